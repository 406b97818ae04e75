"""Drives straight on, whatever is ahead."""

from simkit import ModelPlugin


class Straight(ModelPlugin):
    before_step_rate = 10.0

    def load(self, parent, params):
        self.speed = params.number("speed", 0.18)
        self.command = self.advertise("/cmd_vel", "geometry_msgs/msg/Twist")

    def before_step(self):
        self.command.publish({"linear": {"x": self.speed}})
