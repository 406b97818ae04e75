"""MuJoCo's own format: its scene, the files that it may read, and the reports on invalid files."""

from __future__ import annotations

import os
import struct
from pathlib import Path

import mujoco
import numpy as np
import pytest

import simkit
from simkit.compiler.mjcf_parser import MjcfParser
from simkit.diagnostics import Diagnostics
from simkit.loaders import Resolver, load_scene
from simkit.loaders.mjcf import size_limits
from simkit.pose import Pose
from simkit.scene import Box, Capsule, Mesh, Scene

ARM = """<mujoco model="arm">
  <compiler angle="degree"/>
  <option timestep="0.004" gravity="0 0 -1.5"/>
  <default><default class="shown"><geom contype="0" conaffinity="0" group="2"/></default></default>
  <worldbody>
    <light name="top" pos="0 0 3"/>
    <body name="base" pos="0 0 1">
      <freejoint name="root"/>
      <geom name="hull" type="box" size=".1 .2 .3" friction="0.4"/>
      <body name="upper" pos="0 0 .5" euler="0 90 0">
        <joint name="elbow" axis="0 1 0" range="-90 45" damping="2" frictionloss="0.1" actuatorfrcrange="-7 7"/>
        <joint name="slide" type="slide" axis="0 0 1" pos="0 0 .1" stiffness="30" springref="0.2"/>
        <geom name="bone" type="capsule" fromto="0 0 0 0 0 .4" size=".05" group="3"/>
        <geom name="skin" class="shown" type="sphere" size=".1" rgba="1 0 0 1"/>
        <site name="tip" pos="0 0 .4"/>
        <body name="hand" pos="0 0 .4"><geom name="palm" size=".05" mass="0.5"/></body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
STL = (
    b"\0" * 80
    + struct.pack("<I", 4)
    + b"".join(
        struct.pack("<12fH", *(0.0,) * 3, *(c for p in triangle for c in p), 0)
        for triangle in (
            ((0, 0, 0), (0, 1, 0), (1, 0, 0)),
            ((0, 0, 0), (1, 0, 0), (0, 0, 1)),
            ((0, 0, 0), (0, 0, 1), (0, 1, 0)),
            ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
        )
    )
)


def scene_of(source: str | Path, **options: object) -> tuple[Scene, Diagnostics]:
    diagnostics = Diagnostics()
    scene = load_scene(source, resolver=Resolver(), diagnostics=diagnostics, mjcf_parser=MjcfParser, **options)  # type: ignore[arg-type]
    return scene, diagnostics


def errors_of(source: str | Path) -> list[simkit.Diagnostic]:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.describe(source)
    return [d for d in caught.value.diagnostics if d.severity == "error"]


def write(folder: Path, files: dict[str, str | bytes]) -> Path:
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return folder / next(iter(files))


# ---------------------------------------------------------------------- content of the scene


def test_a_file_with_one_free_body_is_a_model_in_a_world_with_the_options_of_the_file() -> None:
    scene, _ = scene_of(ARM)
    assert scene.model is not None
    assert scene.model.name == "arm"
    assert [link.name for link in scene.model.links] == ["base", "upper", "hand"]
    assert scene.world.physics.max_step_size == 0.004
    assert scene.world.gravity == (0.0, 0.0, -1.5)
    assert [light.name for light in scene.world.lights] == ["top"]


def test_bodies_become_links_with_their_poses_masses_and_inertias() -> None:
    model = scene_of(ARM)[0].model
    assert model is not None
    base, upper, hand = model.links
    assert upper.pose_world.position == pytest.approx((0, 0, 1.5))
    assert hand.pose_world.position == pytest.approx((0.4, 0, 1.5), abs=1e-12)
    assert base.inertial.mass == pytest.approx(1000 * 0.2 * 0.4 * 0.6)
    expected_moments = [48 / 12 * (a * a + b * b) for a, b in ((0.4, 0.6), (0.2, 0.6), (0.2, 0.4))]
    assert base.inertial.inertia == pytest.approx((*expected_moments, 0, 0, 0))
    assert hand.inertial.mass == 0.5


def test_each_joint_of_a_body_connects_the_same_two_links() -> None:
    model = scene_of(ARM)[0].model
    assert model is not None
    elbow, slide, wrist = model.joints
    assert {(j.parent_link, j.child_link) for j in (elbow, slide)} == {("arm::base", "arm::upper")}
    assert (elbow.type, slide.type, wrist.type) == ("revolute", "prismatic", "fixed")
    axis = elbow.axes[0]
    assert (axis.lower, axis.upper) == pytest.approx((-np.pi / 2, np.pi / 4))
    assert (axis.effort, axis.damping, axis.friction) == (7.0, 2.0, 0.1)
    assert slide.axes[0].xyz_world == pytest.approx((1, 0, 0), abs=1e-12)
    assert slide.pose_world.position == pytest.approx((0.1, 0, 1.5), abs=1e-12)
    assert (slide.axes[0].stiffness, slide.axes[0].spring_ref) == (30.0, 0.2)


def test_masks_decide_whether_a_geom_collides_and_its_group_whether_it_is_drawn() -> None:
    model = scene_of(ARM)[0].model
    assert model is not None
    base, upper, _ = model.links
    assert [c.name for c in base.collisions] == [v.name for v in base.visuals] == ["hull"]
    assert base.collisions[0].geometry == Box((0.2, 0.4, 0.6))
    assert base.collisions[0].surface.mu == 0.4
    assert [c.name for c in upper.collisions] == ["bone"]
    assert upper.collisions[0].geometry == Capsule(0.05, 0.4)
    assert [v.name for v in upper.visuals] == ["skin"]
    assert upper.visuals[0].material is not None
    assert upper.visuals[0].material.diffuse == (1.0, 0.0, 0.0, 1.0)


def test_sites_are_frames_on_their_links() -> None:
    model = scene_of(ARM)[0].model
    assert model is not None
    (tip,) = model.frames
    assert (tip.name, tip.attached_to) == ("tip", "arm::upper")
    assert tip.pose_world.position == pytest.approx((0.4, 0, 1.5), abs=1e-12)


def test_a_joint_with_a_linear_equality_mimics_its_leader() -> None:
    text = """<mujoco><worldbody><body name="a"><joint name="lead"/><geom size=".1"/></body>
      <body name="b"><joint name="follow" ref="0.3"/><geom size=".1"/></body></worldbody>
      <compiler angle="radian"/>
      <equality><joint joint1="follow" joint2="lead" polycoef="0.1 -2 0 0 0"/></equality></mujoco>"""
    world = scene_of(text)[0].world
    mimic = world.models[1].joints[0].axes[0].mimic
    assert mimic is not None
    assert (mimic.joint, mimic.multiplier, mimic.offset) == ("lead", -2.0, pytest.approx(0.4))


def test_a_file_with_geoms_in_the_world_body_is_a_world(tmp_path: Path) -> None:
    scene_file = """<mujoco model="yard"><include file="arm.xml"/>
      <worldbody><geom name="floor" type="plane" size="0 0 1"/>
        <body name="crate" pos="1 0 0"><freejoint/><geom size=".1"/></body></worldbody></mujoco>"""
    path = write(tmp_path, {"scene.xml": scene_file, "arm.xml": ARM})
    described = simkit.describe(path)
    (world,) = described["worlds"]
    assert world["name"] == "yard"
    assert world["gravity"] == [0, 0, -1.5]
    assert [(m["name"], m["static"]) for m in world["models"]] == [
        ("worldbody", True),
        ("arm", False),  # by the name of the file that it was included from
        ("crate", False),
    ]
    assert world["models"][1]["pose_world"] == [0, 0, 1, 1, 0, 0, 0]
    assert described["totals"]["links"] == 5


def test_names_with_colons_are_split_into_models_and_links() -> None:
    text = """<mujoco><worldbody><body name="robot::base"><freejoint/><geom size=".1"/>
      <body name="robot::arm"><joint name="robot::elbow"/><geom size=".1"/></body></body>
      <body name="robot::loose"><freejoint/><geom size=".1"/></body></worldbody></mujoco>"""
    (model,) = scene_of(text)[0].world.models
    assert [link.scoped for link in model.links] == ["robot::base", "robot::arm", "robot::loose"]
    assert model.joints[0].scoped == "robot::elbow"


@pytest.mark.parametrize(("base", "free"), [("fixed", False), ("floating", True)])
def test_the_caller_chooses_the_base(base: str, free: bool) -> None:
    for loose in ("<freejoint/>", ""):
        text = f'<mujoco><worldbody><body name="b" pos="0 0 1">{loose}<geom size=".1"/></body></worldbody></mujoco>'
        with simkit.load(text, base=base) as sim:
            sim.run(0.2)
            assert (sim.model("model").link("b").pose.position[2] < 0.95) == free


def test_the_angle_unit_of_the_file_is_applied() -> None:
    for unit, number in (("degree", "90"), ("radian", repr(np.pi / 2))):
        text = f"""<mujoco><compiler angle="{unit}"/><worldbody>
          <body euler="0 0 {number}"><joint range="-{number} {number}"/><geom size=".1"/></body></worldbody></mujoco>"""
        model = scene_of(text)[0].model
        assert model is not None
        assert model.joints[0].axes[0].upper == pytest.approx(np.pi / 2)
        assert model.links[0].pose_world.rpy[2] == pytest.approx(np.pi / 2)


# ---------------------------------------------------------------------- asset files and included files


def test_a_mesh_is_found_by_the_folder_that_the_compiler_element_names(tmp_path: Path) -> None:
    text = """<mujoco model="m"><compiler meshdir="parts"/><asset><mesh file="tetra.stl" scale="2 2 2"/></asset>
      <worldbody><body name="b"><geom type="mesh" mesh="tetra"/></body></worldbody></mujoco>"""
    path = write(tmp_path, {"m.xml": text, "parts/tetra.stl": STL})
    model = scene_of(path)[0].model
    assert model is not None
    (collision,) = model.links[0].collisions
    assert collision.geometry == Mesh(tmp_path / "parts" / "tetra.stl", "tetra.stl", (2.0, 2.0, 2.0))
    assert collision.pose_link.position == pytest.approx((0, 0, 0), abs=1e-6)  # the file's own axes
    assert model.links[0].inertial.mass == pytest.approx(1000 * 8 / 6, rel=1e-5)


def test_a_missing_mesh_is_an_error_but_only_a_warning_for_describe(tmp_path: Path) -> None:
    text = """<mujoco model="m"><asset><mesh name="q" file="no.stl"/></asset>
      <worldbody><body name="b"><geom type="mesh" mesh="q"/></body></worldbody></mujoco>"""
    path = write(tmp_path, {"m.xml": text})
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(path)
    assert [(d.code, d.line) for d in caught.value.diagnostics] == [("SK-URI-001", 1)]
    described = simkit.describe(path)
    assert [d["code"] for d in described["diagnostics"] if d["severity"] == "warning"] == ["SK-URI-001"]
    assert described["model"]["links"][0]["collisions"][0]["geom"]["missing"]


def test_an_attached_model_uses_its_own_files(tmp_path: Path) -> None:
    hand = """<mujoco model="hand"><compiler meshdir="m"/><asset><mesh file="tetra.stl"/></asset>
      <worldbody><body name="palm"><geom type="mesh" mesh="tetra"/></body></worldbody></mujoco>"""
    main = """<mujoco model="arm"><asset><model name="hand" file="hand/hand.xml"/></asset>
      <worldbody><body name="base"><geom size=".1"/><attach model="hand" body="palm" prefix="left_"/></body>
      </worldbody></mujoco>"""
    path = write(tmp_path, {"arm.xml": main, "hand/hand.xml": hand, "hand/m/tetra.stl": STL})
    model = scene_of(path)[0].model
    assert model is not None
    assert [link.name for link in model.links] == ["base", "left_palm"]
    assert model.links[1].inertial.mass == pytest.approx(1000 / 6, rel=1e-5)


@pytest.mark.parametrize(
    "named",
    ["../secret.stl", "/etc/passwd", "file:///etc/passwd", "a/../../secret.stl"],
)
def test_no_file_outside_the_resource_folders_is_read(tmp_path: Path, named: str) -> None:
    write(tmp_path, {"secret.stl": STL})
    text = f'<mujoco><asset><mesh name="m" file="{named}"/></asset></mujoco>'
    path = write(tmp_path / "inside", {"m.xml": text})
    assert [d.code for d in errors_of(path)] == ["SK-URI-003"]
    text = f'<mujoco><include file="{named}"/></mujoco>'
    path = write(tmp_path / "inside", {"m.xml": text})
    assert [d.code for d in errors_of(path)] == ["SK-URI-003"]


def test_a_file_is_included_once(tmp_path: Path) -> None:
    path = write(
        tmp_path,
        {"a.xml": '<mujoco>\n<include file="b.xml"/></mujoco>', "b.xml": '<mujoco><include file="a.xml"/></mujoco>'},
    )
    assert {d.code for d in errors_of(path)} == {"SK-MJCF-006"}


def test_a_file_that_includes_another_twice_is_not_compiled(tmp_path: Path) -> None:
    twice = '<mujoco><include file="b.xml"/><include file="b.xml"/></mujoco>'
    body = '<mujoco><worldbody><body name="b"><geom size="1"/></body></worldbody></mujoco>'
    scene, diagnostics = scene_of(write(tmp_path, {"a.xml": twice, "b.xml": body}))
    assert [d.code for d in diagnostics if d.severity == "error"] == ["SK-MJCF-006"]
    assert scene.model is None and not scene.worlds


def test_a_file_that_attaches_itself_is_an_error(tmp_path: Path) -> None:
    text = """<mujoco><asset><model name="me" file="a.xml"/></asset><worldbody><body name="b"><geom size="1"/>
      <attach model="me" body="b" prefix="x"/></body></worldbody></mujoco>"""
    assert {d.code for d in errors_of(write(tmp_path, {"a.xml": text}))} == {"SK-MJCF-006"}


# ---------------------------------------------------------------------- invalid files


def test_all_unknown_names_are_reported_in_one_pass_with_the_closest_name(tmp_path: Path) -> None:
    text = """<mujoco>
  <worldbody>
    <body>
      <goem size="1"/>
      <geom sise="1"/>
      <joint stifness="1"/>
    </body>
  </worldbody>
  <actuater/>
</mujoco>"""
    found = errors_of(write(tmp_path, {"m.xml": text}))
    assert [(d.code, d.line) for d in found] == [
        ("SK-MJCF-002", 4),
        ("SK-MJCF-003", 5),
        ("SK-MJCF-003", 6),
        ("SK-MJCF-002", 9),
    ]
    assert [d.hint for d in found] == [f"did you mean '{w}'?" for w in ("geom", "size", "stiffness", "actuator")]


def test_attributes_of_earlier_versions_of_mujoco_are_ignored_with_a_warning(tmp_path: Path) -> None:
    text = """<mujoco>
  <option apirate="100"><flag sensornoise="enable"/></option>
  <worldbody><body><geom size="1"/></body></worldbody>
</mujoco>"""
    scene, diagnostics = scene_of(write(tmp_path, {"m.xml": text}))
    assert scene.model is not None
    assert [(d.code, d.severity, d.line) for d in diagnostics if d.severity != "note"] == [
        ("SK-MJCF-016", "warning", 2)
    ] * 2


def test_errors_have_the_line_of_the_included_file(tmp_path: Path) -> None:
    part = "<mujoco>\n\n<worldbody>\n<body name='b'>\n<geom size='1' type='blob'/></body></worldbody></mujoco>"
    path = write(tmp_path, {"main.xml": "<mujoco>\n<include file='part.xml'/></mujoco>", "part.xml": part})
    (found,) = errors_of(path)
    assert (found.code, found.file, found.line) == ("SK-MJCF-001", str(tmp_path / "part.xml"), 5)
    assert "'blob'" in found.message


def test_an_unknown_reference_is_reported_with_the_closest_name() -> None:
    text = """<mujoco><worldbody><body><joint name="elbow"/><geom size="1"/></body></worldbody>
      <actuator><motor joint="elbwo"/></actuator></mujoco>"""
    (found,) = errors_of(text)
    assert found.hint == "did you mean 'elbow'?"


@pytest.mark.parametrize(
    ("content", "code"),
    [
        ('<worldbody><geom size="nan"/></worldbody>', "SK-MJCF-004"),
        ('<worldbody><geom size="1" pos="0 1e999 0"/></worldbody>', "SK-MJCF-004"),
        ('<option timestep="inf"/>', "SK-MJCF-004"),
        ('<asset><hfield name="h" nrow="20000" ncol="2" size="1 1 1 1"/></asset>', "SK-MJCF-005"),
        ('<asset><texture name="t" builtin="flat" width="16000" height="16000"/></asset>', "SK-MJCF-005"),
        ('<size memory="10000G"/>', "SK-MJCF-005"),
        ('<custom><numeric name="n" size="2000000000"/></custom>', "SK-MJCF-005"),
        ('<worldbody><replicate count="9999"><replicate count="9999"/></replicate></worldbody>', "SK-MJCF-005"),
        ('<compiler><lengthrange timestep="1e-9"/></compiler>', "SK-MJCF-005"),
        ('<extension><plugin plugin="nobody.knows"/></extension>', "SK-MJCF-001"),
        ("<worldbody><body/></worldbody>", ""),
    ],
)  # fmt: skip
def test_a_file_that_exceeds_a_limit_is_refused(content: str, code: str) -> None:
    text = f"<mujoco>{content}</mujoco>"
    if code:
        assert code in [d.code for d in errors_of(text)]
    else:
        simkit.describe(text)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("m.stl", b"\0" * 80 + struct.pack("<I", 1_000_000_000) + b"\0" * 50),
        ("m.stl", b"solid x\nfacet normal 0 0 1\nendsolid" + b" " * 100),
        ("m.msh", struct.pack("<4i", 1 << 30, 0, 0, 1 << 30)),
        ("m.msh", struct.pack("<4i", -1, 0, 0, 5)),
        ("m.obj", b""),
        ("m.dae", b"<COLLADA/>"),
    ],
)
def test_an_invalid_mesh_file_is_refused_before_mujoco_reads_it(tmp_path: Path, name: str, content: bytes) -> None:
    text = f'<mujoco>\n<asset><mesh name="m" file="{name}"/></asset></mujoco>'
    (found,) = errors_of(write(tmp_path, {"a.xml": text, name: content}))
    assert (found.code, found.line) == ("SK-MJCF-007", 2)


def test_an_image_whose_header_declares_too_many_pixels_is_refused(tmp_path: Path) -> None:
    bomb = b"\x89PNG\r\n\x1a\n" + struct.pack(">I4s2I5B", 13, b"IHDR", 100_000, 100_000, 8, 2, 0, 0, 0) + b"\0" * 8
    text = '<mujoco><asset><texture name="t" type="2d" file="t.png"/></asset></mujoco>'
    (found,) = errors_of(write(tmp_path, {"a.xml": text, "t.png": bomb}))
    assert found.code == "SK-MJCF-007"


def test_the_search_for_the_range_of_a_muscle_has_a_time_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """The muscle below has no `lengthrange`, so MuJoCo must measure the range; here 0.01 s is too short for this."""
    monkeypatch.setattr("simkit.compiler.mjcf_parser.RANGE_TIMEOUT", 0.01)
    text = """<mujoco><worldbody><body><joint name="j" range="-1 1" limited="true"/><geom size=".1" pos="1 0 0"/></body>
      </worldbody><actuator><muscle joint="j"/></actuator></mujoco>"""
    assert [d.code for d in errors_of(text)] == ["SK-MJCF-014"]


def test_the_length_range_of_a_muscle_equals_that_of_mujoco() -> None:
    text = """<mujoco><compiler angle="radian"/><worldbody><body name="b"><joint name="j" range="-1 1"/>
      <geom size=".1" pos="1 0 0"/></body></worldbody><actuator><muscle name="pull" joint="j"/></actuator></mujoco>"""
    bare = mujoco.MjModel.from_xml_string(text)
    with simkit.load(text) as sim:
        assert np.array_equal(sim.mj_model.actuator_lengthrange, bare.actuator_lengthrange)


def test_mujoco_warnings_are_not_written_to_a_file(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    before = Path.cwd()
    os.chdir(tmp_path)
    try:
        simkit.describe('<mujoco><statistic meaninertia="1"/><worldbody><geom size="1"/></worldbody></mujoco>')
    finally:
        os.chdir(before)
    assert not list(tmp_path.iterdir())
    assert capfd.readouterr().err == ""


def test_the_limits_count_replicated_elements() -> None:
    assert size_limits.MOST_ELEMENTS == 100_000
    text = """<mujoco><worldbody><replicate count="300" offset="1 0 0"><body><geom size=".1"/></body></replicate>
      </worldbody></mujoco>"""
    assert len(scene_of(text)[0].world.models) == 300


def test_a_pose_given_by_the_caller_places_the_file_s_world() -> None:
    scene, _ = scene_of(ARM, name="other", pose=Pose((5, 0, 0)))
    assert scene.model is not None
    assert scene.model.links[0].pose_world.position == pytest.approx((5, 0, 1))
    assert scene.model.links[0].scoped == "other::base"


def test_a_total_mass_counts_for_all_bodies_beside_a_static_geom():
    text = """<mujoco><compiler settotalmass="14"/><worldbody><geom type="plane" size="1 1 1"/>
      <body pos="0 0 1"><freejoint/><geom size=".1"/>
      <body name="arm"><joint axis="0 1 0"/><geom size=".1"/></body></body></worldbody></mujoco>"""
    with simkit.load(text) as sim:
        assert sim.mj_model.body_mass.sum() == pytest.approx(14.0)
        assert sim.mj_model.body("arm").mass[0] == pytest.approx(7.0)


def test_the_file_of_a_skin_is_found(tmp_path):
    vertices, faces = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4"), np.array([[0, 1, 2]], "<i4")
    bone = struct.pack("<40s", b"b") + np.array([0, 0, 0, 1, 0, 0, 0], "<f4").tobytes() + struct.pack("<i", 3)
    bone += np.arange(3, dtype="<i4").tobytes() + np.ones(3, "<f4").tobytes()
    content = struct.pack("<4i", 3, 0, 1, 1) + vertices.tobytes() + faces.tobytes() + bone
    (tmp_path / "cloth.skn").write_bytes(content)
    (tmp_path / "m.xml").write_text(
        """<mujoco><asset><skin name="s" file="cloth.skn"/></asset>
        <worldbody><body name="b"><freejoint/><geom size=".1"/></body></worldbody></mujoco>"""
    )
    with simkit.load(tmp_path / "m.xml") as sim:
        assert sim.mj_model.nskin == 1
        assert sim.mj_model.nskinvert == 3
