"""Sensors of the Kobuki base in Gazebo Classic: bumper, cliff and wheel drop events, and the IMU.

Topics, thresholds, the three zones of the bumper and the conversion of a distance to the value of the analog-digital
converter are those of `gazebo_ros_kobuki_updates.cpp` in kobuki_gazebo_plugins. Four differences are deliberate. An
angle of the bumper is wrapped to ±180°; Gazebo's plugin loses contacts when the robot looks along -x of the world. The
rays of the cliff sensors pass through the own model; in the published description they start inside the collision of
the base, and Gazebo's cliff events never come (yujinrobot/kobuki#431). The IMU is published once for each reading, not
at every step. The wheel drop is simkit's own, because Gazebo's plugin has none: a wheel has dropped while it touches
nothing. The states of all sensors together are those that the driver of the real base publishes; the angle of an
encoder's tick is from `diff_drive.cpp` in kobuki_core.
"""

from __future__ import annotations

import abc
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, cast

import numpy as np

from simkit import ModelPlugin, Params, msgs
from simkit.extend import choice, did_you_mean, number, publish_while_subscribed, publishes, text
from simkit.plugins.find_entities import find_named_sensor
from simkit.plugins.publish_on_demand import watch_while_subscribed
from simkit.pose import wrap_angle
from simkit.runtime.contact.collision_contacts import Bools, collision_table, find_contacts
from simkit_robots.plugins.classic.kobuki_docking import CHARGING, RECEIVERS, KobukiDockOptions, is_docked, signals

if TYPE_CHECKING:
    from simkit import Model, Pose, Publisher
    from simkit.extend import SceneModel, Sensor
    from simkit.sensors.rays.lidar_measurement import LidarMeasurement

PACKAGES: Final = ("kobuki_ros_interfaces", "kobuki_msgs")
BUMPER, CLIFF, WHEEL_DROP = (f"{PACKAGES[0]}/msg/{name}Event" for name in ("Bumper", "Cliff", "WheelDrop"))
STATE, DOCK = f"{PACKAGES[0]}/msg/SensorState", f"{PACKAGES[0]}/msg/DockInfraRed"
IMU: Final = "sensor_msgs/msg/Imu"
PREFIX: Final = "mobile_base"
_RAYS: Final = ("ray", "gpu_ray", "lidar", "gpu_lidar")
_CLIFF_ELEMENTS: Final = ("cliff_sensor_left_name", "cliff_sensor_center_name", "cliff_sensor_right_name")
_BUMPER_HEIGHTS: Final = (0.01, 0.13)  # above the model's origin [m]; the collision is higher than the bumper
_ZONE: Final = math.pi / 6  # half of the angle of the bumper's middle zone [rad]
_DROP_TIME_NS: Final = 100_000_000  # a shorter flight, as over the joint of a floor, is no wheel drop
_CONVERTER: Final = 76123.0, 0.995  # of the cliff sensors: factor, and distance in metres
_WORD: Final = 1 << 16  # a value of the converter has 16 bits
_TICK: Final = 0.002436916871363930  # of a wheel's encoder [rad]
_STATE_RATE: Final = 50.0  # of the real base [Hz]
_NOMINAL_BATTERY: Final = 148  # [0.1 V]; there is no model of the battery
_UNKNOWN: Final = 1e6  # variance of the axes that a Kobuki does not measure
_YAW_VARIANCE: Final = 0.05


class KobukiSensorOptions(KobukiDockOptions):
    """Options of `KobukiSensors`."""

    imu_name: str = text()
    bumper_name: str = text()
    cliff_sensor_left_name: str = text()
    cliff_sensor_front_name: str = text()  # the name of the middle sensor in files from before 2013
    cliff_sensor_center_name: str = text(instead="cliff_sensor_front_name")
    cliff_sensor_right_name: str = text()
    cliff_detection_threshold: float = number(0.04, "m", minimum=0)
    base_prefix: str = text(PREFIX)
    message_package: str = choice(PACKAGES, PACKAGES[0])

    def topic(self, name: str) -> str:
        """Return the name of one of the base's topics, below `<base_prefix>`."""
        prefix = self.base_prefix.rstrip("/")
        return f"{prefix}/{name}" if prefix else name


class KobukiSensors(ModelPlugin):
    """Base class of the Kobuki's plugin: finds the sensors and publishes the events and the IMU.

    An event is a change of state since the previous reading, and is published only while an events topic has a
    subscriber.
    """

    sensor_endpoints = (
        publishes(f"{PREFIX}/events/bumper", BUMPER, named_by=("base_prefix",)),
        publishes(f"{PREFIX}/events/cliff", CLIFF, named_by=("base_prefix",)),
        publishes(f"{PREFIX}/events/wheel_drop", WHEEL_DROP, named_by=("base_prefix",)),
        publishes(f"{PREFIX}/sensors/core", STATE, named_by=("base_prefix",)),
        publishes(f"{PREFIX}/sensors/dock_ir", DOCK, named_by=("base_prefix",)),
        publishes(f"{PREFIX}/sensors/imu_data", IMU, named_by=("base_prefix",)),
    )
    _imu: Sensor | None = None

    def find_sensors(self, scene: SceneModel, params: Params, wheels: Sequence[str]) -> None:
        """Find the sensors that the file names.

        Args:
            scene: Model of the plugin.
            params: Parameters of the plugin.
            wheels: Scoped names of the links of the left and the right wheel.
        """
        self._imu_name = find_named_sensor(scene, "imu_name", ("imu",), params)
        self._bumper_name = find_named_sensor(scene, "bumper_name", ("contact",), params)
        left, center, right = (find_named_sensor(scene, element, _RAYS, params) for element in _CLIFF_ELEMENTS)
        front = find_named_sensor(scene, "cliff_sensor_front_name", _RAYS, params)
        self._cliff_names = left, center or front, right
        collisions = {link.scoped: [c.scoped for c in link.collisions] for link in scene.all_links()}
        self._wheel_collisions = tuple(tuple(collisions.get(wheel, ())) for wheel in wheels)

    @abc.abstractmethod
    def read_encoders(self) -> tuple[float, float]:
        """Return the angles of the left and the right wheel [rad]."""

    def open_sensors(self, parent: Model, options: KobukiSensorOptions) -> None:
        """Open the topics of the sensors that were found."""
        self._model, self._threshold = parent, options.cliff_detection_threshold
        self._imu = self.sim.sensor(self._imu_name) if self._imu_name else None
        self._bumper = self.sim.sensor(self._bumper_name) if self._bumper_name else None
        self._cliffs = tuple(self.sim.sensor(name) if name else None for name in self._cliff_names)
        for cliff in self._cliffs:
            if cliff is not None and not self.sim.world.gazebo_quirks:
                cast("LidarMeasurement", cliff).ignore_own_model()
        self._pressed, self._over_cliff = [False] * 3, [False] * 3
        self._dropped, self._last_touch_ns = [False] * 2, [self.sim.time_ns] * 2
        self._was_heard = False
        package = options.message_package
        types = (f"{package}/msg/{name.rpartition('/')[2]}" for name in (BUMPER, CLIFF, WHEEL_DROP, STATE, DOCK))
        self._bumper_type, self._cliff_type, self._drop_type, self._state_type, self._dock_type = types
        events: list[Publisher] = []
        if self._bumper is not None:
            self._bumper_out = self.advertise(options.topic("events/bumper"), self._bumper_type)
            events.append(self._bumper_out)
        if any(self._cliff_names):
            self._cliff_out = self.advertise(options.topic("events/cliff"), self._cliff_type)
            events.append(self._cliff_out)
        self._drop_out = self.advertise(options.topic("events/wheel_drop"), self._drop_type)
        rates = [sensor.update_rate for sensor in (self._bumper, *self._cliffs) if sensor is not None]
        # the states change only when a sensor samples; a rate of 0 is every step
        rate = None if 0 in rates else max([_STATE_RATE, *rates])
        watch_while_subscribed(self, (*events, self._drop_out), "publish_events", rate)
        self._state_out = self.advertise(options.topic("sensors/core"), self._state_type)
        publish_while_subscribed(self, self._state_out, _STATE_RATE, "publish_state")
        self._open_dock(options)
        if self._imu is not None:
            self._imu_out = self.advertise(options.topic("sensors/imu_data"), IMU)
            publish_while_subscribed(self, self._imu_out, self._imu.update_rate, "publish_imu")

    def _open_dock(self, options: KobukiSensorOptions) -> None:
        """Open the topic of the infrared signals, if the file names a docking station; it may be spawned later."""
        self._dock_options = options
        name, models = options.dock_model, self.sim.models
        if not name:
            return
        if name not in models:
            message = f"there is no model {name!r} yet; the base gets no infrared signals until it exists"
            where = self.params.block("dock_model").where
            self.params.diagnostics.note("SK-PLUGIN-003", message, where, did_you_mean(name, models))
        self._dock_out = self.advertise(options.topic("sensors/dock_ir"), self._dock_type)
        publish_while_subscribed(self, self._dock_out, _STATE_RATE, "publish_dock_signals")

    # ------------------------------------------------------------------ events

    def begin(self) -> None:
        """Store the states of the sensors when the first subscriber of an event appears."""
        self._last_touch_ns = [self.sim.time_ns] * 2
        # at t = 0 a model may stand a hair above the ground
        self._dropped = [self.sim.tick > 0 and not touches for touches in self._wheel_touches()]
        self._pressed = self._pressed_zones()
        for index, cliff in enumerate(self._cliffs):
            distance = _first_range(cliff)
            self._over_cliff[index] = distance is not None and distance >= self._threshold

    def publish_events(self) -> None:
        """Publish the changes since the previous readings."""
        pressed = self._pressed_zones()
        for zone, (before, now) in enumerate(zip(self._pressed, pressed, strict=True)):
            if before != now:
                self._bumper_out.publish(msgs.make(self._bumper_type, bumper=zone, state=int(now)))
        self._pressed = pressed
        for index, cliff in enumerate(self._cliffs):
            distance = _first_range(cliff)
            if distance is not None and (distance >= self._threshold) != self._over_cliff[index]:
                self._over_cliff[index] = not self._over_cliff[index]
                state, value = int(self._over_cliff[index]), converter_value(distance)
                self._cliff_out.publish(msgs.make(self._cliff_type, sensor=index, state=state, bottom=value))
        self._publish_wheel_drops()

    def _publish_wheel_drops(self) -> None:
        now = self.sim.time_ns
        for wheel, touches in enumerate(self._wheel_touches()):
            if touches:
                self._last_touch_ns[wheel] = now
            has_dropped = now - self._last_touch_ns[wheel] >= _DROP_TIME_NS or (self._dropped[wheel] and not touches)
            if has_dropped != self._dropped[wheel]:
                self._dropped[wheel] = has_dropped
                self._drop_out.publish(msgs.make(self._drop_type, wheel=wheel, state=int(has_dropped)))

    def _pressed_zones(self) -> list[bool]:
        """Return whether the left, the middle and the right zone of the bumper have a contact.

        The zones cover 90° to 30°, 30° to -30° and -30° to -90° about the robot's z axis. A contact counts by the
        direction of its normal, and only at the height of the bumper.
        """
        pressed = [False] * 3
        message = None if self._bumper is None else self._bumper.latest
        if message is None or not message.contacts:
            return pressed
        pose = self._model.pose
        heading, height = float(pose.rpy[2]), float(pose.position[2])
        for contact in message.contacts:
            for point, normal in zip(contact.positions, contact.normals, strict=True):
                if not _BUMPER_HEIGHTS[0] <= point.z - height <= _BUMPER_HEIGHTS[1]:
                    continue
                # the normal points from the obstacle to the robot
                zone = bumper_zone(math.atan2(-normal.y, -normal.x) - heading)
                if zone is not None:
                    pressed[zone] = True
        return pressed

    def _wheel_touches(self) -> list[bool]:
        """Return whether the left and the right wheel touch anything."""
        sim = self.sim
        data = sim.engine.physics.fresh()
        masks = sim.engine.names.shared(f"kobuki wheels {id(self)}", self._wheel_masks)
        return [find_contacts(sim.mj_model, data, mask) is not None for mask in masks]

    def _wheel_masks(self) -> tuple[Bools, ...]:
        table = collision_table(self.sim.engine.compiled)
        return tuple(table.mask(names) for names in self._wheel_collisions)

    # ------------------------------------------------------------------ all states, and the IMU

    def publish_state(self) -> None:
        """Publish the present states of all sensors, as the driver of the real base does."""
        now, distances = self.sim.time_ns, [_first_range(cliff) for cliff in self._cliffs]
        left, right = (round(angle / _TICK) % _WORD for angle in self.read_encoders())
        cliffs = [distance is not None and distance >= self._threshold for distance in distances]
        in_dock = self._pose_in_dock()
        message = msgs.make(
            self._state_type,
            header=msgs.header(now, ""),
            time_stamp=now // 1_000_000 % _WORD,
            bumper=_bits(self._pressed_zones()),
            wheel_drop=_bits([not touches for touches in self._wheel_touches()]),
            cliff=_bits(cliffs),
            left_encoder=left,
            right_encoder=right,
            charger=CHARGING if in_dock is not None and is_docked(in_dock) else 0,
            battery=_NOMINAL_BATTERY,
            bottom=[0 if distance is None else converter_value(distance) for distance in reversed(distances)],
            current=[0, 0],
            analog_input=[0, 0, 0, 0],
        )
        self._state_out.publish(message)

    def publish_dock_signals(self) -> None:
        """Publish the signals that the three receivers get from the docking station."""
        robot = self._pose_in_dock()
        data = [0] * len(RECEIVERS) if robot is None else signals(robot, self._dock_options)
        header = msgs.header(self.sim.time_ns, "base_link")
        self._dock_out.publish(msgs.make(self._dock_type, header=header, data=data))

    def _pose_in_dock(self) -> Pose | None:
        """Return the pose of the robot in the frame of the docking station; None without a station."""
        name = self._dock_options.dock_model
        if not name or name not in self.sim.models:
            return None
        return self.sim.model(name).pose.inverse() @ self._model.pose

    def publish_imu(self) -> None:
        """Publish the newest reading of the IMU, with the covariances and the frame of the Kobuki's plugin."""
        reading = None if self._imu is None else self._imu.latest
        if reading is None:
            return
        spread = np.diag((_UNKNOWN, _UNKNOWN, _YAW_VARIANCE)).reshape(9)
        header = msgs.header(self.sim.time_ns, "base_link")
        rates, acceleration = reading.angular_velocity, reading.linear_acceleration
        fields = header, reading.orientation, spread, rates, spread, acceleration, np.zeros(9)
        self._imu_out.publish(msgs.type_of(IMU)(*fields))


def bumper_zone(angle: float) -> int | None:
    """Return the zone of the bumper for a direction about the robot's z axis [rad]; None behind the bumper.

    0 is left, 1 is the middle and 2 is right, as in `BumperEvent`.
    """
    angle = wrap_angle(angle)
    if abs(angle) > math.pi / 2:
        return None
    if abs(angle) <= _ZONE:
        return 1
    return 0 if angle > 0 else 2


def converter_value(distance: float) -> int:
    """Return the 16-bit value of a cliff sensor's converter for a distance to the floor [m]."""
    factor, scale = _CONVERTER
    return int(factor * math.atan2(scale, distance)) % _WORD


def _bits(states: Sequence[bool]) -> int:
    """Return states from left to right as one number; the lowest bit is the rightmost state."""
    return sum(1 << place for place, state in enumerate(reversed(states)) if state)


def _first_range(sensor: Sensor | None) -> float | None:
    """Return the first ray's range [m], at most the maximum range; None before the first reading."""
    scan = None if sensor is None else sensor.latest
    if scan is None or not len(scan.ranges):
        return None
    distance = float(scan.ranges[0])
    return float(scan.range_max) if math.isnan(distance) else max(0.0, min(distance, float(scan.range_max)))
