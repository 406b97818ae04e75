"""Messages and the pose of the camera, for the exercise. Given."""

from __future__ import annotations

import numpy as np

from simkit import Pose, msgs

CELL = 0.025  # [m], side of a cell of the map
CAMERA = "head_front_camera_rgb_optical_frame"
PANS = (0.5, 0.0, -0.5)  # [rad], directions of the motion head_look_around
TILT = -0.6  # [rad]
GOAL = Pose.from_rpy(0.52, 0.02, 0.9, 0, 0, 0)  # of arm_tool_link, in base_footprint


def camera_pose(sim):
    """Return the rotation matrix (3, 3) and the position (3,) [m] of the camera in base_footprint.

    A point p in the camera's frame is rotation @ p + position in base_footprint.
    """
    answer = sim.call("/compute_fk", {"fk_link_names": [CAMERA]})
    pose = msgs.pose(answer.pose_stamped[0])
    return np.array(pose.matrix), np.array(pose.position)


def look(pan):
    """Return a trajectory_msgs/msg/JointTrajectory that turns the head within 1 s."""
    point = {"positions": [pan, TILT], "time_from_start": {"sec": 1}}
    return {"joint_names": ["head_1_joint", "head_2_joint"], "points": [point]}


def cells_of(boxes):
    """Return the centres of all cells in boxes, shape (n, 3); a box is (x, y, z, side) [m]."""
    found = []
    for x, y, z, side in boxes:
        count = max(1, round(side / CELL))
        steps = (np.arange(count) - (count - 1) / 2) * CELL
        grid = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
        found.append(grid + np.array([x, y, z]))
    return np.vstack(found) if found else np.zeros((0, 3))


def cloud_message(points):
    """Return a sensor_msgs/msg/PointCloud2 in base_footprint."""
    fields = [{"name": name, "offset": 4 * k, "datatype": 7, "count": 1} for k, name in enumerate("xyz")]
    data = np.asarray(points, dtype="<f4").tobytes()
    sizes = {"height": 1, "width": len(points), "point_step": 12, "row_step": 12 * len(points)}
    header = {"frame_id": "base_footprint"}
    return {"header": header, "fields": fields, "data": np.frombuffer(data, np.uint8), "is_dense": True, **sizes}


def goal_message():
    """Return the goal of /move_action: the pose GOAL of the tool."""
    pose = msgs.pose_message(GOAL)
    place = {"link_name": "arm_tool_link", "constraint_region": {"primitive_poses": [pose]}}
    turn = {"link_name": "arm_tool_link", "orientation": pose.orientation}
    constraints = {"position_constraints": [place], "orientation_constraints": [turn]}
    return {"request": {"group_name": "arm_torso", "goal_constraints": [constraints]}}
