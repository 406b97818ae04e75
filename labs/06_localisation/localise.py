"""Find a robot on a map with a particle filter: your plugin. Run it with `simkit lab grade .`"""

from __future__ import annotations

import math

import numpy as np
from scipy.ndimage import distance_transform_edt

from simkit import Pose, WorldPlugin, msgs

LEAST, MOST = 300, 3000  # particles
TRAVEL, TURN = 0.1, 0.2  # [m] and [rad], a scan is used when the robot has moved so far since the last one
BEAMS = 20  # rays of a scan that are used
CELL = np.array([0.5, 0.5, math.radians(10)])  # sides of a cell of the histogram [m, m, rad]


def move(poses, motion, random):
    """Return the poses after a motion of the robot; each pose moves with an error of its own.

    poses: x [m], y [m] and yaw [rad] of each particle in the frame map, shape (n, 3).
    motion: x [m], y [m] and yaw [rad] of the robot now in its frame at the last scan, measured by the odometry.
    random: NumPy's generator of random numbers; random.normal(0.0, sigma, n) returns n of them.
    """
    # Exercise 1: move each particle along its own heading, and add errors that grow with the motion.
    return poses


def log_likelihoods(distances):
    """Return the logarithm of the likelihood of each particle, shape (n,).

    distances: distance between the end of each ray and the nearest wall [m], shape (n, rays), one row for each
        particle. A particle in the right place has small distances.
    """
    # Exercise 2: the likelihood of a ray by its distance; then all rays of a particle together.
    return np.zeros(len(distances))


def enough(cells):
    """Return how many particles are enough if they lie in so many cells of the histogram."""
    # Exercise 3: the formula of KLD-sampling; between LEAST and MOST.
    return MOST


class Localise(WorldPlugin):
    """Publishes /amcl_pose, /particle_cloud, and the transform from map to odom."""

    before_step_rate = 20.0  # [Hz]

    def load(self, parent, params):
        self.poses = self.weights = None  # of the particles, shapes (n, 3) and (n,); no particles before the start
        self.slow = self.fast = 0.0  # averages of how well the scans agree with the map
        self.odometry, self.correction, self.count = None, None, 0
        self.scans, self.stream = [], self.random("particles")
        self.sim.tf.frames()  # from here on, transforms are kept
        self.subscribe("/map", self.take_map)
        self.subscribe("/scan", self.scans.append)
        self.listen("/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped", self.start_at)
        self.offer("/reinitialize_global_localization", "std_srvs/srv/Empty", lambda request: self.start_anywhere())
        self.pose = self.advertise("/amcl_pose", "geometry_msgs/msg/PoseWithCovarianceStamped")
        self.cloud = self.advertise("/particle_cloud", "nav2_msgs/msg/ParticleCloud")
        self.number = self.advertise("/localise/particles", "std_msgs/msg/Int32")
        self.tf = self.advertise("/tf", "tf2_msgs/msg/TFMessage")

    # ------------------------------------------------------------------ the lesson

    def update(self, motion, points, random):
        """Use a scan: move the particles, weigh them, estimate the pose, and draw new particles.

        motion: see `move`.
        points: ends of the rays in the frame of the robot [m], shape (rays, 2).
        """
        self.poses = move(self.poses, motion, random)
        distances = self.distances_at(ends_of(self.poses, points))
        logs = log_likelihoods(distances)
        agreement = float(self.weights @ np.exp(logs / len(points)))  # likelihood of one ray, mean over all particles
        self.slow = self.slow or agreement
        self.fast = self.fast or agreement
        # Exercise 4: let both averages follow the agreement, self.slow with the rate 0.02, self.fast with 0.3.
        self.weights = self.weights * np.exp(logs - logs.max())
        self.weights = self.weights / self.weights.sum()
        estimate = self.estimate()
        self.resample(random)
        return estimate

    def resample(self, random):
        """Draw as many particles as are enough, by their weights, and some anywhere if the robot seems to be lost."""
        # Exercise 3: random.choice(len(self.poses), number, p=self.weights) draws indices by the weights;
        #   how many particles are enough depends on count_cells(poses).
        # Exercise 4: replace the share 1 - self.fast / self.slow of them by self.anywhere(number, random).
        self.weights = np.full(len(self.poses), 1 / len(self.poses))

    # ------------------------------------------------------------------ given

    def estimate(self):
        """Return mean and covariance, by their weights, of the particles around the heaviest one of the histogram."""
        cells, which = np.unique(np.floor(self.poses / CELL), axis=0, return_inverse=True)
        best = cells[np.argmax(np.bincount(which.ravel(), self.weights))]
        offset = self.poses - (best + 0.5) * CELL
        offset[:, 2] = wrapped(offset[:, 2])
        near = np.abs(offset / CELL).max(axis=1) < 1.5
        weights = self.weights[near] / self.weights[near].sum()
        mean = weights @ offset[near]
        spread = offset[near] - mean
        return mean + (best + 0.5) * CELL, (spread * weights[:, None]).T @ spread

    def anywhere(self, number, random):
        """Return poses that are spread evenly over the free cells of the map and over all headings."""
        rows, columns = self.free[random.integers(len(self.free), size=number)].T
        x, y = self.corner[:, None] + (np.stack([columns, rows]) + random.random((2, number))) * self.resolution
        return np.column_stack([x, y, random.uniform(-math.pi, math.pi, number)])

    def distances_at(self, places):
        """Return the distance from each place [m] to the nearest wall [m]; places outside of the map are far."""
        columns, rows = np.moveaxis(np.floor((places - self.corner) / self.resolution).astype(int), -1, 0)
        height, width = self.field.shape
        inside = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
        return np.where(inside, self.field[rows.clip(0, height - 1), columns.clip(0, width - 1)], self.field.max())

    def take_map(self, message):
        info = message.info
        cells = np.asarray(message.data).reshape(info.height, info.width)
        self.resolution = info.resolution
        self.corner = np.array([info.origin.position.x, info.origin.position.y])
        self.free = np.argwhere(cells == 0)
        self.field = distance_transform_edt(cells != 100) * info.resolution  # [m] to the nearest wall, for each cell

    def start_anywhere(self):
        self.start(self.anywhere(MOST, self.new_random()))

    def start_at(self, message):
        pose, covariance = planar(msgs.pose(message)), np.reshape(message.pose.covariance, (6, 6))
        self.start(pose + self.new_random().normal(size=(MOST, 3)) * np.sqrt(np.diag(covariance)[[0, 1, 5]]))

    def start(self, poses):
        self.poses, self.weights = poses, np.full(len(poses), 1 / len(poses))
        self.odometry = None
        self.number.publish({"data": len(poses)})

    def new_random(self):
        """Return a generator whose numbers depend on the seed of the run and on the number of calls."""
        self.count += 1
        return self.stream.generator(self.count)

    def before_step(self):
        while self.scans and self.add(self.scans[0]):
            self.scans.pop(0)

    def add(self, scan):
        """Use a scan if the robot has moved; return False while the transform at its time is not known."""
        try:
            odometry = self.sim.tf.lookup("odom", "base_footprint", time=scan.header.stamp)
            lidar = planar(self.sim.tf.lookup("base_footprint", scan.header.frame_id))
        except LookupError:
            return False
        if self.poses is None:
            return True
        motion = planar(Pose() if self.odometry is None else self.odometry.inverse() @ odometry)
        if self.odometry is None or math.hypot(*motion[:2]) >= TRAVEL or abs(motion[2]) >= TURN:
            self.odometry = odometry
            ranges = np.asarray(scan.ranges, float)[:: len(scan.ranges) // BEAMS]
            angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))[:: len(scan.ranges) // BEAMS]
            hit = np.isfinite(ranges) & (ranges < scan.range_max)
            ends = ranges[hit, None] * np.stack([np.cos(angles[hit]), np.sin(angles[hit])], axis=1)
            points = ends_of(lidar[None], ends)[0]
            if len(points):
                self.publish(scan.header.stamp, *self.update(motion, points, self.new_random()))
        if self.correction is not None:
            self.tf.publish({"transforms": [self.transform(scan.header.stamp)]})
        return True

    def publish(self, stamp, mean, covariance):
        robot = Pose.from_rpy(mean[0], mean[1], 0, 0, 0, mean[2])
        self.correction = robot @ self.odometry.inverse()  # pose of the frame odom in the frame map
        header, full = {"stamp": stamp, "frame_id": "map"}, np.zeros((6, 6))
        full[np.ix_((0, 1, 5), (0, 1, 5))] = covariance
        self.pose.publish({"header": header, "pose": {"pose": msgs.pose_message(robot), "covariance": full.ravel()}})
        self.number.publish({"data": len(self.poses)})
        if self.cloud.wanted:  # many particles take a while
            poses = [msgs.pose_message(Pose.from_rpy(x, y, 0, 0, 0, yaw)) for x, y, yaw in self.poses]
            self.cloud.publish({"header": header, "particles": [{"pose": pose} for pose in poses]})

    def transform(self, stamp):
        """Return the transform from map to odom as a message."""
        (x, y, z), (qw, qx, qy, qz) = self.correction.position, self.correction.quaternion
        transform = {"translation": {"x": x, "y": y, "z": z}, "rotation": {"w": qw, "x": qx, "y": qy, "z": qz}}
        return {"header": {"stamp": stamp, "frame_id": "map"}, "child_frame_id": "odom", "transform": transform}


def ends_of(poses, points):
    """Return points of the frame of the robot [m] in the frame map for each pose, shape (poses, points, 2)."""
    cos, sin = np.cos(poses[:, 2, None]), np.sin(poses[:, 2, None])
    x, y = points.T
    return np.stack([poses[:, 0, None] + cos * x - sin * y, poses[:, 1, None] + sin * x + cos * y], axis=-1)


def count_cells(poses):
    """Return in how many cells of the histogram the poses lie."""
    return len(np.unique(np.floor(poses / CELL), axis=0))


def wrapped(angle):
    """Return an angle, or an array of them, between -pi and pi [rad]."""
    return (angle + math.pi) % math.tau - math.pi


def planar(pose):
    """Return x [m], y [m] and yaw [rad] of a pose."""
    return np.array([pose.position[0], pose.position[1], pose.rpy[2]])
