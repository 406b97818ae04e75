"""Folders of the option `--interfaces`, which every command has."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from typer import Exit

from simkit.cli.terminal.output import print_error
from simkit.errors import InterfaceError
from simkit.home_folder import expand_home
from simkit.msgs import own_interfaces

_folders: list[Path] = []


def define_interfaces(ctx: Any, folders: Sequence[str]) -> None:
    """Define the types in some folders; end the command with exit code 2 if a definition has errors."""
    paths = [expand_home(folder).absolute() for folder in folders]
    try:
        own_interfaces.add_folders(paths)
    except InterfaceError as error:
        if not ctx.resilient_parsing:
            print_error(error)
            raise Exit(error.exit_code) from None
    _folders[:] = paths
    ctx.call_on_close(_folders.clear)


def interface_folders() -> tuple[Path, ...]:
    """Return the folders of the option on this command line."""
    return tuple(_folders)
