"""Progress display of a run on a terminal: simulated time, real-time factor, and topics with their rates."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console, RenderableType
    from rich.live import Live

    from simkit.recording.topic_counts import TopicCount, TopicCounter
    from simkit.runtime import Simulation

_REFRESH = 0.25  # [s] of wall time between two updates of the display
_REFRESH_LINES = 0.1  # [s] of wall time, for keyboard driving
_FACTOR_WINDOW = 1.0  # [s] of wall time


def rate_text(row: TopicCount) -> str:
    """Format the measured rate of a topic; a dash if it has too few messages, "not read" if it is not counted."""
    if not row.counted:
        return "not read"
    rate = row.rate()
    return "–" if rate is None else f"{rate:.2f} Hz"


class Progress:
    """Live display on a terminal; shows nothing on other outputs. A context manager.

    Args:
        sim: simulation to show.
        counter: message counts of its topics.
        duration: simulated length of the run [s]; None for a run without an end.
        console: output of the display.
        lines: function that returns lines to show instead of the topics.
        status_lines: lines that are always shown below the time, such as an address.
    """

    def __init__(
        self,
        sim: Simulation,
        counter: TopicCounter,
        duration: float | None,
        console: Console,
        lines: Callable[[], Sequence[str]] | None = None,
        status_lines: Sequence[str] = (),
    ) -> None:
        self._sim, self._counter, self._duration, self._console = sim, counter, duration, console
        self._lines, self._status_lines = lines, status_lines
        self._refresh = _REFRESH if lines is None else _REFRESH_LINES
        self._drawn = time.perf_counter()
        self._marks = [(self._drawn, sim.time)]
        self._live: Live | None = None

    def __enter__(self) -> Progress:
        if self._console.is_interactive:
            from rich.live import Live

            # redirect the output of plugins only if it goes to the same terminal
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
        """Redraw the display if the last update is old enough."""
        now = time.perf_counter()
        if self._live is None or now - self._drawn < self._refresh:
            return
        self._drawn = now
        try:
            self._live.update(self._picture(), refresh=True)
        except OSError:  # the terminal has closed; the run continues without the display
            self._live = None

    def _factor(self) -> float:
        """Return simulated time divided by wall time: of the whole run, or of the last second for keyboard driving."""
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
        digits = 3 if self._sim.paused else 2  # a single step is often 1 ms
        head = Text.assemble((f"t = {self._sim.time:.{digits}f}{end} s", "bold"), state)
        status = [Text(line, overflow="fold") for line in self._status_lines]
        if self._lines is not None:
            return Group(head, *status, *(Text(line, no_wrap=True, overflow="ellipsis") for line in self._lines()))
        table = Table(box=None, padding=(0, 2, 0, 0))
        table.add_column("topic")
        table.add_column("messages", justify="right")
        table.add_column("rate", justify="right")
        rows = self._counter.rows
        room = max(self._console.height - 4 - len(status), 3)
        for row in rows[:room]:
            table.add_row(row.topic, str(row.count), rate_text(row))
        more = [Text(f"… and {len(rows) - room} more")] if len(rows) > room else []
        return Group(head, *status, table, *more)
