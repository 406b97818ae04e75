"""Servers of interactive markers.

Changes of markers are collected until `applyChanges`. Feedback comes from a program that shows the markers, such as
RViz.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Final

from simkit_nodes.host import current_host
from simkit_nodes.interfaces import ROS2, MessageFlavour, ProgramMessage, interface_module
from simkit_nodes.ros_modules.rclpy.qos import QoSProfile

__all__ = ["InteractiveMarkerServer"]

Feedback = Callable[[Any], object]

_OTHER_CLIENT_NS: Final = 1_000_000_000
"""Time for which the feedback of a second client about the same marker is ignored [ns]."""


@dataclass
class _Marker:
    """Marker with the functions for its feedback, by type; `DEFAULT_FEEDBACK_CB` for all other types."""

    marker: ProgramMessage
    callbacks: dict[int, Feedback] = field(default_factory=dict)
    client: str = ""
    feedback_ns: int = 0


@dataclass
class _Change:
    """Change of a marker that is not applied: a new marker, a new pose and header, or none of both to erase it."""

    marker: ProgramMessage = None
    pose: tuple[Any, Any] | None = None
    callbacks: dict[int, Feedback] = field(default_factory=dict)


class MarkerServer:
    """Interactive markers of a program; a base of the servers of ROS 1 and ROS 2."""

    DEFAULT_FEEDBACK_CB = 255

    _flavour: MessageFlavour

    def __init__(self) -> None:
        self.seq_num = 0
        self._markers: dict[str, _Marker] = {}
        self._changes: dict[str, _Change] = {}

    def _publish(self, update: ProgramMessage) -> None:
        """Publish an `InteractiveMarkerUpdate`."""
        raise NotImplementedError

    def _message(self, name: str) -> Any:
        return self._flavour.message_class(f"visualization_msgs/msg/{name}")()

    def _insert(self, marker: ProgramMessage) -> None:
        self._changes.setdefault(marker.name, _Change()).marker = marker

    def setPose(self, name: str, pose: ProgramMessage, header: ProgramMessage = None) -> bool:
        """Change the pose of a marker.

        Args:
            name: name of the marker.
            pose: `geometry_msgs.msg.Pose`.
            header: header; the present one if it has no frame.

        Returns:
            False if there is no such marker, or if it is new.
        """
        change, known = self._changes.get(name), self._markers.get(name)
        if known is None or (change is not None and change.marker is not None):
            return False
        keeps_header = header is None or not header.frame_id
        self._set_pose(name, pose, known.marker.header if keeps_header else header)
        return True

    def _set_pose(self, name: str, pose: ProgramMessage, header: ProgramMessage) -> None:
        change = self._changes.setdefault(name, _Change())
        if change.marker is None:
            change.pose = (pose, header)
        else:
            change.marker.pose, change.marker.header = pose, header

    def erase(self, name: str) -> bool:
        """Erase a marker; return False if there is no such marker."""
        if name not in self._changes and name not in self._markers:
            return False
        self._changes[name] = _Change()
        return True

    def clear(self) -> None:
        """Erase all markers."""
        self._changes = {name: _Change() for name in self._markers}

    def setCallback(self, name: str, feedback_callback: Any, feedback_type: int = DEFAULT_FEEDBACK_CB) -> bool:
        """Set the function that receives the feedback about a marker.

        Args:
            name: name of the marker.
            feedback_callback: function of an `InteractiveMarkerFeedback`; None for no function.
            feedback_type: type of the feedback; the default is for types that have no function.

        Returns:
            False if there is no such marker.
        """
        places = [place for place in (self._markers.get(name), self._changes.get(name)) if place is not None]
        for place in places:
            if feedback_callback is None:
                place.callbacks.pop(feedback_type, None)
            else:
                place.callbacks[feedback_type] = feedback_callback
        return bool(places)

    def applyChanges(self) -> None:
        """Apply all changes and publish them."""
        if not self._changes:
            return
        changes, self._changes = self._changes, {}
        update = self._message("InteractiveMarkerUpdate")
        update.type = update.UPDATE
        for name, change in changes.items():
            if change.marker is not None:
                known = self._markers.setdefault(name, _Marker(change.marker, change.callbacks))
                known.marker = change.marker
                update.markers.append(change.marker)
            elif change.pose is not None:
                marker = self._markers[name].marker
                marker.pose, marker.header = change.pose
                pose = self._message("InteractiveMarkerPose")
                pose.header, pose.pose, pose.name = marker.header, marker.pose, marker.name
                update.poses.append(pose)
            elif self._markers.pop(name, None) is not None:
                update.erases.append(name)
        self.seq_num += 1
        update.seq_num = self.seq_num
        self._publish(update)

    def get(self, name: str) -> Any:
        """Return a marker with its changes; None if there is none or if it is erased."""
        change, known = self._changes.get(name), self._markers.get(name)
        if change is None or known is None:
            return known.marker if known is not None else change.marker if change is not None else None
        if change.pose is not None:
            known.marker.pose = change.pose[0]
            return known.marker
        return change.marker

    def processFeedback(self, feedback: ProgramMessage) -> None:
        """Apply the pose of a feedback, and call its function."""
        known = self._markers.get(feedback.marker_name)
        if known is None:
            return
        now = current_host().now_ns()
        if known.client not in ("", feedback.client_id) and now - known.feedback_ns < _OTHER_CLIENT_NS:
            return
        known.client, known.feedback_ns = feedback.client_id, now
        if feedback.event_type == feedback.POSE_UPDATE:
            stamp = known.marker.header.stamp
            has_stamp = stamp != type(stamp)()
            self._set_pose(known.marker.name, feedback.pose, feedback.header if has_stamp else known.marker.header)
        default = known.callbacks.get(self.DEFAULT_FEEDBACK_CB)
        callback = known.callbacks.get(feedback.event_type, default)
        if callback is not None:
            callback(feedback)
        self.applyChanges()


class InteractiveMarkerServer(MarkerServer):
    """Server of interactive markers: a service and two topics in a namespace.

    Args:
        node: node of the topics.
        namespace: namespace of the topics.
        update_pub_qos: QoS of the topic with changes.
        feedback_sub_qos: QoS of the topic with feedback.
    """

    DEFAULT_FEEDBACK_CALLBACK = MarkerServer.DEFAULT_FEEDBACK_CB

    _flavour = ROS2

    def __init__(
        self,
        node: Any,
        namespace: str,
        *,
        update_pub_qos: QoSProfile | None = None,
        feedback_sub_qos: QoSProfile | None = None,
    ) -> None:
        super().__init__()
        self.node, self.namespace = node, namespace
        services: Any = interface_module("visualization_msgs.srv", ROS2)
        messages: Any = interface_module("visualization_msgs.msg", ROS2)
        self._service = node.create_service(
            services.GetInteractiveMarkers, f"{namespace}/get_interactive_markers", self._answer
        )
        self._updates = node.create_publisher(
            messages.InteractiveMarkerUpdate, f"{namespace}/update", update_pub_qos or QoSProfile(depth=100)
        )
        self._feedback = node.create_subscription(
            messages.InteractiveMarkerFeedback,
            f"{namespace}/feedback",
            self.processFeedback,
            feedback_sub_qos or QoSProfile(depth=1),
        )

    def _publish(self, update: ProgramMessage) -> None:
        self._updates.publish(update)

    def _answer(self, request: ProgramMessage, response: ProgramMessage) -> Any:
        response.sequence_number = self.seq_num
        response.markers = [known.marker for known in self._markers.values()]
        return response

    def insert(
        self,
        marker: ProgramMessage,
        *,
        feedback_callback: Feedback | None = None,
        feedback_type: int = MarkerServer.DEFAULT_FEEDBACK_CB,
    ) -> None:
        """Add a marker, or replace the one of the same name; see `setCallback` for the other arguments."""
        self._insert(marker)
        if feedback_callback is not None:
            self.setCallback(marker.name, feedback_callback, feedback_type)

    def shutdown(self) -> None:
        """Erase all markers, and close the service and the topics."""
        if self.node.context.ok():
            self.clear()
            self.applyChanges()
        self.node.destroy_service(self._service)
        self.node.destroy_publisher(self._updates)
        self.node.destroy_subscription(self._feedback)
