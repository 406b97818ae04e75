"""End of a command: messages and exit codes for errors, and with `--json` one JSON object on standard output.

With `--json`, everything else is on standard error.
"""

from __future__ import annotations

import functools
import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, redirect_stdout, suppress
from typing import IO, NoReturn

import typer

from simkit.cli.terminal.output import (
    JsonObject,
    P,
    errors_in_words,
    json_written_to,
    print_json,
)
from simkit.diagnostics import Diagnostic
from simkit.errors import InputError, LoadError, SimkitError

# Base class of click's usage errors; newer versions of Typer have click as a private module.
UsageError: type[Exception] = typer.BadParameter.__mro__[1]
_USAGE_CODE = "SK-CLI-018"
_INTERRUPTED = (130, 143)  # exit codes of a stream that a user ends
_FILE_AND_LINE = re.compile(r"(?P<file>\S[^:\n]*):(?P<line>\d+)")


class JsonReport:
    """Report of the running command; a context manager that redirects standard output to standard error.

    The redirection includes the file descriptor, so that output of plugins, of child processes and of libraries in C
    does not mix with the JSON object.

    Attributes:
        values: keys and values that the command has added.
        diagnostics: problems and notes, in order and without repetition.
    """

    def __init__(self) -> None:
        self.values: JsonObject = {}
        self.diagnostics: dict[Diagnostic, None] = {}
        self._output: IO[str] | None = None
        self._descriptor: int | None = None
        self._python_redirection = redirect_stdout(sys.stderr)
        self._json_redirection = json_written_to(self._direct_output)
        self._is_printed = False

    def __enter__(self) -> JsonReport:
        global _running
        self._output = sys.stdout
        with suppress(OSError, ValueError, AttributeError):  # output without a file descriptor, or a closed one
            sys.stdout.flush()
            if sys.stdout.fileno() == 1:
                self._descriptor = os.dup(1)
                os.dup2(2, 1)
        self._python_redirection.__enter__()
        self._json_redirection.__enter__()
        _running = self
        return self

    def __exit__(self, *_: object) -> None:
        global _running
        _running = None
        self._json_redirection.__exit__(None, None, None)
        self._python_redirection.__exit__(None, None, None)
        if self._descriptor is not None:
            os.dup2(self._descriptor, 1)
            os.close(self._descriptor)
            self._descriptor = None

    @contextmanager
    def _direct_output(self) -> Iterator[None]:
        """Write to the standard output of the command inside the context."""
        self._is_printed = True
        if self._descriptor is not None:
            os.dup2(self._descriptor, 1)
        try:
            with redirect_stdout(self._output):
                yield
        finally:
            if self._descriptor is not None:
                os.dup2(2, 1)

    def print(self, exit_code: int) -> None:
        """Print the object, unless JSON is printed already."""
        if self._is_printed or self._output is None:
            return
        diagnostics = [diagnostic.as_dict() for diagnostic in self.diagnostics]
        print_json({**self.values, "diagnostics": diagnostics, "exit_code": exit_code})


_running: JsonReport | None = None


def add_to_report(**values: object) -> None:
    """Add keys to the report of the running command; without `--json` there is no report, and nothing happens."""
    if _running is not None:
        _running.values.update(values)


def add_diagnostics(diagnostics: Iterable[Diagnostic]) -> None:
    """Add diagnostics to the report of the running command, if it has one."""
    if _running is not None:
        _running.diagnostics.update(dict.fromkeys(diagnostics))


def print_report_now(exit_code: int) -> None:
    """Print the report from another thread, before the process is terminated."""
    if _running is not None:
        _running.print(exit_code)


def error_diagnostics(error: BaseException) -> list[Diagnostic]:
    """Return the problems that an error reports."""
    if isinstance(error, LoadError):
        return list(error.diagnostics)
    code = error.code if isinstance(error, SimkitError) else "SK-CORE-001"
    if isinstance(error, UsageError):
        code = _USAGE_CODE
        message = str(getattr(error, "format_message", error.__str__)())
    else:
        message = str(error) if isinstance(error, SimkitError) else f"{type(error).__name__}: {error}"
    message, _, hint = message.removeprefix(code).strip().partition("\n    help: ")
    message = message.replace(f": {code} ", ": ", 1)  # the code follows the place of the problem
    place = _FILE_AND_LINE.match(str(getattr(error, "where", None) or message))
    file, line = (place["file"], int(place["line"])) if place else (None, None)
    if place and message.startswith(f"{place[0]}: "):
        message = message.removeprefix(f"{place[0]}: ")
    return [Diagnostic(code, "error", message, file, line, hint)]


def report_errors(command: Callable[P, int | None]) -> Callable[P, None]:
    """Convert the errors of a command to messages and exit codes, without a traceback for errors of the user.

    With the parameter `json_`, standard output has JSON alone: values of `print_json`, or else one object with the
    values of `add_to_report`, the diagnostics of an error and the exit code. Other output goes to standard error.
    """
    return _report_errors(command, is_always_printed=False)


def report_errors_and_json(command: Callable[P, int | None]) -> Callable[P, None]:
    """Wrap a command like `report_errors`; with `json_`, the object is also printed if it has no values.

    The command adds its results with `add_to_report`. Diagnostics and the exit code are added here.
    """
    return _report_errors(command, is_always_printed=True)


def _report_errors(command: Callable[P, int | None], *, is_always_printed: bool) -> Callable[P, None]:
    in_words = errors_in_words(command)

    @functools.wraps(command)
    def run(*args: P.args, **kwargs: P.kwargs) -> None:
        if kwargs.get("json_"):
            _run_with_report(command, is_always_printed, *args, **kwargs)
        else:
            in_words(*args, **kwargs)

    return run


def _run_with_report(command: Callable[P, int | None], has_report: bool, /, *args: P.args, **kwargs: P.kwargs) -> None:
    @functools.wraps(command)
    def collect_errors(*args: P.args, **kwargs: P.kwargs) -> int | None:
        try:
            return command(*args, **kwargs)
        except SimkitError as error:
            add_diagnostics(error_diagnostics(error))
            raise

    code = 0
    with JsonReport() as report:
        try:
            errors_in_words(collect_errors)(*args, **kwargs)
        except typer.Exit as ended:
            code = ended.exit_code
        except UsageError:  # `print_usage_error` prints it
            raise
        except Exception as error:
            add_diagnostics(error_diagnostics(error))
            report.print(1)
            raise
        if has_report or report.values or code not in (0, *_INTERRUPTED):
            errors_in_words(lambda: report.print(code))()
    if code:
        raise typer.Exit(code)


def end_with_error(error: SimkitError, *, json_: bool) -> NoReturn:
    """End the command with an error that is found before its function is called, in words and as a report."""

    @report_errors_and_json
    def fail(*, json_: bool) -> None:  # noqa: ARG001 (`report_errors_and_json` reads it)
        raise error

    fail(json_=json_)
    raise AssertionError("an error ends the command")


def print_usage_error(error: Exception, words: Iterable[str]) -> None:
    """Print a usage error as a report, if the words of the command line select a command and its option `--json`.

    Other errors are printed by the command itself.
    """
    command = getattr(getattr(error, "ctx", None), "command", None)
    has_option = any("--json" in parameter.opts for parameter in getattr(command, "params", ()))
    if isinstance(error, UsageError) and "--json" in words and has_option:
        diagnostics = [diagnostic.as_dict() for diagnostic in error_diagnostics(error)]
        print_json({"diagnostics": diagnostics, "exit_code": InputError.exit_code})
