"""Sensors: classes that sample the simulation and publish readings; one file per kind, in a subfolder of its field.

Inputs are a `<sensor>` of the scene and the running simulation. Outputs are messages on topics, at the sensor's rate
and with noise and latency. A sensor never changes the physics. A sensor without a reader costs nothing. This folder
holds the code that all kinds share. The kinds are discovered at first use, in the subfolders and in the entry points
`simkit.sensors`.
"""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

from simkit.registry import Kinds

if TYPE_CHECKING:
    from simkit.sensors.base import Sensor

__all__ = ["sensor_kinds"]

GROUP = "simkit.sensors"


@functools.cache
def sensor_kinds() -> Kinds[Sensor]:
    """Return every known sensor class by its `<sensor type>`, as a read-only mapping.

    Raises:
        RuntimeError: two classes of simkit claim the same kind.
    """
    from simkit.sensors.base import Sensor

    return Kinds("simkit.sensors", GROUP, Sensor, lambda cls: cls.kinds, ("kinds",))  # type: ignore[type-abstract]
