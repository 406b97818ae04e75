"""Publishers of the true motion of a drive: odometry without error, and the slip of its wheels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import msgs
from simkit.plugins.drives.odometry import TrueMotion
from simkit.plugins.drives.odometry_messages import ODOMETRY, odometry_message
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.runtime.contact.rim_slip import WheelSlip

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin
    from simkit.runtime import Model

WHEEL_MOTION: Final = "simkit_msgs/msg/WheelMotion"
_NUMBERS: Final = ("load", "rim_speed", "axle_speed", "slip", "ratio", "sideways")


class GroundTruth(SharedByCopies):
    """Publishers of the truth on `<prefix>ground_truth/odom` and `<prefix>ground_truth/wheel_slip`.

    Args:
        plugin: Drive that publishes; its `load` creates this object.
        parent: Model of the drive.
        true: True motion of the model.
        joints: Scoped names of the drive's wheel joints.
        prefix: Beginning of the names of the topics.
        child_frame: Frame of the base, for the odometry.
    """

    def __init__(
        self, plugin: Plugin, parent: Model, true: TrueMotion, joints: Sequence[str], prefix: str, child_frame: str
    ) -> None:
        self._sim, self._model, self._true, self._child = plugin.sim, parent.scoped, true, child_frame
        self._joints = list(joints)
        self._names = [joint.rpartition("::")[2] for joint in joints]
        self._odom = plugin.advertise(f"{prefix}ground_truth/odom", ODOMETRY)
        self._slip = plugin.advertise(f"{prefix}ground_truth/wheel_slip", WHEEL_MOTION)

    @property
    def odometry_topic(self) -> str:
        """Topic of the true odometry."""
        return self._odom.topic

    def publish(self) -> None:
        """Publish the present truth, if the topics have subscribers."""
        now = self._sim.time_ns
        if self._odom.wanted:
            self._odom.publish(odometry_message(now, "world", self._child, *self._true.state()))
        if self._slip.wanted:
            by_joint = {wheel.joint: wheel for wheel in self._sim.wheel_slips(self._model)}
            wheels = [by_joint.get(joint, WheelSlip(joint, "")) for joint in self._joints]
            columns = {name: np.array([getattr(wheel, name) for wheel in wheels]) for name in _NUMBERS}
            header = msgs.header(now, "world")
            self._slip.publish(msgs.make(WHEEL_MOTION, header=header, name=list(self._names), **columns))
