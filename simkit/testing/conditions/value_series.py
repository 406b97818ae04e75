"""Values of expressions over the time of a run."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from simkit.errors import InputError
from simkit.testing.conditions.binder import bind_value
from simkit.testing.conditions.bound_expression import BoundNode
from simkit.testing.conditions.syntax_tree import Attribute, Call, UndecidedValue
from simkit.testing.conditions.value_types import NUMBER, TRUTH, is_pose_like
from simkit.testing.conditions.world_view import WorldView

if TYPE_CHECKING:
    from simkit.runtime import Simulation


_POSE_UNITS: Final = {**dict.fromkeys("xyz", "m"), **dict.fromkeys(("roll", "pitch", "yaw"), "rad")}


class ValueSeries:
    """Values of expressions at the start of a run and after each step; a context manager around the run.

    Args:
        sim: Simulation.
        expressions: Expressions that are numbers, or true (1) or false (0).

    Raises:
        InputError: Expressions have syntax errors, unknown names or other types; the message lists all errors.
    """

    def __init__(self, sim: Simulation, expressions: Sequence[str]) -> None:
        self._sim, self._view = sim, WorldView(sim, "wait" if sim.nodes else "error")
        self._parts: list[BoundNode] = []
        problems: list[InputError] = []
        for text in expressions:
            try:
                self._parts.append(bind_value(text, self._view, (NUMBER, TRUTH), "the plotted value"))
            except InputError as error:
                problems.append(error)
        if problems:
            raise InputError(problems[0].code, "\n".join(map(str, problems)), shows_code=False)
        self._times: list[float] = []
        self._values: list[list[float]] = [[] for _ in self._parts]
        self._is_open = False
        self._end: Callable[[], None] = lambda: None

    def __enter__(self) -> ValueSeries:
        self._view.open()
        if self._parts:
            self._is_open = True
            self._take()
            self._end = self._sim.communication.on_demand.add(
                lambda: self._is_open, None, lambda _: self._take(), "after"
            )
        return self

    def __exit__(self, *_: object) -> None:
        self._is_open = False
        self._end()
        self._view.close()

    @property
    def times(self) -> NDArray[np.float64]:
        """Simulated times [s], shape (n,)."""
        return np.array(self._times)

    def values(self) -> list[NDArray[np.float64]]:
        """Return the values of each expression at these times, shape (n,); NaN for an unknown value."""
        return [np.array(values) for values in self._values]

    def units(self) -> list[str]:
        """Return the SI unit of each expression; empty if it is unknown."""
        return [_unit(part) for part in self._parts]

    def _take(self) -> None:
        self._times.append(self._sim.time)
        for part, values in zip(self._parts, self._values, strict=True):
            try:
                values.append(float(part.get()))
            except UndecidedValue:
                values.append(math.nan)


def _unit(part: BoundNode) -> str:
    """Return the unit of a coordinate or an angle of a pose, or of a length; empty for others."""
    node = part.node
    if isinstance(node, Attribute) and is_pose_like(part.below[0].kind):
        return _POSE_UNITS.get(node.name, "")
    return "m" if isinstance(node, Call) and node.name in ("distance", "path_length") else ""
