"""Publishers of Gazebo Classic's drives: odometry, transforms and joint states, as the plugin's options select."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, ClassVar

from simkit.plugins.drives.odometry import planar_covariance
from simkit.plugins.drives.odometry_messages import (
    ODOMETRY,
    TRANSFORMS,
    BodyTwist,
    LatePose,
    PlanarPose,
    odometry_message,
    transforms,
)
from simkit.plugins.joint_states import JOINT_STATE, joint_readings, joint_state_message
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.plugins.options import Options
from simkit.pose import Pose, Vector

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin
    from simkit.scene import SceneJoint


class DriveOutputOptions(Options):
    """Options that select and name the outputs of a drive; an element that a drive does not have is a constant.

    Attributes:
        odometry_topic: Name of the odometry topic.
        odometry_frame: Frame of the odometry, parent of its transform.
        robot_base_frame: Frame of the robot's base, child of the odometry's transform.
        publish_odom: True to publish odometry.
        publish_odom_tf: True to publish the transform of the odometry.
        publish_wheel_tf: True to publish the transforms of the joints' child links.
        publish_wheel_joint_state: True to publish joint states.
        covariance_x: Variance of x [m²].
        covariance_y: Variance of y [m²].
        covariance_yaw: Variance of the yaw [rad²].
        is_level: True if the height in the odometry is 0.
    """

    odometry_topic: str = "odom"
    odometry_frame: str
    robot_base_frame: str
    publish_odom: bool = True
    publish_odom_tf: bool
    publish_wheel_tf: bool = False
    publish_wheel_joint_state: bool = False
    covariance_x: float = 1e-5
    covariance_y: float = 1e-5
    covariance_yaw: float = 1e-3
    is_level: ClassVar[bool] = False

    @property
    def publishes_odom_tf(self) -> bool:
        """True if the odometry is published as a transform."""
        return self.publish_odom_tf


class DriveOutputs(SharedByCopies):
    """Publishers of one drive. A deep copy returns the same object, because there is no state to copy.

    Args:
        plugin: Drive that publishes; its `load` creates this object.
        options: Selection and names of the outputs.
        joints: Joints whose transforms and states are published.
        present_pose: Function that returns the present pose of the base in the odometry frame.
    """

    def __init__(
        self,
        plugin: Plugin,
        options: DriveOutputOptions,
        joints: Sequence[SceneJoint],
        present_pose: Callable[[], LatePose],
    ) -> None:
        self._sim, self._options = plugin.sim, options
        self._links = [(joint.parent_link, joint.child_link) for joint in joints]
        self._joints = [plugin.sim.joint(joint.scoped) for joint in joints]
        self._covariance = planar_covariance(options.covariance_x, options.covariance_y, options.covariance_yaw)
        self._odom = plugin.advertise(options.odometry_topic, ODOMETRY) if options.publish_odom else None
        has_tf = options.publishes_odom_tf or options.publish_wheel_tf
        self._tf = plugin.advertise("/tf", TRANSFORMS) if has_tf else None
        if self._tf is not None:
            self._tf.present = lambda: transforms(self._sim.time_ns, *self._links_with(present_pose()))
        self._states = plugin.advertise("joint_states", JOINT_STATE) if options.publish_wheel_joint_state else None

    @property
    def odometry_topic(self) -> str:
        """Topic of the odometry; empty if it is not published."""
        return "" if self._odom is None else self._odom.topic

    @property
    def wants_odometry(self) -> bool:
        """True while the odometry or transform topic has a subscriber."""
        odom, tf = self._odom, self._tf
        return (odom is not None and odom.wanted) or (tf is not None and tf.wanted)

    def tell(self, pose: LatePose, twist: BodyTwist, *covariances: Vector) -> None:
        """Publish odometry and transforms.

        Args:
            pose: Pose of the base in the odometry frame, or a function that returns this pose at any later time.
            twist: Twist in the axes of the base.
            covariances: Covariances of the pose and of the twist; none for the variances of the options.
        """
        now = self._sim.time_ns
        if self._odom is not None and self._odom.wanted:
            options, level = self._options, pose
            if options.is_level and not isinstance(pose, PlanarPose):
                level = partial(_level, pose)
            frames = options.odometry_frame, options.robot_base_frame
            spread = covariances or (self._covariance,)
            self._odom.publish_later(partial(odometry_message, now, *frames, level, twist, *spread))
        if self._tf is not None and self._tf.wanted:
            self._tf.publish_later(partial(transforms, now, *self._links_with(pose)))

    def _links_with(self, pose: LatePose) -> list[tuple[str, str, LatePose]]:
        """Return the parent frame, the child frame and the pose of the base and of each published joint."""
        options = self._options
        transforms = [(options.odometry_frame, options.robot_base_frame, pose)] if options.publishes_odom_tf else []
        for above, below in self._links if options.publish_wheel_tf else ():
            parent, child = self._sim.link(above), self._sim.link(below)
            transforms.append((parent.name, child.name, parent.pose.inverse() @ child.pose))
        return transforms

    def tell_joints(self) -> None:
        """Publish joint states."""
        if self._states is not None and self._states.wanted:
            self._states.publish_later(partial(joint_state_message, self._sim.time_ns, joint_readings(self._joints)))


def _level(pose: LatePose) -> Pose:
    """Return a pose with the height 0."""
    pose = pose() if callable(pose) else pose
    return Pose((*pose.position[:2], 0.0), pose.quaternion)
