"""Calls and attributes, as far as they can be followed."""

from __future__ import annotations

import functools
import inspect
import math
from collections.abc import ItemsView, KeysView, ValuesView
from dataclasses import fields, is_dataclass
from types import FunctionType, MethodType, ModuleType
from typing import TYPE_CHECKING, Any, Final

from simkit.params import Params
from simkit.plugins.authoring.abstract_values import (
    Block,
    Bound,
    Closure,
    Either,
    Given,
    Hole,
    Made,
    Record,
    Table,
    Template,
    alternatives,
    either,
    is_known,
    joined,
    noun,
)
from simkit.plugins.authoring.observed_calls import OPENS, Asked
from simkit.plugins.authoring.plugin_facts import Parameter
from simkit.plugins.base import Plugin
from simkit.plugins.gz_python.sdformat import Element

if TYPE_CHECKING:
    from simkit.plugins.authoring.source_interpreter import Interpreter

_OF_TEXT: Final = {"strip", "rstrip", "lstrip", "removeprefix", "removesuffix", "split", "rsplit", "replace", "lower"}
_CHANGES: Final = {"append", "add", "extend", "update"}
_LOOKS: Final = {"get", "items", "keys", "values", "index", "count"}
_MOST: Final = 64
_CAUTIOUS: Final[set[Any]] = {str, float, int, bool, len, max, min, sum, abs, repr}
"""Of these the result is known only where the arguments are."""
_PLAIN: Final[set[Any]] = _CAUTIOUS | {list, tuple, dict, set, sorted, range, zip, enumerate, reversed}


class Calls:
    """What calling something does, for an interpreter that only reads."""

    def __init__(self, reader: Interpreter) -> None:
        self._reader = reader
        self.asked = Asked(reader, product_types)

    # ------------------------------------------------------------------ attributes

    def attribute(self, owner: Any, name: str) -> Any:
        """An attribute of a value."""
        if isinstance(owner, Either):
            return either(*(self.attribute(v, name) for v in owner.values))
        if isinstance(owner, Record):
            return self._of_record(owner, name)
        if isinstance(owner, Block):
            if name == "value":
                self.asked.note(Parameter(owner.path, "text", repeated=owner.many)) if owner.path else None
                return Given(owner.path, None)
            if name == "children":
                return [Block((*owner.path, "*"), many=True)]
            if name == "name" and owner.path:
                return owner.path[-1]
            return Bound(getattr(Params, name, getattr(Element, name, print)), owner)
        if isinstance(owner, Hole):
            if owner.label == "sensor" and name in _sensor_methods():
                method, cls = _sensor_methods()[name]
                return Bound(method, Record(cls))
            return Bound(getattr(str, name), owner) if name in _OF_TEXT else Hole(_label(owner.label, name))
        if isinstance(owner, (Given, Template)):
            return Bound(getattr(str, name, print), owner)
        if isinstance(owner, (Closure, Bound)):
            return Hole(name)
        try:
            return getattr(owner, name)
        except Exception:  # noqa: BLE001 - a property of somebody's object may do anything
            return Hole(name)

    def _of_record(self, owner: Record, name: str) -> Any:
        if issubclass(owner.cls, Plugin) and name == "params":
            return Block()
        if name in owner.fields:
            return owner.fields[name]
        if issubclass(owner.cls, Plugin):
            if name in {"sim", "log", "ros", "where", "source", *OPENS}:
                return Hole(name)
            if name in {"name", "scoped"}:
                return Hole("plugin" if name == "name" else "entity")
        found = inspect.getattr_static(owner.cls, name, None)
        if isinstance(found, property) and isinstance(found.fget, FunctionType):
            return self._reader.call(found.fget, [owner], {})
        if isinstance(found, FunctionType):
            return Bound(found, owner)
        if isinstance(found, (classmethod, staticmethod)):
            return getattr(owner.cls, name)
        return Hole(name) if found is None or inspect.isdatadescriptor(found) else found

    # ------------------------------------------------------------------ calls

    def call(self, function: Any, args: list[Any], named: dict[str, Any], line: str) -> Any:
        """What a call gives back."""
        if isinstance(function, Either):
            return either(*(self.call(v, args, named, line) for v in function.values))
        if isinstance(function, Bound):
            return self._bound(function, args, named, line)
        if isinstance(function, Hole):
            return self.asked.unknown(function.label, args, named)
        if isinstance(function, MethodType) and isinstance(function.__self__, type):
            return self._followed(function.__func__, [function.__self__, *args], named)
        if isinstance(function, Closure):
            return self._reader.call(function, args, named)
        if inspect.isclass(function) and function not in _PLAIN:
            return self._made(function, args, named)
        if isinstance(function, FunctionType):
            return self._followed(function, args, named)
        return self._built_in(function, args, named)

    def _bound(self, function: Bound, args: list[Any], named: dict[str, Any], line: str) -> Any:
        owner, name = function.owner, function.function.__name__
        if isinstance(owner, Block):
            return self.asked.of_params(owner, name, args, named, line)
        if isinstance(owner, (Given, Template, Hole)):
            return owner if name in _OF_TEXT else Hole("value")
        if name == "publish_on":
            return self.asked.publish_on(name, args, named)
        return self._followed(function.function, [owner, *args], named)

    def _followed(self, function: Any, args: list[Any], named: dict[str, Any]) -> Any:
        """Follows functions of simkit and of whoever wrote the plugin, where what is looked for can be in them."""
        everything = [*args, *named.values()]
        if "topic" in function.__name__ and len(everything) == 1 and isinstance(everything[0], (str, Given, Either)):
            return everything[0]  # whatever makes a valid name of it, it is still the one that it was given
        own = str(function.__module__ or "").split(".")[0] in {"simkit", "simkit_user_plugins"}
        own = own or function.__module__ == self._reader.module
        if own and isinstance(function, FunctionType) and any(_is_of_interest(v) for v in everything):
            given = self._reader.call(function, args, named)
            if not isinstance(given, Hole) and given is not None:
                return given
        if "topic" in function.__name__:
            return next((v for v in everything if isinstance(v, (str, Given, Either))), Hole("topic"))
        return Hole(noun(function.__name__))

    def _made(self, cls: type[Any], args: list[Any], named: dict[str, Any]) -> Any:
        """An instance of a class."""
        if cls is Params:
            inner = next((v for v in (*args, *named.values()) for v in _within(v) if isinstance(v, Block)), None)
            return Block(inner.path[:-1], inner.many) if inner else Block(("…",))
        made = Record(cls)
        if is_dataclass(cls):
            names = [f.name for f in fields(cls) if f.init]
            made.fields = {**dict(zip(names, args, strict=False)), **named}
        elif cls.__module__.split(".")[0] == "simkit" or cls.__module__ == self._reader.module:
            start = inspect.getattr_static(cls, "__init__", None)
            if isinstance(start, FunctionType):
                self._reader.call(start, [made, *args], named)
        return made

    def _change(self, owner: Made | Table, how: str, args: list[Any]) -> None:
        """What `append` and its like do to a list or a dict that the code itself has made."""
        if isinstance(owner, Made) and len(args) == 1 and len(owner) < _MOST:
            owner += args[0] if how == "extend" and isinstance(args[0], (list, tuple)) else [args[0]]
        elif isinstance(owner, Table) and how == "update" and args and isinstance(args[0], dict):
            owner.update(args[0])

    def _built_in(self, function: Any, args: list[Any], named: dict[str, Any]) -> Any:
        if isinstance(function, ModuleType) or not callable(function):
            return Hole("value")
        if function is getattr and len(args) > 1 and isinstance(args[1], str):
            return self.attribute(args[0], args[1])
        owner = getattr(function, "__self__", None)
        if isinstance(owner, (Made, Table)) and function.__name__ in _CHANGES:
            self._change(owner, function.__name__, args)
            return None
        if isinstance(owner, str) and function.__name__ in _OF_TEXT and not all(map(is_known, args)):
            return owner
        if isinstance(owner, str) and function.__name__ == "join" and args and isinstance(args[0], (list, tuple)):
            parts = [v for part in args[0] for v in (owner, part)]
            return joined(parts[1:])
        name = getattr(function, "__name__", "value")
        simple = function in _PLAIN if _is_hashable(function) else False
        cautious = not simple or function in _CAUTIOUS
        looks = isinstance(owner, (tuple, list, dict)) and name in _LOOKS  # what would change them is not called
        simple = simple or looks or isinstance(owner, str) or getattr(math, name, None) is function
        given = [v for v in args if isinstance(v, Given)]
        if simple and cautious and len(given) == 1:
            return given[0]  # max(0.0, what the file gives)
        if not simple or (cautious and not all(map(is_known, [*args, *named.values()]))):
            return Hole(noun(name))
        try:
            found = function(*args, **named)
        except Exception:  # noqa: BLE001 - what does not work for what is known is not known
            return Hole("value")
        return list(found) if isinstance(found, (zip, enumerate, reversed, KeysView, ValuesView, ItemsView)) else found


@functools.cache
def _sensor_methods() -> dict[str, tuple[FunctionType, type[Any]]]:
    """What a kind of sensor has and not every one, by name: a plugin that asks for it hangs on that kind."""
    from simkit.sensors import sensor_kinds

    found: dict[str, tuple[FunctionType, type[Any]]] = {}
    for cls in dict.fromkeys(sensor_kinds().values()):
        for name, member in vars(cls).items():
            if isinstance(member, FunctionType) and not name.startswith("_") and not hasattr(cls.__mro__[1], name):
                found.setdefault(name, (member, cls))
    return found


@functools.cache
def product_types() -> dict[str, tuple[str, ...]]:
    """The types that sensors publish by the names of their products, `imu` and `image`."""
    from simkit.plugins.authoring.source_interpreter import Interpreter
    from simkit.sensors import sensor_kinds

    found: dict[str, dict[str, None]] = {}
    for kind in dict.fromkeys(sensor_kinds().values()):
        for given in alternatives(Interpreter(kind).method("products")):
            for name, product in given.items() if isinstance(given, dict) else ():
                types = product.fields.get("type_name") if isinstance(product, Record) else None
                found.setdefault(name, {}).update({str(t): None for t in alternatives(types) if isinstance(t, str)})
    return {name: tuple(types) for name, types in found.items()}


def _is_of_interest(value: Any) -> bool:
    """Whether a function that is given it may read parameters or open topics."""
    return any(isinstance(v, (Block, Record, Given, Template)) for v in _within(value)) or (
        isinstance(value, Hole) and value.label == "sim"
    )


def _within(value: Any) -> list[Any]:
    return [v for part in value for v in _within(part)] if isinstance(value, (list, tuple)) else [value]


def _label(owner: str, attribute: str) -> str:
    """What to call an attribute: of `model.name` it is the model."""
    if attribute in {"name", "scoped", "value", "id"}:
        return owner.rsplit(".", 1)[-1]
    return attribute


def _is_hashable(value: Any) -> bool:
    try:
        hash(value)
    except TypeError:
        return False
    return True
