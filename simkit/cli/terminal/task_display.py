"""Display of long tasks on a terminal: what is done, how far it is, and how long it will take."""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Final

from simkit import progress
from simkit.cli.terminal import interruption

if TYPE_CHECKING:
    from rich.console import Console, RenderableType

    from simkit.progress import Task

_DELAY: Final = 1.0  # [s] of wall time before the display appears; most commands end earlier
_REFRESH: Final = 0.25  # [s] of wall time between two updates
_LONGEST_PAUSE: Final = 0.5  # [s] of wall time between two tasks that count as one for the delay
_MOST_LINES: Final = 3
_FIRST_LINE: Final = 30.0  # [s] of wall time before the first line in a pipe or a log
_LINE_PERIOD: Final = 60.0  # [s] of wall time between two such lines


@contextmanager
def displayed_tasks(console: Callable[[], Console], *, quiet: bool = False) -> Iterator[None]:
    """Show long tasks on standard error: on a terminal they are redrawn, elsewhere a line appears from time to time."""
    if quiet or sys.stderr is None:
        yield
        return
    display = TaskDisplay(console) if is_interactive() else TaskLines(console)
    interruption.before_exit(display.close)
    try:
        with progress.shown_on(display):
            yield
    finally:
        display.close()


def is_interactive() -> bool:
    """Check whether a person reads standard error on a terminal that can redraw a line."""
    return (
        sys.stderr is not None
        and sys.stderr.isatty()
        and not os.environ.get("CI")
        and os.environ.get("TERM", "") not in ("dumb", "unknown")
    )


class TaskDisplay:
    """Display that a thread redraws, so that it also shows the time while the main thread waits for the engine.

    Args:
        console: function that returns the console of standard error; a display that never appears does not call it.
    """

    def __init__(self, console: Callable[[], Console]) -> None:
        self._console = console
        self._tasks: list[Task] = []
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self._stop = threading.Event()
        self._begun = self._ended = -_LONGEST_PAUSE

    def begin(self, task: Task) -> None:
        """Show a task below the tasks that have begun before it."""
        with self._lock:
            self._tasks.append(task)
            if self._thread is None:
                if task.begun - self._ended > _LONGEST_PAUSE:
                    self._begun = task.begun
                self._stop = threading.Event()
                self._thread = threading.Thread(
                    target=self._draw, args=(self._stop,), name="simkit progress", daemon=True
                )
                self._thread.start()

    def end(self, task: Task) -> None:
        """Remove a task. After the last one, the display disappears."""
        with self._lock:
            if task in self._tasks:
                self._tasks.remove(task)
            is_last = not self._tasks
        if is_last:
            self.close()

    def close(self) -> None:
        """Remove the display from the terminal."""
        with self._lock:
            self._tasks.clear()
            thread, self._thread = self._thread, None
        self._stop.set()
        if thread is not None:
            thread.join(_DELAY)
            self._ended = time.perf_counter()

    def _draw(self, stop: threading.Event) -> None:
        if stop.wait(max(0.0, self._begun + _DELAY - time.perf_counter())):
            return
        from rich.errors import LiveError
        from rich.live import Live

        is_both = sys.stdout is not None and sys.stdout.isatty()
        live = Live(console=self._console(), auto_refresh=False, transient=True, redirect_stdout=is_both)
        # OSError: the terminal has closed. LiveError: an old version of rich cannot draw inside the display of a run.
        with suppress(OSError, LiveError), live:
            while not stop.is_set():
                live.update(self._picture(), refresh=True)
                stop.wait(_REFRESH)

    def _picture(self) -> RenderableType:
        from rich.text import Text

        with self._lock:
            shown = self._tasks[-_MOST_LINES:]
        lines = [f"{'  ' * depth}{task_text(task)}" for depth, task in enumerate(shown)]
        return Text("\n".join(lines), no_wrap=True, overflow="ellipsis", style="dim")


class TaskLines(TaskDisplay):
    """Display for pipes and logs: one line for tasks that take long, and another one each minute."""

    _next_line = 0.0

    def _draw(self, stop: threading.Event) -> None:
        self._next_line = max(self._next_line, self._begun + _FIRST_LINE)
        while not stop.wait(max(0.0, self._next_line - time.perf_counter())):
            self._next_line = time.perf_counter() + _LINE_PERIOD
            with self._lock:
                text = "; ".join(task_text(task) for task in self._tasks[:_MOST_LINES])
            with suppress(OSError, ValueError):  # the pipe has closed
                sys.stderr.write(f"{text}\n")
                sys.stderr.flush()


def task_text(task: Task) -> str:
    """Describe a task in one line: title, amount, item, elapsed and remaining time."""
    amount = ""
    if task.total is not None and task.unit == "%":
        amount = f" {100.0 * task.done / task.total:.0f} %"
    elif task.total is not None:
        amount = f" {task.done:.4g} of {task.total:.4g}{' ' if task.unit else ''}{task.unit}"
    elif task.done:
        amount = f" {task.done:.0f}"
    left = task.seconds_left()
    rest = f", about {time_text(left)} left" if left is not None else ""
    item = f" ({task.item})" if task.item else ""
    text = f"{task.title}{':' if amount else ''}{amount}{item}, {time_text(time.perf_counter() - task.begun)}{rest}"
    return text if task.translate is None else task.translate(text)


def time_text(seconds: float) -> str:
    """Format a duration: "8 s", "3 min 40 s" or "2 h 5 min"."""
    full_seconds = round(seconds)
    if full_seconds < 60:
        return f"{full_seconds} s"
    if full_seconds < 3600:
        return f"{full_seconds // 60} min {full_seconds % 60} s"
    return f"{full_seconds // 3600} h {full_seconds % 3600 // 60} min"
