"""The words of an expression."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final, Literal

from simkit.conditions.faults import Span, fault

TokenKind = Literal["number", "name", "text", "sign", "end"]

LONGEST: Final = 2000
"""Characters of an expression."""

_TOKEN = re.compile(
    r"(?P<space>\s+)"
    r"|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
    r"|(?P<name>[^\W\d]\w*)"
    r"|(?P<text>'[^'\n]*'|\"[^\"\n]*\")"
    r"|(?P<sign>\*\*|<=|>=|==|!=|[-+*/%<>(),.\[\]])"
)
_INSTEAD = {
    "=": "two values are compared by ==",
    "&&": "write: and",
    "||": "write: or",
    "&": "write: and",
    "|": "write: or",
    "!": "write: not",
    "^": "a power is written **",
    "//": "floor(a / b) is the whole part of a quotient",
    ";": "join conditions by: and",
    "{": "there are no lists or tables",
    "\u2264": "write <=",
    "\u2265": "write >=",
    "\u2260": "write !=",
    "\u201c": "texts stand in plain quotes: 'tb3'",
    "\u2018": "texts stand in plain quotes: 'tb3'",
    "\u2019": "texts stand in plain quotes: 'tb3'",
}
_UNITS = {"s", "ms", "m", "mm", "cm", "km", "deg", "rad", "Hz", "hz", "kg", "N", "min", "h"}


@dataclass(frozen=True, slots=True)
class Token:
    """One word with its place."""

    kind: TokenKind
    text: str
    span: Span


def tokens_of(source: str) -> list[Token]:
    """The words of a text, with an end behind them.

    Raises:
        InputError: SK-COND-001 it has a sign that means nothing; SK-COND-008 it is too long.
    """
    if len(source) > LONGEST:
        raise fault(
            "SK-COND-008",
            f"an expression of {len(source)} characters; allowed are {LONGEST}",
            source,
            Span(LONGEST, LONGEST + 1),
            "make several checks of it",
        )
    found: list[Token] = []
    at = 0
    while at < len(source):
        match = _TOKEN.match(source, at)
        if match is None or match.lastgroup is None:
            raise _unreadable(source, at)
        if match.lastgroup != "space":
            token = Token(match.lastgroup, match.group(), Span(at, match.end()))  # type: ignore[arg-type]
            _check_apart(source, found[-1] if found else None, token)
            found.append(token)
        at = match.end()
    found.append(Token("end", "", Span(len(source), len(source) + 1)))
    return found


def _check_apart(source: str, before: Token | None, token: Token) -> None:
    """A number and a name that touch are a unit, or a name that begins with a digit."""
    if before is None or before.kind != "number" or token.kind != "name" or before.span.end != token.span.start:
        return
    span = Span(before.span.start, token.span.end)
    if token.text in _UNITS:
        hint = f"numbers are in SI units (m, s, rad) and stand alone: {before.text}"
        if token.text == "deg":
            hint = f"angles are in rad: rad({before.text}) makes some of degrees"
        raise fault("SK-COND-001", f"{span.text(source)!r} has a unit", source, span, hint)
    raise fault("SK-COND-001", f"{span.text(source)!r} is neither a number nor a name", source, span)


def _unreadable(source: str, at: int) -> Exception:
    sign = source[at]
    if sign in "'\"":
        return fault("SK-COND-001", "a text that has no end", source, Span(at, len(source)), f"close it with {sign}")
    pair = source[at : at + 2]
    if pair in _INSTEAD:
        return fault("SK-COND-001", f"{pair} means nothing here", source, Span(at, at + 2), _INSTEAD[pair])
    what = f"{sign!r} means nothing here" if sign.isprintable() else f"a sign that cannot be read (U+{ord(sign):04X})"
    return fault("SK-COND-001", what, source, Span(at, at + 1), _INSTEAD.get(sign, ""))
