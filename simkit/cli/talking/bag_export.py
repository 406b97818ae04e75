"""`simkit bag export`: a bag as tables, pictures and clouds for other tools."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from simkit.cli.options import Force, Json
from simkit.cli.talking.printed import as_json, aside, line, quiet
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError


@quiet
def export(
    recording: Annotated[
        Path, typer.Argument(help="An .mcap or .db3 file, or a folder of rosbag2.", metavar="BAG", show_default=False)
    ],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="The folder; NAME_export beside the bag's name where not given."),
    ] = None,
    topic: Annotated[list[str], typer.Option(help="Only topics of this pattern; repeatable.", metavar="PATTERN")] = [],
    skip: Annotated[
        list[str], typer.Option(help="All but topics of this pattern; repeatable.", metavar="PATTERN")
    ] = [],
    format_: Annotated[
        str, typer.Option("--format", help="Of tables; parquet is the extra of that name.", metavar="csv|npz|parquet")
    ] = "csv",
    images: Annotated[str, typer.Option(help="What becomes of pictures.", metavar="png|mp4|npz|none")] = "png",
    clouds: Annotated[str, typer.Option(help="What becomes of point clouds.", metavar="npz|ply|none")] = "npz",
    start: Annotated[float | None, typer.Option("--start", help="Leaves out what was before.", metavar="S")] = None,
    end: Annotated[float | None, typer.Option("--end", help="Leaves out what was after.", metavar="S")] = None,
    force: Force = False,
    json_: Json = False,
) -> int:
    """Writes a recording as tables, a file a topic, with pictures and point clouds beside them."""
    from dataclasses import asdict

    from simkit.sinks.export import CLOUDS, FORMATS, IMAGES, Wish
    from simkit.sinks.export import export as write

    for option, word, allowed in (
        ("--format", format_, FORMATS),
        ("--images", images, IMAGES),
        ("--clouds", clouds, CLOUDS),
    ):
        if word not in allowed:
            hint = did_you_mean(word, allowed)
            text = f"SK-CLI-018 {option}: found {word!r}, allowed is {', '.join(allowed)}"
            raise InputError(text + (f"; {hint}" if hint else ""), "SK-CLI-018")
    target = output or Path(f"{recording.resolve().stem}_export")
    wish = Wish(tuple(topic), tuple(skip), format_, images, clouds, start, end, force)
    found = write(recording, target, wish)
    if json_:
        as_json({"output": str(target), "topics": [asdict(one) for one in found]})
        return 0
    width = max(len(one.topic) for one in found)
    for one in found:
        beside = f" and {one.beside}" if one.beside else ""
        line(f"{one.topic:<{width}}  {one.count:>8}  {one.file}{beside}")
    for one in found:
        for note in one.notes:
            aside(f"note: {one.topic}: {note}")
    line(f"{target}: {sum(one.count for one in found)} messages of {len(found)} topics")
    return 0
