"""Measures how good a map is: compares /map with the true map of the world, and /tf with the true pose of the robot.

You need not change this file. It reads the ground truth, which only a simulator has.
"""

from __future__ import annotations

import math

import cv2
import numpy as np

from simkit import WorldPlugin
from simkit.errors import SimkitError

NEAR = 0.05  # [m], an occupied cell is true if something is so near to its middle
FOUND = 0.10  # [m], a place of a wall is found if an occupied cell is so near
SEEN = 3  # number of rays that must have hit a place of a wall
OCCUPIED, FREE = 65, 25  # limits of the values of cells, as for map_saver
NAMES = ("occupied", "free", "found", "known_area", "answers", "heading_error", "position_error")
NAMES += ("odometry_heading_error", "odometry_position_error")


class Referee(WorldPlugin):
    """Publishes every 0.5 s on /referee/..., each as std_msgs/msg/Float64:

    occupied: share of the map's occupied cells that are true to 5 cm.
    free: share of the map's free cells that are truly free.
    found: share of the places on walls, hit by at least three rays, that are on the map.
    known_area: area of the cells that are not unknown [m²].
    answers: 1 if the service /dynamic_map responds with the map that was published last, 0 otherwise.
    heading_error, position_error: of the robot in the frame map [deg, m].
    odometry_heading_error, odometry_position_error: of the robot in the frame odom [deg, m].
    """

    after_step_rate = 2.0  # [Hz]

    def load(self, parent, params):
        self.robot, self.lidar = params.text("robot", required=True), params.text("lidar", required=True)
        self.start = parent.model(self.robot).pose
        self.truth = self.map = self.judged = None
        self.subscribe("/truth/map", self.take_truth)
        self.subscribe("/map", self.take_map)
        self.subscribe(params.text("scan", "/scan"), self.take_scan)
        self.publishers = {name: self.advertise(f"/referee/{name}", "std_msgs/msg/Float64") for name in NAMES}
        self.sim.tf.frames()

    def take_truth(self, message):
        self.corner = message.info.origin.position.x, message.info.origin.position.y
        self.resolution = message.info.resolution
        cells = np.asarray(message.data).reshape(message.info.height, message.info.width)
        self.truth = distances(cells >= OCCUPIED, self.resolution)
        self.hits = np.zeros(cells.shape, int)

    def take_map(self, message):
        self.map = message

    def take_scan(self, scan):
        """Count the rays that end in each cell of the true map, from the true pose of the lidar."""
        pose = self.sim.link(self.lidar).pose
        ranges = np.asarray(scan.ranges, float)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges)) + pose.rpy[2]
        hit = np.isfinite(ranges) & (ranges < scan.range_max)
        directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        np.add.at(self.hits, self.cells(pose.position[:2] + ranges[hit, None] * directions[hit]), 1)

    def cells(self, points):
        """Return rows and columns of the true map for points in the world [m], shape (n, 2)."""
        columns, rows = np.floor((points - self.corner) / self.resolution).astype(int).T
        return np.clip(rows, 0, self.truth.shape[0] - 1), np.clip(columns, 0, self.truth.shape[1] - 1)

    def after_step(self):
        self.judge_pose("odometry_", "odom")
        self.judge_pose("", "map")
        if self.map is not None and self.sim.time >= self.judge_next():
            self.judged = self.sim.time
            self.judge_map()

    def judge_next(self):
        """Return the time of the next judgement of the map [s]: it takes longer than that of the pose."""
        return 0.0 if self.judged is None else self.judged + 5.0

    def publish(self, name, value):
        self.publishers[name].publish({"data": float(value)})

    def judge_pose(self, prefix, frame):
        try:  # the newest transform of each: a mapper publishes its own less often
            found = self.sim.tf.lookup(frame, "odom") @ self.sim.tf.lookup("odom", "base_footprint")
        except LookupError:
            return
        error = (self.start.inverse() @ self.sim.model(self.robot).pose).inverse() @ found
        self.publish(f"{prefix}heading_error", abs(math.degrees(error.rpy[2])))
        self.publish(f"{prefix}position_error", math.hypot(*error.position[:2]))

    def judge_map(self):
        info, origin = self.map.info, self.map.info.origin.position
        cells = np.asarray(self.map.data).reshape(info.height, info.width)
        rows, columns = np.nonzero(cells >= 0)
        values = cells[rows, columns]
        x, y = (columns + 0.5) * info.resolution + origin.x, (rows + 0.5) * info.resolution + origin.y
        yaw = self.start.rpy[2]  # the frame map begins at the place where the robot starts
        turned = np.stack([math.cos(yaw) * x - math.sin(yaw) * y, math.sin(yaw) * x + math.cos(yaw) * y], axis=1)
        middles = turned + self.start.position[:2]
        distance = self.truth[self.cells(middles)]
        is_occupied, is_free = values >= OCCUPIED, values <= FREE
        self.publish("occupied", share(distance[is_occupied] <= NEAR))
        self.publish("free", share(distance[is_free] > 0))
        marked = np.zeros(self.truth.shape, bool)
        marked[self.cells(middles[is_occupied])] = True
        wall = (self.hits >= SEEN) & (self.truth <= self.resolution)
        self.publish("found", share(distances(marked, self.resolution)[wall] <= FOUND) if marked.any() else 0.0)
        self.publish("known_area", len(values) * info.resolution**2)
        self.publish("answers", self.answers(cells))

    def answers(self, cells):
        try:
            response = self.sim.call("/dynamic_map")
        except SimkitError:
            return 0.0
        return float(np.array_equal(np.asarray(response.map.data), cells.ravel()))


def share(is_right):
    """Return the share of right cells; 0 if there are none."""
    return is_right.mean() if len(is_right) else 0.0


def distances(marked, resolution):
    """Return the distance of each cell to the next marked one [m]."""
    return cv2.distanceTransform((~marked).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE) * resolution
