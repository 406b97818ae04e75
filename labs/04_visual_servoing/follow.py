"""Part 3: drive a TurtleBot 2 to the ball, and stop in front of it."""

from __future__ import annotations

import numpy as np

from simkit import ModelPlugin

DISTANCE = 0.8  # [m], wanted, from the camera to the ball along the view
CAMERA_AHEAD = -0.087  # [m], from the axle to the camera: the camera is behind the axle


class Follow(ModelPlugin):
    def load(self, parent, params):
        self.gain = self.declare("gain", 0.5, minimum=0.0, description="decay rate of the errors [1/s]")
        self.highest_speed = self.declare("highest_speed", 0.45, minimum=0.0, description="[m/s]")
        self.highest_turn = self.declare("highest_turn", 0.4, minimum=0.0, description="[rad/s]")
        self.command = self.advertise("/mobile_base/commands/velocity", "geometry_msgs/msg/Twist")
        self.subscribe("/ball", self.take_ball)

    def take_ball(self, message):
        speed, turn = self.limited(*self.speeds(message.point.x, message.point.z))
        self.command.publish({"linear": {"x": float(speed)}, "angular": {"z": float(turn)}})

    def speeds(self, x, distance):
        """Return speed [m/s] and turning speed [rad/s] for a ball at the image coordinate x and a distance [m]."""
        # Exercise: write the errors and the interaction matrix (np.array), then solve for the speeds (np.linalg.solve).
        return np.zeros(2)

    def limited(self, speed, turn):
        """Return both speeds, reduced by the same factor if one of them exceeds its limit."""
        # Exercise: the direction of the vector (speed, turn) stays the same.
        return speed, turn
