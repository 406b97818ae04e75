"""Vectors, poses and transforms as arrays."""

from __future__ import annotations

from simkit_nodes.message_arrays import (
    numpy_to_point,
    numpy_to_pose,
    numpy_to_quat,
    numpy_to_transform,
    numpy_to_vector3,
    point_to_numpy,
    pose_to_numpy,
    quat_to_numpy,
    transform_to_numpy,
    vector3_to_numpy,
)

__all__ = [
    "numpy_to_point",
    "numpy_to_pose",
    "numpy_to_quat",
    "numpy_to_transform",
    "numpy_to_vector3",
    "point_to_numpy",
    "pose_to_numpy",
    "quat_to_numpy",
    "transform_to_numpy",
    "vector3_to_numpy",
]
