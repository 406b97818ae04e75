"""First tick at which two runs differ, and the quantity that differs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simkit.testing.run_record.record import States

Numbers = npt.NDArray[np.float64]

_ROUNDING = 1e-9
"""Smallest scale of a quantity, so that smaller differences are listed last."""


@dataclass(frozen=True)
class FirstDifferentTick:
    """First difference in the physics of two runs.

    Attributes:
        tick: First tick at which the state differs, as a number of steps; 0 if the initial states differ.
        time: Simulated time of the tick [s].
        has_other_input: True if an input from plugins or commands differs at this tick or earlier.
        quantity: First quantity that differs, in words; empty if unknown.
        words: Complete description of the difference.
    """

    tick: int
    time: float
    has_other_input: bool
    quantity: str
    words: str


def first_different_tick(golden: States, run: States) -> FirstDifferentTick | None:
    """Find the first difference in the physics of two runs; None if there is none.

    A mark is a hash of one byte, so the marks of different states are equal with a probability of 1/256. The
    difference then appears at the next tick.
    """
    state, input_index = (
        _first_different_mark(golden.marks, run.marks),
        _first_different_mark(golden.inputs, run.inputs),
    )
    if state is None and input_index is None and golden.digest == run.digest:
        return None
    index = min(i for i in (state, input_index, len(golden.marks)) if i is not None)
    starts = _initial_states_differ(golden, run)
    by_input = input_index is not None and (state is None or input_index <= state) and not starts
    tick = 0 if starts else index + 1
    time = tick * (run.timestep or golden.timestep)
    quantity = _quantity(golden, run, tick, by_input)
    return FirstDifferentTick(
        tick, time, by_input, quantity, _description(tick, time, by_input, state is None, golden, run, quantity)
    )


def _first_different_mark(golden: npt.NDArray[np.uint8], run: npt.NDArray[np.uint8]) -> int | None:
    """Return the index of the first mark that differs within the common length; None if there is none."""
    count = min(len(golden), len(run))
    differing = np.flatnonzero(np.asarray(golden[:count]) != np.asarray(run[:count]))
    return int(differing[0]) if differing.size else None


def _initial_states_differ(golden: States, run: States) -> bool:
    """Check whether the initial states differ."""
    if not (len(golden.ticks) and len(run.ticks)) or golden.ticks[0] or run.ticks[0]:
        return False
    names, mine, other = _common_quantities(golden, run, False)
    return bool(names) and not np.array_equal(mine[0], other[0], equal_nan=True)


def _description(
    tick: int, time: float, by_input: bool, state_same: bool, golden: States, run: States, quantity: str
) -> str:
    if golden.names != run.names:
        return "the physics has different quantities: " + _other_names(golden.names, run.names)
    if tick == 0:
        return "the initial state differs" + (f": {quantity}" if quantity else "")
    when = "from the first step on" if tick == 1 else f"first at tick {tick} (t = {_time(time)} s)"
    if by_input:
        text = f"the inputs from plugins and commands differ {when}"
        text += "; the state stays the same" if state_same else ""
    else:
        text = f"the state differs {when}; until then all inputs are equal"
        text += ", so the model, the engine or the initial state differs"
    return text + (f"; first {quantity}" if quantity else "")


def _other_names(golden: list[str], run: list[str]) -> str:
    gone, new = [n for n in golden if n not in set(run)], [n for n in run if n not in set(golden)]
    parts = []
    for names, word in ((gone, "gone"), (new, "new")):
        if names:
            parts.append(", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "") + f" {word}")
    return "; ".join(parts) or "different order"


def _quantity(golden: States, run: States, tick: int, by_input: bool) -> str:
    """Describe the largest relative difference in the first recorded state that differs."""
    names, mine, other = _common_quantities(golden, run, by_input)
    if not names:
        return ""
    ours, theirs = golden.ticks.tolist(), run.ticks.tolist()
    for at in sorted({*ours} & {*theirs}):
        a, b = mine[ours.index(at)], other[theirs.index(at)]
        if not np.array_equal(a, b, equal_nan=True):
            sizes = np.abs(np.nan_to_num(mine[: ours.index(at) + 1])).max(axis=0, initial=0.0)
            return largest_difference_text(names, a, b, sizes) + (
                f" at t = {_time(at * run.timestep)} s" if at != tick else ""
            )
    return ""


def largest_final_difference(golden: States, run: States, *, by_input: bool) -> str:
    """Describe the largest relative difference in the last states of two runs."""
    names, mine, other = _common_quantities(golden, run, by_input)
    if not names or np.array_equal(mine[-1], other[-1], equal_nan=True):
        return ""
    return largest_difference_text(names, mine[-1], other[-1], np.abs(np.nan_to_num(mine)).max(axis=0, initial=0.0))


def _common_quantities(golden: States, run: States, by_input: bool) -> tuple[list[str], Numbers, Numbers]:
    """Return the common quantities and their values in both runs; a missing input counts as 0."""
    if by_input:
        names = sorted({*golden.input_names, *run.input_names})
        mine, other = (_columns(names, states.input_names, states.input_values, 0.0) for states in (golden, run))
    else:
        names = [n for n in golden.names if n in set(run.names)]
        mine, other = (_columns(names, states.names, states.values, np.nan) for states in (golden, run))
    return names, mine, other


def _columns(names: list[str], have: list[str], values: Numbers, absent: float) -> Numbers:
    columns = np.full((len(values), len(names)), absent)
    places = {name: i for i, name in enumerate(have)}
    for at, name in enumerate(names):
        if name in places:
            columns[:, at] = values[:, places[name]]
    return np.nan_to_num(columns, nan=0.0) if absent == 0.0 else columns


def largest_difference_text(
    names: list[str], golden: npt.ArrayLike, run: npt.ArrayLike, sizes: Numbers | None = None
) -> str:
    """Describe the quantity with the largest relative difference: `robot::wheel velocity 1 → 1.01`.

    Args:
        names: Names of the quantities.
        golden: Values in the golden run, shape (quantities,).
        run: Values in the new run, shape (quantities,).
        sizes: Smallest scale of each quantity, shape (quantities,); None to use only the size of both values.
    """
    a, b = np.asarray(golden, dtype=np.float64), np.asarray(run, dtype=np.float64)
    scale = np.maximum(np.abs(a), np.abs(b)) if sizes is None else np.maximum(sizes, np.abs(b))
    off = np.abs(np.nan_to_num(a - b, nan=np.inf)) / np.maximum(scale, _ROUNDING)
    at = int(np.argmax(off))
    return f"{names[at]} {distinct_digits(a[at], b[at])}"


def distinct_digits(golden: float, run: float) -> str:
    """Format two numbers with enough digits to show their difference."""
    exact = (f"{golden:.6g}", f"{run:.6g}")
    if [float(text) for text in exact] == [golden, run]:  # numbers with few digits, as written by a person
        return f"{exact[0]} → {exact[1]}"
    for digits in (3, 4, 5, 6, 8, 10, 13, 17):
        a, b = f"{golden:.{digits}g}", f"{run:.{digits}g}"
        if a != b and _preserves_difference(float(a), float(b), golden, run):
            return f"{a} → {b}"
    return f"{golden!r} → {run!r}"


def _preserves_difference(a: float, b: float, golden: float, run: float) -> bool:
    """Check whether rounding changes the difference by at most 1 %."""
    difference = run - golden
    return not np.isfinite(difference) or abs((b - a) - difference) <= 0.01 * abs(difference)


def _time(seconds: float) -> str:
    return f"{seconds:.6f}".rstrip("0").rstrip(".") or "0"
