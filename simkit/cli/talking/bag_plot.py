"""`simkit bag plot`: fields of a bag over time."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from simkit.cli.options import Json
from simkit.cli.talking.plot_options import Against, End, Output, Start, Title
from simkit.cli.talking.plotted import Wish, divided, is_bag
from simkit.cli.talking.plotted import plot as draw
from simkit.cli.talking.printed import quiet


@quiet
def plot(
    words: Annotated[
        list[str],
        typer.Argument(
            help="A bag, or several to compare; then fields: /odom.pose.pose.position.x, /scan.ranges[0].",
            metavar="BAG... FIELD...",
            show_default=False,
        ),
    ],
    output: Output = Path("plot.svg"),
    against: Against = None,
    start: Start = None,
    end: End = None,
    title: Title = "",
    json_: Json = False,
) -> int:
    """Draws fields of a recording over time; several recordings come into one chart."""
    from simkit.sinks.bag_reader import open_bag_to_read

    sources, fields = divided(words)
    for name in sources:
        if not is_bag(Path(name)):
            open_bag_to_read(name).close()  # says why not
    return draw(sources, fields, Wish(output, against, start, end, title), json_=json_)
