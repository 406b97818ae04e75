"""Steering controllers of ros2_controllers: bicycle, tricycle and Ackermann."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar

from simkit import Params
from simkit.float_sum import float_sum
from simkit.plugins.drives.odometry import Motion
from simkit_control.plugins.ros2_control.reference_drive import ReferenceDrive, read_joints, read_size

if TYPE_CHECKING:
    from simkit.plugins.ros_parameter_files import ParameterFiles

_FREE_DEVIATION = math.pi / 6
"""Deviation of the steering angle [rad] up to which `reduce_wheel_speed_until_steering_reached` has no effect."""
_LARGEST_DEVIATION = 1.5608
"""Deviation of the steering angle [rad] from which the wheel speed has its smallest value."""

_STEER_BOT = "steer_bot_hardware_gazebo"
"""Library of steer_drive_ros, and node whose parameters name the joints of both sides."""


class SteeringDrive(ReferenceDrive):
    """Drives traction joints by velocity and steering joints by position, with the kinematics of ros2_controllers.

    Joints on both sides of an axle are listed from right to left. After the reference has expired, the base stops and
    keeps its steering angle.

    Attributes:
        traction_counts, steering_counts: allowed numbers of joints.
    """

    traction_counts: ClassVar[Sequence[int]]
    steering_counts: ClassVar[Sequence[int]]

    def read_wheels(self, params: Params) -> None:
        front_steers = params.boolean("front_steering", True)
        front, rear = ("front", "rear") if front_steers else ("rear", "front")  # names of Humble and Iron
        self._traction = read_joints(params, ["traction_joints_names", f"{rear}_wheels_names"], self.traction_counts)
        self._steering = read_joints(params, ["steering_joints_names", f"{front}_wheels_names"], self.steering_counts)
        radii = [f"{name}_wheel{s}_radius" for name in ("traction", rear) for s in ("s", "")]
        self._radius = read_size(params, radii)
        self._wheelbase = read_size(params, ["wheelbase"])
        tracks = {"traction": rear, "steering": front}
        self._traction_track, self._steering_track = (
            read_size(
                params, [f"{new}_track_width", f"{old}_wheel_track", "wheel_track"], None if len(joints) > 1 else 1.0
            )
            for (new, old), joints in zip(tracks.items(), (self._traction, self._steering), strict=True)
        )
        for name in (f"{front}_wheels_radius", f"{front}_wheel_radius", "steering_wheels_radius"):
            params.child(name)  # the steered wheels roll freely
        self._position_feedback = params.boolean("position_feedback", False)
        self._slows_down = params.boolean("reduce_wheel_speed_until_steering_reached", False)
        self._angles: list[float] | None = None  # traction angles at the last update
        self._steering_angle = 0.0  # measured, in the middle of the axle
        self._steering_commands: list[float] | None = None

    @property
    def _traction_steers(self) -> bool:
        """True if the driven wheel is the steered wheel."""
        return False

    def command_interfaces(self) -> Sequence[str]:
        return [*(f"{name}/velocity" for name in self._traction), *(f"{name}/position" for name in self._steering)]

    def state_interfaces(self) -> Sequence[str]:
        feedback = "position" if self._position_feedback else "velocity"
        return [*(f"{name}/{feedback}" for name in self._traction), *(f"{name}/position" for name in self._steering)]

    def activate(self) -> None:
        super().activate()
        self._angles = self._steering_commands = None

    def measured_twist(self, values: Sequence[float], period: float) -> Motion:
        count = len(self._traction)
        speeds, angles = list(values[:count]), values[count:]
        if self._position_feedback:
            before, self._angles = self._angles or speeds, speeds
            speeds = [(new - old) / period for new, old in zip(speeds, before, strict=True)] if period > 0.0 else speeds
        if self._steering_commands is None:
            self._steering_commands = list(angles)  # the joints keep their angles until the first reference
        self._steering_angle = steer = self._middle_angle(angles)
        rims = [speed * self._radius for speed in speeds]
        if self._traction_steers:
            return rims[0] * math.cos(steer), 0.0, rims[0] * math.sin(steer) / self._wheelbase
        factors = self._traction_factors(steer)
        # a wheel at the centre of rotation does not turn, so its speed says nothing about the base
        ahead = float_sum(rim / factor for rim, factor in zip(rims, factors, strict=True) if abs(factor) > 1e-6) / count
        return ahead, 0.0, math.tan(steer) * ahead / self._wheelbase

    def _middle_angle(self, angles: Sequence[float]) -> float:
        """Return the steering angle in the middle of the axle [rad]."""
        if len(angles) == 1:
            return angles[0]
        base, half = self._wheelbase, self._steering_track / 2
        wheel_angles = []
        for sign, angle in zip((-1.0, 1.0), angles, strict=True):  # right, left
            across, along = math.sin(angle), math.cos(angle)
            wheel_angles.append(math.atan2(base * across, base * along + sign * half * across))
        return float_sum(wheel_angles) / 2

    def _traction_factors(self, steer: float) -> list[float]:
        """Return the ratio of the speed of each driven wheel to the speed of the middle of its axle."""
        if len(self._traction) == 1:
            return [1.0]
        share = self._traction_track / 2 * math.tan(steer) / self._wheelbase
        return [1.0 + share, 1.0 - share]  # right, left

    def wheel_commands(self, reference: Motion | None) -> list[float]:
        if reference is None:
            return [0.0] * len(self._traction) + (self._steering_commands or [0.0] * len(self._steering))
        ahead, _, turn = reference
        wanted = (
            math.atan(turn * self._wheelbase / ahead) if ahead else math.copysign(math.pi / 2, turn) if turn else 0.0
        )
        steer = wanted if self._open_loop else self._steering_angle
        speed = ahead / self._radius
        if self._slows_down and not self._open_loop:
            deviation = min(max(abs(self._steering_angle - wanted), _FREE_DEVIATION), _LARGEST_DEVIATION)
            speed *= math.cos(deviation) / math.cos(_FREE_DEVIATION)
        if self._traction_steers:
            speeds = [abs(turn) * self._wheelbase / self._radius if not ahead else speed / max(math.cos(steer), 1e-3)]
        else:
            speeds = [speed * factor for factor in self._traction_factors(steer)]
        self._steering_commands = self._wheel_angles(wanted)
        return speeds + self._steering_commands

    def _wheel_angles(self, steer: float) -> list[float]:
        """Return the angle of each steering joint for the angle in the middle of the axle [rad]."""
        if len(self._steering) == 1:
            return [steer]
        across, along = 2 * self._wheelbase * math.sin(steer), 2 * self._wheelbase * math.cos(steer)
        offset = self._steering_track * math.sin(steer)
        return [math.atan2(across, along + sign * offset) for sign in (1.0, -1.0)]  # right, left


class BicycleSteering(SteeringDrive):
    """Drives one wheel and steers another wheel."""

    types = ("bicycle_steering_controller/BicycleSteeringController",)
    traction_counts = steering_counts = (1,)


class TricycleSteering(SteeringDrive):
    """Steers one wheel, and drives the same wheel or the two wheels of the other axle."""

    types = ("tricycle_steering_controller/TricycleSteeringController",)
    traction_counts, steering_counts = (1, 2), (1,)

    @property
    def _traction_steers(self) -> bool:
        return len(self._traction) == 1


class AckermannSteering(SteeringDrive):
    """Drives the two wheels of one axle, and steers the two wheels of the other axle.

    With the parameters of ROS 1 (`rear_wheel`, `front_steer`) it drives one wheel and steers one joint. A robot with
    `steer_bot_hardware_gazebo` has these two joints on both sides: then both wheels get the speed, and the two steering
    joints the angles that `steer_bot_hardware_gazebo.cpp` of steer_drive_ros gives them.
    """

    types: ClassVar[tuple[str, ...]] = (
        "ackermann_steering_controller/AckermannSteeringController",
        "steer_drive_controller/SteerDriveController",
    )
    traction_counts = steering_counts = (2,)

    def read_wheels(self, params: Params) -> None:
        if not params.has("rear_wheel"):
            super().read_wheels(params)
            return
        self.topics = ("~/cmd_vel", "~/odom", "/tf")
        self.publish_rate = params.number("publish_rate", 50.0, minimum=0)
        for name in ("publish_cmd", "allow_multiple_cmd_vel_publishers", "publish_wheel_joint_controller_state"):
            params.child(name)
        self._traction, self._steering = (read_joints(params, [name], (1,)) for name in ("rear_wheel", "front_steer"))
        self._wheelbase, self._radius = (
            read_size(params, [name]) * read_size(params, [f"{name}_multiplier"], 1.0)
            for name in ("wheel_separation_h", "wheel_radius")
        )
        self._position_feedback = params.boolean("estimate_velocity_from_position", False)
        self._traction_track, self._steering_track, self._slows_down = 0.0, 0.0, False
        self._angles, self._steering_angle, self._steering_commands = None, 0.0, None
        files: ParameterFiles = self.plugin.files  # type: ignore[attr-defined] # of the plugin with the manager
        entry = files.of_node(f"{self.plugin.ros.namespace}/{_STEER_BOT}") or files.of_node(f"/{_STEER_BOT}")
        if entry is not None:
            self._read_steer_bot(entry.block(_STEER_BOT, params.diagnostics))

    def _read_steer_bot(self, hardware: Params) -> None:
        """Read the joints on both sides, which `steer_bot_hardware_gazebo` moves."""
        self._traction = read_joints(hardware, ["virtual_rear_wheels"], (2,))
        self._steering = read_joints(hardware, ["virtual_front_steers"], (2,))
        width, height = (read_size(hardware, [f"wheel_separation_{axis}"], 1.0) for axis in "wh")
        if hardware.boolean("enable_ackermann_link", True):
            self._steering_track = width / 2 * self._wheelbase / height
