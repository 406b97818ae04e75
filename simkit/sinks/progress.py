"""What a person sees while a world runs: simulated time, real-time factor, topics with their true rates."""

from __future__ import annotations

import time
from types import TracebackType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console, RenderableType
    from rich.live import Live

    from simkit.runtime import Simulation
    from simkit.sinks.topic_counts import TopicCount, TopicCounter

_REFRESH = 0.25  # [s] of wall time between two pictures of the progress


class Stopwatch:
    """Wall time [s] since its making."""

    def __init__(self) -> None:
        self._start = time.perf_counter()

    @property
    def elapsed(self) -> float:
        return time.perf_counter() - self._start


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
    """

    def __init__(self, sim: Simulation, counter: TopicCounter, duration: float | None, console: Console) -> None:
        self._sim, self._counter, self._duration, self._console = sim, counter, duration, console
        self._begin = sim.time
        self._watch = Stopwatch()
        self._drawn = 0.0
        self._live: Live | None = None

    def __enter__(self) -> Progress:
        if self._console.is_terminal:
            from rich.live import Live

            self._live = Live(self._picture(), console=self._console, auto_refresh=False, transient=True)
            self._live.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._live is not None:
            self._live.stop()
            self._live = None

    def update(self) -> None:
        """Draws anew when the last picture is old enough."""
        if self._live is None or self._watch.elapsed - self._drawn < _REFRESH:
            return
        self._drawn = self._watch.elapsed
        self._live.update(self._picture(), refresh=True)

    def _picture(self) -> RenderableType:
        from rich.console import Group
        from rich.table import Table
        from rich.text import Text

        done = self._sim.time - self._begin
        factor = done / max(self._watch.elapsed, 1e-9)
        end = f" of {self._duration:g}" if self._duration is not None else ""
        head = Text.assemble((f"t = {self._sim.time:.2f}{end} s", "bold"), f"   {factor:.2f} × real time")
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
