"""Step 6: a light that moves, a sensor that says where it is, and a visual that shows it.

simkit run sun.sdf --plugin-path . --duration 12 --record sun.mcap
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from simkit import Params, Pose, SensorPlugin, Simulation, Visual, VisualPlugin, WorldPlugin, msgs


class SunWalk(WorldPlugin):
    """Leads the light `<light>` from the east over the sky to the west, in `<day>` [s], at `<distance>` [m]."""

    filenames = ("libsun_walk.so",)
    after_step_rate = 20.0

    def load(self, parent: Simulation, params: Params) -> None:
        self.lamp = parent.light(params.text("light", "sun"))
        self.day = params.number("day", 12.0, minimum=1e-3)
        self.distance = params.number("distance", 50.0, minimum=1e-3)
        self.after_step()

    def after_step(self) -> None:
        angle = math.pi * self.sim.time / self.day
        self.lamp.set_pose(Pose((self.distance * math.cos(angle), 0.0, self.distance * math.sin(angle))))


class SunCompass(SensorPlugin):
    """Publishes with each reading of its IMU the elevation [rad] of `<light>` over the sensor's own x-y plane."""

    filenames = ("libsun_compass.so",)

    def load(self, parent: Any, params: Params) -> None:
        if parent.kind != "imu":
            self.refuse(parent, "imu")
            return
        self.sensor = parent
        self.lamp = self.sim.light(params.text("light", "sun"))
        self.elevation = self.advertise("sun/elevation", "std_msgs/msg/Float64")
        self.subscribe(parent.topic, self.tell)

    def tell(self, _reading: Any) -> None:
        x, y, z = self.sensor.pose.inverse().transform(self.lamp.pose.position)
        self.elevation.publish(msgs.make("std_msgs/msg/Float64", data=math.atan2(z, math.hypot(x, y))))


class SunDial(VisualPlugin):
    """Is as bright as the light stands high: black at the horizon, `<colour>` at the zenith."""

    filenames = ("libsun_dial.so",)
    after_step_rate = 5.0

    def load(self, parent: Visual, params: Params) -> None:
        self.visual = parent
        self.colour = np.array(params.vector3("colour", (1.0, 0.8, 0.0)))
        self.lamp = self.sim.light(params.text("light", "sun"))

    def after_step(self) -> None:
        towards = self.lamp.pose.position - self.visual.pose.position
        height = max(0.0, float(towards[2] / np.linalg.norm(towards)))
        self.visual.set_colour(*(height * self.colour))
