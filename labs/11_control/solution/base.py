"""Drive TIAGo's base 1 m ahead, and turn it to the left: a solution."""

from __future__ import annotations

import math

from simkit import ModelPlugin

SPEED = 0.3  # [m/s]
WAY, TURN = 1.0, math.pi / 2  # [m], [rad]


class Base(ModelPlugin):
    before_step_rate = 20.0  # [Hz]

    def load(self, parent, params):
        self.pose = None
        self.is_ahead = False  # True after the way ahead
        self.subscribe("/mobile_base_controller/odom", self.take_odometry)
        self.command = self.advertise("/mobile_base_controller/cmd_vel_unstamped", "geometry_msgs/msg/Twist")

    def take_odometry(self, message):
        self.pose = message.pose.pose

    def before_step(self):
        if self.pose is not None:
            forward, turning = self.speeds()
            self.command.publish({"linear": {"x": forward}, "angular": {"z": turning}})

    def speeds(self):
        """Return forward speed [m/s] and turning speed [rad/s]."""
        remaining = WAY - self.pose.position.x
        yaw = 2 * math.atan2(self.pose.orientation.z, self.pose.orientation.w)
        if remaining > 0.005 and not self.is_ahead:
            return min(SPEED, 2.0 * remaining), 0.0
        self.is_ahead = True
        return 0.0, min(0.5, 2.0 * (TURN - yaw))
