"""`simkit tf`: frames of a running simulation or a bag: which hangs on which, and where one is seen from another."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import typer

from simkit.cli.terminal import completion
from simkit.cli.terminal.live_options import Bag, Sim
from simkit.cli.terminal.options import Json
from simkit.cli.terminal.output import not_found_error, print_json, print_line, report_errors_quietly
from simkit.cli.terminal.topic_sources import ReceivedMessage, Source, open_source
from simkit.errors import InputError

if TYPE_CHECKING:
    from simkit.pose import Pose

_TOPICS = ("/tf", "/tf_static")
_TYPE = "tf2_msgs/msg/TFMessage"
_LISTENED = 1.0  # [s] of wall time in which frames are collected
tf = typer.Typer(help="Frames of a running simulation, or of a bag.", no_args_is_help=True)
Topics = Annotated[
    list[str],
    typer.Option("--topic", help="Where transforms come, other than /tf and /tf_static; repeatable.", metavar="TOPIC"),
]


@tf.callback()
def _group() -> None:
    """Frames of a running simulation, or of a bag."""


@dataclass(frozen=True)
class Edge:
    """A frame in the one it hangs on; the time is that of the transform [ns]."""

    parent: str
    pose: Pose
    time_ns: int
    static: bool


class Frames:
    """Every frame that was told of, with its newest transform."""

    def __init__(self) -> None:
        self.edges: dict[str, Edge] = {}

    def take(self, message: Any, *, static: bool) -> None:
        """Takes in a `tf2_msgs/msg/TFMessage`."""
        from simkit import msgs
        from simkit.pose import Pose

        for one in message.transforms:
            at, turn = one.transform.translation, one.transform.rotation
            pose = Pose((at.x, at.y, at.z), (turn.w, turn.x, turn.y, turn.z))
            child = one.child_frame_id.lstrip("/")
            self.edges[child] = Edge(one.header.frame_id.lstrip("/"), pose, msgs.stamp_ns(one.header.stamp), static)

    def names(self) -> list[str]:
        """All frames, sorted."""
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

    def between(self, source: str, target: str) -> tuple[Pose, int] | None:
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


def listen(
    source: Source, frames: Frames, topics: list[str] | None = None, *, lasting: float
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
    until = time.monotonic() + lasting
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


@tf.command()
@report_errors_quietly
def tree(
    topic: Topics = [],
    listened: Annotated[
        float, typer.Option("--time", help="Listens so long (wall time).", metavar="S", min=0)
    ] = _LISTENED,
    sim: Sim = None,
    bag: Bag = None,
    json_: Json = False,
) -> int:
    """Prints which frame hangs on which."""
    frames = Frames()
    with open_source(sim, bag) as source:
        for _ in listen(source, frames, topic or None, lasting=listened):
            pass
    if json_:
        rows = {c: {"parent": e.parent, "static": e.static, "time": e.time_ns * 1e-9} for c, e in frames.edges.items()}
        print_json(rows)
    elif frames.edges:
        for text in frames.lines():
            print_line(text)
    else:
        print_line("no transforms came")
    return 0


@tf.command()
@report_errors_quietly
def echo(
    source_frame: Annotated[
        str, typer.Argument(metavar="SOURCE", show_default=False, autocompletion=completion.frames)
    ],
    target_frame: Annotated[
        str, typer.Argument(metavar="TARGET", show_default=False, autocompletion=completion.frames)
    ],
    rate: Annotated[float, typer.Argument(help="Times a second (wall time).", metavar="[RATE]", min=1e-3)] = 1.0,
    once: Annotated[bool, typer.Option("--once", help="Ends behind the first one.")] = False,
    precision: Annotated[int, typer.Option("--precision", "-p", help="Digits.", metavar="N", min=0, max=15)] = 3,
    topic: Topics = [],
    sim: Sim = None,
    bag: Bag = None,
    json_: Json = False,
) -> int:
    """Prints where TARGET is, as seen from SOURCE; of a bag, at its end."""
    frames = Frames()
    with open_source(sim, bag) as source:
        begun = time.monotonic()
        while True:
            for _ in listen(source, frames, topic or None, lasting=1.0 / rate):
                if once and source.is_live and frames.between(source_frame, target_frame) is not None:
                    break
            found = frames.between(source_frame, target_frame)
            if found is None and time.monotonic() - begun < _LISTENED and source.is_live:
                continue
            if found is None:
                raise _not_connected(frames, source_frame, target_frame, source.where)
            _print(*found, precision, json_)
            if once or not source.is_live:
                return 0


def _not_connected(frames: Frames, source: str, target: str, where: str) -> InputError:
    for name in (source, target):
        if name not in frames.names():
            return not_found_error("frame", name, frames.names(), "SK-CLI-038", where)
    text = f"SK-CLI-038 {source!r} and {target!r} do not hang together: they are of separate trees in {where}"
    return InputError(text, "SK-CLI-038")


def _print(pose: Pose, time_ns: int, precision: int, json_: bool) -> None:
    xyz, (w, x, y, z), rpy = list(pose.position), pose.quaternion, list(pose.rpy)
    if json_:
        rotation = [float(q) for q in (x, y, z, w)]
        print_json({"time": time_ns * 1e-9, "translation": [float(v) for v in xyz], "rotation": rotation})
        return

    def listed(numbers: Any) -> str:
        return "[" + ", ".join(f"{float(n) + 0.0:.{precision}f}" for n in numbers) + "]"

    print_line(f"At time {time_ns // 10**9}.{time_ns % 10**9:09d}")
    print_line(f"- Translation: {listed(xyz)}")
    print_line(f"- Rotation: in Quaternion (xyzw) {listed((x, y, z, w))}")
    print_line(f"- Rotation: in RPY (radian) {listed(rpy)}")
    print_line(f"- Rotation: in RPY (degree) {listed(math.degrees(a) for a in rpy)}")
    print_line("- Matrix:")
    for row, at in zip(pose.matrix, xyz, strict=True):
        print_line("".join(f"{float(n) + 0.0:{precision + 4}.{precision}f}" for n in (*row, at)))
    print_line("".join(f"{n:{precision + 4}.{precision}f}" for n in (0.0, 0.0, 0.0, 1.0)))
