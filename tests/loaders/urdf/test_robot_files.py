"""Published URDF files: the element table, poses compared with an independent library, and damaged files."""

from __future__ import annotations

import random
import re
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest

import simkit
from simkit.diagnostics import Diagnostics
from simkit.loaders import Resolver, load_scene
from simkit.loaders.elements_page import urdf_elements
from simkit.loaders.resources.xml_reader import parse_text
from simkit.loaders.sdf.load_context import SdfFile, Workspace
from simkit.loaders.urdf.robot import build_robot, declare_robot

ELEMENTS = urdf_elements()
_ORIGIN = '<origin xyz="0 0 1" rpy="0 0 0" quat_xyzw="0 0 0 1"/>'
_SHAPES = (
    '<box size="1 1 1"/>',
    '<cylinder radius="1" length="1"/>',
    '<sphere radius="1"/>',
    '<capsule radius="1" length="1"/>',
    '<mesh filename="a.stl" scale="1 1 1"/>',
)
_END = (
    '<{0} name="j" role="joint1"><mechanicalReduction>1</mechanicalReduction><role>joint1</role><offset>0</offset>'
    "<hardwareInterface>x</hardwareInterface></{0}>"
)
_MATERIAL = '<material name="m"><color rgba="1 0 0 1"/><texture filename="a.png"/></material>'
WHOLE = f"""<robot name="r">{_MATERIAL}
<link name="a"><inertial>{_ORIGIN}<mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
{"".join(f'<collision name="c{i}">{_ORIGIN}<geometry>{s}</geometry></collision>' for i, s in enumerate(_SHAPES))}
{"".join(f'<visual name="v{i}">{_ORIGIN}<geometry>{s}</geometry>{_MATERIAL}</visual>' for i, s in enumerate(_SHAPES))}
</link><link name="b"/>
<joint name="j" type="revolute">{_ORIGIN}<parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/><dynamics damping="0" friction="0"/><mimic joint="k" multiplier="1"
 offset="0"/><safety_controller soft_lower_limit="0" soft_upper_limit="0" k_position="0" k_velocity="0"/>
<calibration rising="0" falling="0" reference_position=""/></joint>
<transmission name="t" type="x"><type>x</type><mechanicalReduction>1</mechanicalReduction>{_END.format("joint")}
{_END.format("actuator")}</transmission><ros2_control name="c"/>
<gazebo/><gazebo reference="a"/><gazebo reference="j"/></robot>"""


def read_paths(text: str) -> set[str]:
    """Return every path and attribute that the readers read in a robot."""
    diagnostics = Diagnostics()
    root = parse_text(text, diagnostics)
    workspace = Workspace(Resolver(missing_meshes=True), diagnostics)
    draft = declare_robot(SdfFile(root, (1, 11), Path.cwd()), workspace, workspace.resolver)
    build_robot(draft, "")
    found: set[str] = set()
    stack = [(root, "robot")]
    while stack:
        element, path = stack.pop()
        found |= {f"{path}@{name}" for name in element.attributes_asked}
        if path in ("robot/ros2_control",):
            continue
        found |= {f"{path}/{name}" for name in element.asked}
        stack += [(child, f"{path}/{child.name}") for child in element.children if child.was_read]
    for reference, kind in (("a", "link"), ("j", "joint"), ("", "robot")):
        found |= {f"robot/gazebo[{kind}]/{name}" for name in draft.extensions.merged[reference].asked}
    return found


def test_the_table_of_elements_lists_exactly_the_names_that_are_read():
    found, table = read_paths(WHOLE), {path for path, _ in ELEMENTS}
    holders = {path.partition("@")[0] for path in table} | {p.rpartition("/")[0] for p in table}
    holders |= {h.rpartition("/")[0] for h in holders} | {"robot/gazebo", "robot/ros2_control@name"}
    assert not table - found, "the table has what nobody reads"
    assert not found - table - holders, "somebody reads what the table lacks"


def test_the_table_describes_each_element():
    assert len({path for path, _ in ELEMENTS}) == len(ELEMENTS)
    assert all(becomes for _, becomes in ELEMENTS)


# ---------------------------------------------------------------------- real robots


def robots() -> list[Path]:
    """Return the URDF files of the package example-robot-data; none if the package is not installed."""
    try:
        files = metadata.files("example-robot-data") or []
    except metadata.PackageNotFoundError:
        return []
    return sorted(Path(str(f.locate())) for f in files if str(f).endswith(".urdf"))


SMALL = [p for p in robots() if p.name in ("panda.urdf", "ur3_robot.urdf", "solo12.urdf", "tiago_no_hand.urdf")]


@pytest.mark.slow
@pytest.mark.skipif(not SMALL, reason="example-robot-data is not installed")
@pytest.mark.parametrize("file", SMALL, ids=lambda p: p.stem)
def test_poses_agree_with_yourdfpy_at_any_configuration(file):
    """The library yourdfpy computes the poses of the links independently."""
    yourdfpy = pytest.importorskip("yourdfpy")
    reference = yourdfpy.URDF.load(str(file), load_meshes=False, build_scene_graph=True, mesh_dir=str(file.parent))
    folder = next(p for p in file.parents if p.name == "robots" or (p / "robots").is_dir())
    generator = np.random.default_rng(3)
    with simkit.load(file, base="fixed", resource_paths=[folder]) as sim:
        model = next(iter(sim.models.values()))
        names = [
            n for n, j in zip(reference.actuated_joint_names, reference.actuated_joints, strict=True) if not j.mimic
        ]
        for _ in range(3):
            position = {n: float(generator.uniform(-0.5, 0.5)) for n in names}
            reference.update_cfg(position)
            for name, value in position.items():
                model.joint(name).set_position(value)
            for name in reference.link_map:
                want = reference.get_transform(name, reference.base_link)
                have = model.link(name).pose
                np.testing.assert_allclose(have.position, want[:3, 3], atol=1e-9)
                np.testing.assert_allclose(have.matrix, want[:3, :3], atol=1e-9)


@pytest.mark.skipif(not robots(), reason="example-robot-data is not installed")
def test_the_mass_of_a_real_robot_is_the_sum_of_the_masses_in_its_file():
    for file in robots()[:12]:
        folder = next(p for p in file.parents if p.name == "example-robot-data").parent
        written = re.sub(r"<!--.*?-->", "", file.read_text(errors="ignore"), flags=re.DOTALL)
        masses = re.findall(r"<mass\s+value\s*=\s*[\"']([^\"']+)[\"']", written)
        found = simkit.describe(file, resource_paths=[folder])
        assert found["totals"]["mass"] == pytest.approx(sum(map(float, masses)), rel=1e-9), file.name


# ---------------------------------------------------------------------- damaged files


_PIECES = (
    "nan",
    "inf",
    "-1",
    "1e308",
    "",
    "a::b",
    "${x}",
    "$(find x)",
    "0 0",
    "<link/>",
    "</robot>",
    "<gazebo reference='a'/>",
    "<joint name='j' type='fixed'/>",
    "\x00",
    "&amp;",
    "world",
    "<xacro:macro name='m'/>",
    "1_0",
    "\u0661",
    "x" * 3000,
)


def damaged(text: str, generator: random.Random) -> str:
    """Return the text with exchanged attributes, removed or repeated lines, or inserted invalid pieces."""
    for _ in range(generator.randint(1, 6)):
        position = generator.randrange(len(text))
        kind = generator.randrange(4)
        if kind == 0:
            values = list(re.finditer(r'"[^"]*"', text))
            chosen = generator.choice(values) if values else None
            if chosen is not None:
                text = text[: chosen.start()] + f'"{generator.choice(_PIECES)}"' + text[chosen.end() :]
        elif kind == 1:
            tags = list(re.finditer(r"<[^<>]*/>", text))
            chosen = generator.choice(tags) if tags else None
            if chosen is not None:
                text = text[: chosen.start()] + generator.choice(["", chosen.group() * 2]) + text[chosen.end() :]
        elif kind == 2:
            text = text[:position] + generator.choice(_PIECES) + text[position:]
        else:
            names = re.findall(r"<(\w+)", text) or ["robot"]
            text = text.replace(f"<{generator.choice(names)}", f"<{generator.choice(names)}", 1)
    return text


@pytest.mark.parametrize("seed", range(60))
def test_a_damaged_file_is_read_or_refused_without_an_exception(seed):
    generator = random.Random(seed)
    text = damaged(WHOLE, generator)
    diagnostics = Diagnostics()
    load_scene(text, resolver=Resolver(missing_meshes=True), diagnostics=diagnostics)
    assert all(d.code and d.message for d in diagnostics)
