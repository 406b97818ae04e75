"""`simkit bag`: what is in a recording; a new one of a running simulation; one played into it; a broken one mended."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from simkit.cli.console import guarded, out
from simkit.cli.options import Force, Json
from simkit.cli.talking.bag_export import export
from simkit.cli.talking.bag_play import play
from simkit.cli.talking.bag_plot import plot
from simkit.cli.talking.bag_record import record
from simkit.cli.talking.printed import as_json, aside, line, quiet

bag = typer.Typer(help="Recordings: what is in them, new ones, and broken ones mended.", no_args_is_help=True)


@bag.callback()
def _group() -> None:
    """Recordings: what is in them, new ones, and broken ones mended."""


@bag.command()
@quiet
def info(
    recording: Annotated[
        Path, typer.Argument(help="An .mcap or .db3 file, or a folder of rosbag2.", metavar="BAG", show_default=False)
    ],
    topic_name: Annotated[
        bool, typer.Option("--topic-name", "-t", help="Prints the names of the topics only.")
    ] = False,
    json_: Json = False,
) -> int:
    """Says what is in a recording."""
    from simkit.sinks.bag_reader import open_bag_to_read
    from simkit.sinks.bag_text import bag_summary, bag_text

    with open_bag_to_read(recording) as reader:
        if reader.broken:
            aside(f"note: {recording}: {reader.broken}")
        if json_:
            as_json(bag_summary(reader))
        elif topic_name:
            for name in dict.fromkeys(topic.name for topic in reader.topics):
                line(name)
        else:
            line(bag_text(reader))
    return 0


bag.command()(record)
bag.command()(play)
bag.command()(plot)
bag.command()(export)


@bag.command()
@guarded
def recover(
    broken: Annotated[
        Path,
        typer.Argument(help="The recording that was cut off: an MCAP file or a rosbag2 folder.", show_default=False),
    ],
    mended: Annotated[
        Path | None, typer.Argument(help="Where the whole one goes; beside it where not given.", show_default=False)
    ] = None,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="The same.", metavar="MENDED")] = None,
    force: Force = False,
) -> int:
    """Copies what is readable of a recording into a whole one; the broken one stays as it is."""
    from simkit.sinks.recover import recover as mend

    target = output or mended or broken.with_name(f"{broken.stem}_recovered{broken.suffix}")
    found = mend(broken, target, overwrite=force)
    span = (found.end - found.start) * 1e-9
    state = "it was whole" if found.complete else "it was cut off"
    out().print(f"{target}: {found.messages} messages on {found.topics} topics over {span:.3f} s ({state})")
    return 0
