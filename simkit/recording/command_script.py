"""Send commands while a world runs: one steady velocity, or a YAML script of messages over time.

A script is a list; times are simulated seconds:

    - {at: 0.0, topic: /cmd_vel, message: {linear: {x: 0.2}}}
    - {at: 2.0, until: 6.0, rate: 10, topic: /cmd_vel, message: {angular: {z: 0.5}}}
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError, MessageError
from simkit.run_spec import JsonMapping, JsonObject
from simkit.yaml_reader import NotYaml, compose_nodes, finite_number, node_value

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_Item = TypeVar("_Item")
_Made = TypeVar("_Made")
_KEYS = ("at", "topic", "message", "until", "rate")
_RATE = 10.0  # [Hz] of a command that is repeated without saying how often
_TWISTS = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")


@dataclass(frozen=True)
class Command:
    """Message that is sent once or repeatedly.

    Attributes:
        at: first time [s].
        until: last time [s]; None for a single message.
        rate: repetitions a second [Hz].
        where: where it was written, for messages about it.
    """

    at: float
    topic: str
    message: object
    until: float | None = None
    rate: float = _RATE
    where: str = ""

    def time(self, index: int) -> float | None:
        """When it is sent for the `index`-th time [s]; None when not any more."""
        if index == 0:
            return self.at
        if self.until is None:
            return None
        time = self.at + index / self.rate
        return time if time <= self.until else None

    def plain(self) -> JsonObject:
        """Return the command as a mapping, as a scenario file holds it."""
        found = {"at": self.at, "topic": self.topic, "message": self.message, "where": self.where}
        return found if self.until is None else {**found, "until": self.until, "rate": self.rate}


class Commands:
    """Sends commands at the first tick at or after their time.

    Args:
        sim: the simulation.
        commands: in any order; of two at one time the earlier in the list goes first.
    """

    def __init__(self, sim: Simulation, commands: Iterable[Command]) -> None:
        self._sim = sim
        self._commands = list(commands)
        self._queue: list[tuple[int, int, int]] = []
        for number in range(len(self._commands)):
            self._push(number, 0)

    @property
    def next_tick(self) -> int | None:
        """The tick at which something is to be sent next; None when all is sent."""
        return self._queue[0][0] if self._queue else None

    def send_due(self) -> None:
        """Sends what is due at the present tick.

        Raises:
            InputError: SK-CLI-012 a message does not fit its topic, with the place it was written.
        """
        while self._queue and self._queue[0][0] <= self._sim.tick:
            _, number, index = heapq.heappop(self._queue)
            command = self._commands[number]
            try:
                self._sim.publish(command.topic, command.message)
            except MessageError as error:
                raise InputError(f"{command.where}: SK-CLI-012 {error}", "SK-CLI-012") from None
            self._push(number, index + 1)

    def _push(self, number: int, index: int) -> None:
        time = self._commands[number].time(index)
        if time is not None:
            # A whole number of steps must not become one more by a rounding error.
            tick = math.ceil(time / self._sim.timestep - 1e-6)
            heapq.heappush(self._queue, (tick, number, index))


def steady_velocity(text: str, topics: Mapping[str, str]) -> Command:
    """The command of `--cmd-vel LINEAR,ANGULAR`: a Twist on `/cmd_vel`, or on the one topic that takes one.

    Args:
        text: forward speed [m/s] and turning speed [rad/s], with a comma between.
        topics: topic -> type of the world.

    Raises:
        InputError: SK-CLI-010 no such numbers, or no single topic to send them to.
    """
    parts = text.replace(",", " ").split()
    try:
        linear, angular = (float(p) for p in parts)
        if not (math.isfinite(linear) and math.isfinite(angular)):
            raise ValueError
    except ValueError:
        raise InputError(
            f"SK-CLI-010 --cmd-vel: found {text!r}, allowed is LINEAR,ANGULAR such as 0.2,0.3", "SK-CLI-010"
        ) from None
    takers = [topic for topic, type_name in topics.items() if type_name in _TWISTS]
    topic = "/cmd_vel" if "/cmd_vel" in takers else takers[0] if len(takers) == 1 else None
    if topic is None:
        found = "none does" if not takers else f"there are several ({', '.join(takers)}); use --script to name one"
        raise InputError(f"SK-CLI-010 --cmd-vel needs one topic that takes a Twist; {found}", "SK-CLI-010")
    twist = {"linear": {"x": linear}, "angular": {"z": angular}}
    message = twist if topics[topic] == _TWISTS[0] else {"twist": twist}
    return Command(0.0, topic, message, where="--cmd-vel")


def read_script(path: Path, topics: Mapping[str, str]) -> list[Command]:
    """The commands of a YAML script.

    Raises:
        InputError: SK-CLI-011 with file and line.
    """
    return commands_of(script_items(path), topics)


def script_items(path: Path) -> list[JsonObject]:
    """Return the items of a YAML script, each with its place under "where"; `commands_of` validates them for a world.

    Raises:
        InputError: SK-CLI-011 with file and line.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise _script_error(str(path), f"cannot be read: {getattr(error, 'strerror', None) or error}") from None
    try:
        root = compose_nodes(text)
    except NotYaml as error:
        raise _script_error(
            str(path) if error.line is None else f"{path}:{error.line}", f"is not YAML: {error}"
        ) from None
    if root is None:
        return []
    if root.id != "sequence":
        raise _script_error(
            f"{path}:{root.start_mark.line + 1}", "found something else, allowed is a list of {at, topic, message}"
        )
    found = []
    for node in root.value:
        where = f"{path}:{node.start_mark.line + 1}"
        try:
            found.append((node_value(node), where))
        except NotYaml as error:
            raise _script_error(where, f"is not YAML: {error!s:.200}") from None
    return validate_items(found)


def validate_items(items: Iterable[tuple[object, str]]) -> list[JsonObject]:
    """The mappings of commands, each with its place under "where"; what is wrong in any world is told.

    Args:
        items: what was written, and where.

    Raises:
        InputError: SK-CLI-011 with a line for every one that is no command.
    """
    return _collect(_validate_item, items)


def _validate_item(written: tuple[object, str]) -> JsonObject:
    item, where = written
    if not isinstance(item, dict):
        raise _script_error(where, f"found {item!r:.60}, allowed is {{at, topic, message}}")
    _command(item, where, None)
    return {**item, "where": where}


def commands_of(items: Iterable[JsonMapping], topics: Mapping[str, str]) -> list[Command]:
    """The commands that mappings stand for: those of a script, each with its place under "where".

    Raises:
        InputError: SK-CLI-011 with a line for every one that does not fit.
    """

    def command(item: JsonMapping) -> Command:
        where = str(item.get("where", "commands"))
        return _command({key: value for key, value in item.items() if key != "where"}, where, topics)

    return _collect(command, items)


def _collect(make: Callable[[_Item], _Made], items: Iterable[_Item]) -> list[_Made]:
    """Makes something of each item; what is wrong with any of them is told at once."""
    found, wrong = [], []
    for item in items:
        try:
            found.append(make(item))
        except InputError as error:
            wrong.append(error)
    if wrong:
        raise InputError("\n".join(map(str, wrong)), wrong[0].code)
    return found


def _command(item: JsonMapping, where: str, topics: Mapping[str, str] | None) -> Command:
    """A command; whether its topic is there is seen where topics are given."""
    for key in item:
        if key not in _KEYS:
            raise _script_error(
                where, f"unknown key {key!r}; {did_you_mean(str(key), _KEYS) or 'keys are ' + ', '.join(_KEYS)}"
            )
    for key in ("at", "topic"):
        if key not in item:
            raise _script_error(where, f"needs {key!r}")
    topic = item["topic"]
    if not isinstance(topic, str):
        raise _script_error(where, f"topic: found {topic!r}, allowed is a text")
    topic = topic if topic.startswith("/") else "/" + topic
    if topics is not None and topic not in topics:
        raise _script_error(
            where, f"no topic {topic!r}; {did_you_mean(topic, topics) or 'there is ' + ', '.join(topics)}"
        )
    message = item.get("message") or {}
    if not isinstance(message, dict):
        of = "its message" if topics is None else topics[topic]
        raise _script_error(where, f"message: found {message!r:.60}, allowed is a mapping of the fields of {of}")
    at = _number(item["at"], "at", where, 0.0)
    until = None if item.get("until") is None else _number(item["until"], "until", where, at)
    rate = _number(item.get("rate", _RATE), "rate", where, 1e-6)
    return Command(at, topic, message, until, rate, where)


def _number(value: object, key: str, where: str, minimum: float) -> float:
    number = finite_number(value)
    if number is None or number < minimum:
        raise _script_error(where, f"{key}: found {value!r:.60}, allowed is a number of at least {minimum:g}")
    return number


def _script_error(where: str, message: str) -> InputError:
    return InputError(f"{where}: SK-CLI-011 {message}", "SK-CLI-011")
