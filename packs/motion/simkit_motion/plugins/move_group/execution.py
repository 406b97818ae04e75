"""Execution of a plan by the robot's trajectory controllers."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from simkit import msgs
from simkit_motion.plugins.move_group.error_codes import Code, PlanningFailed
from simkit_motion.plugins.move_group.path_timing import TimedPath
from simkit_motion.plugins.move_group.planning import find_joint
from simkit_motion.plugins.play_motion.motion_planning import active_controllers

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.extend import GoalHandle
    from simkit.msgs import Message

_START_TOLERANCE = 0.05  # [rad or m] between the first point of a trajectory and the robot


@dataclass(slots=True)
class Execution:
    """Trajectory that is being executed.

    Attributes:
        goal: Goal of the client.
        fields: Fields of the result, except the error code.
        parts: Goals of the controllers that have not finished yet.
    """

    goal: GoalHandle
    fields: dict[str, object]
    parts: list[GoalHandle] = field(default_factory=list)


def course_of_message(robot: Model, message: Message) -> tuple[tuple[str, ...], TimedPath]:
    """Convert a `trajectory_msgs/msg/JointTrajectory`.

    Raises:
        PlanningFailed: A joint does not exist, or the numbers of a point do not match the joints.
    """
    names = tuple(str(name) for name in message.joint_names)
    for name in names:
        find_joint(robot, name, Code.INVALID_MOTION_PLAN)
    rows = [np.array(point.positions, dtype=float) for point in message.points]
    speeds = [np.array(point.velocities, dtype=float) for point in message.points]
    if not names or not rows or any(len(row) != len(names) or not np.isfinite(row).all() for row in rows):
        text = "the trajectory needs joints, and points with a position for each joint"
        raise PlanningFailed(Code.INVALID_MOTION_PLAN, text)
    speeds = [v if len(v) == len(names) else np.full(len(names), np.nan) for v in speeds]
    times = np.array([p.time_from_start.sec + p.time_from_start.nanosec * 1e-9 for p in message.points])
    return names, TimedPath(times, np.array(rows), np.array(speeds))


def split_trajectory(
    sim: Simulation, robot: Model, joints: tuple[str, ...], course: TimedPath
) -> dict[str, dict[str, object]]:
    """Return the goal for each controller, by name of its action.

    Joints of a controller that the trajectory does not move keep their positions.

    Raises:
        PlanningFailed: No controller moves a joint, or the robot is not at the start of the trajectory.
    """
    controllers = [c for c in active_controllers(sim, robot) if set(c.joints) & set(joints)]
    moved = {joint for c in controllers for joint in c.joints}
    free = [name for name in joints if name not in moved]
    if free:
        raise PlanningFailed(Code.CONTROL_FAILED, f"no active controller moves {', '.join(map(repr, free))}")
    for k, name in enumerate(joints):
        off = abs(float(robot.joints[name].position) - course.positions[0, k])
        if off > _START_TOLERANCE and course.times[0] == 0.0:
            text = f"joint {name!r} is {off:.3g} away from the start of the trajectory; at most {_START_TOLERANCE:g}"
            raise PlanningFailed(Code.INVALID_MOTION_PLAN, text)
    requests: dict[str, dict[str, object]] = {}
    for controller in controllers:
        columns = [joints.index(joint) if joint in joints else -1 for joint in controller.joints]
        here = [float(robot.joints[joint].position) for joint in controller.joints]
        points = []
        for k, time in enumerate(course.times):
            if time == 0.0 and len(course.times) > 1:
                continue  # the controller starts from the measured state
            row = [course.positions[k, c] if c >= 0 else h for c, h in zip(columns, here, strict=True)]
            speeds = [course.velocities[k, c] if c >= 0 else 0.0 for c in columns]
            point: dict[str, object] = {"positions": [float(v) for v in row]}
            if np.isfinite(speeds).all():
                point["velocities"] = [float(v) for v in speeds]
            points.append({**point, "time_from_start": msgs.duration(round(float(time) * 1e9))})
        requests[controller.action] = {"trajectory": {"joint_names": list(controller.joints), "points": points}}
    return requests
