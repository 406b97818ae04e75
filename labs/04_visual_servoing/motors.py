"""Motors with friction: they pass a turning speed on to the drive, but one below 0.05 rad/s does not move the robot."""

from __future__ import annotations

from simkit import ModelPlugin

LEAST = 0.05  # [rad/s]


class Motors(ModelPlugin):
    def load(self, parent, params):
        self.drive = self.advertise("/cmd_vel", "geometry_msgs/msg/Twist")
        self.subscribe("/motors/cmd_vel", self.take_command)

    def take_command(self, message):
        turn = message.angular.z
        self.drive.publish({"angular": {"z": turn if abs(turn) >= LEAST else 0.0}})
