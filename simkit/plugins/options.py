"""Options of a plugin, declared as a class: each field names an element of the file, with default, unit and bounds.

    class BeltOptions(Options):
        speed: float = number(0.5, "m/s", minimum=0.0)
        is_reversed: bool = boolean(element="reverse")

    class Belt(ModelPlugin):
        options = OptionsOf(BeltOptions)

        def load(self, parent, params):
            self._speed = self.options.speed

The first use of a field reads the element; later uses return the same value. If a field is never used, its element is
reported as not read. `simkit plugin info` lists the fields. The report of an unknown element suggests a similar field.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Generic, Literal, Protocol, Self, TypeVar, overload

from simkit.params import Params
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.plugins.ros_names import is_ros_1
from simkit.pose import IDENTITY, Pose

OptionKind = Literal["number", "integer", "boolean", "text", "vector", "pose", "choice", "block", ""]
Value = TypeVar("Value")
OptionsKind = TypeVar("OptionsKind", bound="Options")
OptionsKind_co = TypeVar("OptionsKind_co", bound="Options", covariant=True)


class Options(SharedByCopies):
    """Options in one block of a file.

    Args:
        params: block of the file that contains the options.

    Attributes:
        ros_1_marks: elements that only a file for ROS 1 has. Without marks, each option decides by its own element.
        is_given: whether the file has the block.
    """

    ros_1_marks: ClassVar[tuple[str, ...]] = ()

    def __init__(self, params: Params) -> None:
        self.params = params
        self.is_given = True

    @classmethod
    def fields(cls) -> dict[str, Option]:
        """Return the options by name of the field; the options of base classes come first."""
        return {name: v for c in reversed(cls.__mro__) for name, v in vars(c).items() if isinstance(v, Option)}

    def read_all(self) -> Self:
        """Read all options except live parameters, so that all errors are reported together.

        The options of base classes are read last.
        """
        for kind in type(self).__mro__:
            for name, value in vars(kind).items():
                if isinstance(value, Option) and not value.is_live:
                    getattr(self, name)
        return self

    @property
    def is_ros_1(self) -> bool:
        """True if the file has the spelling of ROS 1."""
        return is_ros_1(self.params, self.ros_1_marks)

    def element_of(self, field: str) -> str:
        """Return the name of the element that a field reads, in the spelling of the file."""
        return self.fields()[field].element_in(self)

    @classmethod
    def element_names(cls) -> Iterator[str]:
        """Yield the names of all elements that the options read, including elements within blocks."""
        for option in cls.fields().values():
            yield option.element
            if option.ros_1:
                yield option.ros_1
            if option.options is not None:
                yield from option.options.element_names()


@dataclass(eq=False)
class Option:
    """Field of a class of options; it reads one element of the file.

    Attributes:
        kind: type of the value; empty if the element has no effect.
        element: name of the element in the file, or `@name` for an attribute; by default the name of the field.
        ros_1: name of the element in a file for ROS 1; empty if it is the same.
        default: value if the file does not have the element; for a computed default, a text for `simkit plugin info`.
        unit: SI unit; empty for a value without unit.
        minimum, maximum: bounds of a number.
        finite: whether a number must be finite.
        choices: allowed words.
        size: number of values in a vector.
        required: whether the file must have the element.
        repeated: whether the element may occur several times.
        instead: name of the field whose value is the default.
        options: class of the options in a block.
        is_live: whether the option is a live parameter, which `Plugin.declare` reads.
        description: meaning of the option, if its name is not clear enough.
    """

    kind: OptionKind
    element: str = ""
    default: Any = None
    unit: str = ""
    minimum: float | None = None
    maximum: float | None = None
    finite: bool = True
    choices: tuple[str, ...] = ()
    size: int | None = None
    required: bool = False
    repeated: bool = False
    instead: str = ""
    options: type[Options] | None = None
    is_live: bool = False
    description: str = ""
    ros_1: str = ""

    def __set_name__(self, owner: type[Options], name: str) -> None:
        self.name, self.element = name, self.element or name

    def __get__(self, options: Options | None, owner: type[Options]) -> Any:
        if options is None:
            return self
        default = getattr(options, self.instead) if self.instead else self.default
        # the instance's attribute now replaces the class's descriptor, so the element is read only once
        value = vars(options)[self.name] = self._read(options.params, self.element_in(options), default)
        return value

    def element_in(self, options: Options) -> str:
        """Return the name of the element in the spelling of a file."""
        if not self.ros_1:
            return self.element
        if options.ros_1_marks:
            return self.ros_1 if options.is_ros_1 else self.element
        params = options.params
        return self.ros_1 if params.has(self.ros_1) and not params.has(self.element) else self.element

    def _read(self, params: Params, name: str, default: Any) -> Any:
        required = self.required
        if self.options is not None:
            if self.repeated:
                return tuple(self.options(block) for block in params.all(name))
            inside = self.options(params.block(name))
            inside.is_given = any(child.name == name for child in params.children)
            return inside
        if name.startswith("@"):
            return params.attribute(name[1:], default)
        if self.repeated:
            if self.kind == "number":
                items = params.each(name)
                return tuple(item.number(name, minimum=self.minimum, maximum=self.maximum) for item in items)
            elements = params.all(name)
            if required and not elements:
                params.text(name, required=True)
            return tuple(element.value for element in elements)
        match self.kind:
            case "number":
                return params.number(name, default, required, self.minimum, self.maximum, self.finite)
            case "integer":
                low, high = (None if bound is None else int(bound) for bound in (self.minimum, self.maximum))
                return params.integer(name, default, required, low, high)
            case "boolean":
                return params.boolean(name, default, required)
            case "text":
                return params.text(name, default, required)
            case "vector":
                return params.vector(name, self.size or len(default), default, required)
            case "pose":
                return params.pose(name, default)
            case "choice":
                return params.choice(name, self.choices, default, required)
        return params.child(name) is not None


class HasParams(Protocol):
    """Plugin with parameters."""

    params: Params


class OptionsOf(Generic[OptionsKind_co]):
    """Class attribute of a plugin; on an instance, it returns the options read from the instance's parameters.

    Args:
        kind: class of the options.
    """

    def __init__(self, kind: type[OptionsKind_co]) -> None:
        self.kind = kind

    @overload
    def __get__(self, plugin: None, owner: type[object]) -> OptionsOf[OptionsKind_co]: ...

    @overload
    def __get__(self, plugin: HasParams, owner: type[object]) -> OptionsKind_co: ...

    def __get__(self, plugin: HasParams | None, owner: type[object]) -> OptionsOf[OptionsKind_co] | OptionsKind_co:
        if plugin is None:
            return self
        made = vars(plugin).setdefault("_read_options", {})
        options = made.get(self.kind)
        if options is None or options.params is not plugin.params:
            options = made[self.kind] = self.kind(plugin.params)
        known: OptionsKind_co = options
        return known


def option_types_of(cls: type[object]) -> list[type[Options]]:
    """Return the classes of options that a plugin class declares; the classes of its base classes come first."""
    attributes = {name: v for c in reversed(cls.__mro__) for name, v in vars(c).items()}
    declared = (v.kind for v in attributes.values() if isinstance(v, OptionsOf))
    return list(dict.fromkeys((*declared, *getattr(cls, "option_types", ()))))


def _declare(kind: type[Value], option: Option) -> Value:  # noqa: ARG001 - for type checkers
    """Return the option; a type checker sees it as a value of the type `kind`, as the field has on an instance."""
    declared: Any = option
    value: Value = declared
    return value


def number(
    default: float | None = None,
    unit: str = "",
    *,
    element: str = "",
    minimum: float | None = None,
    maximum: float | None = None,
    finite: bool = True,
    required: bool = False,
    instead: str = "",
    is_live: bool = False,
    description: str = "",
    ros_1: str = "",
) -> float:
    """Declare a number."""
    option = Option(
        "number",
        element,
        default,
        unit,
        minimum=minimum,
        maximum=maximum,
        finite=finite,
        required=required,
        instead=instead,
        is_live=is_live,
        description=description,
        ros_1=ros_1,
    )
    return _declare(float, option)


def numbers(
    unit: str = "", *, element: str = "", minimum: float | None = None, maximum: float | None = None
) -> tuple[float, ...]:
    """Declare a repeated element; each occurrence contains a number."""
    option = Option("number", element, None, unit, minimum=minimum, maximum=maximum, repeated=True)
    return _declare(tuple[float, ...], option)


def integer(
    default: int | None = None,
    *,
    element: str = "",
    minimum: int | None = None,
    maximum: int | None = None,
    required: bool = False,
) -> int:
    """Declare a whole number."""
    return _declare(int, Option("integer", element, default, minimum=minimum, maximum=maximum, required=required))


def boolean(default: bool = False, *, element: str = "", instead: str = "") -> bool:
    """Declare a boolean."""
    return _declare(bool, Option("boolean", element, default, instead=instead))


def text(
    default: str | None = "", *, element: str = "", required: bool = False, instead: str = "", ros_1: str = ""
) -> str:
    """Declare a text."""
    return _declare(str, Option("text", element, default, required=required, instead=instead, ros_1=ros_1))


def texts(*, element: str = "", required: bool = False) -> tuple[str, ...]:
    """Declare a repeated element; each occurrence contains a text."""
    return _declare(tuple[str, ...], Option("text", element, required=required, repeated=True))


def choice(allowed: Sequence[str], default: str | None = None, *, element: str = "", required: bool = False) -> str:
    """Declare an element whose text is one of the allowed words."""
    return _declare(str, Option("choice", element, default, choices=tuple(allowed), required=required))


def vector(
    default: Sequence[float] | None, unit: str = "", *, element: str = "", size: int = 0, required: bool = False
) -> tuple[float, ...]:
    """Declare an element with several numbers."""
    count = size or len(default or ())
    start = None if default is None else tuple(float(value) for value in default)
    return _declare(tuple[float, ...], Option("vector", element, start, unit, size=count, required=required))


def vector3(
    default: Sequence[float] = (0.0, 0.0, 0.0),
    unit: str = "",
    *,
    element: str = "",
    required: bool = False,
    instead: str = "",
    ros_1: str = "",
) -> tuple[float, float, float]:
    """Declare an element with three numbers."""
    x, y, z = map(float, default)
    option = Option("vector", element, (x, y, z), unit, size=3, required=required, instead=instead, ros_1=ros_1)
    return _declare(tuple[float, float, float], option)


def pose(default: Pose = IDENTITY, *, element: str = "") -> Pose:
    """Declare a pose: `x y z roll pitch yaw` [m, rad]."""
    return _declare(Pose, Option("pose", element, default, "m, rad"))


def block(options: type[OptionsKind], *, element: str = "") -> OptionsKind:
    """Declare an element that contains options; if the element is missing, its options have their defaults."""
    return _declare(options, Option("block", element, options=options))


def blocks(options: type[OptionsKind], *, element: str = "") -> tuple[OptionsKind, ...]:
    """Declare a repeated element; each occurrence contains options."""
    return _declare(tuple[OptionsKind, ...], Option("block", element, options=options, repeated=True))


def without_effect(*, element: str = "", ros_1: str = "") -> bool:
    """Declare an element without an effect; the value of the field is true if the file has the element."""
    return _declare(bool, Option("", element, ros_1=ros_1))
