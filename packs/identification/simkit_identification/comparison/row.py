"""Rows of a comparison, and their cells as text."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Final, Literal

Verdict = Literal["same", "within tolerance", "differs", "only in a", "only in b", "not tested", "measured"]
DIFFERING: Final = frozenset({"differs", "only in a", "only in b"})
"""Verdicts of rows that make `--check` fail."""


@dataclass(frozen=True)
class Row:
    """One quantity of a topic in both recordings.

    Attributes:
        topic: name of the topic in a.
        quantity: name of the quantity.
        unit: unit of all numbers of the row.
        a, b: values; NaN for none.
        difference: b - a; for a distribution, the largest difference of the shares.
        interval: confidence interval of the difference, or of the value if there is only one recording; NaN if unknown.
        chance: probability of such a difference if nothing differs; NaN if unknown.
        verdict: verdict.
        tolerance: difference that counts as none.
        note: remark.
    """

    topic: str
    quantity: str
    unit: str
    a: float
    b: float
    difference: float
    interval: tuple[float, float]
    chance: float
    verdict: Verdict
    tolerance: float = 0.0
    note: str = ""

    @property
    def text(self) -> str:
        """Verdict with its size, as a sentence."""
        unit = f" {self.unit}" if self.unit else ""
        if self.verdict == "measured":
            return self.note or "measured"
        if self.verdict in ("only in a", "only in b", "same"):
            return self.verdict + (f" ({self.note})" if self.note else "")
        if math.isnan(self.difference):
            return self.verdict + (f": {self.note}" if self.note else "")
        size = f"{abs(self.difference):.3g}{unit}"
        direction = "larger" if self.difference > 0.0 else "smaller"
        if self.quantity.endswith("distribution"):
            moved = f"{abs(self.difference):.0%} of the messages have other values"
        else:
            moved = f"b is {size} {direction}{_relative(self)}"
        if self.verdict == "differs":
            return f"differs: {moved}"
        return f"{self.verdict}: {moved}" + (f"; {self.note}" if self.note else "")


def _relative(row: Row) -> str:
    """Return the relative size of a difference in words; empty for a value near zero."""
    if not row.a or not math.isfinite(row.difference) or abs(row.difference) > 100.0 * abs(row.a):
        return ""
    return f" ({row.difference / abs(row.a):+.1%})"


def number_text(value: float) -> str:
    """Format a number of a table with four digits; a dash for NaN."""
    return "–" if value != value else f"{value:.4g}"


def interval_text(row: Row) -> str:
    """Format the confidence interval of a row; empty if it is unknown."""
    low, high = row.interval
    return f"{low:.3g} … {high:.3g}" if math.isfinite(low) and math.isfinite(high) else ""


def cells_of(row: Row, *, has_b: bool) -> tuple[str, ...]:
    """Return the cells of a row as texts."""
    quantity = row.quantity + (f" [{row.unit}]" if row.unit else "")
    if not has_b:
        return quantity, number_text(row.a), interval_text(row)
    return quantity, number_text(row.a), number_text(row.b), number_text(row.difference), interval_text(row), row.text


def headings(confidence: float, *, has_b: bool) -> tuple[str, ...]:
    """Return the headings of the columns."""
    percent = f"{confidence:.0%}"
    return ("quantity", "a", "b", "b - a", percent, "verdict") if has_b else ("quantity", "value", percent)


def html_table(rows: Sequence[Row], *, has_b: bool, confidence: float = 0.95) -> str:
    """Return rows as an HTML table."""
    heads = "".join(f"<th>{escape(h)}</th>" for h in ("topic", *headings(confidence, has_b=has_b)))
    lines = []
    for row in rows:
        role = "bad" if row.verdict in DIFFERING else ""
        first, *numbers = cells_of(row, has_b=has_b)
        last = numbers.pop() if has_b else None
        inner = f"<td><code>{escape(row.topic)}</code></td><td>{escape(first)}</td>"
        inner += "".join(f'<td class="n">{escape(n)}</td>' for n in numbers)
        inner += f'<td class="{role}">{escape(last)}</td>' if last is not None else ""
        lines.append(f"<tr>{inner}</tr>")
    return f"<table><thead><tr>{heads}</tr></thead><tbody>{''.join(lines)}</tbody></table>"
