"""Mecanum drive controller of ros2_controllers: `mecanum_drive_controller/MecanumDriveController`."""

from __future__ import annotations

import math
from collections.abc import Sequence

from simkit.params import Params
from simkit.plugins.drives.odometry import Motion
from simkit.plugins.ros2_control.reference_drive import ReferenceDrive, read_size

_PLACES = ("front_left", "front_right", "rear_right", "rear_left")
_SIGNS = ((1, -1, -1), (1, 1, 1), (1, -1, 1), (1, 1, -1))
"""Signs of a wheel's rim speed when the base moves forward, moves left and turns left, for each place."""


class MecanumDrive(ReferenceDrive):
    """Drives four wheels with rollers at 45 degrees: forward, sideways and turning.

    The effect of the rollers comes from friction that differs along and across `<fdir1>` of the wheels' collisions.
    """

    types = ("mecanum_drive_controller/MecanumDriveController",)
    default_timeout = 0.0
    default_variances = (0.1,) * 6

    def read_wheels(self, params: Params) -> None:
        is_husarion = params.has("front_left_wheel_name")
        key = "wheel_name" if is_husarion else "wheel_command_joint_name"
        self._joints = [params.text(f"{place}_{key}", required=True) for place in _PLACES]
        states = [params.text(f"{place}_wheel_state_joint_name", "") for place in _PLACES]
        self._state_joints = [state or joint for state, joint in zip(states, self._joints, strict=True)]
        for joint in sorted({j for j in self._joints if j and self._joints.count(j) > 1}):
            message = f"joint {joint!r} is named for several wheels; each wheel needs its own joint"
            params.error("SK-CONTROL-041", message)
        sizes = params if is_husarion else params.block("kinematics")
        if is_husarion:
            self._read_husarion_sizes(params)
        else:
            self._radius = read_size(sizes, ["wheels_radius"])
            self._arm = read_size(sizes, ["sum_of_robot_center_projection_on_X_Y_axis", "wheels_k"])
        offset = sizes.block("base_frame_offset")
        self._offset = offset.number("x", 0.0), offset.number("y", 0.0), offset.number("theta", 0.0)

    def _read_husarion_sizes(self, params: Params) -> None:
        """Read the sizes and set the topics of Husarion's controller, which has the same type name."""
        names = ("wheel_radius", "wheel_separation_x", "wheel_separation_y")
        radius, x, y = (read_size(params, [name]) * read_size(params, [f"{name}_multiplier"], 1.0) for name in names)
        self._radius, self._arm = radius, (x + y) / 2
        self.topics = ("~/cmd_vel", "~/odom", "/tf")

    def command_interfaces(self) -> Sequence[str]:
        return [f"{name}/velocity" for name in self._joints]

    def state_interfaces(self) -> Sequence[str]:
        return [f"{name}/velocity" for name in self._state_joints]

    def measured_twist(self, values: Sequence[float], period: float) -> Motion:
        rims = [value * self._radius / 4 for value in values]
        x, y, turn = (sum(sign[axis] * rim for sign, rim in zip(_SIGNS, rims, strict=True)) for axis in range(3))
        turn /= self._arm
        # from the centre of the wheels to the frame of the base
        offset_x, offset_y, theta = self._offset
        x, y = x - offset_y * turn, y + offset_x * turn
        return x * math.cos(theta) + y * math.sin(theta), y * math.cos(theta) - x * math.sin(theta), turn

    def wheel_commands(self, reference: Motion | None) -> list[float]:
        ahead, left, turn = reference or (0.0, 0.0, 0.0)
        offset_x, offset_y, theta = self._offset
        x = ahead * math.cos(theta) - left * math.sin(theta) + offset_y * turn
        y = ahead * math.sin(theta) + left * math.cos(theta) - offset_x * turn
        return [(a * x + b * y + c * turn * self._arm) / self._radius for a, b, c in _SIGNS]
