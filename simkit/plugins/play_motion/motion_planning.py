"""Planning of a motion: the approach to its first point, its timing, its limits and the collisions on its way."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import msgs
from simkit.diagnostics import did_you_mean
from simkit.plugins.play_motion.collision_check import CollisionCheck
from simkit.plugins.play_motion.motion import Motion, limit_violations, speed_limits
from simkit.plugins.play_motion.motion_timing import SHORTEST_INTERVAL, Course, approach_time, time_course
from simkit.plugins.ros2_control.control_plugin import ControlPlugin
from simkit.plugins.ros2_control.controllers.joint_trajectory import JointTrajectoryController
from simkit.pose import Vector

if TYPE_CHECKING:
    from simkit.runtime import Joint, Model, Simulation
    from simkit.scene.model import Mimic

MISSING_CONTROLLER: Final = -4
NO_PLAN_FOUND: Final = -8
OTHER_ERROR: Final = -42
APPROACH_SPEED: Final = 0.5
"""[rad/s or m/s], where nobody says anything."""
_STEPS: Final = {"prismatic": 0.005}  # [m] between two positions that are checked for collisions
_STEP: Final = 0.03  # [rad]
_REACHED_DISTANCE: Final = 1e-3  # [rad or m] from the first point, where no way to it is needed
_MIMIC_TOLERANCE: Final = 1e-3  # [rad or m] between a joint's position and the one that its leader gives it
_LONGEST_DURATION: Final = 2.0**31 - 1.0  # [s] that the time of a trajectory's point can tell


class MotionRefused(Exception):
    """A motion is refused.

    Attributes:
        code: why, as `play_motion_msgs/action/PlayMotion` numbers it.
    """

    def __init__(self, code: int, text: str) -> None:
        super().__init__(text)
        self.code = code


@dataclass(frozen=True, slots=True)
class TrajectoryController:
    """An active controller that follows trajectories.

    Attributes:
        name: the controller's.
        action: name of its action.
        joints: all that it moves, in its order.
    """

    name: str
    action: str
    joints: tuple[str, ...]


def active_controllers(sim: Simulation, robot: Model) -> list[TrajectoryController]:
    """List the active trajectory controllers of a robot in the order in which they were loaded."""
    found = []
    plugins = (plugin for plugin in sim.engine.structure.all_plugins() if isinstance(plugin, ControlPlugin))
    for plugin in plugins:
        is_within = f"{plugin.scoped}::".startswith(f"{robot.scoped}::")
        if not is_within or not hasattr(plugin, "manager"):
            continue
        for name, loaded in plugin.manager.controllers.items():
            controller = loaded.controller
            if loaded.state != "active" or not isinstance(controller, JointTrajectoryController):
                continue
            joints = dict.fromkeys(one.rpartition("/")[0] for one in controller.command_interfaces() if "/" in one)
            action = plugin.ros.topic(controller.topic("~/follow_joint_trajectory"))
            found.append(TrajectoryController(name, action, tuple(joints)))
    return found


def unclaimed_joints(robot: Model, joints: Sequence[str], controllers: Sequence[TrajectoryController]) -> list[str]:
    """List the joints that no active controller moves, neither itself nor by a joint that they mimic."""
    moved = {joint for controller in controllers for joint in controller.joints}
    laws = {joint: mimic_of(robot, joint) for joint in joints if joint not in moved}
    return [joint for joint, law in laws.items() if law is None or leader_name(law) not in moved]


def mimic_of(robot: Model, joint: str) -> Mimic | None:
    """Return how a joint mimics another one; None where it mimics none."""
    axes = robot.joints[joint].scene.axes if joint in robot.joints else ()
    return axes[0].mimic if axes else None


def leader_name(law: Mimic) -> str:
    """Return the plain name of the joint that is mimicked."""
    return law.joint.rpartition("::")[2]


@dataclass(frozen=True, slots=True)
class Approach:
    """Approach to the first point of a motion.

    Attributes:
        speed: at most, on average of the joint that has the longest way [rad/s or m/s].
        shortest: it takes at least that long [s].
        free_joints: plain names of joints whose links may touch each other and whatever lies loose, as grippers do.
    """

    speed: float = APPROACH_SPEED
    shortest: float = 0.0
    free_joints: frozenset[str] = frozenset()


def plan_motion(
    sim: Simulation,
    robot: Model,
    motion: Motion,
    controllers: Sequence[TrajectoryController],
    approach: Approach,
    *,
    looks_around: bool = True,
) -> Course:
    """The course of a motion's joints from where they are now.

    Args:
        sim: the simulation.
        robot: whose joints they are.
        motion: what is to be done.
        controllers: controllers that can do it.
        approach: how to get to its first point.
        looks_around: whether it is to touch nothing.

    Raises:
        MotionRefused: it cannot be done, or leaves the limits, or something is in the way.
    """
    joints = find_joints(robot, motion.joints, controllers)
    beyond = limit_violations(motion, joints)
    if beyond:
        raise MotionRefused(OTHER_ERROR, f"motion {motion.key!r} leaves the limits: {'; '.join(beyond)}")
    check_mimic_joints(robot, motion)
    start = np.array([float(joint.position) for joint in joints.values()])
    found = course_from(start, motion, speed_limits(motion, joints), approach)
    if not found.duration <= _LONGEST_DURATION:
        said = f"motion {motion.key!r} would take {found.duration:g} s, allowed is up to {_LONGEST_DURATION:.0f} s"
        raise MotionRefused(OTHER_ERROR, said)
    if looks_around and not approach.free_joints.issuperset(motion.joints):
        check_collisions(sim, robot, motion, found, joints, approach.free_joints)
    return found


def find_joints(robot: Model, names: Sequence[str], controllers: Sequence[TrajectoryController]) -> dict[str, Joint]:
    """The joints of a motion by name, each of which a controller moves. Raises MotionRefused."""
    missing = [name for name in names if name not in robot.joints]
    if missing:
        near = did_you_mean(missing[0], robot.joints)
        raise MotionRefused(
            MISSING_CONTROLLER, f"{robot.name!r} has no joint {missing[0]!r}" + (f"; {near}" if near else "")
        )
    free = unclaimed_joints(robot, names, controllers)
    if free:
        listed = ", ".join(map(repr, free))
        plural = "s" if len(free) > 1 else ""
        verb = "are" if plural else "is"
        raise MotionRefused(MISSING_CONTROLLER, f"Joint{plural} {listed} {verb} not claimed by any active controller")
    return {name: robot.joints[name] for name in names}


def add_leader_joints(robot: Model, motion: Motion) -> Motion:
    """A motion with the joints that lead those which it names: a joint that follows another one moves by that one."""
    for name in motion.joints:
        law = mimic_of(robot, name)
        if law is None or not law.multiplier:
            continue
        if leader_name(law) in motion.joints or leader_name(law) not in robot.joints:
            continue
        column = motion.joints.index(name)
        ratio, rows = law.multiplier, motion.positions
        places = tuple((*row, (row[column] - law.offset) / ratio + law.reference) for row in rows)
        speeds = tuple((*row, row[column] / ratio) for row in motion.velocities)
        motion = replace(motion, joints=(*motion.joints, leader_name(law)), positions=places, velocities=speeds)
    return motion


def check_mimic_joints(robot: Model, motion: Motion) -> None:
    """Raises MotionRefused where a joint that follows another one is to be elsewhere than that one takes it."""
    for column, name in enumerate(motion.joints):
        law = mimic_of(robot, name)
        if law is None or leader_name(law) not in motion.joints:
            continue
        lead = motion.joints.index(leader_name(law))
        for time, row in zip(motion.times, motion.positions, strict=True):
            there = law.multiplier * (row[lead] - law.reference) + law.offset
            if abs(row[column] - there) > _MIMIC_TOLERANCE:
                wanted = f"{name} is to be at {row[column]:g} at {time:g} s, but it follows {leader_name(law)}"
                raise MotionRefused(OTHER_ERROR, f"motion {motion.key!r}: {wanted}, which takes it to {there:g}")


def course_from(start: Vector, motion: Motion, limits: Vector, approach: Approach) -> Course:
    """The course from where the joints are through the points of a motion.

    The way to the first point takes the time that the motion gives it, or longer where a joint would be too fast; what
    follows keeps its distance in time.
    """
    points = np.vstack([start, np.array(motion.positions)])
    times = np.array(motion.times)
    is_there = float(np.max(np.abs(points[1] - start))) <= _REACHED_DISTANCE
    needed = SHORTEST_INTERVAL if is_there else approach_time(start, points[1], approach.speed, approach.shortest)
    shifted = np.concatenate([[0.0], times + max(needed - times[0], 0.0)])
    given = np.array(motion.velocities) if motion.velocities else None
    return time_course(points, shifted, given, limits)


def check_collisions(
    sim: Simulation,
    robot: Model,
    motion: Motion,
    found: Course,
    joints: Mapping[str, Joint],
    free_joints: Collection[str],
) -> None:
    """Goes along a course in a copy of the state. Raises MotionRefused where two links come into each other."""
    clearance = CollisionCheck(sim, robot, list(joints.values()), free_joints)
    steps = np.array([_STEPS.get(joint.type, _STEP) for joint in joints.values()])
    reached = found.times[1]
    for time, positions in found.samples(steps):
        meeting = clearance.meeting(positions)
        if meeting is not None:
            at = time - reached + motion.times[0]
            where = "on the way to its first point" if time < reached else f"at {at:.2f} s"
            raise MotionRefused(NO_PLAN_FOUND, f"motion {motion.key!r} collides {where}: {meeting}")


def trajectory_goal(found: Course, motion: Motion, controller: TrajectoryController, robot: Model) -> dict[str, object]:
    """The goal of one controller: its joints of a course; those that the motion leaves out stay where they are."""
    columns = [motion.joints.index(joint) if joint in motion.joints else None for joint in controller.joints]
    here = [float(robot.joints[joint].position) if joint in robot.joints else 0.0 for joint in controller.joints]

    def row(values: Vector, otherwise: Sequence[float]) -> list[float]:
        return [otherwise[k] if c is None else float(values[c]) for k, c in enumerate(columns)]

    at_rest = [0.0] * len(columns)
    points = [
        {
            "positions": row(found.positions[k], here),
            "velocities": row(found.velocities[k], at_rest),
            "time_from_start": msgs.duration(round(float(found.times[k]) * 1e9)),
        }
        for k in range(1, len(found.times))
    ]
    return {"trajectory": {"joint_names": list(controller.joints), "points": points}}
