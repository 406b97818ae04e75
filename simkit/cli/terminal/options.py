"""Options and arguments that several commands share."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Annotated, Any, cast

from typer import Argument, Option, Typer
from typer.core import TyperCommand
from typer.models import ArgumentInfo, OptionInfo

from simkit.cli.terminal import completion
from simkit.cli.terminal.output import P, report_errors_quietly
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.run_spec import RENDERERS, LoadOptions, RendererName, SourceOptions, named_values


def option(
    help: str,
    metavar: str,
    *names: str,
    min: float | None = None,
    max: float | None = None,
    show_default: bool = True,
    complete: completion.Completer | None = None,
    parser: Callable[[str], float] | None = None,
) -> OptionInfo:
    """Declare an option with a value.

    Args:
        help: help text.
        metavar: placeholder of the value in the help.
        names: names of the option; default: the parameter's name.
        min: lowest allowed number.
        max: highest allowed number.
        show_default: True to show the default in the help.
        complete: function for shell completion.
        parser: conversion of the text.
    """
    info: OptionInfo = Option(
        *names,
        help=help,
        metavar=metavar,
        min=min,
        max=max,
        show_default=show_default,
        autocompletion=complete,
        parser=parser,
    )
    return info


def argument(help: str, metavar: str | None = None, complete: completion.Completer | None = None) -> ArgumentInfo:
    """Declare an argument without a default in its help.

    Args:
        help: help text.
        metavar: placeholder in the help; default: the parameter's name.
        complete: function for shell completion.
    """
    info: ArgumentInfo = Argument(help=help, metavar=metavar, show_default=False, autocompletion=complete)
    return info


World = Annotated[
    str, argument("World or model file, or the bare name of a world or model of simkit.", complete=completion.worlds)
]
File = Annotated[str, argument("World or model file, or a bare name.", complete=completion.worlds)]
Scenario = Annotated[
    str, argument("Scenario (.yaml, .py), world or bare name.", "WORLD|SCENARIO", completion.scenarios)
]
ResourcePaths = Annotated[
    list[Path],
    option("Search folder for model://, package:// and relative URIs; repeatable.", "DIR", "--resource-path"),
]
PackagePaths = Annotated[
    list[str],
    option("Workspace of ROS packages, or folder of the package NAME; repeatable.", "[NAME=]DIR", "--package-path"),
]
XacroArgs = Annotated[list[str], option("Argument of a xacro file; repeatable.", "NAME:=VALUE", "--xacro-arg")]
Base = Annotated[
    str,
    option("Base of a bare model: fixed, floating, or auto (floating unless joined to the world).", "BASE", "--base"),
]
PluginPaths = Annotated[
    list[Path],
    Option("--plugin-path", help="Folder of Python plugins to allow; repeatable.", metavar="DIR", exists=True),
]
ParamsFiles = Annotated[
    list[str],
    option(
        "Controller parameter file, for all control plugins or for those of one model; repeatable.",
        "[MODEL=]FILE.yaml",
        "--params-file",
    ),
]
Overrides = Annotated[
    list[str], option("Override one value: scoped::name.element=VALUE; repeatable.", "PATH=VALUE", "--set")
]
Spawns = Annotated[
    list[str],
    option(
        "Spawn a model, by name or file; repeatable.", "MODEL:x,y,yaw[:name]", "--spawn", complete=completion.worlds
    ),
]
ModelWorld = Annotated[
    str | None,
    option(
        "World of a bare model: a file, a name, or none for empty space; default: level ground and a sun.",
        "NAME|none|FILE",
        "--world",
        complete=completion.worlds,
    ),
]
CmdVel = Annotated[str | None, option("Send a constant velocity: m/s forward, rad/s left.", "V,W", "--cmd-vel")]
Script = Annotated[Path | None, option("Script of timed commands.", "FILE.yaml", "--script")]
Seed = Annotated[int | None, option("Seed of all random streams.", "N", "--seed", min=0, max=2**64 - 1)]
Renderer = Annotated[
    str | None,
    option(
        "Renderer of images: gl, software, or auto (OpenGL if this machine has it); default: the world's, else auto.",
        "auto|gl|software",
        "--renderer",
    ),
]
Strict = Annotated[bool, Option("--strict", help="Treat warnings as errors.")]
Json = Annotated[bool, Option("--json", help="Print JSON.")]
Verbose = Annotated[bool, Option("--verbose", "-v", help="Show every note instead of their number.")]
Force = Annotated[bool, Option("--force", help="Overwrite existing files.")]
Sim = Annotated[
    str | None,
    Option(
        "--sim",
        envvar="SIMKIT_SIM",
        help="Name of the running simulation, if several run: its --name, else its world's name.",
        metavar="NAME",
        show_envvar=True,
        autocompletion=completion.simulations,
    ),
]
Bag = Annotated[Path | None, option("Read a bag instead: an .mcap file or a rosbag2 folder.", "BAG", "--bag")]
Recording = Annotated[Path, argument("Bag: an .mcap or .db3 file, or a rosbag2 folder.", "BAG")]
ShowTypes = Annotated[bool, Option("--show-types", "-t", help="Show the types, too.")]
Topic = Annotated[str, argument("Name of the topic, such as /odom.", "TOPIC", completion.topics)]
ChartFile = Annotated[Path, option("Chart to write: .svg or .png.", "OUT", "--output", "-o")]
Against = Annotated[str | None, option("Field for the x axis instead of time.", "FIELD", show_default=False)]
Start = Annotated[float | None, option("Start time.", "S", "--start")]
End = Annotated[float | None, option("End time.", "S", "--end")]
Title = Annotated[str, option("Title of the chart.", "TEXT", show_default=False)]
_BASES = ("auto", "fixed", "floating")


def parse_pairs(texts: Sequence[str], option: str) -> dict[str, str]:
    """Parse `NAME=VALUE` or `NAME:=VALUE` texts to a mapping; ROS writes the second form.

    Raises:
        InputError: SK-CLI-018 a text has another form.
    """
    return named_values(texts, option)


def validate_word(name: str, word: str, allowed: Sequence[str]) -> str:
    """Validate the value of an option with fixed choices.

    Raises:
        InputError: SK-CLI-018 the value is not allowed; the message suggests the closest choice.
    """
    if word not in allowed:
        hint = did_you_mean(word, allowed)
        text = f"SK-CLI-018 {name}: found {word!r}; expected {', '.join(allowed)}"
        raise InputError(text + (f"; {hint}" if hint else ""), "SK-CLI-018")
    return word


def source_arguments(
    resource_paths: Sequence[Path], package_paths: Sequence[str], xacro_args: Sequence[str], base: str = "auto"
) -> SourceOptions:
    """Return the options for reading a file as keyword arguments.

    Raises:
        InputError: SK-CLI-018 a folder does not exist, or another value is not allowed.
    """
    for folder in resource_paths:
        if not folder.expanduser().is_dir():
            raise InputError(f"SK-CLI-018 --resource-path: there is no folder {str(folder)!r}", "SK-CLI-018")
    return {
        "resource_paths": resource_paths,
        "package_paths": tuple(package_paths),
        "xacro_args": parse_pairs(xacro_args, "--xacro-arg"),
        "base": validate_word("--base", base, _BASES),
    }


def renderer_argument(name: str | None) -> LoadOptions:
    """Return the option --renderer as a keyword argument of `simkit.load`; empty without the option.

    Raises:
        InputError: SK-CLI-018 the renderer is unknown.
    """
    if name is None:
        return {}
    return {"renderer": cast(RendererName, validate_word("--renderer", name, RENDERERS))}


_FLAGS = frozenset({"--no-daemon", "--use-sim-time"})
_QOS = ("profile", "reliability", "durability", "history", "depth", "liveliness", "liveliness-lease-duration-seconds")
_WITH_VALUE = frozenset({"--spin-time", "--node-name", *(f"--qos-{name}" for name in _QOS)})


class Ros2Command(TyperCommand):
    """Command that accepts and ignores the network and daemon options of `ros2`: simkit has neither."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Remove the ignored options and parse the rest."""
        return super().parse_args(ctx, list(_remove_ros2_flags(args)))


def _remove_ros2_flags(args: list[str]) -> Iterator[str]:
    words = iter(args)
    for word in words:
        if word == "--":
            yield word
            yield from words
        elif word in _WITH_VALUE:
            next(words, None)
        elif word not in _FLAGS and word.partition("=")[0] not in _WITH_VALUE:
            yield word


def live_command(group: Typer, name: str | None = None) -> Callable[[Callable[P, int | None]], Callable[P, None]]:
    """Add a command for a running simulation to a group, in the style of `ros2`.

    The command ignores the network and daemon options of `ros2`. Ctrl-C ends it without a message.

    Args:
        group: group of commands.
        name: name of the command; default: the function's name.
    """

    def add(command: Callable[P, int | None]) -> Callable[P, None]:
        return group.command(name, cls=Ros2Command)(report_errors_quietly(command))

    return add
