"""Drives the robot around, and compares its localisation with the truth of the simulation. The lab gives this file."""

from __future__ import annotations

import math

import numpy as np

from simkit import Pose, WorldPlugin

SPEED, TURNING = 0.22, 1.5  # [m/s], [rad/s]
NEAR, CLEAR = 0.35, 0.6  # [m], the robot turns away from an obstacle that is nearer, until the way is clear
DELAY = 0.1  # [s] between a time and its measurement, so that the transforms at this time are known


class Tour(WorldPlugin):
    """Asks for a localisation, turns the robot once around, drives 3 m, and stops.

    The parameter carried, x [m], y [m] and yaw [rad], begins another tour: the robot starts with a known pose, turns,
    is carried to this place, which the odometry does not notice, and drives for 20 s.
    """

    before_step_rate = 10.0  # [Hz]

    def load(self, parent, params):
        self.carried = params.vector3("carried") if params.has("carried") else None
        self.robot = parent.model("robot")
        self.scan, self.turn, self.side = None, 0.0, 1.0
        self.phase, self.since, self.way, self.last = self.begin, 0.0, 0.0, None
        self.subscribe("/scan", self.take_scan)
        self.command = self.advertise("/cmd_vel", "geometry_msgs/msg/Twist")
        self.initial = self.advertise("/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped")
        self.done = self.advertise("/referee/done", "std_msgs/msg/Bool")

    def take_scan(self, message):
        self.scan = np.asarray(message.ranges)

    def before_step(self):
        speed, turning = self.phase() if self.scan is not None else (0.0, 0.0)
        self.command.publish({"linear": {"x": speed}, "angular": {"z": turning}})

    def next(self, phase):
        self.phase, self.since = phase, self.sim.time
        return 0.0, 0.0

    def begin(self):
        if self.sim.time < 0.5:
            return 0.0, 0.0
        if self.carried is None:
            self.sim.call("/reinitialize_global_localization")
        else:
            x, y, yaw = self.robot.pose.position[0], self.robot.pose.position[1], self.robot.pose.rpy[2]
            pose = {"position": {"x": x, "y": y}, "orientation": {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}}
            covariance = np.diag([0.01, 0.01, 0, 0, 0, 0.01]).ravel()
            self.initial.publish({"header": {"frame_id": "map"}, "pose": {"pose": pose, "covariance": covariance}})
        return self.next(self.look_around)

    def look_around(self):
        if self.sim.time - self.since < math.tau / TURNING + 0.2:
            return 0.0, TURNING
        if self.carried is not None:
            x, y, yaw = self.carried
            self.robot.set_pose(Pose.from_rpy(x, y, 0, 0, 0, yaw))
        return self.next(self.drive)

    def drive(self):
        place = self.robot.pose.position[:2]
        self.way += 0.0 if self.last is None else math.dist(place, self.last)
        self.last = place
        if self.way > 3.0 if self.carried is None else self.sim.time - self.since > 20.0:
            return self.next(self.stop)
        ahead = np.concatenate([self.scan[-30:], self.scan[:30]]).min()
        if self.turn == 0.0 and ahead > NEAR:
            return SPEED, 0.0
        if self.turn == 0.0:  # turn to the side that is free, until the way is clear
            left, right = (np.minimum(self.scan[part], 2).mean() for part in (slice(20, 90), slice(-90, -20)))
            self.turn = TURNING if left > right else -TURNING
        if ahead > CLEAR:
            self.turn = 0.0
        return 0.0, self.turn

    def stop(self):
        if self.sim.time - self.since > 1.0:
            self.done.publish({"data": True})
        return 0.0, 0.0


class Referee(WorldPlugin):
    """Publishes ten times a second on /referee/...:

    position_error, heading_error: of the pose of base_footprint in the frame map [m, deg], from the transforms.
    """

    after_step_rate = 10.0  # [Hz]

    def load(self, parent, params):
        names = ("position_error", "heading_error")
        self.numbers = {name: self.advertise(f"/referee/{name}", "std_msgs/msg/Float64") for name in names}
        self.robot, self.truth = parent.model("robot"), []
        self.sim.tf.frames()  # from here on, transforms are kept

    def after_step(self):
        self.truth.append((self.sim.time, self.robot.pose))
        if self.sim.time - self.truth[0][0] < DELAY - 1e-6:
            return
        time, truth = self.truth.pop(0)
        try:
            found = self.sim.tf.lookup("map", "odom") @ self.sim.tf.lookup("odom", "base_footprint", time=time)
        except LookupError:
            return
        turned = math.remainder(found.rpy[2] - truth.rpy[2], math.tau)
        error = math.dist(found.position[:2], truth.position[:2])
        self.numbers["position_error"].publish({"data": error})
        self.numbers["heading_error"].publish({"data": abs(math.degrees(turned))})
