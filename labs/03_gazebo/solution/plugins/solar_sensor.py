"""Measure the direction of a light: a solution."""

from __future__ import annotations

import math

import numpy as np

from simkit import ModelPlugin, Pose, msgs


class SolarSensor(ModelPlugin):
    def load(self, parent, params):
        self.light = self.sim.light(params.text("light_name", required=True))
        self.frame = params.text("frame_name", required=True)
        self.link = parent.link(self.frame)
        self.after_step_rate = params.number("update_rate", 10.0, minimum=0)  # [Hz]
        self.noise = params.number("gaussian_noise", 0.0, minimum=0)  # [rad]
        self.draws, self.count = self.random("angles", 3), 0
        self.imu = self.advertise("sunloin_imu", "sensor_msgs/msg/Imu")

    def after_step(self):
        roll, pitch, yaw = self.angles() + self.noise * self.draws.normal(self.count)
        self.count += 1
        w, x, y, z = Pose.from_rpy(0, 0, 0, roll, pitch, yaw).quaternion
        message = msgs.make(
            "sensor_msgs/msg/Imu",
            header=msgs.header(self.sim.time_ns, self.frame),
            orientation={"x": x, "y": y, "z": z, "w": w},
            orientation_covariance=(self.noise**2 * np.eye(3)).ravel(),
        )
        self.imu.publish(message)

    def angles(self):
        """Return roll, pitch and yaw [rad] of the light in the axes of the sensor."""
        to_light = self.link.pose.inverse().transform(self.light.pose.position)
        x, y, z = to_light / np.linalg.norm(to_light)
        return np.array([0.0, math.asin(-z), math.atan2(y, x)])
