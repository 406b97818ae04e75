"""Sensors: what samples the simulation and publishes readings; one file for each kind, in a subfolder of its field.

A `<sensor>` of the scene and the running simulation enter; samples at the sensor's rate, with noise and latency, leave
as messages on topics. A sensor never changes the physics, and one that nobody reads costs nothing. This folder holds
what all kinds share; the kinds are discovered in the subfolders and in the entry points `simkit.sensors` at first use.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import TYPE_CHECKING

from simkit.registry import Kinds

if TYPE_CHECKING:
    from simkit.sensors.base import Sensor

__all__ = ["sensor_kinds"]

GROUP = "simkit.sensors"


@functools.cache
def sensor_kinds() -> Mapping[str, type[Sensor]]:
    """Every known sensor class by the `<sensor type>` it answers to; read-only.

    Raises:
        RuntimeError: two classes claim one kind.
    """
    from simkit.sensors.base import Sensor

    return Kinds("simkit.sensors", GROUP, Sensor, lambda cls: cls.kinds, ("kinds",))  # type: ignore[type-abstract]
