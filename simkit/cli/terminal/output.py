"""Output of commands: results on standard output, messages on standard error, and exit codes for errors."""

from __future__ import annotations

import errno
import functools
import json
import math
import os
import re
import signal
import stat
import sys
import traceback
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, cast

import typer

from simkit.cli.terminal.interruption import running_command
from simkit.cli.terminal.plain_console import PlainConsole, is_plain_stream
from simkit.cli.terminal.task_display import displayed_tasks
from simkit.cli.terminal.verbosity import given_verbosity, is_quiet, is_verbose
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError, LoadError, PackError, PluginError, SimkitError
from simkit.hidden_text import hidden_in_command, is_hiding
from simkit.memory_error import OutOfMemory, find_memory_error
from simkit.number_text import counted
from simkit.packs import fault_text, foreign_pack_of

if TYPE_CHECKING:
    from rich.console import Console, ConsoleOptions, RenderableType
    from rich.segment import Segment

    from simkit.diagnostics import Diagnostic


# Value of JSON or YAML.
JsonValue = Any
JsonObject = dict[str, JsonValue]
"""JSON object as a Python dict."""
P = ParamSpec("P")
INTERRUPTED = 130
_MOST_LISTED, _MOST_ERRORS_LISTED = 12, 200  # listed entries of one code
_OUTPUT_ERRORS = frozenset(
    getattr(errno, name, errno.ENOSPC) for name in ("EPIPE", "EIO", "ENOSPC", "EDQUOT", "EFBIG", "EBADF")
)
_LONGEST_NAME = 200
_PLACES = 8  # listed further places of one entry
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069\ud800-\udfff]")
_NOT_UTF8 = re.compile("[^\\s\"'<>]*[\ud800-\udfff][^\\s\"'<>]*")  # a name with a byte that is not UTF-8
_STYLES = {"error": "bold red", "warning": "yellow", "note": "cyan"}


def printable(text: str) -> str:
    r"""Write control characters as `\x1b`, except line feeds and tabs.

    Names out of files can contain control characters, which would change the colours, the title or the content of a
    terminal. The characters that reverse the direction of writing are written as `\u202e`.
    """
    return _CONTROL.sub(lambda match: match[0].encode("unicode_escape").decode(), text)


@functools.cache
def stdout_console() -> Console:
    """Console of standard output."""
    return _stream_console(is_error=False)


@functools.cache
def stderr_console() -> Console:
    """Console of standard error."""
    return _stream_console(is_error=True)


def _stream_console(*, is_error: bool) -> Console:
    if not is_plain_stream(sys.stderr if is_error else sys.stdout):
        return _console(is_error=is_error)
    return cast("Console", PlainConsole(printable, partial(_console, is_error=is_error), is_error=is_error))


def _console(*, is_error: bool) -> Console:
    """Create a console that prints every text as `printable`.

    `FORCE_COLOR` makes rich write styles into a pipe or a file. A progress display still needs a real terminal.
    """
    from rich.console import Console

    class PrintableConsole(Console):
        def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterator[Segment]:
            for segment in super().render(renderable, options):
                yield segment if segment.control else segment._replace(text=printable(segment.text))

        def on_broken_pipe(self) -> None:
            """Discard the remaining output, so that the command ends with its own exit code; rich alone would exit."""
            self.quiet = True
            sink = os.open(os.devnull, os.O_WRONLY)
            os.dup2(sink, self.file.fileno())
            os.close(sink)

    stream = sys.stderr if is_error else sys.stdout
    return PrintableConsole(
        stderr=is_error,
        highlight=False,
        markup=False,
        emoji=False,
        soft_wrap=True,
        color_system=None if is_plain() else "auto",
        force_interactive=None if stream is not None and stream.isatty() else False,
    )


def is_plain() -> bool:
    """Check whether the environment forbids colours and styles; rich alone would keep bold and dim text."""
    return bool(os.environ.get("NO_COLOR")) or os.environ.get("TERM", "").lower() in ("dumb", "unknown")


def print_status(text: str) -> None:
    """Print a status line as `print_message`, unless `--quiet` is given."""
    if not is_quiet():
        print_message(text)


def print_message(text: str) -> None:
    """Print a line on standard error, above the progress of a run.

    The progress display intercepts only `sys.stderr`, so this function does not use the console.
    """
    if sys.stderr is not None:
        sys.stderr.write(f"{printable(text)}\n")
        sys.stderr.flush()


def print_diagnostics(
    found: Iterable[Diagnostic], *, verbose: bool, console: Console | None = None, every: bool = False
) -> None:
    """Print errors and warnings one by one; notes as well with `verbose` or `--verbose`, else only their number.

    The number does not count notes about files of simkit, which a user cannot change. With `--quiet` there are none.
    Equal diagnostics form one entry with all places. At most 12 entries of one code are listed (200 for errors), unless
    `every` is set.
    """
    target = console or stderr_console()
    notes: Counter[str] = Counter()
    shown: dict[tuple[str, str, str], list[Diagnostic]] = {}
    for d in found:
        if d.severity == "note" and not (verbose or is_verbose()):
            if not is_quiet() and not _is_in_simkit(d):
                notes[d.code] += 1
        else:
            key = (d.code, d.message, str(len(shown)) if every else d.hint)
            shown.setdefault(key, []).append(d)
    listed, left_out = Counter[tuple[str, str]](), Counter[tuple[str, str]]()
    for equal in shown.values():
        kind = (equal[0].severity, equal[0].code)
        if listed[kind] >= (_MOST_ERRORS_LISTED if kind[0] == "error" else _MOST_LISTED) and not every:
            left_out[kind] += len(equal)
            continue
        listed[kind] += 1
        _print_entry(equal, target)
    for (severity, code), count in left_out.items():
        target.print(f"{counted(count, f'more {severity}')} {code}; list all with `simkit check --all`", style="dim")
    if notes:
        names = ", ".join(f"{code} × {count}" if count > 1 else code for code, count in sorted(notes.items()))
        total = sum(notes.values())
        text = f"{counted(total, 'note')} ({names}); show with --verbose"
        target.print(text, style="dim")


def _is_in_simkit(diagnostic: Diagnostic) -> bool:
    """Check whether a problem is in a model or world of simkit."""
    from simkit.loaders.resources.bundled_models import builtin_model, bundle_around

    file = diagnostic.file or ""
    return builtin_model(file) is not None or (bool(file) and bundle_around(Path(file).absolute().parent) is not None)


def _print_entry(equal: list[Diagnostic], target: Console) -> None:
    """Print one problem with all places where it was found."""
    d = equal[0]
    place = _location(d)
    pieces = [(f"{place}: " if place else "", ""), (d.severity, _STYLES[d.severity]), (f" {d.code}: {d.message}", "")]
    if d.hint:
        pieces.append((f"\n    help: {d.hint}", "dim"))
    if len(equal) > 1:
        others = [f":{o.line}" if o.file == d.file and o.line else _location(o) for o in equal[1 : _PLACES + 1]]
        rest = len(equal) - 1 - len(others)
        more = f" and {rest} more" if rest else ""
        pieces.append((f"\n    also at {', '.join(others)}{more}", "dim"))
    plain: object = target
    if isinstance(plain, PlainConsole):
        plain.print("".join(printable(text) for text, _ in pieces))
        return
    from rich.text import Text

    target.print(Text.assemble(*((printable(text), style) for text, style in pieces)))


def _location(d: Diagnostic) -> str:
    return f"{d.file}:{d.line}" if d.file and d.line else (d.file or "")


def print_error(error: SimkitError) -> None:
    """Print an error. Only a plugin's error has a traceback, limited to the plugin's own code."""
    if isinstance(error, LoadError):
        print_diagnostics(error.diagnostics, verbose=False)
        count = sum(d.severity == "error" for d in error.diagnostics)
        if count:
            stderr_console().print(f"{counted(count, 'error')}; nothing was run", style="bold")
        else:
            stderr_console().print("--strict treats warnings as errors; nothing was run", style="bold")
        return
    if isinstance(error, PluginError) and error.__cause__ is not None and not is_hiding():
        sys.stderr.write(printable("".join(traceback.format_exception(error.__cause__))))
    message = str(error)
    if error.code not in message:
        message = f"{error.code} {message}"
    stderr_console().print(f"error: {printable(message)}", style="red")


def errors_in_words(command: Callable[P, int | None]) -> Callable[P, None]:
    """Convert the errors of a command to messages and exit codes."""

    @functools.wraps(command)
    @hidden_in_command()
    def run(*args: P.args, **kwargs: P.kwargs) -> None:
        verbosity = given_verbosity(quiet=bool(kwargs.get("quiet")), verbose=bool(kwargs.get("verbose")))
        try:
            with verbosity, running_command(), displayed_tasks(stderr_console, quiet=is_quiet()):
                code = command(*args, **kwargs)
        except KeyboardInterrupt as stopped:
            print_message(f"interrupted {stopped}".rstrip())
            raise typer.Exit(interrupt_exit_code(stopped)) from None
        except SimkitError as error:
            print_error(error)
            raise typer.Exit(error.exit_code) from None
        except OSError as error:
            if error.errno == errno.ENOMEM:
                print_error(OutOfMemory())
                raise typer.Exit(OutOfMemory.exit_code) from None
            if _is_output_failure(error):
                raise typer.Exit(output_failure_exit_code(error)) from None
            # a file that no other check expected to fail, for example because there are too many open files
            place = os.fsdecode(error.filename) if isinstance(error.filename, (str, bytes)) else "a file"
            print_error(InputError("SK-CLI-016", f"cannot read or write {place}: {error.strerror}"))
            raise typer.Exit(2) from None
        except Exception as error:
            simkit_error = known_error(error)
            if simkit_error is None:
                raise
            print_error(simkit_error)
            raise typer.Exit(simkit_error.exit_code) from None
        if code:
            raise typer.Exit(int(code))

    return run


def known_error(error: Exception) -> SimkitError | None:
    """Return the error for the user behind an exception that may come from anywhere; None if it is a fault of simkit.

    These are too little memory, a name that is not valid UTF-8 where a file format needs text, and a fault in the code
    of a pack of another distribution.
    """
    word = _NOT_UTF8.search(error.object) if isinstance(error, UnicodeEncodeError) else None
    if word is not None:
        name = ascii(word[0] if len(word[0]) <= _LONGEST_NAME else word[0][:_LONGEST_NAME] + "...")
        text = f"{name} is not valid UTF-8, but the file or program that gets it needs text"
        return InputError("SK-CLI-057", text, help="rename the file or folder")
    memory_error = find_memory_error(error)
    is_of_typer = isinstance(error, (typer.Abort, typer.Exit)) or hasattr(error, "exit_code")  # and usage errors
    if memory_error is not None or is_of_typer or sys.flags.dev_mode:
        return memory_error
    pack = foreign_pack_of(error)
    return None if pack is None else PackError(pack.package, fault_text(error, pack.folder))


def _is_output_failure(error: OSError) -> bool:
    """Check whether an error of the system may come from a standard stream.

    A full disk is also an error of other files: then the error has the name of the file, or both streams are pipes.
    EIO is also the error of a damaged disk: then no stream is a terminal.
    """
    if error.errno not in _OUTPUT_ERRORS:
        return error.strerror is None
    if error.errno in (errno.EPIPE, errno.EBADF):
        return True
    kinds = (stat.S_ISCHR,) if error.errno == errno.EIO else (stat.S_ISCHR, stat.S_ISREG)
    return error.filename is None and any(is_kind(_stream_mode(stream)) for stream in (1, 2) for is_kind in kinds)


def _stream_mode(stream: int) -> int:
    try:
        return os.fstat(stream).st_mode  # isatty is False for a closed terminal
    except OSError:
        return 0


def output_failure_exit_code(error: OSError) -> int:
    """Return the exit code of a program whose output cannot be written, and print the reason where that is possible.

    Raises:
        OSError: the error itself, if it does not come from writing the output.
    """
    if error.errno not in _OUTPUT_ERRORS:
        raise error
    # closing a standard stream that failed would raise a second error at the end of the program
    sys.stdout = None
    if error.errno == errno.EPIPE:  # the reader of the output has ended
        return 0
    if error.errno == errno.EIO:  # the terminal has closed, and its signal may arrive later
        sys.stderr = None
        return _hang_up_exit_code()
    try:
        print_message(f"error: cannot write the output: {error.strerror}")
    except OSError:
        sys.stderr = None
    return 1


def interrupt_exit_code(stopped: KeyboardInterrupt) -> int:
    """Return the exit code after an interrupt: 143 for SIGTERM, else 130."""
    return getattr(stopped, "exit_code", INTERRUPTED)


def _hang_up_exit_code() -> int:
    """Return the exit code after the terminal has closed: 0 if the process ignores that (`nohup`)."""
    hang_up = getattr(signal, "SIGHUP", None)
    return 0 if hang_up is None or signal.getsignal(hang_up) is signal.SIG_IGN else 128 + hang_up


def print_line(text: str = "") -> None:
    """Print a line on standard output at once."""
    typer.echo(printable(text))


def print_name(text: str) -> None:
    r"""Print a name on one line of standard output; a line feed is written as `\n`."""
    print_line(text.replace("\n", "\\n"))


def print_note(text: str) -> None:
    """Print a line on standard error, unless `--quiet` is given."""
    if not is_quiet():
        typer.echo(printable(text), err=True)


def print_json(value: object, indent: int | None = None, default: Callable[[Any], object] | None = None) -> None:
    """Print a JSON value; infinity and NaN become the texts `"inf"`, `"-inf"`, `"nan"`.

    Args:
        value: value to print.
        indent: spaces of each level; None for one line.
        default: function that converts other values.
    """
    text = json.dumps(_json_value(value), allow_nan=False, ensure_ascii=False, indent=indent, default=default)
    with _json_output():
        typer.echo(_CONTROL.sub(lambda match: f"\\u{ord(match[0]):04x}", text))


_json_output: Callable[[], AbstractContextManager[None]] = nullcontext


@contextmanager
def json_written_to(output: Callable[[], AbstractContextManager[None]]) -> Iterator[None]:
    """Write JSON inside a context of its own, because other output is redirected."""
    global _json_output
    before, _json_output = _json_output, output
    try:
        yield
    finally:
        _json_output = before


def _json_value(value: object) -> object:
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if isinstance(value, Mapping):
        return {str(k): _json_value(v) for k, v in value.items()}
    return [_json_value(v) for v in value] if isinstance(value, (list, tuple)) else value


def without_interrupt_message(command: Callable[P, int | None]) -> Callable[P, int]:
    """Wrap a command so that Ctrl-C ends it without a message, with exit code 130."""

    @functools.wraps(command)
    def run(*args: P.args, **kwargs: P.kwargs) -> int:
        try:
            return int(command(*args, **kwargs) or 0)
        except KeyboardInterrupt as stopped:
            return interrupt_exit_code(stopped)

    return run


def not_found_error(
    noun: str, name: str, known: Sequence[str] | Mapping[str, object], code: str, where: str
) -> InputError:
    """Make a 'not found' error that suggests the closest name or lists all names."""
    names = list(known)
    listed = ", ".join(names[:20]) + (f" and {len(names) - 20} more" if len(names) > 20 else "")
    hint = did_you_mean(name, names) or ("known: " + listed if names else "there are none")
    return InputError(code, f"no {noun} {name!r} in {where}; {hint}")


def absolute_name(name: str) -> str:
    """Add a leading slash to a name, unless it has one."""
    return name if name.startswith("/") else f"/{name}"
