"""Messages of gz.msgs with the interface of protobuf's Python classes: a new message already has all its fields."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, ClassVar, Final, NamedTuple, TypeVar

from simkit.extend import did_you_mean

M = TypeVar("M", bound="Message")
PLAIN_DEFAULTS: Final[Mapping[str, object]] = {"f": 0.0, "i": 0, "s": "", "b": False, "y": b""}
"""Default value of a plain field by the letter of its kind: f number, i integer, s text, b boolean, y bytes."""


# Value of a field: a number, a text, bytes, a message, or a `Repeated` with values of one of these types.
FieldValue = Any


class Repeated(list[FieldValue]):
    """Repeated field; `add()` appends a message."""

    def __init__(self, kind: str, values: Iterable[object] = ()) -> None:
        super().__init__(values)
        self._kind = kind

    def add(self, **fields: object) -> Message:
        """Append a new message with these fields and return it."""
        message = MESSAGE_CLASSES[self._kind](**fields)
        self.append(message)
        return message

    def CopyFrom(self, other: Iterable[object]) -> None:  # noqa: N802 - protobuf's names
        self[:] = copy.deepcopy(list(other))

    def MergeFrom(self, other: Iterable[object]) -> None:  # noqa: N802
        self.extend(copy.deepcopy(list(other)))


class Descriptor(NamedTuple):
    """Names of a message class, with the interface of protobuf's descriptors."""

    name: str
    full_name: str


class Message:
    """Base class of all messages.

    Attributes:
        DESCRIPTOR: names of the class.
        FIELDS: kind of each field: a letter of `PLAIN_DEFAULTS` or the name of a message class, with `[]` at the end
            for a repeated field.
    """

    DESCRIPTOR: ClassVar[Descriptor]
    FIELDS: ClassVar[Mapping[str, str]] = {}
    __slots__ = ("_values",)
    _values: dict[str, FieldValue]

    def __init__(self, **fields: FieldValue) -> None:
        object.__setattr__(self, "_values", {})
        for name, value in fields.items():
            kind = type(self)._kind_of(name)
            if kind.endswith("[]"):
                getattr(self, name).extend(value)
            elif kind in PLAIN_DEFAULTS:
                setattr(self, name, value)
            else:
                getattr(self, name).CopyFrom(value if isinstance(value, Message) else MESSAGE_CLASSES[kind](**value))

    @classmethod
    def _kind_of(cls, name: str) -> str:
        kind = cls.FIELDS.get(name)
        if kind is None:
            hint = did_you_mean(name, cls.FIELDS) or f"its fields are {', '.join(cls.FIELDS)}"
            raise AttributeError(f"gz.msgs.{cls.__name__} has no field {name!r}; {hint}")
        return kind

    def __getattr__(self, name: str) -> FieldValue:
        if name.startswith("_"):
            raise AttributeError(name)
        values = self._values
        if name not in values:
            kind = type(self)._kind_of(name)
            if kind.endswith("[]"):
                values[name] = Repeated(kind[:-2])
            elif kind in PLAIN_DEFAULTS:
                return PLAIN_DEFAULTS[kind]
            else:
                values[name] = MESSAGE_CLASSES[kind]()
        return values[name]

    def __setattr__(self, name: str, value: FieldValue) -> None:
        kind = type(self)._kind_of(name)
        if kind not in PLAIN_DEFAULTS:
            raise AttributeError(f"{name} of gz.msgs.{type(self).__name__} cannot be assigned to; use CopyFrom")
        start = PLAIN_DEFAULTS[kind]
        if isinstance(start, bool):
            value = bool(value)
        elif isinstance(start, int):
            if value != int(value):
                raise TypeError(f"{name} of gz.msgs.{type(self).__name__} is a whole number, got {value!r}")
            value = int(value)
        elif isinstance(start, float):
            value = float(value)
        elif not isinstance(value, type(start)):
            expected = type(start).__name__
            raise TypeError(f"{name} of gz.msgs.{type(self).__name__} is a {expected}, got {value!r}")
        self._values[name] = value

    def CopyFrom(self, other: Message) -> None:  # noqa: N802 - protobuf's names
        """Copy all fields from another message."""
        self._values.clear()
        self._values.update(copy.deepcopy(other._values))

    def Clear(self) -> None:  # noqa: N802
        self._values.clear()

    def HasField(self, name: str) -> bool:  # noqa: N802
        """Check whether a plain field was set, or a nested message or repeated field was read or set."""
        type(self)._kind_of(name)
        return name in self._values

    def ListFields(self) -> list[tuple[str, object]]:  # noqa: N802
        """Return names and values of all fields that differ from their defaults."""
        return [(name, getattr(self, name)) for name in self.FIELDS if not _is_empty(self._values.get(name))]

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other) or not isinstance(other, Message):
            return False
        return all(getattr(self, name) == getattr(other, name) for name in self.FIELDS)

    __hash__ = None  # type: ignore[assignment]

    def __deepcopy__(self: M, memo: dict[int, object]) -> M:
        copied = type(self)()
        copied._values.update({name: copy.deepcopy(value, memo) for name, value in self._values.items()})
        return copied

    def __reduce__(self) -> tuple[object, ...]:
        return (_unpickle_message, (type(self).__name__, dict(self._values)))

    def __repr__(self) -> str:
        return _format_message(self, "")


def _unpickle_message(name: str, values: dict[str, object]) -> Message:
    message = MESSAGE_CLASSES[name]()
    message._values.update(values)
    return message


def __getattr__(name: str) -> type[Message]:
    try:  # pickle looks for the generated classes here
        return MESSAGE_CLASSES[name]
    except KeyError:
        raise AttributeError(name) from None


def _is_empty(value: object) -> bool:
    return value is None or value in (0, "", b"", []) or (isinstance(value, Message) and not value.ListFields())


def _format_message(message: Message, indent: str) -> str:
    lines = []
    for name, value in message.ListFields():
        for item in value if isinstance(value, list) else [value]:
            if isinstance(item, Message):
                lines.append(f"{indent}{name} {{\n{_format_message(item, indent + '  ')}{indent}}}\n")
            else:
                shown = f'"{item}"' if isinstance(item, str) else item
                lines.append(f"{indent}{name}: {shown}\n")
    return "".join(lines)


def _read_classes(text: str) -> Iterator[type[Message]]:
    """Yield a message class for each line of `gz_messages.txt`; the comment in that file describes the format."""
    for line in text.splitlines():
        if not line.startswith("#"):
            name, *words = line.split()
            fields = dict(word.split(":") for word in words if ":" in word)
            constants = {key: int(number) for key, number in (word.split("=") for word in words if "=" in word)}
            members = {
                "DESCRIPTOR": Descriptor(name, f"gz.msgs.{name}"),
                "FIELDS": fields,
                "__slots__": (),
                **constants,
            }
            yield type(name, (Message,), {**members, "__module__": __name__})


_DEFINITIONS: Final = Path(__file__).with_name("gz_messages.txt").read_text(encoding="utf-8")
MESSAGE_CLASSES: Final[Mapping[str, type[Message]]] = MappingProxyType(
    {cls.__name__: cls for cls in _read_classes(_DEFINITIONS)}
)
"""Message classes by name."""
