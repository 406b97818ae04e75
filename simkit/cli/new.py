"""Command `simkit new`: create a pack."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from simkit.cli.terminal import options
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import print_status, report_errors, stdout_console

new = typer.Typer(help="Create a pack.", no_args_is_help=True)


@new.callback()
def _group() -> None:
    """Create a pack."""


@new.command("pack")
@report_errors
def new_pack(
    name: Annotated[str, argument("Name of the pack; its package is simkit_NAME.")],
    folder: Annotated[Path | None, option("Folder for the new files; simkit_NAME by default.", "DIR")] = None,
    force: options.Force = False,
) -> None:
    """Create a pack with a plugin, a sensor, a command, a code, a world, and tests that pass."""
    from simkit.plugins.authoring.pack_skeleton import write_pack

    place = folder if folder is not None else Path(f"simkit_{name}")
    for path in write_pack(name, place, overwrite=force):
        stdout_console().print(str(path))
    print_status(f"install it with `pip install -e {place}`, then run `python -m pytest {place}`")
