"""Point clouds as arrays."""

from __future__ import annotations

from simkit_nodes.message_arrays import (
    array_to_pointcloud2,
    dtype_to_fields,
    fields_to_dtype,
    get_xyz_points,
    merge_rgb_fields,
    pointcloud2_to_array,
    pointcloud2_to_xyz_array,
    split_rgb_field,
)

__all__ = [
    "array_to_pointcloud2",
    "dtype_to_fields",
    "fields_to_dtype",
    "get_xyz_points",
    "merge_rgb_fields",
    "pointcloud2_to_array",
    "pointcloud2_to_xyz_array",
    "split_rgb_field",
]
