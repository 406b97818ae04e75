"""Command `simkit topic pub`: publish messages into a running simulation."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Annotated

from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.output import JsonObject, JsonValue, absolute_name, print_json, print_line, print_note
from simkit.cli.terminal.topic_sources import LONGEST_WAIT, LiveSource, SimClock, connect_to_simulation
from simkit.errors import InputError, MessageError
from simkit.extend import argument, option
from simkit_terminal.cli.terminal import completion
from simkit_terminal.cli.terminal.message_arguments import make_message, split_type_and_words
from simkit_terminal.cli.terminal.named_endpoints import find_topic
from simkit_terminal.cli.terminal.positional_values import read_fields

if TYPE_CHECKING:
    from simkit.live import Client


_TYPE_HELP = "Type such as geometry_msgs/msg/Twist; default: the topic's type."
_VALUES_HELP = (
    "Message as YAML: '{linear: {x: 0.2}}', or one value for each field, as in `rostopic pub`; "
    "`header: auto` and `stamp: now` insert the present time."
)
_WAIT_HELP = "Number of subscribers to wait for; default: 1 with --once and --times, else 0."
_WAIT_NAMES = ("--wait-matching-subscriptions", "-w")

MessageType = Annotated[str | None, argument(_TYPE_HELP, "[TYPE]", completion.topic_types)]
Values = Annotated[list[str] | None, argument(_VALUES_HELP, "[VALUES]...", completion.message_values)]
MatchingSubscribers = Annotated[int | None, option(_WAIT_HELP, "N", *_WAIT_NAMES, min=0, show_default=False)]


def pub(
    topic: options.Topic,
    message_type: MessageType = None,
    values: Values = None,
    stdin: Annotated[bool, Option("--stdin", help="Read the values from standard input.")] = False,
    rate: Annotated[float, option("Messages per simulated second.", "N", "--rate", "-r", min=1e-3)] = 1.0,
    every: Annotated[int, option("Print every Nth message; 0: none.", "N", "--print", "-p", min=0)] = 1,
    once: Annotated[bool, Option("--once", "-1", help="Publish one message.")] = False,
    times: Annotated[int | None, option("Publish N messages.", "N", "--times", "-t", min=0, show_default=False)] = None,
    wait: MatchingSubscribers = None,
    keep_alive: Annotated[float, option("Wall time to stay after the last message.", "S", "--keep-alive", min=0)] = 0.1,
    wall_time: Annotated[bool, Option("--wall-time", help="Use wall time for the rate.")] = False,
    sim: options.Sim = None,
    json_: options.Json = False,
) -> None:
    """Publish a message repeatedly until Ctrl-C."""
    from simkit.live import LiveClosed

    message_type, words = split_type_and_words(message_type, values)
    if stdin:
        words = [sys.stdin.read()]
    number = 1 if once else times or 0
    if once and times is not None:
        raise InputError("SK-CLI-018", "--once and --times: found both; expected one of them")
    with connect_to_simulation(sim) as client:
        publisher = client.advertise(topic, _full_type_name(client, topic, message_type))
        make = _message_factory(publisher.type_name, read_fields(publisher.type_name, words, "the message"))
        make(0)  # report an invalid message before any waiting
        _wait_matching(
            client, topic, (1 if number else 0) if wait is None else wait, print_note if json_ else print_line
        )
        if not json_:
            print_line("publisher: beginning loop")
        try:
            for count, now_ns in enumerate(_times(client, rate, number, wall_time), 1):
                message = make(now_ns)
                if every and count % every == 0:
                    _print(message, count, json_)
                publisher.publish(message)
        except LiveClosed as closed:
            if number or closed.code != "SK-LIVE-005":
                raise  # some of the messages were not sent
            print_note(f"note: {str(closed).removeprefix('SK-LIVE-005 ')}")
            return
        client.flush()
        if keep_alive:
            time.sleep(min(keep_alive, LONGEST_WAIT))


def _full_type_name(client: Client, topic: str, type_name: str | None) -> str:
    """Return the full name of a known type.

    Raises:
        InputError: SK-CLI-032 the type is unknown; SK-CLI-030 no type is given and the topic does not exist.
    """
    from simkit import msgs

    if type_name is None:
        entry = find_topic(LiveSource(client), topic)
        subscribed_types = [t for end in entry.subscribers for t in end.types]
        return subscribed_types[0] if subscribed_types else entry.types[0]
    client.interfaces()  # the type may be one that only the simulation knows
    try:
        return msgs.full_name(type_name)
    except MessageError as error:
        raise InputError("SK-CLI-032", str(error)) from None


def _message_factory(type_name: str, fields: JsonObject) -> Callable[[int], object]:
    """Return a function that builds the message of a time [ns]. A message without a time is built once."""
    is_stamped = fields.get("header") == "auto" or _uses_time(fields)

    def at(now_ns: int) -> object:
        return make_message(type_name, _with_time(fields, now_ns))

    if is_stamped:
        return at
    message = at(0)
    return lambda _: message


def _uses_time(value: object) -> bool:
    if isinstance(value, dict):
        return any(v == "now" or _uses_time(v) for v in value.values())
    return isinstance(value, list) and any(_uses_time(v) for v in value)


def _with_time(value: object, now_ns: int) -> JsonValue:
    stamp = {"sec": now_ns // 10**9, "nanosec": now_ns % 10**9}
    if isinstance(value, dict):
        return {
            k: {"stamp": stamp}
            if k == "header" and v == "auto"
            else stamp
            if v == "now" and k == "stamp"
            else _with_time(v, now_ns)
            for k, v in value.items()
        }
    return [_with_time(v, now_ns) for v in value] if isinstance(value, list) else value


def _wait_matching(client: Client, topic: str, number: int, print_text: Callable[[str], None]) -> None:
    was_reported = False
    while number and len(_subscribers(client, absolute_name(topic))) < number:
        if not was_reported:
            print_text(f"Waiting for at least {number} matching subscription(s)...")
            was_reported = True
        time.sleep(0.1)


def _subscribers(client: Client, topic: str) -> list[JsonObject]:
    return next((list(row["subscribers"]) for row in client.topics() if row["name"] == topic), [])


def _times(client: Client, rate: float, number: int, by_wall: bool) -> Iterator[int]:
    """Yield the simulated times [ns] at which to send messages: at once, then every 1/rate seconds."""
    clock = SimClock(client, by_wall=by_wall)
    period = round(1e9 / rate)
    due = clock.now_ns()
    sent = 0
    while not number or sent < number:
        if not clock.wait_until(due, due - period):
            due = clock.now_ns()  # after a reset
        yield clock.sim_ns()
        sent += 1
        due = max(due + period, clock.now_ns() - period)  # after a delay, at most one message is sent late


def _print(message: object, count: int, json_: bool) -> None:
    from simkit.msgs.message_text import message_to_dict, to_python

    if json_:
        print_json(message_to_dict(message))
    else:
        print_line(f"publishing #{count}: {to_python(message)}\n")
