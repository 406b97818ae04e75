"""Omni wheel drive controller of ros2_controllers: `omni_wheel_drive_controller/OmniWheelDriveController`."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from simkit import Params
from simkit.extend import counted
from simkit.linear_algebra import matmul
from simkit.matrix_decompositions import pinv
from simkit.plugins.drives.odometry import Motion
from simkit.plugins.ros_parameter_block import read_names
from simkit_control.plugins.ros2_control.reference_drive import ReferenceDrive, read_size

_FEWEST_WHEELS = 3


class OmniWheelDrive(ReferenceDrive):
    """Drives three or more omnidirectional wheels on a circle: forward, sideways and turning.

    The wheels follow each other anticlockwise at equal angles. The first wheel is at `wheel_offset` [rad] from the x
    axis of the base, and the axes of the wheel joints point outwards. The effect of the rollers comes from friction
    that differs along and across `<fdir1>` of the wheels' collisions.
    """

    types = ("omni_wheel_drive_controller/OmniWheelDriveController",)
    default_timeout = 0.5
    default_variances = (0.001, 0.001, 0.001, 0.001, 0.001, 0.01)

    def read_wheels(self, params: Params) -> None:
        self._joints = read_names(params, "wheel_names", required=True, code="SK-CONTROL-041")
        count = len(self._joints)
        if 0 < count < _FEWEST_WHEELS:
            params.error(
                "SK-CONTROL-040", f"wheel_names names {counted(count, 'joint')}; this controller needs at least 3"
            )
        self.topics = ("~/cmd_vel", "~/odom", "/tf")
        self.publish_rate = params.number("publish_rate", 50.0, minimum=0)
        self._feedback = "position" if params.boolean("position_feedback", True) else "velocity"
        arm = read_size(params, ["robot_radius"])
        radius = read_size(params, ["wheel_radius"])
        angles = params.number("wheel_offset", 0.0) + np.arange(count) * 2 * math.pi / max(count, 1)
        forward, left = np.sin(angles), -np.cos(angles)
        self._wheels_of_twist = np.stack([forward, left, np.full(count, -arm)], axis=1) / radius
        self._twist_of_wheels = pinv(self._wheels_of_twist)
        self._positions: np.ndarray | None = None

    def command_interfaces(self) -> Sequence[str]:
        return [f"{name}/velocity" for name in self._joints]

    def state_interfaces(self) -> Sequence[str]:
        return [f"{name}/{self._feedback}" for name in self._joints]

    def activate(self) -> None:
        super().activate()
        self._positions = None

    def measured_twist(self, values: Sequence[float], period: float) -> Motion:
        speeds = np.array(values)
        if self._feedback == "position":
            before, self._positions = self._positions, speeds
            speeds = (speeds - before) / period if before is not None and period > 0 else np.zeros(len(speeds))
        x, y, turn = (float(value) for value in matmul(self._twist_of_wheels, speeds))
        return x, y, turn

    def wheel_commands(self, reference: Motion | None) -> list[float]:
        speeds: list[float] = matmul(self._wheels_of_twist, np.array(reference or (0.0, 0.0, 0.0))).tolist()
        return speeds
