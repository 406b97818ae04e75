"""Referee of lab 12: drives the rover, and compares odometry and filter with the true pose.

| topic | type | meaning |
|---|---|---|
| /cmd_vel | Twist | the drive of the rover, with stops |
| /referee/odometry_error | Float64 | root mean square of the odometry's position error, so far [m] |
| /referee/filter_error | Float64 | the same of /odometry/filtered |
| /referee/error_ratio | Float64 | the second divided by the first, from 10 s on |
| /referee/heading_error | Float64 | heading of /odometry/filtered minus the true one [rad] |
| /referee/heading_sigmas | Float64 | size of this error, divided by the standard deviation in the message |
"""

from __future__ import annotations

import math
from functools import partial

from simkit import WorldPlugin

FLOAT = "std_msgs/msg/Float64"
DRIVE = [  # duration [s], forward speed [m/s], turning speed [rad/s]; repeated
    (4.0, 0.0, 0.0),
    (6.0, 0.6, 0.0),
    (3.0, 0.3, 0.7),
    (5.0, 0.6, -0.15),
]


class Referee(WorldPlugin):
    before_step_rate = 10.0  # [Hz]

    def load(self, parent, params):
        self.rover = parent.model("rover")
        self.start = self.rover.pose
        self.squares = {"/odom": 0.0, "/odometry/filtered": 0.0}  # sums of squared position errors [m²]
        self.counts = dict.fromkeys(self.squares, 0)
        for topic in self.squares:
            self.subscribe(topic, partial(self.compare, topic))
        names = ("odometry_error", "filter_error", "error_ratio", "heading_error", "heading_sigmas")
        self.results = {name: self.advertise(f"/referee/{name}", FLOAT) for name in names}
        self.command = self.advertise("/cmd_vel", "geometry_msgs/msg/Twist")

    def before_step(self):
        forward, turning = self.speeds(self.sim.time)
        self.command.publish({"linear": {"x": forward}, "angular": {"z": turning}})

    def speeds(self, time):
        time %= sum(duration for duration, _, _ in DRIVE)
        for duration, forward, turning in DRIVE:
            if time < duration:
                return forward, turning
            time -= duration
        return 0.0, 0.0

    def compare(self, topic, message):
        """Compare a message with the true pose at the moment at which it arrives."""
        true = self.start.inverse() @ self.rover.pose
        pose = message.pose.pose
        self.counts[topic] += 1
        self.squares[topic] += (pose.position.x - true.position[0]) ** 2 + (pose.position.y - true.position[1]) ** 2
        error = math.sqrt(self.squares[topic] / self.counts[topic])
        if topic == "/odom":
            self.publish("odometry_error", error)
            return
        self.publish("filter_error", error)
        if self.sim.time > 10 and self.counts["/odom"]:
            self.publish("error_ratio", error / math.sqrt(self.squares["/odom"] / self.counts["/odom"]))
        yaw = 2 * math.atan2(pose.orientation.z, pose.orientation.w)
        off = math.remainder(yaw - true.rpy[2], math.tau)
        self.publish("heading_error", off)
        variance = float(message.pose.covariance[35])
        self.publish("heading_sigmas", abs(off) / math.sqrt(variance) if variance > 0 else math.inf)

    def publish(self, name, value):
        self.results[name].publish({"data": float(value)})
