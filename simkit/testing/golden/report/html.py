"""HTML report of golden runs: one file that loads no other files and runs no code."""

from __future__ import annotations

import base64
import math
import os
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.diagnostics import shorten
from simkit.msgs.field_units import unit_of
from simkit.number_text import counted
from simkit.recording.charts.page_chart import PageChart, page_chart_svg
from simkit.testing.golden.compare.difference import Cause, Comparison, Verdict
from simkit.testing.golden.compare.tolerances import allowed_text as tolerance_text
from simkit.testing.golden.compare.tolerances import tolerance_of
from simkit.testing.golden.report.difference_plot import (
    ImageFigure,
    ImageRow,
    PlotFigure,
    image_figure,
    plot_figure,
)
from simkit.testing.golden.report.text_report import (
    PROOF_PREFIX,
    REGULAR_ENDINGS,
    allowed_text,
    cause_lines,
    clean_text,
    headline,
    machine_text,
    passed_text,
    proof_text,
)
from simkit.testing.run_record.record import Stream
from simkit.writers.atomic_output import write_atomically

if TYPE_CHECKING:
    from jinja2 import Template

_TEMPLATE: Final = Path(__file__).with_name("report.html.j2")
_LONGEST: Final = 2_000  # maximum length of a text in characters
_PLOTS: Final = 8  # maximum number of figures of one golden run
_ALL_PLOTS: Final = 80  # maximum number of figures on a page
_FIELDS: Final = 4  # fields that are named for one tolerance
_ROWS: Final = 200  # maximum number of rows in a table
_BLESS: Final = 'simkit golden check GOLDEN --bless "reason for the change"'


@dataclass(frozen=True)
class _MachineRow:
    name: str
    golden: str
    run: str
    differs: bool


@dataclass(frozen=True)
class _ComparedRow:
    """One compared topic, or the physics states."""

    name: str
    type_name: str
    count: str
    compared: str
    allowed: str


@dataclass(frozen=True)
class _VerdictView:
    """Data about one golden run that the page shows in addition to the verdict.

    Attributes:
        number: Position on the page.
        found: Result in one sentence.
        ending: End of the run; empty if the run ended regularly.
        codes: Diagnostic codes whose counts differ between the runs.
        tier: Description of the comparison between the machines.
        compared: Compared topics and states, with their tolerances.
        pictures: Pictures of both worlds, with a note about missing ones.
    """

    number: int
    verdict: Verdict
    found: str
    figures: Sequence[PlotFigure | ImageFigure]
    ending: str
    codes: Sequence[str]
    diagnostics: Sequence[object]
    tier: str
    machine: Sequence[_MachineRow]
    compared: Sequence[_ComparedRow]
    pictures: ImageRow


def write_html(path: str | os.PathLike[str], verdicts: Iterable[Verdict], *, bless: str = _BLESS) -> None:
    """Write the page atomically.

    Args:
        path: File to write; missing folders are created.
        verdicts: Verdicts in any order; the page shows failed verdicts first.
        bless: Command that makes the new run golden.

    Raises:
        InputError: SK-CLI-016 the file cannot be written.
    """
    write_atomically(path, report_page(list(verdicts), bless=bless).encode())


def report_page(verdicts: Sequence[Verdict], *, bless: str = _BLESS) -> str:
    """Return the page as HTML text that is valid XML too."""
    ordered = sorted(verdicts, key=lambda verdict: verdict.passed)
    failed = sum(not verdict.passed for verdict in verdicts)
    all_ = counted(len(verdicts), "golden run")
    title = f"{failed} of {all_} differ" + ("s" if failed == 1 else "") if failed else f"{all_} unchanged"
    views, plots = [], _ALL_PLOTS
    for number, verdict in enumerate(ordered):
        views.append(_verdict_view(verdict, number, min(_PLOTS, plots)))
        plots -= len(views[-1].figures)
    return _template().render(title=title, failed=failed, views=views, bless=bless)


def _template() -> Template:
    from jinja2 import Environment, StrictUndefined  # slow to import, and only pages need it
    from markupsafe import Markup

    def clean(value: object) -> object:
        return value if isinstance(value, Markup) else clean_text(shorten(str(value), _LONGEST))

    def svg(chart: PageChart) -> Markup:
        words = {name: str(clean(getattr(chart, name))) for name in ("title", "x_label", "y_label")}
        return Markup(page_chart_svg(replace(chart, **words)))  # type: ignore[arg-type]

    environment = Environment(
        autoescape=True, finalize=clean, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters["not"] = lambda value: not value
    environment.filters["seconds"] = lambda time: f"{time:.6g} s" if math.isfinite(time) else ""
    environment.filters["allowed"] = lambda difference, exact: allowed_text(difference, exact=exact)
    environment.globals.update(most_rows=_ROWS, svg=svg, cause_lines=cause_lines, proof=_proof)
    return environment.from_string(_TEMPLATE.read_text(encoding="utf-8"))


def _verdict_view(verdict: Verdict, number: int, most_plots: int) -> _VerdictView:
    golden, run, end = verdict.golden.diagnostics, verdict.run.diagnostics, verdict.run.end
    return _VerdictView(
        number,
        verdict,
        passed_text(verdict) if verdict.passed else headline(verdict),
        [] if verdict.passed else list(_figures(verdict, most_plots)),
        end if end not in REGULAR_ENDINGS or end != verdict.golden.end else "",
        [code for code in sorted({*golden, *run}) if golden.get(code, 0) != run.get(code, 0)],
        list(getattr(verdict.run.simulation, "diagnostics", ()) or ()),
        _tier(verdict.comparison),
        _machine_rows(verdict),
        list(_compared_rows(verdict)),
        _world_row(verdict),
    )


def _compared_rows(verdict: Verdict) -> Iterator[_ComparedRow]:
    """Describe the physics states, and the messages and tolerances of each topic."""
    golden, run = verdict.golden, verdict.run
    is_exact = verdict.comparison.tier == "exact"
    states = golden.states
    count = f"{len(states.ticks)} stored"
    quantities = counted(len(states.names), "quantity", "quantities") + (
        ", and the hash of the last state" if states.digest else ""
    )
    tolerance = "the same bits" if is_exact else "tolerances by unit"
    allowed_states = tolerance if run.scenario.state else "not compared (state: false)"
    yield _ComparedRow("physics states", "", count, quantities, allowed_states)
    for topic in sorted(golden.streams.keys() & run.streams.keys()):
        stream = golden.streams[topic]
        fields = [*stream.columns, *stream.words, *stream.statistics]
        what = counted(len(fields), "field") + (" and images" if stream.pictures else "")
        allowed = "the same bits" if is_exact else _tolerances(verdict, stream)
        yield _ComparedRow(topic, stream.type_name, str(len(stream.times_ns)), what, allowed)


def _tolerances(verdict: Verdict, stream: Stream) -> str:
    """Return the tolerances of the fields of a topic in words, with the fields that share each one."""
    groups: dict[str, list[str]] = {}
    for field in stream.columns:
        tolerance = tolerance_of(verdict.run.scenario, stream.topic, stream.type_name, field)
        is_exact = bool(tolerance.exact)
        words = "the same bits" if is_exact else tolerance_text(tolerance, unit_of(stream.type_name, field))
        groups.setdefault(words, []).append(field)
    if stream.pictures is not None:
        of_images = tolerance_of(verdict.run.scenario, stream.topic, stream.type_name, "data")
        groups[f"mean difference {of_images.image:g} of 255, similarity {of_images.ssim:g}"] = ["images"]
    if len(groups) == 1:
        return next(iter(groups))
    return "; ".join(
        f"{words}: {', '.join(fields[:_FIELDS])}"
        + (f" and {len(fields) - _FIELDS} more" if len(fields) > _FIELDS else "")
        for words, fields in groups.items()
    )


def _world_row(verdict: Verdict) -> ImageRow:
    images = [
        (name, "data:image/jpeg;base64," + base64.b64encode(data).decode()) for name, data in verdict.world_pictures
    ]
    return ImageRow(images, verdict.world_note or ("both worlds at the beginning of the run" if images else ""))


def _proof(cause: Cause) -> str:
    return proof_text(cause).removeprefix(PROOF_PREFIX) or "not tested"


def _figures(verdict: Verdict, most: int) -> Iterator[PlotFigure | ImageFigure]:
    """Draw the first difference of each topic, then the further differences; draw each field at most once."""
    seen: set[tuple[str, str]] = set()
    before: Counter[str] = Counter()
    ranked_differences = []
    for difference in verdict.comparison.differences:
        ranked_differences.append((before[difference.topic], difference))
        before[difference.topic] += 1
    for _, difference in sorted(ranked_differences, key=lambda ranked_difference: ranked_difference[0]):
        if len(seen) >= most:
            return
        what = (difference.topic, difference.field)
        if what in seen:
            continue
        drawn = image_figure(verdict, difference) or plot_figure(verdict, difference)
        if drawn is not None:
            seen.add(what)
            yield drawn


def _tier(comparison: Comparison) -> str:
    if comparison.tier == "exact":
        return "no difference of the machine that can change bits: bits must be equal"
    if not comparison.machine:
        return "no known difference of the machine; numbers must be within the tolerances"
    known = machine_text(comparison) or "see the table"
    return f"other machine or versions ({known}): numbers must be within the tolerances"


def _machine_rows(verdict: Verdict) -> list[_MachineRow]:
    golden, run = verdict.golden.fingerprint, verdict.run.fingerprint
    names = sorted({*golden, *run}, key=lambda name: (golden.get(name) == run.get(name), name))
    return [_MachineRow(n, golden.get(n, ""), run.get(n, ""), golden.get(n) != run.get(n)) for n in names]
