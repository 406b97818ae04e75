"""Tables of `contact.py` in Markdown: a row for each group of cases, with the worst of the group in each engine."""

from __future__ import annotations

import math
import statistics
from collections.abc import Mapping, Sequence
from typing import Any

from contact_measures import MEASURES

Done = Sequence[Mapping[str, Any]]
SLIDING = ("contact", "hop", "distance", "force", "direction", "gain")


def grouped(done: Done) -> dict[str, list[Mapping[str, Any]]]:
    """The cases by their group, in the order of the run."""
    groups: dict[str, list[Mapping[str, Any]]] = {}
    for case in done:
        groups.setdefault(case["group"], []).append(case)
    return groups


def worst(cases: Done, engine: str, quantity: str) -> float | None:
    """Value of a quantity in the case with the greatest error; NaN where a case gave none, None where none has it."""
    results = [case["results"].get(engine, {}) for case in cases]
    values: list[float] = [found[quantity] for found in results if quantity in found]
    if not values:
        return None
    if any(math.isnan(value) for value in values):
        return math.nan
    return max(values, key=MEASURES[quantity].error)


def quantities(cases: Done) -> list[str]:
    """Quantities that any engine found in these cases."""
    found = {quantity for case in cases for results in case["results"].values() for quantity in results}
    return [quantity for quantity in MEASURES if quantity in found]


def integrator_shares(cases: Done) -> str:
    """Smallest and greatest error of the way that v dt/2 of the integrator makes in these cases."""
    shares = [case["integrator_share"] for case in cases if not math.isnan(case["integrator_share"])]
    return " to ".join(dict.fromkeys(number(share) for share in (max(shares), min(shares)))) if shares else ""


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


def step_time(cases: Done, engine: str) -> str:
    """Median CPU time of a step [µs] and the median of its ratios to plain MuJoCo."""
    found = [case["results"][engine] for case in cases if "step_us" in case["results"].get(engine, ())]
    if not found:
        return "–"
    taken, ratio = (statistics.median(f[key] for f in found) for key in ("step_us", "step_ratio"))
    return f"{taken:.1f} ({ratio:.2f})"


def _title(quantity: str) -> str:
    measure = MEASURES[quantity]
    return f"{measure.title} [{measure.unit}]" if measure.unit else measure.title


def _aim(quantity: str) -> str:
    measure = MEASURES[quantity]
    if measure.more:
        return f"≥ {measure.aim:g}"
    return f"{measure.exact:g} ± {measure.aim:g}" if measure.exact else f"≤ {measure.aim:g}"


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def markdown(done: Done, engines: Sequence[str]) -> str:
    """What slides in one table with a column for each quantity, everything else in another."""
    groups = grouped(done)
    beside = " / ".join(engines)
    lines = [f"Worst case of each row; in each cell {beside}.", ""]
    head = ["case", *(f"{_title(q)}, {_aim(q)}" for q in SLIDING), "v·dt/2 itself [%]", "step [µs] (beside MuJoCo)"]
    lines += [_row(head), "|---" * len(head) + "|"]
    sliding = {group: cases for group, cases in groups.items() if "gain" in quantities(cases)}
    for group, cases in sliding.items():
        cells = [group]
        for quantity in SLIDING:
            # an angle that is turned is a way, too
            here = "angle" if quantity == "distance" and "angle" in quantities(cases) else quantity
            values = [worst(cases, engine, here) for engine in engines]
            cells.append("" if all(v is None for v in values) else " / ".join(map(number, values)))
        times = " / ".join(step_time(cases, engine) for engine in engines)
        lines.append(_row([*cells, integrator_shares(cases), times]))
    head = ["case", "quantity", "aim", *engines]
    lines += ["", _row(head), "|---" * len(head) + "|"]
    for group, cases in groups.items():
        rest = [q for q in quantities(cases) if group not in sliding or q not in {*SLIDING, "angle"}]
        for quantity in rest:
            shown = [number(worst(cases, engine, quantity)) for engine in engines]
            lines.append(_row([group, _title(quantity), _aim(quantity), *shown]))
        if group not in sliding:
            cells = [group, "step [µs] (beside MuJoCo)", "", *(step_time(cases, engine) for engine in engines)]
            lines.append(_row(cells))
    return "\n".join(lines)
