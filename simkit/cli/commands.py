"""Commands of the command line `simkit`, with their help lines."""

from __future__ import annotations

from typing import Annotated

import typer
from typer import Option

from simkit.cli.lazy_command import Commands, defer
from simkit.version import __version__

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
    "run": "Run a world without a window, as fast as possible.",
    "check": "Print all problems of a file without running it.",
    "certify": "Verify that a run is bit-identical in different environments.",
    "explain": "Explain a diagnostic code, with its remedy and an example.",
    "inspect": "Show the resolved content of a file.",
    "convert": "Convert a world or model to MJCF or to a single SDF file.",
    "vendor": "Copy a world and all files that it uses into one folder.",
    "fetch": "Download the models that a world names on Fuel servers.",
    "bench": "Compare the speed of a world with bare MuJoCo.",
    "grade": "Run an exercise with submitted plugins and print the results.",
    "lab": "List, start and grade the labs of the course.",
    "sweep": "Run a world with many parameters and seeds, and report the results.",
    "doctor": "Check the installation and print a remedy for each problem.",
    "golden": "Record and compare golden runs (reference sensor outputs).",
    "bundle": "Run a world or scenario and pack it into a repeatable bundle.",
    "replay": "Repeat the run in a bundle and compare the results bit by bit.",
    "bag": "Record, describe, play, film, export and recover bags.",
    "plot": "Plot fields of bags, worlds and scenarios over time.",
    "graph": "Draw the nodes and topics, or the frames, of a world or a running simulation.",
    "map": "Write the true occupancy map of a world as PGM and YAML.",
    "plugin": "List, describe and create plugins.",
    "new": "Create a pack.",
    "topic": "Inspect and publish topics of a simulation or a bag.",
    "service": "List and call the services of a running simulation.",
    "param": "List, read and set the parameters of a running simulation.",
    "action": "List the actions of a running simulation and send goals.",
    "node": "List the nodes of a running simulation.",
    "lifecycle": "Show and change the states of lifecycle nodes.",
    "log": "Print log messages of plugins and of simkit: the last 1000 and all new ones; of a bag, all recorded ones.",
    "interface": "List and show the types of messages, services and actions.",
    "model": "Show models, poses and joints of a running simulation.",
    "ros": "Connect a running simulation to ROS 2 until the simulation ends, or until Ctrl-C.",
    "view": "Show a world, a robot, a running simulation or a bag in a browser.",
    "tf": "Show the frames of a running simulation or of a bag.",
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
