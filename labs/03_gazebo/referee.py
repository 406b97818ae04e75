"""Referees of lab 3. They listen to your plugins, and publish what they find as std_msgs/msg/Float64.

`HelloReferee` publishes on `/referee/greetings` the number of log messages with the text `<greeting>`.

`SolarReferee` adds simkit's own solar sensor, without noise, to the link `base_solar_sensor`. It publishes on
`/referee/error` the angle [deg] between the two directions at the time of the newest message on `/sunloin_imu`, on
`/referee/rms` the root of the mean square of this angle so far [rad], and on `/referee/mount` the pose of the link
relative to `base_link` (geometry_msgs/msg/Pose).
"""

from __future__ import annotations

import math

import numpy as np

from simkit import Pose, WorldPlugin, msgs

ROBOT, LINK = "solar_waffle", "base_solar_sensor"
SENSOR = """
<sensor name="reference" type="custom" xmlns:gz="http://gazebosim.org/schema" gz:type="solar">
  <update_rate>100</update_rate>
  <topic>/referee/sun</topic>
  <solar><light_name>sunloin</light_name><towards>position</towards></solar>
</sensor>"""


class HelloReferee(WorldPlugin):
    after_step_rate = 10.0  # [Hz]

    def load(self, parent, params):
        self.greeting = params.text("greeting", "")
        self.greetings = 0
        self.found = self.advertise("/referee/greetings", "std_msgs/msg/Float64")
        self.subscribe("/rosout", self.hear)

    def hear(self, message):
        self.greetings += message.msg == self.greeting

    def after_step(self):
        self.found.publish({"data": float(self.greetings)})


class SolarReferee(WorldPlugin):
    after_step_rate = 100.0  # [Hz]

    def load(self, parent, params):
        self.is_added = False
        self.mount = self.advertise("/referee/mount", "geometry_msgs/msg/Pose")
        self.reference = self.measured = None
        self.squares = []
        self.error = self.advertise("/referee/error", "std_msgs/msg/Float64")
        self.rms = self.advertise("/referee/rms", "std_msgs/msg/Float64")
        self.subscribe("/referee/sun", self.take_reference)
        self.subscribe("/sunloin_imu", self.take_measured)

    def after_step(self):
        links = self.sim.model(ROBOT).links
        if LINK not in links:
            return
        if not self.is_added:
            self.sim.contents.add_sensor(f"{ROBOT}::{LINK}", SENSOR)
            self.is_added = True
        self.mount.publish(msgs.pose_message(links["base_link"].pose.inverse() @ links[LINK].pose))

    def take_reference(self, message):
        self.reference = message
        self.compare()

    def take_measured(self, message):
        self.measured = message
        self.compare()

    def compare(self):
        if self.reference is None or self.measured is None:
            return
        if msgs.stamp_ns(self.measured.header.stamp) != msgs.stamp_ns(self.reference.header.stamp):
            return
        first, second = (direction(message.orientation) for message in (self.measured, self.reference))
        angle = math.atan2(np.linalg.norm(np.cross(first, second)), np.dot(first, second))
        self.squares.append(angle**2)
        self.error.publish({"data": math.degrees(angle)})
        self.rms.publish({"data": math.sqrt(np.mean(self.squares))})


def direction(orientation):
    """Return the x axis of an orientation."""
    return Pose(quaternion=(orientation.w, orientation.x, orientation.y, orientation.z)).rotate((1.0, 0.0, 0.0))
