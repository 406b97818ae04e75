"""Point clouds in other frames."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import numpy.typing as npt
from numpy.lib.recfunctions import structured_to_unstructured

from simkit.linear_algebra import matmul
from simkit_nodes.interfaces import ProgramMessage
from simkit_nodes.message_transforms import Transforms, rotation_matrix
from simkit_nodes.message_transforms import same_message as from_msg_msg
from simkit_nodes.message_transforms import same_message as to_msg_msg
from simkit_nodes.ros_modules.sensor_msgs_py.point_cloud2 import create_cloud, read_points

__all__ = ["do_transform_cloud", "from_msg_msg", "to_msg_msg", "transform_points"]

Points = npt.NDArray[Any]


def transform_points(point_cloud: Points, transform: ProgramMessage) -> Points:
    """Return points, a row each, in another frame.

    Args:
        point_cloud: array (n, 3).
        transform: `geometry_msgs.msg.Transform`.
    """
    base = transform.translation
    turned: Points = matmul(point_cloud, rotation_matrix(transform).T)
    moved: Points = turned + np.array((base.x, base.y, base.z))
    return moved


def do_transform_cloud(cloud: ProgramMessage, transform: ProgramMessage) -> Any:
    """Return a `sensor_msgs.msg.PointCloud2` in another frame; fields other than x, y and z stay.

    Args:
        cloud: point cloud.
        transform: `geometry_msgs.msg.Transform`, or a `TransformStamped`, which also gives the name of the frame.

    Raises:
        AssertionError: the cloud lacks x, y or z.
    """
    header = type(cloud.header)(stamp=cloud.header.stamp, frame_id=cloud.header.frame_id)
    if hasattr(transform, "transform"):
        header.frame_id, transform = transform.header.frame_id, transform.transform
    names = {field.name for field in cloud.fields}
    if not set("xyz") <= names:
        raise AssertionError("Point cloud needs the fields x, y, and z for the transformation")
    points: Any = read_points(cloud)
    moved = transform_points(structured_to_unstructured(points[["x", "y", "z"]]), transform)
    if names == set("xyz"):
        return create_cloud(header, cloud.fields, moved)
    points = points.copy()
    for number, name in enumerate("xyz"):
        points[name] = moved[:, number]
    return create_cloud(header, cloud.fields, points, cloud.point_step)


TRANSFORMS: Final[Transforms] = {"sensor_msgs/msg/PointCloud2": do_transform_cloud}
