"""The linear battery of Gazebo: open-circuit voltage by charge, an inner resistance, a current that is smoothed."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import Final

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
