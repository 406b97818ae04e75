"""Commands with a name and a help line whose module is imported on first use.

A shell completion or a command for a running simulation therefore imports one module instead of all.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator
from functools import cache, partial
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from simkit.garbage_collection import permanent_imports
from simkit.memory_error import check_memory_limit

# Command of click; newer versions of Typer have click as a private module.
Command = Any
# Context of click.
Context = Any
# Parameter of click.
Parameter = Any

_INTERFACES_HELP = "Folder with definitions .msg, .srv and .action: a ROS package or a workspace; repeatable."
_WORDS = __name__  # key of the words of the command line in the context's meta
_FIRST_LINE = re.compile(r'"""(.+?\.?)(?:"""|\n)')
_SHELLS = ("bash", "zsh", "fish", "powershell", "pwsh")
_COMPLETION_CALLBACKS = {"--show-completion": "show_callback", "--install-completion": "install_callback"}


class Commands(TyperGroup):
    """Group of all commands of the command line."""

    _is_spared = False
    _has_packs = False

    def get_command(self, ctx: Context, cmd_name: str) -> Command:
        """Return a command by its name; packs are searched only for a name that the core does not have."""
        if super().get_command(ctx, cmd_name) is None:
            self._add_packs()
        return super().get_command(ctx, cmd_name)

    def list_commands(self, ctx: Context) -> list[str]:
        """Return the names of all commands: those of the core, then those of packs."""
        self._add_packs()
        return super().list_commands(ctx)

    def _add_packs(self) -> None:
        """Add the commands of packs, once. A pack cannot replace a command of the core."""
        if not self._has_packs:
            self._has_packs = True
            for name, command in _pack_commands():
                _bypass_conversion(self.commands.setdefault(name, command))

    def make_context(self, info_name: str | None, args: list[str], parent: Context = None, **extra: object) -> Context:
        """Create the context of a command line, or of one that is being completed."""
        if not self._is_spared:
            self._is_spared = True
            _bypass_conversion(self)
        return super().make_context(info_name, args, parent, **extra)

    def parse_args(self, ctx: Context, args: list[str]) -> list[str]:
        """Parse the options before the command; `--show-completion` and `--install-completion` accept a shell."""
        ctx.meta[_WORDS] = list(args)
        name, _, shell = "=".join(args[:2]).partition("=")
        if name in _COMPLETION_CALLBACKS and shell and not shell.startswith("-") and not ctx.resilient_parsing:
            if shell not in _SHELLS:
                raise typer.BadParameter(f"{shell!r} is not one of {', '.join(_SHELLS)}", param_hint=name)
            if os.environ.get("NO_COLOR"):
                ctx.color = False  # click does not read the variable
            getattr(import_module("typer.completion"), _COMPLETION_CALLBACKS[name])(ctx, None, shell)
        return super().parse_args(ctx, args)

    def invoke(self, ctx: Context) -> object:
        """Run the command; print a usage error as JSON too if the command line requests it."""
        try:
            return super().invoke(ctx)
        except Exception as error:
            if isinstance(error, MemoryError):
                raise
            from simkit.cli.terminal.json_report import print_usage_error

            print_usage_error(error, ctx.meta[_WORDS])
            raise


class DeferredCommand(TyperCommand):
    """Command, or group of commands, defined in `simkit.cli.<name>` under its own name.

    Attributes:
        package: package with the command's module; a pack has one of its own.

    A list of commands uses only name and help line. To run a command, complete it or show its help, click calls
    `make_context`, which imports the real command.
    """

    package = "simkit.cli"
    _real: Command | None = None

    @property
    def real(self) -> Command:
        """The real command; its module is imported on first access."""
        if self._real is None:
            assert self.name is not None
            check_memory_limit()
            with permanent_imports():
                module = import_module(f"{self.package}.{self.name}")
            found = getattr(module, self.name)
            maker = typer.Typer(add_completion=False, pretty_exceptions_enable=False, rich_markup_mode=None)
            maker.callback()(_placeholder)
            if isinstance(found, typer.Typer):
                maker.add_typer(found, name=self.name)
            else:
                maker.command(self.name, cls=getattr(module, "COMMAND", None))(found)
            group: Command = typer.main.get_command(maker)
            self._real = group.commands[self.name]
            _bypass_conversion(self._real)
        return self._real

    def make_context(self, info_name: str | None, args: list[str], parent: Context = None, **extra: object) -> Context:
        """Create the context of the real command."""
        return self.real.make_context(info_name, args, parent, **extra)


def defer(app: typer.Typer, name: str, line: str) -> None:
    """Add a command to an application.

    Args:
        app: application to extend.
        name: name of the command, of its module in `simkit.cli`, and of the object in that module.
        line: first line of the command's help.
    """
    app.command(name, cls=DeferredCommand, help=line)(_placeholder)


def _pack_commands() -> Iterator[tuple[str, Command]]:
    """Yield name and command of each file `cli/<command>.py` in a pack. The help line is the first line of the file."""
    from simkit.packs import installed_packs

    for pack in installed_packs():
        for file in sorted(Path(pack.folder, "cli").glob("[a-z]*.py")):
            line = _FIRST_LINE.match(file.read_text(encoding="utf-8"))
            app = typer.Typer()
            defer(app, file.stem, line[1] if line else "")
            command: Command = typer.main.get_command_from_info(
                app.registered_commands[0], pretty_exceptions_short=False, rich_markup_mode=None
            )
            command.package = f"{pack.package}.cli"
            yield file.stem, command


def _placeholder() -> None:
    """Callback of a command whose module is not imported yet."""


def _bypass_conversion(command: Command) -> None:
    """Accept texts, defaults and missing values without conversion.

    Typer may send these values through pydantic, too. The import of pydantic takes longer than many commands.
    """
    for each in getattr(command, "commands", {}).values():
        _bypass_conversion(each)
    command.get_params = partial(_converted_parameters, command.get_params)


def _converted_parameters(original: Callable[[Context], list[Parameter]], ctx: Context) -> list[Parameter]:
    """Return the parameters of a command, including `--help`."""
    found = original(ctx)
    if not hasattr(ctx.command, "commands"):
        found = [*found[:-1], interfaces_option(), *found[-1:]]
    for each in found:
        if each.nargs == 1 and not getattr(each, "multiple", False) and "process_value" not in vars(each):
            each.process_value = partial(_process_value, each, each.process_value)
    return found


def _define_interfaces(ctx: typer.Context, folders: list[str]) -> None:
    """Define the types in the folders of the option, before the command runs or completes a value."""
    if folders:
        from simkit.cli.terminal.given_interfaces import define_interfaces

        define_interfaces(ctx, folders)


@cache
def interfaces_option() -> Parameter:
    """Return the option `--interfaces`, which every command has."""

    def placeholder(
        interfaces: Annotated[
            list[str],
            typer.Option(
                metavar="DIR", help=_INTERFACES_HELP, callback=_define_interfaces, expose_value=False, is_eager=True
            ),
        ] = [],
    ) -> None:
        pass

    maker = typer.Typer(add_completion=False)
    maker.command()(placeholder)
    return next(each for each in typer.main.get_command(maker).params if each.name == "interfaces")


def _process_value(parameter: Parameter, original: Callable[..., object], ctx: Context, value: object) -> object:
    """Return the value of a parameter; convert it only if its type differs."""
    kind = getattr(getattr(parameter, "type_descriptor", None), "annotation", None)
    is_there = type(value) is kind and (kind is str or value is parameter.default)
    if not is_there and (value is not None or (parameter.required and not ctx.resilient_parsing)):
        return original(ctx, value)
    return value if parameter.callback is None else parameter.callback(ctx, parameter, value)
