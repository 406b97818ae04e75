"""Replay of a bundle: repeats the run and compares the result with the recording."""

from __future__ import annotations

import math
import os
import re
import tempfile
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from simkit import Simulation
from simkit.errors import InputError, PluginError, SimkitError
from simkit.extend import SceneModel, counted
from simkit.recording import Recorder
from simkit.recording.bags.reader import open_bag_to_read
from simkit.runtime.engine.snapshot import state_hash
from simkit.testing.run_record.fingerprint import RENDERER, fingerprint, fingerprint_differences
from simkit_verification.testing.bundles.archive import Bundle, open_bundle
from simkit_verification.testing.bundles.bundle_recorder import MessageWindow, StateHashes, WindowMessage, topic_digests
from simkit_verification.testing.bundles.bundle_staging import load_packed_world, packed_run_spec
from simkit_verification.testing.bundles.journal_player import JournalPlayer
from simkit_verification.testing.bundles.manifest import BAG, Failure, Manifest, failure_from_error

CODE: Final = "SK-BUNDLE-005"
_CODE_POSITION: Final = re.compile(r"\([^()\n]*:\d+\)")  # a place may have spaces: (world given as text:10)
_SLICE: Final = 0.5  # [s] of simulated time between two calls of on_slice


@dataclass(frozen=True)
class ReplayResult:
    """Result of a replay.

    Attributes:
        manifest: Manifest of the bundle.
        state: Hash of the physics state at the end.
        time: Simulated time at the end [s].
        failure: Failure of the replay; None if it did not fail.
        differences: Descriptions of the differences from the bundle, earliest first; empty if there are none.
        machine: Properties of the machine that differ: name -> (value in the bundle, value on this machine).
        refused: Descriptions of journal entries that the simulation rejected.
        messages: Number of messages of the last seconds that were compared bit for bit.
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
        """True if the replay gave the state, the messages and the failure that the bundle contains."""
        return not self.differences


def replay(
    path: str | os.PathLike[str],
    *,
    allow_code: bool = False,
    on_slice: Callable[[Simulation], None] | None = None,
    record: Path | None = None,
) -> ReplayResult:
    """Repeat the run in a bundle.

    Args:
        path: Bundle.
        allow_code: Allow the plugin code in the bundle to run. The code has the same rights as the user.
        on_slice: Function that is called between two steps, every 0.5 s of simulated time or more often.
        record: Bag to which all topics of the replay are written.

    Raises:
        InputError: SK-BUNDLE-001 to SK-BUNDLE-004 the bundle is invalid; SK-BUNDLE-005 it needs code that is not
            allowed.
        LoadError: The world has errors on this machine.
    """
    with _opened_replay(path, allow_code=allow_code) as opened:
        return opened.run(on_slice, record)


@contextmanager
def replay_until(path: str | os.PathLike[str], time: float | None, *, allow_code: bool = False) -> Iterator[Simulation]:
    """Repeat the run in a bundle up to a time, and yield its simulation.

    Args:
        path: Bundle.
        time: Simulated time [s]; None for the end of the run. A run that failed ends before its last step.
        allow_code: See `replay`.

    Raises:
        InputError, LoadError: See `replay`.
        SimulationDiverged, PluginError: The run failed before that time.
    """
    with _opened_replay(path, allow_code=allow_code) as opened, opened.at(time) as sim:
        yield sim


@contextmanager
def _opened_replay(path: str | os.PathLike[str], *, allow_code: bool) -> Iterator[_Replay]:
    """Extract a bundle to a temporary folder."""
    with open_bundle(path) as bundle, tempfile.TemporaryDirectory(prefix="simkit-replay.") as folder:
        if bundle.brings_code and not allow_code:
            listed = ", ".join(name.partition("/")[2].partition("/")[2] for name in bundle.manifest.code)
            raise InputError(
                CODE,
                f"{bundle.path} contains plugin code, which was not run: {listed}",
                help="read the code with simkit replay --extract DIR, then allow the code with --allow-code",
            )
        bundle.extract(Path(folder), with_code=allow_code)
        yield _Replay(bundle, Path(folder))


class _Replay:
    """Replay of one bundle.

    Args:
        bundle: Bundle to repeat.
        folder: Folder with the extracted files of the bundle.
    """

    def __init__(self, bundle: Bundle, folder: Path) -> None:
        self._bundle, self._manifest, self._folder = bundle, bundle.manifest, folder

    def run(self, on_slice: Callable[[Simulation], None] | None, record: Path | None) -> ReplayResult:
        """Load the world, play the journal and compare the result."""
        manifest = self._manifest
        machine = fingerprint_differences(manifest.fingerprint, fingerprint())
        try:
            opened = self._load()
        except PluginError as error:
            met = failure_from_error(error)
            return ReplayResult(manifest, "", 0.0, met, tuple(self._failures(met)), machine, (), 0)
        with opened as sim:
            window, marks = (
                MessageWindow(sim, manifest.seconds, manifest.topics, manifest.run.skip, most=1 << 62),
                StateHashes(sim),
            )
            player = JournalPlayer(sim, self._bundle.commands())
            recorder = None if record is None else Recorder(sim, record)
            try:
                raised = self._run_to_end(sim, player, on_slice)
            finally:
                if recorder is not None:
                    recorder.close()
            if RENDERER in manifest.fingerprint:
                machine = fingerprint_differences(manifest.fingerprint, fingerprint(sim), True)
            failure = None if raised is None else failure_from_error(raised)
            differences = [*self._failures(failure), *self._states(sim, marks)]
            streams, count = self._streams(window)
            refused = tuple(player.refused)
            return ReplayResult(
                manifest, state_hash(sim), sim.time, failure, (*differences, *streams), machine, refused, count
            )

    @contextmanager
    def at(self, time: float | None) -> Iterator[Simulation]:
        """Repeat the run up to a simulated time [s], None for its end, and yield its simulation."""
        with self._load() as sim:
            raised = self._run_to_end(
                sim, JournalPlayer(sim, self._bundle.commands()), None, math.inf if time is None else time
            )
            if raised is not None:
                raise raised
            yield sim

    def _load(self) -> Simulation:
        """Load the world of the bundle at t = 0."""
        numbers = sorted({int(n) for name in self._manifest.code if (n := name.split("/")[1]).isdecimal()})
        code = [self._folder / "code" / str(number) for number in numbers]
        sim = load_packed_world(packed_run_spec(self._folder, self._manifest.run_spec, code))
        self._read_models_from_bundle(sim)
        return sim

    def _read_models_from_bundle(self, sim: Simulation) -> None:
        """Read every spawned model from the bundle; raise an error if the bundle does not contain the model."""
        read, models = sim.contents.models_reader, self._manifest.models

        def read_packed(source: object, *args: object, **named: object) -> SceneModel:
            text = str(source)
            if "<" not in text:
                if text not in models:
                    raise InputError("SK-BUNDLE-006", f"the bundle has no model {text!r:.200}")
                source = self._folder / models[text]
            return read(source, *args, **named)

        sim.contents.models_reader = read_packed

    def _run_to_end(
        self,
        sim: Simulation,
        player: JournalPlayer,
        on_slice: Callable[[Simulation], None] | None,
        until: float | None = None,
    ) -> SimkitError | None:
        """Run to the recorded end. Return the error that stopped the replay, or None without an error.

        Args:
            sim: Simulation at t = 0.
            player: Player of the journal.
            on_slice: See `replay`.
            until: Simulated time at which the replay stops [s], or at the end before a failure; None to repeat the
                failure, too.
        """
        end = self._manifest.end
        last_tick = math.inf if until is None or math.isinf(until) else sim.engine.clock.ticks(until)
        slice_ = max(1, sim.engine.clock.ticks(_SLICE))
        try:
            while sim.tick < last_tick:
                player.play_due()
                if sim.engine.steps >= end.steps:
                    break
                stop = int(min(sim.engine.steps + slice_, end.steps, sim.engine.steps + last_tick - sim.tick))
                if player.next_steps is not None:
                    stop = min(stop, max(player.next_steps, sim.engine.steps + 1))
                sim.step(stop - sim.engine.steps)
                if on_slice is not None:
                    on_slice(sim)
            if until is None and end.failure is not None and end.failure.kind in ("PluginError", "SimulationDiverged"):
                sim.step(1)  # the run failed within this step, before the step was counted
        except InputError:
            raise
        except SimkitError as error:
            return error
        return None

    # ------------------------------------------------------------------ comparing

    def _failures(self, failure: Failure | None) -> list[str]:
        was = self._manifest.end.failure
        if failure is None:
            repeats = was is not None and was.kind in ("PluginError", "SimulationDiverged", "RenderError")
            return [f"the run failed, the replay did not: {was.text:.300}"] if was is not None and repeats else []
        if was is None:
            return [f"the replay failed, the run did not: {failure.text:.300}"]
        if _without_code_positions(failure) == _without_code_positions(was):
            return []
        return [f"the run failed with {was.text:.300}\n    the replay with {failure.text:.300}"]

    def _states(self, sim: Simulation, marks: StateHashes) -> list[str]:
        """Compare the physics state; if it differs, find the simulated second of the first difference."""
        end = self._manifest.end
        if end.state == state_hash(sim) and end.steps == sim.engine.steps:
            return []
        here = dict(marks.found)
        same, first = 0, None
        for steps, mark in self._manifest.marks:
            if here.get(steps) != mark:
                first = steps
                break
            same = steps
        step = sim.timestep
        where = f"equal up to {same * step:g} s" if same else "no equal state is known"
        where += f", differs at {first * step:g} s" if first is not None else ", differs at the end"
        if sim.engine.steps != end.steps:
            where += f"; the replay made {counted(sim.engine.steps, 'step')}, the run made {counted(end.steps, 'step')}"
        return [f"state {state_hash(sim)[:16]}…, in the bundle {end.state[:16]}… ({where})"]

    def _streams(self, window: MessageWindow) -> tuple[list[str], int]:
        """Compare the messages of the last seconds; return the differences and the number of messages."""
        manifest = self._manifest
        messages = list(window.messages(manifest.first))
        replayed = topic_digests(iter(messages))
        topics = sorted({*manifest.streams, *replayed})
        differing = [topic for topic in topics if manifest.streams.get(topic) != replayed.get(topic)]
        if not differing:
            return [], len(messages)
        with open_bag_to_read(self._folder / BAG) as bag:
            recorded = [
                WindowMessage(message.time_ns, message.topic, message.type_name, message.data)
                for message in bag.messages()
            ]
        there, here = _by_topic(recorded), _by_topic(messages)
        first_differences = [(*_first_difference(there.get(t, []), here.get(t, [])), t) for t in differing]
        return [f"{topic}: {text}" for _, text, topic in sorted(first_differences)], len(messages)


def _without_code_positions(failure: Failure) -> tuple[str, str, str]:
    """Return the kind, code and text of a failure; remove file names and line numbers from the text."""
    return failure.kind, failure.code, _CODE_POSITION.sub("()", failure.text)


def _by_topic(messages: Iterable[WindowMessage]) -> dict[str, list[WindowMessage]]:
    by_topic: dict[str, list[WindowMessage]] = defaultdict(list)
    for message in messages:
        by_topic[message.topic].append(message)
    return by_topic


def _first_difference(there: list[WindowMessage], here: list[WindowMessage]) -> tuple[int, str]:
    """Return the time [ns] and a description of the first difference between two streams."""
    for number, (a, b) in enumerate(zip(there, here, strict=False)):
        if a.type_name != b.type_name:
            return a.time_ns, f"has type {b.type_name}, in the bundle {a.type_name}"
        if a.time_ns != b.time_ns:
            times = f"at {b.time_ns / 1e9:g} s, in the bundle at {a.time_ns / 1e9:g} s"
            return a.time_ns, f"message {number + 1} is sent {times}"
        if a.data != b.data:
            return (
                a.time_ns,
                f"content differs from t = {a.time_ns / 1e9:g} s on (message {number + 1} of {len(there)})",
            )
    last = min(len(there), len(here))
    rest = (there if len(there) > len(here) else here)[last:]
    return (rest[0].time_ns if rest else 0), f"{counted(len(here), 'message')}, in the bundle {len(there)}"
