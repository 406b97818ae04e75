"""Answers to options of Gazebo and to arguments of ROS launch files on the command line of `simkit run`."""

from __future__ import annotations

import functools
import re
import shlex
import tomllib
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from simkit.diagnostics import Diagnostic
from simkit.errors import LoadError

_TABLE = Path(__file__).parent / "gazebo_options.toml"


@dataclass(frozen=True)
class GazeboOption:
    """One option of another program; the file of the table describes the attributes."""

    pattern: str
    of: str
    answer: str
    accepted: bool = False


@functools.cache
def _gazebo_options() -> tuple[GazeboOption, ...]:
    return tuple(GazeboOption(**entry) for entry in tomllib.loads(_TABLE.read_text(encoding="utf-8"))["option"])


def remove_gazebo_options(words: Sequence[str], with_value: Collection[str]) -> tuple[list[str], list[str]]:
    """Remove the options of Gazebo that need no action from a command line.

    Args:
        words: command line after `simkit run`.
        with_value: options of `simkit run` that have a value.

    Returns:
        The remaining words, and one note for each removed option.

    Raises:
        LoadError: SK-CLI-052 other options of Gazebo, one problem for each, with the replacement.
    """
    entries = list(_split(words, with_value))
    rest = [word for text, entry, _ in entries if entry is None for word in text]
    operands = [text[0] for text, entry, _ in entries if entry is None and len(text) == 1 and text[0][:1] != "-"]
    world = shlex.quote(operands[0]) if operands else "WORLD"
    notes, problems = [], []
    for text, entry, value in entries:
        if entry is None:
            continue
        answer = entry.answer.replace("{world}", world).replace("{value}", value or "VALUE")
        line = f"{entry.of} {' '.join(text)}: {answer}"
        if entry.accepted:
            notes.append(line)
        else:
            problems.append(Diagnostic("SK-CLI-052", "error", line))
    if problems:
        raise LoadError(problems)
    return rest, notes


def _split(
    words: Sequence[str], with_value: Collection[str]
) -> Iterator[tuple[Sequence[str], GazeboOption | None, str | None]]:
    """Yield each option with its value or each single word, its entry in the table, and the value in the entry."""
    at = 0
    while at < len(words):
        if words[at] == "--":
            yield words[at:], None, None
            return
        following = words[at + 1] if at + 1 < len(words) else ""
        size, entry, value = _match(words[at], following)
        if entry is None:
            size = 2 if words[at] in with_value else 1
        yield words[at : at + size], entry, value
        at += size


def _match(word: str, following: str) -> tuple[int, GazeboOption | None, str | None]:
    """Find the entry for a word and its value, else for the word alone; return its number of words as well."""
    if word.startswith("-") or ":=" in word:
        for text in (f"{word} {following}", word):
            for entry in _gazebo_options():
                if match := re.fullmatch(entry.pattern, text):
                    has_value = text != word and following[:1] not in ("", "-")
                    return 1 + has_value, entry, match.groupdict().get("value")
    return 1, None, None
