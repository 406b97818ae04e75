"""Options of a plugin: a class whose fields say which element each is read from, its default, unit and bounds.

    class BeltOptions(Options):
        speed: float = number(0.5, "m/s", minimum=0.0)
        is_reversed: bool = boolean(element="reverse")

    class Belt(ModelPlugin):
        options = OptionsOf(BeltOptions)

        def load(self, parent, params):
            self._speed = self.options.speed

A field is read from the file when it is first used, and once: an element that a plugin does not need stays unread and
is reported. `simkit plugin info` shows the fields, and the report of an element that nobody read suggests their names.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Generic, Literal, Protocol, Self, TypeVar, overload

from simkit.params import Params
from simkit.pose import IDENTITY, Pose

OptionKind = Literal["number", "integer", "boolean", "text", "vector", "pose", "choice", "block", ""]
Value = TypeVar("Value")
OptionsKind = TypeVar("OptionsKind", bound="Options")
OptionsKind_co = TypeVar("OptionsKind_co", bound="Options", covariant=True)


class Options:
    """Options in one block of a file.

    Args:
        params: the block.

    Attributes:
        is_given: whether the file has the block.
    """

    def __init__(self, params: Params) -> None:
        self.params = params
        self.is_given = True

    @classmethod
    def fields(cls) -> dict[str, Option]:
        """The options by the names of their fields, those of base classes first."""
        return {name: v for c in reversed(cls.__mro__) for name, v in vars(c).items() if isinstance(v, Option)}

    def read_all(self) -> Self:
        """Read every option except live parameters, those of base classes last, so that all faults come together."""
        for kind in type(self).__mro__:
            for name, value in vars(kind).items():
                if isinstance(value, Option) and not value.is_live:
                    getattr(self, name)
        return self

    @classmethod
    def element_names(cls) -> Iterator[str]:
        """Names of all elements that are read, those within blocks too."""
        for option in cls.fields().values():
            yield option.element
            if option.options is not None:
                yield from option.options.element_names()

    def __deepcopy__(self, memo: dict[int, object]) -> Options:
        return self


@dataclass(eq=False)
class Option:
    """One element that a plugin reads; a field of a class of options.

    Attributes:
        kind: type of its value; empty where the element is known and has no effect.
        element: its name in the file, `@name` for an attribute; that of the field unless given.
        default: value where the file says nothing; of one that the code computes, how it is shown.
        unit: SI unit; empty where it has none.
        minimum, maximum: bounds of a number.
        finite: whether a number must be finite.
        choices: the words allowed.
        size: how many numbers a vector has.
        required: whether the file must have it.
        repeated: whether every element of that name counts.
        instead: field whose value is the default.
        options: class of the options in a block.
        is_live: whether it is a live parameter, which `Plugin.declare` reads.
        description: what it is, where its name does not tell.
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
        # from now on the attribute of the instance comes before this descriptor of its class
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
                return tuple(one.number(name, minimum=self.minimum, maximum=self.maximum) for one in params.each(name))
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
    """A plugin, as far as options know it."""

    params: Params


class OptionsOf(Generic[OptionsKind_co]):
    """The options of a plugin, read from its parameters; an attribute of its class.

    Args:
        kind: their class.
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
    """The classes of options that a plugin class declares, those of its bases first."""
    attributes = {name: v for c in reversed(cls.__mro__) for name, v in vars(c).items()}
    declared = (v.kind for v in attributes.values() if isinstance(v, OptionsOf))
    return list(dict.fromkeys((*declared, *getattr(cls, "option_types", ()))))


def _declare(kind: type[Value], option: Option) -> Value:  # noqa: ARG001 - for type checkers
    """Return an option that a type checker takes for the value of its field, which has the type `kind`."""
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
    """A number."""
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
    """The number in each element of that name."""
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
    """A whole number."""
    return _declare(int, Option("integer", element, default, minimum=minimum, maximum=maximum, required=required))


def boolean(default: bool = False, *, element: str = "", instead: str = "") -> bool:
    """True or false."""
    return _declare(bool, Option("boolean", element, default, instead=instead))


def text(default: str | None = "", *, element: str = "", required: bool = False, instead: str = "") -> str:
    """A text."""
    return _declare(str, Option("text", element, default, required=required, instead=instead))


def texts(*, element: str = "", required: bool = False) -> tuple[str, ...]:
    """The text of each element of that name."""
    return _declare(tuple[str, ...], Option("text", element, required=required, repeated=True))


def choice(allowed: Sequence[str], default: str | None = None, *, element: str = "", required: bool = False) -> str:
    """One of a few words."""
    return _declare(str, Option("choice", element, default, choices=tuple(allowed), required=required))


def vector(
    default: Sequence[float] | None, unit: str = "", *, element: str = "", size: int = 0, required: bool = False
) -> tuple[float, ...]:
    """Several numbers."""
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
    """Three numbers."""
    x, y, z = map(float, default)
    option = Option("vector", element, (x, y, z), unit, size=3, required=required, instead=instead)
    return _declare(tuple[float, float, float], option)


def pose(default: Pose = IDENTITY, *, element: str = "") -> Pose:
    """A pose: `x y z roll pitch yaw` [m, rad]."""
    return _declare(Pose, Option("pose", element, default, "m, rad"))


def block(options: type[OptionsKind], *, element: str = "") -> OptionsKind:
    """The options within an element, at their defaults where it is absent."""
    return _declare(options, Option("block", element, options=options))


def blocks(options: type[OptionsKind], *, element: str = "") -> tuple[OptionsKind, ...]:
    """The options within each element of that name."""
    return _declare(tuple[OptionsKind, ...], Option("block", element, options=options, repeated=True))


def without_effect(*, element: str = "") -> bool:
    """An element that is known and changes nothing; true where the file has it."""
    return _declare(bool, Option("", element))
