"""Table of a comparison: one row for each quantity of each topic, with a verdict."""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from simkit.errors import InputError
from simkit.extend import counted, did_you_mean
from simkit.install_command import install_command
from simkit_identification.comparison.page import PageContents, write_page
from simkit_identification.comparison.row import DIFFERING, Row, cells_of, headings, html_table
from simkit_identification.result_texts import finite_or_none

if TYPE_CHECKING:
    from simkit.msgs.data_frames import DataFrame


@dataclass
class Comparison:
    """Table of a comparison, with one row for each quantity of each topic.

    Attributes:
        a, b: names of the sources; b is empty if there is only one.
        rows: rows, in the order of the topics.
        confidence: confidence of the intervals, and of all verdicts together.
        notes: remarks about alignment, parts that were left out, and played commands.
        charts: title and SVG of each plot of the page.
    """

    a: str
    b: str
    rows: list[Row]
    confidence: float = 0.95
    notes: list[str] = field(default_factory=list)
    charts: list[tuple[str, str]] = field(default_factory=list, repr=False)

    def __iter__(self) -> Iterator[Row]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, index: int) -> Row:
        return self.rows[index]

    @property
    def differing(self) -> list[Row]:
        """Rows that differ by more than chance and tolerance, the clearest first."""
        found = [row for row in self.rows if row.verdict in DIFFERING]
        return sorted(found, key=lambda row: (row.verdict == "differs", math.isnan(row.chance), row.chance))

    @property
    def is_same(self) -> bool:
        """True if no row differs."""
        return not any(row.verdict in DIFFERING for row in self.rows)

    def row(self, topic: str, quantity: str) -> Row:
        """Return the row of a quantity.

        Raises:
            KeyError: there is no such row; the error names the closest one.
        """
        for row in self.rows:
            if row.topic == topic and row.quantity == quantity:
                return row
        names = [f"{row.topic} {row.quantity}" for row in self.rows]
        raise KeyError(f"no row {topic} {quantity}; {did_you_mean(f'{topic} {quantity}', names) or 'see .rows'}")

    def counts(self) -> Counter[str]:
        """Return the number of rows of each verdict."""
        return Counter(row.verdict for row in self.rows)

    def to_dataframe(self) -> DataFrame:
        """Return the rows as a pandas DataFrame.

        Raises:
            InputError: SK-INPUT-004 pandas is not installed.
        """
        try:
            pandas = import_module("pandas")
        except ImportError:
            text = "a DataFrame needs the package pandas, which is not installed"
            raise InputError("SK-INPUT-004", text, help=install_command("pandas")) from None
        return pandas.DataFrame([asdict(row) | {"text": row.text} for row in self.rows])

    def as_dict(self) -> dict[str, Any]:
        """Return the table as plain values; NaN and infinite numbers are None."""
        return {
            "a": self.a,
            "b": self.b or None,
            "confidence": self.confidence,
            "same": self.is_same,
            "verdicts": dict(self.counts()),
            "notes": list(self.notes),
            "rows": [_plain(row) for row in self.rows],
        }

    def text(self, *, everything: bool = False) -> str:
        """Return the table as text.

        Args:
            everything: list all rows instead of those that differ.
        """
        return "\n".join(table_lines(self, everything=everything))

    def __repr__(self) -> str:
        return self.text()

    def _repr_html_(self) -> str:
        """Return the rows as an HTML table, for notebooks."""
        return html_table(self.rows, has_b=bool(self.b))

    def write_html(self, path: str | os.PathLike[str]) -> None:
        """Write the page of the comparison, with all rows and plots.

        Raises:
            InputError: SK-CLI-016 the page cannot be written.
        """
        contents = PageContents(
            self.a, self.b, self.confidence, self.notes, summary(self), self.differing, self.rows, self.charts
        )
        write_page(contents, Path(path))


def _plain(row: Row) -> dict[str, Any]:
    values = asdict(row) | {"text": row.text}
    values["interval"] = [finite_or_none(v) for v in row.interval]
    return {key: finite_or_none(value) if isinstance(value, float) else value for key, value in values.items()}


def table_lines(comparison: Comparison, *, everything: bool) -> Iterator[str]:
    """Yield the lines of a table: a heading for each topic, and its rows."""
    has_b = bool(comparison.b)
    yield f"a: {comparison.a}"
    if has_b:
        yield f"b: {comparison.b}"
    yield from (f"note: {note}" for note in comparison.notes)
    shown = comparison.rows if everything or not has_b else [r for r in comparison.rows if r.verdict in DIFFERING]
    cells = [(row.topic, cells_of(row, has_b=has_b)) for row in shown]
    heads = headings(comparison.confidence, has_b=has_b)
    widths = [max((len(c[k]) for c in (heads, *(line for _, line in cells))), default=0) for k in range(len(heads))]
    topic = ""
    for name, line in cells:
        if name != topic:
            topic = name
            yield ""
            yield name
            yield "  " + _columns(heads, widths)
        yield "  " + _columns(line, widths)
    if cells:
        yield ""
    if has_b:
        yield summary(comparison)


def _columns(cells: Sequence[str], widths: Sequence[int]) -> str:
    first = f"{cells[0]:<{widths[0]}}"
    middle = "".join(f"  {c:>{w}}" for c, w in zip(cells[1:], widths[1:], strict=True))
    if len(cells) > 3:
        middle = "".join(f"  {c:>{w}}" for c, w in zip(cells[1:-1], widths[1:-1], strict=True)) + f"  {cells[-1]}"
    return (first + middle).rstrip()


def summary(comparison: Comparison) -> str:
    """Return the numbers of rows of each verdict, in one line."""
    counts = comparison.counts()
    verdicts = ("differs", "only in a", "only in b", "within tolerance", "same", "not tested")
    parts = [f"{counts[verdict]} {verdict}" for verdict in verdicts if counts[verdict]]
    return f"{counted(len(comparison.rows), 'row')}: " + ", ".join(parts) if parts else "no rows"
