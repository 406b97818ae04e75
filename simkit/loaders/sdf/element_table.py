"""What each element and attribute of SDF becomes here: the list `elements.csv`.

The report of unread names and `docs/elements.md` come from it.

A table belongs to one element (`link`); a row's path goes on from there (`velocity_decay/linear`, `@name`), and a row
may say that its element is described `like` another table's. A row `*` says that other names are somebody else's to
know. A test loads a file that has everything and compares the names that the readers asked for with these rows.
"""

from __future__ import annotations

import csv
import functools
import itertools
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path


class Use(Enum):
    """What becomes of an element, in the words of the file and of the page."""

    USED = "used"
    APPROXIMATED = "approximated"
    IGNORED = "ignored"
    NOT_SIMULATED = "not simulated"

    @property
    def read(self) -> bool:
        """Whether a reader asks for it."""
        return self is Use.USED or self is Use.APPROXIMATED


@dataclass(frozen=True, slots=True)
class Row:
    """One element or attribute.

    Attributes:
        path: from the table's own element: names joined with `/`, an attribute's with `@` before it.
        use: what becomes of it.
        becomes: the same in words.
        like: the table that describes its content; empty where this table goes on.
    """

    path: str
    use: Use
    becomes: str
    like: str = ""


@dataclass(frozen=True, slots=True)
class Table:
    """The rows of one element.

    Attributes:
        element: the element whose content they describe; also the table's name.
        rows: in the order of the page.
        open: whether names beyond the rows are somebody else's to know (a plugin's, a sensor's kind's).
    """

    element: str
    rows: tuple[Row, ...]
    open: bool = False


@dataclass
class Schema:
    """All tables as one tree.

    A place in it is a text: the name of a table, or such a name and a path inside it (`link/velocity_decay`).
    """

    tables: tuple[Table, ...]
    rows: dict[str, Row] = field(init=False)
    _children: dict[str, list[str]] = field(init=False)
    _open: frozenset[str] = field(init=False)
    _elements: dict[str, list[str]] = field(init=False)
    _read_at: dict[str, dict[str, str]] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self.rows, self._children = {}, {}
        for one in self.tables:
            self._children.setdefault(one.element, [])
            for row in one.rows:
                place = f"{one.element}/{row.path}"
                self.rows[place] = row
                parent, _, name = place.rpartition("/")
                self._children.setdefault(parent, []).append(name)
        self._open = frozenset(one.element for one in self.tables if one.open)
        self._elements = {
            place: [n for n in names if not n.startswith(("@", "#"))] for place, names in self._children.items()
        }

    def row(self, place: str, name: str) -> Row | None:
        """The row of a child (or `@attribute`) at a place."""
        return self.rows.get(f"{place}/{name}")

    def read_elements(self, place: str) -> dict[str, str]:
        """Every element at a place that a reader asks for, and the place of its content."""
        if place not in self._read_at:
            rows = {name: self.row(place, name) for name in self._elements.get(place, ()) if ":" not in name}
            read = {name: row for name, row in rows.items() if row is not None and row.use.read}
            self._read_at[place] = {name: row.like or f"{place}/{name}" for name, row in read.items()}
        return self._read_at[place]

    def content_place(self, place: str, name: str) -> str:
        """The place of a child's content."""
        row = self.row(place, name)
        return row.like if row is not None and row.like else f"{place}/{name}"

    def elements(self, place: str) -> list[str]:
        """Names of the elements at a place."""
        return self._elements.get(place, [])

    def attributes(self, place: str) -> list[str]:
        """Names of the attributes at a place."""
        return [n[1:] for n in self._children.get(place, ()) if n.startswith("@")]

    def has_text(self, place: str) -> bool:
        """Whether an element that holds others may also have a text of its own (some had one in old versions)."""
        return f"{place}/#text" in self.rows

    def is_open(self, place: str) -> bool:
        """Whether unknown names are not this schema's to judge."""
        return place in self._open

    def places_with(self, name: str) -> list[str]:
        """Places that have an element of this name."""
        return [place for place, names in self._children.items() if name in names]


@functools.cache
def sdf_elements() -> Schema:
    """The tables of SDF, read once."""
    rows: dict[str, list[Row]] = {}
    open_tables = set()
    with Path(__file__).with_name("elements.csv").open(encoding="utf-8", newline="") as file:
        for table, path, use, becomes, like in itertools.islice(csv.reader(file), 1, None):
            if path == "*":
                open_tables.add(table)
            else:
                rows.setdefault(table, []).append(Row(path, Use(use), becomes, like))
    return Schema(tuple(Table(name, tuple(found), name in open_tables) for name, found in rows.items()))
