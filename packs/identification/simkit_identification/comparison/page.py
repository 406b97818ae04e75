"""HTML page of a comparison: one file that loads no other files and runs no code."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from simkit_identification.comparison.row import Row, html_table
from simkit_identification.result_texts import write_html

_TEMPLATE: Final = Path(__file__).with_name("page.html.j2")


@dataclass(frozen=True)
class PageContents:
    """Contents of a page.

    Attributes:
        a: name of the first source.
        b: name of the second source; empty for none.
        confidence: confidence of the intervals.
        notes: remarks.
        summary: numbers of rows of each verdict.
        differing: rows that differ.
        rows: all rows.
        charts: title and SVG of each plot.
    """

    a: str
    b: str
    confidence: float
    notes: Sequence[str]
    summary: str
    differing: Sequence[Row]
    rows: Sequence[Row]
    charts: Sequence[tuple[str, str]]


def write_page(contents: PageContents, target: Path) -> Path:
    """Write the page of a comparison; return its path.

    Raises:
        InputError: SK-CLI-016 the page cannot be written.
    """
    tables = [
        html_table(rows, has_b=bool(contents.b), confidence=contents.confidence) if rows else ""
        for rows in (contents.differing, contents.rows)
    ]
    values = {
        "a": contents.a, "b": contents.b, "notes": contents.notes, "confidence": f"{contents.confidence:.0%}",
        "charts": contents.charts, "summary": contents.summary, "differing": len(contents.differing),
        "worst": tables[0], "rows": tables[1],
    }  # fmt: skip
    return write_html(_TEMPLATE, values, target)
