"""ArduPilot's plugin for Gazebo: `ArduPilotPlugin`, which speaks the JSON interface of ArduPilot's SITL over UDP.

Parameters, defaults and the order of receiving and sending follow `ArduPilotPlugin.cc` of ArduPilot/ardupilot_gazebo.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, cast

import numpy as np

from simkit import Params, Pose, msgs
from simkit.extend import (
    LARGEST,
    JointAxis,
    Options,
    OptionsOf,
    blocks,
    boolean,
    choice,
    integer,
    listens,
    number,
    pose,
    publishes,
    text,
    without_effect,
)
from simkit.msgs import valid_topic
from simkit.plugins.find_entities import find_axis_joint, find_sensor
from simkit.plugins.joints.joint_commands import DOUBLE
from simkit.plugins.joints.kinematic_trees import KinematicTrees
from simkit.plugins.joints.pid import Pid
from simkit.plugins.joints.velocity_servo import VelocityServo
from simkit_water_and_air.plugins.autopilots.autopilot_plugin import AutopilotPlugin
from simkit_water_and_air.plugins.autopilots.bounded_wait import ConnectionOptions, listen_address
from simkit_water_and_air.plugins.autopilots.joint_channel import ChannelKind, JointChannel
from simkit_water_and_air.plugins.autopilots.servo_link import ServoLink
from simkit_water_and_air.plugins.autopilots.servo_packet import ServoPacket, encode_state

if TYPE_CHECKING:
    from collections.abc import Callable

    from simkit import Model, Publisher
    from simkit.extend import SceneModel, SpecBuilder

_SCAN: Final = "sensor_msgs/msg/LaserScan"
_HALF_TURN: Final = Pose.from_rpy(0, 0, 0, math.pi, 0, 0)
_TYPES: Final = ("VELOCITY", "POSITION", "EFFORT", "COMMAND")
_DIRECTIONS: Final = {"ccw": 1.0, "cw": -1.0}
_MOST_RANGES: Final = 6
_UNKNOWN_RANGE: Final = -1.0  # as in the source, before the first scan


class ControlOptions(Options):
    """One output channel of ArduPilot."""

    channel: str = text("", element="@channel")
    id: str = text("", element="@id")
    type: str = choice(_TYPES, "VELOCITY")
    joint: str = text(None, element="jointName", required=True)
    use_force: bool = boolean(True, element="useForce")
    servo_min: float = number(1000.0, "µs")
    servo_max: float = number(2000.0, "µs")
    multiplier: float = number(1.0)
    turning_direction: str = text(element="turningDirection")
    offset: float = number(0.0)
    topic: str = text(element="cmd_topic")
    slowdown: float = number(1.0, element="rotorVelocitySlowdownSim")
    control_slowdown: bool = without_effect(element="controlVelocitySlowdownSim")
    cutoff: bool = without_effect(element="frequencyCutoff")
    sampling: bool = without_effect(element="samplingRate")
    vel_p_gain: float = number(0.1)
    vel_i_gain: float = number(0.0)
    vel_d_gain: float = number(0.0)
    vel_i_max: float = number(0.0)
    vel_i_min: float = number(0.0)
    vel_cmd_max: float = number(1.0)
    vel_cmd_min: float = number(-1.0)
    p_gain: float = number(instead="vel_p_gain")
    i_gain: float = number(instead="vel_i_gain")
    d_gain: float = number(instead="vel_d_gain")
    i_max: float = number(instead="vel_i_max")
    i_min: float = number(instead="vel_i_min")
    cmd_max: float = number(instead="vel_cmd_max")
    cmd_min: float = number(instead="vel_cmd_min")


class RangeOptions(Options):
    """One range finder, `rng_1` to `rng_6`."""

    type: bool = without_effect()
    index: int = integer(None, minimum=1, maximum=_MOST_RANGES, required=True)
    topic: str = text(None, required=True)


class ArduPilotOptions(ConnectionOptions):
    """Options of `ArduPilotPlugin`."""

    address: str = text("127.0.0.1", element="fdm_addr")
    port: int = integer(9002, element="fdm_port_in", minimum=0, maximum=65535)
    port_out: bool = without_effect(element="fdm_port_out")
    listen_addr: bool = without_effect()
    most_misses: int = integer(10, element="connectionTimeoutMaxCount", minimum=0)
    lock_step: bool = boolean()
    have_32_channels: bool = boolean()
    body_axes: Pose = pose(_HALF_TURN, element="modelXYZToAirplaneXForwardZDown")
    world_axes: Pose = pose(_HALF_TURN, element="gazeboXYZToNED")
    imu: str = text("imu_sensor", element="imuName")
    anemometer: str = text()
    controls: tuple[ControlOptions, ...] = blocks(ControlOptions, element="control")
    rotors: tuple[ControlOptions, ...] = blocks(ControlOptions, element="rotor")
    ranges: tuple[RangeOptions, ...] = blocks(RangeOptions, element="sensor")


class ArduPilotPlugin(AutopilotPlugin):
    """Connects a vehicle to ArduPilot (`sim_vehicle.py --model JSON`): servo outputs move joints, sensors go back.

    simkit listens for UDP packets at 127.0.0.1 and `<fdm_port_in>` from the first step on. Each packet sets the targets
    of the `<control>` channels; after each step, ArduPilot receives the reading of the IMU `<imuName>`, and the true
    position, attitude and velocity of its link, north-east-down. With `<lock_step>`, every step waits for the answer to
    the last state, at most `<simkit:peer_timeout>` [s] of wall time. Without an autopilot the run continues, and no
    channel moves its joint; `<simkit:connection_wait>` [s] lets the first step wait for ArduPilot.
    """

    endpoints = (
        publishes("/world/{world}/model/{model}/joint/{joint}/cmd", DOUBLE, named_by=("cmd_topic",)),
        listens("{topic}", _SCAN, "sensor_msgs/msg/Range", named_by=("topic",)),
    )
    options = OptionsOf(ArduPilotOptions)
    _connection: ServoLink
    filenames = ("libArduPilotPlugin.so",)
    names = ("ArduPilotPlugin", "gz::sim::systems::ArduPilotPlugin")
    drives = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._place = listen_address(options.address, params, "fdm_addr"), options.port
        imu = find_sensor(scene, options.imu, params.child_or_self("imuName"))
        if imu is not None and imu.kind != "imu":
            params.child_or_self("imuName").error("SK-PLUGIN-003", f"sensor {imu.name!r} is {imu.kind}, not an imu")
        self._imu_name, self._imu_link = ("", "") if imu is None else (imu.scoped, imu.parent)
        self._anemometer: tuple[str, Pose] | None = None
        if options.anemometer:
            sensor = find_sensor(scene, options.anemometer, params.child_or_self("anemometer"))
            self._anemometer = None if sensor is None else (sensor.parent, sensor.pose_link)
        self._joint_names: list[str] = []
        self._channels: list[int] = []
        most = 32 if options.have_32_channels else 16
        for place, control in enumerate(options.controls or options.rotors):
            control.read_all()
            joint = find_axis_joint(scene, control.joint, control.params) if control.joint else None
            self._joint_names.append("" if joint is None else joint.scoped)
            self._channels.append(_channel(control, place, most))
            if control.servo_min == control.servo_max:
                control.params.error("SK-PARAM-002", "<servo_min> equals <servo_max>; expected two different widths")
            if control.type == "POSITION" and not control.use_force:
                message = "<type>POSITION</type> without <useForce> moves nothing, as in Gazebo"
                control.params.warning("SK-PILOT-005", message, "remove <useForce>")
        for sensor_options in options.ranges:
            sensor_options.read_all()

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self._imu, self._link = self.sim.sensor(self._imu_name), self.sim.link(self._imu_link)
        self._wind_link = None if self._anemometer is None else self.sim.link(self._anemometer[0])
        self._to_ned, self._to_model = options.world_axes.inverse(), options.body_axes
        self._controls = options.controls or options.rotors
        self._factors = [_factor(control) for control in self._controls]
        self._targets = [0.0] * len(self._controls)
        self._joints = [
            JointChannel(JointAxis(self.sim.joint(name)), _pid(c), cast("ChannelKind", c.type.lower()))
            for name, c in zip(self._joint_names, self._controls, strict=True)
        ]
        self._publishers: dict[int, Publisher] = {}
        for place, control in enumerate(self._controls):
            if control.type == "COMMAND":
                default_topic = f"/world/{self.sim.world.name}/model/{parent.name}/joint/{control.joint}/cmd"
                self._publishers[place] = self.advertise(valid_topic(control.topic or default_topic), DOUBLE)
        self._servo = VelocityServo()
        self._ranges = [_UNKNOWN_RANGE] * max((sensor.index for sensor in options.ranges), default=0)
        for sensor in options.ranges:
            self.subscribe(valid_topic(sensor.topic), self._range_callback(sensor.index - 1))
        lock, timeout = options.lock_step, options.peer_timeout
        channels = 32 if options.have_32_channels else 16
        self._connection = ServoLink(self.name, self._place, lock, timeout, self._once, channels, options.most_misses)

    def _range_callback(self, place: int) -> Callable[[msgs.Message], None]:
        def keep(message: msgs.Message) -> None:
            measured = getattr(message, "ranges", getattr(message, "range", None))
            if measured is None:
                self._once.left_out(f"range {place}", f"a message for rng_{place + 1} is not a LaserScan or Range")
                return
            ranges = np.atleast_1d(np.asarray(measured, float))
            largest = message.range_max if hasattr(message, "range_max") else message.max_range
            far = 2.0 * min(float(largest), LARGEST)  # without an echo, as in the source
            finite = ranges[np.isfinite(ranges)]
            self._ranges[place] = min(float(finite.min()), far) if len(finite) else far

        return keep

    # ------------------------------------------------------------------ steps

    def before_step(self) -> None:
        """Receive a packet, and move the joints."""
        connection = self._connection
        packet = None
        if self.open_once("UDP") and self.options.connection_wait:
            packet = connection.wait_for_peer(self.options.connection_wait)
            self.report_absence(self.options.connection_wait)
        if not connection.is_open:
            return
        if connection.is_time_broken:
            connection.resume(self._state())
        packet = packet or connection.next_packet()
        if packet is not None:
            self._apply(packet)
        if not connection.is_connected:
            self._targets = [0.0] * len(self._targets)
            return
        self._move_joints()

    def _apply(self, packet: ServoPacket) -> None:
        for place, (control, channel) in enumerate(zip(self._controls, self._channels, strict=True)):
            if channel >= 0:
                width = packet.pulse_widths[channel]
                share = (width - control.servo_min) / (control.servo_max - control.servo_min)
                self._targets[place] = self._factors[place] * (max(0.0, min(1.0, share)) + control.offset)

    def _move_joints(self) -> None:
        turned: list[tuple[JointAxis, float]] = []
        for place, (control, joint) in enumerate(zip(self._controls, self._joints, strict=True)):
            target = self._targets[place]
            if control.type == "COMMAND":
                self._publishers[place].publish(msgs.make(DOUBLE, data=target))
            elif control.use_force or control.type == "EFFORT":
                slower = control.slowdown or 1.0
                joint.push(target / slower if control.type == "VELOCITY" else target, self.period)
                self.watch(joint.axis, joint.pid)
            elif control.type == "VELOCITY":
                turned.append((joint.axis, target))
        if turned:
            axes, velocities = zip(*turned, strict=True)
            layouts: dict[tuple[int, ...], KinematicTrees] = self.sim.engine.names.shared(f"ardupilot {id(self)}", dict)
            self._servo.drive(self.sim, axes, velocities, layouts)

    def controllers(self) -> list[tuple[JointAxis, Pid]]:
        driven = zip(self._joints, self._controls, strict=True)
        return [(joint.axis, joint.pid) for joint, control in driven if control.type in ("VELOCITY", "POSITION")]

    def after_step(self) -> None:
        """Send the state of the vehicle."""
        if self._connection.is_connected:
            state = self._state()
            if state:
                self._connection.send(state)

    def _state(self) -> bytes:
        """Return the state of the vehicle for ArduPilot; empty without a connection or before the first reading."""
        if not self._connection.is_connected or (reading := self._imu.latest) is None:
            return b""
        rate, force = reading.angular_velocity, reading.linear_acceleration
        body = self._to_ned @ self._link.pose @ self._to_model
        velocity = self._to_ned.rotate(self._link.linear_velocity)
        more: dict[str, object] = {f"rng_{i + 1}": value for i, value in enumerate(self._ranges)}
        if self._wind_link is not None:
            more["windvane"] = self._apparent_wind(body)
        return encode_state(
            self.sim.time_ns * 1e-9,
            (rate.x, rate.y, rate.z),
            (force.x, force.y, force.z),
            body.position.tolist(),
            body.quaternion.tolist(),
            velocity.tolist(),
            more,
        )

    def _apparent_wind(self, body: Pose) -> dict[str, float]:
        """Return speed [m/s] and direction [rad] of the wind at the anemometer, clockwise from the bow."""
        assert self._wind_link is not None and self._anemometer is not None
        link = self._wind_link
        arm = link.pose.rotate(self._anemometer[1].position)
        moving = link.linear_velocity + np.cross(link.angular_velocity, arm)
        wind = np.array(self.sim.engine.wind.at(self.sim.tick)) - moving
        x, y, _ = (-body.inverse().rotate(self._to_ned.rotate(wind))).tolist()
        return {"direction": math.atan2(y, x), "speed": math.hypot(x, y)}


def _channel(control: ControlOptions, place: int, most: int) -> int:
    """Return the number of a control's channel; -1 after an error or a warning."""
    written = control.channel or control.id
    try:
        channel = int(written) if written else place
    except ValueError:
        control.params.error("SK-PARAM-002", f"found channel={written!r}; expected a number from 0 to {most - 1}")
        return -1
    if not 0 <= channel < most:
        hint = "for channels 16 to 31, set <have_32_channels>" if most == 16 else ""
        control.params.warning("SK-PILOT-005", f"channel {channel} does not exist; there are {most}", hint)
        return -1
    return channel


def _factor(control: ControlOptions) -> float:
    """Return the factor of a control: `<multiplier>`, or else that of the old `<turningDirection>`, or 1."""
    written = control.turning_direction
    if control.params.has("multiplier") or not written:
        return control.multiplier
    return _DIRECTIONS[written] if written in _DIRECTIONS else control.params.number("turningDirection", 1.0)


def _pid(control: ControlOptions) -> Pid:
    gains = control.p_gain, control.i_gain, control.d_gain
    return Pid(*gains, control.i_max, control.i_min, control.cmd_max, control.cmd_min)
