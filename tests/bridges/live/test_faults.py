"""Whatever clients do, the run has the same bits and the same bag, and goes on."""

from __future__ import annotations

import contextlib
import json
import random
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit import msgs
from simkit.bridges.live import answering, request_fields, socket_files
from simkit.bridges.live.connection import MOST_OPEN, ClientConnection
from simkit.bridges.live.message_log import MOST_BYTES, Entry
from simkit.bridges.live.protocol import (
    ASK,
    HEAD,
    LARGEST_IN,
    MESSAGE,
    NUMBER,
    FrameReader,
    json_frame,
    message_frame,
    read_json_frame,
)
from simkit.bridges.live.server import MOST_CLIENTS, Server
from simkit.recording.bags.recorder import Recorder

SLICES, STEPS = 40, 25


pytestmark = pytest.mark.parametrize("kind_of_sockets", ["unix", "tcp"], indirect=True)


class Caller:
    """A client that sends whatever it likes, and never waits."""

    def __init__(self, server: Server) -> None:
        self.socket, token = socket_files.connect(server.path, timeout=60.0)
        self.socket.setblocking(False)
        self._reader, self._numbers = FrameReader(1 << 28, (2, 3, 4), token), 0

    def ask(self, question: str, **args: Any) -> None:
        self._numbers += 1
        self.send(json_frame(ASK, {"id": self._numbers, "ask": question, **args}))

    def send(self, data: bytes) -> int:
        with contextlib.suppress(BlockingIOError, BrokenPipeError, ConnectionResetError):
            return self.socket.send(data)
        return 0

    def heard(self) -> list[dict[str, Any]]:
        """The words of what has come."""
        with contextlib.suppress(BlockingIOError, ConnectionResetError):
            while data := self.socket.recv(1 << 20):
                self._reader.feed(data)
        frames = iter(self._reader.next, None)
        return [read_json_frame(body)[0] for kind, body in frames if kind != MESSAGE]


def queued(peer: ClientConnection, number: int) -> list[Entry]:
    """The messages that wait for a subscription of a client."""
    subscribed = peer.subscriptions[number]
    next(subscribed.take_entries(), None)  # goes to the oldest that is still there
    log = subscribed.log
    return [] if log is None else [log.entries[n] for n in range(subscribed.position, log.end)]


Disturbance = Callable[[Server, int, list[Any]], None]


def slow(server: Server, index: int, open_: list[Any]) -> None:
    """Subscribes to everything there is and reads nothing."""
    if index == 2:
        caller = Caller(server)
        open_.append(caller)
        for number, topic in enumerate(server.sim.topics()):
            caller.ask("subscribe", number=number, topic=topic, depth=100_000)


def dying(server: Server, index: int, open_: list[Any]) -> None:
    """Is gone in the middle of a frame, of a command and of a question."""
    caller = Caller(server)
    caller.ask("advertise", number=1, topic="/cmd_vel", type=None)
    server.poll()
    frame = message_frame(1, msgs.serialize(msgs.make("geometry_msgs/msg/Twist", linear={"x": 9.0})))
    caller.send(frame[: 5 + index] if index % 2 else json_frame(ASK, {"id": 9, "ask": "ping"})[:-3])
    server.poll()
    caller.socket.close()


def garbage(server: Server, index: int, open_: list[Any]) -> None:
    """Sends noise, and is told what was wrong with it."""
    caller = Caller(server)
    server.poll()
    caller.send(random.Random(index).randbytes(5000))
    for _ in range(3):
        server.poll()
    assert caller.heard()[-1]["code"] == "SK-LIVE-006"
    assert caller.socket.recv(1) == b"", "hung up on"
    caller.socket.close()


def crowd(server: Server, index: int, open_: list[Any]) -> None:
    """Calls again and again without a word."""
    if index % 10 == 5:
        for _ in range(MOST_CLIENTS + 20):
            with contextlib.suppress(BlockingIOError):
                open_.append(Caller(server))
            server.poll()
        assert len(server.peers) <= MOST_CLIENTS
        assert open_[-1].heard()[-1]["code"] == "SK-LIVE-007"
    elif index % 10 == 8:
        while open_:
            open_.pop().socket.close()


def questions(server: Server, index: int, open_: list[Any]) -> None:
    """Asks as fast as it can and listens to no answer."""
    if not open_:
        open_.append(Caller(server))
    for question in ("models", "topics", "nodes", "parameters", "services", "state", "nonsense") * 40:
        open_[0].ask(question)
    open_[0].ask("model", name="rover")


def subscriptions(server: Server, index: int, open_: list[Any]) -> None:
    """Subscribes again and again, which is refused from some number on."""
    if not open_:
        open_.append(Caller(server))
    for n in range(12_000 // SLICES):
        open_[0].ask("subscribe", number=index * 10_000 + n, topic=f"/nowhere_{n}", depth=1 << 40)
        if n % 50 == 0:
            server.poll()
            open_[0].heard()
    for peer in server.peers.values():
        assert len(peer.subscriptions) <= MOST_OPEN


def huge(server: Server, index: int, open_: list[Any]) -> None:
    """Announces more than there will be, and sends the largest there may be, a little at a time."""
    if index == 0:
        open_ += [Caller(server), Caller(server)]
        open_[0].send(HEAD.pack(0xFFFFFFFF, ASK))
        open_[1].send(HEAD.pack(LARGEST_IN, MESSAGE) + NUMBER.pack(77))
    open_[1].send(bytes(200_000))


WORDS = (
    json_frame(ASK, {"ask": "ping"}),
    json_frame(ASK, {"id": 1, "ask": ["ping"]}),
    json_frame(ASK, {"id": True, "ask": "ping"}),
    HEAD.pack(4 + 9, ASK) + NUMBER.pack(9) + b"[1,2,3,4]",
    HEAD.pack(4 + 100_000, ASK) + NUMBER.pack(100_000) + b"[" * 100_000,
    HEAD.pack(4, ASK) + NUMBER.pack(99),
    HEAD.pack(0, ASK),
    HEAD.pack(0, MESSAGE),
    message_frame(5, b""),
    HEAD.pack(3, 77) + b"abc",
)


def odd(server: Server, index: int, open_: list[Any]) -> None:
    """Frames that are well-formed but for one thing."""
    caller = Caller(server)
    caller.send(WORDS[index % len(WORDS)])
    for _ in range(4):
        server.poll()
    assert caller.heard()[-1]["code"] == "SK-LIVE-006"
    caller.socket.close()


ARGS: tuple[dict[str, Any], ...] = (
    {"ask": "subscribe"},
    {"ask": "subscribe", "number": -1, "topic": "/imu", "depth": 1},
    {"ask": "subscribe", "number": 1, "topic": "/i mu", "depth": 1},
    {"ask": "subscribe", "number": 1, "topic": "/" + "x" * 999, "depth": 1},
    {"ask": "subscribe", "number": 1, "topic": "/imu", "depth": "deep"},
    {"ask": "unsubscribe", "number": 9},
    {"ask": "advertise", "number": 1, "topic": "/cmd_vel", "type": 7},
    {"ask": "advertise", "number": 1, "topic": "/cmd_vel", "type": "../../x"},
    {"ask": "unadvertise", "number": [9]},
    {"ask": "call", "name": "/world/court/control", "fields": {"world_control": {"seed": -1}}},
    {"ask": "call", "name": "/world/court/control", "type": "std_srvs/srv/Trigger_Request"},
    {"ask": "call", "name": None},
    {"ask": "goal", "number": 1, "name": "/none", "fields": {}},
    {"ask": "cancel", "number": 1.5},
    {"ask": "model", "name": "x"},
    {"ask": "control", "action": "rtf", "value": float("nan")},
    {"ask": "set_parameter", "node": "/a", "name": "b", "value": {"c": []}},
    {"ask": "node", "name": {}},
    {"ask": "offer", "number": 1, "name": "/a b", "type": "std_srvs/srv/Trigger"},
    {"ask": "offer", "number": 1, "name": "/s", "type": "std_srvs/srv/Triger"},
    {"ask": "offer", "number": "1", "name": "/s", "type": "std_srvs/srv/Trigger"},
    {"ask": "offer", "number": 1, "name": "/world/court/control/" + "x" * 999, "type": "std_srvs/srv/Trigger"},
    {"ask": "act", "number": 1, "name": "/s", "type": "std_srvs/srv/Trigger", "cancels": True},
    {"ask": "act", "number": 1, "name": "/s", "type": "example_interfaces/action/Fibonacci"},
    {"ask": "listen", "number": 1, "topic": "/imu", "types": ["std_msgs/msg/String"], "depth": 1},
    {"ask": "listen", "number": 1, "topic": "/imu", "types": [], "depth": 1},
    {"ask": "listen", "number": 1, "topic": "/imu", "types": [{}], "depth": 1},
    {"ask": "declare", "number": 1, "name": "", "value": 1, "choices": [], "description": ""},
    {"ask": "declare", "number": 1, "name": "a", "value": {}, "choices": [], "description": ""},
    {"ask": "declare", "number": 1, "name": "a", "value": 10**400, "choices": [], "description": ""},
    {"ask": "declare", "number": 1, "name": "a", "value": 1, "choices": [{}, [{}]], "description": ""},
    {"ask": "declare", "number": 1, "name": "a", "value": 1, "minimum": [], "choices": [], "description": ""},
    {"ask": "respond", "number": 1, "call": 1},
    {"ask": "update_goal", "number": 1, "goal": 1, "change": "accept", "reason": ""},
    {"ask": "close_endpoint", "number": 1},
    {"ask": "subscribers", "number": 1},
    {"ask": "subscribers", "number": []},
    {"ask": "__class__"},
)


def args(server: Server, index: int, open_: list[Any]) -> None:
    """Questions with arguments that are no such thing."""
    caller = Caller(server)
    caller.send(json_frame(ASK, {"id": 5, **ARGS[index % len(ARGS)]}))
    for _ in range(4):
        server.poll()
    answer = next(words for words in caller.heard() if words.get("id") == 5)
    assert answer["error"] and (answer["code"].startswith("SK-") or ARGS[index % len(ARGS)]["ask"] == "cancel")
    caller.socket.close()


def bad_cdr(server: Server, index: int, open_: list[Any]) -> None:
    """Bytes of a message that are none of its type."""
    caller = Caller(server)
    caller.ask("advertise", number=1, topic="/points", type="sensor_msgs/msg/PointCloud2")
    server.poll()
    noise = random.Random(index).randbytes(200)
    caller.send(message_frame(1, b"\x00\x01\x00\x00" + struct.pack("<IiI", 1, 2, 0xFFFFFFF0 - index) + noise))
    for _ in range(3):
        server.poll()
    assert caller.heard()[-1]["code"] == "SK-LIVE-006"
    caller.socket.close()


def mutated(server: Server, index: int, open_: list[Any]) -> None:
    """Frames of which some bytes are others."""
    draw = random.Random(index)
    twist = msgs.serialize(msgs.make("nav_msgs/msg/Path", poses=[{}, {}]))
    frames = [json_frame(ASK, {"id": n, "ask": q, "name": "rover"}) for n, q in enumerate(("model", "topics", "node"))]
    for _ in range(10):
        caller = Caller(server)
        caller.ask("advertise", number=1, topic="/path", type="nav_msgs/msg/Path")
        server.poll()
        for frame in (*frames, message_frame(1, twist)):
            changed = bytearray(frame)
            for _ in range(draw.randint(0, 3)):
                changed[draw.randrange(len(changed))] = draw.randrange(256)
            caller.send(bytes(changed))
        for _ in range(2):
            server.poll()
        caller.socket.close()


def servers(server: Server, index: int, open_: list[Any]) -> None:
    """Servers that call themselves, and answer nothing or nonsense."""
    caller = Caller(server)
    caller.ask("offer", number=1, name=f"/sum_{index}", type="example_interfaces/srv/AddTwoInts")
    caller.ask("act", number=2, name=f"/count_{index}", type="example_interfaces/action/Fibonacci", cancels=True)
    caller.ask("listen", number=3, topic="/imu", types=["sensor_msgs/msg/Imu"], depth=10)
    caller.ask("declare", number=4, name="gain", value=index, choices=[], description="", node=f"/n_{index}")
    for number in range(20):
        caller.ask("call", name=f"/sum_{index}", fields={"a": number})
        caller.ask("goal", number=number, name=f"/count_{index}", fields={})
        caller.ask("respond", number=1, call=number, type="std_msgs/msg/Float64")
        caller.ask("update_goal", number=2, goal=number, change="SUCCEEDED", reason="", type="std_msgs/msg/Empty")
        caller.ask("set_parameter", node=f"/n_{index}", name="gain", value=number)
    server.poll()
    open_.append(caller)
    if len(open_) > 5:
        open_.pop(0).socket.close()


DISTURBANCES: list[Disturbance] = [
    servers, mutated, slow, dying, garbage, crowd, questions, subscriptions, huge, odd, args, bad_cdr,
]  # fmt: skip


def run(world: str, path: Path, disturb: Disturbance | None) -> tuple[bytes, bytes]:
    """Bits and bag of a run of a second."""
    open_: list[Any] = []
    with simkit.load(world, seed=4) as sim, Recorder(sim, path, skip=["/path"]) as recorder, Server(sim) as server:
        for index in range(SLICES):
            if index == 10:
                sim.publish("/cmd_vel", {"linear": {"x": 0.3}, "angular": {"z": 0.4}})
            if disturb is not None:
                disturb(server, index, open_)
            server.poll()
            sim.step(STEPS)
        recorder.close()
        state = sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes()
        for caller in open_:
            caller.socket.close()
        for _ in range(20):
            server.poll()
        assert not server.peers and not server.feeds._feeds
    return state, path.read_bytes()


@pytest.fixture(scope="module")
def undisturbed(court_text: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[bytes, bytes]]:
    import tempfile

    with tempfile.TemporaryDirectory(prefix="sk", dir="/tmp") as folder, pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_RUNTIME_DIR", folder)
        yield run(court_text, tmp_path_factory.mktemp("bags") / "a.mcap", None)


@pytest.mark.parametrize("disturb", DISTURBANCES, ids=lambda d: d.__name__)
def test_the_run_has_the_same_bits_and_the_same_bag(
    disturb: Disturbance, court_text: str, undisturbed: tuple[bytes, bytes], tmp_path: Path
) -> None:
    state, bag = run(court_text, tmp_path / "b.mcap", disturb)
    assert state == undisturbed[0]
    assert bag == undisturbed[1]


def test_a_slow_client_does_not_exceed_its_memory_limit(court: simkit.Simulation) -> None:
    talker = court.communication.bus.advertise("/picture", "std_msgs/msg/UInt8MultiArray")
    big = msgs.make("std_msgs/msg/UInt8MultiArray", data=bytes(1 << 20))
    with Server(court) as server:
        caller = Caller(server)
        caller.ask("subscribe", number=1, topic="/picture", depth=100_000)
        server.poll()
        server.poll()
        peer = next(iter(server.peers.values()))
        for _ in range(100):
            talker.publish(big)
        memory = server.feeds.memory
        assert MOST_BYTES - (2 << 20) < memory.total <= MOST_BYTES
        assert peer.subscriptions[1].lost == 100 - len(queued(peer, 1))
        caller.socket.close()


def test_images_that_are_still_being_rendered_arrive_in_order(court: simkit.Simulation) -> None:
    class Work:
        is_done = False

    drawing = Work()
    talker = court.communication.bus.advertise("/picture", "std_msgs/msg/Int32")
    with Server(court) as server:
        caller = Caller(server)
        caller.ask("subscribe", number=1, topic="/picture", depth=10)
        server.poll(0.1)
        server.poll()
        talker.publish_later(lambda: msgs.make("std_msgs/msg/Int32", data=1), drawing)
        court.step(10)
        talker.publish(msgs.make("std_msgs/msg/Int32", data=2))
        server.poll()
        peer = next(iter(server.peers.values()))
        assert not queued(peer, 1), "the second waits for the first"
        drawing.is_done = True
        server.feeds.deliver_ready()
        found = [(entry[1], msgs.deserialize(entry[3], "std_msgs/msg/Int32").data) for entry in queued(peer, 1)]
        assert found == [(0, 1), (10_000_000, 2)]
        caller.socket.close()


def test_a_reset_keeps_the_open_handles_of_clients(court: simkit.Simulation) -> None:
    heard = court.subscribe("/cmd_vel")
    with Server(court) as server:
        caller = Caller(server)
        caller.ask("subscribe", number=1, topic="/imu", depth=10)
        caller.ask("advertise", number=1, topic="/cmd_vel", type=None)
        server.poll(0.1)
        server.poll()
        court.step(50)
        court.reset()
        caller.send(message_frame(1, msgs.serialize(msgs.make("geometry_msgs/msg/Twist", linear={"x": 0.5}))))
        server.poll(0.1)
        court.step(50)
        assert heard.latest is not None and heard.latest.linear.x == 0.5
        server.feeds.deliver_ready()
        times = [entry[1] for entry in queued(next(iter(server.peers.values())), 1)]
        assert times[-5:] == [10_000_000, 20_000_000, 30_000_000, 40_000_000, 50_000_000]
        caller.socket.close()


def test_clients_take_turns(court: simkit.Simulation) -> None:
    with Server(court) as server:
        flood, modest = Caller(server), Caller(server)
        server.poll()
        flood.ask("advertise", number=1, topic="/cmd_vel", type=None)
        server.poll()
        frame = message_frame(1, msgs.serialize(msgs.make("geometry_msgs/msg/Twist")))
        while flood.send(frame * 100) == len(frame) * 100:
            pass
        modest.ask("ping")
        court.paused = True
        words: list[dict[str, Any]] = []
        while not any(w.get("ok") == "pong" for w in words):
            server.poll()
            words += modest.heard()
        assert server._busy, "the other has more to say"
        for caller in (flood, modest):
            caller.socket.close()


def test_no_command_is_dropped_during_a_run(court: simkit.Simulation) -> None:
    heard: list[Any] = []
    court.communication.bus.listen("/numbers", ["std_msgs/msg/Int32"], heard.append, depth=10)
    with Server(court) as server:
        caller = Caller(server)
        server.poll()
        caller.ask("advertise", number=1, topic="/numbers", type=None)
        for n in range(95):
            caller.send(message_frame(1, msgs.serialize(msgs.make("std_msgs/msg/Int32", data=n))))
        steps = 0
        while len(heard) < 95:
            server.poll()
            court.step()
            steps += 1
        assert [m.data for m in heard] == list(range(95))
        assert 10 <= steps <= 13, "ten of them a step"
        assert not court.communication.bus.dropped
        caller.socket.close()


def test_json_of_answers_has_infinity_and_arrays() -> None:
    import numpy as np

    content = {"id": 1, "ok": [float("inf"), np.float64(0.5), np.array([1, 2]), b"ab", {3}]}
    assert read_json_frame(json_frame(2, content)[5:])[0]["ok"] == [float("inf"), 0.5, [1, 2], [97, 98], [3]]
    assert json.loads("[Infinity]") == [float("inf")]


def test_unused_topics_are_removed(court: simkit.Simulation) -> None:
    bus = court.communication.bus
    before = len(bus._readers), len(bus._publishers), len(bus._listeners)
    with Server(court) as server:
        caller = Caller(server)
        for n in range(50):
            caller.ask("subscribe", number=n, topic=f"/heard_{n}", depth=1)
            caller.ask("advertise", number=n, topic=f"/said_{n}", type="std_msgs/msg/Empty")
        while not server.peers or len(next(iter(server.peers.values())).publishers) < 50:
            server.poll(0.1)
        assert len(bus._readers) == before[0] + 100
        caller.socket.close()
        server.poll(0.1)
    assert (len(bus._readers), len(bus._publishers), len(bus._listeners)) == before


def test_a_fault_of_simkit_is_logged_once(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, court: simkit.Simulation
) -> None:
    def broken(request: object) -> object:
        raise KeyError("secret of the client")

    monkeypatch.setitem(answering._HANDLERS, "state", broken)
    monkeypatch.setattr(request_fields, "_LOGGED", set())
    with Server(court) as server:
        caller = Caller(server)
        for _ in range(3):
            caller.ask("state")
            server.poll(0.05)
        for _ in range(10):
            server.poll(0.01)
        answers = [words for words in caller.heard() if "error" in words]
        caller.socket.close()
    assert [words["code"] for words in answers] == ["SK-LIVE-008"] * 3
    assert "secret" not in str(answers)
    (line,) = [record.getMessage() for record in caplog.records if "SK-LIVE-010" in record.getMessage()]
    assert "KeyError at " in line and "test_faults.py:" in line and "secret" not in line
