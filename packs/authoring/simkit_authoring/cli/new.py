"""Create a pack."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from simkit.cli.terminal import options
from simkit.cli.terminal.output import print_status, stdout_console
from simkit.extend import add_to_report, argument, option, report_errors

new = typer.Typer(help="Create a pack.", no_args_is_help=True)


@new.callback()
def _group() -> None:
    """Create a pack."""


@new.command("pack")
@report_errors
def new_pack(
    context: typer.Context,
    name: Annotated[str, argument("Name of the pack; its package is simkit_NAME.")],
    folder: Annotated[Path | None, option("Folder for the new files; simkit_NAME by default.", "DIR")] = None,
    force: options.Force = False,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors` reads it)
) -> None:
    """Create a pack with one of each of the usual contents, and tests that pass."""
    from simkit_authoring.pack_skeleton import write_pack

    place = folder if folder is not None else Path(f"simkit_{name}")
    group: Any = context.find_root().command
    commands = group.list_commands(context)
    paths = write_pack(name, place, commands=commands, overwrite=force)
    add_to_report(files=[str(path) for path in paths])
    for path in paths:
        stdout_console().print(str(path))
    print_status(f"install it with `pip install -e {place}`, then run `python -m pytest {place}`")
