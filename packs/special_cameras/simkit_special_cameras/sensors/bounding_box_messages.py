"""Conversion of bounding boxes into `vision_msgs`, like ros_gz_bridge, and drawing of boxes into an image."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.linear_algebra import matmul
from simkit.msgs import Message
from simkit.pose import rpy_from_quat
from simkit_special_cameras.sensors.bounding_boxes import Box2D, Box3D, Projection
from simkit_special_cameras.sensors.shape_corners import CUBE_EDGES

Picture = npt.NDArray[np.uint8]

TYPE_2D: Final = "vision_msgs/msg/Detection2DArray"
TYPE_3D: Final = "vision_msgs/msg/Detection3DArray"
_GREEN: Final = (0, 255, 0)
_OGRE: Final = np.array(((0.0, -1.0, 0.0), (0.0, 0.0, 1.0), (-1.0, 0.0, 0.0)))
"""Rotation from the sensor's axes (forward, left, up) to those of Ogre's cameras (right, up, backward)."""


def detections_2d(header: msgs.Header, boxes: Sequence[Box2D]) -> msgs.Detection2DArray:
    """Return a `Detection2DArray`; each class id is a label as a decimal number, and each id is a model's name."""
    detection, corner = msgs.type_of("vision_msgs/msg/Detection2D"), msgs.type_of("vision_msgs/msg/Point2D")
    centre, bounding_box = msgs.type_of("vision_msgs/msg/Pose2D"), msgs.type_of("vision_msgs/msg/BoundingBox2D")
    detections = []
    for box in boxes:
        middle = centre(corner((box.left + box.right) / 2, (box.top + box.bottom) / 2), 0.0)
        frame = bounding_box(middle, box.right - box.left, box.bottom - box.top)
        detections.append(detection(header, [_hypothesis(box.item.label)], frame, box.item.model))
    return msgs.Detection2DArray(header, detections)


def detections_3d(header: msgs.Header, boxes: Sequence[Box3D], *, in_ogre_axes: bool = False) -> msgs.Detection3DArray:
    """Return a `Detection3DArray` in the sensor's frame.

    Args:
        header: header of the message.
        boxes: boxes in the sensor's frame.
        in_ogre_axes: True uses the axes of Gazebo's renderer, x to the right, y up, z backward.
    """
    detection, bounding_box = msgs.type_of("vision_msgs/msg/Detection3D"), msgs.type_of("vision_msgs/msg/BoundingBox3D")
    point, vector = msgs.type_of("geometry_msgs/msg/Point"), msgs.type_of("geometry_msgs/msg/Vector3")
    pose, turn = msgs.type_of("geometry_msgs/msg/Pose"), msgs.type_of("geometry_msgs/msg/Quaternion")
    quaternion = np.empty(4)
    detections = []
    for box in boxes:
        centre, rotation = (
            (matmul(_OGRE, box.centre), matmul(_OGRE, box.rotation)) if in_ogre_axes else (box.centre, box.rotation)
        )
        mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(rotation).ravel())
        w, x, y, z = quaternion.tolist()
        frame = bounding_box(pose(point(*centre.tolist()), turn(x, y, z, w)), vector(*box.size.tolist()))
        detections.append(detection(header, [_hypothesis(box.item.label)], frame, box.item.model))
    return msgs.Detection3DArray(header, detections)


def boxes_as_csv(message: Message) -> bytes:
    """Return the boxes of a message as a table with Gazebo's columns."""
    is_flat = message.__msgtype__ == TYPE_2D
    rows = ["label,x_center,y_center,width,height" if is_flat else "label,x,y,z,w,h,l,roll,pitch,yaw"]
    for detection in message.detections:
        box = detection.bbox
        if is_flat:
            centre = box.center.position
            values = [centre.x, centre.y, box.size_x, box.size_y]
        else:
            centre, turn, size = box.center.position, box.center.orientation, box.size
            angles = rpy_from_quat((turn.w, turn.x, turn.y, turn.z))
            values = [centre.x, centre.y, centre.z, size.x, size.y, size.z, *angles]
        rows.append(",".join([detection.results[0].hypothesis.class_id, *(f"{value:.6f}" for value in values)]))
    return ("\n".join(rows) + "\n").encode()


def _hypothesis(label: int) -> msgs.ObjectHypothesisWithPose:
    message: msgs.ObjectHypothesisWithPose = msgs.make(
        "vision_msgs/msg/ObjectHypothesisWithPose", hypothesis={"class_id": str(label), "score": 1.0}
    )
    return message


def draw_boxes(colours: Picture, boxes: Sequence[Box2D | Box3D], projection: Projection) -> Picture:
    """Return a copy of an image with the boxes in green."""
    import cv2

    out = colours.copy()
    corners = [box.corners() for box in boxes if isinstance(box, Box3D)]
    if corners:
        edges = np.concatenate([CUBE_EDGES + 8 * i for i in range(len(corners))])
        lines = projection.edges(np.concatenate(corners), edges)
        # far outside the image, clipping the end of a line hardly changes its slope inside
        farthest = 8.0 * max(projection.model.width, projection.model.height)
        cv2.polylines(out, list(np.clip(np.floor(lines), -farthest, farthest).astype(np.int32)), False, _GREEN)
    for box in boxes:
        if isinstance(box, Box2D):
            left, top = int(box.left), int(box.top)
            right, bottom = max(int(np.ceil(box.right)) - 1, left), max(int(np.ceil(box.bottom)) - 1, top)
            cv2.rectangle(out, (left, top), (right, bottom), _GREEN)
    return out
