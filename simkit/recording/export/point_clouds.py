"""Export of the point clouds of a topic, as NumPy or PLY files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit.msgs.point_arrays import PointArray, read_points
from simkit.recording.export.images import NumberedFiles

if TYPE_CHECKING:
    from simkit.msgs import PointCloud2

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
        points = read_points(message)
        with target.open("wb") as file:
            if self._ending == "ply":
                file.write(_ply_bytes(points))
            else:
                arrays = {name: np.ascontiguousarray(points[name]) for name in points.dtype.names or ()}
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
