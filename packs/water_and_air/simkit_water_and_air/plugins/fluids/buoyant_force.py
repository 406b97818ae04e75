"""Buoyant force on links in a fluid with horizontal layers, by Archimedes' principle."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from simkit.extend import SharedByCopies, Vector
from simkit.linear_algebra import matmul
from simkit_water_and_air.plugins.fluids.collision_volumes import Hull
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, cross
from simkit_water_and_air.plugins.fluids.submerged_volume import Solid

if TYPE_CHECKING:
    import mujoco

    from simkit import Simulation

_ZERO: Final = np.zeros(3)
_SAME: Final = 1e-9  # [m], largest distance between centre of volume and centre of mass that counts as zero
_FEW: Final = 32  # hulls; up to this number of hulls, Python floats are several times faster than arrays
Three = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Fluid:
    """Horizontal layers of a fluid.

    Attributes:
        densities: Density of each layer, lowest first [kg/m³].
        heights: World heights of the boundaries between the layers [m], in ascending order.
    """

    densities: tuple[float, ...]
    heights: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Immersion:
    """Layers in which the hulls are at one tick.

    Attributes:
        low, high: Indices of the lowest and highest layer that each hull can reach into, for any orientation.
        steady: True for each link whose force is the same in any orientation, while the link is in the same layer.
        masses: Mass of the fluid that each steady link displaces [kg]; zero for the other links.
    """

    low: Sequence[int]
    high: Sequence[int]
    steady: tuple[bool, ...]
    masses: tuple[float, ...]


class _Part(NamedTuple):
    """Hull of the link with index `owner`, as Python floats.

    `axes` and `origin` are the frame of the solid in the link's frame; `axes` is None if both frames have equal axes.
    """

    owner: int
    volume: float
    centre: Three
    reach: float
    solid: Solid | None
    axes: list[list[float]] | None
    origin: Three
    middle: Three


class BuoyantForces(SharedByCopies):
    """Buoyant forces on the links of one compiled model. A deep copy returns the same object.

    Args:
        sim: Simulation of the links.
        hulls: Hulls of each link, by scoped name of the link.
        fluid: Fluid around the links.
    """

    def __init__(self, sim: Simulation, hulls: Mapping[str, Sequence[Hull]], fluid: Fluid) -> None:
        self.links = PushedLinks(sim, [name for name, parts in hulls.items() if parts])
        self.fluid = fluid
        parts = [(index, hull) for index, name in enumerate(self.links.names) for hull in hulls[name]]
        self._hulls = [hull for _, hull in parts]
        self._owners = np.array([index for index, _ in parts], dtype=np.intp)
        self._volumes = np.array([hull.volume for hull in self._hulls])
        self._centres = np.array([hull.centre for hull in self._hulls]).reshape(-1, 3)
        self._reach = np.array([hull.reach for hull in self._hulls])
        self._solid_axes = np.array([hull.axes for hull in self._hulls]).reshape(-1, 3, 3)
        self._solid_origins = np.array([hull.origin for hull in self._hulls]).reshape(-1, 3)
        self._solid_centres = np.array([h.solid.centre if h.solid else _ZERO for h in self._hulls]).reshape(-1, 3)
        self._densities, self._heights = np.array(fluid.densities), np.array(fluid.heights)
        self._whole = self._summed(self._volumes[:, None])[:, 0]
        self._is_even = self._find_even(sim.mj_model)
        self._always: Immersion | None = None
        self._parts = [_part(*part) for part in parts] if len(parts) <= _FEW else []
        self._evens, self._wholes = self._is_even.tolist(), self._whole.tolist()

    def _find_even(self, model: mujoco.MjModel) -> npt.NDArray[np.bool_]:
        """Return for each link whether its centre of volume is at its centre of mass."""
        middle = self._summed(self._volumes[:, None] * self._centres)
        middle /= np.maximum(self._whole[:, None], 1e-300)
        away = middle - model.body_ipos[self.links.bodies]
        even: npt.NDArray[np.bool_] = (away * away).sum(axis=1) < _SAME**2
        return even

    @property
    def is_all_steady(self) -> bool:
        """True if all forces are constant, because they do not depend on the poses of the links."""
        return not self.fluid.heights and bool(self._is_even.all())

    def find_immersion(self, data: mujoco.MjData) -> Immersion:
        """Determine the layers of all hulls from the poses of the links in `data`."""
        if not len(self._heights):
            if self._always is None:
                lowest = [0] * len(self._hulls)
                masses = self._masses(np.zeros(len(self.links), int))
                self._always = Immersion(lowest, lowest, tuple(self._evens), tuple(masses.tolist()))
            return self._always
        if self._parts:
            return self._find_immersion_few(data)
        axes = self.links.axes(data)[self._owners]
        z = data.xpos[self.links.bodies, 2][self._owners] + (axes[:, 2] * self._centres).sum(axis=1)
        low, high = (np.searchsorted(self._heights, z + s * self._reach, side="right") for s in (-1.0, 1.0))
        first = np.zeros(len(self.links), dtype=np.intp)
        first[self._owners] = low
        is_split = (low != high) | (low != first[self._owners])
        steady = self._is_even.copy()
        steady[self._owners[is_split]] = False
        masses = np.where(steady, self._masses(first), 0.0)
        return Immersion(low.tolist(), high.tolist(), tuple(steady.tolist()), tuple(masses.tolist()))

    def _find_immersion_few(self, data: mujoco.MjData) -> Immersion:
        heights, densities = self.fluid.heights, self.fluid.densities
        rows, places = data.xmat[self.links.bodies, 6:].tolist(), data.xpos[self.links.bodies, 2].tolist()
        low, high, steady = [], [], list(self._evens)
        layers: dict[int, int] = {}
        for part in self._parts:
            owner = part.owner
            (a, b, c), (x, y, z), reach = rows[owner], part.centre, part.reach
            level = places[owner] + (a * x + b * y + c * z)
            lowest, highest = bisect_right(heights, level - reach), bisect_right(heights, level + reach)
            low.append(lowest)
            high.append(highest)
            if lowest != highest or layers.setdefault(owner, lowest) != lowest:
                steady[owner] = False
        masses = [
            densities[layers[owner]] * volume if is_steady else 0.0
            for owner, (is_steady, volume) in enumerate(zip(steady, self._wholes, strict=True))
        ]
        return Immersion(low, high, tuple(steady), tuple(masses))

    def _masses(self, layers: npt.NDArray[np.intp]) -> Vector:
        masses: Vector = self._densities[layers] * self._whole * self._is_even
        return masses

    def push(self, data: mujoco.MjData, immersion: Immersion, gravity: Vector) -> None:
        """Apply the buoyant forces to the links that are not steady, for the next step only.

        Args:
            data: Engine data with computed poses.
            immersion: Immersion at these poses.
            gravity: Gravity in the world frame [m/s²], shape (3,).
        """
        if self._parts:
            self.links.push_some(data, self._wrenches_few(data, immersion, gravity.tolist()))
        else:
            self.links.push(data, *self._wrenches(data, immersion, gravity))

    def _wrenches_few(self, data: mujoco.MjData, immersion: Immersion, gravity: list[float]) -> dict[int, list[float]]:
        """Return the force at the centre of mass [N] and the torque [N·m], in the world frame, by index of the link."""
        bodies = self.links.bodies
        axes, origins, masses = data.xmat[bodies].tolist(), data.xpos[bodies].tolist(), data.xipos[bodies].tolist()
        gx, gy, gz = gravity
        wrenches: dict[int, list[float]] = {}
        for part, low, high in zip(self._parts, immersion.low, immersion.high, strict=True):
            owner = part.owner
            if immersion.steady[owner]:
                continue
            if low == high:
                mass, (x, y, z) = (
                    self.fluid.densities[low] * part.volume,
                    _point_in_world(axes[owner], origins[owner], part.centre),
                )
            else:
                mass, (x, y, z) = self._cut_few(part, axes[owner], origins[owner], low, high)
            fx, fy, fz = -mass * gx, -mass * gy, -mass * gz
            ox, oy, oz = masses[owner]
            x, y, z = x - ox, y - oy, z - oz
            wrench = [fx, fy, fz, y * fz - z * fy, z * fx - x * fz, x * fy - y * fx]
            before = wrenches.get(owner)
            wrenches[owner] = wrench if before is None else [p + q for p, q in zip(before, wrench, strict=True)]
        return wrenches

    def _cut_few(self, part: _Part, axes: list[float], origin: list[float], low: int, high: int) -> tuple[float, Three]:
        """Return the mass [kg] and the world centre [m] of the fluid that a hull in several layers displaces."""
        assert part.solid is not None
        densities, heights = self.fluid.densities, self.fluid.heights
        start = _point_in_world(axes, origin, part.origin)
        turned = axes if part.axes is None else _matrix_product(axes, part.axes)
        mass = densities[high] * part.volume
        mx, my, mz = (mass * c for c in part.middle)
        total = 0.0
        for layer in range(low, high):
            more = densities[layer] - densities[layer + 1]
            volume, vx, vy, vz = part.solid.cut(turned[6], turned[7], turned[8], heights[layer] - start[2])
            total += more * volume
            mx, my, mz = mx + more * vx, my + more * vy, mz + more * vz
        mass = max(mass + total, 0.0)
        share = max(mass, 1e-300)
        return mass, _point_in_world(turned, start, (mx / share, my / share, mz / share))

    def _wrenches(self, data: mujoco.MjData, immersion: Immersion, gravity: Vector) -> tuple[Vector, Vector]:
        """Compute the wrenches on the links that are not steady.

        Returns:
            Forces at the centres of mass [N] and torques [N·m] in the world frame, each of shape (n, 3) for n links.
            The rows of steady links are zero.
        """
        rows = np.flatnonzero(~np.array(immersion.steady, bool)[self._owners])
        owners = self._owners[rows]
        bodies = self.links.bodies[owners]
        axes = self.links.axes(data)[owners]
        centres = data.xpos[bodies] + (axes * self._centres[rows, None, :]).sum(axis=2)
        low, high = np.array(immersion.low, int)[rows], np.array(immersion.high, int)[rows]
        masses = self._densities[low] * self._volumes[rows]
        cut = [(place, layer) for place in np.flatnonzero(low != high) for layer in range(low[place], high[place])]
        if cut:
            self._cut(np.array(cut), rows, axes, data.xpos[bodies], masses, centres)
        forces = -masses[:, None] * gravity
        torques = cross(centres - data.xipos[bodies], forces)
        return self._summed(forces, owners), self._summed(torques, owners)

    def _cut(
        self,
        cuts: npt.NDArray[np.intp],
        rows: npt.NDArray[np.intp],
        axes: Vector,
        origins: Vector,
        masses: Vector,
        centres: Vector,
    ) -> None:
        """Correct the displaced mass and its centre for the hulls that reach into several layers.

        The arrays have one row for each hull of a link that is not steady.

        Args:
            cuts: Pairs (row, layer) for each layer whose upper boundary may cut the hull of that row, sorted by row.
            rows: Index of the hull in each row.
            axes: World rotation matrix of the link in each row.
            origins: World position of the link in each row [m].
            masses: Displaced masses [kg], corrected in place.
            centres: World positions of the centres of the displaced fluid [m], corrected in place.
        """
        places, layers = cuts.T
        hulls = rows[places]
        turned = matmul(axes[places], self._solid_axes[hulls])
        starts = origins[places] + (axes[places] * self._solid_origins[hulls][:, None, :]).sum(axis=2)
        depths = self._heights[layers] - starts[:, 2]
        cut_parts = np.array(
            [
                solid.cut(*normal, depth)
                for row, normal, depth in zip(hulls, turned[:, 2].tolist(), depths.tolist(), strict=True)
                if (solid := self._hulls[row].solid) is not None
            ]
        )
        volumes, moments = cut_parts[:, 0], cut_parts[:, 1:]
        more = self._densities[layers] - self._densities[layers + 1]
        total, first = np.zeros(len(masses)), np.zeros((len(masses), 3))
        np.add.at(total, places, more * volumes)
        np.add.at(first, places, more[:, None] * moments)
        at = np.unique(places)
        top = np.zeros(len(masses), dtype=np.intp)
        np.maximum.at(top, places, layers + 1)
        last = places.searchsorted(at)  # index of the first cut of each hull; all cuts of a hull have the same frame
        full_mass = self._densities[top[at]] * self._volumes[rows[at]]
        masses[at] = np.maximum(full_mass + total[at], 0.0)
        first = first[at] + full_mass[:, None] * self._solid_centres[rows[at]]
        middle = first / np.maximum(masses[at], 1e-300)[:, None]
        centres[at] = starts[last] + (turned[last] * middle[:, None, :]).sum(axis=2)

    def _summed(self, values: Vector, owners: npt.NDArray[np.intp] | None = None) -> Vector:
        """Return for each link the sum of the values of its hulls."""
        sums = np.zeros((len(self.links), values.shape[1]))
        np.add.at(sums, self._owners if owners is None else owners, values)
        return sums


def _part(owner: int, hull: Hull) -> _Part:
    def three(vector: Vector) -> Three:
        x, y, z = np.asarray(vector, float).tolist()
        return x, y, z

    axes = None if np.array_equal(hull.axes, np.eye(3)) else np.asarray(hull.axes, float).tolist()
    middle = three(hull.solid.centre if hull.solid else _ZERO)
    return _Part(
        owner, float(hull.volume), three(hull.centre), float(hull.reach), hull.solid, axes, three(hull.origin), middle
    )


def _point_in_world(axes: Sequence[float], origin: Sequence[float], at: Three) -> Three:
    """Transform a point from a frame with these axes and this origin into the world."""
    a, b, c, d, e, f, g, h, i = axes
    x, y, z = at
    return (
        origin[0] + (a * x + b * y + c * z),
        origin[1] + (d * x + e * y + f * z),
        origin[2] + (g * x + h * y + i * z),
    )


def _matrix_product(axes: Sequence[float], by: list[list[float]]) -> list[float]:
    """Return the product of two rotation matrices as nine numbers, row by row."""
    (a, b, c), (d, e, f), (g, h, i) = by
    rows = (axes[0:3], axes[3:6], axes[6:9])
    return [
        value for x, y, z in rows for value in (x * a + y * d + z * g, x * b + y * e + z * h, x * c + y * f + z * i)
    ]
