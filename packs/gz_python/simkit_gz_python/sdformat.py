"""Replacement of sdformat's Python module (`sdformat14`, `sdformat`, …) with the types that systems of gz-sim use.

An `Element` reads a block of a world file. As with the parameters of any plugin, a warning lists the elements and
attributes that the system never reads.
"""

from __future__ import annotations

import enum
import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Final, NoReturn, TypeVar

from simkit import Params
from simkit_gz_python.math import Angle, Color, Pose3d, Quaterniond, Temperature, Vector2d, Vector2i, Vector3d
from simkit_gz_python.math.missing_names import missing_name_error

if TYPE_CHECKING:
    from simkit.scene.model import Axis as SceneAxis

T = TypeVar("T")
SDF_VERSION: Final = "1.11"


class JointType(enum.IntEnum):
    """Kinds of joints."""

    INVALID = 0
    BALL = 1
    CONTINUOUS = 2
    FIXED = 3
    GEARBOX = 4
    PRISMATIC = 5
    REVOLUTE = 6
    REVOLUTE2 = 7
    SCREW = 8
    UNIVERSAL = 9


class Param:
    """Text of an element or of an attribute."""

    def __init__(self, key: str, text: str) -> None:
        self._key, self._text = key, text

    def get_key(self) -> str:
        return self._key

    def get_string(self) -> str:
        return self._text

    get_as_string = get_string

    def get_double(self) -> float:
        return float(self._text)

    def get_int(self) -> int:
        return int(float(self._text))

    def get_bool(self) -> bool:
        return self._text.strip().lower() in ("1", "true")

    def get_set(self) -> bool:
        return True

    def __repr__(self) -> str:
        return self._text


class Element:
    """Element of a file, or an element that a program creates.

    `get_double("force")` returns the number of a child or an attribute, or 0 if the element has no `force`.
    `get_double("force", 2.0)` returns a pair: the number or 2.0, and a flag that is true if the element has a `force`.
    Without a name, these methods read the element's own text. A text that is not a number is an error of the file
    (SK-PARAM-002).
    """

    def __init__(self, params: Params | None = None, parent: Element | None = None) -> None:
        self._params = params if params is not None else Params()
        self._parent = parent

    # ------------------------------------------------------------------ the tree

    def get_name(self) -> str:
        return self._params.name

    def set_name(self, name: str) -> None:
        self._params.name = name

    def get_parent(self) -> Element | None:
        """Return the parent element; None for the `<plugin>` element: its model is available through the entity."""
        return self._parent

    def has_element(self, name: str) -> bool:
        return self._params.has(name)

    def find_element(self, name: str) -> Element | None:
        """Return the first child with this name, or None."""
        child = self._params.child(name)
        return Element(child, self) if child is not None else None

    def get_first_element(self) -> Element | None:
        """Return the first child, or None."""
        children = self._params.children
        return self.find_element(children[0].name) if children else None

    def get_next_element(self, name: str = "") -> Element | None:
        """Return the next sibling, or the next one with this name, or None."""
        if self._parent is None:
            return None
        siblings = self._parent._params.children
        index = next(i for i, child in enumerate(siblings) if child is self._params)
        for child in siblings[index + 1 :]:
            if not name or child.name == name:
                self._parent._params.all(child.name)
                return Element(child, self._parent)
        return None

    def add_element(self, name: str) -> Element:
        """Append a new, empty child element."""
        child = Params(name, where=self._params.where, diagnostics=self._params.diagnostics)
        self._params.children.append(child)
        return Element(child, self)

    def insert_element(self, element: Element, set_parent: bool = False) -> None:
        """Append an existing element as a child."""
        self._params.children.append(element._params)
        if set_parent:
            element._parent = self

    def clone(self) -> Element:
        return Element(self._params.copied(), self._parent)

    # ------------------------------------------------------------------ attributes and text

    def has_attribute(self, name: str) -> bool:
        return name in self._params.attributes

    get_attribute_set = has_attribute

    def get_attribute(self, name: str | int) -> Param | None:
        """Return an attribute by name or by index; None if the element does not have it."""
        if isinstance(name, int):
            name = next(iter(list(self._params.attributes)[name : name + 1]), "")
        if name not in self._params.attributes:
            return None
        return Param(name, self._params.attribute(name))

    def get_attributes(self) -> list[Param]:
        return [Param(name, self._params.attribute(name)) for name in self._params.attributes]

    def get_attribute_count(self) -> int:
        return len(self._params.attributes)

    def get_value(self) -> Param | None:
        """Return the element's own text; None if it is empty."""
        return Param(self._params.name, self._params.value) if self._params.value else None

    def file_path(self) -> str:
        return self._params.where.file or ""

    def line_number(self) -> int | None:
        return self._params.where.line

    def to_string(self, prefix: str = "", *_: object) -> str:
        """Return the element as XML text."""
        p = self._params
        attributes = "".join(f" {k}='{_escape_xml(v)}'" for k, v in p.attributes.items())
        if not p.children:
            return f"{prefix}<{p.name}{attributes}>{_escape_xml(p.value)}</{p.name}>\n"
        inner = "".join(Element(child).to_string(prefix + "  ") for child in p.children)
        return f"{prefix}<{p.name}{attributes}>\n{inner}{prefix}</{p.name}>\n"

    def __repr__(self) -> str:
        return f"<Element {self._params.name!r}>"

    def __getattr__(self, name: str) -> NoReturn:
        raise missing_name_error("Element", name, dir(type(self)))

    # ------------------------------------------------------------------ values by type

    def _read(self, key: str, default: tuple[T, ...], zero: T, parse: Callable[[Params, str], T]) -> T | tuple[T, bool]:
        is_present, block, name = False, self._params, key
        if not key:
            is_present, name = bool(block.value), block.name or "value"
            element = Params(name, block.value, block.attributes, (), block.where, block.diagnostics)
            block = Params("", children=(element,), diagnostics=block.diagnostics)
        elif key in block.attributes:
            is_present = True
            text = Params(key, block.attribute(key), where=block.where, diagnostics=block.diagnostics)
            block = Params("", children=(text,), diagnostics=block.diagnostics)
        else:
            is_present = block.child(key) is not None
        value = parse(block, name) if is_present else (default[0] if default else zero)
        return (value, is_present) if default else value

    def get_string(self, key: str = "", *default: str) -> str | tuple[str, bool]:
        return self._read(key, default, "", lambda p, name: p.text(name))

    def get_bool(self, key: str = "", *default: bool) -> bool | tuple[bool, bool]:
        return self._read(key, default, False, lambda p, name: p.boolean(name))

    def get_int(self, key: str = "", *default: int) -> int | tuple[int, bool]:
        return self._read(key, default, 0, lambda p, name: p.integer(name))

    def get_uint(self, key: str = "", *default: int) -> int | tuple[int, bool]:
        return self._read(key, default, 0, lambda p, name: p.integer(name, minimum=0))

    get_uint64 = get_uint

    def get_double(self, key: str = "", *default: float) -> float | tuple[float, bool]:
        return self._read(key, default, 0.0, lambda p, name: p.number(name, finite=False))

    get_float = get_double

    def get_angle(self, key: str = "", *default: Angle) -> Angle | tuple[Angle, bool]:
        """Read an angle [rad]."""
        return self._read(key, default, Angle(), lambda p, name: Angle(p.number(name)))

    def get_vector2d(self, key: str = "", *default: Vector2d) -> Vector2d | tuple[Vector2d, bool]:
        return self._read(key, default, Vector2d(), lambda p, name: Vector2d(*p.vector(name, 2)))

    def get_vector2i(self, key: str = "", *default: Vector2i) -> Vector2i | tuple[Vector2i, bool]:
        return self._read(key, default, Vector2i(), lambda p, name: Vector2i(*p.vector(name, 2)))

    def get_vector3d(self, key: str = "", *default: Vector3d) -> Vector3d | tuple[Vector3d, bool]:
        return self._read(key, default, Vector3d(), lambda p, name: Vector3d(*p.vector3(name)))

    def get_quaterniond(self, key: str = "", *default: Quaterniond) -> Quaterniond | tuple[Quaterniond, bool]:
        """Read a rotation of roll, pitch and yaw [rad]."""
        return self._read(key, default, Quaterniond(), lambda p, name: Quaterniond(*p.vector3(name)))

    def get_pose(self, key: str = "", *default: Pose3d) -> Pose3d | tuple[Pose3d, bool]:
        """Read a pose of x, y, z [m], roll, pitch and yaw [rad]."""

        def parse(p: Params, name: str) -> Pose3d:
            pose = p.pose(name)
            return Pose3d(*pose.position, *pose.quaternion)

        return self._read(key, default, Pose3d(), parse)

    def get_color(self, key: str = "", *default: Color) -> Color | tuple[Color, bool]:
        def parse(p: Params, name: str) -> Color:
            child = p.child(name)
            size = 3 if child is not None and len(child.value.split()) == 3 else 4
            return Color(*p.vector(name, size))

        return self._read(key, default, Color(), parse)

    def _write(self, value: object) -> None:
        self._params.value = str(value).lower() if isinstance(value, bool) else str(value)

    set_string = set_bool = set_int = set_uint = set_double = set_float = _write
    set_vector3d = set_pose = set_quaterniond = set_angle = set_color = _write


def _escape_xml(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace("'", "&apos;")


def _axis_reader(name: str, default: float) -> Callable[[JointAxis], float]:
    """Create a method that reads a property of an axis; the default is for a `JointAxis` without data."""
    return lambda self: default if self._axis is None else float(getattr(self._axis, name))


class JointAxis:
    """Degree of freedom of a joint; a limit that the file does not set is infinite."""

    def __init__(self, axis: SceneAxis | None = None) -> None:
        self._axis = axis

    def xyz(self) -> Vector3d:
        """Return the unit vector of the axis in the joint frame; the z axis if the file has no axis."""
        return Vector3d(0, 0, 1) if self._axis is None else Vector3d(*self._axis.xyz_joint)

    lower, upper = _axis_reader("lower", -1e16), _axis_reader("upper", 1e16)
    effort, max_velocity = _axis_reader("effort", math.inf), _axis_reader("velocity", math.inf)
    damping, friction = _axis_reader("damping", 0.0), _axis_reader("friction", 0.0)
    spring_reference, spring_stiffness = _axis_reader("spring_ref", 0.0), _axis_reader("stiffness", 0.0)


class Atmosphere:
    """Air at sea level."""

    def __init__(self, temperature: float = 288.15, gradient: float = -0.0065, pressure: float = 101325.0) -> None:
        self._temperature, self._gradient, self._pressure = Temperature(temperature), gradient, pressure

    def temperature(self) -> Temperature:
        return self._temperature

    def set_temperature(self, value: Temperature | float) -> None:
        self._temperature = Temperature(value)

    def temperature_gradient(self) -> float:
        """Return the temperature gradient [K/m]."""
        return self._gradient

    def set_temperature_gradient(self, value: float) -> None:
        self._gradient = float(value)

    def pressure(self) -> float:
        """Return the pressure [Pa]."""
        return self._pressure

    def set_pressure(self, value: float) -> None:
        self._pressure = float(value)


def __getattr__(name: str) -> NoReturn:
    raise missing_name_error("sdformat", name, globals())
