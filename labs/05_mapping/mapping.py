"""Map a building from a lidar, and find the robot on the map: your plugin. Run it with `simkit lab grade .`"""

from __future__ import annotations

import numpy as np

from simkit import Pose, WorldPlugin, msgs

RESOLUTION = 0.05  # [m], side of a cell
SIDE = 20.0  # [m], side of the map; its middle is the place where the robot starts
TRAVEL, TURN = 0.2, 0.2  # [m] and [rad], a scan is used when the robot has moved so far since the last one


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
        # Exercise 1: change self.log_odds at the ends of the rays, and along the rays before their ends.
        # Without a loop over the rays this takes 2 ms; with one, 100 times as long.

    def values(self):
        """Return the cells of a nav_msgs/msg/OccupancyGrid: 0 (free) to 100 (occupied), and -1 (unknown)."""
        # Exercise 2: compute the probabilities from self.log_odds.
        return np.full(self.log_odds.shape, -1, np.int8)


def match(grid, guess, points):
    """Return the pose near a guess at which a scan fits the map best; each is x [m], y [m] and yaw [rad] of the robot.

    guess: the last pose, moved by the odometry since.
    points: ends of the rays [m] in the frame of the robot, shape (n, 2).
    """
    # Exercise 4: try poses around the guess, and return the best one. The map may still be empty.
    return guess


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
        # Exercise 3: offer the service /dynamic_map of the type nav_msgs/srv/GetMap.

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
