"""A sensor of one's own, from nothing: a model plugin that tells in which direction a lamp is.

    simkit run examples/solar_sensor_plugin/world.sdf --plugin-path examples/solar_sensor_plugin --record sun.mcap

It shows what most plugins need: parameters read by type, an error that names what there is, links and lights by name,
a topic, a rate, repeatable noise, and a state that survives reset and snapshots without a line about it.
"""

from __future__ import annotations

import math

import numpy as np

from simkit import Model, ModelPlugin, Params, Pose, msgs


class SolarCompass(ModelPlugin):
    """Publishes an orientation on `solar_compass` whose x axis points from the mast at the lamp.

    Parameters: `<lamp>` (required), `<mast>` (link, default `mast`), `<rate>` [Hz], `<noise>` (deviation of both
    angles [rad]).
    """

    filenames = ("libsolar_compass.so",)

    def load(self, parent: Model, params: Params) -> None:
        lamp = params.text("lamp", required=True)
        if lamp not in self.sim.contents.lights:
            params.error(
                "SK-PLUGIN-003", f"there is no lamp {lamp!r}; lights are: {', '.join(sorted(self.sim.contents.lights))}"
            )
            return
        self.lamp = self.sim.light(lamp)
        self.mast = parent.link(params.text("mast", "mast"))
        self.noise = params.number("noise", 0.0, minimum=0)
        self.after_step_rate = params.number("rate", 10.0, minimum=0)
        self.readings = 0
        self.draws = self.random("angles", 2)
        self.compass = self.advertise("solar_compass", "sensor_msgs/msg/Imu")

    def after_step(self) -> None:
        self.readings += 1
        x, y, z = direction(self.mast.pose, self.lamp.pose.position)
        elevation, azimuth = math.atan2(z, math.hypot(x, y)), math.atan2(y, x)
        if self.noise > 0:
            first, second = self.draws.normal(self.readings)
            elevation, azimuth = elevation + self.noise * first, azimuth + self.noise * second
        # to look up is to pitch backwards
        qw, qx, qy, qz = Pose.from_rpy(0, 0, 0, 0, -elevation, azimuth).quaternion
        message = msgs.make(
            "sensor_msgs/msg/Imu",
            header=msgs.header(self.sim.time_ns, self.mast.name),
            orientation={"x": float(qx), "y": float(qy), "z": float(qz), "w": float(qw)},
            orientation_covariance=np.diag([0.0, self.noise**2, self.noise**2]).reshape(9),
        )
        self.compass.publish(message)


def direction(observer: Pose, target: np.ndarray) -> np.ndarray:
    """Unit vector from the observer to the target [m, world], in the observer's own axes."""
    seen = observer.inverse().transform(target)
    return np.asarray(seen / np.linalg.norm(seen))
