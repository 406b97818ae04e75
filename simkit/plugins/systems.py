"""gz systems that a world lists so that the server does what simkit does by itself."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from simkit.params import Params
from simkit.plugins.base import Plugin

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder

_SYSTEMS = {
    "physics": "Physics",
    "user-commands": "UserCommands",
    "scene-broadcaster": "SceneBroadcaster",
    "imu": "Imu",
    "contact": "Contact",
    "forcetorque": "ForceTorque",
    "altimeter": "Altimeter",
    "air-pressure": "AirPressure",
    "air-speed": "AirSpeed",
    "navsat": "NavSat",
    "logical-camera": "LogicalCamera",
    "cpu-lidar": "CpuLidar",
    "dvl": "DopplerVelocityLogSystem",
}


class BuiltInSystem(Plugin):
    """Stands for a system whose work simkit does whether it is named or not; says so in a note.

    A sensor of a kind that simkit does not have is reported at the sensor itself.
    """

    parent_kind = "any"
    filenames = (
        *(f"gz-sim-{name}-system" for name in _SYSTEMS),
        "libgazebo_ros_init.so",
        "libgazebo_ros_factory.so",
    )
    names = tuple(f"gz::sim::systems::{name}" for name in _SYSTEMS.values())

    def prepare(self, scene: Any, params: Params, builder: SpecBuilder) -> None:
        params.mark_all_read()
        label = self.name.rsplit("::", 1)[-1]
        message = f"plugin {label!r} is not needed: simkit does what it stands for by itself; its settings are not used"
        params.diagnostics.note("SK-PLUGIN-005", message, self.where)

    def load(self, parent: Any, params: Params) -> None:
        """Nothing to do."""
