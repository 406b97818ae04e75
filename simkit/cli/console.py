"""How the command line speaks: results on standard output, everything about them on standard error."""

from __future__ import annotations

import functools
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
    """One line about what is going on."""
    err().print(text)


def print_diagnostics(found: Iterable[Diagnostic], *, verbose: bool, console: Console | None = None) -> None:
    """Errors and warnings one by one; notes too where `verbose`, else how many there are."""
    from rich.text import Text

    target = console or err()
    notes: Counter[str] = Counter()
    for d in found:
        if d.severity == "note" and not verbose:
            notes[d.code] += 1
            continue
        place = f"{d.file or '<text>'}:{d.line}" if d.line else (d.file or "")
        line = Text(f"{place}: " if place else "")
        line.append(d.severity, style=_STYLES[d.severity])
        line.append(f" {d.code}: {d.message}")
        if d.hint:
            line.append(f"\n    help: {d.hint}", style="dim")
        target.print(line)
    if notes:
        listed = ", ".join(f"{code} × {count}" if count > 1 else code for code, count in sorted(notes.items()))
        target.print(f"{sum(notes.values())} notes ({listed}); --verbose shows them", style="dim")


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
        except KeyboardInterrupt:
            say("interrupted")
            raise typer.Exit(INTERRUPTED) from None
        except BrokenPipeError:
            # Whoever read our output has gone; closing standard output again would complain a second time.
            sys.stdout = None
            raise typer.Exit(0) from None
        if code:
            raise typer.Exit(int(code))

    return run
