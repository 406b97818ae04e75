"""Last commands with large numbers, which explain why the physics of a run diverged."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.msgs.message_text import field_nodes, field_value, is_message

if TYPE_CHECKING:
    from simkit.msgs.message_types import FieldValue, Message
    from simkit.runtime.communication.topic_bus import TopicBus

_LARGE: Final = 100.0  # [m/s, rad/s, N·m, ...] robots of this size seldom get more
_MOST_NUMBERS: Final = 100  # in a list; longer ones are readings, not commands
_MOST_LISTED: Final = 2
_TIMES: Final = ("header", "stamp", "time_from_start", "duration")


def large_commands(bus: TopicBus) -> list[str]:
    """Return a sentence for each of the largest last commands of plugins, with the topic and the plugin's place."""
    lines: list[tuple[float, str]] = []
    for topic, end, _, kind in bus.endpoints():
        message, owner = getattr(end, "last", None), end.owner
        if kind == "takes" and message is not None and owner is not None:
            value, field = max(_numbers(message, ""), key=lambda number: abs(number[0]), default=(0.0, ""))
            if abs(value) >= _LARGE:
                whose = f"plugin {getattr(owner, 'name', '')!r} ({getattr(owner, 'where', '')})"
                lines.append((-abs(value), f"the last command on {topic} for {whose} has {field} = {value:g}"))
    return [text for _, text in sorted(lines)[:_MOST_LISTED]]


def forget_commands(bus: TopicBus) -> None:
    """Forget the last commands, because a reset ends their effect."""
    for listener in bus.listeners():
        listener.last = None


def _numbers(message: Message, prefix: str) -> Iterator[tuple[float, str]]:
    """Yield the finite numbers of a message with the names of their fields."""
    for name, _ in field_nodes(message.__msgtype__):
        if name not in _TIMES:
            yield from _values(field_value(message, name), f"{prefix}{name}")


def _values(value: FieldValue, name: str) -> Iterator[tuple[float, str]]:
    if is_message(value):
        yield from _numbers(value, f"{name}.")
    elif isinstance(value, (list, tuple, np.ndarray)):
        for number, item in enumerate(value if len(value) <= _MOST_NUMBERS else ()):
            yield from _values(item, f"{name}[{number}]")
    elif isinstance(value, (int, float, np.number)) and not isinstance(value, bool) and math.isfinite(value):
        yield float(value), name
