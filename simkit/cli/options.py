"""Options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

World = Annotated[
    str, typer.Argument(help="A file, or the bare name of a world or model that comes with simkit.", show_default=False)
]
File = Annotated[str, typer.Argument(help="A world or model file, or a bare name.", show_default=False)]
ResourcePaths = Annotated[
    list[Path],
    typer.Option(
        "--resource-path", help="One more folder for model://, package:// and relative URIs; repeatable.", metavar="DIR"
    ),
]
PluginPaths = Annotated[
    list[Path],
    typer.Option("--plugin-path", help="Allows the Python plugins in that folder; repeatable.", metavar="DIR"),
]
Strict = Annotated[bool, typer.Option("--strict", help="Warnings are errors.")]
Json = Annotated[bool, typer.Option("--json", help="For programs: one JSON value.")]
Verbose = Annotated[bool, typer.Option("--verbose", "-v", help="Shows every note, not only how many there are.")]
Force = Annotated[bool, typer.Option("--force", help="Replaces what is there already.")]
