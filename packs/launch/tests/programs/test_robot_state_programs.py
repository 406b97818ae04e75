"""Known programs for transforms: `robot_state_publisher`, `joint_state_publisher`, `static_transform_publisher`."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import pytest

import simkit
from simkit import Simulation
from simkit.testing.scenarios.scenario_run import open_scenario

FOLDER = Path(__file__).with_name("worlds")
WORLD = (FOLDER / "field.sdf").read_text()
ROBOT = (FOLDER / "cart.urdf").read_text()

STATES = "robot_state_publisher/robot_state_publisher"
JOINTS = "joint_state_publisher/joint_state_publisher"
STATIC = "tf2_ros/static_transform_publisher"
MIMIC = """<robot name="gripper"><link name="palm"/><link name="left"/><link name="right"/>
<joint name="open" type="prismatic"><parent link="palm"/><child link="left"/><axis xyz="0 1 0"/>
<limit lower="0.1" upper="0.3" effort="1" velocity="1"/></joint>
<joint name="follow" type="prismatic"><parent link="palm"/><child link="right"/><axis xyz="0 2 0"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="open" multiplier="-2" offset="0.05"/></joint>
</robot>"""
MODEL = """<sdf version="1.9"><model name="arm"><link name="base"/><link name="tip"><pose>0 0 1 0 0 0</pose>
<visual name="v"><geometry><mesh><uri>model://missing/mesh.dae</uri></mesh></geometry></visual></link>
<joint name="turn" type="revolute"><pose>0 0 -1 0 0 0</pose><parent>base</parent><child>tip</child>
<axis><xyz>1 0 0</xyz></axis></joint></model></sdf>"""


@pytest.fixture
def sim() -> Iterator[Simulation]:
    with simkit.load(WORLD) as simulation:
        simulation.tf.frames()  # transforms are received from now on
        yield simulation


def test_the_description_is_published_for_late_subscribers(sim: Simulation) -> None:
    node = sim.add_node(STATES, params={"robot_description": ROBOT})
    sim.run(0.1)
    assert sim.subscribe("/robot_description").latest.data == ROBOT
    assert node.log == ["[INFO] [0.000000000] [robot_state_publisher]: Robot initialized"]


def test_transforms_follow_the_joints_and_agree_with_those_of_the_simulation(sim: Simulation) -> None:
    remap = {"joint_states": "/world/field/model/cart/joint_state"}
    node = sim.add_node(STATES, params={"robot_description": ROBOT}, remap=remap)
    sim.add_node("ros_gz_sim/create", args=["-topic", "robot_description"])
    transforms = sim.subscribe("/tf")
    sim.run(0.1)
    sim.publish("/model/cart/cmd_vel", {"linear": {"x": 0.3}})
    sim.run(1.0)
    robot = sim.models["cart"]
    parts = [robot.link(name).pose for name in ("base_footprint", "left_wheel", "laser")]
    assert len(transforms.messages) in range(21, 24)  # 20 Hz, although the joint states come in every step
    assert node.hand_overs < 60
    latest = transforms.latest.transforms[0].header.stamp
    lag = sim.time - latest.sec - latest.nanosec * 1e-9
    for name, pose in zip(("left_wheel", "laser"), parts[1:], strict=True):
        found, true = sim.tf.lookup("base_footprint", name), parts[0].inverse() @ pose
        assert found.position == pytest.approx(true.position, abs=1e-6)
        turned = 2 * math.acos(min(1.0, abs(float((found.inverse() @ true).quaternion[0]))))
        assert turned <= 3.5 * lag + 1e-6  # the wheel turns by 3 rad/s


def test_frame_prefix_mimic_joints_and_states_with_old_stamps(sim: Simulation) -> None:
    sim.add_node(STATES, params={"robot_description": MIMIC, "frame_prefix": "r/", "publish_frequency": 10.0})
    sim.run(1.0)
    out = sim.subscribe("/tf")
    state = {"header": {"stamp": {"sec": 1}}, "name": ["open"], "position": [0.2]}
    joints = sim.advertise("/joint_states", "sensor_msgs/msg/JointState")
    joints.publish(state)
    sim.run(0.01)
    joints.publish(state)  # its stamp is not later, so nothing is published
    sim.run(0.01)
    (message,) = out.messages
    found = {each.child_frame_id: each for each in message.transforms}
    assert {each.header.frame_id for each in message.transforms} == {"r/palm"}
    assert found["r/left"].transform.translation.y == pytest.approx(0.2)
    assert found["r/right"].transform.translation.y == pytest.approx(-0.35)


def test_the_description_and_the_prefix_may_be_parameters_of_ros_1(sim: Simulation) -> None:
    parameters = {"/r1/robot_description": MIMIC, "/r1/states/tf_prefix": "r1", "/r1/joints/rate": 50}
    sim.set_ros_parameters(parameters)
    sim.add_node(STATES, name="states", namespace="/r1", remap={"/tf": "/tf"})
    sim.add_node(JOINTS, name="joints", namespace="/r1")
    states = sim.subscribe("/r1/joint_states")
    sim.run(1.0)
    assert sim.tf.lookup("r1/palm", "r1/left").position[1] == pytest.approx(0.2)
    assert len(states.messages) in range(48, 52)


def test_a_model_in_sdf_has_frames_although_a_mesh_is_missing(sim: Simulation) -> None:
    sim.add_node(STATES, params={"robot_description": MODEL, "ignore_timestamp": True})
    sim.run(0.1)
    sim.advertise("/joint_states", "sensor_msgs/msg/JointState").publish({"name": ["turn"], "position": [1.0]})
    sim.run(0.1)
    assert sim.tf.lookup("base", "tip").rpy[0] == pytest.approx(1.0)
    assert sim.tf.lookup("base", "tip").position == pytest.approx([0, 0, 1])


def test_a_description_that_is_empty_or_wrong_ends_the_program(sim: Simulation) -> None:
    empty = sim.add_node(STATES)
    wrong = sim.add_node(STATES, params={"robot_description": "<robot><joint"})
    sim.run(0.1)
    assert empty.exit_code == wrong.exit_code == 1
    assert "robot_description parameter must not be empty" in empty.log[-1]
    assert "the robot description is not valid XML" in wrong.log[-1]


def test_joints_rest_at_zero_within_their_limits_and_mimic_joints_follow(sim: Simulation) -> None:
    sim.add_node(STATES, params={"robot_description": MIMIC})
    sim.add_node(JOINTS, params={"rate": 20})
    states = sim.subscribe("/joint_states")
    sim.run(1.0)
    assert len(states.messages) in range(19, 22)
    assert dict(zip(states.latest.name, states.latest.position, strict=True)) == pytest.approx(
        {"open": 0.2, "follow": -0.35}
    )


def test_joint_states_of_a_source_replace_those_at_rest_and_zeros_can_be_given(sim: Simulation) -> None:
    sim.add_node(JOINTS, params={"robot_description": ROBOT, "source_list": ["wheels"], "zeros.left_joint": 0.7})
    states = sim.subscribe("/joint_states")
    sim.run(0.2)
    assert list(states.latest.position) == [0.7, 0.0]
    sim.advertise("/wheels", "sensor_msgs/msg/JointState").publish({"name": ["right_joint"], "position": [2.0]})
    sim.run(0.2)
    assert list(states.latest.position) == [0.7, 2.0]


def test_joint_states_from_two_sides_are_reported(sim: Simulation) -> None:
    sim.add_node(STATES, params={"robot_description": ROBOT})
    sim.add_node("ros_gz_sim/create", args=["-topic", "robot_description"])
    rule = "/world/field/model/cart/joint_state@sensor_msgs/msg/JointState[gz.msgs.Model"
    sim.add_node("ros_gz_bridge/parameter_bridge", args=[rule], remap={rule.partition("@")[0]: "/joint_states"})
    sim.add_node(JOINTS)
    sim.run(1.0)
    assert [report.code for report in sim.diagnostics].count("SK-LAUNCH-063") == 1


@pytest.mark.parametrize(
    ("words", "yaw"),
    [
        ("1 2 3 0.5 0 0 map odom", 0.5),
        ("1 2 3 0 0 0 1 map odom", 0.0),
        ("1 2 3 0.5 0 0 map odom 100", 0.5),
        ("--x 1 --y 2 --z 3 --yaw 0.5 --frame-id map --child-frame-id odom", 0.5),
        ("--child-frame-id odom --frame-id map --x 1 --y 2 --z 3 --qz 1 --qw 0", math.pi),
    ],
)
def test_a_static_transform_has_old_and_new_arguments(sim: Simulation, words: str, yaw: float) -> None:
    sim.add_node(STATIC, args=words.split())
    sim.run(0.1)
    pose = sim.tf.lookup("map", "odom")
    assert pose.position == pytest.approx([1, 2, 3])
    assert math.cos(pose.rpy[2] - yaw) == pytest.approx(1)


def test_a_static_transform_of_a_component_has_parameters(sim: Simulation) -> None:
    params = {"translation.x": 1.0, "frame_id": "map", "child_frame_id": "odom"}
    sim.add_node("tf2_ros/tf2_ros::StaticTransformBroadcasterNode", params=params)
    sim.run(0.1)
    assert sim.tf.lookup("map", "odom").position == pytest.approx([1, 0, 0])


def test_a_static_transform_needs_two_frames(sim: Simulation) -> None:
    same = sim.add_node(STATIC, args=["0", "0", "0", "0", "0", "0", "map", "map"])
    none = sim.add_node(STATIC, args=["--frame-id", "map"])
    sim.run(0.1)
    assert (same.exit_code, none.exit_code) == (1, 2)
    assert "cannot publish static transform from 'map' to 'map'" in same.log[-1]


def test_a_launch_file_without_a_simulator_shows_the_robot(tmp_path: Path) -> None:
    file = tmp_path / "show.launch.py"
    node = "launch_ros.actions.Node(package='{0}', executable='{0}', parameters=[{1}])"
    nodes = [
        node.format("robot_state_publisher", repr({"robot_description": ROBOT})),
        node.format("joint_state_publisher", {"zeros.left_joint": 0.7}),
    ]
    file.write_text(
        "import launch\nimport launch_ros.actions\n\n\ndef generate_launch_description():\n"
        f"    return launch.LaunchDescription([{', '.join(nodes)}])\n"
    )
    with open_scenario(simkit.launch(file)) as shown:
        shown.tf.frames()
        shown.run(2.0)
        model = shown.model("cart")
        assert shown.joint("cart::left_joint").position == pytest.approx(0.7, abs=1e-6)
        assert model.pose.position == pytest.approx([0, 0, 0], abs=1e-6)
        assert shown.tf.lookup("base_footprint", "left_wheel").position == pytest.approx([0, 0.15, 0.1])
        assert "world" not in shown.tf.frames()
        assert "SK-LAUNCH-064" in [report.code for report in shown.diagnostics]
