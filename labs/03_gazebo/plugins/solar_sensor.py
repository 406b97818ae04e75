"""Measure the direction of a light: your plugin. Run it with `simkit lab grade .`"""

from __future__ import annotations

import numpy as np

from simkit import ModelPlugin, msgs


class SolarSensor(ModelPlugin):
    def load(self, parent, params):
        # Exercise 1: read the parameters of the model's file.
        # params.text("name", "default") and params.number("name", 0.0, minimum=0); required=True instead of a default.
        # self.sim.light("name") is a light, parent.link("name") a link of the model; both have a `pose`.
        self.frame, self.noise = "", 0.0
        self.after_step_rate = 10.0  # [Hz], calls of after_step
        self.count = 0
        self.draws = self.random("angles", 3)  # self.draws.normal(n): three numbers of deviation 1, for n = 0, 1, 2, …
        self.imu = self.advertise("sunloin_imu", "sensor_msgs/msg/Imu")

    def after_step(self):
        # Exercise 3: the orientation of self.angles() and their noise, and the covariance of this noise.
        # simkit.Pose.from_rpy(0, 0, 0, roll, pitch, yaw).quaternion is an array w, x, y, z.
        w, x, y, z = 1.0, 0.0, 0.0, 0.0
        message = msgs.make(
            "sensor_msgs/msg/Imu",
            header=msgs.header(self.sim.time_ns, self.frame),
            orientation={"x": x, "y": y, "z": z, "w": w},
            orientation_covariance=np.zeros(9),
        )
        self.imu.publish(message)

    def angles(self):
        """Return roll, pitch and yaw [rad] of the light in the axes of the sensor."""
        # Exercise 2: a pose has inverse(), transform(point) and rotate(vector); points are NumPy arrays [m].
        return np.zeros(3)
