"""Functions that read the world: where things are, how they move, what came on topics."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from simkit.conditions.faults import Undecided
from simkit.conditions.function import Function, text_argument
from simkit.conditions.kinds import JOINT, NUMBER, POSE, SCAN, TEXT, TRUTH, TWIST, VECTOR, is_pose_like, message
from simkit.conditions.parts import Part
from simkit.conditions.syntax import Call, Node, Text
from simkit.conditions.vectors import as_pose, as_vector
from simkit.pose import quat_conjugate, quat_rotate

if TYPE_CHECKING:
    from simkit.conditions.binding import Binder
    from simkit.conditions.view import Thing
    from simkit.pose import Vector

_THING = "the name of a model or a link"


def thing(binder: Binder, call: Call, place: int) -> Thing:
    """A model or a link that an argument names."""
    node = text_argument(binder, call, place, _THING)
    return binder.view.thing(node.value, binder.source, node.span)


def _pose(binder: Binder, call: Call) -> Part:
    one = thing(binder, call, 0)
    if len(call.arguments) == 1:
        return Part(call, POSE, one.pose)
    frame = thing(binder, call, 1)
    return Part(call, POSE, lambda: frame.pose().inverse() @ one.pose())


def _in_axes(frame: Thing, vector: Vector) -> Vector:
    return quat_rotate(quat_conjugate(frame.pose().quaternion), vector)


def _twist(binder: Binder, call: Call) -> Part:
    one = thing(binder, call, 0)
    if len(call.arguments) == 1:
        return Part(call, TWIST, one.twist)
    frame = thing(binder, call, 1)

    def value() -> tuple[Vector, Vector]:
        linear, angular = one.twist()
        return _in_axes(frame, linear), _in_axes(frame, angular)

    return Part(call, TWIST, value)


def _velocity(binder: Binder, call: Call) -> Part:
    one = thing(binder, call, 0)
    if len(call.arguments) == 1:
        return Part(call, VECTOR, lambda: one.twist()[0])
    frame = thing(binder, call, 1)
    return Part(call, VECTOR, lambda: _in_axes(frame, one.twist()[0]))


def _joint(binder: Binder, call: Call) -> Part:
    node = text_argument(binder, call, 0, "the name of a joint")
    joint = binder.view.joint(node.value, binder.source, node.span)
    entities, name = binder.view.sim.entities, joint.scoped
    # another may come in the place of one that was removed
    return Part(call, JOINT, lambda: entities.tables["joint"].get(name, joint))


def _exists(binder: Binder, call: Call) -> Part:
    name = text_argument(binder, call, 0, _THING).value
    entities = binder.view.sim.entities
    return Part(call, TRUTH, lambda: any(name in entities.tables[kind] for kind in ("model", "link")))


# ------------------------------------------------------------------ distances


def _distance(binder: Binder, call: Call) -> Part:
    gets, parts = [], []
    for node in call.arguments:
        part = binder.part(node)
        gets.append(_place(binder, node, part))
        parts.append(part)
    first, second = gets
    source = call.span.text(binder.source)

    def value() -> float:
        a, b = first(), second()
        if len(a) != len(b):
            raise Undecided(f"{source} has lists of {len(a)} and of {len(b)} numbers")
        gap = a - b
        return math.sqrt(float(gap.dot(gap)))

    return Part(call, NUMBER, value, tuple(parts))


def _place(binder: Binder, node: Node, part: Part) -> Callable[[], Any]:
    """What gives the point that an argument means."""
    if part.kind is TEXT and isinstance(node, Text):
        named = binder.view.thing(node.value, binder.source, node.span)
        return lambda: named.pose().position
    if is_pose_like(part.kind):
        pose = as_pose(part)
        return lambda: pose().position
    if part.kind is NUMBER or not _has_vector(part):
        text = node.span.text(binder.source)
        hint = "distance takes poses, vectors, and names of models and links in quotes"
        raise binder.fault("SK-COND-004", f"{text} is {part.kind}, which is no place", node.span, hint)
    return as_vector(part)


def _has_vector(part: Part) -> bool:
    from simkit.conditions.kinds import is_vector_like

    return is_vector_like(part.kind)


# ------------------------------------------------------------------ topics


def _topic_argument(binder: Binder, call: Call) -> tuple[str, str, Text]:
    node = text_argument(binder, call, 0, "a topic")
    topic, type_name = binder.view.topic(node.value, binder.source, node.span)
    return topic, type_name, node


def _topic(binder: Binder, call: Call) -> Part:
    topic, type_name, _ = _topic_argument(binder, call)
    feed = binder.view.feed(topic)
    return Part(call, message(type_name), feed.latest, feed=feed)


def _scan(binder: Binder, call: Call) -> Part:
    _, type_name, node = _topic_argument(binder, call)
    if type_name != SCAN:
        text = f"{node.value!r} carries {type_name}, and scan reads {SCAN}"
        raise binder.fault("SK-COND-004", text, node.span, f"topic('{node.value}') reads any message")
    return _topic(binder, call)


def _count(binder: Binder, call: Call) -> Part:
    tally = binder.view.tally(_topic_argument(binder, call)[0])
    return Part(call, NUMBER, lambda: float(tally.count))


def _rate(binder: Binder, call: Call) -> Part:
    topic = _topic_argument(binder, call)[0]
    tally = binder.view.tally(topic)

    def value() -> float:
        rate = tally.rate()
        if rate is None:
            raise Undecided(f"fewer than two messages have come on {topic}")
        return rate

    return Part(call, NUMBER, value)


def _age(binder: Binder, call: Call) -> Part:
    topic = _topic_argument(binder, call)[0]
    tally, sim = binder.view.tally(topic), binder.view.sim

    def value() -> float:
        if not tally.count:
            raise Undecided(f"no message has come on {topic}")
        return (sim.time_ns - tally.last) / 1e9

    return Part(call, NUMBER, value)


WORLD_FUNCTIONS: Final[dict[str, Function]] = {
    "pose": Function("pose('model or link'[, 'seen from'])", 1, 2, _pose),
    "twist": Function("twist('model or link'[, 'axes of'])", 1, 2, _twist),
    "velocity": Function("velocity('model or link'[, 'axes of'])", 1, 2, _velocity),
    "joint": Function("joint('model::joint').position", 1, 1, _joint),
    "exists": Function("exists('model or link')", 1, 1, _exists),
    "distance": Function("distance(a, b)", 2, 2, _distance),
    "topic": Function("topic('/topic').field", 1, 1, _topic),
    "scan": Function("scan('/scan')", 1, 1, _scan),
    "count": Function("count('/topic')", 1, 1, _count),
    "rate": Function("rate('/topic')", 1, 1, _rate),
    "age": Function("age('/topic')", 1, 1, _age),
}
