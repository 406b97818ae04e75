"""Clients with Foxglove's WebSocket protocol."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from simkit import msgs

Connect = Callable[..., Any]


@pytest.fixture(scope="module")
def running(court: Path, start_run: Callable[..., Any]) -> Iterator[Any]:
    """A run at real time with a server for Foxglove."""
    with start_run(court, "--rtf", "1", "--foxglove=0") as run:
        yield run


@pytest.fixture
def client(running: Any, connect: Connect) -> Any:
    """A client that has received the channels and the services."""
    client = connect(running.addresses["foxglove"], subprotocols=["foxglove.sdk.v1"])
    client.info = client.until_op("serverInfo")
    client.channels = {row["topic"]: row for row in client.until_op("advertise")["channels"]}
    client.services = {row["name"]: row for row in client.until_op("advertiseServices")["services"]}
    return client


def _is_binary(op: int) -> Callable[[Any], bool]:
    return lambda data: isinstance(data, bytes) and data[0] == op


def _subscribe(client: Any, topic: str, number: int) -> tuple[int, bytes]:
    """Subscribe; return time and CDR of the first message."""
    client.send("subscribe", subscriptions=[{"id": number, "channelId": client.channels[topic]["id"]}])
    data = client.until(lambda found: _is_binary(1)(found) and struct.unpack_from("<I", found, 1)[0] == number)
    return struct.unpack_from("<Q", data, 5)[0], data[13:]


def test_the_server_names_its_capabilities_and_channels_with_schemas(client: Any) -> None:
    assert client.socket.subprotocol == "foxglove.sdk.v1"
    assert {"clientPublish", "time", "parameters", "services", "assets"} <= set(client.info["capabilities"])
    odometry = client.channels["/odom"]
    assert (odometry["encoding"], odometry["schemaEncoding"]) == ("cdr", "ros2msg")
    assert odometry["schema"] == msgs.definition("nav_msgs/msg/Odometry")
    assert client.services["/add"]["request"]["schema"] == "int64 a\nint64 b\n"


def test_messages_arrive_as_cdr_with_their_time_and_the_clock_goes_on(client: Any) -> None:
    first, cdr = _subscribe(client, "/scan", 7)
    scan = msgs.deserialize(cdr, "sensor_msgs/msg/LaserScan")
    assert len(scan.ranges) == 8 and abs(msgs.stamp_ns(scan.header.stamp) - first) < 10**9
    later = client.until(lambda data: _is_binary(2)(data) and struct.unpack_from("<Q", data, 1)[0] > first + 10**8)
    assert len(later) == 9
    client.send("unsubscribe", subscriptionIds=[7])


@pytest.mark.parametrize("encoding", ["cdr", "json"])
def test_a_client_drives_the_rover(client: Any, encoding: str) -> None:
    speed = 0.5 if encoding == "cdr" else -0.5
    twist = {"linear": {"x": speed}}
    payload = json.dumps(twist).encode()
    if encoding == "cdr":
        payload = msgs.serialize(msgs.make("geometry_msgs/msg/Twist", **twist))
    row = {"id": 3, "topic": "/cmd_vel", "encoding": encoding, "schemaName": "geometry_msgs/msg/Twist"}
    client.send("advertise", channels=[row])
    client.send("getParameters", parameterNames=[], id="opened")
    client.until_op("parameterValues")
    client.socket.send(struct.pack("<BI", 1, 3) + payload)
    client.send("subscribe", subscriptions=[{"id": 1, "channelId": client.channels["/odom"]["id"]}])

    def is_driving(data: Any) -> bool:
        if not _is_binary(1)(data):
            return False
        linear = msgs.deserialize(data[13:], "nav_msgs/msg/Odometry").twist.twist.linear
        return bool(linear.x * speed > 0.2)

    assert client.until(is_driving)


@pytest.mark.parametrize("encoding", ["cdr", "json"])
def test_services_are_called(client: Any, encoding: str) -> None:
    fields = {"a": 40, "b": 2}
    payload = json.dumps(fields).encode()
    if encoding == "cdr":
        payload = msgs.serialize(msgs.make("example_interfaces/srv/AddTwoInts_Request", **fields))
    service = client.services["/add"]["id"]
    head = struct.pack("<BIII", 2, service, 11, len(encoding)) + encoding.encode()
    client.socket.send(head + payload)
    found = client.until(_is_binary(3))
    assert struct.unpack_from("<II", found, 1) == (service, 11)
    answer = found[13 + len(encoding) :]
    if encoding == "cdr":
        assert msgs.deserialize(answer, "example_interfaces/srv/AddTwoInts_Response").sum == 42
    else:
        assert json.loads(answer) == {"sum": 42}
    client.socket.send(struct.pack("<BIII", 2, 9999, 12, 3) + b"cdr")
    assert client.until_op("serviceCallFailure")["callId"] == 12


@pytest.mark.slow
def test_parameters_are_read_set_and_watched(client: Any) -> None:
    name = "/Counter.gain"
    client.send("getParameters", parameterNames=[], id="all")
    found = client.until_op("parameterValues")
    assert found["id"] == "all" and [row["name"] for row in found["parameters"]] == [name]
    client.send("subscribeParameterUpdates", parameterNames=[name])
    client.until_op("parameterValues")
    client.send("setParameters", parameters=[{"name": name, "value": 2}], id="set")
    expected = {"name": name, "value": 2.0, "type": "float64"}
    assert client.until(lambda words: isinstance(words, dict) and words.get("id") == "set")["parameters"] == [expected]
    assert client.until_op("parameterValues")["parameters"] == [expected]
    client.send("setParameters", parameters=[{"name": name, "value": 99}])
    assert "gain" in client.until_op("status")["message"]


def test_meshes_of_the_world_are_fetched_and_no_other_file(client: Any, court: Path) -> None:
    client.send("fetchAsset", uri="meshes/tetra.stl", requestId=5)
    found = client.until(_is_binary(4))
    assert struct.unpack_from("<IBI", found, 1) == (5, 0, 0) and found[10:].startswith(b"solid t")
    (court.parent / "meshes/linked.png").symlink_to(court.parent / "counter.py")
    for uri in (
        "meshes/secret.txt",
        "meshes/linked.png",
        "meshes/..%2Fcounter.png",
        "meshes/../court.sdf",
        (court.parent / "counter.py").as_uri(),
        "file:///etc/passwd",
    ):
        client.send("fetchAsset", uri=uri, requestId=6)
        found = client.until(_is_binary(4))
        assert struct.unpack_from("<IB", found, 1) == (6, 1) and b"is no mesh of the simulation" in found


def test_invalid_data_have_a_status_and_the_connection_stays(client: Any) -> None:
    wrong: list[Any] = [
        *("no JSON", "[1]", "{}", b"", b"\1", b"\1\2\0\0\0", b"\x63\0\0\0\0", b"\2\0\0\0\0", {"op": "dance"}),
        {"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 10**6}]},
        {"op": "advertise", "channels": [{"id": 1, "topic": "/x", "encoding": "cdr", "schemaName": "a/B"}]},
        {
            "op": "advertise",
            "channels": [{"id": 1, "topic": "/x", "encoding": "ros1", "schemaName": "std_msgs/Bool"}],
        },
        {"op": "unsubscribe", "subscriptionIds": [77]},
    ]
    for data in wrong:
        client.socket.send(json.dumps(data) if isinstance(data, dict) else data)
        assert client.until_op("status")["level"] == 2, data
    _subscribe(client, "/imu", 2)


@pytest.mark.slow
def test_a_robot_in_urdf_has_its_description(court: Path, start_run: Callable[..., Any], connect: Connect) -> None:
    robot = court.parent / "robot.urdf"
    robot.write_text(
        '<robot name="box"><link name="base"><visual><geometry><mesh filename="meshes/tetra.stl"/></geometry></visual>'
        '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
        "</robot>"
    )
    with start_run(robot, "--rtf", "1", "--foxglove=0") as run:
        client = connect(run.addresses["foxglove"], subprotocols=["foxglove.websocket.v1"])
        client.channels = {row["topic"]: row for row in client.until_op("advertise")["channels"]}
        text = msgs.deserialize(_subscribe(client, "/robot_description", 1)[1], "std_msgs/msg/String").data
        uri = (court.parent / "meshes" / "tetra.stl").resolve().as_uri()
        assert uri in text
        client.send("fetchAsset", uri=uri, requestId=1)
        assert client.until(_is_binary(4))[10:].startswith(b"solid t")


def test_odd_requests_are_answered_and_a_client_that_dies_ends_no_other(
    running: Any, client: Any, connect: Connect
) -> None:
    client.send("getParameters", parameterNames=5, id="odd")
    assert "must be a list" in client.until_op("status")["message"]
    for _ in range(3):
        dying = connect(running.addresses["foxglove"], subprotocols=["foxglove.sdk.v1"])
        dying.send("subscribeParameterUpdates", parameterNames=["/Counter.gain"])
        dying.send("setParameters", parameters=[{"name": "/Counter.gain", "value": "much"}])
        dying.socket.socket.close()
    for number in range(3):
        client.send("getParameters", parameterNames=["/Counter.gain"], id=f"after {number}")
        found = client.until_op("parameterValues")
        assert (found["id"], len(found["parameters"])) == (f"after {number}", 1)
