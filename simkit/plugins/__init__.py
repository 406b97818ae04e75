"""Plugins: Python that hangs on a world, a model, a visual or a sensor and is called as the run goes.

A plugin of a file enters as a `ScenePlugin` with its parameters and leaves as an instance of its class, which
`discovery` finds by name and attaches. One kind is one file: `gz` and `classic` hold Gazebo's two generations,
`world` what every world brings, `ros2_control`, `play_motion` and `gz_python` whole subsystems; `drives`, `joints`,
`fluids` and `actors` hold what several kinds share, and the files beside them what all share. A plugin never touches
the MuJoCo spec itself: what it needs before the compile it asks of the builder in `prepare`.
"""

from __future__ import annotations

from simkit.plugins.base import ModelPlugin, Plugin, SensorPlugin, VisualPlugin, WorldPlugin
from simkit.plugins.ros_names import RosNames

__all__ = ["ModelPlugin", "Plugin", "RosNames", "SensorPlugin", "VisualPlugin", "WorldPlugin"]
