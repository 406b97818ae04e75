"""What Gazebo's batteries share, old and new: their arithmetic at each step, and the state that they tell."""

from __future__ import annotations

import math
from typing import Any, Final

from simkit import msgs
from simkit.msgs.topics import valid_topic
from simkit.plugins.base import ModelPlugin
from simkit.plugins.gz.battery_cell import FULL, Cell
from simkit.plugins.heard import publish_while_heard

STATE: Final = "sensor_msgs/msg/BatteryState"
_RATE: Final = 50.0  # [Hz]
_CHARGING, _DISCHARGING, _NOT_CHARGING, _IS_FULL = 1, 2, 3, 4  # of BatteryState


class BatteryConsumer(ModelPlugin):
    """Base of plugins that draw from a battery of their model.

    Attributes:
        battery: its name.
    """

    battery: str = ""

    @property
    def power(self) -> float:
        """What it draws [W]."""
        return 0.0


class Battery(ModelPlugin):
    """Base of batteries.

    Attributes:
        battery: its name.
        cell: how it is.
        is_drained: whether something draws from it.
        charger: current of the charger that is at work [A]; None while none is.
        sign: -1 where the current is told as one into the battery.
        percent: what a full battery tells as its percentage.
    """

    battery: str = ""
    cell: Cell
    is_drained: bool = False
    charger: float | None = None
    sign: float = 1.0
    percent: float = 1.0

    @property
    def node(self) -> str:
        """Name of its node, for its parameters."""
        return valid_topic(f"/model/{self.scoped}/battery/{self.battery}".replace("::", "/"))

    def open_state(self, model: str) -> str:
        """Opens the topic of its state; gives what the names of its topics begin with."""
        base = f"/model/{model}/battery/{self.battery}"
        for other in self.sim.structure.all_plugins():
            if other is self:
                break
            if isinstance(other, Battery) and (other.scoped, other.battery) == (self.scoped, self.battery):
                message = f"plugin {self.name!r}: the model has a battery {self.battery!r} already"
                self.params.error("SK-PARAM-002", f"{message}, allowed is another <battery_name>")
                return ""
        self._state = self.advertise(valid_topic(f"{base}/state"), STATE)
        publish_while_heard(self, self._state, _RATE, "tell")
        return base

    def demand(self) -> float:
        """What is drawn [W]."""
        return sum(consumer.power for consumer in self._consumers())

    def _consumers(self) -> list[BatteryConsumer]:
        return self.sim.names.shared(f"consumers {id(self)}", self._find_consumers)  # type: ignore[no-any-return]

    def _find_consumers(self) -> list[BatteryConsumer]:
        consumers = [p for p in self.sim.structure.all_plugins() if isinstance(p, BatteryConsumer)]
        return [p for p in consumers if p.battery == self.battery and p.scoped == self.scoped]

    def after_step(self) -> None:
        """Takes one step of draining and charging."""
        if self.is_drained or self.charger is not None:
            self.cell.step(self.period, self.demand() if self.is_drained else 0.0, self.charger)

    def tell(self) -> None:
        """Publishes its state."""
        cell = self.cell
        if self.charger is not None:
            status = _CHARGING
        elif self.is_drained:
            status = _DISCHARGING
        else:
            status = _IS_FULL if cell.soc > FULL else _NOT_CHARGING
        fields: dict[str, Any] = {
            "header": msgs.header(self.sim.time_ns, ""),
            "voltage": cell.voltage,
            "temperature": math.nan,
            "current": self.sign * cell.current,
            "charge": max(0.0, cell.charge),
            "capacity": cell.capacity,
            "design_capacity": math.nan,
            "percentage": max(0.0, cell.soc) * self.percent,
            "power_supply_status": status,
            "present": True,
        }
        self._state.publish(msgs.make(STATE, **fields))
