"""Command `simkit convert`: write a world or model in another format."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from typer import Option

from simkit.cli.run_options import NONE_GIVEN, GivenOptions, with_run_options
from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import add_diagnostics, add_to_report, report_errors
from simkit.cli.terminal.options import option
from simkit.cli.terminal.output import print_diagnostics, print_status, stdout_console
from simkit.diagnostics import Diagnostics
from simkit.errors import InputError
from simkit.number_text import counted
from simkit.run_spec import SourceOptions
from simkit.writers.atomic_output import check_target


@report_errors
@with_run_options("file")
def convert(
    file: options.File,
    output: Annotated[
        Path,
        option(
            "File to write: .xml or .mjcf for MJCF, .sdf or .world for SDF. Its assets go to OUT_assets.",
            "OUT",
            "--output",
            "-o",
            show_default=False,
        ),
    ],
    keep_uris: Annotated[
        bool, Option("--keep-uris", help="SDF: keep model:// and package:// URIs and copy no files.")
    ] = False,
    strict: options.Strict = False,
    given: GivenOptions = NONE_GIVEN,
    force: options.Force = False,
    verbose: options.Verbose = False,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors` reads it)
) -> None:
    """Convert a world or model to MJCF or to a single SDF file."""
    source = given.source_options()
    ending = output.suffix.lower()
    if ending in (".sdf", ".world"):
        count = _to_sdf(file, output, source, keep_uris=keep_uris, strict=strict, force=force, verbose=verbose)
    elif ending in (".xml", ".mjcf"):
        count = _to_mjcf(file, output, source, strict=strict, force=force, verbose=verbose)
    else:
        text = f"found the ending {output.suffix!r}; expected .xml, .mjcf, .sdf or .world"
        raise InputError("SK-CLI-018", f"--output {output}: {text}")
    add_to_report(output=str(output), assets=count)
    stdout_console().print(f"{output}" + (f" and {counted(count, 'file')} in {output.stem}_assets" if count else ""))


def _to_mjcf(file: str, output: Path, source: SourceOptions, *, strict: bool, force: bool, verbose: bool) -> int:
    """Write MJCF; return the number of files in its asset folder."""
    from simkit.build import load
    from simkit.writers.mjcf import write_mjcf

    check_target(output, f"{output.stem}_assets", overwrite=force)
    with load(file, strict=strict, **source) as sim:
        print_diagnostics(sim.diagnostics, verbose=verbose)
        add_diagnostics(sim.diagnostics)
        written = write_mjcf(sim.engine.compiled.builder, output, overwrite=force)
    if written.balanced:
        print_status(
            f"MuJoCo's compiler rejects the inertia of {', '.join(written.balanced[:6])}"
            f"{' and others' if len(written.balanced) > 6 else ''}; the file has the nearest valid inertia"
        )
    return written.files


def _to_sdf(
    file: str, output: Path, source: SourceOptions, *, keep_uris: bool, strict: bool, force: bool, verbose: bool
) -> int:
    """Write SDF; return the number of files in its asset folder."""
    from simkit.build import read_scene
    from simkit.writers.asset_folder import write_sdf

    scene, diagnostics = read_scene(file, missing_meshes=keep_uris, **source)
    lost = Diagnostics(diagnostics)
    lost.raise_if_errors(strict)
    written = write_sdf(scene, output, lost, keep_uris=keep_uris, overwrite=force)
    print_diagnostics(lost, verbose=verbose)
    add_diagnostics(lost)
    return written.files
