"""Messages and topics of bags, whatever their format, and the errors of unreadable bags."""

from __future__ import annotations

import fnmatch
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, Protocol

from simkit.errors import InputError


def matches_topic(topic: str, patterns: Iterable[str]) -> bool:
    """Check whether a topic matches one of the shell patterns; `scan` and `/scan` are the same."""
    return any(fnmatch.fnmatchcase(topic, p if p.startswith(("/", "*")) else f"/{p}") for p in patterns)


class BagMessage(NamedTuple):
    """Serialised message of a bag, with its recording time [ns]."""

    time_ns: int
    topic: str
    type_name: str
    data: bytes


@dataclass(frozen=True)
class BagTopic:
    """Topic of a bag with one type.

    Attributes:
        definition: definition of the type in the bag; empty if the bag has none.
        latched: True if the publisher kept the last message for late subscribers.
        format: encoding of the messages; simkit decodes `cdr`.
    """

    name: str
    type_name: str
    count: int
    definition: str = ""
    latched: bool = False
    format: str = "cdr"


class BagFile(Protocol):
    """Open file of a bag.

    Attributes:
        storage: `mcap` or `sqlite3`.
        damage: reason why the file is read only up to some place; empty for a complete file.
        start, end: recording time of the first and the last message [ns].
        run: metadata of the recorded run; empty if the file has none.
    """

    storage: str
    damage: str
    start: int
    end: int
    run: dict[str, str]

    def topics(self) -> list[BagTopic]:
        """Return the topics with their numbers of messages."""

    def messages(self, topics: frozenset[str], start: int | None) -> Iterator[BagMessage]:
        """Yield the messages of some topics (empty: all) from a time [ns] on, in the order of their times.

        Raises:
            InputError: SK-CLI-035 the file is damaged.
        """

    def close(self) -> None:
        """Close the file."""


def unreadable(path: Path, reason: object, hint: str = "") -> InputError:
    """Return the error for a bag that cannot be read."""
    return InputError("SK-CLI-035", f"{path} cannot be read: {reason}", help=hint)


def damaged(path: Path, reason: object) -> InputError:
    """Return the error for a bag that is damaged at some place."""
    hint = f"save what is readable with `simkit bag recover {path}`"
    return InputError("SK-CLI-035", f"{path} is damaged: {reason}", help=hint)
