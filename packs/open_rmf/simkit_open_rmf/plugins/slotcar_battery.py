"""Battery of a slotcar: charge that motion and devices use, as in rmf_robot_sim_common."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

_GRAVITY: Final = 9.81  # [m/s²], as in the source
_HOUR: Final = 3600.0  # [s]


@dataclass(frozen=True, slots=True)
class BatteryModel:
    """Battery and mechanical losses of a robot.

    Attributes:
        voltage: nominal voltage [V].
        capacity: nominal capacity [A·h].
        charging_current: current of the charger [A].
        mass, inertia: mass [kg] and inertia about the vertical [kg·m²].
        friction: coefficient of the rolling friction.
        power: power of the devices [W].
    """

    voltage: float
    capacity: float
    charging_current: float
    mass: float
    inertia: float
    friction: float
    power: float

    def discharge(self, speeds: tuple[float, float], accelerations: tuple[float, float], time: float) -> float:
        """Return the fraction of the charge that is used in a time [s].

        Args:
            speeds: linear and turning speed [m/s, rad/s], without a sign.
            accelerations: linear and turning acceleration [m/s², rad/s²], without a sign.
            time: duration [s].
        """
        (v, w), (a, alpha) = speeds, accelerations
        motion = self.mass * a * v + self.inertia * alpha * w + self.friction * self.mass * _GRAVITY * v
        return (motion + self.power) * time / self.voltage / (self.capacity * _HOUR)

    def recharge(self, time: float) -> float:
        """Return the fraction of the charge that a charger adds in a time [s]."""
        return self.charging_current * time / (self.capacity * _HOUR)
