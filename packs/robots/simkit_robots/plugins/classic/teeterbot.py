"""Two-wheeled balancing robot Teeterbot in Gazebo Classic: `libteeterbot_gazebo_plugin.so`.

The motors, topics and the detection of a fall are those of `ControllerInterfacePlugin.cpp` and `DcMotorSim.cpp`, and
the loops of the torque and speed modes those of `MotorController.cpp` with the gains of `MotorControl.cfg`. The service
of pushes, the automatic return to the upright pose and the transforms are left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Final

from simkit import ModelPlugin, Params, msgs
from simkit.extend import (
    JointAxis,
    Options,
    OptionsOf,
    boolean,
    find_link,
    listens,
    publishes,
    without_effect,
)
from simkit.plugins.drives.wheel_joints import find_drive_joint

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Float64

_FLOAT: Final = "std_msgs/msg/Float64"
_BOOL: Final = "std_msgs/msg/Bool"
_SIDES: Final = ("left", "right")
_INDUCTANCE, _RESISTANCE, _TORQUE_CONSTANT, _MOST_CURRENT = 0.0025, 0.5, 0.35, 30.0  # H, Ω, N·m/A, A
_RAMP, _KP, _KI = 20.0, 3.0, 2.0  # of the loop of a torque or speed
_COMMANDS: Final = {"voltage": "{}_motor_voltage", "torque": "{}_torque_cmd", "speed": "{}_speed_cmd"}
_RATE: Final = 100.0  # of speeds and currents [Hz]


class TeeterbotOptions(Options):
    """Options of `Teeterbot`."""

    voltage_mode: bool = boolean(element="voltageMode")
    torque_mode: bool = boolean(element="torqueMode")
    speed_mode: bool = boolean(element="speedMode")
    ground_truth: bool = without_effect(element="pubGroundTruth")
    auto_reset: bool = without_effect(element="autoResetOrientation")
    reset_delay: bool = without_effect(element="autoResetDelay")
    length: bool = without_effect(element="bodyLength")

    @property
    def mode(self) -> str:
        """Quantity that the commands have: voltage, torque or speed; voltage unless exactly one mode is on."""
        modes = {"voltage": self.voltage_mode, "torque": self.torque_mode, "speed": self.speed_mode}
        chosen = [name for name, is_on in modes.items() if is_on]
        return chosen[0] if len(chosen) == 1 else "voltage"


@dataclass(slots=True)
class DcMotor:
    """Motor with the loop of its controller.

    Attributes:
        current: current [A].
        command: last command [V, N·m or rad/s].
        target: command after its ramp.
        integral: integral of the error.
    """

    current: float = 0.0
    command: float = 0.0
    target: float = 0.0
    integral: float = 0.0

    def torque(self, voltage: float, speed: float, period: float) -> float:
        """Advance the current by a period [s], and return the torque [N·m] at a voltage [V] and a speed [rad/s]."""
        # the implicit step has no limit of the period; the explicit one of Gazebo needs less than 10 ms
        drive = voltage - _TORQUE_CONSTANT * speed
        current = (self.current + period / _INDUCTANCE * drive) / (1.0 + period / _INDUCTANCE * _RESISTANCE)
        self.current = max(-_MOST_CURRENT, min(_MOST_CURRENT, current))
        return self.current * _TORQUE_CONSTANT

    def loop_voltage(self, measured: float, period: float) -> float:
        """Return the voltage [V] of the PI loop for a measured torque or speed."""
        if abs(self.target) < 1e-2:
            self.integral = 0.0
        ahead, most = self.command - self.target, period * _RAMP
        self.target = self.command if abs(ahead) <= most / 2 else self.target + math.copysign(most, ahead)
        error = self.target - measured
        voltage = _KP * error + _KI * self.integral
        if self.target * voltage < 0.0:
            return 0.0
        self.integral += period * error
        return voltage


class Teeterbot(ModelPlugin):
    """Drives two wheels by motors whose voltage, torque or speed is commanded on topics below the model's name.

    With `<voltageMode>` commands are `left_motor_voltage` and `right_motor_voltage` [V], with `<torqueMode>`
    `left_torque_cmd` [N·m], with `<speedMode>` `left_speed_cmd` [rad/s].
    """

    drives = True
    endpoints = (
        *(listens(f"{{model}}/{topic.format(side)}", _FLOAT) for side in _SIDES for topic in _COMMANDS.values()),
        *(publishes(f"{{model}}/{side}_{name}", _FLOAT) for side in _SIDES for name in ("wheel_speed", "current")),
        publishes("{model}/fallen_over", _BOOL),
    )
    options = OptionsOf(TeeterbotOptions)
    filenames = ("libteeterbot_gazebo_plugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        joints = [find_drive_joint(scene, f"{side}_wheel_joint", f"{side} wheel", params) for side in _SIDES]
        self._joints = [joint.scoped for joint in joints if joint is not None]
        body = find_link(scene, "base_link", params)
        self._body = "" if body is None else body.scoped

    def load(self, parent: Model, params: Params) -> None:
        self._mode = self.options.mode
        self._axes = [JointAxis(self.sim.joint(name)) for name in self._joints]
        self._motors = [DcMotor(), DcMotor()]
        self._link = self.sim.link(self._body)
        self._is_down = False
        self._next_ns = self.sim.time_ns
        name = f"/{parent.name}"
        for side in _SIDES:
            self.listen(f"{name}/{_COMMANDS[self._mode].format(side)}", _FLOAT, partial(self._on_command, side))
        self._speeds = [self.advertise(f"{name}/{side}_wheel_speed", _FLOAT) for side in _SIDES]
        self._currents = [self.advertise(f"{name}/{side}_current", _FLOAT) for side in _SIDES]
        self._fallen = self.advertise(f"{name}/fallen_over", _BOOL, latched=True)
        self._fallen.publish(msgs.make(_BOOL, data=False))

    def _on_command(self, side: str, message: Float64) -> None:
        if math.isfinite(message.data):
            self._motors[_SIDES.index(side)].command = message.data
        else:
            self._once.not_finite()

    def before_step(self) -> None:
        """Set the torques of both motors for one step, and publish a fall."""
        for axis, motor in zip(self._axes, self._motors, strict=True):
            voltage, speed = motor.command, axis.velocity
            if self._mode != "voltage":
                measured = motor.current * _TORQUE_CONSTANT if self._mode == "torque" else speed
                voltage = motor.loop_voltage(measured, self.period)
            axis.push(motor.torque(voltage, speed, self.period))
        up = self._link.pose.rotate((0.0, 0.0, 1.0))
        if (float(up[2]) < math.cos(math.pi / 4)) != self._is_down:
            self._is_down = not self._is_down
            self._fallen.publish(msgs.make(_BOOL, data=self._is_down))
        if self.sim.time_ns >= self._next_ns:
            self._next_ns += round(1e9 / _RATE)
            for axis, motor, speeds, currents in zip(
                self._axes, self._motors, self._speeds, self._currents, strict=True
            ):
                speeds.publish(msgs.make(_FLOAT, data=axis.velocity))
                currents.publish(msgs.make(_FLOAT, data=motor.current))
