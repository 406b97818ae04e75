"""What is known of an expression when it is read and not run."""

from __future__ import annotations

import ast
import inspect
import operator
from collections.abc import Callable
from types import FunctionType
from typing import TYPE_CHECKING, Any, Final

from simkit.plugins.authoring.abstract_values import (
    Block,
    Bound,
    Closure,
    Either,
    Given,
    Hole,
    Made,
    Record,
    Scope,
    Table,
    either,
    elements,
    is_known,
    joined,
    text_of,
)

if TYPE_CHECKING:
    from simkit.plugins.authoring.call_evaluation import Calls

_MOST_ENTRIES: Final = 64
_BINARY: Final[dict[type[ast.operator], Callable[[Any, Any], Any]]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Mod: operator.mod,
}
_COMPARED: Final[dict[type[ast.cmpop], Callable[[Any, Any], Any]]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda one, several: one in several,
    ast.NotIn: lambda one, several: one not in several,
}


class Above:
    """What `super()` is within a method."""

    def __init__(self, function: FunctionType, owner: Any) -> None:
        self._function, self._owner = function, owner

    def attribute(self, name: str) -> Any:
        """The method of that name of the next class above."""
        cls = self._owner.cls if isinstance(self._owner, Record) else self._owner
        order = cls.__mro__ if inspect.isclass(cls) else ()
        own = next((i for i, c in enumerate(order) if self._function in map(_plain, vars(c).values())), len(order))
        found = next((_plain(vars(c)[name]) for c in order[own + 1 :] if name in vars(c)), None)
        return Bound(found, self._owner) if isinstance(found, FunctionType) else Hole(name)


class Expressions:
    """Values of expressions.

    Attributes:
        calls: what calling something does.
        lines: of the function that is being read.
    """

    calls: Calls
    lines: tuple[str, ...]

    def assign(self, target: ast.expr, value: Any, scope: Scope) -> None:
        """Binds a name, an attribute of what is followed, or several at once."""
        if isinstance(target, ast.Name):
            scope.names[target.id] = value
        elif isinstance(target, ast.Attribute):
            owner = self.value(target.value, scope)
            if isinstance(owner, Record):
                old = owner.fields.get(target.attr)
                owner.fields[target.attr] = value if old is None else either(value, old)
        elif isinstance(target, (ast.Tuple, ast.List)):
            parts = list(elements(value) or ())
            if len(parts) != len(target.elts):
                parts = [Hole(getattr(t, "id", "value")) for t in target.elts]
            for one, part in zip(target.elts, parts, strict=True):
                self.assign(one, part, scope)
        elif isinstance(target, ast.Subscript):
            owner, key = self.value(target.value, scope), self.value(target.slice, scope)
            if isinstance(owner, Table) and len(owner) < _MOST_ENTRIES:
                owner[key if is_known(key) and isinstance(key, (str, int, float)) else text_of(key)] = value
        elif isinstance(target, ast.Starred):
            self.assign(target.value, value, scope)

    def value(self, node: ast.expr | None, scope: Scope) -> Any:
        """What is known of an expression."""
        if node is None:
            return None
        handler = getattr(self, f"_of_{type(node).__name__.lower()}", None)
        if handler is not None:
            return handler(node, scope)
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.expr):
                self.value(child, scope)
        return Hole("value")

    def _of_constant(self, node: ast.Constant, _: Scope) -> Any:
        return node.value

    def _of_name(self, node: ast.Name, scope: Scope) -> Any:
        return scope.find(node.id)

    def _of_attribute(self, node: ast.Attribute, scope: Scope) -> Any:
        owner = self.value(node.value, scope)
        return owner.attribute(node.attr) if isinstance(owner, Above) else self.calls.attribute(owner, node.attr)

    def _of_call(self, node: ast.Call, scope: Scope) -> Any:
        function = self.value(node.func, scope)
        args: list[Any] = []
        for argument in node.args:
            if isinstance(argument, ast.Starred):
                args += list(elements(self.value(argument.value, scope)) or ())
            else:
                args.append(self.value(argument, scope))
        named = {k.arg: self.value(k.value, scope) for k in node.keywords if k.arg}
        for keyword in node.keywords:
            more = self.value(keyword.value, scope) if keyword.arg is None else None
            named |= {k: v for k, v in more.items() if isinstance(k, str)} if isinstance(more, dict) else {}
        if isinstance(function, Above):
            return function
        line = self.lines[node.end_lineno - 1] if node.end_lineno and node.end_lineno <= len(self.lines) else ""
        return self.calls.call(function, args, named, line)

    def _of_joinedstr(self, node: ast.JoinedStr, scope: Scope) -> Any:
        parts = [self.value(v.value if isinstance(v, ast.FormattedValue) else v, scope) for v in node.values]
        lists = [p.values if isinstance(p, Either) else (p,) for p in parts]
        several = max((len(options) for options in lists), default=1)
        return either(*(joined([options[min(i, len(options) - 1)] for options in lists]) for i in range(several)))

    def _of_binop(self, node: ast.BinOp, scope: Scope) -> Any:
        return self._operate(node.op, self.value(node.left, scope), self.value(node.right, scope))

    def _operate(self, op: ast.operator, left: Any, right: Any) -> Any:
        if isinstance(op, ast.Add) and all(isinstance(v, (list, tuple)) for v in (left, right)):
            return (*left, *right) if isinstance(left, tuple) else Made([*left, *right])
        if isinstance(op, ast.Add) and any(isinstance(v, str) for v in (left, right)):
            return joined([left, right])
        if type(op) in _BINARY and is_known(left) and is_known(right):
            try:
                return _BINARY[type(op)](left, right)
            except Exception:  # noqa: BLE001 - what does not add up there does not here either
                return Hole("value")
        return Hole("value")

    def _of_unaryop(self, node: ast.UnaryOp, scope: Scope) -> Any:
        value = self.value(node.operand, scope)
        if isinstance(node.op, ast.USub) and isinstance(value, (int, float)):
            return -value
        if isinstance(node.op, ast.Not) and isinstance(value, bool):
            return not value
        return Hole("value")

    def _of_boolop(self, node: ast.BoolOp, scope: Scope) -> Any:
        values = [self.value(v, scope) for v in node.values]
        if isinstance(node.op, ast.Or):
            return self._instead(values)
        return values[-1]

    def _instead(self, values: list[Any]) -> Any:
        """`a or b`: b where the file gives no a."""
        last = values[-1]
        for value in reversed(values[:-1]):
            if isinstance(value, Given):
                stands = value.default is not None and _truthy(value.default)
                last = value if stands else Given(value.path, last)
            elif is_known(value):
                last = value if value else last
            else:
                last = either(value, last)
        return last

    def _of_ifexp(self, node: ast.IfExp, scope: Scope) -> Any:
        test = self.value(node.test, scope)
        if isinstance(test, bool):
            return self.value(node.body if test else node.orelse, scope)
        body, orelse = self.value(node.body, scope), self.value(node.orelse, scope)
        if isinstance(test, Given) and test == body:
            return self._instead([body, orelse])
        return either(body, orelse)

    def _of_compare(self, node: ast.Compare, scope: Scope) -> Any:
        parts = [self.value(part, scope) for part in (node.left, *node.comparators)]
        if len(parts) == 2 and type(node.ops[0]) in _COMPARED and all(map(is_known, parts)):
            try:
                return bool(_COMPARED[type(node.ops[0])](*parts))
            except Exception:  # noqa: BLE001 - what cannot be compared is not known
                return Hole("value")
        return Hole("value")

    def _of_tuple(self, node: ast.Tuple, scope: Scope) -> Any:
        return tuple(self._listed(node.elts, scope))

    def _of_list(self, node: ast.List, scope: Scope) -> Any:
        return self._listed(node.elts, scope)

    _of_set = _of_list

    def _listed(self, nodes: list[ast.expr], scope: Scope) -> list[Any]:
        found = Made()
        for node in nodes:
            if isinstance(node, ast.Starred):
                value = self.value(node.value, scope)
                found += list(elements(value) or (Hole("value"),))
            else:
                found.append(self.value(node, scope))
        return found

    def _of_dict(self, node: ast.Dict, scope: Scope) -> Any:
        found = Table()
        for key, value in zip(node.keys, node.values, strict=True):
            name, content = self.value(key, scope), self.value(value, scope)
            if key is None:
                found |= content if isinstance(content, dict) else {}
            elif isinstance(name, (str, int, float)):
                found[name] = content
        return found

    def _of_subscript(self, node: ast.Subscript, scope: Scope) -> Any:
        owner, index = self.value(node.value, scope), self.value(node.slice, scope)
        if isinstance(owner, Given):
            return owner
        if is_known(index) and isinstance(owner, (tuple, list, dict, str)):
            try:
                return owner[index]
            except (KeyError, IndexError, TypeError):
                return Hole("value")
        if isinstance(owner, (tuple, list)) and owner:
            return either(*owner)
        if isinstance(owner, dict) and owner:
            return either(*owner.values())
        return owner if isinstance(owner, Hole) else Hole("value")

    def _of_slice(self, node: ast.Slice, scope: Scope) -> Any:
        parts = [self.value(p, scope) for p in (node.lower, node.upper, node.step)]
        return slice(*parts) if all(p is None or isinstance(p, int) for p in parts) else Hole("value")

    def _of_lambda(self, node: ast.Lambda, scope: Scope) -> Any:
        return Closure(node, scope)

    def _of_namedexpr(self, node: ast.NamedExpr, scope: Scope) -> Any:
        value = self.value(node.value, scope)
        self.assign(node.target, value, scope)
        return value

    def _of_listcomp(self, node: ast.ListComp | ast.GeneratorExp | ast.SetComp, scope: Scope) -> Any:
        found = Made()
        self._through(node.generators, scope, lambda inner: found.append(self.value(node.elt, inner)))
        return found

    _of_generatorexp = _of_setcomp = _of_listcomp

    def _of_dictcomp(self, node: ast.DictComp, scope: Scope) -> Any:
        found = Table()

        def add(inner: Scope) -> None:
            key, value = self.value(node.key, inner), self.value(node.value, inner)
            found[key if isinstance(key, (str, int)) else "…"] = value

        self._through(node.generators, scope, add)
        return found

    def _through(self, loops: list[ast.comprehension], scope: Scope, do: Callable[[Scope], None]) -> None:
        inner = Scope(scope.module, {}, scope)
        if not loops:
            do(inner)
            return
        for item in self._items(self.value(loops[0].iter, scope)):
            self.assign(loops[0].target, item, inner)
            for test in loops[0].ifs:
                self.value(test, inner)
            self._through(loops[1:], inner, do)

    def _items(self, value: Any) -> list[Any]:
        """What a loop goes through; one hole where only a run knows it."""
        found = elements(value)
        if found is not None:
            # what is empty here may be filled in a run
            return list(found) or ([Hole("value")] if isinstance(value, (list, dict)) else [])
        if isinstance(value, Either):
            return [item for one in value.values for item in self._items(one)][:64]
        return [value if isinstance(value, (Hole, Block)) else Hole("value")]


def _plain(member: Any) -> Any:
    return member.__func__ if isinstance(member, (classmethod, staticmethod)) else member


def _truthy(value: Any) -> bool:
    return bool(value) if is_known(value) else True
