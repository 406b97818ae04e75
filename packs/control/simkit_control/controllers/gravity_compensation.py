"""Gravity compensation for arms that a person moves by hand: efforts that hold the joints against gravity only."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from simkit.plugins.ros_parameter_block import read_names, read_numbers
from simkit_control.plugins.ros2_control.controller import Controller
from simkit_control.plugins.ros2_control.gravity_efforts import GravityEfforts
from simkit_control.plugins.ros2_control.hardware_interfaces import EFFORT, VELOCITY

_MOTOR_PARAMETERS: Final = ("motor_torque_constants", "reduction_ratios", "dt")


class GravityCompensationController(Controller):
    """Compensates gravity as PAL's controller does: the arm seems weightless and stays where a person leaves it.

    Parameters: `command_joints` (or `joints`); `control_type` of each joint, `COMMAND` (compensated, the default) or
    `ZERO_TORQUE` (no effort); `torque_gain`, which scales all efforts; `static_frictions` [N·m] and `viscous_frictions`
    [N·m·s/rad], which are compensated above `velocity_tolerances` [rad/s]. Parameters of the real robot's motors
    (`motor_torque_constants`, `reduction_ratios`, `dt`) have no effect, because commands are joint efforts.
    """

    types = (
        "pal_controllers/GravityCompensationController",
        "gravity_compensation_controller/GravityCompensationController",
    )

    def configure(self) -> None:
        params = self.params
        self._joints = read_names(params, "command_joints") or read_names(params, "joints")
        if not self._joints:
            params.error("SK-CONTROL-050", "'command_joints' parameter is empty.", "command_joints: [arm_1_joint, …]")
        count = len(self._joints)
        kinds = [element.value.upper() for element in params.all("control_type")] or ["COMMAND"] * count
        if len(kinds) != count or not set(kinds) <= {"COMMAND", "ZERO_TORQUE"}:
            message = (
                f"'control_type' is {', '.join(kinds)}; each of the {count} joints needs one of COMMAND, ZERO_TORQUE"
            )
            params.error("SK-CONTROL-050", message, f"control_type: [{', '.join(['COMMAND'] * count)}]")
            kinds = ["COMMAND"] * count
        self._gain = params.number("torque_gain", 1.0) * np.array([float(kind == "COMMAND") for kind in kinds])
        self._static = np.array(read_numbers(params, "static_frictions", [0.0] * count))
        self._viscous = np.array(read_numbers(params, "viscous_frictions", [0.0] * count))
        self._tolerance = np.array(read_numbers(params, "velocity_tolerances", [0.0] * count))
        for name in _MOTOR_PARAMETERS:
            for element in params.all(name):
                element.mark_all_read()
        known = [self.hardware.joints[name] for name in self._joints if name in self.hardware.joints]
        self._gravity = GravityEfforts(self.sim, [joint.scoped for joint in known])

    def command_interfaces(self) -> Sequence[str]:
        return [f"{joint}/{EFFORT}" for joint in self._joints]

    def state_interfaces(self) -> Sequence[str]:
        return [f"{joint}/{VELOCITY}" for joint in self._joints]

    def deactivate(self) -> None:
        self.commands.values = np.zeros(len(self._joints))

    def update(self, now_ns: int, period: float) -> None:
        velocity = self.states.values
        is_moving = np.abs(velocity) > self._tolerance
        friction = np.where(is_moving, np.copysign(self._static, velocity) + self._viscous * velocity, 0.0)
        self.commands.values = self._gain * (self._gravity.efforts() + friction)
