"""Repeats the run in a bundle and says whether it came out the same."""

from __future__ import annotations

import os
import re
import tempfile
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from simkit.errors import InputError, PluginError, SimkitError
from simkit.recording.bags.reader import open_bag_to_read
from simkit.recording.bags.recorder import Recorder
from simkit.runtime import Simulation
from simkit.runtime.engine.snapshot import state_hash
from simkit.testing.bundles.archive import Bundle, open_bundle
from simkit.testing.bundles.bundle_recorder import MessageWindow, StateHashes, WindowMessage, topic_digests
from simkit.testing.bundles.bundle_staging import load_packed_world, packed_run_spec
from simkit.testing.bundles.journal_player import JournalPlayer
from simkit.testing.bundles.manifest import BAG, Failure, Manifest, failure_from_error
from simkit.testing.run_record.fingerprint import fingerprint, fingerprint_differences

CODE: Final = "SK-BUNDLE-005"
_CODE_POSITION: Final = re.compile(r"\([^()\s]*:\d+\)")
_SLICE: Final = 0.5  # [s] of simulated time between two looks at who watches


@dataclass(frozen=True)
class ReplayResult:
    """What came of a replay.

    Attributes:
        manifest: of the bundle.
        state: hash of the physics at the end.
        time: simulated [s] at the end.
        failure: what it failed with.
        differences: what is other than in the bundle, in words, the first first; empty where all is the same.
        machine: what of the machine is other: name -> there and here.
        refused: entries of the journal that could not be done.
        messages: how many of the last seconds were compared, bit by bit.
    """

    manifest: Manifest
    state: str
    time: float
    failure: Failure | None
    differences: tuple[str, ...]
    machine: Mapping[str, tuple[str, str]]
    refused: tuple[str, ...]
    messages: int

    @property
    def is_same(self) -> bool:
        """Whether state, messages and the error are those of the bundle."""
        return not self.differences


def replay(
    path: str | os.PathLike[str],
    *,
    allow_code: bool = False,
    on_slice: Callable[[Simulation], None] | None = None,
    record: Path | None = None,
) -> ReplayResult:
    """Repeats the run in a bundle.

    Args:
        path: of the bundle.
        allow_code: whether plugins' code that came with it may run; it may do whatever you may.
        on_slice: called now and then between two steps.
        record: writes all topics of the replay to this bag.

    Raises:
        InputError: SK-BUNDLE-001 to SK-BUNDLE-004 the bundle is refused, SK-BUNDLE-005 it needs code that is not
            allowed.
        LoadError: its world has errors here.
    """
    with open_bundle(path) as bundle, tempfile.TemporaryDirectory(prefix="simkit-replay.") as folder:
        if bundle.brings_code and not allow_code:
            listed = ", ".join(name.partition("/")[2].partition("/")[2] for name in bundle.manifest.code)
            raise InputError(
                f"{CODE} {bundle.path} brings code of plugins, which was not run: {listed}\n"
                "    help: look at it with simkit replay --list or --extract DIR, then allow it with --allow-code",
                CODE,
            )
        bundle.extract(Path(folder), with_code=allow_code)
        return _Replay(bundle, Path(folder)).run(on_slice, record)


class _Replay:
    """One replay.

    Args:
        bundle: what is repeated.
        folder: where its files lie.
    """

    def __init__(self, bundle: Bundle, folder: Path) -> None:
        self._bundle, self._said, self._folder = bundle, bundle.manifest, folder

    def run(self, on_slice: Callable[[Simulation], None] | None, record: Path | None) -> ReplayResult:
        """Loads the world, plays the journal, and compares."""
        said = self._said
        machine = fingerprint_differences(said.fingerprint, fingerprint())
        numbers = sorted({int(n) for name in said.code if (n := name.split("/")[1]).isdecimal()})
        code = [self._folder / "code" / str(number) for number in numbers]
        spec = packed_run_spec(self._folder, said.world, said.spawn, said.params, said.run_spec, code)
        try:
            opened = load_packed_world(spec)
        except PluginError as error:
            met = failure_from_error(error)
            return ReplayResult(said, "", 0.0, met, tuple(self._failures(met)), machine, (), 0)
        with opened as sim:
            self._read_models_here(sim)
            window, marks = MessageWindow(sim, said.seconds, said.topics, most=1 << 62), StateHashes(sim)
            player = JournalPlayer(sim, self._bundle.commands())
            recorder = None if record is None else Recorder(sim, record)
            try:
                raised = self._played(sim, player, on_slice)
            finally:
                if recorder is not None:
                    recorder.close()
            failure = None if raised is None else failure_from_error(raised)
            found = [*self._failures(failure), *self._states(sim, marks)]
            streams, count = self._streams(window)
            refused = tuple(player.refused)
            return ReplayResult(said, state_hash(sim), sim.time, failure, (*found, *streams), machine, refused, count)

    def _read_models_here(self, sim: Simulation) -> None:
        """Models that are spawned while it runs come from the bundle, and from nowhere else."""
        read, models = sim.contents.models_reader, self._said.models

        def packed(source: Any, *args: Any, **named: Any) -> Any:
            text = str(source)
            if "<" not in text:
                if text not in models:
                    raise InputError(f"SK-BUNDLE-006 the bundle has no model {text!r:.200}", "SK-BUNDLE-006")
                source = self._folder / models[text]
            return read(source, *args, **named)

        sim.contents.models_reader = packed

    def _played(
        self, sim: Simulation, player: JournalPlayer, on_slice: Callable[[Simulation], None] | None
    ) -> SimkitError | None:
        """Runs to the end; gives what it failed with there."""
        end = self._said.end
        slice_ = max(1, sim.engine.clock.ticks(_SLICE))
        try:
            while True:
                player.play_due()
                if sim.engine.steps >= end.steps:
                    break
                stop = min(sim.engine.steps + slice_, end.steps)
                if player.next_steps is not None:
                    stop = min(stop, max(player.next_steps, sim.engine.steps + 1))
                sim.step(stop - sim.engine.steps)
                if on_slice is not None:
                    on_slice(sim)
            if end.failure is not None and end.failure.kind in ("PluginError", "SimulationDiverged"):
                sim.step(1)  # it failed before the step was done
        except InputError:
            raise
        except SimkitError as error:
            return error
        return None

    # ------------------------------------------------------------------ comparing

    def _failures(self, failure: Failure | None) -> list[str]:
        was = self._said.end.failure
        if failure is None:
            repeats = was is not None and was.kind in ("PluginError", "SimulationDiverged", "RenderError")
            return [f"the run failed, the replay did not: {was.text:.300}"] if was is not None and repeats else []
        if was is None:
            return [f"the replay failed, the run did not: {failure.text:.300}"]
        if _without_places(failure) == _without_places(was):
            return []
        return [f"the run failed with {was.text:.300}\n    the replay with {failure.text:.300}"]

    def _states(self, sim: Simulation, marks: StateHashes) -> list[str]:
        """Whether the physics is the same, and if not, in which second it begins to be another."""
        end = self._said.end
        if end.state == state_hash(sim) and end.steps == sim.engine.steps:
            return []
        here = dict(marks.found)
        same, first = 0, None
        for steps, mark in self._said.marks:
            if here.get(steps) != mark:
                first = steps
                break
            same = steps
        step = sim.timestep
        where = f"equal up to {same * step:g} s" if same else "nothing before the first second is known to be equal"
        where += f", other at {first * step:g} s" if first is not None else ", other at the end"
        if sim.engine.steps != end.steps:
            where += f"; {sim.engine.steps} steps were made, not {end.steps}"
        return [f"state {state_hash(sim)[:16]}…, in the bundle {end.state[:16]}… ({where})"]

    def _streams(self, window: MessageWindow) -> tuple[list[str], int]:
        """Whether the messages of the last seconds are the same."""
        said = self._said
        messages = list(window.messages(said.first))
        here = topic_digests(iter(messages))
        other = [topic for topic in sorted({*said.streams, *here}) if said.streams.get(topic) != here.get(topic)]
        if not other:
            return [], len(messages)
        with open_bag_to_read(self._folder / BAG) as bag:
            recorded = [WindowMessage(one.time_ns, one.topic, one.type_name, one.data) for one in bag.messages()]
        there, mine = _by_topic(recorded), _by_topic(messages)
        told = [(*_first_difference(there.get(t, []), mine.get(t, [])), t) for t in other]
        return [f"{topic}: {text}" for _, text, topic in sorted(told)], len(messages)


def _without_places(failure: Failure) -> tuple[str, str, str]:
    """What of an error is equal wherever it is written what raised."""
    return failure.kind, failure.code, _CODE_POSITION.sub("()", failure.text)


def _by_topic(messages: Iterable[WindowMessage]) -> dict[str, list[WindowMessage]]:
    found: dict[str, list[WindowMessage]] = defaultdict(list)
    for one in messages:
        found[one.topic].append(one)
    return found


def _first_difference(there: list[WindowMessage], here: list[WindowMessage]) -> tuple[int, str]:
    """When two streams part, and how, in words."""
    for number, (a, b) in enumerate(zip(there, here, strict=False)):
        if a.type_name != b.type_name:
            return a.time_ns, f"is {b.type_name}, in the bundle {a.type_name}"
        if a.time_ns != b.time_ns:
            times = f"at {b.time_ns / 1e9:g} s, in the bundle at {a.time_ns / 1e9:g} s"
            return a.time_ns, f"message {number + 1} comes {times}"
        if a.data != b.data:
            return a.time_ns, f"other bits from t = {a.time_ns / 1e9:g} s on (message {number + 1} of {len(there)})"
    last = min(len(there), len(here))
    rest = (there if len(there) > len(here) else here)[last:]
    return (rest[0].time_ns if rest else 0), f"{len(here)} messages, in the bundle {len(there)}"
