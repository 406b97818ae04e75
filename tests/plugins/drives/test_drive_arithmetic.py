"""Arithmetic of the drives without physics: parameters, ramps, limits, dead reckoning."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from simkit import msgs
from simkit.params import Params
from simkit.plugins.classic.diff_drive import GazeboRosDiffDrive, read_options
from simkit.plugins.drives.odometry import DeadReckoning, WheelOdometry, command_of, planar_covariance
from simkit.plugins.drives.speed_limits import SpeedLimiter, SpeedLimitOptions, limit_each, speed_limits

WHEELS = {"left_joint": "l", "right_joint": "r"}


def options(**values: Any) -> Any:
    return read_options(Params.from_dict({**WHEELS, **values}))


def test_missing_elements_of_a_ros_2_file_get_gazebos_defaults() -> None:
    found = options()
    (pair,) = found.pairs
    assert (pair.left, pair.right, pair.separation, pair.radius) == ("l", "r", 0.34, 0.075)
    assert (found.update_rate, found.max_wheel_torque, found.max_wheel_acceleration) == (100.0, 5.0, 0.0)
    assert not (found.publish_odom or found.publishes_odom_tf or found.publish_wheel_tf or found.from_encoders)
    assert (found.odometry_frame, found.robot_base_frame) == ("odom", "base_footprint")
    assert (found.covariance_x, found.covariance_y, found.covariance_yaw) == (1e-5, 1e-5, 1e-3)


def test_missing_elements_of_a_ros_1_file_get_gazebos_defaults() -> None:
    params = Params.from_dict({"leftJoint": "a", "rightJoint": "b"})
    found = read_options(params)
    (pair,) = found.pairs
    assert (pair.left, pair.right, pair.separation, pair.radius) == ("b", "a", 0.34, 0.075)
    assert [d.code for d in params.diagnostics] == ["SK-PARAM-009"]
    assert found.publish_odom and found.publishes_odom_tf and not found.from_encoders


def test_ros_1_without_transforms_has_no_odometry_and_older_files_swap_the_wheels() -> None:
    found = read_options(Params.from_dict({"leftJoint": "a", "rightJoint": "b", "publishTf": False}))
    assert not (found.publish_odom or found.publishes_odom_tf)
    for is_old, joints in ((True, ("b", "a")), (False, ("a", "b"))):
        params = Params.from_dict({"leftJoint": "a", "rightJoint": "b", "legacyMode": is_old, "rosDebugLevel": "na"})
        (pair,) = read_options(params).pairs
        assert (pair.left, pair.right) == joints
        assert not list(params.unread()) and not params.diagnostics


def test_ros_1_names_topics_and_source() -> None:
    found = read_options(
        Params.from_dict(
            {"commandTopic": "go", "odometryTopic": "where", "odometrySource": "encoder", "wheelTorque": 2}
        )
    )
    assert (found.command_topic, found.odometry_topic, found.from_encoders, found.max_wheel_torque) == (
        "go",
        "where",
        True,
        2,
    )


def test_an_unused_topic_element_is_reported_unless_it_repeats_the_name() -> None:
    params = Params.from_dict({**WHEELS, "command_topic": "cmd_vel", "odometry_topic": "position"})
    assert read_options(params).odometry_topic == "odom"
    assert [element.name for element, _ in params.unread()] == ["odometry_topic"]


def test_each_pair_of_wheels_has_its_own_geometry_or_the_default() -> None:
    found = options(
        num_wheel_pairs=2,
        left_joint=["a", "c"],
        right_joint=["b", "d"],
        wheel_separation=[0.4, 0.5],
        wheel_diameter=[0.2],
    )
    assert [(p.left, p.right, p.separation, p.radius) for p in found.pairs] == [
        ("a", "b", 0.4, 0.1),
        ("c", "d", 0.5, 0.075),
    ]


def test_a_missing_wheel_is_an_error() -> None:
    params = Params.from_dict({"left_joint": "l"})
    read_options(params)
    assert [(d.code, d.severity) for d in params.diagnostics] == [("SK-PARAM-001", "error")]


def test_a_wrong_number_of_wheels_is_an_error() -> None:
    params = Params.from_dict({**WHEELS, "num_wheel_pairs": 2})
    read_options(params)
    assert [d.code for d in params.diagnostics] == ["SK-PARAM-002"]


# ------------------------------------------------------------------ the Classic ramp


def driven(rate: float = 50.0, **values: Any) -> tuple[GazeboRosDiffDrive, dict[int, float], SimpleNamespace]:
    """Return a drive without a simulation, its wheel commands, and the clock."""
    plugin = GazeboRosDiffDrive()
    controls: dict[int, float] = {}
    plugin.sim = sim = SimpleNamespace(time_ns=0, engine=SimpleNamespace(set_control=controls.__setitem__))  # type: ignore[assignment]
    plugin.options = options(update_rate=rate, wheel_separation=0.5, wheel_diameter=0.2, **values)
    plugin._servos, plugin._rims, plugin._last_ns = [0, 1], [0.0, 0.0], 0
    plugin._command = (0.0, 0.0)
    return plugin, controls, sim


def test_without_a_limit_wheels_reach_their_speed_at_once() -> None:
    plugin, controls, sim = driven()
    plugin._command = (0.3, 0.4)
    sim.time_ns = 20_000_000
    plugin.before_step()
    assert controls == pytest.approx({0: (0.3 - 0.4 * 0.25) / 0.1, 1: (0.3 + 0.4 * 0.25) / 0.1})


def test_the_rim_speed_grows_by_the_acceleration_limit() -> None:
    plugin, controls, sim = driven(max_wheel_acceleration=1.0)
    plugin._command = (0.1, 0.0)
    speeds = []
    for update in range(1, 8):
        sim.time_ns = update * 20_000_000
        plugin.before_step()
        speeds.append(controls[0] * 0.1)
    np.testing.assert_allclose(speeds, [0.02, 0.04, 0.06, 0.08, 0.1, 0.1, 0.1], atol=1e-12)


def test_a_change_below_a_centimetre_a_second_is_applied_at_once() -> None:
    plugin, controls, sim = driven(max_wheel_acceleration=0.1)
    plugin._command = (-0.009, 0.0)
    sim.time_ns = 20_000_000
    plugin.before_step()
    assert controls[0] == pytest.approx(-0.09)


def test_the_acceleration_limit_applies_to_braking_too() -> None:
    plugin, controls, sim = driven(max_wheel_acceleration=1.0)
    plugin._rims = [0.5, 0.5]
    sim.time_ns = 100_000_000
    plugin.before_step()
    assert controls[0] * 0.1 == pytest.approx(0.4)


# ------------------------------------------------------------------ gz's limiter


def test_without_limits_the_target_is_reached_at_once() -> None:
    assert SpeedLimiter().limit(3.7, 0.0, 0.0, 0.001) == 3.7


def test_acceleration_and_speed_are_limited() -> None:
    limiter = SpeedLimiter(velocity=(-0.5, 0.5), acceleration=(-1.0, 1.0))
    speed, last = 0.0, 0.0
    track = []
    for _ in range(700):
        speed, last = limiter.limit(2.0, speed, last, 0.001), speed
        track.append(speed)
    assert track[99] == pytest.approx(0.1)
    assert track[-1] == 0.5


def test_the_jerk_limit_bounds_the_change_of_acceleration() -> None:
    limiter = SpeedLimiter(jerk=(-10.0, 10.0))
    speed, last = 0.0, 0.0
    for _ in range(100):
        speed, last = limiter.limit(1.0, speed, last, 0.001), speed
    # half of jerk times time squared, in steps
    assert speed == pytest.approx(10.0 * 0.001**2 * 100 * 101 / 2)


def test_specific_limits_override_general_ones() -> None:
    params = Params.from_dict({"max_velocity": 1.0, "max_angular_velocity": 3.0, "min_velocity": -1.0})
    linear, angular = speed_limits(SpeedLimitOptions(params))
    assert (linear.velocity, angular.velocity) == ((-1.0, 1.0), (-1.0, 3.0))
    assert linear.acceleration == angular.jerk == (-math.inf, math.inf)


def test_limits_with_the_wrong_sign_are_an_error() -> None:
    params = Params.from_dict({"max_acceleration": -1.0, "min_angular_velocity": 1.0, "max_jerk": 0.0})
    speed_limits(SpeedLimitOptions(params))
    assert [(d.code, d.message.split(";")[0]) for d in params.diagnostics] == [
        ("SK-PARAM-002", "found <min_angular_velocity>1.0</min_angular_velocity>"),
        ("SK-PARAM-002", "found <max_acceleration>-1.0</max_acceleration>"),
    ]


# ------------------------------------------------------------------ dead reckoning


def test_a_quarter_circle_is_exact_in_one_stride() -> None:
    base = DeadReckoning()
    # radius 1 to the left, wheels 0.4 apart
    base.advance(0.8 * math.pi / 2, 1.2 * math.pi / 2, 0.4)
    assert (base.x, base.y, base.yaw) == pytest.approx((1.0, 1.0, math.pi / 2))


def test_a_long_way_in_small_strides_ends_where_the_arc_does() -> None:
    base = DeadReckoning()
    for _ in range(10_000):
        base.advance(1e-5, 1.0001e-5, 0.3)
    turn = 10_000 * 1e-9 / 0.3
    radius = 1.00005e-5 * 10_000 / turn
    assert base.x == pytest.approx(radius * math.sin(turn), rel=1e-9)
    assert base.y == pytest.approx(radius * (1 - math.cos(turn)), rel=1e-6)


def rolled(speeds: Any, odometry: WheelOdometry, every: int = 20, step: float = 0.001) -> list[tuple[float, ...]]:
    """Return rows of x, y, yaw, speed and turning rate.

    Args:
        speeds: Rim speeds (left, right) of each step [m/s].
        odometry: Odometry to update.
        every: Number of steps between two rows.
        step: Time of a step [s].
    """
    turned = np.cumsum(np.asarray(speeds) * step / 0.1, axis=0)
    angles = np.vstack((np.zeros(2), turned)) + np.array((0.3, -0.2))
    rows = []
    for k in range(1, len(angles)):
        odometry.note((float(angles[k - 1][0]), float(angles[k - 1][1])))
        if k % every == 0:
            odometry.reckon((float(angles[k][0]), float(angles[k][1])))
            base, twist = odometry.reckoning, odometry.twist
            rows.append((base.x, base.y, base.yaw, twist.linear[0], twist.angular[2]))
    return rows


def test_wheel_odometry_of_a_constant_curve_is_the_arc() -> None:
    """Rim speeds of 0.3 and 0.5 m/s, 0.4 m apart, give 0.4 m/s and 0.5 rad/s: a circle of radius 0.8 m."""
    for every in (1, 7, 20, 1500):
        rows = rolled([(0.3, 0.5)] * 3000, WheelOdometry(0.1, 0.4, 0.001), every)[-1]
        turn = 0.5 * (3000 // every * every) * 0.001
        expected = (0.8 * math.sin(turn), 0.8 * (1 - math.cos(turn)), turn, 0.4, 0.5)
        assert rows == pytest.approx(expected, abs=1e-9)


def test_the_twist_of_wheel_odometry_is_the_mean_over_ten_steps() -> None:
    """The twist of a growing speed (1 mm/s per step) is 4.5 steps late; at first it is the mean over fewer steps."""
    ramp = 0.001 * np.arange(1, 101)
    rows = rolled(np.stack((ramp, ramp), axis=1), WheelOdometry(0.1, 0.4, 0.001), every=1)
    speeds = [row[3] for row in rows]
    expected = [ramp[max(0, k - 9) : k + 1].mean() for k in range(100)]
    np.testing.assert_allclose(speeds, expected, atol=1e-12)
    rows = rolled(np.stack((-ramp, ramp), axis=1), WheelOdometry(0.1, 0.4, 0.001), every=20)
    np.testing.assert_allclose([row[4] for row in rows], 2 * ramp[19::20] / 0.4 - 4.5 * 0.001 / 0.2, atol=1e-12)


def test_wheel_odometry_at_a_low_rate_has_the_same_path() -> None:
    """The path is straight, then a spin, then straight; one arc over all wheel angles would be wrong."""
    legs = [(0.5, 0.5)] * 1000 + [(-0.2, 0.2)] * 1000 + [(0.5, 0.5)] * 1000
    seldom = rolled(legs, WheelOdometry(0.1, 0.4, 0.001), every=3000)[-1]
    often = rolled(legs, WheelOdometry(0.1, 0.4, 0.001), every=1)[-1]
    np.testing.assert_allclose(seldom, often, atol=1e-9)
    assert seldom[:3] == pytest.approx((0.5 + 0.5 * math.cos(1.0), 0.5 * math.sin(1.0), 1.0), abs=1e-9)


def test_twist_and_twist_stamped_are_accepted() -> None:
    twist = {"linear": {"x": 0.2}, "angular": {"z": 0.3}}
    assert command_of(msgs.make("geometry_msgs/msg/Twist", **twist)) == (0.2, 0.3)
    assert command_of(msgs.make("geometry_msgs/msg/TwistStamped", twist=twist)) == (0.2, 0.3)
    assert command_of(msgs.make("geometry_msgs/msg/Twist", linear={"x": math.nan})) is None


def test_the_covariance_of_height_roll_and_pitch_is_huge() -> None:
    np.testing.assert_array_equal(
        np.diag(planar_covariance(1.0, 2.0, 3.0).reshape(6, 6)), [1.0, 2.0, 1e12, 1e12, 1e12, 3.0]
    )


def test_limits_of_arrays_have_the_bits_of_single_limits() -> None:
    random, step = np.random.default_rng(1), 0.001
    limiters = [
        SpeedLimiter((-0.4, 0.5), (-1.5, 1.0), (-8.0, 5.0)),
        SpeedLimiter(acceleration=(-3.0, 2.0)),
        SpeedLimiter(),
    ]
    last, before_last = np.zeros((20, 3)), np.zeros((20, 3))
    for k in range(300):
        if k % 60 == 0:
            target = random.uniform(-1.0, 1.0, (20, 3)) * (random.random((20, 3)) < 0.8)
        speeds = np.stack(limit_each(limiters, target.T, last.T, before_last.T, step), axis=1)
        single = [
            [limiters[j].limit(*(float(v[i, j]) for v in (target, last, before_last)), step) for j in range(3)]
            for i in range(20)
        ]
        assert speeds.tolist() == single
        last, before_last = speeds, last
    assert (np.abs(last[:, 0]) <= 0.5).all() and (last[:, 2] == target[:, 2]).all()
