"""One run of a certificate in its own process."""

from __future__ import annotations

import inspect
import pickle
import time
from contextlib import ExitStack, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from simkit import RunSpec, Simulation, msgs
from simkit.errors import InputError, RenderError, SimkitError
from simkit.extend import Sensor
from simkit.memory_error import OutOfMemory
from simkit.msgs import Message
from simkit.runtime.engine.snapshot import state_hash
from simkit.testing import count_left_out, open_scenario, run_scenario
from simkit.testing.run_record.fingerprint import fingerprint
from simkit.testing.scenarios.scenario_file import read_scenario
from simkit.testing.scenarios.scenario_run import ScenarioCommands
from simkit_verification.testing.certify.outcome import RunOutcome
from simkit_verification.testing.certify.run_hashes import (
    PluginCallRecorder,
    TickHashes,
    TopicHashes,
    attribute_hashes,
    plugin_attributes,
    plugin_title,
    short_hash,
)
from simkit_verification.testing.certify.variations import Variation

_SLICE: Final = 0.25  # simulated time [s] between two collections of messages
_DETOUR: Final = 0.5  # simulated duration of the detour [s]
_DETOUR_MODEL: Final = (
    '<sdf version="1.9"><model name="simkit_certify_box"><pose>0 0 1000 0 0 0</pose><link name="l"><inertial><mass>1'
    '</mass></inertial><collision name="c"><geometry><box><size>.1 .1 .1</size></box></geometry></collision></link>'
    "</model></sdf>"
)


@dataclass
class ChildRequest:
    """Request to a child process.

    Attributes:
        scenario: Scenario with absolute paths.
        variation: Environment of the run.
        ticks: Number of steps; None for the scenario's own end, including `until`.
        is_watched: True if every plugin call is recorded.
        half: Tick at which subscribers are added or the detour begins; None for the middle of the run.
        plugins_from: Python scenario file from which the plugins are loaded.
        limit: Wall-clock limit [s]; None for no limit.
    """

    scenario: RunSpec
    variation: Variation
    ticks: int | None = None
    is_watched: bool = False
    half: int | None = None
    plugins_from: Path | None = None
    limit: float | None = None


def run_child(request: ChildRequest) -> RunOutcome:
    """Run the scenario and return its outcome."""
    started = time.perf_counter()
    outcome = RunOutcome()
    with ExitStack() as stack:
        try:
            scenario = request.scenario
            if request.plugins_from is not None:
                scenario = replace(scenario, plugins=read_scenario(request.plugins_from).plugins)
            sim = stack.enter_context(open_scenario(scenario, render_thread=request.variation.render_thread))
        except SimkitError as error:
            return RunOutcome(failure=_picklable_error(error))
        _ChildRun(request, sim, outcome).run()
    outcome.seconds = time.perf_counter() - started
    return outcome


def _picklable_error(error: SimkitError) -> SimkitError:
    """Return an error that can be pickled."""
    error.__cause__ = error.__context__ = None
    with suppress(Exception):  # a plugin's own exception class or attributes may not be picklable
        if type(error).__module__ == SimkitError.__module__ and pickle.dumps(error):
            return error
    return InputError(error.code, str(error), shows_code=False)


class _ChildRun:
    """Run of the scenario from the first tick to the last."""

    def __init__(self, request: ChildRequest, sim: Simulation, outcome: RunOutcome) -> None:
        self._request, self._scenario, self._sim = request, request.scenario, sim
        self._variation, self._outcome = request.variation, outcome
        self._call_recorder = PluginCallRecorder(sim) if request.is_watched else None
        self._topic_hashes: TopicHashes | None = None
        self._marks = TickHashes(sim)
        ticks = request.ticks
        if ticks is None:
            ticks = sim.engine.clock.checked_ticks(self._scenario.longest, "duration")
        self._end = ticks
        self._half = self._end // 2 if request.half is None else request.half

    def run(self) -> None:
        """Run the scenario and write the results to the outcome."""
        outcome = self._outcome
        try:
            if self._variation.detour == "reset":
                self._reset()
            if self._variation.listening != "late":
                self._listen()
            if self._request.ticks is None and self._scenario.until:
                # only `run_scenario` evaluates the condition `until`
                run_scenario(self._scenario, self._sim, self._collect_messages)
            else:
                self._run_to(self._end)
        except (InputError, RenderError, OutOfMemory) as error:  # the scenario does not fit the world or the machine
            outcome.failure = _picklable_error(error)
            return
        except SimkitError as error:
            outcome.end = str(error)
        self._gather()

    # ------------------------------------------------------------------ running

    def _run_to(self, end: int) -> None:
        sim = self._sim
        has_turned = self._variation.detour != "restore"
        slice_ = max(1, sim.engine.clock.ticks(_SLICE))
        with ScenarioCommands(self._scenario, sim) as commands:
            while sim.tick < end:
                if self._topic_hashes is None and sim.tick >= self._half:
                    self._listen()
                if not has_turned and sim.tick >= self._half:
                    has_turned = True
                    self._detour()
                commands.send_due()
                stops = [end, sim.tick + slice_]
                stops += [self._half] if sim.tick < self._half else []
                stops += [max(commands.next_tick, sim.tick + 1)] if commands.next_tick is not None else []
                sim.step(min(stops) - sim.tick)
                self._collect_messages()

    def _reset(self) -> None:
        """Run for a short time, then reset the simulation."""
        self._set_paused(True)
        with suppress(SimkitError), ScenarioCommands(self._scenario, self._sim) as commands:
            self._run_detour(commands)  # an error is ignored, because it would occur again after the reset
        self._sim.reset()
        self._set_paused(False)
        self._marks.state.clear()
        self._marks.inputs.clear()
        if self._call_recorder is not None:
            self._call_recorder.begin_again()

    def _detour(self) -> None:
        """Run further steps with an additional box, then restore the state from before these steps."""
        self._collect_messages()
        snapshot = self._sim.snapshot()
        self._set_paused(True)
        with suppress(SimkitError):
            self._run_detour(None)
        self._sim.restore(snapshot)
        self._collect_messages()
        self._set_paused(False)

    def _run_detour(self, commands: ScenarioCommands | None) -> None:
        sim = self._sim
        left = max(self._end, 2 * self._half) - sim.tick  # the scenario is not defined after its end
        for part in range(2):
            end = sim.tick + min(sim.engine.clock.ticks(_DETOUR / 2), left // 2)
            while sim.tick < end:
                if commands is not None:
                    commands.send_due()
                sim.step(min(25, end - sim.tick))
            if part == 0:
                with suppress(InputError):
                    sim.spawn(_DETOUR_MODEL)

    def _set_paused(self, is_paused: bool) -> None:
        self._marks.is_paused = is_paused
        if self._call_recorder is not None:
            self._call_recorder.is_paused = is_paused
        if self._topic_hashes is not None:
            self._topic_hashes.is_paused = is_paused

    # ------------------------------------------------------------------ outcome

    def _listen(self) -> None:
        scenario = self._scenario
        self._outcome.heard_from = self._sim.tick
        self._topic_hashes = TopicHashes(self._sim, self._variation.listening, scenario.topics, scenario.skip)

    def _collect_messages(self) -> None:
        if self._topic_hashes is not None:
            self._topic_hashes.take()

    def _gather(self) -> None:
        sim, outcome = self._sim, self._outcome
        outcome.ticks, outcome.timestep = sim.tick, sim.timestep
        outcome.state = state_hash(sim)
        outcome.marks, outcome.inputs = self._marks.rows(sim.tick)
        outcome.heard = self._topic_hashes.heard() if self._topic_hashes is not None else {}
        for sensor in sim.engine.structure.all_sensors():
            latest = _latest_reading(sensor)
            outcome.latest[plugin_title(sensor)] = 0 if latest is None else short_hash(msgs.serialize(latest))
            outcome.sources[plugin_title(sensor)] = _class_source(sensor)
        for plugin in sim.engine.structure.all_plugins():
            outcome.remembered[plugin_title(plugin)] = attribute_hashes(plugin_attributes(plugin))
            outcome.sources[plugin_title(plugin)] = _class_source(plugin)
        has_images = any("Image" in h.type_name for h in outcome.heard.values())
        outcome.fingerprint = fingerprint(sim if has_images else None)
        outcome.left_out = count_left_out(sim.diagnostics)
        if self._call_recorder is not None:
            outcome.events = self._call_recorder.events


def _latest_reading(sensor: object) -> Message:
    """Return the newest message of a sensor; None without one."""
    try:
        return sensor.latest if isinstance(sensor, Sensor) else None
    except SimkitError:  # there is no renderer, and an earlier message reported this
        return None


def _class_source(part: object) -> tuple[str, int, int]:
    """Return the file, first line and last line of a plugin's or sensor's class; an empty file if unknown."""
    cls = type(getattr(part, "system", None) or part)
    try:
        lines, first = inspect.getsourcelines(cls)
        return inspect.getsourcefile(cls) or "", first, first + len(lines)
    except (OSError, TypeError):
        return "", 0, 0
