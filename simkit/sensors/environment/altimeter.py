"""Altimeter: height above where the sensor started, and vertical velocity."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from simkit import msgs
from simkit.compiler import Compiled
from simkit.params import Params
from simkit.sensors.base import Product, Sensor
from simkit.sensors.environment.point_velocity import point_velocity
from simkit.sensors.noise import Noise, NoiseModel, read_noise

TYPE = "ros_gz_interfaces/msg/Altimeter"


@dataclass(frozen=True, slots=True)
class AltimeterOptions:
    """The `<altimeter>` block: noise of the position [m] and of the velocity [m/s]."""

    position: NoiseModel
    velocity: NoiseModel


@dataclass(frozen=True, slots=True)
class Climb:
    """Height above the reference [m] and its rate [m/s]."""

    position: float
    velocity: float


class Altimeter(Sensor):
    """`altimeter`: height and rate of climb of the sensor's own origin, along the world's z.

    The reference is the height [m] of the sensor when it came into the world, at the load or the spawn. Nothing changes
    it afterwards: neither a reset nor a pose that is set.
    """

    kinds = ("altimeter",)
    example = "<altimeter/>"
    options: AltimeterOptions
    noise: Noise
    _reference: float | None = None

    def read_options(self, params: Params) -> AltimeterOptions:
        block = params.block("altimeter")
        return AltimeterOptions(
            position=read_noise(block.block("vertical_position")),
            velocity=read_noise(block.block("vertical_velocity")),
        )

    def describe(self) -> dict[str, object]:
        """Standard deviations [m, m/s]."""
        options = self.options
        return {"altimeter": {"position_stddev": options.position.stddev, "velocity_stddev": options.velocity.stddev}}

    def prepare(self) -> None:
        self.noise = self._make_noise((self.options.position, self.options.velocity), "altimeter")

    def bind(self, compiled: Compiled) -> None:
        super().bind(compiled)
        if self._reference is None:
            self._reference = float(self._frame_in_world(self.sim.engine.physics.fresh())[0][2])

    @property
    def reference(self) -> float:
        """Height in the world [m] that positions are measured from."""
        assert self._reference is not None
        return self._reference

    def products(self) -> dict[str, Product]:
        return {"altimeter": Product(TYPE, self._message_of)}

    def default_topics(self) -> dict[str, str]:
        return {"altimeter": self._default_topic("altimeter")}

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> Climb:
        body = self._body
        lever = data.xmat[body].reshape(3, 3) @ self._offset_position
        velocity = point_velocity(model, data, body, lever)
        return Climb(float(data.xpos[body][2] + lever[2]) - self.reference, float(velocity[2]))

    def perturb(self, reading: Climb, index: int) -> Climb:
        if self.noise.is_silent:
            return reading
        position, velocity = self.noise.apply(np.array((reading.position, reading.velocity)), index).tolist()
        return Climb(position, velocity)

    def _message_of(self, reading: Climb, time_ns: int) -> msgs.Altimeter:
        header = msgs.header(time_ns, self.frame_id)
        message: msgs.Altimeter = msgs.type_of(TYPE)(header, reading.position, reading.velocity, self.reference)
        return message
