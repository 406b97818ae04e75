"""Points of point cloud messages as structured NumPy arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit.argument_checks import wrong_type
from simkit.errors import ArgumentValueError
from simkit.number_text import counted

if TYPE_CHECKING:
    from simkit.msgs.message_classes import PointCloud2

PointArray = npt.NDArray[np.void]
"""Structured array with the fields of a point cloud."""
_KINDS: Final = ("", "i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8")  # sensor_msgs/msg/PointField


def points(message: PointCloud2) -> PointArray:
    """Return the points of a point cloud as a structured array: `points(m)["x"]` has the x of all points [m].

    Args:
        message: `sensor_msgs/msg/PointCloud2`.

    Returns:
        New array, shape (height · width,), with one field for each field of the message, including NaN and infinite
        points. A field with a count above 1 becomes several fields: `name_0`, `name_1`, ….

    Raises:
        ArgumentTypeError: the message is not a point cloud.
        ArgumentValueError: the fields and the size of the data do not match.
    """
    if getattr(message, "__msgtype__", "") != "sensor_msgs/msg/PointCloud2":
        raise wrong_type("the point cloud", "a sensor_msgs/msg/PointCloud2", message)
    read = read_points(message)
    names = read.dtype.names or ()
    packed = np.empty(read.shape, [(name, read.dtype[name].newbyteorder("=")) for name in names])
    for name in names:
        packed[name] = read[name]
    return packed


def read_points(message: PointCloud2) -> PointArray:
    """Return the points of a point cloud as a structured array with its fields, including NaN and infinite points.

    The array has the layout of the message, and may share its memory.

    Raises:
        ArgumentValueError: the fields and the size of the data do not match.
    """
    order = ">" if message.is_bigendian else "<"
    names, formats, offsets = [], [], []
    for field in message.fields:
        if not 1 <= int(field.datatype) < len(_KINDS):
            raise ArgumentValueError(f"a field {field.name!r} of a point cloud has the unknown type {field.datatype}")
        if int(field.count) > int(message.point_step):  # a loop over 4e9 values would take an hour
            text = f"a field {field.name!r} of a point cloud has {counted(field.count, 'value')}"
            raise ArgumentValueError(f"{text} in a point of {message.point_step} bytes")
        for number in range(max(1, int(field.count))):
            kind = np.dtype(order + _KINDS[int(field.datatype)])
            names.append(str(field.name) if int(field.count) <= 1 else f"{field.name}_{number}")
            formats.append(kind)
            offsets.append(int(field.offset) + number * kind.itemsize)
    height, width, step = int(message.height), int(message.width), int(message.point_step)
    row = int(message.row_step) or width * step
    data = np.asarray(message.data).view(np.uint8).ravel()
    ends = [offset + kind.itemsize for offset, kind in zip(offsets, formats, strict=True)]
    if (
        len(set(names)) != len(names)
        or (ends and max(ends) > step)
        or (height and data.size < row * (height - 1) + width * step)
    ):
        raise ArgumentValueError(
            f"a point cloud of {width} × {height} points of {step} bytes has {counted(data.size, 'byte')}"
        )
    layout = np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": max(step, 1)})
    if not height or not width or not names:
        return np.empty(0, dtype=layout)
    rows = np.lib.stride_tricks.as_strided(data, (height, width * step), (row, 1))
    return np.ascontiguousarray(rows).reshape(-1).view(layout)
