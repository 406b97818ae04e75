import simkit


class Wander(simkit.ModelPlugin):
    """Plugin that a student submits."""

    before_step_rate = 10.0

    def load(self, parent, params):
        self.command = self.advertise("/cmd_vel", "geometry_msgs/msg/Twist")
        self.speed = params.number("speed", 0.2)

    def before_step(self):
        self.command.publish({"linear": {"x": self.speed}})
