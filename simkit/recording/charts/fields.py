"""Resolve names of message fields, as on a command line, to functions that read their numbers.

`/odom.pose.pose.position.x`, `/scan.ranges[0]`, `/joint_states.position[left_wheel]`,
`/odom.pose.pose.orientation.yaw`. What a path names is looked up in the definitions of the
types, so that a wrong one is told before anything runs.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError
from simkit.msgs.message_text import NUMBER_CODES, field_nodes, field_value
from simkit.msgs.message_types import ARRAY, BASE, NAME, SEQUENCE, FieldNode, FieldValue, Message

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

    from simkit.msgs import Quaternion, Time

Number = Callable[[FieldValue], float]
Reader = Callable[[FieldValue], FieldValue]
"""Reads a value of a message."""
Unit = Callable[[str, str], str]

MOST_CURVES: Final = 64
_STEP = re.compile(r"[./]?(?:(\w+)|\[([^\[\]]*)\])")
_COMPUTED = re.compile(r"\[[^\]]*\]|\.(norm|min|max|mean)$")
_SPREAD: Final = 12  # items of an array of fixed length that are all meant where none is named
_ANGLES: Final = ("roll", "pitch", "yaw")
_OF_ARRAYS: Final = ("min", "max", "mean", "length")
_NAMES: Final = ("name", "names", "joint_names")  # of arrays that name the items of those beside them
_NAMED: Final = ("child_frame_id", "name", "id")  # of messages in an array


@dataclass(frozen=True)
class Curve:
    """A number of every message of a topic.

    Attributes:
        topic: the topic.
        path: of the field, each item by itself.
        read: takes the number out of a message; NaN where a message has none.
        unit: SI; empty where none is known.
        is_angle: whether it comes back to where it began after a turn.
        type_name: of the messages; those of another type on the same topic have none.
    """

    topic: str
    path: str
    read: Number
    unit: str = ""
    is_angle: bool = False
    type_name: str = ""

    @property
    def label(self) -> str:
        """Topic and field."""
        return f"{self.topic}.{self.path}"


@dataclass(frozen=True)
class _PathStep:
    """One step of a path: the type at its end and a function that reads it; `before` reads the message around it."""

    node: FieldNode
    read: Reader
    path: str
    owner: str
    before: Reader


def _no_unit(_type_name: str, _path: str) -> str:
    return ""


def curves_of(
    text: str, topics: Mapping[str, str], store_of: Callable[[str], Typestore], where: str, unit_of: Unit = _no_unit
) -> list[Curve]:
    """The curves that a field stands for: several, where it is a vector or a part of an array.

    Args:
        text: topic and field.
        topics: topic -> type of all there are.
        store_of: the definitions that a type is read by.
        where: what has these topics, for messages.
        unit_of: the unit of a field of a type.

    Raises:
        InputError: SK-CLI-030 there is no such topic; SK-CLI-033 its messages have no such field; SK-BAG-010 the field
            is no number.
    """
    topic, rest = _split_topic(text, topics, where)
    type_name = topics[topic]
    walk = _FieldPath(store_of(type_name), type_name, text)
    return [
        replace(
            curve,
            topic=topic,
            type_name=type_name,
            unit=curve.unit or unit_of(type_name, _COMPUTED.sub("", curve.path)),
        )
        for curve in walk.curves(rest)
    ]


def _split_topic(text: str, topics: Mapping[str, str], where: str) -> tuple[str, str]:
    """The topic, and what is behind it: the longest topic counts."""
    name = text if text.startswith("/") else f"/{text}"
    fits = [t for t in topics if name == t or (name.startswith(t) and name[len(t)] in "./[")]
    if fits:
        topic = max(fits, key=len)
        return topic, name[len(topic) :]
    wanted = name.partition(".")[0]
    listed = ", ".join(list(topics)[:20]) + (" …" if len(topics) > 20 else "")
    hint = did_you_mean(wanted, topics) or (f"there is {listed}" if topics else "there is none")
    raise InputError(f"SK-CLI-030 no topic {wanted!r} in {where}; {hint}", "SK-CLI-030")


class _FieldPath:
    """Goes along one path through the definitions of types."""

    def __init__(self, store: Typestore, type_name: str, text: str) -> None:
        self._store, self._text = store, text
        self._root = _PathStep((NAME, type_name), _identity, "", type_name, _identity)

    def curves(self, rest: str) -> list[Curve]:
        """The curves behind a path."""
        places, at = [self._root], 0
        rest = rest.rstrip("./")
        while at < len(rest):
            found = _STEP.match(rest, at)
            if found is None:
                raise self._field_error(f"{rest!r} is no path of fields, such as .pose.position.x or .ranges[0]")
            at = found.end()
            if found[1] is not None:
                ends = [self._derived(place, found[1]) for place in places]
                if all(end is not None for end in ends):
                    if at < len(rest):
                        raise self._field_error(f"{found[1]!r} is a number and has no {rest[at:]!r}")
                    return [end for end in ends if end is not None]
                places = [self._field(place, found[1]) for place in places]
            else:
                places = [inner for place in places for inner in self._items(place, found[2])]
            self._count(places)
        curves = [curve for place in places for curve in self._numbers(place)]
        self._count(curves)
        return curves

    def _count(self, found: Sequence[object]) -> None:
        if len(found) > MOST_CURVES:
            raise self._path_error(f"stands for {len(found)} numbers, allowed are {MOST_CURVES}")

    # ------------------------------------------------------------------ one step

    def _field(self, place: _PathStep, name: str) -> _PathStep:
        if int(place.node[0]) != NAME:
            hint = self._hint(place)
            raise self._field_error(f"{place.path or 'it'} is {_kind_in_words(place.node)} and has no {name!r}; {hint}")
        fields = dict(field_nodes(place.node[1], self._store))
        if name not in fields:
            told = did_you_mean(name, [*fields, *self._computed_names(place)])
            hint = told or "its fields are " + (", ".join(fields) or "none")
            raise self._field_error(f"{place.node[1]} has no field {name!r}; {hint}")
        path = f"{place.path}.{name}" if place.path else name
        return _PathStep(
            fields[name], _compose(place.read, partial(_field_value, name)), path, place.node[1], place.read
        )

    def _items(self, place: _PathStep, text: str) -> list[_PathStep]:
        if int(place.node[0]) not in (ARRAY, SEQUENCE):
            raise self._field_error(
                f"{place.path or 'it'} is {_kind_in_words(place.node)}, no array: it has no item [{text}]"
            )
        inner, size = place.node[1]
        found = re.fullmatch(r"\s*(-?\d*)\s*(?:(:)\s*(-?\d*))?\s*", text)
        if found is None or (not found[2] and not found[1]):
            return [self._named(place, text.strip().strip("'\""))]
        if found[2] is None:
            numbers = [int(found[1])]
        else:
            start, stop = int(found[1] or 0), int(found[3]) if found[3] else size if int(place.node[0]) == 3 else None
            if stop is None or (start < 0) != (stop < 0):
                raise self._path_error(f"[{text}] does not say how many items are meant, as [{max(start, 0)}:10] does")
            numbers = list(range(start, min(stop, start + MOST_CURVES + 1)))
        if int(place.node[0]) == ARRAY:
            for number in numbers:
                if not -size <= number < size:
                    raise self._field_error(f"{place.path} has {size} items, found [{number}]")
        return [self._item(place, inner, partial(_item, number), str(number)) for number in numbers]

    def _item(self, place: _PathStep, inner: FieldNode, take: Reader, said: str) -> _PathStep:
        path = f"{place.path}[{said}]"
        return _PathStep(inner, _compose(place.read, take), path, place.owner, place.read)

    def _named(self, place: _PathStep, name: str) -> _PathStep:
        """The item of that name: of messages by what they are called, of numbers by the names beside them."""
        inner = place.node[1][0]
        if int(inner[0]) == NAME:
            fields = dict(field_nodes(inner[1], self._store))
            key = next((n for n in _NAMED if n in fields and _is_text(fields[n])), None)
            if key is not None:
                return self._item(place, inner, partial(_item_with_name, key, name), name)
        beside = dict(field_nodes(place.owner, self._store)) if place.path else {}
        names = next((n for n in _NAMES if n in beside and int(beside[n][0]) == SEQUENCE), None)
        if names is None or not name:
            raise self._field_error(f"[{name}] is no number, and nothing names the items of {place.path}")
        read = partial(_item_at_name, place.before, names, name, place.read)
        return _PathStep(inner, read, f"{place.path}[{name}]", place.owner, place.before)

    # ------------------------------------------------------------------ numbers

    def _numbers(self, place: _PathStep) -> list[Curve]:
        """The numbers at the end of a path: one, or those of a small vector."""
        kind = int(place.node[0])
        if kind == BASE:
            if _is_text(place.node):
                raise self._path_error(f"{place.path} is a text, no number")
            return [self._curve(place, place.read, place.path)]
        if kind == NAME:
            fields = field_nodes(place.node[1], self._store)
            names = [name for name, _ in fields]
            if names == ["sec", "nanosec"]:
                return [self._curve(place, _compose(place.read, _seconds), place.path or "time", "s")]
            if fields and all(int(node[0]) == BASE and not _is_text(node) for _, node in fields):
                return [c for name in names for c in self._numbers(self._field(place, name))]
            raise self._path_error(f"{place.path or 'a whole message'} is no number; {self._hint(place)}")
        if kind == ARRAY and place.node[1][1] <= _SPREAD:
            return [c for i in self._items(place, f"0:{place.node[1][1]}") for c in self._numbers(i)]
        raise self._path_error(f"{place.path} is {_kind_in_words(place.node)}; {self._hint(place)}")

    def _derived(self, place: _PathStep, name: str) -> Curve | None:
        """A number that is made of what lies there; None where the type has a field of that name, or it cannot be."""
        if name not in self._computed_names(place):
            return None
        path = f"{place.path}.{name}" if place.path else name
        read = place.read
        if name in _ANGLES:
            inner = self._orientation_field(place)
            if inner is not None:
                read = _compose(read, partial(_field_value, inner))
            return self._curve(place, _compose(read, partial(_angle, name)), path, "rad", is_angle=name != "pitch")
        if name == "norm":
            names = [n for n, _ in field_nodes(place.node[1], self._store)]
            return self._curve(place, _compose(read, partial(_norm, names)), path)
        return self._curve(
            place, _compose(read, partial(_array_statistic, name)), path, "" if name != "length" else "items"
        )

    def _computed_names(self, place: _PathStep) -> tuple[str, ...]:
        """Return the names that can be computed of a type, beside its fields."""
        kind = int(place.node[0])
        if kind in (ARRAY, SEQUENCE):
            is_number = int(place.node[1][0][0]) == BASE and not _is_text(place.node[1][0])
            return _OF_ARRAYS if is_number else ("length",)
        if kind != NAME:
            return ()
        fields = dict(field_nodes(place.node[1], self._store))
        found: tuple[str, ...] = ()
        if self._is_quaternion(place.node) or self._orientation_field(place) is not None:
            found = _ANGLES
        elif fields and set(fields) <= {"x", "y", "z"} and len(fields) > 1:
            found = ("norm",)
        return tuple(name for name in found if name not in fields)

    def _is_quaternion(self, node: FieldNode) -> bool:
        return int(node[0]) == NAME and [n for n, _ in field_nodes(node[1], self._store)] == ["x", "y", "z", "w"]

    def _orientation_field(self, place: _PathStep) -> str | None:
        """The field that says how something is turned."""
        for name, node in field_nodes(place.node[1], self._store):
            if name in ("orientation", "rotation") and self._is_quaternion(node):
                return name
        return None

    def _curve(self, place: _PathStep, read: Reader, path: str, unit: str = "", *, is_angle: bool = False) -> Curve:
        return Curve("", path, partial(_number, read), unit, is_angle)

    def _hint(self, place: _PathStep) -> str:
        kind = int(place.node[0])
        if kind == NAME:
            fields = [n for n, _ in field_nodes(place.node[1], self._store)]
            return "its fields are " + (", ".join((*fields, *self._computed_names(place))) or "none")
        if kind in (ARRAY, SEQUENCE):
            name = place.path.rpartition(".")[2]
            extra = "".join(f", .{n}" for n in self._computed_names(place))
            return f"allowed is an item or some of them, as {name}[0] or {name}[0:10]{extra}"
        return "nothing lies below it"

    def _field_error(self, text: str) -> InputError:
        return InputError(f"SK-CLI-033 {self._text}: {text}", "SK-CLI-033")

    def _path_error(self, text: str) -> InputError:
        return InputError(f"SK-BAG-010 {self._text}: {text}", "SK-BAG-010")


# ---------------------------------------------------------------------- out of messages


def _identity(value: object) -> object:
    return value


def _compose(first: Reader, second: Reader) -> Reader:
    return second if first is _identity else lambda message: second(first(message))


def _field_value(name: str, value: FieldValue) -> FieldValue:
    return field_value(value, name)


def _item(number: int, value: FieldValue) -> FieldValue:
    return value[number]


def _item_with_name(key: str, name: str, items: Iterable[Message]) -> Message:
    """The message of a name; names of frames may be written without what stands before their last part."""
    for item in items:
        if field_value(item, key) == name:
            return item
    raise LookupError(name)


def _item_at_name(before: Reader, key: str, name: str, read: Reader, message: Message) -> FieldValue:
    names = field_value(before(message), key)
    return read(message)[list(names).index(name)]


def _number(read: Reader, message: Message) -> float:
    try:
        return float(read(message))
    except (LookupError, ValueError):
        return math.nan


def _seconds(stamp: Time) -> float:
    return float(int(stamp.sec) + int(stamp.nanosec) * 1e-9)


def _norm(names: list[str], value: FieldValue) -> float:
    return math.hypot(*(float(getattr(value, name)) for name in names))


def _array_statistic(what: str, value: FieldValue) -> float:
    """Compute a statistic of the finite items; NaN where there are none."""
    if what == "length":
        return float(len(value))
    numbers = np.asarray(value, dtype=np.float64)
    numbers = numbers[np.isfinite(numbers)]
    return float(getattr(numbers, what)()) if numbers.size else math.nan


def _angle(name: str, q: Quaternion) -> float:
    """Roll, pitch or yaw [rad] about fixed axes x, y, z (REP 103) of a quaternion that need not be of unit length."""
    x, y, z, w = float(q.x), float(q.y), float(q.z), float(q.w)
    size = x * x + y * y + z * z + w * w
    if not size > 0:
        return math.nan
    if name == "roll":
        return math.atan2(2 * (w * x + y * z), w * w - x * x - y * y + z * z)
    if name == "pitch":
        return math.asin(min(1.0, max(-1.0, 2 * (w * y - z * x) / size)))
    return math.atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z)


def _is_text(node: FieldNode) -> bool:
    return int(node[0]) == BASE and node[1][0] not in NUMBER_CODES and node[1][0] not in ("bool", "byte")


def _kind_in_words(node: FieldNode) -> str:
    kind = int(node[0])
    if kind == BASE:
        return "a text" if _is_text(node) else "a number"
    if kind == NAME:
        return str(node[1])
    inner, size = node[1]
    of = inner[1] if int(inner[0]) == NAME else inner[1][0]
    return f"an array of {size} {of}" if kind == ARRAY else f"an array of {of}"
