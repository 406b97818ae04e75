"""PID controller of a carriage: your plugin. Run it with `simkit lab grade .`"""

from __future__ import annotations

from simkit import ModelPlugin

FORCE_LIMIT = 60.0  # [N], the largest force of the motor


class Pid(ModelPlugin):
    def load(self, parent, params):
        self.joint = parent.joint("slide")
        # Live parameters: `self.kp.value` is always the current value. Exercise: compute good first values.
        self.kp = self.declare("kp", 0.0, minimum=0, description="force for an error [N/m]")
        self.ki = self.declare("ki", 0.0, minimum=0, description="force for the integral of the error [N/(m s)]")
        self.kd = self.declare("kd", 0.0, minimum=0, description="force for a speed [N s/m]")
        self.reference = 0.0  # [m]
        self.integral = 0.0
        self.listen("/reference", "std_msgs/msg/Float64", self.take_reference)
        self.force_topic = self.advertise("/force", "std_msgs/msg/Float64")

    def take_reference(self, message):
        self.reference = message.data

    def before_step(self):
        force = self.force(self.reference - self.joint.position, self.joint.velocity, self.sim.timestep)
        self.joint.set_effort(force)
        self.force_topic.publish({"data": force})

    def force(self, error, speed, period):
        """Return the force [N] for an error [m] and a speed [m/s]; the period is the time between two calls [s]."""
        # Exercise: the three parts of a PID controller, and the limit of the motor.
        return 0.0
