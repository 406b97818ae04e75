"""Commands of the command line `simkit`: their names and help lines; the module of a command is imported on first use.

A shell completion or a command for a running simulation therefore imports one module instead of all.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Option
from typer.core import TyperCommand, TyperGroup

from simkit.cli.terminal.interfaces_option import interfaces_option
from simkit.cli.terminal.verbosity import verbosity_options
from simkit.errors import InputError
from simkit.garbage_collection import permanent_imports
from simkit.memory_error import check_memory_limit
from simkit.version import __version__

if TYPE_CHECKING:
    from simkit.packs import Pack

# Command of click; newer versions of Typer have click as a private module.
Command = Any
# Context of click.
Context = Any
# Parameter of click.
Parameter = Any

_WORDS = __name__  # key of the words of the command line in the context's meta
_FIRST_LINE = re.compile(r'"""(.+?\.?)(?:"""|\n)')
_LISTED_AFTER = re.compile(r'^LISTED_AFTER = "(\w+)"$', re.MULTILINE)
_SHELLS = ("bash", "zsh", "fish", "powershell", "pwsh")
_COMPLETION_CALLBACKS = {"--show-completion": "show_callback", "--install-completion": "install_callback"}


class Commands(TyperGroup):
    """Group of all commands of the command line."""

    _is_spared = False
    _has_packs = False

    def get_command(self, ctx: Context, cmd_name: str) -> Command:
        """Return a command by its name; packs are searched only for a name that the core does not have."""
        if cmd_name not in self.commands:
            self._add_packs(cmd_name)
        if cmd_name not in self.commands and not ctx.resilient_parsing:
            _check_left_out(cmd_name)
        return super().get_command(ctx, cmd_name)

    def list_commands(self, ctx: Context) -> list[str]:
        """Return the names of all commands: those of the core, then those of packs, or each after the one it names."""
        if not self._has_packs:
            self._has_packs = True
            self._add_packs()
        followers: dict[str, list[str]] = {}
        for name, command in self.commands.items():
            before = getattr(command, "listed_after", "")
            followers.setdefault(before if before in self.commands else "", []).append(name)
        return list(_with_followers("", followers))

    def _add_packs(self, cmd_name: str | None = None) -> None:
        """Add one command of packs, or all of them. A pack cannot replace a command of the core."""
        for name, command in _pack_commands(cmd_name):
            _bypass_conversion(self.commands.setdefault(name, command))

    def make_context(self, info_name: str | None, args: list[str], parent: Context = None, **extra: object) -> Context:
        """Create the context of a command line, or of one that is being completed."""
        if not self._is_spared:
            self._is_spared = True
            _bypass_conversion(self)
        return super().make_context(info_name, args, parent, **extra)

    def parse_args(self, ctx: Context, args: list[str]) -> list[str]:
        """Parse the options before the command; `--show-completion` and `--install-completion` accept a shell.

        The arguments of ROS after an option `--node` become a part of its value, for all commands.
        """
        if "--ros-args" in args:
            from simkit.run_nodes import join_node_words

            args = join_node_words(args)
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
    """Command, or group of commands, defined in `simkit.cli.<name>`, or in that folder of a pack, under its own name.

    Attributes:
        pack: pack with the command; None for a command of the core.
        listed_after: name of the command after which the help lists this one; empty for the end.

    A list of commands uses only name and help line. To run a command, complete it or show its help, click calls
    `make_context`, which imports the real command.
    """

    pack: Pack | None = None
    listed_after = ""
    _real: Command | None = None

    @property
    def real(self) -> Command:
        """The real command; its module is imported on first access.

        Raises:
            PackError: SK-CLI-058 the command of a pack of another distribution cannot be used.
        """
        if self._real is None:
            check_memory_limit()
            self._real = self._load() if self.pack is None else _load_of_pack(self.pack, f"{self.name}.py", self._load)
            _bypass_conversion(self._real)
        return self._real

    def _load(self) -> Command:
        assert self.name is not None
        with permanent_imports():
            module = import_module(f"{'simkit' if self.pack is None else self.pack.package}.cli.{self.name}")
        command = getattr(module, self.name)
        maker = typer.Typer(add_completion=False, pretty_exceptions_enable=False, rich_markup_mode=None)
        maker.callback()(_placeholder)
        if isinstance(command, typer.Typer):
            maker.add_typer(command, name=self.name)
            for pack, addition in _additions_to_group(self.name):
                maker.add_typer(addition, name=f"{self.name} {pack}")
        else:
            maker.command(self.name, cls=getattr(module, "COMMAND", None))(command)
        made: Command = typer.main.get_command(maker)
        real = made.commands.pop(self.name)
        for each in made.commands.values():
            real.commands = {**real.commands, **each.commands, **real.commands}  # a pack replaces none
        return real

    def make_context(self, info_name: str | None, args: list[str], parent: Context = None, **extra: object) -> Context:
        """Create the context of the real command."""
        return self.real.make_context(info_name, args, parent, **extra)


def _additions_to_group(name: str) -> Iterator[tuple[str, typer.Typer]]:
    """Yield the commands that packs have for a group, in a file `cli/groups/<name>.py`, with the name of the pack."""
    from simkit.packs import installed_packs

    for pack in installed_packs():
        file = os.path.join("groups", f"{name}.py")  # noqa: PTH118 - `Path` would be slower
        if os.path.isfile(os.path.join(pack.folder, "cli", file)):  # noqa: PTH113, PTH118
            module = _load_of_pack(pack, file, partial(import_module, f"{pack.package}.cli.groups.{name}"))
            yield pack.name, getattr(module, name)


def _load_of_pack(pack: Pack, file: str, load: Callable[[], Any]) -> Any:
    """Call a function that imports a file in the folder `cli` of a pack.

    Raises:
        PackError: SK-CLI-058 a file of a pack of another distribution cannot be used.
    """
    from simkit.errors import PackError, SimkitError
    from simkit.packs import fault_text

    try:
        return load()
    except (Exception, SystemExit) as error:
        if pack.is_shipped or isinstance(error, SimkitError) or sys.flags.dev_mode:
            raise
        text = fault_text(error, pack.folder)
        path = os.path.join(pack.folder, "cli", file)  # noqa: PTH118 - `Path` would be slower
        place = "" if path in text else f"{path}: "
        command = os.path.splitext(os.path.basename(file))[0]  # noqa: PTH119, PTH122
        raise PackError(pack.package, f"{place}the command {command!r} cannot be used: {text}") from error


def defer(app: typer.Typer, name: str, line: str) -> None:
    """Add a command to an application.

    Args:
        app: application to extend.
        name: name of the command, of its module in `simkit.cli`, and of the object in that module.
        line: first line of the command's help.
    """
    app.command(name, cls=DeferredCommand, help=line)(_placeholder)


def _pack_commands(name: str | None) -> Iterator[tuple[str, Command]]:
    """Yield name and command of each file `cli/<command>.py` in a pack, or of one. No pack is imported.

    The help line is the first line of the file. A line `LISTED_AFTER = "<command>"` gives the place in the list.
    """
    from simkit.packs import installed_packs

    for pack in installed_packs():
        for file in sorted(Path(pack.folder, "cli").glob("[a-z]*.py")):
            if name not in (None, file.stem):
                continue
            text = file.read_text(encoding="utf-8", errors="replace")
            line, before = _FIRST_LINE.match(text), _LISTED_AFTER.search(text)
            app = typer.Typer()
            defer(app, file.stem, line[1] if line else "")
            command: Command = typer.main.get_command_from_info(
                app.registered_commands[0], pretty_exceptions_short=False, rich_markup_mode=None
            )
            command.pack = pack
            command.listed_after = before[1] if before else ""
            yield file.stem, command


def _with_followers(name: str, followers: Mapping[str, Sequence[str]]) -> Iterator[str]:
    """Yield each command that follows a name in the list, with those that follow it."""
    for follower in followers.get(name, ()):
        yield follower
        yield from _with_followers(follower, followers)


def _check_left_out(name: str) -> None:
    """Check that a command is not one of a pack that simkit was built without.

    Raises:
        InputError: SK-INPUT-004 its pack is not installed.
    """
    from simkit.packs import left_out_names, missing_pack_text

    pack = left_out_names("commands").get(name)
    if pack is not None:
        needs, help_ = missing_pack_text(pack)
        raise InputError("SK-INPUT-004", f"simkit {name} {needs}", help=help_)


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
    """Return the parameters of a command with those of every command, before `--help`."""
    parameters = original(ctx)
    if not hasattr(ctx.command, "commands"):
        taken = {name for each in parameters for name in each.opts}
        added = [each for each in verbosity_options() if taken.isdisjoint(each.opts)]
        parameters = [*parameters[:-1], *added, interfaces_option(), *parameters[-1:]]
    for each in parameters:
        if each.nargs == 1 and not getattr(each, "multiple", False) and "process_value" not in vars(each):
            each.process_value = partial(_process_value, each, each.process_value)
    return parameters


def _process_value(parameter: Parameter, original: Callable[..., object], ctx: Context, value: object) -> object:
    """Return the value of a parameter; convert it only if its type differs."""
    kind = getattr(getattr(parameter, "type_descriptor", None), "annotation", None)
    is_there = type(value) is kind and (kind is str or value is parameter.default)
    if not is_there and (value is not None or (parameter.required and not ctx.resilient_parsing)):
        return original(ctx, value)
    return value if parameter.callback is None else parameter.callback(ctx, parameter, value)


app = typer.Typer(
    name="simkit",
    cls=Commands,
    help="Robot simulator for Gazebo worlds and robots, with MuJoCo physics and ROS 2 messages.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["--help", "-h"]},
)
COMMANDS = {
    "demo": "Run short examples one after the other, in about a minute.",
    "run": "Run a world without a window, as fast as possible.",
    "check": "Print all problems of a file without running it, or the scores of all files of a folder.",
    "explain": "Explain a diagnostic code, with its remedy and an example.",
    "inspect": "Show the resolved content of a file.",
    "convert": "Convert a world or model to MJCF or to a single SDF file.",
    "bench": "Compare the speed of a world with bare MuJoCo.",
    "doctor": "Check the installation and print a remedy for each problem.",
    "golden": "Record and compare golden runs (reference sensor outputs).",
    "bag": "Record, describe, play, film, export and recover bags.",
    "plot": "Plot fields of topics, and expressions as in conditions, over time.",
    "graph": "Draw the nodes and topics, or the frames, of a world or a running simulation.",
    "map": "Write the true occupancy map of a world as PGM and YAML.",
}
"""Commands and their help lines. The module of each command has the command's name and is imported on first use."""

for _name, _line in COMMANDS.items():
    defer(app, _name, _line)


def _print_version(requested: bool) -> None:
    if requested:
        typer.echo(f"simkit {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Robot simulator for Gazebo worlds and robots, with MuJoCo physics and ROS 2 messages."""
