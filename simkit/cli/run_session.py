"""Session that runs a loaded world, from its first slice to its summary."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from simkit.cli.run_bridges import start_bridges
from simkit.cli.run_display import RunDisplay
from simkit.cli.run_loop import Interrupts, RunLoop
from simkit.cli.run_pictures import check_renderer, draw_picture, film_run, note_missing_gl
from simkit.cli.run_verdict import RunVerdict
from simkit.cli.terminal.blocked_plugins import BlockedPlugins
from simkit.cli.terminal.json_report import add_diagnostics, add_to_report
from simkit.cli.terminal.output import JsonObject, print_diagnostics, print_status, stderr_console, stdout_console
from simkit.cli.terminal.page_options import open_later, open_page
from simkit.diagnostics import NOWHERE, Diagnostics, name_hint
from simkit.errors import InputError
from simkit.recording.bags.bag_contents import matches_topic
from simkit.run_spec import RunSpec
from simkit.runtime.engine.snapshot import state_hash

if TYPE_CHECKING:
    from simkit.bridges.bridge_process import BridgeProcess
    from simkit.bridges.teleop import Teleop
    from simkit.cli.terminal.keyboard import Keyboard, WindowsKeyboard
    from simkit.cli.terminal.progress import Progress
    from simkit.recording.bags.playback import Playback
    from simkit.recording.bags.recorder import Recorder
    from simkit.recording.command_script import Command
    from simkit.recording.run_picture import DrivenPath
    from simkit.recording.topic_counts import TopicCount, TopicCounter
    from simkit.runtime import Simulation


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
    line = f"simulated {sim.time:.3f} s in {elapsed:.2f} s ({factor:.2f} × real time), {counter.total} messages read"
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


def _topic_dict(row: TopicCount) -> JsonObject:
    """Return the counts of a topic for the JSON report; null for numbers that are not known."""
    return {
        "topic": row.topic,
        "type": row.type_name,
        "messages": row.count if row.counted else None,
        "rate": row.rate() if row.counted else None,
    }


def check_keyboard(display: RunDisplay) -> None:
    """Check before a run whether keys can be read for --teleop.

    Raises:
        InputError: SK-CLI-050 standard input is not a terminal.
    """
    from simkit.cli.terminal.keyboard import open_keyboard

    if display.teleop is not None and open_keyboard(sys.stdin) is None:
        raise InputError(
            "SK-CLI-050 --teleop needs a terminal, but standard input is not a terminal\n"
            "    help: drive with --cmd-vel V,W or --script FILE.yaml, or with `simkit topic pub` in another terminal",
            "SK-CLI-050",
        )


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
    if interrupts.exit_code:
        return "an interrupt"
    return "" if loop.keep_going() else "the viewer's"


class Session:
    """One run of a loaded world.

    Args:
        spec: run specification.
        display: display, keyboard and report options.
        sim: loaded simulation.
        blocked: reporter of plugins that block the run.
        verdict: result of the run.
        bridges: bridges to other programs, which are not started yet.
    """

    def __init__(
        self,
        spec: RunSpec,
        display: RunDisplay,
        sim: Simulation,
        blocked: BlockedPlugins,
        verdict: RunVerdict,
        bridges: Sequence[BridgeProcess] = (),
    ) -> None:
        self.spec, self.display, self._bridges = spec, display, bridges
        self.sim, self.blocked, self.verdict = sim, blocked, verdict
        self._teleop: Teleop | None = None
        self._printed = frozenset(sim.diagnostics)  # before the run

    def execute(self) -> int:
        """Run the simulation to its end and return the exit code."""
        from simkit.recording.command_script import Commands
        from simkit.recording.topic_counts import RENDERED, TopicCounter

        spec, display, sim = self.spec, self.display, self.sim
        if display.picture is not None or display.film is not None:
            check_renderer(sim)
        commands, self._teleop = Commands(sim, self._commands()), self._driver()
        played = self._played()
        duration = run_length(spec, played.duration if played is not None else None)
        conditions = self.verdict.watch(sim, duration)
        driven = self._driven_path()
        with ExitStack() as stack:
            if played is not None:
                stack.enter_context(played)
            interrupts = stack.enter_context(Interrupts(self.blocked.hasten))
            recording = self._start_recording(stack)
            note_missing_gl(sim)
            counter = TopicCounter(sim, RENDERED, recording.records if recording is not None else None)
            keyboard = self._keyboard()
            view = None if display.page is None else open_page(sim, display.page, stack)
            begun = time.perf_counter()
            progress = stack.enter_context(self._progress(counter, duration))
            watchers: list[Callable[[], object]] = [progress.update]
            if recording is not None:
                watchers.append(recording.check)
            if driven is not None:
                watchers.append(driven.sample)
            loop = RunLoop(sim, commands, interrupts, watchers, rtf=spec.pace, follow=driven is not None)
            if played is not None:
                loop.senders.append(played)
            film = stack.enter_context(film_run(sim, display.film, driven, loop.senders))
            if view is not None:
                loop.show(view)
            if display.view:
                self._open_viewer(stack, loop, watchers)
            if keyboard is not None:
                stack.enter_context(keyboard)
                self._connect_keys(keyboard, loop)
            self._serve(stack, loop)
            start_bridges(self._bridges, loop, interrupts, watchers)
            if duration is None:
                print_status(_endless_text(spec))  # other terminals can connect from now on
            self._hold()
            stack.enter_context(conditions)
            loop.is_over = self.verdict.is_over
            advance = self._watched(loop, interrupts, watchers) if display.watch else loop.run
            try:
                advance(duration)
                film()
            except BaseException as error:
                self.verdict.end(error, "")
                raise
            else:
                self.verdict.end(None, _interrupt_text(interrupts, loop))
            finally:
                elapsed = time.perf_counter() - begun
                progress.__exit__(None, None, None)
                if recording is not None:
                    recording.close()
                print_summary(sim, counter, recording, elapsed, quiet=display.quiet)
                self.verdict.print_results()
                self._report_new_warnings()
                self._report_fallen_models()
                if recording is not None:
                    self._report_unmatched_topics()
        if driven is not None and display.picture is not None:
            draw_picture(sim, display.picture, driven)
        return interrupts.exit_code or self.verdict.code

    def _driven_path(self) -> DrivenPath | None:
        """Start to record the path of the robot, if the run draws a picture or a film."""
        if self.display.picture is None and self.display.film is None:
            return None
        from simkit.recording.run_picture import DrivenPath  # 4 ms

        return DrivenPath(self.sim)

    def _report_new_warnings(self) -> None:
        """Print the warnings that the run has caused, such as ignored commands; disabled plugins are logged at once."""
        found = [d for d in self.sim.diagnostics if d.severity == "warning" and d not in self._printed]
        print_diagnostics([d for d in found if d.code != "SK-PLUGIN-020"], verbose=True)

    def _report_fallen_models(self) -> None:
        """Warn of models that fell out of the world."""
        from simkit.runtime.fallen_models import find_fallen_models

        found = find_fallen_models(self.sim)
        print_diagnostics(found, verbose=True)
        add_diagnostics(found)

    def _report_unmatched_topics(self) -> None:
        """Warn of selected topics that no topic of the recorded run matches."""
        found, topics = Diagnostics(), self.sim.communication.bus.all_topics()
        for pattern in self.spec.topics:
            if not any(matches_topic(topic, [pattern]) for topic in topics):
                text = f"the recording selects the topic {pattern!r}, but no topic of this run matches"
                found.warning("SK-BAG-017", text, NOWHERE, name_hint(pattern, topics))
        print_diagnostics(found, verbose=True)
        add_diagnostics(found)

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

        topics = self.sim.communication.bus.topics()
        found = []
        if self.spec.velocity is not None:
            found.append(steady_velocity(self.spec.velocity, topics))
        if self.spec.script is not None:
            found += read_script(self.spec.script, topics)
        return found

    def _played(self) -> Playback | None:
        """Open the bag to play, if the specification names one."""
        bag = self.spec.played_bag
        if bag is None:
            if self.spec.play_topics:
                raise InputError("SK-CLI-018 --play-topic needs --play BAG", "SK-CLI-018")
            return None
        from simkit.recording.bags.playback import Playback  # 5 ms: the formats of bags

        played = Playback(self.sim, bag, self.spec.play_topics)
        for note in played.notes:
            print_status(f"note: {note}")
        remappings = [old if old == new else f"{old} on {new}" for old, new in played.names.items()]
        print_status(f"playing {', '.join(remappings)} of {bag}")
        return played

    def _driver(self) -> Teleop | None:
        from simkit.bridges.teleop import Teleop, find_target

        display = self.display
        if display.teleop is None:
            return None
        return Teleop(self.sim, find_target(self.sim, display.teleop), display.key_timeout)

    def _keyboard(self) -> Keyboard | WindowsKeyboard | None:
        """Open the terminal's keyboard for teleop, or if the options pause the run and its output is on the terminal.

        Keys that are typed during any other run are for the shell, which reads them after the run. If the output goes
        to a pager, the pager reads the keys. simkit then reads them only for teleop.
        """
        from simkit.cli.terminal.keyboard import open_keyboard

        if self._teleop is None:
            is_paused_by_options = self.spec.paused or self.spec.steps is not None
            has_output = sys.stdout is not None and not sys.stdout.closed and sys.stdout.isatty()
            if not (is_paused_by_options and has_output):
                return None
        return open_keyboard(sys.stdin)

    def _connect_keys(self, keyboard: Keyboard | WindowsKeyboard, loop: RunLoop) -> None:
        """Connect the keyboard to the loop, so that keys pause, step and drive the run."""
        from simkit.cli.run_keys import RunKeys

        keys = RunKeys(self.sim, keyboard, self._teleop)
        loop.poll_keys, loop.on_pause = keys.poll, keys.say_paused
        if self._teleop is not None:
            loop.senders.append(self._teleop)

    def _progress(self, counter: TopicCounter, duration: float | None) -> Progress:
        from simkit.cli.terminal.progress import Progress
        from simkit.cli.terminal.teleop_display import DriverLine

        if self._teleop is None:
            return Progress(self.sim, counter, duration, stdout_console())
        console = stdout_console() if stdout_console().is_interactive else stderr_console()
        return Progress(self.sim, counter, duration, console, DriverLine(self.sim, self._teleop).lines)

    def _hold(self) -> None:
        """Start the run paused, or pause it after some steps, as specified."""
        if self.spec.steps is not None:
            self.sim.control.pausing.step(self.spec.steps)
        elif self.spec.paused:
            self.sim.paused = True

    # ------------------------------------------------------------------ viewer, clients and plugin files

    def _open_viewer(self, stack: ExitStack, loop: RunLoop, watchers: list[Callable[[], object]]) -> None:
        from simkit.bridges.viewer import Viewer

        viewer = stack.enter_context(Viewer(self.sim))
        watchers.append(viewer.update)
        loop.keep_going = viewer.is_open

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
            loop.server.open_view = partial(open_later, loop, self.sim, stack)
            stack.enter_context(loop.server)

    def _watched(
        self, loop: RunLoop, interrupts: Interrupts, watchers: list[Callable[[], object]]
    ) -> Callable[[float | None], object]:
        """Return a function that runs the loop and reloads plugins whose files change."""
        from simkit.cli.plugin_watch import PluginWatch

        folders = [Path(folder) for folder in self.spec.options.get("plugin_paths", ())]
        watch = PluginWatch(self.sim, folders, interrupts, waits=self.spec.recording is None)
        watchers.append(watch.poll)
        loop.before_slice = watch.keep
        return partial(watch.run, loop)
