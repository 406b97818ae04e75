"""Inspect and publish topics of a simulation or a bag."""

from __future__ import annotations

import hashlib
from typing import Annotated

import typer
from typer import Option

from simkit.cli.terminal import options
from simkit.cli.terminal.output import JsonObject, print_json, print_line, print_name
from simkit.cli.terminal.topic_sources import TopicEndpoint, TopicEntry, open_source
from simkit.errors import MessageError
from simkit.extend import argument, counted
from simkit.msgs.topic_names import is_hidden
from simkit_terminal.cli.terminal import completion
from simkit_terminal.cli.terminal.live_command import live_command
from simkit_terminal.cli.terminal.message_arguments import is_same_type
from simkit_terminal.cli.terminal.name_lists import print_names
from simkit_terminal.cli.terminal.named_endpoints import find_topic
from simkit_terminal.cli.terminal.topic_echo import echo
from simkit_terminal.cli.terminal.topic_pub import pub
from simkit_terminal.cli.terminal.topic_rates import bw, delay, hz

LISTED_AFTER = "map"

topic = typer.Typer(help="Inspect and publish topics of a simulation or a bag.", no_args_is_help=True)


Count = Annotated[bool, Option("--count-topics", "--count", "-c", help="Print only the number of topics.")]
Hidden = Annotated[
    bool, Option("--include-hidden-topics", "-a", "--all", help="Include hidden topics (a name part begins with _).")
]


@live_command(topic, "list")
def list_(
    show_types: options.ShowTypes = False,
    verbose: Annotated[bool, Option("--verbose", "-v", help="Group by publishers and subscribers.")] = False,
    count: Count = False,
    hidden: Hidden = False,
    sim: options.Sim = None,
    bag: options.Bag = None,
    json_: options.Json = False,
) -> None:
    """List the topics."""
    with open_source(sim, bag) as source:
        entries = [t for t in source.topics().values() if hidden or not is_hidden(t.name)]
    if json_:
        print_json(len(entries) if count else [_topic_dict(t, show_ends=verbose) for t in entries])
    elif count:
        print_line(str(len(entries)))
    elif verbose:
        for word, end in (("Published", "publisher"), ("Subscribed", "subscriber")):
            print_line(f"{word} topics:")
            for entry in entries:
                number = len(entry.publishers if end == "publisher" else entry.subscribers)
                if number:
                    types = ", ".join(entry.types)
                    print_name(f" * {entry.name} [{types}] {counted(number, end)}")
            print_line()
    else:
        for entry in entries:
            print_name(f"{entry.name} [{', '.join(entry.types)}]" if show_types else entry.name)


def _topic_dict(entry: TopicEntry, *, show_ends: bool) -> JsonObject:
    row: JsonObject = {"name": entry.name, "types": list(entry.types)}
    if show_ends:
        row |= {
            "publishers": [_endpoint_dict(e) for e in entry.publishers],
            "subscribers": [_endpoint_dict(e) for e in entry.subscribers],
        }
    return row


def _endpoint_dict(end: TopicEndpoint) -> JsonObject:
    return {"node": end.node, "types": list(end.types), "latched": end.latched}


@live_command(topic)
def info(
    topic: options.Topic,
    verbose: Annotated[bool, Option("--verbose", "-v", help="Print each node with its QoS.")] = False,
    sim: options.Sim = None,
    bag: options.Bag = None,
    json_: options.Json = False,
) -> None:
    """Print the type of a topic and the numbers of its publishers and subscribers."""
    with open_source(sim, bag) as source:
        entry = find_topic(source, topic)
    if json_:
        print_json(_topic_dict(entry, show_ends=True))
        return
    gap = "\n" if verbose else ""
    print_line(f"Type: {entry.types[0] if len(entry.types) == 1 else list(entry.types)}{gap}")
    for word, ends, kind in (
        ("Publisher", entry.publishers, "PUBLISHER"),
        ("Subscription", entry.subscribers, "SUBSCRIPTION"),
    ):
        print_line(f"{word} count: {len(ends)}{gap}")
        if verbose:
            for number, end in enumerate(ends):
                for type_name in end.types:
                    print_line(_endpoint_text(entry.name, end, type_name, kind, number) + gap)


def _endpoint_text(topic_name: str, end: TopicEndpoint, type_name: str, kind: str, number: int) -> str:
    """Describe one endpoint in the format of rclpy."""
    from simkit import msgs

    space, _, name = (end.node or "_NODE_NAME_UNKNOWN_").rpartition("/")
    unknown = "_NODE_NAMESPACE_UNKNOWN_" if not end.node else "/"
    try:
        known = msgs.rihs(type_name)
    except MessageError:
        known = "INVALID"
    digest = hashlib.sha256(f"{topic_name} {end.node} {kind} {type_name} {number}".encode()).digest()[:16]
    return "\n".join(
        (
            f"Node name: {name}",
            f"Node namespace: {space or unknown}",
            f"Topic type: {type_name}",
            f"Topic type hash: {known}",
            f"Endpoint type: {kind}",
            f"GID: {'.'.join(f'{b:02x}' for b in digest)}",
            "QoS profile:",
            "  Reliability: RELIABLE",
            f"  History (Depth): KEEP_LAST ({1 if end.latched else 10})",
            f"  Durability: {'TRANSIENT_LOCAL' if end.latched else 'VOLATILE'}",
            "  Lifespan: Infinite",
            "  Deadline: Infinite",
            "  Liveliness: AUTOMATIC",
            "  Liveliness lease duration: Infinite",
        )
    )


@live_command(topic, "type")
def type_(topic: options.Topic, sim: options.Sim = None, bag: options.Bag = None, json_: options.Json = False) -> None:
    """Print the type of a topic."""
    with open_source(sim, bag) as source:
        entry = find_topic(source, topic)
    print_names(entry.types, json_=json_)


@live_command(topic)
def find(
    topic_type: Annotated[str, argument("Type such as geometry_msgs/msg/Twist.", "TYPE", completion.message_types)],
    count: Count = False,
    hidden: Hidden = False,
    sim: options.Sim = None,
    bag: options.Bag = None,
    json_: options.Json = False,
) -> None:
    """List the topics of a type."""
    with open_source(sim, bag) as source:
        names = [
            t.name for t in source.topics().values() if any(is_same_type(topic_type, known) for known in _all_types(t))
        ]
    names = [name for name in names if hidden or not is_hidden(name)]
    print_names(names, count=count, json_=json_)


def _all_types(entry: TopicEntry) -> set[str]:
    return {*entry.types, *(t for end in (*entry.publishers, *entry.subscribers) for t in end.types)}


live_command(topic)(echo)
live_command(topic)(hz)
live_command(topic)(bw)
live_command(topic)(delay)
live_command(topic)(pub)
