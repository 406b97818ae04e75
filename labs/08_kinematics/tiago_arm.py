"""TIAGo's torso and arm for the exercise: a chain of joints, a collision check and the timing of a path. Given."""

from __future__ import annotations

from collections import namedtuple
from itertools import pairwise
from pathlib import Path

import coal  # Pinocchio needs it for collisions
import numpy as np
import pinocchio as pin

import simkit

TOOL = "arm_tool_link"
Joint = namedtuple("Joint", "name slides placement axis")
# name: as in /joint_states; slides: True for the torso, which moves along its axis [m]; False: turns [rad];
# placement: pose of the joint in the frame of the joint before, pin.SE3; axis: unit vector in the joint's own frame


class Arm:
    """Torso and arm. All positions are arrays of 8 numbers: torso_lift_joint [m], arm_1_joint … arm_7_joint [rad].

    chain: list of `Joint`, from the base to the tool
    tool: pose of the tool in the frame of the last joint, pin.SE3
    lower, upper: limits of the positions
    speeds, accelerations: largest ones [m/s, rad/s] and [m/s², rad/s²]
    """

    def __init__(self):
        folder = Path(simkit.__file__).resolve().parent
        file = next(f for f in (folder / "assets", folder.parent / "assets") if f.is_dir()) / "tiago" / "tiago.urdf"
        self.names = ["torso_lift_joint"] + [f"arm_{i}_joint" for i in range(1, 8)]
        whole = pin.buildModelFromUrdf(str(file))
        shapes = pin.buildGeomFromUrdf(whole, str(file), pin.GeometryType.COLLISION)
        fixed = [whole.getJointId(name) for name in whole.names[1:] if name not in self.names]
        self._model, self._shapes = pin.buildReducedModel(whole, shapes, fixed, pin.neutral(whole))
        self._choose_pairs()
        self._data, self._shape_data = self._model.createData(), self._shapes.createData()
        for request in self._shape_data.collisionRequests:
            request.security_margin = 0.003  # [m] that two links keep: the real motion follows the plan to 1 mm
        self.chain = []
        for name, placement in zip(self._model.names[1:], list(self._model.jointPlacements)[1:]):
            pin.forwardKinematics(self._model, self._data, np.zeros(8), np.eye(8)[len(self.chain)])
            speed = self._data.v[self._model.getJointId(name)]  # of this joint alone, at 1 m/s or 1 rad/s
            slides = name == "torso_lift_joint"
            self.chain.append(Joint(name, slides, placement, (speed.linear if slides else speed.angular).copy()))
        self.tool = self._model.frames[self._model.getFrameId(TOOL)].placement
        self.lower, self.upper = self._model.lowerPositionLimit.copy(), self._model.upperPositionLimit.copy()
        self.speeds = self._model.upperVelocityLimit.copy()
        self.accelerations = np.array([0.2] + [2.0] * 7)

    def _choose_pairs(self):
        """Check all pairs of links that move relative to each other, except those that touch nearly always."""
        parent = [shape.parentJoint for shape in self._shapes.geometryObjects]
        above = list(self._model.parents)
        pairs = [(i, k) for k in range(len(parent)) for i in range(k) if parent[i] != parent[k]]
        pairs = [(i, k) for i, k in pairs if above[parent[i]] != parent[k] and above[parent[k]] != parent[i]]
        for pair in pairs:
            self._shapes.addCollisionPair(pin.CollisionPair(*pair))
        data, shape_data, random = self._model.createData(), self._shapes.createData(), np.random.default_rng(0)
        touched, count = np.zeros(len(pairs)), 100
        for _ in range(count):
            q = random.uniform(self._model.lowerPositionLimit, self._model.upperPositionLimit)
            pin.computeCollisions(self._model, data, self._shapes, shape_data, q, False)
            touched += [result.isCollision() for result in shape_data.collisionResults]
        self._shapes.removeAllCollisionPairs()
        for pair, times in zip(pairs, touched):
            if times < count / 2:
                self._shapes.addCollisionPair(pin.CollisionPair(*pair))

    def is_free(self, q):
        """Return True if no two links touch at these positions."""
        return not pin.computeCollisions(self._model, self._data, self._shapes, self._shape_data, np.array(q), True)

    def is_line_free(self, start, end):
        """Return True if no two links touch on the straight line from start to end, checked every 0.02 rad or m."""
        count = int(np.ceil(np.abs(end - start).max() / 0.02)) + 1
        return all(self.is_free(start + (end - start) * k / count) for k in range(1, count + 1))

    def timed(self, path):
        """Return the points of a trajectory along straight lines: lists of times [s], positions and velocities.

        Each line starts and ends at rest with the speed v(s) = 6 v s (1 - s), whose peak is 1.5 times its mean. So a
        line that is d long takes at least 1.5 d / speed, and sqrt(6 d / acceleration), for the slowest joint.
        """
        times, positions, velocities = [0.0], [np.array(path[0])], [np.zeros(8)]
        for a, b in pairwise(path):
            way = np.abs(b - a)
            period = max(np.max(1.5 * way / self.speeds), np.max(np.sqrt(6 * way / self.accelerations)), 0.1) * 1.02
            begin, count = times[-1], int(np.ceil(period / 0.1))
            for s in np.arange(1, count + 1) / count:
                times.append(begin + s * period)
                positions.append(a + (b - a) * (3 * s**2 - 2 * s**3))
                velocities.append((b - a) * 6 * s * (1 - s) / period)
        return times, positions, velocities

    def message(self, timed, joints):
        """Return a trajectory_msgs/msg/JointTrajectory for some of the joints."""
        columns, points = [self.names.index(name) for name in joints], []
        for time, position, velocity in list(zip(*timed))[1:]:
            point = {"positions": list(position[columns]), "velocities": list(velocity[columns])}
            points.append({**point, "time_from_start": {"sec": int(time), "nanosec": int(time % 1 * 1e9)}})
        return {"joint_names": list(joints), "points": points}
