"""The running simulation.

What enters: a compiled world with its sensors and plugins, and what users and plugins command while it runs. What
leaves: the state at every tick, messages, snapshots and diagnostics. What never: files of any format, kinds of sensors
and plugins by name, and sockets. `contact` is below `engine`, that is below `communication` and `handles`, and
`simulation.py` puts them together.
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
