"""Noisy odometry: errors that agree with its covariance, independent of subscribers."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.plugins.drives.odometry import DeadReckoning
from simkit.plugins.drives.odometry_noise import (
    EquivalentWheelAngles,
    NoisyOdometry,
    OdometryNoise,
    replace_planar_pose,
)
from simkit.pose import Pose
from simkit.runtime.engine.random_streams import RandomStreams

RADIUS, SEPARATION = 0.1, 0.4


def drive(noise: OdometryNoise, seed: int = 0, steps: int = 50, left: float = 0.032, right: float = 0.048) -> Any:
    """Drive an arc of 2 m with a left turn of 2 rad in steps, and return the travel of each wheel and step [m]."""
    odometry = NoisyOdometry(noise, RADIUS, SEPARATION, RandomStreams(seed).stream("m", "odometry_noise", 2))
    for k in range(1, steps + 1):
        odometry.advance(k * left / RADIUS, k * right / RADIUS, 0.02)
    return odometry


def error_of(odometry: Any, exact: DeadReckoning) -> Any:
    found = odometry.reckoning
    return np.array((found.x - exact.x, found.y - exact.y, found.yaw - exact.yaw))


# ------------------------------------------------------------------ without physics


@pytest.mark.parametrize(("left", "right"), [(0.04, 0.04), (0.032, 0.048), (-0.04, 0.04), (-0.048, -0.032)])
def test_the_covariance_agrees_with_two_hundred_runs(left: float, right: float) -> None:
    """The motions are straight, an arc, a spin and backwards."""
    noise = OdometryNoise(wheel_variance=1e-4)
    exact = drive(OdometryNoise(), left=left, right=right).reckoning
    runs = [drive(noise, seed, left=left, right=right) for seed in range(200)]
    errors = np.array([error_of(run, exact) for run in runs])
    # the normalised error squared of three numbers has a mean of 3 and, over 200 runs, a deviation of sqrt(6 / 200)
    squares = [e @ np.linalg.solve(run.covariance, e) for e, run in zip(errors, runs, strict=True)]
    assert np.mean(squares) == pytest.approx(3.0, abs=4 * math.sqrt(6 / 200))
    predicted = np.mean([np.diag(run.covariance) for run in runs], axis=0)
    assert (np.abs(errors.mean(axis=0)) <= 4 * np.sqrt(predicted / 200) + 1e-9).all()
    np.testing.assert_allclose(np.diag(np.cov(errors.T)), predicted, rtol=0.45, atol=1e-7)


def test_on_a_straight_line_the_covariance_matches_the_textbook() -> None:
    """The variance of yaw is 2ks/b², that of the distance ks/2, and that of y, the integral of yaw, 2ks³/(3b²)."""
    noise = OdometryNoise(wheel_variance=1e-4)
    covariance = np.mean([drive(noise, s, 1000, 0.002, 0.002).covariance for s in range(5)], axis=0)
    way, k = 2.0, 1e-4
    assert covariance[2, 2] == pytest.approx(2 * k * way / SEPARATION**2, rel=0.02)
    assert covariance[0, 0] == pytest.approx(k * way / 2, rel=0.2)
    assert covariance[1, 1] == pytest.approx(2 * k * way**3 / (3 * SEPARATION**2), rel=0.05)


def test_the_noise_does_not_depend_on_the_rate_of_the_odometry() -> None:
    noise = OdometryNoise(wheel_variance=1e-4)
    coarse, fine = drive(noise, 1, 20, 0.08, 0.12), drive(noise, 1, 2000, 0.0008, 0.0012)
    np.testing.assert_allclose(np.diag(coarse.covariance), np.diag(fine.covariance), rtol=0.15)


def test_a_stopped_robot_does_not_drift() -> None:
    odometry = drive(OdometryNoise(wheel_variance=1e-2), left=0.0, right=0.0)
    assert (odometry.reckoning.x, odometry.reckoning.yaw) == (0, 0)
    assert not odometry.covariance.any()


def test_unequal_wheels_turn_a_straight_line_into_an_arc() -> None:
    """The assumed right radius is 1 % too large: 2 m straight become a turn of 0.02 / 0.4 rad."""
    odometry = drive(OdometryNoise(right_radius_error=0.01), left=0.04, right=0.04)
    assert odometry.reckoning.yaw == pytest.approx(2.0 * 0.01 / SEPARATION)
    wide = drive(OdometryNoise(separation_error=0.25), left=-0.04, right=0.04)
    assert wide.reckoning.yaw == pytest.approx(4.0 / SEPARATION / 1.25)
    assert not odometry.covariance.any()


def test_the_error_of_encoder_counts_is_at_most_half_a_count() -> None:
    step = 2 * math.pi / 64
    odometry = NoisyOdometry(OdometryNoise(resolution=step), RADIUS, SEPARATION, None)
    for k in range(1, 500):
        odometry.advance(k * 0.013, k * 0.013, 0.02)
        assert abs(odometry.reckoning.x - k * 0.0013) <= step / 2 * RADIUS + 1e-12
    counts = odometry.twist.linear[0] * 0.02 / (step * RADIUS)
    assert counts == pytest.approx(round(counts), abs=1e-9)


def test_the_error_of_a_twist_agrees_with_its_covariance() -> None:
    noise = OdometryNoise(wheel_variance=1e-4)
    runs = [drive(noise, seed, 1) for seed in range(400)]
    twists = np.array([(r.twist.linear[0], r.twist.angular[2]) for r in runs])
    np.testing.assert_allclose(np.cov(twists.T), runs[0].twist_covariance, rtol=0.25, atol=2e-3)
    assert twists.mean(axis=0) == pytest.approx((2.0, 2.0), abs=0.1)


def test_equivalent_wheel_angles_reproduce_the_true_motion() -> None:
    """The curves include sideways motion and rotations beyond half a turn."""
    followed = EquivalentWheelAngles(Pose.from_rpy(1, 2, 0, 0, 0, 3.0), RADIUS, SEPARATION)
    odometry = NoisyOdometry(OdometryNoise(), RADIUS, SEPARATION, None, followed.angles, followed.start)
    for k in range(1, 400):
        t = k * 0.01
        pose = Pose.from_rpy(1 + math.sin(t), 2 + t * t / 3, 0.1, 0.05, 0, 3.0 + 0.8 * t)
        left, right, sideways = followed.follow(pose)
        odometry.advance(left, right, 0.01, sideways)
    back = replace_planar_pose(pose, odometry.reckoning)
    np.testing.assert_allclose(back.position, pose.position, atol=1e-9)
    np.testing.assert_allclose(back.matrix, pose.matrix, atol=1e-9)


# ------------------------------------------------------------------ in a world

INERTIA = "<inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia>"


def rover(plugin: str) -> str:
    wheels = "".join(
        f"""<link name="{side}"><pose>0 {y} 0.1 -1.5707963267948966 0 0</pose>
<inertial><mass>0.5</mass>{INERTIA}</inertial><collision name="c"><geometry><cylinder><radius>0.1</radius>
<length>0.02</length></cylinder></geometry></collision></link><joint name="{side}_joint" type="revolute">
<parent>base</parent><child>{side}</child><axis><xyz>0 0 1</xyz></axis></joint>"""
        for side, y in (("left", 0.2), ("right", -0.2))
    )
    balls = "".join(
        f"""<collision name="b{x}"><pose>{x} 0 -0.05 0 0 0</pose><geometry><sphere><radius>0.05</radius></sphere>
</geometry><surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction></surface></collision>"""
        for x in (-0.2, 0.2)
    )
    return f"""<sdf version="1.9"><world name="w"><model name="ground"><static>true</static><link name="l">
<collision name="c"><geometry><plane/></geometry></collision></link></model><model name="m">
<link name="base"><pose>0 0 0.1 0 0 0</pose><inertial><mass>5</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz>
</inertia></inertial>{balls}</link>{wheels}{plugin}</model></world></sdf>"""


NOISE = "<odometry_noise><wheel_variance>1e-3</wheel_variance>{}</odometry_noise>"
JOINTS = "<left_joint>left_joint</left_joint><right_joint>right_joint</right_joint>"


def gz(noise: str) -> str:
    return rover(
        f"""<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">{JOINTS}{noise}
<wheel_separation>0.4</wheel_separation><wheel_radius>0.1</wheel_radius><topic>/cmd_vel</topic>
<odom_topic>/odom</odom_topic></plugin>"""
    )


def classic(noise: str, source: int) -> str:
    return rover(
        f"""<plugin filename="libgazebo_ros_diff_drive.so" name="drive">{JOINTS}{noise}<update_rate>50</update_rate>
<wheel_separation>0.4</wheel_separation><wheel_diameter>0.2</wheel_diameter><publish_odom>true</publish_odom>
<publish_odom_tf>true</publish_odom_tf><odometry_source>{source}</odometry_source></plugin>"""
    )


WORLDS = {"gz": gz, "encoders": lambda n: classic(n, 0), "world": lambda n: classic(n, 1)}


def last_odometry(text: str, seed: int = 0, listen_late: bool = False) -> tuple[Any, Any]:
    """Return the last odometry of a drive of two seconds, and the true planar pose of the point between the wheels."""
    with simkit.load(text, seed=seed) as sim:
        sub = None if listen_late else sim.subscribe("/odom")
        sim.publish("/cmd_vel", {"linear": {"x": 0.5}, "angular": {"z": 0.5}})
        sim.run(1.9)
        sub = sub or sim.subscribe("/odom")
        sim.run(0.1)
        x, y, _ = sim.link("m::base").pose.position
        return sub.latest, np.array((x, y, sim.link("m::base").pose.rpy[2]))


def planar(message: Any) -> Any:
    pose = message.pose.pose
    return np.array((pose.position.x, pose.position.y, 2 * math.atan2(pose.orientation.z, pose.orientation.w)))


@pytest.mark.parametrize("kind", WORLDS)
def test_a_drive_with_noise_has_errors_and_publishes_its_covariance(kind: str) -> None:
    exact, place = last_odometry(WORLDS[kind](""))
    message, true = last_odometry(WORLDS[kind](NOISE.format("")), seed=5)
    np.testing.assert_allclose(true, place, atol=1e-9)  # the robot's true path is unchanged
    covariance = np.array(message.pose.covariance).reshape(6, 6)[np.ix_((0, 1, 5), (0, 1, 5))]
    error = planar(message) - planar(exact)
    assert 0.01 < np.abs(error).max() < 0.5
    assert error @ np.linalg.solve(covariance, error) < 16.3  # 99.9 % of all seeds
    np.testing.assert_allclose(covariance, covariance.T)
    assert covariance[2, 2] == pytest.approx(1e-3 * 2 * 1.0 / 0.4**2, rel=0.15)
    twist = np.array(message.twist.covariance).reshape(6, 6)
    assert twist[0, 0] > 0 and twist[5, 5] > 0
    assert message.pose.covariance[14] == 1e12


@pytest.mark.parametrize("kind", WORLDS)
def test_the_same_seed_repeats_the_noise_also_for_late_subscribers(kind: str) -> None:
    text = WORLDS[kind](NOISE.format("<counts_per_revolution>2048</counts_per_revolution>"))
    first, again, late, other = (
        last_odometry(text),
        last_odometry(text),
        last_odometry(text, listen_late=True),
        last_odometry(text, seed=1),
    )
    np.testing.assert_array_equal(planar(first[0]), planar(again[0]))
    np.testing.assert_array_equal(planar(first[0]), planar(late[0]))
    assert np.abs(planar(first[0]) - planar(other[0])).max() > 1e-3


def test_without_random_errors_the_classic_covariance_is_the_file_s() -> None:
    block = "<odometry_noise><left_radius_error>0.02</left_radius_error></odometry_noise>"
    message, _ = last_odometry(classic(block, 0))
    exact, _ = last_odometry(classic("", 0))
    assert message.pose.covariance[35] == pytest.approx(1e-3)
    # 0.02 of the left wheel's 0.8 m is missing between the wheels
    assert planar(message)[2] - planar(exact)[2] == pytest.approx(-0.02 * 0.8 / 0.4, rel=0.1)


def test_a_reset_restarts_the_noise() -> None:
    with simkit.load(gz(NOISE.format(""))) as sim:
        sub = sim.subscribe("/odom")
        ends = []
        for _ in range(2):
            sim.publish("/cmd_vel", {"linear": {"x": 0.5}})
            sim.run(0.5)
            ends.append(planar(sub.latest))
            sim.reset()
        np.testing.assert_array_equal(*ends)


@pytest.mark.parametrize("block", ["<wheel_variance>-1</wheel_variance>", "<left_radius_error>2</left_radius_error>"])
def test_a_value_that_is_not_allowed_is_an_error(block: str) -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002"):
        simkit.load(gz(f"<odometry_noise>{block}</odometry_noise>"))
