"""Evaluator of xacro expressions (`${2 * length}`): Python expressions that can only compute values.

The evaluator walks Python's syntax tree itself. Attributes of Python objects cannot be read, only functions of the
table can be called, and every step, text, list and number is limited.
"""

from __future__ import annotations

import ast
import operator
import re
from collections.abc import Callable, Mapping
from typing import Any

from simkit.loaders.xacro.expansion_limits import MAX_BITS, MAX_ITEMS, MAX_TEXT, BoundError, Budget, ExpansionError
from simkit.number_text import counted

MAX_EXPRESSION = 20_000

Value = Any  # an expression can have a value of any Python type
Names = Mapping[str, Value]

_BINARY: dict[type[ast.operator], Callable[[Value, Value], Value]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: operator.pow,
    ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_,
    ast.BitXor: operator.xor,
    ast.LShift: operator.lshift,
    ast.RShift: operator.rshift,
}
_UNARY: dict[type[ast.unaryop], Callable[[Value], Value]] = {
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
    ast.Not: operator.not_,
    ast.Invert: operator.invert,
}
_COMPARE: dict[type[ast.cmpop], Callable[[Value, Value], Value]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda a, b: a in b,
    ast.NotIn: lambda a, b: a not in b,
}
_TEXT_METHODS = """capitalize casefold count endswith find index isalnum isalpha isdecimal isdigit isidentifier islower
isnumeric isspace istitle isupper join lower lstrip partition removeprefix removesuffix replace rfind rindex rpartition
rsplit rstrip split splitlines startswith strip swapcase title upper zfill format"""
METHODS: dict[type, frozenset[str]] = {
    str: frozenset(_TEXT_METHODS.split()),
    list: frozenset(("append", "copy", "count", "extend", "index", "insert", "pop", "remove", "reverse")),
    tuple: frozenset(("count", "index")),
    dict: frozenset(("copy", "get", "items", "keys", "values", "update", "pop")),
    set: frozenset(("add", "difference", "intersection", "issubset", "issuperset", "union")),
    float: frozenset(("is_integer",)),
}
_SPACES = ("Table", "NameSpace")  # xacro's own dictionaries: their entries are names, not methods
_WIDE = re.compile(r"\d{4,}|\*")
_FIELD = re.compile(r"\{([^{}]*)\}")


class Function:
    """Function that expressions may call."""

    def __init__(self, call: Callable[..., Value], kind: type | None = None) -> None:
        self.call, self.kind = call, kind


class Evaluator:
    """Evaluator of expressions over a table of names.

    Args:
        names: values by name; a missing name raises KeyError.
        budget: steps left of the whole expansion.
    """

    def __init__(self, names: Names, budget: Budget) -> None:
        self.names, self.budget = names, budget

    def run(self, text: str) -> Value:
        """Return the value of an expression.

        Raises:
            ExpansionError: the expression is invalid or exceeds a limit; the text is for the user.
        """
        if len(text) > MAX_EXPRESSION:
            raise BoundError(f"an expression has more than {MAX_EXPRESSION} characters")
        try:
            tree = ast.parse(text.strip(), "<expression>", "eval")
            return self._visit(tree.body, {})
        except ExpansionError:
            raise
        except SyntaxError as error:
            raise ExpansionError(f"invalid expression: {error.msg}") from None
        except RecursionError:
            raise BoundError("an expression is nested too deeply") from None
        except KeyError as error:
            raise ExpansionError(f"no entry {error}") from None
        except MemoryError:
            raise BoundError("an expression needs too much memory") from None
        except Exception as error:  # noqa: BLE001 - arithmetic in the file can raise any exception of Python
            raise ExpansionError(f"{type(error).__name__}: {error}") from None

    def call(self, function: Value, *args: Value, **options: Value) -> Value:
        """Call a function of the table (or a lambda of the file) within the limits."""
        if not isinstance(function, Function):
            raise ExpansionError("only functions can be called")
        self.budget.weigh(args, options)
        options = {k: self._callable(v) if isinstance(v, Function) else v for k, v in options.items()}
        return self.budget.value(function.call(*args, **options))

    def _callable(self, function: Function) -> Callable[..., Value]:
        return lambda *args: self.call(function, *args)

    # ------------------------------------------------------------------ the tree

    def _visit(self, node: ast.AST, local: Names) -> Value:
        self.budget.spend()
        visit = _VISITORS.get(type(node))
        if visit is None:
            raise ExpansionError(f"{type(node).__name__} is not allowed in an expression")
        return self.budget.value(visit(self, node, local))

    def _constant(self, node: ast.Constant, local: Names) -> Value:
        return node.value

    def _name(self, node: ast.Name, local: Names) -> Value:
        if node.id in local:
            return local[node.id]
        if node.id.startswith("__"):
            raise ExpansionError(f"the name {node.id!r} is not allowed")
        try:
            return self.names[node.id]
        except KeyError:
            raise ExpansionError(f"name {node.id!r} is not defined") from None

    def _binary(self, node: ast.BinOp, local: Names) -> Value:
        a, b = self._visit(node.left, local), self._visit(node.right, local)
        apply = _BINARY.get(type(node.op))
        if apply is None:
            raise ExpansionError("this operator is not allowed in an expression")
        if isinstance(node.op, ast.Mult):
            for sequence, count in ((a, b), (b, a)):
                if isinstance(sequence, (str, list, tuple)) and isinstance(count, int):
                    most = MAX_TEXT if isinstance(sequence, str) else MAX_ITEMS
                    if len(sequence) * count > most:
                        raise BoundError("a list or text is too long")
        elif isinstance(node.op, ast.Pow) and isinstance(a, int) and isinstance(b, int):
            if b > 0 and abs(a) > 1 and a.bit_length() * b > MAX_BITS:
                raise BoundError("a number is too large")
        elif isinstance(node.op, ast.LShift) and isinstance(b, int) and b > MAX_BITS:
            raise BoundError("a number is too large")
        elif isinstance(node.op, ast.Mod) and isinstance(a, str):
            if _WIDE.search(a):
                raise BoundError("a format is too wide")
            self.budget.weigh(b)
        return apply(a, b)

    def _unary(self, node: ast.UnaryOp, local: Names) -> Value:
        return _UNARY[type(node.op)](self._visit(node.operand, local))

    def _logic(self, node: ast.BoolOp, local: Names) -> Value:
        value: Value = None
        for operand in node.values:
            value = self._visit(operand, local)
            if bool(value) is isinstance(node.op, ast.Or):
                return value
        return value

    def _comparison(self, node: ast.Compare, local: Names) -> Value:
        left = self._visit(node.left, local)
        for operation, right_node in zip(node.ops, node.comparators, strict=True):
            right = self._visit(right_node, local)
            if not isinstance(left, (int, float)) or not isinstance(right, (int, float)):
                self.budget.weigh(left, right)
            if not _COMPARE[type(operation)](left, right):
                return False
            left = right
        return True

    def _choice(self, node: ast.IfExp, local: Names) -> Value:
        return self._visit(node.body if self._visit(node.test, local) else node.orelse, local)

    def _sequence(self, node: ast.List | ast.Tuple | ast.Set, local: Names) -> Value:
        values: list[Value] = []
        for item in node.elts:
            if isinstance(item, ast.Starred):
                values += list(self._visit(item.value, local))
            else:
                values.append(self._visit(item, local))
        return {ast.List: list, ast.Tuple: tuple, ast.Set: set}[type(node)](values)

    def _dict(self, node: ast.Dict, local: Names) -> Value:
        items: dict[Value, Value] = {}
        for key, value in zip(node.keys, node.values, strict=True):
            if key is None:
                items.update(self._visit(value, local))
            else:
                items[self._visit(key, local)] = self._visit(value, local)
        return items

    def _subscript(self, node: ast.Subscript, local: Names) -> Value:
        return self._visit(node.value, local)[self._visit(node.slice, local)]

    def _slice(self, node: ast.Slice, local: Names) -> Value:
        ends = (node.lower, node.upper, node.step)
        return slice(*(None if end is None else self._visit(end, local) for end in ends))

    def _attribute(self, node: ast.Attribute, local: Names) -> Value:
        """Return a name of a name space, or a key of a YAML dictionary; never an attribute of a Python object."""
        owner = self._visit(node.value, local)
        if isinstance(owner, dict):
            try:
                return owner[node.attr]
            except (KeyError, AttributeError):
                raise ExpansionError(f"no entry {node.attr!r}") from None
        raise ExpansionError(f"{node.attr!r} of a {type(owner).__name__} cannot be used in an expression")

    def _call(self, node: ast.Call, local: Names) -> Value:
        args: list[Value] = []
        for argument in node.args:
            if isinstance(argument, ast.Starred):
                args += list(self._visit(argument.value, local))
            else:
                args.append(self._visit(argument, local))
        options = {k.arg: self._visit(k.value, local) for k in node.keywords if k.arg is not None}
        if isinstance(node.func, ast.Attribute):
            owner = self._visit(node.func.value, local)
            for kind, allowed in METHODS.items():
                if isinstance(owner, kind) and node.func.attr in allowed and type(owner).__name__ not in _SPACES:
                    return self._method(owner, node.func.attr, args, options)
            return self.call(self._attribute(node.func, local), *args, **options)
        return self.call(self._visit(node.func, local), *args, **options)

    def _method(self, owner: Value, name: str, args: list[Value], options: dict[str, Value]) -> Value:
        self.budget.weigh(owner, args, options)
        if isinstance(owner, str):
            if name == "join":
                args = [[str(item) if not isinstance(item, str) else item for item in args[0]]] if args else args
                if args and sum(len(item) + len(owner) for item in args[0]) > MAX_TEXT:
                    raise BoundError("a text is too long")
            elif name == "replace" and len(args) > 1:
                if owner.count(str(args[0])) * len(str(args[1])) > MAX_TEXT:
                    raise BoundError("a text is too long")
            elif name == "zfill":
                if args and isinstance(args[0], int) and args[0] > 1000:
                    raise BoundError("a text is too long")
            elif name == "format":
                _check_format(owner)
        result = getattr(owner, name)(*args, **options)
        if name in ("items", "keys", "values"):
            return list(result)
        self.budget.value(owner)
        return result

    def _lambda(self, node: ast.Lambda, local: Names) -> Value:
        names = [a.arg for a in node.args.args]

        def call(*args: Value) -> Value:
            if len(args) != len(names):
                raise ExpansionError(f"the lambda takes {counted(len(names), 'value')}, but is called with {len(args)}")
            return self._visit(node.body, {**local, **dict(zip(names, args, strict=True))})

        return Function(call)

    def _comprehension(self, node: Value, local: Names) -> Value:
        rows: list[Value] = []

        def run_loop(index: int, scope: dict[str, Value]) -> None:
            if index == len(node.generators):
                self.budget.spend()
                if isinstance(node, ast.DictComp):
                    rows.append((self._visit(node.key, scope), self._visit(node.value, scope)))
                else:
                    rows.append(self._visit(node.elt, scope))
                self.budget.value(rows)
                return
            generator = node.generators[index]
            for item in self._visit(generator.iter, scope):
                inner = {**scope, **_loop_variables(generator.target, item)}
                if all(self._visit(test, inner) for test in generator.ifs):
                    run_loop(index + 1, inner)

        run_loop(0, dict(local))
        return {ast.DictComp: dict, ast.SetComp: set}.get(type(node), list)(rows)

    def _text(self, node: ast.JoinedStr, local: Names) -> Value:
        return "".join(str(self._visit(part, local)) for part in node.values)

    def _formatted(self, node: ast.FormattedValue, local: Names) -> Value:
        value = self._visit(node.value, local)
        width = "" if node.format_spec is None else self._visit(node.format_spec, local)
        if _WIDE.search(width):
            raise BoundError("a format is too wide")
        self.budget.weigh(value)
        return format(repr(value) if node.conversion == ord("r") else value, width)


def _loop_variables(target: ast.expr, item: Value) -> dict[str, Value]:
    """Return the names that a `for` of a comprehension binds, with their values."""
    if isinstance(target, ast.Name):
        return {target.id: item}
    if isinstance(target, (ast.Tuple, ast.List)):
        items = list(item)
        if len(items) != len(target.elts):
            raise ExpansionError(f"cannot assign {counted(len(items), 'value')} to {len(target.elts)} names")
        bound: dict[str, Value] = {}
        for name, value in zip(target.elts, items, strict=True):
            bound.update(_loop_variables(name, value))
        return bound
    raise ExpansionError("a 'for' can only assign to names")


def _check_format(template: str) -> None:
    """Raise an error if a format has attributes, indices, wide paddings or nested fields."""
    for field in _FIELD.findall(template):
        name, _, width = field.partition(":")
        if not re.fullmatch(r"\w*(![rs])?", name) or _WIDE.search(width):
            raise ExpansionError(f"the format {{{field}}} is not allowed")
    if re.search(r"\{[^{}]*\{", template):
        raise ExpansionError("a format within a format is not allowed")


_VISITORS: dict[type[ast.AST], Callable[[Evaluator, Value, Names], Value]] = {
    ast.Constant: Evaluator._constant,
    ast.Name: Evaluator._name,
    ast.BinOp: Evaluator._binary,
    ast.UnaryOp: Evaluator._unary,
    ast.BoolOp: Evaluator._logic,
    ast.Compare: Evaluator._comparison,
    ast.IfExp: Evaluator._choice,
    ast.List: Evaluator._sequence,
    ast.Tuple: Evaluator._sequence,
    ast.Set: Evaluator._sequence,
    ast.Dict: Evaluator._dict,
    ast.Subscript: Evaluator._subscript,
    ast.Slice: Evaluator._slice,
    ast.Attribute: Evaluator._attribute,
    ast.Call: Evaluator._call,
    ast.Lambda: Evaluator._lambda,
    ast.ListComp: Evaluator._comprehension,
    ast.SetComp: Evaluator._comprehension,
    ast.GeneratorExp: Evaluator._comprehension,
    ast.DictComp: Evaluator._comprehension,
    ast.JoinedStr: Evaluator._text,
    ast.FormattedValue: Evaluator._formatted,
}
