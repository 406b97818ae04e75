"""What a robot is made of here: links with the joints that hold them, shapes, looks, sensors, plugins.

Lengths m, masses kg, inertias kg m^2, angles rad; forces N, torques N m, damping N s/m or N m s/rad.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, field
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))  # what the scripts of all robots share
from robots_text import ZERO, Collision, Look, Plugin, Sensor, Shape, Vector

QUARTER = math.pi / 2
HALF = math.pi
PACKAGE = "tiago"
"""The folder of these files is the package and the model that the mesh URIs name."""


@dataclass(frozen=True, slots=True)
class Visual:
    name: str
    shape: Shape
    look: Look
    xyz: Vector = ZERO
    rpy: Vector = ZERO


@dataclass(frozen=True, slots=True)
class Contact:
    """Friction, and stiffness [N/m] and damping [N s/m] of a contact where they are not the default."""

    mu: float
    kp: float | None = None
    kd: float | None = None


@dataclass(frozen=True, slots=True)
class Limit:
    """Of a moving joint: effort [N m or N], velocity [rad/s or m/s], and the ends of its travel where it has any.

    Attributes:
        soft: how far inside the ends the safety controller begins.
        k_position, k_velocity: gains of the safety controller; it is described, the physics does not use it. There is
            none where both are 0.
    """

    effort: float
    velocity: float
    lower: float | None = None
    upper: float | None = None
    soft: float = 0.0
    k_position: float = 20.0
    k_velocity: float = 20.0


@dataclass(frozen=True, slots=True)
class Link:
    """A link and the joint that holds it.

    Attributes:
        name: of the link.
        joint: the joint's name; empty for the root.
        parent: the link it hangs on.
        kind: "fixed", "prismatic", "revolute" or "continuous".
        xyz: the link's origin in its parent's frame; of the joint as well.
        rpy: how the link is turned in its parent's frame.
        axis: of the joint, in the link's frame.
        limit: of a moving joint; None where nothing holds it.
        mimic: the joint that this one follows; empty where it moves by itself.
        multiplier: how far it moves for one unit of that joint.
        damping: viscous, of the joint.
        friction: dry, of the joint.
        mass: of the part; a frame weighs a milligram.
        inertia: (ixx, iyy, izz, ixy, ixz, iyz) about the centre of mass.
        centre: of mass, in the link's frame.
        contact: of its collisions, where it is not the default.
        joint_sensors: sensors on the joint.
        about: what it is, for the reader of the files.
    """

    name: str
    joint: str = ""
    parent: str = ""
    kind: str = "fixed"
    xyz: Vector = ZERO
    rpy: Vector = ZERO
    axis: Vector = (0.0, 0.0, 1.0)
    limit: Limit | None = None
    mimic: str = ""
    multiplier: float = 1.0
    damping: float = 0.0
    friction: float = 0.0
    mass: float = 1e-6
    inertia: tuple[float, ...] = (1e-9, 1e-9, 1e-9)
    centre: Vector = ZERO
    contact: Contact | None = None
    collisions: tuple[Collision, ...] = ()
    visuals: tuple[Visual, ...] = ()
    sensors: tuple[Sensor, ...] = ()
    joint_sensors: tuple[Sensor, ...] = ()
    about: str = ""

    @property
    def moments(self) -> tuple[float, ...]:
        """(ixx, iyy, izz, ixy, ixz, iyz)."""
        return (*self.inertia, 0.0, 0.0, 0.0)[:6]


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot: `control` is its `<ros2_control>` element or its transmissions, line by line.

    Attributes:
        origin: where the model's origin is.
        height: of the origin above the ground [m].
        package: the folder that the meshes' URIs name.
    """

    name: str
    title: str
    about: str
    links: tuple[Link, ...]
    plugins: tuple[Plugin, ...] = field(default=())
    control: tuple[str, ...] = ()
    origin: str = "base_footprint: on the ground, midway between the wheels"
    height: float = 0.0
    package: str = PACKAGE


def box(x: float, y: float, z: float) -> Shape:
    return Shape("box", (x, y, z))


def cylinder(radius: float, length: float) -> Shape:
    return Shape("cylinder", (radius, length))


def sphere(radius: float) -> Shape:
    return Shape("sphere", (radius,))


def solid_cylinder(mass: float, radius: float, length: float) -> tuple[float, float, float]:
    """Moments (ixx, iyy, izz) of a solid cylinder along z."""
    across = mass * (3 * radius**2 + length**2) / 12
    return (round(across, 9), round(across, 9), round(mass * radius**2 / 2, 9))


# ------------------------------------------------------------------ looks

WHITE = Look("white", (0.93, 0.93, 0.92), 0.4)
LIGHT = Look("light_grey", (0.80, 0.80, 0.81), 0.3)
METAL = Look("metal", (0.62, 0.63, 0.65), 0.6)
GREY = Look("grey", (0.42, 0.43, 0.45), 0.3)
DARK = Look("dark_grey", (0.16, 0.17, 0.18), 0.3)
BLACK = Look("black", (0.05, 0.05, 0.055), 0.3)
ORANGE = Look("orange", (0.91, 0.42, 0.10), 0.4)
GLASS = Look("glass", (0.09, 0.12, 0.21), 0.9)


def drawn(*parts: tuple[str, str, Look], package: str = PACKAGE) -> tuple[Visual, ...]:
    """Visuals of meshes: (name, file without suffix, look) each."""
    return tuple(Visual(name, Shape("mesh", mesh=f"{package}/meshes/{file}.obj"), look) for name, file, look in parts)
