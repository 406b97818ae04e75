"""Plot of `contact.py`: results over the time step, and the time of a step in heaps."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from typing import Any

from contact_engines import LAW
from contact_tables import Results

COLOURS = {"simkit": "C3", LAW: "C0", "PyBullet": "C1", "Drake": "C2", "DART": "C4"}
WIDEST = 20.0  # ratio of the greatest to the least value above which an axis is logarithmic
LEAST = 1e-3  # value that is drawn for smaller ones on such an axis
HEAP = "fall_us"
MOST = 4  # rows of a table that are drawn one by one


def _over_step(axes: Any, results: Results) -> None:
    """Draw the first quantity over the step: a line for each row and engine, or the median of more than `MOST` rows."""
    key, quantity = next(iter(results.quantities.items()))
    drawn: list[float] = []
    for engine in reversed(results.engines):  # simkit's lines lie on top
        rows = [[results.value(row, engine, key, (step,)) for step in results.steps] for row in results.rows]
        lines = [[math.nan if value is None else max(LEAST, abs(value)) for value in row] for row in rows]
        lines = [line for line in lines if not all(map(math.isnan, line))]
        if len(lines) > MOST:
            lines = [[statistics.median(values) for values in zip(*lines, strict=True)]]
        for line in lines:
            drawn += [value for value in line if not math.isnan(value)]
            axes.plot([1e3 * step for step in results.steps], line, "o-", color=COLOURS[engine], ms=3, lw=1, alpha=0.7)
    is_median = len(results.rows) > MOST
    axes.set(
        xscale="log", xlabel="step [ms]", title=results.table.title + (", median of the rows" if is_median else "")
    )
    axes.set_ylabel(f"{quantity.title} [{quantity.unit}]")
    if drawn and max(drawn) > WIDEST * min(drawn):
        axes.set_yscale("log")
    if quantity.aim is not None:
        axes.axhline(quantity.aim, color="k", linestyle=":", lw=1)
    axes.set_xticks([1e3 * step for step in results.steps], [f"{1e3 * step:.2g}" for step in results.steps])
    axes.minorticks_off()
    axes.grid(alpha=0.3)


def _heaps(axes: Any, results: Results) -> None:
    """Draw the time of a step in each heap that falls."""
    width = 0.8 / len(results.engines)
    for place, engine in enumerate(results.engines):
        values = [results.value(row, engine, HEAP, results.steps) or 0.0 for row in results.rows]
        at = [i + (place + 0.5) * width - 0.4 for i in range(len(values))]
        axes.bar(at, values, width, color=COLOURS[engine], label=engine)
    axes.set(title="Heaps that fall", ylabel="step [µs]")
    axes.set_xticks(range(len(results.rows)), results.rows)
    axes.grid(axis="y", alpha=0.3)


def draw(done: Sequence[Results], path: str) -> None:
    """Draw the figure into a file, a panel for each table that has a column for each step."""
    import matplotlib as mpl

    mpl.use("Agg")
    mpl.rcParams["svg.hashsalt"] = "contact"  # the same numbers give the same file
    from matplotlib import pyplot as plt
    from matplotlib.lines import Line2D

    panels = [results for results in done if results.table.by_step or HEAP in results.quantities]
    if not panels:
        raise SystemExit("no table of these cases is drawn")
    columns = min(3, len(panels))
    rows = -(-len(panels) // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(4.2 * columns, 3.4 * rows), squeeze=False)
    for axes, results in zip(grid.flat, panels, strict=False):
        (_over_step if results.table.by_step else _heaps)(axes, results)
    for axes in grid.flat[len(panels) :]:
        axes.set_axis_off()
    names = {name: None for results in panels for name in results.engines}
    handles = [Line2D([], [], color=COLOURS[name], marker="o", label=name) for name in COLOURS if name in names]
    figure.legend(handles=handles, loc="upper center", ncols=len(handles))
    figure.tight_layout(rect=(0, 0, 1, 0.96))
    metadata = {"Date": None} if path.endswith(".svg") else None
    figure.savefig(path, dpi=110, metadata=metadata)
