"""Paths that moving models have driven."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from simkit.runtime import Model, Simulation

Points = npt.NDArray[np.float64]

_SHORTEST: Final = 0.01  # [m] between two points
_MOST: Final = 8000  # points of a path; then every second one is dropped


class Travel:
    """Paths of the first links of the moving models since the creation, or since the last reset.

    Args:
        sim: simulation.

    Attributes:
        tracks: points in the world [m] by model.
        resets: number of resets that have cleared the paths.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self.tracks: dict[str, list[Points]] = {}
        self.resets = 0
        self._model: object = None
        self._names: list[str] = []
        self._models: dict[str, Model] = {}
        self._bodies: npt.NDArray[np.int_] = np.zeros(0, int)
        self._last: npt.NDArray[np.float64] = np.zeros((0, 3))
        self._tick = -1

    def sample(self) -> None:
        """Add the present positions, except in a diverged state, which the next step reports."""
        sim = self._sim
        if sim.tick < self._tick:
            self.tracks.clear()
            self.resets += 1
        self._tick = sim.tick
        if sim.mj_model is not self._model:
            self._find_bodies()
        if not self._names:
            return
        positions = sim.engine.physics.fresh().xpos[self._bodies]
        if not np.isfinite(positions).all():
            return
        if self.tracks:
            moved = np.linalg.norm(positions - self._last, axis=1) >= _SHORTEST
        else:
            moved = np.ones(len(positions), bool)
            self._last = positions.copy()
        for index in np.flatnonzero(moved):
            self._last[index] = positions[index]
            path = self.tracks.setdefault(self._names[index], [])
            path.append(positions[index].copy())
            if len(path) > _MOST:
                del path[1::2]

    def paths(self, most: int = _MOST) -> dict[str, Points]:
        """Return the path of each moving model [m], shape (n, 3), with at most about `most` points."""
        return {name: np.array(track[:: 1 + len(track) // most]) for name, track in self.tracks.items()}

    def _find_bodies(self) -> None:
        """Find the body of each moving model: that of its first link with a body."""
        sim = self._sim
        links = sim.engine.names.links
        body_by_model: dict[str, int] = {}
        for link in links.values():
            if link.body > 0 and not sim.models[link.model].static:
                body_by_model.setdefault(link.model, link.body)
        self._model = sim.mj_model
        self._names, self._bodies = list(body_by_model), np.array(list(body_by_model.values()), dtype=int)
        self._last = sim.engine.physics.fresh().xpos[self._bodies].copy()
        before, self._models = self._models, {name: sim.models[name] for name in body_by_model}
        self.tracks = {  # a model that was removed and spawned again begins a new path
            name: path for name, path in self.tracks.items() if self._models.get(name, self) is before.get(name)
        }
        for name, place in zip(self._names, self._last, strict=True):
            self.tracks.setdefault(name, [place.copy()])
