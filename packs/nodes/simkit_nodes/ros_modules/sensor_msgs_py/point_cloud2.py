"""Points of `sensor_msgs.msg.PointCloud2` as NumPy arrays."""

from __future__ import annotations

import sys
from array import array
from collections import namedtuple
from collections.abc import Iterable, Sequence
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from numpy.lib.recfunctions import structured_to_unstructured, unstructured_to_structured

from simkit_nodes.interfaces import ROS2, ProgramMessage

__all__ = [
    "DUMMY_FIELD_PREFIX",
    "Header",
    "PointCloud2",
    "PointField",
    "create_cloud",
    "create_cloud_xyz32",
    "dtype_from_fields",
    "read_points",
    "read_points_list",
    "read_points_numpy",
]

PointCloud2 = ROS2.message_class("sensor_msgs/msg/PointCloud2")
PointField = ROS2.message_class("sensor_msgs/msg/PointField")
Header = ROS2.message_class("std_msgs/msg/Header")

Points = npt.NDArray[Any]
DUMMY_FIELD_PREFIX: Final = "unnamed_field"
"""Name of fields without a name; their number follows."""

_DATATYPES: Final = dict(enumerate(("i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8"), PointField.INT8))
"""NumPy's type of each type of fields."""

_IS_BIG_ENDIAN: Final = sys.byteorder != "little"


def read_points(
    cloud: ProgramMessage,
    field_names: Iterable[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
    reshape_organized_cloud: bool = False,
) -> Points:
    """Return the points of a cloud as a structured array that shares the cloud's memory, where this is possible.

    Args:
        cloud: `sensor_msgs.msg.PointCloud2`.
        field_names: names of the fields to read; all by default.
        skip_nans: leave out points with NaN, unless the cloud says that it has none.
        uvs: numbers of the points to read; all by default.
        reshape_organized_cloud: return an array (width, height) for a cloud with rows.

    Raises:
        AssertionError: the argument is no cloud, or it lacks a field.
    """
    _require(isinstance(cloud, PointCloud2), "Cloud is not a sensor_msgs.msg.PointCloud2")
    dtype = dtype_from_fields(cloud.fields, point_step=cloud.point_step)
    points: Points = np.ndarray((cloud.width * cloud.height,), dtype, buffer=cloud.data)
    if field_names is not None:
        names = list(field_names)
        known = dtype.names or ()
        _require(all(name in known for name in names), "Requests field is not in the fields of the PointCloud!")
        points = points[names]
    if bool(cloud.is_bigendian) is not _IS_BIG_ENDIAN:
        points = points.byteswap(inplace=True)
    if skip_nans and not cloud.is_dense:
        is_number = np.ones(len(points), bool)
        for name in points.dtype.names or ():
            is_number &= ~np.isnan(points[name])
        points = points[is_number]
    if uvs is not None:
        points = points[uvs if isinstance(uvs, np.ndarray) else np.fromiter(uvs, int)]
    if reshape_organized_cloud and cloud.height > 1:
        points = points.reshape(cloud.width, cloud.height)
    return points


def read_points_numpy(
    cloud: ProgramMessage,
    field_names: Iterable[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
    reshape_organized_cloud: bool = False,
) -> Points:
    """Return the points of a cloud as an array with a column for each field; see `read_points`.

    Raises:
        AssertionError: the fields have different types.
    """
    names = None if field_names is None else list(field_names)
    fields = [field for field in cloud.fields[1:] if names is None or field.name in names]
    _require(
        all(cloud.fields[0].datatype == field.datatype for field in fields),
        "All fields need to have the same datatype. Use `read_points()` otherwise.",
    )
    points = read_points(cloud, names, skip_nans, uvs, reshape_organized_cloud)
    return structured_to_unstructured(points)


def read_points_list(
    cloud: ProgramMessage,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
) -> list[Any]:
    """Return the points of a cloud as named tuples; see `read_points`."""
    _require(isinstance(cloud, PointCloud2), "cloud is not a sensor_msgs.msg.PointCloud2")
    names = [field.name for field in cloud.fields] if field_names is None else field_names
    point_class = namedtuple("Point", names)  # type: ignore[misc]
    return [point_class._make(point) for point in read_points(cloud, names, skip_nans, uvs)]


def dtype_from_fields(fields: Iterable[Any], point_step: int | None = None) -> np.dtype[Any]:
    """Return the type of a structured array with the points of a cloud.

    Args:
        fields: `sensor_msgs.msg.PointField` of the cloud; one with several numbers becomes `name_0`, `name_1`, …
        point_step: length of a point [bytes]; up to the end of the last field by default.

    Raises:
        AssertionError: a field has no numbers, or two have one name.
    """
    names: list[str] = []
    formats: list[str] = []
    offsets: list[int] = []
    for number, field in enumerate(fields):
        dtype = np.dtype(_DATATYPES[field.datatype])
        name = field.name or f"{DUMMY_FIELD_PREFIX}_{number}"
        _require(field.count > 0, "Can't process fields with count = 0.")
        for index in range(field.count):
            part = f"{name}_{index}" if field.count > 1 else name
            _require(part not in names, "Duplicate field names are not allowed!")
            names.append(part)
            formats.append(dtype.str)
            offsets.append(field.offset + index * dtype.itemsize)
    description: dict[str, Any] = {"names": names, "formats": formats, "offsets": offsets}
    if point_step is not None:
        description["itemsize"] = point_step
    return np.dtype(description)  # type: ignore[call-overload,no-any-return]


def create_cloud(
    header: ProgramMessage, fields: Sequence[Any], points: Iterable[Any], point_step: int | None = None
) -> Any:
    """Return a `sensor_msgs.msg.PointCloud2`.

    Args:
        header: `std_msgs.msg.Header`.
        fields: `sensor_msgs.msg.PointField` of the cloud.
        points: array with a column for each field, structured array, or sequences of numbers; an array with one more
            axis makes a cloud with rows.
        point_step: length of a point [bytes]; up to the end of the last field by default.

    Raises:
        AssertionError: points and fields do not fit.
    """
    dtype = dtype_from_fields(fields, point_step)
    if not isinstance(points, np.ndarray):
        points = np.array([tuple(point) for point in points], dtype)
    elif points.dtype.names is None:
        _require(
            all(fields[0].datatype == field.datatype for field in fields[1:]),
            "All fields need to have the same datatype. Pass a structured NumPy array with multiple dtypes otherwise.",
        )
        points = unstructured_to_structured(points, dtype=dtype)
    else:
        _require(
            points.dtype == dtype,
            "PointFields and structured NumPy array dtype do not match for all fields! "
            "Check their field order, names and types.",
        )
    _require(
        points.ndim <= 2,
        "Too many dimensions for organized cloud! Points can only be organized in max. two dimensional space",
    )
    data = array("B")
    data.frombytes(np.ascontiguousarray(points).view("u1").data if points.size else b"")
    width, height = points.shape[0], points.shape[1] if points.ndim == 2 else 1
    cloud = PointCloud2(
        header=header,
        height=height,
        width=width,
        is_dense=False,
        is_bigendian=_IS_BIG_ENDIAN,
        fields=fields,
        point_step=points.dtype.itemsize,
        row_step=points.dtype.itemsize * width,
    )
    cloud.data = data
    return cloud


def create_cloud_xyz32(header: ProgramMessage, points: Iterable[Any]) -> Any:
    """Return a `sensor_msgs.msg.PointCloud2` with the fields x, y and z; see `create_cloud`."""
    fields = [
        PointField(name=name, offset=4 * number, datatype=PointField.FLOAT32, count=1)
        for number, name in enumerate("xyz")
    ]
    return create_cloud(header, fields, points)


def _require(condition: bool, text: str) -> None:
    """Raise the AssertionError that ROS's function raises, also where Python does not check assertions."""
    if not condition:
        raise AssertionError(text)
