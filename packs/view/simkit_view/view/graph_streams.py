"""Graph of nodes and topics, and tree of frames, laid out for the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

from simkit.bridges.live.introspection import node_list
from simkit.msgs.transform_tree import TransformTree
from simkit.recording.graphs.graph_contents import frame_graph, node_graph
from simkit.recording.graphs.graph_svg import GraphBox, GraphEdge
from simkit.recording.graphs.layered_layout import layered_layout
from simkit.run_spec import JsonObject
from simkit.runtime.communication.transform_buffer import present_messages
from simkit_view.view.packet import Stream
from simkit_view.view.topic_streams import ChangeStream

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.msgs import Message

_PERIOD: Final = 1.0  # [s] of wall time between two looks
_MOST_BOXES: Final = 600  # the time of a layout grows faster than the number of boxes
_TRANSFORMS: Final = "tf2_msgs/msg/TFMessage"


def drawing(boxes: Sequence[GraphBox], edges: Sequence[GraphEdge]) -> JsonObject:
    """Return places and texts of a graph; one with too many boxes has none, but their number."""
    if len(boxes) > _MOST_BOXES:
        return {"boxes": [], "edges": [], "size": [0, 0], "count": len(boxes), "most": _MOST_BOXES}
    layout = layered_layout({box.name: box.size() for box in boxes}, [(edge.start, edge.end) for edge in edges])
    shown = [
        {
            "name": box.name,
            "kind": box.kind,
            "head": box.head,
            "above": box.above,
            "lines": list(box.lines),
            "place": [round(value, 1) for value in layout.boxes[box.name]],
        }
        for box in boxes
    ]
    lines = [
        {"ends": [e.start, e.end], "dashed": e.is_dashed, "points": [[round(x, 1), round(y, 1)] for x, y in points]}
        for e in edges
        if (points := layout.paths.get((e.start, e.end))) is not None
    ]
    size = [round(layout.width, 1), round(layout.height, 1)]
    return {"boxes": shown, "edges": lines, "size": size, "count": len(boxes), "most": _MOST_BOXES}


class GraphStream:
    """Nodes and topics; `graph`. The option `{"all": true}` includes hidden names and simkit's own nodes.

    The last line of each topic is empty: the page writes the rate there.
    """

    def __init__(self, sim: Simulation, _: str) -> None:
        self._sim, self._hidden = sim, False
        self._drawn: tuple[object, JsonObject] = (None, {})
        self._stream = ChangeStream("graph", _PERIOD, self._content)

    def packet(self, options: Sequence[object]) -> bytes | None:
        hidden = any(isinstance(option, dict) and option.get("all") is True for option in options)
        if hidden != self._hidden:
            self._hidden = hidden
            self._stream = ChangeStream("graph", _PERIOD, self._content)
        return self._stream.packet(options)

    def _content(self) -> JsonObject:
        boxes, edges = node_graph(node_list(self._sim, ()), hidden=self._hidden)
        boxes = [replace(box, lines=[*box.lines, ""]) if box.kind == "topic" else box for box in boxes]
        if self._drawn[0] != (boxes, edges):
            self._drawn = (boxes, edges), drawing(boxes, edges)
        return self._drawn[1]

    def close(self) -> None:
        """Nothing is open."""


class FrameStream:
    """Tree of frames from `/tf` and `/tf_static`, also below namespaces, with rates [Hz]; `frames`.

    The last line of each frame that moves is empty: the page writes the rate there.
    """

    def __init__(self, sim: Simulation, _: str) -> None:
        self._sim, self._tree = sim, TransformTree(length=1.0)
        self._stamps: dict[str, list[int]] = {}  # count, first and newest time [ns] of the transforms of a frame
        self._drawn: tuple[object, JsonObject] = (None, {})
        self._stream = ChangeStream("frames", _PERIOD, self._content)
        self.packet = self._stream.packet
        bus = sim.communication.bus
        names = (topic for topic, type_name in bus.all_topics().items() if type_name == _TRANSFORMS)
        topics = {"/tf_static", "/tf", *(topic for topic in names if topic.endswith(("/tf", "/tf_static")))}
        self._taps = [bus.tap(topic, partial(self._take, topic)) for topic in sorted(topics)]
        for topic in sorted(topics):
            for message in present_messages(bus, topic):
                self._tree.take(message, is_static=topic.endswith("tf_static"))

    def _take(self, topic: str, message: Message) -> None:
        now = self._sim.time_ns
        self._tree.advance(topic, now)
        is_static = topic.endswith("tf_static")
        self._tree.take(message, is_static=is_static)
        for stamped in () if is_static else message.transforms:
            name = stamped.child_frame_id.lstrip("/")
            stamp = self._stamps.get(name)
            if stamp is None or now < stamp[2]:
                self._stamps[name] = [1, now, now]
            elif now > stamp[2]:
                stamp[0] += 1
                stamp[2] = now

    def _content(self) -> JsonObject:
        tree, parents = self._tree, self._tree.frames()
        boxes, edges = frame_graph(tree)
        moving = {name for name, parent in parents.items() if parent and not tree.is_static(name)}
        boxes = [replace(box, lines=[""]) if box.name in moving else box for box in boxes]
        if self._drawn[0] != (boxes, edges):
            self._drawn = (boxes, edges), drawing(boxes, edges)
        now = self._sim.time_ns
        rates = {
            name: round((count - 1) * 1e9 / (last - first), 3)
            for name, (count, first, last) in self._stamps.items()
            if last > first
        }
        ages = {
            name: round((now - last) * 1e-9, 1) for name, (_, _, last) in self._stamps.items() if now - last > 10**9
        }
        return {**self._drawn[1], "rates": rates, "ages": ages}

    def close(self) -> None:
        for tap in self._taps:
            tap.close()


GRAPH_STREAMS: Final[dict[str, Callable[[Simulation, str], Stream]]] = {"graph": GraphStream, "frames": FrameStream}
"""Streams of graphs."""
