"""Builder of messages from plain values: dicts become messages, numbers arrays; missing fields have their defaults."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial

import numpy as np
import numpy.typing as npt

from simkit.argument_checks import shown
from simkit.diagnostics import did_you_mean
from simkit.errors import MessageError
from simkit.msgs.definition_parser import ARRAY, BASE, INTEGER_RANGES, NAME, SEQUENCE, TEXTS, FieldNode
from simkit.msgs.message_types import FieldValue, Message, definition_of, full_name, type_store
from simkit.msgs.shipped_interfaces import NO_FIELD, rosbags_defaults
from simkit.number_text import counted

_DTYPES = {"byte": "uint8", "char": "uint8", "bool": "bool"}

_LARGEST_FLOAT32 = float.fromhex("0x1.ffffffp+127")  # larger numbers do not round to a finite one
_Default = Callable[[], FieldValue]
_Conversion = Callable[[FieldValue], FieldValue]


class MessageBuilder:
    """Builds messages of one type.

    Attributes:
        name: full name of the type.
        cls: dataclass of the type.
        fields: attribute, default and conversion of each field, in order.
    """

    def __init__(self, name: str) -> None:
        from rosbags.typesys.base import normalize_fieldname

        store = type_store()
        self.name = name
        self.cls: type[Message] = store.types[name]
        self.fields: list[tuple[str, _Default, _Conversion]] = []
        definition = definition_of(name)
        published = definition.defaults if definition else rosbags_defaults(name)
        for field, node in store.fielddefs[name][1]:
            default, convert = _default_and_conversion(node)
            value = published.get(field)
            default = default if value is None else partial(convert, value)
            self.fields.append((normalize_fieldname(field), default, convert))
        self._defaults = [default for _, default, _ in self.fields]

    def default(self) -> Message:
        """Return a message with every field at its default."""
        return self.cls(*[default() for default in self._defaults])

    def build(self, fields: Mapping[str, FieldValue]) -> Message:
        """Return a message of the given fields; all other fields have their defaults.

        Raises:
            MessageError: a field is unknown, or a value does not match its field.
        """
        values = []
        taken = 0
        for name, default, convert in self.fields:
            if name in fields:
                taken += 1
                try:
                    values.append(convert(fields[name]))
                except MessageError as error:
                    raise MessageError(f"{self.name}.{name}: {error}") from None
                except (TypeError, ValueError, OverflowError):  # of an object of the caller
                    text = f"{self.name}.{name}: found {_short(fields[name])}, which does not match the field"
                    raise MessageError(text) from None
            else:
                values.append(default())
        if taken != len(fields):
            known = [name for name, _, _ in self.fields if name != NO_FIELD]
            unknown = next(name for name in fields if name not in known)
            hint = did_you_mean(str(unknown), known) or f"its fields: {', '.join(known) or 'none'}"
            raise MessageError(f"{self.name} has no field {unknown!r}; {hint}")
        return self.cls(*values)

    def convert(self, value: FieldValue) -> Message:
        """Return a message unchanged; build a message from a dict."""
        if type(value) is self.cls:
            return value
        if isinstance(value, Mapping):
            return self.build(value)
        if getattr(value, "__msgtype__", None) == self.name:
            return value
        raise MessageError(f"found {_short(value)}; expected a {self.name} or a dict of its fields")


@cache
def builder_of(type_name: str) -> MessageBuilder:
    """Return the builder of a type; short names are allowed."""
    return MessageBuilder(full_name(type_name))


def _short(value: object) -> str:
    text = shown(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _default_and_conversion(node: FieldNode) -> tuple[_Default, _Conversion]:
    """Return a factory for the default and a conversion function, for a field with this type."""
    kind, content = int(node[0]), node[1]
    if kind == NAME:
        builder = builder_of(content)
        return builder.default, builder.convert
    if kind == BASE:
        return _scalar(*content)
    (inner_kind, inner), size = content
    length = size if kind == ARRAY else 0
    bound = size if kind == SEQUENCE and size else None
    if int(inner_kind) == BASE and inner[0] not in TEXTS:
        dtype = np.dtype(_DTYPES.get(inner[0], inner[0]))
        return partial(np.zeros, length, dtype), partial(_numbers, dtype, length or None, bound)
    default, convert = _default_and_conversion((inner_kind, inner))
    return (lambda: [default() for _ in range(length)]), partial(_items, convert, length or None, bound)


def _scalar(name: str, bound: int) -> tuple[_Default, _Conversion]:
    if name in TEXTS:
        return str, partial(_bounded_text, bound) if bound else _text
    if name == "bool":
        return bool, _boolean
    if name in INTEGER_RANGES:
        return int, partial(_integer, *INTEGER_RANGES[name])
    return float, _float32 if name == "float32" else _float


def _float(value: FieldValue) -> float:
    if isinstance(value, (str, bytes, bool)):
        raise MessageError(f"found {_short(value)}; expected a number")
    try:
        return float(value)
    except TypeError:
        raise MessageError(f"found {_short(value)}; expected a number") from None
    except OverflowError:
        raise MessageError(f"found {_short(value)}; expected a number below 1.8e308") from None


def _float32(value: FieldValue) -> float:
    number = _float(value)
    if _LARGEST_FLOAT32 < abs(number) < math.inf:
        raise MessageError(f"found {_short(value)}; expected a number below 3.4e38")
    return number


def _integer(low: int, high: int, value: FieldValue) -> int:
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    try:
        number = operator.index(value)
    except TypeError:
        raise MessageError(f"found {_short(value)}; expected a whole number from {low} to {high}") from None
    if not low <= number <= high:
        raise MessageError(f"found {_short(number)}; expected a whole number from {low} to {high}")
    return number


def _boolean(value: FieldValue) -> bool:
    if value is True or value is False or isinstance(value, np.bool_):
        return bool(value)
    raise MessageError(f"found {_short(value)}; expected true or false")


def _text(value: FieldValue) -> str:
    if not isinstance(value, str):
        raise MessageError(f"found {_short(value)}; expected a text")
    if not value.isascii():
        try:
            value.encode()
        except UnicodeEncodeError:
            raise MessageError(f"found {_short(value)}; expected a text that UTF-8 can represent") from None
    return value


def _bounded_text(bound: int, value: FieldValue) -> str:
    text = _text(value)
    if len(text) > bound:
        raise MessageError(f"found {counted(len(text), 'character')}; expected at most {bound}")
    return text


def _check_length(count: int, length: int | None, bound: int | None) -> None:
    if length is not None and count != length:
        raise MessageError(f"found {count} entries; expected {length}")
    if bound is not None and count > bound:
        raise MessageError(f"found {count} entries; expected at most {bound}")


def _numbers(
    dtype: np.dtype[np.generic], length: int | None, bound: int | None, value: FieldValue
) -> npt.NDArray[np.generic]:
    if type(value) is np.ndarray and value.dtype == dtype and value.ndim == 1:
        array = value
    elif isinstance(value, (bytes, bytearray, memoryview)):
        array = np.frombuffer(value, np.uint8).astype(dtype, copy=False)
    else:
        try:
            array = _converted(dtype, value)
        except (TypeError, ValueError, ArithmeticError):  # lists of different lengths, numbers out of range
            raise MessageError(f"found {_short(value)}; expected a list of {dtype}") from None
    _check_length(len(array), length, bound)
    return array


def _converted(dtype: np.dtype[np.generic], value: FieldValue) -> npt.NDArray[np.generic]:
    """Return a list of numbers as a flat array.

    Raises:
        TypeError, ValueError, ArithmeticError: the list has other values, or numbers that the type cannot hold.
    """
    array = np.asarray(value)
    if array.dtype == np.float64 and dtype == np.uint64:
        array = np.asarray(value, object)  # NumPy converts a list with numbers above 2**63 to float64
        array = array.astype(dtype) if all(isinstance(item, int) for item in array.flat) else np.asarray(value)
    if array.size and (array.dtype.kind not in "biuf" or (dtype.kind in "iu" and array.dtype.kind == "f")):
        raise TypeError
    if array.size and array.dtype != dtype and dtype.kind in "iu":
        low, high = INTEGER_RANGES[dtype.name]
        if int(array.min()) < low or int(array.max()) > high:  # NumPy would wrap the numbers around
            raise OverflowError
    with np.errstate(over="raise"):
        return array.astype(dtype).reshape(-1)


def _items(convert: _Conversion, length: int | None, bound: int | None, value: FieldValue) -> list[FieldValue]:
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, (Sequence, np.ndarray)):
        raise MessageError(f"found {_short(value)}; expected a list")
    _check_length(len(value), length, bound)
    return [convert(item) for item in value]
