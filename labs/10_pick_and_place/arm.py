"""Moves TIAGo's hand through poses. The lab gives this file; its theory is that of lab 8.

The way to the first pose is planned by the plugin move_group, under the names of MoveIt: neither the robot nor an
object in its hand touches anything. Straight lines are computed here by inverse kinematics. The torso keeps its height.
"""

from __future__ import annotations

import functools
import itertools

import numpy as np
import pinocchio as pin

from simkit import WorldPlugin, msgs
from simkit.loaders.resources.bundled_models import bundled_folders

ARM = tuple(f"arm_{number}_joint" for number in range(1, 8))
HAND = "gripper_grasping_frame"
CONTROLLER, PLANNER = "/arm_controller/follow_joint_trajectory", "/plan_kinematic_path"
SPEED = 0.6  # share of the joints' speed limits on a free way
PLANNING_TIME = 2.0  # [s]
JOINT_SPEED = 0.8  # [rad/s], mean speed of the fastest joint along a straight line
HAND_SPEED = 0.08  # [m/s], mean speed along a straight line
STEP, TURN = 0.01, 0.3  # [m] between two points of a straight line; [rad], most that a joint turns from one to the next
SEEDS = 30  # number of positions from which the inverse kinematics begins
NEAR_LIMIT = 0.02  # [rad] that the solutions stay away from a joint's limits
EXACT = 1e-4  # [m] and [rad], error of a solution


@functools.cache
def robot_model():
    """Return TIAGo's kinematic model; its base is the frame base_footprint."""
    return pin.buildModelFromUrdf(str(bundled_folders("assets")[0] / "tiago" / "tiago.urdf"))


class NoWayError(Exception):
    """The arm cannot move the hand as a goal wants."""


class Arm(WorldPlugin):
    """Offers the action /arm/move_hand (lab_arm/action/MoveHand) and the service /arm/can_reach (lab_arm/srv/CanReach).

    A way that can_reach has planned is taken by the next goal with the same poses.
    """

    def load(self, parent, params):
        self.joints, self.goal, self.planned = {}, None, ([], [])
        self.subscribe("/joint_states", self.take_joints)
        self.act("/arm/move_hand", "lab_arm/action/MoveHand", self.move)
        self.offer("/arm/can_reach", "lab_arm/srv/CanReach", self.can_reach)

    def take_joints(self, message):
        self.joints = dict(zip(message.name, map(float, message.position), strict=True))

    def can_reach(self, request):
        poses = [msgs.pose(pose) for pose in request.poses]
        try:
            self.planned = poses, self.plan(poses, straight=False)
        except NoWayError as error:
            return {"success": False, "message": str(error)}
        return {"success": True}

    def move(self, goal):
        if self.goal is not None:
            goal.reject("the hand moves already")
            return
        poses, straight = [msgs.pose(pose) for pose in goal.request.poses], goal.request.straight
        planned_poses, points = self.planned
        self.planned = [], []
        try:
            if straight or poses != planned_poses:
                points = self.plan(poses, straight)
        except NoWayError as error:
            goal.reject(str(error))
            return
        self.goal = goal
        trajectory = {"joint_names": list(ARM), "points": [as_message(*point) for point in points]}
        self.sim.send_goal(CONTROLLER, {"trajectory": trajectory}, on_done=self.moved)

    def moved(self, controller_goal):
        goal, self.goal = self.goal, None
        if controller_goal.status.name == "SUCCEEDED":
            goal.succeed()
        else:
            goal.abort({"message": controller_goal.reason}, controller_goal.reason)

    # ------------------------------------------------------------------ planning

    def plan(self, poses, straight):
        """Return the points of a trajectory through the poses: positions [rad], velocities [rad/s], time [s]."""
        if not poses:
            raise NoWayError("there is no pose")
        kinematics = Kinematics(self.joints)
        targets = [pin.SE3(pose.matrix, pose.position) for pose in poses]
        if straight:
            targets = [kinematics.hand(kinematics.start), *targets]
            begins = [kinematics.start]
        else:
            begins = kinematics.solutions(targets[0])
        if not begins:
            raise NoWayError(f"the hand does not reach {np.round(poses[0].position, 3)}")
        lines = [kinematics.lines(targets, begin) for begin in begins]
        lines = [line for line in lines if line is not None]
        if not lines:
            raise NoWayError("the hand cannot move along the straight lines between the poses")
        points = [] if straight else self.free_way([line[0] for line in lines])
        if not points:
            return line_points(lines[0], 0.0)
        end, _, seconds = points[-1]
        return points + line_points(min(lines, key=lambda line: np.abs(line[0] - end).max()), seconds)

    def free_way(self, ends):
        """Return the points of a trajectory to one of several positions; it touches nothing."""
        goals = [
            {"joint_constraints": [{"joint_name": n, "position": float(q)} for n, q in zip(ARM, end, strict=True)]}
            for end in ends
        ]
        request = {"group_name": "arm", "goal_constraints": goals}
        request |= {"max_velocity_scaling_factor": SPEED, "max_acceleration_scaling_factor": SPEED}
        request["allowed_planning_time"] = PLANNING_TIME
        answer = self.sim.call(PLANNER, {"motion_plan_request": request}).motion_plan_response
        if answer.error_code.val != answer.error_code.SUCCESS:
            raise NoWayError(answer.error_code.message)
        found = answer.trajectory.joint_trajectory
        order = [list(found.joint_names).index(name) for name in ARM]
        times = [one.time_from_start.sec + one.time_from_start.nanosec * 1e-9 for one in found.points]
        return [
            (np.asarray(one.positions)[order], np.asarray(one.velocities)[order], time)
            for one, time in zip(found.points, times, strict=True)
            if time > 0
        ]


class Kinematics:
    """Kinematics of the arm, with the other joints at the given positions."""

    def __init__(self, positions):
        self.model = robot_model()
        self.data, self.q = self.model.createData(), pin.neutral(self.model)
        for name, position in positions.items():
            if self.model.existJointName(name) and self.joint(name).nq == 1:
                self.q[self.joint(name).idx_q] = position
        self.rows = [self.joint(name).idx_q for name in ARM]
        self.columns = [self.joint(name).idx_v for name in ARM]
        self.low = self.model.lowerPositionLimit[self.rows] + NEAR_LIMIT
        self.high = self.model.upperPositionLimit[self.rows] - NEAR_LIMIT
        self.frame = self.model.getFrameId(HAND)
        self.start = self.q[self.rows].copy()

    def joint(self, name):
        return self.model.joints[self.model.getJointId(name)]

    def hand(self, position):
        """Return the pose of the hand in the frame of the base."""
        self.q[self.rows] = position
        pin.computeJointJacobians(self.model, self.data, self.q)
        return pin.updateFramePlacement(self.model, self.data, self.frame).copy()

    def solve(self, target, position):
        """Return positions with which the hand has a pose, by damped least squares; None if they do not converge."""
        position = np.clip(position, self.low, self.high)
        for _ in range(60):
            error = pin.log6(self.hand(position).actInv(target)).vector
            if np.linalg.norm(error) < EXACT:
                return position
            jacobian = pin.getFrameJacobian(self.model, self.data, self.frame, pin.LOCAL)[:, self.columns]
            position = np.clip(position + self.step(jacobian, error, position), self.low, self.high)
        return None

    def step(self, jacobian, error, position):
        """Return a step of the joints; those at a limit that would leave it are held, and the others do their work."""
        moves = np.ones(len(ARM))
        while True:
            used = jacobian * moves
            step = np.clip(used.T @ np.linalg.solve(used @ used.T + 1e-5 * np.eye(6), error), -TURN, TURN)
            leaves = ((position <= self.low) & (step < 0)) | ((position >= self.high) & (step > 0))
            if not leaves.any():
                return step
            moves[leaves] = 0.0

    def solutions(self, target):
        """Return positions with which the hand has a pose, the nearest to the present position first."""
        seeds = np.random.default_rng(0).uniform(self.low, self.high, (SEEDS, len(ARM)))
        found = (self.solve(target, seed) for seed in (self.start, *seeds))
        return sorted((p for p in found if p is not None), key=lambda position: np.abs(position - self.start).max())

    def lines(self, targets, position):
        """Return positions along straight lines between poses, (n, 7); None if an arm of another shape is needed."""
        found = [np.array(position)]
        for first, last in itertools.pairwise(targets):
            count = max(1, round(np.linalg.norm(last.translation - first.translation) / STEP))
            for share in np.arange(1, count + 1) / count:
                position = self.solve(pin.SE3.Interpolate(first, last, share), found[-1])
                if position is None or np.abs(position - found[-1]).max() > TURN:
                    return None
                found.append(position)
        return np.array(found)


def line_points(line, begin):
    """Return the points of a trajectory along a line that begins at a time [s]; its speed is a half wave of a sine."""
    if len(line) == 1:
        return []
    seconds = max(STEP * len(line) / HAND_SPEED, np.abs(np.diff(line, axis=0)).sum(axis=0).max() / JOINT_SPEED)
    times = begin + seconds * np.arccos(1 - 2 * np.linspace(0, 1, len(line))) / np.pi
    speeds = np.gradient(line, times, axis=0)
    speeds[-1] = 0.0
    return list(zip(line[1:], speeds[1:], times[1:], strict=True))


def as_message(positions, velocities, seconds):
    """Return a point of a trajectory as a message."""
    nanoseconds = round(float(seconds) * 1e9)
    time = {"sec": nanoseconds // 10**9, "nanosec": nanoseconds % 10**9}
    return {"positions": list(positions), "velocities": list(velocities), "time_from_start": time}
