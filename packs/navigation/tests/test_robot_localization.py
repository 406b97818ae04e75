"""EKF node: analytic cases of the filter, frames and parameters of robot_localization, and a drive on truth."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.errors import LoadError
from simkit_navigation.plugins.localisation import extended_kalman_filter as ekf
from simkit_navigation.plugins.localisation.extended_kalman_filter import (
    ExtendedKalmanFilter,
    Measurement,
    predict_state,
)

TWIST = "0 0 0  0 0 0  1 1 1  1 1 1  0 0 0"
POSE = "1 1 1  1 1 1  0 0 0  0 0 0  0 0 0"
ROOM = '<sdf version="1.9"><world name="w">{}</world></sdf>'


def node(options: str, name: str = "ekf_filter_node") -> str:
    return f'<plugin filename="libsimkit_robot_localization.so" name="{name}">{options}</plugin>'


def loaded(tmp_path: Path, options: str, rest: str = "") -> Any:
    file = tmp_path / "w.sdf"
    file.write_text(ROOM.format(rest + node(options)), "utf-8")
    return simkit.load(file)


def advertised(sim: Any) -> Any:
    return sim.advertise("/odom", "nav_msgs/msg/Odometry")


def stamp(seconds: float) -> dict[str, int]:
    ns = round(seconds * 1e9)
    return {"sec": ns // 10**9, "nanosec": ns % 10**9}


def odometry(time: float, *, x: float = 0.0, yaw: float = 0.0, speed: float = 0.0, **changed: Any) -> dict[str, Any]:
    pose = {"position": {"x": x}, "orientation": {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}}
    return {
        "header": {"frame_id": "odom", "stamp": stamp(time)},
        "child_frame_id": "base_link",
        "pose": {"pose": pose, "covariance": (np.eye(6) * changed.pop("pose_variance", 0.01)).reshape(-1)},
        "twist": {
            "twist": {"linear": {"x": speed}, "angular": {"z": changed.pop("turn", 0.0)}},
            "covariance": np.diag(np.full(6, changed.pop("variance", 0.01))).reshape(-1),
        },
        **changed,
    }


def filter_with(**values: Any) -> ExtendedKalmanFilter:
    noise = np.diag(values.get("noise", np.zeros(ekf.SIZE)))
    covariance = np.eye(ekf.SIZE) * values.get("variance", 1e-9)
    return ExtendedKalmanFilter(noise, np.zeros(ekf.SIZE), covariance, has_dynamic_noise=False)


def measured(seconds: float, variance: float, threshold: float = math.inf, **values: float) -> Measurement:
    state, used = np.zeros(ekf.SIZE), np.zeros(ekf.SIZE, bool)
    for name, value in values.items():
        index = {"x": 0, "yaw": 5, "vx": 6, "vyaw": 11, "ax": 12}[name]
        state[index], used[index] = value, True
    return Measurement(round(seconds * 1e9), state, np.eye(ekf.SIZE) * variance, used, threshold)


# ------------------------------------------------------------------ filter


def test_the_jacobian_is_the_derivative_of_the_prediction() -> None:
    state = np.linspace(-0.6, 0.9, ekf.SIZE)
    _, jacobian = predict_state(state, 0.1)
    step = 1e-6 * np.eye(ekf.SIZE)
    numeric = [(predict_state(state + d, 0.1)[0] - predict_state(state - d, 0.1)[0]) / 2e-6 for d in step]
    np.testing.assert_allclose(jacobian, np.transpose(numeric), atol=1e-8)


def test_a_constant_twist_drives_a_circle() -> None:
    state = np.zeros(ekf.SIZE)
    state[6], state[11] = 1.0, 0.5
    for _ in range(1000):
        state, _ = predict_state(state, math.tau / 0.5 / 1000)
    np.testing.assert_allclose(state[:2], 0.0, atol=0.02)  # radius 2 m; the Euler step is 12.6 mm
    assert math.remainder(state[5], math.tau) == pytest.approx(0.0, abs=1e-9)


def test_equal_measurements_of_a_constant_average() -> None:
    """Without process noise, n measurements of variance r have the mean as estimate, of variance r/n."""
    found = filter_with(variance=1e6)
    values = [0.3, -0.1, 0.5, 0.7, 0.1]
    for value in values:
        found.time_ns = 0
        found.take(measured(0.0, 0.04, x=value))
    assert found.state[0] == pytest.approx(np.mean(values), abs=1e-6)
    assert found.covariance[0, 0] == pytest.approx(0.04 / 5, rel=1e-6)


def test_a_random_walk_has_the_variance_of_the_riccati_equation() -> None:
    """With p' = p + q before each measurement of variance r, p ends at (sqrt(q² + 4qr) - q)/2."""
    q, r = 0.01 * 0.1, 0.04
    noise = np.zeros(ekf.SIZE)
    noise[0] = 0.01
    found = filter_with(noise=noise, variance=0.0)
    for k in range(400):
        found.take(measured(0.1 * k, r, x=0.0))
    assert found.covariance[0, 0] == pytest.approx((math.sqrt(q * q + 4 * q * r) - q) / 2, rel=1e-6)


def test_a_position_corrects_the_speed_through_their_covariance() -> None:
    found = filter_with(variance=1.0)
    for k in range(200):
        found.take(measured(0.1 * k, 1e-4, x=0.5 * 0.1 * k))
    assert found.state[6] == pytest.approx(0.5, abs=1e-3)


def test_angles_take_the_short_way_and_outliers_are_refused() -> None:
    found = filter_with(variance=0.01)
    found.take(measured(0.0, 0.01, yaw=3.1))
    found.correct(measured(0.0, 0.01, yaw=-3.1))
    assert abs(found.state[5]) == pytest.approx(math.pi, abs=1e-9)
    before = found.state.copy()
    found.correct(measured(0.0, 0.01, threshold=3.0, yaw=0.0))
    np.testing.assert_array_equal(found.state, before)


# ------------------------------------------------------------------ node


def test_twists_are_integrated_along_the_heading(tmp_path: Path) -> None:
    options = f"<odom0>odom</odom0><odom0_config>{TWIST}</odom0_config><two_d_mode>true</two_d_mode>"
    with loaded(tmp_path, options) as sim:
        sim.tf.open()
        filtered = sim.subscribe("/odometry/filtered", keep=1)
        out = advertised(sim)
        for _ in range(100):
            out.publish(odometry(sim.time, speed=0.5, turn=0.2, variance=1e-6))
            sim.run(0.02)
        found = filtered.latest
        yaw = 0.2 * 1.96  # the time of the newest message that was published
        assert found.pose.pose.position.x == pytest.approx(0.5 / 0.2 * math.sin(yaw), abs=0.01)
        assert found.pose.pose.position.y == pytest.approx(0.5 / 0.2 * (1 - math.cos(yaw)), abs=0.01)
        assert found.twist.twist.linear.x == pytest.approx(0.5, abs=1e-3)
        assert (found.header.frame_id, found.child_frame_id) == ("odom", "base_link")
        variance = np.asarray(found.pose.covariance).reshape(6, 6)
        assert (np.linalg.eigvalsh(variance) > 0).all()
        assert sim.tf.lookup("odom", "base_link").position[0] == pytest.approx(found.pose.pose.position.x, abs=1e-9)


def test_differential_poses_are_velocities_and_relative_ones_begin_at_zero(tmp_path: Path) -> None:
    for kind in ("differential", "relative"):
        options = f"<odom0>odom</odom0><odom0_config>{POSE}</odom0_config><odom0_{kind}>1</odom0_{kind}>"
        with loaded(tmp_path, options) as sim:
            filtered = sim.subscribe("/odometry/filtered", keep=1)
            out = advertised(sim)
            for _ in range(100):
                out.publish(odometry(sim.time, x=7.0 + sim.time, pose_variance=1e-4))
                sim.run(0.02)
            found = filtered.latest
            seconds = found.header.stamp.sec + found.header.stamp.nanosec * 1e-9
            assert found.pose.pose.position.x == pytest.approx(seconds, abs=0.03)
            if kind == "differential":
                assert found.twist.twist.linear.x == pytest.approx(1.0, abs=1e-3)


MOUNTED = """<model name="car"><pose>0 0 1 0 0 0</pose><link name="base"><gravity>false</gravity>
  <inertial><mass>1</mass></inertial></link><link name="imu_link"><pose>0.2 0 0 3.141592653589793 0 0</pose>
  <gravity>false</gravity><inertial><mass>0.1</mass></inertial>
  <sensor name="imu" type="imu"><update_rate>100</update_rate><topic>imu</topic>
  <imu><enable_orientation>{}</enable_orientation>
  <orientation_reference_frame><localization>ENU</localization></orientation_reference_frame></imu></sensor></link>
  <joint name="j" type="fixed"><parent>base</parent><child>imu_link</child></joint></model>"""


@pytest.mark.parametrize("has_orientation", ["true", "false"])
def test_an_imu_upside_down_gives_the_rates_of_the_base_and_no_gravity(tmp_path: Path, has_orientation: str) -> None:
    """The world's gravity is 9.8 m/s²; the frame of the IMU is connected by /tf_static."""
    config = "0 0 0  0 0 0  0 0 0  0 0 1  1 1 1"
    options = f"""<imu0>imu</imu0><imu0_config>{config}</imu0_config><base_link_frame>base</base_link_frame>
      <imu0_remove_gravitational_acceleration>true</imu0_remove_gravitational_acceleration>
      <gravitational_acceleration>9.8</gravitational_acceleration>"""
    rest = MOUNTED.format(has_orientation)
    with loaded(tmp_path, options, rest) as sim:
        frames = sim.subscribe("/imu", keep=1)
        sim.model("car").set_velocity((0, 0, 0), (0, 0, 0.5))
        filtered = sim.subscribe("/odometry/filtered", keep=1)
        sim.run(1.0)
        assert frames.latest.angular_velocity.z == pytest.approx(-0.5, abs=1e-3)
        assert [d.message for d in sim.diagnostics if d.code == "SK-EKF-001"] == []
        assert filtered.latest.twist.twist.angular.z == pytest.approx(0.5, abs=2e-3)
        assert filtered.latest.twist.twist.linear.z == pytest.approx(0.0, abs=0.02)


def test_a_service_sets_the_pose(tmp_path: Path) -> None:
    options = f"<odom0>odom</odom0><odom0_config>{TWIST}</odom0_config>"
    with loaded(tmp_path, options) as sim:
        filtered = sim.subscribe("/odometry/filtered", keep=1)
        pose = {"pose": {"position": {"x": 3.0, "y": -1.0}, "orientation": {"w": 1.0}}}
        sim.run(0.1)
        sim.call("/set_pose", {"pose": {"header": {"frame_id": "odom"}, "pose": pose}})
        sim.run(0.1)
        found = filtered.latest.pose.pose.position
        assert (found.x, found.y) == pytest.approx((3.0, -1.0))


def test_with_the_map_as_world_frame_the_transform_moves_the_odometry_frame(tmp_path: Path) -> None:
    options = f"<pose0>fix</pose0><pose0_config>{POSE}</pose0_config><world_frame>map</world_frame>"
    with loaded(tmp_path, options) as sim:
        sim.tf.open()
        tf = sim.advertise("/tf", "tf2_msgs/msg/TFMessage")
        fix = sim.advertise("/fix", "geometry_msgs/msg/PoseWithCovarianceStamped")
        for _ in range(20):
            header = {"frame_id": "odom", "stamp": stamp(sim.time)}
            moved = {"translation": {"x": 1.0}, "rotation": {"w": 1.0}}
            tf.publish({"transforms": [{"header": header, "child_frame_id": "base_link", "transform": moved}]})
            pose = {"position": {"x": 5.0}, "orientation": {"w": 1.0}}
            covariance = (np.eye(6) * 1e-4).reshape(-1)
            header = {"frame_id": "map", "stamp": stamp(sim.time)}
            fix.publish({"header": header, "pose": {"pose": pose, "covariance": covariance}})
            sim.run(0.05)
        assert sim.tf.lookup("map", "odom").position == pytest.approx((4.0, 0.0, 0.0), abs=1e-3)


@pytest.mark.parametrize("wrong", [math.nan, math.inf])
def test_values_that_are_no_numbers_are_not_used(tmp_path: Path, wrong: float) -> None:
    with loaded(tmp_path, f"<odom0>odom</odom0><odom0_config>{TWIST}</odom0_config>") as sim:
        filtered = sim.subscribe("/odometry/filtered", keep=1)
        out = advertised(sim)
        for k in range(30):
            variance = wrong if k % 3 == 1 else 0.01
            out.publish(odometry(sim.time, speed=wrong if k % 3 == 2 else 1.0, variance=variance))
            sim.run(0.02)
        assert filtered.latest.twist.twist.linear.x == pytest.approx(1.0, abs=1e-6)


def test_parameters_of_a_file_count_and_are_checked(tmp_path: Path) -> None:
    lines = [
        "ekf_filter_node:",
        "  ros__parameters:",
        "    frequency: 50.0",
        "    two_d_mode: true",
        "    odom0: odom",
        "    odom0_config: [false, false, false, false, false, false, true, true, false, false, false, true,",
        "                   false, false, false]",
        "    base_link_fram: base_footprint",
    ]
    (tmp_path / "ekf.yaml").write_text("\n".join(lines), "utf-8")
    with loaded(tmp_path, "<ros><argument>--params-file ekf.yaml</argument></ros>") as sim:
        warnings = [(d.code, d.hint, d.line) for d in sim.diagnostics if "base_link_fram" in d.message]
        assert warnings == [("SK-PARAM-003", "did you mean 'base_link_frame'?", 8)]
        filtered = sim.subscribe("/odometry/filtered", keep=100)
        out = advertised(sim)
        for _ in range(50):
            out.publish(odometry(sim.time, speed=1.0))
            sim.run(0.02)
        assert 48 <= len(filtered.messages) <= 50


@pytest.mark.parametrize(
    ("options", "code", "text"),
    [
        ("", "SK-PARAM-001", "needs an input"),
        ("<odom0>odom</odom0>", "SK-PARAM-001", "odom0_config"),
        ("<odom0>odom</odom0><odom0_config>1 1</odom0_config>", "SK-PARAM-002", "found 2 values"),
        (f"<odom0>o</odom0><odom0_config>{TWIST.replace('0', 'no')}</odom0_config>", "SK-PARAM-002", "'no'"),
        (f"<odom0>o</odom0><odom0_config>{TWIST}</odom0_config><world_frame>w</world_frame>", "SK-PARAM-002", "'w'"),
        (
            f"<odom0>o</odom0><odom0_config>{TWIST}</odom0_config>"
            "<process_noise_covariance>1 2 x 4 5 6 7 8 9 1 1 1 1 1 1</process_noise_covariance>",
            "SK-PARAM-002",
            "no number",
        ),
    ],
)
def test_invalid_parameters_are_errors(tmp_path: Path, options: str, code: str, text: str) -> None:
    with pytest.raises(LoadError) as raised:
        loaded(tmp_path, options)
    assert [d.code for d in raised.value.diagnostics if d.severity == "error" and text in d.message] == [code]


def test_a_frame_that_is_not_known_is_reported_once(tmp_path: Path) -> None:
    with loaded(tmp_path, f"<odom0>odom</odom0><odom0_config>{TWIST}</odom0_config>") as sim:
        out = advertised(sim)
        for _ in range(3):
            out.publish(odometry(sim.time, child_frame_id="base_footprint"))
            sim.run(0.1)
        assert [d.code for d in sim.diagnostics if d.code == "SK-EKF-001"] == ["SK-EKF-001"]


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf])
def test_a_measurement_without_a_finite_number_is_reported_once_and_not_used(tmp_path: Path, number: float) -> None:
    """The numbers that no input uses, and -1 of an IMU without attitude, are no mistakes."""
    imu = "<imu0>imu</imu0><imu0_config>0 0 0  0 0 0  0 0 0  0 0 1  0 0 0</imu0_config>"
    with loaded(tmp_path, f"<odom0>odom</odom0><odom0_config>{TWIST}</odom0_config>{imu}") as sim:
        odom, imu_topic = advertised(sim), sim.advertise("/imu", "sensor_msgs/msg/Imu")
        result = sim.subscribe("/odometry/filtered", keep=1)
        for forward in (0.5, number, number):
            odom.publish(odometry(sim.time, x=number, speed=forward))
            header = {"stamp": stamp(sim.time), "frame_id": "base_link"}
            reading = {"header": header, "linear_acceleration": {"x": number}}
            imu_topic.publish({**reading, "orientation_covariance": [-1.0] + 8 * [0.0]})
            sim.run(0.1)
        (found,) = [d for d in sim.diagnostics if d.code == "SK-EKF-001"]
        assert "a measurement of odom0 has NaN or infinite numbers" in found.message
        assert math.isfinite(result.latest.pose.pose.position.x)
        assert result.latest.twist.twist.linear.x == pytest.approx(0.5, abs=0.05)


def test_messages_of_another_type_are_ignored_and_reported_once(tmp_path: Path) -> None:
    with loaded(tmp_path, f"<odom0>scan</odom0><odom0_config>{TWIST}</odom0_config>") as sim:
        out = sim.advertise("/scan", "sensor_msgs/msg/LaserScan")
        for _ in range(3):
            out.publish({"header": {"stamp": stamp(sim.time)}})
            sim.run(0.1)
        (found,) = [d for d in sim.diagnostics if d.code == "SK-EKF-001"]
        assert "sensor_msgs/msg/LaserScan on <odom0> are ignored; expected nav_msgs/msg/Odometry" in found.message


# ------------------------------------------------------------------ truth


@pytest.mark.slow
def test_wheels_and_gyroscope_follow_the_truth(tmp_path: Path) -> None:
    """2 mm on a way of 1.2 m. In lab 12, the wheels err."""
    file = tmp_path / "w.sdf"
    world = (Path(simkit.__file__).parents[1] / "worlds" / "turtlebot3_empty.sdf").read_text("utf-8")
    config = "0 0 0  0 0 0  1 1 0  0 0 {}  0 0 0"
    options = f"""<odom0>odom</odom0><odom0_config>{config.format(0)}</odom0_config>
      <imu0>imu</imu0><imu0_config>{config.format(1).replace("1 1 0", "0 0 0")}</imu0_config>
      <base_link_frame>base_footprint</base_link_frame><two_d_mode>true</two_d_mode><publish_tf>false</publish_tf>"""
    file.write_text(world.replace("</world>", f"{node(options)}</world>"), "utf-8")
    with simkit.load(file) as sim:
        odom, filtered = (sim.subscribe(topic, keep=1) for topic in ("/odom", "/odometry/filtered"))
        for _ in range(60):
            sim.publish("/cmd_vel", {"linear": {"x": 0.2}, "angular": {"z": 0.1}})
            sim.run(0.1)
        assert [d.code for d in sim.diagnostics if d.code.startswith("SK-EKF")] == []
        place = sim.model("turtlebot3").pose.position
        found = filtered.latest.pose.pose.position
        assert math.hypot(found.x - place[0], found.y - place[1]) < 0.01
        assert odom.latest is not None


NAN_WORLD = """<sdf version="1.9"><world name="w"><plugin filename="libsimkit_robot_localization.so" name="ekf">
  <odom0>odom</odom0><odom0_config>1 1 0  0 0 1  1 0 0  0 0 1  0 0 0</odom0_config></plugin></world></sdf>"""


def test_set_pose_with_a_covariance_of_nan_is_ignored() -> None:
    with simkit.load(NAN_WORLD) as sim:
        filtered = sim.subscribe("/odometry/filtered", keep=1)
        for _ in range(3):
            header = {"frame_id": "odom", "stamp": simkit.msgs.time(sim.time_ns)}
            sim.publish("/odom", simkit.msgs.make("nav_msgs/msg/Odometry", header=header))
            sim.run(0.1)
            if sim.time < 0.15:
                sim.call("/set_pose", {"pose": {"pose": {"covariance": [math.nan] * 36}}})
        assert filtered.latest.pose.pose.position.x == 0.0
