"""Battery model of Gazebo and Gazebo Classic: open-circuit voltage, inner resistance, smoothed current, state topic."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field
from typing import ClassVar, Final

from simkit import msgs
from simkit.float_sum import float_sum
from simkit.msgs.topic_names import valid_topic
from simkit.plugins.base import ModelPlugin
from simkit.plugins.endpoints import Endpoint, publishes
from simkit.plugins.options import Options, number, text
from simkit.plugins.publish_on_demand import publish_while_subscribed

_HOUR: Final = 3600.0  # [s]
_WINDOW: Final = 100  # steps
FULL: Final = 0.9
"""State of charge above which a charger supplies no current and an idle battery counts as full."""


@dataclass(slots=True)
class Cell:
    """State and constants of a battery.

    Attributes:
        constant, linear: parameters e0 and e1 [V] of the open-circuit voltage e0 + e1 (1 − q/c).
        capacity: capacity c [A·h].
        resistance: inner resistance [Ω].
        tau: time constant of the smoothed current [s].
        voltage: voltage at the terminals [V].
        charge: charge q [A·h].
        current: smoothed current out of the battery [A].
        soc: state of charge, from 0 to 1.
        recent: last 100 currents [A], if the state of charge is computed from their sum as in older versions of Gazebo;
            None otherwise.
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
        """Compute the state of charge from the sum of the last 100 currents, as gz does without `<fix_issue_225>`."""
        self.recent = deque(maxlen=_WINDOW)

    def step(self, step: float, power: float, charger: float | None) -> None:
        """Compute the state after a time step with gz's equations (LinearBatteryPlugin.cc, OnUpdateVoltage).

        Args:
            step: duration of the step [s].
            power: power drawn from the battery [W].
            charger: current of an active charger [A]; None without an active charger.
        """
        if charger is None and (abs(self.voltage) < 1e-3 or self.soc < 0.0):
            return
        # gz divides by the voltage without this check, although the voltage may be 0
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
            self.soc -= float_sum(self.recent) * step / _HOUR / self.capacity


STATE: Final = "sensor_msgs/msg/BatteryState"
_RATE: Final = 50.0  # [Hz]
_CHARGING, _DISCHARGING, _NOT_CHARGING, _IS_FULL = 1, 2, 3, 4  # constants of sensor_msgs/msg/BatteryState


class BatteryConsumer(ModelPlugin):
    """Base class of plugins that draw power from a battery of their model.

    Attributes:
        battery: name of the battery.
    """

    battery: str = ""

    @property
    def power(self) -> float:
        """Power drawn from the battery [W]."""
        return 0.0


class BatteryOptions(Options):
    """Options that the batteries of both Gazebos have."""

    battery_name: str = text(required=True)
    capacity: float = number(minimum=1e-12, required=True)
    open_circuit_voltage_constant_coef: float = number(0.0)
    open_circuit_voltage_linear_coef: float = number(0.0)
    resistance: float = number(0.0, minimum=0.0)


class Battery(ModelPlugin):
    """Base class of the battery plugins.

    Attributes:
        battery: name of the battery.
        cell: state and constants of the battery.
        is_drained: whether a consumer draws power from the battery.
        charger: current of the active charger [A]; None without an active charger.
        sign: 1 if a published current out of the battery is positive, -1 if a current into the battery is positive.
        percent: published `percentage` of a full battery, 1 or 100.
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
        """Name of the ROS node that has the battery's live parameters."""
        return valid_topic(f"/model/{self.scoped}/battery/{self.battery}".replace("::", "/"))

    def open_state(self, model: str) -> str:
        """Open the topic of the battery's state, and return the common prefix of all topics of the battery."""
        base = f"/model/{model}/battery/{self.battery}"
        for other in self.sim.engine.structure.all_plugins():
            if other is self:
                break
            if isinstance(other, Battery) and (other.scoped, other.battery) == (self.scoped, self.battery):
                message = f"plugin {self.name!r}: the model already has a battery {self.battery!r}"
                self.params.error("SK-PARAM-002", f"{message}; expected a <battery_name> that no other battery has")
                return ""
        self._state = self.advertise(valid_topic(f"{base}/state"), STATE)
        publish_while_subscribed(self, self._state, _RATE, "tell")
        return base

    def demand(self) -> float:
        """Return the power that all consumers together draw [W]."""
        return float_sum(consumer.power for consumer in self._consumers())

    def _consumers(self) -> list[BatteryConsumer]:
        return self.sim.engine.names.shared(f"consumers {id(self)}", self._find_consumers)

    def _find_consumers(self) -> list[BatteryConsumer]:
        consumers = [p for p in self.sim.engine.structure.all_plugins() if isinstance(p, BatteryConsumer)]
        return [p for p in consumers if p.battery == self.battery and p.scoped == self.scoped]

    def after_step(self) -> None:
        """Compute the battery's state after the step."""
        if self.is_drained or self.charger is not None:
            self.cell.step(self.period, self.demand() if self.is_drained else 0.0, self.charger)

    def tell(self) -> None:
        """Publish the battery's state."""
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
