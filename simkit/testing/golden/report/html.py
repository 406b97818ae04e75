"""A page that says what checks of golden runs found: one file, which loads nothing and runs nothing."""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from simkit.testing.golden.compare.difference import Cause, Comparison, Verdict
from simkit.testing.golden.report.difference_plot import figure
from simkit.testing.golden.report.html_markup import STYLE, escape_html, table
from simkit.testing.golden.report.image_figure import picture_figure
from simkit.testing.golden.report.text import (
    ENDING_TEXTS,
    allowed_text,
    cause_lines,
    headline,
    machine_text,
    passed_text,
    proof_text,
)

_PLOTS: Final = 8  # of one golden run
_ALL_PLOTS: Final = 80  # of a page
_ROWS: Final = 200  # of a table
_BLESS: Final = 'simkit golden check GOLDEN --bless "why it is meant"'


def write_html(path: str | os.PathLike[str], verdicts: Iterable[Verdict], *, bless: str = _BLESS) -> None:
    """Writes the page; it is there as a whole or not at all.

    Args:
        path: of the file; folders on the way are made.
        verdicts: in any order; those that did not pass come first.
        bless: the command that makes what differs the new golden run.

    Raises:
        InputError: SK-CLI-016 the file cannot be written.
    """
    from simkit.recording.atomic_output import write_atomically

    write_atomically(path, page(list(verdicts), bless=bless).encode())


def page(verdicts: Sequence[Verdict], *, bless: str = _BLESS) -> str:
    """The page as text: HTML that is XML too."""
    ordered = sorted(verdicts, key=lambda verdict: verdict.passed)
    failed = sum(not verdict.passed for verdict in verdicts)
    all_ = f"{len(verdicts)} golden run" + ("" if len(verdicts) == 1 else "s")
    title = f"{failed} of {all_} differ" + ("s" if failed == 1 else "") if failed else f"{all_} as before"
    body = [
        f'<h1>{escape_html(title)} <span class="badge {"bad" if failed else "good"}">{_state_mark(not failed)}</span></h1>'
    ]
    if len(ordered) > 1:
        body.append(_overview(ordered))
    plots = _ALL_PLOTS
    for number, verdict in enumerate(ordered):
        if verdict.passed:
            body.append(_passed(verdict, number))
            continue
        figures = list(_figures(verdict, min(_PLOTS, plots)))
        plots -= len(figures)
        body.append(_failed(verdict, number, figures, bless))
    policy = "default-src 'none'; style-src 'unsafe-inline'; img-src data:"
    return (
        '<!DOCTYPE html>\n<html lang="en" xmlns="http://www.w3.org/1999/xhtml"><head><meta charset="utf-8"/>'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}"/>'
        '<meta name="viewport" content="width=device-width, initial-scale=1"/>'
        f"<title>{escape_html(title)}</title><style>{STYLE}</style></head><body>\n"
        + "\n".join(body)
        + "\n</body></html>\n"
    )


def _overview(verdicts: Sequence[Verdict]) -> str:
    rows = []
    for number, verdict in enumerate(verdicts[:_ROWS]):
        said = passed_text(verdict) if verdict.passed else headline(verdict)
        rows.append(
            [
                f'<a href="#golden-{number}">{escape_html(verdict.name)}</a>',
                _state_mark(verdict.passed),
                escape_html(said),
            ]
        )
    marked = [not verdict.passed for verdict in verdicts]
    return table(["golden run", "", "what was found"], rows, marked) + _left_out(len(verdicts), "golden runs")


def _passed(verdict: Verdict, number: int) -> str:
    notes = "".join(f"<li>{escape_html(note)}</li>" for note in verdict.comparison.notes[:_ROWS])
    inside = _list(notes) + _checks(verdict) + _machine(verdict) + _run(verdict)
    said = f'<span class="good">{_state_mark(True)}</span> {escape_html(passed_text(verdict))}'
    head = f"<summary><b>{escape_html(verdict.name)}</b> {said}</summary>"
    return f'<section class="passed" id="golden-{number}"><details>{head}{inside}</details></section>'


def _failed(verdict: Verdict, number: int, figures: Sequence[str], bless: str) -> str:
    parts = [
        f'<section class="failed" id="golden-{number}"><h2>{escape_html(verdict.name)} '
        f'<span class="badge bad">differs</span></h2><p class="headline">{escape_html(headline(verdict))}</p>',
        _causes(verdict),
        _differences(verdict.comparison),
        f'<h3>Golden and run</h3><div class="grid">{"".join(figures)}</div>' if figures else "",
        _checks(verdict),
        _end(verdict),
        _notes(verdict),
        _diagnostics(verdict),
        _machine(verdict),
        _run(verdict),
        f"<h3>If this is meant</h3><pre>{escape_html(bless)}</pre></section>",
    ]
    return "\n".join(filter(None, parts))


def _causes(verdict: Verdict) -> str:
    explanation = verdict.explanation
    if explanation is None:
        return ""
    rows = [
        [escape_html(cause.words), f"<code>{escape_html(cause.where)}</code>" if cause.where else "", _proof(cause)]
        for cause in explanation.causes[:_ROWS]
    ]
    told = "".join(f"<p>{escape_html(line)}</p>" for line in cause_lines(explanation)[:_ROWS])
    listed = table(["what was changed", "where", "put back"], rows) if rows else ""
    if listed and told:
        listed = f"<details><summary>Every change that was found: {len(explanation.causes)}</summary>{listed}</details>"
    return f'<h3>Where it comes from</h3><div class="cause">{told}</div>{listed}' if told or rows else ""


def _proof(cause: Cause) -> str:
    said = proof_text(cause).removeprefix("; put back, ")
    return escape_html(said or "not tried")


def _differences(comparison: Comparison) -> str:
    differences = comparison.differences
    if not differences:
        return ""
    rows = []
    for difference in differences[:_ROWS]:
        time = f"{difference.time:.6g} s" if math.isfinite(difference.time) else ""
        allowed = allowed_text(difference, exact=comparison.tier == "exact")
        rows.append([time, escape_html(difference.words), escape_html(allowed)])
    heads = ["from", "what differs", "allowed"]
    if not any(row[2] for row in rows):
        rows, heads = [row[:2] for row in rows], heads[:2]
    return f"<h3>What differs</h3>{table(heads, rows)}{_left_out(len(differences), 'differences')}"


def _figures(verdict: Verdict, most: int) -> Iterator[str]:
    """Drawings of the first difference of each topic, then of the others; no two of one field."""
    seen: set[tuple[str, str]] = set()
    before: Counter[str] = Counter()
    turns = []
    for difference in verdict.comparison.differences:
        turns.append((before[difference.topic], difference))
        before[difference.topic] += 1
    for _, difference in sorted(turns, key=lambda turn: turn[0]):
        if len(seen) >= most:
            return
        what = (difference.topic, difference.field)
        if what in seen:
            continue
        drawn = picture_figure(verdict, difference) or figure(verdict, difference)
        if drawn:
            seen.add(what)
            yield drawn


def _checks(verdict: Verdict) -> str:
    if not verdict.checks:
        return ""
    rows = []
    for result in verdict.checks[:_ROWS]:
        hint = f'<br/><span class="small">{escape_html(result.check.hint)}</span>' if result.check.hint else ""
        rows.append(
            [
                "✓ holds" if result.passed else "✗ does not hold",
                escape_html(result.check.title),
                escape_html(result.message) + hint,
            ]
        )
    marked = [not result.passed for result in verdict.checks]
    return f"<h3>Checks</h3>{table(['', 'what must hold', 'what was found'], rows, marked)}"


def _end(verdict: Verdict) -> str:
    end = verdict.run.end
    told = end not in ENDING_TEXTS or end != verdict.golden.end
    return f"<h3>How the run ended</h3><pre>{escape_html(end)}</pre>" if told else ""


def _notes(verdict: Verdict) -> str:
    notes = "".join(f"<li>{escape_html(note)}</li>" for note in verdict.comparison.notes[:_ROWS])
    return f"<h3>What differs and does not count</h3>{_list(notes)}" if notes else ""


def _diagnostics(verdict: Verdict) -> str:
    """What loading the world reported: how many of each code in both, and the run's own words."""
    golden, run = verdict.golden.diagnostics, verdict.run.diagnostics
    codes = [code for code in sorted({*golden, *run}) if golden.get(code, 0) != run.get(code, 0)]
    rows = [[f"<code>{escape_html(c)}</code>", str(golden.get(c, 0)), str(run.get(c, 0))] for c in codes[:_ROWS]]
    listed = table(["code", "golden", "run"], rows, [True] * len(rows)) if rows else ""
    found = list(getattr(verdict.run.simulation, "diagnostics", ()) or ())
    told = "".join(f"<li>{escape_html(one)}</li>" for one in found[:_ROWS])
    whole = f"<details><summary>{len(found)} of the run</summary>{_list(told)}</details>" if found else ""
    return f"<h3>Diagnostics</h3>{listed}{whole}{_left_out(len(found), 'diagnostics')}" if listed or whole else ""


def _machine(verdict: Verdict) -> str:
    comparison, golden, run = verdict.comparison, verdict.golden.fingerprint, verdict.run.fingerprint
    names = sorted({*golden, *run}, key=lambda name: (golden.get(name) == run.get(name), name))
    rows = [[escape_html(n), escape_html(golden.get(n, "")), escape_html(run.get(n, ""))] for n in names[:_ROWS]]
    tier = "the same in what counts: bits must be equal"
    if comparison.tier != "exact" and not comparison.machine:
        tier = "the same in what counts, and numbers must be within the tolerances"
    elif comparison.tier != "exact":
        tier = f"other ({machine_text(comparison) or 'see the table'}): numbers must be within the tolerances"
    listed = table(["", "golden", "run"], rows, [golden.get(n) != run.get(n) for n in names]) if rows else ""
    return f"<details><summary>Machine and versions: {escape_html(tier)}</summary>{listed}</details>"


def _run(verdict: Verdict) -> str:
    scenario = verdict.run.scenario
    world = "text" if "<" in scenario.world else scenario.world
    rows = [
        ["world", escape_html(world)],
        ["duration", f"{scenario.duration:g} s, seed {scenario.seed}, wall time {verdict.elapsed:.1f} s"],
        ["state at the end, golden", f"<code>{escape_html(verdict.golden.states.digest)}</code>"],
        ["state at the end, run", f"<code>{escape_html(verdict.run.states.digest)}</code>"],
        ["compared", f"{verdict.comparison.topics} topics, {verdict.comparison.messages} messages"],
    ]
    if scenario.overrides:
        rows.insert(1, ["set", escape_html(", ".join(scenario.overrides))])
    return f"<details><summary>What was run</summary>{table(['', ''], rows)}</details>"


def _state_mark(passed: bool) -> str:
    return "✓ passed" if passed else "✗ differs"


def _list(items: str) -> str:
    return f"<ul>{items}</ul>" if items else ""


def _left_out(count: int, what: str) -> str:
    return f'<p class="small">… and {count - _ROWS} more {what}</p>' if count > _ROWS else ""
