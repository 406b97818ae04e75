"""Kinematics and planning of TIAGo's arm: your file. Run it with `simkit lab grade .`"""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from tiago_arm import Arm

from simkit import ModelPlugin

POSE = pin.SE3(pin.rpy.rpyToMatrix(-0.011, 1.57, 0.037), np.array([0.4, -0.3, 0.26]))  # of the tool, in base_footprint
JOINTS = np.array([0.0, 2.7, 0.2, -2.1, 2.0, 1.0, -0.8, 0.0])  # goal of the joints, after the pose
SEED = 1  # of the random numbers


def forward(arm, q):
    """Return the frames of the joints, a list of pin.SE3, and the pose of the tool, pin.SE3; both in base_footprint.

    A frame is the pose of the joint's axis before the joint moves. Poses are multiplied with `*`.
    pin.SE3(rotation, translation) makes one; pin.exp3(axis * angle) is a rotation matrix about an axis.
    """
    frames, pose = [], pin.SE3.Identity()
    for joint, value in zip(arm.chain, q):  # noqa: B007
        frames.append(pose)
        # Exercise 1: go to the joint by joint.placement, note the frame, and let the joint slide or turn by value.
    return frames, pose * arm.tool


def jacobian(arm, q):
    """Return the 6 x 8 matrix of the tool's velocity (3 rows linear, 3 angular, axes of base_footprint)."""
    found = np.zeros((6, len(q)))
    # Exercise 2: a column for each joint; np.cross is the cross product, frame.rotation @ axis turns an axis.
    return found


def inverse(arm, target, seed, random):
    """Return joint positions with which the tool has the pose target (pin.SE3), without a collision; None if none.

    seed: positions to begin with; random: np.random.Generator, whose uniform(low, high) gives others.
    pin.log3(R) is the rotation vector [rad] of a rotation matrix.
    """
    # Exercise 3: damped least squares, within arm.lower and arm.upper; a solution must be arm.is_free.
    return None


def plan(arm, start, goal, random):
    """Return a list of positions from start to goal; the lines between them are free of collisions. None if none."""
    # Exercise 4: two trees, RRT-Connect; then shorten the path. The straight line alone is the naive way.
    return [start, goal]


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
