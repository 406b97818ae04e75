"""Reports about the health of a node on `/diagnostics`, as the ROS 2 package `diagnostic_updater`."""

from __future__ import annotations

from typing import Any

from simkit_nodes.interfaces import ROS2, ProgramMessage
from simkit_nodes.ros_modules.diagnostic_updater import tasks
from simkit_nodes.ros_modules.diagnostic_updater.tasks import *  # noqa: F403 - both packages have these names
from simkit_nodes.ros_modules.rclpy.time import Time

__all__ = ["DiagnosedPublisher", "DiagnosticStatusWrapper", "Updater", *tasks.__all__]

_DiagnosticArray = ROS2.message_class("diagnostic_msgs/msg/DiagnosticArray")
_DiagnosticStatus: Any = ROS2.message_class("diagnostic_msgs/msg/DiagnosticStatus")


class DiagnosticStatusWrapper(tasks.StatusFunctions, _DiagnosticStatus):  # type: ignore[misc]
    """Status with functions to fill it in."""

    _key_value = ROS2.message_class("diagnostic_msgs/msg/KeyValue")
    _converts_values = False


class Updater(tasks.DiagnosticTaskVector):
    """Tasks that run at a period, and whose statuses are published on `/diagnostics`.

    Args:
        node: node.
        period: period [s], if the parameter `diagnostic_updater.period` has no value.
    """

    def __init__(self, node: Any, period: float = 1.0) -> None:
        super().__init__()
        self.node, self.verbose, self.hwid = node, False, ""
        self.publisher = node.create_publisher(_DiagnosticArray, "/diagnostics", 1)
        self._period = node.declare_parameter("diagnostic_updater.period", period).value
        self.timer = node.create_timer(self._period, self.update)
        if not node.has_parameter("diagnostic_updater.use_fqn"):
            node.declare_parameter("diagnostic_updater.use_fqn", False)
        uses_namespace = node.get_parameter("diagnostic_updater.use_fqn").value
        self.node_name = f"{node.get_namespace()}/{node.get_name()}" if uses_namespace else node.get_name()
        self._has_warned = False

    @property
    def period(self) -> float:
        """Period [s]."""
        return self._period  # type: ignore[no-any-return]

    @period.setter
    def period(self, value: float) -> None:
        self._period = value
        self.node.destroy_timer(self.timer)
        self.timer = self.node.create_timer(value, self.update)

    def setHardwareID(self, hwid: str) -> None:
        """Set the name of the hardware."""
        self.hwid = hwid

    def update(self) -> None:
        """Run all tasks and publish their statuses."""
        statuses, log = self.statuses(DiagnosticStatusWrapper, self.hwid), self.node.get_logger()
        not_ok = [status for status in statuses if status.level != status.OK]
        for status in not_ok if self.verbose else ():
            log.warning(f"Non-zero diagnostic status. Name: {status.name}, status {status.level}: {status.message}")
        if not self.hwid and not not_ok and not self._has_warned:
            log.warning("diagnostic_updater: No HW_ID was set. For devices without one, set it to none.")
            self._has_warned = True
        self.publish(statuses)

    force_update = update

    def broadcast(self, lvl: Any, msg: str) -> None:
        """Publish the same level and message for all tasks."""
        self.publish(self.equal_statuses(DiagnosticStatusWrapper, lvl, msg))

    def publish(self, msg: ProgramMessage) -> None:
        """Publish a status, or a list of them."""
        array = _DiagnosticArray()
        array.header.stamp = self.node.get_clock().now().to_msg()
        for status in msg if isinstance(msg, list) else [msg]:
            status.name = f"{self.node_name}: {status.name}"
            fields = ("level", "name", "message", "hardware_id", "values")
            array.status.append(_DiagnosticStatus(**{field: getattr(status, field) for field in fields}))
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
        super().__init__(pub.topic_name, diag, freq, stamp)
        self.publisher = pub

    def publish(self, message: ProgramMessage) -> None:
        """Publish a message."""
        self.tick(Time.from_msg(message.header.stamp))
        self.publisher.publish(message)
