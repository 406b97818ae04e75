"""`simkit run`: a world, headless, as fast as it goes."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Annotated, Any

import typer
from typer import Option
from typer.core import TyperCommand

from simkit.cli.failure_bundle import DEFAULT_FOLDER as BUNDLES
from simkit.cli.failure_bundle import FailureBundle
from simkit.cli.run_options import RunDisplay, load_options
from simkit.cli.terminal import options
from simkit.cli.terminal.blocked_plugins import BlockedPlugins
from simkit.cli.terminal.options import option
from simkit.cli.terminal.output import print_diagnostics, print_status, report_errors
from simkit.cli.terminal.teleop import KEY_TIMEOUT
from simkit.run_spec import Check, PluginErrorPolicy, Recording, RunSpec

_TIME = re.compile(r"(\d+\.?\d*|\.\d+)\s*(s|ms|min|)")
_UNITS = {"": 1.0, "s": 1.0, "ms": 1e-3, "min": 60.0}
_TOPIC = re.compile(r"/[A-Za-z0-9_/]*")


class RunCommand(TyperCommand):
    """Options that take a value or none: `--teleop` and `--bundle-on-failure`.

    `--teleop` takes the topic after it, where that is one: a word that begins with a slash and names no file.
    `--bundle-on-failure` takes the folder after it, where that is one: it is there or ends with a slash, or the world
    has been named before.
    """

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Gives both the value that they have without one."""
        given: list[str] = []
        for at, word in enumerate(args):
            if word == "--":
                given += args[at:]
                break
            if word == "--teleop":
                follows = args[at + 1] if at + 1 < len(args) else ""
                if not _TOPIC.fullmatch(follows) or Path(follows).exists():
                    word = "--teleop="
            if word == "--bundle-on-failure":
                follows = args[at + 1] if at + 1 < len(args) else ""
                is_folder = follows.endswith("/") or Path(follows or "-").is_dir() or args[0][0:1] != "-"
                if follows.startswith("-") or not follows or not is_folder:
                    word = f"--bundle-on-failure={BUNDLES}"
            given.append(word)
        return super().parse_args(ctx, given)


COMMAND = RunCommand


def _seconds(text: str) -> float:
    """A time: `30`, `30s`, `500ms` or `2min`."""
    match = _TIME.fullmatch(text.strip())
    if match is None or not float(match[1]) > 0:
        raise typer.BadParameter(f"{text!r} is no time; allowed are seconds greater than 0, as 30, 30s, 500ms or 2min")
    return float(match[1]) * _UNITS[match[2]]


@report_errors
def run(
    world: options.World,
    duration: Annotated[float | None, option("Simulated seconds; until Ctrl-C where not given.", "S", min=0)] = None,
    seed: Annotated[int, option("Seed of all noise.", "N", min=0)] = 0,
    record: Annotated[Path | None, option("Writes all topics: x.mcap one file, else a rosbag2 folder.", "OUT")] = None,
    topic: Annotated[list[str], option("Records only topics of this pattern; repeatable.", "PATTERN")] = [],
    skip: Annotated[list[str], option("Records all but topics of this pattern; repeatable.", "PATTERN")] = [],
    force: options.Force = False,
    rtf: Annotated[
        float | None, option("No faster than X times real time; 1 with --teleop and --view.", "X", min=1e-3)
    ] = None,
    teleop: Annotated[str | None, option("Drives with the keyboard: who takes velocities there.", "[TOPIC]")] = None,
    key_timeout: Annotated[
        float, option("--teleop stops after so many simulated seconds without a key; inf: never.", "S")
    ] = KEY_TIMEOUT,
    paused: Annotated[bool, Option("--paused", help="Begins paused; space or a service lets it go on.")] = False,
    step: Annotated[int | None, option("Does N steps, then is paused.", "N", min=0)] = None,
    name: Annotated[
        str | None, option("What other terminals call this run; else the world's or file's name.", "NAME")
    ] = None,
    set_: options.Overrides = [],
    spawn: options.Spawns = [],
    params_file: options.ParamsFiles = [],
    strict: options.Strict = False,
    view: Annotated[bool, Option("--view", help="Opens a viewer.")] = False,
    picture: Annotated[Path | None, option("Draws the scene at the end, with path and last scan.", "OUT.png")] = None,
    cmd_vel: options.CmdVel = None,
    script: options.Script = None,
    play: Annotated[Path | None, option("Commands of a recording, at their ticks; runs as long.", "BAG")] = None,
    play_topic: Annotated[
        list[str], option("Plays only this topic, or it on another one; repeatable.", "TOPIC[:=NEW]", "--play-topic")
    ] = [],
    resource_path: options.ResourcePaths = [],
    package_path: options.PackagePaths = [],
    plugin_path: options.PluginPaths = [],
    watch: Annotated[bool, Option("--watch", help="Reloads a plugin whose file is edited, and goes on.")] = False,
    xacro_arg: options.XacroArgs = [],
    base: options.Base = "auto",
    on_plugin_error: Annotated[
        str | None,
        option(
            "What becomes of a plugin that raises: stop ends the run (exit 4), disable goes on without it.",
            "stop|disable",
        ),
    ] = None,
    bundle_on_failure: Annotated[
        Path | None,
        option(
            "Where the run fails: writes it into one file there, which simkit replay repeats; else bundles/.", "[DIR]"
        ),
    ] = None,
    verbose: options.Verbose = False,
    quiet: Annotated[bool, Option("--quiet", "-q", help="One line at the end, no table of topics.")] = False,
    until: Annotated[str | None, option("Ends as soon as this holds: \"pose('tb3').x > 2\".", "EXPR")] = None,
    timeout: Annotated[
        float | None, option("Simulated time by which --until must hold, else exit 5.", "S", parser=_seconds)
    ] = None,
    wall_timeout: Annotated[
        float | None, option("Wall time after which the run is given up, exit 5.", "S", parser=_seconds)
    ] = None,
    assert_: Annotated[list[str], option("Must hold at the end, else exit 5; repeatable.", "EXPR", "--assert")] = [],
    junit: Annotated[Path | None, option("Writes what held and what did not, for a CI.", "FILE.xml")] = None,
) -> int:
    """Runs a world headless, as fast as it goes."""
    spec = RunSpec(
        world,
        duration=duration if duration is not None and math.isfinite(duration) else math.inf,
        seed=seed,
        name=name or "",
        overrides=tuple(set_),
        spawn=tuple(spawn),
        topics=tuple(topic),
        skip=tuple(skip),
        until=_expression(until),
        timeout=_until_when(timeout, until),
        wall_timeout=wall_timeout,
        checks=tuple(Check("final", expression=expression, where="--assert") for expression in assert_),
        options=load_options(
            resource_path,
            package_path,
            xacro_arg,
            base,
            plugin_path,
            params_file,
            on_error=_on_error(on_plugin_error),
            strict=strict,
        ),
        play="" if play is None else str(play),
        play_topics=tuple(play_topic),
        velocity=cmd_vel,
        script=script,
        recording=None if record is None else Recording(record, overwrite=force),
        pace=highest_pace(rtf, is_watched=view or teleop is not None),
        paused=paused,
        steps=step,
    )
    key_timeout = _timeout(key_timeout)
    display = RunDisplay(view, picture, teleop, key_timeout, verbose, quiet, watch, junit, bundle_on_failure)
    return execute(spec, display)


def _on_error(word: str | None) -> PluginErrorPolicy | None:
    """The word as one of those that are allowed."""
    if word not in (None, "stop", "disable"):
        raise typer.BadParameter(f"{word!r} is not stop or disable", param_hint="--on-plugin-error")
    return word  # type: ignore[return-value]


def _timeout(seconds: float) -> float:
    """A time to wait that is one."""
    if not seconds > 0:
        raise typer.BadParameter(f"{seconds} is not greater than 0", param_hint="--key-timeout")
    return seconds


def _expression(until: str | None) -> str:
    """A condition; an empty one is a variable of a script that was not set, and asks for nothing by mistake."""
    if until is not None and not until.strip():
        raise typer.BadParameter("an expression is empty", param_hint="--until")
    return until or ""


def _until_when(timeout: float | None, until: str | None) -> float | None:
    """The time by which a condition must hold."""
    if timeout is not None and not until:
        message = "there is no --until to wait for; --duration S ends a run by itself"
        raise typer.BadParameter(message, param_hint="--timeout")
    return timeout


def highest_pace(rtf: float | None, *, is_watched: bool) -> float | None:
    """Return the highest real-time factor, None for none: real time for those who watch or drive and say nothing."""
    if rtf is None:
        return 1.0 if is_watched else None
    return rtf if math.isfinite(rtf) else None


def execute(spec: RunSpec, display: RunDisplay) -> int:
    """Runs what is asked for; returns the exit code.

    Raises:
        SimkitError: what went wrong; the recording up to there is complete by then.
    """
    from simkit.bridges import viewer
    from simkit.build import load
    from simkit.cli.run_session import Session, check_keyboard
    from simkit.cli.run_verdict import RunVerdict
    from simkit.recording import run_picture
    from simkit.recording.bags import recorder
    from simkit.scene.overrides import check_used

    if spec.recording is not None:
        recorder.check_target(spec.recording.path, overwrite=spec.recording.overwrite)
    if display.picture is not None:
        run_picture.check_target(display.picture)
    if display.view:
        viewer.check_possible()
    check_keyboard(display)
    with (
        RunVerdict(spec, display.junit) as verdict,
        BlockedPlugins(print_status) as blocked,
        FailureBundle(display.bundles, verdict, spec) as bundling,
    ):
        sim = load(spec.world, **spec.load_arguments())
        with sim:
            bundling.keep(sim)
            check_used(sim.diagnostics)
            print_diagnostics(sim.diagnostics, verbose=display.verbose)
            verdict.code = Session(spec, display, sim, blocked, verdict).execute()
    return verdict.code
