"""Running simulation.

- Input: a compiled world with its sensors and plugins, and the commands of users and plugins during the run.
- Output: the state at every tick, messages, snapshots and diagnostics.
- Not known here: file formats, names of kinds of sensors and plugins, and sockets.

`contact` is below `engine`, which is below `communication` and `handles`. `simulation.py` combines them.
"""

from simkit.mujoco_import import mujoco  # noqa: F401  (before any module imports MuJoCo by itself)
from simkit.runtime.communication.publisher import Publisher
from simkit.runtime.communication.subscription import Subscription
from simkit.runtime.engine.entity_structure import SensorsAndPlugins, WorldStructure
from simkit.runtime.engine.snapshot import Snapshot
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
