"""What is known of a value when a program is read and not run."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

_MOST = 4  # values that one name is followed through


@dataclass(frozen=True)
class Hole:
    """A value that only a run knows; `label` says in a word what it is (`joint`)."""

    label: str

    def __repr__(self) -> str:
        return "{" + self.label + "}"


class Template(str):
    """A text with holes: `/model/{model}/cmd_vel`."""

    __slots__ = ()


@dataclass(frozen=True)
class Block:
    """A `Params`: the elements above it and its own, none for the plugin's; `many` where it is one of several."""

    path: tuple[str, ...] = ()
    many: bool = False


@dataclass(frozen=True)
class Given:
    """What a file gives in an element, or else a default (a value of this kind again)."""

    path: tuple[str, ...]
    default: Any


@dataclass(frozen=True)
class Either:
    """One of several values, depending on the file."""

    values: tuple[Any, ...]


@dataclass
class Record:
    """An instance of a class, with what is known of its attributes."""

    cls: type[Any]
    fields: dict[str, Any] = field(default_factory=dict)


class Made(list[Any]):
    """A list that the code under inspection makes; lists that are there already are never changed."""


class Table(dict[Any, Any]):
    """A dict that the code under inspection makes."""


@dataclass
class Closure:
    """A function written within another, or a lambda, with the names around it."""

    node: ast.FunctionDef | ast.Lambda
    scope: Scope


@dataclass(frozen=True)
class Bound:
    """A method with its instance."""

    function: Callable[..., Any]
    owner: Any


@dataclass
class Scope:
    """Names of a function: its own, then those around it, then the module's."""

    module: ModuleType
    names: dict[str, Any] = field(default_factory=dict)
    outer: Scope | None = None

    def find(self, name: str) -> Any:
        """The value of a name; a hole where there is none."""
        scope: Scope | None = self
        while scope is not None:
            if name in scope.names:
                return scope.names[name]
            scope = scope.outer
        if hasattr(self.module, name):
            return getattr(self.module, name)
        builtins: Mapping[str, Any] = vars(__import__("builtins"))
        return builtins.get(name, Hole(name))


def is_known(value: Any) -> bool:
    """Whether the value is the one of every run."""
    if isinstance(value, (Hole, Template, Block, Given, Either, Record, Closure, Bound)):
        return False
    if isinstance(value, (tuple, list, set, frozenset)):
        return all(map(is_known, value))
    if isinstance(value, dict):
        return all(is_known(v) for pair in value.items() for v in pair)
    return True


def alternatives(value: Any) -> tuple[Any, ...]:
    """What a value may be, one by one."""
    return value.values if isinstance(value, Either) else (value,)


def either(*values: Any) -> Any:
    """One of the values; a hole only where nothing else is known."""
    found: list[Any] = []
    for value in (a for v in values for a in alternatives(v)):
        if not any(same(value, other) for other in found):
            found.append(value)
    told = [v for v in found if not isinstance(v, Hole) and v is not None] or found
    if len(told) > 1 and all(isinstance(v, Record) for v in told) and len({v.cls for v in told}) == 1:
        names = dict.fromkeys(name for v in told for name in v.fields)
        return Record(told[0].cls, {n: either(*(v.fields[n] for v in told if n in v.fields)) for n in names})
    if not told:
        return None
    return told[0] if len(told) == 1 else Either(tuple(told[:_MOST]))


def same(one: Any, other: Any) -> bool:
    """Whether two values are equal as far as anybody can tell."""
    if one is other:
        return True
    try:
        return type(one) is type(other) and bool(one == other)
    except Exception:  # noqa: BLE001 - an array compares as an array
        return False


def text_of(value: Any) -> str:
    """A value as a part of a text."""
    if isinstance(value, Given):
        shown = text_of(value.default)
        return shown if shown and value.default is not None else "{" + "/".join(value.path) + "}"
    if isinstance(value, Either):
        return text_of(value.values[0])
    if isinstance(value, (Record, Closure, Bound, Block)):
        return "{…}"
    return str(value)


def joined(parts: list[Any]) -> str:
    """Texts and holes as one text."""
    text = "".join(text_of(p) for p in parts)
    return text if all(is_known(p) for p in parts) else Template(text)


def elements(value: Any) -> Iterator[Any] | None:
    """The values that a loop goes through; None where only a run knows them."""
    if isinstance(value, (tuple, list, range, set, frozenset, dict)) and len(value) <= 64:
        return iter(list(value))
    return None


def noun(name: str) -> str:
    """What a function gives, by its name: `find_axis_joint` gives a joint."""
    return name.strip("_").rsplit("_", 1)[-1] or "value"
