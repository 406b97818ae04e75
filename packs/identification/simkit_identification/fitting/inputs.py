"""Topics that a world subscribes to."""

from __future__ import annotations

from simkit import Simulation


def world_inputs(sim: Simulation) -> list[str]:
    """Return the topics that a world subscribes to and does not publish itself, sorted."""
    bus = sim.communication.bus
    ends = [(topic, role) for topic, end, _, role in bus.endpoints() if end.active and topic not in bus.unlisted]
    published = {topic for topic, role in ends if role == "publishes"}
    return sorted({topic for topic, role in ends if role == "takes"} - published)
