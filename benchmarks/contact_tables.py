"""Tables of `contact.py` in Markdown, in full for a terminal and with fewer columns for the page."""

from __future__ import annotations

import math
import re
import statistics
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from contact_engines import LAW
from contact_scene import Quantity, Table

WIDTH = 130  # of a line of text
PAGE_STEP = 0.001  # [s]
STEP = {"step_us": Quantity("step", "µs", mean=True, beside=True)}


@dataclass
class Results:
    """Results of a table's cases.

    Attributes:
        found: by row, engine and step; one mapping from quantity to value for each case.
    """

    table: Table
    steps: tuple[float, ...]
    found: dict[tuple[str, str, float], list[Mapping[str, float]]] = field(default_factory=dict)

    def add(self, row: str, engine: str, step: float, values: Mapping[str, float]) -> None:
        self.found.setdefault((row, engine, step), []).append(values)

    @property
    def rows(self) -> list[str]:
        return list(dict.fromkeys(row for row, _, _ in self.found))

    @property
    def engines(self) -> list[str]:
        names = {engine for _, engine, _ in self.found}
        return [name for name in self.table.engines if name in names]

    @property
    def quantities(self) -> dict[str, Quantity]:
        """Quantities of the table that any engine found, and the times of a step."""
        keys = {key for cases in self.found.values() for values in cases for key in values}
        return {key: quantity for key, quantity in {**self.table.quantities, **STEP}.items() if key in keys}

    def value(self, row: str, engine: str, key: str, steps: Iterable[float]) -> float | None:
        """Value of a cell: the worst or the mean of the cases; NaN where a case diverged, None where there is none."""
        cases = [values for step in steps for values in self.found.get((row, engine, step), ())]
        values = [found[key] for found in cases if key in found]
        if not values:
            return None
        quantity = self.quantities[key]
        if any(math.isnan(value) for value in values):
            return math.nan
        return statistics.fmean(values) if quantity.mean else max(values, key=quantity.error)


def number(value: float | None) -> str:
    """Three digits at most, without exponents."""
    if value is None:
        return "–"
    if math.isnan(value):
        return "diverged"
    size = abs(value)
    if size < 0.0005:
        return "0"
    return f"{value:.0f}" if size >= 100 else f"{value:.{2 if size < 10 else 1}f}" if size >= 0.01 else f"{value:.3f}"


def _title(quantity: Quantity) -> str:
    unit = f" [{quantity.unit}]" if quantity.unit else ""
    if quantity.beside:
        unit += f" (beside {LAW})"
    if quantity.aim is None:
        return f"{quantity.title}{unit}"
    bound = f"{quantity.exact:g} ± {quantity.aim:g}" if quantity.exact else f"≤ {quantity.aim:g}"
    return f"{quantity.title}{unit}, " + (f"≥ {quantity.aim:g}" if quantity.more else bound)


def _cell(results: Results, row: str, engine: str, key: str, steps: Iterable[float]) -> str:
    value = results.value(row, engine, key, steps)
    base = results.value(row, LAW, key, steps) if results.quantities[key].beside else None
    return number(value) + (f" ({number(value / base)})" if value and base else "")


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def markdown(results: Results) -> str:
    """The table, with a column for each step or for each quantity."""
    shown = results.quantities
    if results.table.by_step:
        head = [f"{1e3 * step:g} ms" for step in results.steps]
        columns: list[tuple[list[str], tuple[float, ...]]] = [(list(shown), (step,)) for step in results.steps]
    else:
        head = [_title(quantity) for quantity in shown.values()]
        columns = [([key], results.steps) for key in shown]
    lines = [_line(["case", "engine", *head]), "|---" * (2 + len(head)) + "|"]
    for row in results.rows:
        for engine in results.engines:
            cells = []
            for keys, steps in columns:
                texts = [_cell(results, row, engine, key, steps) for key in keys]
                cells.append("–" if set(texts) == {"–"} else " / ".join(texts))
            if set(cells) != {"–"}:
                lines.append(_line([row, engine, *cells]))
    return "\n".join(lines)


def page_table(results: Results) -> str:
    """The table for the page: a column for each engine at the step next to 1 ms, or of the headline quantities."""
    table = results.table
    keys = list(results.quantities) if table.by_step else [k for k in table.headline if k in results.quantities]
    if not keys:
        return markdown(results)
    steps, first = results.steps, "case: " + " / ".join(_title(results.quantities[key]) for key in keys)
    if table.by_step:
        steps = (min(results.steps, key=lambda step: abs(step - PAGE_STEP)),)
        first = f"case, step {1e3 * steps[0]:g} ms"
    lines = [_line([first, *results.engines]), "|---" * (1 + len(results.engines)) + "|"]
    for row in results.rows:
        exist = [k for k in keys if any(results.value(row, one, k, steps) is not None for one in results.engines)]
        texts = [[_cell(results, row, engine, key, steps) for key in exist] for engine in results.engines]
        lines.append(_line([row, *("–" if set(cell) == {"–"} else " / ".join(cell) for cell in texts)]))
    return "\n".join(lines)


def section(results: Results) -> str:
    """The text of a table and the table for the page."""
    return f"{textwrap.fill(results.table.text, WIDTH, break_on_hyphens=False)}\n\n{page_table(results)}"


def _marker(name: str) -> tuple[str, str]:
    return f"<!-- contact.py: {name} -->", f"<!-- end of {name} -->"


def replace_sections(text: str, sections: Mapping[str, str]) -> str:
    """Return a page with the text between the markers of each section replaced.

    Raises:
        ValueError: the page has no markers for a section.
    """
    for name, content in sections.items():
        first, last = _marker(name)
        pattern = re.compile(re.escape(first) + ".*?" + re.escape(last), re.DOTALL)
        if not pattern.search(text):
            raise ValueError(f"the page has no section {first} … {last}")
        before, rest = pattern.split(text, maxsplit=1)
        text = f"{before}{first}\n\n{content}\n\n{last}{rest}"
    return text


def write_page(path: Path, sections: Mapping[str, str]) -> None:
    """Replace the sections of a page in its file."""
    path.write_text(replace_sections(path.read_text(encoding="utf-8"), sections), encoding="utf-8")
