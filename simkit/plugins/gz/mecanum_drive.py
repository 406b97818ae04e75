"""gz's mecanum drive: `gz::sim::systems::MecanumDrive`, four wheels (or groups of them) with rollers at 45 degrees.

The plugin only turns the wheels. That they roll across is in their collisions, whose friction differs along and across
`<fdir1>`: see `simkit.runtime.contact.anisotropic_friction`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, cast

from simkit.compiler.contact_friction import has_directional_friction
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.drives.odometry import COMMAND_TYPES, ODOMETRY, TRANSFORMS, odometry_message, transforms
from simkit.plugins.drives.speed_limits import SpeedLimitOptions, limit_each, speed_limits
from simkit.plugins.drives.steering import Motion, TravelOdometry, joint_angles
from simkit.plugins.drives.wheel_joints import add_wheel_servos, find_wheels
from simkit.plugins.find_entities import read_topic
from simkit.plugins.one_time_warnings import OneTimeWarnings
from simkit.plugins.options import OptionsOf, number, text, texts

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import Twist, TwistStamped
    from simkit.runtime import Model
    from simkit.scene import SceneJoint, SceneModel

_PLACES = ("front_left", "front_right", "back_left", "back_right")
_SIGNS = ((1, -1, -1), (1, 1, 1), (1, 1, -1), (1, -1, 1))
"""How a wheel's rim moves with the base's speed ahead, its speed to the left and its turning, by place."""

Triple = tuple[float, float, float]


class MecanumOdometry(TravelOdometry):
    """Of one wheel at each place.

    Args:
        radius: of the wheels [m].
        arm: half the distance between the sides and half that between the axles together [m].
        step: from one noting to the next [s].
    """

    def __init__(self, radius: float, arm: float, step: float) -> None:
        super().__init__(step)
        self._radius, self._arm = radius, arm

    def motion(self, before: Sequence[float], after: Sequence[float]) -> Motion:
        """The mean of what the wheels say."""
        rims = [(b - a) * self._radius for a, b in zip(before, after, strict=True)]
        ahead, left, turn = (
            sum(sign[axis] * rim for sign, rim in zip(_SIGNS, rims, strict=True)) / 4 for axis in range(3)
        )
        return ahead, left, turn / self._arm


class MecanumDriveOptions(SpeedLimitOptions):
    """Options of `MecanumDrive`."""

    wheel_separation: float = number(1.0, "m", minimum=1e-6)
    wheelbase: float = number(1.0, "m", minimum=1e-6)
    wheel_radius: float = number(0.2, "m", minimum=1e-6)
    odom_publish_frequency: float = number(50.0, "Hz", minimum=0)
    front_left_joint: tuple[str, ...] = texts(required=True)
    front_right_joint: tuple[str, ...] = texts(required=True)
    back_left_joint: tuple[str, ...] = texts(required=True)
    back_right_joint: tuple[str, ...] = texts(required=True)
    topic: str = text()
    odom_topic: str = text()
    tf_topic: str = text()


class MecanumDrive(ModelPlugin):
    """Drives four wheels with rollers from `/model/<model>/cmd_vel`: ahead, sideways and round.

    Odometry by the wheels' turns goes out on `/model/<model>/odometry` and `/model/<model>/tf`. It starts at zero, in
    the middle of the wheels; its twist is the mean over the last ten steps.
    """

    options = OptionsOf(MecanumDriveOptions)
    filenames = ("gz-sim-mecanum-drive-system",)
    drives = True
    names = ("gz::sim::systems::MecanumDrive",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        separation = self.options.wheel_separation
        self._arm = (separation + self.options.wheelbase) / 2
        self._radius = self.options.wheel_radius
        self._limits = speed_limits(self.options)
        self._canonical = scene.canonical_link
        # gz publishes at every step where the frequency is zero
        self.after_step_rate = self.options.odom_publish_frequency
        named = {
            "front left wheel": self.options.front_left_joint,
            "front right wheel": self.options.front_right_joint,
            "back left wheel": self.options.back_left_joint,
            "back right wheel": self.options.back_right_joint,
        }
        wheels = find_wheels(scene, named, params)
        self._joints = [[joint.scoped for joint in joints] for joints in wheels.values()]
        self._servos = add_wheel_servos(builder, wheels, self.name)
        _report_rubber(scene, [joint for joints in wheels.values() for joint in joints], params)

    def load(self, parent: Model, params: Params) -> None:
        self.once = OneTimeWarnings(self)
        model = parent.name
        link = self._canonical.rsplit("::", 1)[-1]
        self._frame = params.text("frame_id", f"{model}/odom")
        self._child = params.text("child_frame_id", f"{model}/{link}")
        self._wheels = [self.sim.joint(joints[0]) for joints in self._joints]
        self._target: Triple = (0.0, 0.0, 0.0)
        self._last: Triple = (0.0, 0.0, 0.0)
        self._before_last: Triple = (0.0, 0.0, 0.0)
        self._settled = True
        self._odometry = MecanumOdometry(self._radius, self._arm, self.period)
        self.listen(read_topic(params, "topic", f"/model/{model}/cmd_vel"), COMMAND_TYPES, self._on_command)
        self._odom = self.advertise(read_topic(params, "odom_topic", f"/model/{model}/odometry"), ODOMETRY)
        self._tf = self.advertise(read_topic(params, "tf_topic", f"/model/{model}/tf"), TRANSFORMS)

    # ------------------------------------------------------------------ commands

    def _on_command(self, message: Twist | TwistStamped) -> None:
        twist = cast("Twist", getattr(message, "twist", message))
        command = float(twist.linear.x), float(twist.linear.y), float(twist.angular.z)
        if not all(map(math.isfinite, command)):
            self.once.not_finite()
        else:
            self._target, self._settled = command, False

    def before_step(self) -> None:
        """Notes the wheels' angles, and takes the limited speeds one step towards the command."""
        self._odometry.note(joint_angles(self._wheels))
        if not self._settled:
            self._command()

    def _command(self) -> None:
        linear, angular = self._limits
        limiters = (linear, linear, angular)
        ahead, left, turn = limit_each(limiters, self._target, self._last, self._before_last, self.period)
        speeds = (ahead, left, turn)
        self._settled = speeds == self._last == self._before_last
        self._before_last, self._last = self._last, speeds
        for servos, (a, b, c) in zip(self._servos, _SIGNS, strict=True):
            rim = a * ahead + b * left + c * turn * self._arm
            for servo in servos:
                self.sim.engine.set_control(servo, rim / self._radius)

    # ------------------------------------------------------------------ readings

    def after_step(self) -> None:
        """Odometry and its transform."""
        now, odometry = self.sim.time_ns, self._odometry
        odometry.reckon(joint_angles(self._wheels))
        pose = odometry.pose
        if self._odom.wanted:
            self._odom.publish_later(partial(odometry_message, now, self._frame, self._child, pose, odometry.twist))
        if self._tf.wanted:
            self._tf.publish_later(partial(transforms, now, (self._frame, self._child, pose)))


def _report_rubber(scene: SceneModel, wheels: Sequence[SceneJoint], params: Params) -> None:
    """Warns where a wheel holds in every direction: the base then only drags sideways."""
    surfaces = {link.scoped: [c.surface for c in link.collisions] for link in scene.all_links()}
    rubber = [j for j in wheels if (own := surfaces.get(j.child_link)) and not any(map(has_directional_friction, own))]
    if rubber:
        names = ", ".join(repr(joint.child_link.rsplit("::", 1)[-1]) for joint in rubber)
        message = f"mecanum drive: friction of {names} is the same in every direction; such wheels have no rollers"
        hint = '<mu>1</mu><mu2>0</mu2><fdir1 gz:expressed_in="chassis">1 -1 0</fdir1> in the surface of the collision'
        params.diagnostics.warning("SK-PLUGIN-090", message, params.where, hint)
