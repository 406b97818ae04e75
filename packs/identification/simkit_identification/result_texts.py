"""Texts and files of results: numbers for JSON and for people, and HTML pages that load no other files."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path

from simkit.writers.atomic_output import write_atomically


def finite_or_none(value: float) -> float | None:
    """Return a number for JSON; None for NaN and infinity, which JSON lacks."""
    return value if math.isfinite(value) else None


def percent(share: float) -> str:
    """Return a share as a text; a dash for NaN."""
    if math.isnan(share):
        return "–"
    return f"{100.0 * share:.3g} %" if share >= 1e-5 else "0 %"


def write_html(
    template: Path, values: Mapping[str, object], target: Path, filters: Mapping[str, Callable[..., str]] | None = None
) -> Path:
    """Write a page; return its path.

    Args:
        template: template of Jinja.
        values: values of the template by name; texts are escaped.
        target: page to write.
        filters: functions that the template calls, by name.

    Raises:
        InputError: SK-CLI-016 the page cannot be written.
    """
    from jinja2 import Environment, StrictUndefined

    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters.update(filters or {})
    page = environment.from_string(template.read_text("utf-8")).render(values)
    write_atomically(target, page.encode("utf-8"))
    return target
