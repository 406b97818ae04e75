"""Reader of `<inertial>`: mass properties from the file, from the format's defaults, or from the collisions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from simkit.float_sum import float_sum
from simkit.linear_algebra import matmul
from simkit.loaders.resources.loader import MeshReader
from simkit.loaders.sdf.solid_moments import Solid, solid_of, solid_of_triangles
from simkit.matrix_decompositions import eigvalsh
from simkit.params import Params
from simkit.pose import Pose
from simkit.scene import Inertial, Mesh, SceneCollision
from simkit.scene.geometry import vec3

Matrix = npt.NDArray[np.float64]
Moments = tuple[float, float, float, float, float, float]
"""ixx, iyy, izz, ixy, ixz, iyz [kg·m²]."""

MOMENT_NAMES = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
ADDED_MASS_NAMES = tuple(f"{a}{b}" for i, a in enumerate("xyzpqr") for b in "xyzpqr"[i:])
"""Elements of `<fluid_added_mass>`: the upper triangle of the matrix, row by row."""

_WATER = 1000.0  # density [kg/m³], the default of the format
_MAX_MOMENT = 1e15  # [kg] and [kg·m²]; products of larger numbers overflow


def read_inertial(
    link: Params,
    name: str,
    collisions: Sequence[SceneCollision],
    densities: Sequence[float | None],
    static: bool,
    mesh_reader: MeshReader | None = None,
) -> Inertial:
    """Return the mass properties of a link in link axes, about its centre of mass.

    Args:
        link: the `<link>` element.
        name: name of the link, for messages.
        collisions: collisions of the link.
        densities: density of each collision [kg/m³]; None if not given.
        static: true for a static model; its faults are only warnings, because the model does not move.
        mesh_reader: returns the triangles of meshes; without it a mesh has no volume.
    """
    block = link.child("inertial")
    if block is None:
        return Inertial(given=False)
    if block.attribute("auto", "false").lower() in ("true", "1"):
        return _automatic(block, name, collisions, densities, mesh_reader)
    block.has("density")
    earlier, errors = len(block.diagnostics), block.diagnostics.error_count
    mass = block.number("mass", 1.0, maximum=_MAX_MOMENT)
    pose, moments = block.pose("pose"), block.block("inertia")
    values = [moments.number(k, float(k[1] == k[2]), minimum=-_MAX_MOMENT, maximum=_MAX_MOMENT) for k in MOMENT_NAMES]
    if static and block.diagnostics.error_count > errors:
        # saved worlds have `nan` for walls without mass, and Gazebo opens them
        block.diagnostics.soften(d for d in tuple(block.diagnostics)[earlier:] if d.severity == "error")
    _check(name, mass, values, block, static)
    return Inertial(mass, vec3(pose.position), rotated_moments(values, pose), True)


def read_fluid_added_mass(link: Params) -> tuple[float, ...]:
    """Return the values of `<fluid_added_mass>` in the order of `ADDED_MASS_NAMES`; empty without this element."""
    block = link.block("inertial").block("fluid_added_mass")
    if not block.children:
        return ()
    return tuple(block.number(name, 0.0, minimum=-_MAX_MOMENT, maximum=_MAX_MOMENT) for name in ADDED_MASS_NAMES)


def rotated_moments(values: Sequence[float], pose: Pose) -> Moments:
    """Rotate moments and products of inertia from the axes of `pose` to the frame that contains the pose."""
    if pose.quaternion[0] != 1.0:
        turn = pose.matrix
        return moments_of(matmul(turn, _matrix(values), turn.T))
    ixx, iyy, izz, ixy, ixz, iyz = values
    return ixx, iyy, izz, ixy, ixz, iyz


def _matrix(v: Sequence[float]) -> Matrix:
    return np.array(((v[0], v[3], v[4]), (v[3], v[1], v[5]), (v[4], v[5], v[2])))


def moments_of(m: Matrix) -> Moments:
    """Return ixx, iyy, izz, ixy, ixz and iyz of an inertia matrix."""
    return float(m[0, 0]), float(m[1, 1]), float(m[2, 2]), float(m[0, 1]), float(m[0, 2]), float(m[1, 2])


def _check(name: str, mass: float, values: Sequence[float], block: Params, static: bool) -> None:
    place = block.child_or_self("mass")
    if mass < 0:
        report = place.warning if static else place.error
        report("SK-SDF-013", f"link {name!r} has mass {mass:g} kg; it must be positive")
    elif mass == 0:
        place.warning("SK-SDF-029", f"link {name!r} has mass 0; a link without mass cannot move by itself")
    if any(values[3:]):
        small, middle, large = (float(v) for v in eigvalsh(_matrix(values)))
    else:
        small, middle, large = sorted(values[:3])
    place = block.child_or_self("inertia")
    shown = ", ".join(f"{v:.4g}" for v in (small, middle, large))
    if small <= 0:
        text = f"link {name!r} has an impossible inertia: principal moments {shown}; all must be positive"
        # moments of zero are common in published files, and Gazebo runs them; a negative moment is a mistake
        is_mistake = small < -1e-12 * max(1.0, large) and not static
        (place.error if is_mistake else place.warning)("SK-SDF-013", text)
    elif small + middle < large * (1 - 1e-6):
        text = f"link {name!r} has an impossible inertia: principal moments {shown}"
        place.warning("SK-SDF-014", f"{text}; the sum of any two must be at least the third")


def _automatic(
    block: Params,
    name: str,
    collisions: Sequence[SceneCollision],
    densities: Sequence[float | None],
    mesh_reader: MeshReader | None,
) -> Inertial:
    """Return the mass properties of the collision solids; a `<mass>` in the file scales the computed values."""
    common = block.number("density", _WATER, minimum=0, maximum=_MAX_MOMENT)
    parts = []
    for collision, density in zip(collisions, densities, strict=True):
        solid = _solid(collision, mesh_reader, block)
        if solid is None or not (solid[0] > 0 and np.isfinite(solid[2]).all()):
            text = f"link {name!r}: collision {collision.name!r} has no volume for automatic inertia"
            block.diagnostics.warning("SK-SDF-022", text, collision.where)
            continue
        volume, centre, moments = solid
        mass = volume * (common if density is None else density)
        turn = collision.pose_link.matrix
        parts.append((mass, collision.pose_link.transform(centre), matmul(turn, moments, turn.T) * (mass / volume)))
    total = float_sum(mass for mass, _, _ in parts)
    if total <= 0:
        block.warning("SK-SDF-022", f"link {name!r} has no collision for automatic inertia; 1 kg is used")
        return Inertial()
    com = sum((mass * at for mass, at, _ in parts), np.zeros(3)) / total
    inertia = np.zeros((3, 3))
    for mass, at, moments in parts:
        d = at - com
        inertia += moments + mass * (float(matmul(d, d)) * np.eye(3) - np.outer(d, d))
    total_mass = block.number("mass", total, maximum=_MAX_MOMENT)
    if not (total <= _MAX_MOMENT and np.abs(inertia).max() <= _MAX_MOMENT):
        weight = f"link {name!r} has mass {total:g} kg from its collisions"
        block.error("SK-SDF-013", f"{weight}; at most {_MAX_MOMENT:g} kg and kg·m² can be simulated")
        return Inertial()
    if total_mass <= 0:
        message = f"link {name!r} has mass {total_mass:g} kg; it must be positive"
        block.child_or_self("mass").error("SK-SDF-013", message)
        total_mass = total
    return Inertial(total_mass, vec3(com), moments_of(inertia * (total_mass / total)), True)


def _solid(collision: SceneCollision, mesh_reader: MeshReader | None, block: Params) -> Solid | None:
    """Return the solid of a collision; a mesh is read, which also reports problems of its file."""
    shape = collision.geometry
    if not isinstance(shape, Mesh):
        return solid_of(shape)
    if mesh_reader is None or shape.missing:
        return None
    return solid_of_triangles(mesh_reader(shape, block.diagnostics, collision.where))
