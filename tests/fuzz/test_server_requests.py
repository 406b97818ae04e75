"""Clients that send every server of a run each kind of JSON value in each field.

Each answer is plain English with a code; no answer and no line of the run shows the inside of a Python program.
"""

from __future__ import annotations

import itertools
import json
import os
import re
import socket
import struct
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from simkit.bridges.live.protocol import ANSWER, ASK, LARGEST_OUT, TELL, FrameReader, json_frame, read_json_frame

pytestmark = [
    pytest.mark.fuzz,
    pytest.mark.needs_packs,
    pytest.mark.skipif(sys.platform == "win32", reason="sockets of POSIX"),
]
TIMEOUT = 60.0
BOT = """<sdf version="1.9"><world name="yard"><plugin filename="desk.py" name="Desk"/>
<model name="rover"><pose>0 0 0.1 0 0 0</pose><link name="base"><collision name="c"><geometry><box>
<size>0.4 0.2 0.1</size></box></geometry></collision></link><plugin filename="gz-sim-velocity-control-system"
name="gz::sim::systems::VelocityControl"><topic>/cmd_vel</topic></plugin></model>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
</link></model></world></sdf>"""
DESK = '''
import simkit


class Desk(simkit.WorldPlugin):
    """Offers a service, an action and a parameter."""

    def load(self, sim, params):
        self.declare("gain", 1.0, minimum=0.0, maximum=2.0, description="of nothing")
        self.act("/count", "example_interfaces/action/Fibonacci", lambda goal: goal.reject("too far"))
        self.offer("/add", "example_interfaces/srv/AddTwoInts", lambda r: {"sum": r.a + r.b})
'''
RAW = {
    "nothing": "null",
    "true": "true",
    "a number": "7",
    "a negative number": "-3",
    "a fraction": "0.5",
    "a large number": "1e300",
    "an infinite number": "1e999",
    "NaN": "NaN",
    "-Infinity": "-Infinity",
    "a number of 400 digits": "9" * 400,
    "a number of 5000 digits": "9" * 5000,
    "an empty text": '""',
    "a text": '"text"',
    "half of a character": '"\\ud800"',
    "a zero byte": '"a\\u0000b"',
    "a long text": json.dumps("x" * 5000),
    "a list": "[]",
    "a list of texts": '["a"]',
    "a list of objects": '[{}, {"id": []}]',
    "an object": "{}",
    "a nested object": '{"a": {"b": [1]}}',
}
INSIDE = re.compile(
    r"object has no attribute|unhashable|object is not|object cannot|Traceback|<class '|<function|must be str\b"
    r"|must be real number|could not convert|codec can't|invalid literal|cannot convert|Exceeds the limit|NoneType"
    r"|not subscriptable|\bint\(\)|\bfloat\(\)|'(int|str|list|dict|float|bool|bytes|tuple)'|lambda|unpack"
    r"|of type (int|str|list|dict|float|bool)\b|\b[A-Z]\w+(Error|Exception)\b|numpy|\bdtype\b|required argument"
    r"|not supported between|argument of type|unexpected keyword|positional argument|format requires|large to convert"
)
CODE = re.compile(r"SK-[A-Z]+-\d{3}")


def faults(text: str) -> list[str]:
    """Return what is wrong with the text of an error for a client."""
    found = [f"inside of Python: {match[0]}"] if (match := INSIDE.search(text)) else []
    return found if CODE.search(text) else [*found, "no code"]


ROSBRIDGE: dict[str, dict[str, Any]] = {
    "auth": {"token": "a", "mac": "b", "id": "i"},
    "advertise": {"topic": "/t", "type": "std_msgs/msg/Float64", "latch": False, "id": "i", "queue_size": 1},
    "unadvertise": {"topic": "/t", "id": "i"},
    "publish": {"topic": "/cmd_vel", "type": "geometry_msgs/msg/Twist", "latch": False, "msg": {}, "id": "i"},
    "subscribe": {
        "topic": "/s",
        "type": "std_msgs/msg/Bool",
        "throttle_rate": 0,
        "queue_length": 0,
        "compression": "none",
        "id": "i",
        "fragment_size": 9,
    },
    "unsubscribe": {"topic": "/s", "id": "i"},
    "call_service": {"service": "/add", "args": [1, 2], "id": "i", "type": "a/B", "compression": "none"},
    "advertise_service": {"service": "/o", "type": "std_srvs/SetBool", "id": "i"},
    "unadvertise_service": {"service": "/o", "id": "i"},
    "service_response": {"id": "i", "service": "/o", "values": {}, "result": True},
    "send_action_goal": {"action": "/count", "action_type": "a/B", "args": {"order": 3}, "feedback": True, "id": "i"},
    "cancel_action_goal": {"action": "/count", "id": "i"},
    "set_level": {"level": "none", "id": "i"},
    "dance": {"id": "i"},
}
ROSAPI = {
    "topic_type": "topic",
    "topics_for_type": "type",
    "publishers": "topic",
    "subscribers": "topic",
    "service_type": "service",
    "services_for_type": "type",
    "node_details": "node",
    "message_details": "type",
    "service_request_details": "type",
    "service_response_details": "type",
    "has_param": "name",
    "get_param": "name",
    "set_param": "name",
}
FOXGLOVE: dict[str, dict[str, Any]] = {
    "subscribe": {"subscriptions": [{"id": 1, "channelId": 1}]},
    "unsubscribe": {"subscriptionIds": [1]},
    "advertise": {"channels": [{"id": 1, "topic": "/t", "encoding": "json", "schemaName": "std_msgs/msg/Bool"}]},
    "unadvertise": {"channelIds": [1]},
    "getParameters": {"parameterNames": ["/Desk.gain"], "id": "i"},
    "setParameters": {"parameters": [{"name": "/Desk.gain", "value": 1.5, "type": "float64"}], "id": "i"},
    "subscribeParameterUpdates": {"parameterNames": ["/Desk.gain"]},
    "unsubscribeParameterUpdates": {"parameterNames": ["/Desk.gain"]},
    "subscribeConnectionGraph": {},
    "fetchAsset": {"uri": "package://a/b.stl", "requestId": 1},
    "dance": {},
}
PAGE: dict[str, dict[str, Any]] = {
    "pause": {"value": False},
    "step": {"count": 1},
    "pace": {"value": 1.0},
    "reset": {},
    "travel": {},
    "targets": {},
    "drive": {"topic": "/cmd_vel", "ahead": 0.0, "left": 0.0, "turn": 0.0},
    "key": {"topic": "/cmd_vel", "key": "w"},
    "pose": {"kind": "goal", "x": 1, "y": 1, "yaw": 0, "topic": "/goal_pose"},
    "joint": {"name": "j", "value": 1},
    "spawnable": {},
    "spawn": {"source": "none", "name": "n", "x": 1, "y": 1, "z": 1, "yaw": 0},
    "model_pose": {"name": "rover"},
    "move": {"name": "rover", "position": [1, 1, 1], "quaternion": [1, 0, 0, 0]},
    "remove": {"name": "none"},
    "interfaces": {},
    "describe": {"kind": "service", "name": "/add"},
    "call": {"name": "/add", "values": {"a": 1, "b": 2}},
    "goal": {"name": "/count", "values": {"order": 3}},
    "cancel": {"goal": 1},
    "set_parameter": {"node": "/Desk", "name": "gain", "value": 1.5},
    "log": {"after": 0},
    "dance": {},
}
LIVE: dict[str, dict[str, Any]] = {
    "ping": {},
    "interfaces": {},
    "node": {"name": "n", "is_bridge": False},
    "state": {},
    "control": {"action": "step", "value": 1},
    "topics": {},
    "subscribe": {"number": 1, "topic": "/clock", "depth": 10},
    "unsubscribe": {"number": 1},
    "advertise": {"number": 2, "topic": "/t", "type": "std_msgs/msg/Bool", "latched": False},
    "unadvertise": {"number": 2},
    "services": {},
    "actions": {},
    "goal": {"number": 3, "name": "/count", "fields": {"order": 3}, "type": None},
    "cancel": {"number": 3},
    "parameters": {},
    "set_parameter": {"node": "/Desk", "name": "gain", "value": 1.5},
    "nodes": {},
    "models": {},
    "view": {"rest": 1},
    "model": {"name": "rover"},
    "call": {"name": "/add", "fields": {"a": 1, "b": 2}, "type": None},
    "offer": {"number": 4, "name": "/o", "type": "std_srvs/srv/SetBool"},
    "respond": {"number": 4, "call": 1, "error": None, "type": None, "fields": {}},
    "act": {"number": 5, "name": "/a", "type": "example_interfaces/action/Fibonacci", "cancels": True},
    "update_goal": {"number": 5, "goal": 1, "change": "succeed", "reason": "", "type": None, "fields": {}},
    "listen": {"number": 6, "topic": "/l", "types": ["std_msgs/msg/Bool"], "depth": 3},
    "declare": {
        "number": 7,
        "node": None,
        "name": "p",
        "value": 1.0,
        "minimum": None,
        "maximum": None,
        "choices": [],
        "description": "d",
    },
    "close_endpoint": {"number": 7},
    "subscribers": {"number": 2},
    "log": {"number": 8, "file": "f", "function": "g", "line": 1, "level": 20, "text": "t"},
    "graph": {"revision": 1},
    "goal_result": {"action": "example_interfaces/action/Fibonacci", "status": 4},
    "robot_description": {"name": "rover"},
    "asset": {"uri": "file:///a.stl"},
    "default_message": {"type": "std_msgs/msg/Bool"},
    "dance": {},
}


def variants(requests: dict[str, dict[str, Any]], key: str) -> Iterator[str]:
    """Yield the JSON of each request with each value in each field, with each field left out, and with inner rows."""
    for name, fields in requests.items():
        whole: dict[str, Any] = {key: name, **fields}
        yield json.dumps(whole)
        for field in whole:
            yield json.dumps({k: v for k, v in whole.items() if k != field})
            for raw in RAW.values():
                yield _with(whole, field, raw)
        for field, value in fields.items():
            row = value[0] if isinstance(value, list) and value else value
            for inner in row if isinstance(row, dict) else ():
                for raw in RAW.values():
                    text = _with(row, inner, raw)
                    yield _with(whole, field, f"[{text}]" if isinstance(value, list) else text)
            if isinstance(value, list):
                for raw in RAW.values():
                    yield _with(whole, field, f"[{raw}]")


def _with(fields: dict[str, Any], field: str, raw: str) -> str:
    return json.dumps({**fields, field: "@"}).replace('"@"', raw, 1)


def rosbridge_requests() -> Iterator[str]:
    yield from ("[]", "7", "null", '"a"', "{", "[" * 5000, "", "{}", '{"op": "publish", "op": []}', *RAW.values())
    for text in variants(ROSBRIDGE, "op"):
        if '"set_level"' not in text:
            yield text
    for name, field in ROSAPI.items():
        request: dict[str, Any] = {"op": "call_service", "service": f"/rosapi/{name}", "id": "i"}
        yield json.dumps(request)
        for raw in RAW.values():
            yield _with({**request, "args": 0}, "args", raw)
            yield _with({**request, "args": 0}, "args", f'{{"{field}": {raw}}}')
            yield _with({**request, "args": 0}, "args", f'{{"{field}": "/Desk:gain", "value": {raw}}}')


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[dict[str, str], Path, Callable[[], str]]]:
    """Addresses of the servers of a run, its socket, and a function that ends the run and returns its output."""
    folder = tmp_path_factory.mktemp("yard")
    (folder / "yard.sdf").write_text(BOT)
    (folder / "desk.py").write_text(DESK)
    options = ["--rtf", "2", "--rosbridge=0", "--foxglove=0", "--web", "--no-open", "--plugin-path", str(folder)]
    with tempfile.TemporaryDirectory(prefix="sk", dir="/tmp") as sockets, (folder / "log").open("w") as log:
        process = subprocess.Popen(
            [sys.executable, "-m", "simkit", "run", str(folder / "yard.sdf"), *options],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "XDG_RUNTIME_DIR": sockets},
        )
        assert process.stderr is not None and process.stdout is not None
        found: dict[str, str] = {}
        while len(found) < 3:
            line = process.stderr.readline()
            assert line, "the run has ended"
            log.write(line)
            if address := re.search(r"(foxglove|rosbridge): (ws://\S+)", line):
                found[address[1]] = address[2]
            elif address := re.search(r"http://\S+token=\S+", line):
                found["page"] = address[0]
            if "page" not in found and len(found) == 2:
                found["page"] = process.stdout.readline().strip()

        def end() -> str:
            assert process.poll() is None, process.communicate()[1]
            process.terminate()
            return process.communicate(timeout=TIMEOUT)[1]

        yield found, Path(sockets), end
        if process.poll() is None:
            process.kill()
            process.communicate()


def _report(found: dict[str, str]) -> None:
    assert not found, f"{len(found)} answers, such as\n" + "\n".join(
        f"{key}\n    {value}" for key, value in list(found.items())[:40]
    )


def test_rosbridge_answers_in_plain_english(run: Any) -> None:
    from websockets.sync.client import connect

    wrong: dict[str, str] = {}
    with connect(run[0]["rosbridge"], max_size=None) as client:
        for number, text in enumerate(rosbridge_requests()):
            client.send(text)
            client.send(json.dumps({"op": "call_service", "service": "/add", "args": [number, 0], "id": f"@{number}"}))
            while True:
                answer = client.recv(timeout=TIMEOUT)
                said = json.loads(answer, parse_constant=lambda name: f"invalid JSON {name}")
                if said.get("id") == f"@{number}":
                    break
                if "invalid JSON" in str(said):
                    wrong[text[:200]] = f"no JSON: {answer[:200]!r}"
                told = said.get("msg") if said["op"] == "status" else said.get("values")
                if (said.get("level") == "error" or said.get("result") is False) and (bad := faults(str(told))):
                    wrong[text[:200]] = f"{bad} {str(told)[:200]}"
    _report(wrong)


def test_foxglove_answers_in_plain_english(run: Any) -> None:
    from websockets.sync.client import connect

    wrong: dict[str, str] = {}
    contents = {
        b"json": (b"{}", b"[]", b"{", b'{"a": "x"}', b'{"a": ' + b"9" * 400 + b"}"),
        b"cdr": (b"", b"\0\1\0\0"),
        b"\xff\xff": (b"x",),
    }
    binary = [
        b"",
        b"\1",
        b"\1\1\1",
        b"\2",
        b"\2\0\0\0\0",
        b"\3abcdefgh",
        b"\1\xff\xff\xff\xff{}",
        b"\1\1\0\0\0\xff\xff",
    ]
    for service, length in itertools.product((1, 2, 99), (0, 3, 4, 9999)):
        head = struct.pack("<BIII", 2, service, 1, length)
        binary += [head + encoding + content for encoding, found in contents.items() for content in found]
    texts = ["[]", "7", "null", '"a"', "{", "[" * 5000, "", "{}", *RAW.values(), *variants(FOXGLOVE, "op")]
    with connect(run[0]["foxglove"], max_size=None, subprotocols=["foxglove.websocket.v1"]) as client:  # type: ignore[list-item]
        for number, data in enumerate([*texts, *binary]):
            client.send(data)
            client.send(json.dumps({"op": "getParameters", "parameterNames": ["none"], "id": f"@{number}"}))
            while True:
                answer = client.recv(timeout=TIMEOUT)
                if isinstance(answer, bytes):
                    size = struct.unpack_from("<I", answer, 6)[0] if answer[0] == 4 else 0
                    if answer[0] == 4 and answer[5] and (bad := faults(told := answer[10 : 10 + size].decode())):
                        wrong[str(data)[:200]] = f"{bad} {told}"
                    continue
                said = json.loads(answer, parse_constant=lambda name: f"invalid JSON {name}")
                if said.get("id") == f"@{number}":
                    break
                if "invalid JSON" in str(said):
                    wrong[str(data)[:200]] = f"no JSON: {answer[:200]!r}"
                if said["op"] in ("status", "serviceCallFailure") and (bad := faults(said["message"])):
                    wrong[str(data)[:200]] = f"{bad} {said['message'][:200]}"
    _report(wrong)


def test_the_page_answers_in_plain_english(run: Any) -> None:
    from websockets.sync.client import connect

    wrong: dict[str, str] = {}
    texts = ["[]", "7", "null", '"a"', "{", "[" * 5000, "", "{}", *RAW.values(), *variants(PAGE, "do")]
    streams = [
        "topics",
        "log",
        "parameters",
        "sensor:x",
        "frames",
        "series:x",
        "plot",
        "camera:x",
        "display:x",
        "",
        "x",
    ]
    texts += [f'{{"do": "want", "streams": {{"{s}": {raw}}}}}' for s in streams for raw in RAW.values()]
    texts += [f'{{"do": "want", "streams": {raw}}}' for raw in RAW.values()]
    address = run[0]["page"].replace("http:", "ws:").replace("/?", "/ws?")
    with connect(address, max_size=None) as client:
        for number, text in enumerate(texts):
            client.send(text.replace('{"do"', f'{{"id": "t{number}", "do"', 1))
            client.send(json.dumps({"do": "targets", "id": f"@{number}"}))
            while True:
                answer = client.recv(timeout=TIMEOUT)
                if isinstance(answer, bytes):
                    head = answer[4 : 4 + struct.unpack_from("<I", answer)[0]]
                    with suppress(ValueError):
                        if (problem := json.loads(head).get("error")) and (match := INSIDE.search(problem)):
                            wrong[text[:200]] = f"{match[0]}: {problem[:200]}"
                    continue
                said = json.loads(answer, parse_constant=lambda name: f"invalid JSON {name}")
                if said.get("id") == f"@{number}":
                    break
                if "invalid JSON" in str(said):
                    wrong[text[:200]] = f"no JSON: {answer[:200]!r}"
                if "error" in said and (bad := faults(f"{said['error']} {said.get('code')}")):
                    wrong[text[:200]] = f"{bad} {said}"[:300]
    _report(wrong)


def test_the_socket_of_the_run_answers_in_plain_english(run: Any) -> None:
    wrong: dict[str, str] = {}
    last = ""
    for number, text in enumerate(["[]", "7", "{", "", *RAW.values(), *variants(LIVE, "ask")]):
        with socket.socket(socket.AF_UNIX) as link:
            link.settimeout(TIMEOUT)
            path = next(run[1].rglob("*.sock"), None)
            assert path is not None, f"the run has ended after {last}"
            link.connect(str(path))
            last = text[:300]
            body = text.replace('{"ask"', f'{{"id": {number}, "ask"', 1).encode()
            head = struct.pack("<IB", 4 + len(body), ASK) + struct.pack("<I", len(body))
            link.sendall(head + body + json_frame(ASK, {"ask": "ping", "id": 10**9}))
            reader, is_done = FrameReader(LARGEST_OUT, (1, 2, 3, 4)), False
            while not is_done:
                data = link.recv(1 << 16)
                if not data:
                    break
                reader.feed(data)
                while frame := reader.next():
                    if frame[0] not in (ANSWER, TELL):
                        continue
                    said = read_json_frame(frame[1])[0]
                    is_done = is_done or said.get("id") == 10**9 or said.get("tell") == "bye"
                    told = said.get("error") or said.get("why")
                    if told and (bad := faults(f"{told} {said.get('code')}")):
                        wrong[text[:200]] = f"{bad} {told}"[:300]
    _report(wrong)


def test_the_run_goes_on_and_shows_no_traceback(run: Any) -> None:
    text = run[2]()
    assert "error:" not in text, text[-3000:]
    assert "Traceback" not in text and not INSIDE.search(text), text[-3000:]
