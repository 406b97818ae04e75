"""Export of the point clouds of a topic, as NumPy or PLY files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit.recording.export.images import NumberedFiles

if TYPE_CHECKING:
    from simkit.msgs import PointCloud2

PointArray = npt.NDArray[np.void]
"""Structured array with the fields of a point cloud."""
_KINDS: Final = ("", "i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8")  # sensor_msgs/msg/PointField
_PLY: Final = {
    "i1": "char",
    "u1": "uchar",
    "i2": "short",
    "u2": "ushort",
    "i4": "int",
    "u4": "uint",
    "f4": "float",
    "f8": "double",
}


def read_points(message: PointCloud2) -> PointArray:
    """Return the points of a point cloud as a structured array with its fields, including NaN and infinite points.

    Raises:
        ValueError: the fields and the size of the data do not match.
    """
    order = ">" if message.is_bigendian else "<"
    names, formats, offsets = [], [], []
    for field in message.fields:
        if not 1 <= int(field.datatype) < len(_KINDS):
            raise ValueError(f"a field {field.name!r} of a point cloud has the unknown type {field.datatype}")
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
        raise ValueError(f"a point cloud of {width} × {height} points of {step} bytes has {data.size} bytes")
    layout = np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": max(step, 1)})
    if not height or not width or not names:
        return np.empty(0, dtype=layout)
    rows = np.lib.stride_tricks.as_strided(data, (height, width * step), (row, 1))
    return np.ascontiguousarray(rows).reshape(-1).view(layout)


class CloudFiles(NumberedFiles):
    """Writer of one file per point cloud.

    Args:
        folder: folder to create for the files.
        ending: `npz`, with one array per field; or `ply`, binary, with colours from a field `rgb`.
    """

    def __init__(self, folder: Path, ending: str) -> None:
        super().__init__(folder)
        self._ending = ending

    def _write(self, target: Path, message: PointCloud2) -> Path:
        target = target.with_suffix(f".{self._ending}")
        found = read_points(message)
        with target.open("wb") as file:
            if self._ending == "ply":
                file.write(_ply_bytes(found))
            else:
                arrays = {name: np.ascontiguousarray(found[name]) for name in found.dtype.names or ()}
                np.savez_compressed(file, allow_pickle=False, **arrays)
        return target


def _ply_bytes(points: PointArray) -> bytes:
    """Return the finite points as binary PLY."""
    names = points.dtype.names or ()
    if {"x", "y", "z"} <= set(names):
        points = points[np.isfinite(points["x"]) & np.isfinite(points["y"]) & np.isfinite(points["z"])]
    parts: list[tuple[str, str, npt.NDArray[np.generic]]] = []
    for name in names:
        values = points[name]
        if name in ("rgb", "rgba") and values.dtype.itemsize == 4:
            packed = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("=")).view(np.uint32)
            for colour, shift in (("red", 16), ("green", 8), ("blue", 0)):
                parts.append((colour, "u1", (packed >> shift) & 255))
        else:
            parts.append((name, values.dtype.str[1:], values))
    packed_points = np.empty(len(points), dtype=[(name, "<" + kind) for name, kind, _ in parts])
    for name, _, values in parts:
        packed_points[name] = values
    lines = [f"property {_PLY[kind]} {name}" for name, kind, _ in parts]
    header = "\n".join(
        ("ply", "format binary_little_endian 1.0", f"element vertex {len(points)}", *lines, "end_header")
    )
    return header.encode() + b"\n" + packed_points.tobytes()
