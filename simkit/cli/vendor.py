"""Command `simkit vendor`: copy a world and every file that it uses into one folder."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from simkit.cli.terminal import options
from simkit.cli.terminal.options import argument
from simkit.cli.terminal.output import report_errors, stdout_console


@report_errors
def vendor(
    file: options.File,
    folder: Annotated[Path, argument("New or empty folder to write.")],
    resource_path: options.ResourcePaths = [],
    package_path: options.PackagePaths = [],
    xacro_arg: options.XacroArgs = [],
    base: options.Base = "auto",
) -> None:
    """Copy a world and all files that it uses into one folder."""
    from simkit.build import describe
    from simkit.writers.vendored_folder import vendor as write

    source = options.source_arguments(resource_path, package_path, xacro_arg, base)
    main, count = write(file, folder, describe, **source)
    stdout_console().print(f"{folder / main} and {count - 1} other files")
