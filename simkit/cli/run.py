"""`simkit run`: a world, headless, as fast as it goes."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from simkit.cli.console import err, guarded, out, print_diagnostics, say
from simkit.cli.interrupts import Interrupts
from simkit.cli.loop import Loop
from simkit.cli.options import (
    Base,
    Force,
    PackagePaths,
    ParamsFiles,
    PluginPaths,
    ResourcePaths,
    Source,
    Strict,
    Verbose,
    World,
    XacroArgs,
    source,
)
from simkit.errors import RenderError
from simkit.sinks.blocked import BlockedPlugins

if TYPE_CHECKING:
    from simkit.sinks.recorder import Recorder
    from simkit.sinks.topic_counts import TopicCounter


OnError = Literal["stop", "disable"]


@dataclass(frozen=True)
class Request:
    """What a run is to do; one field an option."""

    world: str
    duration: float | None = None
    seed: int = 0
    record: Path | None = None
    topics: tuple[str, ...] = ()
    skip: tuple[str, ...] = ()
    force: bool = False
    rtf: float | None = None
    overrides: tuple[str, ...] = ()
    strict: bool = False
    view: bool = False
    picture: Path | None = None
    cmd_vel: str | None = None
    script: Path | None = None
    plugin_paths: tuple[Path, ...] = ()
    on_plugin_error: OnError | None = None
    verbose: bool = False
    quiet: bool = False
    watch: bool = False
    spawn: tuple[str, ...] = ()
    params_files: tuple[str, ...] = ()
    source: Source = field(default_factory=lambda: source((), (), ()))


@guarded
def run(
    world: World,
    duration: Annotated[
        float | None, typer.Option(help="Simulated seconds; until Ctrl-C where not given.", metavar="S", min=0)
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of all noise.", metavar="N", min=0)] = 0,
    record: Annotated[
        Path | None, typer.Option(help="Writes all topics: x.mcap one file, else a rosbag2 folder.", metavar="OUT")
    ] = None,
    topic: Annotated[
        list[str], typer.Option(help="Records only topics of this pattern; repeatable.", metavar="PATTERN")
    ] = [],
    skip: Annotated[
        list[str], typer.Option(help="Records all but topics of this pattern; repeatable.", metavar="PATTERN")
    ] = [],
    force: Force = False,
    rtf: Annotated[float | None, typer.Option(help="No faster than X times real time.", metavar="X", min=1e-3)] = None,
    set_: Annotated[
        list[str],
        typer.Option("--set", help="Changes one value: scoped::name.element=VALUE; repeatable.", metavar="PATH=VALUE"),
    ] = [],
    spawn: Annotated[
        list[str],
        typer.Option(help="Puts a model into the world, by name or file; repeatable.", metavar="MODEL:x,y,yaw[:name]"),
    ] = [],
    params_file: ParamsFiles = [],
    strict: Strict = False,
    view: Annotated[bool, typer.Option("--view", help="Opens a viewer.")] = False,
    picture: Annotated[
        Path | None, typer.Option(help="Draws the scene at the end, with path and last scan.", metavar="OUT.png")
    ] = None,
    cmd_vel: Annotated[
        str | None, typer.Option(help="Sends one velocity: m/s forward, rad/s to the left.", metavar="V,W")
    ] = None,
    script: Annotated[Path | None, typer.Option(help="Commands over time.", metavar="FILE.yaml")] = None,
    resource_path: ResourcePaths = [],
    package_path: PackagePaths = [],
    plugin_path: PluginPaths = [],
    watch: Annotated[bool, typer.Option("--watch", help="Reloads a plugin whose file is edited, and goes on.")] = False,
    xacro_arg: XacroArgs = [],
    base: Base = "auto",
    on_plugin_error: Annotated[
        str | None,
        typer.Option(
            help="What becomes of a plugin that raises: stop ends the run (exit 4), disable goes on without it.",
            metavar="stop|disable",
        ),
    ] = None,
    verbose: Verbose = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="One line at the end, no table of topics.")] = False,
) -> int:
    """Runs a world headless, as fast as it goes."""
    request = Request(
        world, _finite(duration), seed, record, tuple(topic), tuple(skip), force, _finite(rtf), tuple(set_), strict,
        view, picture, cmd_vel, script, tuple(plugin_path), _on_error(on_plugin_error), verbose, quiet, watch,
        tuple(spawn), tuple(params_file), source(resource_path, package_path, xacro_arg, base),
    )  # fmt: skip
    return execute(request)


def _on_error(word: str | None) -> OnError | None:
    """The word as one of those that are allowed."""
    if word not in (None, "stop", "disable"):
        raise typer.BadParameter(f"{word!r} is not stop or disable", param_hint="--on-plugin-error")
    return word  # type: ignore[return-value]


def _finite(number: float | None) -> float | None:
    """An infinite duration or real-time factor is none: until Ctrl-C, as fast as it goes."""
    return number if number is None or math.isfinite(number) else None


def execute(request: Request) -> int:
    """Does what is asked for; returns the exit code.

    Raises:
        SimkitError: what went wrong; the recording up to there is complete by then.
    """
    from simkit.build import load
    from simkit.overrides import check_used
    from simkit.sinks import picture, recorder, viewer

    if request.record is not None:
        recorder.check_target(request.record, overwrite=request.force)
    if request.picture is not None:
        picture.check_target(request.picture)
    if request.view:
        viewer.check_possible()
    with BlockedPlugins(say) as blocked:
        sim = load(
            request.world,
            seed=request.seed,
            plugin_paths=request.plugin_paths,
            strict=request.strict,
            overrides=request.overrides,
            on_error=request.on_plugin_error,
            spawn=request.spawn,
            params_files=request.params_files,
            **request.source,
        )
        with sim:
            check_used(sim.diagnostics)
            print_diagnostics(sim.diagnostics, verbose=request.verbose)
            return _Run(request, sim, blocked).execute()


class _Run:
    """One run of a loaded world."""

    def __init__(self, request: Request, sim: Any, blocked: BlockedPlugins) -> None:
        self.request, self.sim, self.blocked = request, sim, blocked

    def execute(self) -> int:
        from simkit.sinks.commands import Commands
        from simkit.sinks.picture import DrivenPath
        from simkit.sinks.progress import Progress, Stopwatch
        from simkit.sinks.recorder import Recorder
        from simkit.sinks.topic_counts import RENDERED, TopicCounter

        request, sim = self.request, self.sim
        commands = Commands(sim, self._commands())
        if request.duration is None:
            say("running until Ctrl-C (--duration S stops by itself)")
        driven = DrivenPath(sim) if request.picture is not None else None
        with ExitStack() as stack:
            interrupts = stack.enter_context(Interrupts(self.blocked.ask))
            recording = None
            if request.record is not None:
                recording = stack.enter_context(
                    Recorder(sim, request.record, overwrite=request.force, topics=request.topics, skip=request.skip)
                )
            counter = TopicCounter(sim, RENDERED, recording.records if recording is not None else None)
            watch = Stopwatch()
            progress = stack.enter_context(Progress(sim, counter, request.duration, out()))
            watchers: list[Any] = [progress.update]
            if recording is not None:
                watchers.append(recording.check)
            if driven is not None:
                watchers.append(driven.sample)
            rtf = request.rtf if request.rtf is not None or not request.view else 1.0
            loop = Loop(sim, commands, interrupts, watchers, rtf=rtf, follow=driven is not None)
            if request.view:
                self._open_viewer(stack, loop, watchers)
            advance = self._watched(loop, interrupts, watchers) if request.watch else loop.run
            try:
                advance(request.duration)
            finally:
                elapsed = watch.elapsed
                progress.__exit__(None, None, None)
                if recording is not None:
                    recording.close()
                self._summarise(counter, recording, elapsed)
        if driven is not None:
            self._draw(driven)
        return interrupts.exit_code

    def _commands(self) -> list[Any]:
        from simkit.sinks.commands import read_script, steady_velocity

        topics = self.sim.topics()
        found = []
        if self.request.cmd_vel is not None:
            found.append(steady_velocity(self.request.cmd_vel, topics))
        if self.request.script is not None:
            found += read_script(self.request.script, topics)
        return found

    def _open_viewer(self, stack: ExitStack, loop: Loop, watchers: list[Any]) -> None:
        from simkit.sinks.viewer import Viewer

        viewer = stack.enter_context(Viewer(self.sim))
        watchers.append(viewer.update)
        loop.keep_going = viewer.is_open

    def _watched(self, loop: Loop, interrupts: Interrupts, watchers: list[Any]) -> Callable[[float | None], Any]:
        """The same loop, which reloads plugins that are edited."""
        from simkit.cli.run_watch import Watch

        watch = Watch(self.sim, self.request.plugin_paths, interrupts, waits=self.request.record is None)
        watchers.append(watch.poll)
        loop.before_slice = watch.keep
        return partial(watch.run, loop)

    def _summarise(self, counter: TopicCounter, recording: Recorder | None, elapsed: float) -> None:
        """Topics with their true rates, then one line, then the hash of the physics state."""
        from simkit.sinks.progress import rate_text

        sim = self.sim
        if not self.request.quiet and counter.rows:
            width = max(len(row.topic) for row in counter.rows)
            for row in counter.rows:
                out().print(f"{row.topic:<{width}}  {row.count:>8}  {rate_text(row):>12}  {row.type_name}")
        factor = sim.time / max(elapsed, 1e-9)
        line = (
            f"simulated {sim.time:.3f} s in {elapsed:.2f} s ({factor:.2f} × real time), {counter.total} messages read"
        )
        if recording is not None:
            line += f"; {recording.message_count} in {recording.path}"
        out().print(line)
        out().print(f"state {state_hash(sim)}")

    def _draw(self, driven: Any) -> None:
        from simkit.build import render_view
        from simkit.sinks.picture import save_picture

        path = self.request.picture
        assert path is not None
        try:
            save_picture(self.sim, path, render_view, driven)
        except RenderError as error:
            err().print(f"warning: no picture: {error}", style="yellow")
        else:
            out().print(f"picture {path}")


def state_hash(sim: Any) -> str:
    """SHA-256 of positions and velocities, as bits: equal for two runs that did the same."""
    digest = hashlib.sha256()
    digest.update(sim.mj_data.qpos.tobytes())
    digest.update(sim.mj_data.qvel.tobytes())
    return digest.hexdigest()
