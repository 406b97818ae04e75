"""Schedule of due tasks. Due ticks follow from the rates alone, so that snapshots need not store them."""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Sequence
from typing import Literal, Protocol

from simkit.runtime.engine.simulated_time import Clock, TickGrid

Phase = Literal["before", "sense", "after"]
Task = Callable[[int], None]
NEVER = 1 << 62
_LONGEST_CYCLE = 10_000  # ticks


class Timetable(Protocol):
    """Due ticks of a task."""

    def next(self, tick: int) -> int:
        """Return the first due tick after a tick."""


class Agenda:
    """Tasks of one phase, in the order in which they were added.

    Attributes:
        every: tasks of every step.
        next: next tick at which a periodic task is due.
    """

    def __init__(self) -> None:
        self._tasks: list[tuple[Task, Timetable | None]] = []
        self._cycle = 0
        self._plan: dict[int, tuple[list[Task], int]] = {}
        self.clear()

    def clear(self) -> None:
        """Remove every task; the plan of due tasks stays for the case that equal tasks are added again."""
        self._planned_tasks, self._tasks = self._tasks, []
        self.every: list[Task] = []
        self._heap: list[tuple[int, int]] = []
        self.next = NEVER

    def add(self, task: Task, grid: Timetable | None) -> None:
        self._tasks.append((task, grid))

    def rewind(self, tick: int) -> None:
        """Compute the tasks that are due after `tick`."""
        self.every = [task for task, grid in self._tasks if grid is None]
        self._heap = [(grid.next(tick), order) for order, (_, grid) in enumerate(self._tasks) if grid is not None]
        heapq.heapify(self._heap)
        self.next = self._heap[0][0] if self._heap else NEVER
        if self._tasks != self._planned_tasks:
            self._cycle = _common_cycle([grid for _, grid in self._tasks if grid is not None])
            self._plan = {}
            self._planned_tasks = self._tasks

    def due(self, tick: int) -> list[Task]:
        """Return every task due at `tick`, in order of addition; periodic tasks advance to their next tick."""
        if self.next > tick:
            return self.every
        if self._cycle and tick > 1:  # the first tick has additional samples of sensors
            planned = self._plan.get(tick % self._cycle)
            if planned is None:
                planned = self._plan[tick % self._cycle] = self._compute_due(tick)
            self.next = tick + planned[1]
            return planned[0]
        return self._by_heap(tick)

    def _compute_due(self, tick: int) -> tuple[list[Task], int]:
        """Return the tasks that are due at `tick`, and the number of ticks to the next due tick."""
        due = [task for task, grid in self._tasks if grid is None or grid.next(tick - 1) == tick]
        return due, min(grid.next(tick) for _, grid in self._tasks if grid is not None) - tick

    def _by_heap(self, tick: int) -> list[Task]:
        heap, tasks = self._heap, self._tasks
        order = heap[0][1]
        heapq.heapreplace(heap, (tasks[order][1].next(tick), order))  # type: ignore[union-attr]
        self.next = heap[0][0]
        if self.next > tick and not self.every:
            return [tasks[order][0]]
        orders = [order]
        while heap[0][0] <= tick:
            order = heap[0][1]
            heapq.heapreplace(heap, (tasks[order][1].next(tick), order))  # type: ignore[union-attr]
            orders.append(order)
        self.next = heap[0][0]
        if self.every:
            orders += [i for i, (_, grid) in enumerate(self._tasks) if grid is None]
            orders.sort()
        return [self._tasks[i][0] for i in orders]


def _common_cycle(timetables: Sequence[Timetable]) -> int:
    """Return the number of ticks after which all timetables repeat; 0 if the cycle is too long or does not exist."""
    periods = [grid.cycle for grid in timetables if isinstance(grid, TickGrid)]
    if not periods or len(periods) < len(timetables):
        return 0
    cycle = math.lcm(*periods)
    return cycle if cycle <= _LONGEST_CYCLE else 0


class Scheduler:
    """Tasks before a step, and tasks of sensors and hooks after it."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self.before, self.sense, self.after = Agenda(), Agenda(), Agenda()

    def clear(self) -> None:
        """Remove every task."""
        for agenda in (self.before, self.sense, self.after):
            agenda.clear()

    def every(self, rate: float | None, task: Task, phase: Phase) -> None:
        """Call `task(tick)` at `rate` [Hz] (None or 0: at every step); takes effect at the next `rewind`.

        Sensors have a first sample after the first step; later samples and all hooks are due at k/rate.
        """
        getattr(self, phase).add(task, self.clock.grid(rate or 0.0, from_start=phase == "sense"))

    def on(self, timetable: Timetable | None, task: Task, phase: Phase) -> None:
        """Call `task(tick)` at the ticks of a timetable; None for every step."""
        getattr(self, phase).add(task, timetable)

    def rewind(self, tick: int) -> None:
        """Continue from `tick`. The readings of this tick are done; the commands before the next step are still due."""
        self.before.rewind(max(tick - 1, 0))
        self.sense.rewind(tick)
        self.after.rewind(tick)
