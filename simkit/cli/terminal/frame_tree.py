"""Transforms on `/tf` and `/tf_static` of a simulation or a bag."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from simkit.cli.terminal.output import not_found_error
from simkit.cli.terminal.topic_sources import ReceivedMessage, Source
from simkit.errors import InputError

if TYPE_CHECKING:
    from simkit.msgs.transform_tree import TransformTree

_TOPICS = ("/tf", "/tf_static")
_TYPE = "tf2_msgs/msg/TFMessage"


def receive_transforms(
    source: Source, frames: TransformTree, topics: list[str] | None = None, *, duration: float
) -> Iterator[ReceivedMessage]:
    """Store transforms in `frames` and yield their messages.

    A live source is read for `duration` [s, wall time, from its subscription on]; a bag is read to its end.
    """
    known = source.topics()
    selected = topics or [t for t in known if t.rpartition("/")[2] in ("tf", "tf_static") and _TYPE in known[t].types]
    selected = [t for t in selected if t in known] or [t for t in _TOPICS if t in known]
    if not selected:
        raise not_found_error("topic", "/tf", list(known), "SK-CLI-030", source.where)
    static = {t for t in selected if any(end.latched for end in known[t].publishers) or t.endswith("tf_static")}
    from simkit import msgs

    msgs.type_of(_TYPE)  # the first use of a type is slow, so it must come before the duration begins
    feed = source.feed(selected)
    until = time.monotonic() + duration
    try:
        while not source.is_live or time.monotonic() < until:
            received = feed.take(max(0.0, until - time.monotonic()))
            if received is None:
                return
            message = source.decode(received)
            if not hasattr(message, "transforms"):
                text = f"{received.topic} has type {received.type_name}; expected {_TYPE}"
                raise InputError("SK-CLI-032", text)
            frames.advance(received.topic, received.time_ns)
            frames.take(message, is_static=received.topic in static)
            yield received
    finally:
        feed.close()


def check_frame_chart(output: Path) -> None:
    """Check that a chart can be written to a file.

    Raises:
        InputError: SK-CLI-016 the suffix of the file is none of a chart.
    """
    from simkit.recording.graphs.graph_file import check_graph_file

    check_graph_file(output)


def write_frame_chart(output: Path, title: str, frames: TransformTree) -> None:
    """Write the tree of frames as SVG or PDF, as the suffix of the file says."""
    from simkit.recording.graphs.graph_contents import frame_graph
    from simkit.recording.graphs.graph_file import write_graph

    write_graph(output, title, *frame_graph(frames))
