"""Every file and piece of a file on a page is valid: XML, YAML, TOML and JSON, as simkit reads each kind of file."""

from __future__ import annotations

import itertools
import json
import re
import tomllib
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Final

import pytest

import simkit
from simkit.build import check
from simkit.diagnostics import Diagnostics
from simkit.recording.command_script import read_script
from simkit.sensors.realism.realism_file import read_realism_file
from simkit.testing.scenarios.scenario_file import read_scenario
from simkit.yaml_reader import read_yaml
from tests.page_blocks import ROOT, Block, blocks, page_name, pages, write_files

NAMESPACES: Final = {"simkit": "simkit", "gz": "http://gazebosim.org/schema", "xacro": "http://wiki.ros.org/xacro"}
for _prefix, _uri in NAMESPACES.items():
    ET.register_namespace(_prefix, _uri)
DECLARED: Final = "".join(f' xmlns:{prefix}="{uri}"' for prefix, uri in NAMESPACES.items())

# What a page leaves out with `…` inside an element.
OMITTED: Final = {
    "lidar": "<scan><horizontal><samples>9</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal>"
    "</scan><range><min>0.1</min><max>9</max></range>",
    "collision": "<geometry><sphere><radius>0.1</radius></sphere></geometry>",
    "model": '<link name="frame"/><link name="leaf"/><joint name="hinge" type="revolute"><parent>frame</parent>'
    "<child>leaf</child><axis><xyz>0 0 1</xyz><limit><lower>0</lower><upper>1.5</upper></limit></axis></joint>",
}

# What the rest of a world contains, for the elements and plugins that look for it.
WORLD: Final = {
    "spherical_coordinates": "<spherical_coordinates><latitude_deg>47</latitude_deg><longitude_deg>8</longitude_deg>"
    "<elevation>488</elevation></spherical_coordinates>",
    "light": '<light name="sun" type="directional"/><light name="sunloin" type="directional"/>',
    "model": '<model name="crate"><pose>3 0 0.5 0 0 0</pose><link name="box"/>'
    '<plugin filename="gz-sim-label-system" name="gz::sim::systems::Label"><label>1</label></plugin></model>'
    '<plugin name="gz::sim" filename="dummy"><performer name="p"><ref>crate</ref>'
    "<geometry><box><size>1 1 1</size></box></geometry></performer></plugin>",
}
JOINTS: Final = {
    "left": "left_wheel", "right": "right_wheel", "left_finger_joint": "left_finger", "cabin_joint": "cabin",
    "right_finger_joint": "right_finger", "rotor_0_joint": "rotor",
}  # fmt: skip
ROBOT: Final = (
    '<model name="robot"><link name="base_link"><sensor name="imu_sensor" type="imu"/></link>'
    + "".join(
        f'<link name="{link}"/><joint name="{joint}" type="revolute"><parent>base_link</parent><child>{link}</child>'
        "<axis><xyz>0 0 1</xyz></axis></joint>"
        for joint, link in JOINTS.items()
    )
    + '<link name="forearm"/><link name="hand"/><link name="gripper_link"/><link name="base_solar_sensor"/>'
    '<link name="base"/>{}</model>'
)
LINK: Final = '<model name="robot"><link name="base_link">{}</link></model>'
JOINT: Final = (
    '<model name="robot"><link name="base_link"/><link name="arm"/><joint name="j" type="revolute">'
    "<parent>base_link</parent><child>arm</child><axis><xyz>0 0 1</xyz></axis>{}</joint></model>"
)
SENSOR: Final = LINK.format('<sensor name="s" type="%s"><update_rate>1</update_rate>{}</sensor>')
IMU: Final = SENSOR % "imu"
LIDAR: Final = SENSOR.format(f"<lidar>{OMITTED['lidar']}</lidar>{{}}") % "gpu_lidar"

# Where an element belongs, by its name or by its page and name; an element with no line belongs into a world.
PLACES: Final = {
    "sensor": LINK,
    "plugin": ROBOT,
    "joint": ROBOT,
    "link": '<model name="robot">{}</model>',
    "visual": LINK,
    "mesh": LINK.format('<collision name="c"><geometry>{}</geometry></collision>'),
    "camera": SENSOR % "camera",
    "angular_velocity": IMU.format("<imu>{}</imu>"),
    "noise": IMU.format("<imu><angular_velocity><x>{}</x></angular_velocity></imu>"),
    "simkit:shutter": SENSOR % "camera",
    "simkit:depth_holes": SENSOR % "rgbd_camera",
    "simkit:scan_pattern": LIDAR,
    "simkit:point_layout": LIDAR,
    "simkit:actuation_error": ROBOT.format(
        '<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"><left_joint>left</left_joint>'
        "<right_joint>right</right_joint>{}</plugin>"
    ),
    "ros": ROBOT.format('<plugin filename="libgazebo_ros2_control.so" name="gazebo_ros2_control">{}</plugin>'),
    "docs/sensors/encoder.md sensor": JOINT,
    "docs/sensors/depth_camera.md camera": SENSOR % "depth_camera",
    "packs/motion/docs/motion_planning.md plugin": "<include><uri>model://tiago</uri>{}</include>",
}

URDF: Final = (
    f'<robot name="robot"{DECLARED}><link name="base"><inertial><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>%s{}</robot>'
)
CHILD: Final = '<joint name="of_%s" type="fixed"><parent link="base"/><child link="%s"/></joint>'
ARM: Final = "".join(
    f'<link name="{name}"/><joint name="left_{name}" type="continuous"><parent link="{parent}"/>'
    f'<child link="{name}"/></joint>'
    for parent, name in itertools.pairwise(("base", "s0", "s1", "e0", "e1", "w0", "w1", "w2"))
)
ROBOTS: Final = {  # robot for a piece of URDF, by the name of its first element
    "packs/robots/docs/baxter.md gazebo": URDF % ARM,
    "gazebo": URDF % "".join(f'<link name="{name}"/>' + CHILD % (name, name) for name in ("left", "right")),
    "xacro:macro": URDF % (CHILD % ("left_leg", "left_leg")),
}
# World of a page for its files of parameters.
PARAMETERS: Final = {
    "packs/control/docs/trajectories.md": "tiago",
    "packs/navigation/docs/planners.md": '<sdf version="1.9"><world name="w"><model name="robot"><link name="base"/>'
    '<plugin filename="libsimkit_planner_server.so" name="planner_server"/></model></world></sdf>',
}
WELL_FORMED_ONLY: Final = ("package", "boxes")


def of(*languages: str) -> list[object]:
    """Return the blocks in some languages as parameters of a test."""
    return [
        pytest.param(page, block, id=f"{page_name(page)}:{block.line}")
        for page in pages()
        for block in blocks(page, *languages)
    ]


def elements_of(text: str) -> list[ET.Element]:
    """Return the elements of a piece of XML, with something in the place of each `…`."""
    root = ET.fromstring(f"<piece{DECLARED}>{re.sub(r'<[?].*?[?]>', '', text)}</piece>")
    for element in root.iter():
        if (element.text or "").strip() in ("…", "..."):
            element.text = ""
            element[:0] = ET.fromstring(f"<x>{OMITTED.get(element.tag, '')}</x>")
        if (element.tail or "").strip() == "…":
            element.tail = ""
    return [*root]


def prefixed(tag: str) -> str:
    """Return the name of an element with its prefix."""
    return next((f"{p}:{tag[len(u) + 2 :]}" for p, u in NAMESPACES.items() if tag.startswith(f"{{{u}}}")), tag)


def world_with(page: Path, elements: list[ET.Element], *, plugins_in_world: bool) -> str:
    """Return a world with each element at the place where it belongs."""
    by_place: dict[str, str] = {}
    for element in elements:
        name = prefixed(element.tag)
        place = PLACES.get(f"{page_name(page)} {name}") or PLACES.get(name, "{}")
        if name == "plugin" and plugins_in_world:
            place = "{}"
        by_place[place] = by_place.get(place, "") + ET.tostring(element, encoding="unicode")
    names = {element.tag for element in elements}
    rest = "".join(text for name, text in WORLD.items() if name not in names)
    content = rest + "".join(place.format(text) for place, text in by_place.items())
    return f'<sdf version="1.9"{DECLARED}><world name="w">{content}</world></sdf>'


def problems(source: Path | str, folder: Path, **arguments: object) -> list[str]:
    """Return the errors and warnings of a world, a robot or a launch file."""
    found = check(source, plugin_paths=[folder], resource_paths=[folder], **arguments)
    return [str(one) for one in found if one.severity != "note"]


def problems_of_launch(file: Path) -> list[str]:
    """Return the errors and warnings of a launch file."""
    return [str(one) for one in simkit.launch(file).diagnostics if one.severity != "note"]


def problems_of_tree(file: Path) -> list[str]:
    """Return the problems of a behaviour tree."""
    from simkit_navigation.behavior_trees.tree_reader import read_tree_file

    found = Diagnostics()
    read_tree_file(file, found)
    return [*map(str, found)]


@pytest.mark.leaves_out
@pytest.mark.needs_packs
@pytest.mark.parametrize(("page", "block"), of("xml"))
def test_xml_of_a_page_is_valid_where_it_belongs(page: Path, block: Block, tmp_path: Path) -> None:
    write_files(page, tmp_path)
    elements = elements_of(block.text)
    name = prefixed(elements[0].tag)
    if name in WELL_FORMED_ONLY or page_name(page) == "docs/adding_a_sensor.md":
        return  # tests/test_adding_pages.py runs the page with its sensor
    file = tmp_path / (block.file or "page.xml")
    file.write_text(block.text, encoding="utf-8")
    if name == "launch":
        found = problems_of_launch(file)
    elif name == "root":
        found = problems_of_tree(file)
    elif name in ("sdf", "robot", "mujoco"):
        found = problems(file, tmp_path)
    elif name in ROBOTS:
        file = tmp_path / "page.urdf.xacro"
        robot = ROBOTS.get(f"{page_name(page)} {name}", ROBOTS[name])
        file.write_text(robot.format(block.text), encoding="utf-8")
        found = problems(file, tmp_path)
    else:
        file.write_text(world_with(page, elements, plugins_in_world=False), encoding="utf-8")
        found = problems(file, tmp_path)
        if any("SK-PLUGIN-007" in one for one in found):
            file.write_text(world_with(page, elements, plugins_in_world=True), encoding="utf-8")
            found = problems(file, tmp_path)
    assert found == [], "\n".join(["", *found, ""])


def problems_of_yaml(file: Path, value: object, page: Path) -> list[str]:
    """Return the problems of a file in YAML, which its keys show to be of one of simkit's kinds."""
    keys = set(value) if isinstance(value, dict) else set(value[0])
    found = Diagnostics()
    if "uses" in keys:
        inputs = read_yaml((ROOT / "action.yml").read_text("utf-8"))["inputs"]
        return [
            name for step in value for name in step.get("with", {}) if "simkit" in step["uses"] and name not in inputs
        ]
    if "at" in keys:
        read_script(file, None)
    elif isinstance(value.get("launch"), list):
        return problems_of_launch(file)
    elif "parameters" in keys:
        from simkit_learning.sweeps.sweep_file import read_sweep

        read_sweep(file, allow_code=True)
    elif "exercise" in keys:
        from simkit_verification.testing.grading.exercise import read_exercise

        read_exercise(file)
    elif keys & {"world", "launch"}:
        read_scenario(file, allow_code=True)
    elif keys & {"sensors", "plugins"}:
        read_realism_file(file, found)
    elif keys == {"tolerances"}:
        file.write_text("world: empty\n" + file.read_text("utf-8"), encoding="utf-8")
        read_scenario(file)
    elif page_name(page) in PARAMETERS:
        return problems(PARAMETERS[page_name(page)], file.parent, params_files=[file])
    return [*map(str, found)]


@pytest.mark.needs_packs
@pytest.mark.parametrize(("page", "block"), of("yaml"))
def test_yaml_of_a_page_is_valid_for_its_kind(page: Path, block: Block, tmp_path: Path) -> None:
    write_files(page, tmp_path)
    file = tmp_path / (block.file or "page.yaml")
    file.write_text(re.sub(r"^…$", "", block.text, flags=re.MULTILINE), encoding="utf-8")
    found = problems_of_yaml(file, read_yaml(file.read_text("utf-8")), page)
    assert found == [], "\n".join(["", *found, ""])


@pytest.mark.parametrize(("page", "block"), of("toml", "json"))
def test_toml_and_json_of_a_page_are_valid(page: Path, block: Block) -> None:
    assert (tomllib.loads if block.language == "toml" else json.loads)(block.text)
