"""Clients of rosbridge: roslibpy, and WebSockets that break the rules."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from simkit.errors import InputError
from simkit_view.cli.run_parts.web_servers import WebServers

Connect = Callable[..., Any]
STATE = re.compile(r"^state (\w+)", re.MULTILINE)


@pytest.fixture(scope="module")
def client(running: Any) -> dict[str, Any]:
    """What a script with roslibpy has seen."""
    pytest.importorskip("roslibpy", reason="needs roslibpy")
    port = running.addresses["rosbridge"].rpartition(":")[2]
    script = Path(__file__).parent / "roslibpy_client.py"
    found = subprocess.run([sys.executable, str(script), port], capture_output=True, text=True, timeout=120)
    assert found.returncode == 0, found.stderr
    answer: dict[str, Any] = json.loads(found.stdout.strip().splitlines()[-1])
    return answer


def test_roslibpy_subscribes_and_its_commands_drive_the_rover(client: dict[str, Any]) -> None:
    assert client["scans"] and client["is_moved"]


def test_ranges_beyond_the_lidar_are_null(client: dict[str, Any]) -> None:
    assert len(client["ranges"]) == 8 and client["ranges"][4] is None


def test_rosapi_lists_the_graph(client: dict[str, Any]) -> None:
    assert client["topic_type"] == "nav_msgs/msg/Odometry"
    assert {"/odom", "/scan", "/imu", "/cmd_vel"} <= set(client["topics"])
    assert "/rosbridge_2" in client["nodes"]
    assert client["parameters"] == ["/Counter:gain"] and client["gain"] == 1.5


def test_services_are_called_with_errors_as_texts_and_answered_by_roslibpy(client: dict[str, Any]) -> None:
    assert client["sum"] == 5
    assert "found 'two'" in client["wrong"]
    assert client["own"] == {"success": True, "message": "got True"}


def test_goals_succeed_with_feedback_are_cancelled_and_are_rejected(client: dict[str, Any]) -> None:
    assert client["goal"] == {"status": 4, "values": {"sequence": [0, 1, 1, 2, 3, 5]}}
    assert client["feedback"] == 4
    assert client["cancelled"] == {"status": 5, "values": {"sequence": [7]}}
    assert "too far" in client["rejected"]["values"]


def test_every_invalid_message_has_a_status_and_the_connection_stays(running: Any, connect: Connect) -> None:
    socket = connect(running.addresses["rosbridge"])
    wrong: list[Any] = [
        *("no JSON", "[1]", b"\xff\xff\xff", "[" * 5000, "{}"),
        *({"op": "dance"}, {"op": "publish"}, {"op": "publish", "topic": "/cmd_vel", "msg": {"linear": 5}}),
        *({"op": "publish", "topic": "/new", "msg": {}}, {"op": "advertise", "topic": "/x", "type": "a/B"}),
        *({"op": "subscribe", "topic": 5, "throttle_rate": "often"}, {"op": "service_response", "id": 1}),
        *({"op": "cancel_action_goal", "id": "none"}, {"op": "advertise_service", "service": "/s", "type": "a/B"}),
        {"op": "publish", "topic": "/cmd_vel", "type": "geometry_msgs/msg/Twist", "msg": {"linear": {"x": "fast"}}},
    ]
    for data in wrong:
        socket.socket.send(json.dumps(data) if isinstance(data, dict) else data)
        assert socket.until_op("status")["level"] == "error", data
    socket.send("call_service", service="/add", args=[20, 22], id="after")
    assert socket.until_op("service_response")["values"] == {"sum": 42}


def test_a_request_that_fails_when_its_answer_comes_ends_nothing(running: Any, connect: Connect) -> None:
    socket = connect(running.addresses["rosbridge"])
    for service, args in (
        ("/rosapi/topic_type", {}),
        ("/rosapi/node_details", {"node": ["a"]}),
        ("/rosapi/publishers", {}),
        ("/rosapi/get_param", {"name": {}}),
    ):
        socket.send("call_service", service=service, args=args, id=service)
        found = socket.until_op("service_response")
        assert (found["id"], found["result"]) == (service, False), found
    socket.send("call_service", service="/add", args=[20, 22], id="after")
    assert socket.until_op("service_response")["values"] == {"sum": 42}


def test_throttled_topics_keep_the_newest_messages_and_two_ids_share_one_stream(running: Any, connect: Connect) -> None:
    socket = connect(running.addresses["rosbridge"])
    for identifier in ("a", "b"):
        socket.send("subscribe", topic="/imu", id=identifier, throttle_rate=200, queue_length=1)
    stamps = [socket.until_op("publish")["msg"]["header"]["stamp"] for _ in range(4)]
    times = [stamp["sec"] + stamp["nanosec"] * 1e-9 for stamp in stamps]
    assert times == sorted(set(times)) and times[-1] - times[0] > 0.05  # 0.03 s for four readings in a row
    socket.send("unsubscribe", topic="/imu", id="a")
    socket.until_op("publish")
    socket.send("unsubscribe", topic="/imu")
    socket.send("call_service", service="/rosapi/get_time", id="last")
    socket.until_op("service_response")


def test_cbor_carries_arrays_of_numbers_and_the_raw_message(running: Any, connect: Connect) -> None:
    cbor2 = pytest.importorskip("cbor2")
    socket = connect(running.addresses["rosbridge"])
    socket.send("subscribe", topic="/scan", compression="cbor")
    found = cbor2.loads(socket.until(lambda data: isinstance(data, bytes)))
    ranges = found["msg"]["ranges"]
    assert ranges.tag == 85 and len(ranges.value) == 8 * 4
    raw = connect(running.addresses["rosbridge"])
    raw.send("subscribe", topic="/scan", compression="cbor-raw")
    assert cbor2.loads(raw.until(lambda data: isinstance(data, bytes)))["msg"]["bytes"][:4] == b"\0\1\0\0"


@pytest.mark.slow
def test_clients_that_flood_send_garbage_or_never_read_change_no_bit(
    court: Path, start_run: Callable[..., Any], connect: Connect
) -> None:
    with start_run(court, "--duration", "3") as run:
        alone = STATE.search(run.end()[0])
    with start_run(court, "--duration", "3", "--rtf", "1", "--rosbridge=0") as run:
        address = run.addresses["rosbridge"]
        deaf, loud = connect(address), connect(address)
        for number in range(1100):
            deaf.send("subscribe", topic=f"/none_{number}" if number % 2 else "/imu", id=number)
            loud.socket.send("garbage" * 100)
        loud.socket.socket.close()
        reader = connect(address)
        reader.send("subscribe", topic="/imu")
        assert reader.until_op("publish")["msg"]["linear_acceleration"]["z"] == pytest.approx(9.8, abs=0.1)
        beside = STATE.search(run.end()[0])
    assert alone is not None and beside is not None and alone[1] == beside[1]


@pytest.mark.slow
def test_a_run_goes_on_when_its_server_is_killed_and_says_so(court: Path, start_run: Callable[..., Any]) -> None:
    with start_run(court, "--duration", "2", "--rtf", "1", "--rosbridge=0") as run:
        for thread in Path(f"/proc/{run.process.pid}/task").glob("*/children"):  # a bare system has no `ps`
            for child in thread.read_text().split():
                os.kill(int(child), signal.SIGKILL)
        out, errors = run.end()
        assert run.process.returncode == 0 and "simulated 2.000 s" in out
        assert "warning SK-WEB-004: the rosbridge server has ended (signal SIGKILL)" in errors


@pytest.mark.slow
def test_a_token_of_the_environment_is_required_in_the_address_or_as_op_auth(
    court: Path, start_run: Callable[..., Any], connect: Connect
) -> None:
    from websockets.exceptions import InvalidStatus

    with start_run(court, "--rtf", "1", "--rosbridge=0", SIMKIT_WEB_TOKEN="s3cret") as run:
        address = run.addresses["rosbridge"]
        assert address.endswith("/?token=s3cret")
        bare = address.partition("/?")[0]
        connect(address).send("subscribe", topic="/imu")
        late = connect(bare)
        late.send("subscribe", topic="/imu")
        assert "token" in late.until_op("status")["msg"]
        late.send("auth", token="wrong")
        assert "wrong" in late.until_op("status")["msg"]
        late.send("auth", mac="s3cret")
        late.send("subscribe", topic="/imu")
        late.until_op("publish")
        with pytest.raises(InvalidStatus, match="401"):
            connect(f"{bare}/?token=other")


def test_pages_of_other_servers_are_refused_without_a_token(running: Any, connect: Connect) -> None:
    from websockets.exceptions import InvalidStatus

    for origin in ("http://localhost:8000", "https://app.foxglove.dev", "file://"):
        connect(running.addresses["rosbridge"], origin=origin)
    for origin in ("https://example.com", "null"):
        with pytest.raises(InvalidStatus, match="403"):
            connect(running.addresses["rosbridge"], origin=origin)


@pytest.mark.slow
def test_a_port_in_use_ends_the_command_with_the_reason(running: Any) -> None:
    port = running.addresses["rosbridge"].rpartition(":")[2]
    command = [sys.executable, "-m", "simkit", "run", "turtlebot3_empty", "--rosbridge", port, "--duration", "1"]
    found = subprocess.run(command, capture_output=True, text=True)
    assert found.returncode == 2
    assert f"SK-WEB-002 the rosbridge server cannot start: 127.0.0.1:{port}" in found.stderr.replace("\n", " ")
    assert "choose another port, such as --rosbridge 0" in found.stderr


def test_addresses_are_ports_with_an_optional_host(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("SIMKIT_WEB_TOKEN", raising=False)
    local, remote, six = (WebServers(rosbridge=text).servers[0] for text in ("", "0.0.0.0:8080", "[::1]:0"))
    assert (local.host, local.port, local.token) == ("127.0.0.1", 9090, "")
    assert (remote.host, remote.port) == ("0.0.0.0", 8080) and len(remote.token) == 16
    assert (six.host, six.port, six.token) == ("::1", 0, "")
    assert WebServers().servers == []
    for wrong in ("99999", "port", "host:", "a/b:3"):
        with pytest.raises(InputError, match="SK-WEB-003 --rosbridge: found"):
            WebServers(rosbridge=wrong)
