"""Small worlds with a depth camera, and the messages of that camera."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
from sensor_worlds import box, cloud, depths, sensor, world

import simkit

SCENE = "<scene><ambient>1 1 1 1</ambient><background>0.2 0.4 0.6 1</background></scene>"
WALL = box("wall", "3.5 0 1 0 0 0", "1 19 19", colour="1 0 0")
TILT = math.radians(30)
OPTICAL = "<optical_frame_id>eye</optical_frame_id>"
LENS = "<distortion><k1>-0.15</k1><k2>0.03</k2><p1>0.002</p1></distortion>"
INTRINSICS = "<lens><intrinsics><fx>150</fx><fy>170</fy><cx>70</cx><cy>66</cy><s>{}</s></intrinsics></lens>"
CLASSIC = '<plugin name="p" filename="libgazebo_ros_camera.so">{}</plugin>'


def camera(
    more: str = "",
    *,
    kind: str = "rgbd_camera",
    width: int = 64,
    height: int = 48,
    clip: str = "<near>0.1</near><far>100</far>",
    plugin: str = "",
    extra: str = "<topic>c</topic>",
    **how: Any,
) -> str:
    block = f"""<camera><horizontal_fov>1.2</horizontal_fov>
      <image><width>{width}</width><height>{height}</height></image><clip>{clip}</clip>{more}</camera>"""
    return sensor(kind, block + plugin, extra=extra, **how)


def scene(sensors: str, others: str = "", **how: Any) -> str:
    return world(sensors, others=others, top=SCENE + how.pop("top", ""), **how)


def loaded(text: str, *topics: str) -> tuple[Any, list[Any]]:
    """Return a simulation that is already closed, and the first message of each topic."""
    with simkit.load(text) as sim:
        subs = [sim.subscribe(topic) for topic in topics]
        sim.run(0.02)
        return sim, [sub.messages[0] for sub in subs]


def first_messages(text: str, *topics: str) -> list[Any]:
    return loaded(text, *topics)[1]


def depth_of(text: str) -> npt.NDArray[np.float32]:
    (message,) = first_messages(text, "/c/depth_image")
    return depths(message)


def points_of(message: Any) -> npt.NDArray[np.float32]:
    found = cloud(message)
    return np.stack([found[axis] for axis in "xyz"], axis=-1)


def seen_at(points: npt.NDArray[Any], info: Any) -> npt.NDArray[Any]:
    """Return the pixels (n, 2) of points (n, 3) in optical axes, from K and D."""
    k, (k1, k2, p1, p2, k3) = info.k.reshape(3, 3), info.d
    x, y = points[:, 0] / points[:, 2], points[:, 1] / points[:, 2]
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    bent = np.stack(
        (
            x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
            x**0,
        ),
        axis=-1,
    )
    return (bent @ k.T)[:, :2]


def looks_at(pixels: npt.NDArray[Any], info: Any) -> npt.NDArray[Any]:
    """Return the directions of pixels (n, 2), x to the right and y down at distance 1, by K and D of `CameraInfo`."""
    k, (k1, k2, p1, p2, k3) = info.k.reshape(3, 3), info.d
    down = (pixels[:, 1] - k[1, 2]) / k[1, 1]
    right = (pixels[:, 0] - k[0, 2] - k[0, 1] * down) / k[0, 0]
    x, y = right, down
    for _ in range(40):
        r2 = x * x + y * y
        radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
        x, y = (
            (right - 2 * p1 * x * y - p2 * (r2 + 2 * x * x)) / radial,
            (down - p1 * (r2 + 2 * y * y) - 2 * p2 * x * y) / radial,
        )
    return np.stack((x, y), axis=-1)
