"""Option `--interfaces`, which every command has, and the folders of this option on the command line."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Annotated, Any

import typer

_HELP = "Folder with definitions .msg, .srv and .action: a ROS package or a workspace; repeatable."
_folders: list[Path] = []


def interface_folders() -> tuple[Path, ...]:
    """Return the folders of the option on this command line."""
    return tuple(_folders)


@cache
def interfaces_option() -> Any:
    """Return the option, a parameter of click."""

    def placeholder(
        interfaces: Annotated[
            list[str],
            typer.Option(metavar="DIR", help=_HELP, callback=_define_interfaces, expose_value=False, is_eager=True),
        ] = [],
    ) -> None:
        pass

    maker = typer.Typer(add_completion=False)
    maker.command()(placeholder)
    return next(each for each in typer.main.get_command(maker).params if each.name == "interfaces")


def _define_interfaces(ctx: typer.Context, folders: list[str]) -> None:
    """Define the types in the folders of the option, before the command runs or completes a value.

    A definition with errors is left out with a warning. If no definition remains, the command ends with exit code 2.
    """
    if not folders:
        return
    from simkit.cli.terminal.output import print_error, print_note
    from simkit.errors import InterfaceError
    from simkit.home_folder import expand_home
    from simkit.msgs import own_interfaces

    paths = [expand_home(folder).absolute() for folder in folders]
    try:
        reports = own_interfaces.add_folders(paths)
        if not ctx.resilient_parsing:
            for report in reports:
                print_note(str(report))
            own_interfaces.note_told(reports)
    except InterfaceError as error:
        if not ctx.resilient_parsing:
            print_error(error)
            raise typer.Exit(error.exit_code) from None
    _folders[:] = paths
    ctx.call_on_close(_folders.clear)
