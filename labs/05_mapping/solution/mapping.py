"""Map a building from a lidar, and find the robot on the map: a solution."""

from __future__ import annotations

import cv2
import numpy as np

from simkit import Pose, WorldPlugin, msgs

RESOLUTION = 0.05  # [m], side of a cell
SIDE = 20.0  # [m], side of the map; its middle is the place where the robot starts
TRAVEL, TURN = 0.2, 0.2  # [m] and [rad], a scan is used when the robot has moved so far since the last one

HIT, MISS = 0.85, -0.4  # log-odds that a ray adds to the cell at its end, and to the cells before
LIMIT = 4.0  # largest log-odds, so that a cell can still change

SIGMA = 0.06  # [m], standard deviation of the likelihood field
PULL = 10.0  # [1/m²] and [1/rad²], weight of the odometry: cost of a pose away from the guess
STEPS = [(0.04, 0.02), (0.02, 0.01), (0.01, 0.004), (0.005, 0.002)]  # [m] and [rad] between candidates, coarse to fine


class Grid:
    """Occupancy grid: the log-odds of each cell, by row (y) and column (x); 0 is unknown."""

    def __init__(self):
        cells = round(SIDE / RESOLUTION)
        self.corner = -SIDE / 2  # [m], x and y of the corner of cell (0, 0) in the frame map
        self.log_odds = np.zeros((cells, cells), np.float32)

    def cells(self, x, y):
        """Return rows and columns of points [m] in the frame map; a point outside gets the nearest cell."""
        last = len(self.log_odds) - 1
        rows, columns = (np.floor((value - self.corner) / RESOLUTION).astype(int) for value in (y, x))
        return np.clip(rows, 0, last), np.clip(columns, 0, last)

    def add_scan(self, lidar, angles, ranges, longest):
        """Add one scan to the log-odds.

        lidar: x [m], y [m] and yaw [rad] of the lidar in the frame map.
        angles, ranges: direction [rad] of each ray in the frame of the lidar, and its range [m]; inf if it hit nothing.
        longest: largest range that the lidar measures [m].
        """
        x, y, yaw = lidar
        hit = np.isfinite(ranges) & (ranges < longest)
        length = np.where(hit, ranges, longest)
        cosine, sine = np.cos(yaw + angles), np.sin(yaw + angles)

        along = np.arange(0.0, length.max(), RESOLUTION / 2)
        ray, sample = np.nonzero(along < length[:, None])
        is_free = np.zeros(self.log_odds.shape, bool)
        is_free[self.cells(x + along[sample] * cosine[ray], y + along[sample] * sine[ray])] = True
        is_occupied = np.zeros(self.log_odds.shape, bool)
        is_occupied[self.cells((x + length * cosine)[hit], (y + length * sine)[hit])] = True

        self.log_odds[is_free & ~is_occupied] += MISS
        self.log_odds[is_occupied] += HIT
        np.clip(self.log_odds, -LIMIT, LIMIT, out=self.log_odds)

    def values(self):
        """Return the cells of a nav_msgs/msg/OccupancyGrid: 0 (free) to 100 (occupied), and -1 (unknown)."""
        percent = 100.0 / (1.0 + np.exp(-self.log_odds))
        return np.where(self.log_odds == 0.0, -1, np.round(percent)).astype(np.int8)


def match(grid, guess, points):
    """Return the pose near a guess at which a scan fits the map best; each is x [m], y [m] and yaw [rad] of the robot.

    guess: the last pose, moved by the odometry since.
    points: ends of the rays [m] in the frame of the robot, shape (n, 2).
    """
    is_wall = grid.log_odds > 0.0
    if not is_wall.any():
        return guess
    distance = cv2.distanceTransform((~is_wall).astype(np.uint8), cv2.DIST_L2, 3) * RESOLUTION
    likelihood = np.exp(-0.5 * (distance / SIGMA) ** 2)

    best = np.asarray(guess, float)
    offsets = np.arange(-2, 3)
    right, up, left = (axis.ravel() for axis in np.meshgrid(offsets, offsets, offsets))
    for step, turn in STEPS:
        candidates = best + np.stack([step * right, step * up, turn * left], axis=1)
        x, y, yaw = candidates.T[:, :, None]  # each with a row for each candidate; the points are the columns
        ends_x = x + np.cos(yaw) * points[:, 0] - np.sin(yaw) * points[:, 1]
        ends_y = y + np.sin(yaw) * points[:, 0] + np.cos(yaw) * points[:, 1]
        column, row = (((ends - grid.corner) / RESOLUTION - 0.5).astype(np.float32) for ends in (ends_x, ends_y))
        scores = cv2.remap(likelihood, column, row, cv2.INTER_LINEAR).mean(axis=1)  # between the middles of cells
        scores -= PULL * ((candidates - guess) ** 2).sum(axis=1)  # where the walls do not tell, as in a corridor
        best = candidates[scores.argmax()]
    return best


class Mapper(WorldPlugin):
    """Publishes /map, and the transform from map to odom, from the scans and the transforms of the robot."""

    before_step_rate = 20.0  # [Hz]

    def load(self, parent, params):
        self.grid, self.scans, self.last = Grid(), [], None
        self.correction = Pose()  # of the frame odom in the frame map
        self.sim.tf.frames()  # from here on, transforms are kept
        self.subscribe(params.text("scan", "/scan"), self.scans.append)
        self.map = self.advertise("/map", "nav_msgs/msg/OccupancyGrid", latched=True)
        self.tf = self.advertise("/tf", "tf2_msgs/msg/TFMessage")
        self.offer("/dynamic_map", "nav_msgs/srv/GetMap", self.answer)

    def answer(self, request):
        return {"map": self.message()}

    def before_step(self):
        while self.scans and self.add(self.scans[0]):
            self.scans.pop(0)

    def add(self, scan):
        """Add a scan to the map; return False while the transform at the time of the scan is not known."""
        try:
            odometry = self.sim.tf.lookup("odom", "base_footprint", time=scan.header.stamp)
            lidar = self.sim.tf.lookup("base_footprint", scan.header.frame_id)
        except LookupError:
            return False
        if self.last is not None:
            x, y, yaw = planar(self.last.inverse() @ odometry)
            if np.hypot(x, y) < TRAVEL and abs(yaw) < TURN:
                return True
        self.last = odometry

        ranges = np.asarray(scan.ranges, float)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        hit = np.isfinite(ranges) & (ranges < scan.range_max)
        x, y, yaw = planar(lidar)
        directions = np.stack([np.cos(yaw + angles), np.sin(yaw + angles)], axis=1)
        points = (x, y) + ranges[hit, None] * directions[hit]

        x, y, yaw = match(self.grid, planar(self.correction @ odometry), points)
        robot = Pose.from_rpy(x, y, 0, 0, 0, yaw)
        self.correction = robot @ odometry.inverse()
        self.grid.add_scan(planar(robot @ lidar), angles, ranges, scan.range_max)
        self.map.publish(self.message())
        self.tf.publish({"transforms": [self.transform(scan.header.stamp)]})
        return True

    def message(self):
        """Return the map as a message of the type nav_msgs/msg/OccupancyGrid."""
        values, corner = self.grid.values(), self.grid.corner
        origin = {"position": {"x": corner, "y": corner}, "orientation": {"w": 1.0}}
        info = {"resolution": RESOLUTION, "width": values.shape[1], "height": values.shape[0], "origin": origin}
        header = msgs.header(self.sim.time_ns, "map")
        return msgs.make("nav_msgs/msg/OccupancyGrid", header=header, info=info, data=values.ravel())

    def transform(self, stamp):
        """Return the transform from map to odom as a message."""
        (x, y, z), (qw, qx, qy, qz) = self.correction.position, self.correction.quaternion
        transform = {"translation": {"x": x, "y": y, "z": z}, "rotation": {"w": qw, "x": qx, "y": qy, "z": qz}}
        return {"header": {"stamp": stamp, "frame_id": "map"}, "child_frame_id": "odom", "transform": transform}


def planar(pose):
    """Return x [m], y [m] and yaw [rad] of a pose."""
    return float(pose.position[0]), float(pose.position[1]), float(pose.rpy[2])
