"""Comparison of two run records: the first difference of each field beyond its tolerance, and of the physics."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.diagnostics import Where
from simkit.number_text import counted
from simkit.testing.golden.compare.difference import Comparison, Difference, DifferenceKind
from simkit.testing.golden.compare.streams import StreamPair, begin_time, compare_stream
from simkit.testing.golden.compare.tolerances import joint_unit, quantity_text, time_text, tolerance_of
from simkit.testing.golden.compare.world_edits import field_edits
from simkit.testing.run_record.fingerprint import RAY_TRACER, fingerprint_differences
from simkit.testing.run_record.left_out import CODES as LEFT_OUT_CODES
from simkit.testing.run_record.left_out import newly_left_out
from simkit.testing.run_record.record import RunRecord, States, Stream

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
    differences = _state_differences(golden, run, joints or {})
    return _bits(golden, run, differences) if is_exact else _values(differences)


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


def _bits(golden: States, run: States, differences: _StateDifferences) -> Difference | None:
    if len(differences.times) and differences.times[0] <= 0.0 and differences.shift[0].any():
        return _largest_difference(differences, 0, "physics: initial state differs", 0.0, "the same bits")
    both = min(len(golden.marks), len(run.marks))
    apart = np.flatnonzero(golden.marks[:both] != run.marks[:both])
    if not apart.size:
        has_digests = golden.named_digest and run.named_digest and len(golden.marks) == len(run.marks)
        if not has_digests or golden.named_digest == run.named_digest:
            return None
    tick = int(apart[0]) + 1 if apart.size else both
    time = tick * run.timestep
    words = f"physics: state differs from {time_text(time)} (tick {tick})"
    first = next(
        (i for i in range(len(differences.times)) if differences.times[i] >= time and differences.shift[i].any()), None
    )
    if first is None:
        return _state(f"{words}, but not in the recorded states", time, 0.0, "", "")
    return _largest_difference(differences, first, words, time, "the same bits")


def _largest_difference(
    differences: _StateDifferences, index: int, words: str, time: float, allowed: str
) -> Difference:
    """Describe the quantity with the largest relative difference in one recorded state."""
    scale = np.maximum(np.abs(differences.golden).max(axis=0), _TINY)
    at = int(np.argmax(np.abs(differences.shift[index]) / scale))
    name, unit = differences.names[at], unit_of_quantity(differences.names[at], differences.joints)
    shifts = differences.shift[:, at]
    shift, largest = float(shifts[index]), int(np.argmax(np.abs(shifts)))
    when = "" if differences.times[index] == time else f" at {time_text(float(differences.times[index]))}"
    words += f": {name} {quantity_text(shift, unit)}{when}"
    size = abs(float(shifts[largest]))
    if largest > index and size > 1.5 * abs(shift):
        words += (
            f", up to {quantity_text(float(shifts[largest]), unit)} at {time_text(float(differences.times[largest]))}"
        )
    return _state(words, time, size, unit, name, allowed)


# ---------------------------------------------------------------------- another machine


def _values(differences: _StateDifferences) -> Difference | None:
    if not len(differences.times):
        return None
    largest = np.abs(differences.golden).max(axis=0)
    limits = np.array([_limit(name, float(size)) for name, size in zip(differences.names, largest, strict=True)])
    over = np.where(np.abs(differences.shift) > limits, differences.shift, 0.0)
    failing = (np.abs(differences.shift) > limits).any(axis=1)
    if not failing.any():
        return None
    index = int(np.argmax(failing))
    time, allowed = float(differences.times[index]), "1 mm, 1 mrad, 1 % of velocities"
    words = f"physics: state differs from {time_text(time)}"
    return _largest_difference(replace(differences, shift=over), index, words, time, allowed)


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


_FROM_IMAGES = (
    "sensor_msgs/msg/Image",
    "sensor_msgs/msg/CompressedImage",
    "sensor_msgs/msg/PointCloud2",  # also of lidars
    "vision_msgs/msg/Detection2DArray",
    "vision_msgs/msg/Detection3DArray",
)
_RAYS = ("sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2", "sensor_msgs/msg/Range")
_NOTES = 12  # maximum number of notes about topics


def compare(golden: RunRecord, run: RunRecord, *, exact: bool | None = None) -> Comparison:
    """Compare a new run with a golden run, using the tolerances of the new run's scenario.

    Args:
        golden: Stored record.
        run: New record of the same scenario.
        exact: True if bits must be equal, False for tolerances. If None, bits must be equal on the same machine with
            the same versions, unless the scenario of the new run requests tolerances.
    """
    if exact is None and not run.scenario.bits:
        exact = False
    same = not fingerprint_differences(golden.fingerprint, run.fingerprint) if exact is None else exact
    same_pictures = not fingerprint_differences(golden.fingerprint, run.fingerprint, True) if exact is None else exact
    same_rays = golden.fingerprint.get(RAY_TRACER) == run.fingerprint.get(RAY_TRACER) if exact is None else exact
    is_reordered = exact is None and same and _is_reordered(golden, run)
    if is_reordered:  # the engine sums values in file order, so the rounding differs
        same = same_pictures = same_rays = False
    comparison = Comparison("exact" if same else "tolerant")
    if is_reordered:
        comparison.notes.append("the entities of the world have another order, so bits need not be equal")

    def must_be_equal(stream: Stream) -> bool:
        return same and (same_pictures or not _is_rendered(stream)) and (same_rays or not _is_traced(stream))

    comparison.machine = fingerprint_differences(
        golden.fingerprint,
        run.fingerprint,
        pictures=any(map(_is_rendered, run.streams.values())),
        rays=any(map(_is_traced, run.streams.values())),
    )
    with np.errstate(all="ignore"):  # compared values may be NaN or infinite
        _compare_topics(golden, run, must_be_equal, comparison)
    if run.scenario.state:
        comparison.is_identical &= golden.states.named_digest == run.states.named_digest
        physics = compare_physics(golden.states, run.states, same, joint_units(run))
        if physics is not None:
            comparison.differences.append(physics)
    _compare_ends(golden, run, comparison)
    _compare_left_out(golden, run, comparison)
    comparison.differences.sort(key=lambda d: (d.kind != "left out", d.kind != "end", d.time, d.topic))
    if run.scenario.model and not comparison.differences:
        _compare_worlds(golden, run, comparison)
    _note_diagnostics(golden, run, comparison)
    return comparison


def _is_reordered(golden: RunRecord, run: RunRecord) -> bool:
    """Check whether values that both worlds have are in a different order in their files."""
    mine = [path for path in golden.leaves if path in run.leaves]
    return mine != [path for path in run.leaves if path in golden.leaves]


_JOINT = re.compile(r"joints\[([^\]]+)\]\.type$")


def joint_units(record: RunRecord) -> dict[str, str]:
    """Return the unit of each joint's position, by joint name; empty if joints of both types share the name."""
    units: dict[str, str] = {}
    for path, kind in record.leaves.items():
        match = _JOINT.search(path)
        if match:
            unit = "m" if kind == "prismatic" else "rad"
            units[match[1]] = unit if units.get(match[1], unit) == unit else ""
    return units


# ---------------------------------------------------------------------- topics


def _compare_topics(
    golden: RunRecord, run: RunRecord, must_be_equal: Callable[[Stream], bool], comparison: Comparison
) -> None:
    notes: list[str] = []
    joints = joint_units(run)
    for topic in sorted(golden.streams.keys() | run.streams.keys()):
        mine, other = golden.streams.get(topic), run.streams.get(topic)
        known = mine or other
        assert known is not None
        tolerance = tolerance_of(run.scenario, topic, known.type_name, "")
        if tolerance.ignore:
            comparison.notes.append(f"{topic} is not compared" + (f" ({tolerance.where})" if tolerance.where else ""))
        elif mine is None or other is None:
            comparison.differences.append(_missing_topic(known, mine is None, golden, run))
        else:
            is_exact = must_be_equal(other)
            result = compare_stream(StreamPair(mine, other, run.scenario, is_exact, run.states.timestep, joints))
            comparison.is_identical &= bool(mine.digest) and mine.digest == other.digest
            comparison.differences += result.differences
            notes += result.notes
            comparison.topics += 1
            comparison.messages += len(mine.times_ns)
    more = [counted(len(notes) - _NOTES, "more note")] if len(notes) > _NOTES else []
    comparison.notes += notes[:_NOTES] + more


def _missing_topic(stream: Stream, is_new: bool, golden: RunRecord, run: RunRecord) -> Difference:
    """Describe a topic that only one of the two runs has."""
    number = len(stream.times_ns)
    messages = f"{counted(number, 'message')} of {stream.type_name}"
    kind: DifferenceKind = "extra" if is_new else "missing"
    words = f"{stream.topic}: is new, {messages}" if is_new else f"{stream.topic}: is gone, {messages} are missing"
    renamed = [s.topic for t, s in run.streams.items() if t not in golden.streams and s.type_name == stream.type_name]
    if renamed and not is_new:
        words += f"; {_listed(sorted(renamed))} of its type {'is' if len(renamed) == 1 else 'are'} new"
    return Difference(stream.topic, "", kind, begin_time(stream), math.nan, "", words, "the same topics")


def _is_rendered(stream: Stream) -> bool:
    """Check whether a renderer produced the topic."""
    return stream.pictures is not None or stream.type_name in _FROM_IMAGES


def _is_traced(stream: Stream) -> bool:
    """Check whether rays of a sensor produced the topic."""
    return stream.type_name in _RAYS


# ---------------------------------------------------------------------- end, world, diagnostics


def _compare_ends(golden: RunRecord, run: RunRecord, comparison: Comparison) -> None:
    """Compare the reasons and times at which the runs ended."""
    ticks = len(golden.states.marks), len(run.states.marks)
    time = min(ticks) * run.states.timestep
    if golden.end != run.end:
        words = f"the run ended with “{run.end}” at t = {ticks[1] * run.states.timestep:g} s"
        words += f"; the golden run with “{golden.end}” at t = {ticks[0] * golden.states.timestep:g} s"
        comparison.differences.append(Difference("", "", "end", time, math.nan, "", words, "the same end"))
    elif ticks[0] != ticks[1] and golden.states.timestep == run.states.timestep:
        words = f"the run took {counted(ticks[1], 'step')}, the golden run {ticks[0]}"
        size = float(abs(ticks[1] - ticks[0]))
        comparison.differences.append(Difference("", "", "end", time, size, "steps", words, "as many steps"))


def _compare_worlds(golden: RunRecord, run: RunRecord, found: Comparison) -> None:
    """Compare the values of the worlds; a changed value is a difference even if all recorded outputs are equal."""
    other_version = golden.fingerprint.get("simkit") != run.fingerprint.get("simkit")
    common = golden.leaves.keys() & run.leaves.keys()
    leaves = sorted(path for path in common if not _is_same_value(golden.leaves[path], run.leaves[path]))
    alone = sorted(golden.leaves.keys() ^ run.leaves.keys()) if golden.leaves and run.leaves else []
    if other_version and alone:
        words = f"{counted(len(alone), 'value')} of the world exist in only one version of simkit: {_listed(alone)}"
        found.notes.append(words)
        alone = []
    names = sorted(golden.sources.keys() | run.sources.keys())
    changed = [*leaves, *alone, *(name for name in names if golden.sources.get(name) != run.sources.get(name))]
    if changed:
        text = _count_text(golden, run, changed)
        found.differences.append(_unrecorded_difference("the world", len(changed), changed[0], text))
    elif found.tier == "exact" and golden.fields and run.fields:
        # equal scene values may hide changes of elements in MuJoCo's own format, so compare the compiled fields
        edits = field_edits(golden, run)
        if edits:
            text = _listed([f"{edit.path} {edit.golden} → {edit.run}" for edit in edits])
            found.differences.append(_unrecorded_difference("the compiled model", len(edits), edits[0].path, text))


def _unrecorded_difference(what: str, count: int, path: str, text: str) -> Difference:
    words = f"{what} changed in {counted(count, 'place')}, but no recorded output differs: {text}"
    return Difference("", path, "model", 0.0, math.nan, "", words, "the same world (model: false allows changes)")


def _count_text(golden: RunRecord, run: RunRecord, changed: list[str]) -> str:
    texts = []
    for path in changed[:3]:
        if path in golden.leaves and path in run.leaves:
            texts.append(f"{path} {golden.leaves[path]} → {run.leaves[path]}")
        elif path in golden.leaves or path in run.leaves:
            texts.append(f"{path} is {'new' if path in run.leaves else 'gone'}")
        else:
            texts.append(f"{path} has different content")
    more = len(changed) - len(texts)
    return ", ".join(texts) + (f" and {more} more" if more else "")


def _is_same_value(a: object, b: object) -> bool:
    """Check whether two values are equal; NaN equals NaN."""
    if isinstance(a, float) and isinstance(b, float):
        return a == b or (math.isnan(a) and math.isnan(b))
    if isinstance(a, list | tuple) and isinstance(b, list | tuple):
        return len(a) == len(b) and all(map(_is_same_value, a, b))
    return a == b


def _compare_left_out(golden: RunRecord, run: RunRecord, found: Comparison) -> None:
    """Report what the new run left out and the golden run had; fewer than in the golden run are only noted."""
    now = run.left_out or {}
    if golden.left_out is None:  # an older version stored no names
        count = sum(golden.diagnostics.get(code, 0) for code in LEFT_OUT_CODES)
        names, gone = list(now) if sum(now.values()) > count else [], []
    else:
        names, gone = newly_left_out(golden.left_out, now), newly_left_out(now, golden.left_out)
    for name in names:
        words = f"the world runs without {name}, which the golden run had{_reason_for(name, run)}"
        found.differences.append(Difference("", name, "left out", 0.0, math.nan, "", words, "nothing more left out"))
    found.notes += [f"{name} is no longer left out" for name in gone]


def _reason_for(name: str, run: RunRecord) -> str:
    """Return the place of the warning with this name, which the load prints with the reason."""
    reported = () if run.simulation is None else run.simulation.diagnostics
    found = next((item for item in reported if item.code in LEFT_OUT_CODES and name in item.message), None)
    return "" if found is None else f" ({Where(found.file, found.line)}: {found.code})"


def _note_diagnostics(golden: RunRecord, run: RunRecord, found: Comparison) -> None:
    for code in sorted(golden.diagnostics.keys() | run.diagnostics.keys()):
        counts = golden.diagnostics.get(code, 0), run.diagnostics.get(code, 0)
        if counts[0] != counts[1]:
            found.notes.append(f"loading reports {code} {counts[1]} times; in the golden run {counts[0]} times")


def _listed(names: list[str], most: int = 3) -> str:
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")
