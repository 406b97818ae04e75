"""Sensors of the Create 3 base of TurtleBot 4 in Gazebo Classic: `libgazebo_ros_create_bumper.so` and others.

The thresholds and formulas are those of irobot_create_gazebo_plugins. Each plugin publishes on `~/out`, which the files
of the robot remap.
"""

from __future__ import annotations

import abc
import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params, SensorPlugin, msgs
from simkit.extend import (
    Options,
    OptionsOf,
    find_link,
    find_named_joint,
    number,
    publish_while_subscribed,
    publishes,
    text,
)
from simkit.plugins.find_entities import SensorFrameOptions
from simkit.pose import quat_conjugate, quat_rotate

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, Sensor, SpecBuilder

HAZARD: Final = "irobot_create_msgs/msg/HazardDetection"
INTENSITY: Final = "irobot_create_msgs/msg/IrIntensity"
MOUSE: Final = "irobot_create_msgs/msg/Mouse"
IMU: Final = "sensor_msgs/msg/Imu"
_RAYS: Final = ("ray", "gpu_ray", "lidar", "gpu_lidar")
_BUMP, _CLIFF, _WHEEL_DROP = 1, 2, 4  # constants of HazardDetection
_STRONGEST: Final = 3500.0  # intensity at zero distance
_ZONES: Final = (
    (-math.pi / 2, -3 * math.pi / 10, "bump_right"),
    (-3 * math.pi / 10, -math.pi / 10, "bump_front_right"),
    (-math.pi / 10, math.pi / 10, "bump_front_center"),
    (math.pi / 10, 3 * math.pi / 10, "bump_front_left"),
    (3 * math.pi / 10, math.pi / 2, "bump_left"),
)
"""First and last direction of a zone of the bumper about the robot's z axis [rad], and its name."""


class CreateSensor(SensorPlugin):
    """Base class of plugins that publish what a sensor measures; while nobody subscribes, the sensor rests.

    Attributes:
        kinds: kinds of sensors that fit; the first one is named in errors.
        message_type: type of the messages on `~/out`.
    """

    options = OptionsOf(SensorFrameOptions)
    kinds: tuple[str, ...]
    message_type: str

    def load(self, parent: Sensor, params: Params) -> None:
        self._frame = self.options.read_all().frame_of(parent)
        if parent.kind not in self.kinds:
            self.refuse(parent, self.kinds[0])
            return
        self._sensor = parent
        self._out = self.advertise("~/out", self.message_type)
        parent.publish_on({next(iter(parent.products())): self.ros.topic("~/_raw")})
        publish_while_subscribed(self, self._out, parent.update_rate, "publish")

    @abc.abstractmethod
    def publish(self) -> None:
        """Publish the newest reading."""

    def _nearest(self) -> float:
        """Return the shortest range of a ray sensor [m], at most its maximum range."""
        scan = self._sensor.latest
        if scan is None:
            return math.inf
        ranges = np.asarray(scan.ranges)
        finite = ranges[np.isfinite(ranges)]
        return float(min(finite.min(initial=scan.range_max), scan.range_max))


class CreateBumper(CreateSensor):
    """Publishes `HazardDetection` of type BUMP on `~/out` for each zone of the bumper that has a contact.

    The frame of a message is the zone: `bump_left`, `bump_front_left`, `bump_front_center`, `bump_front_right` or
    `bump_right`, by the direction of the contact from the origin of the robot.
    """

    endpoints = (publishes("~/out", HAZARD),)
    filenames = ("libgazebo_ros_create_bumper.so",)
    kinds, message_type = ("contact",), HAZARD

    def publish(self) -> None:
        """Publish a message for each zone with a contact."""
        contacts = self._sensor.latest
        if contacts is None:
            return
        into_robot = self.sim.model(self.scoped.split("::")[0]).pose.inverse()
        zones: set[str] = set()
        for contact in contacts.contacts:
            for point in contact.positions:
                x, y, _ = into_robot.transform((point.x, point.y, point.z))
                angle = math.atan2(y, x)
                zones.update(name for low, high, name in _ZONES if low <= angle < high)
        for _, _, name in _ZONES:
            if name in zones:
                self._out.publish(msgs.make(HAZARD, header=msgs.header(self.sim.time_ns, name), type=_BUMP))


class CreateCliffOptions(SensorFrameOptions):
    """Options of `CreateCliffSensor`."""

    detection_threshold: float = number(0.01, "m", minimum=0)


class CreateCliffSensor(CreateSensor):
    """Publishes `HazardDetection` of type CLIFF on `~/out` while the floor is farther than `<detection_threshold>` [m].

    The nearest ray of the sensor counts.
    """

    endpoints = (publishes("~/out", HAZARD),)
    options = OptionsOf(CreateCliffOptions)
    filenames = ("libgazebo_ros_create_cliff_sensor.so",)
    kinds, message_type = _RAYS, HAZARD

    def publish(self) -> None:
        """Publish a message if there is a cliff."""
        nearest = self._nearest()
        if nearest >= self.options.detection_threshold and math.isfinite(nearest):
            self._out.publish(msgs.make(HAZARD, header=msgs.header(self.sim.time_ns, self._frame), type=_CLIFF))


class CreateIrIntensity(CreateSensor):
    """Publishes `IrIntensity` on `~/out`: 3500 · exp(-2e · d / d_max) for the nearest ray d and the maximum range."""

    endpoints = (publishes("~/out", INTENSITY),)
    filenames = ("libgazebo_ros_create_ir_intensity_sensor.so",)
    kinds, message_type = _RAYS, INTENSITY

    def publish(self) -> None:
        """Publish the intensity."""
        nearest = self._nearest()
        if math.isfinite(nearest):
            value = int(_STRONGEST * math.exp(-2 * math.e * nearest / self._sensor.latest.range_max))
            self._out.publish(msgs.make(INTENSITY, header=msgs.header(self.sim.time_ns, self._frame), value=value))


class CreateImu(CreateSensor):
    """Publishes its IMU on `~/out`, with the acceleration without the reaction to gravity, as Create 3's own plugin."""

    endpoints = (publishes("~/out", IMU),)
    filenames = ("libgazebo_ros_create_imu.so",)
    kinds, message_type = ("imu",), IMU

    def load(self, parent: Sensor, params: Params) -> None:
        super().load(parent, params)
        if hasattr(parent, "set_orientation_reference"):
            parent.frame_id = self._frame
            parent.set_orientation_reference((1.0, 0.0, 0.0, 0.0))

    def publish(self) -> None:
        """Publish the newest reading without gravity."""
        reading = self._sensor.latest
        if reading is None:
            return
        q = reading.orientation
        gravity = quat_rotate(quat_conjugate((q.w, q.x, q.y, q.z)), self.sim.mj_model.opt.gravity)
        a = reading.linear_acceleration
        x, y, z = (np.array((a.x, a.y, a.z)) + gravity).tolist()
        fields = {name: getattr(reading, name) for name in type(reading).__dataclass_fields__ if name != "__msgtype__"}
        self._out.publish(msgs.make(IMU, **{**fields, "linear_acceleration": {"x": x, "y": y, "z": z}}))


class CreateWheelDropOptions(Options):
    """Options of `CreateWheelDrop`."""

    joint_name: str = text(None, required=True)
    frame_id: str = text()
    update_rate: float = number(62.0, "Hz", minimum=0)
    detection_threshold: float = number(0.7, "m or rad", minimum=0)


class CreateWheelDrop(ModelPlugin):
    """Publishes `HazardDetection` of type WHEEL_DROP on `~/out` while a wheel hangs down.

    The wheel has dropped when the position of `<joint_name>` reaches 0.95 · `<detection_threshold>`, until the position
    is below 0.75 · `<detection_threshold>`.
    """

    endpoints = (publishes("~/out", HAZARD),)
    options = OptionsOf(CreateWheelDropOptions)
    filenames = ("libgazebo_ros_create_wheel_drop.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        joint = find_named_joint(scene, "joint_name", params)
        self._joint_name = "" if joint is None else joint.scoped
        self.after_step_rate = options.update_rate

    def load(self, parent: Model, params: Params) -> None:
        self._joint = self.sim.joint(self._joint_name)
        self._has_dropped = False
        self._out = self.advertise("~/out", HAZARD)

    def after_step(self) -> None:
        """Compare the position of the joint with the thresholds."""
        position = float(np.ravel(self._joint.position)[0])
        threshold = self.options.detection_threshold
        self._has_dropped = position >= (0.75 if self._has_dropped else 0.95) * threshold
        if self._has_dropped and self._out.wanted:
            header = msgs.header(self.sim.time_ns, self.options.frame_id)
            self._out.publish(msgs.make(HAZARD, header=header, type=_WHEEL_DROP))


class CreateOpticalMouseOptions(Options):
    """Options of `CreateOpticalMouse`."""

    link: str = text("base_link")
    update_rate: float = number(100.0, "Hz", minimum=0)


class CreateOpticalMouse(ModelPlugin):
    """Publishes `Mouse` on `~/out`: the way of a link along its own x and y axes since the start [m]."""

    endpoints = (publishes("~/out", MOUSE),)
    options = OptionsOf(CreateOpticalMouseOptions)
    filenames = ("libgazebo_ros_create_optical_mouse.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        link = find_link(scene, options.link, params.block("link"))
        self._scoped = "" if link is None else link.scoped
        self.after_step_rate = options.update_rate

    def load(self, parent: Model, params: Params) -> None:
        self._link = self.sim.link(self._scoped)
        self._last = self._link.pose
        self._way = np.zeros(2)
        self._out = self.advertise("~/out", MOUSE)

    def after_step(self) -> None:
        """Add the way since the last instant."""
        pose = self._link.pose
        self._way = self._way + (self._last.inverse() @ pose).position[:2]
        self._last = pose
        if self._out.wanted:
            x, y = self._way.tolist()
            header = msgs.header(self.sim.time_ns, "")
            self._out.publish(msgs.make(MOUSE, header=header, integrated_x=x, integrated_y=y))
