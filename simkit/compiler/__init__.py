"""Compiler from a `Scene` to a MuJoCo model.

- Input: a scene, and the elements that sensors and plugins add through `SpecBuilder`.
- Output: an `MjModel` with its first state and the name map.
- Limits: this package steps no model and knows no kinds of sensors or plugins. No other package creates an `MjSpec`.
"""

from simkit.mujoco_import import mujoco  # noqa: F401, I001  (before any module imports MuJoCo by itself)
from simkit.compiler import geom_groups
from simkit.compiler.lights import drawn_position
from simkit.compiler.name_map import ActuatorRef, Follower, GeomOwner, JointBinding, LightBinding, LinkBinding, NameMap
from simkit.compiler.spec_builder import Compiled, SpecBuilder

__all__ = [
    "ActuatorRef",
    "Compiled",
    "Follower",
    "GeomOwner",
    "JointBinding",
    "LightBinding",
    "LinkBinding",
    "NameMap",
    "SpecBuilder",
    "drawn_position",
    "geom_groups",
]
