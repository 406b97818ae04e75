"""How the air of a world moves: evenly everywhere, at every moment."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from simkit.scene import SceneWorld

Velocity = tuple[float, float, float]


class Wind:
    """The velocity of the air: the world's `<wind>`, or what a plugin makes of it. A handle.

    Attributes:
        source: gives the velocity [m/s], world frame, that holds in the step from a tick on; None: the world's.
    """

    def __init__(self, world: SceneWorld) -> None:
        x, y, z = world.wind
        self._steady: Velocity = float(x), float(y), float(z)
        self.source: Callable[[int], Velocity] | None = None

    def at(self, tick: int) -> Velocity:
        """Velocity of the air [m/s], world frame, in the step that follows a tick."""
        return self._steady if self.source is None else self.source(tick)

    def __deepcopy__(self, memo: dict[int, Any]) -> Wind:
        return self
