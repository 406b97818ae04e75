"""Known programs that convert commands, images, point clouds and scans."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import simkit
from simkit import Simulation, msgs

WORLD = '<sdf version="1.9"><world name="w"/></sdf>'


@pytest.fixture
def sim() -> Iterator[Simulation]:
    with simkit.load(WORLD) as simulation:
        yield simulation


def received(sim: Simulation, topic: str, sent: dict[str, tuple[str, dict[str, Any]]]) -> list[Any]:
    """Messages on a topic after messages were sent, by topic: type and fields; the last topic comes later."""
    subscription = sim.subscribe(topic)
    publishers = {name: sim.advertise(name, kind) for name, (kind, _) in sent.items()}
    sim.run(0.3)
    for name, (kind, fields) in sent.items():
        publishers[name].publish(msgs.make(kind, **fields))
        sim.run(0.1)
    return list(subscription.messages)


def camera(width: int, height: int, focal: float) -> dict[str, Any]:
    matrix = [focal, 0.0, width / 2 - 0.5, 0.0, focal, height / 2 - 0.5, 0.0, 0.0, 1.0]
    return {"width": width, "height": height, "k": matrix}


def depth_image(depth: np.ndarray[Any, Any]) -> dict[str, Any]:
    data = np.frombuffer(depth.astype(np.float32).tobytes(), np.uint8)
    height, width = depth.shape
    return {"width": width, "height": height, "encoding": "32FC1", "step": 4 * width, "data": data}


def test_a_depth_image_becomes_a_scan_with_distances_along_the_rays(sim: Simulation) -> None:
    sim.add_node("depthimage_to_laserscan/depthimage_to_laserscan_node", params={"output_frame": "camera_link"})
    depth = np.full((5, 11), 2.0)
    depth[:, 0] = 0.1  # nearer than the least range
    sent = {
        "/depth_camera_info": ("sensor_msgs/msg/CameraInfo", camera(11, 5, 5.0)),
        "/depth": ("sensor_msgs/msg/Image", depth_image(depth)),
    }
    (scan,) = received(sim, "/scan", sent)
    assert scan.header.frame_id == "camera_link"
    assert (scan.angle_min, scan.angle_max) == pytest.approx((-math.pi / 4, math.pi / 4))
    assert scan.ranges[5] == pytest.approx(2.0)
    assert scan.ranges[0] == pytest.approx(2.0 * math.sqrt(2.0))
    assert math.isnan(scan.ranges[10])


def cloud(points: list[tuple[float, float, float]]) -> dict[str, Any]:
    fields = [{"name": n, "offset": 4 * i, "datatype": 7, "count": 1} for i, n in enumerate("xyz")]
    data = np.frombuffer(np.array(points, np.float32).tobytes(), np.uint8)
    size = {"height": 1, "width": len(points), "point_step": 12, "row_step": 12 * len(points)}
    return {"header": {"frame_id": "lidar"}, "fields": fields, "data": data, **size}


def test_a_point_cloud_becomes_a_scan_of_the_nearest_points_between_two_heights(sim: Simulation) -> None:
    params = {"min_height": -0.1, "max_height": 0.1, "range_max": 10.0}
    sim.add_node("pointcloud_to_laserscan/pointcloud_to_laserscan_node", params=params)
    points = [(2.0, 0.01, 0.0), (1.0, 0.01, 0.05), (0.5, 0.01, 1.0), (0.0, 3.0, 0.0), (30.0, 0.0, 0.0)]
    (scan,) = received(sim, "/scan", {"/cloud_in": ("sensor_msgs/msg/PointCloud2", cloud(points))})
    near = {index: distance for index, distance in enumerate(scan.ranges) if math.isfinite(distance)}
    assert near == {180: pytest.approx(1.0, abs=1e-3), 270: pytest.approx(3.0)}


def test_filters_of_a_scan_run_in_their_order(sim: Simulation) -> None:
    params = {
        "filter1": {"name": "sector", "type": "laser_filters/LaserScanAngularBoundsFilter",
                    "params": {"lower_angle": -0.15, "upper_angle": 0.15}},
        "filter2": {"name": "range", "type": "laser_filters/LaserScanRangeFilter",
                    "params": {"lower_threshold": 1.0, "upper_threshold": 5.0}},
        "filter3": {"name": "box", "type": "laser_filters/LaserScanBoxFilter"},
    }  # fmt: skip
    node = sim.add_node("laser_filters/scan_to_scan_filter_chain", params=params)
    scan = {"angle_min": -0.2, "angle_increment": 0.1, "ranges": [2.0, 0.5, 3.0, 9.0, 2.0], "range_max": 10.0}
    (filtered,) = received(sim, "/scan_filtered", {"/scan": ("sensor_msgs/msg/LaserScan", scan)})
    assert np.array(filtered.ranges) == pytest.approx([math.nan, 3.0, math.nan], nan_ok=True)
    assert filtered.angle_min == pytest.approx(-0.1)
    assert "LaserScanBoxFilter" in node.log[0]


def test_points_of_a_depth_image_are_in_the_optical_frame(sim: Simulation) -> None:
    sim.add_node("depth_image_proc/point_cloud_xyz_node")
    sent = {
        "/camera_info": ("sensor_msgs/msg/CameraInfo", camera(3, 3, 2.0)),
        "/image_rect": ("sensor_msgs/msg/Image", depth_image(np.full((3, 3), 2.0))),
    }
    (points,) = received(sim, "/points", sent)
    xyz = np.frombuffer(bytes(points.data), np.float32).reshape(3, 3, 3)
    assert xyz[0, 2].tolist() == pytest.approx([1.0, -1.0, 2.0])


def test_an_image_is_compressed(sim: Simulation) -> None:
    sim.add_node("image_transport/republish", args=["raw", "compressed"])
    data = np.full(10 * 10 * 3, 200, np.uint8)
    image = {"width": 10, "height": 10, "encoding": "rgb8", "step": 30, "data": data}
    (compressed,) = received(sim, "/out/compressed", {"/in": ("sensor_msgs/msg/Image", image)})
    assert bytes(compressed.data[:2]) == b"\xff\xd8"


def test_an_image_without_distortion_is_its_rectification(sim: Simulation) -> None:
    sim.add_node("image_proc/rectify_node")
    sent = {
        "/camera_info": ("sensor_msgs/msg/CameraInfo", camera(3, 3, 2.0)),
        "/image": ("sensor_msgs/msg/Image", depth_image(np.full((3, 3), 2.0))),
    }
    assert len(received(sim, "/image_rect", sent)) == 1


def test_a_stamp_is_added_to_velocities_and_taken_away(sim: Simulation) -> None:
    remap = {"cmd_vel_in": "/a", "cmd_vel_out": "/b"}
    sim.add_node("twist_stamper/twist_stamper", remap=remap, params={"frame_id": "base"})
    sim.add_node("twist_stamper/twist_unstamper", remap={"cmd_vel_in": "/b", "cmd_vel_out": "/c"})
    stamped = sim.subscribe("/b")
    (twist,) = received(sim, "/c", {"/a": ("geometry_msgs/msg/Twist", {"linear": {"x": 0.5}})})
    assert twist.linear.x == 0.5
    assert stamped.latest.header.frame_id == "base"


def test_keys_command_velocities(sim: Simulation) -> None:
    keys = [(0.5, "i"), (1.0, "q"), (1.5, "l"), (2.0, "k")]
    node = sim.add_node("teleop_twist_keyboard/teleop_twist_keyboard", keys=keys)
    subscription = sim.subscribe("/cmd_vel")
    sim.run(2.5)
    speeds = [(round(m.linear.x, 3), round(m.angular.z, 3)) for m in subscription.messages]
    assert speeds == [(0.5, 0.0), (0.55, 0.0), (0.0, -1.1), (0.0, 0.0)]
    assert not node.done


def test_a_joystick_commands_velocities_while_its_button_is_pressed(sim: Simulation) -> None:
    params = {"axis_linear": {"x": 1}, "scale_linear": {"x": 2.0}, "enable_button": 0}
    sim.add_node("teleop_twist_joy/teleop_node", params=params)
    joy = "sensor_msgs/msg/Joy"
    sent = {"/joy": (joy, {"axes": [0.0, 0.5, 0.0], "buttons": [1]})}
    (twist,) = received(sim, "/cmd_vel", sent)
    assert twist.linear.x == 1.0
    assert received(sim, "/cmd_vel", {"/joy": (joy, {"axes": [0.0, 0.5, 0.0], "buttons": [0]})})[-1].linear.x == 0.0


def test_xacro_writes_the_expanded_file(sim: Simulation, tmp_path: Path) -> None:
    text = '<robot name="$(arg name)" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    text += '<xacro:arg name="name" default="a"/></robot>'
    (tmp_path / "r.xacro").write_text(text)
    words = ["-o", str(tmp_path / "r.urdf"), str(tmp_path / "r.xacro"), "name:=bot"]
    node = sim.add_node("command/xacro", args=words)
    sim.run(0.1)
    assert node.exit_code == 0, node.log
    assert 'name="bot"' in (tmp_path / "r.urdf").read_text()


def test_talker_and_listener_of_the_tutorial(sim: Simulation) -> None:
    sim.add_node("demo_nodes_cpp/talker")
    node = sim.add_node("demo_nodes_py/listener")
    sim.run(2.5)
    assert [line.partition("]: ")[2] for line in node.log] == ["I heard: [Hello World: 1]", "I heard: [Hello World: 2]"]


def test_sleep_lasts_for_a_simulated_time(sim: Simulation) -> None:
    node = sim.add_node("command/sleep", args=["1.5"])
    sim.run(1.4)
    assert not node.done
    sim.run(0.2)
    assert node.done


@pytest.mark.parametrize("name", ["rqt_graph/rqt_graph", "joy/joy_node", "foxglove_bridge/foxglove_bridge"])
def test_tools_without_effect_are_noted(sim: Simulation, name: str) -> None:
    sim.add_node(name)
    sim.run(0.1)
    assert [each.message for each in sim.diagnostics if each.code == "SK-NODE-064"]
