"""What loading found: one record per problem, collected in one pass."""

from __future__ import annotations

import difflib
import functools
import re
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from typing import Any, Literal

from simkit.errors import LoadError

Severity = Literal["error", "warning", "note"]


@dataclass(frozen=True, slots=True)
class Where:
    """A place in an input file; `file` is None for XML given as text."""

    file: str | None = None
    line: int | None = None

    def __str__(self) -> str:
        return f"{self.file or '<text>'}:{self.line}" if self.line else (self.file or "<text>")


NOWHERE = Where()
_QUOTED = re.compile(r"'([^']+)'")


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One problem of an input.

    Attributes:
        code: `SK-AREA-NNN`; never renumbered.
        severity: "error" stops the load, "warning" may change the meaning, "note" is a standing conversion.
        message: what was found and what is allowed.
        hint: what helps; may be empty.
    """

    code: str
    severity: Severity
    message: str
    file: str | None = None
    line: int | None = None
    hint: str = ""

    def __str__(self) -> str:
        text = f"{Where(self.file, self.line)}: {self.severity} {self.code}: {self.message}"
        return f"{text}\n    help: {self.hint}" if self.hint else text

    def as_dict(self) -> dict[str, Any]:
        """The record as plain data, as `inspect --json` prints it."""
        return asdict(self)


class Diagnostics:
    """Collects diagnostics in order; a repeated identical one is kept once."""

    def __init__(self, items: Iterable[Diagnostic] = ()) -> None:
        self._items: dict[Diagnostic, None] = dict.fromkeys(items)

    def __iter__(self) -> Iterator[Diagnostic]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    @property
    def has_errors(self) -> bool:
        return any(d.severity == "error" for d in self._items)

    @property
    def error_count(self) -> int:
        """How many errors there are so far."""
        return sum(d.severity == "error" for d in self._items)

    def add(self, severity: Severity, code: str, message: str, where: Where = NOWHERE, hint: str = "") -> None:
        self._items.setdefault(Diagnostic(code, severity, message, where.file, where.line, hint))

    def error(self, code: str, message: str, where: Where = NOWHERE, hint: str = "") -> None:
        self.add("error", code, message, where, hint)

    def warning(self, code: str, message: str, where: Where = NOWHERE, hint: str = "") -> None:
        self.add("warning", code, message, where, hint)

    def note(self, code: str, message: str, where: Where = NOWHERE, hint: str = "") -> None:
        self.add("note", code, message, where, hint)

    def extend(self, items: Iterable[Diagnostic]) -> None:
        for item in items:
            self._items.setdefault(item)

    def drop(self, items: Iterable[Diagnostic]) -> None:
        """Forgets some that were found."""
        for item in tuple(items):
            self._items.pop(item, None)

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


def closest(name: str, allowed: Iterable[str]) -> str | None:
    """The known name most like `name`, or None when none is near."""
    return _closest(name, tuple(sorted(set(allowed))))


@functools.lru_cache(maxsize=256)  # one misspelling often stands in a file a hundred times, and a search takes 3 ms
def _closest(name: str, names: tuple[str, ...]) -> str | None:
    found = difflib.get_close_matches(name, names, n=1, cutoff=0.6)
    if not found:
        folded = {n.lower(): n for n in names}
        found = [folded[m] for m in difflib.get_close_matches(name.lower(), list(folded), n=1, cutoff=0.6)]
    return found[0] if found else None


def did_you_mean(name: str, allowed: Iterable[str]) -> str:
    """`did you mean 'x'?`, or an empty text."""
    near = closest(name, allowed)
    return f"did you mean {near!r}?" if near else ""
