"""Ackermann steering of Gazebo: `gz::sim::systems::AckermannSteering`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.base import NEVER
from simkit.plugins.drives.odometry import COMMAND_TYPES, Angles, Motion, TravelOdometry
from simkit.plugins.drives.odometry_messages import ODOMETRY, TRANSFORMS
from simkit.plugins.drives.speed_limits import speed_limits
from simkit.plugins.drives.twist_drive import TwistDrive, WheeledDriveOptions
from simkit.plugins.drives.wheel_joints import find_drive_joint, steering_angles
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.find_entities import read_topic
from simkit.plugins.one_time_warnings import are_usable
from simkit.plugins.options import OptionsOf, boolean, integer, number, text, texts
from simkit.runtime.handles.joint import joint_angles

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.compiler.name_map import ActuatorRef
    from simkit.msgs import Actuators, Float32, Float64
    from simkit.pose import Pose
    from simkit.runtime import Model
    from simkit.scene import SceneModel

_STRAIGHT = 1e-3  # turning rate [rad/s] below which Gazebo drives straight ahead
_SIDES = ("left", "right")


class AckermannOdometry(TravelOdometry):
    """Odometry of the middle of the unsteered axle, from the mean wheel angle and the mean steering angle.

    Each sample has four angles [rad]: left wheel, right wheel, left steering joint and right steering joint. The twist
    is the motion of the last step, as in Gazebo.

    Args:
        radius: Radius of the wheels [m].
        base: Distance between the axles [m].
        step: Time between two calls of `note` [s].
    """

    stride = mean_steps = 1

    def __init__(self, radius: float, base: float, step: float) -> None:
        super().__init__(step)
        self._radius, self._base = radius, base

    def motion(self, before: Angles, after: Angles) -> Motion:
        """Return the displacement along the arc of the mean steering angle."""
        ahead = self._radius * ((after[0] - before[0]) + (after[1] - before[1])) / 2
        return ahead, 0.0, ahead * math.tan((after[2] + after[3]) / 2) / self._base


class AckermannSteeringOptions(WheeledDriveOptions):
    """Options of `AckermannSteering`."""

    steering_only: bool = boolean()
    wheel_base: float = number(1.0, "m", minimum=1e-6)
    steering_limit: float = number(0.5, minimum=1e-6, maximum=math.pi / 2)
    left_steering_joint: tuple[str, ...] = texts(required=True)
    right_steering_joint: tuple[str, ...] = texts(required=True)
    kingpin_width: float = number(0.8, "m", minimum=1e-6)
    left_joint: tuple[str, ...] = texts(required=True)
    right_joint: tuple[str, ...] = texts(required=True)
    steer_i_min: float = number(0.0)
    steer_i_max: float = number(0.0)
    steer_cmd_min: float = number(-1000.0)
    steer_cmd_max: float = number(1000.0)
    steer_cmd_offset: float = number(0.0)
    use_actuator_msg: bool = boolean()
    actuator_number: int = integer(0, minimum=0)
    sub_topic: str = text()


class AckermannSteering(TwistDrive):
    """Steers two front wheels, and drives the rear wheels or all wheels, with commands from `/model/<model>/cmd_vel`.

    With `<steering_only>` the plugin only steers. It then reads the steering angle from `/model/<model>/steer_angle`.
    With `<use_actuator_msg>` the angle is position number `<actuator_number>` of a message on `/actuators`. The
    odometry is computed from the wheel angles and the steering angles. The odometry starts at zero, and its frame is in
    the middle of the rear axle.
    """

    endpoints = (
        listens("/model/{model}/cmd_vel", *COMMAND_TYPES, named_by=("topic",)),
        listens("/model/{model}/steer_angle", "std_msgs/msg/Float64", "std_msgs/msg/Float32", named_by=("topic",)),
        listens("/actuators", "actuator_msgs/msg/Actuators", named_by=("topic",)),
        publishes("/model/{model}/odometry", ODOMETRY, named_by=("odom_topic",)),
        publishes("/model/{model}/tf", TRANSFORMS, named_by=("tf_topic",)),
    )
    options = OptionsOf(AckermannSteeringOptions)
    filenames = ("gz-sim-ackermann-steering-system",)
    names = ("gz::sim::systems::AckermannSteering",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._only = self.options.steering_only
        self._base = self.options.wheel_base
        self._separation = self.options.wheel_separation
        self._limit = self.options.steering_limit
        self._limiters = speed_limits(self.options)
        self.actuation = None if self._only else self.options.actuation_error.motion_errors
        self._canonical = scene.canonical_link
        self._steering = [self._prepare_steering(f"{side}_steering_joint", scene, params, builder) for side in _SIDES]
        self.after_step_rate = NEVER
        if not self._only:
            self._width = self.options.kingpin_width
            self._radius = self.options.wheel_radius
            # a frequency of zero means every step, as in Gazebo
            self.after_step_rate = self.options.odom_publish_frequency
            named = {"left wheel": self.options.left_joint, "right wheel": self.options.right_joint}
            self.add_wheels(scene, builder, named)

    def _prepare_steering(
        self, name: str, scene: SceneModel, params: Params, builder: SpecBuilder
    ) -> list[tuple[str, ActuatorRef]]:
        """Add a velocity servo to each steering joint of one side; return the joints with their servos."""
        elements = params.all(name)
        if not elements:
            params.text(name, required=True)
        steered = [find_drive_joint(scene, element.value, "steered wheel", element) for element in elements]
        joints = [joint for joint in steered if joint is not None]
        return [
            (j.scoped, builder.add_velocity_servo(j.scoped, max_effort=j.axes[0].effort, owner=self.name))
            for j in joints
        ]

    def load(self, parent: Model, params: Params) -> None:
        self.start()
        description = "steering speed per error of the steering angle [1/s]"
        self._gain = self.declare("steer_p_gain", 1.0, minimum=0.0, maximum=1e6, description=description)
        self._read_rest_of_gains(params)
        self._rims = [0.0, 0.0]
        self._turners = [self.sim.joint(joints[0][0]) for joints in self._steering]
        self._turns = [0.0, 0.0]
        self._listen(parent.name, params)
        if self._only:
            return
        self._wheels = [self.sim.joint(joints[0]) for joints in self._joint_names]
        self._odometry = AckermannOdometry(self._radius, self._base, self.period)
        self.add_odometry_errors(self.options, self._odometry.reckoning.pose)
        self.open_odometry(parent, params)

    def _read_rest_of_gains(self, params: Params) -> None:
        """Read the integral, derivative, limit and offset parameters of the steering controller.

        Gazebo resets this controller at every step, so its i and d gains act as additional proportional gains.
        """
        i, d = (params.number(f"steer_{name}_gain", 0.0, minimum=0) for name in "id")
        least, most = self.options.steer_i_min, self.options.steer_i_max
        self._integral, self._slope = (i, least, most), d
        self._bounds = self.options.steer_cmd_min, self.options.steer_cmd_max
        self._offset = self.options.steer_cmd_offset

    def _listen(self, model: str, params: Params) -> None:
        by_message = self.options.use_actuator_msg
        self._number = self.options.actuator_number
        topic = "/actuators" if by_message else f"/model/{model}/steer_angle"
        if not self._only:
            topic = f"/model/{model}/cmd_vel"
        if self.options.sub_topic:
            topic = f"/model/{model}{read_topic(params, 'sub_topic', '')}"
        topic = read_topic(params, "topic", topic)
        if not self._only:
            self.listen(topic, COMMAND_TYPES, self.on_twist)
        elif by_message:
            self.listen(topic, "actuator_msgs/msg/Actuators", self._on_actuators)
        else:
            self.listen(topic, ("std_msgs/msg/Float64", "std_msgs/msg/Float32"), self._on_angle)

    # ------------------------------------------------------------------ commands

    def _on_angle(self, message: Float64 | Float32) -> None:
        self._steer(float(message.data))

    def _on_actuators(self, message: Actuators) -> None:
        if self._number >= len(message.position):
            count = len(message.position)
            self.log.warning("ignored a message with %d positions: it has no index %d", count, self._number)
        else:
            self._steer(float(message.position[self._number]))

    def _steer(self, angle: float) -> None:
        if are_usable(angle):
            self.aim((0.0, angle))
        else:
            self._once.not_finite()

    def before_step(self) -> None:
        """Advance the limited command by one step, and set the speeds of the wheels and of the steering joints."""
        if not self._only:
            self._odometry.note(joint_angles((*self._wheels, *self._turners)))
        forward, turn = self.next_speeds()
        if self._only:  # the second value of the command is then the steering angle
            turn = max(-self._limit, min(self._limit, turn))
            self._last = (forward, turn)
            angles = steering_angles(math.tan(turn), self._base, self._separation)
        else:
            slope = self._slope_of(forward, turn)
            angles = steering_angles(slope, self._base, self._width)
            self._drive(forward, slope)
        for side, (joint, angle) in enumerate(zip(self._turners, angles, strict=True)):
            speed = self._correction(joint_angles((joint,))[0] - angle)
            if speed != self._turns[side]:
                self._turns[side] = speed
                for _, servo in self._steering[side]:
                    self.sim.engine.set_control(servo, speed)

    def _slope_of(self, forward: float, turn: float) -> float:
        """Return the tangent of the steering angle, within its limit, of a virtual wheel between the front wheels.

        Args:
            forward: Forward speed [m/s].
            turn: Turning rate [rad/s].
        """
        if abs(turn) < _STRAIGHT:
            return 0.0
        tightest = self._base / math.sin(self._limit)
        radius = forward / turn
        if forward == 0.0 or abs(radius) < tightest:
            # at zero speed the wheels are steered as for forward motion
            radius = math.copysign(tightest, turn if forward == 0.0 else radius)
        return self._base / radius

    def _drive(self, forward: float, slope: float) -> None:
        """Set the speeds of the driven wheels; in a curve the outer wheels turn faster than the inner wheels."""
        share = self._separation * slope / (2 * self._base)
        for side, part in enumerate((1 - share, 1 + share)):
            rim = forward * part
            if rim != self._rims[side]:
                self._rims[side] = rim
                for motor in self._servos[side]:
                    self.sim.engine.set_control(motor, rim / self._radius)

    def _correction(self, error: float) -> float:
        """Return the steering speed [rad/s] that corrects an error of the steering angle [rad]."""
        i, least, most = self._integral
        summed = i * error * self.period
        if most >= least:
            summed = max(least, min(most, summed))
        speed = self._offset - self._gain.value * error - summed - self._slope * error / self.period
        low, high = self._bounds
        return max(low, min(high, speed)) if high >= low else speed

    # ------------------------------------------------------------------ readings

    def odometry_pose(self) -> Pose:
        return self.reckoned_pose(self._odometry.reckoning.pose)

    def after_step(self) -> None:
        """Publish odometry and its transform."""
        if self._only:
            return
        self._odometry.reckon(joint_angles((*self._wheels, *self._turners)))
        self.publish_reckoned(self._odometry.reckoning.pose, self._odometry.twist)
