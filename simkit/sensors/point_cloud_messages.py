"""Conversion of arrays into `PointCloud2` messages and older `PointCloud` messages."""

from __future__ import annotations

import functools

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.pose import Vector

LEGACY_CLOUD_TYPE = "sensor_msgs/msg/PointCloud"
DATATYPES = {"u1": 2, "i2": 3, "u2": 4, "i4": 5, "u4": 6, "f4": 7, "f8": 8}


@functools.lru_cache(maxsize=32)
def _fields(dtype: np.dtype[np.void]) -> tuple[msgs.PointField, ...]:
    assert dtype.fields is not None
    fields = [(name, *dtype.fields[name]) for name in dtype.names or ()]
    return tuple(msgs.PointField(name, offset, DATATYPES[kind.str[1:]], 1) for name, kind, offset, *_ in fields)


def point_cloud(
    header: msgs.Header, points: npt.NDArray[np.void], height: int, width: int, is_dense: bool
) -> msgs.PointCloud2:
    """Make a cloud of `height` rows of `width` points.

    Args:
        header: header of the message.
        points: structured array, shape (height · width,), contiguous; its fields are the cloud's.
        height: rows.
        width: points in a row.
        is_dense: True if every point is finite.
    """
    step = points.dtype.itemsize
    data = points.view(np.uint8).reshape(-1) if points.size else np.empty(0, dtype=np.uint8)
    fields = list(_fields(points.dtype))
    return msgs.PointCloud2(header, height, width, fields, False, step, step * width, data, is_dense)


def legacy_point_cloud(header: msgs.Header, positions: Vector, intensities: Vector) -> msgs.PointCloud:
    """Make a `sensor_msgs/msg/PointCloud`.

    Args:
        header: header of the message.
        positions: positions of the points [m], shape (n, 3).
        intensities: intensities of the points, shape (n,), the only channel.
    """
    point = msgs.Point32
    points = [point(*position) for position in positions.tolist()]
    return msgs.PointCloud(header, points, [msgs.ChannelFloat32("intensity", intensities.astype(np.float32))])
