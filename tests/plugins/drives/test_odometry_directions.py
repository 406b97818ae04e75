"""Errors of odometry and of the motion by direction, slip, and the same errors for drives of every kind."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.plugins.drives.motion_errors import MotionErrors
from simkit.plugins.drives.odometry_noise import NoisyOdometry, OdometryNoise
from simkit.runtime.engine.random_streams import RandomStreams

RADIUS, SEPARATION = 0.1, 0.4
BOX = """<link name="base"><inertial><mass>5</mass></inertial><collision name="c"><geometry><box>
<size>0.4 0.4 0.2</size></box></geometry>
<surface><friction><ode><mu>0</mu></ode></friction></surface></collision></link>"""


def measured(noise: OdometryNoise, speeds: list[tuple[float, float]], sideways: float = 0.0) -> Any:
    """Return x, y and yaw that wheels with these forward speeds [m/s] and turning rates [rad/s] measure, 10 ms each."""
    stream = RandomStreams(0).stream("m", "odometry_noise", 2)
    odometry = NoisyOdometry(noise, RADIUS, SEPARATION, stream)
    left = right = 0.0
    for ahead, turn in speeds:
        left += (ahead - turn * SEPARATION / 2) / RADIUS * 0.01
        right += (ahead + turn * SEPARATION / 2) / RADIUS * 0.01
        odometry.advance(left, right, 0.01, sideways * 0.01)
    way = odometry.reckoning
    return np.array((way.x, way.y, way.yaw)), odometry


def test_each_direction_has_its_own_error() -> None:
    motion = MotionErrors(0.1, -0.2, 0.3, -0.4, 0.05, -0.06)
    noise = OdometryNoise(motion=motion)
    assert measured(noise, [(0.5, 0)] * 200)[0] == pytest.approx((1.1, 0, 0))
    assert measured(noise, [(-0.5, 0)] * 200)[0] == pytest.approx((-0.8, 0, 0))
    assert measured(noise, [(0, 0)] * 200, sideways=0.5)[0] == pytest.approx((0, 1.3, 0))
    assert measured(noise, [(0, 0)] * 200, sideways=-0.5)[0] == pytest.approx((0, -0.6, 0))
    assert measured(noise, [(0, 0.5)] * 200)[0] == pytest.approx((0, 0, 1.05))
    assert measured(noise, [(0, -0.5)] * 200)[0] == pytest.approx((0, 0, -0.94))


def test_slip_grows_with_the_turning_rate_and_with_the_acceleration() -> None:
    turning = OdometryNoise(turn_slip=0.1)
    assert measured(turning, [(0, 0.5)] * 200)[0][2] == pytest.approx(1.0 * 1.05)
    assert measured(turning, [(0, -2.0)] * 50)[0][2] == pytest.approx(-1.0 * 1.2)
    assert measured(turning, [(0.5, 0)] * 200)[0][0] == pytest.approx(1.0)
    loaded = OdometryNoise(acceleration_slip=0.05)
    ramp = [(0.02 * step, 0.0) for step in range(100)]  # 2 m/s²
    assert measured(loaded, ramp)[0][0] == pytest.approx(measured(OdometryNoise(), ramp)[0][0] * 1.1)
    assert measured(loaded, [(1.0, 0)] * 100 + [(1.0, 0)] * 900)[0][0] == pytest.approx(10.0, abs=0.011)


def test_encoder_counts_do_not_look_like_acceleration() -> None:
    coarse = OdometryNoise(acceleration_slip=0.05, resolution=2 * math.pi / 64)
    assert measured(coarse, [(0.0, 0.0), *[(0.5, 0)] * 400])[0][0] == pytest.approx(2.0, abs=0.015)


def planar_move(block: str) -> str:
    return drive(
        BOX,
        f"""<plugin filename="libgazebo_ros_planar_move.so" name="p"><update_rate>50</update_rate>
<publish_rate>50</publish_rate>{block}</plugin>""",
    )


def four_wheels(plugin: str, block: str) -> str:
    wheels = "".join(
        f"""<link name="{name}"><pose>{x} {y} 0.1 -1.5707963267948966 0 0</pose><inertial><mass>0.5</mass><inertia>
<ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial></link><joint name="{name}_j" type="revolute">
<parent>base</parent><child>{name}</child><axis><xyz>0 0 1</xyz></axis></joint>"""
        for name, x, y in (("fl", 0.2, 0.2), ("fr", 0.2, -0.2), ("bl", -0.2, 0.2), ("br", -0.2, -0.2))
    )
    return drive(
        BOX + wheels,
        f"""<plugin filename="gz-sim-{plugin[0]}-system" name="gz::sim::systems::{plugin[1]}">{plugin[2]}
<wheel_radius>0.1</wheel_radius><wheel_separation>0.4</wheel_separation><topic>/cmd_vel</topic>
<odom_topic>/odom</odom_topic>{block}</plugin>""",
    )


def mecanum(block: str) -> str:
    joints = "".join(
        f"<{place}_{side}_joint>{place[0]}{side[0]}_j</{place}_{side}_joint>"
        for place in ("front", "back")
        for side in ("left", "right")
    )
    return four_wheels(("mecanum-drive", "MecanumDrive", joints + "<wheelbase>0.4</wheelbase>"), block)


def drive(links: str, plugins: str) -> str:
    return f"""<sdf version="1.9"><world name="w"><model name="ground"><static>true</static><link name="l">
<collision name="c"><geometry><plane/></geometry></collision></link></model><model name="m"><pose>0 0 0.1 0 0 0</pose>
{links}{plugins}</model></world></sdf>"""


def reported(text: str, command: tuple[float, float, float], topic: str = "/odom") -> tuple[Any, Any]:
    """Return the last twist (x, y, yaw) of the odometry and the planar pose that it reports after 1 s."""
    with simkit.load(text) as sim:
        kept = sim.subscribe(topic)
        x, y, turn = command
        sim.publish("/cmd_vel", {"linear": {"x": x, "y": y}, "angular": {"z": turn}})
        sim.run(1.0)
        message = kept.latest
        twist, pose = message.twist.twist, message.pose.pose
        position = np.array((pose.position.x, pose.position.y, 2 * math.atan2(pose.orientation.z, pose.orientation.w)))
        return np.array((twist.linear.x, twist.linear.y, twist.angular.z)), position


ERRORS = """<forward_error>0.1</forward_error><backward_error>-0.2</backward_error>
<leftward_error>0.3</leftward_error><right_turn_error>0.4</right_turn_error>"""
EXPECTED = {
    (0.2, 0, 0): (0.22, 0, 0),
    (-0.2, 0, 0): (-0.16, 0, 0),
    (0, 0.2, 0): (0, 0.26, 0),
    (0, 0, -0.3): (0, 0, -0.42),
}


@pytest.mark.parametrize("command", EXPECTED)
@pytest.mark.parametrize("world", [planar_move, mecanum])
def test_the_odometry_of_every_drive_can_have_errors_by_direction(world: Any, command: Any) -> None:
    twist, pose = reported(world(f"<odometry_noise>{ERRORS}</odometry_noise>"), command)
    exact, place = reported(world(""), command)
    factors = np.divide(EXPECTED[command], command, out=np.ones(3), where=np.array(command) != 0)
    np.testing.assert_allclose(twist, exact * factors, atol=2e-3)
    np.testing.assert_allclose(pose, place * factors, atol=4e-3)
    assert abs(pose).max() > 0.1


@pytest.mark.parametrize("command", EXPECTED)
@pytest.mark.parametrize("world", [planar_move, mecanum])
def test_actuation_errors_change_the_motion_and_the_odometry_reports_it(world: Any, command: Any) -> None:
    twist, _ = reported(world(f"<actuation_error>{ERRORS}</actuation_error>"), command)
    np.testing.assert_allclose(twist, EXPECTED[command], atol=3e-3)


def test_the_odometry_publisher_of_gazebo_can_have_errors_of_wheels() -> None:
    block = "<odometry_noise><forward_error>0.1</forward_error><wheel_variance>1e-6</wheel_variance></odometry_noise>"
    _, pose = reported(drive(BOX, PUBLISHER.format(block)), (0.2, 0, 0))
    exact, place = reported(drive(BOX, PUBLISHER.format("")), (0.2, 0, 0))
    assert pose[0] == pytest.approx(1.1 * place[0], abs=4e-3) and place[0] > 0.1
    assert exact[0] == pytest.approx(0.2, abs=1e-3)


PUBLISHER = """<plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl">
<topic>/cmd_vel</topic></plugin><plugin filename="gz-sim-odometry-publisher-system"
name="gz::sim::systems::OdometryPublisher"><odom_topic>/odom</odom_topic>{}</plugin>"""


def test_a_robot_can_be_slower_than_commanded_and_its_odometry_wrong() -> None:
    """The real robot goes at 0.0957 m/s forward and 0.0727 m/s backward, and reports the command of 0.1 m/s."""
    block = f"""<actuation_error><forward_error>-0.043</forward_error><backward_error>-0.273</backward_error>
</actuation_error><odometry_noise><forward_error>{1 / 0.957 - 1}</forward_error>
<backward_error>{1 / 0.727 - 1}</backward_error></odometry_noise>"""
    for command, real in ((0.1, 0.0957), (-0.1, -0.0727)):
        with simkit.load(planar_move(block)) as sim:
            kept = sim.subscribe("/odom")
            sim.publish("/cmd_vel", {"linear": {"x": command}})
            sim.run(1.0)
            assert sim.link("m::base").linear_velocity[0] == pytest.approx(real, abs=2e-4)
            assert kept.latest.twist.twist.linear.x == pytest.approx(command, abs=1e-3)


def test_reset_and_restore_repeat_the_odometry() -> None:
    errors = "<wheel_variance>1e-3</wheel_variance><acceleration_slip>0.1</acceleration_slip>"
    block = f"<odometry_noise>{errors}</odometry_noise>"
    with simkit.load(mecanum(block)) as sim:
        kept = sim.subscribe("/odom")

        def ends() -> Any:
            sim.run(0.4)
            position = kept.latest.pose.pose.position
            return position.x, position.y

        sim.publish("/cmd_vel", {"linear": {"x": 0.3, "y": 0.1}})
        first = ends()
        state = sim.snapshot()
        second = ends()
        sim.restore(state)
        assert ends() == second
        sim.reset()
        sim.publish("/cmd_vel", {"linear": {"x": 0.3, "y": 0.1}})
        assert ends() == first
