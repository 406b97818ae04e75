"""Archimedes' principle: what floats is pushed up by the weight of the fluid whose place it takes.

A fluid may lie in layers, each of its own density; a hull that reaches into several is cut at their bounds.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from simkit.plugins.fluids.hulls import Hull
from simkit.plugins.fluids.pushed_links import PushedLinks, cross
from simkit.plugins.fluids.solids import all_below
from simkit.pose import Vector

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_ZERO: Final = np.zeros(3)
_SAME: Final = 1e-9  # [m] between centre of volume and centre of mass that are one point


@dataclass(frozen=True, slots=True)
class Fluid:
    """Layers of a fluid, level in the world.

    Attributes:
        densities: of each layer from the lowest up [kg/m³].
        heights: where each but the lowest begins [m], rising.
    """

    densities: tuple[float, ...]
    heights: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Lie:
    """How everything lies in the layers now.

    Attributes:
        low, high: the lowest and highest layer that each hull may reach into, shape (hulls,).
        steady: links that are pushed by the same force while they stay in their layer, however they turn, shape (n,).
        masses: of the fluid that each of these displaces [kg], shape (n,); zero for others.
    """

    low: npt.NDArray[np.intp]
    high: npt.NDArray[np.intp]
    steady: npt.NDArray[np.bool_]
    masses: Vector


class Displacement:
    """The hulls of the engine's present model in a fluid. A handle.

    Args:
        sim: the simulation.
        hulls: by scoped link name.
        fluid: around them.
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
        self._always: Lie | None = None

    def __deepcopy__(self, memo: dict[int, Any]) -> Displacement:
        return self

    def _find_even(self, model: Any) -> npt.NDArray[np.bool_]:
        """Links whose centre of volume is their centre of mass."""
        middle = self._summed(self._volumes[:, None] * self._centres)
        middle /= np.maximum(self._whole[:, None], 1e-300)
        away = middle - model.body_ipos[self.links.bodies]
        even: npt.NDArray[np.bool_] = (away * away).sum(axis=1) < _SAME**2
        return even

    @property
    def is_all_steady(self) -> bool:
        """Whether nothing ever changes with how the links lie."""
        return not self.fluid.heights and bool(self._is_even.all())

    def lie(self, data: Any) -> Lie:
        """How everything lies, by the places in `data`."""
        if not len(self._heights):
            if self._always is None:
                whole = np.zeros(len(self._hulls), dtype=np.intp)
                self._always = Lie(whole, whole, self._is_even, self._masses(np.zeros(len(self.links), int)))
            return self._always
        axes = self.links.axes(data)[self._owners]
        z = data.xpos[self.links.bodies, 2][self._owners] + (axes[:, 2] * self._centres).sum(axis=1)
        low, high = (np.searchsorted(self._heights, z + s * self._reach, side="right") for s in (-1.0, 1.0))
        first = np.zeros(len(self.links), dtype=np.intp)
        first[self._owners] = low
        is_split = (low != high) | (low != first[self._owners])
        steady = self._is_even.copy()
        steady[self._owners[is_split]] = False
        return Lie(low, high, steady, np.where(steady, self._masses(first), 0.0))

    def _masses(self, layers: npt.NDArray[np.intp]) -> Vector:
        masses: Vector = self._densities[layers] * self._whole * self._is_even
        return masses

    def wrenches(self, data: Any, lie: Lie, gravity: Vector) -> tuple[Vector, Vector]:
        """On the links that are not steady; zero on others.

        Args:
            data: with places computed.
            lie: how everything lies in it.
            gravity: [m/s²], shape (3,).

        Returns:
            Forces at the centres of mass [N] and torques [N·m], world frame, shape (n, 3) each.
        """
        rows = np.flatnonzero(~lie.steady[self._owners])
        owners = self._owners[rows]
        bodies = self.links.bodies[owners]
        axes = self.links.axes(data)[owners]
        centres = data.xpos[bodies] + (axes * self._centres[rows, None, :]).sum(axis=2)
        low, high = lie.low[rows], lie.high[rows]
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
        """Corrects masses [kg] and centres [m, world] of the displaced fluid of hulls that reach into several layers.

        Args:
            cuts: pairs of a place in the arrays below and a layer that ends within that hull, by place.
            rows: the hulls.
            axes, origins: of the links in the world.
        """
        places, layers = cuts.T
        hulls = rows[places]
        solids = [solid for row in hulls if (solid := self._hulls[row].solid) is not None]
        turned = axes[places] @ self._solid_axes[hulls]
        starts = origins[places] + (axes[places] * self._solid_origins[hulls][:, None, :]).sum(axis=2)
        volumes, moments = all_below(solids, turned[:, 2], self._heights[layers] - starts[:, 2])
        more = self._densities[layers] - self._densities[layers + 1]
        total, first = np.zeros(len(masses)), np.zeros((len(masses), 3))
        np.add.at(total, places, more * volumes)
        np.add.at(first, places, more[:, None] * moments)
        at = np.unique(places)
        top = np.zeros(len(masses), dtype=np.intp)
        np.maximum.at(top, places, layers + 1)
        last = places.searchsorted(at)  # the frame of each
        whole = self._densities[top[at]] * self._volumes[rows[at]]
        masses[at] = np.maximum(whole + total[at], 0.0)
        first = first[at] + whole[:, None] * self._solid_centres[rows[at]]
        middle = first / np.maximum(masses[at], 1e-300)[:, None]
        centres[at] = starts[last] + (turned[last] * middle[:, None, :]).sum(axis=2)

    def _summed(self, values: Vector, owners: npt.NDArray[np.intp] | None = None) -> Vector:
        """Of each link, the sum over its hulls."""
        found = np.zeros((len(self.links), values.shape[1]))
        np.add.at(found, self._owners if owners is None else owners, values)
        return found
