"""Command `simkit bag`: describe, recover, plot, film, export, play and record bags."""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Option

from simkit.cli.bag_record import record
from simkit.cli.plot_sources import PlotRequest, draw_chart, is_bag, split_sources_and_fields
from simkit.cli.run_loop import Interrupts
from simkit.cli.run_options import NONE_GIVEN, GivenOptions, with_run_options
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.json_report import add_to_report, report_errors
from simkit.cli.terminal.options import argument, option, validate_word
from simkit.cli.terminal.output import (
    absolute_name,
    print_diagnostics,
    print_json,
    print_line,
    print_name,
    print_note,
    without_interrupt_message,
)
from simkit.cli.terminal.topic_sources import SimClock, connect_to_simulation
from simkit.errors import InputError
from simkit.number_text import counted

if TYPE_CHECKING:
    from simkit.live import Client, LivePublisher
    from simkit.recording.bags.reader import BagReader

_LOSSES_LISTED = 20


@report_errors
@without_interrupt_message
def plot(
    arguments: Annotated[
        list[str],
        argument(
            "One or more bags, then fields: /odom.pose.pose.position.x, /scan.ranges[0].",
            "BAG... FIELD...",
            completion.sources_and_fields,
        ),
    ],
    output: options.ChartFile = Path("plot.svg"),
    against: options.Against = None,
    start: options.Start = None,
    end: options.End = None,
    title: options.Title = "",
    json_: options.Json = False,
) -> None:
    """Plot fields of bags over time. Several bags share one chart."""
    from simkit.recording.bags.reader import open_bag_to_read

    sources, fields = split_sources_and_fields(arguments)
    for name in sources:
        if not is_bag(Path(name)):
            open_bag_to_read(name).close()  # raises an error that describes the problem
    draw_chart(sources, fields, PlotRequest(output, against, start, end, title), json_=json_)


@report_errors
@without_interrupt_message
def export(
    recording: options.Recording,
    output: Annotated[
        Path | None, Option("--output", "-o", help="Folder to write; default: NAME_export in the current folder.")
    ] = None,
    topic: Annotated[list[str], option("Only topics that match this pattern; repeatable.", "PATTERN")] = [],
    skip: Annotated[list[str], option("Leave out topics that match this pattern; repeatable.", "PATTERN")] = [],
    format_: Annotated[
        str, option("Format of the tables; parquet needs the extra of that name.", "csv|npz|parquet", "--format")
    ] = "csv",
    images: Annotated[str, option("Format of the images.", "png|mp4|npz|none")] = "png",
    clouds: Annotated[str, option("Format of the point clouds.", "npz|ply|none")] = "npz",
    start: options.Start = None,
    end: options.End = None,
    force: options.Force = False,
    json_: options.Json = False,
) -> None:
    """Export a bag as tables, images and point clouds."""
    from simkit.recording.export import CLOUDS, FORMATS, IMAGES, ExportOptions, export_bag

    validate_word("--format", format_, FORMATS)
    validate_word("--images", images, IMAGES)
    validate_word("--clouds", clouds, CLOUDS)
    target = output or Path(f"{recording.resolve().stem}_export")
    export_options = ExportOptions(tuple(topic), tuple(skip), format_, images, clouds, start, end, force)
    exports = export_bag(recording, target, export_options)
    if json_:
        print_json({"output": str(target), "topics": [asdict(e) for e in exports]})
        return
    width = max(len(e.topic) for e in exports)
    for e in exports:
        beside = f" and {e.beside}" if e.beside else ""
        print_line(f"{e.topic:<{width}}  {e.count:>8}  {e.file}{beside}")
    for e in exports:
        for note in e.notes:
            print_note(f"note: {e.topic}: {note}")
    messages = counted(sum(e.count for e in exports), "message")
    print_line(f"{target}: {messages} of {counted(len(exports), 'topic')}")


@report_errors
@without_interrupt_message
@with_run_options("file", "world", usual={"model_world": "empty space"})
def video(
    recording: options.Recording,
    world: Annotated[str, argument("World of the recorded run.", "WORLD", completion.worlds)],
    output: Annotated[Path, option("Film to write: OUT.mp4, OUT.webm or OUT.gif.", "OUT", "--output", "-o")] = Path(
        "bag.mp4"
    ),
    resolution: options.Resolution = None,
    fps: options.Fps = None,
    camera: options.FilmCamera = "auto",
    start: options.Start = None,
    end: options.End = None,
    given: GivenOptions = NONE_GIVEN,
    json_: options.Json = False,
) -> int:
    """Film a bag: its poses or odometry, joint states and scans, drawn in its world."""
    from simkit.build import load
    from simkit.recording.bags.reader import open_bag_to_read
    from simkit.recording.films.film import film_bag, film_options
    from simkit.sensors.cameras.overview_image import render_view
    from simkit.sensors.cameras.renderer_choice import check_available

    is_gif = output.suffix.lower() == ".gif"
    film = film_options(output if is_gif else None, None if is_gif else output, resolution, fps, camera)
    assert film is not None
    with open_bag_to_read(recording) as bag, Interrupts() as interrupts:
        with load(world, **given.load_arguments()) as sim:
            check_available(sim)
            print_diagnostics(sim.diagnostics, verbose=False)
            count, moved = film_bag(sim, bag, film, render_view, (start, end), lambda: interrupts.exit_code != 0)
        if not moved:
            print_note(f"note: {recording} moves no model of {world}: it has no odometry or poses of its models")
    if json_:
        print_json({"output": str(output), "frames": count, "models": sorted(moved)})
    else:
        print_line(f"{output}: {counted(count, 'frame')}, {float(film.frame_rate):g} per second")
    return interrupts.exit_code


@report_errors
@without_interrupt_message
def play(
    recordings: Annotated[
        list[Path], argument("Bags: .mcap or .db3 files, or rosbag2 folders; several share one timeline.", "BAG...")
    ],
    topics: Annotated[
        list[str],
        option(
            "Topic to play; repeatable. Default: all inputs of the world.",
            None,
            "--topics",
            complete=completion.source_topics,
        ),
    ] = [],
    all_: Annotated[bool, Option("--all", "-a", help="Play all topics of the bags.")] = False,
    rate: Annotated[float, option("Playback speed factor.", "N", "--rate", "-r", min=1e-3)] = 1.0,
    start: Annotated[float, option("Start at this offset into the bag.", "S", "--start-offset", min=0)] = 0.0,
    remap: Annotated[list[str], option("Play OLD as NEW; repeatable.", "OLD:=NEW", "--remap", "-m")] = [],
    loop: Annotated[bool, Option("--loop", "-l", help="Repeat until Ctrl-C.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Play the messages of bags into a running simulation.

    The simulation's clock sets the pace.
    """
    from simkit.recording.bags.reader import open_bag_to_read

    names = _parse_remappings(remap)
    with ExitStack() as stack:
        readers = [stack.enter_context(open_bag_to_read(recording)) for recording in recordings]
        client = stack.enter_context(connect_to_simulation(sim))
        bag_topics = list(dict.fromkeys(t.name for reader in readers for t in reader.topics))
        selected = [absolute_name(t) for t in topics] or (
            bag_topics if all_ else _input_topics(client, bag_topics, names)
        )
        if not selected:
            text = f"the world subscribes to no topic of {', '.join(map(str, recordings))}; choose topics with --topics"
            raise InputError("SK-CLI-030", text, help="--all plays all topics")
        for unknown in [t for t in selected if t not in bag_topics][:1]:
            next(readers[0].messages([unknown]))
        publishers: dict[str, LivePublisher] = {}
        for reader in readers:
            of_bag = [t for t in reader.topics if t.name in selected]
            reader.define_types([t.name for t in of_bag])
            for t in of_bag:
                if t.name not in publishers:
                    publishers[t.name] = client.advertise(names.get(t.name, t.name), t.type_name)
        if not json_:
            print_note(f"[INFO] [rosbag2_player]: playing {', '.join(publishers)}")
        count = _play_once(client, readers, publishers, rate, start)
        while loop and count:  # a round without messages takes no time, so that the loop would never wait or end
            count += _play_once(client, readers, publishers, rate, start)
        client.flush()
    if json_:
        print_json({"messages": count, "topics": list(publishers)})


def _parse_remappings(pairs: list[str]) -> dict[str, str]:
    new_by_old = {}
    for text in pairs:
        old, sign, new = text.partition(":=")
        if not sign or not old or not new:
            raise InputError("SK-CLI-018", f"--remap: found {text!r}; expected OLD:=NEW")
        new_by_old[absolute_name(old)] = absolute_name(new)
    return new_by_old


def _input_topics(client: Client, topics: list[str], names: dict[str, str]) -> list[str]:
    """Return the topics that plugins of the world subscribe to; subscribers in clients do not count."""
    inputs = {row["name"] for row in client.topics() if any(s.get("kind") != "client" for s in row["subscribers"])}
    return [t for t in topics if names.get(t, t) in inputs]


def _play_once(
    client: Client, readers: Sequence[BagReader], publishers: dict[str, LivePublisher], rate: float, start: float
) -> int:
    """Play the bags once, in the order of their times; return the number of messages."""
    clock = SimClock(client)
    first_ns = min(reader.start for reader in readers) + round(start * 1e9)
    begun_ns = clock.now_ns()
    count = 0
    bags = []
    for reader in readers:
        known = {t.name for t in reader.topics}
        played = [topic for topic in publishers if topic in known]
        if played:
            bags.append(reader.messages(played, first_ns))
    for message in heapq.merge(*bags, key=lambda message: message.time_ns):
        due_ns = begun_ns + round((message.time_ns - first_ns) / rate)
        if not clock.wait_until(due_ns, begun_ns):
            print_note("note: the simulation was reset; the remaining messages are not played")
            break
        publishers[message.topic].publish(message.data)
        count += 1
    return count


bag = typer.Typer(help="Record, describe, play, film, export and recover bags.", no_args_is_help=True)


@bag.command()
@report_errors
@without_interrupt_message
def info(
    recording: options.Recording,
    topic_name: Annotated[bool, Option("--topic-name", "-t", help="Print only the names of the topics.")] = False,
    json_: options.Json = False,
) -> None:
    """Describe a bag: time span, topics, types and numbers of messages."""
    from simkit.recording.bags.reader import open_bag_to_read
    from simkit.recording.bags.summary import bag_summary, bag_text

    with open_bag_to_read(recording) as reader:
        if reader.broken:
            print_note(f"note: {recording}: {reader.broken}")
        if json_:
            print_json(bag_summary(reader))
        elif topic_name:
            for name in dict.fromkeys(topic.name for topic in reader.topics):
                print_name(name)
        else:
            print_line(bag_text(reader))


bag.command()(record)
bag.command()(play)
bag.command()(plot)
bag.command()(export)
bag.command()(video)


@bag.command()
@report_errors
def recover(
    broken: Annotated[Path, argument("Bag that is damaged or was cut off: an MCAP file or a rosbag2 folder.")],
    recovered: Annotated[Path | None, argument("Bag to write; default: NAME_recovered in the same folder.")] = None,
    output: Annotated[Path | None, option("Alias of the argument RECOVERED.", "RECOVERED", "--output", "-o")] = None,
    force: options.Force = False,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors` reads it)
) -> None:
    """Copy the readable part of a bag into a new, complete bag, and report what is lost.

    The original is not changed.
    """
    from simkit.recording.bags.recovery import recover_bag

    target = output or recovered or broken.with_name(f"{broken.stem}_recovered{broken.suffix}")
    recovery = recover_bag(broken, target, overwrite=force)
    add_to_report(
        output=str(target),
        messages=recovery.messages,
        topics=recovery.topics,
        state=recovery.state,
        losses=recovery.loss_lines(),
    )
    for line in recovery.loss_lines()[:_LOSSES_LISTED]:
        print_note(f"note: {line}")
    if len(recovery.losses) > _LOSSES_LISTED:
        print_note(f"note: {counted(len(recovery.losses) - _LOSSES_LISTED, 'more damaged part')}")
    span = (recovery.end - recovery.start) * 1e-9
    print_line(
        f"{target}: {counted(recovery.messages, 'message')} on {counted(recovery.topics, 'topic')} "
        f"over {span:.3f} s ({recovery.state})"
    )
