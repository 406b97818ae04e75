"""Displays of a bag: drawings at certain times, for a page that plays them."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit.msgs import Message
from simkit.msgs.transform_tree import TransformTree
from simkit.recording.bags.bag_motion import TRANSFORMS
from simkit.run_spec import JsonObject
from simkit_view.displays.display import Display
from simkit_view.displays.frame_poses import FramePoses
from simkit_view.displays.grid_displays import UPDATE, UPDATES
from simkit_view.displays.kinds import DISPLAYS, SimulationTools
from simkit_view.view.topic_display import drawing_packet

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.recording.bags.bag_motion import BagMotion

_PERIOD: Final = 0.2  # [s] between two drawings of a topic
_MOST_RAW: Final = 64_000_000  # [bytes] of the drawings of a topic before the rest is left out
_MOST_PACKED: Final = 200_000  # [bytes] of the compressed drawings of a topic; of more, every second one is dropped


class RecordedDisplays:
    """Drawings of the topics of a bag.

    Args:
        sim: simulation of the bag's world, which a `BagMotion` moves.
        motion: motion of the bag.
        topics: type of each topic of the bag.

    Attributes:
        topics: topics that the displays read.
    """

    def __init__(self, sim: Simulation, motion: BagMotion, topics: Mapping[str, str]) -> None:
        self._sim, self._tree = sim, TransformTree()
        tools = SimulationTools(sim, FramePoses(sim, self._tree, motion.links_by_frame))
        self._tracks = {
            topic: _Track(DISPLAYS[type_name](topic, tools), type_name)
            for topic, type_name in topics.items()
            if type_name in DISPLAYS
        }
        updated = {topic + UPDATES: topic for topic in self._tracks if topics.get(topic + UPDATES) == UPDATE}
        self._track_of = {**{topic: topic for topic in self._tracks}, **updated}
        transforms = {topic for topic, type_name in topics.items() if type_name == TRANSFORMS}
        self._transforms = {topic for topic in transforms if not topic.endswith("pose/info")} if self._tracks else set()
        self.topics = [*self._track_of, *self._transforms]

    def take(self, topic: str, message: Message, time: float) -> None:
        """Take a message of the bag at a time from its begin [s]."""
        if topic in self._transforms:
            self._tree.take(message, is_static=topic.endswith("tf_static"))
        if topic in self._track_of:
            track = self._tracks[self._track_of[topic]]
            track.display.take(message, round(time * 1e9))
            track.draw(self._sim, time)

    def finish(self, time: float) -> tuple[list[JsonObject], dict[str, npt.NDArray[np.generic]]]:
        """Return the drawings up to the end of the bag [s]: topics with types and times, and arrays of packets."""
        heads: list[JsonObject] = []
        arrays: dict[str, npt.NDArray[np.generic]] = {}
        for topic, track in self._tracks.items():
            track.draw(self._sim, time, is_last=True)
            track.thin()
            if track.drawings:
                name = f"display{len(heads)}"
                ends = np.cumsum([len(packet) for _, packet in track.drawings]).tolist()
                times = [moment for moment, _ in track.drawings]
                heads.append({"topic": topic, "type": track.type_name, "times": times, "ends": ends})
                arrays[name] = np.frombuffer(b"".join(packet for _, packet in track.drawings), np.uint8)
        return heads, arrays


class _Track:
    """Drawings of one topic.

    Attributes:
        display: display of the topic.
        type_name: type of the topic.
        drawings: times [s] and packets.
    """

    def __init__(self, display: Display, type_name: str) -> None:
        self.display, self.type_name = display, type_name
        self.drawings: list[tuple[float, bytes]] = []
        self._next, self._size = 0.0, 0

    def draw(self, sim: Simulation, time: float, *, is_last: bool = False) -> None:
        """Draw what has changed, if the last drawing is old enough."""
        now_ns = round(time * 1e9)
        is_due = time >= self._next or is_last
        if not is_due or not (self.display.has_changed or self.display.expires(now_ns)) or self._size > _MOST_RAW:
            return
        self._next, self.display.has_changed = time + _PERIOD, False
        packet = drawing_packet(sim, self.display, now_ns)
        if not self.drawings or packet != self.drawings[-1][1]:
            self.drawings.append((round(time, 3), packet))
            self._size += len(packet)

    def thin(self) -> None:
        """Drop every second drawing until the compressed ones are small; none is left if one alone is too large."""
        while self.drawings and sum(len(zlib.compress(packet, 1)) for _, packet in self.drawings) > _MOST_PACKED:
            self.drawings = self.drawings[:-1][::2] + self.drawings[-1:] if len(self.drawings) > 2 else []
