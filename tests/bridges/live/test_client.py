"""What a client in another process can do, it can do from another thread as well."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import simkit
from simkit import msgs
from simkit.live import Client, LiveClosed, LiveError, Server, connect, simulations

pytestmark = pytest.mark.parametrize("kind_of_sockets", ["unix", "tcp"], indirect=True)


def test_a_simulation_is_found_by_name_and_describes_itself(client: Client) -> None:
    found = simulations()
    assert [(s.name, s.world) for s in found] == [("court", "court")]
    assert found[0].pid == client.info["pid"] > 0
    with connect("court") as other, connect() as third:
        assert other.info["world"] == third.info["world"] == "court"
        assert len({client.info["node"], other.info["node"], third.info["node"]}) == 3


def test_two_simulations_of_one_world_have_different_names(
    court: simkit.Simulation, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Server(court) as one, Server(court) as two, Server(court, "mine!") as three:
        assert (one.name, two.name, three.name) == ("court", "court_2", "mine_")
        assert [s.name for s in simulations()] == ["court", "court_2", "mine_"]
        with pytest.raises(
            LiveError, match="SK-LIVE-002 3 simulations run \\(court, court_2, mine_\\); choose one with --sim NAME"
        ):
            connect()
        with pytest.raises(LiveError, match="SK-LIVE-003 .*did you mean 'court'"):
            connect("curt")
        monkeypatch.setenv("SIMKIT_SIM", "nobody")
        with pytest.raises(LiveError, match="SK-LIVE-003"):
            connect()
        with pytest.raises(LiveError, match="SK-LIVE-004 simulation 'court' does not answer"):
            connect("court", timeout=0.01)
    with pytest.raises(LiveError, match="SK-LIVE-001"):
        connect()
    assert simulations() == []


def test_a_command_moves_the_robot_and_sensor_messages_arrive(client: Client) -> None:
    imu = client.subscribe("imu")
    publisher = client.advertise("/cmd_vel")
    assert publisher.type_name == "geometry_msgs/msg/Twist"
    publisher.publish({"angular": {"z": 0.5}})
    client.flush()
    first = imu.get(5.0)
    while (received := imu.get(5.0)) is not None and received.message.angular_velocity.z < 0.4:
        pass
    assert first is not None and received is not None
    assert received.type_name == "sensor_msgs/msg/Imu"
    assert (received.time_ns - first.time_ns) % 10_000_000 == 0, "100 Hz"
    assert received.time_ns == msgs.stamp_ns(received.message.header.stamp)
    assert imu.lost == 0
    imu.close()
    pose = client.model("rover")["pose"]
    assert pose["rpy"][2] > 0.0


@pytest.mark.parametrize("form", ["dict", "message", "bytes"])
def test_a_message_is_given_as_a_dict_or_a_message_or_bytes(
    court: simkit.Simulation, run: Callable[..., Any], form: str
) -> None:
    heard = court.subscribe("/cmd_vel")
    with run(court) as client:
        publisher = client.advertise("/cmd_vel", "geometry_msgs/Twist")
        message = msgs.make("geometry_msgs/msg/Twist", linear={"x": 0.25})
        forms = {"dict": {"linear": {"x": 0.25}}, "message": message, "bytes": msgs.serialize(message)}
        publisher.publish(forms[form])
        client.flush()
    assert heard.latest == message


def test_a_mismatched_message_is_reported_before_it_is_sent(client: Client) -> None:
    publisher = client.advertise("/cmd_vel")
    with pytest.raises(simkit.SimkitError, match="did you mean 'linear'"):
        publisher.publish({"liner": {"x": 1.0}})
    with pytest.raises(
        LiveError, match="SK-MSG-001 topic '/cmd_vel' has type .*Twist or .*TwistStamped, got std_msgs/msg/Bool"
    ):
        client.advertise("/cmd_vel", "std_msgs/msg/Bool")
    with pytest.raises(LiveError, match="unknown message type 'geometry_msgs/msg/Twits'; did you mean"):
        client.advertise("/other", "geometry_msgs/msg/Twits")
    with pytest.raises(LiveError, match="does not exist yet, so its type is required"):
        client.advertise("/other")


def test_a_topic_of_a_client_is_listed_while_it_is_open(court: simkit.Simulation, run: Callable[..., Any]) -> None:
    with run(court, node="chatter") as client:
        publisher = client.advertise("/chat", "std_msgs/msg/String")
        client.subscribe("/chat")
        row = next(t for t in client.topics() if t["name"] == "/chat")
        end = {"node": "/chatter", "type": "std_msgs/msg/String", "latched": False}
        assert row["types"] == ["std_msgs/msg/String"] and row["publishers"] == [end]
        assert [s["node"] for s in row["subscribers"]] == ["/chatter"]
        assert list(client.ask("nodes")["/chatter"]["publishers"]) == ["/chat"]
        publisher.close()
        assert "/chat" not in {t["name"] for t in client.topics()}
    assert "/chat" not in court.topics()


def test_a_late_subscriber_gets_the_last_message_of_a_latched_topic(
    court: simkit.Simulation, run: Callable[..., Any]
) -> None:
    court.communication.bus.advertise("/map_name", "std_msgs/msg/String", latched=True).publish(
        msgs.make("std_msgs/msg/String", data="hall")
    )
    with run(court) as client:
        for _ in range(3):
            received = client.subscribe("/map_name").get(5.0)
            assert received is not None and received.message.data == "hall"


def test_a_full_queue_keeps_the_newest_messages_and_counts_the_dropped_ones(
    court: simkit.Simulation, run: Callable[..., Any]
) -> None:
    talker = court.communication.bus.advertise("/count", "std_msgs/msg/Int32")
    calls: list[Any] = []
    with run(court, calls=calls) as client:
        few = client.subscribe("/count", depth=5)
        numbers = [msgs.make("std_msgs/msg/Int32", data=n) for n in range(20)]
        calls.append(lambda _: list(map(talker.publish, numbers)))
        found = [few.get(5.0) for _ in range(5)]
        assert [f.message.data for f in found if f] == [15, 16, 17, 18, 19]
        assert few.lost == 15


def test_services_answer_and_report_errors(client: Client) -> None:
    assert client.services()["/world/court/control"] == "ros_gz_interfaces/srv/ControlWorld"
    assert client.call("/world/court/control", {"world_control": {"pause": True}}).success
    assert client.state()["paused"]
    request = msgs.make("ros_gz_interfaces/srv/ControlWorld_Request", world_control={"pause": False})
    assert client.call("/world/court/control", request).success
    assert not client.state()["paused"]
    with pytest.raises(LiveError, match="SK-SERVICE-001 no service '/world/court/contrl'; did you mean"):
        client.call("/world/court/contrl")
    with pytest.raises(LiveError, match="SK-MSG-001 .*has no field 'pause'") as caught:
        client.call("/world/court/control", {"pause": True})
    assert caught.value.code == "SK-MSG-001"


def test_a_simulation_is_paused_stepped_and_slowed_down(client: Client) -> None:
    before = client.control("pause")
    assert before["paused"]
    assert client.control("step", 3)["tick"] == before["tick"]
    while (after := client.state())["tick"] < before["tick"] + 3 or not after["paused"]:
        pass
    assert after["tick"] == before["tick"] + 3
    assert client.control("rtf", 2)["rtf"] == 2.0
    assert client.control("rtf")["rtf"] is None
    assert not client.control("resume")["paused"]
    for action, value in (("step", 0), ("step", 1.5), ("rtf", -1), ("rtf", "fast"), ("rest", None)):
        with pytest.raises(LiveError, match="SK-LIVE-008 .*expected"):
            client.control(action, value)  # type: ignore[arg-type]


def test_models_links_and_joints_are_read(client: Client) -> None:
    assert client.models() == ["ball", "rover", "ground"]
    rover = client.model("rover")
    assert rover["links"]["base"]["pose"]["position"][0] == pytest.approx(3.0, abs=0.01)
    assert not rover["static"] and client.model("ground")["static"]
    with pytest.raises(LiveError, match="did you mean 'rover'"):
        client.model("rovr")


def test_a_goal_has_feedback_and_a_result_and_can_be_rejected_or_cancelled(
    counting: simkit.Simulation, run: Callable[..., Any]
) -> None:
    with run(counting) as client:
        assert client.actions().items() >= {"/count": "example_interfaces/action/Fibonacci"}.items()
        heard: list[int] = []
        goal = client.send_goal("count", {"order": 5}, lambda f: heard.append(len(f.sequence)))
        assert goal.wait(60.0) and goal.status.name == "SUCCEEDED"
        assert list(goal.result.sequence) == [0, 1, 1, 2, 3, 5]
        assert heard == [3, 4, 5, 6]
        refused = client.send_goal("/count", {"order": 90})
        assert refused.wait(60.0) and (refused.status.name, refused.reason) == ("REJECTED", "too far")
        client.control("pause")
        client.flush()
        long = client.send_goal("/count", {"order": 50})
        long.cancel()
        client.control("resume")
        assert long.wait(60.0) and long.status.name == "CANCELED" and list(long.result.sequence) == [7]
        with pytest.raises(LiveError, match="SK-ACTION-001 no action '/cont'; did you mean"):
            client.send_goal("/cont")


def test_parameters_are_listed_and_changed(counting: simkit.Simulation, run: Callable[..., Any]) -> None:
    with run(counting) as client:
        node, found = next(iter(client.ask("parameters").items()))
        assert found["gain"]["value"] == 1.0 and found["gain"]["allowed"] == "a number from 0 to 2"
        client.ask("set_parameter", node=node, name="gain", value=1.5)
        assert client.ask("parameters")[node]["gain"]["value"] == 1.5
        with pytest.raises(LiveError, match="SK-PARAMETER-001 .*expected a number from 0 to 2"):
            client.ask("set_parameter", node=node, name="gain", value=3.0)


def test_the_end_of_a_simulation_is_reported(court: simkit.Simulation, run: Callable[..., Any]) -> None:
    calls: list[Any] = []
    with run(court, calls=calls) as client:
        client.control("pause")
        imu = client.subscribe("/imu")
        calls.append(lambda server: server.close("the battery is empty"))
        assert list(imu) == []
        with pytest.raises(LiveClosed, match="SK-LIVE-005 the battery is empty"):
            client.state()


def test_an_error_in_a_service_of_a_script_is_reported_and_raised(
    court: simkit.Simulation, run: Callable[..., Any]
) -> None:
    def fail(_: Any) -> None:
        raise ValueError("no bricks left")

    court.offer("/build", "std_srvs/srv/Trigger", fail)
    with run(court, may_fail=True) as client:
        with pytest.raises(LiveError, match="no bricks left"):
            client.call("/build")
        with pytest.raises(LiveClosed, match="ended: SK-TOPIC-002 .*no bricks left"):
            client.flush()


def test_a_client_looks_up_poses_between_frames(client: Client) -> None:
    fixed = client.advertise("/tf_static", "tf2_msgs/msg/TFMessage")
    fixed.publish({"transforms": [{"header": {"frame_id": "map"}, "child_frame_id": "hall",
                                   "transform": {"translation": {"x": 3.0}}}]})  # fmt: skip
    client.flush()
    moving = client.advertise("/tf", "tf2_msgs/msg/TFMessage")
    assert client.tf.frames(timeout=0.0).get("tag", "") == ""
    for second in (1, 3):
        stamp = {"frame_id": "hall", "stamp": {"sec": second}}
        moving.publish({"transforms": [{"header": stamp, "child_frame_id": "tag",
                                        "transform": {"translation": {"y": float(second)}}}]})  # fmt: skip
    assert client.tf.lookup("hall", "tag", 2.0, timeout=60.0).position.tolist() == [0.0, 2.0, 0.0]
    with pytest.raises(LookupError, match=r"unknown frame 'tga' \(did you mean 'tag'\?\)"):
        client.tf.lookup("hall", "tga", timeout=0.0)
    client.call("/world/court/control", {"world_control": {"reset": {"all": True}}})
    moving.publish({"transforms": [{"header": {"frame_id": "hall"}, "child_frame_id": "tag",
                                    "transform": {"translation": {"y": 9.0}}}]})  # fmt: skip
    client.flush()
    assert client.tf.lookup("hall", "tag", timeout=60.0).position.tolist() == [0.0, 9.0, 0.0], (
        "not those before the reset"
    )
