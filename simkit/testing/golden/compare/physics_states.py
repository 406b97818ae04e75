"""Comparison of the physics of two runs: the first tick that differs, and the quantity that differs most."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.testing.golden.compare.difference import Difference
from simkit.testing.golden.compare.units import joint_unit, quantity_text, time_text
from simkit.testing.run_record.record import States

_TINY: Final = 1e-9  # smallest scale of a quantity, so that tiny motions are not reported as large relative differences
# on another machine: word in the quantity's name, absolute tolerance, tolerance as a share of the largest value
_ALLOWED: Final[tuple[tuple[str, float, float], ...]] = (
    ("velocity", 2e-2, 1e-2),
    ("position", 1e-3, 1e-3),
    ("orientation", 1e-3, 0.0),
    ("", 1e-3, 1e-2),
)
Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class _StateDifferences:
    """Differences of the ticks and quantities that both runs recorded."""

    names: list[str]
    times: Floats
    golden: Floats
    shift: Floats
    joints: Mapping[str, str]


def compare_physics(
    golden: States, run: States, is_exact: bool, joints: Mapping[str, str] | None = None
) -> Difference | None:
    """Compare the physics of two runs; return None without a difference beyond the tolerance.

    Args:
        golden: States of the golden run.
        run: States of the new run, of the same scenario.
        is_exact: True if bits must be equal; otherwise the recorded states are compared with tolerances.
        joints: Unit of each joint's position, by joint name.
    """
    if golden.timestep != run.timestep:
        steps = [quantity_text(s.timestep, "s", signed=False) for s in (golden, run)]
        words = f"physics: time step {steps[0]} became {steps[1]}"
        return _state(words, 0.0, abs(run.timestep - golden.timestep), "s", "")
    parts = _entity_changes(golden, run)
    if parts:
        return _state(f"physics: different moving entities: {parts}", 0.0, float("nan"), "", "")
    kept = _state_differences(golden, run, joints or {})
    return _bits(golden, run, kept) if is_exact else _values(kept)


def _state(words: str, time: float, size: float, unit: str, name: str, allowed: str = "the same bits") -> Difference:
    return Difference("", name, "state", time, size, unit, words, allowed)


def _entity_changes(golden: States, run: States) -> str:
    """List added and removed entities, such as `new: crate; gone: pillar`."""
    groups = []
    for words, names in (("new", set(run.names) - set(golden.names)), ("gone", set(golden.names) - set(run.names))):
        owners = sorted({_quantity_owner(name) for name in names})
        if owners:
            more = f" and {len(owners) - 3} more" if len(owners) > 3 else ""
            groups.append(f"{words}: {', '.join(owners[:3])}{more}")
    return "; ".join(groups)


def _quantity_owner(name: str) -> str:
    """Return the entity of a quantity: `crate` for `crate angular velocity x`."""
    for word in (" position", " orientation", " angular velocity", " velocity", " activation"):
        if word in name:
            return name[: name.index(word)]
    return name


# ---------------------------------------------------------------------- same machine


def _bits(golden: States, run: States, kept: _StateDifferences) -> Difference | None:
    if len(kept.times) and kept.times[0] <= 0.0 and kept.shift[0].any():
        return _largest_difference(kept, 0, "physics: initial state differs", 0.0, "the same bits")
    both = min(len(golden.marks), len(run.marks))
    apart = np.flatnonzero(golden.marks[:both] != run.marks[:both])
    if not apart.size:
        has_digests = golden.named_digest and run.named_digest and len(golden.marks) == len(run.marks)
        if not has_digests or golden.named_digest == run.named_digest:
            return None
    tick = int(apart[0]) + 1 if apart.size else both
    time = tick * run.timestep
    words = f"physics: state differs from {time_text(time)} (tick {tick})"
    first = next((i for i in range(len(kept.times)) if kept.times[i] >= time and kept.shift[i].any()), None)
    if first is None:
        return _state(f"{words}, but not in the recorded states", time, 0.0, "", "")
    return _largest_difference(kept, first, words, time, "the same bits")


def _largest_difference(kept: _StateDifferences, index: int, words: str, time: float, allowed: str) -> Difference:
    """Describe the quantity with the largest relative difference in one recorded state."""
    scale = np.maximum(np.abs(kept.golden).max(axis=0), _TINY)
    at = int(np.argmax(np.abs(kept.shift[index]) / scale))
    name, unit = kept.names[at], unit_of_quantity(kept.names[at], kept.joints)
    shifts = kept.shift[:, at]
    shift, largest = float(shifts[index]), int(np.argmax(np.abs(shifts)))
    when = "" if kept.times[index] == time else f" at {time_text(float(kept.times[index]))}"
    words += f": {name} {quantity_text(shift, unit)}{when}"
    size = abs(float(shifts[largest]))
    if largest > index and size > 1.5 * abs(shift):
        words += f", up to {quantity_text(float(shifts[largest]), unit)} at {time_text(float(kept.times[largest]))}"
    return _state(words, time, size, unit, name, allowed)


# ---------------------------------------------------------------------- another machine


def _values(kept: _StateDifferences) -> Difference | None:
    if not len(kept.times):
        return None
    largest = np.abs(kept.golden).max(axis=0)
    limits = np.array([_limit(name, float(size)) for name, size in zip(kept.names, largest, strict=True)])
    over = np.where(np.abs(kept.shift) > limits, kept.shift, 0.0)
    failing = (np.abs(kept.shift) > limits).any(axis=1)
    if not failing.any():
        return None
    index = int(np.argmax(failing))
    time, allowed = float(kept.times[index]), "1 mm, 1 mrad, 1 % of velocities"
    words = f"physics: state differs from {time_text(time)}"
    return _largest_difference(replace(kept, shift=over), index, words, time, allowed)


def _limit(name: str, size: float) -> float:
    return next(absolute + relative * size for word, absolute, relative in _ALLOWED if word in name)


def _state_differences(golden: States, run: States, joints: Mapping[str, str]) -> _StateDifferences:
    """Subtract the states that both runs recorded; a difference is infinite if only one value is a number."""
    names = [name for name in golden.names if name in set(run.names)]
    ticks = np.intersect1d(golden.ticks, run.ticks)
    mine = golden.values[np.searchsorted(golden.ticks, ticks)][:, [golden.names.index(name) for name in names]]
    other = run.values[np.searchsorted(run.ticks, ticks)][:, [run.names.index(name) for name in names]]
    with np.errstate(invalid="ignore"):
        shift = other - mine
    shift[np.isnan(mine) & np.isnan(other)] = 0.0
    times = np.asarray(ticks * run.timestep, np.float64)
    return _StateDifferences(names, times, np.nan_to_num(mine), np.nan_to_num(shift, nan=np.inf), joints)


def unit_of_quantity(name: str, joints: Mapping[str, str]) -> str:
    """Return the unit of a state quantity.

    Args:
        name: Name of the quantity.
        joints: Unit of each joint's position, by joint name.
    """
    if "angular velocity" in name:
        return "rad/s"
    if " velocity " in name:
        return "m/s"
    if " position " in name:
        return "m"
    position = joints.get(_quantity_owner(name).rpartition("::")[2], "")
    if name.endswith(" velocity"):
        return joint_unit("rad/s or m/s", position)
    return joint_unit("rad or m", position) if name.endswith(" position") else ""
