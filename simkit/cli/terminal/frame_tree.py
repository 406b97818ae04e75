"""Tree of the coordinate frames in the transforms on `/tf` and `/tf_static`."""

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
    """Pose of a frame in its parent frame.

    Attributes:
        parent: name of the parent frame.
        pose: pose of the frame in the parent frame.
        time_ns: time of the transform [ns].
        static: True for a transform from `/tf_static`.
    """

    parent: str
    pose: Pose
    time_ns: int
    static: bool


class FrameTree:
    """Newest transform of every received frame."""

    def __init__(self) -> None:
        self.edges: dict[str, FrameTransform] = {}

    def take(self, message: TFMessage, *, static: bool) -> None:
        """Store the transforms of a `tf2_msgs/msg/TFMessage`."""
        from simkit import msgs  # imported late: NumPy and rosbags would delay shell completion
        from simkit.pose import Pose

        for stamped in message.transforms:
            position, rotation = stamped.transform.translation, stamped.transform.rotation
            pose = Pose((position.x, position.y, position.z), (rotation.w, rotation.x, rotation.y, rotation.z))
            child = stamped.child_frame_id.lstrip("/")
            self.edges[child] = FrameTransform(
                stamped.header.frame_id.lstrip("/"), pose, msgs.stamp_ns(stamped.header.stamp), static
            )

    def names(self) -> list[str]:
        """Return the names of all frames, sorted."""
        return sorted({*self.edges, *(edge.parent for edge in self.edges.values())})

    def lines(self) -> list[str]:
        """Return the trees as text, one frame per line, indented by depth."""
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
        """Return a frame and its ancestors.

        Returns:
            For each frame: its name, the pose of `name` in it, and the oldest time on the path [ns] (-1: only static).
        """
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
        """Return the pose of `target` in `source` and its time [ns]; None for unknown frames or separate trees."""
        if source not in self.names():
            return None  # without this check, an unknown frame would have a pose in its own frame
        ancestors = {name: (pose, time_ns) for name, pose, time_ns in reversed(self.chain(source))}
        for name, pose, time_ns in self.chain(target):
            if name in ancestors:
                source_pose, source_time_ns = ancestors[name]
                times = [t for t in (time_ns, source_time_ns) if t >= 0]
                return source_pose.inverse() @ pose, min(times, default=0)
        return None


def receive_transforms(
    source: Source, frames: FrameTree, topics: list[str] | None = None, *, duration: float
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
                text = f"SK-CLI-032 {received.topic} has type {received.type_name}; expected {_TYPE}"
                raise InputError(text, "SK-CLI-032")
            frames.take(message, static=received.topic in static)
            yield received
    finally:
        feed.close()
