"""Matrices, quaternions and Euler angles, as in the ROS 2 package `tf_transformations`.

It differs from `tf.transformations` of ROS 1 in a few results: quaternions are tuples, the real part of a quaternion
from a matrix is not negative, shears come before scales, and perspective parts are ignored.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from simkit_nodes import transformations
from simkit_nodes.rotations import Array, Axes
from simkit_nodes.transformations import *  # noqa: F403 - the package has the same names, and some more

__all__ = [
    "ROTATION_IDENTITY",
    "SHEAR_IDENTITY",
    "TRANSLATION_IDENTITY",
    "ZOOM_IDENTITY",
    *transformations.__all__,
]

Quaternion = tuple[Any, Any, Any, Any]

TRANSLATION_IDENTITY: Final = [0.0, 0.0, 0.0]
ROTATION_IDENTITY: Final = np.identity(3)
ZOOM_IDENTITY: Final = [1.0, 1.0, 1.0]
SHEAR_IDENTITY: Final = TRANSLATION_IDENTITY


def _as_tuple(quaternion: Array) -> Quaternion:
    x, y, z, w = quaternion
    return x, y, z, w


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Quaternion:  # type: ignore[no-redef]
    """Return the quaternion of three angles about the axes of a sequence."""
    return _as_tuple(transformations.quaternion_from_euler(ai, aj, ak, axes))


def quaternion_about_axis(angle: float, axis: Any) -> Quaternion:  # type: ignore[no-redef]
    """Return the quaternion of a rotation about an axis."""
    return _as_tuple(transformations.quaternion_about_axis(angle, axis))


def quaternion_multiply(quaternion1: Any, quaternion0: Any) -> Quaternion:  # type: ignore[no-redef]
    """Return the product of two quaternions: the rotation by the second, then by the first."""
    return _as_tuple(transformations.quaternion_multiply(quaternion1, quaternion0))


def quaternion_from_matrix(matrix: Any) -> Quaternion:  # type: ignore[no-redef]
    """Return the quaternion of the rotation in a matrix, which may also scale and shear."""
    rotation, _, _ = transformations.polar_parts(np.asarray(matrix, np.float64)[:3, :3])
    quaternion = transformations.quaternion_from_matrix(rotation)
    return _as_tuple(-quaternion if quaternion[3] < 0.0 else quaternion)


def decompose_matrix(matrix: Any) -> tuple[Array, Array, tuple[float, ...], Array, None]:  # type: ignore[no-redef]
    """Return scale, shear, angles about fixed x, y, z axes and translation of a matrix, and None.

    Raises:
        ValueError: the matrix is singular.
    """
    (x, y, z), shear, angles, translate, _ = transformations.decompose_matrix(matrix)
    shears = np.array((shear[0] * y / x, shear[1] * z / x, shear[2] * z / y))
    return np.array((x, y, z)), shears, tuple(angles), translate, None


def compose_matrix(  # type: ignore[no-redef]
    scale: Any = None, shear: Any = None, angles: Any = None, translate: Any = None, perspective: Any = None
) -> Array:
    """Return the matrix with these parts, the inverse of `decompose_matrix`; the perspective is ignored."""
    del perspective
    if shear is not None and scale is not None:
        x, y, z = scale
        shear = shear[0] * x / y, shear[1] * x / z, shear[2] * y / z
    return transformations.compose_matrix(scale, shear, angles, translate)
