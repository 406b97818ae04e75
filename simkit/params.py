"""Typed reader for a block of parameters from a file.

A `Params` is a tree of elements that is independent of any XML library. The tree records which elements were read, so
that unread elements can be reported. An invalid value is recorded as a diagnostic instead of raised, so that one pass
finds all problems.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any, ClassVar, TypeVar

from simkit.diagnostics import NOWHERE, Diagnostics, Where, did_you_mean
from simkit.number_text import counted, is_number, parse_boolean, parse_number, range_text, without_units
from simkit.pose import IDENTITY, Pose
from simkit.template_texts import find_template_text

T = TypeVar("T")
LARGEST = 1e100
"""Largest accepted magnitude of a vector's component or standard deviation; squares of larger numbers may overflow."""
_FARTHEST = 1e15  # [m] largest coordinate of a pose; sums of larger poses would lose their precision
_NOT, _READ, _WHOLLY = range(3)  # element unread; read; read with all its children


class Params:
    """One XML element: its name, text, attributes and children, each with its position in the file.

    Args:
        name: element name, without a namespace prefix's URI (`gz:type` stays `gz:type`).
        text: the element's own text, stripped.
        attributes: attribute texts by name.
        children: child elements in document order.
        where: file and line.
        diagnostics: collection that receives the problems; the children share it.
    """

    __slots__ = (
        *("_asked", "_attributes_asked", "_read"),
        *("attributes", "children", "diagnostics", "name", "value", "where"),
    )
    empty_is_default: ClassVar[bool] = True
    """True if an element without a text has the default value, as in sdformat."""

    def __init__(
        self,
        name: str = "",
        text: str = "",
        attributes: dict[str, str] | None = None,
        children: Sequence[Params] = (),
        where: Where = NOWHERE,
        diagnostics: Diagnostics | None = None,
    ) -> None:
        self.name, self.value, self.where = name, text, where
        self.attributes = dict(attributes or {})
        self.children = list(children)
        self.diagnostics = diagnostics if diagnostics is not None else Diagnostics()
        # created at first use, because most elements of a file have no children or attributes that are read
        self._asked: set[str] | None = None
        self._attributes_asked: set[str] | None = None
        self._read = _NOT

    @classmethod
    def from_dict(cls, values: dict[str, Any], name: str = "plugin", diagnostics: Diagnostics | None = None) -> Params:
        """Create a block from Python values: nested dicts become elements, lists become repeated elements."""
        root = cls(name, diagnostics=diagnostics)

        def fill(node: Params, items: dict[str, Any]) -> None:
            for key, value in items.items():
                for item in value if isinstance(value, list) else [value]:
                    child = cls(key, diagnostics=root.diagnostics)
                    if isinstance(item, dict):
                        fill(child, item)
                    elif isinstance(item, bool):
                        child.value = str(item).lower()
                    elif isinstance(item, (tuple, list)) or hasattr(item, "__array__"):
                        child.value = " ".join(str(v) for v in item)
                    else:
                        child.value = str(item)
                    node.children.append(child)

        fill(root, values)
        return root

    def __deepcopy__(self, memo: dict[int, object]) -> Params:
        return self

    # ------------------------------------------------------------------ structure

    def _ask_for(self, name: str) -> None:
        if self._asked is None:
            self._asked = {name}
        else:
            self._asked.add(name)

    def child(self, name: str) -> Params | None:
        """Return the first child of that name and mark it as read; None when absent."""
        self._ask_for(name)
        for c in self.children:
            if c.name == name:
                c._read = c._read or _READ
                return c
        return None

    def child_or_self(self, name: str) -> Params:
        """Return the first child of that name, or this element, as the location for a message about the child."""
        return self.child(name) or self

    def block(self, name: str) -> Params:
        """Return the first child of that name, or an empty block whose reads return their defaults."""
        return self.child(name) or Params(name, where=self.where, diagnostics=self.diagnostics)

    def all(self, name: str) -> list[Params]:
        """Return all children of that name in document order and mark them as read."""
        self._ask_for(name)
        elements = [c for c in self.children if c.name == name]
        for c in elements:
            c._read = c._read or _READ
        return elements

    def each(self, name: str) -> list[Params]:
        """Return a block for each child of that name, with only that child."""
        single = ((c,) for c in self.all(name))
        return [Params(self.name, children=c, where=c[0].where, diagnostics=self.diagnostics) for c in single]

    def has(self, name: str) -> bool:
        """Check whether a child of that name exists, without marking it as read."""
        self._ask_for(name)
        return any(c.name == name for c in self.children)

    @property
    def was_read(self) -> bool:
        """True if the reader of the parent element has read this element."""
        return self._read != _NOT

    @property
    def asked(self) -> set[str]:
        """Names of children that a reader has requested, present or not."""
        return set(self._asked or ())

    @property
    def attributes_asked(self) -> set[str]:
        """Names of attributes that a reader has requested, present or not."""
        return set(self._attributes_asked or ())

    def copied(self) -> Params:
        """Return an unread copy of the tree that can be changed independently."""
        children = [c.copied() for c in self.children]
        return Params(self.name, self.value, self.attributes, children, self.where, self.diagnostics)

    def mark_all_read(self) -> None:
        """Mark this whole block as read, because another reader handles it."""
        self._read = _WHOLLY
        for c in self.children:
            c.mark_all_read()

    # ------------------------------------------------------------------ values of children

    def text(self, name: str, default: str | None = None, required: bool = False) -> str:
        """Return the stripped text of a child."""
        return self._value(name, default, "", required, lambda p: p.value, "a text")

    def number(
        self,
        name: str,
        default: float | None = None,
        required: bool = False,
        minimum: float | None = None,
        maximum: float | None = None,
        finite: bool = True,
    ) -> float:
        """Return the number in a child.

        A number outside `minimum`..`maximum`, NaN, or an infinite number where `finite` is set, is recorded as an
        error.
        """
        element = self.child(name)
        if element is None and not required:
            return 0.0 if default is None else default
        try:  # fast path: most values are valid numbers, so the text for an error is not made yet
            if element is not None:
                return parse_number(element.value, minimum, maximum, finite)
        except ValueError:
            pass
        allowed = "a number" + range_text(minimum, maximum)

        def parse(p: Params) -> float:
            return parse_number(self._numeral(p, " ".join(p.first_of(1))), minimum, maximum, finite)

        return self._value(name, default, 0.0, required, parse, allowed)

    def integer(
        self,
        name: str,
        default: int | None = None,
        required: bool = False,
        minimum: int | None = None,
        maximum: int | None = None,
    ) -> int:
        """Return the whole number in a child.

        `360.0` is accepted. 666.5 gives its whole part and a warning, as in Gazebo.
        """

        def parse(p: Params) -> int:
            number = parse_number(self._numeral(p, p.value), minimum, maximum, True)
            if number != int(number):
                message = f"<{name}>{p.value}</{name}> is not a whole number, {int(number)} is used"
                p.diagnostics.warning("SK-PARAM-005", message, p.where)
            return int(number)

        return self._value(name, default, 0, required, parse, "a whole number" + range_text(minimum, maximum))

    def boolean(self, name: str, default: bool | None = None, required: bool = False) -> bool:
        """Return the truth value in a child: true, false, 1 or 0."""
        return self._value(name, default, False, required, lambda p: parse_boolean(p.value), "true, false, 1 or 0")

    def vector(
        self, name: str, size: int, default: Sequence[float] | None = None, required: bool = False
    ) -> tuple[float, ...]:
        """Return a vector of `size` finite numbers, separated by white space; their magnitude is at most `LARGEST`."""

        def parse(p: Params) -> tuple[float, ...]:
            parts = p.first_of(size)
            if len(parts) != size:
                raise ValueError
            return tuple(parse_number(v, -LARGEST, LARGEST, True) for v in parts)

        fallback = None if default is None else tuple(float(v) for v in default)
        return self._value(name, fallback, (0.0,) * size, required, parse, counted(size, "number"))

    def vector3(
        self, name: str, default: Sequence[float] | None = None, required: bool = False
    ) -> tuple[float, float, float]:
        """Return three finite numbers, as `vector` does."""
        x, y, z = self.vector(name, 3, default, required)
        return (x, y, z)

    def pose(self, name: str, default: Pose = IDENTITY) -> Pose:
        """Return the pose `x y z roll pitch yaw` [m, rad]; `degrees="true"` and `rotation_format` are supported."""
        return self._value(name, default, IDENTITY, False, lambda p: p.as_pose(), "x y z roll pitch yaw")

    def choice(self, name: str, allowed: Sequence[str], default: str | None = None, required: bool = False) -> str:
        """Return the text of a child, which must be one of the allowed words."""

        def parse(p: Params) -> str:
            if p.value not in allowed:
                raise ValueError
            return p.value

        return self._value(name, default, allowed[0], required, parse, "one of " + ", ".join(allowed))

    # ------------------------------------------------------------------ attributes

    def attribute(self, name: str, default: str = "") -> str:
        """Return the text of an attribute of this element."""
        if self._attributes_asked is None:
            self._attributes_asked = {name}
        else:
            self._attributes_asked.add(name)
        return self.attributes.get(name, default)

    # ------------------------------------------------------------------ this element's own text

    def first_of(self, count: int) -> list[str]:
        """Return the first words of this element's text. Surplus numbers are ignored with a warning, as in Gazebo."""
        parts = self.value.split()
        if len(parts) > count and all(map(is_number, parts)):
            shown = self.value if len(self.value) <= 60 else self.value[:57] + "..."
            what = "number is" if count == 1 else f"{count} numbers are"
            message = f"<{self.name}>{shown}</{self.name}> has {counted(len(parts), 'number')}, the first {what} used"
            self.diagnostics.warning("SK-PARAM-006", message, self.where)
            return parts[:count]
        return parts

    def as_pose(self) -> Pose:
        """Return this element's text as a pose.

        Raises:
            ValueError: the text is not a pose.
        """
        numbers = [parse_number(v, -_FARTHEST, _FARTHEST, True) for v in self.value.split()]
        if not numbers:
            return IDENTITY
        degrees = parse_boolean(self.attribute("degrees", "false"))
        form = self.attribute("rotation_format", "euler_rpy") or "euler_rpy"
        if form == "quat_xyzw":
            if len(numbers) != 7 or degrees:
                raise ValueError
            x, y, z, qx, qy, qz, qw = numbers
            return Pose((x, y, z), (qw, qx, qy, qz))
        if form != "euler_rpy" or len(numbers) < 3:
            raise ValueError
        if len(numbers) > 6:
            self.first_of(6)  # reports the surplus
        elif len(numbers) < 6:
            text = f"<{self.name}>{self.value}</{self.name}> has {counted(len(numbers), 'number')}"
            lost = ", and the rotation needs 3 of them: it is 0, as in Gazebo Classic" if len(numbers) > 3 else ""
            self.diagnostics.warning("SK-PARAM-006", text + (lost or ", 0 is used for the others"), self.where)
            numbers = numbers[:3]
        numbers = [*numbers, 0.0, 0.0, 0.0][:6]
        angles = numbers[3:]
        if degrees:
            angles = [math.radians(a) for a in angles]
        return Pose.from_rpy(*numbers[:3], *angles)

    # ------------------------------------------------------------------ reports

    def error(self, code: str, message: str, hint: str = "") -> None:
        """Record an error at this element's line."""
        self.diagnostics.error(code, message, self.where, hint)

    def warning(self, code: str, message: str, hint: str = "") -> None:
        """Record a warning at this element's line."""
        self.diagnostics.warning(code, message, self.where, hint)

    def note(self, code: str, message: str, hint: str = "") -> None:
        """Record a note at this element's line."""
        self.diagnostics.note(code, message, self.where, hint)

    def unread(self) -> Iterator[tuple[Params, str]]:
        """Yield each unread element with a hint: the closest requested name, or that the element is a duplicate."""
        for c in self.children:
            if ":" in c.name:
                continue
            if not c._read:
                comes_twice = any(o._read and o.name == c.name for o in self.children)
                yield c, f"the first <{c.name}> is" if comes_twice else did_you_mean(c.name, self._asked or ())
            else:
                yield from c.unread()

    def unread_attributes(self) -> Iterator[tuple[Params, str]]:
        """Yield each attribute that no reader requested, with its element, for all read elements below this element."""
        for c in self.children:
            if ":" in c.name or c._read in (_NOT, _WHOLLY):
                continue
            asked = c._attributes_asked or ()
            yield from ((c, name) for name in c.attributes if ":" not in name and name != "xmlns" and name not in asked)
            yield from c.unread_attributes()

    def report_unread(self, code: str, owner: str) -> None:
        """Record a warning for each unread element."""
        for element, suggestion in self.unread():
            self.diagnostics.warning(code, f"{owner}: <{element.name}> is not used", element.where, suggestion)

    def _value(
        self, name: str, default: T | None, fallback: T, required: bool, parse: Callable[[Params], T], allowed: str
    ) -> T:
        element = self.child(name)
        if element is None:
            if required:
                message = f"<{self.name}> needs <{name}>: {allowed}"
                self.diagnostics.error("SK-PARAM-001", message, self.where, self._near(name))
            return fallback if default is None else default
        try:
            return parse(element)
        except ValueError:
            if self.empty_is_default and not (element.value.strip() or element.children or required):
                message = f"{self._as_written(name, '')} is empty, the default is used"  # as in sdformat
                self.diagnostics.warning("SK-PARAM-005", message, element.where)
                return fallback if default is None else default
            written, element.value = element.value, without_units(element.value)
        try:
            value = parse(element)
        except ValueError:
            element.value = written
            self._bad(self._as_written(name, written), allowed, element.where)
            return fallback if default is None else default
        message = f"{self._as_written(name, written)} has letters after a number, {element.value} is used"
        self.diagnostics.warning("SK-PARAM-005", message, element.where)
        return value

    def _numeral(self, element: Params, text: str) -> str:
        """Return the text of a number; sdformat reads `true` and `false` as 1 and 0."""
        number = {"true": "1", "false": "0"}.get(text.lower())
        if number is not None:
            message = f"{self._as_written(element.name, text)} is not a number, {number} is used"
            self.diagnostics.warning("SK-PARAM-005", message, element.where)
        return number or text

    def _as_written(self, name: str, value: str) -> str:
        """Return an element as it is written in the file, for messages."""
        return f"<{name}>{value}</{name}>"

    def _near(self, name: str) -> str:
        return did_you_mean(name, [c.name for c in self.children if not c.was_read])  # a read child is not misspelled

    def _bad(self, text: str, allowed: str, where: Where) -> None:
        shown = text if len(text) <= 200 else text[:200] + "..."
        hint = find_template_text(text)[1]
        self.diagnostics.error("SK-PARAM-002", f"found {shown}; expected {allowed}", where, hint)
