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
_MOST_STOPS = 10_000  # stops that are stored


class Timetable(Protocol):
    """Due ticks of a task."""

    def next(self, tick: int) -> int:
        """Return the first due tick after a tick."""


class SampledTask(Protocol):
    """Sensor whose samples are a task."""

    @property
    def is_silent(self) -> bool:
        """True if a sample calls no code that may read another sensor."""

    @property
    def keeps_last(self) -> bool:
        """True if only the last of several samples can be read; `skip` counts the others."""

    def skip(self, count: int) -> None:
        """Count samples that are not taken."""


class SilentTask:
    """Task of the simulation itself, which reads no sensor."""

    is_silent, keeps_last = True, False

    def skip(self, count: int) -> None:
        """Do nothing, because no call is left out."""


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


class SampleAgenda(Agenda):
    """Tasks after a step that sample sensors; samples that nobody can read need no stop of the run.

    A sensor without a reader keeps the state of its last sample for a later reader. A run therefore stops at such a
    sample only if it is the last one before the next stop. Stops that other tasks need are no exception. The rule
    holds while no task of this phase can read a sensor, and while no task is due at every step.
    """

    def __init__(self) -> None:
        self._sensors: list[SampledTask | None] = []
        self._skipped: list[int] = []  # numbers of the tasks whose calls may be left out
        self._stops: dict[tuple[int, int], int] = {}
        self._missed: dict[tuple[int, int], list[tuple[SampledTask, int]]] = {}
        self._seen = 0  # all samples up to this tick are taken or counted
        super().__init__()

    def clear(self) -> None:
        super().clear()
        self._sensors = []

    def add_sensor(self, task: Task, grid: Timetable | None, sensor: SampledTask | None) -> None:
        """Add a task; None for a task that may read sensors."""
        self.add(task, grid)
        self._sensors += [None] * (len(self._tasks) - 1 - len(self._sensors)) + [sensor]

    def choose_skipped(self, tick: int, *, is_allowed: bool) -> None:
        """Choose the sensors whose samples may be left out after `tick`, from their present readers."""
        sensors = [*self._sensors, *[None] * (len(self._tasks) - len(self._sensors))]
        self._skipped, self._seen = [], tick
        self._stops, self._missed = {}, {}
        if is_allowed and self._cycle and all(sensor is not None and sensor.is_silent for sensor in sensors):
            self._skipped = [order for order, sensor in enumerate(sensors) if sensor is not None and sensor.keeps_last]
        if self._skipped and tick > 0:
            self.next = min(grid.next(tick) for _, grid in self._tasks if grid is not None)

    def stop_before(self, tick: int, stop: int) -> int:
        """Return the next tick after `tick` at which a run that is to reach `stop` must stop for this phase."""
        if not self._skipped or tick < 1:
            return min(stop, self.next)
        key = tick % self._cycle, stop - tick
        ticks = self._stops.get(key)
        if ticks is None:
            if len(self._stops) > _MOST_STOPS:
                self._stops.clear()
            ticks = self._stops[key] = self._compute_stop(*key)
        return tick + ticks

    def _compute_stop(self, tick: int, ticks: int) -> int:
        """Return the number of ticks to the next stop, for a run of a number of ticks from a tick of the cycle."""
        begin = tick + self._cycle  # the first tick has additional samples
        end = begin + min(ticks, self._cycle)
        grids = [grid for _, grid in self._tasks if grid is not None]
        end = min([end, *(grid.next(begin) for order, grid in enumerate(grids) if order not in self._skipped)])
        last = [_due_ticks(grids[order], begin, end)[-1:] for order in self._skipped]
        return min([end, *(ticks[0] for ticks in last if ticks)]) - begin

    def due(self, tick: int) -> list[Task]:
        if self._skipped:
            if tick - self._seen > 1:
                self._count_missed(tick)
            self._seen = tick
        return super().due(tick)

    def _count_missed(self, tick: int) -> None:
        """Count the samples that were left out before a tick."""
        key = self._seen % self._cycle, tick - self._seen
        missed = self._missed.get(key)
        if missed is None:
            if len(self._missed) > _MOST_STOPS:
                self._missed.clear()
            begin, end = key[0] + self._cycle, key[0] + self._cycle + key[1] - 1
            missed = self._missed[key] = []
            for order in self._skipped:
                (_, grid), sensor = self._tasks[order], self._sensors[order]
                count = len(_due_ticks(grid, begin, end)) if grid is not None else 0
                if count and sensor is not None:
                    missed.append((sensor, count))
        for sensor, count in missed:
            sensor.skip(count)


def _due_ticks(grid: Timetable, begin: int, end: int) -> list[int]:
    """Return the due ticks after `begin` up to and including `end`."""
    ticks: list[int] = []
    while (tick := grid.next(ticks[-1] if ticks else begin)) <= end:
        ticks.append(tick)
    return ticks


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
        self.before, self.sense, self.after = Agenda(), SampleAgenda(), Agenda()

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

    def sample(self, timetable: Timetable | None, task: Task, sensor: SampledTask) -> None:
        """Call `task(tick)` after the steps of a timetable, unless nobody can read the result."""
        self.sense.add_sensor(task, timetable, sensor)

    def rewind(self, tick: int) -> None:
        """Continue from `tick`. The readings of this tick are done; the commands before the next step are still due."""
        self.before.rewind(max(tick - 1, 0))
        self.sense.rewind(tick)
        self.after.rewind(tick)
        self.renew_readers(tick)

    def renew_readers(self, tick: int) -> None:
        """Consider the present readers of the sensors from `tick` on."""
        self.sense.choose_skipped(tick, is_allowed=not (self.before.every or self.sense.every or self.after.every))
