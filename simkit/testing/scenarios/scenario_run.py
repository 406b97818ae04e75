"""Open the world of a scenario, send its commands, and run to its end."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import TracebackType
from typing import TYPE_CHECKING, Any, Literal

from simkit.recording.command_script import Commands, commands_of, read_script, steady_velocity
from simkit.run_spec import RunSpec

if TYPE_CHECKING:
    from simkit.recording.bags.playback import Playback
    from simkit.runtime import Simulation
    from simkit.testing.conditions import CheckResult


_SLICE_SECONDS = 0.25  # [s] of simulated time between two looks at the wall clock


@dataclass(frozen=True)
class ScenarioResult:
    """How a run of a scenario ended.

    Attributes:
        reason: "duration", "until", "timeout" or "wall_timeout".
        results: of every check, in the scenario's order; that of `until` comes first.
    """

    reason: str
    results: tuple[CheckResult, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether everything held, and the run was not given up."""
        return self.reason != "wall_timeout" and all(result.passed for result in self.results)


def open_scenario(scenario: RunSpec, **more: Any) -> Simulation:
    """The world of a scenario, at t = 0.

    Args:
        scenario: what is opened.
        more: further keyword arguments of `simkit.load`, which go over the scenario's.

    Raises:
        LoadError: the world has errors.
    """
    from simkit.build import load

    return load(scenario.source, **{**scenario.load_arguments(), **more})


def run_scenario(
    scenario: RunSpec,
    sim: Simulation,
    on_slice: Callable[[], None] | None = None,
    *,
    absent: Literal["error", "wait"] = "error",
) -> ScenarioResult:
    """Sends the scenario's commands and runs to its end, with its checks.

    Args:
        scenario: what is done.
        sim: its world, opened by `open_scenario`.
        on_slice: called now and then between two steps.
        absent: what a condition is that names a topic which nobody publishes: an "error", or one that is not known
            until somebody does ("wait"), so that its check fails.

    Raises:
        InputError: a command or a check does not fit the world.
        SimulationDiverged: the physics left the numbers.
        PluginError: a plugin raised.
    """
    from simkit.testing.conditions import Watch

    given_up = None if scenario.wall_timeout is None else time.perf_counter() + scenario.wall_timeout
    with (
        ScenarioCommands(scenario, sim) as commands,
        Watch(sim, scenario.checks, until=scenario.until, timeout=scenario.longest, absent=absent) as watch,
        sim.control.pausing.served(),
    ):
        end = sim.engine.steps + sim.engine.clock.ticks(scenario.longest)
        slice_ = max(1, sim.engine.clock.ticks(_SLICE_SECONDS))
        reason = "timeout" if scenario.until else "duration"
        while sim.engine.steps < end and not watch.ended:
            commands.send_due()
            stop = min(sim.tick + slice_, sim.tick + end - sim.engine.steps)
            if commands.next_tick is not None:
                stop = min(stop, max(commands.next_tick, sim.tick + 1))
            sim.control.pausing.advance(stop - sim.tick)
            if on_slice is not None:
                on_slice()
            if given_up is not None and time.perf_counter() > given_up:
                reason = "wall_timeout"
                break
        if watch.ended:
            reason = "until"
        return ScenarioResult(reason, watch.results(reason))


def resolve_commands(spec: RunSpec, topics: Mapping[str, str]) -> RunSpec:
    """Return the run with its `velocity` and its `script` among its commands.

    Args:
        spec: the run.
        topics: topic -> type of its world.

    Raises:
        InputError: SK-CLI-010 no such speeds, or no topic for them; SK-CLI-011 what is wrong with the script.
    """
    if spec.velocity is None and spec.script is None:
        return spec

    found = [] if spec.velocity is None else [steady_velocity(spec.velocity, topics)]
    if spec.script is not None:
        found += read_script(spec.script, topics)
    commands = (*spec.commands, *(command.plain() for command in found))
    return replace(spec, commands=commands, velocity=None, script=None)


class ScenarioCommands:
    """Sends a scenario's commands at their ticks, from the present one on; a context manager.

    Args:
        scenario: what is sent.
        sim: its world.

    Raises:
        InputError: a command does not fit the world, or the recording cannot be played.
    """

    def __init__(self, scenario: RunSpec, sim: Simulation) -> None:

        topics = sim.topics()
        self._commands = Commands(sim, commands_of(resolve_commands(scenario, topics).commands, topics))
        self._played: Playback | None = None
        if scenario.played_bag is not None:
            from simkit.recording.bags.playback import Playback

            self._played = Playback(sim, scenario.played_bag, scenario.play_topics)

    def __enter__(self) -> ScenarioCommands:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._played is not None:
            self._played.close()

    @property
    def next_tick(self) -> int | None:
        """The tick at which something is to be sent next; None when all is sent."""
        ticks = [self._commands.next_tick, None if self._played is None else self._played.next_tick]
        return min((tick for tick in ticks if tick is not None), default=None)

    def send_due(self) -> None:
        """Sends what is due at the present tick.

        Raises:
            InputError: a message does not fit its topic, or the recording breaks off.
        """
        self._commands.send_due()
        if self._played is not None:
            self._played.send_due()
