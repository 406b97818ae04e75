"""Friction of wheels in the middle of their treads.

A wide wheel touches flat ground at the two ends of a line. While it turns about the vertical, both ends slip in
opposite directions. Under Coulomb's law the least drag then makes one end stick, and the wheel rolls on that edge. Its
track width is then wrong by half a wheel width, 6 % of the speed of a TurtleBot3 that turns on the spot. On the contact
line of a tyre the slip changes continuously. There a drag D moves the point without slip by D / (mu N) of half the
width.

Therefore both contacts keep their own normals, which hold the wheel upright, and share one friction point. It lies
where the contact line crosses the middle of the tread.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul, norm

_ALIGNED: Final = 0.999
"""Least cosine between the axis of a wheel's shape and that of its joint."""

_CENTRED: Final = 0.05
"""Largest distance of a wheel's shape from the axis of its joint, in radii."""

_LEVEL: Final = 0.9999
"""Least cosine between the normals of two contacts on one line."""

_SPHERE: Final = int(mujoco.mjtGeom.mjGEOM_SPHERE)
_DISCS: Final = (int(mujoco.mjtGeom.mjGEOM_CYLINDER), int(mujoco.mjtGeom.mjGEOM_MESH))

WHEEL_SHAPES: Final = (*_DISCS, _SPHERE, int(mujoco.mjtGeom.mjGEOM_ELLIPSOID))
"""Types of geoms that may be wheels; spheres and ellipsoids touch flat ground in one point."""

Floats = npt.NDArray[np.float64]

_ROTATION: Final = 5
"""Number of the coordinate of a free body that is its rotation about its vertical axis."""

WheelPair = tuple[Floats, Floats, list[int], bool]
"""Wheel and another geom that touch at several points.

- Axis of the wheel, a view of MuJoCo's data.
- Centre of the wheel's geom, a view of MuJoCo's data.
- Numbers of the contacts.
- True if all contacts have the same normal, because the other geom is a plane.
"""

_NO_ISLANDS: Final = int(mujoco.mjtDisableBit.mjDSBL_ISLAND)


def turns_freely(model: mujoco.MjModel, joint: int) -> bool:
    """Check whether a hinge turns more than once, and is the only joint of its body."""
    low, high = model.jnt_range[joint].tolist()
    is_free = not model.jnt_limited[joint] or high - low > 2.0 * np.pi
    return is_free and bool(model.body_jntnum[model.jnt_bodyid[joint]] == 1)


def wheel_column(model: mujoco.MjModel, geom: int, joint: int, kinds: Collection[int] = _DISCS) -> int | None:
    """Return the column of a geom's matrix about which the geom is a wheel on a joint; None if it is not a wheel.

    Args:
        model: MuJoCo's model.
        geom: geom of the body that the joint moves.
        joint: hinge.
        kinds: types of geoms that may be wheels.
    """
    kind = int(model.geom_type[geom])
    if kind not in kinds or not (model.geom_contype[geom] | model.geom_conaffinity[geom]):
        return None
    matrix = np.empty(9)
    mujoco.mju_quat2Mat(matrix, model.geom_quat[geom])
    along = np.abs(matmul(matrix.reshape(3, 3).T, model.jnt_axis[joint]))
    column = int(along.argmax())
    centre, size = model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]
    across = [i for i in range(3) if i != column]
    radius = float(size[across].max())
    offset = model.geom_pos[geom] + matmul(matrix.reshape(3, 3), centre) - model.jnt_pos[joint]
    off_axis = norm(np.cross(offset, model.jnt_axis[joint]))
    is_round = size[across].min() > (1.0 - _CENTRED) * radius
    is_aligned = along[column] > _ALIGNED or kind == _SPHERE
    is_wheel = is_aligned and is_round and off_axis < _CENTRED * radius and size[column] <= radius
    return column if is_wheel else None


class WheelContacts:
    """Wheels of one compiled model: shapes of revolution that turn freely about their own axis.

    Args:
        model: MuJoCo's model.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._is_sparse = bool(mujoco.mj_isSparse(model))
        self._has_islands = not model.opt.disableflags & _NO_ISLANDS
        self._axis_of: dict[int, int] = {}  # geom -> column of its matrix that is the axis
        # geoms of all contacts, their data, and what was derived from them
        self._geoms, self._pairs = b"", list[WheelPair]()
        self._data: mujoco.MjData | None = None
        self._weight = np.zeros(())  # NumPy multiplies by an array in half the time of a float
        if model.opt.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL:  # its rows are edges, not tangents
            return
        for joint in np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE).tolist():
            body = int(model.jnt_bodyid[joint])
            if turns_freely(model, joint):
                first = int(model.body_geomadr[body])
                for geom in range(first, first + int(model.body_geomnum[body])):
                    column = wheel_column(model, geom, joint)
                    if column is not None:
                        self._axis_of[geom] = column

    def __bool__(self) -> bool:
        return bool(self._axis_of)

    def merge(self, data: mujoco.MjData) -> bool:
        """Give the contacts of a line one friction point: the tangent rows of their Jacobians become equal.

        Args:
            data: MuJoCo's data with contacts, constraints and velocities.

        Returns:
            True if there was a line.
        """
        lines = self._lines(data) if self._axis_of else []
        if not lines:
            return False
        jacobian, count, factor = data.efc_J, self._model.nv, self._weight
        starts: list[int] | None = data.efc_J_rowadr.tolist() if self._is_sparse else None
        is_changed = False
        for low, high, weight in lines:
            first, second = low + 1, high + 1
            if starts is None:
                row = jacobian[first * count : (first + 2) * count]
                other = jacobian[second * count : (second + 2) * count]
            else:
                row = jacobian[starts[first] : starts[first + 1] + int(data.efc_J_rownnz[first])]
                other = jacobian[starts[second] : starts[second + 1] + int(data.efc_J_rownnz[second])]
            apart = other - row
            # the rotation about the vertical usually tells; counting takes a fifth of the time of `any`
            if apart.item(_ROTATION % apart.size) or np.count_nonzero(apart):
                factor[()] = weight
                apart *= factor
                row += apart
                other[:] = row
                is_changed = True
        if not is_changed:  # merged before: computing islands again would use more of the engine's memory
            return True
        if self._has_islands:
            mujoco.mj_island(self._model, data)
        mujoco.mj_referenceConstraint(self._model, data)
        return True

    def _lines(self, data: mujoco.MjData) -> list[tuple[int, int, float]]:
        """Return the rows of both ends of each contact line, and the relative position of the middle of the tread."""
        contact = data.contact
        geoms = contact.geom
        content = geoms.tobytes()
        if content != self._geoms or data is not self._data:  # the pairs in contact seldom change from step to step
            self._geoms, self._data, self._pairs = content, data, self._wheel_pairs(data, geoms.tolist())
        lines: list[tuple[int, int, float]] = []
        if not self._pairs:
            return lines
        rows, points = contact.efc_address.tolist(), contact.pos.tolist()
        for axis, centre, numbers, is_level in self._pairs:
            (a, b, c), (u, v, w) = axis.tolist(), centre.tolist()
            low = high = 0.0
            lowest = other = -1
            for number in numbers:
                x, y, z = points[number]
                place = a * (x - u) + b * (y - v) + c * (z - w)
                if rows[number] < 0:
                    continue
                if place < low:
                    low, lowest = place, number
                elif place > high:
                    high, other = place, number
            has_line = lowest >= 0 and other >= 0 and contact.dim.item(lowest) > 1
            if has_line and (is_level or _are_level(contact, lowest, other)):
                lines.append((rows[lowest], rows[other], -low / (high - low)))
        return lines

    def _wheel_pairs(self, data: mujoco.MjData, geoms: list[list[int]]) -> list[WheelPair]:
        """Return the pairs of geoms with at least two contacts and a wheel.

        Args:
            data: MuJoCo's data.
            geoms: both geoms of each contact.
        """
        axis_of, model = self._axis_of, self._model
        groups: dict[tuple[int, int], list[int]] = {}
        for number, (first, second) in enumerate(geoms):
            if first in axis_of or second in axis_of:
                groups.setdefault((first, second), []).append(number)
        pairs: list[WheelPair] = []
        for (first, second), numbers in groups.items():
            if len(numbers) > 1:
                wheel = second if second in axis_of else first
                is_level = bool((model.geom_type[[first, second]] == mujoco.mjtGeom.mjGEOM_PLANE).any())
                axis, centre = data.geom_xmat[wheel, axis_of[wheel] :: 3], data.geom_xpos[wheel]
                pairs.append((axis, centre, numbers, is_level))
        return pairs


def _are_level(contact: Any, first: int, other: int) -> bool:
    """Check whether two contacts have the same normal."""
    (a, b, c), (d, e, f) = contact.frame[[first, other], :3].tolist()
    return bool(a * d + b * e + c * f > _LEVEL)
