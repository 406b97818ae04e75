"""Sensors of the control hardware: state interfaces with the measurements of simulated sensors."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from operator import attrgetter
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.extend import Diagnostics, Vector, did_you_mean
from simkit_control.plugins.ros2_control.hardware_description import SensorDescription

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.extend import SceneModel

_IMU: Final = {
    f"{part}.{axis}": f"{part}.{axis}"
    for part, axes in (("orientation", "xyzw"), ("angular_velocity", "xyz"), ("linear_acceleration", "xyz"))
    for axis in axes
}
_WRENCH: Final = {f"{part}.{axis}": f"wrench.{part}.{axis}" for part in ("force", "torque") for axis in "xyz"}
_RANGE: Final = {"range": "range"}
SENSOR_INTERFACES: Final = {"imu": _IMU, "force_torque": _WRENCH, "sonar": _RANGE}
"""Message field of each state interface, by kind of sensor."""


@dataclass(frozen=True, slots=True)
class HardwareSensor:
    """Simulated sensor whose measurements are state interfaces.

    Attributes:
        name: name in the hardware description.
        scoped: scoped name of the simulation's sensor.
        kind: kind of the sensor, a key of `SENSOR_INTERFACES`.
    """

    name: str
    scoped: str
    kind: str

    def read(self, sim: Simulation, interfaces: tuple[str, ...]) -> Vector:
        """Return the last measurement for each interface; NaN before the first sample and for unknown interfaces."""
        message = sim.sensor(self.scoped).latest
        fields = SENSOR_INTERFACES[self.kind]
        if message is None:
            return np.full(len(interfaces), np.nan)
        if len(interfaces) > 1 and all(i in fields for i in interfaces):
            return np.array(_field_getter(self.kind, interfaces)(message))
        return np.array([attrgetter(fields[i])(message) if i in fields else np.nan for i in interfaces])


@cache
def _field_getter(kind: str, interfaces: tuple[str, ...]) -> attrgetter[tuple[float, ...]]:
    """Return a function that reads the fields of some interfaces from a message of this kind of sensor."""
    return attrgetter(*(SENSOR_INTERFACES[kind][interface] for interface in interfaces))


def find_sensor(described: SensorDescription, scene: SceneModel, diagnostics: Diagnostics) -> HardwareSensor | None:
    """Find the sensor of the simulation for a `<sensor>` of `<ros2_control>`; return None after a warning.

    A sensor with the same name is used, else the model's only sensor that measures the same quantities.
    """
    kind = next((k for k, fields in SENSOR_INTERFACES.items() if any(i in fields for i in described.interfaces)), "")
    if not kind:
        message = f"<ros2_control> sensor {described.name!r}: no sensor measures its interfaces"
        hint = "use the interfaces of an IMU (orientation.x, …), of a force-torque sensor (force.x, …), or range"
        diagnostics.warning("SK-CONTROL-008", message, described.where, hint)
        return None
    candidates = [s for s in scene.all_sensors() if s.kind == kind]
    chosen = next((s for s in candidates if s.name == described.name), None)
    if chosen is None and len(candidates) == 1:
        chosen = candidates[0]
        message = f"<ros2_control> sensor {described.name!r} uses the model's only {kind} sensor, {chosen.name!r}"
        diagnostics.note("SK-CONTROL-006", message, described.where)
    if chosen is None:
        near = did_you_mean(described.name, [s.name for s in candidates])
        message = f"<ros2_control> sensor {described.name!r}: the model has no {kind} sensor with this name"
        listed = ", ".join(repr(s.name) for s in candidates) or "none"
        hint = near or f"its {kind} sensors are: {listed}"
        diagnostics.warning("SK-CONTROL-008", f"{message}; its interfaces stay NaN", described.where, hint)
        return None
    for interface in described.interfaces:
        if interface not in SENSOR_INTERFACES[kind]:
            message = f"<ros2_control> sensor {described.name!r}: a {kind} sensor has no interface {interface!r}"
            diagnostics.warning(
                "SK-CONTROL-008", message, described.where, did_you_mean(interface, SENSOR_INTERFACES[kind])
            )
    return HardwareSensor(described.name, chosen.scoped, kind)
