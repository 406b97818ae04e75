"""Sensors: one file per kind. The registry is computed when first asked for."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import TYPE_CHECKING

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
    from simkit.registry import discover
    from simkit.sensors.base import Sensor

    return discover("simkit.sensors", GROUP, Sensor, lambda cls: cls.kinds, ("kinds",))  # type: ignore[type-abstract]
