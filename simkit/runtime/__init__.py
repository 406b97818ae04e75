"""The running simulation: clock, loop, topics, random streams, snapshots, handles."""

import simkit.mujoco_loaded  # noqa: F401  (before any module imports MuJoCo by itself)
from simkit.runtime.communication.topic_bus import Publisher, Subscription
from simkit.runtime.engine.snapshot import Snapshot
from simkit.runtime.engine.world_structure import SensorsAndPlugins, WorldStructure
from simkit.runtime.handles.joint import Joint
from simkit.runtime.handles.light import Light
from simkit.runtime.handles.link import Link
from simkit.runtime.handles.model import Model
from simkit.runtime.handles.visual import Visual
from simkit.runtime.simulation import Simulation

__all__ = [
    "Joint",
    "Light",
    "Link",
    "Model",
    "Publisher",
    "SensorsAndPlugins",
    "Simulation",
    "Snapshot",
    "Subscription",
    "Visual",
    "WorldStructure",
]
