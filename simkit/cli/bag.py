"""The command `simkit bag`: describe, mend, plot, export, play and record recordings."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from typer import Option

from simkit.cli.bag_record import record
from simkit.cli.plot_sources import PlotRequest, draw_chart, is_bag, split_sources_and_fields
from simkit.cli.terminal import options
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import (
    absolute_name,
    print_json,
    print_line,
    print_note,
    report_errors,
    report_errors_quietly,
    stdout_console,
)
from simkit.cli.terminal.topic_sources import SimClock, connect_to_simulation
from simkit.errors import InputError

if TYPE_CHECKING:
    from simkit.live import Client, LivePublisher
    from simkit.recording.bags.reader import BagReader


@report_errors_quietly
def plot(
    words: Annotated[
        list[str],
        argument(
            "A bag, or several to compare; then fields: /odom.pose.pose.position.x, /scan.ranges[0].", "BAG... FIELD..."
        ),
    ],
    output: options.ChartFile = Path("plot.svg"),
    against: options.Against = None,
    start: options.Start = None,
    end: options.End = None,
    title: options.Title = "",
    json_: options.Json = False,
) -> None:
    """Draws fields of a recording over time; several recordings come into one chart."""
    from simkit.recording.bags.reader import open_bag_to_read

    sources, fields = split_sources_and_fields(words)
    for name in sources:
        if not is_bag(Path(name)):
            open_bag_to_read(name).close()  # says why not
    draw_chart(sources, fields, PlotRequest(output, against, start, end, title), json_=json_)


@report_errors_quietly
def export(
    recording: options.Recording,
    output: Annotated[
        Path | None, Option("--output", "-o", help="The folder; NAME_export beside the bag's name where not given.")
    ] = None,
    topic: Annotated[list[str], option("Only topics of this pattern; repeatable.", "PATTERN")] = [],
    skip: Annotated[list[str], option("All but topics of this pattern; repeatable.", "PATTERN")] = [],
    format_: Annotated[
        str, option("Of tables; parquet is the extra of that name.", "csv|npz|parquet", "--format")
    ] = "csv",
    images: Annotated[str, option("What becomes of pictures.", "png|mp4|npz|none")] = "png",
    clouds: Annotated[str, option("What becomes of point clouds.", "npz|ply|none")] = "npz",
    start: options.Start = None,
    end: options.End = None,
    force: options.Force = False,
    json_: options.Json = False,
) -> None:
    """Writes a recording as tables, a file a topic, with pictures and point clouds beside them."""
    from simkit.recording.export import CLOUDS, FORMATS, IMAGES, ExportOptions, export_bag

    options.validate_word("--format", format_, FORMATS)
    options.validate_word("--images", images, IMAGES)
    options.validate_word("--clouds", clouds, CLOUDS)
    target = output or Path(f"{recording.resolve().stem}_export")
    wanted = ExportOptions(tuple(topic), tuple(skip), format_, images, clouds, start, end, force)
    found = export_bag(recording, target, wanted)
    if json_:
        print_json({"output": str(target), "topics": [asdict(one) for one in found]})
        return
    width = max(len(one.topic) for one in found)
    for one in found:
        beside = f" and {one.beside}" if one.beside else ""
        print_line(f"{one.topic:<{width}}  {one.count:>8}  {one.file}{beside}")
    for one in found:
        for note in one.notes:
            print_note(f"note: {one.topic}: {note}")
    print_line(f"{target}: {sum(one.count for one in found)} messages of {len(found)} topics")


@report_errors_quietly
def play(
    recording: options.Recording,
    topics: Annotated[
        list[str], Option("--topics", help="Only this one; repeatable. Else all that the world takes.")
    ] = [],
    rate: Annotated[float, option("Times as fast, of simulated time.", "N", "--rate", "-r", min=1e-3)] = 1.0,
    start: Annotated[float, option("Begins so far into the bag.", "S", "--start-offset", min=0)] = 0.0,
    remap: Annotated[list[str], option("Plays OLD on NEW; repeatable.", "OLD:=NEW", "--remap", "-m")] = [],
    loop: Annotated[bool, Option("--loop", "-l", help="Again and again until Ctrl-C.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Plays the messages of a bag into a running simulation, by its clock."""
    from simkit.recording.bags.reader import open_bag_to_read

    names = _parse_remappings(remap)
    with open_bag_to_read(recording) as reader, connect_to_simulation(sim) as client:
        there = list(dict.fromkeys(t.name for t in reader.topics))
        wanted = [absolute_name(t) for t in topics] or _input_topics(client, there, names)
        if not wanted:
            text = f"nothing of {recording} is taken here; --topics says what is to be played"
            raise InputError(f"SK-CLI-030 {text}", "SK-CLI-030")
        for unknown in [t for t in wanted if t not in there][:1]:
            next(reader.messages([unknown]))
        publishers = {
            t.name: client.advertise(names.get(t.name, t.name), t.type_name) for t in reader.topics if t.name in wanted
        }
        if not json_:
            print_note(f"[INFO] [rosbag2_player]: playing {', '.join(publishers)}")
        count = _play_once(client, reader, publishers, rate, start)
        while loop and count:  # a round of nothing takes no time
            count += _play_once(client, reader, publishers, rate, start)
        client.flush()
    if json_:
        print_json({"messages": count, "topics": list(publishers)})


def _parse_remappings(pairs: list[str]) -> dict[str, str]:
    found = {}
    for text in pairs:
        old, sign, new = text.partition(":=")
        if not sign or not old or not new:
            raise InputError(f"SK-CLI-018 --remap: found {text!r}, allowed is OLD:=NEW", "SK-CLI-018")
        found[absolute_name(old)] = absolute_name(new)
    return found


def _input_topics(client: Client, topics: list[str], names: dict[str, str]) -> list[str]:
    """Return the topics that plugins of the world subscribe to; readings of its own sensors are left out."""
    inputs = {row["name"] for row in client.topics() if any(s.get("kind") != "client" for s in row["subscribers"])}
    return [t for t in topics if names.get(t, t) in inputs]


def _play_once(
    client: Client, reader: BagReader, publishers: dict[str, LivePublisher], rate: float, start: float
) -> int:
    """Plays the bag once; how many messages that was."""
    clock = SimClock(client)
    first_ns = reader.start + round(start * 1e9)
    begun_ns = clock.now_ns()
    count = 0
    for message in reader.messages(list(publishers), first_ns):
        due_ns = begun_ns + round((message.time_ns - first_ns) / rate)
        if not clock.wait_until(due_ns, begun_ns):
            print_note("note: the simulation was reset; what is left is not played")
            break
        publishers[message.topic].publish(message.data)
        count += 1
    return count


bag = typer.Typer(help="Recordings: what is in them, new ones, and broken ones mended.", no_args_is_help=True)


@bag.command()
@report_errors_quietly
def info(
    recording: options.Recording,
    topic_name: Annotated[bool, Option("--topic-name", "-t", help="Prints the names of the topics only.")] = False,
    json_: options.Json = False,
) -> None:
    """Says what is in a recording."""
    from simkit.recording.bags.reader import open_bag_to_read
    from simkit.recording.bags.summary import bag_summary, bag_text

    with open_bag_to_read(recording) as reader:
        if reader.broken:
            print_note(f"note: {recording}: {reader.broken}")
        if json_:
            print_json(bag_summary(reader))
        elif topic_name:
            for name in dict.fromkeys(topic.name for topic in reader.topics):
                print_line(name)
        else:
            print_line(bag_text(reader))


bag.command()(record)
bag.command()(play)
bag.command()(plot)
bag.command()(export)


@bag.command()
@report_errors
def recover(
    broken: Annotated[Path, argument("The recording that was cut off: an MCAP file or a rosbag2 folder.")],
    mended: Annotated[Path | None, argument("Where the whole one goes; beside it where not given.")] = None,
    output: Annotated[Path | None, option("The same.", "MENDED", "--output", "-o")] = None,
    force: options.Force = False,
) -> None:
    """Copies what is readable of a recording into a whole one; the broken one stays as it is."""
    from simkit.recording.bags.recovery import recover_bag

    target = output or mended or broken.with_name(f"{broken.stem}_recovered{broken.suffix}")
    found = recover_bag(broken, target, overwrite=force)
    span = (found.end - found.start) * 1e-9
    state = "it was whole" if found.complete else "it was cut off"
    stdout_console().print(f"{target}: {found.messages} messages on {found.topics} topics over {span:.3f} s ({state})")
