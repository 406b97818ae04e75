"""Voxels from a depth camera: your file. Run it with `simkit lab grade .`"""

from __future__ import annotations

import numpy as np
import pyoctomap
from voxel_tools import CELL, PANS, camera_pose, cells_of, cloud_message, goal_message, look

from simkit import ModelPlugin

RANGE = 2.0  # [m]: points further away are not used


def points_of(cloud):
    """Return the points of a sensor_msgs/msg/PointCloud2, shape (n, 3) [m], in the frame of the camera; without NaN.

    cloud.data has cloud.point_step bytes for each point; each of cloud.fields has a name ("x", "y", "z", "rgb") and an
    offset in bytes. The numbers are float32 ("<f4").
    """
    # Exercise 1: np.frombuffer, reshape, and np.isfinite.
    return np.zeros((0, 3))


def in_base(points, rotation, position):
    """Return points in base_footprint. rotation (3, 3) and position (3,): pose of the camera in base_footprint."""
    # Exercise 2
    return points


def make_map(scans):
    """Return a pyoctomap.OcTree of all scans. A scan: points (n, 3) and camera position (3,), in base_footprint."""
    tree = pyoctomap.OcTree(CELL)
    # Exercise 3: tree.insertPointCloud(points, origin, RANGE) casts the rays; a fourth of the points is enough.
    return tree


def occupied_boxes(tree):
    """Return a list of (x, y, z, side) [m]: the occupied leaves of the tree with x > 0.45 and z > 0.1."""
    # Exercise 4: tree.begin_leafs(), tree.isNodeOccupied(leaf), leaf.getCoordinate(), leaf.getSize()
    return []


def scene_world(boxes):
    """Return a moveit_msgs/msg/PlanningSceneWorld as a dict: one collision object "octomap" with all boxes.

    A primitive is {"type": 1, "dimensions": [x, y, z]}; primitive_poses has a pose for each of them.
    """
    # Exercise 5
    return {"collision_objects": []}


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
