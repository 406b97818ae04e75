"""Commands of `ros2 topic` and of `rostopic`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any

import rclpy
import yaml
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSPresetProfiles, QoSProfile, ReliabilityPolicy
from rosidl_runtime_py import message_to_csv, message_to_yaml, set_message_fields
from rosidl_runtime_py.utilities import get_message

from simkit.errors import InputError
from simkit.input_file import read_input_text
from simkit_terminal.cli.terminal.message_arguments import parse_fields

LOOK = 0.1
"""Period with which a command looks for a topic [s]."""


def topic_command(node: Node, words: list[str]) -> int:
    """Run a command of `ros2 topic`; return its exit code.

    Args:
        node: node of the command.
        words: words after `ros2`.
    """
    end = words.index("--") if "--" in words else len(words)
    options, rest = _parser().parse_known_args(words[1:end])
    if options.verb == "pub":
        options.values += [*rest, *words[end + 1 :]]
        return _publish(node, options)
    if options.verb == "echo":
        return _echo(node, options)
    if options.verb in ("hz", "bw", "delay"):
        node.get_logger().warning(f"`ros2 topic {options.verb}` has no effect here: use simkit topic {options.verb}")
        return 0
    wait_a_moment(node)
    for name, types in node.get_topic_names_and_types():
        if options.verb == "list":
            print(f"{name} [{', '.join(types)}]" if options.show_types else name)
        elif name == node.resolve_topic_name(options.topic):
            print("\n".join(types))
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="topic")
    verbs = parser.add_subparsers(dest="verb", required=True)
    pub = verbs.add_parser("pub")
    pub.add_argument("topic")
    pub.add_argument("type", nargs="?", default="")
    pub.add_argument("values", nargs="*", default=[])
    pub.add_argument("-r", "--rate", type=float, default=1.0)
    pub.add_argument("-p", "--print", type=int, default=1)
    pub.add_argument("-1", "--once", action="store_true")
    pub.add_argument("-l", "--latch", action="store_true")
    pub.add_argument("-f", "--file", default="")
    pub.add_argument("-s", "--substitute", action="store_true")
    pub.add_argument("-t", "--times", type=int, default=0)
    pub.add_argument("-w", "--wait-matching-subscriptions", type=int, default=None)
    pub.add_argument("--max-wait-time-secs", type=float, default=None)
    pub.add_argument("--keep-alive", type=float, default=0.1)
    pub.add_argument("-n", "--node-name", default="")
    echo = verbs.add_parser("echo")
    echo.add_argument("topic")
    echo.add_argument("type", nargs="?", default="")
    echo.add_argument("--once", "-1", action="store_true")
    echo.add_argument("-n", "--count", type=int, default=0)
    echo.add_argument("--field", default="")
    echo.add_argument("--csv", "-p", action="store_true")
    echo.add_argument("--no-arr", "--noarr", action="store_true")
    echo.add_argument("--no-str", "--nostr", action="store_true")
    echo.add_argument("--full-length", "-f", action="store_true")
    echo.add_argument("--truncate-length", "-l", type=int, default=128)
    for verb in (pub, echo):
        for name in ("profile", "reliability", "durability", "history", "depth"):
            verb.add_argument(f"--qos-{name}", default="")
        verb.add_argument("--spin-time", type=float, default=0.0)
    lists = verbs.add_parser("list")
    lists.add_argument("-t", "--show-types", action="store_true")
    for name in ("type", "info", "hz", "bw", "delay"):
        verbs.add_parser(name).add_argument("topic")
    return parser


def wait_a_moment(node: Node) -> None:
    """Wait until the node has found the topics and services that exist."""
    rclpy.spin_once(node, timeout_sec=LOOK)


def profile_of(options: argparse.Namespace, default: Any) -> Any:
    """Return the quality of service in the options of a command."""
    qos = QoSPresetProfiles.get_from_short_key(options.qos_profile) if options.qos_profile else default
    if options.qos_reliability:
        qos.reliability = ReliabilityPolicy.get_from_short_key(options.qos_reliability)
    if options.qos_durability:
        qos.durability = DurabilityPolicy.get_from_short_key(options.qos_durability)
    if options.qos_depth:
        qos.depth = int(options.qos_depth)
    return qos


def fields_of(values: Sequence[str], kind: Any) -> dict[str, Any]:
    """Return the fields of a message by name.

    Args:
        values: one text with a mapping in YAML, or the values of the fields in their order, as for `rostopic pub`.
        kind: class of the message.

    Raises:
        InputError: SK-CLI-031 a text is not valid.
    """
    if len(values) <= 1 and not (values and values[0].lstrip().startswith("[")):
        text = values[0] if values else ""
        names = list(kind.get_fields_and_field_types())
        if text and len(names) == 1 and not isinstance(yaml.safe_load(text), dict):
            return {names[0]: yaml.safe_load(text)}
        return dict(parse_fields(text, "the message"))
    try:
        items = [yaml.safe_load(value) for value in values]
    except yaml.YAMLError as error:
        raise InputError("SK-CLI-031", f"the message: {' '.join(values)!r:.200} is not YAML: {error}") from None
    return _by_order(items, kind)


def _by_order(items: Sequence[Any], kind: Any) -> dict[str, Any]:
    """Return fields by name from values in the order of the fields; a list stands for a message."""
    types = kind.get_fields_and_field_types()
    fields = {}
    for (name, type_name), item in zip(types.items(), items, strict=False):
        is_message = "/" in type_name and "[" not in type_name and "sequence" not in type_name
        fields[name] = _by_order(item, get_message(type_name)) if is_message and isinstance(item, list) else item
    return fields


def fill(message: Any, fields: dict[str, Any]) -> list[Any]:
    """Set the fields of a message; return functions that set its times.

    Raises:
        InputError: SK-CLI-031 the fields do not match the type.
    """
    try:
        setters: list[Any] = set_message_fields(message, fields, expand_header_auto=True, expand_time_now=True)
    except (AttributeError, TypeError, ValueError, AssertionError) as error:
        raise InputError("SK-CLI-031", f"the message does not match its type: {error}") from None
    return setters


def class_of(name: str) -> Any:
    """Return the class of a message.

    Raises:
        InputError: SK-CLI-032 there is no such type.
    """
    try:
        return get_message(name)
    except (ValueError, AttributeError, ModuleNotFoundError):
        raise InputError("SK-CLI-032", f"no message type {name!r}") from None


def _publish(node: Node, options: argparse.Namespace) -> int:
    if not options.type:
        options.type = _type_of(node, options.topic)
    kind = class_of(options.type)
    if options.file:
        options.values = [read_input_text(options.file)]
    qos = profile_of(options, QoSProfile(depth=10))
    if options.latch:
        qos.durability = DurabilityPolicy.TRANSIENT_LOCAL
    message = kind()
    setters = fill(message, fields_of(options.values, kind))
    publisher = node.create_publisher(kind, options.topic, qos)
    number = 1 if options.once or options.latch else options.times
    wanted = options.wait_matching_subscriptions
    wanted = int(bool(number) and not options.latch) if wanted is None else wanted
    _wait_matching(node, publisher, wanted, options.max_wait_time_secs)
    print("publisher: beginning loop")
    count = 0
    while True:
        for setter in setters:
            setter(node.get_clock().now().to_msg())
        count += 1
        if options.print and count % options.print == 0:
            print(f"publishing #{count}: {message!r}\n")
        publisher.publish(message)
        if count == number:
            break
        _sleep(node, 1.0 / options.rate)
    if options.latch:
        rclpy.spin(node)
    _sleep(node, options.keep_alive)
    return 0


def _wait_matching(node: Node, publisher: Any, wanted: int, limit: float | None) -> None:
    """Wait for subscriptions, at most for a time [s]."""
    waited = 0.0
    while publisher.get_subscription_count() < wanted and (limit is None or waited < limit):
        if waited and round(waited / LOOK) % 10 == 0:
            print(f"Waiting for at least {wanted} matching subscription(s)...")
        _sleep(node, LOOK)
        waited += LOOK


def _sleep(node: Node, duration: float) -> None:
    """Wait for a simulated time [s]."""
    is_over = [False]
    timer = node.create_timer(duration, lambda: is_over.__setitem__(0, True))
    while not is_over[0]:
        rclpy.spin_once(node)
    node.destroy_timer(timer)


def _type_of(node: Node, topic: str) -> str:
    """Wait until a topic exists and return its type."""
    name = node.resolve_topic_name(topic)
    while True:
        types = dict(node.get_topic_names_and_types()).get(name)
        if types:
            return str(types[0])
        _sleep(node, LOOK)


def _echo(node: Node, options: argparse.Namespace) -> int:
    kind = class_of(options.type or _type_of(node, options.topic))
    number = 1 if options.once else options.count
    printed = [0]
    length = None if options.full_length else options.truncate_length

    def show(message: Any) -> None:
        value = message
        for part in filter(None, options.field.split(".")):
            value = getattr(value, part)
        printed[0] += 1
        if not hasattr(value, "get_fields_and_field_types"):
            print(value)
        elif options.csv:
            print(message_to_csv(value, truncate_length=length, no_arr=options.no_arr, no_str=options.no_str))
            return
        else:
            print(message_to_yaml(value, truncate_length=length, no_arr=options.no_arr, no_str=options.no_str), end="")
        print("---")

    qos = profile_of(options, QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT))
    node.create_subscription(kind, options.topic, show, qos)
    while not number or printed[0] < number:
        rclpy.spin_once(node)
    return 0
