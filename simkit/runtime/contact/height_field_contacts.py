"""Contacts with the inner walls of a height field, which must not push.

MuJoCo builds a height field of prisms, one below each triangle. A body on it may touch the wall between two prisms,
with a normal along the ground. Without a correction, a box that slides down an even ramp stops at the border of two
cells.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul

_STEEPEST: Final = 0.866
"""Cosine of 30°: the normal of an inner wall differs by more than 30° from all normals of the surrounding ground."""

_ARRAY_THRESHOLD: Final = 60
"""Number of contacts from which arrays select those to look at."""

Floats = npt.NDArray[np.float64]
Normal = tuple[float, float, float]


class CellGround(NamedTuple):
    """Ground of the cells of a height field below points.

    Attributes:
        is_inside: True for points above or below the height field.
        level: height of the ground [m].
        slopes: slopes along x and y of the two triangles of each cell.
        is_first: True if the first triangle is at the point.
    """

    is_inside: npt.NDArray[np.bool_]
    level: Floats
    slopes: tuple[tuple[Floats, Floats], tuple[Floats, Floats]]
    is_first: npt.NDArray[np.bool_]

    @classmethod
    def at(cls, model: mujoco.MjModel, field: int, points: Floats) -> CellGround:
        """Return the ground at points.

        Args:
            model: MuJoCo's model.
            field: number of the height field.
            points: positions in the frame of the height field [m], shape (..., 3).
        """
        rows, columns = int(model.hfield_nrow[field]), int(model.hfield_ncol[field])
        half_x, half_y, height, _ = model.hfield_size[field].tolist()
        step_x, step_y = 2.0 * half_x / (columns - 1), 2.0 * half_y / (rows - 1)
        start = int(model.hfield_adr[field])
        heights = model.hfield_data[start : start + rows * columns]
        along_x, along_y = (points[..., 0] + half_x) / step_x, (points[..., 1] + half_y) / step_y
        column = np.clip(np.floor(along_x), 0, columns - 2).astype(np.intp)
        row = np.clip(np.floor(along_y), 0, rows - 2).astype(np.intp)
        x, y, first = along_x - column, along_y - row, row * columns + column
        # the engine's prisms have the diagonal from (row, column + 1) to (row + 1, column)
        a, b, c, d = (height * heights[first + n].astype(float) for n in (0, 1, columns, columns + 1))
        is_first = x + y <= 1.0
        level = np.where(is_first, a + (b - a) * x + (c - a) * y, d + (c - d) * (1.0 - x) + (b - d) * (1.0 - y))
        slopes = ((b - a) / step_x, (c - a) / step_y), ((d - c) / step_x, (d - b) / step_y)
        return cls((x >= 0.0) & (x <= 1.0) & (y >= 0.0) & (y <= 1.0), level, slopes, is_first)


class HeightFieldContacts:
    """Height fields of one compiled model.

    Args:
        model: MuJoCo's model.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        geoms = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_HFIELD)
        self._fields: dict[int, int] = dict(zip(geoms.tolist(), model.geom_dataid[geoms].tolist(), strict=True))

    def __bool__(self) -> bool:
        return bool(self._fields)

    def __contains__(self, geom: int) -> bool:
        return geom in self._fields

    def inner(self, data: mujoco.MjData) -> frozenset[int]:
        """Return the numbers of the contacts with inner walls.

        Args:
            data: MuJoCo's data with contacts.
        """
        geoms: list[list[int]] = data.contact.geom.tolist()
        fields, numbers = self._fields, []
        chosen = range(len(geoms)) if len(geoms) <= _ARRAY_THRESHOLD else self._doubtful(data)
        for number in chosen:
            first, second = geoms[number]
            if first in fields or second in fields:
                field, sign = (first, 1.0) if first in fields else (second, -1.0)
                if self.is_inner(data, number, field, sign):
                    numbers.append(number)
        return frozenset(numbers)

    def _doubtful(self, data: mujoco.MjData) -> list[int]:
        """Return the contacts whose normal differs from both triangles of their cell, computed on arrays."""
        contact, doubtful = data.contact, list[int]()
        for geom, field in self._fields.items():
            is_first, is_second = contact.geom[:, 0] == geom, contact.geom[:, 1] == geom
            numbers = (is_first | is_second).nonzero()[0]
            turn = data.geom_xmat[geom].reshape(3, 3)
            normals = contact.frame[numbers, :3] * np.where(is_first[numbers], 1.0, -1.0)[:, None]
            points = _turned_back(turn, contact.pos[numbers] - data.geom_xpos[geom])
            cell = CellGround.at(self._model, field, points)
            x, y, z = _turned_back(turn, normals).T
            is_near = np.zeros(len(numbers), bool)
            for slope_x, slope_y in cell.slopes:
                size = np.sqrt(slope_x * slope_x + slope_y * slope_y + 1.0)
                is_near |= z - slope_x * x - slope_y * y > _STEEPEST * 1.001 * size
            doubtful += numbers[~(is_near & cell.is_inside)].tolist()
        return sorted(doubtful)

    def is_inner(self, data: mujoco.MjData, number: int, field: int, sign: float) -> bool:
        """Check whether a contact is with an inner wall.

        Args:
            data: MuJoCo's data with contacts.
            number: number of the contact.
            field: geom id of the height field.
            sign: 1 if the height field is the first geom of the contact, else -1.
        """
        turn = data.geom_xmat[field].reshape(3, 3)
        point = matmul(data.contact.pos[number] - data.geom_xpos[field], turn)
        return self._is_inner(self._fields[field], point, matmul(sign * data.contact.frame[number, :3], turn))

    def _is_inner(self, field: int, point: npt.NDArray[np.float64], normal: npt.NDArray[np.float64]) -> bool:
        """Check whether a normal differs from those of the surrounding, nearly even ground.

        Args:
            field: number of the height field.
            point: position in the frame of the height field [m].
            normal: unit normal in the frame of the height field.
        """
        model = self._model
        rows, columns = int(model.hfield_nrow[field]), int(model.hfield_ncol[field])
        half_x, half_y, height, _ = model.hfield_size[field].tolist()
        step_x, step_y = 2.0 * half_x / (columns - 1), 2.0 * half_y / (rows - 1)
        row, column = int((point[1] + half_y) / step_y), int((point[0] + half_x) / step_x)
        start = int(model.hfield_adr[field])
        if 0 <= row < rows - 1 and 0 <= column < columns - 1:  # most contacts touch the triangles of this cell
            at, data = start + row * columns + column, model.hfield_data
            a, b, c, d = (height * data.item(i) for i in (at, at + 1, at + columns, at + columns + 1))
            x, y, z = normal.tolist()
            for slope_x, slope_y in (((b - a) / step_x, (c - a) / step_y), ((d - c) / step_x, (d - b) / step_y)):
                size = math.sqrt(slope_x * slope_x + slope_y * slope_y + 1.0)
                if z - slope_x * x - slope_y * y > _STEEPEST * size:
                    return False
        heights = model.hfield_data[start : start + rows * columns].reshape(rows, columns)
        around = heights[max(0, row - 1) : row + 3, max(0, column - 1) : column + 3] * height
        if min(around.shape) < 2:
            return False
        along_x, along_y = np.diff(around, axis=1) / step_x, np.diff(around, axis=0) / step_y
        # each triangle has one edge along x and one along y: a cell has four such pairs, two of them are triangles
        x = np.stack((along_x[:-1], along_x[1:], along_x[:-1], along_x[1:]))
        y = np.stack((along_y[:, :-1], along_y[:, 1:], along_y[:, 1:], along_y[:, :-1]))
        normals = np.stack((-x, -y, np.ones_like(x)), axis=-1).reshape(-1, 3)
        normals /= np.sqrt((normals * normals).sum(axis=1))[:, None]
        mean = normals.mean(axis=0)
        is_even = matmul(normals, mean).min() > _STEEPEST * float(np.sqrt(matmul(mean, mean)))
        return bool(is_even and matmul(normals, normal).max() < _STEEPEST)


def _turned_back(turn: Floats, vectors: Floats) -> Floats:
    """Return vectors in the frame of a rotation; sums in a fixed order, for the same bits on every processor."""
    x, y, z = vectors[..., 0, None], vectors[..., 1, None], vectors[..., 2, None]
    return np.asarray(turn[0] * x + turn[1] * y + turn[2] * z)
