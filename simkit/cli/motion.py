"""The command `simkit motion`: list the named motions of a robot and play them."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Argument, Option

from simkit.cli.terminal import options
from simkit.cli.terminal.options import argument, option
from simkit.cli.terminal.output import print_diagnostics, print_status, report_errors, stdout_console
from simkit.diagnostics import Diagnostics
from simkit.errors import InputError, RenderError

if TYPE_CHECKING:
    from simkit.plugins.play_motion.motion import Motion
    from simkit.runtime import Model, Simulation

motion = typer.Typer(help="Lists the motions that a robot knows by name, and plays them.", no_args_is_help=True)

ROBOT = "tiago"
Motions = Annotated[
    list[Path], option("One more file of motions, play_motion's or play_motion2's.", "FILE.yaml", "--motions")
]
OfModel = Annotated[str | None, option("Which robot, where several play.", "NAME", "--model")]


@motion.command("list")
@report_errors
def list_motions(
    file: Annotated[str, Argument(help="A robot, a world with one, or a file of motions.", metavar="[FILE]")] = ROBOT,
    motions: Motions = [],
    model: OfModel = None,
    json_: options.Json = False,
    resource_path: options.ResourcePaths = [],
    package_path: options.PackagePaths = [],
    plugin_path: options.PluginPaths = [],
    xacro_arg: options.XacroArgs = [],
) -> None:
    """Lists motions: joints, points, how long each takes, and what it is for."""
    if Path(file).suffix.lower() in (".yaml", ".yml"):
        found = _read_motions([Path(file), *motions])
    else:
        from simkit.plugins.play_motion.motion_session import choose_player, motion_players

        source = options.source_arguments(resource_path, package_path, xacro_arg)
        with _open_world(file, None, motions, 0, plugin_path, source, verbose=False) as sim:
            found = list(choose_player(motion_players(sim), model).motions.values())
    if json_:
        shown = [{**one.as_message(), "duration": one.duration, "file": one.where.file} for one in found]
        stdout_console().file.write(json.dumps(shown, indent=2) + "\n")
        return
    rows = [
        (
            one.key,
            f"{one.duration:g} s",
            f"{len(one.times)} point{'s' * (len(one.times) > 1)}",
            _joint_ranges(one.joints),
        )
        for one in found
    ]
    widths = [max((len(row[k]) for row in rows), default=0) for k in range(4)]
    for one, row in zip(found, rows, strict=True):
        columns = "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True))
        stdout_console().print(f"{columns}  {one.description}".rstrip())


@motion.command("play")
@report_errors
def play(
    names: Annotated[list[str], argument("Motions, played one after another.", "MOTION...")],
    world: Annotated[str | None, option("Where: a file or a bare name; level ground otherwise.", "WORLD")] = None,
    robot: Annotated[
        str | None, option(f"Who: a file or a bare name; {ROBOT} where no world is given.", "MODEL")
    ] = None,
    motions: Motions = [],
    model: OfModel = None,
    skip_planning: Annotated[
        bool, Option("--skip-planning", help="Does not look whether anything is in the way.")
    ] = False,
    seed: Annotated[int, option("Seed of all noise.", "N", min=0)] = 0,
    record: Annotated[Path | None, option("Writes all topics: x.mcap one file, else a rosbag2 folder.", "OUT")] = None,
    force: options.Force = False,
    picture: Annotated[Path | None, option("Draws the scene at the end.", "OUT.png")] = None,
    json_: options.Json = False,
    verbose: options.Verbose = False,
    resource_path: options.ResourcePaths = [],
    package_path: options.PackagePaths = [],
    plugin_path: options.PluginPaths = [],
    xacro_arg: options.XacroArgs = [],
    params_file: options.ParamsFiles = [],
) -> None:
    """Plays motions: the way to the first point no faster than is safe, then as the file has it."""
    from simkit.plugins.play_motion.motion_session import choose_player, motion_players, play_motions
    from simkit.recording import run_picture as pictures
    from simkit.recording.bags import recorder

    if picture is not None:
        pictures.check_target(picture)
    if record is not None:
        recorder.check_target(record, overwrite=force)
    source: Any = {**options.source_arguments(resource_path, package_path, xacro_arg), "params_files": params_file}
    shown = []
    with ExitStack() as stack:
        sim = stack.enter_context(_open_world(world, robot, motions, seed, plugin_path, source, verbose=verbose))
        if record is not None:
            stack.enter_context(recorder.Recorder(sim, record, overwrite=force))
        for played in play_motions(sim, choose_player(motion_players(sim), model), names, skip_planning=skip_planning):
            joint, off = played.furthest
            key = played.motion.key
            shown.append({"motion": key, "duration": round(played.duration, 6), "joint": joint, "off": off})
            if not json_:
                stdout_console().print(f"{key}: done in {played.duration:.2f} s; {joint} is {abs(off):.2g} off")
        if picture is not None:
            _draw(sim, picture)
    if json_:
        stdout_console().file.write(json.dumps(shown, indent=2) + "\n")


def _open_world(
    world: str | None,
    robot: str | None,
    motions: Sequence[Path],
    seed: int,
    plugin_paths: Sequence[Path],
    source: Any,
    *,
    verbose: bool,
) -> Simulation:
    """The world with its robot, ready to play; further motions are known by then."""
    from simkit.build import load
    from simkit.plugins.play_motion.motion_session import controlled_models, empty_world_with, motion_players
    from simkit.plugins.play_motion.play_motion_plugin import PlayMotion

    _check_files(motions)
    text = world
    if text is None:
        text, folders = empty_world_with(robot or ROBOT)
        source = {**source, "resource_paths": [*source["resource_paths"], *folders]}
    sim = load(text, seed=seed, plugin_paths=plugin_paths, **source)
    spawned = _spawn_robot(sim, robot) if world is not None and robot is not None else None
    there = motion_players(sim)
    for player in there.values():
        for path in motions:
            player.read(path)
    if motions and not there:
        hosts = controlled_models(sim)
        sim.close()
        if len(hosts) != 1 or spawned is not None:
            what = f"here are {len(hosts)} of them" if spawned is None else "put the robot into the world's file"
            message = f"SK-MOTION-010 --motions is for the one robot that a controller manager moves; {what}"
            raise InputError(message, "SK-MOTION-010")
        made = PlayMotion(motions=[str(path.resolve()) for path in motions])
        sim = load(text, seed=seed, plugin_paths=plugin_paths, plugins=[(hosts[0], made)], **source)
    print_diagnostics(sim.diagnostics, verbose=verbose)
    return sim


def _read_motions(paths: Sequence[Path]) -> list[Motion]:
    """The motions of files, without a robot."""
    from simkit.plugins.play_motion.motion_files import read_motions

    _check_files(paths)
    problems = Diagnostics()
    found: dict[str, Motion] = {}
    for path in paths:
        found.update(read_motions(path, problems).motions)
    problems.raise_if_errors()
    print_diagnostics(problems, verbose=False)
    return list(found.values())


def _check_files(paths: Sequence[Path]) -> None:
    """Raises where a file of motions is not there, or broken: what it says is not to be missed."""
    from simkit.plugins.play_motion.motion_files import read_motions

    broken = Diagnostics()
    for path in paths:
        if not path.is_file():
            raise InputError(f"SK-MOTION-001 there is no file of motions {path}", "SK-MOTION-001")
        read_motions(path, broken)
    broken.raise_if_errors()


def _spawn_robot(sim: Simulation, robot: str) -> Model:
    """The robot, put into a world that may have it already."""
    from simkit.plugins.play_motion.motion_session import motion_players

    there = [scoped for scoped in motion_players(sim) if scoped == Path(robot).stem]
    if there:
        message = f"SK-MOTION-010 the world has a robot {there[0]!r} already; leave --robot out"
        raise InputError(message, "SK-MOTION-010")
    return sim.spawn(robot)


def _joint_ranges(names: Sequence[str]) -> str:
    """Joints in short: `arm_1_joint` to `arm_7_joint` are `arm_1-7`."""
    short: list[tuple[str, int | None, int | None]] = []
    for name in names:
        stem = name.removesuffix("_joint")
        match = re.fullmatch(r"(.*_)(\d+)", stem)
        if match is None:
            short.append((stem, None, None))
            continue
        prefix, number = match[1], int(match[2])
        if short and short[-1][0] == prefix and short[-1][2] == number - 1:
            short[-1] = (prefix, short[-1][1], number)
        else:
            short.append((prefix, number, number))
    return ", ".join(
        stem if first is None else f"{stem}{first}" + (f"-{last}" if last != first else "")
        for stem, first, last in short
    )


def _draw(sim: Simulation, path: Path) -> None:
    from simkit.build import render_view
    from simkit.recording.run_picture import save_picture

    try:
        save_picture(sim, path, render_view)
    except RenderError as error:
        print_status(f"warning: no picture: {error}")
    else:
        stdout_console().print(f"picture {path}")
