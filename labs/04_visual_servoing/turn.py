"""Part 2: turn a TurtleBot3 towards the ball. Run it with `simkit lab grade .`"""

from __future__ import annotations

from simkit import ModelPlugin


class Turn(ModelPlugin):
    def load(self, parent, params):
        # `simkit param set /Turn gain 0.8` changes a parameter during a run; self.gain.value is its present value.
        self.gain = self.declare("gain", 0.5, minimum=0.0, description="decay rate of the error [1/s]")
        self.highest_turn = self.declare("highest_turn", 0.16, minimum=0.0, description="[rad/s]")
        self.dead_band = self.declare("dead_band", 0.003, minimum=0.0, description="error that counts as zero")
        self.command = self.advertise("/cmd_vel", "geometry_msgs/msg/Twist")
        self.subscribe("/ball", self.take_ball)

    def take_ball(self, message):
        self.command.publish({"angular": {"z": self.turn(message.point.x)}})

    def turn(self, x):
        """Return the turning speed [rad/s], positive to the left, for a ball at the image coordinate x."""
        # Exercise: the law of the README, at most self.highest_turn.value in both directions; 0 in the dead band.
        return 0.0
