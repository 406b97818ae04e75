"""Scenes into MuJoCo models: the one place where the physics engine's model is built."""

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
