"""Servers of interactive markers."""

from __future__ import annotations

from simkit_nodes.interfaces import ROS1, ProgramMessage
from simkit_nodes.ros1_modules import rospy
from simkit_nodes.ros_modules.interactive_markers.interactive_marker_server import Feedback, MarkerServer

__all__ = [
    "Header",
    "InteractiveMarker",
    "InteractiveMarkerFeedback",
    "InteractiveMarkerInit",
    "InteractiveMarkerPose",
    "InteractiveMarkerServer",
    "InteractiveMarkerUpdate",
    "rospy",
]

Header = ROS1.message_class("std_msgs/msg/Header")
InteractiveMarker = ROS1.message_class("visualization_msgs/msg/InteractiveMarker")
InteractiveMarkerFeedback = ROS1.message_class("visualization_msgs/msg/InteractiveMarkerFeedback")
InteractiveMarkerInit = ROS1.message_class("visualization_msgs/msg/InteractiveMarkerInit")
InteractiveMarkerPose = ROS1.message_class("visualization_msgs/msg/InteractiveMarkerPose")
InteractiveMarkerUpdate = ROS1.message_class("visualization_msgs/msg/InteractiveMarkerUpdate")

_KEEP_ALIVE_PERIOD = 0.5  # [s]


class InteractiveMarkerServer(MarkerServer):
    """Server of interactive markers: topics in a namespace.

    Args:
        topic_ns: namespace of the topics.
        server_id: text after the name of the node in the name of the server.
        q_size: length of the queue of feedback.
    """

    _flavour = ROS1

    def __init__(self, topic_ns: str, server_id: str = "", q_size: int = 100) -> None:
        super().__init__()
        self.topic_ns, self.server_id = topic_ns, rospy.get_name() + server_id
        self._all = rospy.Publisher(f"{topic_ns}/update_full", InteractiveMarkerInit, latch=True, queue_size=100)
        self._updates = rospy.Publisher(f"{topic_ns}/update", InteractiveMarkerUpdate, queue_size=100)
        rospy.Subscriber(f"{topic_ns}/feedback", InteractiveMarkerFeedback, self.processFeedback, queue_size=q_size)
        rospy.Timer(rospy.Duration(_KEEP_ALIVE_PERIOD), self._keep_alive, reset=True)
        self._publish_all()

    def _publish(self, update: ProgramMessage) -> None:
        update.server_id = self.server_id
        self._updates.publish(update)
        self._publish_all()

    def _publish_all(self) -> None:
        markers = [known.marker for known in self._markers.values()]
        self._all.publish(InteractiveMarkerInit(self.server_id, self.seq_num, markers))

    def _keep_alive(self, _: object) -> None:
        update = InteractiveMarkerUpdate(server_id=self.server_id, seq_num=self.seq_num)
        update.type = update.KEEP_ALIVE
        self._updates.publish(update)

    def insert(
        self,
        marker: ProgramMessage,
        feedback_cb: Feedback | int = -1,
        feedback_type: int = MarkerServer.DEFAULT_FEEDBACK_CB,
    ) -> None:
        """Add a marker, or replace the one of the same name; see `setCallback` for the other arguments."""
        self._insert(marker)
        if feedback_cb != -1:
            self.setCallback(marker.name, feedback_cb, feedback_type)

    def getNames(self) -> list[str]:
        """Return the names of all markers."""
        return list(self._markers)
