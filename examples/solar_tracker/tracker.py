"""A robot that turns its panel to the sun, with nothing but its solar sensor to tell it where that is.

    simkit run examples/solar_tracker/world.sdf --plugin-path examples/solar_tracker --duration 51 --record day.mcap

`day.py` beside this file runs the day and says what it was worth.
"""

from __future__ import annotations

import math
from typing import Any

from simkit import ModelPlugin, Params
from simkit.pose import quat_rotate

_MOST_EFFORT = 80.0  # [N·m]


class SolarTracker(ModelPlugin):
    """Turns a turntable (about z) and the hinge on it (about y) until the panel's z axis points at the sun.

    Parameters: `<sensor>` (topic of a solar sensor whose frame is the panel's), `<turntable>`, `<hinge>` (joints),
    `<gain>` [1/s], `<top_speed>` [rad/s].
    """

    filenames = ("libsolar_tracker.so",)

    def prepare(self, scene: Any, params: Params, builder: Any) -> None:
        self.servos = [
            builder.add_velocity_servo(
                f"{scene.scoped}::{params.text(name, name)}", max_effort=_MOST_EFFORT, owner="sun"
            )
            for name in ("turntable", "hinge")
        ]

    def load(self, parent: Any, params: Params) -> None:
        self.hinge = parent.joint(params.text("hinge", "hinge"))
        self.gain = params.number("gain", 2.0, minimum=0)
        self.top_speed = params.number("top_speed", 0.5, minimum=0)
        self.listen(params.text("sensor", required=True), "sensor_msgs/msg/Imu", self.turn)

    def turn(self, reading: Any) -> None:
        """Towards the sun, as fast as it is far away; where there is no sun the panel stays where it is."""
        turntable = hinge = 0.0
        if reading.orientation_covariance[0] >= 0:
            q, tilt = reading.orientation, self.hinge.position
            x, y, z = quat_rotate((q.w, q.x, q.y, q.z), (1, 0, 0))
            # from the panel's axes to the turntable's
            x, z = math.cos(tilt) * x + math.sin(tilt) * z, math.cos(tilt) * z - math.sin(tilt) * x
            turntable = self.gain * math.atan2(y, x)
            hinge = self.gain * (math.atan2(math.hypot(x, y), z) - tilt)
        for servo, speed in zip(self.servos, (turntable, hinge), strict=True):
            self.sim.engine.set_control(servo, max(-self.top_speed, min(self.top_speed, speed)))
