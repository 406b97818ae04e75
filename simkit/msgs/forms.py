"""Messages from plain values: missing fields are zero, dicts become messages, whatever does not fit is said."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from typing import Any

import numpy as np

from simkit.diagnostics import did_you_mean
from simkit.errors import MessageError
from simkit.msgs.store import full_name, type_store

_BASE, _NAME, _ARRAY, _SEQUENCE = 1, 2, 3, 4  # rosbags.interfaces.Nodetype

_INTEGERS: dict[str, tuple[int, int]] = {
    **{f"int{n}": (-(1 << (n - 1)), (1 << (n - 1)) - 1) for n in (8, 16, 32, 64)},
    **{f"uint{n}": (0, (1 << n) - 1) for n in (8, 16, 32, 64)},
    "byte": (0, 255),
    "char": (0, 255),
}
_DTYPES = {"byte": "uint8", "char": "uint8", "bool": "bool"}

# The defaults that ROS gives other than zero.
_DEFAULTS: dict[tuple[str, str], float] = {("geometry_msgs/msg/Quaternion", "w"): 1.0}

_Slot = tuple[str, Callable[[], Any], Callable[[Any], Any]]


class Form:
    """How one message type is filled."""

    def __init__(self, name: str) -> None:
        store = type_store()
        self.name = name
        self.cls: type[Any] = store.types[name]
        self.slots: list[_Slot] = []
        for field, node in store.fielddefs[name][1]:
            zero, take = _field(node)
            default = _DEFAULTS.get((name, field))
            if default is not None:
                zero = partial(float, default)
            attribute = field + "_" if field in _KEYWORDS else field
            self.slots.append((attribute, zero, take))
        self._zeros = [zero for _, zero, _ in self.slots]

    def zero(self) -> Any:
        """A message with every field zero."""
        return self.cls(*[zero() for zero in self._zeros])

    def build(self, fields: Mapping[str, Any]) -> Any:
        """A message of the given fields; the others are zero.

        Raises:
            MessageError: an unknown field, or a value that does not fit.
        """
        values = []
        found = 0
        for name, zero, take in self.slots:
            if name in fields:
                found += 1
                try:
                    values.append(take(fields[name]))
                except MessageError as error:
                    raise MessageError(f"{self.name}.{name}: {error}") from None
                except (TypeError, ValueError, OverflowError) as error:
                    raise MessageError(f"{self.name}.{name}: found {_short(fields[name])}: {error}") from None
            else:
                values.append(zero())
        if found != len(fields):
            known = [name for name, _, _ in self.slots]
            unknown = next(name for name in fields if name not in known)
            hint = did_you_mean(str(unknown), known) or f"its fields are {', '.join(known)}"
            raise MessageError(f"{self.name} has no field {unknown!r}; {hint}")
        return self.cls(*values)

    def take(self, value: Any) -> Any:
        """A message as it is, or a dict made into one."""
        if type(value) is self.cls:
            return value
        if isinstance(value, Mapping):
            return self.build(value)
        if getattr(value, "__msgtype__", None) == self.name:
            return value
        raise MessageError(f"found {_short(value)}, allowed is a {self.name} or a dict of its fields")


_KEYWORDS = frozenset({"from", "in", "is", "not", "or", "and", "as", "if", "pass", "class", "lambda", "global"})


@cache
def form_of(type_name: str) -> Form:
    """The form of a type; short names are taken too."""
    return Form(full_name(type_name))


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _field(node: Any) -> tuple[Callable[[], Any], Callable[[Any], Any]]:
    """The zero and the conversion of one field, from its description in the type store."""
    kind, what = int(node[0]), node[1]
    if kind == _NAME:
        form = form_of(what)
        return form.zero, form.take
    if kind == _BASE:
        return _scalar(what[0])
    (inner_kind, inner), size = what
    length = size if kind == _ARRAY else 0
    bound = size if kind == _SEQUENCE and size else None
    if int(inner_kind) == _BASE and inner[0] != "string":
        dtype = np.dtype(_DTYPES.get(inner[0], inner[0]))
        return partial(np.zeros, length, dtype), partial(_numbers, dtype, length or None, bound)
    zero, take = _scalar("string") if int(inner_kind) == _BASE else (form_of(inner).zero, form_of(inner).take)
    return (lambda: [zero() for _ in range(length)]), partial(_items, take, length or None, bound)


def _scalar(name: str) -> tuple[Callable[[], Any], Callable[[Any], Any]]:
    if name == "string":
        return str, _text
    if name == "bool":
        return bool, _boolean
    if name in _INTEGERS:
        return int, partial(_integer, *_INTEGERS[name])
    return float, _float


def _float(value: Any) -> float:
    if isinstance(value, (str, bytes, bool)):
        raise MessageError(f"found {_short(value)}, allowed is a number")
    return float(value)


def _integer(low: int, high: int, value: Any) -> int:
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    number = operator.index(value)
    if not low <= number <= high:
        raise MessageError(f"found {number}, allowed is a whole number from {low} to {high}")
    return number


def _boolean(value: Any) -> bool:
    if value is True or value is False or isinstance(value, np.bool_):
        return bool(value)
    raise MessageError(f"found {_short(value)}, allowed is true or false")


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise MessageError(f"found {_short(value)}, allowed is a text")
    return value


def _check_length(count: int, length: int | None, bound: int | None) -> None:
    if length is not None and count != length:
        raise MessageError(f"found {count} entries, allowed is {length}")
    if bound is not None and count > bound:
        raise MessageError(f"found {count} entries, allowed is at most {bound}")


def _numbers(dtype: np.dtype[Any], length: int | None, bound: int | None, value: Any) -> Any:
    if type(value) is np.ndarray and value.dtype == dtype and value.ndim == 1:
        array = value
    elif isinstance(value, (bytes, bytearray, memoryview)):
        array = np.frombuffer(value, np.uint8).astype(dtype, copy=False)
    else:
        array = np.asarray(value)
        if array.size and (array.dtype.kind not in "biuf" or (dtype.kind in "iu" and array.dtype.kind == "f")):
            raise MessageError(f"found {_short(value)}, allowed is a list of {dtype}")
        array = array.astype(dtype).reshape(-1)
    _check_length(len(array), length, bound)
    return array


def _items(take: Callable[[Any], Any], length: int | None, bound: int | None, value: Any) -> list[Any]:
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, (Sequence, np.ndarray)):
        raise MessageError(f"found {_short(value)}, allowed is a list")
    _check_length(len(value), length, bound)
    return [take(item) for item in value]
