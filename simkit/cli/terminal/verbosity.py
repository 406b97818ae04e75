"""Options `--quiet` and `--verbose`, which every command has, and their values on this command line."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Annotated, Any

import typer

_QUIET, _VERBOSE = "quiet", "verbose"
_given: set[str] = set()


def is_quiet() -> bool:
    """Check whether only results, warnings and errors are printed."""
    return _QUIET in _given


def is_verbose() -> bool:
    """Check whether every note is printed."""
    return _VERBOSE in _given


@contextmanager
def given_verbosity(*, quiet: bool, verbose: bool) -> Iterator[None]:
    """Apply the values of a command that has these options itself."""
    added = {name for name, value in ((_QUIET, quiet), (_VERBOSE, verbose)) if value} - _given
    _given.update(added)
    try:
        yield
    finally:
        _given.difference_update(added)


@cache
def verbosity_options() -> tuple[Any, ...]:
    """Return the two options, parameters of click."""

    def placeholder(
        verbose: Annotated[
            bool,
            typer.Option("--verbose", "-v", help="Print every note.", callback=_store, expose_value=False),
        ] = False,
        quiet: Annotated[
            bool,
            typer.Option(
                "--quiet", "-q", help="Print no notes, status or progress.", callback=_store, expose_value=False
            ),
        ] = False,
    ) -> None:
        pass

    maker = typer.Typer(add_completion=False)
    maker.command()(placeholder)
    return tuple(each for each in typer.main.get_command(maker).params if each.name in (_QUIET, _VERBOSE))


def _store(ctx: typer.Context, parameter: typer.CallbackParam, value: bool) -> None:
    if value and parameter.name is not None:
        _given.add(parameter.name)
        ctx.call_on_close(lambda: _given.discard(str(parameter.name)))
