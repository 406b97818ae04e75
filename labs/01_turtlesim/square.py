"""Drive a square with the turtle: your plugin. Run it with `simkit lab grade .`"""

from __future__ import annotations

from simkit import ModelPlugin

CORNERS = [(7.544, 5.544), (7.544, 7.544), (5.544, 7.544), (5.544, 5.544)]  # [m]


class Square(ModelPlugin):
    before_step_rate = 20.0  # [Hz], calls of before_step

    def load(self, parent, params):
        self.pose = None  # newest message of the type turtlesim/msg/Pose: x, y, theta
        self.subscribe("/turtle1/pose", self.take_pose)
        self.command = self.advertise("/turtle1/cmd_vel", "geometry_msgs/msg/Twist")

    def take_pose(self, message):
        self.pose = message

    def before_step(self):
        # Exercise: compare self.pose with the next corner, and publish forward speed and turning speed.
        self.command.publish({"linear": {"x": 0.0}, "angular": {"z": 0.0}})
