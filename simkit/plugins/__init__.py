"""Plugins: Python classes attached to a world, a model, a visual or a sensor and called while the simulation runs.

A file describes a plugin as a `ScenePlugin` with parameters; `discovery` finds the class by its name and creates the
instance. `gz` and `classic` contain the plugins of Gazebo and Gazebo Classic, and `world` contains the plugins that
every world has. `drives` and `joints` contain code that several plugins share; the modules in this folder contain code
for all plugins. A plugin does not change the MuJoCo spec directly: in `prepare`, it requests actuators and sites from
the builder.
"""

from __future__ import annotations

from simkit.plugins.base import ModelPlugin, Plugin, SensorPlugin, VisualPlugin, WorldPlugin
from simkit.plugins.ros_names import RosNames

__all__ = ["ModelPlugin", "Plugin", "RosNames", "SensorPlugin", "VisualPlugin", "WorldPlugin"]
