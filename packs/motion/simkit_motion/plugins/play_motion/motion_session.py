"""Functions behind `simkit motion`: open a world with a robot, and play motions in sequence."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.errors import InputError, SimkitError
from simkit.extend import did_you_mean
from simkit_control.plugins.ros2_control.control_plugin import ControlPlugin
from simkit_motion.plugins.play_motion.motion import Motion
from simkit_motion.plugins.play_motion.play_motion_plugin import PlayMotion

if TYPE_CHECKING:
    from simkit import Simulation

_SLICE: Final = 0.02  # [s], simulated time between two checks whether a motion has ended
_LONGEST: Final = 10_000.0  # [s], largest duration of a motion


class MotionError(SimkitError):
    """Error: a motion was refused or did not finish."""

    code = "SK-MOTION-012"
    _shows_class_code = True


@dataclass(frozen=True, slots=True)
class PlayedMotion:
    """Motion that has finished.

    Attributes:
        motion: Motion that was played.
        duration: Simulated duration, including the approach [s].
        furthest: Name and error [rad or m] of the joint with the largest distance from the last point of the motion.
    """

    motion: Motion
    duration: float
    furthest: tuple[str, float]


def empty_world_with(robot: str) -> tuple[str, list[Path]]:
    """Return the SDF text of a world with a ground plane and a robot, and the resource folders of the robot.

    Args:
        robot: Name of a model, or path of a robot file.
    """
    path = Path(robot)
    uri, folders = (str(path.resolve()), [path.resolve().parent]) if path.is_file() else (f"model://{robot}", [])
    models = "".join(f"<include><uri>{model}</uri></include>" for model in ("model://ground_plane", "model://sun", uri))
    physics = '<physics name="step_1ms" type="ignored"><max_step_size>0.001</max_step_size></physics>'
    return f'<sdf version="1.12"><world name="motion">{physics}{models}</world></sdf>', folders


def motion_players(sim: Simulation) -> dict[str, PlayMotion]:
    """Return the plugins that play motions, by scoped name of the robot."""
    return {p.scoped: p for p in sim.engine.structure.all_plugins() if isinstance(p, PlayMotion)}


def controlled_models(sim: Simulation) -> list[str]:
    """Return the scoped names of the models that have a controller manager."""
    return [p.scoped for p in sim.engine.structure.all_plugins() if isinstance(p, ControlPlugin)]


def choose_player(players: Mapping[str, PlayMotion], name: str | None) -> PlayMotion:
    """Return the plugin that plays the motions of a robot.

    Args:
        players: Plugins by scoped name of the robot.
        name: Scoped name of the robot; None if only one robot plays motions.

    Raises:
        InputError: SK-MOTION-010, the robot does not play motions, or several robots play motions and `name` is None.
    """
    listed = ", ".join(players) or "none"
    if name is not None and name not in players:
        hint = did_you_mean(name, players) or f"these robots do: {listed}"
        raise InputError("SK-MOTION-010", f"no robot {name!r} plays motions; {hint}")
    if name is None and not players:
        hint = "load motions with --motions FILE.yaml, or use a robot that has some, such as tiago"
        raise InputError("SK-MOTION-010", f"no robot in this world plays motions; {hint}")
    if name is None and len(players) > 1:
        hint = f"choose one with --model NAME: {listed}"
        raise InputError("SK-MOTION-010", f"several robots play motions; {hint}")
    return players[name] if name is not None else next(iter(players.values()))


def play_motions(
    sim: Simulation, player: PlayMotion, names: Sequence[str], *, skip_planning: bool = False
) -> Iterator[PlayedMotion]:
    """Play motions in sequence; each motion begins where the previous motion ends.

    Args:
        sim: Simulation of the robot.
        player: Plugin that plays the robot's motions.
        names: Keys of the motions.
        skip_planning: True to skip the collision check.

    Raises:
        InputError: SK-MOTION-011, a motion does not exist.
        MotionError: A motion was refused or did not finish.
    """
    motions = player.motions
    for name in names:
        if name not in motions:
            hint = did_you_mean(name, motions) or "there is " + (", ".join(motions) or "none")
            raise InputError("SK-MOTION-011", f"there is no motion {name!r}; {hint}")
    for name in names:
        start = sim.time
        goal = sim.send_goal(player.action_name, {"motion_name": name, "skip_planning": skip_planning})
        while not goal.is_done and sim.time - start < _LONGEST:
            sim.run(_SLICE)
            planned = player.planned_duration(goal)
            if planned > _LONGEST:
                text = f"motion {name!r} would take {planned:g} s; expected up to {_LONGEST:g} s"
                raise MotionError(text)
        if goal.status.name != "SUCCEEDED":
            raise MotionError(goal.reason or f"motion {name!r} did not finish")
        yield PlayedMotion(motions[name], sim.time - start, _largest_error(player, motions[name]))


def _largest_error(player: PlayMotion, motion: Motion) -> tuple[str, float]:
    joints = player.robot.joints
    off = {name: float(joints[name].position) - v for name, v in zip(motion.joints, motion.positions[-1], strict=True)}
    name = max(off, key=lambda joint: abs(off[joint]))
    return name, off[name]
