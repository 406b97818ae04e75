"""Ackermann drive of Gazebo Classic: `libgazebo_ros_ackermann_drive.so`.

A command has the speed (`linear.x`) and the angle of a virtual wheel between the front wheels (`angular.z`). As in
Classic, PID controllers drive the steering joints and the rear wheels. Each update of a controller sets an effort for
one step only, and the gains must suit these short efforts. One deliberate difference to Gazebo Classic:
`<publish_steerangle>` publishes the steering angle, while Classic only documents this option.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

from simkit import msgs
from simkit.params import Params
from simkit.plugins.classic.commanded_drive import CommandedDrive
from simkit.plugins.drives.drive_outputs import DriveOutputOptions, DriveOutputs
from simkit.plugins.drives.odometry import COMMAND_TYPES
from simkit.plugins.drives.wheel_joints import find_drive_joint, find_wheels, steering_angles
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.joints.joint_axis import JointAxis
from simkit.plugins.joints.pid import Pid
from simkit.plugins.options import OptionsOf, boolean, number, text, vector, vector3
from simkit.scene import Cylinder, SceneJoint, SceneLink, SceneModel, Sphere

if TYPE_CHECKING:
    from simkit.compiler import ActuatorRef, SpecBuilder
    from simkit.runtime import Model

_FLOAT = "std_msgs/msg/Float32"
_WHEELS = ("front_left_joint", "front_right_joint", "rear_left_joint", "rear_right_joint")
_STEERING = ("left_steering_joint", "right_steering_joint")


class GazeboRosAckermannDriveOptions(DriveOutputOptions):
    """Options of `GazeboRosAckermannDrive`."""

    max_speed: float = number(20.0, minimum=0)
    max_steer: float = number(0.6, minimum=1e-6, maximum=1.5)
    max_steering_angle: float = number(7.85, "rad", minimum=1e-6)
    update_rate: float = number(100.0, "Hz", minimum=0)
    left_steering_pid_gain: tuple[float, float, float] = vector3()
    left_steering_i_range: tuple[float, ...] = vector((0.0, 0.0))
    right_steering_pid_gain: tuple[float, float, float] = vector3()
    right_steering_i_range: tuple[float, ...] = vector((0.0, 0.0))
    linear_velocity_pid_gain: tuple[float, float, float] = vector3()
    linear_velocity_i_range: tuple[float, ...] = vector((0.0, 0.0), "m/s")
    publish_distance: bool = boolean()
    publish_steerangle: bool = boolean()
    odometry_frame: str = text("odom")
    robot_base_frame: str = text("base_footprint")
    publish_odom: bool = boolean()
    publish_odom_tf: bool = boolean()
    publish_wheel_tf: bool = boolean()
    covariance_yaw: float = number(1e-3, minimum=0)
    front_left_joint: str = text("front_left_joint")
    front_right_joint: str = text("front_right_joint")
    rear_left_joint: str = text("rear_left_joint")
    rear_right_joint: str = text("rear_right_joint")
    left_steering_joint: str = text("left_steering_joint")
    right_steering_joint: str = text("right_steering_joint")
    steering_wheel_joint: str = text("steering_wheel_joint")


class GazeboRosAckermannDrive(CommandedDrive):
    """Steers the front wheels and drives the rear wheels of a car from `cmd_vel`; its odometry is the true motion.

    The wheel base, the track width and the radius of the rear wheels come from the wheels' collisions, as in Classic.
    """

    endpoints = (
        listens("cmd_vel", *COMMAND_TYPES),
        publishes("odom", "nav_msgs/msg/Odometry"),
        publishes("/tf", "tf2_msgs/msg/TFMessage"),
        publishes("distance", _FLOAT),
        publishes("steerangle", _FLOAT),
    )
    options = OptionsOf(GazeboRosAckermannDriveOptions)
    filenames = ("libgazebo_ros_ackermann_drive.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._canonical = scene.canonical_link
        self._read(params)
        named = {name.replace("_joint", " wheel").replace("_", " "): [getattr(self.options, name)] for name in _WHEELS}
        wheels = [joint for joints in find_wheels(scene, named, params).values() for joint in joints]
        steering = [find_drive_joint(scene, getattr(self.options, name), "steered wheel", params) for name in _STEERING]
        self._turned = [joint for joint in steering if joint is not None]
        self._wheels = wheels
        if len(wheels) == len(_WHEELS) and len(self._turned) == len(_STEERING):
            self._measure(scene, wheels, params)
        self._steering_wheel = self._add_steering_wheel_servo(scene, params, builder)

    def _read(self, params: Params) -> None:
        options = self.options.read_all()
        self._ratio = options.max_steer / options.max_steering_angle
        self._gains = {
            "left_steering": _pid_numbers(options.left_steering_pid_gain, options.left_steering_i_range),
            "right_steering": _pid_numbers(options.right_steering_pid_gain, options.right_steering_i_range),
            "linear_velocity": _pid_numbers(options.linear_velocity_pid_gain, options.linear_velocity_i_range),
        }
        options.covariance_x, options.covariance_y = (
            params.number(f"covariance_{axis}", 1e-5, minimum=0) for axis in "xy"
        )

    def _measure(self, scene: SceneModel, wheels: list[SceneJoint], params: Params) -> None:
        """Measure the radius of the rear wheels, the track width and the wheel base."""
        links = {link.scoped: link for link in scene.all_links()}
        wheel_links = [links[joint.child_link] for joint in wheels]
        bare = [link.name for link in wheel_links if not link.collisions]
        if bare:
            names = ", ".join(map(repr, bare))
            params.error("SK-PLUGIN-093", f"the drive cannot measure its wheels: no collision in {names}")
            return
        shape = wheel_links[3].collisions[0].geometry
        if not isinstance(shape, (Cylinder, Sphere)):
            kind = type(shape).__name__.lower()
            message = (
                f"the drive needs the radius of its wheels, but the collision of {wheel_links[3].name!r} is a {kind}"
            )
            params.error("SK-PLUGIN-093", f"{message}; expected a cylinder or a sphere")
            return
        self._radius = shape.radius
        front_left, front_right, rear_left, rear_right = (_centre(link) for link in wheel_links)
        self._width = math.dist(front_left, front_right)
        middles = [
            [(a + b) / 2 for a, b in zip(*pair, strict=True)]
            for pair in ((front_left, front_right), (rear_left, rear_right))
        ]
        self._base = math.dist(*middles)
        if self._base <= 0.0:
            params.error("SK-PLUGIN-093", "the front and the rear wheels are at the same position; the wheel base is 0")

    def _add_steering_wheel_servo(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> ActuatorRef | None:
        """Add a servo for the joint of the steering wheel.

        Without this joint the car drives, too: many files copy the element from a car that has a steering wheel.
        """
        name = self.options.steering_wheel_joint
        if not any(name in (joint.name, joint.scoped) for joint in scene.all_joints()):
            if params.has("steering_wheel_joint"):
                message = f"model {scene.name!r} has no joint {name!r}; the car drives without a steering wheel"
                params.block("steering_wheel_joint").warning("SK-PLUGIN-124", message, "remove <steering_wheel_joint>")
            return None
        joint = find_drive_joint(scene, name, "steering wheel", params)
        if joint is None:
            return None
        return builder.add_position_servo(joint.scoped, max_effort=math.inf, owner=self.name)

    def load(self, parent: Model, params: Params) -> None:
        self.start(parent, "cmd_vel", self.options.update_rate)
        self._axes = [JointAxis(self.sim.joint(joint.scoped)) for joint in (*self._turned, *self._wheels[2:])]
        self._pids = {name: Pid.of(numbers) for name, numbers in self._gains.items()}
        self._distance = 0.0
        self._place = self._true.place()[:2]
        self._outputs = DriveOutputs(self, self.options, [*self._turned, *self._wheels], lambda: self._true.state()[0])
        self._distance_out = self.advertise("distance", _FLOAT) if self.options.publish_distance else None
        self._angle_out = self.advertise("steerangle", _FLOAT) if self.options.publish_steerangle else None

    # ------------------------------------------------------------------ commands

    def before_step(self) -> None:
        """Set the efforts of the steering joints and of the rear wheels for one step."""
        options, elapsed = self.options, self._elapsed()
        if elapsed <= 0.0:
            elapsed = max(self.period, 1.0 / options.update_rate) if options.update_rate > 0 else self.period
        speed, angle = self._command
        left, right, rear_left, rear_right = self._axes
        target = max(-options.max_speed, min(options.max_speed, speed)) / self._radius
        push = self._pids["linear_velocity"].update(rear_right.velocity - target, elapsed)
        most = options.max_steer
        angle = max(-most, min(most, math.copysign(angle, angle * math.copysign(1.0, speed))))
        goals = steering_angles(math.tan(angle), self._base, self._width)
        for axis, name, goal in zip((left, right), ("left_steering", "right_steering"), goals, strict=True):
            axis.push(self._pids[name].update(axis.position - goal, elapsed))
        for axis in (rear_left, rear_right):
            axis.push(push)
        if self._steering_wheel is not None:
            self.sim.engine.set_control(self._steering_wheel, self._mean_steering_angle() / self._ratio)

    def _mean_steering_angle(self) -> float:
        """Return the mean steering angle of both front wheels [rad]."""
        return (self._axes[0].position + self._axes[1].position) / 2

    # ------------------------------------------------------------------ readings

    def after_step(self) -> None:
        """Publish odometry, transforms, distance and steering angle."""
        place = self._true.place()[:2]
        self._distance += math.dist(place, self._place)
        self._place = place
        if self._outputs.wants_odometry:
            self._outputs.tell(*self._true.state())
        for out, value in ((self._distance_out, self._distance), (self._angle_out, self._mean_steering_angle())):
            if out is not None and out.wanted:
                out.publish_later(partial(msgs.make, _FLOAT, data=value))


def _pid_numbers(gains: tuple[float, float, float], bounds: tuple[float, ...]) -> dict[str, float]:
    """Return gains (p, i, d) and bounds of the integral (minimum, maximum) in the form that `Pid.of` reads."""
    (p, i, d), (least, most) = gains, bounds
    numbers = {"p_gain": p, "i_gain": i, "d_gain": d, "i_min": least, "i_max": most}
    return {**numbers, "cmd_min": 0.0, "cmd_max": -1.0, "cmd_offset": 0.0}


def _centre(link: SceneLink) -> tuple[float, float, float]:
    """Return the centre of a link's first collision, in the world at load time [m]."""
    x, y, z = (link.pose_world @ link.collisions[0].pose_link).position.tolist()
    return x, y, z
