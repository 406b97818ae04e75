"""Shell completion with names from the running simulation or the bag.

Typer passes the incomplete command line to each function. The parameters of its context are the words before the
completed word.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from simkit.cli.terminal.output import absolute_name

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

    from simkit.cli.terminal.topic_sources import Source
    from simkit.live import Client

Completer = Callable[[typer.Context, str], list[str]]
"""Function that returns the completions of an incomplete word."""
_TIMEOUT = 1.0  # [s] of wall time that a shell waits at most
_INCOMPLETE = __name__  # key of the incomplete word in the context's meta


def _silent(complete: Callable[[typer.Context], Iterable[str]]) -> Completer:
    """Return a completer that offers nothing after an error, because an error message would disturb the prompt."""

    def matching_names(ctx: typer.Context, incomplete: str) -> list[str]:
        try:
            ctx.meta[_INCOMPLETE] = incomplete
            return [name for name in complete(ctx) if name.startswith(incomplete)]
        except Exception:  # noqa: BLE001
            return []

    return matching_names


@contextmanager
def _client(ctx: typer.Context) -> Iterator[Client]:
    from simkit.live import connect

    with connect(ctx.params.get("sim") or os.environ.get("SIMKIT_SIM"), timeout=_TIMEOUT) as client:
        yield client


@contextmanager
def _source(ctx: typer.Context) -> Iterator[Source]:
    from simkit.cli.terminal.topic_sources import BagSource, LiveSource
    from simkit.recording.bags.reader import open_bag_to_read

    bag = ctx.params.get("bag")
    if bag is not None:
        with open_bag_to_read(Path(bag)) as reader:
            yield BagSource(reader)
        return
    with _client(ctx) as client:
        yield LiveSource(client)


def _topic_before(ctx: typer.Context) -> str:
    """Return the topic earlier on the line. While an option's value is completed, click has the topic in `args`."""
    found = ctx.params.get("topic") or next((word for word in ctx.args if not word.startswith("-")), "")
    return absolute_name(found) if found else ""


_WORLD_SUFFIXES = (".sdf", ".world", ".urdf", ".xacro", ".xml", ".model", ".mjcf")
_SCENARIO_SUFFIXES = (".yaml", ".yml", ".py")


@_silent
def worlds(ctx: typer.Context) -> Iterable[str]:
    """Complete names of bundled worlds and models, and world and model files."""
    return _worlds_and_files(ctx, _WORLD_SUFFIXES)


@_silent
def scenarios(ctx: typer.Context) -> Iterable[str]:
    """Complete the same names as `worlds`, and scenario files."""
    return _worlds_and_files(ctx, _WORLD_SUFFIXES + _SCENARIO_SUFFIXES)


def _worlds_and_files(ctx: typer.Context, suffixes: tuple[str, ...]) -> list[str]:
    from simkit.loaders.resources.bundled_models import bundled_names

    incomplete = ctx.meta[_INCOMPLETE]
    return list(dict.fromkeys([*bundled_names(), *_files(incomplete, suffixes)]))


def _files(incomplete: str, suffixes: tuple[str, ...]) -> list[str]:
    """Return the files and folders that begin with `incomplete`.

    A single folder is replaced by its content, because a shell ends a single completion with a space.
    """
    base, _, beginning = incomplete.rpartition("/")
    folder = f"{base}/" if "/" in incomplete else ""
    found: list[str] = []
    with os.scandir(folder or ".") as entries:
        for entry in entries:
            is_folder = entry.is_dir()
            if not entry.name.startswith(beginning) or (entry.name.startswith(".") and not beginning):
                continue
            if is_folder or entry.name.lower().endswith(suffixes):
                found.append(f"{folder}{entry.name}/" if is_folder else f"{folder}{entry.name}")
    if len(found) == 1 and found[0].endswith("/") and found[0] != incomplete:
        return _files(found[0], suffixes) or found
    return sorted(found)


@_silent
def simulations(_: typer.Context) -> Iterable[str]:
    """Complete names of running simulations."""
    from simkit.live import simulations as running

    return [found.name for found in running()]


@_silent
def topics(ctx: typer.Context) -> Iterable[str]:
    """Complete topics, with or without the leading slash."""
    with _source(ctx) as source:
        names = list(source.topics())
    incomplete = ctx.meta[_INCOMPLETE]
    return names if incomplete.startswith("/") or not incomplete else [n.removeprefix("/") for n in names]


@_silent
def topic_types(ctx: typer.Context) -> Iterable[str]:
    """Complete types of the topic earlier on the line; all message types for a topic that does not exist yet."""
    from simkit.msgs.interface_definitions import interface_names

    topic = _topic_before(ctx)
    if topic:
        with _source(ctx) as source:
            found = source.topics().get(topic)
        if found is not None:
            subscribed_types = [t for end in found.subscribers for t in end.types]
            return dict.fromkeys([*found.types, *subscribed_types])
    return interface_names("msg")


@_silent
def message_types(_: typer.Context) -> Iterable[str]:
    """Complete message types."""
    from simkit.msgs.interface_definitions import interface_names

    return interface_names("msg")


@_silent
def interfaces(_: typer.Context) -> Iterable[str]:
    """Complete message, service and action types."""
    from simkit.msgs.interface_definitions import interface_names

    return [name for kind in ("msg", "srv", "action") for name in interface_names(kind)]


@_silent
def fields(ctx: typer.Context) -> Iterable[str]:
    """Complete field paths of the topic earlier on the line, one level at a time."""
    from simkit.msgs.message_text import field_nodes

    with _source(ctx) as source:
        entry = source.topics()[_topic_before(ctx)]
        type_name = entry.types[0]
        store = source.store(type_name)
        before, _, _ = ctx.meta[_INCOMPLETE].rpartition(".")
        for name in before.split(".") if before else ():
            node = dict(field_nodes(_full_type_name(type_name, store), store))[name.partition("[")[0]]
            while int(node[0]) in (3, 4):
                node = node[1][0]
            type_name = node[1]
        found = field_nodes(_full_type_name(type_name, store), store)
    return [f"{before}.{name}" if before else name for name, _ in found]


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

    return _silent(prototypes)


message_values = _prototype_of("message_type")
service_values = _prototype_of("service_type")
goal_values = _prototype_of("action_type")


def _of_client(names: Callable[[Client, typer.Context], Iterable[str]]) -> Completer:
    """Return a completer that offers names from a running simulation."""

    def client_names(ctx: typer.Context) -> Iterable[str]:
        with _client(ctx) as client:
            return list(names(client, ctx))

    return _silent(client_names)


def _nodes_with_parameters(client: Client, _: typer.Context) -> list[str]:
    from simkit.cli.terminal.topic_sources import parameter_nodes

    return parameter_nodes(client)


def _lifecycle_nodes(client: Client, _: typer.Context) -> list[str]:
    from simkit.cli.terminal.topic_sources import lifecycle_node_names

    return lifecycle_node_names(client)


def _transitions_of_node(client: Client, ctx: typer.Context) -> Iterable[str]:
    """Return the transitions that are possible for the node earlier on the line."""
    name = absolute_name(str(ctx.params.get("node") or ""))
    return [t.transition.label for t in client.call(f"{name}/get_available_transitions").available_transitions]


def _all_nodes(client: Client, _: typer.Context) -> list[str]:
    from simkit.cli.terminal.topic_sources import node_names

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


@_silent
def service_types(ctx: typer.Context) -> Iterable[str]:
    """Complete the type of the service earlier on the line; all service types if it does not exist."""
    return _types_of_name(ctx, "service", "srv")


@_silent
def action_types(ctx: typer.Context) -> Iterable[str]:
    """Complete the type of the action earlier on the line; all action types if it does not exist."""
    return _types_of_name(ctx, "action", "action")


def _types_of_name(ctx: typer.Context, what: str, kind: str) -> list[str]:
    """Return the type of the service or action earlier on the line; if it does not exist, all types of that kind."""
    from simkit.msgs.interface_definitions import interface_names

    name = ctx.params.get(what)
    if name:
        with _client(ctx) as client:
            types = client.services() if what == "service" else client.actions()
        if absolute_name(name) in types:
            return [types[absolute_name(name)]]
    return interface_names(kind)


@_silent
def frames(ctx: typer.Context) -> Iterable[str]:
    """Complete frames that arrive on /tf within half a second."""
    from simkit.cli.terminal.frame_tree import receive_transforms
    from simkit.msgs.transform_tree import TransformTree

    with _source(ctx) as source:
        found = TransformTree()
        for _ in receive_transforms(source, found, duration=_TIMEOUT / 2):
            pass
    return found.frames()
