"""Mecanum drive of Gazebo: `gz::sim::systems::MecanumDrive`, four wheels (or groups) with rollers at 45 degrees.

The plugin only turns the wheels. The effect of the rollers comes from the wheels' collisions, whose friction differs
along and across `<fdir1>`: see `simkit.runtime.contact.anisotropic_friction`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from simkit.compiler.contact_friction import has_directional_friction
from simkit.float_sum import float_sum
from simkit.params import Params
from simkit.plugins.drives.odometry import Angles, Motion, TravelOdometry
from simkit.plugins.drives.speed_limits import speed_limits
from simkit.plugins.drives.twist_drive import Speeds, TwistDrive, WheeledDriveOptions
from simkit.plugins.options import OptionsOf, number, texts
from simkit.runtime.handles.joint import joint_angles

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import Twist
    from simkit.pose import Pose
    from simkit.runtime import Model
    from simkit.scene import SceneJoint, SceneModel

_PLACES = ("front_left", "front_right", "back_left", "back_right")
_SIGNS = ((1, -1, -1), (1, 1, 1), (1, 1, -1), (1, -1, 1))
"""Signs of a wheel's rim speed when the base moves forward, moves left and turns left, for each wheel position."""


class MecanumOdometry(TravelOdometry):
    """Odometry from one wheel at each of the four positions.

    Args:
        radius: Radius of the wheels [m].
        arm: Half the distance between the sides plus half the distance between the axles [m].
        step: Time between two calls of `note` [s].
    """

    def __init__(self, radius: float, arm: float, step: float) -> None:
        super().__init__(step)
        self._radius, self._arm = radius, arm

    def motion(self, before: Angles, after: Angles) -> Motion:
        """Return the displacement of the base between two samples of the wheel angles."""
        rims = [(b - a) * self._radius for a, b in zip(before, after, strict=True)]
        ahead, left, turn = (
            float_sum(sign[axis] * rim for sign, rim in zip(_SIGNS, rims, strict=True)) / 4 for axis in range(3)
        )
        return ahead, left, turn / self._arm


class MecanumDriveOptions(WheeledDriveOptions):
    """Options of `MecanumDrive`."""

    wheelbase: float = number(1.0, "m", minimum=1e-6)
    front_left_joint: tuple[str, ...] = texts(required=True)
    front_right_joint: tuple[str, ...] = texts(required=True)
    back_left_joint: tuple[str, ...] = texts(required=True)
    back_right_joint: tuple[str, ...] = texts(required=True)


class MecanumDrive(TwistDrive):
    """Drives four wheels with rollers from `/model/<model>/cmd_vel`: forwards, sideways and turning.

    The wheel odometry is published on `/model/<model>/odometry` and `/model/<model>/tf`. Its pose starts at zero and
    describes the point in the middle of the wheels. Its twist is the mean over the last ten steps.
    """

    reads_at_load = ("surface",)  # the rollers follow from the friction

    options = OptionsOf(MecanumDriveOptions)
    filenames = ("gz-sim-mecanum-drive-system",)
    names = ("gz::sim::systems::MecanumDrive",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        separation = self.options.wheel_separation
        self._arm = (separation + self.options.wheelbase) / 2
        self._radius = self.options.wheel_radius
        linear, angular = speed_limits(self.options)
        self._limiters = (linear, linear, angular)
        self.actuation = self.options.actuation_error.motion_errors
        self._canonical = scene.canonical_link
        # a frequency of zero means every step, as in Gazebo
        self.after_step_rate = self.options.odom_publish_frequency
        named = {
            "front left wheel": self.options.front_left_joint,
            "front right wheel": self.options.front_right_joint,
            "back left wheel": self.options.back_left_joint,
            "back right wheel": self.options.back_right_joint,
        }
        _report_missing_rollers(scene, self.add_wheels(scene, builder, named), params)

    def load(self, parent: Model, params: Params) -> None:
        self.start()
        self._wheels = [self.sim.joint(joints[0]) for joints in self._joint_names]
        self._odometry = MecanumOdometry(self._radius, self._arm, self.period)
        self.add_odometry_errors(self.options, self._odometry.reckoning.pose)
        self.open_topics(parent, params)

    def speeds_of(self, twist: Twist) -> Speeds:
        return float(twist.linear.x), float(twist.linear.y), float(twist.angular.z)

    def before_step(self) -> None:
        """Store the wheel angles, and advance the limited speeds by one step towards the command."""
        self._odometry.note(joint_angles(self._wheels))
        if not self._settled:
            ahead, left, turn = self.next_speeds()
            self.turn_wheels([a * ahead + b * left + c * turn * self._arm for a, b, c in _SIGNS])

    def odometry_pose(self) -> Pose:
        return self.reckoned_pose(self._odometry.reckoning.pose)

    def after_step(self) -> None:
        """Publish odometry and its transform."""
        self._odometry.reckon(joint_angles(self._wheels))
        self.publish_reckoned(self._odometry.reckoning.pose, self._odometry.twist)


def _report_missing_rollers(scene: SceneModel, wheels: Sequence[SceneJoint], params: Params) -> None:
    """Warn about wheels with equal friction in every direction, because such wheels do not roll sideways."""
    surfaces = {link.scoped: [c.surface for c in link.collisions] for link in scene.all_links()}
    plain = [
        j
        for j in wheels
        if (wheel_surfaces := surfaces.get(j.child_link)) and not any(map(has_directional_friction, wheel_surfaces))
    ]
    if plain:
        names = ", ".join(repr(joint.child_link.rsplit("::", 1)[-1]) for joint in plain)
        message = f"mecanum drive: friction of {names} is equal in every direction, so these wheels have no rollers"
        hint = 'add <mu>1</mu><mu2>0</mu2><fdir1 gz:expressed_in="chassis">1 -1 0</fdir1> to <ode> of each collision'
        params.diagnostics.warning("SK-PLUGIN-090", message, params.where, hint)
