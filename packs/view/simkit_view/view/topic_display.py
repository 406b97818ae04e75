"""Streams of displays: the list of topics that can be drawn, and the drawing of one topic of a running simulation."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.msgs import Message
from simkit.runtime.communication.transform_buffer import TransformBuffer
from simkit_view.displays.display import Display
from simkit_view.displays.drawing import Drawing
from simkit_view.displays.frame_poses import FramePoses
from simkit_view.displays.grid_displays import UPDATES, GridDisplay
from simkit_view.displays.interactive_marker_display import InteractiveMarkerDisplay
from simkit_view.displays.kinds import DISPLAYS, SimulationTools
from simkit_view.view.packet import make_packet

if TYPE_CHECKING:
    from simkit import Simulation, Subscription
    from simkit.runtime.communication.service_server import ServiceCall

_PERIOD: Final = 0.1  # [s] of wall time between two drawings of a topic
_INITIAL: Final = "visualization_msgs/srv/GetInteractiveMarkers_Request"
_MOST_WAITING: Final = 500  # messages between two looks; of more, the newest are drawn


def displayed_topics(sim: Simulation) -> dict[str, str]:
    """Return the type of each topic that has a display."""
    type_by_topic = sim.communication.bus.topics()
    return {topic: type_name for topic, type_name in type_by_topic.items() if type_name in DISPLAYS}


class DisplayList:
    """Topics that can be drawn: rows of topic and type."""

    def __init__(self, sim: Simulation, name: str) -> None:
        self._sim, self._seen = sim, -1

    def packet(self, options: Sequence[object]) -> bytes | None:
        """Return the rows, if topics were opened or closed."""
        bus = self._sim.communication.bus
        if bus.revision == self._seen:
            return None
        self._seen = bus.revision
        return make_packet({"kind": "displays", "topics": list(displayed_topics(self._sim).items())}, {})

    def close(self) -> None:
        """Nothing is open."""


class TopicDisplay:
    """Drawing of a topic; `display:TOPIC`. The topic may be opened later.

    A message is placed where its frame is when the page next looks for messages. Frames are known from links, sensors
    and `/tf`.
    """

    def __init__(self, sim: Simulation, name: str) -> None:
        self._sim, self._topic = sim, name
        self._display: Display | None = None
        self._tree = TransformBuffer(sim.communication.bus, lambda: sim.time_ns)
        self._frames = FramePoses(sim, self._tree)
        self._taps: list[Subscription] = []
        self._waiting: deque[tuple[Message, int]] = deque(maxlen=_MOST_WAITING)
        self._drawn_at, self._revision = 0.0, -1
        self._model: object = sim.mj_model
        self._initial: ServiceCall | None = None

    @property
    def display(self) -> Display | None:
        """Display of the topic; None until the topic exists."""
        return self._display

    def packet(self, options: Sequence[object]) -> bytes | None:
        """Return the drawing, if it has changed."""
        if self._display is None and not self._open():
            return None
        display, now_ns = self._display, self._sim.time_ns
        assert display is not None
        if isinstance(display, InteractiveMarkerDisplay):
            self._ask_initial(display)
        while self._waiting:
            message, stamp = self._waiting.popleft()
            display.take(message, stamp)
        if self._sim.mj_model is not self._model:
            display.has_changed = True  # bodies have other numbers
        is_due = time.perf_counter() - self._drawn_at >= _PERIOD
        if not is_due or not (display.has_changed or display.expires(now_ns)):
            return None
        self._drawn_at, self._model, display.has_changed = time.perf_counter(), self._sim.mj_model, False
        return drawing_packet(self._sim, display, now_ns)

    def _open(self) -> bool:
        """Subscribe to the topic if it exists; return True if it does."""
        bus = self._sim.communication.bus
        if bus.revision == self._revision:
            return False
        self._revision = bus.revision
        type_name = bus.all_topics().get(self._topic, "")
        if type_name not in DISPLAYS:
            return False
        self._display = DISPLAYS[type_name](self._topic, SimulationTools(self._sim, self._frames))
        self._tree.open()
        topics = [self._topic, *([self._topic + UPDATES] if isinstance(self._display, GridDisplay) else [])]
        self._taps = [bus.tap(topic, self._receive) for topic in topics]
        return True

    def _ask_initial(self, display: InteractiveMarkerDisplay) -> None:
        """Ask the server for its markers, once, and pass them to the display when it has answered."""
        services = self._sim.communication.services
        if self._initial is None:
            if display.initial_service in services.names():
                self._initial = services.begin(display.initial_service, msgs.type_of(_INITIAL)())
        elif self._initial.is_done and self._initial.response is not None:
            display.take_initial(self._initial.response)
            self._initial.response = None

    def _receive(self, message: Message) -> None:
        self._waiting.append((message, self._sim.time_ns))

    def close(self) -> None:
        """End the subscriptions."""
        for tap in self._taps:
            tap.close()
        self._tree.close()


def drawing_packet(sim: Simulation, display: Display, time_ns: int) -> bytes:
    """Return the packet with the present drawing of a display."""
    drawing = Drawing()
    display.draw(drawing, time_ns)
    links = sim.engine.names.links.items()
    head, arrays = drawing.pack({name: (int(link.body), link.offset) for name, link in links})
    return make_packet({"kind": f"display:{display.topic}", **head}, arrays)
