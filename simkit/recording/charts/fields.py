"""Resolve names of message fields, as written on a command line, to functions that read the fields' numbers.

Examples: `/odom.pose.pose.position.x`, `/scan.ranges[0]`, `/joint_states.position[left_wheel]`,
`/odom.pose.pose.orientation.yaw`. Names are checked against the definitions of the types, so that a wrong name is
reported before anything runs.
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
from simkit.msgs.definition_parser import ARRAY, BASE, NAME, SEQUENCE, FieldNode
from simkit.msgs.image_arrays import image
from simkit.msgs.message_text import NUMBER_CODES, field_nodes, field_value
from simkit.msgs.message_types import FieldValue, Message
from simkit.number_text import counted

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

    from simkit.msgs import Quaternion, Time

Number = Callable[[FieldValue], float]
Reader = Callable[[FieldValue], FieldValue]
"""Function that reads a value of a message."""
Unit = Callable[[str, str], str]

MOST_CURVES: Final = 64
_STEP = re.compile(r"[./]?(?:(\w+)|\[([^\[\]]*)\])")
_COMPUTED = re.compile(r"\[[^\]]*\]|\.(norm|min|max|mean)$")
_SPREAD: Final = 12  # largest fixed-length array that a path without an index expands to all items
_ANGLES: Final = ("roll", "pitch", "yaw")
_OF_ARRAYS: Final = ("min", "max", "mean", "length")
_PICTURES: Final = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
_PIXELS: Final = "pixels"  # name for the rows of numbers of a picture; its own field `data` has bytes
_ROWS: Final[FieldNode] = (SEQUENCE, ((SEQUENCE, ((BASE, ("float64", 0)), 0)), 0))
_NAMES: Final = ("name", "names", "joint_names")  # arrays with the names of the items of sibling arrays
_NAMED: Final = ("child_frame_id", "name", "id")  # fields with the name of a message in an array


@dataclass(frozen=True)
class Curve:
    """Number in every message of a topic.

    Attributes:
        topic: name of the topic.
        path: path of the field, with the index of each item.
        read: function that reads the number from a message; NaN if the message has none.
        unit: SI unit; empty if unknown.
        is_angle: True for an angle that wraps around after a full turn.
        type_name: type of the messages; other types on the same topic are ignored.
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
    """Resolved beginning of a field path.

    Attributes:
        node: type at the end of the path.
        read: function that reads this value from a message of the topic.
        path: path as text.
        owner: type of the message that contains the value.
        before: function that reads the message that contains the value.
    """

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
    """Return the curves of a field: several for a vector or a part of an array.

    Args:
        text: topic and field.
        topics: topic -> type, for all topics.
        store_of: function that returns the type store of a type.
        where: description of the source of the topics, for error messages.
        unit_of: function that returns the unit of a field of a type.

    Raises:
        InputError: SK-CLI-030 the topic does not exist; SK-CLI-033 its messages have no such field; SK-BAG-010 the
            field is not a number.
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
    """Split a text into topic and field path; if several topics match, the longest topic is used."""
    name = text if text.startswith("/") else f"/{text}"
    fits = [t for t in topics if name == t or (name.startswith(t) and name[len(t)] in "./[")]
    if fits:
        topic = max(fits, key=len)
        return topic, name[len(topic) :]
    requested = name.partition(".")[0]
    listed = ", ".join(list(topics)[:20]) + (" …" if len(topics) > 20 else "")
    hint = did_you_mean(requested, topics) or (f"known: {listed}" if topics else "there are no topics")
    raise InputError("SK-CLI-030", f"no topic {requested!r} in {where}; {hint}")


class _FieldPath:
    """Resolves one field path with the definitions of the types."""

    def __init__(self, store: Typestore, type_name: str, text: str) -> None:
        self._store, self._text = store, text
        self._root = _PathStep((NAME, type_name), _identity, "", type_name, _identity)

    def curves(self, rest: str) -> list[Curve]:
        """Return the curves of a path."""
        steps, at = [self._root], 0
        rest = rest.rstrip("./")
        while at < len(rest):
            step_match = _STEP.match(rest, at)
            if step_match is None:
                raise self._field_error(f"{rest!r} is not a field path such as .pose.position.x or .ranges[0]")
            at = step_match.end()
            if step_match[1] is not None:
                ends = [self._derived(step, step_match[1]) for step in steps]
                if all(end is not None for end in ends):
                    if at < len(rest):
                        raise self._field_error(f"{step_match[1]!r} is a number and has no {rest[at:]!r}")
                    return [end for end in ends if end is not None]
                steps = [self._field(step, step_match[1]) for step in steps]
            else:
                steps = [inner for step in steps for inner in self._items(step, step_match[2])]
            self._count(steps)
        curves = [curve for step in steps for curve in self._numbers(step)]
        self._count(curves)
        return curves

    def _count(self, numbers: Sequence[object]) -> None:
        if len(numbers) > MOST_CURVES:
            raise self._path_error(f"means {counted(len(numbers), 'number')}; the limit is {MOST_CURVES}")

    # ------------------------------------------------------------------ one step

    def _field(self, step: _PathStep, name: str) -> _PathStep:
        if int(step.node[0]) != NAME:
            hint = self._hint(step)
            raise self._field_error(f"{step.path or 'it'} is {_kind_in_words(step.node)} and has no {name!r}; {hint}")
        fields = dict(field_nodes(step.node[1], self._store))
        if name == _PIXELS and step.node[1] in _PICTURES:
            read = _compose(step.read, _pixels)
            return _PathStep(_ROWS, read, f"{step.path}.{name}" if step.path else name, step.node[1], step.read)
        if name not in fields:
            suggestion = did_you_mean(name, [*fields, *self._computed_names(step)])
            hint = suggestion or "its fields: " + (", ".join(fields) or "none")
            raise self._field_error(f"{step.node[1]} has no field {name!r}; {hint}")
        path = f"{step.path}.{name}" if step.path else name
        return _PathStep(fields[name], _compose(step.read, partial(_field_value, name)), path, step.node[1], step.read)

    def _items(self, step: _PathStep, text: str) -> list[_PathStep]:
        if int(step.node[0]) not in (ARRAY, SEQUENCE):
            raise self._field_error(
                f"{step.path or 'it'} is {_kind_in_words(step.node)}, not an array: it has no item [{text}]"
            )
        inner, size = step.node[1]
        match = re.fullmatch(r"\s*(-?\d*)\s*(?:(:)\s*(-?\d*))?\s*", text)
        if match is None or (not match[2] and not match[1]):
            return [self._named(step, text.strip().strip("'\""))]
        if match[2] is None:
            numbers = [int(match[1])]
        else:
            start, stop = int(match[1] or 0), int(match[3]) if match[3] else size if int(step.node[0]) == 3 else None
            if stop is None or (start < 0) != (stop < 0):
                raise self._path_error(f"[{text}] has no end; give one, such as [{max(start, 0)}:10]")
            numbers = list(range(start, min(stop, start + MOST_CURVES + 1)))
        if int(step.node[0]) == ARRAY:
            for number in numbers:
                if not -size <= number < size:
                    raise self._field_error(f"{step.path} has {counted(size, 'item')}, found [{number}]")
        return [self._item(step, inner, partial(_item, number), str(number)) for number in numbers]

    def _item(self, step: _PathStep, inner: FieldNode, read_item: Reader, index: str) -> _PathStep:
        path = f"{step.path}[{index}]"
        return _PathStep(inner, _compose(step.read, read_item), path, step.owner, step.read)

    def _named(self, step: _PathStep, name: str) -> _PathStep:
        """Return the array item with a name: from the items' name field, or from a sibling array of names."""
        inner = step.node[1][0]
        if int(inner[0]) == NAME:
            fields = dict(field_nodes(inner[1], self._store))
            key = next((n for n in _NAMED if n in fields and _is_text(fields[n])), None)
            if key is not None:
                return self._item(step, inner, partial(_item_with_name, key, name), name)
        siblings = dict(field_nodes(step.owner, self._store)) if step.path else {}
        names = next((n for n in _NAMES if n in siblings and int(siblings[n][0]) == SEQUENCE), None)
        if names is None or not name:
            raise self._field_error(f"[{name}] is not a number, and the items of {step.path} have no names")
        read = partial(_item_at_name, step.before, names, name, step.read)
        return _PathStep(inner, read, f"{step.path}[{name}]", step.owner, step.before)

    # ------------------------------------------------------------------ numbers

    def _numbers(self, step: _PathStep) -> list[Curve]:
        """Return the curves of a path: one curve for a number, or one for each number of a small vector."""
        kind = int(step.node[0])
        if kind == BASE:
            if _is_text(step.node):
                raise self._path_error(f"{step.path} is a text, not a number")
            return [self._curve(step, step.read, step.path)]
        if kind == NAME:
            fields = field_nodes(step.node[1], self._store)
            names = [name for name, _ in fields]
            if names == ["sec", "nanosec"]:
                return [self._curve(step, _compose(step.read, _seconds), step.path or "time", "s")]
            if fields and all(int(node[0]) == BASE and not _is_text(node) for _, node in fields):
                return [c for name in names for c in self._numbers(self._field(step, name))]
            raise self._path_error(f"{step.path or 'a whole message'} is not a number; {self._hint(step)}")
        if kind == ARRAY and step.node[1][1] <= _SPREAD:
            return [c for i in self._items(step, f"0:{step.node[1][1]}") for c in self._numbers(i)]
        raise self._path_error(f"{step.path} is {_kind_in_words(step.node)}; {self._hint(step)}")

    def _derived(self, step: _PathStep, name: str) -> Curve | None:
        """Return the curve of a computed number; None if the type has no such number, or has a field of that name."""
        if name not in self._computed_names(step) or name == _PIXELS:
            return None
        path = f"{step.path}.{name}" if step.path else name
        read = step.read
        if name in _ANGLES:
            inner = self._orientation_field(step)
            if inner is not None:
                read = _compose(read, partial(_field_value, inner))
            return self._curve(step, _compose(read, partial(_angle, name)), path, "rad", is_angle=name != "pitch")
        if name == "norm":
            names = [n for n, _ in field_nodes(step.node[1], self._store)]
            return self._curve(step, _compose(read, partial(_norm, names)), path)
        return self._curve(
            step, _compose(read, partial(_array_statistic, name)), path, "" if name != "length" else "items"
        )

    def _computed_names(self, step: _PathStep) -> tuple[str, ...]:
        """Return the names of numbers that can be computed from a type, in addition to its fields."""
        kind = int(step.node[0])
        if kind in (ARRAY, SEQUENCE):
            is_number = step.node is _ROWS or (int(step.node[1][0][0]) == BASE and not _is_text(step.node[1][0]))
            return _OF_ARRAYS if is_number else ("length",)
        if kind != NAME:
            return ()
        fields = dict(field_nodes(step.node[1], self._store))
        names: tuple[str, ...] = ()
        if self._is_quaternion(step.node) or self._orientation_field(step) is not None:
            names = _ANGLES
        elif fields and set(fields) <= {"x", "y", "z"} and len(fields) > 1:
            names = ("norm",)
        elif step.node[1] in _PICTURES:
            names = (_PIXELS,)
        return tuple(name for name in names if name not in fields)

    def _is_quaternion(self, node: FieldNode) -> bool:
        return int(node[0]) == NAME and [n for n, _ in field_nodes(node[1], self._store)] == ["x", "y", "z", "w"]

    def _orientation_field(self, step: _PathStep) -> str | None:
        """Return the name of the message's quaternion field with its orientation; None if there is none."""
        for name, node in field_nodes(step.node[1], self._store):
            if name in ("orientation", "rotation") and self._is_quaternion(node):
                return name
        return None

    def _curve(self, step: _PathStep, read: Reader, path: str, unit: str = "", *, is_angle: bool = False) -> Curve:
        return Curve("", path, partial(_number, read), unit, is_angle)

    def _hint(self, step: _PathStep) -> str:
        kind = int(step.node[0])
        if kind == NAME:
            fields = [n for n, _ in field_nodes(step.node[1], self._store)]
            return "its fields: " + (", ".join((*fields, *self._computed_names(step))) or "none")
        if kind in (ARRAY, SEQUENCE):
            name = step.path.rpartition(".")[2]
            extra = "".join(f", .{n}" for n in self._computed_names(step))
            return f"give an item or a range, such as {name}[0] or {name}[0:10]{extra}"
        return "it has no fields"

    def _field_error(self, text: str) -> InputError:
        return InputError("SK-CLI-033", f"{self._text}: {text}")

    def _path_error(self, text: str) -> InputError:
        return InputError("SK-BAG-010", f"{self._text}: {text}")


# ---------------------------------------------------------------------- readers


def _identity(value: object) -> object:
    return value


def _compose(first: Reader, second: Reader) -> Reader:
    return second if first is _identity else lambda message: second(first(message))


def _field_value(name: str, value: FieldValue) -> FieldValue:
    return field_value(value, name)


def _pixels(message: Message) -> np.ndarray:
    """Return the depths [m] or grey values of a picture; a colour counts with its mean."""
    pixels = image(message)
    return pixels if pixels.ndim == 2 else pixels[..., :3].mean(axis=2)


def _item(number: int, value: FieldValue) -> FieldValue:
    return value[number]


def _item_with_name(key: str, name: str, items: Iterable[Message]) -> Message:
    """Return the first message with that name."""
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


def _array_statistic(name: str, value: FieldValue) -> float:
    """Compute a statistic of the finite items; NaN without finite items."""
    if name == "length":
        return float(len(value))
    numbers = np.asarray(value, dtype=np.float64)
    numbers = numbers[np.isfinite(numbers)]
    return float(getattr(numbers, name)()) if numbers.size else math.nan


def _angle(name: str, q: Quaternion) -> float:
    """Return roll, pitch or yaw [rad] about the fixed axes x, y, z (REP 103) of a quaternion of any length."""
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
    if node is _ROWS:
        return "an array of rows"
    inner, size = node[1]
    item = inner[1] if int(inner[0]) == NAME else inner[1][0]
    return f"an array of {size} {item}" if kind == ARRAY else f"an array of {item}"
