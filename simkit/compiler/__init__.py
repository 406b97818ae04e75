"""Scenes into MuJoCo models: the one place where the physics engine's model is built."""

import simkit.engine.loaded  # noqa: F401  (before any module imports MuJoCo by itself)
from simkit.compiler import groups
from simkit.compiler.builder import Compiled, SpecBuilder
from simkit.compiler.lights import drawn_position
from simkit.compiler.names import ActuatorRef, Follower, GeomOwner, JointBinding, LightBinding, LinkBinding, NameMap

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
    "groups",
]
