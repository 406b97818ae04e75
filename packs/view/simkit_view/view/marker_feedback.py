"""Feedback of pages to servers of interactive markers, as RViz publishes it."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from simkit import Pose
from simkit.bridges.live.request_fields import RequestRefused
from simkit.run_spec import JsonObject
from simkit_view.displays.interactive_marker_display import FEEDBACK, UPDATE, InteractiveMarkerDisplay, control_for

if TYPE_CHECKING:
    from simkit import Publisher, Simulation

TYPE: Final = "visualization_msgs/msg/InteractiveMarkerFeedback"
EVENTS: Final[Mapping[str, int]] = MappingProxyType(
    {"pose_update": 1, "menu_select": 2, "button_click": 3, "mouse_down": 4, "mouse_up": 5}
)
CLIENT: Final = "simkit page"


class MarkerFeedback:
    """Publishers of feedback, one for each server.

    Args:
        sim: simulation with the servers.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self._publishers: dict[str, Publisher] = {}

    def send(self, display: InteractiveMarkerDisplay, name: str, event: str, pose: Pose, entry: int = 0) -> str:
        """Publish an event of a marker, and return the topic.

        Args:
            display: display of the marker's server.
            name: name of the marker.
            event: one of `EVENTS`.
            pose: pose of the marker in the world.
            entry: number of the entry of the menu.

        Raises:
            RequestRefused: the event or the marker is unknown.
        """
        if event not in EVENTS:
            raise RequestRefused(f"'event' must be one of {', '.join(EVENTS)}, got {event!r:.80}")
        found = display.pose_in_frame(name, pose)
        if found is None:
            raise RequestRefused(f"{display.topic!r} has no marker {name!r:.80} with a known frame")
        marker, frame, placed = found
        sim, topic = self._sim, display.topic.removesuffix(UPDATE) + FEEDBACK
        if topic not in self._publishers:
            self._publishers[topic] = sim.advertise(topic, TYPE)
        w, x, y, z = placed.quaternion.tolist()
        pose_message: JsonObject = {
            "position": dict(zip("xyz", placed.position.tolist(), strict=True)),
            "orientation": {"x": x, "y": y, "z": z, "w": w},
        }
        stamp = {"sec": sim.time_ns // 1_000_000_000, "nanosec": sim.time_ns % 1_000_000_000}
        self._publishers[topic].publish(
            {
                "header": {"frame_id": frame, "stamp": stamp},
                "client_id": CLIENT,
                "marker_name": name,
                "control_name": control_for(marker, event),
                "event_type": EVENTS[event],
                "pose": pose_message,
                "menu_entry_id": entry,
            }
        )
        return topic
