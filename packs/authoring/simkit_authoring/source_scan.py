"""Scanner of a plugin's source for parameters, topics and services whose names are literals.

The source is parsed, not executed. The scan reads the methods of the class and its base classes, and the functions of
the same modules that these methods call. A part of a name that is known only in a run becomes a placeholder `{…}`.
"""

from __future__ import annotations

import ast
import functools
import inspect
import sys
import textwrap
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from types import FunctionType, ModuleType
from typing import Final

from simkit import Plugin
from simkit.extend import Options
from simkit.packs import is_shipped_module
from simkit_authoring.plugin_facts import Facts, Parameter, Service, Topic, merged, merged_topics, unit_of

_READERS: Final = {
    **{name: name for name in ("text", "number", "integer", "boolean", "vector", "pose", "choice")},
    "vector3": "vector",
    "child": "",
    "block": "",
    "all": "",
    "has": "",
    "each": "",
    "attribute": "text",
    # methods of sdformat's Element, with which gz systems read their parameters
    "find_element": "",
    "get_element": "",
    "has_element": "",
    "get_string": "text",
    "get_bool": "boolean",
    **dict.fromkeys(("get_int", "get_uint", "get_uint64"), "integer"),
    **dict.fromkeys(("get_double", "get_float", "get_angle"), "number"),
    **dict.fromkeys(("get_vector2d", "get_vector2i", "get_vector3d", "get_quaterniond", "get_color"), "vector"),
    "get_pose": "pose",
}
_ARGUMENTS: Final = {
    "vector": ("size", "default", "required"),
    "choice": ("allowed", "default", "required"),
    "number": ("default", "required", "minimum", "maximum"),
    "integer": ("default", "required", "minimum", "maximum"),
}
_INNER: Final = {"child", "block", "all", "find_element", "get_element"}
_DEEPEST: Final = 12


@dataclass
class _Function:
    """Syntax tree of a function, with its module, its source lines and the values assigned to its local names."""

    node: ast.FunctionDef
    module: ModuleType
    lines: list[str]
    assignments: dict[str, ast.expr] = field(default_factory=dict)

    @property
    def blocks(self) -> frozenset[str]:
        """Names of the variables with the plugin's parameters, including the arguments of `load` and `configure`."""
        arguments = [argument.arg for argument in self.node.args.args]
        is_hook = self.node.name in ("load", "prepare", "configure")
        return frozenset(
            ("params", "sdf", *(arguments[-1:] if self.node.name == "load" else arguments[:3] if is_hook else ()))
        )


def scan(cls: type, parent: str) -> Facts:
    """Return the parameters, topics and services in the source of a class.

    Args:
        cls: class to scan.
        parent: kind of entity that the plugin is attached to, as placeholder in the names of topics.
    """
    return _Scan(parent).run([c for c in reversed(cls.__mro__) if c not in Plugin.__mro__])


def scan_function(function: object) -> Facts:
    """Return the parameters, topics and services in the source of a function, such as a gz system's `configure`."""
    return _Scan("model").run([function]) if isinstance(function, FunctionType) else Facts()


class _Scan:
    """Scan of one class or function.

    Args:
        parent: kind of the entity whose handle is the variable `parent`.
    """

    def __init__(self, parent: str) -> None:
        self._parent = parent
        self._parameters: list[Parameter] = []
        self._topics: list[Topic] = []
        self._services: list[Service] = []
        self._attributes: dict[str, ast.expr] = {}
        self._function: _Function

    def run(self, starts: list[type | FunctionType]) -> Facts:
        functions: dict[FunctionType, _Function] = {}
        waiting = [f for start in starts for f in (_methods(start) if isinstance(start, type) else [start])]
        while waiting:
            function = waiting.pop(0)
            parsed = None if function in functions else _parsed(function)
            if parsed is not None:
                functions[function] = parsed
                waiting += _named_functions(parsed)
        for parsed in functions.values():
            for name, value in _assignments(parsed.node):
                (self._attributes if name.startswith("self.") else parsed.assignments).setdefault(name, value)
        for parsed in functions.values():
            self._function = parsed
            for node in ast.walk(parsed.node):
                if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
                    self._call(node, node.func)
        above = {p.path[:-1] for p in self._parameters}
        # a repeated element without children is read as text
        read = [replace(p, kind="text") if p.repeated and p.path not in above else p for p in self._parameters]
        return Facts(merged(read), merged_topics(self._topics), tuple(dict.fromkeys(self._services)))

    def _call(self, node: ast.Call, method: ast.Attribute) -> None:
        name = method.attr
        named = {keyword.arg: keyword.value for keyword in node.keywords if keyword.arg}
        if name in _READERS and (node.args or "name" in named):
            self._read(node, method, named)
        elif name == "declare" and node.args:
            self._declare(node, named)
        elif name in ("advertise", "listen") and len(node.args) > 1:
            topic, elements = self._topic(node.args[0])
            types = self._value(node.args[1])
            kinds = tuple(map(str, types)) if isinstance(types, (tuple, list)) else (_shown(types),)
            self._topics.append(Topic(topic, kinds, name == "advertise", "latched" in named, elements))
        elif name in ("offer", "act") and len(node.args) > 1:
            service, elements = self._topic(node.args[0])
            self._services.append(Service(service, _shown(self._value(node.args[1])), elements, name == "act"))

    # ------------------------------------------------------------------ parameters

    def _read(self, node: ast.Call, method: ast.Attribute, named: dict[str, ast.expr]) -> None:
        value = self._value(node.args[0] if node.args else named["name"])
        above = self._path(method.value)
        if not isinstance(value, str) or above is None or not value or "{" in value:
            return
        path = (*above, f"@{value}" if method.attr == "attribute" else value)
        kind = _READERS[method.attr]
        order = ("default",) if method.attr == "vector3" else _ARGUMENTS.get(kind, ("default", "required"))
        told = {name: self._value(arg) for name, arg in zip(order, node.args[1:], strict=False)}
        told |= {name: self._value(arg) for name, arg in named.items() if name != "name"}
        default, instead = told.get("default"), self._instead(node.args[1:2])
        line = self._function.lines[node.lineno - 1] if node.lineno <= len(self._function.lines) else ""
        size = 3 if method.attr == "vector3" else told.get("size")
        choices = told.get("allowed", ())
        self._parameters.append(
            Parameter(
                path,
                kind,
                None if default is None else _plain(default),
                instead,
                told.get("required") is True,
                _bound(told.get("minimum")),
                _bound(told.get("maximum")),
                tuple(map(_shown, choices)) if isinstance(choices, (tuple, list)) else (),
                size if isinstance(size, int) else None,
                repeated=method.attr in ("all", "each"),
                unit=unit_of(path[-1], kind, "", line),
            )
        )

    def _declare(self, node: ast.Call, named: dict[str, ast.expr]) -> None:
        element = self._value(named.get("element", node.args[0]))
        default = self._value(node.args[1]) if len(node.args) > 1 else None
        if not isinstance(element, str) or element.startswith("{"):
            return
        kinds = ((bool, "boolean"), (int, "integer"), (float, "number"), (tuple, "vector"), (str, "text"))
        kind = next((kind for type_, kind in kinds if isinstance(default, type_)), "number")
        told = {name: self._value(value) for name, value in named.items()}
        says, choices = _shown(told.get("description", "")), told.get("choices", ())
        known = tuple(map(_shown, choices)) if isinstance(choices, (tuple, list)) else ()
        self._parameters.append(
            Parameter(
                (element,),
                "choice" if known and kind == "text" else kind,
                None if default is None else _plain(default),
                minimum=_bound(told.get("minimum")),
                maximum=_bound(told.get("maximum")),
                choices=known,
                size=len(default) if isinstance(default, tuple) else None,
                live=True,
                says=says,
                unit=unit_of(element, kind, says),
            )
        )

    def _path(self, node: ast.expr, depth: int = 0) -> tuple[str, ...] | None:
        """Return the path of a block: empty for the `<plugin>` element, None if the expression is not a block."""
        if (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and node.func.attr in _INNER
            and node.args
        ):
            inner, above = self._value(node.args[0]), self._path(node.func.value, depth + 1)
            return None if above is None or not isinstance(inner, str) else (*above, inner)
        assigned = self._assigned(node)
        if assigned is not None and depth < _DEEPEST:
            return self._path(assigned, depth + 1)
        name = node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")
        return () if name in self._function.blocks else None

    def _instead(self, args: list[ast.expr]) -> tuple[str, ...]:
        """Return the names of the elements that an element's default value is read from."""
        for arg in args:
            node = self._assigned(arg) or arg
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in _READERS:
                value = self._value(node.args[0]) if node.args else None
                return (value,) if isinstance(value, str) else ()
        return ()

    # ------------------------------------------------------------------ topics

    def _topic(self, node: ast.expr, depth: int = 0) -> tuple[str, tuple[str, ...]]:
        """Return the name of a topic, and the elements that change the name."""
        if depth > _DEEPEST:
            return "{topic}", ()
        if isinstance(node, ast.BoolOp):
            return self._first_topic(node.values, depth)
        if isinstance(node, ast.IfExp):
            return self._first_topic([node.body, node.orelse], depth)
        if isinstance(node, ast.Call):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if name == "read_topic" and len(node.args) > 2:
                topic, elements = self._topic(node.args[2], depth + 1)
                return topic, (_shown(self._value(node.args[1])), *elements)
            if name == "text" and node.args:
                default = self._topic(node.args[1], depth + 1)[0] if len(node.args) > 1 else ""
                return default, (_shown(self._value(node.args[0])),)
            if node.args and name in ("valid_topic", "topic", "str"):
                return self._topic(node.args[0], depth + 1)
        assigned = self._assigned(node)
        if assigned is not None:
            return self._topic(assigned, depth + 1)
        return _shown(self._value(node)), ()

    def _first_topic(self, nodes: list[ast.expr], depth: int) -> tuple[str, tuple[str, ...]]:
        topics = [self._topic(node, depth + 1) for node in nodes]
        named = next((name for name, _ in topics if name and not name.startswith("{")), topics[0][0])
        return named, tuple(dict.fromkeys(element for _, elements in topics for element in elements))

    # ------------------------------------------------------------------ values

    def _assigned(self, node: ast.expr) -> ast.expr | None:
        if isinstance(node, ast.Name):
            return self._function.assignments.get(node.id)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self":
            return self._attributes.get(f"self.{node.attr}")
        return None

    def _value(self, node: ast.expr, depth: int = 0) -> object:
        """Return the value of an expression; a text has placeholders for values that are known only in a run."""
        if isinstance(node, ast.JoinedStr):
            parts = [part.value if isinstance(part, ast.FormattedValue) else part for part in node.values]
            return "".join(_shown(self._value(part, depth + 1)) for part in parts)
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            left, right = self._value(node.left, depth + 1), self._value(node.right, depth + 1)
            if isinstance(left, str) or isinstance(right, str):
                return _shown(left) + _shown(right)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self":
            assigned = self._attributes.get(f"self.{node.attr}")
            if assigned is not None and depth < _DEEPEST:
                return self._value(assigned, depth + 1)
        if isinstance(node, ast.Name) and node.id in self._function.assignments and depth < _DEEPEST:
            return self._value(self._function.assignments[node.id], depth + 1)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in _READERS:
            return self._value(node.args[1], depth + 1) if len(node.args) > 1 else _hole(node)
        known = _constant(node, self._function.module)
        return self._noun(node) if known is None and not isinstance(node, ast.Constant) else known

    def _noun(self, node: ast.expr) -> str:
        if isinstance(node, ast.Attribute) and node.attr in ("name", "scoped"):
            owner = node.value
            word = owner.attr if isinstance(owner, ast.Attribute) else getattr(owner, "id", "name")
            return "{" + (self._parent if word in ("parent", "self") else word.strip("_")) + "}"
        return _hole(node)


def _methods(cls: type) -> list[FunctionType]:
    members = (getattr(f, "__func__", getattr(f, "fget", f)) for f in vars(cls).values())
    return [f for f in members if isinstance(f, FunctionType)]


@functools.cache
def _source(function: FunctionType) -> tuple[ast.FunctionDef, list[str]] | None:
    try:
        text = textwrap.dedent(inspect.getsource(function))
        node = ast.parse(text).body[0]
    except (OSError, TypeError, SyntaxError, IndexError):
        return None
    return (node, text.splitlines()) if isinstance(node, ast.FunctionDef) else None


def _parsed(function: FunctionType) -> _Function | None:
    source, module = _source(function), sys.modules.get(function.__module__)
    return None if source is None or module is None else _Function(source[0], module, source[1])


def _named_functions(function: _Function) -> Iterator[FunctionType]:
    """Yield the functions that a function calls by name, and the methods of the classes that it calls.

    Only functions and classes of the function's own module are considered.
    """
    for node in ast.walk(function.node):
        if isinstance(node, ast.Call):
            target = _constant(node.func, function.module)
            module = function.module.__name__
            # plugins of simkit declare the options that their helpers read
            if getattr(target, "__module__", "") != module or is_shipped_module(module):
                continue
            if isinstance(target, FunctionType):
                yield target
            elif inspect.isclass(target) and not issubclass(target, (Plugin, Options)):
                yield from _methods(target)


def _assignments(node: ast.FunctionDef) -> Iterator[tuple[str, ast.expr]]:
    """Yield each value that is assigned to a local name or attribute, with the name."""
    for inner in ast.walk(node):
        match inner:
            case ast.Assign(targets=[ast.Tuple(elts=names)], value=ast.Tuple(elts=values)):
                yield from ((ast.unparse(name), value) for name, value in zip(names, values, strict=False))
            case ast.Assign(targets=targets, value=value):
                yield from ((ast.unparse(target), value) for target in targets if not isinstance(target, ast.Tuple))
            case ast.AnnAssign(target=target, value=ast.expr() as value) | ast.NamedExpr(target=target, value=value):
                yield ast.unparse(target), value
            case (
                ast.For(target=target, iter=ast.Call() as value)
                | ast.comprehension(target=target, iter=ast.Call() as value)
            ):
                yield ast.unparse(target), value


def _constant(node: ast.expr, module: ModuleType) -> object:
    """Return the value of an expression that consists of literals and names of the module; None for any other."""
    match node:
        case ast.Constant(value=value):
            return value
        case ast.Name(id=name):
            return getattr(module, name, None)
        case ast.Attribute(value=ast.Name(id=owner), attr=name):
            owner_object = getattr(module, owner, None)
            return (
                getattr(owner_object, name, None)
                if isinstance(owner_object, ModuleType) or inspect.isclass(owner_object)
                else None
            )
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            inner = _constant(operand, module)
            return -inner if isinstance(inner, (int, float)) else None
        case ast.Tuple(elts=items) | ast.List(elts=items):
            values = tuple(_constant(item, module) for item in items)
            return None if None in values else values
        case ast.Call(func=ast.Name(id="tuple" | "list" | "sorted"), args=[only]):
            inner = _constant(only, module)
            return tuple(inner) if isinstance(inner, Iterable) else None
    return None


def _hole(node: ast.expr) -> str:
    while isinstance(node, (ast.Call, ast.Subscript)):
        node = node.func if isinstance(node, ast.Call) else node.value
        if isinstance(node, ast.Attribute) and node.attr in ("rsplit", "split", "strip", "removeprefix"):
            node = node.value
    word = node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "…")
    return "{" + word.strip("_").rsplit("_", 1)[-1] + "}"


def _shown(value: object) -> str:
    return value if isinstance(value, str) else str(value)


def _plain(value: object) -> object:
    return value if isinstance(value, (bool, int, float, str, tuple)) else str(value)


def _bound(value: object) -> float | None:
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else None
