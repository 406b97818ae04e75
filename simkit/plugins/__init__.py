"""Plugins: Python classes attached to a world, a model, a visual or a sensor and called while the simulation runs.

A file describes a plugin as a `ScenePlugin` with parameters. `discovery` finds its class by name and creates the
instance. Each kind of plugin has its own file. `gz` and `classic` hold the plugins of Gazebo's two generations; `world`
holds what every world has. `ros2_control`, `play_motion` and `gz_python` are whole subsystems. `drives`, `joints`,
`fluids` and `actors` hold code that several kinds share; the files next to them hold code that all kinds share. A
plugin never changes the MuJoCo spec itself: `prepare` requests actuators and sites from the builder before the compile.
"""

from __future__ import annotations

from simkit.plugins.base import ModelPlugin, Plugin, SensorPlugin, VisualPlugin, WorldPlugin
from simkit.plugins.ros_names import RosNames

__all__ = ["ModelPlugin", "Plugin", "RosNames", "SensorPlugin", "VisualPlugin", "WorldPlugin"]
