"""Geoms of the world body, of which a large world has tens of thousands.

At each `add_geom`, MuJoCo lists all elements of the specification again: 80,000 geoms would take 15 s. Therefore all
but the first geoms are added to a small specification, which is attached when it is full. The numbers of the compiled
model are the same.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

import mujoco

DIRECT: Final = 500
"""Number of geoms that are added to the world body itself."""

BLOCK: Final = 2500
"""Number of geoms in one attached specification; the time of an attachment grows with the square of this number."""


class WorldGeoms:
    """Writer of the geoms of the world body, in the order of their addition.

    Args:
        spec: specification of the world; before others use it, attach the geoms that wait.
        count: number of geoms that were added before.
        blocks: names of the geoms in each attached frame, by the name of the frame.
    """

    def __init__(self, spec: mujoco.MjSpec, count: int = 0, blocks: dict[str, frozenset[str]] | None = None) -> None:
        self.spec, self._count = spec, count
        self._blocks = dict(blocks or {})
        self._waiting: mujoco.MjSpec | None = None
        self._names: list[str] = []

    def add(self, name: str, **settings: Any) -> None:
        """Add a geom; it is in the specification at the latest after `attach_waiting`."""
        self._count += 1
        if self._count <= DIRECT:
            self.spec.worldbody.add_geom(name=name, **settings)
            return
        if self._waiting is None:
            self._waiting = mujoco.MjSpec()
        self._waiting.worldbody.add_geom(name=name, **settings)
        self._names.append(name)
        if len(self._names) >= BLOCK:
            self.attach_waiting()

    def attach_waiting(self) -> None:
        """Attach the geoms that wait."""
        if self._waiting is None:
            return
        waiting, self._waiting = self._waiting, None
        names, self._names = self._names, []
        block = f"{names[0]}#block"
        self.spec.attach(waiting, prefix="", frame=self.spec.worldbody.add_frame(name=block))
        self._blocks[block] = frozenset(names)

    def remove(self, names: Iterable[str]) -> None:
        """Remove geoms; a whole block of them is removed as one frame, which is as fast as one geom."""
        rest = set(names)
        for block, inside in list(self._blocks.items()):
            if inside <= rest:
                rest -= inside
                self.spec.delete(self.spec.frame(block))
                del self._blocks[block]
        for name in sorted(rest):
            self.spec.delete(self.spec.geom(name))

    def copy_to(self, spec: mujoco.MjSpec) -> WorldGeoms:
        """Return the writer of a copy of the specification, in which no geoms wait."""
        return WorldGeoms(spec, self._count, self._blocks)
