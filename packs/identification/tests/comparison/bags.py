"""Bags with known statistics."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from simkit import msgs
from simkit.recording.bags.writer import McapBag

Entry = tuple[str, float, Any]
"""Topic, time of receipt [s], and message."""


def write_bag(path: Path, entries: Iterable[Entry]) -> Path:
    """Write messages to a bag, in the order of their times."""
    bag = McapBag(path)
    for topic, time, message in sorted(entries, key=lambda entry: entry[1]):
        channel = bag.channel(topic, msgs.type_name(message), False)
        bag.write_raw(channel, msgs.serialize(message), round(time * 1e9))
    bag.close()
    return path


def header(time: float) -> Any:
    return msgs.header(round(time * 1e9), "frame")


def imu(time: float, gyro: Iterable[float] = (0.0, 0.0, 0.0), acceleration: Iterable[float] = (0.0, 0.0, 9.8)) -> Any:
    gx, gy, gz = map(float, gyro)
    ax, ay, az = map(float, acceleration)
    return msgs.make(
        "sensor_msgs/msg/Imu",
        header=header(time),
        angular_velocity={"x": gx, "y": gy, "z": gz},
        linear_acceleration={"x": ax, "y": ay, "z": az},
    )


def number(value: float) -> Any:
    return msgs.make("std_msgs/msg/Float64", data=float(value))


def scan(time: float, ranges: np.ndarray) -> Any:
    return msgs.make(
        "sensor_msgs/msg/LaserScan",
        header=header(time),
        angle_max=6.28,
        angle_increment=6.28 / len(ranges),
        range_min=0.1,
        range_max=20.0,
        ranges=np.asarray(ranges, np.float32),
    )


def odometry(time: float, x: float, yaw: float, speed: float, turn: float) -> Any:
    return msgs.make(
        "nav_msgs/msg/Odometry",
        header=header(time),
        pose={
            "pose": {
                "position": {"x": float(x)},
                "orientation": {"z": float(np.sin(yaw / 2.0)), "w": float(np.cos(yaw / 2.0))},
            }
        },
        twist={"twist": {"linear": {"x": float(speed)}, "angular": {"z": float(turn)}}},
    )


def velocity(speed: float, turn: float = 0.0) -> Any:
    return msgs.make("geometry_msgs/msg/Twist", linear={"x": speed}, angular={"z": turn})


def depth_image(time: float, depths: np.ndarray) -> Any:
    height, width = depths.shape
    data = np.ascontiguousarray(depths, np.float32).view(np.uint8).ravel()
    return msgs.make(
        "sensor_msgs/msg/Image",
        header=header(time), height=height, width=width, encoding="32FC1", step=width * 4, data=data,
    )  # fmt: skip
