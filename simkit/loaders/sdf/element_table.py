"""Table of every element and attribute of SDF and its use in simkit, from the list `elements.csv`.

The report of unread names and `docs/elements.md` use this table.

A table belongs to one element (`link`). The path of a row starts at this element (`velocity_decay/linear`, `@name`).
If another table describes the content of the row's element, the column `like` names that table. A row `*` means that
plugins or sensors can read names that the table does not list.

A test loads a file with all elements and compares the names that were read with these rows.
"""

from __future__ import annotations

import csv
import functools
import itertools
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path


class Use(Enum):
    """Use of an element in simkit; the values are the words in `elements.csv` and in `docs/elements.md`."""

    USED = "used"
    APPROXIMATED = "approximated"
    IGNORED = "ignored"
    NOT_SIMULATED = "not simulated"

    @property
    def read(self) -> bool:
        """True if a reader reads the element."""
        return self is Use.USED or self is Use.APPROXIMATED


@dataclass(frozen=True, slots=True)
class Row:
    """Table row of one element or attribute.

    Attributes:
        path: path from the table's own element: names joined with `/`, with `@` before an attribute.
        use: use of the element.
        becomes: description of this use.
        like: table that describes the element's content; empty if the rows of this table describe the content.
    """

    path: str
    use: Use
    becomes: str
    like: str = ""


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of one element.

    Attributes:
        element: the element whose content the rows describe; also the table's name.
        rows: rows in the order of the page.
        open: true if a plugin or a sensor can read further names.
    """

    element: str
    rows: tuple[Row, ...]
    open: bool = False


@dataclass
class Schema:
    """Tree of all tables.

    A place in the tree is a text: the name of a table, or this name and a path inside it (`link/velocity_decay`).
    """

    tables: tuple[Table, ...]
    rows: dict[str, Row] = field(init=False)
    _children: dict[str, list[str]] = field(init=False)
    _open: frozenset[str] = field(init=False)
    _elements: dict[str, list[str]] = field(init=False)
    _read_at: dict[str, dict[str, str]] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self.rows, self._children = {}, {}
        for table in self.tables:
            self._children.setdefault(table.element, [])
            for row in table.rows:
                place = f"{table.element}/{row.path}"
                self.rows[place] = row
                parent, _, name = place.rpartition("/")
                self._children.setdefault(parent, []).append(name)
        self._open = frozenset(table.element for table in self.tables if table.open)
        self._elements = {
            place: [n for n in names if not n.startswith(("@", "#"))] for place, names in self._children.items()
        }

    def row(self, place: str, name: str) -> Row | None:
        """Return the row of a child (or `@attribute`) at a place, or None."""
        return self.rows.get(f"{place}/{name}")

    def read_elements(self, place: str) -> dict[str, str]:
        """Return the elements at a place that simkit reads: name -> place of the element's content."""
        if place not in self._read_at:
            rows = {name: self.row(place, name) for name in self._elements.get(place, ()) if ":" not in name}
            read = {name: row for name, row in rows.items() if row is not None and row.use.read}
            self._read_at[place] = {name: row.like or f"{place}/{name}" for name, row in read.items()}
        return self._read_at[place]

    def content_place(self, place: str, name: str) -> str:
        """Return the place that describes the content of a child."""
        row = self.row(place, name)
        return row.like if row is not None and row.like else f"{place}/{name}"

    def elements(self, place: str) -> list[str]:
        """Return the names of the elements at a place."""
        return self._elements.get(place, [])

    def attributes(self, place: str) -> list[str]:
        """Return the names of the attributes at a place."""
        return [n[1:] for n in self._children.get(place, ()) if n.startswith("@")]

    def has_text(self, place: str) -> bool:
        """Check whether an element at a place can have text as well as children, as some elements in old versions."""
        return f"{place}/#text" in self.rows

    def is_open(self, place: str) -> bool:
        """Check whether a plugin or a sensor can read names at this place that the schema does not list."""
        return place in self._open

    def places_with(self, name: str) -> list[str]:
        """Return the places that have an element of this name."""
        return [place for place, names in self._children.items() if name in names]


@functools.cache
def sdf_elements() -> Schema:
    """Return the tables of SDF from `elements.csv`, which is read once."""
    rows: dict[str, list[Row]] = {}
    open_tables = set()
    with Path(__file__).with_name("elements.csv").open(encoding="utf-8", newline="") as file:
        for table, path, use, becomes, like in itertools.islice(csv.reader(file), 1, None):
            if path == "*":
                open_tables.add(table)
            else:
                rows.setdefault(table, []).append(Row(path, Use(use), becomes, like))
    return Schema(tuple(Table(name, tuple(elements), name in open_tables) for name, elements in rows.items()))
