"""Commands with a name and a help line whose module is imported when they are used.

A shell that completes a word, or a user who asks a running simulation something, waits for one command and not for all.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup

# Command of click, which newer versions of Typer have as a private module.
Command = Any
# Context of click.
Context = Any
# Parameter of click.
Parameter = Any


class Commands(TyperGroup):
    """All commands of the command line."""

    _is_spared = False

    def make_context(self, info_name: str | None, args: list[str], parent: Context = None, **extra: object) -> Context:
        """The context of what is on a line, or on one that is being completed."""
        if not self._is_spared:
            self._is_spared = True
            _bypass_conversion(self)
        return super().make_context(info_name, args, parent, **extra)


class DeferredCommand(TyperCommand):
    """A command, or a group of them, that stands in `simkit.cli.<name>` under its own name.

    What lists commands sees only name and help line; what goes on to run one, to complete its words or to show its help
    comes through `make_context`, and finds the real one.
    """

    _real: Command | None = None

    @property
    def real(self) -> Command:
        """The command itself."""
        if self._real is None:
            assert self.name is not None
            module = import_module(f"simkit.cli.{self.name}")
            found = getattr(module, self.name)
            maker = typer.Typer(add_completion=False, pretty_exceptions_enable=False, rich_markup_mode=None)
            maker.callback()(_placeholder)
            if isinstance(found, typer.Typer):
                maker.add_typer(found, name=self.name)
            else:
                maker.command(self.name, cls=getattr(module, "COMMAND", None))(found)
            made: Command = typer.main.get_command(maker)
            self._real = made.commands[self.name]
            _bypass_conversion(self._real)
        return self._real

    def make_context(self, info_name: str | None, args: list[str], parent: Context = None, **extra: object) -> Context:
        """The context of the real one."""
        return self.real.make_context(info_name, args, parent, **extra)


def defer(app: typer.Typer, name: str, line: str) -> None:
    """Gives an application a command.

    Args:
        app: the application.
        name: of the command, of its module in `simkit.cli` and of what it is called there.
        line: the first of its help.
    """
    app.command(name, cls=DeferredCommand, help=line)(_placeholder)


def _placeholder() -> None:
    """Stands for a command until its module is there."""


def _bypass_conversion(command: Command) -> None:
    """Takes texts, defaults and what is not given as they are.

    Typer may send these too through pydantic, whose import takes longer than many a command.
    """
    for each in getattr(command, "commands", {}).values():
        _bypass_conversion(each)
    command.get_params = partial(_converted_parameters, command.get_params)


def _converted_parameters(usual: Callable[[Context], list[Parameter]], ctx: Context) -> list[Parameter]:
    """The parameters of a command, `--help` among them."""
    found = usual(ctx)
    for each in found:
        if each.nargs == 1 and not getattr(each, "multiple", False) and "process_value" not in vars(each):
            each.process_value = partial(_process_value, each, each.process_value)
    return found


def _process_value(parameter: Parameter, usual: Callable[..., object], ctx: Context, value: object) -> object:
    """The value of a parameter that is to have one."""
    kind = getattr(getattr(parameter, "type_descriptor", None), "annotation", None)
    is_there = type(value) is kind and (kind is str or value is parameter.default)
    if not is_there and (value is not None or (parameter.required and not ctx.resilient_parsing)):
        return usual(ctx, value)
    return value if parameter.callback is None else parameter.callback(ctx, parameter, value)
