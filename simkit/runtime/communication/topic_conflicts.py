"""Conflicts of two plugins, or a plugin and a sensor, on one topic."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from simkit.diagnostics import NOWHERE, Diagnostics, Where
from simkit.runtime.communication.publisher import Listener, Publisher

Side = tuple[str, Publisher | Listener, tuple[str, ...], str]
"""Topic, publisher or listener, ROS types, and "publishes" or "takes"."""


@dataclass(frozen=True, slots=True)
class TopicEndpoint:
    """Publisher or listener of a topic.

    Attributes:
        name: kind and name of the owner.
        where: file and line of the owner.
        does: "publishes" or "takes".
        types: ROS types that are published or accepted.
        is_plugin: True if the owner is a plugin.
        owner: plugin or sensor.
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
    """Report each topic on which a plugin uses another type than another plugin or a sensor.

    A ROS topic has only one type. If a plugin and a sensor publish on one topic, the topic is reported even if their
    types are equal.

    Args:
        sides: publishers and listeners of all enabled sensors and plugins.
        diagnostics: collection for the reports.
        newcomers: new plugins and sensors; None if all are new.
    """
    new = None if newcomers is None else {id(owner) for owner in newcomers}
    for topic, ends in _endpoints_by_topic(sides).items():
        if len(ends) > 1:
            _report_conflicts(topic, ends, diagnostics, new)


def find_conflict(sides: Iterable[Side], topic: str, end: Publisher | Listener) -> str:
    """Return the text of the conflict that a new publisher or listener of a topic causes; empty without one."""
    new = _endpoint(end, (end.type_name,) if hasattr(end, "type_name") else end.types, "")
    for _, other, types, does in sides:
        is_foreign = other.active and other.owner is not None and other.owner is not end.owner
        if is_foreign and not set(types) & set(new.types):
            old = _endpoint(other, types, does)
            if new.is_plugin or old.is_plugin:
                use = f"{new.name} ({new.where}) uses {' or '.join(new.types)} on {topic!r}"
                return f"{use}, but {_describe_use(old)} ({old.where})"
    return ""


def _report_conflicts(topic: str, ends: list[TopicEndpoint], diagnostics: Diagnostics, new: set[int] | None) -> None:
    reported: set[tuple[int, int]] = set()
    for number, end in enumerate(ends):
        for other in ends[:number]:
            pair = id(other.owner), id(end.owner)
            is_new = new is None or bool(new & set(pair))
            if pair in reported or not is_new or not (end.is_plugin or other.is_plugin) or pair[0] == pair[1]:
                continue
            if not set(end.types) & set(other.types):
                reported.add(pair)
                _report_type_conflict(topic, other, end, diagnostics)
            elif end.does == other.does == "publishes" and end.is_plugin != other.is_plugin:
                reported.add(pair)
                message = f"{_describe_use(end)} on {topic!r}, and so does {other.name} ({other.where})"
                hint = "a subscriber receives both in turn; give one of them a topic of its own"
                diagnostics.warning("SK-TOPIC-006", message, end.where, hint)


def _report_type_conflict(topic: str, first: TopicEndpoint, second: TopicEndpoint, diagnostics: Diagnostics) -> None:
    message = f"{_describe_use(second)} on {topic!r}, but {_describe_use(first)} ({first.where})"
    hint = "a ROS topic has one type; give one of them a topic of its own, for example by a remapping or a namespace"
    diagnostics.error("SK-TOPIC-001", message, second.where, hint)


def _describe_use(end: TopicEndpoint) -> str:
    return f"{end.name} {end.does} {' or '.join(end.types)}"


def _endpoints_by_topic(sides: Iterable[Side]) -> dict[str, list[TopicEndpoint]]:
    by_topic: dict[str, list[TopicEndpoint]] = {}
    for topic, end, types, does in sides:
        if end.active and end.owner is not None:
            by_topic.setdefault(topic, []).append(_endpoint(end, types, does))
    return by_topic


def _endpoint(end: Publisher | Listener, types: tuple[str, ...], does: str) -> TopicEndpoint:
    owner = end.owner
    scene = getattr(owner, "scene", None)  # only sensors have one
    name = getattr(owner, "scoped", "") if scene is not None else getattr(owner, "name", "")
    where = getattr(scene if scene is not None else owner, "where", NOWHERE)
    kind = "sensor" if scene is not None else "plugin"
    return TopicEndpoint(f"{kind} {name!r}", where, does, types, scene is None, owner)
