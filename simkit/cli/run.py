"""`simkit run`: a world, headless, as fast as it goes."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperCommand

from simkit.cli.console import guarded, print_diagnostics, say
from simkit.cli.driving.teleop import KEY_TIMEOUT
from simkit.cli.options import (
    Base,
    Force,
    PackagePaths,
    ParamsFiles,
    PluginPaths,
    ResourcePaths,
    Strict,
    Verbose,
    World,
    XacroArgs,
    source,
)
from simkit.cli.running.request import OnError, Request
from simkit.sinks.blocked import BlockedPlugins

_TOPIC = re.compile(r"/[A-Za-z0-9_/]*")


class RunCommand(TyperCommand):
    """`--teleop` takes the topic after it, where that is one: a word that begins with a slash and names no file."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Gives `--teleop` the value that it has without a topic."""
        given: list[str] = []
        for at, word in enumerate(args):
            if word == "--":
                given += args[at:]
                break
            if word == "--teleop":
                follows = args[at + 1] if at + 1 < len(args) else ""
                if not _TOPIC.fullmatch(follows) or Path(follows).exists():
                    word = "--teleop="
            given.append(word)
        return super().parse_args(ctx, given)


COMMAND = RunCommand


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
    rtf: Annotated[
        float | None,
        typer.Option(help="No faster than X times real time; 1 with --teleop and --view.", metavar="X", min=1e-3),
    ] = None,
    teleop: Annotated[
        str | None, typer.Option(help="Drives with the keyboard: who takes velocities there.", metavar="[TOPIC]")
    ] = None,
    key_timeout: Annotated[
        float,
        typer.Option(help="--teleop stops after so many simulated seconds without a key; inf: never.", metavar="S"),
    ] = KEY_TIMEOUT,
    paused: Annotated[bool, typer.Option("--paused", help="Begins paused; space or a service lets it go on.")] = False,
    step: Annotated[int | None, typer.Option(help="Does N steps, then is paused.", metavar="N", min=0)] = None,
    name: Annotated[
        str | None,
        typer.Option(help="What other terminals call this run; else the world's or file's name.", metavar="NAME"),
    ] = None,
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
        world, _finite(duration), seed, record, tuple(topic), tuple(skip), force, rtf, tuple(set_), strict,
        view, picture, cmd_vel, script, tuple(plugin_path), _on_error(on_plugin_error), verbose, quiet, watch,
        tuple(spawn), tuple(params_file), name, teleop, _timeout(key_timeout), paused, step,
        source(resource_path, package_path, xacro_arg, base),
    )  # fmt: skip
    return execute(request)


def _on_error(word: str | None) -> OnError | None:
    """The word as one of those that are allowed."""
    if word not in (None, "stop", "disable"):
        raise typer.BadParameter(f"{word!r} is not stop or disable", param_hint="--on-plugin-error")
    return word  # type: ignore[return-value]


def _timeout(seconds: float) -> float:
    """A time to wait that is one."""
    if not seconds > 0:
        raise typer.BadParameter(f"{seconds} is not greater than 0", param_hint="--key-timeout")
    return seconds


def _finite(number: float | None) -> float | None:
    """An infinite duration is none: until Ctrl-C."""
    return number if number is None or math.isfinite(number) else None


def execute(request: Request) -> int:
    """Does what is asked for; returns the exit code.

    Raises:
        SimkitError: what went wrong; the recording up to there is complete by then.
    """
    from simkit.build import load
    from simkit.cli.running.session import Session, check_keyboard
    from simkit.overrides import check_used
    from simkit.sinks import picture, recorder, viewer

    if request.record is not None:
        recorder.check_target(request.record, overwrite=request.force)
    if request.picture is not None:
        picture.check_target(request.picture)
    if request.view:
        viewer.check_possible()
    check_keyboard(request)
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
            return Session(request, sim, blocked).execute()
