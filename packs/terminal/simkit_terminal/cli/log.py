"""Print log messages of plugins and of simkit: the last 1000 and all new ones; of a bag, all recorded ones."""

from __future__ import annotations

import re
import time
from fnmatch import fnmatchcase
from typing import Annotated, Any, Final

import typer

from simkit.cli.terminal import completion, options
from simkit.cli.terminal.options import validate_word
from simkit.cli.terminal.output import print_json, print_line, print_note, without_interrupt_message
from simkit.cli.terminal.topic_sources import open_source
from simkit.errors import InputError
from simkit.extend import argument, counted, option, report_errors
from simkit_terminal.cli.terminal.live_command import Ros2Command
from simkit_terminal.cli.terminal.named_endpoints import find_topic

LISTED_AFTER = "lifecycle"

COMMAND = Ros2Command
ROSOUT: Final = "/rosout"
LEVELS: Final = {"debug": 10, "info": 20, "warn": 30, "error": 40, "fatal": 50}
_DEPTH: Final = 1000  # queued messages for a slow terminal
_LABELS: Final = {number: name.upper() for name, number in LEVELS.items()}


@report_errors
@without_interrupt_message
def log(
    simulation: Annotated[
        str | None, argument("Name of the running simulation, if several run.", "[SIM]", completion.simulations)
    ] = None,
    level: Annotated[str, option("Lowest level: debug, info, warn, error or fatal.", "LEVEL", "--level")] = "debug",
    node: Annotated[
        str | None, option("Print only messages of these nodes, such as '/tb3/*'.", "PATTERN", "--node")
    ] = None,
    filter_: Annotated[
        str | None, option("Print only messages whose text matches a regular expression.", "REGEX", "--filter")
    ] = None,
    timeout: Annotated[float | None, option("Exit after this wall time.", "S", "--timeout", min=0)] = None,
    sim: options.Sim = None,
    bag: options.Bag = None,
    json_: options.Json = False,
) -> None:
    """Print log messages of plugins and of simkit: the last 1000 and all new ones; of a bag, all recorded ones."""
    if simulation is not None and sim is not None and simulation != sim:
        raise typer.BadParameter(f"found {simulation!r} and --sim {sim}; expected one name", param_hint="SIM")
    wanted = _MessageFilter(level, node, filter_)
    until = None if timeout is None else time.monotonic() + timeout
    lost = 0
    with open_source(simulation or sim, bag) as source:
        entry = find_topic(source, ROSOUT)
        source.prepare(entry)
        feed = source.feed([entry.name], _DEPTH)
        while (received := feed.take(None if until is None else max(0.0, until - time.monotonic()))) is not None:
            message = source.decode(received)
            if wanted(message):
                _print(message, json_)
            if feed.lost > lost:
                print_note(
                    f"note: {counted(feed.lost - lost, 'message')} lost, because they came faster than they were read"
                )
                lost = feed.lost


class _MessageFilter:
    """Conditions of the options on a message.

    Raises:
        InputError: SK-CLI-018 no such level; SK-CLI-033 the text is not a regular expression.
    """

    def __init__(self, level: str, node: str | None, text: str | None) -> None:
        self._level = LEVELS[validate_word("--level", level.lower().replace("warning", "warn"), tuple(LEVELS))]
        self._node = None if node is None else _logger_name(node)
        try:
            self._text = None if text is None else re.compile(text)
        except re.error as error:
            text = f"--filter: {text!r} is not a regular expression: {error}"
            raise InputError("SK-CLI-033", text) from None

    def __call__(self, message: Any) -> bool:
        return (
            message.level >= self._level
            and (self._node is None or fnmatchcase(_logger_name(message.name), self._node))
            and (self._text is None or self._text.search(message.msg) is not None)
        )


def _logger_name(node: str) -> str:
    """Return the logger's name of a node: `tb3.diff_drive` for `/tb3/diff_drive`."""
    return node.strip("/").replace("/", ".")


def _print(message: Any, as_json: bool) -> None:
    """Print a message as ROS 2 does on a terminal."""
    label = _LABELS.get(message.level, str(message.level))
    stamp = f"{message.stamp.sec}.{message.stamp.nanosec:09d}"
    if not as_json:
        print_line(f"[{label}] [{stamp}] [{message.name}]: {message.msg}")
        return
    place = {"file": message.file, "line": int(message.line), "function": message.function}
    print_json({"time": float(stamp), "level": label, "name": message.name, "message": message.msg, **place})
