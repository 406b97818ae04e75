"""Client of a bridge in a process of its own, for `bridges.py`: subscribes to topics and counts their messages.

python benchmarks/bridge_reader.py KIND ADDRESS TOPIC=TYPE …

KIND is socket (ADDRESS: name of the simulation), ros (ADDRESS: number of the ROS domain; needs a Python with rclpy),
foxglove, rosbridge, cbor or cbor-raw (ADDRESS: `ws://…`). With `deaf-` before it, the client subscribes and reads
nothing any more. It prints `ready` once, and for each line on its standard input the number of messages so far.
"""

from __future__ import annotations

import json
import select
import sys
import threading
import time
from collections.abc import Callable, Mapping
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LONGEST = 0.5  # [s] between two looks at the messages


class Reader:
    """Count of messages, and its lines for the benchmark."""

    def __init__(self, is_deaf: bool) -> None:
        self.count, self.is_deaf = 0, is_deaf

    def begin(self) -> None:
        """Tell that the client has subscribed."""
        print("ready", flush=True)
        threading.Thread(target=self._answer, daemon=True).start()
        while self.is_deaf:
            time.sleep(LONGEST)

    def _answer(self) -> None:
        for _ in sys.stdin:
            print(self.count, flush=True)


def read_socket(reader: Reader, name: str, topics: Mapping[str, str]) -> None:
    """Read messages as a client of the simulation itself, without decoding them."""
    from simkit.live import LiveError, connect

    def count(*_: object) -> None:
        reader.count += 1

    with connect(name, wait=60.0) as client:
        for topic in topics:
            client.subscriptions[client.subscribe(topic).number] = count
        reader.begin()
        try:
            while True:
                client.receive(LONGEST)
        except LiveError:
            return


def read_ros(reader: Reader, domain: str, topics: Mapping[str, str]) -> None:
    """Read messages as a node of ROS, without decoding them; its types need not be installed."""
    sys.path[:0] = [str(ROOT), str(ROOT / "packs" / "ros")]
    from simkit_ros.ros_session import Qos, RosSession
    from simkit_ros.wait_thread import RosWaiter

    session = RosSession("reader", "", [])
    ends = [session.subscribe(topic, session.types.find(kind), Qos()) for topic, kind in topics.items()]
    by_pointer = {end.subscription.handle.pointer: end for end in ends}
    waiter = RosWaiter(session.context)
    waiter.watch([end.subscription for end in ends], (), ())
    reader.begin()
    while True:
        waiter.resume()
        select.select([waiter], [], [], LONGEST)
        if waiter.is_stopped():
            for pointer in waiter.ready:
                while by_pointer[pointer].take() is not None:
                    reader.count += 1


def read_websocket(reader: Reader, kind: str, address: str, topics: Mapping[str, str]) -> None:
    """Read messages as a client of a WebSocket server, without decoding them."""
    from websockets.exceptions import ConnectionClosed
    from websockets.sync.client import connect

    protocols = {"subprotocols": ["foxglove.sdk.v1"]} if kind == "foxglove" else {}
    with connect(address, max_size=None, compression=None, **protocols) as socket:
        if kind == "foxglove":
            channels: dict[str, int] = {}
            while not channels.keys() >= topics.keys():
                words = json.loads(text) if isinstance(text := socket.recv(), str) else {}
                channels |= {row["topic"]: row["id"] for row in words.get("channels", ())}
            rows = [{"id": i, "channelId": channels[topic]} for i, topic in enumerate(topics)]
            socket.send(json.dumps({"op": "subscribe", "subscriptions": rows}))
        else:
            compression = "none" if kind == "rosbridge" else kind
            for topic in topics:
                socket.send(json.dumps({"op": "subscribe", "topic": topic, "compression": compression}))
        reader.begin()
        try:
            while True:
                data = socket.recv()
                if kind != "foxglove" or data[0] == 1:  # else a time
                    reader.count += 1
        except ConnectionClosed:
            return


def main() -> None:
    kind, address, *rest = sys.argv[1:]
    topics = dict(word.split("=") for word in rest)
    reader, kind = Reader(kind.startswith("deaf-")), kind.removeprefix("deaf-")
    readers: dict[str, Callable[[], None]] = {
        "socket": lambda: read_socket(reader, address, topics),
        "ros": lambda: read_ros(reader, address, topics),
    }
    readers.get(kind, lambda: read_websocket(reader, kind, address, topics))()


if __name__ == "__main__":
    main()
