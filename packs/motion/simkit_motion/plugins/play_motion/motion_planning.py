"""Planning of a motion: approach to the first point, timing, and checks of limits and collisions."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import msgs
from simkit.extend import Vector, did_you_mean
from simkit_control.controllers.joint_trajectory import JointTrajectoryController
from simkit_control.plugins.ros2_control.control_plugin import ControlPlugin
from simkit_motion.plugins.play_motion.collision_check import CollisionCheck
from simkit_motion.plugins.play_motion.motion import Motion, limit_violations, speed_limits
from simkit_motion.plugins.play_motion.motion_timing import SHORTEST_INTERVAL, Course, approach_time, time_course

if TYPE_CHECKING:
    from simkit import Joint, Model, Simulation
    from simkit.scene.model import Mimic

MISSING_CONTROLLER: Final = -4
NO_PLAN_FOUND: Final = -8
OTHER_ERROR: Final = -42
APPROACH_SPEED: Final = 0.5
"""Default speed of the approach [rad/s or m/s]."""
_STEPS: Final = {"prismatic": 0.005}  # [m] between two positions that are checked for collisions
_STEP: Final = 0.03  # [rad]
_REACHED_DISTANCE: Final = 1e-3  # [rad or m], distance to the first point below which no approach is needed
_MIMIC_TOLERANCE: Final = 1e-3  # [rad or m], allowed error between a mimic joint and its leader's rule
_LONGEST_DURATION: Final = 2.0**31 - 1.0  # [s], largest time_from_start that a trajectory message can hold


class MotionRefused(Exception):
    """Error: a motion cannot be played.

    Attributes:
        code: Error code of `play_motion_msgs/action/PlayMotion`.
    """

    def __init__(self, code: int, text: str) -> None:
        super().__init__(text)
        self.code = code


@dataclass(frozen=True, slots=True)
class TrajectoryController:
    """Active controller that follows trajectories.

    Attributes:
        name: Name of the controller.
        action: Name of its action.
        joints: All joints of the controller, in its order.
        speed_scaling: Factor of the speed of its trajectories.
    """

    name: str
    action: str
    joints: tuple[str, ...]
    speed_scaling: float = 1.0


def active_controllers(sim: Simulation, robot: Model) -> list[TrajectoryController]:
    """Return the active trajectory controllers of a robot, in the order of loading."""
    controllers = []
    plugins = (plugin for plugin in sim.engine.structure.all_plugins() if isinstance(plugin, ControlPlugin))
    for plugin in plugins:
        is_within = f"{plugin.scoped}::".startswith(f"{robot.scoped}::")
        if not is_within or not hasattr(plugin, "manager"):
            continue
        for name, loaded in plugin.manager.controllers.items():
            controller = loaded.controller
            if loaded.state != "active" or not isinstance(controller, JointTrajectoryController):
                continue
            interfaces = controller.command_interfaces()
            joints = dict.fromkeys(name.rpartition("/")[0] for name in interfaces if "/" in name)
            action = plugin.ros.topic(controller.topic("~/follow_joint_trajectory"))
            controllers.append(TrajectoryController(name, action, tuple(joints), controller.speed_scaling))
    return controllers


def unclaimed_joints(robot: Model, joints: Sequence[str], controllers: Sequence[TrajectoryController]) -> list[str]:
    """Return the joints that no active controller moves, directly or through the joint that they mimic."""
    moved = {joint for controller in controllers for joint in controller.joints}
    laws = {joint: mimic_of(robot, joint) for joint in joints if joint not in moved}
    return [joint for joint, law in laws.items() if law is None or leader_name(law) not in moved]


def mimic_of(robot: Model, joint: str) -> Mimic | None:
    """Return the mimic rule of a joint; None if the joint does not mimic another joint."""
    axes = robot.joints[joint].scene.axes if joint in robot.joints else ()
    return axes[0].mimic if axes else None


def leader_name(law: Mimic) -> str:
    """Return the plain name of the joint that a mimic rule refers to."""
    return law.joint.rpartition("::")[2]


@dataclass(frozen=True, slots=True)
class Approach:
    """Approach to the first point of a motion.

    Attributes:
        speed: Average speed of the joint with the longest way [rad/s or m/s].
        shortest: Shortest duration of the approach [s].
        free_joints: Plain names of joints whose links may touch each other and free bodies, such as grippers.
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
    checks_collisions: bool = True,
) -> Course:
    """Plan the course of a motion's joints, from their present positions through all points of the motion.

    Args:
        sim: Simulation of the robot.
        robot: Robot that plays the motion.
        motion: Motion to plan.
        controllers: Active controllers of the robot.
        approach: Approach to the first point.
        checks_collisions: True to check for collisions.

    Raises:
        MotionRefused: A joint has no controller, a limit is exceeded, or links would collide.
    """
    joints = find_joints(robot, motion.joints, controllers)
    beyond = limit_violations(motion, joints)
    if beyond:
        raise MotionRefused(OTHER_ERROR, f"motion {motion.key!r} exceeds the joint limits: {'; '.join(beyond)}")
    check_mimic_joints(robot, motion)
    start = np.array([float(joint.position) for joint in joints.values()])
    course = course_from(start, motion, speed_limits(motion, joints), approach)
    if not course.duration <= _LONGEST_DURATION:
        text = f"motion {motion.key!r} would take {course.duration:g} s; expected up to {_LONGEST_DURATION:.0f} s"
        raise MotionRefused(OTHER_ERROR, text)
    if checks_collisions and not approach.free_joints.issuperset(motion.joints):
        check_collisions(sim, robot, motion, course, joints, approach.free_joints)
    return course


def find_joints(robot: Model, names: Sequence[str], controllers: Sequence[TrajectoryController]) -> dict[str, Joint]:
    """Return the joints of a motion by name.

    Raises:
        MotionRefused: A joint does not exist, or no controller moves it.
    """
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
    """Add to a motion the joints that its mimic joints follow, with the matching positions.

    No controller moves a mimic joint itself: it follows its leader.
    """
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
    """Check that mimic joints and their leaders have matching positions in the motion.

    Raises:
        MotionRefused: A mimic joint has a position that does not follow from its leader's position.
    """
    for column, name in enumerate(motion.joints):
        law = mimic_of(robot, name)
        if law is None or leader_name(law) not in motion.joints:
            continue
        lead = motion.joints.index(leader_name(law))
        for time, row in zip(motion.times, motion.positions, strict=True):
            there = law.multiplier * (row[lead] - law.reference) + law.offset
            if abs(row[column] - there) > _MIMIC_TOLERANCE:
                fault = f"{name} would be at {row[column]:g} at {time:g} s, but it mimics {leader_name(law)}"
                raise MotionRefused(OTHER_ERROR, f"motion {motion.key!r}: {fault}, which moves it to {there:g}")


def course_from(start: Vector, motion: Motion, limits: Vector, approach: Approach) -> Course:
    """Return the course from the present positions through the points of a motion.

    The approach to the first point takes the time of that point in the motion, or longer if the approach would be too
    fast. The times between the points of the motion get longer only if a joint would exceed its speed limit.

    Args:
        start: Present positions of the joints [rad or m].
        motion: Motion to play.
        limits: Largest speed of each joint [rad/s or m/s].
        approach: Speed and shortest duration of the approach to the first point.
    """
    points = np.vstack([start, np.array(motion.positions)])
    times = np.array(motion.times)
    is_there = float(np.max(np.abs(points[1] - start))) <= _REACHED_DISTANCE
    needed = SHORTEST_INTERVAL if is_there else approach_time(start, points[1], approach.speed, approach.shortest)
    needed = min(needed, 2 * _LONGEST_DURATION)  # infinite at a speed near 0; too long in any case
    shifted = np.concatenate([[0.0], times + max(needed - times[0], 0.0)])
    velocities = np.array(motion.velocities) if motion.velocities else None
    return time_course(points, shifted, velocities, limits)


def check_collisions(
    sim: Simulation,
    robot: Model,
    motion: Motion,
    found: Course,
    joints: Mapping[str, Joint],
    free_joints: Collection[str],
) -> None:
    """Check sampled positions along a course for collisions, in a copy of the state.

    Raises:
        MotionRefused: Two links would collide.
    """
    checker = CollisionCheck(sim, robot, list(joints.values()), free_joints)
    steps = np.array([_STEPS.get(joint.type, _STEP) for joint in joints.values()])
    reached = found.times[1]
    for time, positions in found.samples(steps):
        collision = checker.deepest_collision(positions)
        if collision is not None:
            at = time - reached + motion.times[0]
            where = "on the way to its first point" if time < reached else f"at {at:.2f} s"
            raise MotionRefused(NO_PLAN_FOUND, f"motion {motion.key!r} collides {where}: {collision}")


def trajectory_goal(
    course: Course, motion: Motion, controller: TrajectoryController, robot: Model
) -> dict[str, object]:
    """Return the goal for one controller; a joint that is not in the motion keeps its present position."""
    columns = [motion.joints.index(joint) if joint in motion.joints else None for joint in controller.joints]
    here = [float(robot.joints[joint].position) if joint in robot.joints else 0.0 for joint in controller.joints]

    def row(values: Vector, otherwise: Sequence[float]) -> list[float]:
        return [otherwise[k] if c is None else float(values[c]) for k, c in enumerate(columns)]

    at_rest = [0.0] * len(columns)
    points = [
        {
            "positions": row(course.positions[k], here),
            "velocities": row(course.velocities[k], at_rest),
            "time_from_start": msgs.duration(round(float(course.times[k]) * 1e9)),
        }
        for k in range(1, len(course.times))
    ]
    return {"trajectory": {"joint_names": list(controller.joints), "points": points}}
