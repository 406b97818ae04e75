"""Kalman filter for the heading of a rover: your plugin. Run it with `simkit lab grade .`"""

from __future__ import annotations

import math

import numpy as np

from simkit import WorldPlugin

NOISE_DENSITY = 1e-3  # [rad/s/sqrt(Hz)], of the gyroscope
FIRST_BIAS = 0.05  # [rad/s], standard deviation of the bias before the first measurement
STANDING = 1e-3  # [m/s], [rad/s], largest speeds of the wheels at rest


class Heading(WorldPlugin):
    def load(self, parent, params):
        self.state = np.zeros(2)  # heading [rad], bias of the gyroscope [rad/s]
        self.covariance = np.diag([0.0, FIRST_BIAS**2])
        self.place = np.zeros(2)  # [m]
        self.speed, self.is_standing = 0.0, True
        self.times = {}  # time of the newest message [s], by topic
        self.subscribe("/odom", self.take_odometry)
        self.subscribe("/imu", self.take_imu)
        self.odometry = self.advertise("/odometry/filtered", "nav_msgs/msg/Odometry")
        self.bias = self.advertise("/bias", "std_msgs/msg/Float64")

    def take_imu(self, message):
        period = self.period("imu", message.header.stamp)
        rate = message.angular_velocity.z
        if period:
            self.predict(rate, period)
            if self.is_standing:
                self.correct(rate, NOISE_DENSITY**2 / period)
        self.bias.publish({"data": float(self.state[1])})

    def take_odometry(self, message):
        period = self.period("odom", message.header.stamp)
        self.speed = message.twist.twist.linear.x
        turning = message.twist.twist.angular.z
        self.is_standing = False  # Exercise: when do the wheels stand?
        self.state[0] += turning * period  # Exercise: replace the turning of the wheels by `predict` and `correct`.
        heading = self.state[0]
        self.place += self.speed * period * np.array([math.cos(heading), math.sin(heading)])
        self.publish(message.header)

    def predict(self, rate, period):
        """Turn the heading by the measured rate [rad/s] without the bias, over a period [s]."""
        # Exercise: the new state, and its covariance: jacobian @ covariance @ jacobian.T + noise.

    def correct(self, rate, variance):
        """Correct by a rate that was measured at rest: it is the bias, with a variance."""
        # Exercise: gain, state, covariance.

    def period(self, topic, stamp):
        """Return the time since the last message of a topic [s]; 0 for the first one."""
        time = stamp.sec + stamp.nanosec * 1e-9
        before = self.times.get(topic, time)
        self.times[topic] = time
        return time - before

    def publish(self, header):
        heading, covariance = self.state[0], np.zeros(36)
        covariance[35] = self.covariance[0, 0]
        orientation = {"z": math.sin(heading / 2), "w": math.cos(heading / 2)}
        pose = {"position": {"x": self.place[0], "y": self.place[1]}, "orientation": orientation}
        filtered = {"pose": pose, "covariance": covariance}
        self.odometry.publish({"header": header, "child_frame_id": "base_link", "pose": filtered})
