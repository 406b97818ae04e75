"""Collection of the problems that a load finds in one pass, and search for the closest known name."""

from __future__ import annotations

import difflib
import functools
import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from pathlib import Path

from simkit.diagnostic_record import NOWHERE, TEXT_SOURCE, Diagnostic, Severity, Where
from simkit.errors import LoadError
from simkit.number_text import counted

__all__ = [
    "NOWHERE",
    "Diagnostic",
    "Diagnostics",
    "Severity",
    "Where",
    "closest",
    "did_you_mean",
    "file_hint",
    "follows_from",
    "name_hint",
    "shorten",
]

MOST_ERRORS = 1000
LONGEST_MESSAGE = 4000  # characters
_MOST_NAMES = 5000  # largest number of candidates; among more names, a similar name means nothing
_LONGEST_NAME = 200
_MOST_LISTED = 20  # names in a message
_QUOTED = re.compile(r"'([^']+)'")


class Diagnostics:
    """Collection of diagnostics in order; identical diagnostics are stored once.

    After `MOST_ERRORS` errors LoadError is raised, because a search for a hundred thousand errors would take minutes.
    """

    def __init__(self, items: Iterable[Diagnostic] = ()) -> None:
        self._items: dict[Diagnostic, None] = {}
        self._errors = 0
        self._successor: Diagnostics | None = None
        self._on_new: Callable[[Diagnostic], None] | None = None
        self.can_leave_out: Callable[[Diagnostic], bool] = lambda _: False
        """Function that checks whether an error may be a warning, because what has the error is left out."""
        self._blamed: object | None = None
        self._errors_of: dict[int, tuple[object, list[Diagnostic]]] = {}
        self.extend(items)

    def __iter__(self) -> Iterator[Diagnostic]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __contains__(self, item: object) -> bool:
        return item in self._items

    @property
    def has_errors(self) -> bool:
        """True if an error was added."""
        return self._errors > 0

    @property
    def error_count(self) -> int:
        """Number of errors so far."""
        return self._errors

    def add(self, severity: Severity, code: str, message: str, where: Where = NOWHERE, hint: str = "") -> None:
        """Add a diagnostic; texts longer than `LONGEST_MESSAGE` lose their middle."""
        if len(message) > LONGEST_MESSAGE:
            message = f"{message[: LONGEST_MESSAGE // 2]} ... {message[-LONGEST_MESSAGE // 2 :]}"
        file = where.file or (TEXT_SOURCE if where.line else None)
        self._put(Diagnostic(code, severity, message, file, where.line, hint[:LONGEST_MESSAGE]))
        if severity == "error" and self._errors >= MOST_ERRORS:
            text = f"the input has {counted(self._errors, 'error')}; the rest is not checked"
            self._put(Diagnostic("SK-LOAD-012", "error", text, file, where.line))
            self.raise_if_errors()

    def _put(self, item: Diagnostic) -> None:
        if item.severity == "error" and self._blamed is not None:  # also an error that is stored already
            self._errors_of.setdefault(id(self._blamed), (self._blamed, []))[1].append(item)
        if item not in self._items:
            self._items[item] = None
            self._errors += item.severity == "error"
            if self._successor is not None:
                self._successor._put(item)
            if self._on_new is not None:
                self._on_new(item)

    def error(self, code: str, message: str, where: Where = NOWHERE, hint: str = "") -> None:
        """Add an error: its code, message, place, and a remedy as `hint`."""
        self.add("error", code, message, where, hint)

    def warning(self, code: str, message: str, where: Where = NOWHERE, hint: str = "") -> None:
        """Add a warning: its code, message, place, and a remedy as `hint`."""
        self.add("warning", code, message, where, hint)

    def note(self, code: str, message: str, where: Where = NOWHERE, hint: str = "") -> None:
        """Add a note: its code, message, place, and a remedy as `hint`."""
        self.add("note", code, message, where, hint)

    def extend(self, items: Iterable[Diagnostic]) -> None:
        """Add diagnostics."""
        for item in items:
            self._put(item)

    def tell(self, callback: Callable[[Diagnostic], None]) -> None:
        """Call a function with each present and future diagnostic."""
        for item in self._items:
            callback(item)
        self._on_new = callback

    def pass_on(self, to: Diagnostics) -> None:
        """Add all present and future diagnostics to another collection."""
        to.extend(self._items)
        self._successor = to

    @contextmanager
    def blame(self, part: object | None) -> Iterator[None]:
        """Attribute the errors that are reported inside the context to a sensor or plugin; None for no one."""
        outer, self._blamed = self._blamed, part
        try:
            with nullcontext() if self._successor is None else self._successor.blame(part):
                yield
        finally:
            self._blamed = outer

    def blamed(self) -> list[tuple[object, list[Diagnostic]]]:
        """Return each sensor and plugin with its errors, in the order of their first errors."""
        return list(self._errors_of.values())

    @property
    def has_only_blamed_errors(self) -> bool:
        """True if there are errors, and all of them belong to sensors and plugins."""
        blamed = {item for _, items in self._errors_of.values() for item in items}
        return self.has_errors and all(d in blamed for d in self._items if d.severity == "error")

    def soften(self, errors: Iterable[Diagnostic]) -> None:
        """Make warnings of errors; they keep their places in the order."""
        changed = {error: replace(error, severity="warning") for error in errors}
        self._items = dict.fromkeys(changed.get(item, item) for item in self._items)
        self._errors = sum(item.severity == "error" for item in self._items)

    def drop(self, items: Iterable[Diagnostic]) -> None:
        """Remove diagnostics."""
        for item in tuple(items):
            if item in self._items:
                del self._items[item]
                self._errors -= item.severity == "error"

    def raise_if_errors(self, strict: bool = False) -> None:
        """Raise LoadError with all diagnostics so far if there are errors; `strict` counts warnings as errors."""
        if self.has_errors or (strict and any(d.severity == "warning" for d in self._items)):
            raise LoadError(tuple(self._items))


def follows_from(diagnostic: Diagnostic, earlier: Iterable[Diagnostic]) -> bool:
    """Check whether an error is a consequence of an earlier error.

    Messages begin with the faulty object (`joint 'elbow' has type ...`). Their first clause ends with the missing
    object (`model 'robot' has no joint 'elbow'; it has ...`). The error is a consequence if its missing object is the
    faulty object of an earlier error.
    """
    faulty = {name.group(1) for d in earlier if d.severity == "error" and (name := _QUOTED.search(d.message))}
    missed = _QUOTED.findall(diagnostic.message.split(";")[0])
    return diagnostic.severity == "error" and bool(missed) and missed[-1] in faulty


def closest(name: str, allowed: Iterable[str], least: float = 0.6) -> str | None:
    """Return the allowed name that is most similar to `name`.

    Args:
        name: misspelled name.
        allowed: known names.
        least: smallest accepted similarity, from 0 to 1.

    Returns:
        Closest name, or None if no name is similar enough.
    """
    names = list(allowed)
    if len(names) > _MOST_NAMES or len(name) > _LONGEST_NAME:
        return None
    return _closest(name, tuple(sorted({n for n in names if len(n) <= _LONGEST_NAME})), least)


def _without_style(name: str) -> str:
    return name.lower().replace("_", "").replace("-", "")


@functools.lru_cache(maxsize=256)  # a file often repeats one misspelling a hundred times; a search takes 3 ms
def _closest(name: str, names: tuple[str, ...], least: float) -> str | None:
    same = [n for n in names if n != name and _without_style(n) == _without_style(name)]
    if same:  # distortion_k1 means distortionK1 and not distortionT1, which is as similar
        return same[0]
    matches = difflib.get_close_matches(name, names, n=1, cutoff=least)
    if not matches:
        folded = {n.lower(): n for n in names}
        if name == name.lower() and len(folded) == len(names) and all(n in folded for n in names):
            return None  # all names are lower case already
        matches = [folded[m] for m in difflib.get_close_matches(name.lower(), list(folded), n=1, cutoff=least)]
    return matches[0] if matches else None


def did_you_mean(name: str, allowed: Iterable[str]) -> str:
    """Return `did you mean 'x'?`, or an empty text if no other allowed name is similar."""
    near = closest(name, (known for known in allowed if known != name))
    return f"did you mean {near!r}?" if near else ""


def name_hint(name: str, known: Iterable[str]) -> str:
    """Return `did you mean 'x'?`, else `there is` with the first known names, or `none`."""
    names = list(known)
    more = f" and {len(names) - _MOST_LISTED} more" if len(names) > _MOST_LISTED else ""
    return did_you_mean(name, names) or "there is " + (", ".join(names[:_MOST_LISTED]) or "none") + more


def file_hint(name: str, suffixes: tuple[str, ...]) -> str:
    """Return `did you mean 'x'?` with the most similar file name of the same folder, or an empty text.

    Args:
        name: path of a missing file.
        suffixes: suffixes of the files that are suggested.
    """
    try:
        return did_you_mean(Path(name).name, [f.name for f in Path(name).parent.iterdir() if f.suffix in suffixes])
    except (OSError, ValueError):
        return ""


def shorten(text: str, most: int) -> str:
    """Shorten a text to at most `most` characters; a shortened text ends with an ellipsis."""
    return text if len(text) <= most else text[: most - 1] + "…"
