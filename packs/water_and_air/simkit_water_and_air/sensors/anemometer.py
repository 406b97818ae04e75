"""Anemometer of asv_sim: the velocity of the air relative to the sensor (`Anemometer.cc`)."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from simkit import Params, msgs
from simkit.extend import NoiseModel, Vector, VectorSensor, read_noise
from simkit.linear_algebra import matmul

TYPE = "geometry_msgs/msg/Vector3Stamped"


@dataclass(frozen=True, slots=True)
class AnemometerOptions:
    """The `<anemometer>` block: noise of each component [m/s]."""

    noise: NoiseModel


class Anemometer(VectorSensor):
    """Anemometer, `anemometer` (`<sensor type="custom" gz:type="anemometer">`): the apparent wind [m/s] in its frame.

    The air moves with the world's wind, including the gusts of a wind plugin. A sensor on a moving vehicle measures the
    wind minus its own velocity.
    """

    kinds = ("anemometer",)
    example = "<anemometer/>"
    sees_scene = False
    product, message_type = "anemometer", TYPE
    options: AnemometerOptions

    def read_options(self, params: Params) -> AnemometerOptions:
        blocks = (params.child(name) for name in ("gz:anemometer", "ignition:anemometer"))
        return AnemometerOptions(read_noise(next(filter(None, blocks), params.block("anemometer"))))

    def describe(self) -> dict[str, object]:
        """Return the standard deviation of the noise [m/s]."""
        return {"anemometer": {"stddev": self.options.noise.stddev}}

    def prepare(self) -> None:
        self.noise = self._make_noise((self.options.noise,) * 3, "anemometer")

    def default_topics(self) -> dict[str, str]:
        return {"anemometer": self._default_topic("anemometer")}

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> Vector:
        """Return the velocity of the air relative to the sensor [m/s], in the sensor's frame, shape (3,)."""
        rotation = data.xmat[self._body].reshape(3, 3)
        moving = self._velocity_in_world(model, data, matmul(rotation, self._offset_position))
        wind = np.array(self.sim.engine.wind.at(max(round(data.time / self.sim.timestep) - 1, 0)))
        apparent: Vector = matmul(wind - moving, matmul(rotation, self._offset_rotation))
        return apparent

    def _message_of(self, reading: Vector, time_ns: int) -> msgs.Message:
        vector = dict(zip("xyz", reading.tolist(), strict=True))
        return msgs.make(TYPE, header=msgs.header(time_ns, self.frame_id), vector=vector)
