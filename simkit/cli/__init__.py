"""The command line `simkit`: one file for each command, `cli/<command>.py`, with what they share in `cli/terminal`.

Words of the user enter; lines of text, files and exit codes leave. A command is thin: it parses its options, calls the
library and prints. Nothing below imports this room, and a command's module is loaded only when the command is used.
"""

from __future__ import annotations

import io
import sys
from typing import Annotated

import typer
from typer import Option

from simkit.cli.lazy_command import Commands, defer
from simkit.version import __version__

app = typer.Typer(
    name="simkit",
    cls=Commands,
    help="A robot simulator: Gazebo worlds and robots, stepped by MuJoCo, answering with ROS 2 messages.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
COMMANDS = {
    "run": "Runs a world headless, as fast as it goes.",
    "check": "Prints every problem of a file, not only the first; runs nothing.",
    "certify": "Runs a world in fresh processes with other surroundings, and shows that the bits are the same.",
    "explain": "Says what a code means, what helps, and shows an input that brings it about.",
    "inspect": "Shows what a file means once it is resolved.",
    "convert": "Writes a world or model as MJCF, to be opened by MuJoCo alone, or as SDF in one file.",
    "vendor": "Writes a folder that holds a world and everything it names, and that opens anywhere.",
    "bench": "Times a world and, in the same run, bare MuJoCo on the same compiled model.",
    "grade": "Runs an exercise with plugins that were handed in, and says what each got and why.",
    "doctor": "Prints what simkit found on this machine, and what helps where something is missing.",
    "golden": "Golden runs: sensor outputs kept, and compared with today's.",
    "bundle": "Runs a world or a scenario, and packs it into one file that repeats it anywhere.",
    "replay": "Repeats the run in a bundle: exit 0 if it came out the same, bit by bit, exit 5 if not.",
    "bag": "Recordings: what is in them, new ones, and broken ones mended.",
    "plot": "Draws fields of topics over time: of bags, and of worlds that are run for it.",
    "motion": "Lists the motions that a robot knows by name, and plays them.",
    "plugin": "Lists plugins, says what one reads and publishes, and begins new ones.",
    "topic": "Topics of a running simulation, or of a bag.",
    "service": "Services of a running simulation.",
    "param": "Live parameters of a running simulation.",
    "action": "Actions of a running simulation.",
    "node": "Nodes of a running simulation: its plugins, sensors and clients.",
    "interface": "Types of messages, services and actions.",
    "model": "Models of a running simulation.",
    "tf": "Frames of a running simulation, or of a bag.",
}
"""Commands with the line that stands beside each; its module in this folder has its name, and is not read before."""

for _name, _line in COMMANDS.items():
    defer(app, _name, _line)


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"simkit {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, Option("--version", callback=_print_version, is_eager=True, help="Prints the version.")
    ] = False,
) -> None:
    """A robot simulator: Gazebo worlds and robots, stepped by MuJoCo, answering with ROS 2 messages."""


def main() -> None:
    """The entry point `simkit`."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without our signs or the file's names ends no run
    app()
