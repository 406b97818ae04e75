"""Kinematics and planning of TIAGo's arm: a solution."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from tiago_arm import Arm

from simkit import ModelPlugin

POSE = pin.SE3(pin.rpy.rpyToMatrix(-0.011, 1.57, 0.037), np.array([0.4, -0.3, 0.26]))  # of the tool, in base_footprint
JOINTS = np.array([0.0, 2.7, 0.2, -2.1, 2.0, 1.0, -0.8, 0.0])  # goal of the joints, after the pose
SEED = 1  # of the random numbers


def forward(arm, q):
    """Return the frames of the joints, a list of pin.SE3, and the pose of the tool, pin.SE3; both in base_footprint."""
    frames, pose = [], pin.SE3.Identity()
    for joint, value in zip(arm.chain, q):
        pose = pose * joint.placement
        frames.append(pose)
        if joint.slides:
            pose = pose * pin.SE3(np.eye(3), joint.axis * value)
        else:
            pose = pose * pin.SE3(pin.exp3(joint.axis * value), np.zeros(3))
    return frames, pose * arm.tool


def jacobian(arm, q):
    """Return the 6 x 8 matrix of the tool's velocity (3 rows linear, 3 angular, axes of base_footprint)."""
    frames, tool = forward(arm, q)
    found = np.zeros((6, len(q)))
    for k, (joint, frame) in enumerate(zip(arm.chain, frames)):
        axis = frame.rotation @ joint.axis
        if joint.slides:
            found[:3, k] = axis
        else:
            found[:3, k] = np.cross(axis, tool.translation - frame.translation)
            found[3:, k] = axis
    return found


def inverse(arm, target, seed, random):
    """Return joint positions with which the tool has the pose target (pin.SE3), without a collision; None if none."""
    for _ in range(20):
        q = np.array(seed, dtype=float)
        for _ in range(150):
            pose = forward(arm, q)[1]
            turn = pin.log3(target.rotation @ pose.rotation.T)
            error = np.concatenate([target.translation - pose.translation, turn])
            if np.abs(error).max() < 1e-6 and arm.is_free(q):
                return q
            j = jacobian(arm, q)
            step = j.T @ np.linalg.solve(j @ j.T + 1e-4 * np.eye(6), error)
            step *= min(1.0, 0.3 / np.abs(step).max())
            q = np.clip(q + step, arm.lower, arm.upper)
        seed = random.uniform(arm.lower, arm.upper)
    return None


def plan(arm, start, goal, random):
    """Return a list of positions from start to goal; the lines between them are free of collisions. None if none."""
    path = connect(arm, start, goal, random)
    return None if path is None else shorten(arm, path, random)


def connect(arm, start, goal, random):
    """RRT-Connect: grow a tree from each end towards random positions, and towards each other."""
    trees = [[(start, None)], [(goal, None)]]  # a tree is a list of positions, each with the index of its parent
    for turn in range(3000):
        grown, other = trees[turn % 2], trees[1 - turn % 2]
        if not extend(arm, grown, random.uniform(arm.lower, arm.upper)):
            continue
        target = grown[-1][0]
        while extend(arm, other, target):
            if np.array_equal(other[-1][0], target):
                there, back = branch(trees[0]), branch(trees[1])
                return there[::-1] + back[1:]
    return None


def extend(arm, tree, target):
    """Add a position to a tree: from its nearest one, one step of 0.3 (rad or m) towards a target; False if blocked."""
    away = np.array([np.linalg.norm(target - q) for q, _ in tree])
    near = int(np.argmin(away))
    start = tree[near][0]
    new = target if away[near] <= 0.3 else start + (target - start) * 0.3 / away[near]
    if not arm.is_line_free(start, new):
        return False
    tree.append((new, near))
    return True


def branch(tree):
    """Return the positions from the newest one of a tree to its root."""
    index, found = len(tree) - 1, []
    while index is not None:
        found.append(tree[index][0])
        index = tree[index][1]
    return found


def shorten(arm, path, random):
    """Replace parts of a path by straight lines, where these are free."""
    for _ in range(60):
        if len(path) < 3:
            break
        i, j = sorted(random.choice(len(path), 2, replace=False))
        if j > i + 1 and arm.is_line_free(path[i], path[j]):
            path = path[: i + 1] + path[j:]
    return path


class Student(ModelPlugin):
    """Plans and executes the two goals, one after the other. Given."""

    before_step_rate = 50.0  # [Hz], calls of before_step

    def load(self, parent, params):
        self.random = np.random.default_rng(SEED)
        self.goals, self.ready = [POSE, JOINTS], 0.5  # [s], when the robot is at rest
        self.subscribe("/joint_states", self.take_joints, keep=1)
        self.tool = self.advertise("/student/tool_pose", "geometry_msgs/msg/PoseStamped")
        self.parts = {
            "torso_controller": ["torso_lift_joint"],
            "arm_controller": [f"arm_{i}_joint" for i in range(1, 8)],
        }
        self.out = {
            name: self.advertise(f"/{name}/joint_trajectory", "trajectory_msgs/msg/JointTrajectory")
            for name in self.parts
        }
        self.positions = None

    def take_joints(self, message):
        at = dict(zip(message.name, message.position))
        self.positions = np.array([at[name] for name in arm().names])

    def before_step(self):
        if self.positions is None or self.sim.time < self.ready:
            return
        self.publish_tool()
        self.ready = np.inf
        if self.goals:
            self.move(self.goals.pop(0))

    def publish_tool(self):
        _, pose = forward(arm(), self.positions)
        x, y, z, w = pin.Quaternion(pose.rotation).coeffs()
        place = dict(zip("xyz", map(float, pose.translation)))
        turn = {"x": float(x), "y": float(y), "z": float(z), "w": float(w)}
        self.tool.publish({"header": {"frame_id": "base_footprint"}, "pose": {"position": place, "orientation": turn}})

    def move(self, goal):
        if isinstance(goal, pin.SE3):
            goal = inverse(arm(), goal, self.positions, self.random)
            if goal is None:
                print("inverse() found no joint positions for the pose")
                return
        path = plan(arm(), self.positions, goal, self.random)
        if path is None:
            print("plan() found no path")
            return
        timed = arm().timed(path)
        for name, joints in self.parts.items():
            self.out[name].publish(arm().message(timed, joints))
        self.ready = self.sim.time + timed[0][-1] + 1.0  # the robot comes to rest


def arm(made=[]):  # noqa: B006  the list keeps the arm, which takes 0.3 s to build
    if not made:
        made.append(Arm())
    return made[0]
