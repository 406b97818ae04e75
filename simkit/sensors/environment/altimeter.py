"""Altimeter: height above the sensor's initial height, and vertical velocity."""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from simkit import msgs
from simkit.compiler import Compiled
from simkit.linear_algebra import matmul
from simkit.params import Params
from simkit.pose import Vector
from simkit.sensors.measured_rows import MeasuredRows
from simkit.sensors.noise import NoiseModel, read_noise
from simkit.sensors.vector_sensor import VectorSensor


@dataclass(frozen=True, slots=True)
class AltimeterOptions:
    """The `<altimeter>` block: noise of the position [m] and of the velocity [m/s]."""

    position: NoiseModel
    velocity: NoiseModel


class Altimeter(VectorSensor["msgs.Altimeter"]):
    """Altimeter, `altimeter`: height and climb rate of the sensor's own origin, along the world's z axis.

    The reference is the height [m] of the sensor when it was loaded or spawned. A reset or a new pose does not change
    the reference.
    """

    kinds = ("altimeter",)
    example = "<altimeter/>"
    sees_scene = False
    product, message_type = "altimeter", "ros_gz_interfaces/msg/Altimeter"
    options: AltimeterOptions
    _reference: float | None = None

    def read_options(self, params: Params) -> AltimeterOptions:
        block = params.block("altimeter")
        return AltimeterOptions(
            position=read_noise(block.block("vertical_position")),
            velocity=read_noise(block.block("vertical_velocity")),
        )

    def describe(self) -> dict[str, object]:
        """Return the standard deviations of height [m] and velocity [m/s]."""
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
        """Reference height in the world [m] of the measured positions."""
        assert self._reference is not None
        return self._reference

    def array_rule(self) -> MeasuredRows:
        return MeasuredRows(self)

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> Vector:
        """Return the height above the reference [m] and its rate [m/s]."""
        body = self._body
        lever = matmul(data.xmat[body].reshape(3, 3), self._offset_position)
        velocity = self._velocity_in_world(model, data, lever)
        return np.array((data.xpos[body][2] + lever[2] - self.reference, velocity[2]))

    def _message_of(self, reading: Vector, time_ns: int) -> msgs.Altimeter:
        height, rate = reading.tolist()
        return msgs.Altimeter(msgs.header(time_ns, self.frame_id), height, rate, self.reference)
