"""Mistake: drives by time and speed, without looking at the pose."""

from simkit import ModelPlugin


class Square(ModelPlugin):
    before_step_rate = 20.0

    def load(self, parent, params):
        self.command = self.advertise("/turtle1/cmd_vel", "geometry_msgs/msg/Twist")

    def before_step(self):
        phase, side = self.sim.time % 4.0, int(self.sim.time // 4.0)
        drives, turns = phase < 2.0 and side < 4, phase >= 2.0 and side < 4
        forward, turning = (1.0 if drives else 0.0), (3.1416 / 4 if turns else 0.0)
        self.command.publish({"linear": {"x": forward}, "angular": {"z": turning}})
