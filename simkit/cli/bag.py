"""`simkit bag`: mends recordings."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from simkit.cli.console import guarded, out
from simkit.cli.options import Force

bag = typer.Typer(help="Mends recordings.", no_args_is_help=True)


@bag.callback()
def _group() -> None:
    """Mends recordings."""


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
