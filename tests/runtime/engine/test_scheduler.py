"""Due ticks of tasks, for rates with a common cycle and for rates whose cycle is too long to store."""

from __future__ import annotations

from functools import partial

import pytest

from simkit.runtime.engine.scheduler import Scheduler
from simkit.runtime.engine.simulated_time import Clock


def _record_call(called: list[tuple[int, int]], number: int, tick: int) -> None:
    called.append((tick, number))


@pytest.mark.parametrize(
    ("step", "rates"),
    [
        (0.001, (200.0, 30.0, 5.0, 100.0, 7.0)),
        (0.001, (130.0, None, 30.0)),
        (0.0005, (1000.0 / 3, 17.3, 59.94)),  # repeats after millions of steps
        (0.001, (1.0, 1.0)),
    ],
)
def test_every_task_is_called_at_its_own_ticks_in_the_order_of_addition(
    step: float, rates: tuple[float | None, ...]
) -> None:
    clock = Clock(step)
    scheduler = Scheduler(clock)
    called: list[tuple[int, int]] = []
    for number, rate in enumerate(rates):
        scheduler.every(rate, partial(_record_call, called, number), "sense")
    scheduler.rewind(0)
    last = 5000
    grids = [clock.grid(rate or 0.0, from_start=True) for rate in rates]
    expected = [
        (tick, number)
        for tick in range(1, last + 1)
        for number, grid in enumerate(grids)
        if grid is None or grid.next(tick - 1) == tick
    ]
    agenda = scheduler.sense
    tick = 0
    while True:
        tick = tick + 1 if agenda.every else agenda.next
        if tick > last:
            break
        for task in agenda.due(tick):
            task(tick)
    assert called == expected


def test_after_a_rewind_the_schedule_continues_from_that_tick() -> None:
    scheduler = Scheduler(Clock(0.001))
    scheduler.every(30.0, lambda tick: None, "sense")
    scheduler.every(200.0, lambda tick: None, "sense")
    for tick in (0, 1, 2, 33, 34, 100, 12345):
        scheduler.rewind(tick)
        first = scheduler.sense.next
        assert tick < first <= tick + 5
        assert scheduler.sense.due(first)
        assert first < scheduler.sense.next <= first + 5


def test_a_schedule_that_is_filled_again_has_the_ticks_of_its_present_rates() -> None:
    scheduler = Scheduler(Clock(0.001))
    called: list[tuple[int, int]] = []
    tasks = [partial(_record_call, called, number) for number in range(2)]

    def ticks(rates: tuple[float, float], begin: int) -> list[tuple[int, int]]:
        scheduler.clear()
        for rate, task in zip(rates, tasks, strict=True):
            scheduler.every(rate, task, "after")
        scheduler.rewind(begin)
        called.clear()
        for tick in range(begin + 1, begin + 61):
            for task in scheduler.after.due(tick) if scheduler.after.next <= tick else ():
                task(tick)
        return list(called)

    def expected(periods: tuple[int, int], begin: int) -> list[tuple[int, int]]:
        times = range(begin + 1, begin + 61)
        return [(tick, n) for tick in times for n, period in enumerate(periods) if tick % period == 0]

    for begin in (0, 30, 0):
        for rates in ((100.0, 50.0), (100.0, 50.0), (50.0, 200.0)):
            assert ticks(rates, begin) == expected((round(1000 / rates[0]), round(1000 / rates[1])), begin)


class Sensor:
    """Sensor whose last sample alone can be read; it records ticks of samples and counts those that are left out."""

    def __init__(self, *, is_silent: bool = True) -> None:
        self.is_silent = self.keeps_last = is_silent
        self.ticks: list[int] = []
        self.count = 0

    def sample(self, tick: int) -> None:
        self.ticks.append(tick)
        self.count += 1

    def skip(self, count: int) -> None:
        self.count += count


def run_with_stops(sensors: dict[float, Sensor], stops: list[int]) -> list[int]:
    """Run sensors by their rates to given ticks, and return all ticks at which the run stopped."""
    clock = Clock(0.001)
    scheduler = Scheduler(clock)
    for rate, sensor in sensors.items():
        scheduler.sample(clock.grid(rate, from_start=True), sensor.sample, sensor)
    scheduler.rewind(0)
    agenda, tick, passed = scheduler.sense, 0, []
    for stop in stops:
        while tick < stop:
            tick = agenda.stop_before(tick, stop)
            passed.append(tick)
            for task in agenda.due(tick) if agenda.next <= tick else ():
                task(tick)
    return passed


def test_of_samples_that_nobody_reads_only_the_last_before_a_stop_is_taken_and_all_are_counted() -> None:
    sensors = {200.0: Sensor(), 30.0: Sensor()}
    stops = run_with_stops(sensors, [101, 120, 123, 199])
    assert stops == [1, 100, 101, 120, 123, 167, 195, 199]
    assert sensors[200.0].ticks == [1, 100, 120, 195]
    assert sensors[30.0].ticks == [1, 100, 167]
    assert [sensor.count for sensor in sensors.values()] == [40, 6]


def test_all_samples_are_taken_if_one_task_may_read_the_others() -> None:
    sensors = {200.0: Sensor(), 30.0: Sensor(is_silent=False)}
    run_with_stops(sensors, [101, 1000])
    assert [len(sensor.ticks) for sensor in sensors.values()] == [201, 31]
