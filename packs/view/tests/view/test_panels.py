"""Data and requests of the panels, without a browser: plots, console, forms, parameters and graphs."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import simkit
from packs.view.tests.view.conftest import YARD, Stage, TestPage
from packs.view.tests.view.test_live_view import ODOMETRY
from simkit import msgs
from simkit.recording import Recorder
from simkit.recording.bags.reader import open_bag_to_read
from simkit.runtime.engine.snapshot import state_hash
from simkit_verification.testing.bundles import keep, replay, write_bundle
from simkit_view.view.bag_panels import BagPanels
from simkit_view.view.message_form import describe_form
from simkit_view.view.packet import read_packet
from simkit_view.view.series_stream import SeriesStream, field_paths, series_packet

MOVING = YARD.replace("</model></world>", f"{ODOMETRY}</model></world>")
SCAN = "rover::base::scan"
PANELS: dict[str, Any] = {
    "series:/odom": {"fields": ["pose.pose.position.x", "pose.pose.orientation.yaw"]},
    "series:/scan": {"fields": ["ranges[4]", "ranges[0:3]"]},
    "truth": {"fields": ["rover.x", "rover.forward"]},
    **{name: {} for name in ("topics", "rates", "parameters", "log", "calls", "graph", "frames")},
}


@pytest.fixture
def moving() -> Iterator[Stage]:
    """Rover with odometry."""
    with ExitStack() as stack:
        yield Stage(stack, MOVING)


def packet(page: TestPage, kind: str) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    return page.until(lambda: page.packets[kind])


def samples(page: TestPage, kind: str, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return times and values of a stream as soon as a packet has so many samples."""
    page.until(lambda: len(page.packets[kind][1]["times"]) >= count)
    head, arrays = page.packets[kind]
    return arrays["times"] + head["begin"], arrays["values"] + [curve["base"] for curve in head["curves"]]


# ---------------------------------------------------------------------- plots


def test_the_numbers_of_a_field_are_those_of_its_messages(moving: Stage) -> None:
    page, sim = moving.page(), moving.sim
    odometry = sim.subscribe("/odom")
    page.want(**PANELS)
    packet(page, "topics")
    sim.publish("/cmd_vel", {"linear": {"x": 0.5}, "angular": {"z": 0.4}})
    sim.run(1.0)
    times, values = samples(page, "series:/odom", 49)
    head, arrays = page.packets["series:/odom"]
    assert [(c["path"], c["unit"], c["is_angle"]) for c in head["curves"]] == [
        ("pose.pose.position.x", "m", False),
        ("pose.pose.orientation.yaw", "rad", True),
    ]
    sent = [m.pose.pose.position.x for m in odometry.messages]
    assert values[:, 0] == pytest.approx(sent[-len(values) :], abs=1e-6)
    assert values[-1, 1] == pytest.approx(0.4, abs=0.02)
    assert arrays["stamps"] + head["begin"] == pytest.approx(times, abs=1e-6)
    _, ranges = samples(page, "series:/scan", 15)
    assert ranges.shape[1] == 4
    _, truth = samples(page, "truth", 1)
    assert truth[-1] == pytest.approx([sim.model("rover").pose.position[0], 0.5], abs=0.01)


def test_a_wrong_field_is_told_and_the_others_are_sent(moving: Stage) -> None:
    page = moving.page()
    fields = ["pose.pose.position.x", "pose.pose.positon.x", "child_frame_id", "pose.covariance[99]", "x" * 999]
    page.want(**{"series:/odom": {"fields": fields}, "series:/none": {"fields": ["x"]}, "truth": {"fields": ["a.b"]}})
    page.until(lambda: "series:/odom" in moving.view.server.wants)
    moving.sim.run(0.1)
    head, _ = packet(page, "series:/odom")
    assert [curve["path"] for curve in head["curves"]] == ["pose.pose.position.x"]
    assert head["errors"].keys() == {"pose.pose.positon.x", "child_frame_id", "pose.covariance[99]"}
    assert "did you mean 'position'" in head["errors"]["pose.pose.positon.x"]
    assert "expected MODEL.VALUE" in packet(page, "truth")[0]["errors"]["a.b"]
    assert "no topic '/none'" in packet(page, "series:/none")[0]["errors"]["x"]


def test_a_topic_of_1_khz_is_read_at_a_bounded_rate() -> None:
    with simkit.load(YARD) as sim:
        fast = sim.advertise("/fast", "std_msgs/msg/Float64")
        stream, reads = SeriesStream(sim, "/fast"), 0
        options = [{"fields": ["data"]}]
        stream.packet(options)
        read = stream._curves[0][1].read

        def counted(message: Any) -> float:
            nonlocal reads
            reads += 1
            return read(message)

        object.__setattr__(stream._curves[0][1], "read", counted)
        for number in range(10_000):
            fast.publish({"data": float(number)})
        stream._rows._due = 0.0
        found = stream.packet(options)
        assert found is not None
        head, arrays = read_packet(found)
        assert 40 <= len(arrays["values"]) <= 81 and reads < 500
        values = arrays["values"][:, 0] + head["curves"][0]["base"]
        assert values[0] < 300 and values[-1] > 9700  # over the whole time
        assert np.diff(values).max() <= 2 * np.diff(values).min()
        stream.close()
        assert sim.communication.bus.subscriptions() == []


def test_large_numbers_keep_their_digits() -> None:
    """A stamp of a calendar has 10 digits before the point, a 32-bit number 7."""
    rows = [(1.7e9 + 0.001 * k, 1.7e9 + 0.001 * k, [1.7e9 + 0.001 * k, np.nan, np.inf]) for k in range(3)]
    head, arrays = read_packet(series_packet("series:/x", rows, [{"path": "a"}, {"path": "b"}, {"path": "c"}]))
    assert head["begin"] == 1.7e9
    assert arrays["times"] == pytest.approx([0.0, 0.001, 0.002], abs=1e-6)
    assert arrays["values"][:, 0] == pytest.approx([0.0, 0.001, 0.002], abs=1e-6)
    assert not np.isfinite(arrays["values"][:, 1:]).any()


def test_the_paths_of_a_type_lead_to_its_numbers() -> None:
    store = msgs.type_store()
    odometry = field_paths("nav_msgs/msg/Odometry", store)
    assert odometry[:3] == ["header.stamp", "pose.pose.position.x", "pose.pose.position.y"]
    assert {"pose.pose.orientation.yaw", "pose.covariance[]", "twist.twist.angular.z"} <= set(odometry)
    assert "ranges[]" in field_paths("sensor_msgs/msg/LaserScan", store)
    assert "transforms[].transform.translation.x" in field_paths("tf2_msgs/msg/TFMessage", store)
    assert field_paths("std_msgs/msg/String", store) == []


# ---------------------------------------------------------------------- topics, log and graphs


@pytest.mark.slow
def test_topics_come_with_types_fields_and_rates(moving: Stage) -> None:
    page = moving.page()
    page.want(topics={}, rates={})
    head, _ = packet(page, "topics")
    found = {row["name"]: row["type"] for row in head["topics"]}
    assert found["/scan"] == "sensor_msgs/msg/LaserScan" and "ranges[]" in head["types"]["sensor_msgs/msg/LaserScan"]
    assert head["models"] == ["stone", "rover"] and "yaw" in head["truth"]
    packet(page, "rates")
    moving.sim.run(1.0)
    page.until(lambda: page.packets["rates"][0]["rates"].get("/scan") == pytest.approx(20.0))
    assert page.packets["rates"][0]["rates"]["/odom"] == pytest.approx(50.0)
    page.want()
    page.until(lambda: moving.sim.communication.bus.subscriptions() == [])


def test_the_last_page_that_leaves_ends_all_subscriptions(moving: Stage) -> None:
    page = moving.page()
    page.want(**PANELS)
    packet(page, "rates")
    page.until(lambda: len(moving.sim.communication.bus.subscriptions()) > 5)
    page.socket.close()
    page.until(lambda: moving.sim.communication.bus.subscriptions() == [])


def test_the_console_has_the_diagnostics_of_the_load_and_later_messages(stage: Stage) -> None:
    page, sim = stage.page(), stage.sim
    assert page.ask("log", after=0)["ok"] == []  # nothing is received before a page shows it
    page.want(log={})
    packet(page, "log")
    sim.engine.log.error("the wheel is %s", "loose")
    sim.engine.log.warning("slow")
    page.until(lambda: page.packets["log"][0]["last"] >= 2)
    entries = page.ask("log", after=0)["ok"]
    assert [(e["level"], e["node"], e["text"]) for e in entries[-2:]] == [
        (40, "simkit", "the wheel is loose"),
        (30, "simkit", "slow"),
    ]
    assert page.ask("log", after=entries[-1]["number"] - 1)["ok"] == entries[-1:]
    for number in range(1200):
        sim.engine.log.info("line %d", number)
    page.until(lambda: page.packets["log"][0]["last"] >= 1200)
    oldest = page.ask("log", after=0)["ok"]
    assert len(oldest) == 300 and oldest[0]["text"] == "line 200"


def test_the_graph_has_the_boxes_of_simkit_graph_with_places(moving: Stage) -> None:
    page = moving.page()
    page.want(graph={})
    head, _ = packet(page, "graph")
    boxes = {box["name"]: box for box in head["boxes"]}
    assert boxes["topic /scan"]["lines"] == ["sensor_msgs/LaserScan", ""]
    ends = [edge["ends"] for edge in head["edges"]]
    assert any(end == "topic /scan" for _, end in ends) and any(start == "topic /cmd_vel" for start, _ in ends)
    x, y, width, height = boxes["topic /scan"]["place"]
    assert x >= 0 and y >= 0 and x + width <= head["size"][0] + 0.2 and y + height <= head["size"][1] + 0.2


@pytest.mark.slow
def test_frames_come_with_their_rates(stage: Stage) -> None:
    page, sim = stage.page(), stage.sim
    page.want(frames={})
    packet(page, "frames")
    tf, fixed = (sim.advertise(name, "tf2_msgs/msg/TFMessage", latched=name != "/tf") for name in ("/tf", "/tf_static"))

    def transform(parent: str, child: str) -> dict[str, Any]:
        stamp = {"sec": 0, "nanosec": sim.time_ns}
        header = {"frame_id": parent, "stamp": stamp}
        return {"transforms": [{"header": header, "child_frame_id": child, "transform": {"rotation": {"w": 1.0}}}]}

    other = sim.advertise("/second/tf", "tf2_msgs/msg/TFMessage")
    page.want()
    page.until(lambda: "frames" not in stage.view._streams)
    page.want(frames={})
    page.until(lambda: "frames" in stage.view._streams)
    other.publish(transform("map", "odom"))
    fixed.publish(transform("base", "laser"))
    for _ in range(11):
        tf.publish(transform("odom", "base"))
        sim.run(0.05)
    page.until(lambda: page.packets["frames"][0]["rates"].get("base") == pytest.approx(20.0))
    head = page.packets["frames"][0]
    assert {(*edge["ends"], edge["dashed"]) for edge in head["edges"]} == {
        ("map", "odom", False),
        ("odom", "base", False),
        ("base", "laser", True),
        ("base", SCAN, True),
    }


# ---------------------------------------------------------------------- forms


def test_a_form_has_the_fields_limits_and_constants_of_a_type() -> None:
    form = describe_form("diagnostic_msgs/msg/DiagnosticArray")
    status = form["types"]["diagnostic_msgs/msg/DiagnosticStatus"]
    level = status["fields"][0]
    assert (level["kind"], level["low"], level["high"]) == ("integer", 0, 255)
    assert level["constants"] == [["OK", 0], ["WARN", 1], ["ERROR", 2], ["STALE", 3]]
    assert status["fields"][-1] == {
        "name": "values",
        "kind": "message",
        "type": "diagnostic_msgs/msg/KeyValue",
        "array": {"length": 0, "most": 0},
    }
    pose = describe_form("geometry_msgs/msg/PoseWithCovariance")
    assert pose["types"]["geometry_msgs/msg/Quaternion"]["default"]["w"] == 1.0
    assert pose["types"]["geometry_msgs/msg/PoseWithCovariance"]["fields"][1]["array"]["length"] == 36
    json.dumps(form, allow_nan=False)


def test_a_page_calls_a_service_of_the_world(stage: Stage) -> None:
    page = stage.page()
    found = page.ask("interfaces")["ok"]
    assert found["services"]["/world/yard/set_pose"] == "ros_gz_interfaces/srv/SetEntityPose"
    form = page.ask("describe", kind="service", name="/world/yard/set_pose")["ok"]
    assert [f["name"] for f in form["types"][form["type"]]["fields"]] == ["entity", "pose"]
    values = {"entity": {"name": "stone"}, "pose": {"position": {"x": 1.0, "y": 2.0, "z": 0.5}}}
    answer = page.ask("call", name="/world/yard/set_pose", values=values)["ok"]
    assert answer["values"] == {"success": True} and answer["text"] == "success: true\n"
    assert stage.sim.model("stone").pose.position == pytest.approx([1.0, 2.0, 0.5])
    wrong = page.ask("call", name="/world/yard/set_pose", values={"entity": {"name": 5}})
    assert "expected a text" in wrong["error"] and "SetEntityPose_Request" in wrong["error"]


def test_a_service_that_answers_later_is_shown_when_it_has_answered(stage: Stage) -> None:
    page, sent = stage.page(), []

    class OtherProcess:
        node, is_busy = "/other", False

        def send(self, call: Any) -> None:
            sent.append(call)

        def wait(self, seconds: float) -> None: ...

    services = stage.sim.communication.services
    services.offer("/slow", "std_srvs/srv/Trigger", lambda _: None, remote=OtherProcess())
    page.want(calls={})
    number = page.ask("call", name="/slow")["ok"]["id"]
    page.until(lambda: page.packets["calls"][0]["calls"][0]["status"] == "WAITING")
    services.finish(sent[0], {"success": True, "message": "later"})
    page.until(lambda: page.packets["calls"][0]["calls"][0]["done"])
    (row,) = page.packets["calls"][0]["calls"]
    assert (row["id"], row["status"], row["text"]) == (number, "DONE", "success: true\nmessage: later\n")


def test_a_goal_shows_feedback_and_result_and_can_be_cancelled(stage: Stage) -> None:
    page, sim, goals = stage.page(), stage.sim, []
    sim.act("/count", "example_interfaces/action/Fibonacci", goals.append, on_cancel=lambda goal: goal.canceled())
    page.want(calls={})
    number = page.ask("goal", name="/count", values={"order": 5})["ok"]["id"]
    page.until(lambda: page.packets["calls"][0]["calls"][0]["status"] == "WAITING")
    sim.step()
    goals[0].publish_feedback({"sequence": [0, 1]})
    page.until(lambda: "sequence" in page.packets["calls"][0]["calls"][0]["text"])
    assert page.packets["calls"][0]["calls"][0]["status"] == "EXECUTING"
    assert page.ask("cancel", goal=number)["ok"] is True
    sim.step()
    page.until(lambda: page.packets["calls"][0]["calls"][0]["status"] == "CANCELED")
    assert page.ask("cancel", goal=number)["ok"] is False
    assert "2147483647" in page.ask("goal", name="/count", values={"order": 1 << 40})["error"]
    second = page.ask("goal", name="/count", values={"order": 1})["ok"]["id"]
    sim.reset()
    page.until(lambda: page.packets["calls"][0]["calls"][-1]["status"] == "UNDONE")
    assert page.packets["calls"][0]["calls"][-1]["id"] == second


def test_a_parameter_is_set_within_its_range(stage: Stage) -> None:
    page = stage.page()
    gain = stage.sim.declare("gain", 1.0, minimum=0.0, maximum=5.0, description="gain [1]")
    page.want(parameters={})
    page.until(lambda: page.packets["parameters"][0]["nodes"])
    row = page.packets["parameters"][0]["nodes"]["/script"]["gain"]
    assert (row["value"], row["minimum"], row["maximum"], row["type"]) == (1.0, 0.0, 5.0, "float")
    page.ask("set_parameter", node="/script", name="gain", value=2.5)
    assert gain.value == 2.5
    page.until(lambda: page.packets["parameters"][0]["nodes"]["/script"]["gain"]["value"] == 2.5)
    assert "from 0 to 5" in page.ask("set_parameter", node="/script", name="gain", value=7.0)["error"]
    assert gain.value == 2.5


NONSENSE = (
    {"do": "describe", "kind": "x", "name": "/world/yard/set_pose"},
    {"do": "describe", "kind": "service", "name": "/none"},
    {"do": "describe", "kind": "action", "name": "/world/yard/set_pose"},
    {"do": "describe", "kind": "service", "name": "../../etc/passwd"},
    {"do": "call", "name": "/none"},
    {"do": "call", "name": ""},
    {"do": "call", "name": "/world/yard/set_pose", "values": [1]},
    {"do": "call", "name": "/world/yard/set_pose", "values": {"pose": {"position": {"x": "NaN"}}}},
    {"do": "call", "name": "/world/yard/set_pose", "values": {"entity": {"id": -1}}},
    {"do": "call", "name": "/world/yard/set_pose", "values": {"unknown": 1}},
    {"do": "goal", "name": "/none", "values": {}},
    {"do": "cancel", "goal": 5},
    {"do": "cancel", "goal": "x"},
    {"do": "cancel"},
    {"do": "set_parameter", "node": "/none", "name": "x", "value": 1},
    {"do": "set_parameter", "node": 1, "name": "x", "value": {}},
    {"do": "log", "after": "x"},
)


def test_requests_that_make_no_sense_get_an_error_and_change_nothing(stage: Stage) -> None:
    page, before = stage.page(), state_hash(stage.sim)
    for number, request in enumerate(NONSENSE):
        page.socket.send(json.dumps({**request, "id": number}))
    page.want(**{"series:/scan": {"fields": 5}, "series:": 7, "truth": [], "graph": "x", "series:/tf": {"fields": [1]}})
    page.until(lambda: sum("error" in answer for answer in page.answers) == len(NONSENSE))
    page.ask("travel")
    assert state_hash(stage.sim) == before


# ---------------------------------------------------------------------- bits


@pytest.mark.parametrize("pages", [1, 8])
def test_panels_change_no_bit_of_a_run(moving: Stage, pages: int) -> None:
    with simkit.load(MOVING) as alone:
        alone.publish("/cmd_vel", {"linear": {"x": 0.3}, "angular": {"z": 0.5}})
        alone.run(1.0)
        expected = state_hash(alone)
    opened = [moving.page() for _ in range(pages)]
    for page in opened:
        page.want(**PANELS)
    opened[0].until(lambda: len(moving.view.server.wants) == len(PANELS))
    moving.sim.publish("/cmd_vel", {"linear": {"x": 0.3}, "angular": {"z": 0.5}})
    for _ in range(100):
        moving.sim.step(5)
        moving.view._last = 0.0  # so that each of these steps is sent
        moving.view.update()
    assert state_hash(moving.sim) == expected


def test_what_a_page_calls_sends_and_sets_is_repeated_by_a_bundle(tmp_path: Path) -> None:
    (tmp_path / "yard.sdf").write_text(YARD)
    with ExitStack() as stack:
        stage = Stage(stack, str(tmp_path / "yard.sdf"))
        sim = stage.sim
        stack.enter_context(keep(sim))
        page = stage.page()
        page.want(**PANELS)
        sim.declare("push", 0.0, on_change=lambda value: sim.model("stone").set_velocity((value, 0.0, 0.0)))
        values = {"entity": {"name": "stone"}, "pose": {"position": {"x": -2.0, "y": 1.0, "z": 0.05}}}
        assert page.ask("call", name="/world/yard/set_pose", values=values)["ok"]["values"]["success"]
        sim.run(0.1)
        page.ask("set_parameter", node="/script", name="push", value=1.5)
        page.ask("goal", name="/simulate_steps", values={"steps": 1})
        sim.run(0.2)
        assert sim.model("stone").pose.position[0] > -2.0
        found = replay(write_bundle(sim, tmp_path / "run.zip"), allow_code=True)
    assert found.is_same, (found.differences, found.refused)


# ---------------------------------------------------------------------- bags


@pytest.mark.slow
def test_a_bag_has_its_topics_and_numbers_and_log(tmp_path: Path) -> None:
    with simkit.load(MOVING) as sim, Recorder(sim, tmp_path / "drive.mcap", topics=["*", "/rosout"]):
        sim.publish("/cmd_vel", {"linear": {"x": 0.5}})
        sim.engine.log.warning("it moves")
        sim.run(2.0)
    with open_bag_to_read(tmp_path / "drive.mcap") as bag, simkit.load(MOVING) as sim:
        panels = BagPanels(bag, sim)
        head, _ = read_packet(panels.topics_packet())
        rows = {row["name"]: row for row in head["topics"]}
        assert rows["/odom"]["rate"] == pytest.approx(50.0, rel=0.03) and head["recorded"]
        series = panels.streams["series"]("/odom")
        options = [{"fields": ["pose.pose.position.x", "nothing"]}]
        head, arrays = read_packet(series.packet(options))
        assert series.packet(options) is None
        assert len(arrays["times"]) == rows["/odom"]["count"] and head["errors"].keys() == {"nothing"}
        travelled = arrays["values"][-1, 0] - arrays["values"][0, 0]
        assert travelled == pytest.approx(0.5 * (arrays["times"][-1] - arrays["times"][0]), abs=0.02)
        assert [e["text"] for e in panels.streams["log"]("").entries(0)][-1] == "it moves"
        _, packets = read_packet(panels.file_packet())
        assert {"topics", "/odom", "/scan"} <= packets.keys()
        paths = [curve["path"] for curve in read_packet(packets["/odom"].tobytes())[0]["curves"]]
        assert "pose.pose.orientation.yaw" in paths and "pose.covariance[0]" not in paths
