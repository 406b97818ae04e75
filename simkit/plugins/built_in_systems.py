"""Gazebo systems that a file may list although simkit always has their function."""

from __future__ import annotations

from typing import TYPE_CHECKING

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
    "particle-emitter": "ParticleEmitter",
    "particle-emitter2": "ParticleEmitter2",
    "dvl": "DopplerVelocityLogSystem",
}
_OF_SENSORS = ("Ray", "GpuRay", "Camera", "DepthCamera", "MultiCamera", "Contact", "ImuSensor", "Sonar")
"""Plugins of Gazebo Classic that are base classes for other plugins: they only receive or print sensor readings."""


class BuiltInSystem(Plugin):
    """Reports that a system in the file is not needed, because simkit always has its function.

    For a sensor system, this is also reported if simkit does not support the kind of sensor; a separate warning names
    the unsupported sensor.
    """

    parent_kind = "any"
    filenames = (
        *(f"gz-sim-{name}-system" for name in _SYSTEMS),
        *(f"lib{name}Plugin.so" for name in _OF_SENSORS),
        "libgazebo_ros_init.so",
        "libgazebo_ros_factory.so",
        "libgazebo_ros_force_system.so",
        "libgazebo_ros_api_plugin.so",
        "libgazebo_ros_paths_plugin.so",
    )
    names = tuple(f"gz::sim::systems::{name}" for name in _SYSTEMS.values())

    def prepare(self, scene: object, params: Params, builder: SpecBuilder) -> None:
        unused = ", ".join(sorted({f"<{child.name}>" for child in params.children}))
        params.mark_all_read()
        library = self.source.filename if self.source is not None else self.name
        label = self.name.rsplit("::", 1)[-1] if "::" in self.name else library
        message = f"plugin {label!r} is not needed: simkit always does its work itself"
        params.diagnostics.note("SK-PLUGIN-005", message + (f"; not used: {unused}" if unused else ""), self.where)

    def load(self, parent: object, params: Params) -> None:
        """Do nothing: simkit itself has the function of this system."""
