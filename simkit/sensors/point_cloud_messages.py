"""`PointCloud2` messages from structured arrays, and the `PointCloud` messages of before."""

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
    field = msgs.type_of("sensor_msgs/msg/PointField")
    assert dtype.fields is not None
    assert dtype.names is not None
    return tuple(
        field(name, dtype.fields[name][1], DATATYPES[dtype.fields[name][0].str[1:]], 1) for name in dtype.names
    )


def point_cloud(
    header: msgs.Header, points: npt.NDArray[np.void], height: int, width: int, is_dense: bool
) -> msgs.PointCloud2:
    """A cloud of `height` rows of `width` points.

    Args:
        header: of the message.
        points: structured array, shape (height · width,), contiguous; its fields are the cloud's.
        is_dense: whether every point is finite.
    """
    step = points.dtype.itemsize
    data = points.view(np.uint8).reshape(-1) if points.size else np.empty(0, dtype=np.uint8)
    make = msgs.type_of("sensor_msgs/msg/PointCloud2")
    message: msgs.PointCloud2 = make(
        header, height, width, list(_fields(points.dtype)), False, step, step * width, data, is_dense
    )
    return message


def legacy_point_cloud(header: msgs.Header, places: Vector, intensities: Vector) -> msgs.PointCloud:
    """A `sensor_msgs/msg/PointCloud`.

    Args:
        header: of the message.
        places: [m], shape (n, 3).
        intensities: shape (n,), its only channel.
    """
    point, channel = msgs.type_of("geometry_msgs/msg/Point32"), msgs.type_of("sensor_msgs/msg/ChannelFloat32")
    points = [point(*place) for place in places.tolist()]
    message: msgs.PointCloud = msgs.type_of(LEGACY_CLOUD_TYPE)(
        header, points, [channel("intensity", intensities.astype(np.float32))]
    )
    return message
