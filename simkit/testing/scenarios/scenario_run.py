"""Run of a scenario: load the world, send the commands, evaluate the checks, and stop at the end."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Literal

from simkit import progress
from simkit.argument_checks import shown
from simkit.diagnostics import name_hint
from simkit.errors import InputError
from simkit.recording.command_script import (
    Commands,
    commands_of,
    parse_velocity,
    read_script,
    script_items,
    steady_velocity,
    validate_items,
)
from simkit.run_files import FileName
from simkit.run_nodes import label_of, latency_of, node_arguments, nodes_read_files
from simkit.run_spec import FilePath, RunSpec
from simkit.testing.scenarios.code_permission import permit_code

if TYPE_CHECKING:
    from simkit.recording.bags.playback import Playback
    from simkit.runtime import Simulation
    from simkit.runtime.communication.topic_bus import TopicBus
    from simkit.testing.conditions import CheckResult


CommandsArgument = FilePath | Sequence[Mapping[str, object]]
"""Timed commands, a constant velocity `V,W`, a script `FILE.yaml`, or a bag."""

_SLICE_SECONDS = 0.25  # simulated time between two checks of the wall clock [s]
_RESUME = "remove the call that pauses the world, or resume the world in the same step"


@dataclass(frozen=True)
class ScenarioResult:
    """Result of running a scenario.

    Attributes:
        reason: "duration", "until", "timeout" or "wall_timeout".
        results: Results of the checks; the result of `until` is first, the others are in the scenario's order.
    """

    reason: str
    results: tuple[CheckResult, ...] = ()

    @property
    def passed(self) -> bool:
        """True if all checks passed and the run did not reach its wall-clock limit."""
        return self.reason != "wall_timeout" and all(result.passed for result in self.results)


def open_scenario(scenario: RunSpec, *, allow_code: bool = False, **more: Any) -> Simulation:
    """Load the world of a scenario at t = 0.

    Args:
        scenario: Scenario.
        allow_code: Allow the plugin folders that the scenario's file names. Their code has the same rights as the user.
        more: Further keyword arguments of `simkit.load`; they override the arguments in the scenario. `plugin_paths`
            allow the folders in them.

    Raises:
        LoadError: The world has errors, or SK-SCEN-008 the scenario needs code that is not allowed.
    """
    from simkit.build import load

    scenario = permit_code(scenario, allow_code, more.get("plugin_paths", ()))
    with nodes_read_files(bool(scenario.nodes)):
        sim = load(scenario.source, **{**scenario.load_arguments(), **more})
    try:
        add_nodes(scenario, sim)
    except BaseException:
        sim.close()
        raise
    return sim


def add_nodes(spec: RunSpec, sim: Simulation) -> None:
    """Add the nodes of a run to the simulation of its world; they start with the next step.

    Raises:
        InputError: SK-CLI-018 an invalid latency, or one for a node that the run does not have; or a program does not
            exist, or the pack that runs programs is not installed.
    """
    latency_by_node = _latencies(spec)
    if spec.ros_parameters:
        sim.set_ros_parameters(spec.ros_parameters)
    for number, node in enumerate(spec.nodes):
        arguments = node_arguments(node)
        name = FileName(arguments.pop("program"), "program", ("nodes", number))
        if "cwd" in arguments:
            folder = FileName(arguments["cwd"], "folder", ("nodes", number))
            arguments["cwd"] = folder.used_path(spec.folder) or folder.text
        latency = latency_by_node.get(label_of(node), latency_by_node.get("", 0.0))
        sim.add_node(
            str(name.used_path(spec.folder) or name.text),
            **{"latency": latency, **arguments},
            discovery=spec.node_discovery,
            limit=spec.node_limit,
            restart=spec.node_restart,
        )


def _latencies(spec: RunSpec) -> dict[str, float | tuple[float, float]]:
    """Return the latencies [s] of `node_latency` by node; the name is empty for all other nodes."""
    labels = [label_of(node) for node in spec.nodes]
    latencies: dict[str, float | tuple[float, float]] = {}
    for text in spec.node_latency:
        label, equals, time_text = text.rpartition("=")
        if equals and label not in labels:
            hint = name_hint(label, labels)
            raise InputError("SK-CLI-018", f"node latency {text!r:.100}: the run has no node {label!r}", help=hint)
        latencies[label] = latency_of(time_text)
    return latencies


def run_scenario(
    scenario: RunSpec,
    sim: Simulation,
    on_slice: Callable[[], None] | None = None,
    *,
    absent: Literal["error", "wait"] = "error",
    allow_code: bool = False,
    judged: bool = True,
    slice_seconds: float = _SLICE_SECONDS,
) -> ScenarioResult:
    """Run a scenario to its end with its commands and checks.

    Args:
        scenario: Scenario.
        sim: Simulation from `open_scenario`.
        on_slice: Function that is called between two steps, every `slice_seconds` or more often.
        absent: Behaviour of a condition on a topic without a publisher. "error" raises an error. "wait" waits for a
            publisher, and the check fails if there is none until the end of the run.
        allow_code: Allow the plugin folders that the scenario's file names, as in `open_scenario`.
        judged: False to evaluate only `until`, which ends the run.
        slice_seconds: Longest simulated time between two calls of `on_slice` [s].

    Raises:
        InputError: A command or a check does not fit the world, or SK-SCEN-008 the scenario needs code that is not
            allowed, or SK-SCEN-009 the world was paused before the end.
        SimulationDiverged: The state became NaN or infinite.
        PluginError: A plugin raised an exception.
        NodeError: A node raised an exception; the run went on to its end.
    """
    from simkit.testing.conditions import Watch

    scenario = permit_code(scenario, allow_code)
    checks = scenario.checks if judged else ()
    wall_deadline = None if scenario.wall_timeout is None else time.perf_counter() + scenario.wall_timeout
    with (
        ScenarioCommands(scenario, sim) as commands,
        Watch(sim, checks, until=scenario.until, timeout=scenario.longest, absent=absent) as watch,
        sim.control.pausing.served(),
        progress.task(f"running {scenario.title}", scenario.longest, unit="s") as task,
    ):
        begun = sim.engine.steps
        end = sim.engine.steps + sim.engine.clock.checked_ticks(scenario.longest, "duration")
        slice_ = max(1, sim.engine.clock.ticks(slice_seconds))
        reason = "timeout" if scenario.until else "duration"
        while sim.engine.steps < end and not watch.ended and not sim.ended_by:
            commands.send_due()
            stop = min(sim.tick + slice_, sim.tick + end - sim.engine.steps)
            if commands.next_tick is not None:
                stop = min(stop, max(commands.next_tick, sim.tick + 1))
            before = sim.engine.steps
            sim.control.pausing.advance(stop - sim.tick)
            if sim.engine.steps == before and not watch.ended and not sim.ended_by:
                text = f"the world was paused at t = {sim.time:g} s, and nothing in the scenario resumes it"
                raise InputError("SK-SCEN-009", text, help=_RESUME)
            task.done = (sim.engine.steps - begun) * sim.timestep
            if on_slice is not None:
                on_slice()
            if wall_deadline is not None and time.perf_counter() > wall_deadline:
                reason = "wall_timeout"
                break
        if watch.ended:
            reason = "until"
        sim.check_nodes()
        return ScenarioResult(reason, watch.results(reason))


def with_commands(spec: RunSpec, commands: CommandsArgument | None) -> RunSpec:
    """Return a run specification with other commands in place of its own; with its own if `commands` is None.

    Raises:
        InputError: SK-CLI-010 a velocity is invalid; SK-CLI-011 a command or a script is invalid, or the value is of
            another kind.
    """
    if commands is None:
        return spec
    spec = replace(spec, commands=(), velocity=None, script=None, play="", play_topics=())
    if isinstance(commands, (str, PathLike)):
        path = Path(commands)
        if path.suffix in (".yaml", ".yml"):
            return replace(spec, commands=tuple(script_items(path)))
        if commands and path.exists():
            return replace(spec, play=str(path.absolute()))
        if isinstance(commands, str) and "," in commands:
            if "{" not in commands:  # the values of variables are not known yet
                parse_velocity(commands, "commands")
            return replace(spec, velocity=commands)
    if not isinstance(commands, (list, tuple)):
        wanted = "a list of mappings, a text V,W, a script FILE.yaml, or a bag that exists"
        raise InputError("SK-CLI-011", f"commands: found {shown(commands)}; expected {wanted}")
    items = ((item, f"commands[{number}]") for number, item in enumerate(commands))
    return replace(spec, commands=tuple(validate_items(items)))


def resolve_commands(spec: RunSpec, bus: TopicBus) -> RunSpec:
    """Return a run specification whose `velocity` and `script` are converted to commands.

    Args:
        spec: Run specification.
        bus: Topics of the world.

    Raises:
        InputError: SK-CLI-010 invalid velocity, or no topic for it; SK-CLI-011 invalid script.
    """
    if spec.velocity is None and spec.script is None:
        return spec

    topics = bus.topics()
    requested = [] if spec.velocity is None else [steady_velocity(spec.velocity, topics, bus.idle_topics())]
    if spec.script is not None:
        requested += read_script(spec.script, None if spec.nodes else topics)
    commands = (*spec.commands, *(command.plain() for command in requested))
    return replace(spec, commands=commands, velocity=None, script=None)


class ScenarioCommands:
    """Sender of a scenario's commands, from the present tick on; a context manager around the run.

    Args:
        scenario: Scenario.
        sim: Simulation of its world.

    Raises:
        InputError: A command does not fit the world, or the bag cannot be played.
    """

    def __init__(self, scenario: RunSpec, sim: Simulation) -> None:
        topics = sim.communication.bus.topics()
        self._commands = Commands(
            sim, commands_of(resolve_commands(scenario, sim.communication.bus).commands, None if sim.nodes else topics)
        )
        if not sim.nodes:  # nodes may create further topics
            self._commands.check_messages()
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
        """Tick of the next command; None after the last one."""
        ticks = [self._commands.next_tick, None if self._played is None else self._played.next_tick]
        return min((tick for tick in ticks if tick is not None), default=None)

    def send_due(self) -> None:
        """Send all commands that are due at the present tick.

        Raises:
            InputError: A message does not fit its topic, or the bag is truncated.
        """
        self._commands.send_due()
        if self._played is not None:
            self._played.send_due()
