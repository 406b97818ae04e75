"""Options and arguments that several commands share."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated

from typer import Argument, BadParameter, Option
from typer.models import ArgumentInfo, OptionInfo

from simkit.cli.terminal import completion
from simkit.diagnostics import did_you_mean
from simkit.errors import InputError


def option(
    help: str,
    metavar: str | None = None,
    *names: str,
    min: float | None = None,
    max: float | None = None,
    show_default: bool = True,
    complete: completion.Completer | None = None,
    parser: Callable[[str], float] | None = None,
) -> OptionInfo:
    """Declare an option with a value, or a flag of type `bool`: `option("Show the run.", None, "--view")`.

    Args:
        help: help text.
        metavar: placeholder of the value in the help; None for a flag.
        names: names of the option; default: the parameter's name. A flag without a name gets a second one, `--no-NAME`.
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
        callback=_refuse_nan,
    )
    return info


def _refuse_nan(value: object) -> object:
    """Return the value of an option; NaN is within all limits of numbers, since each comparison with it is false."""
    for number in value if isinstance(value, (list, tuple)) else [value]:
        if isinstance(number, float) and math.isnan(number):
            raise BadParameter("found nan; expected a number")
    return value


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
ReadableFolders = Annotated[
    list[Path],
    option(
        "Folder in which the file may name files, beside its own and its project; repeatable.", "DIR", "--resource-path"
    ),
]
AllowCode = Annotated[
    bool, Option("--allow-code", help="Run the code that the file names, with all your rights; read it first.")
]
CodePaths = Annotated[
    list[Path],
    Option("--plugin-path", help="Run only the code in this folder; repeatable.", metavar="DIR", exists=True),
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
Bag = Annotated[
    Path | None,
    option("Read a bag instead: an .mcap file or a rosbag2 folder.", "BAG", "--bag", complete=completion.bags),
]
Recording = Annotated[Path, argument("Bag: an .mcap or .db3 file, or a rosbag2 folder.", "BAG", completion.bags)]
ShowTypes = Annotated[bool, Option("--show-types", "-t", help="Show the types, too.")]
Topic = Annotated[str, argument("Name of the topic, such as /odom.", "TOPIC", completion.topics)]
ChartFile = Annotated[Path, option("Chart to write: .svg or .png.", "OUT", "--output", "-o")]
Against = Annotated[str | None, option("Field for the x axis instead of time.", "FIELD", show_default=False)]
Start = Annotated[float | None, option("Start time.", "S", "--start")]
End = Annotated[float | None, option("End time.", "S", "--end")]
Title = Annotated[str, option("Title of the chart.", "TEXT", show_default=False)]
Resolution = Annotated[
    str | None, option("Size of --gif and --video; default: 1280x720, 640x360 for a GIF alone.", "WxH", "--resolution")
]
Fps = Annotated[float | None, option("Frames per simulated second; default: 25, 10 for a GIF alone.", "N", "--fps")]
FilmCamera = Annotated[
    str, option("Camera of --gif and --video; auto: fixed in a room, else following.", "auto|fixed|follow", "--camera")
]


def validate_word(name: str, word: str, allowed: Sequence[str]) -> str:
    """Validate the value of an option with fixed choices.

    Raises:
        InputError: SK-CLI-018 the value is not allowed; the message suggests the closest choice.
    """
    if word not in allowed:
        hint = did_you_mean(word, allowed)
        text = f"{name}: found {word!r}; expected {', '.join(allowed)}"
        raise InputError("SK-CLI-018", text + (f"; {hint}" if hint else ""))
    return word


def compile_pattern(text: str | None, option: str) -> re.Pattern[str] | None:
    """Compile the regular expression of an option; None if the option is missing.

    Raises:
        InputError: SK-CLI-031 the text is not a regular expression.
    """
    try:
        return None if text is None else re.compile(text)
    except re.error as error:
        raise InputError("SK-CLI-031", f"{option}: {text!r} is not a regular expression: {error}") from None
