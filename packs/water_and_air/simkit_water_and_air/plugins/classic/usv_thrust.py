"""Thrusters of a boat in Gazebo Classic: `libusv_gazebo_thrust_plugin.so` of VRX.

A command of -maxCmd…maxCmd gives a force along the x axis of the link, turned about its z axis by the angle command:

    mappingType 0   F = command / maxCmd · maxForceFwd, or · |maxForceRev| for a negative command
    mappingType 1   F = A + (K - A) / (C + exp(-B·(command - M)))^(1/ν), within maxForceRev…maxForceFwd

The constants of type 1 are those of a measured engine of a WAM-V.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Final

from simkit import ModelPlugin, Params
from simkit.extend import JointAxis, Options, OptionsOf, blocks, boolean, find_link, integer, listens, number, text
from simkit.plugins.find_entities import find_axis_joint, read_required_name
from simkit.plugins.joint_states import JOINT_STATE, joint_readings, joint_state_message
from simkit.plugins.one_time_warnings import are_usable
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit_water_and_air.plugins.fluids.tuple_vectors import to_world_axes

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Float32

_FLOAT: Final = "std_msgs/msg/Float32"
_MOST: Final = 1e9
_FORWARD: Final = (0.01, 59.82, 5.0, 0.38, 0.56, 0.28)  # A, K, B, ν, C, M of the logistic function
_BACKWARD: Final = (-199.13, -0.09, 8.84, 5.34, 0.99, -0.57)
_DEAD_ZONE: Final = 0.01  # command up to which the second function applies
_LEAST_TURNING: Final = 0.1  # command from which the propeller turns
_PROPELLER_EFFORT: Final = 2.0  # [N·m], of a propeller at the command 1


class UsvThrusterOptions(Options):
    """Options of a `<thruster>`."""

    link_name: str = text(element="linkName", required=True)
    propeller: str = text(element="propJointName")
    engine: str = text(element="engineJointName")
    command_topic: str = text(element="cmdTopic", required=True)
    angle_topic: str = text(element="angleTopic", required=True)
    max_command: float = number(1.0, element="maxCmd", minimum=1e-9, maximum=_MOST)
    forward: float = number(250.0, "N", element="maxForceFwd", minimum=0, maximum=_MOST)
    backward: float = number(-100.0, "N", element="maxForceRev", minimum=-_MOST, maximum=_MOST)
    max_angle: float = number(math.pi / 2, "rad", element="maxAngle", minimum=0, maximum=2 * math.pi)
    mapping: int = integer(0, element="mappingType", minimum=0, maximum=1)
    enable_angle: bool = boolean(True, element="enableAngle")


class UsvThrustOptions(Options):
    """Options of `UsvThrust`."""

    timeout: float = number(1.0, "s", element="cmdTimeout", minimum=0)
    thrusters: tuple[UsvThrusterOptions, ...] = blocks(UsvThrusterOptions, element="thruster")


@dataclass
class _Thruster:
    """Thruster with its present command.

    Attributes:
        options: Options of its `<thruster>`.
        link: Scoped name of its link.
        propeller: Scoped name of the joint of its propeller; empty for none.
        command, angle: Present commands.
        tick: Tick of the last command.
    """

    options: UsvThrusterOptions
    link: str
    propeller: str
    command: float = 0.0
    angle: float = 0.0
    tick: int = field(default=0)

    def force(self) -> float:
        """Return the thrust [N]."""
        o = self.options
        low = -abs(o.backward)
        if not o.mapping:
            share = self.command / o.max_command
            return min(share * o.forward, o.forward) if share >= 0 else max(-share * low, low)
        if self.command > _DEAD_ZONE:
            return min(_logistic(self.command, *_FORWARD), o.forward)
        return max(_logistic(self.command, *_BACKWARD), low)


def _logistic(x: float, a: float, k: float, b: float, nu: float, c: float, m: float) -> float:
    """Return the value of a generalised logistic function."""
    return a + (k - a) / math.pow(c + math.exp(min(-b * (x - m), 700.0)), 1 / nu)


class UsvThrust(ModelPlugin):
    """Pushes links by commanded thrusts, whose directions follow commanded angles, and turns propellers.

    Commands are `Float32` messages on `<cmdTopic>` (of `<maxCmd>`) and `<angleTopic>` [rad] of each thruster. Thrusts
    stop `<cmdTimeout>` after the last command. The joints of the propellers are published on `joint_states`.
    """

    endpoints = (
        listens("{cmdTopic}", _FLOAT, named_by=("thruster/cmdTopic",)),
        listens("{angleTopic}", _FLOAT, named_by=("thruster/angleTopic",)),
    )
    options = OptionsOf(UsvThrustOptions)
    filenames = ("libusv_gazebo_thrust_plugin.so",)
    drives = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        self._thrusters: list[_Thruster] = []
        for options in self.options.thrusters:
            options.read_all()
            element = options.params
            name = read_required_name(element, "linkName")
            link = find_link(scene, name, element.block("linkName")) if name else None
            propeller = ""
            if options.propeller:
                joint = find_axis_joint(scene, options.propeller, element.block("propJointName"))
                propeller = "" if joint is None else joint.scoped
            if options.engine:
                message = "<engineJointName> has no effect: the thrust turns by the angle, and the joint does not"
                element.block("engineJointName").warning("SK-PLUGIN-111", message)
            if link is not None:
                self._thrusters.append(_Thruster(options, link.scoped, propeller))

    def load(self, parent: Model, params: Params) -> None:
        self._links = PushedLinks(self.sim, self._link_names())
        self._joints = [(JointAxis(self.sim.joint(t.propeller)), t) for t in self._thrusters if t.propeller]
        self._states = self.advertise("joint_states", JOINT_STATE)
        for index, thruster in enumerate(self._thrusters):
            self.listen(thruster.options.command_topic, _FLOAT, partial(self._on_command, index))
            if thruster.options.enable_angle:
                self.listen(thruster.options.angle_topic, _FLOAT, partial(self._on_angle, index))

    def _link_names(self) -> list[str]:
        return list(dict.fromkeys(thruster.link for thruster in self._thrusters))

    def _number(self, message: Float32) -> float | None:
        value = float(message.data)
        if are_usable(value):
            return value
        self._once.not_finite()
        return None

    def _on_command(self, index: int, message: Float32) -> None:
        value, thruster = self._number(message), self._thrusters[index]
        if value is not None:
            thruster.command, thruster.tick = value, self.sim.tick

    def _on_angle(self, index: int, message: Float32) -> None:
        value, thruster = self._number(message), self._thrusters[index]
        if value is not None:
            most = thruster.options.max_angle
            thruster.angle = max(-most, min(most, value))

    def before_step(self) -> None:
        """Apply the thrusts for the next step, and turn the propellers."""
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, self._link_names())
        timeout, now = self.options.timeout, self.sim.tick
        data, wrenches = moving_data(self.sim), dict[int, list[float]]()
        for thruster in self._thrusters:
            if 0 < timeout < (now - thruster.tick) * self.period:
                thruster.command = 0.0
            force = thruster.force() if thruster.command else 0.0
            if not force or thruster.link not in self._links.names:
                continue
            row = self._links.names.index(thruster.link)
            body = self._links.ids[row]
            along = force * math.cos(thruster.angle), force * math.sin(thruster.angle), 0.0
            pushed = to_world_axes(data.xmat[body].tolist(), along)
            before = wrenches.setdefault(row, [0.0] * 6)
            wrenches[row] = [a + b for a, b in zip(before, (*pushed, 0.0, 0.0, 0.0), strict=True)]
        self._links.push_some(data, wrenches)
        for axis, thruster in self._joints:
            is_turning = abs(thruster.command) > _LEAST_TURNING
            effort = max(-1.0, min(1.0, thruster.command)) * _PROPELLER_EFFORT
            axis.push(effort if is_turning else 0.0)

    def after_step(self) -> None:
        """Publish the states of the propellers."""
        if self._states.wanted and self._joints:
            joints = joint_readings([axis.joint for axis, _ in self._joints])
            self._states.publish(joint_state_message(self.sim.time_ns, joints))
