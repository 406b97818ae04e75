"""Homogeneous matrices, quaternions and Euler angles, with the functions of ROS's `tf.transformations`.

Matrices are 4 × 4 arrays, quaternions are (x, y, z, w), and angles are in radians unless a function says otherwise.
`simkit_nodes.rotations` has the functions without matrices in their names, and explains sequences of axes.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from simkit.linear_algebra import det, dot, inverse, matmul, norm
from simkit.matrix_decompositions import svd
from simkit_nodes.rotations import (
    EPSILON,
    Arcball,
    Array,
    affine,
    arcball_constrain_to_axis,
    arcball_map_to_sphere,
    arcball_nearest_axis,
    euler_from_matrix,
    euler_from_quaternion,
    euler_matrix,
    quaternion_about_axis,
    quaternion_conjugate,
    quaternion_from_euler,
    quaternion_from_matrix,
    quaternion_inverse,
    quaternion_matrix,
    quaternion_multiply,
    quaternion_slerp,
    random_quaternion,
    random_rotation_matrix,
    random_vector,
    to_array,
    unit_vector,
    vector_norm,
)

__all__ = [
    "Arcball",
    "arcball_constrain_to_axis",
    "arcball_map_to_sphere",
    "arcball_nearest_axis",
    "clip_matrix",
    "compose_matrix",
    "concatenate_matrices",
    "decompose_matrix",
    "euler_from_matrix",
    "euler_from_quaternion",
    "euler_matrix",
    "identity_matrix",
    "inverse_matrix",
    "is_same_transform",
    "orthogonalization_matrix",
    "projection_from_matrix",
    "projection_matrix",
    "quaternion_about_axis",
    "quaternion_conjugate",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_inverse",
    "quaternion_matrix",
    "quaternion_multiply",
    "quaternion_slerp",
    "random_quaternion",
    "random_rotation_matrix",
    "random_vector",
    "reflection_from_matrix",
    "reflection_matrix",
    "rotation_from_matrix",
    "rotation_matrix",
    "scale_from_matrix",
    "scale_matrix",
    "shear_from_matrix",
    "shear_matrix",
    "superimposition_matrix",
    "translation_from_matrix",
    "translation_matrix",
    "unit_vector",
    "vector_norm",
]

_EIGENVALUE_TOLERANCE: Final = 1e-8


def identity_matrix() -> Array:
    """Return the matrix that changes nothing."""
    return np.identity(4)


def translation_matrix(direction: Any) -> Array:
    """Return the matrix that moves points by a vector."""
    return affine(np.identity(3), to_array(direction)[:3])


def translation_from_matrix(matrix: Any) -> Array:
    """Return the vector by which a matrix moves points."""
    return np.array(matrix, np.float64)[:3, 3]


def reflection_matrix(point: Any, normal: Any) -> Array:
    """Return the matrix that mirrors points at the plane through a point with a normal."""
    return scale_matrix(-1.0, point, normal)


def reflection_from_matrix(matrix: Any) -> tuple[Array, Array]:
    """Return a point and the normal of the plane at which a matrix mirrors."""
    values = to_array(matrix)
    return _eigenvector(values, 1.0, point=True), _eigenvector(values[:3, :3], -1.0)


def rotation_matrix(angle: float, direction: Any, point: Any = None) -> Array:
    """Return the matrix that rotates points about an axis through a point; the origin by default."""
    x, y, z = unit_vector(to_array(direction)[:3])
    sine, cosine = math.sin(angle), math.cos(angle)
    cross = np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))
    rotation = cosine * np.identity(3) + (1.0 - cosine) * np.outer((x, y, z), (x, y, z)) + sine * cross
    return affine(rotation) if point is None else _about(rotation, point)


def rotation_from_matrix(matrix: Any) -> tuple[float, Array, Array]:
    """Return angle, direction and a point of the axis of a rotation."""
    values = to_array(matrix)
    rotation = values[:3, :3]
    direction = _eigenvector(rotation.T, 1.0)
    point = _eigenvector(values, 1.0, point=True)
    twice = np.array(
        (rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1])
    )
    return math.atan2(dot(direction, twice) / 2.0, (float(np.trace(rotation)) - 1.0) / 2.0), direction, point


def scale_matrix(factor: float, origin: Any = None, direction: Any = None) -> Array:
    """Return the matrix that scales by a factor about a point, in all directions or in one; -1 mirrors."""
    if direction is None:
        linear = factor * np.identity(3)
    else:
        axis = unit_vector(to_array(direction)[:3])
        linear = np.identity(3) - (1.0 - factor) * np.outer(axis, axis)
    return affine(linear) if origin is None else _about(linear, origin)


def scale_from_matrix(matrix: Any) -> tuple[float, Array, Array | None]:
    """Return factor, origin and direction of a scaling; the direction is None if it scales in all directions."""
    values = to_array(matrix)
    factor = float(np.trace(values[:3, :3])) - 2.0
    direction: Array | None
    try:
        direction = _eigenvector(values[:3, :3], factor)
    except ValueError:
        factor, direction = (factor + 2.0) / 3.0, None
    return factor, _eigenvector(values, 1.0, point=True), direction


def _about(linear: Array, point: Any) -> Array:
    """Return the matrix with a linear part that does not move a point."""
    center = to_array(point)[:3]
    return affine(linear, center - matmul(linear, center))


def projection_matrix(
    point: Any, normal: Any, direction: Any = None, perspective: Any = None, pseudo: bool = False
) -> Array:
    """Return the matrix that projects points onto the plane through a point with a normal.

    Args:
        point: point of the plane.
        normal: normal of the plane.
        direction: direction of a parallel projection; along the normal by default.
        perspective: point from which a perspective projection is made.
        pseudo: keep the relative depth in a perspective projection.
    """
    base, axis = to_array(point)[:3], unit_vector(to_array(normal)[:3])
    offset = float(dot(base, axis))
    if perspective is not None:
        eye = to_array(perspective)[:3]
        matrix = affine(dot(eye - base, axis) * np.identity(3) - np.outer(eye, axis), offset * eye)
        if pseudo:
            matrix[:3, :3] -= np.outer(axis, axis)
            matrix[:3, 3] = offset * (eye + axis)
        matrix[3, :3] = -axis
        matrix[3, 3] = dot(eye, axis)
        return matrix
    along = axis if direction is None else to_array(direction)[:3]
    along = along / dot(along, axis)
    return affine(np.identity(3) - np.outer(along, axis), offset * along)


def projection_from_matrix(matrix: Any, pseudo: bool = False) -> tuple[Array, Array, Array | None, Array | None, bool]:
    """Return the arguments of `projection_matrix` that give a matrix.

    Raises:
        ValueError: the matrix projects onto no plane.
    """
    values = to_array(matrix)
    if not pseudo and _has_eigenvalue(values, 1.0):
        direction, normal = _eigenvector(values[:3, :3], 0.0), _eigenvector(values[:3, :3].T, 0.0)
        return _eigenvector(values, 1.0, point=True), normal, direction, None, False
    point = _eigenvector(values, (float(np.trace(values)) + pseudo) / 3.0, point=True)
    normal = -values[3, :3]
    perspective = values[:3, 3] / dot(point[:3], normal)
    return point, normal, None, perspective - normal if pseudo else perspective, pseudo


def clip_matrix(
    left: float, right: float, bottom: float, top: float, near: float, far: float, perspective: bool = False
) -> Array:
    """Return the matrix from a frustum along the z axis to coordinates from -1 to 1.

    Raises:
        ValueError: the frustum is empty, or a perspective one begins at the eye or behind it.
    """
    if left >= right or bottom >= top or near >= far:
        raise ValueError("invalid frustum")
    if perspective and near <= EPSILON:
        raise ValueError("invalid frustum: near <= 0")
    width, height, depth = right - left, top - bottom, far - near
    matrix = np.zeros((4, 4))
    if perspective:
        matrix[0, 0], matrix[0, 2] = -2.0 * near / width, (right + left) / width
        matrix[1, 1], matrix[1, 2] = -2.0 * near / height, (top + bottom) / height
        matrix[2, 2], matrix[2, 3] = -(far + near) / depth, 2.0 * near * far / depth
        matrix[3, 2] = -1.0
    else:
        matrix[0, 0], matrix[0, 3] = 2.0 / width, -(right + left) / width
        matrix[1, 1], matrix[1, 3] = 2.0 / height, -(top + bottom) / height
        matrix[2, 2], matrix[2, 3] = 2.0 / depth, -(far + near) / depth
        matrix[3, 3] = 1.0
    return matrix


def shear_matrix(angle: float, direction: Any, point: Any, normal: Any) -> Array:
    """Return the matrix that shears by an angle along a direction in a plane.

    Raises:
        ValueError: the direction is not in the plane.
    """
    axis, along = unit_vector(to_array(normal)[:3]), unit_vector(to_array(direction)[:3])
    if abs(dot(axis, along)) > 1e-6:
        raise ValueError("direction and normal vectors are not orthogonal")
    slope = math.tan(angle)
    return affine(np.identity(3) + slope * np.outer(along, axis), -slope * dot(to_array(point)[:3], axis) * along)


def shear_from_matrix(matrix: Any) -> tuple[float, Array, Array, Array]:
    """Return angle, direction, point and normal of a shear.

    Raises:
        ValueError: the matrix is no shear.
    """
    values = to_array(matrix)
    change = values[:3, :3] - np.identity(3)
    _, sizes, rows = svd(change)
    if sizes[1] > 1e-4:
        raise ValueError("No two linear independent eigenvectors found")
    normal = rows[0]
    shift = matmul(change, normal)
    slope = norm(shift)
    return math.atan(slope), shift / slope, _eigenvector(values, 1.0, point=True), normal


def decompose_matrix(matrix: Any) -> tuple[Array, list[float], list[float], Array, Array]:
    """Return scale, shear, angles about fixed x, y, z axes, translation and perspective of a matrix.

    Raises:
        ValueError: the matrix is singular.
    """
    values = np.array(matrix, np.float64)
    if abs(values[3, 3]) < EPSILON:
        raise ValueError("M[3, 3] is zero")
    values /= values[3, 3]
    affine = values.copy()
    affine[3] = 0, 0, 0, 1
    if not det(affine):
        raise ValueError("Matrix is singular")
    has_perspective = np.any(abs(values[3, :3]) > EPSILON)
    perspective = matmul(values[3], inverse(affine)) if has_perspective else to_array((0, 0, 0, 1))
    rotation, scale, shear = polar_parts(affine[:3, :3])
    return scale, shear, list(euler_from_matrix(rotation)), affine[:3, 3].copy(), perspective


def polar_parts(linear: Array) -> tuple[Array, Array, list[float]]:
    """Return rotation, scale and shear (x-y, x-z, y-z) of the linear part of a matrix."""
    columns: list[Array] = []
    upper = np.zeros((3, 3))
    for number, column in enumerate(linear.T):
        for other, unit in enumerate(columns):
            upper[other, number] = dot(unit, column)
            column = column - upper[other, number] * unit
        upper[number, number] = norm(column)
        columns.append(column / upper[number, number])
    rotation, scale = np.column_stack(columns), np.diag(upper).copy()
    shear = [float(upper[0, 1] / scale[1]), float(upper[0, 2] / scale[2]), float(upper[1, 2] / scale[2])]
    if det(rotation) < 0.0:
        scale, rotation = -scale, -rotation
    return rotation, scale, shear


def compose_matrix(
    scale: Any = None, shear: Any = None, angles: Any = None, translate: Any = None, perspective: Any = None
) -> Array:
    """Return the matrix with these parts, the inverse of `decompose_matrix`."""
    matrix = np.identity(4)
    if perspective is not None:
        matrix[3] = to_array(perspective)[:4]
    if translate is not None:
        matrix = matmul(matrix, translation_matrix(translate))
    if angles is not None:
        matrix = matmul(matrix, euler_matrix(*angles))
    sizes = np.ones(3) if scale is None else to_array(scale)[:3]
    upper = np.diag(sizes)
    if shear is not None:
        upper[0, 1], upper[0, 2], upper[1, 2] = shear[0] * sizes[1], shear[1] * sizes[2], shear[2] * sizes[2]
    matrix = matmul(matrix, affine(upper))
    return matrix / matrix[3, 3]  # type: ignore[no-any-return]


def orthogonalization_matrix(lengths: Any, angles: Any) -> Array:
    """Return the matrix from coordinates in a crystal's cell (lengths, angles in degrees) to orthogonal ones."""
    a, b, c = lengths
    alpha, beta, gamma = np.radians(angles)
    part = (math.cos(alpha) * math.cos(beta) - math.cos(gamma)) / (math.sin(alpha) * math.sin(beta))
    return affine(
        (
            (a * math.sin(beta) * math.sqrt(1.0 - part * part), 0.0, 0.0),
            (-a * math.sin(beta) * part, b * math.sin(alpha), 0.0),
            (a * math.cos(beta), b * math.cos(alpha), c),
        )
    )


def superimposition_matrix(v0: Any, v1: Any, scaling: bool = False, usesvd: bool = True) -> Array:  # noqa: ARG001
    """Return the rotation, translation and scale that move points closest to others in the mean square.

    Args:
        v0: points, a column each.
        v1: points to which they are moved.
        scaling: also scale.
        usesvd: accepted; both ways of `tf.transformations` have the same result.

    Raises:
        ValueError: the shapes differ, or there are fewer than three points.
    """
    first, second = to_array(v0)[:3], to_array(v1)[:3]
    if first.shape != second.shape or first.shape[1] < 3:
        raise ValueError("Vector sets are of wrong shape or type.")
    center, goal = first.mean(axis=1), second.mean(axis=1)
    first, second = first - center[:, np.newaxis], second - goal[:, np.newaxis]
    left, _, right = svd(matmul(second, first.T))
    rotation = matmul(left * np.array((1.0, 1.0, math.copysign(1.0, det(matmul(left, right))))), right)
    if scaling:
        rotation = rotation * math.sqrt(np.sum(second * second) / np.sum(first * first))
    return affine(rotation, goal - matmul(rotation, center))


def inverse_matrix(matrix: Any) -> Array:
    """Return the inverse of a matrix."""
    return inverse(matrix)


def concatenate_matrices(*matrices: Any) -> Array:
    """Return the product of matrices."""
    result = np.identity(4)
    for matrix in matrices:
        result = matmul(result, matrix)
    return result


def is_same_transform(matrix0: Any, matrix1: Any) -> bool:
    """Check whether two matrices move points alike."""
    first, second = to_array(matrix0), to_array(matrix1)
    return bool(np.allclose(first / first[3, 3], second / second[3, 3]))


def _has_eigenvalue(matrix: Array, eigenvalue: float) -> bool:
    return bool(svd(matrix - eigenvalue * np.identity(len(matrix)))[1][-1] < _EIGENVALUE_TOLERANCE)


def _eigenvector(matrix: Array, eigenvalue: float, *, point: bool = False) -> Array:
    """Return a unit eigenvector, or with `point` an eigenvector whose last number is 1."""
    _, sizes, rows = svd(matrix - eigenvalue * np.identity(len(matrix)))
    if sizes[-1] > _EIGENVALUE_TOLERANCE:
        raise ValueError(f"no eigenvector corresponding to eigenvalue {eigenvalue:g}")
    if not point:
        return to_array(rows[-1])
    vector = max(rows[sizes <= _EIGENVALUE_TOLERANCE], key=lambda row: abs(float(row[3])))
    return to_array(vector / vector[3])
