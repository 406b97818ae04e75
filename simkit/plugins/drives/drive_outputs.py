"""Publish odometry, transforms and joint states of Gazebo Classic's drives, each where the file asks for it."""

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
from simkit.pose import Pose

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin
    from simkit.scene import SceneJoint


@dataclass(frozen=True, slots=True)
class DriveOutputOptions:
    """What goes out.

    Attributes:
        odometry_topic: name of the odometry's topic.
        odometry_frame, base_frame: of the odometry and its transform.
        odometry, odometry_tf, wheel_tf, joint_states: whether they go out.
        covariance: variances of x, y [m²] and yaw [rad²].
    """

    odometry_topic: str
    odometry_frame: str
    base_frame: str
    odometry: bool
    odometry_tf: bool
    wheel_tf: bool
    joint_states: bool
    covariance: tuple[float, float, float]


class DriveOutputs:
    """The publishers of one drive; a handle, without state of its own.

    Args:
        plugin: whose they are; to be made in its `load`.
        told: what goes out.
        joints: whose transforms and states are told.
    """

    def __init__(self, plugin: Plugin, told: DriveOutputOptions, joints: Sequence[SceneJoint]) -> None:
        self._sim, self._told = plugin.sim, told
        self._links = [(joint.parent_link, joint.child_link) for joint in joints]
        self._joints = [plugin.sim.joint(joint.scoped) for joint in joints]
        self._covariance = planar_covariance(*told.covariance)
        self._odom = plugin.advertise(told.odometry_topic, ODOMETRY) if told.odometry else None
        self._tf = plugin.advertise("/tf", TRANSFORMS) if told.odometry_tf or told.wheel_tf else None
        self._states = plugin.advertise("joint_states", JOINT_STATE) if told.joint_states else None

    def __deepcopy__(self, memo: dict[int, object]) -> DriveOutputs:
        return self

    @property
    def wants_odometry(self) -> bool:
        """Whether anybody hears where the base is."""
        return any(out is not None and out.wanted for out in (self._odom, self._tf))

    def tell(self, pose: Pose, twist: BodyTwist) -> None:
        """Publishes odometry and transforms."""
        told, now = self._told, self._sim.time_ns
        frames = told.odometry_frame, told.base_frame
        if self._odom is not None and self._odom.wanted:
            self._odom.publish_later(partial(odometry_message, now, *frames, pose, twist, self._covariance))
        if self._tf is not None and self._tf.wanted:
            found = [(*frames, pose)] if told.odometry_tf else []
            for above, below in self._links if told.wheel_tf else ():
                parent, child = self._sim.link(above), self._sim.link(below)
                found.append((parent.name, child.name, parent.pose.inverse() @ child.pose))
            self._tf.publish_later(partial(transforms, now, *found))

    def tell_joints(self) -> None:
        """Publishes joint states."""
        if self._states is not None and self._states.wanted:
            self._states.publish_later(partial(joint_state_message, self._sim.time_ns, joint_readings(self._joints)))
