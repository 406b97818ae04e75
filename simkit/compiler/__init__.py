"""Compiler: a `Scene` becomes a MuJoCo model.

A scene enters, then what sensors and plugins add through `SpecBuilder`; an `MjModel` with its first state and the map
of names leaves. `MjSpec` is made in this room only. Nothing here steps a simulation or knows a kind of sensor or
plugin.
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
