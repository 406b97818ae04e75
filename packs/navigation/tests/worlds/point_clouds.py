"""Point clouds of a camera on a robot."""

from __future__ import annotations

from typing import Any

import numpy as np
from navigation_worlds import place

import simkit
from simkit import msgs
from simkit.sensors.point_cloud_messages import point_cloud


def send(sim: simkit.Simulation, points: Any, frame: str = "camera") -> None:
    """Publish a point cloud."""
    points = np.asarray(points, np.float32).reshape(-1, 3)
    table = np.zeros(len(points), [("x", "<f4"), ("y", "<f4"), ("z", "<f4")])
    table["x"], table["y"], table["z"] = points.T
    cloud = point_cloud(msgs.header(sim.time_ns, frame), table, 1, len(points), True)
    sim.advertise("/points", "sensor_msgs/msg/PointCloud2").publish(cloud)


def place_camera(sim: simkit.Simulation, height: float = 0.55) -> None:
    """Place the robot at the origin, with a camera above it that looks along x."""
    place(sim)
    transform = {"translation": {"z": height}, "rotation": {"w": 1.0}}
    stamped = {
        "header": msgs.header(sim.time_ns, "base_footprint"),
        "child_frame_id": "camera",
        "transform": transform,
    }
    sim.advertise("/tf_static", "tf2_msgs/msg/TFMessage", latched=True).publish({"transforms": [stamped]})
