"""Plans for a group of joints: from a request of MoveIt's types to a timed path."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import msgs
from simkit.extend import Vector, counted, did_you_mean
from simkit.linear_algebra import matmul
from simkit_motion.plugins.move_group.error_codes import Code, PlanningFailed
from simkit_motion.plugins.move_group.group_model import GroupModel, Obstacle
from simkit_motion.plugins.move_group.inverse_kinematics import PoseGoal, seeds_of, solutions
from simkit_motion.plugins.move_group.path_planner import BudgetSpent, PathPlanner
from simkit_motion.plugins.move_group.path_timing import TimedPath, round_corners, time_path

if TYPE_CHECKING:
    from simkit import Joint, Model, Simulation
    from simkit.msgs import Message

CHECKS_PER_SECOND: Final = 10_000
"""Number of collision checks that count as one second of planning time. The wall clock would make plans differ."""
_PLANNING_TIME: Final = 5.0  # [s], as in MoveIt
_IK_SEEDS: Final = 30
_GOALS: Final = 6  # most joint positions that a plan may end at
_DEVIATION: Final = 0.1  # [rad or m], of a rounded corner from the straight lines
_SMALLEST_FACTOR: Final = 1e-3  # of a limit; a smaller one makes millions of points
_FINE: Final = 0.004  # [m], longest way of any point between two checks of the final course


@dataclass(frozen=True, slots=True)
class Group:
    """Group of joints that are planned together.

    Attributes:
        name: Name in requests.
        joints: Plain names of the joints, in the order of the tree.
        tip: Plain name of the link that poses refer to if a request names no link.
    """

    name: str
    joints: tuple[str, ...]
    tip: str


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of a plan.

    Attributes:
        acceleration: Largest acceleration of a joint that rotates [rad/s²].
        linear_acceleration: Largest acceleration of a joint that slides [m/s²].
        padding: Distance to obstacles [m].
        joints: Speed and acceleration of some joints by plain name, instead of the others; 0 for those.
    """

    acceleration: float
    linear_acceleration: float
    padding: float
    joints: Mapping[str, tuple[float, float]] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Obstacles of a plan.

    Attributes:
        world: True if the collisions of the other models are obstacles.
        obstacles: Further obstacles.
        allowed: Pairs of names that may touch.
        free_joints: Plain names of joints whose links may touch each other, such as fingers.
    """

    world: bool
    obstacles: tuple[Obstacle, ...]
    allowed: frozenset[frozenset[str]]
    free_joints: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Plan:
    """Result of a request.

    Attributes:
        joints: Plain names of the joints.
        course: Positions and velocities over time.
        checks: Number of collision checks.
    """

    joints: tuple[str, ...]
    course: TimedPath
    checks: int

    def as_trajectory(self, frame: str) -> dict[str, object]:
        """Return the plan as the fields of a `moveit_msgs/msg/RobotTrajectory`."""
        course = self.course
        points = [
            {
                "positions": course.positions[k].tolist(),
                "velocities": course.velocities[k].tolist(),
                "time_from_start": msgs.duration(round(float(course.times[k]) * 1e9)),
            }
            for k in range(len(course.times))
        ]
        names = list(self.joints)
        return {"joint_trajectory": {"header": {"frame_id": frame}, "joint_names": names, "points": points}}


def start_positions(robot: Model, state: Message) -> dict[str, float]:
    """Return the positions that a `moveit_msgs/msg/RobotState` gives, by plain name of the joint.

    Raises:
        PlanningFailed: A joint does not exist, or a number is invalid.
    """
    names, values = list(state.joint_state.name), list(state.joint_state.position)
    if len(names) != len(values):
        text = f"the robot state has {len(names)} names and {counted(len(values), 'position')}"
        raise PlanningFailed(Code.INVALID_ROBOT_STATE, text)
    positions: dict[str, float] = {}
    for name, value in zip(names, values, strict=True):
        joint = find_joint(robot, name, Code.INVALID_ROBOT_STATE)
        if not np.isfinite(value):
            raise PlanningFailed(Code.INVALID_ROBOT_STATE, f"the position of joint {name!r} is {value}")
        if joint.dof == 1:  # joint states may list fixed joints
            positions[name] = float(value)
    return positions


def find_joint(robot: Model, name: str, code: Code) -> Joint:
    """Return a joint of the robot by plain name.

    Raises:
        PlanningFailed: The joint does not exist.
    """
    if name not in robot.joints:
        near = did_you_mean(name, robot.joints)
        raise PlanningFailed(code, f"robot {robot.name!r} has no joint {name!r}{near and '; ' + near}")
    return robot.joints[name]


def find_link(robot: Model, name: str) -> str:
    """Return the scoped name of a link of the robot.

    Raises:
        PlanningFailed: The link does not exist.
    """
    if name not in robot.links:
        near = did_you_mean(name, robot.links)
        text = f"robot {robot.name!r} has no link {name!r}{near and '; ' + near}"
        raise PlanningFailed(Code.INVALID_LINK_NAME, text)
    return robot.links[name].scoped


def refuse_constraints(constraints: Message, kind: str = "path") -> None:
    """Refuse a request with other constraints than goals, a `moveit_msgs/msg/Constraints`.

    Args:
        constraints: constraints of the request.
        kind: word for the constraints in the message.

    Raises:
        PlanningFailed: There are such constraints.
    """
    fields = ("joint", "position", "orientation", "visibility")
    if any(len(getattr(constraints, f"{name}_constraints")) for name in fields):
        raise PlanningFailed(Code.FAILURE, f"{kind} constraints are not supported")


def fine_positions(model: GroupModel, start: Vector, end: Vector) -> list[Vector]:
    """Return the positions of a straight line that the final check of a path uses, from after its start to its end."""
    count = max(1, int(np.ceil(float(matmul(model.levers, np.abs(end - start))) / _FINE)))
    return [start + (end - start) * (k / count) for k in range(1, count + 1)]


def root_link(robot: Model) -> str:
    """Return the plain name of the first link of the robot that no joint moves."""
    moved = {joint.scene.child_link for joint in robot.joints.values()}
    return next((name for name, link in robot.links.items() if link.scoped not in moved), next(iter(robot.links)))


class Planner:
    """Planner for one request and one group.

    Args:
        sim: Simulation of the robot.
        robot: Robot.
        group: Group of joints.
        state: Positions of joints that differ from the present ones [rad or m].
        surroundings: Obstacles.
        limits: Limits.
        random: Source of random numbers.
    """

    def __init__(
        self,
        sim: Simulation,
        robot: Model,
        group: Group,
        state: Mapping[str, float],
        surroundings: Surroundings,
        limits: Limits,
        random: np.random.Generator,
    ) -> None:
        self._sim, self._robot, self._group, self._limits, self._random = sim, robot, group, limits, random
        self._joints = [robot.joints[name] for name in group.joints]
        self.model = GroupModel(sim, robot, self._joints, state, surroundings.free_joints)
        s = surroundings
        self.model.add_collisions(limits.padding, s.world, s.obstacles, s.allowed)

    # ------------------------------------------------------------------ goals

    def joint_positions(self, constraints: Sequence[Message]) -> Vector:
        """Return the positions that joint constraints ask for; other joints keep their start positions.

        Raises:
            PlanningFailed: A joint is not in the group, or a position is outside the limits.
        """
        goal = self.model.start.copy()
        for constraint in constraints:
            name, value = str(constraint.joint_name), float(constraint.position)
            find_joint(self._robot, name, Code.INVALID_GOAL_CONSTRAINTS)
            if name not in self._group.joints:
                text = f"joint {name!r} is not in group {self._group.name!r}: {', '.join(self._group.joints)}"
                raise PlanningFailed(Code.INVALID_GOAL_CONSTRAINTS, text)
            k = self._group.joints.index(name)
            low, high = self.model.lower[k], self.model.upper[k]
            if not low <= value <= high:
                text = f"joint {name!r} shall go to {value:g}; its limits are {low:g} and {high:g}"
                raise PlanningFailed(Code.GOAL_STATE_INVALID, text)
            goal[k] = value
        return goal

    def pose_solutions(self, goal: PoseGoal, first: Vector, *, avoids_collisions: bool) -> list[Vector]:
        """Return joint positions for a pose, the nearest to the start first.

        Raises:
            PlanningFailed: No positions were found, or all of them collide.
        """
        model, distinct = self.model, []
        colliding: tuple[str, str] | None = None
        for q in solutions(model, goal, seeds_of(model, first, self._random, _IK_SEEDS)):
            if not avoids_collisions or model.is_free(q):
                distinct.append(q)
                if len(distinct) == _GOALS or not avoids_collisions:
                    break
            else:
                colliding = colliding or model.collisions(q)[0]
        if not distinct:
            if colliding is None:
                raise PlanningFailed(Code.NO_IK_SOLUTION, "no joint positions within the limits lead to the pose")
            text = f"the pose is in collision: {' and '.join(colliding)} touch or are too close"
            raise PlanningFailed(Code.GOAL_IN_COLLISION, text)
        return sorted(distinct, key=lambda q: float(matmul(model.levers, np.abs(q - model.start))))

    # ------------------------------------------------------------------ plans

    def plan(self, goals: Sequence[Vector], time: float, speed: float, acceleration: float) -> Plan:
        """Return a plan from the start state to one of the goals.

        Args:
            goals: Positions of the joints, the preferred ones first.
            time: Allowed planning time [s]; 0 for the default.
            speed: Factor of the speed limits; 0 for 1.
            acceleration: Factor of the acceleration limits; 0 for 1.

        Raises:
            PlanningFailed: The start or each goal is in collision, or no path was found.
        """
        if not 0.0 <= time < np.inf:
            text = f"allowed_planning_time is {time:g}; expected seconds, or 0 for {_PLANNING_TIME:g} s"
            raise PlanningFailed(Code.INVALID_MOTION_PLAN, text)
        self._check_start()
        free = [goal for goal in goals if self.model.is_free(goal)]
        if not free:
            text = _touching(self.model.collisions(goals[0]))
            raise PlanningFailed(Code.GOAL_IN_COLLISION, f"the goal is in collision: {text}")
        budget = int(CHECKS_PER_SECOND * (time or _PLANNING_TIME))
        checks = 0
        for padding in (self._limits.padding, self._limits.padding / 2, _FINE / 2):
            planner = PathPlanner(self.model, self._random, padding, budget - checks)
            try:
                path = planner.shorten(planner.plan(self.model.start, free))
            except BudgetSpent:
                text = f"no path was found with {budget} collision checks"
                raise PlanningFailed(Code.TIMED_OUT, text) from None
            checks += planner.checks
            course = self.timed(path, speed, acceleration)
            if course is not None:
                return Plan(self._group.joints, course, checks)
        raise PlanningFailed(Code.PLANNING_FAILED, "each path that was found comes too close to an obstacle")

    def _check_start(self) -> None:
        model, joints = self.model, self._group.joints
        for name, q, low, high in zip(joints, model.start, model.lower, model.upper, strict=True):
            if not low - 1e-3 <= q <= high + 1e-3:
                text = f"joint {name!r} starts at {q:g}; its limits are {low:g} and {high:g}"
                raise PlanningFailed(Code.START_STATE_INVALID, text)
        if not model.is_free(model.start):
            text = f"the start state is in collision: {_touching(model.collisions(model.start))}"
            raise PlanningFailed(Code.START_STATE_IN_COLLISION, text)

    def timed(self, path: Sequence[Vector], speed: float, acceleration: float) -> TimedPath | None:
        """Return the course along a path, with corners as round as the obstacles allow; None if all of them collide."""
        for deviation in (_DEVIATION, _DEVIATION / 4, _DEVIATION / 16, 1e-4):
            corners = round_corners(path, np.full(len(self._joints), deviation))
            course = self.time_samples(corners, speed, acceleration)
            if self.is_free(course):
                return course
        return None

    def time_samples(self, samples: Vector, speed: float, acceleration: float) -> TimedPath:
        """Return the course along a sampled path, shape (samples, joints), within the limits times two factors."""
        return time_path(samples, self._speeds(speed), self._accelerations(acceleration))

    def is_free(self, course: TimedPath) -> bool:
        """Check the points of a course, and positions between them, for collisions."""
        steps = pairwise(course.positions)
        return all(self.model.is_free(q) for a, b in steps for q in fine_positions(self.model, a, b))

    def _speeds(self, factor: float) -> Vector:
        own = self._limits.joints
        limits = [own.get(joint.name, (0.0, 0.0))[0] or joint.scene.axes[0].velocity for joint in self._joints]
        known = np.array([v if v and np.isfinite(v) else 1.0 for v in limits])
        return known * _checked_factor(factor, "max_velocity_scaling_factor")

    def _accelerations(self, factor: float) -> Vector:
        most = self._limits
        common = [
            most.linear_acceleration if joint.type == "prismatic" else most.acceleration for joint in self._joints
        ]
        own = [most.joints.get(joint.name, (0.0, 0.0))[1] for joint in self._joints]
        known = [value or default for value, default in zip(own, common, strict=True)]
        return np.array(known) * _checked_factor(factor, "max_acceleration_scaling_factor")


def _checked_factor(factor: float, name: str) -> float:
    """Return a scaling factor; 0 stands for 1, as in MoveIt."""
    if factor != 0.0 and not _SMALLEST_FACTOR <= factor <= 1.0:
        text = f"{name} is {factor:g}; expected {_SMALLEST_FACTOR:g} to 1, or 0 for 1"
        raise PlanningFailed(Code.INVALID_MOTION_PLAN, text)
    return factor or 1.0


def _touching(pairs: Collection[tuple[str, str]]) -> str:
    listed = [" and ".join(pair) for pair in pairs]
    more = f" and {counted(len(listed) - 3, 'more pair')}" if len(listed) > 3 else ""
    return ", ".join(listed[:3]) + more + " touch or are too close"
