"""What a run says at its end: topics, one line, and a hash that is equal for two runs that did the same."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from simkit.cli.console import err, out
from simkit.errors import RenderError
from simkit.runtime.state_hash import state_hash

if TYPE_CHECKING:
    from simkit.sinks.recorder import Recorder
    from simkit.sinks.topic_counts import TopicCounter


def summarise(sim: Any, counter: TopicCounter, recording: Recorder | None, elapsed: float, *, quiet: bool) -> None:
    """Topics with their true rates, then one line, then the hash of the physics state.

    Args:
        sim: the simulation.
        counter: of its topics.
        recording: what was recorded.
        elapsed: wall time of the run [s].
        quiet: whether the topics are left out.
    """
    from simkit.sinks.progress import rate_text

    if not quiet and counter.rows:
        width = max(len(row.topic) for row in counter.rows)
        for row in counter.rows:
            out().print(f"{row.topic:<{width}}  {row.count:>8}  {rate_text(row):>12}  {row.type_name}")
    factor = sim.time / max(elapsed, 1e-9)
    line = f"simulated {sim.time:.3f} s in {elapsed:.2f} s ({factor:.2f} × real time), {counter.total} messages read"
    if recording is not None:
        line += f"; {recording.message_count} in {recording.path}"
    out().print(line)
    out().print(f"state {state_hash(sim)}")


def draw(sim: Any, path: Path, driven: Any) -> None:
    """The scene at the end, with the path that was driven."""
    from simkit.build import render_view
    from simkit.sinks.picture import save_picture

    try:
        save_picture(sim, path, render_view, driven)
    except RenderError as error:
        err().print(f"warning: no picture: {error}", style="yellow")
    else:
        out().print(f"picture {path}")
