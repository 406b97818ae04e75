"""Boxes and edges of the graph of nodes and topics, and of the tree of frames."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final

from simkit.msgs.topic_names import is_hidden
from simkit.msgs.transform_tree import TransformTree
from simkit.number_text import counted
from simkit.recording.graphs.graph_svg import GraphBox, GraphEdge
from simkit.run_spec import JsonObject

_OWN_NODES: Final = frozenset(
    {"/ClassicServices", "/ClockPublisher", "/SimulationInterfaces", "/WorldServices", "/WorldStats"}
)
_OWN_TOPICS: Final = frozenset({"/clock", "/parameter_events", "/rosout"})
_LISTED: Final = 4  # services and actions in the box of a node


def node_graph(nodes: Mapping[str, JsonObject], *, hidden: bool) -> tuple[list[GraphBox], list[GraphEdge]]:
    """Return the graph of nodes and topics.

    Args:
        nodes: nodes with their publishers, subscribers, services and actions, as a simulation describes them.
        hidden: True includes hidden names and the nodes of simkit itself.
    """

    def shown(names: Mapping[str, list[str]]) -> dict[str, list[str]]:
        return {n: t for n, t in names.items() if hidden or not (is_hidden(n) or n in _OWN_TOPICS)}

    boxes: dict[str, GraphBox] = {}
    edges: dict[tuple[str, str], GraphEdge] = {}
    types: dict[str, str] = {}
    for name, node in nodes.items():
        if not hidden and (name in _OWN_NODES or is_hidden(name)):
            continue
        publishes, subscribes = shown(node["publishers"]), shown(node["subscribers"])
        actions, services = shown(node["actions"]), shown(node["services"])
        if not (publishes or subscribes or actions or services):
            continue
        space, _, last = name.rpartition("/")
        lines = [*_listed("action", actions), *_listed("service", services)]
        boxes[f"node {name}"] = GraphBox(f"node {name}", "node", last, lines, space)
        for topic, topic_types in (*publishes.items(), *subscribes.items()):
            types.setdefault(topic, topic_types[0].replace("/msg/", "/") if topic_types else "")
        for topic in publishes:
            edges[name, topic] = GraphEdge(f"node {name}", f"topic {topic}")
        for topic in subscribes:
            edges[topic, name] = GraphEdge(f"topic {topic}", f"node {name}")
    for topic, type_name in sorted(types.items()):
        boxes[f"topic {topic}"] = GraphBox(f"topic {topic}", "topic", topic, [type_name] if type_name else [])
    return list(boxes.values()), list(edges.values())


def _listed(kind: str, names: Iterable[str]) -> list[str]:
    """Return a line for each of the first names, and one for the number of the others."""
    sorted_names = sorted(names)
    lines = [f"{kind} {name}" for name in sorted_names[:_LISTED]]
    more = len(sorted_names) - _LISTED
    return lines + ([f"and {counted(more, f'more {kind}')}"] if more > 0 else [])


def frame_graph(frames: TransformTree) -> tuple[list[GraphBox], list[GraphEdge]]:
    """Return the tree of frames; dashed edges are static transforms."""
    parents = frames.frames()
    boxes = [GraphBox(name, "frame", name) for name in parents]
    edges = [GraphEdge(parent, child, frames.is_static(child)) for child, parent in sorted(parents.items()) if parent]
    return boxes, edges
