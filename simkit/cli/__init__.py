"""Command line `simkit`: one file for each command, `cli/<command>.py`, with shared code in `cli/terminal`.

A command is thin: it parses its options, calls the library and prints lines, files and an exit code. No other package
imports this one. A command's module is imported only when the command runs. This file imports nothing heavy, so that
`main` can handle Ctrl-C from the first milliseconds on.
"""

from __future__ import annotations

import io
import os
import sys

from simkit.cli.terminal import interruption
from simkit.garbage_collection import permanent_imports

TYPE_CHECKING = False  # `typing` itself takes 3 ms, in which Ctrl-C would print a traceback
if TYPE_CHECKING:
    from simkit.cli.commands import COMMANDS, app

__all__ = ["COMMANDS", "app", "main"]


def main() -> None:
    """Run the command line `simkit`."""
    interruption.install()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal that cannot show a character must not end the run
    try:
        with permanent_imports():
            from simkit.cli.commands import app
            from simkit.cli.terminal.output import output_failure_exit_code, print_error
            from simkit.errors import SimkitError
    except ImportError as error:
        if hasattr(sys.modules["simkit"], "_DISTRIBUTION"):
            raise
        sys.exit(f"error: {error}")  # another project with the same import name has replaced simkit's first file

    try:
        try:
            app(prog_name="simkit")  # also for `python -m simkit`, whose name has no shell completion
        finally:
            for stream in (sys.stdout, sys.stderr):
                if stream is not None:
                    stream.flush()
    except SimkitError as error:  # from the import of a command
        print_error(error)
        sys.exit(error.exit_code)
    except OSError as error:  # outside of a command: the output of `--help`, `--version` and of usage errors
        sys.exit(output_failure_exit_code(error))
    except Exception as error:  # noqa: BLE001 - `_exit_code` raises what it does not know
        sys.exit(_exit_code(error))
    finally:
        interruption.exit_if_interrupted()


def _exit_code(error: Exception) -> int:
    """Return the exit code of an exception that no command has handled, and print its message.

    Raises:
        Exception: the exception itself, if it is a fault of simkit.
    """
    try:
        from simkit.cli.terminal.output import known_error, print_error

        simkit_error = known_error(error)
        if simkit_error is not None:
            print_error(simkit_error)
            return simkit_error.exit_code
    except MemoryError:  # not even the message can be made
        os.write(2, b"error: SK-CORE-008 too little memory\n")
        return 1
    raise error


def __getattr__(name: str) -> object:
    if name not in __all__:
        raise AttributeError(f"module 'simkit.cli' has no attribute {name!r}")
    from simkit.cli import commands

    return getattr(commands, name)
