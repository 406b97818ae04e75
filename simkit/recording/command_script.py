"""Commands during a run: one constant velocity, or a YAML script of messages over time.

A script is a list; times are simulated seconds:

    - {at: 0.0, topic: /cmd_vel, message: {linear: {x: 0.2}}}
    - {at: 2.0, until: 6.0, rate: 10, topic: /cmd_vel, message: {angular: {z: 0.5}}}
"""

from __future__ import annotations

import heapq
import math
import re
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError, MessageError, raise_together
from simkit.input_file import read_failure, read_input_text
from simkit.run_spec import JsonMapping, JsonObject
from simkit.yaml_reader import NotYaml, compose_nodes, finite_number, node_value

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_Item = TypeVar("_Item")
_Result = TypeVar("_Result")
_KEYS = ("at", "topic", "message", "until", "rate")
_VARIABLE = re.compile(r"\{[^\W\d]\w*\}")
_RATE = 10.0  # [Hz] default rate of a repeated command
_HIGHEST_RATE = 1e6  # [Hz]
_LATEST = 2.0**31 - 1.0  # [s], latest time that a ROS time stamp can hold
_ANY_NUMBERS = {"at": 0.0, "until": _LATEST, "rate": _RATE}  # for variables, whose values are not known yet
_TWISTS = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")


@dataclass(frozen=True)
class Command:
    """Message that is sent once or repeatedly.

    Attributes:
        at: first time [s].
        until: last time [s]; None for a single message.
        rate: repetition rate [Hz].
        where: file and line of the command, for error messages.
    """

    at: float
    topic: str
    message: object
    until: float | None = None
    rate: float = _RATE
    where: str = ""

    def time(self, index: int) -> float | None:
        """Return the time of the message number `index` [s], counted from 0; None after the last message."""
        if index == 0:
            return self.at
        if self.until is None:
            return None
        time = self.at + index / self.rate
        return time if time <= self.until else None

    def plain(self) -> JsonObject:
        """Return the command as a mapping in the format of a scenario file."""
        fields = {"at": self.at, "topic": self.topic, "message": self.message, "where": self.where}
        return fields if self.until is None else {**fields, "until": self.until, "rate": self.rate}


class Commands:
    """Scheduled commands; each one is sent at the first tick at or after its time.

    Args:
        sim: simulation that receives the commands.
        commands: commands in any order; commands of the same time are sent in the order of the list.
    """

    def __init__(self, sim: Simulation, commands: Iterable[Command]) -> None:
        self._sim = sim
        self._commands = list(commands)
        self._queue: list[tuple[int, int, int]] = []
        for number in range(len(self._commands)):
            self._push(number, 0)

    def check_messages(self) -> None:
        """Check that each message matches the types of its topic; nothing is sent.

        Raises:
            InputError: SK-CLI-012 with one line for each message that does not match; with file and line.
        """
        bus = self._sim.communication.bus

        def check(command: Command) -> None:
            try:
                bus.message_for(command.topic, command.message)
            except MessageError as error:
                raise _message_error(command, error) from None

        _collect(check, self._commands)

    @property
    def next_tick(self) -> int | None:
        """Tick of the next command; None after the last command."""
        return self._queue[0][0] if self._queue else None

    def send_due(self) -> None:
        """Send the commands that are due at the present tick.

        Raises:
            InputError: SK-CLI-012 a message does not match its topic; with the file and line of the command.
        """
        while self._queue and self._queue[0][0] <= self._sim.tick:
            _, number, index = heapq.heappop(self._queue)
            command = self._commands[number]
            try:
                self._sim.publish(command.topic, command.message)
            except MessageError as error:
                raise _message_error(command, error) from None
            except InputError as error:  # nodes had time to create the topic
                raise _script_error(command.where, error.message) from None
            self._push(number, index + 1)

    def _push(self, number: int, index: int) -> None:
        time = self._commands[number].time(index)
        if time is not None:
            # a rounding error must not add a step to a whole number of steps
            tick = math.ceil(time / self._sim.timestep - 1e-6)
            heapq.heappush(self._queue, (tick, number, index))


class LateVelocity:
    """Constant velocity of a run in which a node may create the topic during the run.

    Args:
        sim: simulation that receives the commands.
        text: value of `--cmd-vel`.

    Attributes:
        problem: reason why no command has been sent; empty after the first command.

    Raises:
        InputError: SK-CLI-010 the numbers are invalid.
    """

    def __init__(self, sim: Simulation, text: str) -> None:
        parse_velocity(text)
        self._sim, self._text = sim, text
        self._commands: Commands | None = None
        self._next_look = sim.tick
        self.problem = ""

    @property
    def next_tick(self) -> int | None:
        """Tick of the next command, or of the next search for its topic."""
        return self._next_look if self._commands is None else self._commands.next_tick

    def send_due(self) -> None:
        """Send the commands that are due at the present tick, if the world has a topic for them."""
        if self._commands is None and self._sim.tick >= self._next_look:
            try:
                idle = self._sim.communication.bus.idle_topics()
                command = steady_velocity(self._text, self._topics(), idle)
            except InputError as error:
                self.problem = error.message
                self._next_look = self._sim.tick + max(1, round(1.0 / _RATE / self._sim.timestep))
                return
            self.problem = ""
            self._commands = Commands(self._sim, [replace(command, at=self._sim.time)])
        if self._commands is not None:
            self._commands.send_due()

    def _topics(self) -> dict[str, str]:
        """Return the types by topic, with topics that only a node subscribes, such as an input of `twist_mux`."""
        bus = self._sim.communication.bus
        subscribed = {each.topic: each.type_name for each in bus.subscriptions() if each.type_name}
        return dict(sorted({**subscribed, **bus.topics()}.items()))


def steady_velocity(text: str, topics: Mapping[str, str], idle: Collection[str] = ()) -> Command:
    """Parse `--cmd-vel LINEAR,ANGULAR`: a Twist on `/cmd_vel`, or on the world's only Twist topic.

    The command is repeated until the end, because many controllers stop 0.5 s after their last command.

    Args:
        text: forward speed [m/s] and yaw rate [rad/s], separated by a comma.
        topics: topic -> type, for all topics of the world.
        idle: topics of inactive controllers. One of them is used only if there is no other topic.

    Raises:
        InputError: SK-CLI-010 the numbers are invalid, or the topic is not unique.
    """
    linear, angular = parse_velocity(text)
    twists = [topic for topic, type_name in topics.items() if type_name in _TWISTS]
    # a controller of ros2_control takes commands without a stamp on a second topic and publishes its limited commands
    companions = {f"{topic}{suffix}" for topic in twists for suffix in ("_unstamped", "_out")}
    twist_topics = [topic for topic in twists if topic not in companions]
    twist_topics = [topic for topic in twist_topics if topic not in idle] or twist_topics
    topic = twist_topics[0] if len(twist_topics) == 1 else _outermost_cmd_vel(twist_topics)
    if topic is None:
        topics_text = f"several ({', '.join(twist_topics)}); choose one in a --script" if twist_topics else "none"
        raise InputError("SK-CLI-010", f"--cmd-vel needs exactly one Twist topic; found {topics_text}")
    twist = {"linear": {"x": linear}, "angular": {"z": angular}}
    message = twist if topics[topic] == _TWISTS[0] else {"twist": twist}
    return Command(0.0, topic, message, until=_LATEST, where="--cmd-vel")


def parse_velocity(text: str, where: str = "--cmd-vel") -> tuple[float, float]:
    """Return forward speed [m/s] and yaw rate [rad/s] of a text.

    Args:
        text: two numbers, separated by a comma or a space.
        where: name of the argument, for the message.

    Raises:
        InputError: SK-CLI-010 the numbers are invalid.
    """
    parts = text.replace(",", " ").split()
    try:
        linear, angular = (float(p) for p in parts)
        if not (math.isfinite(linear) and math.isfinite(angular)):
            raise ValueError
    except ValueError:
        raise InputError("SK-CLI-010", f"{where}: found {text!r}; expected LINEAR,ANGULAR such as 0.2,0.3") from None
    return linear, angular


def _outermost_cmd_vel(topics: list[str]) -> str | None:
    """Return the topic `cmd_vel` whose namespace contains all the other topics: a remapped topic of a controller."""
    for topic in topics:
        namespace, _, name = topic.rpartition("/")
        if name == "cmd_vel" and all(other.startswith(f"{namespace}/") for other in topics):
            return topic
    return None


def read_script(path: Path, topics: Mapping[str, str] | None) -> list[Command]:
    """Read the commands of a YAML script; see `commands_of`.

    Raises:
        InputError: SK-CLI-011 the script is invalid; with file and line.
    """
    return commands_of(script_items(path), topics)


def script_items(path: Path) -> list[JsonObject]:
    """Read the items of a YAML script, each with its file and line under "where".

    `commands_of` validates the items for a world.

    Raises:
        InputError: SK-CLI-011 the script is invalid; with file and line.
    """
    try:
        text = read_input_text(path)
    except (OSError, UnicodeDecodeError) as error:
        wanted = "commands are a list of {at, topic, message}, or a YAML file with it"
        raise _script_error(str(path), f"cannot be read: {read_failure(error)}; {wanted}") from None
    try:
        root = compose_nodes(text)
    except NotYaml as error:
        raise _script_error(
            str(path) if error.line is None else f"{path}:{error.line}", f"is not YAML: {error}"
        ) from None
    if root is None:
        return []
    if root.id != "sequence":
        raise _script_error(f"{path}:{root.start_mark.line + 1}", "the script is not a list of {at, topic, message}")
    items = []
    for node in root.value:
        where = f"{path}:{node.start_mark.line + 1}"
        try:
            items.append((node_value(node), where))
        except NotYaml as error:
            raise _script_error(where, f"is not YAML: {error!s:.200}") from None
    return validate_items(items)


def validate_items(items: Iterable[tuple[object, str]]) -> list[JsonObject]:
    """Validate commands independently of a world; a number may be a variable `{name}` of a sweep.

    Args:
        items: each command with its file and line.

    Returns:
        Mappings of the commands, each with its file and line under "where".

    Raises:
        InputError: SK-CLI-011 with one line for each invalid command.
    """
    return _collect(_validate_item, items)


def _validate_item(item_with_location: tuple[object, str]) -> JsonObject:
    item, where = item_with_location
    if not isinstance(item, dict):
        raise _script_error(where, f"found {item!r:.60}; expected {{at, topic, message}}")
    known = {key: number for key, number in _ANY_NUMBERS.items() if _VARIABLE.fullmatch(str(item.get(key)))}
    _command({**item, **known}, where, None)
    return {**item, "where": where}


def commands_of(items: Iterable[JsonMapping], topics: Mapping[str, str] | None) -> list[Command]:
    """Convert the mappings of a script to commands; each mapping has its file and line under "where".

    Args:
        items: mappings.
        topics: topics of the world; None for a run whose nodes may create further topics.

    Raises:
        InputError: SK-CLI-011 with one line for each invalid command.
    """

    def command(item: JsonMapping) -> Command:
        where = str(item.get("where", "commands"))
        return _command({key: value for key, value in item.items() if key != "where"}, where, topics)

    return _collect(command, items)


def _collect(make: Callable[[_Item], _Result], items: Iterable[_Item]) -> list[_Result]:
    """Convert each item, and report the errors of all items together."""
    made, errors = [], []
    for item in items:
        try:
            made.append(make(item))
        except InputError as error:
            errors.append(error)
    raise_together(errors)
    return made


def _command(item: JsonMapping, where: str, topics: Mapping[str, str] | None) -> Command:
    """Convert a mapping to a command; with `topics`, check that its topic exists."""
    for key in item:
        if key not in _KEYS:
            raise _script_error(
                where, f"unknown key {key!r:.60}; {did_you_mean(str(key), _KEYS) or 'allowed: ' + ', '.join(_KEYS)}"
            )
    for key in ("at", "topic"):
        if key not in item:
            raise _script_error(where, f"key {key!r} is missing")
    topic = item["topic"]
    if not isinstance(topic, str):
        raise _script_error(where, f"topic: found {topic!r:.60}; expected a text")
    topic = topic if topic.startswith("/") else "/" + topic
    if topics is not None and topic not in topics:
        raise _script_error(
            where, f"no topic {topic!r:.60}; {did_you_mean(topic, topics) or 'known: ' + ', '.join(topics)}"
        )
    message = item.get("message") or {}
    if not isinstance(message, dict):
        kind = "its message" if topics is None else topics[topic]
        raise _script_error(where, f"message: found {message!r:.60}; expected a mapping of the fields of {kind}")
    at = _number(item["at"], "at", where, 0.0, _LATEST)
    until = None if item.get("until") is None else _number(item["until"], "until", where, at, _LATEST)
    rate = _number(item.get("rate", _RATE), "rate", where, 1e-6, _HIGHEST_RATE)
    return Command(at, topic, message, until, rate, where)


def _number(value: object, key: str, where: str, minimum: float, maximum: float) -> float:
    number = finite_number(value)
    if number is None or not minimum <= number <= maximum:
        bounds = f"at least {minimum:g} and at most {maximum:.10g}"
        raise _script_error(where, f"{key}: found {value!r:.60}; expected a number of {bounds}")
    return number


def _message_error(command: Command, error: MessageError) -> InputError:
    return InputError("SK-CLI-012", f"{command.where}: SK-CLI-012 {error}", shows_code=False)


def _script_error(where: str, message: str) -> InputError:
    return InputError("SK-CLI-011", f"{where}: SK-CLI-011 {message}", shows_code=False)
