"""The command `simkit vendor`: copy a world and every file that it names into one folder."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from simkit.cli.terminal.output import report_errors, stdout_console
from simkit.cli.terminal.shared_options import Base, File, PackagePaths, ResourcePaths, XacroArgs, source_arguments


@report_errors
def vendor(
    file: File,
    folder: Annotated[Path, typer.Argument(help="A folder that does not exist yet, or is empty.", show_default=False)],
    resource_path: ResourcePaths = [],
    package_path: PackagePaths = [],
    xacro_arg: XacroArgs = [],
    base: Base = "auto",
) -> int:
    """Writes a folder that holds a world and everything it names, and that opens anywhere."""
    from simkit.build import describe
    from simkit.writers.vendored_folder import vendor as write

    main, count = write(file, folder, describe, **source_arguments(resource_path, package_path, xacro_arg, base))
    stdout_console().print(f"{folder / main} and {count - 1} files that it needs")
    return 0
