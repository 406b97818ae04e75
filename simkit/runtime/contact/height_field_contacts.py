"""Contacts with the inner walls of a height field, which must not push.

MuJoCo builds a height field of prisms, one below each triangle. A body on it may touch the wall between two prisms,
with a normal along the ground. Without a correction, a box that slides down an even ramp stops at the border of two
cells.
"""

from __future__ import annotations

import math
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul

_STEEPEST: Final = 0.866
"""Cosine of 30°: the normal of an inner wall differs by more than 30° from all normals of the surrounding ground."""

Normal = tuple[float, float, float]


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

    def inner(self, data: mujoco.MjData) -> frozenset[int]:
        """Return the numbers of the contacts with inner walls.

        Args:
            data: MuJoCo's data with contacts.
        """
        contact, fields, numbers = data.contact, self._fields, []
        for number, (first, second) in enumerate(contact.geom.tolist()):
            if first in fields or second in fields:
                field, sign = (first, 1.0) if first in fields else (second, -1.0)
                turn = data.geom_xmat[field].reshape(3, 3)
                point = matmul(contact.pos[number] - data.geom_xpos[field], turn)
                normal = matmul(sign * contact.frame[number, :3], turn)
                if self._is_inner(fields[field], point, normal):
                    numbers.append(number)
        return frozenset(numbers)

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
