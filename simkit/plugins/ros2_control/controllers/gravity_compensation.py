"""Arms that a hand can move: efforts that hold the joints against gravity, and nothing else."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from simkit.plugins.ros2_control.controller import Controller
from simkit.plugins.ros2_control.gravity_efforts import GravityEfforts
from simkit.plugins.ros2_control.hardware_interfaces import EFFORT, VELOCITY
from simkit.plugins.ros_parameter_block import read_names, read_numbers

_MOTOR_PARAMETERS: Final = ("motor_torque_constants", "reduction_ratios", "dt")


class GravityCompensationController(Controller):
    """PAL's gravity compensation: the arm weighs nothing, and stays where it is left.

    Parameters: `command_joints` (or `joints`); `control_type` of each, `COMMAND` (compensated) or `ZERO_TORQUE` (left
    to itself), COMMAND where it is left out; `torque_gain`, which scales all of it; `static_frictions` [N·m] and
    `viscous_frictions` [N·m·s/rad], made up for above `velocity_tolerances` [rad/s]. What concerns the real robot's
    motors alone (`motor_torque_constants`, `reduction_ratios`, `dt`) changes nothing: commands are joint efforts.
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
        kinds = [one.value.upper() for one in params.all("control_type")] or ["COMMAND"] * count
        if len(kinds) != count or not set(kinds) <= {"COMMAND", "ZERO_TORQUE"}:
            message = f"'control_type' is {', '.join(kinds)}; each of {count} joints needs one"
            params.error("SK-CONTROL-050", message, "allowed are COMMAND and ZERO_TORQUE")
            kinds = ["COMMAND"] * count
        self._gain = params.number("torque_gain", 1.0) * np.array([float(kind == "COMMAND") for kind in kinds])
        self._static = np.array(read_numbers(params, "static_frictions", [0.0] * count))
        self._viscous = np.array(read_numbers(params, "viscous_frictions", [0.0] * count))
        self._tolerance = np.array(read_numbers(params, "velocity_tolerances", [0.0] * count))
        for name in _MOTOR_PARAMETERS:
            for one in params.all(name):
                one.mark_all_read()
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
