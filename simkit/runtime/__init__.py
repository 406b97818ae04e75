"""The running simulation: clock, loop, topics, random streams, snapshots, handles."""

import simkit.engine.loaded  # noqa: F401  (before any module imports MuJoCo by itself)
from simkit.runtime.joint import Joint
from simkit.runtime.light import Light
from simkit.runtime.link import Link
from simkit.runtime.model import Model
from simkit.runtime.parts import Parts, Structure
from simkit.runtime.simulation import Simulation
from simkit.runtime.snapshot import Snapshot
from simkit.runtime.topics import Publisher, Subscription
from simkit.runtime.visual import Visual

__all__ = [
    "Joint",
    "Light",
    "Link",
    "Model",
    "Parts",
    "Publisher",
    "Simulation",
    "Snapshot",
    "Structure",
    "Subscription",
    "Visual",
]
