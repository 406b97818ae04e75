"""Plot of `contact.py`: hop and way of sliding boxes over their speed, errors of the other cases beside their aims."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

from contact_measures import MEASURES
from contact_tables import Done, grouped, number, quantities, worst

COLOURS = ("C0", "C1", "C2")
BARS = ("hop", "distance", "angle", "creep", "yaw", "restitution", "rebound", "rest", "sink", "stands")
LEAST, MOST = 1e-3, 1e4  # shares of an aim that are drawn


def _over_speed(axes: Any, done: Done, engines: Sequence[str], quantity: str) -> None:
    """Worst and best error of the sliding boxes at each speed, over all coefficients and steps."""
    measure = MEASURES[quantity]
    floor = 1e-4
    for colour, engine in zip(COLOURS, engines, strict=False):
        speeds: dict[float, list[float]] = {}
        for case in done:
            found = re.fullmatch(r"box_(\d+)mps_mu.*", case["name"])
            value = case["results"].get(engine, {}).get(quantity)
            if found and value is not None and not math.isnan(value):
                speeds.setdefault(float(found[1]), []).append(max(floor, measure.error(value)))
        if speeds:
            x = sorted(speeds)
            axes.plot(x, [max(speeds[v]) for v in x], "o-", color=colour, label=engine)
            axes.fill_between(x, [min(speeds[v]) for v in x], [max(speeds[v]) for v in x], color=colour, alpha=0.15)
    axes.axhline(measure.aim, color="k", linestyle=":", label=f"aim, {measure.aim:g} {measure.unit}")
    axes.set(xscale="log", yscale="log", xlabel="speed at the start [m/s]")
    ticks = (1, 3, 10, 20)
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.minorticks_off()
    axes.grid(alpha=0.3)


def _bars(axes: Any, done: Done, engines: Sequence[str]) -> int:
    """Draw every other error as a multiple of what is aimed at; return the number of rows."""
    rows = []
    for group, cases in grouped(done).items():
        for quantity in quantities(cases):
            if quantity not in BARS or re.fullmatch(r"box, \d+ m/s", group):
                continue
            rows.append((group, quantity, [worst(cases, engine, quantity) for engine in engines]))
    height = 0.8 / len(engines)
    for place, (_, quantity, values) in enumerate(rows):
        measure = MEASURES[quantity]
        for i, value in enumerate(values):
            if value is None:
                continue
            share = MOST if math.isnan(value) else measure.error(value) / max(measure.allowed, 1e-9)
            share = min(MOST, max(LEAST * 1.5, share))
            at = place - 0.4 + (i + 0.5) * height
            axes.barh(at, share, height, left=0, color=COLOURS[i], label=engines[i] if place == 0 else None)
            axes.text(share * 1.1, at, number(value), fontsize=5.5, va="center")
    labels = [f"{group}: {MEASURES[q].title} [{MEASURES[q].unit}]".replace(" []", "") for group, q, _ in rows]
    axes.set_yticks(range(len(rows)), labels, fontsize=8)
    axes.set(xscale="log", xlim=(LEAST, MOST * 4), ylim=(len(rows) - 0.4, -0.6), xlabel="error / error aimed at")
    axes.axvline(1.0, color="k", linestyle=":")
    axes.grid(axis="x", alpha=0.3)
    return len(rows)


def draw(done: Done, engines: Sequence[str], path: str) -> None:
    """Draw the figure into a file."""
    import matplotlib as mpl

    mpl.use("Agg")
    mpl.rcParams["svg.hashsalt"] = "contact"  # the same numbers give the same file
    from matplotlib import pyplot as plt

    figure = plt.figure(figsize=(10, 16), constrained_layout=True)
    halves: Any = figure.subfigures(2, 1, height_ratios=(1, 3))
    top, bottom = halves
    left, right = top.subplots(1, 2)
    _over_speed(left, done, engines, "hop")
    left.set(title="Boxes that slide: hop", ylabel="greatest hop [mm]")
    left.legend()
    _over_speed(right, done, engines, "distance")
    right.set(title="Boxes that slide: way, beyond the integrator's v·dt/2", ylabel="error of the way [%]")
    axes = bottom.subplots()
    _bars(axes, done, engines)
    axes.set_title("Other cases: worst of each row, in the unit named; left of 1 is within the aim")
    axes.legend(loc="lower right")
    metadata = {"Date": None} if path.endswith(".svg") else None
    figure.savefig(path, dpi=110, metadata=metadata)
