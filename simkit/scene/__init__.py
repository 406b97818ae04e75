"""What a file means once resolved: plain frozen data, no XML, no physics engine.

Every pose is resolved, every default of the format is filled in, every list is a list.
"""

from simkit.scene.geometry import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Empty,
    Geometry,
    Heightmap,
    Mesh,
    Plane,
    Polyline,
    Sphere,
)
from simkit.scene.model import (
    Axis,
    Inertial,
    Material,
    Mimic,
    SceneCollision,
    SceneFrame,
    SceneJoint,
    SceneLink,
    SceneModel,
    ScenePlugin,
    SceneSensor,
    SceneVisual,
    Surface,
)
from simkit.scene.world import Physics, Scene, SceneLight, SceneWorld, SphericalCoordinates, Surroundings

__all__ = [
    "Axis",
    "Box",
    "Capsule",
    "Cone",
    "Cylinder",
    "Ellipsoid",
    "Empty",
    "Geometry",
    "Heightmap",
    "Inertial",
    "Material",
    "Mesh",
    "Mimic",
    "Physics",
    "Plane",
    "Polyline",
    "Scene",
    "SceneCollision",
    "SceneFrame",
    "SceneJoint",
    "SceneLight",
    "SceneLink",
    "SceneModel",
    "ScenePlugin",
    "SceneSensor",
    "SceneVisual",
    "SceneWorld",
    "Sphere",
    "SphericalCoordinates",
    "Surface",
    "Surroundings",
]
