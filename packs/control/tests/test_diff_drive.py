"""Differential drive controller on wheels that turn exactly as commanded."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from drive_host import SEPARATION, drive

import simkit

CMD, ODOM, OUT = "/base/cmd_vel", "/base/odom", "/base/cmd_vel_out"
TWIST = "geometry_msgs/msg/Twist"
STAMPED = "geometry_msgs/msg/TwistStamped"


def twist(ahead: float, turn: float = 0.0) -> Any:
    return simkit.msgs.make(TWIST, linear={"x": ahead}, angular={"z": turn})


def stamped(ahead: float, turn: float = 0.0, at: float = 0.0) -> Any:
    stamp = {"sec": int(at), "nanosec": round(at % 1 * 1e9)}
    return simkit.msgs.make(STAMPED, header={"stamp": stamp}, twist={"linear": {"x": ahead}, "angular": {"z": turn}})


def refused(values: dict[str, Any]) -> str:
    sim, host = drive(values)
    sim.close()
    return "\n".join(f"{d.code} {d.message} {d.hint}" for d in host.diagnostics)


# ---------------------------------------------------------------------- commands


def test_wheels_turn_by_the_kinematics_of_the_drive() -> None:
    sim, host = drive({"cmd_vel_timeout": 1})
    sim.publish(CMD, stamped(0.5, 1.0))
    sim.run(0.05)
    np.testing.assert_allclose(host.written[-1], [(0.5 - 0.2) / 0.1, (0.5 + 0.2) / 0.1])


def test_a_command_with_or_without_a_stamp_is_accepted_on_cmd_vel() -> None:
    sim, host = drive()
    sim.publish(CMD, twist(0.3))
    sim.run(0.02)
    assert host.speeds[-1, 0] == pytest.approx(0.3)


def test_unstamped_commands_have_their_own_topic_if_stamps_are_not_used() -> None:
    sim, host = drive({"use_stamped_vel": False})
    assert sim.topics()["/base/cmd_vel_unstamped"] == TWIST
    sim.publish("/base/cmd_vel_unstamped", twist(0.4, -1))
    sim.run(0.02)
    np.testing.assert_allclose(host.speeds[-1], [0.4, -1])
    sim, _ = drive()
    assert sim.topics()[CMD] == STAMPED and "/base/cmd_vel_unstamped" not in sim.topics()


def test_a_command_ends_with_its_timeout() -> None:
    sim, host = drive({"cmd_vel_timeout": 0.25})
    sim.publish(CMD, twist(0.3))
    sim.run(1.0)
    moving = np.flatnonzero(host.speeds[:, 0])
    assert (moving[0], moving[-1]) == (0, 25)  # at 0.25 s it is not older than that


def test_the_timeout_counts_from_the_stamp_of_a_command() -> None:
    sim, host = drive({"cmd_vel_timeout": 0.25})
    sim.run(1.0)
    sim.publish(CMD, stamped(0.3, at=0.9))
    sim.run(0.5)
    assert np.flatnonzero(host.speeds[:, 0])[-1] == 115
    sim.publish(CMD, stamped(0.3, at=0.5))
    sim.run(0.5)
    assert not host.speeds[151:, 0].any()
    sim.publish(CMD, stamped(0.3, at=2.5))
    sim.run(1.0)
    assert np.flatnonzero(host.speeds[:, 0])[-1] == 275


def test_a_nan_command_is_ignored_and_reported_once() -> None:
    sim, host = drive()
    sim.publish(CMD, twist(0.3))
    sim.run(0.02)
    for _ in range(3):
        sim.publish(CMD, twist(math.nan))
    sim.publish(CMD, twist(0.1, math.inf))
    sim.run(0.02)
    assert host.speeds[-1, 0] == pytest.approx(0.3)
    assert [d.code for d in sim.engine.reports].count("SK-CONTROL-045") == 1


def test_an_inactive_controller_ignores_commands_and_its_wheels_stop() -> None:
    sim, host = drive({"cmd_vel_timeout": 10})
    sim.publish(CMD, twist(0.3))
    sim.run(0.1)
    host.controller.deactivate()
    assert not host.hardware.commands.values.any()
    sim.publish(CMD, twist(0.2))
    sim.step()
    host.controller.activate()
    sim.run(0.1)
    assert host.speeds[-1, 0] == 0


# ---------------------------------------------------------------------- limits


def limited(
    ahead: dict[str, Any], command: float, seconds: float = 3.0, then: float | None = None
) -> np.ndarray[Any, Any]:
    """Speeds ahead that are commanded in each period of 0.01 s: towards one command, and then towards another."""
    sim, host = drive({"cmd_vel_timeout": 100, "linear": {"x": ahead}})
    sim.publish(CMD, twist(command))
    sim.run(seconds)
    if then is not None:
        sim.publish(CMD, twist(then))
        sim.run(seconds)
    return host.speeds[:, 0]


def test_speeds_stay_within_their_limits() -> None:
    bounds = {"has_velocity_limits": True, "max_velocity": 1.0, "min_velocity": -0.2}
    speeds = limited(bounds, 3.0, 0.5, then=-3.0)
    assert (speeds.max(), speeds.min()) == pytest.approx((1.0, -0.2))


def test_a_missing_lower_limit_is_the_negative_upper_limit() -> None:
    assert limited({"has_velocity_limits": True, "max_velocity": 0.7}, -3.0, 0.1)[-1] == pytest.approx(-0.7)


def test_disabled_limits_have_no_effect_and_limits_without_a_switch_apply() -> None:
    assert limited({"has_velocity_limits": False, "max_velocity": 0.7}, 3.0, 0.1)[-1] == pytest.approx(3.0)
    assert limited({"max_velocity": 0.7}, 3.0, 0.1)[-1] == pytest.approx(0.7)
    assert limited({"max_velocity": ".nan"}, 3.0, 0.1)[-1] == pytest.approx(3.0)


def test_acceleration_is_the_limit_on_the_way_up_and_down() -> None:
    speeds = limited({"has_acceleration_limits": True, "max_acceleration": 1.0, "min_acceleration": -2.0}, 0.5, 1, 0.0)
    rates = np.diff(speeds, prepend=0) / 0.01
    np.testing.assert_allclose(rates[:50], 1.0, rtol=1e-9)
    np.testing.assert_allclose(rates[100:125], -2.0, rtol=1e-9)
    assert speeds[-1] == 0 and speeds[99] == 0.5


def test_each_direction_has_accelerations_of_its_own() -> None:
    bounds = {
        "max_acceleration": 1.0,
        "max_deceleration": -2.0,
        "max_acceleration_reverse": -0.5,
        "max_deceleration_reverse": 4.0,
    }
    rates = np.diff(limited(bounds, 0.5, 2, -0.5), prepend=0) / 0.01
    np.testing.assert_allclose(rates[[5, 205, 230]], [1.0, -2.0, -0.5], rtol=1e-9)
    back = np.diff(limited(bounds, -0.5, 2, 0.5), prepend=0) / 0.01
    np.testing.assert_allclose(back[[5, 205, 220]], [-0.5, 4.0, 1.0], rtol=1e-9)


def test_jerk_is_limited_while_the_acceleration_grows_without_oscillation() -> None:
    bounds = {"max_velocity": 1.0, "max_acceleration": 1.0, "max_jerk": 2.0}
    speeds = limited(bounds, 0.8, 3)
    rates = np.diff(speeds, prepend=0) / 0.01
    jerks = np.diff(rates, prepend=0) / 0.01
    assert jerks.max() == pytest.approx(2.0, rel=1e-6) and rates.max() == pytest.approx(1.0, rel=1e-9)
    assert speeds.max() == 0.8 and speeds[-1] == 0.8
    # analytic: the rate grows over 0.5 s, to v = 0.25; the rest at 1 m/s²
    assert speeds[49] == pytest.approx(0.25, abs=0.01)


def test_turning_has_limits_of_its_own() -> None:
    sim, host = drive({"cmd_vel_timeout": 9, "angular": {"z": {"max_velocity": 2.09, "max_acceleration": 2.09}}})
    sim.publish(CMD, twist(0.5, 9.0))
    sim.run(2.0)
    np.testing.assert_allclose(host.speeds[0], [0.5, 0.0209])
    np.testing.assert_allclose(host.speeds[-1], [0.5, 2.09])


def test_after_the_timeout_the_base_brakes_by_its_limit() -> None:
    sim, host = drive({"cmd_vel_timeout": 0.25, "linear": {"x": {"max_acceleration": 1.0}}})
    sim.publish(CMD, twist(0.2))
    sim.run(1.0)
    np.testing.assert_allclose(host.speeds[24:50, 0], [0.2, 0.2, *np.arange(0.19, -0.001, -0.01), *[0] * 4], atol=1e-12)


def test_the_limited_command_is_published() -> None:
    sim, _ = drive({"publish_limited_velocity": True, "linear": {"x": {"max_velocity": 0.1}}})
    out = sim.subscribe(OUT)
    sim.publish(CMD, twist(0.5, 0.3))
    sim.run(0.02)
    message = out.latest
    assert (message.twist.linear.x, message.twist.angular.z, message.header.frame_id) == (0.1, 0.3, "base_link")


# ---------------------------------------------------------------------- odometry


def test_odometry_follows_an_arc_exactly() -> None:
    sim, _ = drive({"cmd_vel_timeout": 100})
    odom = sim.subscribe(ODOM)
    sim.publish(CMD, twist(0.5, 0.5))
    sim.run(2.03)
    message = odom.latest
    elapsed = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
    pose, yaw = message.pose.pose, 0.5 * elapsed
    np.testing.assert_allclose([pose.position.x, pose.position.y], [math.sin(yaw), 1 - math.cos(yaw)], atol=1e-9)
    np.testing.assert_allclose([pose.orientation.z, pose.orientation.w], [math.sin(yaw / 2), math.cos(yaw / 2)])
    np.testing.assert_allclose([message.twist.twist.linear.x, message.twist.twist.angular.z], 0.5)


def test_odometry_is_published_at_its_rate_with_the_transform() -> None:
    sim, _ = drive({"publish_rate": 20})
    odom, tf = sim.subscribe(ODOM), sim.subscribe("/tf")
    sim.run(1.005)
    times = [m.header.stamp.sec * 1000 + m.header.stamp.nanosec // 1_000_000 for m in odom.messages]
    assert times == list(range(50, 1001, 50))
    assert [m.transforms[0].header.stamp for m in tf.messages] == [m.header.stamp for m in odom.messages]


def test_frames_and_covariances_are_the_parameters() -> None:
    diagonal = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
    values = {"odom_frame_id": "odom", "base_frame_id": "base_footprint", "pose_covariance_diagonal": diagonal}
    sim, _ = drive(values)
    odom, tf = sim.subscribe(ODOM), sim.subscribe("/tf")
    sim.run(0.1)
    message = odom.latest
    assert (message.header.frame_id, message.child_frame_id) == ("odom", "base_footprint")
    transform = tf.latest.transforms[0]
    assert (transform.header.frame_id, transform.child_frame_id) == ("odom", "base_footprint")
    np.testing.assert_array_equal(message.pose.covariance.reshape(6, 6), np.diag(diagonal))
    assert not message.twist.covariance.any()


def test_the_transform_can_be_left_out_and_frames_prefixed() -> None:
    sim, _ = drive({"enable_odom_tf": False, "tf_frame_prefix": "/left/"})
    odom = sim.subscribe(ODOM)
    sim.run(0.1)
    assert (odom.latest.header.frame_id, odom.latest.child_frame_id) == ("left/odom", "left/base_link")
    assert "/tf" not in sim.topics()
    sim, _ = drive({"tf_frame_prefix": "left", "tf_frame_prefix_enable": False})
    odom = sim.subscribe(ODOM)
    sim.run(0.1)
    assert odom.latest.header.frame_id == "odom"


def test_odometry_uses_the_wheels_and_in_open_loop_the_limited_commands() -> None:
    slow = {"left": 0.5, "right": 0.5}
    for loop, expected in ((False, 0.25), (True, 0.5)):
        sim, _ = drive({"open_loop": loop, "cmd_vel_timeout": 9, "linear": {"x": {"max_velocity": 0.5}}}, slow)
        odom = sim.subscribe(ODOM)
        sim.publish(CMD, twist(3.0))
        sim.run(1.005)
        assert odom.latest.pose.pose.position.x == pytest.approx(expected)


def test_odometry_from_wheel_speeds_equals_odometry_from_angles() -> None:
    sim, host = drive({"position_feedback": False, "cmd_vel_timeout": 9})
    assert list(host.controller.state_interfaces()) == ["left/velocity", "right/velocity"]
    odom = sim.subscribe(ODOM)
    sim.publish(CMD, twist(0.2))
    sim.run(1.005)
    assert odom.latest.pose.pose.position.x == pytest.approx(0.2)


def test_odometry_starts_at_zero_at_any_wheel_angle() -> None:
    sim, _ = drive({}, start={"left": 3.0, "right": -2.0})
    odom = sim.subscribe(ODOM)
    sim.run(0.1)
    position = odom.latest.pose.pose.position
    assert (position.x, position.y) == (0, 0)


def test_the_twist_is_the_mean_over_a_window_of_updates() -> None:
    for window, expected in ((10, 0.1), (2, 0.5)):
        sim, _ = drive({"velocity_rolling_window_size": window, "publish_rate": 0, "cmd_vel_timeout": 9})
        odom = sim.subscribe(ODOM)
        sim.run(0.2)
        sim.publish(CMD, twist(1.0))
        sim.run(0.02)  # one period of moving is known
        assert odom.latest.twist.twist.linear.x == pytest.approx(expected)


def test_multipliers_correct_the_separation_and_the_radii() -> None:
    corrected = {
        "wheel_separation_multiplier": 1.5,
        "left_wheel_radius_multiplier": 0.5,
        "right_wheel_radius_multiplier": 2.0,
    }
    sim, host = drive(corrected)
    sim.publish(CMD, twist(0.6, 1.0))
    sim.run(0.02)
    half = 1.5 * SEPARATION / 2
    np.testing.assert_allclose(host.written[-1], [(0.6 - half) / 0.05, (0.6 + half) / 0.2])


def test_multipliers_can_be_set_during_the_run() -> None:
    sim, host = drive({"cmd_vel_timeout": 9})
    sim.publish(CMD, twist(0.6))
    sim.run(0.02)
    sim.set_parameter("/base", "left_wheel_radius_multiplier", 0.5)
    sim.run(0.02)
    np.testing.assert_allclose(host.written[-1], [12, 6])


def test_several_wheels_on_a_side_turn_alike_and_odometry_uses_their_mean() -> None:
    names = {"left_wheel_names": ["l1", "l2"], "right_wheel_names": ["r1", "r2"], "cmd_vel_timeout": 9}
    sim, host = drive({**names, "wheels_per_side": 2}, factors={"l1": 0.8, "l2": 1.2, "r1": 0.9, "r2": 1.1})
    odom = sim.subscribe(ODOM)
    sim.publish(CMD, twist(0.5, 1.0))
    sim.run(1.005)
    np.testing.assert_allclose(host.written[-1], [3, 3, 7, 7])
    assert odom.latest.pose.pose.position.x == pytest.approx(0.5 * math.sin(1.0))


def test_a_restored_drive_continues_with_the_same_bits() -> None:
    sim, host = drive({"cmd_vel_timeout": 1, "linear": {"x": {"max_acceleration": 1.0}}})
    sim.publish(CMD, twist(0.5, 0.3))
    sim.run(0.2)
    state = host.controller.get_state(), host.hardware.states.values.copy()
    sim.run(0.3)
    first = np.array(host.written[20:50])
    reckoned = host.controller._odometry.reckoning
    host.controller.set_state(state[0])
    host.hardware.states.values[:] = state[1]
    host.written.clear()
    for k in range(30):
        host.controller.update((20 + k) * 10_000_000, 0.01)
        commands = host.hardware.commands.values
        host.written.append(tuple(commands))
        host.hardware.states.values[0::2] += commands * 0.01
    np.testing.assert_array_equal(np.array(host.written), first)
    assert reckoned.x != 0


# ---------------------------------------------------------------------- ROS 1


def test_the_parameter_names_of_ros_1_are_read() -> None:
    spelled = {
        "left_wheel_names": None,
        "right_wheel_names": None,
        "left_wheel": "left",
        "right_wheel": "right",
        "wheel_radius_multiplier": 2.0,
        "publish_cmd": True,
        "allow_multiple_cmd_vel_publishers": True,
    }
    sim, host = drive(spelled)
    assert not list(host.diagnostics)
    assert sim.topics()[CMD] == TWIST and OUT in sim.topics()
    sim.publish(CMD, twist(0.4))
    sim.run(0.02)
    np.testing.assert_allclose(host.written[-1], [2, 2])


# ---------------------------------------------------------------------- bad parameters


def test_all_errors_are_reported_at_once() -> None:
    errors = refused(
        {
            "left_wheel_names": ["a", "b"],
            "right_wheel_names": ["a"],
            "wheel_radius": -1,
            "wheel_separation": None,
            "linear": {"x": {"has_velocity_limits": True, "min_acceleration": -1, "max_jerk": -3}},
            "pose_covariance_diagonal": [1, 2],
            "cmd_vel_timeout": "soon",
        }
    )
    for code, words in (
        ("SK-CONTROL-040", "left_wheel_names has 2 and right_wheel_names has 1"),
        ("SK-CONTROL-041", "joint 'a' is named for several wheels"),
        ("SK-PARAM-002", "<wheel_radius>-1"),
        ("SK-PARAM-001", "<wheel_separation>"),
        ("SK-CONTROL-042", "has_velocity_limits is true, but max_velocity [m/s or rad/s] is missing"),
        ("SK-CONTROL-042", "min_acceleration is set, but max_acceleration [m/s² or rad/s²] is missing"),
        ("SK-PARAM-002", "<max_jerk>-3"),
        ("SK-PARAM-002", "found 2 numbers in 'pose_covariance_diagonal'; expected 6"),
        ("SK-PARAM-002", "<cmd_vel_timeout>soon"),
    ):
        assert any(line.startswith(code) and words in line for line in errors.splitlines()), (code, words, errors)


def test_missing_wheels_are_an_error_and_a_different_count_is_a_warning() -> None:
    assert "SK-CONTROL-040 left_wheel_names names no wheel" in refused({"left_wheel_names": None})
    assert "SK-CONTROL-043 wheels_per_side is 3" in refused({"wheels_per_side": 3})
