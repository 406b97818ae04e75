"""Shell completion with topics, types, services, nodes and other names of a running simulation or a bag."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import typer

from simkit.cli.terminal.completion import Completer, connect_client, incomplete_word, open_topics, silent
from simkit.cli.terminal.output import absolute_name
from simkit_terminal.cli.terminal.named_endpoints import lifecycle_node_names, node_names, parameter_nodes

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

    from simkit.live import Client

_TF_DURATION = 0.5  # [s] of wall time in which frames arrive


def _topic_before(ctx: typer.Context) -> str:
    """Return the topic earlier on the line. While an option's value is completed, click has the topic in `args`."""
    argument = ctx.params.get("topic") or next((word for word in ctx.args if not word.startswith("-")), "")
    return absolute_name(argument) if argument else ""


@silent
def topic_types(ctx: typer.Context) -> Iterable[str]:
    """Complete types of the topic earlier on the line; all message types for a topic that does not exist yet."""
    from simkit.msgs.interface_definitions import interface_names

    topic = _topic_before(ctx)
    if topic:
        with open_topics(ctx) as source:
            entry = source.topics().get(topic)
        if entry is not None:
            subscribed_types = [t for end in entry.subscribers for t in end.types]
            return dict.fromkeys([*entry.types, *subscribed_types])
    return interface_names("msg")


@silent
def message_types(_: typer.Context) -> Iterable[str]:
    """Complete message types."""
    from simkit.msgs.interface_definitions import interface_names

    return interface_names("msg")


@silent
def interfaces(_: typer.Context) -> Iterable[str]:
    """Complete message, service and action types."""
    from simkit.msgs.interface_definitions import interface_names

    return [name for kind in ("msg", "srv", "action") for name in interface_names(kind)]


@silent
def fields(ctx: typer.Context) -> Iterable[str]:
    """Complete field paths of the topic earlier on the line, one level at a time."""
    from simkit.msgs.message_text import field_nodes

    with open_topics(ctx) as source:
        entry = source.topics()[_topic_before(ctx)]
        type_name = entry.types[0]
        store = source.store(type_name)
        before, _, _ = incomplete_word(ctx).rpartition(".")
        for name in before.split(".") if before else ():
            node = dict(field_nodes(_full_type_name(type_name, store), store))[name.partition("[")[0]]
            while int(node[0]) in (3, 4):
                node = node[1][0]
            type_name = node[1]
        nodes = field_nodes(_full_type_name(type_name, store), store)
    return [f"{before}.{name}" if before else name for name, _ in nodes]


def _full_type_name(type_name: str, store: Typestore | None) -> str:
    from simkit.msgs import full_name

    return type_name if store is not None else full_name(type_name)


def _prototype_of(parameter: str) -> Completer:
    """Return a completer that offers a message template of the type in that parameter."""

    def prototypes(ctx: typer.Context) -> list[str]:
        from simkit.msgs.interface_definitions import prototype
        from simkit.msgs.message_text import to_yaml

        type_name = str(ctx.params.get(parameter) or "")
        return [to_yaml(prototype(type_name), flow=True).strip()] if type_name else []

    return silent(prototypes)


message_values = _prototype_of("message_type")
service_values = _prototype_of("service_type")
goal_values = _prototype_of("action_type")


def _of_client(names: Callable[[Client, typer.Context], Iterable[str]]) -> Completer:
    """Return a completer that offers names from a running simulation."""

    def client_names(ctx: typer.Context) -> Iterable[str]:
        with connect_client(ctx) as client:
            return list(names(client, ctx))

    return silent(client_names)


def _nodes_with_parameters(client: Client, _: typer.Context) -> list[str]:
    return parameter_nodes(client)


def _lifecycle_nodes(client: Client, _: typer.Context) -> list[str]:
    return lifecycle_node_names(client)


def _transitions_of_node(client: Client, ctx: typer.Context) -> Iterable[str]:
    """Return the transitions that are possible for the node earlier on the line."""
    name = absolute_name(str(ctx.params.get("node") or ""))
    return [t.transition.label for t in client.call(f"{name}/get_available_transitions").available_transitions]


def _all_nodes(client: Client, _: typer.Context) -> list[str]:
    return node_names(client)


def _parameters_of_node(client: Client, ctx: typer.Context) -> Iterable[str]:
    """Return the parameters of the node earlier on the line."""
    name = absolute_name(str(ctx.params.get("node") or ""))
    names: Iterable[str] = client.call(f"{name}/list_parameters", {}).result.names
    return names


services = _of_client(lambda client, _: client.services())
actions = _of_client(lambda client, _: client.actions())
nodes = _of_client(_nodes_with_parameters)
all_nodes = _of_client(_all_nodes)
lifecycle_nodes = _of_client(_lifecycle_nodes)
lifecycle_transitions = _of_client(_transitions_of_node)
parameters = _of_client(_parameters_of_node)
models = _of_client(lambda client, _: client.models())
links = _of_client(lambda client, ctx: client.model(str(ctx.params["model"]))["links"])
joints = _of_client(lambda client, ctx: client.model(str(ctx.params["model"]))["joints"])


@silent
def service_types(ctx: typer.Context) -> Iterable[str]:
    """Complete the type of the service earlier on the line; all service types if it does not exist."""
    return _types_of_name(ctx, "service", "srv")


@silent
def action_types(ctx: typer.Context) -> Iterable[str]:
    """Complete the type of the action earlier on the line; all action types if it does not exist."""
    return _types_of_name(ctx, "action", "action")


def _types_of_name(ctx: typer.Context, what: str, kind: str) -> list[str]:
    """Return the type of the service or action earlier on the line; if it does not exist, all types of that kind."""
    from simkit.msgs.interface_definitions import interface_names

    name = ctx.params.get(what)
    if name:
        with connect_client(ctx) as client:
            types = client.services() if what == "service" else client.actions()
        if absolute_name(name) in types:
            return [types[absolute_name(name)]]
    return interface_names(kind)


@silent
def frames(ctx: typer.Context) -> Iterable[str]:
    """Complete frames that arrive on /tf within half a second."""
    from simkit.cli.terminal.frame_tree import receive_transforms
    from simkit.msgs.transform_tree import TransformTree

    with open_topics(ctx) as source:
        tree = TransformTree()
        for _ in receive_transforms(source, tree, duration=_TF_DURATION):
            pass
    return tree.frames()
