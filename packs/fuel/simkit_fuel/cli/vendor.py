"""Copy a world and all files that it uses into one folder."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from simkit.cli.run_options import NONE_GIVEN
from simkit.cli.terminal import options
from simkit.cli.terminal.output import print_diagnostics, stdout_console
from simkit.extend import Diagnostics, GivenOptions, add_to_report, argument, counted, report_errors, with_run_options

LISTED_AFTER = "convert"


@report_errors
@with_run_options("file")
def vendor(
    file: options.File,
    folder: Annotated[Path, argument("New or empty folder to write.")],
    given: GivenOptions = NONE_GIVEN,
    verbose: options.Verbose = False,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors` reads it)
) -> None:
    """Copy a world and all files that it uses into one folder."""
    from simkit import describe
    from simkit.writers.vendored_folder import vendor as write

    problems = Diagnostics()
    main, count = write(file, folder, describe, diagnostics=problems, **given.source_options())
    print_diagnostics(problems, verbose=verbose)
    add_to_report(main=str(folder / main), files=count, problems=[problem.as_dict() for problem in problems])
    stdout_console().print(f"{folder / main} and {counted(count - 1, 'other file')}")
