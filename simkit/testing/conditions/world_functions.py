"""Functions that read the world: poses, velocities, topics and contacts."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from simkit.pose import Vector, quat_conjugate, quat_rotate
from simkit.testing.conditions import value_types as kinds
from simkit.testing.conditions.bound_expression import (
    BindFunction,
    BoundNode,
    ExpressionBinder,
    Function,
    NotInRows,
    ValueGetter,
    as_pose,
    as_vector,
    quoted_argument,
)
from simkit.testing.conditions.math_functions import length
from simkit.testing.conditions.syntax_tree import Call, Node, Text, UndecidedValue

if TYPE_CHECKING:
    from simkit.testing.conditions.world_view import Contacts, Entity


_ENTITY_ARGUMENT = "the name of a model or a link"
_VELOCITY_FUNCTIONS: Final = ("twist", "velocity")


def entity_argument(binder: ExpressionBinder, call: Call, index: int) -> Entity:
    """Return the model or link that an argument names."""
    node = quoted_argument(binder, call, index, _ENTITY_ARGUMENT)
    return binder.view.entity(node.value, binder.source, node.span, moves=call.name in _VELOCITY_FUNCTIONS)


def _bind_relative(
    kind: kinds.ValueType, in_world: Callable[[Entity], object], seen: Callable[[Entity, Entity], object]
) -> BindFunction:
    """Return a function that reads a value of a model or link, in the world or relative to a second model or link."""

    def make(binder: ExpressionBinder, call: Call) -> BoundNode:
        entity = entity_argument(binder, call, 0)
        if len(call.arguments) == 1:
            return BoundNode(call, kind, lambda: in_world(entity))
        if binder.in_rows:
            raise NotInRows
        frame = entity_argument(binder, call, 1)
        return BoundNode(call, kind, lambda: seen(frame, entity))

    return make


def _in_axes(frame: Entity, vector: Vector) -> Vector:
    return quat_rotate(quat_conjugate(frame.pose().quaternion), vector)


def _twist_in(frame: Entity, one: Entity) -> tuple[Vector, Vector]:
    linear, angular = one.twist()
    return _in_axes(frame, linear), _in_axes(frame, angular)


_pose = _bind_relative(kinds.POSE, lambda one: one.pose(), lambda frame, one: frame.pose().inverse() @ one.pose())
_twist = _bind_relative(kinds.TWIST, lambda one: one.twist(), _twist_in)
_velocity = _bind_relative(kinds.VECTOR, lambda one: one.twist()[0], lambda frame, one: _in_axes(frame, one.twist()[0]))


def _joint(binder: ExpressionBinder, call: Call) -> BoundNode:
    node = quoted_argument(binder, call, 0, "the name of a joint")
    joint = binder.view.joint(node.value, binder.source, node.span)
    # look up the name again, because a new joint may have it after the first one was removed
    return BoundNode(call, kinds.JOINT, lambda: binder.view.current_joint(joint))


def _exists(binder: ExpressionBinder, call: Call) -> BoundNode:
    name = quoted_argument(binder, call, 0, _ENTITY_ARGUMENT).value
    return BoundNode(call, kinds.TRUTH, binder.view.existence(name))


# ------------------------------------------------------------------ distances


def _distance(binder: ExpressionBinder, call: Call) -> BoundNode:
    gets, parts = [], []
    for node in call.arguments:
        part = binder.part(node)
        gets.append(_point_argument(binder, node, part))
        parts.append(part)
    first, second = gets
    source = call.span.text(binder.source)

    def value() -> float | Vector:
        a, b = first(), second()
        if a.shape[-1] != b.shape[-1]:
            raise UndecidedValue(f"{source} compares lists of {a.shape[-1]} and {b.shape[-1]} numbers")
        return length(a - b)

    return BoundNode(call, kinds.NUMBER, value, tuple(parts))


def _point_argument(binder: ExpressionBinder, node: Node, part: BoundNode) -> ValueGetter:
    """Return a function that gets the point that an argument describes."""
    if part.kind is kinds.TEXT and isinstance(node, Text):
        entity = binder.view.entity(node.value, binder.source, node.span)
        return lambda: entity.pose().position
    if kinds.is_pose_like(part.kind):
        pose = as_pose(part)
        return lambda: pose().position
    if part.kind is kinds.NUMBER or not kinds.is_vector_like(part.kind):
        text = node.span.text(binder.source)
        hint = "distance accepts poses, vectors, and quoted names of models and links"
        raise binder.fault("SK-COND-004", f"{text} is {part.kind}, which is not a point", node.span, hint)
    return as_vector(part)


# ------------------------------------------------------------------ topics


def _topic_argument(binder: ExpressionBinder, call: Call) -> tuple[str, str, Text]:
    node = quoted_argument(binder, call, 0, "a topic")
    topic, type_name = binder.view.topic(node.value, binder.source, node.span)
    return topic, type_name, node


def _topic(binder: ExpressionBinder, call: Call) -> BoundNode:
    topic, type_name, _ = _topic_argument(binder, call)
    feed = binder.view.latest_message(topic)
    return BoundNode(call, kinds.message_type(type_name), feed.latest, feed=feed)


def _scan(binder: ExpressionBinder, call: Call) -> BoundNode:
    _, type_name, node = _topic_argument(binder, call)
    if type_name != kinds.SCAN:
        text = f"{node.value!r} has type {type_name}, but scan reads {kinds.SCAN}"
        raise binder.fault("SK-COND-004", text, node.span, f"topic('{node.value}') reads any message")
    return _topic(binder, call)


def _count(binder: ExpressionBinder, call: Call) -> BoundNode:
    counter = binder.view.message_counter(_topic_argument(binder, call)[0])
    return BoundNode(call, kinds.NUMBER, lambda: float(counter.count))


def _rate(binder: ExpressionBinder, call: Call) -> BoundNode:
    topic = _topic_argument(binder, call)[0]
    counter = binder.view.message_counter(topic)

    def value() -> float:
        rate = counter.rate()
        if rate is None:
            raise UndecidedValue(f"fewer than two messages received on {topic}")
        return rate

    return BoundNode(call, kinds.NUMBER, value)


def _age(binder: ExpressionBinder, call: Call) -> BoundNode:
    topic = _topic_argument(binder, call)[0]
    counter, clock = binder.view.message_counter(topic), binder.view.clock

    def value() -> float:
        if not counter.count:
            raise UndecidedValue(f"no message received on {topic}")
        return (clock.time_ns - counter.last) / 1e9

    return BoundNode(call, kinds.NUMBER, value)


def contact_query(binder: ExpressionBinder, call: Call) -> Contacts:
    """Return the contacts of the models, links or collisions that the arguments name."""
    nodes = [quoted_argument(binder, call, index, _ENTITY_ARGUMENT) for index in range(len(call.arguments))]
    names = [binder.view.scoped_name(node.value, binder.source, node.span) for node in nodes]
    return binder.view.contacts(*names)


def _contact(binder: ExpressionBinder, call: Call) -> BoundNode:
    touching = contact_query(binder, call)

    def contact_details() -> str:
        pairs = touching.describe()
        return f" ({pairs})" if pairs else ""

    if binder.in_rows:
        return BoundNode(call, kinds.TRUTH, touching.now)
    return BoundNode(call, kinds.TRUTH, lambda: bool(touching.now()), tell=contact_details)


def _contacts(binder: ExpressionBinder, call: Call) -> BoundNode:
    touching = contact_query(binder, call)
    return BoundNode(call, kinds.NUMBER, lambda: float(len(touching.now())))


def _contact_force(binder: ExpressionBinder, call: Call) -> BoundNode:
    return BoundNode(call, kinds.NUMBER, contact_query(binder, call).force)


WORLD_FUNCTIONS: Final[dict[str, Function]] = {
    "pose": Function("pose('model or link'[, 'seen from'])", 1, 2, _pose, has_rows=True),
    "twist": Function("twist('model or link'[, 'axes of'])", 1, 2, _twist, has_rows=True),
    "velocity": Function("velocity('model or link'[, 'axes of'])", 1, 2, _velocity, has_rows=True),
    "joint": Function("joint('model::joint').position", 1, 1, _joint, has_rows=True),
    "exists": Function("exists('model or link')", 1, 1, _exists),
    "distance": Function("distance(a, b)", 2, 2, _distance, has_rows=True),
    "topic": Function("topic('/topic').field", 1, 1, _topic),
    "scan": Function("scan('/scan')", 1, 1, _scan),
    "count": Function("count('/topic')", 1, 1, _count),
    "rate": Function("rate('/topic')", 1, 1, _rate),
    "age": Function("age('/topic')", 1, 1, _age),
    "contact": Function("contact('model or link'[, 'another'])", 1, 2, _contact, has_rows=True),
    "contacts": Function("contacts('model or link'[, 'another'])", 1, 2, _contacts),
    "contact_force": Function("contact_force('model or link'[, 'another'])", 1, 2, _contact_force),
}
