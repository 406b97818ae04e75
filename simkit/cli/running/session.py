"""A run of a loaded world, from its first slice to its summary."""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from simkit.cli.console import err, out, say
from simkit.cli.running.end import draw, summarise
from simkit.cli.running.interrupts import Interrupts
from simkit.cli.running.loop import Loop
from simkit.cli.running.request import Request
from simkit.cli.running.verdict import Verdict
from simkit.errors import InputError
from simkit.sinks.blocked import BlockedPlugins

if TYPE_CHECKING:
    from simkit.cli.driving.keyboard import Keyboard, WindowsKeyboard
    from simkit.cli.driving.teleop import Teleop
    from simkit.sinks.playback import Playback
    from simkit.sinks.progress import Progress
    from simkit.sinks.topic_counts import TopicCounter


def check_keyboard(request: Request) -> None:
    """Says before a run why nobody can drive.

    Raises:
        InputError: SK-CLI-050 there is no terminal.
    """
    from simkit.cli.driving.keyboard import keyboard_of

    if request.teleop is not None and keyboard_of(sys.stdin) is None:
        raise InputError(
            "SK-CLI-050 --teleop reads keys, and standard input is no terminal\n"
            "    help: --cmd-vel V,W or --script FILE.yaml drive without one, simkit topic pub from another terminal",
            "SK-CLI-050",
        )


def _endless(request: Request) -> str:
    """What is said of a run that has no end of its own."""
    if request.until:
        return "running until the condition holds, or Ctrl-C (--timeout S gives up then)"
    return "running until Ctrl-C (--duration S stops by itself)"


def _who_ended(interrupts: Interrupts, loop: Loop) -> str:
    """Who ended a run before its time; empty for nobody."""
    if interrupts.exit_code:
        return "an interrupt"
    return "" if loop.keep_going() else "the viewer's"


class Session:
    """One run of a loaded world.

    Args:
        request: what it is to do.
        sim: the simulation.
        blocked: tells of plugins that keep it waiting.
        verdict: what is asked of it.
    """

    def __init__(self, request: Request, sim: Any, blocked: BlockedPlugins, verdict: Verdict) -> None:
        self.request, self.sim, self.blocked, self.verdict = request, sim, blocked, verdict
        self._teleop: Teleop | None = None

    def execute(self) -> int:
        """Runs it to its end; the exit code."""
        from simkit.sinks.commands import Commands
        from simkit.sinks.picture import DrivenPath
        from simkit.sinks.progress import Stopwatch
        from simkit.sinks.recorder import Recorder
        from simkit.sinks.topic_counts import RENDERED, TopicCounter

        request, sim = self.request, self.sim
        commands, self._teleop = Commands(sim, self._commands()), self._driver()
        played = self._played()
        duration = request.longest(played.duration if played is not None else None)
        if duration is None:
            say(_endless(request))
        conditions = self.verdict.watch(sim, duration)
        driven = DrivenPath(sim) if request.picture is not None else None
        with ExitStack() as stack:
            if played is not None:
                stack.enter_context(played)
            interrupts = stack.enter_context(Interrupts(self.blocked.ask))
            recording = None
            if request.record is not None:
                recording = stack.enter_context(
                    Recorder(sim, request.record, overwrite=request.force, topics=request.topics, skip=request.skip)
                )
            counter = TopicCounter(sim, RENDERED, recording.records if recording is not None else None)
            keyboard = self._keyboard()
            watch = Stopwatch()
            progress = stack.enter_context(self._progress(counter, duration))
            watchers: list[Any] = [progress.update]
            if recording is not None:
                watchers.append(recording.check)
            if driven is not None:
                watchers.append(driven.sample)
            loop = Loop(sim, commands, interrupts, watchers, rtf=request.pace, follow=driven is not None)
            if played is not None:
                loop.senders.append(played)
            if request.view:
                self._open_viewer(stack, loop, watchers)
            if keyboard is not None:
                stack.enter_context(keyboard)
                self._listen_to(keyboard, loop)
            self._serve(stack, loop)
            self._hold()
            stack.enter_context(conditions)
            loop.is_over = self.verdict.is_over
            advance = self._watched(loop, interrupts, watchers) if request.watch else loop.run
            try:
                advance(duration)
            except BaseException as error:
                self.verdict.end(error, "")
                raise
            else:
                self.verdict.end(None, _who_ended(interrupts, loop))
            finally:
                elapsed = watch.elapsed
                progress.__exit__(None, None, None)
                if recording is not None:
                    recording.close()
                summarise(sim, counter, recording, elapsed, quiet=request.quiet)
                self.verdict.tell()
        if driven is not None and request.picture is not None:
            draw(sim, request.picture, driven)
        return interrupts.exit_code or self.verdict.code

    # ------------------------------------------------------------------ who drives

    def _commands(self) -> list[Any]:
        from simkit.sinks.commands import read_script, steady_velocity

        topics = self.sim.topics()
        found = []
        if self.request.cmd_vel is not None:
            found.append(steady_velocity(self.request.cmd_vel, topics))
        if self.request.script is not None:
            found += read_script(self.request.script, topics)
        return found

    def _played(self) -> Playback | None:
        """The commands of the recording that is named, where one is."""
        from simkit.sinks.playback import Playback

        if self.request.play is None:
            if self.request.play_topics:
                raise InputError("SK-CLI-018 --play-topic: found no --play BAG beside it", "SK-CLI-018")
            return None
        played = Playback(self.sim, self.request.play, self.request.play_topics)
        for note in played.notes:
            say(f"note: {note}")
        said = [old if old == new else f"{old} on {new}" for old, new in played.names.items()]
        say(f"playing {', '.join(said)} of {self.request.play}")
        return played

    def _driver(self) -> Teleop | None:
        from simkit.cli.driving.target import find_target
        from simkit.cli.driving.teleop import Teleop

        if self.request.teleop is None:
            return None
        return Teleop(self.sim, find_target(self.sim, self.request.teleop), self.request.key_timeout)

    def _keyboard(self) -> Keyboard | WindowsKeyboard | None:
        """The terminal's, where somebody drives or sees what keys do: a pager that shows our output has its own."""
        from simkit.cli.driving.keyboard import keyboard_of

        if self._teleop is None and (sys.stdout is None or sys.stdout.closed or not sys.stdout.isatty()):
            return None
        return keyboard_of(sys.stdin)

    def _listen_to(self, keyboard: Keyboard | WindowsKeyboard, loop: Loop) -> None:
        """Lets keys pause, step and drive the run."""
        from simkit.cli.running.keys import RunKeys

        keys = RunKeys(self.sim, keyboard, self._teleop)
        loop.poll_keys, loop.on_pause = keys.poll, keys.say_paused
        if self._teleop is not None:
            loop.senders.append(self._teleop)

    def _progress(self, counter: TopicCounter, duration: float | None) -> Progress:
        from simkit.cli.driving.line import DriverLine
        from simkit.sinks.progress import Progress

        if self._teleop is None:
            return Progress(self.sim, counter, duration, out())
        console = out() if out().is_terminal else err()
        return Progress(self.sim, counter, duration, console, DriverLine(self.sim, self._teleop).lines)

    def _hold(self) -> None:
        """Has the run begin paused, or be so after some steps."""
        if self.request.step is not None:
            self.sim.pausing.step(self.request.step)
        elif self.request.paused:
            self.sim.paused = True

    # ------------------------------------------------------------------ who looks on

    def _open_viewer(self, stack: ExitStack, loop: Loop, watchers: list[Any]) -> None:
        from simkit.sinks.viewer import Viewer

        viewer = stack.enter_context(Viewer(self.sim))
        watchers.append(viewer.update)
        loop.keep_going = viewer.is_open

    def _serve(self, stack: ExitStack, loop: Loop) -> None:
        """Lets other terminals talk to the run."""
        from simkit.live.server import serve

        name = self.request.name
        if name is None and self.sim.world.name == "default":  # a bare model's, and many a world's
            name = Path(self.request.world).name.partition(".")[0] or None
        loop.server, note = serve(self.sim, name)
        if loop.server is None:
            say(note)
        else:
            stack.enter_context(loop.server)

    def _watched(self, loop: Loop, interrupts: Interrupts, watchers: list[Any]) -> Callable[[float | None], Any]:
        """The same loop, which reloads plugins that are edited."""
        from simkit.cli.running.watch import Watch

        watch = Watch(self.sim, self.request.plugin_paths, interrupts, waits=self.request.record is None)
        watchers.append(watch.poll)
        loop.before_slice = watch.keep
        return partial(watch.run, loop)
