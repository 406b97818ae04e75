"""Comparison of two run records: the first difference of each field beyond its tolerance."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import numpy as np

from simkit.testing.golden.compare.difference import Comparison, Difference, DifferenceKind
from simkit.testing.golden.compare.physics_states import compare_physics
from simkit.testing.golden.compare.streams import StreamPair, begin_time, compare_stream
from simkit.testing.golden.compare.tolerances import tolerance_of
from simkit.testing.golden.compare.world_edits import field_edits
from simkit.testing.run_record.fingerprint import RAY_TRACER, fingerprint_differences
from simkit.testing.run_record.record import RunRecord, Stream

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
    found = Comparison("exact" if same else "tolerant")
    if is_reordered:
        found.notes.append("the entities of the world have another order, so bits need not be equal")

    def must_be_equal(stream: Stream) -> bool:
        return same and (same_pictures or not _is_rendered(stream)) and (same_rays or not _is_traced(stream))

    found.machine = fingerprint_differences(
        golden.fingerprint,
        run.fingerprint,
        pictures=any(map(_is_rendered, run.streams.values())),
        rays=any(map(_is_traced, run.streams.values())),
    )
    with np.errstate(all="ignore"):  # compared values may be NaN or infinite
        _compare_topics(golden, run, must_be_equal, found)
    if run.scenario.state:
        found.is_identical &= golden.states.named_digest == run.states.named_digest
        physics = compare_physics(golden.states, run.states, same, joint_units(run))
        if physics is not None:
            found.differences.append(physics)
    _compare_ends(golden, run, found)
    found.differences.sort(key=lambda d: (d.kind != "end", d.time, d.topic))
    if run.scenario.model and not found.differences:
        _compare_worlds(golden, run, found)
    _note_diagnostics(golden, run, found)
    return found


def _is_reordered(golden: RunRecord, run: RunRecord) -> bool:
    """Check whether values that both worlds have are in a different order in their files."""
    mine = [path for path in golden.leaves if path in run.leaves]
    return mine != [path for path in run.leaves if path in golden.leaves]


_JOINT = re.compile(r"joints\[([^\]]+)\]\.type$")


def joint_units(record: RunRecord) -> dict[str, str]:
    """Return the unit of each joint's position, by joint name; empty if joints of both types share the name."""
    found: dict[str, str] = {}
    for path, kind in record.leaves.items():
        match = _JOINT.search(path)
        if match:
            unit = "m" if kind == "prismatic" else "rad"
            found[match[1]] = unit if found.get(match[1], unit) == unit else ""
    return found


# ---------------------------------------------------------------------- topics


def _compare_topics(
    golden: RunRecord, run: RunRecord, must_be_equal: Callable[[Stream], bool], found: Comparison
) -> None:
    notes: list[str] = []
    joints = joint_units(run)
    for topic in sorted(golden.streams.keys() | run.streams.keys()):
        mine, other = golden.streams.get(topic), run.streams.get(topic)
        known = mine or other
        assert known is not None
        whole = tolerance_of(run.scenario, topic, known.type_name, "")
        if whole.ignore:
            found.notes.append(f"{topic} is not compared" + (f" ({whole.where})" if whole.where else ""))
        elif mine is None or other is None:
            found.differences.append(_missing_topic(known, mine is None, golden, run))
        else:
            is_exact = must_be_equal(other)
            result = compare_stream(StreamPair(mine, other, run.scenario, is_exact, run.states.timestep, joints))
            found.is_identical &= bool(mine.digest) and mine.digest == other.digest
            found.differences += result.differences
            notes += result.notes
            found.topics += 1
            found.messages += len(mine.times_ns)
    more = [f"{len(notes) - _NOTES} more notes"] if len(notes) > _NOTES else []
    found.notes += notes[:_NOTES] + more


def _missing_topic(stream: Stream, is_new: bool, golden: RunRecord, run: RunRecord) -> Difference:
    """Describe a topic that only one of the two runs has."""
    number = len(stream.times_ns)
    messages = f"{number} message{'' if number == 1 else 's'} of {stream.type_name}"
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


def _compare_ends(golden: RunRecord, run: RunRecord, found: Comparison) -> None:
    """Compare the reasons and times at which the runs ended."""
    ticks = len(golden.states.marks), len(run.states.marks)
    time = min(ticks) * run.states.timestep
    if golden.end != run.end:
        words = f"the run ended with “{run.end}” at t = {ticks[1] * run.states.timestep:g} s"
        words += f"; the golden run with “{golden.end}” at t = {ticks[0] * golden.states.timestep:g} s"
        found.differences.append(Difference("", "", "end", time, math.nan, "", words, "the same end"))
    elif ticks[0] != ticks[1] and golden.states.timestep == run.states.timestep:
        words = f"the run took {ticks[1]} steps, the golden run {ticks[0]}"
        size = float(abs(ticks[1] - ticks[0]))
        found.differences.append(Difference("", "", "end", time, size, "steps", words, "as many steps"))


def _compare_worlds(golden: RunRecord, run: RunRecord, found: Comparison) -> None:
    """Compare the values of the worlds; a changed value is a difference even if all recorded outputs are equal."""
    other_version = golden.fingerprint.get("simkit") != run.fingerprint.get("simkit")
    common = golden.leaves.keys() & run.leaves.keys()
    leaves = sorted(path for path in common if not _is_same_value(golden.leaves[path], run.leaves[path]))
    alone = sorted(golden.leaves.keys() ^ run.leaves.keys()) if golden.leaves and run.leaves else []
    if other_version and alone:
        words = f"{len(alone)} values of the world exist in only one version of simkit: {_listed(alone)}"
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
    places = "place" if count == 1 else "places"
    words = f"{what} changed in {count} {places}, but no recorded output differs: {text}"
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


def _note_diagnostics(golden: RunRecord, run: RunRecord, found: Comparison) -> None:
    for code in sorted(golden.diagnostics.keys() | run.diagnostics.keys()):
        counts = golden.diagnostics.get(code, 0), run.diagnostics.get(code, 0)
        if counts[0] != counts[1]:
            found.notes.append(f"loading reports {code} {counts[1]} times; in the golden run {counts[0]} times")


def _listed(names: list[str], most: int = 3) -> str:
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")
