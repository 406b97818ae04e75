"""Show the frames of a running simulation or of a bag."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Argument, Option

from simkit.cli.terminal import options
from simkit.cli.terminal.frame_tree import check_frame_chart, receive_transforms, write_frame_chart
from simkit.cli.terminal.output import (
    not_found_error,
    print_json,
    print_line,
    print_name,
    printable,
    without_interrupt_message,
)
from simkit.cli.terminal.topic_sources import open_source
from simkit.errors import InputError, TransformError
from simkit.extend import counted, option, report_errors
from simkit_terminal.cli.terminal import completion

if TYPE_CHECKING:
    from simkit import Pose
    from simkit.msgs.transform_tree import TransformTree

LISTED_AFTER = "model"

_COLLECTION_TIME = 1.0  # [s] of wall time
tf = typer.Typer(help="Show the frames of a running simulation or of a bag.", no_args_is_help=True)
Topics = Annotated[
    list[str], option("Topic of transforms instead of /tf and /tf_static; repeatable.", "TOPIC", "--topic")
]


@tf.command()
@report_errors
@without_interrupt_message
def tree(
    topic: Topics = [],
    duration: Annotated[float, option("Wall time for collecting transforms.", "S", "--time", min=0)] = _COLLECTION_TIME,
    sim: options.Sim = None,
    bag: options.Bag = None,
    json_: options.Json = False,
) -> None:
    """Print the tree of frames."""
    from simkit.msgs.transform_tree import TransformTree  # imports NumPy

    frames = TransformTree()
    with open_source(sim, bag) as source:
        for _ in receive_transforms(source, frames, topic or None, duration=duration):
            pass
    if json_:
        parents = {child: parent for child, parent in frames.frames().items() if parent}
        rows = {
            c: {"parent": p, "static": frames.is_static(c), "time": frames.newest(c) * 1e-9} for c, p in parents.items()
        }
        print_json(rows)
    elif frames.frames():
        for text in tree_lines(frames):
            print_name(text)
    else:
        print_line("no transforms received")


@tf.command("frames")
@report_errors
@without_interrupt_message
def draw_frames(
    output: Annotated[Path, option("Chart to write: OUT.pdf or OUT.svg.", "OUT", "--output", "-o")] = Path(
        "frames.pdf"
    ),
    topic: Topics = [],
    duration: Annotated[float, option("Wall time for collecting transforms.", "S", "--time", min=0)] = _COLLECTION_TIME,
    sim: options.Sim = None,
    bag: options.Bag = None,
    json_: options.Json = False,
) -> None:
    """Draw the tree of frames, as `ros2 run tf2_tools view_frames` does. Dashed lines are static transforms."""
    from simkit.msgs.transform_tree import TransformTree

    check_frame_chart(output)
    frames = TransformTree()
    with open_source(sim, bag) as source:
        for _ in receive_transforms(source, frames, topic or None, duration=duration):
            pass
        where = source.where
    write_frame_chart(output, printable(f"Frames of {where}"), frames)
    parents = frames.frames()
    if json_:
        edges = len([child for child, parent in parents.items() if parent])
        print_json({"output": str(output), "frames": len(parents), "edges": edges})
    else:
        print_line(f"{output}: {counted(len(parents), 'frame')}")


@tf.command()
@report_errors
@without_interrupt_message
def echo(
    source_frame: Annotated[str, Argument(metavar="SOURCE", show_default=False, autocompletion=completion.frames)],
    target_frame: Annotated[str, Argument(metavar="TARGET", show_default=False, autocompletion=completion.frames)],
    rate: Annotated[float, Argument(help="Lines per second (wall time).", metavar="[RATE]", min=1e-3)] = 1.0,
    once: Annotated[bool, Option("--once", help="Exit after the first pose.")] = False,
    precision: Annotated[int, option("Number of decimals.", "N", "--precision", "-p", min=0, max=15)] = 3,
    topic: Topics = [],
    sim: options.Sim = None,
    bag: options.Bag = None,
    json_: options.Json = False,
) -> None:
    """Print the pose of TARGET in SOURCE; for a bag, at its end."""
    from simkit.msgs.transform_tree import TransformTree

    frames = TransformTree()
    with open_source(sim, bag) as source:
        begun = time.monotonic()
        while True:
            for _ in receive_transforms(source, frames, topic or None, duration=1.0 / rate):
                if once and source.is_live and _has_pose(frames, source_frame, target_frame):
                    break
            try:
                transform = frames.latest(source_frame, target_frame)
            except TransformError:
                if time.monotonic() - begun < _COLLECTION_TIME and source.is_live:
                    continue
                raise _not_connected(frames, source_frame, target_frame, source.where) from None
            _print(*transform, precision, json_)
            if once or not source.is_live:
                return


def _has_pose(frames: TransformTree, source: str, target: str) -> bool:
    try:
        frames.latest(source, target)
    except TransformError:
        return False
    return True


def _not_connected(frames: TransformTree, source: str, target: str, where: str) -> InputError:
    known = list(frames.frames())
    for name in (source, target):
        if name.lstrip("/") not in known:
            return not_found_error("frame", name, known, "SK-CLI-038", where)
    text = f"{source!r} and {target!r} are not connected: they are in separate trees in {where}"
    return InputError("SK-CLI-038", text)


def _print(pose: Pose, time_ns: int, precision: int, json_: bool) -> None:
    xyz, (w, x, y, z), rpy = list(pose.position), pose.quaternion, list(pose.rpy)
    if json_:
        rotation = [float(q) for q in (x, y, z, w)]
        print_json({"time": time_ns * 1e-9, "translation": [float(v) for v in xyz], "rotation": rotation})
        return

    def listed(numbers: Iterable[float]) -> str:
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


def tree_lines(tree: TransformTree) -> list[str]:
    """Return the trees of frames as text, one frame per line, indented by depth."""
    parents = tree.frames()
    children: dict[str, list[str]] = {}
    for child, parent in parents.items():
        children.setdefault(parent, []).append(child)
    lines: list[str] = []

    def add(name: str, depth: int, seen: frozenset[str]) -> None:
        lines.append("  " * depth + name + (" (static)" if tree.is_static(name) else ""))
        for child in children.get(name, ()) if name not in seen else ():
            add(child, depth + 1, seen | {name})

    for root in children.get("", ()) or list(parents)[:1]:  # frames in a circle have no root
        add(root, 0, frozenset())
    return lines
