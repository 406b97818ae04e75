"""Plugin with the names of ROS 2's `ekf_node` (package robot_localization): odometry and IMU become one estimate."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params, Plugin, Pose, msgs
from simkit.errors import ArgumentValueError, TransformError
from simkit.extend import (
    Options,
    OptionsOf,
    Vector,
    boolean,
    counted,
    listens,
    number,
    offers,
    publishes,
    text,
    without_effect,
)
from simkit.number_text import number_or_nan
from simkit.plugins.drives.odometry_messages import ODOMETRY, TRANSFORMS, BodyTwist, odometry_message, transforms
from simkit.pose import quat_from_rpy, quat_multiply
from simkit_navigation.plugins.localisation import extended_kalman_filter as ekf
from simkit_navigation.plugins.localisation import localization_measurements as measured
from simkit_navigation.plugins.localisation.localization_measurements import Flags, MeasuredBlock, PreviousPose

if TYPE_CHECKING:
    from simkit import Subscription

_INPUTS: Final = {
    "odom": ODOMETRY,
    "pose": "geometry_msgs/msg/PoseWithCovarianceStamped",
    "twist": "geometry_msgs/msg/TwistWithCovarianceStamped",
    "imu": "sensor_msgs/msg/Imu",
}
_REQUEST: Final = "robot_localization/srv/SetPose"
_TRUTHS: Final = {"true": True, "1": True, "false": False, "0": False}
_NO_EFFECT: Final = ("queue_size", "nodelay")


class EkfNodeOptions(Options):
    """Options of `EkfNode`, beside those of its inputs.

    Attributes:
        sensor_timeout: time without a measurement after which the filter predicts [s]; 1/`frequency` by default.
    """

    frequency: float = number(30.0, "Hz", minimum=1e-3, maximum=1e4)
    sensor_timeout: float = number(0.0, "s", minimum=0)
    two_d_mode: bool = boolean(False)
    publish_tf: bool = boolean(True)
    map_frame: str = text("map")
    odom_frame: str = text("odom")
    base_link_frame: str = text("base_link")
    world_frame: str = text(instead="odom_frame")
    transform_time_offset: float = number(0.0, "s")
    gravitational_acceleration: float = number(9.80665, "m/s²", minimum=0)
    dynamic_process_noise_covariance: bool = boolean(False)
    use_sim_time: bool = without_effect()
    print_diagnostics: bool = without_effect()
    debug: bool = without_effect()
    debug_out_file: bool = without_effect()
    transform_timeout: bool = without_effect()


@dataclass(eq=False)
class Input:
    """Topic that the filter reads.

    Attributes:
        name: name of its parameter, such as `odom0`.
        used: flags of the 15 states that are used.
        is_differential: whether differences of poses are used, as velocities.
        is_relative: whether poses are relative to the first one.
        removes_gravity: whether gravity is removed from accelerations.
        pose_threshold, twist_threshold, acceleration_threshold: largest Mahalanobis distances.
        first: first pose, of a relative input.
        before: last pose, of a differential input.
        newest_ns: time of the newest message [ns].
    """

    name: str
    used: Flags
    is_differential: bool
    is_relative: bool
    removes_gravity: bool
    pose_threshold: float
    twist_threshold: float
    acceleration_threshold: float
    first: Pose | None = None
    before: PreviousPose | None = None
    newest_ns: int = -1


class EkfNode(Plugin):
    """Estimates pose, twist and acceleration from odometry, poses, twists and IMUs, as robot_localization's `ekf_node`.

    Names, parameters and defaults are those of `ekf_node`. The parameters are elements of the plugin, or in a parameter
    file: `<ros><argument>--params-file ekf.yaml</argument></ros>`. The estimate is on `odometry/filtered`, and with
    `publish_tf` on `/tf`. The topic and the service `set_pose` set the pose.
    """

    parent_kind = ("world", "model")
    filenames = ("libsimkit_robot_localization.so",)
    names = ("simkit::EkfNode",)
    options = OptionsOf(EkfNodeOptions)
    endpoints = (
        publishes("odometry/filtered", ODOMETRY),
        publishes("/tf", TRANSFORMS),
        listens("set_pose", _INPUTS["pose"]),
        offers("set_pose", _REQUEST),
    )
    only_publishes = True

    def load(self, parent: object, params: Params) -> None:
        file_values = self.ros.values_with(None, self.sim.engine.structure.builder)
        if file_values is not None:
            self.params = file_values.joined(self.params)
        options = self.options.read_all()
        self._world = options.world_frame
        if self._world not in (options.odom_frame, options.map_frame):
            element = self.params.child_or_self("world_frame")
            expected = f"expected the odom_frame {options.odom_frame!r} or the map_frame {options.map_frame!r}"
            element.error("SK-PARAM-002", f"found world_frame {self._world!r:.100}; {expected}")
        self._period_ns = round((options.sensor_timeout or 1.0 / options.frequency) * 1e9)
        process = self._read_covariance("process_noise_covariance", np.diag(ekf.PROCESS_NOISE))
        first = self._read_covariance("initial_estimate_covariance", np.eye(ekf.SIZE) * ekf.INITIAL_VARIANCE)
        state = np.array(self.params.vector("initial_state", ekf.SIZE, (0.0,) * ekf.SIZE))
        self._filter = ekf.ExtendedKalmanFilter(
            process, state, first, has_dynamic_noise=options.dynamic_process_noise_covariance
        )
        self._queue: list[ekf.Measurement] = []
        self._published_ns = self._set_ns = -1
        self._inputs = {item.name: item for kind in _INPUTS for item in self._read_inputs(kind)}
        if not self._inputs:
            message = f"plugin {self.name!r} needs an input: odom0, pose0, twist0 or imu0"
            self.params.error("SK-PARAM-001", message, "such as <odom0>odom</odom0> with <odom0_config>")
        self._odometry = self.advertise("odometry/filtered", ODOMETRY)
        self._transforms = self.advertise("/tf", TRANSFORMS) if options.publish_tf else None
        self.listen("set_pose", _INPUTS["pose"], self._set_pose)
        self.offer("set_pose", _REQUEST, lambda request: self._set_pose(request.pose))
        self.after_step_rate = options.frequency

    # ------------------------------------------------------------------ parameters

    def _read_words(self, name: str, *counts: int) -> tuple[Params | None, list[str]]:
        """Return the element and the words of a list, in one element or in several; no words after an error."""
        items = self.params.all(name)
        words = " ".join(item.value for item in items).replace(",", " ").split()
        if items and len(words) not in counts:
            expected = " or ".join(map(str, counts))
            items[0].error("SK-PARAM-002", f"found {counted(len(words), 'value')} in {name!r}; expected {expected}")
            return items[0], []
        return (items[0] if items else None), words

    def _read_covariance(self, name: str, default: Vector) -> Vector:
        """Return a covariance: 225 numbers, or the 15 numbers of its diagonal."""
        item, words = self._read_words(name, ekf.SIZE, ekf.SIZE**2)
        if item is None or not words:
            return default
        values = np.array([number_or_nan(word) for word in words])
        covariance = np.diag(values) if len(values) == ekf.SIZE else values.reshape(ekf.SIZE, ekf.SIZE)
        if not np.isfinite(values).all() or (np.diag(covariance) < 0).any():
            item.error("SK-PARAM-002", f"found a value in {name!r} that is no number or a variance below 0")
            return default
        return covariance

    def _read_inputs(self, kind: str) -> list[Input]:
        """Read and subscribe to `odom0`, `odom1`, …: the first missing number ends the list, as in ROS."""
        inputs: list[Input] = []
        while self.params.has(name := f"{kind}{len(inputs)}"):
            topic = self.params.text(name, required=True)
            inputs.append(self._read_input(kind, name))
            self._subscribe(kind, topic, name)
        return inputs

    def _read_input(self, kind: str, name: str) -> Input:
        params, thresholds = self.params, {}
        item, words = self._read_words(f"{name}_config", ekf.SIZE)
        bad = [word for word in words if word.lower() not in _TRUTHS]
        if item is None:
            params.error("SK-PARAM-001", f"<{name}> needs <{name}_config>: 15 values true or false")
        elif bad:
            item.error("SK-PARAM-002", f"found {bad[0]!r:.60} in '{name}_config'; expected true or false")
        used = np.array([_TRUTHS.get(word.lower(), False) for word in words] or [False] * ekf.SIZE)
        if item is not None and words and not bad and not used.any():
            item.warning("SK-EKF-002", f"'{name}_config' is false for all states, so <{name}> is not used")
        is_imu, has_pose = kind == "imu", kind in ("odom", "pose", "imu")
        single = "_rejection_threshold"
        for part in ("pose", "twist") if kind == "odom" else ("pose", "twist", "linear_acceleration") if is_imu else ():
            thresholds[part] = params.number(f"{name}_{part}{single}", math.inf, minimum=0, finite=False)
        if kind in ("pose", "twist"):
            thresholds[kind] = params.number(f"{name}{single}", math.inf, minimum=0, finite=False)
        for suffix in _NO_EFFECT:
            params.child(f"{name}_{suffix}")
        return Input(
            name,
            used,
            has_pose and params.boolean(f"{name}_differential", False),
            has_pose and params.boolean(f"{name}_relative", False),
            is_imu and params.boolean(f"{name}_remove_gravitational_acceleration", False),
            thresholds.get("pose", math.inf),
            thresholds.get("twist", math.inf),
            thresholds.get("linear_acceleration", math.inf),
        )

    def _subscribe(self, kind: str, topic: str, name: str) -> Subscription:
        take: dict[str, Callable[[Input, msgs.Message], None]] = {
            "odom": self._take_odometry,
            "pose": self._take_pose,
            "twist": self._take_twist,
            "imu": self._take_imu,
        }
        # a name, because a restore replaces the inputs
        return self.subscribe(topic, partial(self._take, take[kind], _INPUTS[kind], name))

    # ------------------------------------------------------------------ messages

    def _take(
        self, take: Callable[[Input, msgs.Message], None], type_name: str, name: str, message: msgs.Message
    ) -> None:
        """Pass a new message to its function; a message of another type is ignored after a warning."""
        if self._once.has_type(message, type_name, name, "SK-EKF-001"):
            source = self._inputs[name]
            if self._is_new(source, message.header):
                take(source, message)

    def _take_odometry(self, source: Input, message: msgs.Odometry) -> None:
        self._add_pose(source, message.header.stamp, message.header.frame_id, message.pose)
        self._add_twist(source, message.header.stamp, message.child_frame_id, message.twist)

    def _take_pose(self, source: Input, message: msgs.PoseWithCovarianceStamped) -> None:
        self._add_pose(source, message.header.stamp, message.header.frame_id, message.pose)

    def _take_twist(self, source: Input, message: msgs.TwistWithCovarianceStamped) -> None:
        self._add_twist(source, message.header.stamp, message.header.frame_id, message.twist)

    def _take_imu(self, source: Input, message: msgs.Imu) -> None:
        mount = self._mount(source, message.header.frame_id)
        if mount is None:
            return
        time_ns = msgs.stamp_ns(message.header.stamp)
        is_oriented = abs(message.orientation_covariance[0] + 1.0) > 1e-9
        attitude = measured.unit_quaternion(message.orientation) if is_oriented else None
        if is_oriented and attitude is None and source.used[ekf.ANGLES].any():
            self._warn_of_numbers(source)
        if attitude is not None and source.used[ekf.ANGLES].any():
            covariance, used = message.orientation_covariance, source.used[ekf.ANGLES]
            block = measured.attitude_block(attitude, covariance, used, mount)
            self._add_angles(source, time_ns, block)
        rates = measured.vector_of(message.angular_velocity)
        if source.used[ekf.RATES].any():
            covariance = np.zeros((6, 6))
            covariance[3:, 3:] = np.reshape(message.angular_velocity_covariance, (3, 3))
            used = source.used[ekf.TWIST] & (np.arange(6) >= 3)
            block = measured.twist_block(np.zeros(3), rates, covariance, used, mount, self._filter.state[ekf.RATES])
            self._add(source, time_ns, block, source.twist_threshold)
        if source.used[ekf.ACCELERATION].any():
            force, gravity = measured.vector_of(message.linear_acceleration), self.options.gravitational_acceleration
            if attitude is None:
                attitude = quat_multiply(quat_from_rpy(*self._filter.state[ekf.ANGLES].tolist()), mount.quaternion)
            block = measured.acceleration_block(
                force,
                message.linear_acceleration_covariance,
                source.used[ekf.ACCELERATION],
                mount,
                attitude if source.removes_gravity else None,
                gravity,
            )
            self._add(source, time_ns, block, source.acceleration_threshold)

    def _is_new(self, source: Input, header: msgs.Header) -> bool:
        """Check whether a message is not older than the last one of its topic, and newer than the last `set_pose`."""
        time_ns = msgs.stamp_ns(header.stamp)
        is_new = time_ns >= source.newest_ns and time_ns > self._set_ns
        source.newest_ns = max(time_ns, source.newest_ns)
        return is_new

    def _add_pose(self, source: Input, stamp: msgs.Time, frame: str, message: msgs.PoseWithCovariance) -> None:
        pose, time_ns = measured.pose_of(message.pose), msgs.stamp_ns(stamp)
        used = source.used[ekf.POSE]
        if pose is None or not used.any():
            if used.any():
                self._warn_of_numbers(source)
            return
        covariance = np.array(message.covariance, np.float64).reshape(6, 6)
        if source.is_differential:
            self._add_difference(source, time_ns, pose, covariance, used)
            return
        if source.is_relative:
            source.first = source.first or pose
            pose = source.first.inverse() @ pose
        world = self._pose_of_frame(source.name, self._world, frame)
        if world is not None:
            self._add(source, time_ns, measured.pose_block(pose, covariance, used, world), source.pose_threshold)

    def _add_angles(self, source: Input, time_ns: int, block: MeasuredBlock) -> None:
        """Add the attitude of an IMU, or its change."""
        attitude = Pose((0.0, 0.0, 0.0), quat_from_rpy(*block.values.tolist()))
        if source.is_differential:
            covariance, used = np.zeros((6, 6)), np.zeros(6, bool)
            covariance[3:, 3:], used[3:] = block.covariance, block.used
            self._add_difference(source, time_ns, attitude, covariance, used)
            return
        if source.is_relative:
            source.first = source.first or attitude
            block.values = (source.first.inverse() @ attitude).rpy
        self._add(source, time_ns, block, source.pose_threshold)

    def _add_difference(self, source: Input, time_ns: int, pose: Pose, covariance: Vector, used: Flags) -> None:
        """Add the mean twist since the last message."""
        before, source.before = source.before, PreviousPose(pose, covariance, time_ns)
        block = None if before is None else measured.pose_difference_block(pose, covariance, used, time_ns, before)
        if block is not None:
            self._add(source, time_ns, block, source.pose_threshold)

    def _add_twist(self, source: Input, stamp: msgs.Time, frame: str, message: msgs.TwistWithCovariance) -> None:
        used = source.used[ekf.TWIST]
        mount = self._mount(source, frame) if used.any() else None
        if mount is not None:
            linear, angular = measured.vector_of(message.twist.linear), measured.vector_of(message.twist.angular)
            rates = self._filter.state[ekf.RATES]
            block = measured.twist_block(linear, angular, message.covariance, used, mount, rates)
            self._add(source, msgs.stamp_ns(stamp), block, source.twist_threshold)

    def _add(self, source: Input, time_ns: int, block: MeasuredBlock, threshold: float) -> None:
        if not block.is_finite:
            self._warn_of_numbers(source)
        self._queue.append(block.measurement(time_ns, threshold, is_planar=self.options.two_d_mode))

    def _warn_of_numbers(self, source: Input) -> None:
        text = f"a measurement of {source.name} has NaN or infinite numbers, which are not used"
        self._once.warn("SK-EKF-001", f"{source.name} finite", text, "check the plugin that publishes it")

    def _mount(self, source: Input, frame: str) -> Pose | None:
        """Return the pose of a sensor's frame in the base."""
        return self._pose_of_frame(source.name, self.options.base_link_frame, frame)

    def _pose_of_frame(self, owner: str, target: str, frame: str) -> Pose | None:
        """Return the pose of a frame in another one; None if it is not known, so that the message is not used."""
        if frame.lstrip("/") in ("", target.lstrip("/")):
            return Pose()
        try:
            return self.sim.tf.lookup(target, frame)
        except (TransformError, ArgumentValueError) as error:
            hint = "check odom_frame, base_link_frame and world_frame against the frames of the messages"
            message = f"a message of {owner} is not used: {error}"
            self._once.warn("SK-EKF-001", f"{owner} {target} {frame}", message, hint)
            return None

    def _set_pose(self, message: msgs.PoseWithCovarianceStamped) -> None:
        """Set the pose; the velocities and accelerations become zero."""
        pose = measured.pose_of(message.pose.pose)
        world = self._pose_of_frame("set_pose", self._world, message.header.frame_id)
        if pose is None or not np.isfinite(message.pose.covariance).all():
            self._once.not_finite("a pose on set_pose")
            return
        if world is None:
            return
        block = measured.pose_block(pose, message.pose.covariance, np.ones(6, bool), world)
        self._filter.state = np.zeros(ekf.SIZE)
        self._filter.state[ekf.POSE] = block.values
        self._filter.covariance = np.eye(ekf.SIZE) * ekf.INITIAL_VARIANCE
        self._filter.covariance[ekf.POSE, ekf.POSE] = block.covariance
        self._filter.time_ns = self._set_ns = self.sim.time_ns
        self._queue.clear()
        for source in self._inputs.values():
            source.before = source.first = None

    # ------------------------------------------------------------------ output

    def after_step(self) -> None:
        queue, self._queue = sorted(self._queue, key=lambda measurement: measurement.time_ns), []
        for measurement in queue:
            self._filter.take(measurement)
        now, time_ns = self.sim.time_ns, self._filter.time_ns
        if time_ns is None:
            return
        if not queue and now - time_ns >= self._period_ns:
            self._filter.predict(now)
        time_ns = self._filter.time_ns or 0
        if time_ns > self._published_ns:
            self._published_ns = time_ns
            self._publish(time_ns)

    def _publish(self, time_ns: int) -> None:
        state, covariance, options = self._filter.state, self._filter.covariance, self.options
        pose = Pose(state[ekf.POSITION], quat_from_rpy(*state[ekf.ANGLES].tolist()))
        if self._odometry.wanted:
            twist = BodyTwist(state[ekf.VELOCITY].tolist(), state[ekf.RATES].tolist())
            both = (np.ascontiguousarray(covariance[part, part]).reshape(-1) for part in (ekf.POSE, ekf.TWIST))
            self._odometry.publish(odometry_message(time_ns, self._world, options.base_link_frame, pose, twist, *both))
        if self._transforms is None or not self._transforms.wanted:
            return
        child = options.base_link_frame
        if self._world != options.odom_frame:  # the parent of the base is `odom`, so `odom` is moved in `map`
            base = self._pose_of_frame(self._world, options.odom_frame, child)
            if base is None:
                return
            pose, child = pose @ base.inverse(), options.odom_frame
        offset = round(options.transform_time_offset * 1e9)
        self._transforms.publish(transforms(time_ns + offset, (self._world, child, pose)))
