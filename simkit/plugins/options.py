"""Options of a plugin: a class whose fields name the elements to read, with default, unit and bounds.

    class BeltOptions(Options):
        speed: float = number(0.5, "m/s", minimum=0.0)
        is_reversed: bool = boolean(element="reverse")

    class Belt(ModelPlugin):
        options = OptionsOf(BeltOptions)

        def load(self, parent, params):
            self._speed = self.options.speed

A field is read from the file at its first use, and only once. An element whose field is never used counts as unread and
is reported. `simkit plugin info` lists the fields; the report of an unread element suggests their names.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Generic, Literal, Protocol, Self, TypeVar, overload

from simkit.params import Params
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.pose import IDENTITY, Pose

OptionKind = Literal["number", "integer", "boolean", "text", "vector", "pose", "choice", "block", ""]
Value = TypeVar("Value")
OptionsKind = TypeVar("OptionsKind", bound="Options")
OptionsKind_co = TypeVar("OptionsKind_co", bound="Options", covariant=True)


class Options(SharedByCopies):
    """Options in one block of a file.

    Args:
        params: block that the options are read from.

    Attributes:
        is_given: whether the file has the block.
    """

    def __init__(self, params: Params) -> None:
        self.params = params
        self.is_given = True

    @classmethod
    def fields(cls) -> dict[str, Option]:
        """Return the options by field name, those of base classes first."""
        return {name: v for c in reversed(cls.__mro__) for name, v in vars(c).items() if isinstance(v, Option)}

    def read_all(self) -> Self:
        """Read every option except live parameters, those of base classes last, to report all errors together."""
        for kind in type(self).__mro__:
            for name, value in vars(kind).items():
                if isinstance(value, Option) and not value.is_live:
                    getattr(self, name)
        return self

    @classmethod
    def element_names(cls) -> Iterator[str]:
        """Yield the names of all elements that the options read, including those within blocks."""
        for option in cls.fields().values():
            yield option.element
            if option.options is not None:
                yield from option.options.element_names()


@dataclass(eq=False)
class Option:
    """Element that a plugin reads; a field of a class of options.

    Attributes:
        kind: type of the value; empty if the element is known and has no effect.
        element: name in the file, `@name` for an attribute; the name of the field by default.
        default: value if the file has none; for a computed default, the text that is shown.
        unit: SI unit; empty for a value without unit.
        minimum, maximum: bounds of a number.
        finite: whether a number must be finite.
        choices: allowed words.
        size: number of values in a vector.
        required: whether the file must have the element.
        repeated: whether the element may occur several times.
        instead: field whose value is the default.
        options: class of the options in a block.
        is_live: whether it is a live parameter, which `Plugin.declare` reads.
        description: meaning of the option, if its name does not say it.
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

    def __set_name__(self, owner: type[Options], name: str) -> None:
        self.name, self.element = name, self.element or name

    def __get__(self, options: Options | None, owner: type[Options]) -> Any:
        if options is None:
            return self
        default = getattr(options, self.instead) if self.instead else self.default
        # this attribute of the instance hides the descriptor of the class, so the file is read once
        found = vars(options)[self.name] = self._read(options.params, default)
        return found

    def _read(self, params: Params, default: Any) -> Any:
        name, required = self.element, self.required
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
            found = params.all(name)
            if required and not found:
                params.text(name, required=True)
            return tuple(element.value for element in found)
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
    """Options of a plugin, read from its parameters; an attribute of its class.

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
        found = made.get(self.kind)
        if found is None or found.params is not plugin.params:
            found = made[self.kind] = self.kind(plugin.params)
        known: OptionsKind_co = found
        return known


def option_types_of(cls: type[object]) -> list[type[Options]]:
    """Return the classes of options that a plugin class declares, those of its bases first."""
    attributes = {name: v for c in reversed(cls.__mro__) for name, v in vars(c).items()}
    declared = (v.kind for v in attributes.values() if isinstance(v, OptionsOf))
    return list(dict.fromkeys((*declared, *getattr(cls, "option_types", ()))))


def _declare(kind: type[Value], option: Option) -> Value:  # noqa: ARG001 - for type checkers
    """Return the option, typed as `kind`: a type checker sees the value that the field will have."""
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
    )
    return _declare(float, option)


def numbers(
    unit: str = "", *, element: str = "", minimum: float | None = None, maximum: float | None = None
) -> tuple[float, ...]:
    """Declare a repeated element with a number each."""
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


def text(default: str | None = "", *, element: str = "", required: bool = False, instead: str = "") -> str:
    """Declare a text."""
    return _declare(str, Option("text", element, default, required=required, instead=instead))


def texts(*, element: str = "", required: bool = False) -> tuple[str, ...]:
    """Declare a repeated element with a text each."""
    return _declare(tuple[str, ...], Option("text", element, required=required, repeated=True))


def choice(allowed: Sequence[str], default: str | None = None, *, element: str = "", required: bool = False) -> str:
    """Declare a choice between a few words."""
    return _declare(str, Option("choice", element, default, choices=tuple(allowed), required=required))


def vector(
    default: Sequence[float] | None, unit: str = "", *, element: str = "", size: int = 0, required: bool = False
) -> tuple[float, ...]:
    """Declare several numbers."""
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
) -> tuple[float, float, float]:
    """Declare three numbers."""
    x, y, z = map(float, default)
    option = Option("vector", element, (x, y, z), unit, size=3, required=required, instead=instead)
    return _declare(tuple[float, float, float], option)


def pose(default: Pose = IDENTITY, *, element: str = "") -> Pose:
    """Declare a pose: `x y z roll pitch yaw` [m, rad]."""
    return _declare(Pose, Option("pose", element, default, "m, rad"))


def block(options: type[OptionsKind], *, element: str = "") -> OptionsKind:
    """Declare an element that contains options; an absent element has their defaults."""
    return _declare(options, Option("block", element, options=options))


def blocks(options: type[OptionsKind], *, element: str = "") -> tuple[OptionsKind, ...]:
    """Declare a repeated element that contains options."""
    return _declare(tuple[OptionsKind, ...], Option("block", element, options=options, repeated=True))


def without_effect(*, element: str = "") -> bool:
    """Declare an element that is known and changes nothing; its value is true if the file has the element."""
    return _declare(bool, Option("", element))
