"""Straight lines of a link: joint positions along the line, from the inverse kinematics of near poses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Pose
from simkit.extend import Vector
from simkit.linear_algebra import matmul, norm
from simkit_motion.plugins.move_group.error_codes import Code, PlanningFailed
from simkit_motion.plugins.move_group.group_model import GroupModel
from simkit_motion.plugins.move_group.inverse_kinematics import PoseGoal, solve
from simkit_motion.plugins.move_group.path_timing import TimedPath
from simkit_motion.plugins.move_group.planning import fine_positions, refuse_constraints
from simkit_motion.plugins.move_group.state_copy import se3

if TYPE_CHECKING:
    from simkit.msgs import Message

_TURN_STEP: Final = 0.05  # [rad] between two poses
_MOST_POSES: Final = 5000
_LONGEST: Final = 1e6  # [s]; the seconds of a message have 32 bits


@dataclass(frozen=True, eq=False)
class LineOptions:
    """Options of a straight line.

    Attributes:
        step: Longest distance between two poses [m].
        jumps: Largest change of each joint between two poses [rad or m]; inf for no limit.
        avoids_collisions: True if the line ends before the first collision.
    """

    step: float
    jumps: Vector
    avoids_collisions: bool


@dataclass(frozen=True, eq=False)
class Line:
    """Joint positions along a straight line.

    Attributes:
        positions: Positions of the joints [rad or m], shape (poses, joints).
        fraction: Part of the line that was reached, 0 to 1.
        checks: Number of collision checks.
        problem: Reason for a fraction below 1; empty otherwise.
    """

    positions: Vector
    fraction: float
    checks: int
    problem: str


def line_options(request: Message, types: Sequence[str]) -> LineOptions:
    """Return the options of a `moveit_msgs/srv/GetCartesianPath_Request`.

    Args:
        request: Request.
        types: Type of each joint.

    Raises:
        PlanningFailed: `max_step` is not positive, or the path has constraints.
    """
    if not 0.0 < request.max_step < np.inf:
        raise PlanningFailed(Code.FAILURE, f"max_step is {request.max_step:g}; expected a positive length [m]")
    refuse_constraints(request.path_constraints)
    thresholds = [
        request.prismatic_jump_threshold if kind == "prismatic" else request.revolute_jump_threshold for kind in types
    ]
    jumps = [value or request.jump_threshold or np.inf for value in thresholds]
    return LineOptions(float(request.max_step), np.array(jumps, dtype=float), bool(request.avoid_collisions))


def follow_line(model: GroupModel, link: str, poses: Sequence[Pose], options: LineOptions) -> Line:
    """Return joint positions with which a link moves straight from its present pose through the given poses.

    Args:
        model: Model of the group, with its collision model.
        link: Scoped name of the link.
        poses: Poses in the world.
        options: Options.

    Raises:
        PlanningFailed: The start is in collision, there are no poses, or the line is too long for its steps.
    """
    if not poses:
        raise PlanningFailed(Code.FAILURE, "the request has no waypoints")
    if options.avoids_collisions and not model.is_free(model.start):
        pair = " and ".join(model.collisions(model.start)[0])
        raise PlanningFailed(Code.START_STATE_IN_COLLISION, f"the start state is in collision: {pair} touch")
    import pinocchio

    placements = [model.pose_and_jacobian(model.tip(link), model.start)[0], *(se3(pose) for pose in poses)]
    targets = []
    for a, b in pairwise(placements):
        turn = norm(pinocchio.log3(matmul(a.rotation.T, b.rotation)))
        length = norm(b.translation - a.translation)
        needed = max(1.0, np.ceil(max(length / options.step, turn / _TURN_STEP)))
        if not needed <= _MOST_POSES:
            raise PlanningFailed(Code.FAILURE, f"max_step makes {needed:.6g} poses; expected at most {_MOST_POSES}")
        count = int(needed)
        for k in range(1, count + 1):
            share = k / count
            rotation = matmul(a.rotation, pinocchio.exp3(share * pinocchio.log3(matmul(a.rotation.T, b.rotation))))
            targets.append(pinocchio.SE3(rotation, a.translation + share * (b.translation - a.translation)))
    return _positions_along(model, link, targets, options)


def _positions_along(model: GroupModel, link: str, targets: Sequence[object], options: LineOptions) -> Line:
    q, rows, checks, problem = model.start, [model.start], 0, ""
    for target in targets:
        solution = solve(model, PoseGoal(link, target, np.zeros(3)), q)
        if solution is None:
            problem = "no joint positions within the limits lead further"
            break
        if (np.abs(solution - q) > options.jumps).any():
            problem = "a joint would jump"
            break
        if options.avoids_collisions:
            between = fine_positions(model, q, solution)
            checks += len(between)
            blocked = next((position for position in between if not model.is_free(position)), None)
            if blocked is not None:
                problem = " and ".join(model.collisions(blocked)[0]) + " would touch"
                break
        q = solution
        rows.append(q)
    return Line(np.array(rows), (len(rows) - 1) / len(targets), checks, problem)


def limit_tip_speed(model: GroupModel, link: str, course: TimedPath, limit: float) -> TimedPath:
    """Return a course that is slower as a whole if a link would be faster than a limit [m/s].

    Raises:
        PlanningFailed: The course would be too long for the time of a message.
    """
    tip = model.tip(link)
    speeds = [
        norm(matmul(model.pose_and_jacobian(tip, q)[1], v)[:3])
        for q, v in zip(course.positions, course.velocities, strict=True)
    ]
    factor = max(1.0, max(speeds) / limit)
    if course.duration * factor > _LONGEST:
        text = f"max_cartesian_speed is {limit:g}: the line would take {course.duration * factor:.3g} s"
        raise PlanningFailed(Code.INVALID_MOTION_PLAN, text)
    return TimedPath(course.times * factor, course.positions, course.velocities / factor)
