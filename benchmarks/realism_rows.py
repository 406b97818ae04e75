"""Measurements of a robot's sensors in a run, row by row, as a probe on the topics of the real robot makes them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import simkit

WALL = """<sdf version="1.11" xmlns:gz="http://gazebosim.org/schema"><world name="wall">
  <physics type="ode"><max_step_size>0.001</max_step_size></physics>
  <light name="lamp" type="directional"><direction>0.6 0.2 -0.7</direction></light>
  <model name="floor"><static>true</static><link name="l"><visual name="v"><geometry><plane><normal>0 0 1</normal>
    <size>30 30</size></plane></geometry></visual></link></model>
  <model name="wall"><static>true</static><pose>{x} 0 5 0 0 0</pose><link name="l"><visual name="v"><geometry><box>
    <size>0.2 30 10</size></box></geometry></visual></link></model>
  <model name="x3"><static>true</static><pose>0 0 0.0714 0 0 0</pose><link name="base_link">
    <sensor name="depth" type="depth_camera"><pose>0.057105 0 0.03755 0 0 0</pose><update_rate>5</update_rate>
      <camera><horizontal_fov>1.5184</horizontal_fov><image><width>424</width><height>240</height></image>
      <clip><near>0.05</near><far>8</far></clip></camera></sensor></link></model>
</world></sdf>"""
"""World of the calibration of the depth camera: a wall at a distance, and a floor below the camera."""

SCREENS = (0.45, 0.63, 0.83, 1.12, 1.63, 2.6, 3.6)
"""Distances of the wall [m]: those of docs/depth_camera_calibration.md of physical_rosmaster."""


def seconds(stamp: Any) -> float:
    """Return a time stamp [s]."""
    return float(stamp.sec + 1e-9 * stamp.nanosec)


class Probe:
    """Listener on one topic: stamps and times of arrival, and what a function keeps of each message.

    Args:
        sim: the simulation.
        topic: the topic.
        keep: function of a message; its values are in `kept`.
    """

    def __init__(self, sim: simkit.Simulation, topic: str, keep: Callable[[Any], Any] | None = None) -> None:
        self.stamps: list[float] = []
        self.arrivals: list[float] = []
        self.kept: list[Any] = []
        self.last: Any = None
        self._sim, self._keep = sim, keep
        sim.subscribe(topic, self._on_message, keep=1)

    def _on_message(self, message: Any) -> None:
        self.stamps.append(seconds(message.header.stamp))
        self.arrivals.append(self._sim.time)
        self.last = message
        if self._keep is not None:
            self.kept.append(self._keep(message))

    @property
    def rate(self) -> float:
        """Messages per second, from the first stamp to the last."""
        return (len(self.stamps) - 1) / (self.stamps[-1] - self.stamps[0])

    @property
    def latency(self) -> float:
        """Median time from the stamp to the arrival [ms]."""
        return 1e3 * float(np.median(np.array(self.arrivals) - np.array(self.stamps)))

    @property
    def long_period(self) -> float:
        """95 % of the periods are shorter [ms]."""
        return 1e3 * float(np.quantile(np.diff(self.stamps), 0.95))


def depths_of(message: Any) -> np.ndarray:
    """Return the depths of an image of type 32FC1 [m], shape (h, w)."""
    return np.frombuffer(bytes(message.data), np.float32).reshape(message.height, message.width)


def measure(world: str, realism: str | None, duration: float, seed: int = 0) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the values of all rows by key, and data for the plots.

    Args:
        world: world with the robot.
        realism: choice for `--realism`; None for the sensors of the file.
        duration: simulated time [s].
        seed: seed of the run.
    """
    with simkit.load(world, realism=realism, seed=seed) as sim:
        sim.run(1.0)  # the robot comes to rest
        scan = Probe(sim, "/scan", lambda m: np.array(m.ranges))
        imu = Probe(sim, "/imu/data", _six)
        colour, colour_info = Probe(sim, "/cam_1/color/image_raw"), Probe(sim, "/cam_1/color/camera_info")
        depth = Probe(sim, "/cam_1/depth/image_raw", lambda m: np.isfinite(depths_of(m)).mean())
        nan = Probe(sim, "/cam_1/depth/image_raw", lambda m: np.isnan(depths_of(m)).mean())
        depth_info = Probe(sim, "/cam_1/depth/camera_info")
        cloud = Probe(sim, "/cam_1/cloud/points")
        odometry, joints = Probe(sim, "/odom"), Probe(sim, "/joint_states")
        sim.run(duration)
        info = colour_info.last
        motion = np.array(imu.kept)
        row: dict[str, Any] = {
            "colour_frame": colour.last.header.frame_id, "colour_info_frame": info.header.frame_id,
            "depth_frame": depth.last.header.frame_id, "depth_info_frame": depth_info.last.header.frame_id,
            "colour_rate": colour.rate, "colour_info_rate": colour_info.rate, "depth_rate": depth.rate,
            "depth_info_rate": depth_info.rate, "cloud_rate": cloud.rate, "scan_rate": scan.rate,
            "odometry_rate": odometry.rate, "joints_rate": joints.rate,
            "colour_latency": colour.latency, "depth_latency": depth.latency, "cloud_latency": cloud.latency,
            "scan_latency": scan.latency, "cloud_period": cloud.long_period,
            "width": info.width, "fx": info.k[0], "fy": info.k[4], "cx": info.k[2],
            "fov": 2 * math.atan(info.width / (2 * info.k[0])),
            "valid": 100 * float(np.mean(depth.kept)), "nan": 100 * float(np.mean(nan.kept)),
            "scan_time": scan.last.scan_time, "time_increment": 1e3 * scan.last.time_increment,
            "lost_rays": 100 * float(np.mean(~np.isfinite(scan.kept))),
            "gyro": 1e3 * float(motion[:, :3].std(axis=0).mean()),
            "accelerometer": float(motion[:, 3:].std(axis=0).mean()),
            "gravity": float(np.linalg.norm(motion[:, 3:].mean(axis=0))),
            "orientation_variance": float(imu.last.orientation_covariance[0]),
            "pose_variance": _variances(odometry.last.pose), "twist_variance": _variances(odometry.last.twist),
            **dict(_layout(cloud.last)),
        }  # fmt: skip
        data = {"gaps": np.rint(np.diff(cloud.stamps) * 30).astype(int), "scan": scan.kept[-1]}
        data["true_scan"] = np.array(sim.sensor("x3::base_link::lidar").truth.ranges)
    row |= _limits(world, realism)
    return row, data


def _six(message: Any) -> tuple[float, ...]:
    rate, force = message.angular_velocity, message.linear_acceleration
    return rate.x, rate.y, rate.z, force.x, force.y, force.z


def _variances(part: Any) -> str:
    return " ".join(f"{part.covariance[i]:g}" for i in (0, 7, 35))


def _layout(message: Any) -> Iterator[tuple[str, Any]]:
    yield "point_step", message.point_step
    yield "rgb_offset", next((f.offset for f in message.fields if f.name in ("rgb", "rgba")), "none")
    yield "organised", "yes" if message.height > 1 else "no"
    x = np.frombuffer(bytes(message.data), np.uint8).reshape(-1, message.point_step)[:, :4].copy().view(np.float32)
    odd = x[~np.isfinite(x)]
    yield "no_points", ("left out" if message.height == 1 else "none") if not odd.size else str(abs(odd.flat[0]))


def reached_speed(world: str, realism: str | None, part: str, axis: str, command: float) -> float:
    """Return the speed [m/s or rad/s] that the odometry shows for a constant command."""
    with simkit.load(world, realism=realism) as sim:
        speeds = Probe(sim, "/odom", lambda m: getattr(getattr(m.twist.twist, part), axis))
        for _ in range(6):
            sim.publish("/cmd_vel", {part: {axis: command}})
            sim.run(0.2)
        return float(np.median(speeds.kept[-4:]))


def _limits(world: str, realism: str | None) -> dict[str, Any]:
    """Return the largest commands that have an effect, and the track of the robot's odometry."""
    found: dict[str, Any] = {}
    for key, part, axis, small in (
        ("limit_x", "linear", "x", 0.5), ("limit_y", "linear", "y", 0.5), ("limit_turn", "angular", "z", 2.0)
    ):  # fmt: skip
        gain = reached_speed(world, realism, part, axis, small) / small
        found[key] = reached_speed(world, realism, part, axis, 3.5 * small) / gain
    with simkit.load(world, realism=realism) as sim:
        plugin = next(p for p in sim.world.models[-1].plugins if "Mecanum" in p.name)
        found["track"] = plugin.params.number("wheel_separation", 0.0)
    return found


def wall_row(realism: str | None, distance: float, images: int = 12, seed: int = 0) -> dict[str, Any]:
    """Return what the calibration in front of a wall measures: share of valid pixels, scale and noise.

    Args:
        realism: choice for `--realism`.
        distance: distance from the camera to the wall [m].
        images: number of images.
        seed: seed of the run.
    """
    text = WALL.format(x=0.057105 + distance + 0.1)
    with simkit.load(text, realism=realism, seed=seed) as sim:
        sensor = sim.sensor("x3::base_link::depth")
        found = Probe(sim, sensor.topic, depths_of)
        sim.run((images + 0.5) / sensor.update_rate)
        depths, truth = np.array(found.kept), depths_of(sensor.truth)
    is_wall = np.abs(truth - distance) < 1e-3
    is_floor = np.isfinite(truth) & (truth < distance - 1e-3)
    errors = depths[:, is_wall]
    seen = errors[np.isfinite(errors)]
    cells = np.isfinite(depths).mean(axis=0)
    rows, columns = cells.shape[0] // 6, cells.shape[1] // 8
    grid = cells[: 6 * rows, : 8 * columns].reshape(6, rows, 8, columns).mean(axis=(1, 3))
    return {
        "valid": 100 * float(np.isfinite(depths).mean()), "mean": float(seen.mean()), "sigma": float(seen.std()),
        "scale": 100 * (float(seen.mean()) / distance - 1),
        "floor": 100 * float(np.isfinite(depths[:, is_floor]).mean()),
        "grid": 100 * grid, "image": depths[-1],
    }  # fmt: skip
