"""PX4's interface for Gazebo Classic: `libgazebo_mavlink_interface.so`, MAVLink's HIL messages over TCP.

Parameters, defaults, frames and units follow `gazebo_mavlink_interface.cpp` of PX4/PX4-SITL_gazebo-classic, with one
difference: the sensors are sent after a step, not before the next one. Commands then belong to the state of their step.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, cast

import numpy as np

from simkit import Params, msgs
from simkit.extend import (
    JointAxis,
    Options,
    OptionsOf,
    block,
    blocks,
    boolean,
    choice,
    integer,
    number,
    publishes,
    text,
    without_effect,
)
from simkit.linear_algebra import matmul
from simkit.msgs import valid_topic
from simkit.plugins.joints.joint_commands import DOUBLE
from simkit.plugins.joints.pid import Pid
from simkit.sensors.environment.geodesy import WorldOnPlanet
from simkit_water_and_air.plugins.autopilots.autopilot_plugin import AutopilotPlugin
from simkit_water_and_air.plugins.autopilots.bounded_wait import ConnectionOptions, listen_address
from simkit_water_and_air.plugins.autopilots.hil_link import HilLink
from simkit_water_and_air.plugins.autopilots.hil_messages import gps_message, sensor_message, state_message
from simkit_water_and_air.plugins.autopilots.joint_channel import ChannelKind, JointChannel
from simkit_water_and_air.plugins.autopilots.mavlink import MavlinkMessage, encode
from simkit_water_and_air.plugins.classic.px4_sensors import (
    Px4Airspeed,
    Px4Barometer,
    Px4Gps,
    Px4Imu,
    Px4Magnetometer,
    find_sensor_plugin,
    home_of,
)
from simkit_water_and_air.plugins.gz.multicopter_motor_model import MulticopterMotorModel

if TYPE_CHECKING:
    from collections.abc import Mapping

    from simkit import Model, Publisher
    from simkit.extend import SceneModel, SpecBuilder, Vector
    from simkit_water_and_air.plugins.autopilots.mavlink import Value
    from simkit_water_and_air.plugins.classic.px4_sensors import AnySensor

_CHANNELS: Final = 16
_ARMED: Final = 128  # flag MAV_MODE_FLAG_SAFETY_ARMED
_STALE: Final = 0.2  # [s] after which motors stop without new commands, as in the source
_HEARTBEAT_PERIOD_NS: Final = 1_000_000_000
_KINDS: Final = ("velocity", "position", "position_kinematic", "position_gztopic")


class JointPidOptions(Options):
    """PID of a channel; all numbers are zero by default, as in Gazebo."""

    p: float = number(0.0)
    i: float = number(0.0)
    d: float = number(0.0)
    i_max: float = number(0.0, element="iMax")
    i_min: float = number(0.0, element="iMin")
    command_max: float = number(0.0, element="cmdMax")
    command_min: float = number(0.0, element="cmdMin")


class ChannelOptions(Options):
    """One channel of the actuator controls."""

    name: str = text("", element="@name")
    index: int = integer(None, element="input_index", minimum=0, maximum=_CHANNELS - 1, required=True)
    offset: float = number(0.0, element="input_offset")
    scaling: float = number(0.0, element="input_scaling")
    disarmed: float = number(0.0, element="zero_position_disarmed")
    armed: float = number(0.0, element="zero_position_armed")
    kind: str = choice(_KINDS, "velocity", element="joint_control_type")
    joint: str = text(element="joint_name")
    topic: str = text(element="gztopic")
    pid: JointPidOptions = block(JointPidOptions, element="joint_control_pid")


class ControlChannelsOptions(Options):
    """All channels."""

    channels: tuple[ChannelOptions, ...] = blocks(ChannelOptions, element="channel")


class MavlinkInterfaceOptions(ConnectionOptions):
    """Options of `GazeboMavlinkInterface`."""

    address: str = text("INADDR_ANY", element="mavlink_addr")
    port: int = integer(4560, element="mavlink_tcp_port", minimum=0, maximum=65535)
    lock_step: bool = boolean(element="enable_lockstep")
    use_tcp: bool = boolean()
    serial: bool = boolean(element="serialEnabled")
    hil_mode: bool = boolean()
    tailsitter: bool = without_effect(element="vehicle_is_tailsitter")
    control_channels: ControlChannelsOptions = block(ControlChannelsOptions)


_UNUSED: Final = (
    *("robotNamespace", "imuSubTopic", "magSubTopic", "baroSubTopic", "gpsSubTopic", "visionSubTopic"),
    *("lidarSubTopic", "opticalFlowSubTopic", "sonarSubTopic", "irlockSubTopic", "motorSpeedCommandPubTopic"),
    *("mavlink_udp_port", "serialDevice", "baudRate", "qgc_addr", "qgc_udp_port", "sdk_addr", "sdk_udp_port"),
    *("hil_state_level", "send_vision_estimation", "send_odometry", "protocol_version", "imu_rate"),
)


class GazeboMavlinkInterface(AutopilotPlugin):
    """Connects a vehicle to PX4 (`make px4_sitl none_iris`): actuator controls move it, sensors go back.

    simkit is a TCP server at 127.0.0.1 and `<mavlink_tcp_port>` from the first step on. After each step PX4 receives
    HIL_SENSOR, HIL_STATE_QUATERNION and, at the rate of the GPS, HIL_GPS. HIL_ACTUATOR_CONTROLS set the speeds of the
    model's `libgazebo_motor_model.so` and the targets of the joints in `<control_channels>`. With `<enable_lockstep>`,
    from PX4's first command on, every step waits for the answer to the last state, at most `<simkit:peer_timeout>` [s]
    of wall time. Without an autopilot the run continues; `<simkit:connection_wait>` [s] lets the first step wait.
    """

    endpoints = (publishes("/{model}/{gztopic}", DOUBLE, named_by=("gztopic",)),)
    options = OptionsOf(MavlinkInterfaceOptions)
    _connection: HilLink
    filenames = ("libgazebo_mavlink_interface.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        for element in _UNUSED:
            params.child(element)
        self._place = listen_address(options.address, params, "mavlink_addr"), options.port
        if options.serial or options.hil_mode or (params.has("use_tcp") and not options.use_tcp):
            choice = "a serial port" if options.serial else "UDP" if not options.hil_mode else "<hil_mode>"
            message = f"{choice} is not supported; simkit waits for a TCP connection of PX4"
            params.warning("SK-PILOT-005", message, "set <use_tcp> to 1, <serialEnabled> and <hil_mode> to 0")
        self._base = scene.canonical_link
        joints = {joint.scoped: joint for joint in scene.all_joints()}
        self._joint_names: list[str] = []
        for channel in options.control_channels.channels:
            channel.read_all()
            channel.pid.read_all()
            found_name = next((name for name in joints if f"::{name}".endswith(f"::{channel.joint}")), "")
            self._joint_names.append(found_name if channel.joint else "")
            if channel.joint and not found_name:
                message = f"channel {channel.index} moves no joint: the model has no joint {channel.joint!r}"
                channel.params.note("SK-PILOT-006", message)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self._channels = options.control_channels.channels
        self._targets = [0.0] * _CHANNELS
        self._commanded_at = -math.inf
        self._joints: dict[int, JointChannel] = {}
        self._publishers: dict[int, Publisher] = {}
        for place, (name, channel) in enumerate(zip(self._joint_names, self._channels, strict=True)):
            if channel.kind == "position_gztopic":
                topic = channel.topic or f"control_position_gztopic_{channel.index}"
                self._publishers[place] = self.advertise(valid_topic(f"/{parent.name}/{topic}"), DOUBLE)
            elif name:
                kind = cast("ChannelKind", channel.kind.removesuffix("_kinematic"))
                self._joints[place] = JointChannel(JointAxis(self.sim.joint(name)), _pid(channel.pid), kind)
        self._link, self._planet = self.sim.link(self._base), WorldOnPlanet(home_of(self.sim))
        self._sent_gps = self._sent_baro = self._sent_mag = self._sent_air = 0
        self._heartbeat_ns, self._sequence, self._connections = -_HEARTBEAT_PERIOD_NS, 0, 0
        timeout, lock = options.peer_timeout, options.lock_step
        self._connection = HilLink(self.name, self._place, lock, timeout, self._once, self.period)

    # ------------------------------------------------------------------ steps

    def before_step(self) -> None:
        """Receive actuator controls, and move motors and joints."""
        connection = self._connection
        wait = self.options.connection_wait
        if self.open_once("TCP") and wait:
            connection.wait_for_peer(wait)
            self.report_absence(wait)
        if not connection.is_open:
            return
        if connection.is_time_broken:
            connection.resume(self._state())
        controls = connection.next_controls()
        if controls is not None:
            self._apply(controls)
        elif not connection.is_connected:
            self._targets, self._commanded_at = [0.0] * _CHANNELS, -math.inf
            self._turn_motors()
            return
        if self._commanded_at >= 0:
            self._turn_motors()
            self._move_joints()

    def _apply(self, message: MavlinkMessage) -> None:
        controls = cast("tuple[float, ...]", message.fields["controls"])
        is_armed = int(cast("float", message.fields["mode"])) & _ARMED
        self._commanded_at = self.sim.time
        for channel in self._channels:
            control = controls[channel.index]
            if not math.isfinite(control):
                self._once.not_finite(f"channel {channel.index} of HIL_ACTUATOR_CONTROLS")
                continue
            moved = (control + channel.offset) * channel.scaling + channel.armed
            self._targets[channel.index] = moved if is_armed else channel.disarmed

    def _turn_motors(self) -> None:
        is_stale = self.sim.time - self._commanded_at > _STALE
        for motor in self.sim.engine.names.shared(f"motors {id(self)}", self._find_motors):
            if motor.motor_number < _CHANNELS:
                motor.command(0.0 if is_stale else self._targets[motor.motor_number])

    def _find_motors(self) -> list[MulticopterMotorModel]:
        plugins = self.sim.engine.structure.all_plugins()
        return [p for p in plugins if isinstance(p, MulticopterMotorModel) and p.scoped == self.scoped]

    def _move_joints(self) -> None:
        for place, channel in enumerate(self._channels):
            target = self._targets[channel.index]
            if place in self._publishers:
                self._publishers[place].publish(msgs.make(DOUBLE, data=target))
            elif place in self._joints and channel.kind == "position_kinematic":
                self._joints[place].axis.joint.set_position(target)
            elif place in self._joints:
                joint = self._joints[place]
                joint.push(target, self.period)
                self.watch(joint.axis, joint.pid)

    def controllers(self) -> list[tuple[JointAxis, Pid]]:
        return [(joint.axis, joint.pid) for joint in self._joints.values()]

    def after_step(self) -> None:
        """Send the state of the vehicle."""
        state = self._state()
        if state:
            self._connection.send(state)

    # ------------------------------------------------------------------ messages

    def _sensor(self, kind: type[AnySensor]) -> AnySensor | None:
        sensor: AnySensor | None = self.sim.engine.names.shared(
            f"{kind.__name__} {id(self)}", lambda: find_sensor_plugin(self.sim, kind, self.scoped)
        )
        return sensor

    def _state(self) -> bytes:
        """Return the frames for PX4; empty without a connection or before the first reading of the IMU."""
        connection = self._connection
        if not connection.is_connected:
            return b""
        if connection.connections != self._connections:  # a new PX4 gets every sensor
            self._connections = connection.connections
            self._sent_gps = self._sent_baro = self._sent_mag = self._sent_air = -1
            self._heartbeat_ns = -_HEARTBEAT_PERIOD_NS
        imu = self._sensor(Px4Imu)
        motion = self._true_motion() if imu is None else imu.update()
        if motion is None:
            return b""
        time = connection.clock(self.sim.time_ns // 1000, round(self.period * 1e6))
        frames = b""
        if self.sim.time_ns - self._heartbeat_ns >= _HEARTBEAT_PERIOD_NS or self.sim.time_ns < self._heartbeat_ns:
            self._heartbeat_ns = self.sim.time_ns
            frames += self._encode("HEARTBEAT", {"autopilot": 8, "mavlink_version": 3})
        frames += self._encode("HIL_SENSOR", self._sensors(time, *motion))
        gps = self._sensor(Px4Gps)
        if gps is not None and gps.update() is not None and gps.number != self._sent_gps:
            self._sent_gps = gps.number
            measured_tick, latitude, longitude, altitude, velocity = gps.reading
            late = round((self.sim.tick - measured_tick) * self.period * 1e6)
            place = latitude, longitude, altitude
            frames += self._encode("HIL_GPS", gps_message(max(time - late, 0), place, velocity))
        truth = state_message(time, self._link, self._planet.geodetic(self._link.pose.position))
        return frames + self._encode("HIL_STATE_QUATERNION", truth)

    def _true_motion(self) -> tuple[Vector, Vector]:
        """Return the true rate and force of a model without `libgazebo_imu_plugin.so`."""
        message = "the model has no libgazebo_imu_plugin.so; PX4 receives true rates and accelerations"
        self._once.warn("SK-PILOT-005", "imu", message)
        axes = self._link.pose.matrix
        force = self._link.linear_acceleration - self.sim.mj_model.opt.gravity
        return matmul(self._link.angular_velocity, axes), matmul(force, axes)

    def _sensors(self, time: int, gyro: np.ndarray, force: np.ndarray) -> dict[str, float]:
        magnetometer, barometer = self._sensor(Px4Magnetometer), self._sensor(Px4Barometer)
        airspeed = self._sensor(Px4Airspeed)
        field = pressure = air = None
        if magnetometer is not None and magnetometer.update() is not None and magnetometer.number != self._sent_mag:
            self._sent_mag, field = magnetometer.number, magnetometer.reading
        if barometer is not None and barometer.update() is not None and barometer.number != self._sent_baro:
            self._sent_baro, pressure = barometer.number, barometer.reading
        if airspeed is not None and airspeed.update() is not None and airspeed.number != self._sent_air:
            self._sent_air, air = airspeed.number, airspeed.reading
        return sensor_message(time, gyro, force, field, pressure, air)

    def _encode(self, name: str, fields: Mapping[str, Value]) -> bytes:
        self._sequence = (self._sequence + 1) & 0xFF
        return encode(name, fields, self._sequence)


def _pid(options: JointPidOptions) -> Pid:
    gains = options.p, options.i, options.d
    return Pid(*gains, options.i_max, options.i_min, options.command_max, options.command_min)
