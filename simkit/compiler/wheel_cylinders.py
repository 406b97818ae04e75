"""Cylinders for the collision meshes of wheels.

A mesh of a wheel is a prism of many sides, which the engine rolls over its edges. The loads on the wheels of a vehicle
then jump at every edge. Skid steering on the spot reaches 0.55 instead of 0.61 of the yaw rate that the wheel speeds
would give (48 sides, wheels 0.5 m apart and 0.4 m behind each other, friction coefficient 1). The cylinder that such a
mesh approximates rolls evenly, so the engine gets the cylinder.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from simkit.compiler.kinematic_tree import KinematicTree
from simkit.compiler.shape_geometry import turn_z_to
from simkit.linear_algebra import matmul, norm
from simkit.loaders.meshes.mesh_part import Floats, Ints
from simkit.pose import Pose
from simkit.scene import SceneLink

LEAST_ROUND: Final = 0.98
"""Least ratio of the inscribed circle's radius to that of the corners of a wheel's outline; 16 sides have 0.981."""

LEAST_FILLED: Final = 0.985
"""Least ratio of a wheel's volume to that of the prism with its outline and width: the rims may be bevelled."""

_ALIGNED: Final = math.cos(math.radians(1.0))
"""Least cosine of the angle between the normals of a wheel's end faces and the axis of its joint."""

_CENTRED: Final = 0.01
"""Largest distance of a wheel's centre from the axis of its joint, relative to the wheel's radius."""

_INSIDE: Final = 1.01
"""Largest extent of the other pieces of the mesh, such as a rim, relative to the wheel's radius and half width."""


@dataclass(frozen=True, slots=True)
class TurningAxis:
    """Axis about which a link turns freely: a point [m] and a unit vector, in the link frame."""

    point: Floats
    direction: Floats


@dataclass(frozen=True, slots=True)
class RoundMesh:
    """Cylinder that a mesh approximates: radius and length [m], and its pose in the mesh's frame.

    The radius is that of the mesh's corners, because design programs tessellate a cylinder in this way. The axle is
    therefore never lower than on the corners of the mesh.
    """

    radius: float
    length: float
    pose: Pose


def turning_axis(link: SceneLink, tree: KinematicTree) -> TurningAxis | None:
    """Return the axis of the joint without limits that moves a link or its rigid group; None if there is none."""
    edge = tree.edges.get(tree.rigid[link.scoped])
    if edge is None or edge.joint.type not in ("revolute", "continuous") or len(edge.joint.axes) != 1:
        return None
    axis = edge.joint.axes[0]
    if not axis.upper - axis.lower > 2.0 * math.pi:
        return None
    to_link = link.pose_world.inverse()
    return TurningAxis(to_link.transform(edge.joint.pose_world.position), to_link.rotate(axis.xyz_world))


def round_mesh(shapes: Sequence[tuple[Floats, Ints]], pose: Pose, axis: TurningAxis) -> RoundMesh | None:
    """Return the cylinder that the largest convex shape of a mesh approximates and that contains the others.

    Args:
        shapes: vertices [m] and outward faces of each shape.
        pose: pose of the mesh in the link frame.
        axis: axis in the link frame.

    Returns:
        The cylinder; None if the mesh is not round about the axis.
    """
    if not shapes:
        return None
    vertices, faces = max(shapes, key=lambda shape: float(np.prod(np.ptp(shape[0], axis=0))))
    to_mesh = pose.inverse()
    cylinder = _cylinder(vertices, faces, to_mesh.transform(axis.point), to_mesh.rotate(axis.direction))
    if cylinder is None or len(shapes) == 1:
        return cylinder
    points = matmul(np.vstack([corners for corners, _ in shapes]) - cylinder.pose.position, cylinder.pose.matrix)
    is_inside = (np.hypot(points[:, 0], points[:, 1]) <= _INSIDE * cylinder.radius).all()
    return cylinder if is_inside and (np.abs(points[:, 2]) <= _INSIDE * cylinder.length / 2).all() else None


def _cylinder(vertices: Floats, faces: Ints, point: Floats, direction: Floats) -> RoundMesh | None:
    """Return the cylinder that a convex shape approximates about a line; None if the shape is not round.

    All values are in the frame of the vertices.
    """
    from scipy.spatial import ConvexHull, QhullError

    from simkit.compiler.meshes.convex_pieces import hull_volume

    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])  # length: twice the area
    along = matmul(normals, direction)
    ends = np.abs(along) > _ALIGNED * np.linalg.norm(normals, axis=1)
    axis_sum = (normals[ends] * np.sign(along[ends])[:, None]).sum(axis=0)
    if not axis_sum.any():
        return None
    turn = Pose((0.0, 0.0, 0.0), turn_z_to((*(axis_sum / norm(axis_sum)).tolist(),)))
    points = matmul(vertices - point, turn.matrix)
    try:
        outline = ConvexHull(points[:, :2])
    except (QhullError, ValueError):
        return None
    ring = points[outline.vertices, :2]
    following = np.roll(ring, -1, axis=0)
    areas = ring[:, 0] * following[:, 1] - ring[:, 1] * following[:, 0]
    centre = ((ring + following) * areas[:, None]).sum(axis=0) / (3.0 * areas.sum())
    radius = float(np.linalg.norm(ring - centre, axis=1).max())
    inscribed = float(-(matmul(outline.equations[:, :2], centre) + outline.equations[:, 2]).max())
    low, high = float(points[:, 2].min()), float(points[:, 2].max())
    if inscribed < LEAST_ROUND * radius or norm(centre) > _CENTRED * radius:
        return None
    if hull_volume(vertices) < LEAST_FILLED * outline.volume * (high - low):
        return None
    middle = point + turn.rotate((*centre, (low + high) / 2))
    return RoundMesh(radius, high - low, Pose(middle, turn.quaternion))
