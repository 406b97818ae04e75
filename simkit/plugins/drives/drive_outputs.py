"""Publishers of Gazebo Classic's drives: odometry, transforms and joint states, as the plugin's options select."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from simkit.plugins.drives.odometry import (
    ODOMETRY,
    TRANSFORMS,
    BodyTwist,
    odometry_message,
    planar_covariance,
    transforms,
)
from simkit.plugins.joint_states import JOINT_STATE, joint_readings, joint_state_message
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.pose import Pose

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin
    from simkit.scene import SceneJoint


@dataclass(frozen=True, slots=True)
class DriveOutputOptions:
    """Selection and names of the outputs of a drive.

    Attributes:
        odometry_topic: Name of the odometry topic.
        odometry_frame: Frame of the odometry, parent of its transform.
        base_frame: Frame of the robot's base, child of the odometry's transform.
        odometry: True to publish odometry.
        odometry_tf: True to publish the transform of the odometry.
        wheel_tf: True to publish the transforms of the joints' child links.
        joint_states: True to publish joint states.
        covariance: Variances of x, y [m²] and yaw [rad²].
    """

    odometry_topic: str
    odometry_frame: str
    base_frame: str
    odometry: bool
    odometry_tf: bool
    wheel_tf: bool
    joint_states: bool
    covariance: tuple[float, float, float]


class DriveOutputs(SharedByCopies):
    """Publishers of one drive. A deep copy returns the same object, because there is no state to copy.

    Args:
        plugin: Drive that publishes; its `load` creates this object.
        options: Selected outputs.
        joints: Joints whose transforms and states are published.
    """

    def __init__(self, plugin: Plugin, options: DriveOutputOptions, joints: Sequence[SceneJoint]) -> None:
        self._sim, self._options = plugin.sim, options
        self._links = [(joint.parent_link, joint.child_link) for joint in joints]
        self._joints = [plugin.sim.joint(joint.scoped) for joint in joints]
        self._covariance = planar_covariance(*options.covariance)
        self._odom = plugin.advertise(options.odometry_topic, ODOMETRY) if options.odometry else None
        self._tf = plugin.advertise("/tf", TRANSFORMS) if options.odometry_tf or options.wheel_tf else None
        self._states = plugin.advertise("joint_states", JOINT_STATE) if options.joint_states else None

    @property
    def wants_odometry(self) -> bool:
        """True while the odometry or transform topic has a subscriber."""
        return any(out is not None and out.wanted for out in (self._odom, self._tf))

    def tell(self, pose: Pose, twist: BodyTwist) -> None:
        """Publish odometry and transforms.

        Args:
            pose: Pose of the base in the odometry frame.
            twist: Twist in the axes of the base.
        """
        options, now = self._options, self._sim.time_ns
        frames = options.odometry_frame, options.base_frame
        if self._odom is not None and self._odom.wanted:
            self._odom.publish_later(partial(odometry_message, now, *frames, pose, twist, self._covariance))
        if self._tf is not None and self._tf.wanted:
            found = [(*frames, pose)] if options.odometry_tf else []
            for above, below in self._links if options.wheel_tf else ():
                parent, child = self._sim.link(above), self._sim.link(below)
                found.append((parent.name, child.name, parent.pose.inverse() @ child.pose))
            self._tf.publish_later(partial(transforms, now, *found))

    def tell_joints(self) -> None:
        """Publish joint states."""
        if self._states is not None and self._states.wanted:
            self._states.publish_later(partial(joint_state_message, self._sim.time_ns, joint_readings(self._joints)))
