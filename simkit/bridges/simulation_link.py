"""Bridge's connection to a simulation: requests with callbacks instead of waits, and messages as CDR."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

from simkit.bridges.live.protocol import JsonObject, LiveClosed, LiveError, message_frame
from simkit.bridges.live.server_link import ServerLink

Then = Callable[[Any, bytes], None]
"""Callback for an answer: its value and its CDR."""
Failed = Callable[[LiveError], None]
"""Callback for an error that a request was answered with."""
_ANSWER_TIMEOUT = 1e6  # [s]; a simulation may make one very long step
DEPTH = 1000
"""Queued messages of a topic in the simulation."""


CDR_HEADER = b"\0\1\0\0"
"""Header of little-endian CDR."""


def text_message(text: str) -> bytes:
    """Return a `std_msgs/msg/String` as CDR."""
    data = text.encode()
    return CDR_HEADER + struct.pack("<I", len(data) + 1) + data + b"\0"


def robot_descriptions(graph: JsonObject) -> dict[str, str]:
    """Return the topics for the URDF of every robot, and the topic of the first one without a name, with the robots."""
    robots: list[str] = graph["robots"]
    robot_by_topic = {f"/{name}/robot_description": name for name in robots}
    return {**robot_by_topic, "/robot_description": robots[0]} if robots else robot_by_topic


def _ignore(*_: object) -> None:
    """Do nothing with an answer or an error."""


class SimulationLink(ServerLink):
    """Connection to a running simulation that waits for no answer.

    Args:
        path: path of the simulation's socket.
        report: callback for a note to the user.
        name: name of the bridge in the simulation's node lists.
        is_bridge: False for a client whose services and actions are its own.
    """

    def __init__(self, path: Path, report: Callable[[str], None], name: str = "ros", *, is_bridge: bool = True) -> None:
        self._report, self._pending = report, dict[int, tuple[Then, Failed]]()
        self._invalid: set[str] = set()
        super().__init__(path, node=name)
        self.timeout = _ANSWER_TIMEOUT
        self._socket.settimeout(_ANSWER_TIMEOUT)
        self.info["node"] = self.request("node", {"name": name, "is_bridge": is_bridge, "skips_own": True})[0]

    @property
    def node(self) -> str:
        """Name of the bridge in the simulation's node lists."""
        return str(self.info["node"])

    def ask(
        self, question: str, args: JsonObject, data: bytes = b"", then: Then = _ignore, failed: Failed = _ignore
    ) -> None:
        """Send a request; `dispatch_answers` calls `then` or `failed` once the answer has arrived."""
        self._pending[self.send_request(question, args, data)] = then, failed

    def dispatch_answers(self) -> None:
        """Call the callbacks of the answers that have arrived."""
        for number in [n for n in self._pending if self.has_answer(n)]:
            then, failed = self._pending.pop(number)
            try:
                value, data, _ = self.answer(number)
            except LiveClosed:
                raise
            except LiveError as error:
                failed(error)
            else:
                then(value, data)

    def subscribe(
        self, topic: str, take: Callable[[int, str, bytes, int], None], failed: Failed, depth: int = DEPTH
    ) -> int:
        """Subscribe to a topic; return the number of the subscription."""
        number = self.next_number()
        self.subscriptions[number] = take
        self.ask("subscribe", {"number": number, "topic": topic, "depth": depth}, failed=failed)
        return number

    def unsubscribe(self, number: int) -> None:
        """Close a subscription."""
        self.subscriptions.pop(number, None)
        self.ask("unsubscribe", {"number": number})

    def advertise(self, topic: str, type_name: str, then: Callable[[int], None], failed: Failed) -> None:
        """Open a topic for publishing; `then` receives the number of the publisher."""
        number = self.next_number()
        args = {"number": number, "topic": topic, "type": type_name}
        self.ask("advertise", args, then=lambda *_: then(number), failed=failed)

    def unadvertise(self, number: int) -> None:
        """Close a publisher."""
        self.ask("unadvertise", {"number": number})

    def publish(self, number: int, data: bytes) -> None:
        """Publish a message, given as CDR."""
        self.send(message_frame(number, data))

    def invalid(self, words: JsonObject) -> None:
        """Report an invalid message, once for each topic."""
        topic = str(words["topic"])
        if topic not in self._invalid:
            self._invalid.add(topic)
            self._report(f"messages on {topic} are dropped: they are no valid {words['type']}")
