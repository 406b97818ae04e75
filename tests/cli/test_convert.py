"""`simkit convert` and `simkit vendor`: what comes out opens alone and means the same."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import cv2
import mujoco
import numpy as np
import pytest
from typer.testing import CliRunner, Result

import simkit
from simkit import msgs
from simkit.cli import app
from simkit.scene.simkit_elements import OWN_ELEMENTS

ROOT = Path(__file__).resolve().parents[2]
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
MASS = '<inertial><mass value="1.25"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'
MESH = '<geometry><mesh filename="package://arm_description/meshes/base.obj" scale="0.1 0.1 0.1"/></geometry>'
URDF = f"""<robot name="arm">
  <link name="base">{MASS}
    <visual>{MESH}</visual>
    <collision>{MESH}</collision>
  </link>
  <link name="upper">{MASS}</link>
  <joint name="shoulder" type="revolute">
    <origin xyz="0.1 0.2 0.333333333333333" rpy="0.1 0.2 0.3"/>
    <parent link="base"/><child link="upper"/><axis xyz="0 0.6 0.8"/>
    <limit lower="-1.23456789" upper="2" effort="30" velocity="3"/><dynamics damping="0.7" friction="0.05"/>
  </joint>
  <gazebo reference="upper">
    <sensor name="imu" type="imu"><update_rate>50</update_rate><pose>0 0 0.1 0 0 0</pose></sensor>
  </gazebo>
  <gazebo><plugin filename="libgazebo_ros_joint_state_publisher.so" name="states">
    <joint_name>shoulder</joint_name><update_rate>10</update_rate>
  </plugin></gazebo>
</robot>
"""
SAME = ("file", "uri", "diagnostics")


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    package = tmp_path / "arm_description"
    (package / "meshes").mkdir(parents=True)
    (package / "urdf").mkdir()
    (package / "package.xml").write_text("<package><name>arm_description</name></package>")
    (package / "LICENSE").write_text("as you like\n")
    (package / "meshes" / "base.obj").write_text("mtllib base.mtl\nusemtl red\n" + TETRAHEDRON)
    (package / "meshes" / "base.mtl").write_text("newmtl red\nKd 0.9 0.1 0.1\n")
    (package / "urdf" / "arm.urdf").write_text(URDF)
    return tmp_path


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)


def assert_means_the_same(after: Any, before: Any, path: str = "") -> None:
    """Two descriptions say the same, the paths of files aside; numbers to 1e-9."""
    after, before = (_comparable(x) for x in (after, before))
    if isinstance(before, dict):
        assert after.keys() == before.keys(), path
        for key in before:
            assert_means_the_same(after[key], before[key], f"{path}.{key}")
    elif isinstance(before, list):
        assert len(after) == len(before), path
        for i, (a, b) in enumerate(zip(after, before, strict=True)):
            assert_means_the_same(a, b, f"{path}[{i}]")
    elif isinstance(before, float):
        assert after == pytest.approx(before, rel=1e-9, abs=1e-9), path
    else:
        assert after == before, path


def _comparable(described: Any) -> Any:
    """Without the paths of files; the quaternion of a pose with its first part positive."""
    if isinstance(described, dict):
        return {k: v for k, v in described.items() if k not in SAME}
    if isinstance(described, list) and len(described) == 7 and all(isinstance(v, (int, float)) for v in described):
        first = next((v for v in described[3:] if abs(v) > 1e-6), 1.0)
        return [float(v) for v in described[:3]] + [float(v) * (1 if first > 0 else -1) for v in described[3:]]
    return described


def assert_opens_alone_with_the_same(sim: simkit.Simulation, path: Path) -> None:
    model, wanted = mujoco.MjModel.from_xml_path(str(path)), sim.mj_model
    fields = (
        "body_pos body_quat body_mass body_ipos body_inertia geom_type geom_pos geom_quat geom_size jnt_pos jnt_axis"
    )
    for field in (*fields.split(), "jnt_range", "dof_damping", "geom_friction", "mesh_vertnum", "body_parentid"):
        np.testing.assert_allclose(getattr(model, field), getattr(wanted, field), rtol=0, atol=1e-9, err_msg=field)
    names = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, i) for i in range(model.nbody)]
    assert names == [mujoco.mj_id2name(wanted, mujoco.mjtObj.mjOBJ_BODY, i) for i in range(wanted.nbody)]


# ---------------------------------------------------------------------- MJCF


@pytest.mark.parametrize("name", ["turtlebot3_world", "turtlebot3_empty"])
def test_a_world_opens_in_mujoco_alone_with_the_same_poses_and_masses(here: Path, name: str) -> None:
    (here / "out").mkdir()
    result = run("convert", name, "-o", "out/w.xml")
    assert result.exit_code == 0
    with simkit.load(name) as sim:
        assert_opens_alone_with_the_same(sim, here / "out" / "w.xml")
    assert not (here / "w_assets").exists()
    assert [p.name for p in sorted((here / "out").iterdir())] == ["w.xml", "w_assets"]


def test_a_robot_with_an_inertia_that_mujoco_refuses_opens_in_it(here: Path) -> None:
    text = URDF.replace('izz="0.1"', 'izz="0.21"', 1).replace(
        '<link name="upper">' + MASS, '<link name="upper">' + MASS
    )
    (here / "arm_description" / "urdf" / "arm.urdf").write_text(text)
    result = run("convert", "arm_description/urdf/arm.urdf", "-o", "arm.xml")
    assert result.exit_code == 0
    assert "rejects the inertia of arm::base" in result.stderr
    mujoco.MjModel.from_xml_path("arm.xml")


def test_output_is_replaced_only_by_force_and_nothing_is_half_written(here: Path) -> None:
    arm = "arm_description/urdf/arm.urdf"
    assert run("convert", arm, "-o", "arm.xml").exit_code == 0
    before = {p: p.read_bytes() for p in here.rglob("*") if p.is_file()}
    refused = run("convert", arm, "-o", "arm.xml")
    assert refused.exit_code == 2
    assert "--force" in refused.stderr
    broken = run("convert", "arm_description/meshes/base.mtl", "-o", "arm.xml", "--force")
    assert broken.exit_code == 2
    assert {p: p.read_bytes() for p in here.rglob("*") if p.is_file()} == before
    assert run("convert", arm, "-o", "arm.xml", "--force").exit_code == 0
    assert {p: p.read_bytes() for p in here.rglob("*") if p.is_file()} == before
    assert run("convert", arm, "-o", "arm.usd").exit_code == 2


def test_missing_folders_of_the_output_are_made_and_removed_again_after_an_error(here: Path) -> None:
    assert run("convert", "arm_description/meshes/base.mtl", "-o", "new/folder/arm.xml").exit_code == 2
    assert not (here / "new").exists()
    assert run("convert", "arm_description/urdf/arm.urdf", "-o", "new/folder/arm.xml").exit_code == 0
    assert (here / "new" / "folder" / "arm.xml").is_file()
    below_a_file = run("convert", "arm_description/urdf/arm.urdf", "-o", "new/folder/arm.xml/arm.xml")
    assert below_a_file.exit_code == 2
    assert "is not a folder" in below_a_file.stderr


# ---------------------------------------------------------------------- SDF


def test_a_urdf_becomes_an_equivalent_sdf(here: Path) -> None:
    (here / "out").mkdir()
    result = run("convert", "arm_description/urdf/arm.urdf", "-o", "out/arm.sdf")
    assert result.exit_code == 0
    before, after = simkit.describe("arm_description/urdf/arm.urdf"), simkit.describe("out/arm.sdf")
    assert_means_the_same(after, before)
    copies = sorted(p.relative_to(here / "out").as_posix() for p in (here / "out").rglob("*.*") if p.is_file())
    assert copies == ["arm.sdf", "arm_assets/arm_description/base.mtl", "arm_assets/arm_description/base.obj"]
    (here / "arm_description").rename(here / "gone")
    assert not [d for d in simkit.check("out/arm.sdf") if d.severity == "error"]


def test_keep_uris_keeps_uris(here: Path) -> None:
    run("convert", "arm_description/urdf/arm.urdf", "-o", "arm.sdf", "--keep-uris")
    assert "package://arm_description/meshes/base.obj" in (here / "arm.sdf").read_text()
    assert not (here / "arm_assets").exists()


@pytest.mark.parametrize(
    "path", sorted([*ROOT.glob("worlds/*.sdf"), *ROOT.glob("packs/*/simkit_*/worlds/*.sdf")]), ids=lambda p: p.name
)
def test_a_world_becomes_one_equivalent_file(here: Path, path: Path) -> None:
    assert run("convert", path, "-o", "w.sdf").exit_code == 0
    assert "<include>" not in (here / "w.sdf").read_text()
    assert_means_the_same(simkit.describe("w.sdf"), simkit.describe(path))


def test_rotations_and_numbers_come_back_as_they_were(here: Path) -> None:
    text = (
        "<sdf version='1.9'><world name='w &amp; co'><gravity>0 0 -3.7</gravity>"
        "<model name='m'><pose>1e-7 0.1 123456.789012345 0 1.5707963267948966 0.3</pose>"
        "<link name='a'><pose degrees='true'>0 0 0 10 20 30</pose></link><frame name='f' attached_to='a'/>"
        "<model name='n'><link name='b'><visual name='v'><geometry><capsule><radius>0.1</radius><length>0.7</length>"
        "</capsule></geometry></visual></link></model>"
        "<joint name='j' type='screw'><parent>a</parent><child>n::b</child>"
        "<screw_thread_pitch>0.01</screw_thread_pitch>"
        "<axis><xyz expressed_in='f'>1 2 3</xyz><limit><lower>-1</lower></limit></axis></joint></model></world></sdf>"
    )
    (here / "a.sdf").write_text(text)
    assert run("convert", "a.sdf", "-o", "b.sdf").exit_code == 0
    assert_means_the_same(simkit.describe("b.sdf"), simkit.describe("a.sdf"))


# ---------------------------------------------------------------------- vendor


def test_a_vendored_robot_opens_without_its_package(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = simkit.describe("arm_description/urdf/arm.urdf")
    result = run("vendor", "arm_description/urdf/arm.urdf", "box")
    assert result.exit_code == 0
    (here / "arm_description").rename(here / "gone")
    (here / "box").rename(here / "elsewhere")
    assert_means_the_same(simkit.describe("elsewhere/arm.urdf"), before)
    files = sorted(p.relative_to(here / "elsewhere").as_posix() for p in (here / "elsewhere").rglob("*") if p.is_file())
    assert files == [
        "arm.urdf",
        "models/arm_description/LICENSE",
        "models/arm_description/meshes/base.mtl",
        "models/arm_description/meshes/base.obj",
        "models/arm_description/package.xml",
    ]


def test_a_vendored_world_brings_its_models_with_their_text(here: Path) -> None:
    for name in ("table", "lamp"):
        folder = here / "store" / name
        folder.mkdir(parents=True)
        (folder / "model.config").write_text(f"<model><name>{name}</name><sdf version='1.9'>m.sdf</sdf></model>")
        (folder / "LICENSE.txt").write_text("as you like\n")
        (folder / "m.sdf").write_text(
            f"<sdf version='1.9'><!-- {name} --><model name='{name}'><static>true</static><link name='l'>"
            f"<visual name='v'><geometry><mesh><uri>model://{name}/top.obj</uri></mesh></geometry></visual></link>"
            f"</model></sdf>"
        )
        (folder / "top.obj").write_text(TETRAHEDRON)
    (here / "worlds").mkdir()
    (here / "worlds" / "w.sdf").write_text(
        "<sdf version='1.9'><world name='w'><include><uri>model://sun</uri></include>"
        "<include><uri>model://table</uri></include>"
        "<include><uri>model://lamp</uri><pose>0 0 1 0 0 0</pose></include></world></sdf>"
    )
    assert run("vendor", "worlds/w.sdf", "box", "--resource-path", "store").exit_code == 0
    before = simkit.describe("worlds/w.sdf", resource_paths=["store"])
    (here / "store").rename(here / "gone")
    assert_means_the_same(simkit.describe("box/w.sdf"), before)
    assert "<!-- lamp -->" in (here / "box" / "models" / "lamp" / "m.sdf").read_text()
    assert (here / "box" / "models" / "table" / "LICENSE.txt").is_file()


def heated(name: str, picture: str) -> str:
    thermal = f"<plugin filename='gz-sim-thermal-system' name='gz::sim::systems::Thermal'>{picture}</plugin>"
    shape = "<geometry><box><size>1 1 1</size></box></geometry>"
    return (
        f"<model name='{name}'><static>true</static><link name='l'><visual name='v'>{shape}{thermal}</visual></link>"
        "</model>"
    )


def test_a_converted_world_brings_its_heat_signatures(here: Path) -> None:
    cv2.imwrite(str(here / "a.png"), np.full((2, 2, 3), 128, np.uint8))
    text = (
        f"<sdf version='1.9'><world name='w'>{heated('near', '<heat_signature>a.png</heat_signature>')}</world></sdf>"
    )
    (here / "w.sdf").write_text(text)
    (here / "out").mkdir()
    assert run("convert", "w.sdf", "-o", "out/v.sdf").exit_code == 0
    assert run("convert", "w.sdf", "-o", "as_it_was.sdf", "--keep-uris").exit_code == 0
    assert "<heat_signature>a.png</heat_signature>" in (here / "as_it_was.sdf").read_text()
    (here / "a.png").unlink()
    with simkit.load("out/v.sdf") as sim:
        assert not [d for d in sim.diagnostics if d.code == "SK-SENSOR-142"]
        assert [name for name, _ in sim.contents.temperatures.items()] == ["near::l::v"]


def test_a_vendored_world_brings_its_heat_signatures(here: Path) -> None:
    store = here / "store" / "oven"
    for folder in (store / "textures", here / "worlds" / "warm"):
        folder.mkdir(parents=True)
        for name in ("a.png", "b.png"):
            cv2.imwrite(str(folder / name), np.full((2, 2, 3), 128, np.uint8))
    (store / "model.config").write_text("<model><name>oven</name><sdf version='1.9'>m.sdf</sdf></model>")
    inside = heated("oven", "<heat_signature>textures/a.png</heat_signature>")
    (store / "m.sdf").write_text(f"<sdf version='1.9'>{inside}</sdf>")
    others = (
        heated("near", "<heat_signature> warm/a.png </heat_signature>"),
        heated("far", "<heat_signature>model://oven/textures/b.png</heat_signature>"),
    )
    include = "<include><uri>model://oven</uri></include>"
    text = f"<sdf version='1.9'><world name='w'>{include}{''.join(others)}</world></sdf>"
    (here / "worlds" / "w.sdf").write_text(text)
    assert run("vendor", "worlds/w.sdf", "box", "--resource-path", "store").exit_code == 0
    (here / "store").rename(here / "gone")
    (here / "worlds").rename(here / "elsewhere")
    with simkit.load("box/w.sdf") as sim:
        assert not [d for d in sim.diagnostics if d.code == "SK-SENSOR-142"]
        pictures = {name: found.picture.relative_to(here / "box") for name, found in sim.contents.temperatures.items()}
    assert {name: str(path) for name, path in pictures.items()} == {
        "oven::l::v": "models/oven/textures/a.png",
        "near::l::v": "warm/a.png",
        "far::l::v": "models/oven/textures/b.png",
    }


def test_a_vendored_xacro_is_expanded(here: Path) -> None:
    (here / "r.urdf.xacro").write_text(
        "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:arg name='mass' default='1'/>"
        "<link name='a'><inertial><mass value='$(arg mass)'/>"
        "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link></robot>"
    )
    assert run("vendor", "r.urdf.xacro", "box", "--xacro-arg", "mass=3").exit_code == 0
    assert simkit.describe("box/r.urdf")["totals"]["mass"] == 3


def test_a_folder_that_is_not_empty_is_left_alone(here: Path) -> None:
    (here / "box").mkdir()
    (here / "box" / "mine.txt").write_text("mine")
    refused = run("vendor", "arm_description/urdf/arm.urdf", "box")
    assert refused.exit_code == 2
    assert "SK-CLI-016" in refused.stderr
    assert [p.name for p in (here / "box").iterdir()] == ["mine.txt"]


def test_the_meshes_of_another_output_with_the_same_stem_are_not_replaced_unasked(here: Path) -> None:
    assert run("convert", "arm_description/urdf/arm.urdf", "-o", "arm.xml").exit_code == 0
    refused = run("convert", "arm_description/urdf/arm.urdf", "-o", "arm.mjcf")
    assert refused.exit_code == 2 and "give the output another name" in refused.stderr
    assert not (here / "arm.mjcf").exists()


def test_an_mjcf_file_whose_path_is_not_text_is_refused(here: Path) -> None:
    before = sorted(here.rglob("*"))
    refused = run("convert", "arm_description/urdf/arm.urdf", "-o", "a\udcff.xml")
    assert refused.exit_code == 2
    assert "SK-CLI-016 cannot write a\\udcff.xml: MuJoCo needs a path that is valid text" in refused.stderr
    assert sorted(here.rglob("*")) == before


def test_a_vendored_world_without_one_of_its_models_says_so(here: Path) -> None:
    (here / "w.sdf").write_text(
        "<sdf version='1.9'><world name='w'><include><uri>model://sun</uri></include>\n"
        "<include><uri>https://fuel.gazebosim.org/1.0/openrobotics/models/none</uri></include></world></sdf>"
    )
    result = run("vendor", "w.sdf", "box")
    assert result.exit_code == 0
    assert "w.sdf:2: warning SK-URI-002" in result.stderr and "simkit fetch w.sdf" in result.stderr


def test_a_world_with_errors_leaves_nothing_behind(here: Path) -> None:
    (here / "w.sdf").write_text(
        "<sdf version='1.9'><world name='w'><include><uri>model://none</uri></include></world></sdf>"
    )
    before = sorted(here.iterdir())
    assert run("vendor", "w.sdf", "box").exit_code == 2
    assert sorted(here.iterdir()) == before


OWN = """<sdf version="1.9"><world name="w"><gazebo_quirks>1</gazebo_quirks>
  <entity_services>classic</entity_services><scene><quality>high</quality><renderer>software</renderer></scene>
<light name="sun" type="directional"><irradiance>900</irradiance></light>
<model name="m"><link name="l">
<sensor name="imu" type="imu"><update_rate>100</update_rate><phase>0.001</phase><jitter>0.002</jitter>
  <simkit:latency>0.01</simkit:latency><latency_jitter>0.004</latency_jitter><set_rate_topic>r</set_rate_topic>
  <imu><simkit:orientation><noise type="gaussian"><stddev>0.1</stddev></noise></simkit:orientation><angular_velocity><x>
  <noise type="gaussian"><noise_density>0.1</noise_density><bias_instability>0.2</bias_instability>
  <random_walk>0.3</random_walk><correlation_time>4</correlation_time></noise></x></angular_velocity></imu></sensor>
<sensor name="sonar" type="sonar"><sonar><axis>1 0 0</axis><noise type="gaussian"><stddev>0.1</stddev></noise></sonar>
</sensor><sensor name="field" type="magnetometer"><magnetometer><date>2026.5</date></magnetometer></sensor>
<sensor name="lds" type="ray"><preset>LDS-01</preset><sweep>true</sweep><point_layout>ouster</point_layout>
  <scan_pattern><samples>9</samples><rosette><rate_1>7</rate_1><rate_2>3</rate_2><deflection_1>0.1</deflection_1>
  <deflection_2>0.2</deflection_2></rosette></scan_pattern>
  <dropout><probability>0.1</probability></dropout><signal><range>3</range></signal><intensity/><glass_and_mirrors/>
  <range_error><bias>0.01</bias></range_error><no_return><value>zero</value></no_return><sun/>
  <beam><divergence>0.01</divergence></beam><blind_zone><range>0.2</range></blind_zone></sensor>
<sensor name="eye" type="depth_camera"><camera><image><width>8</width><height>6</height></image>
  <disparity_noise><baseline>0.05</baseline><stddev>0.1</stddev></disparity_noise></camera>
  <depth_error><scale>-0.01</scale></depth_error><depth_holes><probability>0.1</probability></depth_holes>
  <flying_pixels/><multipath/><occlusion_shadow><baseline>0.05</baseline></occlusion_shadow>
  <phase_wrap><range>50</range></phase_wrap><lost_depth><value>nan</value></lost_depth></sensor>
<sensor name="colour" type="camera"><update_rate>30</update_rate>
  <camera><image><width>8</width><height>6</height></image></camera>
  <shutter><exposure>0.01</exposure></shutter><vignetting/><exposure_control/><image_sensor/><white_balance/><tone_curve/>
</sensor>
<sensor name="mems" type="imu"><bandwidth><angular_velocity>40</angular_velocity></bandwidth><calibration_error>
  <angular_velocity><scale>0 0 0.01</scale></angular_velocity></calibration_error><saturation>
  <linear_acceleration>40</linear_acceleration></saturation><clock><offset>0.1</offset></clock>
  <gaps><probability>0.1</probability></gaps><latency_histogram><values>0.01</values></latency_histogram></sensor>
<sensor name="gps" type="navsat"><outages><window>1 2</window></outages><multipath><stddev>1</stddev></multipath>
  <fix_types><fix><status>sbas</status></fix></fix_types></sensor>
<sensor name="solar" type="custom" gz:type="solar"><update_rate>50</update_rate><solar><normal>0 0 1</normal></solar>
</sensor><collision name="c"><geometry><box><size>1 1 1</size></box></geometry><reflectivity>0.1</reflectivity>
<transmittance>0.2</transmittance><specularity>0.3</specularity></collision></link>
<link name="k"/><joint name="j" type="revolute"><parent>l</parent><child>k</child><axis/>
<sensor name="e" type="custom" gz:type="encoder"><encoder><resolution>0.001</resolution></encoder></sensor></joint>
<link name="o"/><joint name="i" type="revolute"><parent>l</parent><child>o</child><axis/></joint>
<plugin filename="user" name="user"><latency>1</latency><sensor><phase>0</phase></sensor>
<on_error>disable</on_error></plugin>
<plugin filename="libgazebo_ros_diff_drive.so" name="d"><left_joint>j</left_joint><right_joint>i</right_joint>
<odometry_noise><wheel_variance>1e-4</wheel_variance></odometry_noise>
<actuation_error><forward_error>0.1</forward_error></actuation_error></plugin>
<plugin filename="gz-sim-joint-trajectory-controller-system" name="t"><interpolation>cubic</interpolation></plugin>
<plugin filename="libgazebo_ros_joint_pose_trajectory.so" name="p"><point_times>from_start</point_times></plugin>
<plugin filename="gz-sim-pose-publisher-system" name="gz::sim::systems::PosePublisher">
<pose_type>geometry_msgs/msg/Pose</pose_type></plugin>
<plugin filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin">
<parameters>c.yaml</parameters><controllers>b</controllers>
<ros2_control name="h" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
<joint name="j"><command_interface name="effort"/><state_interface name="position"/></joint></ros2_control></plugin>
</model>
<actor name="a"><person><height>1.7</height></person></actor>
<plugin filename="gz-sim-python-system-loader-system" name="gz::sim::systems::PythonSystemLoader">
<module_name>absent</module_name><shadow_gz>true</shadow_gz></plugin></world></sdf>"""


@pytest.mark.slow
def test_elements_of_our_own_come_out_with_their_prefix_and_mean_the_same(here: Path) -> None:
    Path("own.sdf").write_text(OWN)
    broadcaster = "joint_state_broadcaster/JointStateBroadcaster"
    Path("c.yaml").write_text(f"controller_manager: {{ros__parameters: {{b: {{type: {broadcaster}}}}}}}\n")
    assert run("convert", "own.sdf", "-o", "again.sdf").exit_code == 0
    root = ElementTree.parse("again.sdf").getroot()
    ours = {e.tag.removeprefix("{urn:simkit}") for e in root.iter() if e.tag.startswith("{urn:simkit}")}
    assert ours == {name for names in OWN_ELEMENTS.values() for name in names}
    bare = {f"{parent.tag}/{child.tag}" for parent in root.iter() for child in parent if child.tag in ours}
    # what the format has itself, what is inside one of our own, and what a plugin of others has
    assert bare == {"joint/axis", "x/noise", "{urn:simkit}orientation/noise", "plugin/latency", "sensor/phase"}
    assert messages("again.sdf") == messages("own.sdf")


def messages(path: str) -> dict[str, list[bytes]]:
    heard: dict[str, list[bytes]] = {}
    Path("absent.py").write_text("class Quiet:\n    def reset(self, *_): pass\nget_system = Quiet\n")
    with simkit.load(path, seed=3, plugin_paths=["."]) as sim:
        for sensor in sim.contents.sensors.values():
            sim.communication.bus.tap(
                sensor.topic, lambda m, n=sensor.scoped: heard.setdefault(n, []).append(msgs.serialize(m))
            )
        sim.run(0.1)
    return heard


@pytest.mark.parametrize(
    "page",
    [*sorted((ROOT / "docs/sensors").glob("*.md")), *sorted((ROOT / "packs/special_cameras/docs").glob("*.md"))],
    ids=lambda p: p.name,
)
def test_a_page_gives_the_prefix_to_what_is_written_with_it(page: Path) -> None:
    named = set(re.findall(r"<simkit:(\w+)>", page.read_text(encoding="utf-8")))
    # what a solar sensor looks at is inside one of our own; its plugin has the same elements
    inside = {"angular_noise", "falloff", "field_of_view", "irradiance", "normal", "panel", "shadow", "towards"}
    inside |= {"rotation", "rpy_noise"}
    assert named - (inside if page.name == "solar.md" else set()) <= set().union(*OWN_ELEMENTS.values())


def test_the_frame_of_a_direction_of_friction_is_written_back(tmp_path: Path) -> None:
    """Also one of a `<frame>`: it comes out in the link that the frame moves with."""
    rubs = '<surface><friction><ode><mu>1</mu><mu2>0</mu2><fdir1 gz:expressed_in="{1}">1 -1 0</fdir1></ode></friction>'
    wheel = (
        '<link name="{0}"><collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry>'
        f"{rubs}</surface></collision></link><joint name='{{0}}_joint' type='continuous'><parent>base</parent>"
        "<child>{0}</child></joint>"
    )
    source, out = tmp_path / "base.sdf", tmp_path / "out.sdf"
    source.write_text(
        '<sdf version="1.9"><model name="robot" xmlns:gz="http://gazebosim.org/schema"><link name="base"/>'
        '<frame name="rollers" attached_to="base"><pose>0 0 0 0 0 1.5707963267948966</pose></frame>'
        f"{wheel.format('left', 'base')}{wheel.format('right', 'rollers')}</model></sdf>"
    )
    assert run("convert", source, "-o", out).exit_code == 0
    directions = list(ElementTree.parse(out).iter("fdir1"))
    assert [found.get("{http://gazebosim.org/schema}expressed_in") for found in directions] == ["base", "base"]
    turned = [float(number) for number in (directions[1].text or "").split()]
    assert turned == pytest.approx([1.0, 1.0, 0.0])
