"""Topics on which two plugins, or a plugin and a sensor, do not mean the same."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from simkit.diagnostics import NOWHERE, Diagnostics, Where
from simkit.runtime.communication.publisher import Listener, Publisher

Side = tuple[str, Publisher | Listener, tuple[str, ...], str]
"""Topic, publisher or listener, its types and what it does ("publishes" or "takes")."""


@dataclass(frozen=True, slots=True)
class TopicEndpoint:
    """One end of a topic.

    Attributes:
        name: whose, in words.
        where: file and line.
        does: "publishes" or "takes".
        types: ROS types: the one it publishes, or those that it takes.
        is_plugin: whether it is a plugin's.
        owner: whose it is.
    """

    name: str
    where: Where
    does: str
    types: tuple[str, ...]
    is_plugin: bool
    owner: object


def report_topic_conflicts(
    sides: Iterable[Side], diagnostics: Diagnostics, newcomers: Iterable[object] | None = None
) -> None:
    """Tells of topics that a plugin shares with a plugin or a sensor and that have two types there: ROS knows one.

    A plugin that publishes what a sensor publishes too is told of where both types are the same.

    Args:
        sides: publishers and listeners of everything that is at work.
        diagnostics: where it is told.
        newcomers: the plugins and sensors that are new; without them all are.
    """
    new = None if newcomers is None else {id(one) for one in newcomers}
    for topic, ends in _endpoints_by_topic(sides).items():
        if len(ends) > 1:
            _report_conflicts(topic, ends, diagnostics, new)


def find_conflict(sides: Iterable[Side], topic: str, end: Publisher | Listener) -> str:
    """What is wrong with one more end of a topic; empty where nothing is."""
    new = _endpoint(end, (end.type_name,) if hasattr(end, "type_name") else end.types, "")
    for _, other, types, does in sides:
        is_others = other.active and other.owner is not None and other.owner is not end.owner
        if is_others and not set(types) & set(new.types):
            old = _endpoint(other, types, does)
            if new.is_plugin or old.is_plugin:
                wants = f"{new.name} ({new.where}) wants {' or '.join(new.types)} on {topic!r}"
                return f"{wants}, where {_describe_use(old)} ({old.where})"
    return ""


def _report_conflicts(topic: str, ends: list[TopicEndpoint], diagnostics: Diagnostics, new: set[int] | None) -> None:
    told: set[tuple[int, int]] = set()
    for number, end in enumerate(ends):
        for other in ends[:number]:
            pair = id(other.owner), id(end.owner)
            is_new = new is None or bool(new & set(pair))
            if pair in told or not is_new or not (end.is_plugin or other.is_plugin) or pair[0] == pair[1]:
                continue
            if not set(end.types) & set(other.types):
                told.add(pair)
                _report_type_conflict(topic, other, end, diagnostics)
            elif end.does == other.does == "publishes" and end.is_plugin != other.is_plugin:
                told.add(pair)
                message = f"{_describe_use(end)} on {topic!r}, and so does {other.name} ({other.where})"
                hint = "a reader gets both in turn; give one of them a topic of its own"
                diagnostics.warning("SK-TOPIC-006", message, end.where, hint)


def _report_type_conflict(topic: str, one: TopicEndpoint, other: TopicEndpoint, diagnostics: Diagnostics) -> None:
    message = f"{_describe_use(other)} on {topic!r}, where {_describe_use(one)} ({one.where})"
    hint = "ROS gives a topic one type; give one of them a topic of its own, as by a remapping or a namespace"
    diagnostics.error("SK-TOPIC-001", message, other.where, hint)


def _describe_use(end: TopicEndpoint) -> str:
    return f"{end.name} {end.does} {' or '.join(end.types)}"


def _endpoints_by_topic(sides: Iterable[Side]) -> dict[str, list[TopicEndpoint]]:
    found: dict[str, list[TopicEndpoint]] = {}
    for topic, end, types, does in sides:
        if end.active and end.owner is not None:
            found.setdefault(topic, []).append(_endpoint(end, types, does))
    return found


def _endpoint(end: Publisher | Listener, types: tuple[str, ...], does: str) -> TopicEndpoint:
    owner = end.owner
    scene = getattr(owner, "scene", None)  # a sensor's
    name = getattr(owner, "scoped", "") if scene is not None else getattr(owner, "name", "")
    where = getattr(scene if scene is not None else owner, "where", NOWHERE)
    what = "sensor" if scene is not None else "plugin"
    return TopicEndpoint(f"{what} {name!r}", where, does, types, scene is None, owner)
