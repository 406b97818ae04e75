"""Each topic has a queue of its own: what is large or never read takes nothing from the others."""

from __future__ import annotations

import contextlib
from typing import Any

import pytest

import simkit
from simkit import msgs
from simkit.bridges.live import connection, message_log, socket_files, topic_feed
from simkit.bridges.live.connection import MOST_OPEN
from simkit.bridges.live.message_log import MOST_BYTES
from simkit.bridges.live.protocol import ASK, MESSAGE, MESSAGE_HEAD, FrameReader, json_frame, message_frame
from simkit.bridges.live.server import Server

MB = 1 << 20


class Caller:
    """A client that reads when it is told to.

    Attributes:
        lost: what the last message of each subscription said about dropped ones.
    """

    def __init__(self, server: Server) -> None:
        self.server, self.lost = server, dict[int, int]()
        self.socket, token = socket_files.connect(server.path, timeout=60.0)
        self.socket.setblocking(False)
        self._reader = FrameReader(1 << 28, (2, 3, 4), token)
        server.poll()

    def ask(self, question: str, **args: Any) -> None:
        self.socket.send(json_frame(ASK, {"id": 1, "ask": question, **args}))
        self.server.poll()

    def subscribe(self, *topics: str, depth: int = 1000) -> None:
        """Subscribes to topics, with the numbers 0, 1, …"""
        for number, topic in enumerate(topics):
            self.ask("subscribe", number=number, topic=topic, depth=depth)

    def messages(self) -> list[tuple[int, bytes]]:
        """Number of the subscription and CDR of everything that there is, in the order of arrival."""
        found: list[tuple[int, bytes]] = []
        empty = 0
        while empty < 3:
            self.server.poll()
            with contextlib.suppress(BlockingIOError):
                self._reader.feed(self.socket.recv(1 << 18))
                for kind, body in iter(self._reader.next, None):
                    if kind == MESSAGE:
                        number, _, _, lost = MESSAGE_HEAD.unpack_from(body)
                        self.lost[number] = lost
                        found.append((number, body[MESSAGE_HEAD.size :]))
                empty = -1
            empty += 1
        return found


def picture(size: int) -> Any:
    return msgs.make("std_msgs/msg/UInt8MultiArray", data=bytes(size))


def number(value: int) -> Any:
    return msgs.make("std_msgs/msg/Int32", data=value)


def numbers(found: list[tuple[int, bytes]], subscription: int) -> list[int]:
    """The values of a subscription to numbers."""
    return [msgs.deserialize(data, "std_msgs/msg/Int32").data for n, data in found if n == subscription]


def test_large_messages_displace_no_small_ones(court: simkit.Simulation) -> None:
    bus = court.communication.bus
    camera = bus.advertise("/picture", "std_msgs/msg/UInt8MultiArray")
    odometer = bus.advertise("/count", "std_msgs/msg/Int32")
    frame = picture(4 * MB)
    with Server(court) as server:
        caller = Caller(server)
        caller.subscribe("/picture", "/count")
        for value in range(50):
            camera.publish(frame)
            odometer.publish(number(value))
            server.poll()
        found = caller.messages()
        assert numbers(found, 1) == list(range(50)) and caller.lost == {0: 50 - [n for n, _ in found].count(0), 1: 0}
        assert [n for n, _ in found].count(0) in (7, 8), "32 MiB, and the one that was being sent"
        places = [place for place, (n, _) in enumerate(found) if n == 0]
        assert places[1] > 50, "the numbers do not wait for the second picture"
        caller.socket.close()


def test_small_messages_arrive_in_the_order_of_publication(court: simkit.Simulation) -> None:
    talkers = [court.communication.bus.advertise(f"/count_{n}", "std_msgs/msg/Int32") for n in range(5)]
    with Server(court) as server:
        caller = Caller(server)
        caller.subscribe(*(f"/count_{n}" for n in range(5)))
        for value in range(300):
            talkers[value * 7 % 5].publish(number(value))
        found = caller.messages()
        assert [numbers([item], item[0])[0] for item in found] == list(range(300))
        caller.socket.close()


def test_each_subscription_has_its_own_depth_and_count(court: simkit.Simulation) -> None:
    talker = court.communication.bus.advertise("/count", "std_msgs/msg/Int32")
    with Server(court) as server:
        caller = Caller(server)
        for index, depth in enumerate((1, 5, 1000)):
            caller.ask("subscribe", number=index, topic="/count", depth=depth)
        for value in range(20):
            talker.publish(number(value))
        found = caller.messages()
        assert [numbers(found, n) for n in range(3)] == [[19], list(range(15, 20)), list(range(20))]
        assert caller.lost == {0: 19, 1: 15, 2: 0}
        caller.socket.close()


def test_a_message_is_stored_once_for_all_subscriptions(court: simkit.Simulation) -> None:
    talker = court.communication.bus.advertise("/picture", "std_msgs/msg/UInt8MultiArray")
    with Server(court) as server:
        callers = [Caller(server) for _ in range(2)]
        for caller in callers:
            for index in range(MOST_OPEN):
                caller.ask("subscribe", number=index, topic="/picture", depth=10)
        talker.publish(picture(MB))
        memory = server.feeds.memory
        assert MB < memory.total < MB + 1000
        for _ in range(200):
            talker.publish(picture(MB))
        assert 10 * MB < memory.total < 11 * MB, "as many as the depth"
        for caller in callers:
            caller.socket.close()
        for _ in range(5):
            server.poll()
        assert memory.total == 0 and not memory.logs


def test_the_last_message_of_a_latched_topic_survives_a_flood(court: simkit.Simulation) -> None:
    bus = court.communication.bus
    maps = [bus.advertise("/map", "std_msgs/msg/Int32", latched=True) for _ in range(2)]
    camera = bus.advertise("/picture", "std_msgs/msg/UInt8MultiArray")
    for value, publisher in enumerate(maps):
        publisher.publish(number(value))
    frame = picture(4 * MB)
    with Server(court) as server:
        early, late = Caller(server), Caller(server)
        early.subscribe("/picture", "/map", depth=1)
        for _ in range(40):
            camera.publish(frame)
        late.subscribe("/picture", "/map", depth=1)
        maps[0].publish(number(7))
        for _ in range(40):
            camera.publish(frame)
        assert numbers(early.messages(), 1)[-1] == 7
        assert numbers(late.messages(), 1) == [0, 1, 7], "the last of each publisher, then what came later"
        for caller in (early, late):
            caller.socket.close()


def test_all_topics_together_have_a_limit_and_the_largest_pays(
    court: simkit.Simulation, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(message_log, "MOST_TOTAL", 8 * MB)
    bus = court.communication.bus
    names = [f"/picture_{n}" for n in range(4)]
    cameras = [bus.advertise(name, "std_msgs/msg/UInt8MultiArray") for name in names]
    odometer = bus.advertise("/count", "std_msgs/msg/Int32")
    frame = picture(MB // 4)
    with Server(court) as server:
        caller = Caller(server)
        caller.subscribe("/count", *names)
        for value in range(100):
            odometer.publish(number(value))
            for camera in cameras:
                camera.publish(frame)
            assert server.feeds.memory.total <= 8 * MB
        odometer.publish(number(100))
        found = caller.messages()
        assert numbers(found, 0) == list(range(101)) and caller.lost[0] == 0
        for n in range(1, 5):
            count = [index for index, _ in found].count(n)
            assert count + caller.lost[n] == 100 and count >= 3, "each keeps some"
        caller.socket.close()


def test_a_message_that_is_larger_than_the_queue_arrives(court: simkit.Simulation) -> None:
    camera = court.communication.bus.advertise("/picture", "std_msgs/msg/UInt8MultiArray")
    with Server(court) as server:
        caller = Caller(server)
        caller.subscribe("/picture")
        camera.publish(picture(MOST_BYTES + MB))
        assert [len(data) > MOST_BYTES for _, data in caller.messages()] == [True]
        camera.publish(picture(message_log.MOST_TOTAL))
        assert caller.messages() == [] and server.feeds.memory.total == 0
        camera.publish(picture(5))
        assert len(caller.messages()) == 1 and caller.lost == {0: 1}
        caller.socket.close()


def test_no_images_are_rendered_for_clients_that_read_nothing(
    court: simkit.Simulation, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Rendering:
        is_done = True

    rendered = [0]

    def render() -> Any:
        rendered[0] += 1
        return picture(MB)

    monkeypatch.setattr(topic_feed, "_REVIEW_PERIOD", -1.0)
    camera = court.communication.bus.advertise("/picture", "std_msgs/msg/UInt8MultiArray")
    with Server(court) as server:
        caller = Caller(server)
        caller.subscribe("/picture")
        for _ in range(3):
            camera.publish_later(render, Rendering())
            server.poll()
        monkeypatch.setattr(connection, "_STUCK_SECONDS", -1.0)
        server.poll()
        assert not court.communication.bus.wanted("/picture"), "the socket is full"
        camera.publish_later(render, Rendering())
        assert rendered == [3]
        assert len(caller.messages()) == 3, "what was queued is still sent"
        server.poll()
        camera.publish_later(render, Rendering())
        assert len(caller.messages()) == 1 and rendered == [4] and caller.lost == {0: 0}
        caller.socket.close()
        server.poll()
        server.poll()
        assert not court.communication.bus.wanted("/picture")


def test_a_bridge_does_not_count_its_own_messages_as_lost(court: simkit.Simulation) -> None:
    with Server(court) as server:
        bridge, other = Caller(server), Caller(server)
        bridge.ask("node", name="ros", is_bridge=True)
        bridge.ask("advertise", number=1, topic="/count", type="std_msgs/msg/Int32")
        for caller in (bridge, other):
            caller.subscribe("/count")
        for value in range(5):
            bridge.socket.send(message_frame(1, msgs.serialize(number(value))))
        court.communication.bus.advertise("/count", "std_msgs/msg/Int32").publish(number(9))
        server.poll()
        assert numbers(bridge.messages(), 0) == [9] and bridge.lost == {0: 0}
        assert numbers(other.messages(), 0) == [9, 0, 1, 2, 3, 4]
        for caller in (bridge, other):
            caller.socket.close()


def test_a_closed_subscription_leaves_nothing_for_one_of_the_same_number(court: simkit.Simulation) -> None:
    bus = court.communication.bus
    old, new = (bus.advertise(f"/{name}", "std_msgs/msg/Int32") for name in ("old", "new"))
    camera = bus.advertise("/picture", "std_msgs/msg/UInt8MultiArray")
    with Server(court) as server:
        caller = Caller(server)
        caller.ask("subscribe", number=5, topic="/picture", depth=10)
        for _ in range(5):
            camera.publish(picture(MB))
        server.poll()  # the socket is full
        caller.ask("subscribe", number=0, topic="/old", depth=10)
        old.publish(number(1))
        caller.ask("unsubscribe", number=0)
        caller.ask("subscribe", number=0, topic="/new", depth=10)
        new.publish(number(2))
        assert numbers(caller.messages(), 0) == [2]
        caller.socket.close()
