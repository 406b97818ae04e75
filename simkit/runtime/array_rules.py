"""Rules over arrays: what sensors and plugins compute in many simulations of one world at once.

A batch steps n simulations of one world together. One ordinary simulation resets all of them in turn: `take` copies its
present state to a row. Everything else is arrays whose first axis is the simulation. A sensor or a plugin takes part
with its array rule, which gives every row the bits of a single simulation. Therefore a rule calls the same functions as
the sensor or plugin itself, with arrays in the place of numbers.
"""

from __future__ import annotations

import abc
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np
import numpy.typing as npt

from simkit.runtime.engine.simulated_time import TickGrid

if TYPE_CHECKING:
    from simkit.runtime.state_arrays import StateArrays

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
Ids = npt.NDArray[np.intp]
"""Rows of some simulations, in ascending order."""

Ticks = npt.NDArray[np.int64]
"""Present tick of each of some simulations."""

Grid = TickGrid | None
"""Ticks at which a task is due; None means every step."""

SetCommand = Callable[[Ids, Floats], None]
"""Function that sets the numbers of a command in some simulations, shape (n, fields)."""

NEVER: Final = 1 << 62
"""Tick that no run reaches."""

AnyRule = TypeVar("AnyRule")


class CannotBatchError(Exception):
    """Reason why a part of a world cannot be computed as arrays."""


class SensorRule(abc.ABC):
    """Readings of one sensor in n simulations.

    Attributes:
        inputs: names of the arrays of MuJoCo's data that the rule reads, such as `xpos`.
        convert: function from the sensor's first message to its numbers, for rules that make messages; the batch sets
            it before the first reading.
    """

    inputs: tuple[str, ...] = ()
    convert: Callable[[Any], npt.NDArray[Any]]

    @abc.abstractmethod
    def bind(self, states: StateArrays, *, is_truth: bool) -> None:
        """Use the states of n simulations; with `is_truth`, the readings have no noise."""

    def take(self, row: int) -> None:
        """Copy what the sensor of the ordinary simulation remembers, such as its noise, to one row."""

    @abc.abstractmethod
    def read(self, ids: Ids, index: npt.NDArray[np.int64]) -> npt.NDArray[np.floating[Any]]:
        """Return the numbers of the sensor's first message in all simulations, shape (n, numbers).

        Args:
            ids: simulations that take a sample; the noise of other rows may be missing.
            index: number of the present sample in each simulation, shape (n,); the noise depends on it.
        """


class TopicRule(abc.ABC):
    """Numbers of the messages that a plugin publishes on one topic, in n simulations.

    Attributes:
        grid: ticks at which the plugin publishes; None for every step.
    """

    grid: Grid = None

    def take(self, row: int) -> None:
        """Copy what the plugin of the ordinary simulation remembers to one row."""

    def next_stop(self, tick: int) -> int:
        """Return the first tick after a tick at which `note` must be called."""
        return NEVER

    def note(self, ids: Ids, ticks: Ticks) -> None:
        """Store what later messages of some simulations need, at the present tick of each."""

    @abc.abstractmethod
    def read(self, ids: Ids, ticks: Ticks) -> Floats:
        """Return the numbers of the messages that some simulations publish now, shape (len(ids), numbers)."""


class PresentNumbers(TopicRule):
    """Messages that a function of the present states makes.

    Args:
        grid: ticks of the messages.
        read: function that returns the numbers of some simulations.
    """

    def __init__(self, grid: Grid, read: Callable[[Ids, Ticks], Floats]) -> None:
        self.grid, self._read = grid, read

    def read(self, ids: Ids, ticks: Ticks) -> Floats:
        return self._read(ids, ticks)


class PluginRule(abc.ABC):
    """Hooks of one plugin in n simulations; a method that is not overridden does nothing.

    The simulations of one call are due at the same steps: their ticks differ by cycles of all grids.

    Attributes:
        grids: ticks of the hooks that run at a rate.
        reads_poses: False if the hooks read only joints, controls and their own state; a batch then leaves out the
            forward pass before them, which takes a third of a step.
    """

    grids: Sequence[Grid] = ()
    reads_poses = True

    @abc.abstractmethod
    def bind(self, states: StateArrays) -> None:
        """Use the states of n simulations."""

    def take(self, row: int, tick: int) -> None:
        """Copy the state of the plugin of the ordinary simulation, at its present tick, to one row."""

    def next_stop(self, ids: Ids, tick: int) -> int:
        """Return the first tick after a tick at which the hooks of some simulations must run."""
        return NEVER

    def before_step(self, ids: Ids, ticks: Ticks) -> None:
        """Write commands of some simulations before a step, at the present tick of each."""

    def after_step(self, ids: Ids, ticks: Ticks) -> None:
        """Read the states of some simulations after a step, at the present tick of each."""

    def command(self, topic: str, fields: Sequence[str]) -> SetCommand | None:
        """Return the function that sets fields of the command on a topic; None if the plugin does not follow it."""
        return None

    def reading(self, topic: str) -> TopicRule | None:
        """Return the rule of the messages on a topic; None if the plugin does not publish them.

        Raises:
            CannotBatchError: the messages cannot be computed as arrays.
        """
        return None


def array_rule_of(part: Any, kind: type[AnyRule]) -> AnyRule | None:
    """Return the array rule of a sensor or plugin; None if its own class has none.

    An inherited rule does not count, because a derived class may behave differently.

    Raises:
        CannotBatchError: the rule does not apply to this sensor or plugin.
    """
    rule = part.array_rule() if "array_rule" in vars(type(part)) else None
    assert rule is None or isinstance(rule, kind)
    return rule


def next_due(grid: Grid, tick: int) -> int:
    """Return the first due tick after a tick."""
    return tick + 1 if grid is None else grid.next(tick)


def is_due(grid: Grid, tick: int) -> bool:
    """Check whether a tick is due; a grid is not due at the start."""
    return grid is None or (tick > 0 and grid.next(tick - 1) == tick)


def last_due(grid: Grid, tick: int) -> int:
    """Return the last due tick up to a tick; 0 if there is none."""
    return tick if grid is None else grid.tick(grid.index(tick))
