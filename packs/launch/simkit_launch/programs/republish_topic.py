"""Tools of topic_tools that publish the messages of a topic again: relay, throttle, drop, delay, mux and demux."""

from __future__ import annotations

import sys
from collections import deque
from collections.abc import Sequence
from pathlib import PurePath
from typing import Any

import rclpy
from rclpy.duration import Duration
from rclpy.serialization import serialize_message
from rclpy.utilities import remove_ros_args
from republisher import Republisher, run
from std_msgs.msg import String
from topic_tools_interfaces.srv import (
    DemuxAdd,
    DemuxDelete,
    DemuxList,
    DemuxSelect,
    MuxAdd,
    MuxDelete,
    MuxList,
    MuxSelect,
)

NONE_TOPIC = "__none"


class Relay(Republisher):
    """Publishes the messages of a topic on another one: `relay INPUT [OUTPUT]`."""

    def __init__(self, words: Sequence[str]) -> None:
        super().__init__("relay")
        rest = self.read_topics(words, "_relay")
        if rest:
            self.output_topic = rest[0]


class Throttle(Republisher):
    """Publishes at most a number of messages or of bytes per second.

    `throttle messages INPUT RATE [OUTPUT]` or `throttle bytes INPUT RATE WINDOW [OUTPUT]`.
    """

    def __init__(self, words: Sequence[str]) -> None:
        super().__init__("throttle")
        kind, *words = words or [""]
        rest = self.read_topics(words, "_throttle")
        self._is_by_bytes = self.value("throttle_type", kind or "messages") == "bytes"
        rate = float(rest.pop(0)) if rest else 1.0
        self._window = self.number("window", float(rest.pop(0)) if self._is_by_bytes and rest else 1.0)
        self._rate = self.number("bytes_per_sec" if self._is_by_bytes else "msgs_per_sec", rate)
        self.value("use_wall_clock", False)  # all time is simulated
        if rest:
            self.output_topic = rest[0]
        self._last = self.get_clock().now()
        self._sent: deque[tuple[float, int]] = deque()

    def process(self, message: Any) -> None:
        """Publish a message if the rate allows it."""
        now = self.get_clock().now()
        if self._is_by_bytes:
            seconds = now.nanoseconds * 1e-9
            while self._sent and self._sent[0][0] < seconds - self._window:
                self._sent.popleft()
            if sum(size for _, size in self._sent) < self._rate:
                super().process(message)
                self._sent.append((seconds, len(serialize_message(message))))
            return
        if now < self._last:
            self._last = now
        if now - self._last >= Duration(nanoseconds=round(1e9 / self._rate)):
            super().process(message)
            self._last = now


class Drop(Republisher):
    """Drops X of each Y messages: `drop INPUT X Y [OUTPUT]`."""

    def __init__(self, words: Sequence[str]) -> None:
        super().__init__("drop")
        rest = self.read_topics(words, "_drop")
        numbers = [int(rest.pop(0)) if rest else default for default in (0, 1)]
        self._dropped, self._of = (self.value(name, number) for name, number in zip("XY", numbers, strict=True))
        if rest:
            self.output_topic = rest[0]
        self._count = 0

    def process(self, message: Any) -> None:
        """Publish a message, or drop it."""
        if self._count >= self._dropped:
            super().process(message)
        self._count = (self._count + 1) % self._of


class Delay(Republisher):
    """Publishes messages later: `delay INPUT SECONDS [OUTPUT]`."""

    def __init__(self, words: Sequence[str]) -> None:
        super().__init__("delay")
        rest = self.read_topics(words, "_delay")
        self._delay = self.number("delay", float(rest.pop(0)) if rest else 0.0)
        self.value("use_wall_clock", False)  # all time is simulated
        if rest:
            self.output_topic = rest[0]

    def process(self, message: Any) -> None:
        """Publish a message after the delay."""
        timer: Any = None

        def publish() -> None:
            self.destroy_timer(timer)
            super(Delay, self).process(message)

        timer = self.create_timer(max(self._delay, 1e-9), publish)


class Mux(Republisher):
    """Publishes one of several inputs, which a service chooses: `mux OUTPUT INPUT…`."""

    def __init__(self, words: Sequence[str]) -> None:
        super().__init__("mux")
        self.output_topic = self.value("output_topic", words[0] if words else "~/selected")
        self._inputs = list(self.value("input_topics", list(words[1:]) or [""]))
        self.is_lazy = self.value("lazy", False)
        self.input_topic = self.value("initial_topic", "") or self._inputs[0]
        if self.input_topic == NONE_TOPIC:
            self.input_topic = ""
        self._chosen = self.create_publisher(String, "~/selected_topic", 1)
        self.create_service(MuxAdd, "~/add", self._on_add)
        self.create_service(MuxDelete, "~/delete", self._on_delete)
        self.create_service(MuxList, "~/list", self._on_list)
        self.create_service(MuxSelect, "~/select", self._on_select)

    def _index(self, topic: str) -> int:
        """Return the number of an input; -1 for another topic."""
        names = [self.resolve_topic_name(name) for name in self._inputs]
        return names.index(self.resolve_topic_name(topic)) if self.resolve_topic_name(topic) in names else -1

    def _on_add(self, request: Any, response: Any) -> Any:
        response.success = request.topic != NONE_TOPIC and self._index(request.topic) < 0
        if response.success:
            self._inputs.append(request.topic)
            self.get_logger().info(f"added {request.topic} to mux")
        else:
            self.get_logger().warning(f"cannot add {request.topic} to mux: it is reserved or already an input")
        return response

    def _on_delete(self, request: Any, response: Any) -> Any:
        index = self._index(request.topic)
        response.success = index >= 0 and self._inputs[index] != self.input_topic
        if response.success:
            del self._inputs[index]
            self.get_logger().info(f"deleted topic {request.topic} from mux")
        else:
            self.get_logger().warning(f"cannot delete {request.topic} from mux: it is no input, or it is selected")
        return response

    def _on_list(self, request: Any, response: Any) -> Any:
        response.topics = self._inputs
        return response

    def _on_select(self, request: Any, response: Any) -> Any:
        response.prev_topic = self.input_topic
        index = self._index(request.topic) if request.topic != NONE_TOPIC else -1
        response.success = request.topic == NONE_TOPIC or index >= 0
        if response.success:
            self.input_topic = self._inputs[index] if index >= 0 else ""
            self.look_for_source()
            self._chosen.publish(String(data=request.topic))
            self.get_logger().info(f"mux selected input: [{request.topic}]")
        return response


class Demux(Republisher):
    """Publishes the input on one of several outputs, which a service chooses: `demux INPUT OUTPUT…`."""

    def __init__(self, words: Sequence[str]) -> None:
        super().__init__("demux")
        self.input_topic = self.value("input_topic", words[0] if words else "~/input")
        self._outputs = list(self.value("output_topics", list(words[1:]) or [""]))
        self.is_lazy = self.value("lazy", False)
        self.output_topic = self.value("initial_topic", "") or self._outputs[0]
        self.create_service(DemuxAdd, "~/add", self._on_add)
        self.create_service(DemuxDelete, "~/delete", self._on_delete)
        self.create_service(DemuxList, "~/list", self._on_list)
        self.create_service(DemuxSelect, "~/select", self._on_select)

    def process(self, message: Any) -> None:
        """Publish a message, unless no output is selected."""
        if self.output_topic != NONE_TOPIC:
            super().process(message)

    def _on_add(self, request: Any, response: Any) -> Any:
        response.success = request.topic != NONE_TOPIC and request.topic not in self._outputs
        if response.success:
            self._outputs.append(request.topic)
        return response

    def _on_delete(self, request: Any, response: Any) -> Any:
        response.success = request.topic in self._outputs and request.topic != self.output_topic
        if response.success:
            self._outputs.remove(request.topic)
        return response

    def _on_list(self, request: Any, response: Any) -> Any:
        response.topics = self._outputs
        return response

    def _on_select(self, request: Any, response: Any) -> Any:
        response.prev_topic = self.output_topic
        response.success = request.topic == NONE_TOPIC or request.topic in self._outputs
        if response.success:
            self.output_topic = request.topic
            self.renew_publisher()
        return response


TOOLS = {"relay": Relay, "throttle": Throttle, "drop": Drop, "delay": Delay, "mux": Mux, "demux": Demux}


def main() -> None:
    """Run the tool that the name of the executable names."""
    rclpy.init(args=sys.argv)
    name = PurePath(sys.argv[0]).name
    run(TOOLS[name](remove_ros_args(sys.argv)[1:]))


if __name__ == "__main__":
    main()
