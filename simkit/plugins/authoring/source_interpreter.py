"""Reads what a plugin's methods do without running them: every branch is taken, every loop gone through.

So it also finds what is read only where a file asks for it, and needs no world to hang the plugin on.
"""

from __future__ import annotations

import ast
import functools
import importlib
import inspect
import sys
import textwrap
from contextlib import suppress
from types import FunctionType, ModuleType
from typing import Any, Final

from simkit.plugins.authoring.abstract_values import Closure, Hole, Record, Scope, either
from simkit.plugins.authoring.call_evaluation import Calls
from simkit.plugins.authoring.expression_evaluation import Above, Expressions
from simkit.plugins.authoring.plugin_facts import Facts, Parameter, Service, Topic, merged, merged_topics

_MOST_CALLS: Final = 4000
_DEEPEST: Final = 25


@functools.cache
def source_of(function: FunctionType) -> tuple[ast.FunctionDef | ast.Lambda, tuple[str, ...]] | None:
    """The syntax of a function with its source lines; None where there is no source."""
    try:
        text = textwrap.dedent(inspect.getsource(function))
        node = ast.parse(text).body[0]
    except (OSError, TypeError, SyntaxError, IndexError):
        return None
    return (node, tuple(text.splitlines())) if isinstance(node, ast.FunctionDef) else None


class Interpreter(Expressions):
    """Follows a class's methods and notes what they read and open.

    Args:
        cls: the plugin class, or a class of gz's way of writing systems.

    Attributes:
        module: whose functions are followed besides simkit's.
    """

    def __init__(self, cls: type[Any]) -> None:
        self.me = Record(cls)
        self.parameters: list[Parameter] = []
        self.topics: list[Topic] = []
        self.services: list[Service] = []
        self.module = cls.__module__
        self.lines: tuple[str, ...] = ()
        self._calls, self._stack = 0, [cls.__name__]
        self._returned: list[list[Any]] = []
        self.calls = Calls(self)

    def function(self, function: Any, *arguments: Any) -> Any:
        """Follows a function of a module; what it gives back."""
        return self.call(function, list(arguments), {}) if isinstance(function, FunctionType) else None

    def method(self, name: str, *arguments: Any) -> Any:
        """Follows a method of the class; what it gives back."""
        function = inspect.getattr_static(self.me.cls, name, None)
        if isinstance(function, (classmethod, staticmethod)):
            function = function.__func__
        return self.call(function, [self.me, *arguments], {}) if isinstance(function, FunctionType) else None

    def facts(self) -> Facts:
        """What was found, each once."""
        return Facts(merged(self.parameters), merged_topics(self.topics), tuple(dict.fromkeys(self.services)))

    # ------------------------------------------------------------------ functions

    def call(self, function: FunctionType | Closure, args: list[Any], named: dict[str, Any]) -> Any:
        """What a function gives back; a hole where it cannot be followed."""
        if isinstance(function, Closure):
            name = key = f"function {id(function.node)}"
        else:
            name, key = function.__name__, f"{function.__module__}.{function.__qualname__}"
        self._calls += 1
        if self._calls > _MOST_CALLS or len(self._stack) > _DEEPEST or self._stack.count(key) > 1:
            return Hole(name)
        self._stack.append(key)
        try:
            if isinstance(function, Closure):
                scope = Scope(function.scope.module, {}, function.scope)
                return self._body(function.node, scope, args, named, None)
            return self._follow(function, args, named)
        finally:
            self._stack.pop()

    def _follow(self, function: FunctionType, args: list[Any], named: dict[str, Any]) -> Any:
        found, module = source_of(function), sys.modules.get(function.__module__)
        if found is None or module is None:
            return Hole(function.__name__)
        node, lines = found
        before, self.lines = self.lines, lines
        try:
            closed = inspect.getclosurevars(function).nonlocals if function.__closure__ else {}
            inside = Scope(module, {**closed, "super": Above(function, args[0] if args else None)})
            return self._body(node, inside, args, named, function)
        finally:
            self.lines = before

    def _body(
        self,
        node: ast.FunctionDef | ast.Lambda,
        scope: Scope,
        args: list[Any],
        named: dict[str, Any],
        function: FunctionType | None,
    ) -> Any:
        self._bind(node.args, scope, args, named, function)
        if isinstance(node, ast.Lambda):
            return self.value(node.body, scope)
        self._returned.append([])
        self.run(node.body, scope)
        returned = self._returned.pop()
        return either(*returned) if returned else None

    def _bind(self, wanted: ast.arguments, scope: Scope, args: list[Any], named: dict[str, Any], function: Any) -> None:
        names = [a.arg for a in (*wanted.posonlyargs, *wanted.args)]
        late = dict(zip(names[len(names) - len(wanted.defaults) :], wanted.defaults, strict=True))
        late |= {a.arg: d for a, d in zip(wanted.kwonlyargs, wanted.kw_defaults, strict=True) if d is not None}
        for name in (*names, *(a.arg for a in wanted.kwonlyargs)):
            scope.names[name] = self.value(late[name], scope) if name in late else Hole(name)
        scope.names |= dict(zip(names, args, strict=False))
        if wanted.vararg:
            scope.names[wanted.vararg.arg] = tuple(args[len(names) :])
        if wanted.kwarg:
            known = {*names, *(a.arg for a in wanted.kwonlyargs)}
            scope.names[wanted.kwarg.arg] = {k: v for k, v in named.items() if k not in known}
        scope.names |= {k: v for k, v in named.items() if k in scope.names}

    # ------------------------------------------------------------------ statements

    def run(self, body: list[ast.stmt], scope: Scope) -> None:
        """Every statement in turn."""
        for node in body:
            handler = getattr(self, f"_do_{type(node).__name__.lower()}", None)
            if handler is not None:
                with suppress(Exception):  # somebody's code may be anything; what cannot be followed is not known
                    handler(node, scope)

    def _do_expr(self, node: ast.Expr, scope: Scope) -> None:
        self.value(node.value, scope)

    def _do_return(self, node: ast.Return, scope: Scope) -> None:
        if node.value is not None:
            self._returned[-1].append(self.value(node.value, scope))

    def _do_assign(self, node: ast.Assign, scope: Scope) -> None:
        value = self.value(node.value, scope)
        for target in node.targets:
            self.assign(target, value, scope)

    def _do_annassign(self, node: ast.AnnAssign, scope: Scope) -> None:
        if node.value is not None:
            self.assign(node.target, self.value(node.value, scope), scope)

    def _do_augassign(self, node: ast.AugAssign, scope: Scope) -> None:
        before = self.value(ast.copy_location(_loaded(node.target), node), scope)
        self.assign(node.target, self._operate(node.op, before, self.value(node.value, scope)), scope)

    def _do_if(self, node: ast.If, scope: Scope) -> None:
        test = self.value(node.test, scope)
        if isinstance(test, bool):
            self.run(node.body if test else node.orelse, scope)
            return
        before = dict(scope.names)
        self.run(node.body, scope)
        one, scope.names = scope.names, before
        self.run(node.orelse, scope)
        other = scope.names
        scope.names = {name: either(*(s[name] for s in (one, other) if name in s)) for name in {**one, **other}}

    def _do_for(self, node: ast.For, scope: Scope) -> None:
        for item in self._items(self.value(node.iter, scope)):
            self.assign(node.target, item, scope)
            self.run(node.body, scope)
        self.run(node.orelse, scope)

    def _do_while(self, node: ast.While, scope: Scope) -> None:
        self.value(node.test, scope)
        self.run(node.body, scope)

    def _do_with(self, node: ast.With, scope: Scope) -> None:
        for item in node.items:
            value = self.value(item.context_expr, scope)
            if item.optional_vars is not None:
                self.assign(item.optional_vars, value, scope)
        self.run(node.body, scope)

    def _do_try(self, node: ast.Try, scope: Scope) -> None:
        for body in (node.body, *(h.body for h in node.handlers), node.orelse, node.finalbody):
            self.run(body, scope)

    def _do_match(self, node: ast.Match, scope: Scope) -> None:
        self.value(node.subject, scope)
        for case in node.cases:
            self.run(case.body, scope)

    def _do_functiondef(self, node: ast.FunctionDef, scope: Scope) -> None:
        scope.names[node.name] = Closure(node, scope)

    def _do_importfrom(self, node: ast.ImportFrom, scope: Scope) -> None:
        module = _module("." * node.level + (node.module or ""), scope.module)
        for alias in node.names:
            found = getattr(module, alias.name, None)
            if found is None and module is not None:
                found = _module(f"{module.__name__}.{alias.name}", scope.module)
            scope.names[alias.asname or alias.name] = found if found is not None else Hole(alias.name)

    def _do_import(self, node: ast.Import, scope: Scope) -> None:
        for alias in node.names:
            name = alias.name if alias.asname else alias.name.split(".")[0]
            scope.names[alias.asname or name] = _module(name, scope.module) or Hole(name)


def _loaded(target: ast.expr) -> ast.expr:
    """A target of `+=` as something to be read."""
    if isinstance(target, ast.Name):
        return ast.Name(target.id, ast.Load())
    if isinstance(target, ast.Attribute):
        return ast.Attribute(target.value, target.attr, ast.Load())
    return target


def _module(name: str, beside: ModuleType) -> ModuleType | None:
    """A module that is imported already, or that comes with simkit; nothing else is run for looking."""
    full = importlib.util.resolve_name(name, beside.__package__ or "") if name.startswith(".") else name
    if full in sys.modules:
        return sys.modules[full]
    if full.split(".")[0] not in {"simkit", "math", "collections", "functools", "itertools"}:
        return None
    try:
        return importlib.import_module(full)
    except ImportError:
        return None
