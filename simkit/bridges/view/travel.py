"""Paths that moving models have driven."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_SHORTEST: Final = 0.015  # [m] between two points
_MOST: Final = 8000  # points of a path; then every second one is dropped


class Travel:
    """Paths of the moving models since the view was opened, or since the last reset.

    Attributes:
        paths: points in the world [m] by model.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self.paths: dict[str, list[npt.NDArray[Any]]] = {}
        self._model: object = None
        self._last: npt.NDArray[Any] = np.zeros((0, 3))
        self._tick = -1

    def sample(self) -> None:
        """Add the present positions."""
        sim = self._sim
        if sim.tick == self._tick:
            return
        if sim.tick < self._tick:
            self.paths.clear()
        self._tick = sim.tick
        if sim.mj_model is not self._model:
            self._find_bodies()
        if not self._names:
            return
        positions = sim.mj_data.xpos[self._bodies]
        if not np.isfinite(positions).all():
            return  # the next step reports the diverged state
        if self.paths:
            moved = np.linalg.norm(positions - self._last, axis=1) >= _SHORTEST
        else:
            moved = np.ones(len(positions), bool)
            self._last = positions.copy()
        for index in np.flatnonzero(moved):
            self._last[index] = positions[index]
            path = self.paths.setdefault(self._names[index], [])
            path.append(positions[index].copy())
            if len(path) > _MOST:
                del path[1::2]

    def _find_bodies(self) -> None:
        """Find the body of each moving model: that of its first link with a body."""
        sim = self._sim
        links = sim.engine.names.links
        found: dict[str, int] = {}
        for link in links.values():
            if link.body > 0 and not sim.models[link.model].static:
                found.setdefault(link.model, link.body)
        self._model = sim.mj_model
        self._names, self._bodies = list(found), np.array(list(found.values()), dtype=int)
        self._last = sim.mj_data.xpos[self._bodies].copy()
        self.paths = {name: path for name, path in self.paths.items() if name in found}
        for name, place in zip(self._names, self._last, strict=True):
            self.paths.setdefault(name, [place.copy()])
