"""Commands for a running simulation, in the style of `ros2`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from typer import Typer
from typer.core import TyperCommand

from simkit.cli.terminal.output import P, without_interrupt_message
from simkit.extend import report_errors

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
        return group.command(name, cls=Ros2Command)(report_errors(without_interrupt_message(command)))

    return add
