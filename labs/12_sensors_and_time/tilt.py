"""Complementary filter for the tilt of a pendulum: your plugin. Run it with `simkit lab grade .`"""

from __future__ import annotations

import math

from simkit import WorldPlugin

TIME_CONSTANT = 0.3  # [s]


class Tilt(WorldPlugin):
    def load(self, parent, params):
        self.tilt, self.time = None, 0.0  # [rad], [s]
        self.subscribe("/imu", self.take_imu)
        self.output = self.advertise("/tilt", "std_msgs/msg/Float64")

    def take_imu(self, message):
        time = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
        force, rate = message.linear_acceleration, message.angular_velocity.y
        measured = math.atan2(-force.x, force.z)
        if self.tilt is None:
            self.tilt = measured
        else:
            self.tilt = self.filtered(measured, rate, time - self.time)
        self.time = time
        self.output.publish({"data": self.tilt})

    def filtered(self, measured, rate, period):
        """Return the new tilt [rad] from that of the accelerometer [rad] and the turning rate [rad/s]."""
        # Exercise: trust the gyroscope for changes shorter than TIME_CONSTANT, the accelerometer for longer ones.
        return measured
