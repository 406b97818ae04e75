"""Module `time` of a program: all clocks show simulated time, and `sleep` waits for it. The time zone is UTC."""

from __future__ import annotations

import calendar
import time as _python
from types import SimpleNamespace
from typing import Any, Final

from simkit_nodes.tasks import current_task

__all__ = [
    "altzone",
    "asctime",
    "clock_gettime",
    "clock_gettime_ns",
    "ctime",
    "daylight",
    "get_clock_info",
    "gmtime",
    "localtime",
    "mktime",
    "monotonic",
    "monotonic_ns",
    "perf_counter",
    "perf_counter_ns",
    "process_time",
    "process_time_ns",
    "sleep",
    "strftime",
    "thread_time",
    "thread_time_ns",
    "time",
    "time_ns",
    "timezone",
    "tzname",
]

_NANOSECONDS: Final = 1_000_000_000

daylight = altzone = timezone = 0
tzname = ("UTC", "UTC")


def sleep(seconds: float) -> None:
    """Wait for a duration [s] of simulated time."""
    if seconds < 0:
        raise ValueError("sleep length must be non-negative")
    task = current_task()
    if task is None:
        _python.sleep(seconds)
        return
    host = task.program.host
    host.wait(host.now_ns() + max(1, round(seconds * _NANOSECONDS)))


def time_ns() -> int:
    """Return the simulated time [ns]."""
    task = current_task()
    if task is None:
        return _python.time_ns()
    task.poll()
    return task.program.host.now_ns()


def time() -> float:
    """Return the simulated time [s]."""
    return time_ns() / _NANOSECONDS


monotonic = perf_counter = process_time = thread_time = time
monotonic_ns = perf_counter_ns = process_time_ns = thread_time_ns = time_ns


def clock_gettime(clock: int) -> float:
    """Return the simulated time [s], which all clocks show."""
    return time()


def clock_gettime_ns(clock: int) -> int:
    """Return the simulated time [ns], which all clocks show."""
    return time_ns()


def get_clock_info(name: str) -> SimpleNamespace:
    """Describe a clock."""
    adjustable = name == "time"
    return SimpleNamespace(implementation="simulated time", monotonic=True, adjustable=adjustable, resolution=1e-9)


def gmtime(seconds: float | None = None) -> _python.struct_time:
    """Return the date of a time [s] since 1970; of the simulated time by default."""
    return _python.gmtime(time() if seconds is None else seconds)


localtime = gmtime


def mktime(date: Any) -> float:
    """Return the time [s] since 1970 of a date."""
    return float(calendar.timegm(tuple(date)))


def asctime(date: Any = None) -> str:
    """Return a date as text."""
    return _python.asctime(localtime() if date is None else date)


def ctime(seconds: float | None = None) -> str:
    """Return the date of a time [s] as text."""
    return asctime(localtime(seconds))


def strftime(pattern: str, date: Any = None) -> str:
    """Return a date in a format."""
    return _python.strftime(pattern, localtime() if date is None else date)
