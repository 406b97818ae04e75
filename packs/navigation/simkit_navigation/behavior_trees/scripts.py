"""Scripts of BehaviorTree.CPP 4, such as `tries := tries + 1; done = tries > 3`.

The language: statements with `;`, assignments `:=`, `=`, `+=`, `-=`, `*=`, `/=`, `a ? b : c`, `||`, `&&`, `|`, `^`,
`&`, comparisons, `+`, `-`, `*`, `/`, `..` (joins texts), `!`, `~`, parentheses, numbers, `'texts'`, `true`, `false`.
Names are entries of the blackboard. Source: https://www.behaviortree.dev/docs/guides/scripting
"""

from __future__ import annotations

import operator as operators
import re
from collections.abc import Callable
from typing import Any, Final, Protocol

_TOKEN: Final = re.compile(
    r"\s*(?:(?P<number>0x[0-9A-Fa-f]+|\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)|(?P<name>@?[A-Za-z_]\w*)"
    r"|(?P<text>'[^']*'|\"[^\"]*\")|(?P<sign>:=|\+=|-=|\*=|/=|==|!=|<=|>=|&&|\|\||\.\.|[-+*/<>=!~?:;()|&^]))"
)
_ASSIGNMENTS: Final = (":=", "=", "+=", "-=", "*=", "/=")
_LEVELS: Final = (
    ("||",),
    ("&&",),
    ("|", "^"),
    ("&",),
    ("==", "!=", "<", ">", "<=", ">="),
    ("..",),
    ("+", "-"),
    ("*", "/"),
)
_DEEPEST: Final = 50
_CONSTANTS: Final = {"true": True, "false": False, "SUCCESS": 2, "FAILURE": 3, "RUNNING": 1, "IDLE": 0, "SKIPPED": 4}

Expression = tuple[Any, ...]
"""Kind of an expression with its parts: plain data, which a snapshot copies."""


class ScriptError(Exception):
    """Script that cannot be read or executed."""


class Board(Protocol):
    """Blackboard of a script."""

    def has(self, name: str) -> bool:
        """Check whether there is a value."""

    def get(self, name: str, default: Any = None) -> Any:
        """Return a value."""

    def set(self, name: str, value: object) -> None:
        """Store a value."""


class Script:
    """Script that was read from its text.

    Raises:
        ScriptError: the text is not a script.
    """

    def __init__(self, text: str) -> None:
        self._statements = _Reader(text).read()

    def run(self, board: Board) -> Any:
        """Execute the script and return the value of its last statement.

        Raises:
            ScriptError: a name has no value, or values do not fit an operator.
        """
        value: Any = None
        for statement in self._statements:
            try:
                value = _value(statement, board)
            except (TypeError, ValueError, ZeroDivisionError, OverflowError) as error:
                raise ScriptError(str(error)) from None
        return value


class _Reader:
    def __init__(self, text: str) -> None:
        self._tokens, self._at, self._depth = _tokens(text), 0, 0

    def read(self) -> tuple[Expression, ...]:
        statements = []
        while self._at < len(self._tokens):
            if not self._skip(";"):
                statements.append(self._statement())
                if self._at < len(self._tokens) and not self._skip(";"):
                    raise ScriptError(f"{self._next()[1]!r} is not expected there")
        if not statements:
            raise ScriptError("the script is empty")
        return tuple(statements)

    def _next(self) -> tuple[str, str]:
        return self._tokens[self._at] if self._at < len(self._tokens) else ("end", "end")

    def _skip(self, sign: str) -> bool:
        is_sign = self._next() == ("sign", sign)
        self._at += is_sign
        return is_sign

    def _statement(self) -> Expression:
        kind, name = self._next()
        following = self._tokens[self._at + 1] if self._at + 1 < len(self._tokens) else ("end", "")
        if kind == "name" and following[0] == "sign" and following[1] in _ASSIGNMENTS:
            self._at += 2
            return ("set", name, following[1], self._ternary())
        return self._ternary()

    def _ternary(self) -> Expression:
        self._depth += 1
        if self._depth > _DEEPEST:
            raise ScriptError(f"expressions nested deeper than {_DEEPEST}")
        condition = self._binary(0)
        if self._skip("?"):
            first = self._ternary()
            if not self._skip(":"):
                raise ScriptError(f"expected ':' before {self._next()[1]!r}")
            condition = ("if", condition, first, self._ternary())
        self._depth -= 1
        return condition

    def _binary(self, level: int) -> Expression:
        if level == len(_LEVELS):
            return self._unary()
        left = self._binary(level + 1)
        while self._next()[0] == "sign" and self._next()[1] in _LEVELS[level]:
            operator = self._next()[1]
            self._at += 1
            left = ("binary", operator, left, self._binary(level + 1))
        return left

    def _unary(self) -> Expression:
        signs = []
        while self._next()[0] == "sign" and self._next()[1] in ("!", "-", "~", "+"):
            signs.append(self._next()[1])
            self._at += 1
        expression = self._primary()
        for sign in reversed(signs[-_DEEPEST:]):
            expression = ("unary", sign, expression)
        return expression

    def _primary(self) -> Expression:
        kind, text = self._next()
        self._at += 1
        if kind == "number":
            is_whole = text.isdigit() or text.startswith("0x")
            return ("constant", int(text, 0) if text.startswith("0x") else int(text) if is_whole else float(text))
        if kind == "text":
            return ("constant", text[1:-1])
        if kind == "name":
            return ("constant", _CONSTANTS[text]) if text in _CONSTANTS else ("entry", text)
        if (kind, text) == ("sign", "("):
            inner = self._ternary()
            if self._skip(")"):
                return inner
            raise ScriptError(f"expected ')' before {self._next()[1]!r}")
        raise ScriptError(f"{text!r} is not expected there")


def _tokens(text: str) -> list[tuple[str, str]]:
    tokens, at, end = [], 0, len(text.rstrip())
    while at < end:
        token_match = _TOKEN.match(text, at)
        if token_match is None or token_match.lastgroup is None:
            raise ScriptError(f"cannot read {text[at:].strip()!r:.40}")
        tokens.append((token_match.lastgroup, token_match.group(token_match.lastgroup)))
        at = token_match.end()
    return tokens


def _value(expression: Expression, board: Board) -> Any:
    kind = expression[0]
    if kind == "constant":
        return expression[1]
    if kind == "entry":
        if not board.has(expression[1]):
            raise ScriptError(f"the blackboard has no entry {expression[1]!r}")
        return _number_of(board.get(expression[1]))
    if kind == "set":
        return _assign(expression, board)
    if kind == "if":
        return _value(expression[2] if _value(expression[1], board) else expression[3], board)
    if kind == "unary":
        return _UNARY[expression[1]](_value(expression[2], board))
    operator, left = expression[1], _value(expression[2], board)
    if operator in ("&&", "||"):
        is_decided = bool(left) is (operator == "||")
        return bool(left) if is_decided else bool(_value(expression[3], board))
    return _combine(operator, left, _value(expression[3], board))


def _assign(expression: Expression, board: Board) -> Any:
    _, name, operator, right = expression
    value = _value(right, board)
    if operator == "=" and not board.has(name):
        raise ScriptError(f"the blackboard has no entry {name!r}; ':=' creates one")
    if operator not in (":=", "="):
        value = _combine(operator[0], _value(("entry", name), board), value)
    board.set(name, value)
    return value


def _combine(operator: str, left: Any, right: Any) -> Any:
    if operator == "..":
        return f"{left}{right}"
    if operator in ("==", "!="):
        return (left == right) is (operator == "==")
    if isinstance(left, str) is not isinstance(right, str):
        raise ScriptError(f"{operator!r} does not combine {left!r:.40} and {right!r:.40}")
    if isinstance(left, str) and operator not in ("+", "<", ">", "<=", ">="):
        raise ScriptError(f"{operator!r} does not combine texts")
    if operator in ("&", "|", "^"):
        a, b = int(left), int(right)
        return a & b if operator == "&" else a | b if operator == "|" else a ^ b
    return _OPERATORS[operator](left, right)


_OPERATORS: Final[dict[str, Callable[[Any, Any], object]]] = {
    "+": operators.add,
    "-": operators.sub,
    "*": operators.mul,
    "/": operators.truediv,
    "<": operators.lt,
    ">": operators.gt,
    "<=": operators.le,
    ">=": operators.ge,
}
_UNARY: Final[dict[str, Callable[[Any], object]]] = {
    "!": operators.not_,
    "-": operators.neg,
    "+": operators.pos,
    "~": lambda value: ~int(value),
}


def _number_of(value: Any) -> Any:
    """Return the number in a text, or the value: texts of ports become numbers where they are some."""
    if not isinstance(value, str):
        return value
    try:
        return float(value) if not value.strip().lstrip("+-").isdigit() else int(value)
    except ValueError:
        return {"true": True, "false": False}.get(value.strip().lower(), value)
