"""What is wrong with an expression, shown at its place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from simkit.errors import InputError

REMOVED: Final = "SK-NAME-002"
"""What handles of things that were removed raise."""

_WIDEST = 100  # characters of an expression that are shown around a place


@dataclass(frozen=True, slots=True)
class Span:
    """A part of an expression's text: from `start` up to, not including, `end`."""

    start: int
    end: int

    def text(self, source: str) -> str:
        """What stands there."""
        return source[self.start : self.end]


class Undecided(Exception):
    """A value that is not known now: no message has come yet, an index is out of range, a model was removed."""


def fault(code: str, message: str, source: str, span: Span, hint: str = "") -> InputError:
    """An error with the expression, a caret under the place, and what helps."""
    text = f"{code} {message}\n    {pointed(source, span)}"
    if hint:
        text += f"\n    help: {hint}"
    return InputError(text, code)


def pointed(source: str, span: Span) -> str:
    """The expression, and below it carets under a place; of a long one the part around it."""
    plain = "".join(c if c.isprintable() else " " for c in source)
    first = 0
    if len(plain) > _WIDEST:
        first = max(0, min(span.start - _WIDEST // 2, len(plain) - _WIDEST))
    before, after = ("... " if first else ""), (" ..." if first + _WIDEST < len(plain) else "")
    shown = plain[first : first + _WIDEST]
    carets = max(1, min(span.end, first + len(shown)) - span.start)
    return f"{before}{shown}{after}\n    {' ' * (len(before) + span.start - first)}{'^' * carets}"
