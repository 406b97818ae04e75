"""Four driven wheels: gz's DiffDrive with several joints per side, and ROS 1's skid steering."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from plugin_worlds import GROUND, element, stamps, world, xyz, yaw

import simkit

ENDS = (("front", 0.15), ("rear", -0.15))


def four_wheeler(plugin: str, pose: str = "0 0 0 0 0 0") -> str:
    """A box of 4 kg on four round wheels of 0.1 m, 0.4 m apart, 0.3 m from axle to axle."""
    parts = [
        "<link name='base'><pose>0 0 0.15 0 0 0</pose><inertial><mass>4</mass><inertia><ixx>0.05</ixx><iyy>0.05</iyy>"
        "<izz>0.05</izz></inertia></inertial></link>"
    ]
    for side, y in (("left", 0.2), ("right", -0.2)):
        for end, x in ENDS:
            name = f"{side}_{end}"
            parts.append(
                f"<link name='{name}'><pose>{x} {y} 0.1 -1.5707963267948966 0 0</pose><inertial><mass>0.5</mass>"
                "<inertia><ixx>0.002</ixx><iyy>0.002</iyy><izz>0.002</izz></inertia></inertial>"
                "<collision name='c'><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link>"
                f"<joint name='{name}_joint' type='continuous'><parent>base</parent><child>{name}</child>"
                "<axis><xyz>0 0 1</xyz></axis></joint>"
            )
    return f"<model name='skid'><pose>{pose}</pose>{''.join(parts)}{plugin}</model>"


IN_SPACE = "<gravity>0 0 0</gravity>"  # where nothing loads the wheels


def gz(around: str = GROUND, **values: Any) -> simkit.Simulation:
    joints = "".join(f"<{s}_joint>{s}_{e}_joint</{s}_joint>" for s in ("left", "right") for e, _ in ENDS)
    settings = {"wheel_separation": 0.4, "wheel_radius": 0.1, **values}
    attributes = "name='gz::sim::systems::DiffDrive' filename='gz-sim-diff-drive-system'"
    plugin = element("plugin", settings, attributes).replace("</plugin>", f"{joints}</plugin>")
    return simkit.load(world(around, four_wheeler(plugin), step=0.002))


def ros_1(around: str = GROUND, pose: str = "0 0 0 0 0 0", **values: Any) -> simkit.Simulation:
    settings = {"wheelSeparation": 0.4, "wheelDiameter": 0.2, "torque": 20, **values}
    plugin = element("plugin", settings, "name='skid' filename='libgazebo_ros_skid_steer_drive.so'")
    return simkit.load(world(around, four_wheeler(plugin, pose), step=0.002))


def speeds(sim: simkit.Simulation) -> list[float]:
    return [float(sim.joint(f"skid::{s}_{e}_joint").velocity) for s in ("left", "right") for e, _ in ENDS]


def test_gz_turns_all_wheels_of_a_side_alike() -> None:
    """(0.5 m/s, 1 rad/s): rims at 0.3 and 0.7 m/s."""
    with gz(IN_SPACE) as sim:
        sim.publish("/model/skid/cmd_vel", {"linear": {"x": 0.5}, "angular": {"z": 1.0}})
        sim.run(1.0)
        assert speeds(sim) == pytest.approx([3, 3, 7, 7], abs=1e-3)


def test_gz_publishes_the_odometry_of_the_first_pair_along_the_arc_of_the_wheels() -> None:
    """Wheels that slip sideways turn the body less than the odometry; the odometry is still the exact arc."""
    with gz(odom_publish_frequency=4) as sim:
        odometry = sim.subscribe("/model/skid/odometry")
        sim.publish("/model/skid/cmd_vel", {"linear": {"x": 0.5}, "angular": {"z": 1.0}})
        sim.run(2.0)
        turned = sim.model("skid").pose.rpy[2]
        first = [sim.joint(f"skid::{side}_front_joint").position * 0.1 for side in ("left", "right")]
    ahead, turn = sum(first) / 2, (first[1] - first[0]) / 0.4
    assert turned < turn
    message = odometry.latest
    assert yaw(message.pose.pose.orientation) == pytest.approx(turn, abs=1e-6)
    # while the wheels start the arc is another: some millimetres
    radius = ahead / turn
    expected = (radius * np.sin(turn), radius * (1 - np.cos(turn)), 0)
    np.testing.assert_allclose(xyz(message.pose.pose.position), expected, atol=5e-3)


def test_gz_drives_straight_at_the_commanded_speed() -> None:
    with gz(max_linear_acceleration=1, min_linear_acceleration=-1) as sim:
        sim.publish("/model/skid/cmd_vel", {"linear": {"x": 0.5}})
        sim.run(2.0)
        x, y, _ = sim.model("skid").pose.position
    assert x == pytest.approx(0.5 * 2 - 0.5**2 / 2, abs=0.02)
    assert abs(y) < 2e-3


def test_ros_1_turns_all_wheels_of_a_side_alike() -> None:
    with ros_1(IN_SPACE) as sim:
        assert sim.topics()["/cmd_vel"] == "geometry_msgs/msg/Twist"
        sim.publish("/cmd_vel", {"linear": {"x": 0.5}, "angular": {"z": 1.0}})
        sim.run(1.0)
        assert speeds(sim) == pytest.approx([3, 3, 7, 7], abs=1e-3)


def test_ros_1_publishes_the_true_pose_without_height_and_the_transform_with_it() -> None:
    with ros_1(pose="1 2 0 0 0 1.0", broadcastTF="true") as sim:
        odometry, tf = sim.subscribe("/odom"), sim.subscribe("/tf")
        sim.publish("/cmd_vel", {"linear": {"x": 0.4}})
        sim.run(1.0)
        pose, link = sim.model("skid").pose, sim.link("skid::base")
        message, (transform,) = odometry.latest, tf.latest.transforms
        assert len(odometry.messages) == 100
        np.testing.assert_allclose(xyz(message.pose.pose.position), (*pose.position[:2], 0), atol=1e-12)
        assert yaw(message.pose.pose.orientation) == pytest.approx(pose.rpy[2], abs=1e-6)
        assert message.twist.twist.linear.x == pytest.approx(np.linalg.norm(link.linear_velocity[:2]), abs=1e-3)
        np.testing.assert_allclose(xyz(transform.transform.translation), pose.position, atol=1e-12)
    np.testing.assert_array_equal(message.pose.covariance[::7], [1e-4, 1e-4, 1e12, 1e12, 1e12, 1e-2])
    np.testing.assert_array_equal(message.twist.covariance, message.pose.covariance)
    assert (message.header.frame_id, message.child_frame_id) == ("odom", "base_footprint")


def test_ros_1_names_and_rates_are_those_of_the_file() -> None:
    names = {"commandTopic": "go", "odometryTopic": "where", "odometryFrame": "map", "robotBaseFrame": "body"}
    with ros_1(robotNamespace="one", updateRate=20, covariance_x=0.5, **names) as sim:
        assert "/tf" not in sim.topics()
        odometry = sim.subscribe("/one/where")
        sim.publish("/one/go", {"linear": {"x": 0.4}})
        sim.run(0.5)
    np.testing.assert_array_equal(stamps(odometry.messages), np.arange(1, 11) * 50_000_000)
    assert (odometry.latest.header.frame_id, odometry.latest.child_frame_id) == ("map", "body")
    assert odometry.latest.pose.covariance[0] == 0.5


def test_ros_1_wheels_are_named_by_their_position() -> None:
    """Each wheel has another name; missing names have Gazebo's default."""
    plugin = element(
        "plugin",
        {"leftFrontJoint": "left_front_joint", "rightRearJoint": "right_rear_joint", "torque": 20},
        "name='skid' filename='libgazebo_ros_skid_steer_drive.so'",
    )
    with simkit.load(world(GROUND, four_wheeler(plugin), step=0.002)) as sim:
        sim.publish("/cmd_vel", {"linear": {"x": 0.3}})
        sim.run(1.0)
        assert speeds(sim) == pytest.approx([4.0] * 4, abs=0.1)  # 0.3 m/s at the default diameter of 0.15 m


def test_the_torque_of_each_wheel_is_limited() -> None:
    """Four wheels of 0.05 N·m on rims of 0.1 m push 6 kg with 2 N at most."""
    with ros_1(torque=0.05) as sim:
        sim.run(0.2)
        sim.publish("/cmd_vel", {"linear": {"x": 5.0}})
        sim.run(1.0)
        assert 0.15 < sim.link("skid::base").linear_velocity[0] < 2 / 6 * 1.01
