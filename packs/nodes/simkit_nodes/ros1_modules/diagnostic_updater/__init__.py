"""Reports about the health of a node on `/diagnostics`, as the ROS 1 package `diagnostic_updater`."""

from __future__ import annotations

from typing import Any

from simkit_nodes.interfaces import ROS1, ProgramMessage
from simkit_nodes.ros1_modules import rospy
from simkit_nodes.ros1_modules.rospy import log
from simkit_nodes.ros_modules.diagnostic_updater import tasks
from simkit_nodes.ros_modules.diagnostic_updater.tasks import *  # noqa: F403 - both packages have these names

__all__ = ["DiagnosedPublisher", "DiagnosticStatusWrapper", "Updater", *tasks.__all__]

_DiagnosticArray = ROS1.message_class("diagnostic_msgs/msg/DiagnosticArray")
_DiagnosticStatus: Any = ROS1.message_class("diagnostic_msgs/msg/DiagnosticStatus")


class DiagnosticStatusWrapper(tasks.StatusFunctions, _DiagnosticStatus):  # type: ignore[misc]
    """Status with functions to fill it in."""

    _key_value = ROS1.message_class("diagnostic_msgs/msg/KeyValue")
    _converts_values = True


class Updater(tasks.DiagnosticTaskVector):
    """Tasks whose statuses `update` publishes on `/diagnostics`, at most once in `~diagnostic_period` [s]."""

    def __init__(self) -> None:
        super().__init__()
        self.publisher = rospy.Publisher("/diagnostics", _DiagnosticArray, queue_size=10)
        self.last_time, self.verbose, self.hwid = rospy.Time.now(), False, ""
        self._has_warned = False

    @property
    def period(self) -> float:
        """Period [s]."""
        return rospy.get_param("~diagnostic_period", 1)  # type: ignore[no-any-return]

    def setHardwareID(self, hwid: str) -> None:
        """Set the name of the hardware."""
        self.hwid = hwid

    def update(self) -> None:
        """Run all tasks and publish their statuses, if the period has passed."""
        if rospy.Time.now() >= self.last_time + rospy.Duration(self.period):
            self.force_update()

    def force_update(self) -> None:
        """Run all tasks and publish their statuses."""
        self.last_time = rospy.Time.now()
        statuses = self.statuses(DiagnosticStatusWrapper, self.hwid)
        not_ok = [status for status in statuses if status.level != status.OK]
        for status in not_ok if self.verbose else ():
            log.logwarn(
                "Non-zero diagnostic status. Name: '%s', status %i: '%s'", status.name, status.level, status.message
            )
        if not self.hwid and not not_ok and not self._has_warned:
            log.logwarn("diagnostic_updater: No HW_ID was set. For devices without one, set it to 'none'.")
            self._has_warned = True
        self.publish(statuses)

    def broadcast(self, lvl: int, msg: str) -> None:
        """Publish the same level and message for all tasks."""
        self.publish(self.equal_statuses(DiagnosticStatusWrapper, lvl, msg))

    def publish(self, msg: ProgramMessage) -> None:
        """Publish a status, or a list of them."""
        statuses = msg if isinstance(msg, list) else [msg]
        for status in statuses:
            status.name = f"{rospy.get_name()[1:]}: {status.name}"
        array = _DiagnosticArray(status=statuses)
        array.header.stamp = rospy.Time.now()
        self.publisher.publish(array)

    def addedTaskCallback(self, task: tasks.FunctionDiagnosticTask) -> None:
        """Report a new task."""
        status: Any = DiagnosticStatusWrapper(name=task.name)
        status.summary(status.OK, "Node starting up")
        self.publish(status)


class DiagnosedPublisher(tasks.TopicDiagnostic):
    """Publisher whose rate and stamps are checked.

    Args:
        pub: publisher of messages with a header.
        diag: updater.
        freq: limits of the rate.
        stamp: limits of the age.
    """

    def __init__(
        self, pub: Any, diag: Updater, freq: tasks.FrequencyStatusParam, stamp: tasks.TimeStampStatusParam
    ) -> None:
        super().__init__(pub.name, diag, freq, stamp)
        self.publisher = pub

    def publish(self, message: ProgramMessage) -> None:
        """Publish a message."""
        self.tick(message.header.stamp)
        self.publisher.publish(message)
