"""Topics, numbers and log messages of a bag, for the panels of a page that plays it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.errors import SimkitError
from simkit.msgs.message_text import field_at_path
from simkit.recording.topic_counts import RENDERED
from simkit.run_spec import JsonObject
from simkit.runtime.communication.publisher import ROSOUT
from simkit_view.view.packet import make_packet
from simkit_view.view.series_stream import (
    TRUTH,
    Row,
    curve_dicts,
    field_paths,
    resolve_fields,
    series_packet,
    stamp_of,
    wanted_fields,
)
from simkit_view.view.topic_streams import LogEntries, log_entry

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.msgs import Message
    from simkit.recording.bags.bag_contents import BagTopic
    from simkit.recording.bags.reader import BagReader
    from simkit.recording.charts.fields import Curve
    from simkit_view.view.streams import StreamMaker

_MOST_SAMPLES: Final = 5000  # samples of a topic for a page; of a longer topic, every n-th message is read
_MOST_IN_FILE: Final = 600  # samples of a topic in an HTML file
_MOST_TOPICS: Final = 60  # topics in an HTML file
_MOST_ENTRIES: Final = 1000  # log messages in an HTML file
_MOST_ITEMS: Final = 12  # items of an array in an HTML file


class BagPanels:
    """Makers of the streams of a bag, which replace those of a simulation.

    Args:
        bag: open bag.
        sim: loaded world, whose models have true poses in the recording.
    """

    def __init__(self, bag: BagReader, sim: Simulation) -> None:
        self._bag, self._topics = bag, {topic.name: topic for topic in bag.topics}
        self._models = [name for name, model in sim.models.items() if not model.static]
        self.streams: dict[str, StreamMaker] = {
            "topics": lambda _: _OnePacket(self.topics_packet),
            "series": lambda topic: _BagSeries(self, topic),
            "log": lambda _: _BagLog(self._log_entries()),
        }

    def topics_packet(self) -> bytes:
        """Return the packet `topics`, with the rates in the bag."""
        rows, types = [], dict[str, list[str]]()
        for topic in self._topics.values():
            length = (self._bag.end - self._bag.start) * 1e-9
            rate = round((topic.count - 1) / length, 3) if topic.count > 1 and length > 0 else None
            rows.append({"name": topic.name, "type": topic.type_name, "rate": rate, "count": topic.count})
            if topic.type_name not in types:
                types[topic.type_name] = self._paths(topic)
        head = {"topics": rows, "types": types, "models": self._models, "truth": TRUTH, "recorded": True}
        return make_packet({"kind": "topics", **head}, {})

    def series_packet(self, topic: str, fields: Sequence[str], most: int = _MOST_SAMPLES) -> bytes:
        """Return the packet with numbers of a topic over the whole bag."""
        name, known = f"series:{topic}", self._topics.get(topic)
        if known is None:
            errors = dict.fromkeys(fields, f"no topic {topic!r:.80} in the bag")
            return series_packet(name, [], [], recorded=True, first=0, errors=errors)
        curves, errors = resolve_fields(topic, known.type_name, fields, self._bag.store_of(known.type_name))
        rows = self._rows(known, curves, most) if curves else []
        return series_packet(name, rows, curve_dicts(curves), recorded=True, first=0, errors=errors)

    def file_packet(self) -> bytes:
        """Return the packet with all topics and the numbers that an HTML file contains."""
        packets = {"topics": self.topics_packet()}
        shown = [t for t in self._topics.values() if t.count and t.type_name not in RENDERED]
        for topic in shown[:_MOST_TOPICS]:
            fields = self._file_fields(topic)
            if fields:
                packets[topic.name] = self.series_packet(topic.name, fields, _MOST_IN_FILE)
        if entries := self._log_entries()[-_MOST_ENTRIES:]:
            packets["log"] = make_packet({"kind": "log", "entries": entries}, {})
        arrays = {name: np.frombuffer(packet, np.uint8) for name, packet in packets.items()}
        return make_packet({"kind": "packets"}, arrays)

    def _paths(self, topic: BagTopic) -> list[str]:
        try:
            return field_paths(topic.type_name, self._bag.store_of(topic.type_name))
        except SimkitError:
            return []

    def _rows(self, topic: BagTopic, curves: Sequence[tuple[str, Curve]], most: int) -> list[Row]:
        stride, rows = math.ceil(topic.count / most), list[Row]()
        for number, message in enumerate(self._bag.messages([topic.name])):
            if number % stride == 0 and message.type_name == topic.type_name:
                decoded = self._bag.decode(message)
                rows.append((message.time_ns * 1e-9, stamp_of(decoded), [curve.read(decoded) for _, curve in curves]))
        return rows

    def _file_fields(self, topic: BagTopic) -> list[str]:
        """Return the fields of a topic in an HTML file: all numbers but those of long arrays."""
        try:
            message = self._bag.decode(next(self._bag.messages([topic.name])))
        except (SimkitError, StopIteration):
            return []
        paths: list[str] = []
        for path in self._paths(topic):
            before, index, after = path.partition("[]")
            if not index:
                paths.append(path)
            elif "[]" not in after:
                paths += [f"{before}[{item}]{after}" for item in self._items(message, before)]
        return paths

    def _items(self, message: Message, path: str) -> list[str]:
        """Return the items of a short array: names where the message has them, else indices."""
        store = self._bag.store_of(message.__msgtype__)
        count = len(field_at_path(message, path, store)[0])
        names = getattr(message, "name", None)
        if not 0 < count <= _MOST_ITEMS:
            return []
        return list(names) if isinstance(names, list) and len(names) == count else [str(k) for k in range(count)]

    def _log_entries(self) -> list[JsonObject]:
        if ROSOUT not in self._topics:
            return []
        entries = [log_entry(self._bag.decode(message)) for message in self._bag.messages([ROSOUT])]
        return [entry | {"number": number} for number, entry in enumerate(entries, 1)]


class _OnePacket:
    """Stream of one packet, which is sent once to the pages that show it."""

    def __init__(self, make: Callable[[], bytes]) -> None:
        self._make, self._is_sent = make, False

    def packet(self, options: Sequence[object]) -> bytes | None:
        if self._is_sent:
            return None
        self._is_sent = True
        return self._make()

    def close(self) -> None:
        """Nothing is open."""


class _BagSeries:
    """Numbers of a topic of a bag; sent when the fields that the pages want have changed."""

    def __init__(self, panels: BagPanels, topic: str) -> None:
        self._panels, self._topic = panels, topic
        self._fields: list[str] | None = None

    def packet(self, options: Sequence[object]) -> bytes | None:
        fields = wanted_fields(options)
        if fields == self._fields:
            return None
        self._fields = fields
        return self._panels.series_packet(self._topic, fields)

    def close(self) -> None:
        """Nothing is open."""


class _BagLog(_OnePacket, LogEntries):
    """Log messages of a bag."""

    def __init__(self, entries: Sequence[JsonObject]) -> None:
        LogEntries.__init__(self)
        self.newest.extend(entries)
        head = {"kind": "log", "last": len(entries), "source": 0, "recorded": True}
        _OnePacket.__init__(self, lambda: make_packet(head, {}))
