"""A world with a robot that plays motions, as `simkit motion` opens it, and motions played in it one after another."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.diagnostics import did_you_mean
from simkit.errors import InputError, SimkitError
from simkit.plugins.play_motion.motion import Motion
from simkit.plugins.play_motion.play_motion_plugin import PlayMotion
from simkit.plugins.ros2_control.control_plugin import ControlPlugin

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_SLICE: Final = 0.02  # [s] of simulated time between two looks at whether a motion is over
_LONGEST: Final = 10_000.0  # [s] that a motion may take


class MotionError(SimkitError):
    """A motion was refused, or did not get to its end."""

    code = "SK-MOTION-012"


@dataclass(frozen=True, slots=True)
class PlayedMotion:
    """A motion that came to its end.

    Attributes:
        motion: which.
        duration: simulated time that it took, the approach included [s].
        furthest: the joint that is furthest from the last point, and how far [rad or m].
    """

    motion: Motion
    duration: float
    furthest: tuple[str, float]


def empty_world_with(robot: str) -> tuple[str, list[Path]]:
    """SDF text of level ground with a robot on it, by bare name or file, and folders that it needs."""
    path = Path(robot)
    uri, folders = (str(path.resolve()), [path.resolve().parent]) if path.is_file() else (f"model://{robot}", [])
    models = "".join(f"<include><uri>{one}</uri></include>" for one in ("model://ground_plane", "model://sun", uri))
    physics = '<physics name="step_1ms" type="ignored"><max_step_size>0.001</max_step_size></physics>'
    return f'<sdf version="1.12"><world name="motion">{physics}{models}</world></sdf>', folders


def motion_players(sim: Simulation) -> dict[str, PlayMotion]:
    """The robots that play motions, by their scoped names."""
    return {p.scoped: p for p in sim.engine.structure.all_plugins() if isinstance(p, PlayMotion)}


def controlled_models(sim: Simulation) -> list[str]:
    """Scoped names of the models that a controller manager moves."""
    return [p.scoped for p in sim.engine.structure.all_plugins() if isinstance(p, ControlPlugin)]


def choose_player(there: Mapping[str, PlayMotion], name: str | None) -> PlayMotion:
    """The robot of that name, or the only one.

    Raises:
        InputError: SK-MOTION-010 there is none, or more than one to choose from.
    """
    listed = ", ".join(there) or "none"
    if name is not None and name not in there:
        hint = did_you_mean(name, there) or f"those that do: {listed}"
        raise InputError(f"SK-MOTION-010 no robot {name!r} plays motions; {hint}", "SK-MOTION-010")
    if name is None and not there:
        hint = "tiago is one that does; --motions FILE.yaml gives the one that is there some"
        raise InputError(f"SK-MOTION-010 no robot here plays motions; {hint}", "SK-MOTION-010")
    if name is None and len(there) > 1:
        hint = f"--model says which: {listed}"
        raise InputError(f"SK-MOTION-010 several robots play motions; {hint}", "SK-MOTION-010")
    return there[name] if name is not None else next(iter(there.values()))


def play_motions(
    sim: Simulation, player: PlayMotion, names: Sequence[str], *, skip_planning: bool = False
) -> Iterator[PlayedMotion]:
    """Plays motions one after another, each from where the one before ended.

    Raises:
        InputError: SK-MOTION-011 there is no such motion.
        MotionError: one was refused, or did not get to its end.
    """
    motions = player.motions
    for name in names:
        if name not in motions:
            hint = did_you_mean(name, motions) or "there is " + (", ".join(motions) or "none")
            raise InputError(f"SK-MOTION-011 no motion {name!r}; {hint}", "SK-MOTION-011")
    for name in names:
        start = sim.time
        goal = sim.send_goal(player.action_name, {"motion_name": name, "skip_planning": skip_planning})
        while not goal.is_done and sim.time - start < _LONGEST:
            sim.run(_SLICE)
        if goal.status.name != "SUCCEEDED":
            raise MotionError(f"SK-MOTION-012 {goal.reason or f'motion {name!r} came to no end'}")
        yield PlayedMotion(motions[name], sim.time - start, _largest_error(player, motions[name]))


def _largest_error(player: PlayMotion, motion: Motion) -> tuple[str, float]:
    joints = player.robot.joints
    off = {name: float(joints[name].position) - v for name, v in zip(motion.joints, motion.positions[-1], strict=True)}
    name = max(off, key=lambda one: abs(off[one]))
    return name, off[name]
