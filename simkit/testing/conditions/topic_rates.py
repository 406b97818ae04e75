"""Rates at which the sensors and plugins of a world publish, as their files set them."""

from __future__ import annotations

from simkit.float_sum import float_sum
from simkit.runtime import Simulation


def configured_rate(sim: Simulation, topic: str) -> float | None:
    """Return the sum of the configured rates of a topic's publishers [Hz]; None if a rate is unknown."""
    owners: list[object] = [sensor for sensor in sim.engine.structure.all_sensors() if topic in sensor._topics.values()]
    if not owners:
        for _, end, _, what in sim.communication.bus.endpoints(topic):
            if what == "publishes" and end.active:
                owners.append(None if getattr(end, "latched", False) else end.owner)
    rates = [_publisher_rate(owner, sim.timestep) for owner in owners]
    return float_sum(rate for rate in rates if rate is not None) if rates and None not in rates else None


def _publisher_rate(owner: object, timestep: float) -> float | None:
    """Return the rate of a sensor or of a plugin's hook `after_step` [Hz]; None if it is unknown.

    A sensor with an update rate of 0 publishes after every step.
    """
    rate = getattr(owner, "update_rate", None)
    if isinstance(rate, (int, float)) and hasattr(owner, "scoped") and hasattr(owner, "sample"):
        return min(float(rate), 1.0 / timestep) if rate > 0 else 1.0 / timestep
    rate = getattr(owner, "after_step_rate", None)
    return float(rate) if isinstance(rate, (int, float)) and rate > 1e-3 else None
