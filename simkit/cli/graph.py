"""Command `simkit graph`: draw the nodes and topics, or the frames, of a world or of a running simulation."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Option

from simkit.cli.run_options import NONE_GIVEN, GivenOptions, with_run_options
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.frame_tree import receive_transforms
from simkit.cli.terminal.json_report import report_errors
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import (
    JsonObject,
    print_diagnostics,
    print_json,
    print_line,
    print_note,
    printable,
    without_interrupt_message,
)
from simkit.cli.terminal.topic_sources import open_source
from simkit.number_text import counted
from simkit.run_fields import LoadArguments

if TYPE_CHECKING:
    from simkit.msgs.transform_tree import TransformTree

_FRAMES_AFTER = 0.2  # [s] of simulated time in which a world sends its transforms
_COLLECTION_TIME = 1.0  # [s] of wall time for the transforms of a running simulation


@report_errors
@without_interrupt_message
@with_run_options("file", "world", usual={"model_world": "empty space"})
def graph(
    source: Annotated[str, argument("World, model, or name of a running simulation.", "WORLD|SIM", completion.worlds)],
    output: Annotated[Path, option("Chart to write: OUT.svg or OUT.pdf.", "OUT", "--output", "-o")] = Path("graph.svg"),
    tf: Annotated[bool, Option("--tf", help="Draw the tree of frames instead of nodes and topics.")] = False,
    hidden: Annotated[
        bool, Option("--all", "-a", help="Include hidden names, simkit's own nodes, and topics such as /clock.")
    ] = False,
    given: GivenOptions = NONE_GIVEN,
    json_: options.Json = False,
) -> None:
    """Draw the nodes and topics, or the frames, of a world or a running simulation."""
    from simkit.live import simulations
    from simkit.recording.graphs.graph_contents import frame_graph, node_graph
    from simkit.recording.graphs.graph_file import check_graph_file, write_graph

    check_graph_file(output)
    is_running = any(sim.name == source for sim in simulations())
    if is_running:
        nodes, frames = _of_simulation(source, tf=tf)
    else:
        nodes, frames = _of_world(source, given.load_arguments(), tf=tf)
    boxes, edges = frame_graph(frames) if tf else node_graph(nodes, hidden=hidden)
    if not boxes:
        print_note(f"note: {source} has no {'frames' if tf else 'nodes with topics, services or actions'}")
    title = f"{'Frames' if tf else 'Nodes and topics'} of {Path(source).name if '<' not in source else 'a world'}"
    write_graph(output, printable(title), boxes, edges)
    kinds = {kind: sum(box.kind == kind for box in boxes) for kind in (("frame",) if tf else ("node", "topic"))}
    if json_:
        print_json({"output": str(output), **{f"{kind}s": count for kind, count in kinds.items()}, "edges": len(edges)})
    else:
        print_line(f"{output}: " + ", ".join(counted(count, kind) for kind, count in kinds.items()))


def _of_simulation(name: str, *, tf: bool) -> tuple[Mapping[str, JsonObject], TransformTree]:
    """Return the nodes and the frames of a running simulation."""
    from simkit.cli.terminal.topic_sources import connect_to_simulation
    from simkit.msgs.transform_tree import TransformTree

    frames = TransformTree()
    if tf:
        with open_source(name, None) as source:
            for _ in receive_transforms(source, frames, duration=_COLLECTION_TIME):
                pass
        return {}, frames
    with connect_to_simulation(name) as client:
        return client.ask("nodes"), frames


def _of_world(source: str, arguments: LoadArguments, *, tf: bool) -> tuple[Mapping[str, JsonObject], TransformTree]:
    """Return the nodes of a world, and with `tf` the frames that it sends at the beginning of a run."""
    from simkit.bridges.live.introspection import node_list
    from simkit.build import load
    from simkit.msgs.transform_tree import TransformTree

    frames = TransformTree()
    with load(source, **arguments) as sim:
        print_diagnostics(sim.diagnostics, verbose=False)
        if tf:
            for topic, type_name in sim.topics().items():
                if type_name == "tf2_msgs/msg/TFMessage" and topic.rpartition("/")[2] in ("tf", "tf_static"):
                    sim.subscribe(topic, partial(frames.take, is_static=topic.endswith("tf_static")))
            sim.run(_FRAMES_AFTER)
            return {}, frames
        return node_list(sim, ()), frames
