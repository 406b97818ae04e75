"""Show the progress of a run on a terminal: simulated time, real-time factor, topics with their rates."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console, RenderableType
    from rich.live import Live

    from simkit.recording.topic_counts import TopicCount, TopicCounter
    from simkit.runtime import Simulation

_REFRESH = 0.25  # [s] of wall time between two pictures of the progress
_REFRESH_LINES = 0.1  # where somebody drives by it
_FACTOR_WINDOW = 1.0  # [s] of wall time


def rate_text(row: TopicCount) -> str:
    """The true rate of a topic up to `now` [ns], or why there is none."""
    if not row.counted:
        return "not read"
    rate = row.rate()
    return "–" if rate is None else f"{rate:.2f} Hz"


class Progress:
    """Live lines on a terminal; silent anywhere else. A context manager.

    Args:
        sim: the simulation.
        counter: counts its topics.
        duration: how long it is to run [s]; None where it runs until it is stopped.
        console: where to draw.
        lines: gives what is shown instead of the topics.
    """

    def __init__(
        self,
        sim: Simulation,
        counter: TopicCounter,
        duration: float | None,
        console: Console,
        lines: Callable[[], Sequence[str]] | None = None,
    ) -> None:
        self._sim, self._counter, self._duration, self._console = sim, counter, duration, console
        self._lines = lines
        self._refresh = _REFRESH if lines is None else _REFRESH_LINES
        self._drawn = time.perf_counter()
        self._marks = [(self._drawn, sim.time)]
        self._live: Live | None = None

    def __enter__(self) -> Progress:
        if self._console.is_terminal:
            from rich.live import Live

            # what a plugin prints stays where it goes, where that is not the terminal
            is_both = not self._console.stderr
            self._live = Live(
                self._picture(), console=self._console, auto_refresh=False, transient=True, redirect_stdout=is_both
            )
            self._live.start()
        return self

    def __exit__(self, *_: object) -> None:
        if self._live is not None:
            self._live.stop()
            self._live = None

    def update(self) -> None:
        """Draws anew when the last picture is old enough."""
        now = time.perf_counter()
        if self._live is None or now - self._drawn < self._refresh:
            return
        self._drawn = now
        try:
            self._live.update(self._picture(), refresh=True)
        except OSError:  # the terminal is gone, and nobody wanted the run to end with it
            self._live = None

    def _factor(self) -> float:
        """Simulated time by wall time: of the whole run, or where somebody drives of the last seconds."""
        now, reached = time.perf_counter(), self._sim.time
        if self._lines is not None and now - self._marks[-1][0] > _FACTOR_WINDOW:
            self._marks = [self._marks[-1], (now, reached)]
        since, begun = self._marks[0]
        return max(0.0, reached - begun) / max(now - since, 1e-9)

    def _picture(self) -> RenderableType:
        from rich.console import Group
        from rich.table import Table
        from rich.text import Text

        factor = self._factor()
        end = f" of {self._duration:g}" if self._duration is not None else ""
        state = ("   paused", "bold yellow") if self._sim.paused else f"   {factor:.2f} × real time"
        head = Text.assemble((f"t = {self._sim.time:.2f}{end} s", "bold"), state)
        if self._lines is not None:
            return Group(head, *(Text(line, no_wrap=True, overflow="ellipsis") for line in self._lines()))
        table = Table(box=None, padding=(0, 2, 0, 0))
        table.add_column("topic")
        table.add_column("messages", justify="right")
        table.add_column("rate", justify="right")
        rows = self._counter.rows
        room = max(self._console.height - 4, 3)
        for row in rows[:room]:
            table.add_row(row.topic, str(row.count), rate_text(row))
        more = [Text(f"… and {len(rows) - room} more")] if len(rows) > room else []
        return Group(head, table, *more)
