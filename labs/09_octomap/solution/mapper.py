"""Voxels from a depth camera: a solution."""

from __future__ import annotations

import numpy as np
import pyoctomap
from voxel_tools import CELL, PANS, camera_pose, cells_of, cloud_message, goal_message, look

from simkit import ModelPlugin

RANGE = 2.0  # [m]: points further away are not used


def points_of(cloud):
    """Return the points of a sensor_msgs/msg/PointCloud2, shape (n, 3) [m], in the frame of the camera; without NaN."""
    offsets = {field.name: field.offset for field in cloud.fields}
    rows = np.frombuffer(cloud.data, np.uint8).reshape(-1, cloud.point_step)
    points = np.stack([rows[:, offsets[n] : offsets[n] + 4].copy().view("<f4")[:, 0] for n in "xyz"], axis=1)
    return points[np.isfinite(points).all(axis=1)].astype(float)


def in_base(points, rotation, position):
    """Return points in base_footprint. rotation (3, 3) and position (3,): pose of the camera in base_footprint."""
    return points @ rotation.T + position


def make_map(scans):
    """Return a pyoctomap.OcTree of all scans. A scan: points (n, 3) and camera position (3,), in base_footprint."""
    tree = pyoctomap.OcTree(CELL)
    for points, position in scans:
        tree.insertPointCloud(np.ascontiguousarray(points[::4]), position, RANGE)
    return tree


def occupied_boxes(tree):
    """Return a list of (x, y, z, side) [m]: the occupied leaves of the tree with x > 0.45 and z > 0.1."""
    found = []
    for leaf in tree.begin_leafs():
        x, y, z = leaf.getCoordinate()
        if tree.isNodeOccupied(leaf) and x > 0.45 and z > 0.1:
            found.append((x, y, z, leaf.getSize()))
    return found


def scene_world(boxes):
    """Return a moveit_msgs/msg/PlanningSceneWorld as a dict: one collision object "octomap" with all boxes."""
    shapes = [{"type": 1, "dimensions": [side] * 3} for *_, side in boxes]
    poses = [{"position": {"x": x, "y": y, "z": z}, "orientation": {"w": 1.0}} for x, y, z, _ in boxes]
    return {"collision_objects": [{"id": "octomap", "primitives": shapes, "primitive_poses": poses}]}


class Mapper(ModelPlugin):
    """Looks around, makes the map, and sends the arm to its goal. Given."""

    before_step_rate = 50.0  # [Hz], calls of before_step

    def load(self, parent, params):
        self.todo = [step for pan in PANS for step in (("look", pan), ("open", None), ("take", None))] + [
            ("move", None)
        ]
        self.ready = 0.5  # [s], time of the next step
        self.cloud, self.scans, self.goal = None, [], None
        self.head = self.advertise("/head_controller/joint_trajectory", "trajectory_msgs/msg/JointTrajectory")
        self.cells = self.advertise("/octomap_point_cloud_centers", "sensor_msgs/msg/PointCloud2", latched=True)

    def before_step(self):
        if self.todo and self.sim.time >= self.ready:
            step, pan = self.todo.pop(0)
            wait = getattr(self, step)(pan)
            self.ready = self.sim.time + wait

    def look(self, pan):
        self.head.publish(look(pan))
        return 1.3

    def open(self, _):
        self.cloud = self.subscribe("/head_front_camera/depth_registered/points", keep=1)
        return 0.04

    def take(self, _):
        message = self.cloud.latest
        self.cloud.close()
        rotation, position = camera_pose(self.sim)
        points = in_base(points_of(message), rotation, position)
        self.scans.append((points, position))
        return 0.0

    def move(self, _):
        tree = make_map(self.scans)
        boxes = occupied_boxes(tree)
        self.cells.publish(cloud_message(cells_of(boxes)))
        answer = self.sim.call("/apply_planning_scene", {"scene": {"is_diff": True, "world": scene_world(boxes)}})
        if not answer.success:
            print("the planning scene was refused")
        self.goal = self.sim.send_goal("/move_action", goal_message())
        return 0.0
