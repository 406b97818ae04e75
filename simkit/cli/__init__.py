"""The command line: one file a command, thin."""

from __future__ import annotations

import io
import sys
from typing import Annotated

import typer

from simkit.cli.bag import bag
from simkit.cli.bench import bench
from simkit.cli.check import check
from simkit.cli.convert import convert
from simkit.cli.doctor import doctor
from simkit.cli.explain import explain
from simkit.cli.inspect import inspect
from simkit.cli.motion import motion
from simkit.cli.plugin import plugin
from simkit.cli.run import run
from simkit.cli.vendor import vendor

app = typer.Typer(
    name="simkit",
    help="A robot simulator: Gazebo worlds and robots, stepped by MuJoCo, answering with ROS 2 messages.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
for _command in (run, check, explain, inspect, convert, vendor, bench, doctor):
    app.command()(_command)
app.add_typer(bag, name="bag")
app.add_typer(motion, name="motion")
app.add_typer(plugin, name="plugin")


def _print_version(wanted: bool) -> None:
    if wanted:
        from simkit import __version__

        typer.echo(f"simkit {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Prints the version.")
    ] = False,
) -> None:
    """A robot simulator: Gazebo worlds and robots, stepped by MuJoCo, answering with ROS 2 messages."""


def main() -> None:
    """The entry point `simkit`."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without our signs or the file's names ends no run
    app()
