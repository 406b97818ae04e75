"""List and play the named motions of a robot."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer
from typer import Argument, Option

from simkit import progress
from simkit.cli.run_options import NONE_GIVEN
from simkit.cli.terminal import completion, options
from simkit.cli.terminal.output import print_diagnostics, print_json, stdout_console
from simkit.errors import InputError
from simkit.extend import Diagnostics, GivenOptions, argument, option, report_errors, with_run_options
from simkit.run_fields import LoadArguments

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit_motion.plugins.play_motion.motion import Motion

motion = typer.Typer(help="List and play the named motions of a robot.", no_args_is_help=True)

ROBOT = "tiago"
SPEED_SCALE = "control_msgs/msg/SpeedScalingFactor"
Motions = Annotated[
    list[Path], option("Additional motion file (play_motion or play_motion2); repeatable.", "FILE.yaml", "--motions")
]
OfModel = Annotated[str | None, option("Robot that plays the motions, if the world has several.", "NAME", "--model")]


@completion.silent
def motion_names(ctx: typer.Context) -> Iterable[str]:
    """Complete the motions of the robot that the line names, or of the default robot."""
    from simkit_motion.plugins.play_motion.motion_session import choose_player, motion_players

    world, robot, motions, model = (ctx.params.get(name) for name in ("world", "robot", "motions", "model"))
    with _open_world(world, robot, motions or (), {}, verbose=False) as sim:
        return list(choose_player(motion_players(sim), model).motions)


@motion.command("list")
@report_errors
@with_run_options("file", "plugin_paths", without={"base": "motions do not depend on the base"})
def list_motions(
    file: Annotated[
        str,
        Argument(help="Robot, world with a robot, or motion file.", metavar="[FILE]", autocompletion=completion.worlds),
    ] = ROBOT,
    motions: Motions = [],
    model: OfModel = None,
    json_: options.Json = False,
    given: GivenOptions = NONE_GIVEN,
) -> None:
    """List motions: name, duration, points, joints and description."""
    if Path(file).suffix.lower() in (".yaml", ".yml"):
        motion_list = _read_motions([Path(file), *motions])
    else:
        from simkit_motion.plugins.play_motion.motion_session import choose_player, motion_players

        with _open_world(file, None, motions, given.load_arguments(), verbose=False) as sim:
            motion_list = list(choose_player(motion_players(sim), model).motions.values())
    if json_:
        shown = [{**m.as_message(), "duration": m.duration, "file": m.where.file} for m in motion_list]
        print_json(shown, indent=2)
        return
    rows = [
        (m.key, f"{m.duration:g} s", f"{len(m.times)} point{'s' * (len(m.times) > 1)}", _joint_ranges(m.joints))
        for m in motion_list
    ]
    widths = [max((len(row[k]) for row in rows), default=0) for k in range(4)]
    for entry, row in zip(motion_list, rows, strict=True):
        columns = "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True))
        stdout_console().print(f"{columns}  {entry.description}".rstrip())


@motion.command("play")
@report_errors
@with_run_options(
    *("file", "world"),
    without={
        "base": "the robot stands in a world",
        "model_world": "--world is the world of the robot",
        "run": "the motions decide what happens, and when it ends",
        "session": "nobody follows the motions",
    },
)
def play(
    names: Annotated[list[str], argument("Motions to play, one after another.", "MOTION...", motion_names)],
    world: Annotated[
        str | None, option("World (a file or a bare name); default: level ground.", "WORLD", complete=completion.worlds)
    ] = None,
    robot: Annotated[
        str | None,
        option(
            f"Robot (a file or a bare name); default without --world: {ROBOT}.", "MODEL", complete=completion.worlds
        ),
    ] = None,
    motions: Motions = [],
    model: OfModel = None,
    skip_planning: Annotated[
        bool, Option("--skip-planning", help="Do not check for collisions on the way to the first point.")
    ] = False,
    speed: Annotated[float, option("Speed scale of all trajectories, 0.01 to 1.", "FACTOR", min=0.01, max=1.0)] = 1.0,
    record: Annotated[Path | None, option("Bag to write: NAME.mcap, else a rosbag2 folder.", "OUT")] = None,
    force: options.Force = False,
    picture: Annotated[Path | None, option("Picture of the scene at the end, to write.", "OUT.png")] = None,
    json_: options.Json = False,
    verbose: options.Verbose = False,
    given: GivenOptions = NONE_GIVEN,
) -> None:
    """Play motions: at a safe speed to the first point, then with the timing of the motion file."""
    from simkit.recording import run_picture as pictures
    from simkit.recording.bags import recorder, writer
    from simkit.sensors.cameras.renderer_choice import check_available
    from simkit_motion.plugins.play_motion.motion_session import choose_player, motion_players, play_motions

    if picture is not None:
        pictures.check_target(picture)
    if record is not None:
        writer.check_target(record, overwrite=force)
    shown = []
    with ExitStack() as stack:
        sim = stack.enter_context(_open_world(world, robot, motions, given.load_arguments(), verbose=verbose))
        _scale_speed(sim, speed)
        if picture is not None:
            check_available(sim)
        if record is not None:
            stack.enter_context(recorder.Recorder(sim, record, overwrite=force))
        motions_played = play_motions(
            sim, choose_player(motion_players(sim), model), names, skip_planning=skip_planning
        )
        for played in progress.report_each("playing motions", motions_played, len(names)):
            joint, off = played.furthest
            key = played.motion.key
            shown.append({"motion": key, "duration": round(played.duration, 6), "joint": joint, "off": off})
            if not json_:
                stdout_console().print(f"{key}: done in {played.duration:.2f} s; {joint} is {abs(off):.2g} off")
        if picture is not None:
            _draw(sim, picture)
    if json_:
        print_json(shown, indent=2)


def _scale_speed(sim: Simulation, factor: float) -> None:
    """Send a speed scale to all trajectory controllers."""
    if factor == 1.0:
        return
    for topic, kind in sim.topics().items():
        if kind == SPEED_SCALE:
            sim.publish(topic, {"factor": factor})


def _open_world(
    world: str | None,
    robot: str | None,
    motions: Sequence[Path],
    arguments: LoadArguments,
    *,
    verbose: bool,
) -> Simulation:
    """Load the world with its robot, ready to play the motions of all files."""
    from simkit import load
    from simkit_motion.plugins.play_motion.motion_session import controlled_models, empty_world_with, motion_players
    from simkit_motion.plugins.play_motion.play_motion_plugin import PlayMotion

    _check_files(motions)
    text = world
    if text is None:
        text, folders = empty_world_with(robot or ROBOT)
        arguments = {**arguments, "resource_paths": [*arguments.get("resource_paths", ()), *folders]}
    sim = load(text, **arguments)
    spawned = _spawn_robot(sim, robot) if world is not None and robot is not None else None
    players = motion_players(sim)
    for player in players.values():
        for path in motions:
            player.read(path)
    if motions and not players:
        hosts = controlled_models(sim)
        sim.close()
        if len(hosts) != 1 or spawned is not None:
            detail = f"found {len(hosts)}" if spawned is None else "add the robot to the world file instead of --robot"
            message = f"--motions needs exactly one robot with a controller manager; {detail}"
            raise InputError("SK-MOTION-010", message)
        player_plugin = PlayMotion(motions=[str(path.resolve()) for path in motions])
        sim = load(text, **cast(LoadArguments, {**arguments, "plugins": [(hosts[0], player_plugin)]}))
    print_diagnostics(sim.diagnostics, verbose=verbose)
    return sim


def _read_motions(paths: Sequence[Path]) -> list[Motion]:
    """Read the motions of files, without a robot."""
    from simkit_motion.plugins.play_motion.motion_files import read_motions

    _check_files(paths)
    problems = Diagnostics()
    by_key: dict[str, Motion] = {}
    for path in paths:
        by_key.update(read_motions(path, problems).motions)
    problems.raise_if_errors()
    print_diagnostics(problems, verbose=False)
    return list(by_key.values())


def _check_files(paths: Sequence[Path]) -> None:
    """Raise an error if a motion file is missing or invalid."""
    from simkit_motion.plugins.play_motion.motion_files import read_motions

    broken = Diagnostics()
    for path in paths:
        if not path.is_file():
            raise InputError("SK-MOTION-001", f"motion file {path} does not exist")
        read_motions(path, broken)
    broken.raise_if_errors()


def _spawn_robot(sim: Simulation, robot: str) -> Model:
    """Spawn the robot, unless the world already has it."""
    from simkit_motion.plugins.play_motion.motion_session import motion_players

    existing = [scoped for scoped in motion_players(sim) if scoped == Path(robot).stem]
    if existing:
        message = f"the world already has a robot {existing[0]!r}; leave out --robot"
        raise InputError("SK-MOTION-010", message)
    return sim.spawn(robot)


def _joint_ranges(names: Sequence[str]) -> str:
    """Abbreviate joint names: `arm_1_joint` to `arm_7_joint` become `arm_1-7`."""
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
    from simkit import render_view
    from simkit.recording.run_picture import save_picture

    save_picture(sim, path, render_view)
    stdout_console().print(f"picture {path}")
