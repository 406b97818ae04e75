"""Content of a URDF file as plain numbers, in which the readings of two programs can be compared."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from simkit.diagnostics import Where
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import (
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Inertial,
    Mesh,
    SceneCollision,
    SceneJoint,
    SceneModel,
    SceneVisual,
    Sphere,
)
from simkit.scene.kinematics import joint_positions, link_poses

Value = str | tuple[float, ...]
"""Text, or numbers in units of the SI."""
Frames = Callable[[Mapping[str, float]], dict[str, tuple[float, ...]]]
"""Function that returns the poses of the links in the root link's frame at joint positions [rad or m] by joints."""

CONFIGURATIONS: Final = 9
"""Number of sets of joint positions at which frames are compared; the first one is zero, the others are random."""
MOVING: Final = ("revolute", "continuous", "prismatic")
"""Types of joints that are moved; second readers keep planar and floating joints at zero."""
NO_LIMIT: Final = 1e15
"""Limit [rad, m, …] from which on a joint counts as unlimited."""
_SECTIONS: Final[Mapping[str, tuple[str, ...]]] = {
    "mass": ("inertial", "mass"), "centre of mass": ("inertial", "origin"), "inertia": ("inertial", "inertia"),
    "parent link": ("parent",), "child link": ("child",), "origin": ("origin",), "axis": ("axis",),
    "lower limit": ("limit",), "upper limit": ("limit",), "effort limit": ("limit",), "velocity limit": ("limit",),
    "damping": ("dynamics",), "friction": ("dynamics",), "mimic": ("mimic",),
    "shape": ("geometry", "*"), "size": ("geometry", "*"), "mesh": ("geometry", "mesh"), "scale": ("geometry", "mesh"),
}  # fmt: skip
"""Element of the file, below that of a link, joint or shape, that contains a quantity."""


@dataclass(frozen=True, slots=True)
class Part:
    """Link, joint, visual or collision of a robot.

    Attributes:
        kind: "link", "joint", "visual" or "collision".
        name: name of the joint or link; for a shape that of its link.
        number: number of a shape in its link, from 0.
    """

    kind: str
    name: str
    number: int = 0

    def __str__(self) -> str:
        if self.kind in ("link", "joint"):
            return f"{self.kind} {self.name!r}"
        return f"{self.kind} {self.number + 1} of link {self.name!r}"


@dataclass(frozen=True, slots=True)
class RobotReading:
    """Content of a URDF file.

    Attributes:
        root: name of the root link.
        parts: values by quantity, such as "upper limit", for each part.
        frames: poses of the links at joint positions: position [m], then the three rows of the rotation matrix.
    """

    root: str
    parts: Mapping[Part, Mapping[str, Value]]
    frames: Frames


def pose_numbers(pose: Pose) -> tuple[float, ...]:
    """Return position [m] and the rows of the rotation matrix of a pose."""
    return (*pose.position.tolist(), *pose.matrix.ravel().tolist())


def limit_values(lower: float, upper: float, effort: float, velocity: float) -> dict[str, Value]:
    """Return the limits of a joint; a limit without effect is infinite."""
    values = {"lower limit": lower, "upper limit": upper, "effort limit": effort, "velocity limit": velocity}
    return {name: (math.copysign(math.inf, v) if abs(v) >= NO_LIMIT else v,) for name, v in values.items()}


def scene_reading(model: SceneModel) -> RobotReading:
    """Return simkit's reading of a robot; links and joints that `<gazebo>` elements add are left out."""
    written = {(child.name, child.attribute("name").strip()) for child in _elements(model)}
    parts: dict[Part, Mapping[str, Value]] = {}
    plain = {link.scoped: link.name for link in model.links}
    poses = {link.scoped: link.pose_world for link in model.links}
    for link in model.links:
        if ("link", link.name) in written:
            parts[Part("link", link.name)] = _mass_values(link.inertial)
            parts |= {Part("collision", link.name, i): _shape_values(c) for i, c in enumerate(link.collisions)}
            parts |= {Part("visual", link.name, i): _shape_values(v) for i, v in enumerate(link.visuals)}
    for joint in model.joints:
        if ("joint", joint.name) in written:
            origin = poses[joint.parent_link].inverse() @ poses[joint.child_link]
            parts[Part("joint", joint.name)] = _joint_values(joint, origin, plain)
    root = next((link for link in model.links if link.scoped == model.canonical_link), model.links[0])
    to_root = root.pose_world.inverse()
    scoped = {joint.name: joint.scoped for joint in model.joints}

    def frames(positions: Mapping[str, float]) -> dict[str, tuple[float, ...]]:
        every = joint_positions(model, {scoped[name]: value for name, value in positions.items()})
        moved = link_poses(model, {name: (value,) for name, value in every.items()})
        return {plain[name]: pose_numbers(to_root @ pose) for name, pose in moved.items()}

    return RobotReading(root.name, parts, frames)


def _elements(model: SceneModel) -> list[Params]:
    return [] if model.urdf is None else model.urdf.children


def _mass_values(inertial: Inertial) -> dict[str, Value]:
    if not inertial.mass:
        return {"mass": (0.0,)}
    return {"mass": (inertial.mass,), "centre of mass": inertial.com, "inertia": inertial.inertia}


def _joint_values(joint: SceneJoint, origin: Pose, links: Mapping[str, str]) -> dict[str, Value]:
    values: dict[str, Value] = {
        "type": joint.type,
        "parent link": links[joint.parent_link],
        "child link": links[joint.child_link],
        "origin": pose_numbers(origin),
    }
    if joint.axes:
        axis = joint.axes[-1]  # the normal of a planar joint
        values["axis"] = axis.xyz_joint
    if joint.type in MOVING:
        values |= limit_values(axis.lower, axis.upper, axis.effort, axis.velocity)
        values |= {"damping": (axis.damping,), "friction": (axis.friction,), "mimic": "none"}
        if axis.mimic is not None:
            values["mimic"] = mimic_text(axis.mimic.joint.rpartition("::")[2], axis.mimic.multiplier, axis.mimic.offset)
    return values


def mimic_text(leader: str, multiplier: float, offset: float) -> str:
    """Return the law of a joint that mimics another one."""
    return f"{multiplier:.9g} · {leader} + {offset:.9g}"


def _shape_values(shape: SceneCollision | SceneVisual) -> dict[str, Value]:
    return {"origin": pose_numbers(shape.pose_link), **_geometry_values(shape.geometry)}


def _geometry_values(shape: Geometry) -> dict[str, Value]:
    match shape:
        case Box(size):
            return {"shape": "box", "size": size}
        case Sphere(radius):
            return {"shape": "sphere", "size": (radius,)}
        case Cylinder(radius, length):
            return {"shape": "cylinder", "size": (radius, length)}
        case Capsule(radius, length):
            return {"shape": "capsule", "size": (radius, length)}
        case Mesh():
            return {"shape": "mesh", "mesh": shape.uri, "scale": shape.scale}
    return {"shape": type(shape).__name__.lower()}


def place_of(model: SceneModel, part: Part, quantity: str) -> Where:
    """Return the place in the file of a quantity; of its part if the file does not give the quantity."""
    owner = "link" if part.kind in ("visual", "collision") else part.kind
    found = [e for e in _elements(model) if e.name == owner and e.attribute("name").strip() == part.name]
    if not found:
        return model.where
    element = found[0]
    if owner != part.kind:
        shapes = [child for child in element.children if child.name == part.kind]
        element = shapes[part.number] if part.number < len(shapes) else element
    for name in _SECTIONS.get(quantity, ()):
        element = next((child for child in element.children if name in (child.name, "*")), element)
    return element.where


def random_positions(reading: RobotReading) -> Iterator[dict[str, float]]:
    """Return joint positions [rad or m] by joint names: first zero, then random ones within the limits.

    A joint without limits takes positions from -π to π, or from -1 m to 1 m. The random numbers are always the same.
    """
    generator = random.Random(0)
    ranges = {part.name: _range(values) for part, values in reading.parts.items() if _is_driven(values)}
    for number in range(CONFIGURATIONS):
        yield {name: generator.uniform(*limits) if number else 0.0 for name, limits in ranges.items()}


def _is_driven(values: Mapping[str, Value]) -> bool:
    return values.get("type") in MOVING and values["mimic"] == "none"


def _range(values: Mapping[str, Value]) -> tuple[float, float]:
    far = 1.0 if values["type"] == "prismatic" else math.pi
    lower, upper = _number(values["lower limit"]), _number(values["upper limit"])
    if lower == -math.inf:
        lower = min(-far, upper - far)
    return lower, max(far, lower + far) if upper == math.inf else upper


def _number(value: Value | Sequence[float]) -> float:
    return float(value[0])
