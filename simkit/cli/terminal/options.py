"""Options and arguments that several commands share."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Annotated, Any

from typer import Argument, Option, Typer
from typer.core import TyperCommand
from typer.models import ArgumentInfo, OptionInfo

from simkit.cli.terminal import completion
from simkit.cli.terminal.output import P, report_errors_quietly
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.run_spec import SourceOptions


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
        help: what it does.
        metavar: stands for the value.
        names: the option's names; the parameter's where none is given.
        min, max: bounds of a number.
        show_default: whether the help names the default.
        complete: gives the words that the shell offers.
        parser: converts the text.
    """
    made: OptionInfo = Option(
        *names,
        help=help,
        metavar=metavar,
        min=min,
        max=max,
        show_default=show_default,
        autocompletion=complete,
        parser=parser,
    )
    return made


def argument(help: str, metavar: str | None = None, complete: completion.Completer | None = None) -> ArgumentInfo:
    """Declare an argument whose default the help does not name.

    Args:
        help: what it means.
        metavar: stands for it; the parameter's name where none is given.
        complete: gives the words that the shell offers.
    """
    made: ArgumentInfo = Argument(help=help, metavar=metavar, show_default=False, autocompletion=complete)
    return made


World = Annotated[str, argument("A file, or the bare name of a world or model that comes with simkit.")]
File = Annotated[str, argument("A world or model file, or a bare name.")]
ResourcePaths = Annotated[
    list[Path],
    option("One more folder for model://, package:// and relative URIs; repeatable.", "DIR", "--resource-path"),
]
PackagePaths = Annotated[
    list[str], option("Where the ROS package NAME lies; repeatable.", "NAME=DIR", "--package-path")
]
XacroArgs = Annotated[list[str], option("An argument of a xacro file; repeatable.", "NAME=VALUE", "--xacro-arg")]
Base = Annotated[
    str,
    option("A bare model stands: fixed, floating, or auto (floating unless joined to the world).", "BASE", "--base"),
]
PluginPaths = Annotated[
    list[Path], option("Allows the Python plugins in that folder; repeatable.", "DIR", "--plugin-path")
]
ParamsFiles = Annotated[
    list[str],
    option(
        "Controllers and their parameters, for all control plugins or for those of one model; repeatable.",
        "[MODEL=]FILE.yaml",
        "--params-file",
    ),
]
Overrides = Annotated[
    list[str], option("Changes one value: scoped::name.element=VALUE; repeatable.", "PATH=VALUE", "--set")
]
Spawns = Annotated[
    list[str], option("Puts a model into the world, by name or file; repeatable.", "MODEL:x,y,yaw[:name]", "--spawn")
]
CmdVel = Annotated[str | None, option("Sends one velocity: m/s forward, rad/s to the left.", "V,W", "--cmd-vel")]
Script = Annotated[Path | None, option("Commands over time.", "FILE.yaml", "--script")]
Seed = Annotated[int | None, option("Seed of all noise.", "N", "--seed", min=0)]
Strict = Annotated[bool, Option("--strict", help="Warnings are errors.")]
Json = Annotated[bool, Option("--json", help="For programs: one JSON value.")]
Verbose = Annotated[bool, Option("--verbose", "-v", help="Shows every note, not only how many there are.")]
Force = Annotated[bool, Option("--force", help="Replaces what is there already.")]
Sim = Annotated[
    str | None,
    Option(
        "--sim",
        envvar="SIMKIT_SIM",
        help="The run to talk to, where there are several: its --name, else its world's.",
        metavar="NAME",
        show_envvar=True,
        autocompletion=completion.simulations,
    ),
]
Bag = Annotated[Path | None, option("Reads a bag instead: an .mcap file or a folder of rosbag2.", "BAG", "--bag")]
Recording = Annotated[Path, argument("An .mcap or .db3 file, or a folder of rosbag2.", "BAG")]
ShowTypes = Annotated[bool, Option("--show-types", "-t", help="Shows the types too.")]
Topic = Annotated[str, argument("Name of a topic, such as /odom.", "TOPIC", completion.topics)]
ChartFile = Annotated[Path, option("The file: .svg or .png.", "OUT", "--output", "-o")]
Against = Annotated[str | None, option("Draws over this field in place of time.", "FIELD", show_default=False)]
Start = Annotated[float | None, option("Leaves out what was before.", "S", "--start")]
End = Annotated[float | None, option("Leaves out what was after.", "S", "--end")]
Title = Annotated[str, option("Above the chart.", "TEXT", show_default=False)]
_BASES = ("auto", "fixed", "floating")


def parse_pairs(texts: Sequence[str], option: str) -> dict[str, str]:
    """`NAME=VALUE` texts as a mapping.

    Raises:
        InputError: SK-CLI-018 a text is of another form.
    """
    found: dict[str, str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name.strip():
            raise InputError(f"SK-CLI-018 {option}: found {text!r}, allowed is NAME=VALUE", "SK-CLI-018")
        found[name.strip()] = value
    return found


def validate_word(name: str, word: str, allowed: Sequence[str]) -> str:
    """Validate the word that an option was given.

    Raises:
        InputError: SK-CLI-018 it is none of those that are allowed; names the closest.
    """
    if word not in allowed:
        hint = did_you_mean(word, allowed)
        text = f"SK-CLI-018 {name}: found {word!r}, allowed is {', '.join(allowed)}"
        raise InputError(text + (f"; {hint}" if hint else ""), "SK-CLI-018")
    return word


def source_arguments(
    resource_paths: Sequence[Path], package_paths: Sequence[str], xacro_args: Sequence[str], base: str = "auto"
) -> SourceOptions:
    """The options that say how a file is read, as keyword arguments."""
    return {
        "resource_paths": resource_paths,
        "package_paths": parse_pairs(package_paths, "--package-path"),
        "xacro_args": parse_pairs(xacro_args, "--xacro-arg"),
        "base": validate_word("--base", base, _BASES),
    }


_FLAGS = frozenset({"--no-daemon", "--use-sim-time"})
_QOS = ("profile", "reliability", "durability", "history", "depth", "liveliness", "liveliness-lease-duration-seconds")
_WITH_VALUE = frozenset({"--spin-time", "--node-name", *(f"--qos-{name}" for name in _QOS)})


class Ros2Command(TyperCommand):
    """A command that takes what `ros2` has for its network and daemon, and does without: there is neither here."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Leaves those options out."""
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
    """Add a command to a group, as `ros2` has it: it takes and leaves out those options, and Ctrl-C ends it quietly.

    Args:
        group: of the commands.
        name: the command's; the function's where none is given.
    """

    def add(command: Callable[P, int | None]) -> Callable[P, None]:
        return group.command(name, cls=Ros2Command)(report_errors_quietly(command))

    return add
