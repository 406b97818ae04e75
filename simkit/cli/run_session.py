"""Session that runs a loaded world, from its first slice to its summary."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.cli.run_loop import Interrupts, RunLoop
from simkit.cli.run_part import OpenRun, RunPart
from simkit.cli.run_verdict import INTERRUPT, RunVerdict
from simkit.cli.terminal.blocked_plugins import BlockedPlugins
from simkit.cli.terminal.json_report import add_diagnostics, add_to_report
from simkit.cli.terminal.output import JsonObject, print_diagnostics, print_status, stderr_console, stdout_console
from simkit.diagnostics import NOWHERE, Diagnostics, name_hint
from simkit.errors import InputError, RenderError
from simkit.number_text import counted
from simkit.plugins.discovery.left_out import DRIVE_CODE as LEFT_OUT_DRIVE
from simkit.recording.bags.bag_contents import matches_topic
from simkit.run_spec import RunSpec
from simkit.runtime.engine.snapshot import state_hash

if TYPE_CHECKING:
    from simkit.cli.terminal.progress import Progress
    from simkit.recording.bags.playback import Playback
    from simkit.recording.bags.recorder import Recorder
    from simkit.recording.command_script import Command
    from simkit.recording.topic_counts import TopicCount, TopicCounter
    from simkit.runtime import Simulation
    from simkit.runtime.world_control import Program


_TOLD_AGAIN: Final = (LEFT_OUT_DRIVE, "SK-CONTROL-013")
"""Codes of drives and controllers that were left out."""


def print_summary(
    sim: Simulation, counter: TopicCounter, recording: Recorder | None, elapsed: float, *, quiet: bool
) -> None:
    """Print the topics with their measured rates, then one summary line, then the hash of the physics state.

    With `--json`, the report gets the same values.

    Args:
        sim: simulation that has ended.
        counter: message counts of its topics.
        recording: recorder of the run, if it was recorded.
        elapsed: wall time of the run [s].
        quiet: True to print no topics.
    """
    from simkit.cli.terminal.progress import rate_text

    if not quiet and counter.rows:
        width = max(len(row.topic) for row in counter.rows)
        for row in counter.rows:
            stdout_console().print(f"{row.topic:<{width}}  {row.count:>8}  {rate_text(row):>12}  {row.type_name}")
    factor = sim.time / max(elapsed, 1e-9)
    line = f"simulated {sim.time:.3f} s in {elapsed:.2f} s ({factor:.2f} × real time)"
    line += f", {counted(counter.total, 'message')} read"
    if recording is not None:
        line += f"; {recording.message_count} in {recording.path}"
    stdout_console().print(line)
    state = state_hash(sim)
    stdout_console().print(f"state {state}")
    add_to_report(
        world=sim.world.name,
        time=sim.time,
        steps=sim.engine.steps,
        wall_time=elapsed,
        real_time_factor=factor,
        state=state,
        topics=[_topic_dict(row) for row in counter.rows],
        recording=None if recording is None else {"path": str(recording.path), "messages": recording.message_count},
    )


def print_nodes(sim: Simulation) -> None:
    """Print one line for each node: its state, the number of its turns and of the lines of its log.

    With `--json`, the report gets the same values.
    """
    rows = [(program, _node_state(program)) for program in sim.nodes]
    counts = Counter(program.name for program, _ in rows)
    for program, state in rows:
        name = program.name if counts[program.name] == 1 else program.label
        if program.awaited:
            stdout_console().print(f"node {name}: {state}")
            continue
        numbers = f"{program.hand_overs} turns, {counted(len(program.log), 'log line')}"
        restarts = f", {counted(program.restarts, 'restart')}" if program.restarts else ""
        style = "red" if program.error is not None else None
        stdout_console().print(f"node {name}: {state}, {numbers}{restarts}", style=style)
    if rows:
        add_to_report(
            nodes=[
                {
                    "name": program.name,
                    "state": state,
                    "turns": program.hand_overs,
                    "restarts": program.restarts,
                    "log": list(program.log),
                    "error": program.failure or None,
                }
                for program, state in rows
            ]
        )


def _node_state(program: Program) -> str:
    """Return the state of a node at the end of a run."""
    if program.awaited:
        return f"not started (waits for {program.awaited})"
    if isinstance(program.error, SystemExit):
        return f"failed with exit code {program.exit_code}"
    if program.error is not None:
        return f"failed with {type(program.error).__name__}"
    return "ended" if program.done else "running"


def _topic_dict(row: TopicCount) -> JsonObject:
    """Return the counts of a topic for the JSON report; null for numbers that are not known."""
    return {
        "topic": row.topic,
        "type": row.type_name,
        "messages": row.count if row.counted else None,
        "rate": row.rate() if row.counted else None,
    }


def run_length(spec: RunSpec, played: float | None = None) -> float | None:
    """Return the longest simulated time [s] of a run; None if the run continues until Ctrl-C.

    Args:
        spec: run specification.
        played: length of the played bag [s]; it limits a run without a duration.
    """
    duration = played if spec.is_endless else spec.duration
    return min((t for t in (duration, spec.timeout) if t is not None), default=None)


def _endless_text(spec: RunSpec) -> str:
    """Return the start message of a run without a time limit."""
    if spec.until:
        return "running until the condition holds, or Ctrl-C (set a limit with --timeout S)"
    return "running until Ctrl-C (set a limit with --duration S)"


def _interrupt_text(interrupts: Interrupts, loop: RunLoop) -> str:
    """Return the reason for an early end of a run; empty if the run was not interrupted."""
    return INTERRUPT if interrupts.exit_code else loop.early_end()


def _report_unsent_velocity(problem: str) -> None:
    """Warn that no command of `--cmd-vel` was sent during the run.

    Args:
        problem: reason.
    """
    diagnostics = Diagnostics()
    diagnostics.warning("SK-CLI-010", f"no command was sent: {problem}", NOWHERE)
    print_diagnostics(diagnostics, verbose=True)
    add_diagnostics(diagnostics)


def _note_missing_gl(sim: Simulation) -> None:
    """Print a note if the simulation has cameras and this machine has no OpenGL.

    With the renderer `auto`, the note names the software renderer. Only the first image opens OpenGL, so that a run
    whose cameras nobody reads starts without it.
    """
    if not any(sensor.needs_renderer for sensor in sim.contents.sensors.values()) or sim.world.renderer == "software":
        return
    from simkit.sensors.cameras.renderer_choice import chosen_renderer
    from simkit.sensors.cameras.rendering.gl_context import find_library

    try:
        find_library()
    except RenderError as error:
        if chosen_renderer(sim) == "gl":
            print_status(f"note: {error.code} cameras have no images: {error.message}")


class Session:
    """One run of a loaded world.

    Args:
        spec: run specification.
        parts: parts of the run.
        sim: loaded simulation.
        blocked: reporter of plugins that block the run.
        verdict: result of the run.
        quiet: True to print no table of topics.
    """

    def __init__(
        self,
        spec: RunSpec,
        parts: Sequence[RunPart],
        sim: Simulation,
        blocked: BlockedPlugins,
        verdict: RunVerdict,
        *,
        quiet: bool,
    ) -> None:
        self.spec, self.parts, self.quiet = spec, parts, quiet
        self.sim, self.blocked, self.verdict = sim, blocked, verdict
        self._printed = frozenset(sim.diagnostics)  # before the run

    def execute(self) -> int:
        """Run the simulation to its end and return the exit code."""
        from simkit.recording.command_script import Commands, LateVelocity
        from simkit.recording.topic_counts import RENDERED, TopicCounter

        spec, sim = self.spec, self.sim
        for part in self.parts:
            part.after_loading(sim)
        commands = Commands(sim, self._commands())
        played = self._played()
        duration = run_length(spec, played.duration if played is not None else None)
        conditions = self.verdict.watch(sim, duration)
        with ExitStack() as stack:
            if played is not None:
                stack.enter_context(played)
            interrupts = stack.enter_context(Interrupts(self.blocked.hasten))
            recording = self._start_recording(stack)
            _note_missing_gl(sim)
            counter = TopicCounter(sim, RENDERED, recording.records if recording is not None else None)
            begun = time.perf_counter()
            loop = RunLoop(sim, commands, interrupts, [], rtf=spec.pace)
            velocity: LateVelocity | None = None
            if spec.velocity is not None and sim.nodes:
                velocity = LateVelocity(sim, spec.velocity)
                loop.senders.append(velocity)
            if recording is not None:
                loop.watchers.append(recording.check)
            if played is not None:
                loop.senders.append(played)
            self._serve(stack, loop)
            run = OpenRun(spec, sim, loop, interrupts, loop.run)
            for part in self.parts:
                stack.enter_context(part.around_loop(run))
            progress = stack.enter_context(_progress(run, counter, duration))
            loop.watchers.append(progress.update)
            if duration is None:
                print_status(_endless_text(spec))  # other terminals can connect from now on
            self._hold()
            if not stdout_console().is_interactive:
                loop.start_lines.extend(run.status_lines)
            stack.enter_context(conditions)
            loop.is_over = self._is_over
            try:
                run.advance(duration)
                sim.check_nodes()
            except BaseException as error:
                self.verdict.end(error, "")
                raise
            else:
                if sim.ended_by:
                    print_status(f"the node {sim.ended_by} has ended the run at t={sim.time:g} s")
                self.verdict.end(None, _interrupt_text(interrupts, loop))
            finally:
                elapsed = time.perf_counter() - begun
                progress.__exit__(None, None, None)
                if recording is not None:
                    recording.close()
                print_summary(sim, counter, recording, elapsed, quiet=self.quiet)
                print_nodes(sim)
                self.verdict.print_results()
                self._report_new_warnings()
                self._report_fallen_models()
                if velocity is not None and velocity.problem:
                    _report_unsent_velocity(velocity.problem)
                if recording is not None:
                    self._report_unmatched_topics()
        return interrupts.exit_code or self.verdict.code

    def _is_over(self) -> bool:
        """Check whether the run has ended before its duration."""
        return self.verdict.is_over() or bool(self.sim.ended_by)

    def _report_new_warnings(self) -> None:
        """Print the warnings that the run has caused, such as ignored commands; disabled plugins are logged at once.

        A drive or controller that was left out is reported again, because the user waits for a motion.
        """
        warnings = [d for d in self.sim.diagnostics if d.severity == "warning"]
        new_warnings = [d for d in warnings if d not in self._printed or d.code in _TOLD_AGAIN]
        print_diagnostics([d for d in new_warnings if d.code != "SK-PLUGIN-020"], verbose=True)

    def _report_fallen_models(self) -> None:
        """Warn of models that fell out of the world, and of robots that folded without a drive."""
        from simkit.runtime.fallen_models import find_fallen_models
        from simkit.runtime.folded_models import find_folded_models

        diagnostics = find_fallen_models(self.sim)
        diagnostics.extend(find_folded_models(self.sim))
        print_diagnostics(diagnostics, verbose=True)
        add_diagnostics(diagnostics)

    def _report_unmatched_topics(self) -> None:
        """Warn of selected topics that no topic of the recorded run matches."""
        diagnostics, topics = Diagnostics(), self.sim.communication.bus.all_topics()
        for pattern in self.spec.topics:
            if not any(matches_topic(topic, [pattern]) for topic in topics):
                text = f"the recording selects the topic {pattern!r}, but no topic of this run matches"
                diagnostics.warning("SK-BAG-017", text, NOWHERE, name_hint(pattern, topics))
        print_diagnostics(diagnostics, verbose=True)
        add_diagnostics(diagnostics)

    def _start_recording(self, stack: ExitStack) -> Recorder | None:
        """Start the recorder that the specification requests; the stack closes it."""
        spec, bag = self.spec, self.spec.recording
        if bag is None:
            self._check_selected_topics()
            return None
        from simkit.recording.bags.recorder import Recorder

        recorder = Recorder(self.sim, bag.path, overwrite=bag.overwrite, topics=spec.topics, skip=spec.skip)
        return stack.enter_context(recorder)

    def _check_selected_topics(self) -> None:
        """Check that the topics of --topic have messages, and note that only a recording uses the option.

        Raises:
            RenderError: SK-RENDER-001 images are selected, and the run requests OpenGL, which is missing.
        """
        spec, bus = self.spec, self.sim.communication.bus
        if not spec.topics:
            return
        for topic in bus.all_topics():
            if matches_topic(topic, spec.topics) and not matches_topic(topic, spec.skip):
                bus.check_available(topic)
        print_status("note: --topic selects the topics of a recording; this run has none, because --record is missing")

    # ------------------------------------------------------------------ commands

    def _commands(self) -> list[Command]:
        from simkit.recording.command_script import read_script, steady_velocity

        topics, has_nodes = self.sim.communication.bus.topics(), bool(self.sim.nodes)
        commands = []
        if self.spec.velocity is not None and not has_nodes:
            commands.append(steady_velocity(self.spec.velocity, topics, self.sim.communication.bus.idle_topics()))
        if self.spec.script is not None:
            commands += read_script(self.spec.script, None if has_nodes else topics)
        return commands

    def _played(self) -> Playback | None:
        """Open the bag to play, if the specification names one."""
        bag = self.spec.played_bag
        if bag is None:
            if self.spec.play_topics:
                raise InputError("SK-CLI-018", "--play-topic needs --play BAG")
            return None
        from simkit.recording.bags.playback import Playback  # 5 ms: the formats of bags

        played = Playback(self.sim, bag, self.spec.play_topics)
        for note in played.notes:
            print_status(f"note: {note}")
        remappings = [old if old == new else f"{old} on {new}" for old, new in played.names.items()]
        print_status(f"playing {', '.join(remappings)} of {bag}")
        return played

    def _hold(self) -> None:
        """Start the run paused, or pause it after some steps, as specified."""
        if self.spec.steps is not None:
            self.sim.control.pausing.step(self.spec.steps)
        elif self.spec.paused:
            self.sim.paused = True

    def _serve(self, stack: ExitStack, loop: RunLoop) -> None:
        """Open the socket for other terminals."""
        from simkit.bridges.live.server import serve

        name = self.spec.name or None
        if name is None and self.sim.world.name == "default":  # name of the world of a bare model, and of many worlds
            name = Path(self.spec.world).name.partition(".")[0] or None
        loop.server, note = serve(self.sim, name)
        if loop.server is None:
            print_status(note)
        else:
            stack.enter_context(loop.server)


def _progress(run: OpenRun, counter: TopicCounter, duration: float | None) -> Progress:
    """Return the display on the terminal, with the lines of a part if it has some."""
    from simkit.cli.terminal.progress import Progress

    console = stdout_console()
    if run.progress_lines is not None and not console.is_interactive:
        console = stderr_console()
    return Progress(run.sim, counter, duration, console, run.progress_lines, run.status_lines)
