"""Base class of sensors that measure a few numbers and publish them in one message."""

from __future__ import annotations

import abc
from typing import ClassVar

from simkit.pose import Vector
from simkit.sensors.base import Product, Sensor
from simkit.sensors.noise import Noise


class VectorSensor(Sensor):
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
