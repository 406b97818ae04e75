"""`force_torque_sensor_broadcaster`: what a force-torque sensor of the hardware measures, as a topic."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from simkit import msgs
from simkit.params import Params
from simkit.plugins.ros2_control.controller import Controller

WRENCH: Final = "geometry_msgs/msg/WrenchStamped"
_PARTS: Final = tuple(f"{part}.{axis}" for part in ("force", "torque") for axis in "xyz")


class ForceTorqueSensorBroadcaster(Controller):
    """The sensor that `sensor_name` names, or the interfaces that `interface_names` names, on `~/wrench`."""

    types = ("force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster",)

    def configure(self) -> None:
        params = self.params
        sensor = params.text("sensor_name", "")
        block = params.block("interface_names")
        single = {part: block.block(part.partition(".")[0]).text(part.partition(".")[2], "") for part in _PARTS}
        self._frame = params.text("frame_id", required=True)
        if sensor and any(single.values()):
            params.error("SK-PARAM-002", "both 'sensor_name' and 'interface_names' are given, one is needed")
        elif not sensor and not any(single.values()):
            params.text("sensor_name", required=True)
        given = {part: f"{sensor}/{part}" for part in _PARTS} if sensor else {p: n for p, n in single.items() if n}
        self._names = list(given.values())
        self._columns = [_PARTS.index(part) for part in given]
        self._has_all_parts = tuple(given) == _PARTS
        offset, multiplier = params.block("offset"), params.block("multiplier")
        self._offset = np.array([_number(offset, part, 0.0) for part in _PARTS])
        self._multiplier = np.array([_number(multiplier, part, 1.0) for part in _PARTS])
        self._publisher = self.advertise("~/wrench", WRENCH)

    def state_interfaces(self) -> Sequence[str]:
        return self._names

    def update(self, now_ns: int, period: float) -> None:
        if not self._publisher.wanted:
            return
        values = self.states.values
        if not self._has_all_parts:
            there, values = values, np.full(6, np.nan)  # what has no interface is not measured
            values[self._columns] = there
        values *= self._multiplier
        values += self._offset
        stamped, wrench, vector = msgs.types_of(WRENCH, "geometry_msgs/msg/Wrench", "geometry_msgs/msg/Vector3")
        force, torque = values[:3].tolist(), values[3:].tolist()
        self._publisher.publish(stamped(msgs.header(now_ns, self._frame), wrench(vector(*force), vector(*torque))))


def _number(block: Params, part: str, default: float) -> float:
    name, _, axis = part.partition(".")
    return block.block(name).number(axis, default)
