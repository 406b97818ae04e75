"""Car of car_demo in Gazebo Classic: `libPriusHybridPlugin.so`.

The elements, defaults, topics and formulas are those of `PriusHybridPlugin.cc` in car_demo. Two differences are
deliberate. The console's fuel consumption and battery, which do not act on the car, are not simulated. Keys of Gazebo's
window and the topics `/prius/reset` and `/prius/stop`, which reset or pause the world, are left out.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from simkit import ModelPlugin, Params
from simkit.extend import (
    Cylinder,
    JointAxis,
    Options,
    OptionsOf,
    Sphere,
    find_named_link,
    listens,
    number,
    text,
    without_effect,
)
from simkit.plugins.drives.wheel_joints import find_drive_joint, find_wheels, steering_angles
from simkit.plugins.joints.pid import Pid

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneLink, SceneModel, SpecBuilder
    from simkit.msgs import Int32, Message, Pose

_CONTROL: Final = "prius_msgs/msg/Control"
_POSE: Final = "geometry_msgs/msg/Pose"
_GEAR: Final = "std_msgs/msg/Int32"
_NEUTRAL, _FORWARD, _REVERSE = 1, 2, 3  # constants of Control
_DIRECTIONS: Final = {_NEUTRAL: 0, _FORWARD: 1, _REVERSE: -1}
_TIMEOUT: Final = 0.3  # [s]; pedals and steering wheel return after this time without a command
_HAND_WHEEL_TURN: Final = 7.85  # [rad]; largest angle of the steering wheel
_LARGEST_STEERING: Final = 0.8727  # [rad]; largest angle of a front wheel
_STEERING_FORCE: Final = 5000.0  # [N·m]
_WITHOUT_RADIUS: Final = 0.0
_CREEP_SPEED: Final = 7.0  # [mile/h]; below, the car creeps forward, and above, it brakes
_MILES_PER_HOUR: Final = 2.23694  # of 1 m/s
_WHEELS: Final = ("front_left_wheel", "front_right_wheel", "back_left_wheel", "back_right_wheel")
_STEERED: Final = ("front_left_wheel_steering", "front_right_wheel_steering")


class PriusHybridOptions(Options):
    """Options of `PriusHybridPlugin`."""

    front_left_wheel: str = text(required=True)
    front_right_wheel: str = text(required=True)
    back_left_wheel: str = text(required=True)
    back_right_wheel: str = text(required=True)
    front_left_wheel_steering: str = text(required=True)
    front_right_wheel_steering: str = text(required=True)
    steering_wheel: str = text(required=True)
    drag: float = number(1.0, "N s²/m²", element="chassis_aero_force_gain")
    front_torque: float = number(0.0, "N·m")
    back_torque: float = number(2000.0, "N·m")
    front_brake_torque: float = number(2000.0, "N·m", minimum=0)
    back_brake_torque: float = number(2000.0, "N·m", minimum=0)
    max_speed: float = number(10.0, "m/s", minimum=0)
    max_steer: float = number(0.6, "rad", minimum=1e-6, maximum=1.5)
    left_p: float = number(0.0, element="flwheel_steering_p_gain")
    left_i: float = number(0.0, element="flwheel_steering_i_gain")
    left_d: float = number(0.0, element="flwheel_steering_d_gain")
    right_p: float = number(0.0, element="frwheel_steering_p_gain")
    right_i: float = number(0.0, element="frwheel_steering_i_gain")
    right_d: float = number(0.0, element="frwheel_steering_d_gain")
    charge: bool = without_effect(element="battery_charge_watt_hours")
    discharge: bool = without_effect(element="battery_discharge_watt_hours")
    efficiency: bool = without_effect(element="gas_efficiency")
    gas_flow: bool = without_effect(element="min_gas_flow")


class PriusHybridPlugin(ModelPlugin):
    """Drives and steers a car with the pedals, the gear and the steering wheel of `prius_msgs/Control` on `prius`.

    `/cmd_vel` has the throttle (`position.x`), the angle of the steering wheel [rad] (`position.y`) and the brake
    (`position.z`), and `/cmd_gear` shifts the gear by −1, 0 or 1. Commands act for 0.3 s. The hand brake holds the car
    until the first throttle; without a throttle the car then creeps forward, as with an automatic gear.
    """

    drives = True
    endpoints = (listens("prius", _CONTROL), listens("/cmd_vel", _POSE), listens("/cmd_gear", _GEAR))
    options = OptionsOf(PriusHybridOptions)
    filenames = ("libPriusHybridPlugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._chassis = find_named_link(scene, "chassis", params)
        named = {role.replace("_", " "): [getattr(options, role)] for role in _WHEELS}
        self._wheels = [joint for joints in find_wheels(scene, named, params).values() for joint in joints]
        roles = (*_STEERED, "steering_wheel")
        found = [find_drive_joint(scene, getattr(options, role), role.replace("_", " "), params) for role in roles]
        self._steered = [joint.scoped for joint in found if joint is not None]
        if len(self._wheels) < len(_WHEELS):
            return
        links = {link.scoped: link for link in scene.all_links()}
        wheel_links = [links[joint.child_link] for joint in self._wheels]
        bare = ", ".join(repr(link.name) for link in wheel_links if not link.collisions)
        if bare:
            params.error("SK-PLUGIN-093", f"the drive cannot measure its wheels: no collision in {bare}")
            return
        self._measure(wheel_links, params)

    def _measure(self, links: list[SceneLink], params: Params) -> None:
        """Measure the radii, the track width and the wheel base of the car from the first collision of each wheel."""
        shapes = [link.collisions[0].geometry for link in links]
        self._radii = [s.radius if isinstance(s, (Cylinder, Sphere)) else _WITHOUT_RADIUS for s in shapes]
        centres = [(link.pose_world @ link.collisions[0].pose_link).position.tolist() for link in links]
        front_left, front_right, back_left, back_right = centres
        self._width = math.dist(front_left, front_right)
        front, back = _middle(front_left, front_right), _middle(back_left, back_right)
        self._base = math.dist(front, back)
        if self._base <= 0.0:
            params.error("SK-PLUGIN-093", "the front and the back wheels are at the same position; the wheel base is 0")

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self._link = self.sim.link(self._chassis)
        self._axes = [JointAxis(self.sim.joint(joint.scoped)) for joint in self._wheels]
        self._steering = [JointAxis(self.sim.joint(name)) for name in self._steered]
        limits = {"i_max": 0.0, "i_min": 0.0, "cmd_offset": 0.0}
        self._pids = [
            Pid.of({"p_gain": p, "i_gain": i, "d_gain": d, "cmd_max": most, "cmd_min": -most, **limits})
            for p, i, d, most in (
                (options.left_p, options.left_i, options.left_d, _STEERING_FORCE),
                (options.right_p, options.right_i, options.right_d, _STEERING_FORCE),
                (100.0, 0.0, 10.0, 10.0),
            )
        ]
        self._ratio = min(_LARGEST_STEERING, options.max_steer) / _HAND_WHEEL_TURN
        self._losses = [joint.axes[0].friction for joint in self._wheels]
        self._direction, self._hand_brake = 1, 1.0
        self._throttle = self._brake = self._hand_wheel = 0.0
        self._braked: float | None = None  # part of the brake torques that the wheels have now
        self._command_ns = self.sim.time_ns
        self.listen(self.ros.topic("prius") if params.has("robotNamespace") else "/prius", _CONTROL, self._on_control)
        self.listen("/cmd_vel", _POSE, self._on_pedals)
        self.listen("/cmd_gear", _GEAR, self._on_gear)

    # ------------------------------------------------------------------ commands

    def _on_control(self, message: Message) -> None:
        if not self._is_finite(message.throttle, message.brake, message.steer):
            return
        self._set(message.throttle, _HAND_WHEEL_TURN * message.steer, message.brake)
        self._direction = _DIRECTIONS.get(message.shift_gears, self._direction)

    def _on_pedals(self, message: Pose) -> None:
        command = message.position
        if self._is_finite(command.x, command.y, command.z):
            self._set(command.x, command.y, command.z)

    def _on_gear(self, message: Int32) -> None:
        self._direction = max(-1, min(1, self._direction + message.data))

    def _is_finite(self, *values: float) -> bool:
        if all(map(math.isfinite, values)):
            return True
        self._once.not_finite()
        return False

    def _set(self, throttle: float, hand_wheel: float, brake: float) -> None:
        """Set the pedals (0 to 1) and the angle of the steering wheel [rad]."""
        self._throttle, self._brake = _within(throttle, 0.0, 1.0), _within(brake, 0.0, 1.0)
        self._hand_wheel = _within(hand_wheel, -_HAND_WHEEL_TURN, _HAND_WHEEL_TURN)
        self._command_ns = self.sim.time_ns

    # ------------------------------------------------------------------ run time

    def before_step(self) -> None:
        """Apply drag, steering, drive torques and brakes for one step."""
        if self.sim.time_ns - self._command_ns > _TIMEOUT * 1e9:
            self._throttle = self._brake = self._hand_wheel = 0.0
        velocity = self._link.linear_velocity
        speed = math.hypot(*velocity.tolist())
        self._link.apply_wrench(-self.options.drag * speed * velocity)
        self._steer()
        miles_per_hour = speed * _MILES_PER_HOUR
        creep = 0.1 * (1.0 - miles_per_hour / _CREEP_SPEED)
        if miles_per_hour > _CREEP_SPEED:
            creep = 0.025 * (_CREEP_SPEED - miles_per_hour)
        creep = _within(creep, -0.025, 0.1)
        if self._throttle > 0.0:
            self._hand_brake = 0.0
        self._drive(max(self._throttle, creep) * self._direction)
        brake = self._brake + self._hand_brake
        if self._direction:
            brake = max(brake, -creep - self._throttle)
        self._apply_brakes(_within(brake, 0.0, 1.0))

    def _steer(self) -> None:
        """Set the efforts of the steering wheel and of both steered joints."""
        most = self.options.max_steer / self._ratio
        self._hand_wheel = _within(self._hand_wheel, -most, most)
        angles = steering_angles(math.tan(self._hand_wheel * self._ratio), self._base, self._width)
        for axis, pid, goal in zip(self._steering, self._pids, (*angles, self._hand_wheel), strict=True):
            axis.push(pid.update(axis.position - goal, self.period))

    def _drive(self, part: float) -> None:
        """Set the torques of the wheels, except those of an axle that has a wheel at the largest speed.

        Args:
            part: part of the largest torques, from −1 to 1.
        """
        options = self.options
        for axle, torque in ((slice(0, 2), options.front_torque), (slice(2, 4), options.back_torque)):
            speeds = [abs(axis.velocity * r) for axis, r in zip(self._axes[axle], self._radii[axle], strict=True)]
            for axis in self._axes[axle]:
                axis.push(part * torque if max(speeds) < options.max_speed else 0.0)

    def _apply_brakes(self, part: float) -> None:
        """Set the dry friction of the wheels' joints to a part of the brake torques, from 0 to 1."""
        if part == self._braked:
            return
        self._braked = part
        losses = self.sim.engine.touch("dof_frictionloss")
        torques = (*[self.options.front_brake_torque] * 2, *[self.options.back_brake_torque] * 2)
        for axis, own, torque in zip(self._axes, self._losses, torques, strict=True):
            losses[axis.dof] = own + part * torque


def _middle(a: list[float], b: list[float]) -> list[float]:
    """Return the point in the middle of two points [m]."""
    return [(x + y) / 2 for x, y in zip(a, b, strict=True)]


def _within(value: float, least: float, most: float) -> float:
    """Limit a value to a range."""
    return max(least, min(most, value))
