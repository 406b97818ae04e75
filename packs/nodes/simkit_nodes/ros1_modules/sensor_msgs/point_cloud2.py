"""Points of `sensor_msgs.msg.PointCloud2` as tuples."""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np

from simkit_nodes.interfaces import ROS1, ProgramMessage
from simkit_nodes.ros_modules.sensor_msgs_py import point_cloud2

__all__ = [
    "PointCloud2",
    "PointField",
    "create_cloud",
    "create_cloud_xyz32",
    "read_points",
    "read_points_list",
]

PointCloud2 = ROS1.message_class("sensor_msgs/msg/PointCloud2")
PointField = ROS1.message_class("sensor_msgs/msg/PointField")


def read_points(
    cloud: ProgramMessage,
    field_names: Iterable[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[tuple[int, int]] = (),
) -> Iterator[tuple[Any, ...]]:
    """Yield the points of a cloud.

    Args:
        cloud: `sensor_msgs.msg.PointCloud2`.
        field_names: names of the fields to read; all by default.
        skip_nans: leave out points with NaN.
        uvs: columns and rows of the points to read; all by default.
    """
    dtype = point_cloud2.dtype_from_fields(cloud.fields, cloud.point_step)
    dtype = dtype.newbyteorder(">" if cloud.is_bigendian else "<")
    strides = cloud.row_step, cloud.point_step
    points: Any = np.ndarray((cloud.height, cloud.width), dtype, bytes(cloud.data), strides=strides)
    places = list(uvs)
    points = points[[row for _, row in places], [column for column, _ in places]] if places else points.reshape(-1)
    names = list(dtype.names or ()) if field_names is None else list(field_names)
    for values in points[names].tolist():
        if not (skip_nans and any(value != value for value in values)):
            yield values


def read_points_list(
    cloud: ProgramMessage,
    field_names: Iterable[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[tuple[int, int]] = (),
) -> list[Any]:
    """Return the points of a cloud as named tuples; see `read_points`."""
    names = [field.name for field in cloud.fields] if field_names is None else list(field_names)
    point = namedtuple("Point", names)  # type: ignore[misc]
    return [point._make(values) for values in read_points(cloud, names, skip_nans, uvs)]


def create_cloud(header: ProgramMessage, fields: Sequence[Any], points: Iterable[Sequence[float]]) -> Any:
    """Return a `sensor_msgs.msg.PointCloud2`.

    Args:
        header: header of the cloud.
        fields: `sensor_msgs.msg.PointField` of each field.
        points: numbers of each point, in the order of the fields.
    """
    data = np.array([tuple(point) for point in points], point_cloud2.dtype_from_fields(fields))
    step = data.dtype.itemsize
    count = len(data)
    return PointCloud2(
        header=header,
        height=1,
        width=count,
        is_dense=False,
        is_bigendian=False,
        fields=list(fields),
        point_step=step,
        row_step=step * count,
        data=data.tobytes(),
    )


def create_cloud_xyz32(header: ProgramMessage, points: Iterable[Sequence[float]]) -> Any:
    """Return a `sensor_msgs.msg.PointCloud2` of points x, y, z [m]."""
    fields = [PointField(name, 4 * index, PointField.FLOAT32, 1) for index, name in enumerate("xyz")]
    return create_cloud(header, fields, points)
