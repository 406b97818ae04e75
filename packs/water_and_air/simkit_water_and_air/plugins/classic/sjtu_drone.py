"""Drone of sjtu_drone for Gazebo Classic, in ROS 2 and ROS 1: `libplugin_drone.so`.

Parameters, defaults, topics and control laws are those of `plugin_drone_private.cpp` and `pid_controller.cpp` of
sjtu_drone (ROS 2), and of `plugin_drone.cpp` (ROS 1).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from simkit import ModelPlugin, Params, msgs
from simkit.extend import (
    Options,
    OptionsOf,
    boolean,
    find_named_link,
    listens,
    number,
    publish_while_subscribed,
    publishes,
    text,
    without_effect,
)
from simkit.float_sum import float_sum
from simkit.plugins.drives.odometry_messages import ODOMETRY, TRANSFORMS, BodyTwist, odometry_message, transforms
from simkit.plugins.one_time_warnings import are_usable
from simkit.pose import quat_conjugate, quat_rotate, rpy_from_quat
from simkit_water_and_air.message_fields import xyz
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit_water_and_air.plugins.fluids.rigid_links import rigid_group
from simkit_water_and_air.plugins.fluids.tuple_vectors import Triple, to_link_axes, to_world_axes

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder, Vector
    from simkit.msgs import Message

LANDED, FLYING, TAKING_OFF, LANDING = 0, 1, 2, 3
"""Numbers on the topic `state`."""
_TWIST, _POSE, _BOOL = "geometry_msgs/msg/Twist", "geometry_msgs/msg/Pose", "std_msgs/msg/Bool"
_EMPTY, _INT8, _STRING = "std_msgs/msg/Empty", "std_msgs/msg/Int8", "std_msgs/msg/String"
_FACTORS: Final = {LANDED: 0.0, FLYING: 1.0, TAKING_OFF: 1.5, LANDING: 0.8}
_NEXT_STATES: Final = {TAKING_OFF: (0.5, FLYING), LANDING: (1.0, LANDED)}  # duration [s] and the state after it
_LEVEL: Final = 1e-6  # smallest cosine of the tilt at which the thrust can carry the weight


class GainOptions(Options):
    """Gains of one controller; their elements have a prefix such as `rollpitch`."""

    proportional: float
    derivative: float
    integral: float
    time_constant: float
    limit: float


def _gain_options(prefix: str) -> type[GainOptions]:
    """Return the class of the options of the controllers with this prefix."""
    fields: dict[str, Any] = {
        "__doc__": f"Gains with the prefix `{prefix}`.",
        "proportional": number(5.0, element=f"{prefix}ProportionalGain"),
        "derivative": number(1.0, element=f"{prefix}DifferentialGain"),
        "integral": number(0.0, element=f"{prefix}IntegralGain"),
        "time_constant": number(0.0, "s", element=f"{prefix}TimeConstant", minimum=0),
        "limit": number(-1.0, element=f"{prefix}Limit"),
    }
    return type("GainOptions", (GainOptions,), fields)


_GAINS: Final = {
    prefix: _gain_options(prefix)
    for prefix in ("rollpitch", "yaw", "velocityXY", "velocityZ", "positionXY", "positionZ")
}
_CONTROLLERS: Final = {
    "roll": "rollpitch",
    "pitch": "rollpitch",
    "yaw": "yaw",
    "velocity_x": "velocityXY",
    "velocity_y": "velocityXY",
    "velocity_z": "velocityZ",
    "position_x": "positionXY",
    "position_y": "positionXY",
    "position_z": "positionZ",
}


class SjtuDroneOptions(Options):
    """Options of `SjtuDrone`; a limit or a force of -1 is unlimited."""

    ros_1_marks = ("imuTopic",)

    body: str = text(None, element="bodyName")
    publishes_odometry: bool = boolean(element="pub_odom")
    odometry_rate: float = number(30.0, "Hz", element="odom_hz", minimum=1e-3)
    max_force: float = number(-1.0, "N", element="maxForce")
    small_noise: float = number(0.0, element="motionSmallNoise", minimum=0, maximum=1e9)
    drift_noise: float = number(0.0, element="motionDriftNoise", minimum=0, maximum=1e9)
    drift_time: float = number(1.0, "s", element="motionDriftNoiseTime", minimum=0)
    imu_topic: bool = without_effect(element="imuTopic")


@dataclass
class _Controller:
    """PID controller whose goal is limited and filtered.

    Attributes:
        gains: Gains of the file.
        goal: Filtered goal.
        error_integral: Integral of the error over time.
    """

    gains: GainOptions
    goal: float = 0.0
    error_integral: float = 0.0

    def update(self, goal: float, value: float, rate: float, period: float) -> float:
        """Return the output for a new goal.

        Args:
            goal: Goal before its limit.
            value: Present value.
            rate: Rate of change of the value for each second.
            period: Time since the last update [s].
        """
        gains = self.gains
        if gains.limit > 0:
            goal = max(-gains.limit, min(gains.limit, goal))
        self.goal = (period * goal + gains.time_constant * self.goal) / (period + gains.time_constant)
        goal_rate = (goal - self.goal) / (period + gains.time_constant)
        error = self.goal - value
        self.error_integral += period * error
        return gains.proportional * error + gains.derivative * (goal_rate - rate) + gains.integral * self.error_integral

    def reset(self) -> None:
        """Forget the goal and the integral."""
        self.goal = self.error_integral = 0.0


@dataclass
class _Motion:
    """Motion of the link.

    Attributes:
        position: Origin of the link in the world [m].
        angles: Roll, pitch and yaw [rad].
        velocity: Velocity of the origin in the world [m/s].
        acceleration: Change of the velocity in the last step [m/s²].
        spin: Turning rate in the world [rad/s].
        axes: Rotation matrix of the link, row-major.
    """

    position: Triple
    angles: Triple
    velocity: Triple
    acceleration: Triple
    spin: Triple
    axes: list[float]


class SjtuDrone(ModelPlugin):
    """Flies a drone by one force along the z axis of `<bodyName>` and a torque, without rotors.

    `takeoff`, `land` and `reset` (Empty) begin the flight, end it and reset the controllers. `cmd_vel` has the velocity
    along the heading and the turning rate about the vertical; with `true` on `posctrl` its linear part is a position in
    the world. During takeoff and landing `cmd_vel.angular` has the tilt, or, with `true` on `dronevel_mode`, the
    velocity. `state` is 0 landed, 1 flying, 2 taking off, 3 landing. In ROS 1, which a file with `<imuTopic>` is for,
    the topics are `drone/takeoff` and so on, with `/cmd_vel` and `drone/vel_mode`.
    """

    endpoints = (
        listens("cmd_vel", _TWIST),
        *(listens(name, _EMPTY) for name in ("takeoff", "land", "reset")),
        *(listens(name, _BOOL) for name in ("posctrl", "dronevel_mode")),
        publishes("state", _INT8),
        publishes("cmd_mode", _STRING),
        publishes("gt_pose", _POSE),
        *(publishes(name, _TWIST) for name in ("gt_vel", "gt_acc")),
        publishes("odom", ODOMETRY, named_by=("pub_odom",)),
        publishes("/tf", TRANSFORMS, named_by=("pub_odom",)),
    )
    options = OptionsOf(SjtuDroneOptions)
    option_types = tuple(_GAINS.values())
    filenames = ("libplugin_drone.so",)
    reads_at_load = ("inertial",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        gains = {prefix: kind(params).read_all() for prefix, kind in _GAINS.items()}
        self._controllers = {name: _Controller(gains[prefix]) for name, prefix in _CONTROLLERS.items()}
        self._link = find_named_link(scene, "bodyName", params) if options.body else scene.canonical_link
        links = {link.scoped: link.inertial for link in scene.all_links()}
        if self._link in links:
            self._mass = float_sum(links[name].mass for name in rigid_group(scene, self._link))
            self._inertia = tuple(map(float, links[self._link].inertia[:3]))

    def load(self, parent: Model, params: Params) -> None:
        self._links = PushedLinks(self.sim, (self._link,))
        self._state, self._time_in_state = LANDED, 0.0
        self._is_position, self._is_velocity = False, False
        self._linear: Triple = (0.0, 0.0, 0.0)
        self._angular: Triple = (0.0, 0.0, 0.0)
        self._velocity: Triple | None = None
        self._position: Triple | None = None
        self._acceleration: Triple = (0.0, 0.0, 0.0)
        self._commands, self._drifts, self._drift_age, self._command_ns = 0, -1, 0.0, self.sim.time_ns
        self._small, self._drift = self.random("motionSmallNoise", 4), self.random("motionDriftNoise", 4)
        is_ros_1 = self.options.is_ros_1
        start = "drone/" if is_ros_1 else ""
        self.listen("/cmd_vel" if is_ros_1 else "cmd_vel", _TWIST, self._on_command)
        self.listen(f"{start}takeoff", _EMPTY, partial(self._begin, TAKING_OFF, (LANDED,)))
        self.listen(f"{start}land", _EMPTY, partial(self._begin, LANDING, (FLYING, TAKING_OFF)))
        self.listen(f"{start}reset", _EMPTY, self._on_reset)
        self.listen(f"{start}posctrl", _BOOL, self._on_position_control)
        self.listen(f"{start}vel_mode" if is_ros_1 else "dronevel_mode", _BOOL, self._on_mode)
        self._mode = self.advertise(f"{start}cmd_mode", _STRING)
        self._states = self.advertise(f"{start}state", _INT8)
        self._poses = self.advertise(f"{start}gt_pose", _POSE)
        self._velocities = self.advertise(f"{start}gt_vel", _TWIST)
        self._accelerations = self.advertise(f"{start}gt_acc", _TWIST)
        publish_while_subscribed(self, self._states, 0, "publish_state")
        publish_while_subscribed(self, self._poses, 0, "publish_pose")
        publish_while_subscribed(self, self._velocities, 0, "publish_velocity")
        publish_while_subscribed(self, self._accelerations, 0, "publish_acceleration")
        if self.options.publishes_odometry:
            self._odometry, self._tf = self.advertise("odom", ODOMETRY), self.advertise("/tf", TRANSFORMS)
            publish_while_subscribed(self, self._odometry, self.options.odometry_rate, "publish_odometry")
            publish_while_subscribed(self, self._tf, self.options.odometry_rate, "publish_transform")

    # ------------------------------------------------------------------ commands

    def _on_command(self, message: Message) -> None:
        linear, angular = message.linear, message.angular
        values = [float(getattr(part, axis)) for part in (linear, angular) for axis in "xyz"]
        if not are_usable(*values):
            self._once.not_finite()
            return
        x, y, z, roll, pitch, yaw = values
        a, b, c, d = self._noise()
        self._linear, self._angular = (x, y, z + c), (roll + a, pitch + b, yaw + d)

    def _noise(self) -> Triple | tuple[float, ...]:
        """Return the noise of the next command: on roll, pitch, the upward velocity and the turning rate."""
        options, now = self.options, self.sim.time_ns
        if self._drift_age > options.drift_time:
            self._drifts, self._drift_age = self._drifts + 1, 0.0
        self._drift_age += (now - self._command_ns) * 1e-9
        self._command_ns, index = now, self._commands
        self._commands += 1
        small = [options.small_noise * value for value in self._small.uniform(index).tolist()]
        if self._drifts < 0:
            return tuple(small)
        drift = self._drift.uniform(self._drifts).tolist()
        return tuple(value + options.drift_noise * slow for value, slow in zip(small, drift, strict=True))

    def _begin(self, state: int, allowed: tuple[int, ...], _: Message) -> None:
        if self._state in allowed:
            self._state, self._time_in_state = state, 0.0

    def _on_reset(self, _: Message) -> None:
        for controller in self._controllers.values():
            controller.reset()

    def _on_position_control(self, message: Message) -> None:
        self._is_position = bool(message.data)

    def _on_mode(self, message: Message) -> None:
        self._is_velocity = bool(message.data)
        self._mode.publish(msgs.make(_STRING, data="velocity" if self._is_velocity else "position"))

    # ------------------------------------------------------------------ control

    def before_step(self) -> None:
        """Apply the force and the torque for the next step."""
        if self._state in _NEXT_STATES:
            self._time_in_state += self.period
            duration, following = _NEXT_STATES[self._state]
            if self._time_in_state > duration:
                self._state = following
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, (self._link,))
        if not len(self._links):
            return
        motion = self._read_motion()
        thrust, torque = self._thrust_and_torque(motion)
        most, factor = self.options.max_force, _FACTORS[self._state]
        if most > 0:
            thrust = min(thrust, most)
        thrust = factor * max(thrust, 0.0)
        x, y, z = torque
        force = to_world_axes(motion.axes, (0.0, 0.0, thrust))
        turned = to_world_axes(motion.axes, (factor * x, factor * y, factor * z))
        self._links.push_some(moving_data(self.sim), {0: (*force, *turned)})

    def _read_motion(self) -> _Motion:
        data, body = moving_data(self.sim), self._links.ids[0]
        x, y, z = data.xpos[body].tolist()
        velocity = self._links.velocities_few(data, [[x, y, z]])[0]
        before, period = self._velocity or velocity, self.period
        self._acceleration = (
            (velocity[0] - before[0]) / period,
            (velocity[1] - before[1]) / period,
            (velocity[2] - before[2]) / period,
        )
        self._velocity = velocity
        p, q, r = data.cvel[body, :3].tolist()
        roll, pitch, yaw = rpy_from_quat(data.xquat[body]).tolist()
        angles = roll, pitch, yaw
        return _Motion((x, y, z), angles, velocity, self._acceleration, (p, q, r), data.xmat[body].tolist())

    def _thrust_and_torque(self, now: _Motion) -> tuple[float, Triple]:
        """Return the thrust [N] along z and the torque [N·m] in the axes of the link, without limits."""
        period, controllers = self.period, self._controllers
        moved = tuple(a - b for a, b in zip(now.position, self._position or now.position, strict=True))
        self._position = now.position
        if self._is_position and self._state != FLYING:
            return 0.0, (0.0, 0.0, 0.0)
        goal, tilt = self._linear, None
        turn = 0.0
        if self._is_position:
            names = ("position_x", "position_y", "position_z")
            x, y, z = (
                controllers[name].update(self._linear[i], now.position[i], moved[i], period)
                for i, name in enumerate(names)
            )
            ahead, aside = _along_heading(now.angles[2], x, y)
            goal = ahead, aside, z
        elif self._state != FLYING:
            goal = self._angular[0], self._angular[1], self._linear[2]
            tilt = None if self._is_velocity else self._angular
        if not self._is_position:
            turn = self._inertia[2] * controllers["yaw"].update(self._angular[2], now.spin[2], 0.0, period)
        gravity = abs(float(self.sim.mj_model.opt.gravity[2]))
        roll, pitch = self._tilt(goal, now, gravity) if tilt is None else tilt[:2]
        p, q, _ = to_link_axes(now.axes, now.spin)
        torque = (
            self._inertia[0] * controllers["roll"].update(roll, now.angles[0], p, period),
            self._inertia[1] * controllers["pitch"].update(pitch, now.angles[1], q, period),
            turn,
        )
        climb = controllers["velocity_z"].update(goal[2], now.velocity[2], now.acceleration[2], period)
        upright = now.axes[8]
        if upright < _LEVEL:  # the thrust of a drone on its side or upside down cannot carry it
            return 0.0, torque
        return self._mass * (climb + gravity / upright), torque

    def _tilt(self, goal: Triple, now: _Motion, gravity: float) -> tuple[float, float]:
        """Return roll and pitch [rad] for a velocity along the heading; 0 without gravity."""
        if not gravity:
            return 0.0, 0.0
        ahead, aside = _along_heading(now.angles[2], *now.velocity[:2])
        gaining, sliding = _along_heading(now.angles[2], *now.acceleration[:2])
        pitch = self._controllers["velocity_x"].update(goal[0], ahead, gaining, self.period) / gravity
        roll = -self._controllers["velocity_y"].update(goal[1], aside, sliding, self.period) / gravity
        return roll, pitch

    # ------------------------------------------------------------------ readings

    def publish_state(self) -> None:
        """Publish the number of the state."""
        self._states.publish(msgs.make(_INT8, data=self._state))

    def publish_pose(self) -> None:
        """Publish the true pose of the link."""
        pose = self.sim.link(self._link).pose
        w, x, y, z = pose.quaternion.tolist()
        orientation = {"x": x, "y": y, "z": z, "w": w}
        self._poses.publish(msgs.make(_POSE, position=xyz(pose.position), orientation=orientation))

    def publish_velocity(self) -> None:
        """Publish the true velocity in the axes of the link."""
        self._velocities.publish(self._in_link(self.sim.link(self._link).linear_velocity))

    def publish_acceleration(self) -> None:
        """Publish the true acceleration in the axes of the link."""
        self._accelerations.publish(self._in_link(self._acceleration))

    def _in_link(self, vector: Vector | Triple) -> Message:
        turned = quat_rotate(quat_conjugate(self.sim.link(self._link).pose.quaternion), vector)
        return msgs.make(_TWIST, linear=xyz(turned))

    def publish_odometry(self) -> None:
        """Publish the true pose and twist."""
        link, (frame, child) = self.sim.link(self._link), self._frames()
        pose, velocity = link.pose, link.spatial_velocity()
        back = quat_conjugate(pose.quaternion)
        twist = BodyTwist(quat_rotate(back, velocity[3:]), quat_rotate(back, velocity[:3]))
        self._odometry.publish(odometry_message(self.sim.time_ns, frame, child, pose, twist))

    def publish_transform(self) -> None:
        """Publish the true pose as a transform."""
        self._tf.publish(transforms(self.sim.time_ns, (*self._frames(), self.sim.link(self._link).pose)))

    def _frames(self) -> tuple[str, str]:
        start = f"{self.ros.namespace}/".lstrip("/")
        return f"{start}odom", f"{start}base_footprint"


def _along_heading(yaw: float, x: float, y: float) -> tuple[float, float]:
    """Return the components of a horizontal vector ahead and to the left."""
    cos, sin = math.cos(yaw), math.sin(yaw)
    return cos * x + sin * y, cos * y - sin * x
