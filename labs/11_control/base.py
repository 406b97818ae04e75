"""Drive TIAGo's base 1 m ahead, and turn it to the left: your plugin. Run it with `simkit lab grade .`"""

from __future__ import annotations

import math

from simkit import ModelPlugin

SPEED = 0.3  # [m/s]
WAY, TURN = 1.0, math.pi / 2  # [m], [rad]


class Base(ModelPlugin):
    before_step_rate = 3.0  # [Hz], calls of before_step

    def load(self, parent, params):
        self.pose = None  # newest pose of the odometry: position.x, position.y, orientation (a quaternion)
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
        # Exercise: compare self.pose with WAY, then with TURN.
        return 0.0, 0.0
