"""Battery model of Gazebo, old and new: open-circuit voltage, inner resistance, smoothed current, published state."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field
from typing import ClassVar, Final

from simkit import msgs
from simkit.msgs.topic_names import valid_topic
from simkit.plugins.base import ModelPlugin
from simkit.plugins.endpoints import Endpoint, publishes
from simkit.plugins.publish_on_demand import publish_while_subscribed

_HOUR: Final = 3600.0  # [s]
_WINDOW: Final = 100  # steps
FULL: Final = 0.9
"""State of charge from which on a charger gives nothing, and a battery at rest is called full."""


@dataclass(slots=True)
class Cell:
    """One battery.

    Attributes:
        constant, linear: e0 and e1 of the open-circuit voltage e0 + e1 (1 - q/c) [V].
        capacity: c [A·h].
        resistance: r [Ω].
        tau: time constant of the smoothed current [s].
        voltage: at the terminals [V].
        charge: q [A·h].
        current: the smoothed one, out of the battery [A].
        soc: state of charge, from 0 to 1.
        recent: the last currents [A] where Gazebo's old sum of them is wanted; else None.
    """

    constant: float
    linear: float
    capacity: float
    resistance: float
    tau: float
    voltage: float
    charge: float
    current: float = 0.0
    soc: float = field(default=1.0)
    recent: deque[float] | None = None

    def __post_init__(self) -> None:
        self.soc = self.charge / self.capacity

    def remember(self) -> None:
        """Counts the state of charge as gz does without `<fix_issue_225>`: by the last 100 currents, at each step."""
        self.recent = deque(maxlen=_WINDOW)

    def step(self, step: float, power: float, charger: float | None) -> None:
        """One step of gz's arithmetic (LinearBatteryPlugin.cc, OnUpdateVoltage).

        Args:
            step: [s]
            power: what is drawn [W].
            charger: current of a charger that is at work [A]; None without one.
        """
        if charger is None and (abs(self.voltage) < 1e-3 or self.soc < 0.0):
            return
        # gz divides by what may be nothing
        drawn = power / self.voltage if abs(self.voltage) >= 1e-3 else 0.0
        if charger is not None and self.soc < FULL:
            drawn -= charger
        self.current += step / max(self.tau, step) * (drawn - self.current)
        self.charge -= step * self.current / _HOUR
        spent = 1.0 - self.charge / self.capacity
        self.voltage = self.constant + self.linear * spent - self.resistance * self.current
        if self.recent is None:
            self.soc = self.charge / self.capacity
        else:
            self.recent.append(self.current)
            self.soc -= sum(self.recent) * step / _HOUR / self.capacity


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

    endpoints: ClassVar[tuple[Endpoint, ...]] = (publishes("/model/{model}/battery/{battery_name}/state", STATE),)
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
        for other in self.sim.engine.structure.all_plugins():
            if other is self:
                break
            if isinstance(other, Battery) and (other.scoped, other.battery) == (self.scoped, self.battery):
                message = f"plugin {self.name!r}: the model has a battery {self.battery!r} already"
                self.params.error("SK-PARAM-002", f"{message}, allowed is another <battery_name>")
                return ""
        self._state = self.advertise(valid_topic(f"{base}/state"), STATE)
        publish_while_subscribed(self, self._state, _RATE, "tell")
        return base

    def demand(self) -> float:
        """What is drawn [W]."""
        return sum(consumer.power for consumer in self._consumers())

    def _consumers(self) -> list[BatteryConsumer]:
        return self.sim.engine.names.shared(f"consumers {id(self)}", self._find_consumers)

    def _find_consumers(self) -> list[BatteryConsumer]:
        consumers = [p for p in self.sim.engine.structure.all_plugins() if isinstance(p, BatteryConsumer)]
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
        fields: dict[str, object] = {
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
