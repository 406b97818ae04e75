"""Systems that a file lists for Gazebo's server, and the known names of the catalogue."""

from __future__ import annotations

import itertools
import pathlib
from collections.abc import Iterator

import pytest
from lxml import etree
from plugin_worlds import GROUND, rover, world

import simkit
from simkit.params import Params
from simkit.plugins.discovery.find_plugin_class import GAZEBO_PLUGINS, find_plugin, plugin_kinds
from simkit.plugins.plugin_names import aliases, normalise
from simkit.scene import ScenePlugin

SYSTEMS = {
    # in the world, or where a robot's file has them; what they do is done anyway
    "physics": "Physics",
    "user-commands": "UserCommands",
    "scene-broadcaster": "SceneBroadcaster",
    "sensors": "Sensors",
    "imu": "Imu",
    "contact": "Contact",
    "forcetorque": "ForceTorque",
    # on a model
    "diff-drive": "DiffDrive",
    "joint-state-publisher": "JointStatePublisher",
    "joint-position-controller": "JointPositionController",
    "joint-controller": "JointController",
    "joint-trajectory-controller": "JointTrajectoryController",
    "apply-joint-force": "ApplyJointForce",
    "velocity-control": "VelocityControl",
    "odometry-publisher": "OdometryPublisher",
    "pose-publisher": "PosePublisher",
}
"""The systems that a robot's world cannot do without: part of the library's name -> the class."""

CLASSIC = {
    "sensor": "camera ray_sensor imu_sensor bumper laser gpu_laser block_laser openni_kinect depth_camera range",
    "model": "diff_drive joint_state_publisher planar_move p3d ft_sensor joint_pose_trajectory force skid_steer_drive "
    "imu f3d",
}
"""Parent -> libraries `libgazebo_ros_<name>.so` of ROS 1 or ROS 2 without which its robots do nothing."""

LIBRARIES = (
    "gz-sim-{}-system",
    "libgz-sim-{}-system.so",
    "gz-sim8-{}-system",
    "libgz-sim7-{}-system.so.7.1.0",
    "libgz-sim9-{}-system.dylib",
    "ignition-gazebo-{}-system",
    "libignition-gazebo-{}-system.so",
    "ignition-gazebo6-{}-system",
    "libignition-gazebo3-{}-system.so.3",
    "/usr/lib/gz-sim-8/plugins/libgz-sim-{}-system.so",
)
CLASSES = ("gz::sim::systems::{}", "ignition::gazebo::systems::{}", "gz::sim::v8::systems::{}")


def found(filename: str, name: str = "mine", parent: str = "any") -> str:
    plugin = ScenePlugin(name, filename, "robot", Params("plugin"))
    cls = find_plugin(plugin, parent=parent)  # type: ignore[arg-type]
    return cls.__name__ if cls else ""


@pytest.mark.parametrize("part", SYSTEMS)
def test_a_system_is_known_by_every_spelling_of_its_library_and_of_its_class(part: str) -> None:
    libraries = {found(spelling.format(part)) for spelling in LIBRARIES}
    classes = {found("my.so", spelling.format(SYSTEMS[part])) for spelling in CLASSES}
    assert len(libraries | classes) == 1, f"{libraries} {classes}"
    assert libraries != {""}


@pytest.mark.parametrize(
    ("parent", "name"), [(parent, name) for parent, names in CLASSIC.items() for name in names.split()]
)
def test_a_plugin_of_gazebo_classic_is_known_on_the_same_parent_as_in_classic(parent: str, name: str) -> None:
    assert found(f"libgazebo_ros_{name}.so", parent=parent)
    assert found(f"gazebo_ros_{name}", parent=parent)


def test_systems_of_the_server_may_be_in_the_world_and_in_a_model() -> None:
    parts = list(SYSTEMS)[:7]
    for part, parent in itertools.product(parts, ("world", "model")):
        assert found(f"gz-sim-{part}-system", parent=parent), (part, parent)


def test_no_two_kinds_have_the_same_name() -> None:
    """Check that the registry rejects duplicates; the registry does so too, but without a test's message."""
    assert len({normalise(name) for name in plugin_kinds()}) == len(plugin_kinds())


def plugin(part: str, inner: str = "") -> str:
    return f"<plugin name='gz::sim::systems::{SYSTEMS[part]}' filename='gz-sim-{part}-system'>{inner}</plugin>"


def notes(source: str) -> list[str]:
    with simkit.load(source) as sim:
        sim.step(3)
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        return [d.message for d in sim.diagnostics if d.code == "SK-PLUGIN-005"]


def test_an_unneeded_system_is_a_note_and_changes_nothing() -> None:
    parts = list(SYSTEMS)[:7]
    messages = notes(world(*(plugin(part) for part in parts), GROUND, rover()))
    assert [m.split("'")[1] for m in messages] == [SYSTEMS[part] for part in parts]
    assert all("is not needed" in m and "not used" not in m for m in messages)


def test_the_note_lists_unused_parameters() -> None:
    engine = "<engine><filename>gz-physics-bullet-plugin</filename></engine><contacts/>"
    (messages,) = notes(world(plugin("physics", engine), GROUND))
    assert messages.endswith("; not used: <contacts>, <engine>")


@pytest.mark.parametrize(
    ("library", "kind"), [("RayPlugin", "ray"), ("ContactPlugin", "contact"), ("ImuSensorPlugin", "imu")]
)
def test_the_empty_plugins_of_classics_sensors_are_not_needed(library: str, kind: str) -> None:
    inner = {
        "ray": "<ray><scan><horizontal><samples>3</samples><min_angle>-1</min_angle><max_angle>1</max_angle>"
        "</horizontal></scan><range><min>0.1</min><max>5</max></range></ray>",
        "contact": "<contact><collision>c</collision></contact>",
        "imu": "",
    }[kind]
    body = "<collision name='c'><geometry><sphere><radius>1</radius></sphere></geometry></collision>"
    sensor = f"<sensor name='s' type='{kind}'>{inner}<plugin name='p' filename='lib{library}.so'/></sensor>"
    source = world(f"<model name='m'><static>true</static><link name='l'>{body}{sensor}</link></model>")
    (messages,) = notes(source)
    assert f"'lib{library}.so' is not needed" in messages
    with simkit.load(source) as sim:
        assert sim.sensor("m::l::s").topic in sim.topics()


# ------------------------------------------------------------------ what real files name

CORPUS = pathlib.Path(__file__).resolve().parents[3] / "shared"
STRANGERS = {
    # libraries of their authors' own, which no simulator but theirs has
    "gazebo_tutorials",
    "move_model_test",
    "obstacles",
    "solar_sensor",
    # of files that test a parser
    "dummy",
    "name",  # test/file/name
}


def plugins_of(path: pathlib.Path) -> Iterator[tuple[str, str]]:
    """Return library and name of each plugin of a file, except those of Gazebo's GUI."""
    try:
        root = etree.parse(path, etree.XMLParser(recover=True, resolve_entities=False, no_network=True)).getroot()
    except (etree.XMLSyntaxError, OSError):
        return
    for element in root.iter("plugin") if root is not None else ():
        if not any(ancestor.tag == "gui" for ancestor in element.iterancestors()) and "filename" in element.attrib:
            yield element.get("filename"), element.get("name", "")


@pytest.mark.skipif(not CORPUS.is_dir(), reason="needs the files in ../shared")
def test_every_plugin_in_real_files_is_supported_or_listed_as_gazebos() -> None:
    files = [p for part in ("corpus", "course", "conformance") for p in (CORPUS / part).rglob("*") if p.is_file()]
    named = {
        one
        for path in files
        if path.suffix in {".sdf", ".world", ".model", ".urdf", ".xacro"}
        for one in plugins_of(path)
    }
    assert len(named) > 60
    unknown = set()
    for filename, name in named:
        spellings = aliases(ScenePlugin(name, filename, "m", Params("plugin")))
        if not any(spelling in plugin_kinds() or spelling in GAZEBO_PLUGINS for spelling in spellings):
            unknown.add(normalise(filename))
    assert unknown <= STRANGERS
