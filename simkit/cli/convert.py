"""`simkit convert`: the engine's own format."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from simkit.cli.console import guarded, out, print_diagnostics
from simkit.cli.options import File, Force, ResourcePaths, Verbose
from simkit.errors import InputError


@guarded
def convert(
    file: File,
    output: Annotated[
        Path,
        typer.Option(
            "--output", "-o", help="The MJCF file; its textures go beside it.", metavar="OUT.xml", show_default=False
        ),
    ],
    resource_path: ResourcePaths = [],
    force: Force = False,
    verbose: Verbose = False,
) -> int:
    """Writes what would be simulated as MJCF, to be opened by MuJoCo alone."""
    from simkit.build import load
    from simkit.sinks.mjcf import write_mjcf

    if output.exists() and not force:
        raise InputError(
            f"SK-CLI-016 {output} exists already and is not overwritten\n    help: --force replaces it", "SK-CLI-016"
        )
    if not output.absolute().parent.is_dir():
        raise InputError(f"SK-CLI-016 there is no folder {output.absolute().parent}", "SK-CLI-016")
    with load(file, resource_paths=resource_path) as sim:
        print_diagnostics(sim.diagnostics, verbose=verbose)
        written = write_mjcf(sim, output)
    out().print(f"{output}" + (f" and {written} textures beside it" if written else ""))
    return 0
