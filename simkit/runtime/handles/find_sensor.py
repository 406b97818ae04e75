"""Sensors by scoped name, by last name and by class."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

from simkit.argument_checks import check_kind
from simkit.errors import InputError
from simkit.runtime.handles.handle import UnknownName, look_up

T = TypeVar("T")


def find_sensor(sensors: Mapping[str, Any], name: str) -> Any:
    """Return a sensor by scoped name, or by its last name if only one sensor has it.

    Raises:
        KeyError: no sensor has the name (the message suggests the closest one), or several have it.
    """
    if isinstance(name, str) and name not in sensors:
        matching = [scoped for scoped in sensors if scoped.rpartition("::")[2] == name]
        if len(matching) == 1:
            return sensors[matching[0]]
        if matching:
            raise UnknownName(f"{len(matching)} sensors have the name {name!r}: {', '.join(matching)}")
    return look_up(dict(sensors), name, "sensor")


def checked_class(sensor: Any, cls: type[T]) -> T:
    """Return a sensor that is an instance of a class.

    Raises:
        InputError: SK-NAME-007 the sensor is of another class.
    """
    check_kind(cls, type, "type", "a class of sensors, such as simkit.sensors.Lidar")
    if not isinstance(sensor, cls):
        text = f"sensor {sensor.scoped!r} has the class {type(sensor).__name__}, got type={cls.__name__}"
        raise InputError("SK-NAME-007", text)
    return sensor
