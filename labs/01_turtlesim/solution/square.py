"""Drive a square with the turtle: a solution."""

from __future__ import annotations

import math

from simkit import ModelPlugin

CORNERS = [(7.544, 5.544), (7.544, 7.544), (5.544, 7.544), (5.544, 5.544)]  # [m]
NEAR = 0.005  # [m]
SPEED_GAIN, TURN_GAIN = 2.0, 4.0  # [1/s]


class Square(ModelPlugin):
    before_step_rate = 20.0  # [Hz]

    def load(self, parent, params):
        self.pose, self.next = None, 0
        self.subscribe("/turtle1/pose", self.take_pose)
        self.command = self.advertise("/turtle1/cmd_vel", "geometry_msgs/msg/Twist")

    def take_pose(self, message):
        self.pose = message

    def before_step(self):
        forward, turning = self.speeds() if self.pose is not None else (0.0, 0.0)
        self.command.publish({"linear": {"x": forward}, "angular": {"z": turning}})

    def speeds(self):
        """Return forward speed [m/s] and turning speed [rad/s]: a proportional controller for each error."""
        while self.next < len(CORNERS):
            x, y = CORNERS[self.next]
            ahead, aside = x - self.pose.x, y - self.pose.y
            distance = math.hypot(ahead, aside)
            if distance < NEAR:
                self.next += 1
                continue
            error = math.remainder(math.atan2(aside, ahead) - self.pose.theta, math.tau)
            forward = min(SPEED_GAIN * distance, 1.0) if abs(error) < 0.02 else 0.0
            return forward, TURN_GAIN * error
        return 0.0, 0.0
