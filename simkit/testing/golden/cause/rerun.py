"""Rerun of a scenario with changes undone, and the test of its outputs against the golden run."""

from __future__ import annotations

import copy
import hashlib
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from simkit.run_spec import JsonObject, RunSpec
from simkit.scene import SceneWorld
from simkit.testing.golden.cause.edits import Change
from simkit.testing.golden.cause.world_patch import patch_world
from simkit.testing.golden.compare.difference import Comparison
from simkit.testing.golden.compare.runs import compare
from simkit.testing.golden.compare.tolerances import tolerance_of
from simkit.testing.golden.compare.world_edits import ABSENT
from simkit.testing.run_record.record import Column, RunRecord, Stream
from simkit.testing.scenarios.scenario_run import open_scenario

ChangeWorld = Callable[[SceneWorld], SceneWorld]
RunChangedWorld = Callable[[RunSpec, ChangeWorld | None], RunRecord]

_NOTHING = hashlib.sha256().hexdigest()


def rerun_scenario(scenario: RunSpec, change_world: ChangeWorld | None) -> RunRecord:
    """Run a scenario from the beginning in a changed world and close its simulation.

    Args:
        scenario: Scenario to run.
        change_world: Function that returns a changed world; None for no change.

    Raises:
        SimkitError: The world or a command of the scenario is invalid.
    """
    from simkit.testing.run_record.run_recorder import record_run

    if scenario.plugins:
        scenario = replace(scenario, plugins=tuple(copy.deepcopy(p) for p in scenario.plugins))
    with open_scenario(scenario, change_world=change_world) as sim:
        record = record_run(scenario, sim=sim)
        record.simulation = None
        return record


class ScenarioRerun:
    """Repetitions of a run in which some changes are undone, within a time limit.

    Args:
        golden, run: Records of both runs.
        comparison: Comparison of both records.
        changes: Changes that can be undone.
        rerun: Function that runs a scenario.
        budget: Wall-clock limit of all reruns [s].
    """

    def __init__(
        self,
        golden: RunRecord,
        run: RunRecord,
        comparison: Comparison,
        changes: Sequence[Change],
        rerun: RunChangedWorld,
        budget: float,
    ) -> None:
        self._golden, self.run, self._comparison = golden, run, comparison
        self._changes, self._rerun = changes, rerun
        self._end = time.perf_counter() + budget
        self._begin = self._pace = 0.0  # wall time for loading [s], and for one simulated second [s/s]
        self._known: dict[frozenset[int], bool | None] = {}
        self.horizon = self._first_horizon()

    def same(self, chosen: frozenset[int]) -> bool | None:
        """Check whether the run with these changes undone gives the golden outputs; None if this was not tested."""
        if chosen not in self._known:
            record = self.record(chosen, self.horizon)
            self._known[chosen] = None if record is None else self._is_golden(record)
        return self._known[chosen]

    def record(self, chosen: frozenset[int], duration: float) -> RunRecord | None:
        """Return the record of the run with these changes undone; None if no time is left or the run failed."""
        begun = time.perf_counter()
        if begun + self._begin + self._pace * duration > self._end:
            return None
        edits = [edit for index in chosen for edit in self._changes[index].edits]
        values = {edit.path: edit.golden for edit in edits if edit.kind != "scenario"}
        fields: JsonObject = {edit.path: edit.golden for edit in edits if edit.kind == "scenario"}
        scenario = replace(self.run.scenario, **fields)
        scenario = replace(scenario, duration=duration, until="", timeout=None, wall_timeout=None, checks=())
        now = self.run.leaves
        change = (lambda world: patch_world(world, now, values, order=self._golden.leaves)) if values else None
        try:
            return self._rerun(scenario, change)
        except Exception:  # noqa: BLE001 - golden values come from a file and may cause any error
            return None
        finally:
            taken = time.perf_counter() - begun
            self._begin = min(self._begin or taken, taken)
            self._pace = max(self._pace, (taken - self._begin) / max(duration, 1e-9))

    def extend_to_whole_run(self) -> bool:
        """Extend the reruns to the whole run and discard earlier results.

        Returns:
            False if the reruns already cover the whole run.
        """
        longest = self.run.scenario.longest
        if self.horizon >= longest:
            return False
        self._pace = max(self._pace, self._begin / self.horizon)
        self._begin = 0.0
        self.horizon = longest
        self._known.clear()
        return True

    # ------------------------------------------------------------------ comparison with the golden run

    def _first_horizon(self) -> float:
        """Return the end of the first reruns [s]: the end of the simulated second with the first difference."""
        longest = self.run.scenario.longest
        differences = self._comparison.differences
        if any(d.kind == "statistics" for d in differences) or not differences:
            return longest
        times = [d.time for d in differences if math.isfinite(d.time)]
        return min(longest, math.floor(min(times)) + 1.0) if times else longest

    def _is_golden(self, record: RunRecord) -> bool:
        if self._comparison.tier == "exact":
            return _same_bits(self._golden, record, self.horizon)

        golden, mine = (
            replace(cut_record(full_record, self.horizon), scenario=replace(full_record.scenario, model=False))
            for full_record in (self._golden, record)
        )
        return compare(golden, mine).passed


def _same_bits(golden: RunRecord, run: RunRecord, until: float) -> bool:
    count = min(round(until / golden.states.timestep), len(golden.states.marks), len(run.states.marks))
    if run.scenario.state:
        if {*golden.states.names} != {*run.states.names}:
            return False
        if not np.array_equal(golden.states.marks[:count], run.states.marks[:count]):
            return False
    seconds = math.ceil(until)
    for topic in {*golden.streams, *run.streams}:
        mine, other = golden.streams.get(topic), run.streams.get(topic)
        is_ignored = tolerance_of(run.scenario, topic, (golden.streams | run.streams)[topic].type_name, "").ignore
        if not is_ignored and _second_hashes(mine, seconds) != _second_hashes(other, seconds):
            return False
    return True


def _second_hashes(stream: Stream | None, seconds: int) -> list[str]:
    """Return the hash of each second; leave out seconds without a message at the end."""
    hashes = list(stream.chunks[:seconds]) if stream is not None else []
    while hashes and hashes[-1] == _NOTHING:
        hashes.pop()
    return hashes


def cut_record(record: RunRecord, until: float) -> RunRecord:
    """Return the part of a record before a simulated time [s]."""
    limit = round(until * 1e9)
    streams = {name: _cut_stream(stream, limit) for name, stream in record.streams.items()}
    states = record.states
    ticks = min(len(states.marks), math.ceil(until / states.timestep) - 1)
    state_count = int(np.searchsorted(states.ticks, ticks, side="right"))
    states = replace(
        states,
        marks=states.marks[:ticks],
        inputs=states.inputs[:ticks],
        ticks=states.ticks[:state_count],
        values=states.values[:state_count],
        input_values=states.input_values[:state_count],
        digest="",
    )
    return replace(record, streams={n: s for n, s in streams.items() if len(s.times_ns)}, states=states)


def _cut_stream(stream: Stream, limit: int) -> Stream:
    count = int(np.searchsorted(stream.times_ns, limit, side="left"))
    if count == len(stream.times_ns):
        return stream
    return replace(
        stream,
        times_ns=stream.times_ns[:count],
        columns={name: _cut_column(column, count) for name, column in stream.columns.items()},
        words={name: texts[:count] for name, texts in stream.words.items()},
        pictures=None if stream.pictures is None else stream.pictures.first(count),
        chunks=stream.chunks[: limit // 1_000_000_000],
        digest="",
    )


def _cut_column(column: Column, count: int) -> Column:
    if column.lengths is None:
        return replace(column, values=column.values[:count])
    lengths = column.lengths[:count]
    return replace(column, values=column.values[: int(lengths.sum())], lengths=lengths)


def can_be_undone(change: Change, run: RunRecord) -> bool:
    """Check whether a change can be undone: all its golden values are stored, and the world depends on them."""
    if change.kind == "scenario":
        return all(edit.path not in ("world", "plugins", "options") for edit in change.edits)
    if change.kind != "model" or not change.edits:
        return False
    world = getattr(run.simulation, "world", None)
    mjcf_paths = [f"models[{m.name}]" for m in world.models if m.mjcf is not None] if world is not None else []
    is_plain = all(e.golden is ABSENT or isinstance(e.golden, (bool, int, float, str, list)) for e in change.edits)
    return is_plain and not any(e.path.startswith(("files[", *mjcf_paths)) for e in change.edits)
