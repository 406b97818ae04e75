"""Options of the commands that talk to a running simulation or read a bag."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperCommand

from simkit.cli.terminal import completion

Sim = Annotated[
    str | None,
    typer.Option(
        "--sim",
        envvar="SIMKIT_SIM",
        help="The run to talk to, where there are several: its --name, else its world's.",
        metavar="NAME",
        show_envvar=True,
        autocompletion=completion.simulations,
    ),
]
Bag = Annotated[
    Path | None,
    typer.Option("--bag", help="Reads a bag instead: an .mcap file or a folder of rosbag2.", metavar="BAG"),
]
Recording = Annotated[
    Path, typer.Argument(help="An .mcap or .db3 file, or a folder of rosbag2.", metavar="BAG", show_default=False)
]
ShowTypes = Annotated[bool, typer.Option("--show-types", "-t", help="Shows the types too.")]
Topic = Annotated[
    str,
    typer.Argument(
        help="Name of a topic, such as /odom.",
        show_default=False,
        metavar="TOPIC",
        autocompletion=completion.topics,
    ),
]
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
