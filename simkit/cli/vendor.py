"""Command `simkit vendor`: copy a world and every file that it uses into one folder."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from simkit.cli.run_options import NONE_GIVEN, GivenOptions, with_run_options
from simkit.cli.terminal import options
from simkit.cli.terminal.options import argument
from simkit.cli.terminal.output import report_errors, stdout_console


@report_errors
@with_run_options("file")
def vendor(
    file: options.File,
    folder: Annotated[Path, argument("New or empty folder to write.")],
    given: GivenOptions = NONE_GIVEN,
) -> None:
    """Copy a world and all files that it uses into one folder."""
    from simkit.build import describe
    from simkit.writers.vendored_folder import vendor as write

    main, count = write(file, folder, describe, **given.source_options())
    stdout_console().print(f"{folder / main} and {count - 1} other files")
