"""How the command line speaks: results on standard output, everything about them on standard error."""

from __future__ import annotations

import errno
import functools
import signal
import sys
import traceback
from collections import Counter
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, ParamSpec

import typer

from simkit.errors import LoadError, PluginError, SimkitError

if TYPE_CHECKING:
    from rich.console import Console

    from simkit.diagnostics import Diagnostic

P = ParamSpec("P")
INTERRUPTED = 130
_MOST, _MOST_ERRORS = 12, 200  # entries of one code that are listed
_PLACES = 8  # further places of equal ones that are listed
_STYLES = {"error": "bold red", "warning": "yellow", "note": "cyan"}


@functools.cache
def out() -> Console:
    """Standard output."""
    from rich.console import Console

    return Console(highlight=False, markup=False, emoji=False, soft_wrap=True)


@functools.cache
def err() -> Console:
    """Standard error."""
    from rich.console import Console

    return Console(stderr=True, highlight=False, markup=False, emoji=False, soft_wrap=True)


def say(text: str) -> None:
    """One line about what is going on; above what a run shows on a terminal, which listens to `sys.stderr` alone."""
    if sys.stderr is not None:
        sys.stderr.write(f"{text}\n")
        sys.stderr.flush()


def print_diagnostics(
    found: Iterable[Diagnostic], *, verbose: bool, console: Console | None = None, every: bool = False
) -> None:
    """Errors and warnings one by one; notes too where `verbose`, else how many there are.

    Equal ones are one entry with all its places, and of one code no more than some are listed, unless `every`.
    """
    target = console or err()
    notes: Counter[str] = Counter()
    shown: dict[tuple[str, str, str], list[Diagnostic]] = {}
    for d in found:
        if d.severity == "note" and not verbose:
            notes[d.code] += 1
        else:
            key = (d.code, d.message, str(len(shown)) if every else d.hint)
            shown.setdefault(key, []).append(d)
    listed, left_out = Counter[tuple[str, str]](), Counter[tuple[str, str]]()
    for equal in shown.values():
        kind = (equal[0].severity, equal[0].code)
        if listed[kind] >= (_MOST_ERRORS if kind[0] == "error" else _MOST) and not every:
            left_out[kind] += len(equal)
            continue
        listed[kind] += 1
        _print_entry(equal, target)
    for (severity, code), count in left_out.items():
        target.print(
            f"{count} more {severity}{'s' if count > 1 else ''} {code}; simkit check --all lists them", style="dim"
        )
    if notes:
        names = ", ".join(f"{code} × {count}" if count > 1 else code for code, count in sorted(notes.items()))
        total = sum(notes.values())
        say = f"{total} notes ({names}); --verbose shows them" if total > 1 else f"1 note ({names}); --verbose shows it"
        target.print(say, style="dim")


def _print_entry(equal: list[Diagnostic], target: Console) -> None:
    """One problem with the places it was found at."""
    from rich.text import Text

    d = equal[0]
    place = _place(d)
    line = Text(f"{place}: " if place else "")
    line.append(d.severity, style=_STYLES[d.severity])
    line.append(f" {d.code}: {d.message}")
    if d.hint:
        line.append(f"\n    help: {d.hint}", style="dim")
    if len(equal) > 1:
        others = [f":{o.line}" if o.file == d.file and o.line else _place(o) for o in equal[1 : _PLACES + 1]]
        rest = len(equal) - 1 - len(others)
        more = f" and {rest} more" if rest else ""
        line.append(f"\n    the same at {', '.join(others)}{more}", style="dim")
    target.print(line)


def _place(d: Diagnostic) -> str:
    return f"{d.file or '<text>'}:{d.line}" if d.line else (d.file or "")


def show_error(error: SimkitError) -> None:
    """What went wrong, in the words of the error; a traceback only for a plugin, of the plugin's own code."""
    if isinstance(error, LoadError):
        print_diagnostics(error.diagnostics, verbose=False)
        count = sum(d.severity == "error" for d in error.diagnostics)
        if count:
            err().print(f"{count} error{'s' if count > 1 else ''}; nothing was run", style="bold")
        else:
            err().print("warnings are errors here (--strict); nothing was run", style="bold")
        return
    if isinstance(error, PluginError) and error.__cause__ is not None:
        sys.stderr.write("".join(traceback.format_exception(error.__cause__)))
    message = str(error)
    if error.code not in message:
        message = f"{error.code} {message}"
    err().print(f"error: {message}", style="red")


def guarded(command: Callable[P, Any]) -> Callable[P, None]:
    """Maps what a command raises to the exit codes: no traceback for what the user can mend."""

    @functools.wraps(command)
    def run(*args: P.args, **kwargs: P.kwargs) -> None:
        try:
            code = command(*args, **kwargs)
        except SimkitError as error:
            show_error(error)
            raise typer.Exit(error.exit_code) from None
        except KeyboardInterrupt as stopped:
            say(f"interrupted {stopped}".rstrip())
            raise typer.Exit(INTERRUPTED) from None
        except BrokenPipeError:
            # Whoever read our output has gone; closing standard output again would complain a second time.
            sys.stdout = None
            raise typer.Exit(0) from None
        except OSError as error:
            if error.errno == errno.EIO:  # a terminal that is gone, which may be seen before its signal comes
                sys.stdout = sys.stderr = None
                raise typer.Exit(_hung_up()) from None
            if error.errno not in (errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC)):
                raise
            sys.stdout = None
            say(f"error: what was to be written found no room: {error.strerror}")
            raise typer.Exit(1) from None
        if code:
            raise typer.Exit(int(code))

    return run


def _hung_up() -> int:
    """The exit code of who has lost its terminal: none of an error where that is not to matter (`nohup`)."""
    hang_up = getattr(signal, "SIGHUP", None)
    return 0 if hang_up is None or signal.getsignal(hang_up) is signal.SIG_IGN else 128 + hang_up
