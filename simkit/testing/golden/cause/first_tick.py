"""The first tick at which two runs part, and what parts there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simkit.testing.run_record.record import States

Numbers = npt.NDArray[np.float64]

_ROUNDING = 1e-9
"""Of a quantity whose own size says nothing: differences below this are shown as tiny, and come last."""


@dataclass(frozen=True)
class FirstDifferentTick:
    """Where the physics of two runs parts.

    Attributes:
        tick: the first at which the state differs, counted from 1: the state after that many steps; 0 where the two
            begin differently.
        time: of that [s].
        is_put_in: whether plugins or commands put in something else at that tick or before.
        quantity: what differs there first, in words; "" where that is not known.
        words: all of it in a sentence.
    """

    tick: int
    time: float
    is_put_in: bool
    quantity: str
    words: str


def first_different_tick(golden: States, run: States) -> FirstDifferentTick | None:
    """Where the physics of two runs parts; None where it does not.

    A mark is one byte, so that one in 256 differing ticks is taken for equal; the next one then shows it.
    """
    state, put_in = _first_different_mark(golden.marks, run.marks), _first_different_mark(golden.inputs, run.inputs)
    if state is None and put_in is None and golden.digest == run.digest:
        return None
    index = min(i for i in (state, put_in, len(golden.marks)) if i is not None)
    starts = _initial_states_differ(golden, run)
    by_input = put_in is not None and (state is None or put_in <= state) and not starts
    tick = 0 if starts else index + 1
    time = tick * (run.timestep or golden.timestep)
    quantity = _quantity(golden, run, tick, by_input)
    return FirstDifferentTick(
        tick, time, by_input, quantity, _description(tick, time, by_input, state is None, golden, run, quantity)
    )


def _first_different_mark(golden: npt.NDArray[np.uint8], run: npt.NDArray[np.uint8]) -> int | None:
    """Of the first mark that differs; where one run is the beginning of the other there is none."""
    count = min(len(golden), len(run))
    differing = np.flatnonzero(np.asarray(golden[:count]) != np.asarray(run[:count]))
    return int(differing[0]) if differing.size else None


def _initial_states_differ(golden: States, run: States) -> bool:
    """Whether the two begin in different states."""
    if not (len(golden.ticks) and len(run.ticks)) or golden.ticks[0] or run.ticks[0]:
        return False
    names, mine, other = _common_quantities(golden, run, False)
    return bool(names) and not np.array_equal(mine[0], other[0], equal_nan=True)


def _description(
    tick: int, time: float, by_input: bool, state_same: bool, golden: States, run: States, quantity: str
) -> str:
    if golden.names != run.names:
        return "the physics has other quantities: " + _other_names(golden.names, run.names)
    if tick == 0:
        return "the run starts in another state" + (f": {quantity}" if quantity else "")
    when = "from the first step on" if tick == 1 else f"first at tick {tick} (t = {_time(time)} s)"
    if by_input:
        said = f"what plugins and commands put in is other {when}"
        said += "; the state stays the same" if state_same else ""
    else:
        said = f"the state is other {when}; up to there the same was put in: the model, the engine or the start"
    return said + (f"; first {quantity}" if quantity else "")


def _other_names(golden: list[str], run: list[str]) -> str:
    gone, new = [n for n in golden if n not in set(run)], [n for n in run if n not in set(golden)]
    parts = []
    for names, word in ((gone, "gone"), (new, "new")):
        if names:
            parts.append(", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "") + f" {word}")
    return "; ".join(parts) or "in another order"


def _quantity(golden: States, run: States, tick: int, by_input: bool) -> str:
    """What differs most, against what it has done so far, at the first kept state that differs."""
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
    """What differs most in the last states of two runs up to the tick at which they part."""
    names, mine, other = _common_quantities(golden, run, by_input)
    if not names or np.array_equal(mine[-1], other[-1], equal_nan=True):
        return ""
    return largest_difference_text(names, mine[-1], other[-1], np.abs(np.nan_to_num(mine)).max(axis=0, initial=0.0))


def _common_quantities(golden: States, run: States, by_input: bool) -> tuple[list[str], Numbers, Numbers]:
    """The quantities that both have, and their values in both; what is put in is nothing where it has no entry."""
    if by_input:
        names = sorted({*golden.input_names, *run.input_names})
        mine, other = (_columns(names, states.input_names, states.input_values, 0.0) for states in (golden, run))
    else:
        names = [n for n in golden.names if n in set(run.names)]
        mine, other = (_columns(names, states.names, states.values, np.nan) for states in (golden, run))
    return names, mine, other


def _columns(names: list[str], have: list[str], values: Numbers, absent: float) -> Numbers:
    found = np.full((len(values), len(names)), absent)
    places = {name: i for i, name in enumerate(have)}
    for at, name in enumerate(names):
        if name in places:
            found[:, at] = values[:, places[name]]
    return np.nan_to_num(found, nan=0.0) if absent == 0.0 else found


def largest_difference_text(
    names: list[str], golden: npt.ArrayLike, run: npt.ArrayLike, sizes: Numbers | None = None
) -> str:
    """The quantity that differs most for its size, in words: `robot::wheel velocity 1 → 1.01`.

    Args:
        names: of the quantities.
        golden, run: their values, (quantities,).
        sizes: how large each gets, (quantities,); None for as large as these two.
    """
    a, b = np.asarray(golden, dtype=np.float64), np.asarray(run, dtype=np.float64)
    scale = np.maximum(np.abs(a), np.abs(b)) if sizes is None else np.maximum(sizes, np.abs(b))
    off = np.abs(np.nan_to_num(a - b, nan=np.inf)) / np.maximum(scale, _ROUNDING)
    at = int(np.argmax(off))
    return f"{names[at]} {distinct_digits(a[at], b[at])}"


def distinct_digits(golden: float, run: float) -> str:
    """Two numbers with as many digits as tell them apart."""
    exact = (f"{golden:.6g}", f"{run:.6g}")
    if [float(text) for text in exact] == [golden, run]:  # as somebody may have written them
        return f"{exact[0]} → {exact[1]}"
    for digits in (3, 4, 5, 6, 8, 10, 13, 17):
        a, b = f"{golden:.{digits}g}", f"{run:.{digits}g}"
        if a != b and _keeps_distance(float(a), float(b), golden, run):
            return f"{a} → {b}"
    return f"{golden!r} → {run!r}"


def _keeps_distance(a: float, b: float, golden: float, run: float) -> bool:
    """Whether the rounded two are as far apart as the real two, to a hundredth."""
    wanted = run - golden
    return not np.isfinite(wanted) or abs((b - a) - wanted) <= 0.01 * abs(wanted)


def _time(seconds: float) -> str:
    return f"{seconds:.6f}".rstrip("0").rstrip(".") or "0"
