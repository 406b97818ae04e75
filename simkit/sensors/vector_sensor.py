"""Base class of sensors that measure a few numbers and publish them in one message."""

from __future__ import annotations

import abc
from collections.abc import Callable
from typing import TYPE_CHECKING, ClassVar

from simkit.msgs.message_types import M
from simkit.pose import Vector
from simkit.runtime.array_rules import Floats, Ids, SensorRule, Ticks
from simkit.sensors.base import Product, Sensor
from simkit.sensors.noise import Noise

if TYPE_CHECKING:
    from simkit.runtime.state_arrays import StateArrays


class VectorSensor(Sensor[M]):
    """Sensor whose reading is a vector with noise on each number, published as one message.

    Attributes:
        product: name of the message and last part of its default topic.
        message_type: ROS 2 type of the message.
    """

    product: ClassVar[str]
    message_type: ClassVar[str]
    noise: Noise

    def products(self) -> dict[str, Product]:
        return {self.product: Product(self.message_type, self._message_of)}

    def perturb(self, reading: Vector, index: int) -> Vector:
        return reading if self.noise.is_silent else self.noise.apply(reading, index)

    @abc.abstractmethod
    def _message_of(self, reading: Vector, time_ns: int) -> object:
        """Make the message of a reading."""


class VectorRule(SensorRule):
    """Array rule of a `VectorSensor` that measures by a function of arrays.

    Args:
        sensor: sensor of the simulation that resets all others.
        inputs: names of the arrays of MuJoCo's data that the function reads.
        measure: function from these arrays, whose first axis is the simulation, to the readings without noise, shape
            (n, numbers). The sensor's `measure` calls the same function with one simulation.
    """

    def __init__(self, sensor: VectorSensor, inputs: tuple[str, ...], measure: Callable[..., Floats]) -> None:
        self._sensor, self.inputs, self._measure = sensor, inputs, measure

    def bind(self, states: StateArrays, *, is_truth: bool) -> None:
        self._fields = [states.field(name) for name in self.inputs]
        self._noise = None if is_truth else self._sensor.noise.rows(states.count)

    def take(self, row: int) -> None:
        if self._noise is not None:
            self._noise.take(row)

    def read(self, ids: Ids, index: Ticks) -> Floats:
        values = self._measure(*self._fields)
        if self._noise is not None:
            self._noise.apply(values, ids, index)
        return values
