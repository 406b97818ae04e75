"""Options and arguments that several commands share."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated, Any

from typer import Argument, Option
from typer.core import TyperCommand

from simkit.cli.terminal import completion
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.run_spec import SourceOptions

World = Annotated[
    str, Argument(help="A file, or the bare name of a world or model that comes with simkit.", show_default=False)
]
File = Annotated[str, Argument(help="A world or model file, or a bare name.", show_default=False)]
ResourcePaths = Annotated[
    list[Path],
    Option(
        "--resource-path", help="One more folder for model://, package:// and relative URIs; repeatable.", metavar="DIR"
    ),
]
PackagePaths = Annotated[
    list[str], Option("--package-path", help="Where the ROS package NAME lies; repeatable.", metavar="NAME=DIR")
]
XacroArgs = Annotated[
    list[str], Option("--xacro-arg", help="An argument of a xacro file; repeatable.", metavar="NAME=VALUE")
]
Base = Annotated[
    str,
    Option(
        "--base",
        help="A bare model stands: fixed, floating, or auto (floating unless joined to the world).",
        metavar="BASE",
    ),
]
PluginPaths = Annotated[
    list[Path], Option("--plugin-path", help="Allows the Python plugins in that folder; repeatable.", metavar="DIR")
]
ParamsFiles = Annotated[
    list[str],
    Option(
        "--params-file",
        help="Controllers and their parameters, for all control plugins or for those of one model; repeatable.",
        metavar="[MODEL=]FILE.yaml",
    ),
]
Overrides = Annotated[
    list[str], Option("--set", help="Changes one value: scoped::name.element=VALUE; repeatable.", metavar="PATH=VALUE")
]
Spawns = Annotated[
    list[str],
    Option("--spawn", help="Puts a model into the world, by name or file; repeatable.", metavar="MODEL:x,y,yaw[:name]"),
]
CmdVel = Annotated[
    str | None, Option("--cmd-vel", help="Sends one velocity: m/s forward, rad/s to the left.", metavar="V,W")
]
Script = Annotated[Path | None, Option("--script", help="Commands over time.", metavar="FILE.yaml")]
Seed = Annotated[int | None, Option("--seed", help="Seed of all noise.", metavar="N", min=0)]
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
Bag = Annotated[
    Path | None, Option("--bag", help="Reads a bag instead: an .mcap file or a folder of rosbag2.", metavar="BAG")
]
Recording = Annotated[
    Path, Argument(help="An .mcap or .db3 file, or a folder of rosbag2.", metavar="BAG", show_default=False)
]
ShowTypes = Annotated[bool, Option("--show-types", "-t", help="Shows the types too.")]
Topic = Annotated[
    str,
    Argument(
        help="Name of a topic, such as /odom.", show_default=False, metavar="TOPIC", autocompletion=completion.topics
    ),
]
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


def validate_base(base: str) -> str:
    """Validate `--base`: auto, fixed or floating.

    Raises:
        InputError: SK-CLI-018 it is something else.
    """
    if base not in _BASES:
        hint = did_you_mean(base, _BASES)
        text = f"SK-CLI-018 --base: found {base!r}, allowed is {', '.join(_BASES)}"
        raise InputError(text + (f"; {hint}" if hint else ""), "SK-CLI-018")
    return base


def source_arguments(
    resource_paths: Sequence[Path], package_paths: Sequence[str], xacro_args: Sequence[str], base: str = "auto"
) -> SourceOptions:
    """The options that say how a file is read, as keyword arguments."""
    return {
        "resource_paths": resource_paths,
        "package_paths": parse_pairs(package_paths, "--package-path"),
        "xacro_args": parse_pairs(xacro_args, "--xacro-arg"),
        "base": validate_base(base),
    }


_FLAGS = frozenset({"--no-daemon", "--use-sim-time"})
_WITH_VALUE = frozenset(
    {
        "--spin-time",
        "--node-name",
        "--qos-profile",
        "--qos-reliability",
        "--qos-durability",
        "--qos-history",
        "--qos-depth",
        "--qos-liveliness",
        "--qos-liveliness-lease-duration-seconds",
    }
)


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
