"""Topics on which controllers show their work, as Nav2's controllers name them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

import numpy as np

from simkit import Plugin, msgs
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose, path_message

_PATH: Final = "nav_msgs/msg/Path"
_POINT: Final = "geometry_msgs/msg/PointStamped"
_MARKERS: Final = "visualization_msgs/msg/MarkerArray"
TOPICS: Final = {
    "received_global_plan": _PATH,
    "transformed_global_plan": _PATH,
    "local_plan": _PATH,
    "optimal_trajectory": _PATH,
    "lookahead_point": _POINT,
    "trajectories": _MARKERS,
}
"""Type of each topic."""


class ControllerTopics(Plugin):
    """Plugin whose controllers publish paths, points and markers in the frame of the costmap."""

    def open_topics(self, topics: Iterable[str]) -> None:
        """Open the publishers of some of the topics."""
        self._publishers = {topic: self.advertise(topic, TOPICS[topic]) for topic in dict.fromkeys(topics)}
        self.place_topics("", None)

    def place_topics(self, frame: str, costmap: PlanarPose | None) -> None:
        """Set the frame of the messages.

        Args:
            frame: name of the frame.
            costmap: pose of this frame in the frame of the path; None if both are the same.
        """
        self._topic_frame = frame
        self._to_topic_frame = PlanarPose(0.0, 0.0, 0.0) if costmap is None else costmap.inverse()

    def wants_path(self, topic: str) -> bool:
        """Check whether a topic of paths has subscribers."""
        publisher = self._publishers.get(topic)
        return publisher is not None and publisher.wanted

    wants_markers = wants_path

    def publish_path(self, topic: str, poses: Floats) -> None:
        """Publish poses in the frame of the path, shape (n, 3), if the topic has subscribers."""
        if self.wants_path(topic):
            moved = np.column_stack(
                (self._to_topic_frame.transform(poses[:, :2]), poses[:, 2] + self._to_topic_frame.yaw)
            )
            header = msgs.header(self.sim.time_ns, self._topic_frame)
            self._publishers[topic].publish(path_message(moved, header))

    def publish_point(self, topic: str, point: Floats) -> None:
        """Publish a point in the frame of the path, shape (1, 2), if the topic has subscribers."""
        if self.wants_path(topic):
            x, y = self._to_topic_frame.transform(point)[0].tolist()
            header = msgs.header(self.sim.time_ns, self._topic_frame)
            self._publishers[topic].publish(msgs.make(_POINT, header=header, point={"x": x, "y": y}))

    def publish_markers(self, topic: str, markers: list[dict[str, Any]]) -> None:
        """Publish the fields of markers whose poses are in the frame of the path."""
        places = np.array([[m["pose"]["position"][axis] for axis in ("x", "y")] for m in markers]).reshape(-1, 2)
        header = msgs.header(self.sim.time_ns, self._topic_frame)
        for marker, (x, y) in zip(markers, self._to_topic_frame.transform(places).tolist(), strict=True):
            marker["header"] = header
            marker["pose"]["position"].update(x=x, y=y)
        self._publishers[topic].publish(msgs.make(_MARKERS, markers=markers))
