"""Collect what loading found: one record per problem, in one pass; and find the closest of several names."""

from __future__ import annotations

import difflib
import functools
import re
from collections.abc import Iterable, Iterator

from simkit.diagnostic_record import NOWHERE, Diagnostic, Severity, Where
from simkit.errors import LoadError

__all__ = [
    "NOWHERE",
    "Diagnostic",
    "Diagnostics",
    "Severity",
    "Where",
    "closest",
    "did_you_mean",
    "follows_from",
    "name_hint",
    "shorten",
]

MOST_ERRORS = 1000
LONGEST_MESSAGE = 4000  # characters
_MOST_NAMES = 5000  # that one is compared with; among more the nearest one is chance
_LONGEST_NAME = 200
_QUOTED = re.compile(r"'([^']+)'")


class Diagnostics:
    """Collects diagnostics in order; a repeated identical one is kept once.

    After `MOST_ERRORS` errors LoadError is raised: looking for a hundred thousand more would take minutes.
    """

    def __init__(self, items: Iterable[Diagnostic] = ()) -> None:
        self._items: dict[Diagnostic, None] = {}
        self._errors = 0
        self._heir: Diagnostics | None = None
        self.extend(items)

    def __iter__(self) -> Iterator[Diagnostic]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    @property
    def has_errors(self) -> bool:
        return self._errors > 0

    @property
    def error_count(self) -> int:
        """How many errors there are so far."""
        return self._errors

    def add(self, severity: Severity, code: str, message: str, where: Where = NOWHERE, hint: str = "") -> None:
        if len(message) > LONGEST_MESSAGE:
            message = f"{message[: LONGEST_MESSAGE // 2]} ... {message[-LONGEST_MESSAGE // 2 :]}"
        self._put(Diagnostic(code, severity, message, where.file, where.line, hint[:LONGEST_MESSAGE]))
        if severity == "error" and self._errors >= MOST_ERRORS:
            text = f"there are {self._errors} errors; the rest is not looked at"
            self._put(Diagnostic("SK-LOAD-012", "error", text, where.file, where.line))
            self.raise_if_errors()

    def _put(self, item: Diagnostic) -> None:
        if item not in self._items:
            self._items[item] = None
            self._errors += item.severity == "error"
            if self._heir is not None:
                self._heir._put(item)

    def error(self, code: str, message: str, where: Where = NOWHERE, hint: str = "") -> None:
        self.add("error", code, message, where, hint)

    def warning(self, code: str, message: str, where: Where = NOWHERE, hint: str = "") -> None:
        self.add("warning", code, message, where, hint)

    def note(self, code: str, message: str, where: Where = NOWHERE, hint: str = "") -> None:
        self.add("note", code, message, where, hint)

    def extend(self, items: Iterable[Diagnostic]) -> None:
        for item in items:
            self._put(item)

    def pass_on(self, to: Diagnostics) -> None:
        """Gives another what was found, and from now on what is found later too."""
        to.extend(self._items)
        self._heir = to

    def drop(self, items: Iterable[Diagnostic]) -> None:
        """Forgets some that were found."""
        for item in tuple(items):
            if item in self._items:
                del self._items[item]
                self._errors -= item.severity == "error"

    def raise_if_errors(self, strict: bool = False) -> None:
        """Raises LoadError with everything found so far; `strict` counts warnings as errors."""
        if self.has_errors or (strict and any(d.severity == "warning" for d in self._items)):
            raise LoadError(tuple(self._items))


def follows_from(found: Diagnostic, earlier: Iterable[Diagnostic]) -> bool:
    """Whether an error misses something that is missing because of an earlier error's own fault.

    Messages begin with whose fault it is (`joint 'elbow' has type ...`) and end their first clause with what is missed
    (`model 'robot' has no joint 'elbow'; it has ...`).
    """
    faulty = {name.group(1) for d in earlier if d.severity == "error" and (name := _QUOTED.search(d.message))}
    missed = _QUOTED.findall(found.message.split(";")[0])
    return found.severity == "error" and bool(missed) and missed[-1] in faulty


def closest(name: str, allowed: Iterable[str], least: float = 0.6) -> str | None:
    """The known name most like `name`, or None when none is near; `least`: how near, from 0 to 1."""
    names = list(allowed)
    if len(names) > _MOST_NAMES or len(name) > _LONGEST_NAME:
        return None
    return _closest(name, tuple(sorted({n for n in names if len(n) <= _LONGEST_NAME})), least)


@functools.lru_cache(maxsize=256)  # one misspelling often stands in a file a hundred times, and a search takes 3 ms
def _closest(name: str, names: tuple[str, ...], least: float) -> str | None:
    found = difflib.get_close_matches(name, names, n=1, cutoff=least)
    if not found:
        folded = {n.lower(): n for n in names}
        if name == name.lower() and len(folded) == len(names) and all(n in folded for n in names):
            return None  # the same search again
        found = [folded[m] for m in difflib.get_close_matches(name.lower(), list(folded), n=1, cutoff=least)]
    return found[0] if found else None


def did_you_mean(name: str, allowed: Iterable[str]) -> str:
    """`did you mean 'x'?`, or an empty text."""
    near = closest(name, allowed)
    return f"did you mean {near!r}?" if near else ""


def name_hint(name: str, known: Iterable[str]) -> str:
    """`did you mean 'x'?`, else `there is` with all known names, or `none`."""
    names = list(known)
    return did_you_mean(name, names) or "there is " + (", ".join(names) or "none")


def shorten(text: str, most: int) -> str:
    """A text of no more than so many letters; where some are left out it ends with an ellipsis."""
    return text if len(text) <= most else text[: most - 1] + "…"
