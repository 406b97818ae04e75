"""Collect the coordinate frames that transforms on `/tf` and `/tf_static` describe."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from simkit.cli.terminal.output import not_found_error
from simkit.cli.terminal.topic_sources import ReceivedMessage, Source
from simkit.errors import InputError

if TYPE_CHECKING:
    from simkit.msgs import TFMessage
    from simkit.pose import Pose

_TOPICS = ("/tf", "/tf_static")
_TYPE = "tf2_msgs/msg/TFMessage"


@dataclass(frozen=True)
class FrameTransform:
    """A frame in the one it hangs on; the time is that of the transform [ns]."""

    parent: str
    pose: Pose
    time_ns: int
    static: bool


class FrameTree:
    """Every frame that was told of, with its newest transform."""

    def __init__(self) -> None:
        self.edges: dict[str, FrameTransform] = {}

    def take(self, message: TFMessage, *, static: bool) -> None:
        """Takes in a `tf2_msgs/msg/TFMessage`."""
        from simkit import msgs  # NumPy and rosbags, which completing a word does not wait for
        from simkit.pose import Pose

        for one in message.transforms:
            at, turn = one.transform.translation, one.transform.rotation
            pose = Pose((at.x, at.y, at.z), (turn.w, turn.x, turn.y, turn.z))
            child = one.child_frame_id.lstrip("/")
            self.edges[child] = FrameTransform(
                one.header.frame_id.lstrip("/"), pose, msgs.stamp_ns(one.header.stamp), static
            )

    def names(self) -> list[str]:
        """Return the names of all frames, sorted."""
        return sorted({*self.edges, *(edge.parent for edge in self.edges.values())})

    def lines(self) -> list[str]:
        """The trees, a frame a line, indented by how deep it hangs."""
        children: dict[str, list[str]] = {}
        for child, edge in sorted(self.edges.items()):
            children.setdefault(edge.parent, []).append(child)
        found: list[str] = []

        def add(name: str, depth: int, seen: frozenset[str]) -> None:
            edge = self.edges.get(name)
            note = " (static)" if edge is not None and edge.static else ""
            found.append("  " * depth + name + note)
            for child in children.get(name, ()) if name not in seen else ():
                add(child, depth + 1, seen | {name})

        roots = [name for name in self.names() if name not in self.edges]
        for root in roots or self.names()[:1]:
            add(root, 0, frozenset())
        return found

    def chain(self, name: str) -> list[tuple[str, Pose, int]]:
        """The frame and those above it: name, pose of `name` in it, oldest time on the way [ns] (-1: static only)."""
        from simkit.pose import Pose

        pose, oldest, found = Pose(), -1, [(name, Pose(), -1)]
        while name in self.edges and len(found) <= len(self.edges):
            edge = self.edges[name]
            pose, name = edge.pose @ pose, edge.parent
            if not edge.static:
                oldest = edge.time_ns if oldest < 0 else min(oldest, edge.time_ns)
            found.append((name, pose, oldest))
        return found

    def pose_between(self, source: str, target: str) -> tuple[Pose, int] | None:
        """The pose of `target` in `source`, and its time [ns]; None where they are of separate trees, or unknown."""
        if source not in self.names():
            return None  # else any name would have its place in itself
        below = {name: (pose, at) for name, pose, at in reversed(self.chain(source))}
        for name, pose, at in self.chain(target):
            if name in below:
                mine, when = below[name]
                times = [t for t in (at, when) if t >= 0]
                return mine.inverse() @ pose, min(times, default=0)
        return None


def receive_transforms(
    source: Source, frames: FrameTree, topics: list[str] | None = None, *, duration: float
) -> Iterator[ReceivedMessage]:
    """Takes transforms into `frames` for so long [s, wall time, from when it is heard]; of a bag, all there are."""
    there = source.topics()
    wanted = topics or [t for t in there if t.rpartition("/")[2] in ("tf", "tf_static") and _TYPE in there[t].types]
    wanted = [t for t in wanted if t in there] or [t for t in _TOPICS if t in there]
    if not wanted:
        raise not_found_error("topic", "/tf", list(there), "SK-CLI-030", source.where)
    static = {t for t in wanted if any(end.latched for end in there[t].publishers) or t.endswith("tf_static")}
    from simkit import msgs

    msgs.type_of(_TYPE)  # the first use of a type takes a while, which is not to be listening's
    feed = source.feed(wanted)
    until = time.monotonic() + duration
    try:
        while not source.is_live or time.monotonic() < until:
            received = feed.take(max(0.0, until - time.monotonic()))
            if received is None:
                return
            message = source.decode(received)
            if not hasattr(message, "transforms"):
                text = f"SK-CLI-032 {received.topic} is of type {received.type_name}, allowed is {_TYPE}"
                raise InputError(text, "SK-CLI-032")
            frames.take(message, static=received.topic in static)
            yield received
    finally:
        feed.close()
