"""The drive of the Kobuki base in Gazebo Classic: wheels, timeout, odometry, and options without effect."""

from __future__ import annotations

import math

import pytest
from plugin_worlds import GROUND, element, world

import simkit

TOPIC = "/mobile_base/commands/velocity"
WHEEL = """<link name='{s}'><pose>0 {y} 0.035 -1.5707963267948966 0 0</pose><inertial><mass>0.1</mass>
<inertia><ixx>1e-3</ixx><iyy>1e-3</iyy><izz>1e-3</izz></inertia></inertial>
<collision name='c'><geometry><sphere><radius>0.035</radius></sphere></geometry></collision></link>
<joint name='wheel_{s}_joint' type='continuous'><parent>base</parent><child>{s}</child><axis><xyz>0 0 1</xyz></axis>
</joint>"""


def kobuki(**values: object) -> simkit.Simulation:
    """Load a base of 2.4 kg on two wheels, 0.23 m apart."""
    settings = {
        "left_wheel_joint_name": "wheel_left_joint", "right_wheel_joint_name": "wheel_right_joint",
        "wheel_separation": 0.23, "wheel_diameter": 0.07, "torque": 1.0, "velocity_command_timeout": 0.6, **values,
    }  # fmt: skip
    base = """<link name='base'><pose>0 0 0.05 0 0 0</pose><inertial><pose>0 0 -0.04 0 0 0</pose><mass>2.4</mass>
    <inertia><ixx>0.02</ixx><iyy>0.02</iyy><izz>0.04</izz></inertia></inertial></link>"""
    wheels = "".join(WHEEL.format(s=s, y=y) for s, y in (("left", 0.115), ("right", -0.115)))
    plugin = element("plugin", settings, "name='kobuki' filename='libgazebo_ros_kobuki.so'")
    return simkit.load(world(GROUND, f"<model name='kobuki'>{base}{wheels}{plugin}</model>", step=0.002))


def test_the_base_drives_on_the_topic_of_the_kobuki_and_publishes_odometry() -> None:
    with kobuki(publish_tf=1) as sim:
        odometry = sim.subscribe("/odom", keep=1)
        for _ in range(4):
            sim.publish(TOPIC, {"linear": {"x": 0.2}, "angular": {"z": 0.5}})
            sim.run(0.5)
        pose = sim.model("kobuki").pose
        message = odometry.messages[-1]
        assert {"/tf", "/joint_states"} <= set(sim.topics())
    assert pose.rpy[2] == pytest.approx(1.0, abs=0.02)
    assert pose.position[0] == pytest.approx(0.4 * math.sin(1.0), abs=0.02)
    assert [message.pose.pose.position.x, message.pose.pose.position.y] == pytest.approx(pose.position[:2], abs=0.01)
    assert message.pose.covariance[0] == 0.1 and message.header.frame_id == "odom"


def test_the_base_stops_after_the_timeout_of_the_command() -> None:
    with kobuki() as sim:
        sim.publish(TOPIC, {"linear": {"x": 0.2}})
        sim.run(1.0)
        place = sim.model("kobuki").pose.position
        sim.run(1.0)
        assert sim.model("kobuki").pose.position == pytest.approx(place, abs=1e-3)
        assert place[0] == pytest.approx(0.12, abs=0.01)


def test_a_sensor_that_the_model_does_not_have_is_an_error() -> None:
    with pytest.raises(simkit.InputError, match=r"SK-PLUGIN-003: model 'kobuki' has no contact sensor 'bumpers'"):
        kobuki(bumper_name="bumpers")


def test_without_power_the_motors_stop_and_wait_for_the_next_command() -> None:
    with kobuki(velocity_command_timeout=10) as sim:
        sim.publish(TOPIC, {"linear": {"x": 0.2}})
        sim.run(0.5)
        sim.publish("/mobile_base/commands/motor_power", {"state": 0})
        sim.run(0.5)
        place = sim.model("kobuki").pose.position[0]
        sim.publish("/mobile_base/commands/motor_power", {"state": 1})
        sim.run(0.5)
        assert sim.model("kobuki").pose.position[0] == pytest.approx(place, abs=1e-3)
        sim.publish(TOPIC, {"linear": {"x": 0.2}})
        sim.run(0.5)
        assert sim.model("kobuki").pose.position[0] == pytest.approx(place + 0.1, abs=0.01)


def test_a_message_sets_the_pose_of_the_odometry_to_zero() -> None:
    with kobuki() as sim:
        odometry = sim.subscribe("/odom", keep=1)
        sim.publish(TOPIC, {"linear": {"x": 0.2}, "angular": {"z": 0.5}})
        sim.run(0.5)
        place = odometry.messages[-1].pose.pose.position
        assert math.hypot(place.x, place.y) == pytest.approx(0.1, abs=0.01)
        sim.publish("/mobile_base/commands/reset_odometry", {})
        sim.step()
        pose = odometry.messages[-1].pose.pose
        assert math.hypot(pose.position.x, pose.position.y) < 1e-3 and abs(pose.orientation.z) < 1e-3


def test_the_prefix_of_the_topics_can_be_empty() -> None:
    with kobuki(base_prefix="") as sim:
        sim.publish("/commands/velocity", {"linear": {"x": 0.2}})
        sim.run(0.5)
        assert sim.model("kobuki").pose.position[0] == pytest.approx(0.1, abs=0.01)
