"""Scene: the resolved content of a file, as frozen data.

Loaders create the scene; the compiler, the writers and `inspect` read it. Every pose is resolved and every default of
the format is filled in. The scene contains no XML, no MuJoCo objects and no running code.
"""

from simkit.scene.actuation import Calibration, Safety, Transmission, TransmissionEnd
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
    DEFAULT_REFLECTIVITY,
    NO_OPTICS,
    Axis,
    Inertial,
    Material,
    Mimic,
    Optics,
    SceneCollision,
    SceneFrame,
    SceneJoint,
    SceneLight,
    SceneLink,
    SceneModel,
    ScenePlugin,
    SceneSensor,
    SceneVisual,
    Surface,
)
from simkit.scene.world import (
    Animation,
    Atmosphere,
    PersonLook,
    Physics,
    Scene,
    SceneActor,
    SceneWorld,
    SphericalCoordinates,
    Surroundings,
    Trajectory,
    Waypoint,
)

__all__ = [
    "DEFAULT_REFLECTIVITY", "NO_OPTICS", "Animation", "Atmosphere", "Axis", "Box", "Calibration", "Capsule", "Cone",
    "Cylinder", "Ellipsoid", "Empty", "Geometry", "Heightmap", "Inertial", "Material", "Mesh", "Mimic", "Optics",
    "PersonLook", "Physics", "Plane", "Polyline", "Safety", "Scene", "SceneActor", "SceneCollision", "SceneFrame",
    "SceneJoint", "SceneLight", "SceneLink", "SceneModel", "ScenePlugin", "SceneSensor", "SceneVisual", "SceneWorld",
    "Sphere", "SphericalCoordinates", "Surface", "Surroundings", "Trajectory", "Transmission", "TransmissionEnd",
    "Waypoint",
]  # fmt: skip
