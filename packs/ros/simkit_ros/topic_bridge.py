"""Topics of a simulation in ROS, in both directions. Messages pass as CDR without being decoded."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from simkit.bridges.live.protocol import LiveError
from simkit.bridges.simulation_link import SimulationLink, text_message
from simkit_ros.ros_session import Qos, RosSession, SubscriptionEnd, publisher_qos
from simkit_ros.ros_types import RosType

if TYPE_CHECKING:
    from rclpy.subscription import Subscription

Report = Callable[[str], None]
"""Callback for a note to the user."""
_MESSAGES_PER_TURN = 200  # messages that are read from one topic before the turn of the next topic


class OutgoingTopic:
    """Topic that the simulation publishes. The bridge subscribes to it only while ROS has subscriptions.

    Args:
        link: connection to the simulation.
        session: session of ROS.
        topic: name in the simulation.
        name: name in ROS.
        ros_type: type of the messages.
        is_latched: True if later subscriptions receive the last message.
        report: callback for a note to the user.

    Attributes:
        count: number of messages that were passed on.
    """

    def __init__(
        self,
        link: SimulationLink,
        session: RosSession,
        topic: str,
        name: str,
        ros_type: RosType,
        is_latched: bool,
        report: Report,
    ) -> None:
        self._link, self.topic, self.ros_type, self._is_latched = link, topic, ros_type, is_latched
        self._session, self._report = session, report
        self._publisher = session.advertise(name, ros_type, publisher_qos(topic, ros_type.name, is_latched=is_latched))
        self._number: int | None = None
        self._is_failed = False
        self.count = 0

    def look(self) -> None:
        """Subscribe to the topic in the simulation if ROS has subscriptions, else unsubscribe."""
        is_wanted = not self._is_failed and (self._is_latched or self._publisher.get_subscription_count() > 0)
        if is_wanted and self._number is None:
            self._number = self._link.subscribe(self.topic, self._take, self._fail)
        elif not is_wanted and self._number is not None:
            self._link.unsubscribe(self._number)
            self._number = None

    def _take(self, time_ns: int, type_name: str, data: bytes, lost: int) -> None:
        if type_name == self.ros_type.name:
            self.count += 1
            self._publisher.publish(data)

    def _fail(self, error: LiveError) -> None:
        self._is_failed, self._number = True, None
        self._report(f"{self.topic} has no messages: {error}")

    def flush(self, seconds: float) -> None:
        """Wait until every reliable subscription has the messages, or until the time has passed."""
        from rclpy.duration import Duration

        self._publisher.wait_for_all_acked(Duration(seconds=seconds))

    def close(self) -> None:
        """Close the topic in ROS and in the simulation."""
        if self._number is not None:
            self._link.unsubscribe(self._number)
        self._session.node.destroy_publisher(self._publisher)


class IncomingTopic:
    """Topic that the simulation takes; messages from ROS are published in the simulation.

    Args:
        link: connection to the simulation.
        session: session of ROS; its thread must be stopped while a topic is opened or closed.
        topic: name in the simulation.
        name: name in ROS.
        ros_type: type of the messages.
        qos: quality of service of the subscription.
        report: callback for a note to the user.
    """

    def __init__(
        self,
        link: SimulationLink,
        session: RosSession,
        topic: str,
        name: str,
        ros_type: RosType,
        qos: Qos,
        report: Report,
    ) -> None:
        self._link, self._session, self.topic, self.ros_type, self.qos = link, session, topic, ros_type, qos
        self._report = report
        self._end: SubscriptionEnd = session.subscribe(name, ros_type, qos)
        self._number: int | None = None
        self._is_closed = False
        link.advertise(topic, ros_type.name, self._open, lambda error: report(f"{topic} takes nothing: {error}"))

    @property
    def subscription(self) -> Subscription:
        """Subscription of rclpy."""
        return self._end.subscription

    def _open(self, number: int) -> None:
        self._number = number
        if self._is_closed:
            self._link.unadvertise(number)

    def take(self) -> None:
        """Publish the messages that have arrived; those that arrive before the topic is open are dropped."""
        for _ in range(_MESSAGES_PER_TURN):
            data = self._end.take()
            if data is None:
                return
            if self._number is not None and data:  # a taken message may be empty
                self._link.publish(self._number, data)

    def close(self) -> None:
        """Close the topic in ROS and in the simulation."""
        self._is_closed = True
        if self._number is not None:
            self._link.unadvertise(self._number)
        self._session.node.destroy_subscription(self.subscription)


class RobotDescription:
    """Latched topic with the URDF of a robot, which the simulation itself does not publish.

    Args:
        link: connection to the simulation.
        session: session of ROS.
        name: name of the topic in ROS.
        robot: name of the model.
    """

    def __init__(self, link: SimulationLink, session: RosSession, name: str, robot: str) -> None:
        self.robot, self._session = robot, session
        self._publisher = session.advertise(
            name, session.types.find("std_msgs/msg/String"), Qos(is_latched=True, depth=1)
        )
        self._is_closed = False
        link.ask("robot_description", {"name": robot}, then=self._publish)

    def _publish(self, text: str, _: bytes) -> None:
        if not self._is_closed:
            self._publisher.publish(text_message(text))

    def close(self) -> None:
        """Close the topic in ROS."""
        self._is_closed = True
        self._session.node.destroy_publisher(self._publisher)
