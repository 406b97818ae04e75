"""Plugin that finds the pose of a robot in a map by adaptive Monte Carlo localisation, as Nav2's `amcl`."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from simkit import Params, Plugin, Pose, msgs
from simkit.errors import ArgumentTypeError, ArgumentValueError, TransformError
from simkit.extend import listens, offers, publishes
from simkit.linear_algebra import matmul
from simkit.matrix_decompositions import eigh
from simkit.plugins.drives.odometry_messages import TRANSFORMS, transforms
from simkit_navigation.plugins.lifecycle_state import GET_STATE, answer_active
from simkit_navigation.plugins.localisation.likelihood_field import Hits, LikelihoodMap, Poses
from simkit_navigation.plugins.localisation.motion_models import MOTION_MODELS, wrapped_angles
from simkit_navigation.plugins.localisation.particle_filter import Adaptation, Estimate, ParticleFilter
from simkit_navigation.plugins.navigation.robot_link import links_of_frame

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.runtime.communication.parameter import Parameter

_POSE: Final = "geometry_msgs/msg/PoseWithCovarianceStamped"
_CLOUD: Final = "nav2_msgs/msg/ParticleCloud"
_SCAN: Final = "sensor_msgs/msg/LaserScan"
_GRID: Final = "nav_msgs/msg/OccupancyGrid"
_CODE: Final = "SK-AMCL-001"
_FARTHEST: Final = 1e9  # [m] of an initial pose and its deviation; larger numbers overflow in the filter
_FIELD_MODELS: Final = ("likelihood_field", "likelihood_field_prob")
_DIFFERENTIAL: Final = "nav2_amcl::DifferentialMotionModel"
_FIRST_COVARIANCE: Final = np.diag([0.25, 0.25, (math.pi / 12) ** 2])  # Nav2's, of `set_initial_pose`
_PATIENCE: Final = 1.0  # [s] for which a scan may wait for its transforms without a warning
_PLANE: Final = np.ix_((0, 1, 5), (0, 1, 5))  # x, y and yaw in a covariance of ROS


class Amcl(Plugin):
    """Finds the pose of a robot in a map by its laser scans and its odometry.

    Names and defaults are those of Nav2's `amcl`. The particles are moved by the odometry on `/tf`, weighted by the
    likelihood field of the map, and drawn again; their number adapts to the area that they cover. The plugin
    publishes the pose, the particles, and the transform from the map to the odometry.
    """

    filenames = ("libsimkit_amcl.so",)
    names = ("simkit::Amcl",)
    parent_kind = ("world", "model")
    endpoints = (
        listens("scan", _SCAN),
        listens("map", _GRID),
        listens("initialpose", _POSE),
        publishes("amcl_pose", _POSE),
        publishes("particle_cloud", _CLOUD),
        offers("~/get_state", GET_STATE),
    )

    def load(self, parent: Simulation | Model, params: Params) -> None:
        self._read_parameters(params)
        self._map: LikelihoodMap | None = None
        self._filter: ParticleFilter | None = None
        self._odometry: Pose | None = None  # at the last update of the filter
        self._correction: Pose | None = None  # pose of the odometry's frame in the map
        self._pending: msgs.LaserScan | None = None  # scan whose transforms are not known yet
        self._waits_since = 0.0
        self._is_everywhere = self._is_forced = self._has_reminded = False
        self._updates = self._draws = 0
        self._stream = self.random("particles")
        self._publisher = self.advertise("amcl_pose", _POSE, latched=True)
        self._cloud = self.advertise("particle_cloud", _CLOUD)
        self._transforms = self.advertise("/tf", TRANSFORMS)
        self.sim.tf.open()  # before the subscription, so that a transform is known when the callback looks for it
        self.subscribe("/tf", self._on_transforms, keep=0)
        builder = self.sim.engine.structure.builder
        of_map, of_scan = (self.ros.values_with(name, builder) or params for name in ("map_topic", "scan_topic"))
        self.subscribe(of_map.text("map_topic", "map"), self._on_map, keep=0)
        self.subscribe(of_scan.text("scan_topic", "scan"), self._on_scan, keep=0)
        self.listen("initialpose", _POSE, self._on_initial_pose)
        self.offer("reinitialize_global_localization", "std_srvs/srv/Empty", lambda _: self._spread())
        answer_active(self)
        self.offer("request_nomotion_update", "std_srvs/srv/Empty", lambda _: self._force())
        self.offer("set_initial_pose", "nav2_msgs/srv/SetInitialPose", lambda r: self._on_initial_pose(r.pose))
        if self._value("set_initial_pose"):
            x, y, yaw = (self._value(f"initial_pose.{name}") for name in ("x", "y", "yaw"))
            self._begin(np.array([x, y, yaw]), _FIRST_COVARIANCE)

    def _read_parameters(self, params: Params) -> None:
        declared: list[Parameter[Any]] = [
            self.declare("min_particles", 500, minimum=2, maximum=10**6, description="smallest number of particles"),
            self.declare("max_particles", 2000, minimum=2, maximum=10**6, description="largest number of particles"),
            self.declare("pf_err", 0.05, minimum=1e-3, maximum=1, description="largest error of the distribution"),
            self.declare("pf_z", 0.99, minimum=0, maximum=10, description="normal quantile of this error"),
            self.declare("recovery_alpha_slow", 0.0, minimum=0, maximum=1, description="rate of the slow average"),
            self.declare("recovery_alpha_fast", 0.0, minimum=0, maximum=1, description="rate of the fast average"),
            self.declare("resample_interval", 1, minimum=1, description="updates between two resamplings"),
            self.declare("update_min_d", 0.25, minimum=0, description="travel between two updates [m]"),
            self.declare("update_min_a", 0.2, minimum=0, description="turn between two updates [rad]"),
            self.declare("max_beams", 60, minimum=2, description="rays of a scan that are used"),
            self.declare("laser_min_range", -1.0, description="shortest range [m]; below 0: that of the scan"),
            self.declare("laser_max_range", 100.0, description="longest range [m]; below 0: that of the scan"),
            self.declare("laser_model_type", "likelihood_field", choices=_FIELD_MODELS, description="sum over rays"),
            self.declare("laser_likelihood_max_dist", 2.0, minimum=1e-3, description="largest distance [m]"),
            self.declare(
                "sigma_hit", 0.2, minimum=1e-3, maximum=1e3, description="standard deviation of the distance [m]"
            ),
            self.declare("z_hit", 0.5, minimum=0, maximum=1, description="weight of rays that hit the map"),
            self.declare("z_rand", 0.5, minimum=0, maximum=1, description="weight of rays that end anywhere"),
            self.declare("robot_model_type", _DIFFERENTIAL, choices=tuple(MOTION_MODELS), description="motion model"),
            self.declare("global_frame_id", "map", description="frame of the map"),
            self.declare("odom_frame_id", "odom", description="frame of the odometry"),
            self.declare("base_frame_id", "base_footprint", description="frame of the robot"),
            self.declare("tf_broadcast", True, description="publish the transform from the map to the odometry"),
            self.declare(
                "transform_tolerance", 1.0, minimum=0, maximum=1e6, description="how long a transform is valid [s]"
            ),
            self.declare("set_initial_pose", False, description="begin at <initial_pose>"),
            self.declare("initial_pose.x", 0.0, description="first position [m]"),
            self.declare("initial_pose.y", 0.0, description="first position [m]"),
            self.declare("initial_pose.yaw", 0.0, description="first heading [rad]"),
            self.declare("first_map_only", False, description="keep the first map"),
            self.declare(
                "begin_at_true_pose",
                False,
                description="begin at the true pose of the robot in the world, as the pose in the map",
            ),
            self.declare("alpha1", 0.2, minimum=0, description="variance of turns by turns [rad²/rad²]"),
            self.declare("alpha2", 0.2, minimum=0, description="variance of turns by travel [rad²/m²]"),
            self.declare("alpha3", 0.2, minimum=0, description="variance of travel by travel [m²/m²]"),
            self.declare("alpha4", 0.2, minimum=0, description="variance of travel by turns [m²/rad²]"),
            self.declare("alpha5", 0.2, minimum=0, description="variance of travel to the side [m²/m²]"),
        ]
        self._parameters = {parameter.name: parameter for parameter in declared}
        least, most = self._value("min_particles"), self._value("max_particles")
        if least > most:
            message = f"found <min_particles> {least}; expected at most <max_particles>, {most}"
            params.error("SK-PARAM-002", message)

    def _value(self, name: str) -> Any:
        return self._parameters[name].value

    def _generator(self) -> np.random.Generator:
        """Return a generator for one use; its numbers depend on seed, plugin and how many uses there were before."""
        self._draws += 1
        return self._stream.generator(self._draws)

    # ------------------------------------------------------------------ begin

    def _begin(self, pose: npt.NDArray[np.float64], covariance: npt.NDArray[np.float64]) -> None:
        """Spread the particles around a pose x, y, yaw [m, rad]."""
        values, axes = eigh((covariance + covariance.T) / 2)
        normal = self._generator().standard_normal((int(self._value("max_particles")), 3))
        poses = pose + matmul(normal * np.sqrt(np.maximum(values, 0.0)), axes.T)
        poses[:, 2] = wrapped_angles(poses[:, 2])
        self._restart(poses)

    def _begin_at_true_pose(self, base: str) -> None:
        """Spread the particles around the true pose of the robot's frame."""
        links = links_of_frame(self.sim, base)
        if len(links) == 1:
            pose = links[0].pose
            self._begin(np.array([*pose.position[:2], pose.rpy[2]]), _FIRST_COVARIANCE)
        else:
            text = f"{len(links)} models have a link {base!r}, so there is no true pose to begin at"
            self._once.warn(_CODE, "true pose", text, "set base_frame_id to LINK, or to MODEL/LINK")

    def _restart(self, poses: Poses) -> None:
        if self._filter is None:
            self._filter = ParticleFilter.of(poses)
        else:
            self._filter.restart(poses)
        self._publish_particles(msgs.time(self.sim.time_ns), self._filter)
        self._odometry = None  # the next scan is used, also if the robot does not move
        self._updates = 0
        self._is_everywhere = False

    def _spread(self) -> None:
        """Spread the particles over the free cells of the map; without a map, when it comes."""
        known_map = self._map
        if known_map is None:
            self._is_everywhere = True
        elif len(known_map.free):
            self._restart(known_map.random_poses(int(self._value("max_particles")), self._generator()))
        else:
            self._once.warn(_CODE, "free", "the map has no free cells, so a robot is nowhere")

    def _force(self) -> None:
        self._is_forced = True

    def _on_initial_pose(self, message: msgs.PoseWithCovarianceStamped) -> None:
        frame, expected = message.header.frame_id.lstrip("/"), self._value("global_frame_id")
        if frame not in ("", expected):
            text = f"an initial pose in the frame {frame!r:.60} is ignored; expected the frame {expected!r}"
            self._once.left_out("frame", text)
            return
        covariance = np.asarray(message.pose.covariance, float).reshape(6, 6)[_PLANE]
        try:
            pose = msgs.pose(message.pose)
        except (ArgumentTypeError, ArgumentValueError):
            pose = None
        if pose is None or not np.isfinite(covariance).all():
            self._once.not_finite("an initial pose")
            return
        if np.abs(pose.position[:2]).max() > _FARTHEST or np.abs(covariance).max() > _FARTHEST**2:
            self._once.left_out("far", f"an initial pose with numbers above {_FARTHEST:.0e} m is ignored")
            return
        self._begin(np.array([*pose.position[:2], pose.rpy[2]]), covariance)

    def _on_map(self, message: msgs.OccupancyGrid) -> None:
        if not self._once.has_type(message, _GRID, "map_topic", _CODE):
            return
        if self._map is not None and self._value("first_map_only"):
            return
        new_map = LikelihoodMap.from_message(message)
        if new_map is None:
            text = "a map is ignored that is empty, or whose size, resolution or origin is not valid"
            self._once.warn(_CODE, "map values", text)
            return
        frame, expected = message.header.frame_id.lstrip("/"), self._value("global_frame_id")
        if frame != expected:
            text = f"the map is in the frame {frame!r:.60}, <global_frame_id> is {expected!r}"
            self._once.warn(_CODE, "map frame", text, "give both the same name")
        self._map = new_map
        if self._is_everywhere:
            self._spread()

    # ------------------------------------------------------------------ scans

    def _on_scan(self, scan: msgs.LaserScan) -> None:
        if not self._once.has_type(scan, _SCAN, "scan_topic", _CODE):
            return
        if not math.isfinite(scan.angle_min + scan.angle_increment * len(scan.ranges)):
            self._once.not_finite("a scan")
            return
        if self._pending is None:
            self._waits_since = self.sim.time
        self._pending = scan
        self._use_if_known(scan)

    def _on_transforms(self, _: object) -> None:
        if self._pending is not None:
            self._use_if_known(self._pending)

    def _use_if_known(self, scan: msgs.LaserScan) -> None:
        """Use a scan when its transforms are known, as the message filter of ROS does."""
        base = self._value("base_frame_id")
        try:
            odometry = self.sim.tf.lookup(self._value("odom_frame_id"), base, scan.header.stamp)
            sensor = self.sim.tf.lookup(base, scan.header.frame_id, scan.header.stamp)
        except (TransformError, ArgumentValueError) as error:  # a scan may name no frame
            if self.sim.time - self._waits_since > _PATIENCE:
                self._once.warn(_CODE, "tf", f"scans are not used: {error}", "check the names of the frames")
            return
        self._pending = None
        if self._filter is None and self._value("begin_at_true_pose"):
            self._begin_at_true_pose(base)
        if self._filter is None:
            if not (self._is_everywhere or self._has_reminded):
                self._has_reminded = True
                self.log.warning("AMCL cannot publish a pose or update the transform. Please set the initial pose...")
            return
        if self._map is None:
            if self.sim.time > _PATIENCE:
                self._once.warn(_CODE, "map", "there is no map", "add a map server, or check <map_topic>")
            return
        self._localise(self._filter, self._map, scan, odometry, sensor)

    def _localise(
        self, known: ParticleFilter, field: LikelihoodMap, scan: msgs.LaserScan, odometry: Pose, sensor: Pose
    ) -> None:
        """Update the particles if the robot has moved, and publish the transform."""
        motion = Pose() if self._odometry is None else self._odometry.inverse() @ odometry
        x, y, turn = float(motion.position[0]), float(motion.position[1]), float(motion.rpy[2])
        has_moved = math.hypot(x, y) >= self._value("update_min_d") or abs(turn) >= self._value("update_min_a")
        if self._odometry is None or has_moved or self._is_forced:
            generator = self._generator()
            if self._odometry is not None:
                a1, a2, a3, a4, a5 = (float(self._value(f"alpha{n}")) for n in range(1, 6))
                move = MOTION_MODELS[self._value("robot_model_type")]
                known.poses = move(known.poses, (x, y, turn), (a1, a2, a3, a4, a5), generator)
            self._odometry, self._is_forced = odometry, False
            adaptation = self._adaptation()
            points, hits = self._end_points(scan, sensor), self._hits(scan)
            if len(points):
                means = field.mean_terms(known.poses, points, hits)
                known.weigh(hits.likelihoods(means, len(points)), hits.agreements(means), adaptation)
            estimate = known.estimate()
            if self._updates % self._value("resample_interval") == 0:
                anywhere = partial(field.random_poses, generator=generator) if len(field.free) else None
                known.resample(adaptation, anywhere, generator)
            self._updates += 1
            self._correction = Pose.from_rpy(*estimate.pose[:2], 0.0, 0.0, 0.0, estimate.pose[2]) @ odometry.inverse()
            frame = self._value("global_frame_id")
            self._publisher.publish_later(partial(_pose_message, scan.header.stamp, frame, estimate))
            self._publish_particles(scan.header.stamp, known)
        if self._correction is not None and self._value("tf_broadcast"):
            stamp = msgs.stamp_ns(scan.header.stamp) + round(self._value("transform_tolerance") * 1e9)
            item = self._value("global_frame_id"), self._value("odom_frame_id"), self._correction
            self._transforms.publish_later(partial(transforms, stamp, item))

    def _adaptation(self) -> Adaptation:
        least, most = int(self._value("min_particles")), int(self._value("max_particles"))
        error, quantile = float(self._value("pf_err")), float(self._value("pf_z"))
        slow, fast = float(self._value("recovery_alpha_slow")), float(self._value("recovery_alpha_fast"))
        return Adaptation(min(least, most), most, error, quantile, slow, fast)

    def _limits(self, scan: msgs.LaserScan) -> tuple[float, float]:
        """Return the shortest and the longest range [m]."""
        low, high = float(self._value("laser_min_range")), float(self._value("laser_max_range"))
        return max(low, float(scan.range_min)), min(high, scan.range_max) if high > 0 else float(scan.range_max)

    def _hits(self, scan: msgs.LaserScan) -> Hits:
        rand = float(self._value("z_rand")) / max(self._limits(scan)[1], 1e-3)
        sigma, farthest = float(self._value("sigma_hit")), float(self._value("laser_likelihood_max_dist"))
        is_product = self._value("laser_model_type") != _FIELD_MODELS[0]
        return Hits(sigma, float(self._value("z_hit")), rand, farthest, is_product)

    def _end_points(self, scan: msgs.LaserScan, sensor: Pose) -> npt.NDArray[np.float64]:
        """Return the end points of the rays that hit something, in the frame of the robot [m], shape (n, 2)."""
        ranges = np.asarray(scan.ranges, float)
        step = max(1, (len(ranges) - 1) // (int(self._value("max_beams")) - 1))
        numbers = np.arange(0, len(ranges), step)
        ranges = ranges[::step]
        low, high = self._limits(scan)
        is_hit = (ranges > low) & (ranges < high)  # not NaN
        ranges, angles = ranges[is_hit], scan.angle_min + scan.angle_increment * numbers[is_hit]
        points = np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles), np.zeros(len(ranges))))
        flat: npt.NDArray[np.float64] = (matmul(points, sensor.matrix.T) + sensor.position)[:, :2]
        return flat

    def _publish_particles(self, stamp: msgs.Time, known: ParticleFilter) -> None:
        if self._cloud.wanted:
            poses, weights = known.poses.copy(), known.weights.copy()
            self._cloud.publish_later(partial(_cloud_message, stamp, self._value("global_frame_id"), poses, weights))


def _pose_message(stamp: msgs.Time, frame: str, estimate: Estimate) -> msgs.Message:
    covariance = np.zeros((6, 6))
    covariance[_PLANE] = estimate.covariance
    pose = msgs.pose_message(Pose.from_rpy(*estimate.pose[:2], 0.0, 0.0, 0.0, estimate.pose[2]))
    header = {"stamp": stamp, "frame_id": frame}
    return msgs.make(_POSE, header=header, pose={"pose": pose, "covariance": covariance.reshape(-1)})


def _cloud_message(stamp: msgs.Time, frame: str, poses: Poses, weights: npt.NDArray[np.float64]) -> msgs.Message:
    names = ("nav2_msgs/msg/Particle", "geometry_msgs/msg/Pose", "geometry_msgs/msg/Point")
    particle, pose, point = map(msgs.type_of, names)
    quaternion = msgs.type_of("geometry_msgs/msg/Quaternion")
    rows = np.column_stack((poses[:, :2], np.sin(poses[:, 2] / 2), np.cos(poses[:, 2] / 2), weights)).tolist()
    particles = [particle(pose(point(x, y, 0.0), quaternion(0.0, 0.0, z, w)), weight) for x, y, z, w, weight in rows]
    return msgs.make(_CLOUD, header={"stamp": stamp, "frame_id": frame}, particles=particles)
