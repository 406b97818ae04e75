"""Mecanum drive controller of ros2_controllers, and of ROS 1: `mecanum_drive_controller/MecanumDriveController`."""

from __future__ import annotations

import math
from collections.abc import Sequence

from simkit import Params
from simkit.extend import Cylinder, Sphere
from simkit.float_sum import float_sum
from simkit.plugins.drives.odometry import Motion
from simkit_control.plugins.ros2_control.reference_drive import ReferenceDrive, read_size

_PLACES = ("front_left", "front_right", "rear_right", "rear_left")
_SIGNS = ((1, -1, -1), (1, 1, 1), (1, -1, 1), (1, 1, -1))
"""Signs of a wheel's rim speed when the base moves forward, moves left and turns left, for each place."""

_ROS_1_NAMES = ("front_left_wheel_joint", "front_right_wheel_joint", "back_right_wheel_joint", "back_left_wheel_joint")
_SAME_RADIUS = 1e-3  # [m]


def _is_ros_1(params: Params) -> bool:
    return params.has(_ROS_1_NAMES[0])


class MecanumDrive(ReferenceDrive):
    """Drives four wheels with rollers at 45 degrees: forward, sideways and turning.

    The effect of the rollers comes from friction that differs along and across `<fdir1>` of the wheels' collisions. The
    controller of ROS 1 has the same type name; it takes the sizes of the base from the model.
    """

    types = ("mecanum_drive_controller/MecanumDriveController",)
    default_timeout = 0.0
    default_variances = (0.1,) * 6

    def read_timeout(self, params: Params) -> float:
        name = "cmd_vel_timeout"
        return params.number(name, 0.5, minimum=0, maximum=1e9) if _is_ros_1(params) else super().read_timeout(params)

    def read_wheels(self, params: Params) -> None:
        if _is_ros_1(params):
            self._joints = [params.text(name, required=True) for name in _ROS_1_NAMES]
            self._state_joints = self._joints
            self.publish_rate = params.number("publish_rate", 50.0, minimum=0)
            self.topics = ("~/cmd_vel", "~/odom", "/tf")
            self._radius, self._arm = self._sizes_of_model(params.boolean("use_realigned_roller_joints", False))
            self._report_repeated_joints(params)
            self._read_offset(params)
            return
        is_husarion = params.has("front_left_wheel_name")
        key = "wheel_name" if is_husarion else "wheel_command_joint_name"
        self._joints = [params.text(f"{place}_{key}", required=True) for place in _PLACES]
        states = [params.text(f"{place}_wheel_state_joint_name", "") for place in _PLACES]
        self._state_joints = [state or joint for state, joint in zip(states, self._joints, strict=True)]
        self._report_repeated_joints(params)
        sizes = params if is_husarion else params.block("kinematics")
        if is_husarion:
            self._read_husarion_sizes(params)
        else:
            self._radius = read_size(sizes, ["wheels_radius"])
            self._arm = read_size(sizes, ["sum_of_robot_center_projection_on_X_Y_axis", "wheels_k"])
        self._read_offset(sizes)

    def _report_repeated_joints(self, params: Params) -> None:
        for joint in sorted({j for j in self._joints if j and self._joints.count(j) > 1}):
            message = f"joint {joint!r} is named for several wheels; each wheel needs its own joint"
            params.error("SK-CONTROL-041", message)

    def _read_offset(self, sizes: Params) -> None:
        offset = sizes.block("base_frame_offset")
        self._offset = offset.number("x", 0.0), offset.number("y", 0.0), offset.number("theta", 0.0)

    def _sizes_of_model(self, has_rollers: bool) -> tuple[float, float]:
        """Return the radius of the wheels and half the wheelbase plus half the track [m], as the model has them.

        With `use_realigned_roller_joints` the radius is that of the rollers.
        """
        wheels = [joint for name in self._joints if (joint := self.hardware.joints.get(name)) is not None]
        if len(wheels) < len(_PLACES):
            return 1.0, 1.0  # the missing interfaces are reported as errors
        radii, arms = [], []
        for joint in wheels:
            scene = joint.handle.scene
            place = (self.sim.link(scene.parent_link).scene.pose_world.inverse() @ scene.pose_world).position
            arms.append(abs(float(place[0])) + abs(float(place[1])))
            wheel = scene.child_link
            if has_rollers:
                joints = self.sim.models[wheel.split("::")[0]].scene.all_joints()
                wheel = next((j.child_link for j in joints if j.parent_link == wheel), wheel)
            shapes = [c.geometry for c in self.sim.link(wheel).scene.collisions]
            radii += [float(shape.radius) for shape in shapes if isinstance(shape, (Cylinder, Sphere))][:1]
        if len(radii) < len(_PLACES) or max(radii) - min(radii) > _SAME_RADIUS:
            message = "the wheels need collisions that are cylinders or spheres of one radius"
            self.params.error("SK-CONTROL-040", message)
            return 1.0, 1.0
        if not float_sum(arms):
            message = "the joints of the wheels are at the origin of their parent link, so the wheelbase is unknown"
            self.params.error("SK-CONTROL-040", message)
            return 1.0, 1.0
        return radii[0], float_sum(arms) / len(arms)

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
        x, y, turn = (float_sum(sign[axis] * rim for sign, rim in zip(_SIGNS, rims, strict=True)) for axis in range(3))
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
