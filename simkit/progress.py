"""Progress of tasks that may take seconds. Code reports its tasks; an installed display shows them.

Without a display, a report costs less than a microsecond and nothing is shown. The command line installs a display for
terminals (`simkit.cli.terminal.task_display`). A Python program can install its own:

    with progress.shown_on(display):
        simkit.load("warehouse.world")
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Protocol, TypeVar

Item = TypeVar("Item")


@dataclass(eq=False)
class Task:
    """Task that is being done. The code that does it sets these fields; a display reads them when it draws.

    Attributes:
        title: text such as "building models".
        total: amount of work in `unit`; None if unknown. It may change.
        unit: unit of `total` and `done`; empty for a count, "%" to show the ratio only.
        expected: expected or longest wall time [s]; None if unknown.
        done: amount of finished work.
        item: file or entity in progress; may be empty.
        begun: start of the task, as `time.perf_counter()` gives it [s].
        translate: function from the line that a display shows to the line in the user's language; None for English.
    """

    title: str
    total: float | None = None
    unit: str = ""
    expected: float | None = None
    done: float = 0.0
    item: str = ""
    begun: float = field(default_factory=time.perf_counter)
    translate: Callable[[str], str] | None = None

    def advance(self, item: str = "") -> None:
        """Count one finished item; name it, or keep the name that is shown."""
        self.done += 1
        self.item = item or self.item

    def seconds_left(self) -> float | None:
        """Estimate the remaining wall time [s]; None if there is no basis for an estimate."""
        elapsed = time.perf_counter() - self.begun
        estimates = []
        if self.total is not None and self.done > 0:
            estimates.append(max(0.0, elapsed * (self.total - self.done) / self.done))
        if self.expected is not None and elapsed < self.expected:
            estimates.append(self.expected - elapsed)
        return min(estimates, default=None)


class Display(Protocol):
    """Display of tasks. Its methods may be called from several threads."""

    def begin(self, task: Task) -> None:
        """Show a task, inside the tasks that have begun before it."""
        ...

    def end(self, task: Task) -> None:
        """Remove a task."""
        ...


_display: Display | None = None
_innermost: Task | None = None


@contextmanager
def shown_on(display: Display | None) -> Iterator[None]:
    """Show the tasks of this process on a display; None shows nothing."""
    global _display
    before, _display = _display, display
    try:
        yield
    finally:
        _display = before


@contextmanager
def task(title: str, total: float | None = None, *, unit: str = "", expected: float | None = None) -> Iterator[Task]:
    """Report a task while the block runs. The arguments are attributes of `Task`."""
    global _innermost
    display, outer = _display, _innermost
    begun = _innermost = Task(title, total, unit, expected)
    if display is not None:
        display.begin(begun)
    try:
        yield begun
    finally:
        _innermost = outer
        if display is not None:
            display.end(begun)


def set_item(item: str) -> None:
    """Name the file or entity that the innermost task works on; without a task, nothing happens."""
    if _innermost is not None:
        _innermost.item = item


def report_each(
    title: str, items: Iterable[Item], total: float | None = None, *, translate: Callable[[str], str] | None = None
) -> Iterator[Item]:
    """Report a loop over items as a task. The other arguments are attributes of `Task`."""
    with task(title, total) as progress:
        progress.translate = translate
        for item in items:
            yield item
            progress.advance()
