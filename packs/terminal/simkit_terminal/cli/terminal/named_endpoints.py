"""Topics, services, actions and nodes of a running simulation or a bag, found by name."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from simkit.cli.terminal.output import JsonObject, absolute_name, not_found_error, print_note
from simkit.cli.terminal.topic_sources import connection_name
from simkit.msgs.topic_names import is_hidden

if TYPE_CHECKING:
    from simkit.cli.terminal.topic_sources import Source, TopicEntry
    from simkit.live import Client

LIST_PARAMETERS: Final = "/list_parameters"
"""Suffix after the node's name in the name of the service that lists its parameters."""
GET_STATE: Final = "/get_state"
"""Suffix after the node's name in the name of the service with its lifecycle state."""
_STATE_TYPE: Final = "lifecycle_msgs/srv/GetState"


def interface_type(client: Client, what: str, types: Mapping[str, str], name: str) -> str:
    """Return the type of a service or an action.

    Args:
        client: connection to the simulation.
        what: `service` or `action`.
        types: types of all services or actions, by name.
        name: name, with or without its leading slash.

    Raises:
        InputError: SK-CLI-037 the name is unknown; the message suggests the closest name.
    """
    full_name = absolute_name(name)
    if full_name not in types:
        raise not_found_error(what, full_name, types, "SK-CLI-037", connection_name(client))
    return str(types[full_name])


def wait_for_topic(source: Source, name: str, until: float | None = None) -> TopicEntry:
    """Return a topic; if the simulation does not have it yet, wait for it.

    Args:
        source: running simulation or bag.
        name: name of the topic.
        until: end of the wait [s of `time.monotonic`]; None for never.

    Raises:
        InputError: SK-CLI-030 a bag has no such topic, or the topic did not appear in time.
    """
    full_name, was_reported = absolute_name(name), False
    while source.is_live and (until is None or time.monotonic() < until):
        entry = source.topics().get(full_name)
        if entry is not None:
            return entry
        if not was_reported:
            print_note(f"WARNING: topic [{name}] does not appear to be published yet")
            was_reported = True
        time.sleep(0.1)
    return find_topic(source, name)


def find_topic(source: Source, name: str) -> TopicEntry:
    """Return a topic by its name, including hidden topics.

    Raises:
        InputError: SK-CLI-030 the topic does not exist; the message suggests the closest name.
    """
    topics = source.topics()
    full_name = absolute_name(name)
    if full_name not in topics:
        visible = [t for t in topics if not is_hidden(t)]
        raise not_found_error("topic", full_name, visible, "SK-CLI-030", source.where)
    return topics[full_name]


def node_endpoints(client: Client, name: str) -> JsonObject:
    """Return the publishers, subscribers, services, actions and clients of a node, each by name.

    Raises:
        InputError: SK-CLI-034 the node does not exist; the message suggests the closest name.
    """
    nodes: dict[str, JsonObject] = client.ask("nodes")
    full_name = absolute_name(name)
    if full_name not in nodes:
        known = [node for node in nodes if not is_hidden(node)]
        raise not_found_error("node", full_name, known, "SK-CLI-034", connection_name(client))
    return nodes[full_name]


def node_names(client: Client, *, hidden: bool = False) -> list[str]:
    """Return the names of the nodes, sorted."""
    return sorted(name for name in client.ask("nodes") if hidden or not is_hidden(name))


def lifecycle_node_names(client: Client) -> list[str]:
    """Return the lifecycle nodes, sorted."""
    return sorted(name.removesuffix(GET_STATE) for name, kind in client.services().items() if kind == _STATE_TYPE)


def parameter_nodes(client: Client) -> list[str]:
    """Return the nodes that have parameters, sorted."""
    return sorted(name.removesuffix(LIST_PARAMETERS) for name in client.services() if name.endswith(LIST_PARAMETERS))
