"""Live view without a browser: packets, requests, bits, and pages that are slow or send nonsense."""

from __future__ import annotations

import http.client
import json
import re
from pathlib import Path

import numpy as np
import pytest

import simkit
from packs.view.tests.view.conftest import YARD, Stage
from simkit.recording import Recorder
from simkit.recording.bags.reader import open_bag_to_read
from simkit.runtime.engine.snapshot import state_hash
from simkit_view.view import scene_packet
from simkit_view.view.bag_recording import MARKER, make_recording
from simkit_view.view.html_file import html_file
from simkit_view.view.live_view import LiveView
from simkit_view.view.packet import make_packet, read_packet
from simkit_view.view.page_server import PAGE

SCAN = "rover::base::scan"


# ---------------------------------------------------------------------- packets and the scene


def test_a_packet_has_the_same_arrays_when_it_is_read() -> None:
    arrays = {"bytes": np.arange(5, dtype=np.uint8), "numbers": np.array([[1.5, -2.0]]), "ids": np.array([7, 8])}
    head, found = read_packet(make_packet({"kind": "x", "text": "ä", "far": [float("inf")]}, arrays))
    assert head == {"kind": "x", "text": "ä", "far": [None]}
    assert {name: (a.dtype.str, a.tolist()) for name, a in found.items()} == {
        "bytes": ("|u1", [0, 1, 2, 3, 4]),
        "numbers": ("<f4", [[1.5, -2.0]]),
        "ids": ("<i4", [7, 8]),
    }


def test_the_scene_has_every_drawn_shape_with_its_colour_and_owner(stage: Stage) -> None:
    head, arrays = stage.scene()
    assert [model["name"] for model in head["models"]] == ["ground", "wall", "stone", "rover"]
    wall = [i for i, owner in enumerate(head["owners"]) if owner == ["wall::l", "wall::l::v"]]
    shown = np.flatnonzero(arrays["geom_owner"] == wall[0])
    assert arrays["geom_size"][shown[0]] == pytest.approx([0.05, 2.0, 0.5])
    assert arrays["geom_rgba"][shown[0]] == pytest.approx([0.1, 0.6, 0.2, 1.0], abs=0.01)
    assert {head["bodies"][body] for body in arrays["moving"]} == {"stone::l", "rover::base", "rover::mast"}
    assert [(j["name"], j["lower"], j["upper"]) for j in head["joints"]] == [("rover::turn", -1.0, 1.0)]
    assert [s["name"] for s in head["sensors"]] == [SCAN]


def test_the_collisions_of_a_link_whose_meshes_are_missing_are_drawn() -> None:
    box = "<geometry><box><size>1 1 1</size></box></geometry>"
    mesh = "<geometry><mesh><uri>file://missing.dae</uri></mesh></geometry>"
    links = "".join(
        f'<link name="{name}">{visual}<collision name="c">{box}</collision></link>'
        for name, visual in (
            ("base", f'<visual name="v">{box}</visual>'), ("arm", f'<visual name="v">{mesh}</visual>'), ("bumper", ""),
        )
    )  # fmt: skip
    text = f"""<sdf version="1.9"><world name="w"><model name="robot">{links}</model></world></sdf>"""
    with simkit.load(text) as sim:
        head, _ = read_packet(scene_packet.make_scene_packet(sim, 1, {}))
    assert head["undrawn"] == ["robot::arm"]


def test_a_state_has_the_pose_of_each_moving_body(stage: Stage) -> None:
    page = stage.page()
    stage.sim.model("rover").set_pose(simkit.Pose((1.0, 0.5, 0.1)))
    page.until(lambda: page.packets["state"][1]["poses"][1][0] == np.float32(1.0))
    poses = page.packets["state"][1]["poses"]
    assert poses.shape == (3, 7)
    assert poses[1] == pytest.approx([1.0, 0.5, 0.1, 1, 0, 0, 0], abs=1e-6)


def test_nothing_is_sent_while_nothing_changes(stage: Stage) -> None:
    page = stage.page()
    page.state()
    page.packets.clear()
    for _ in range(40):
        stage.pump()
        page.read()
    assert page.packets == {}


def test_a_lidar_is_sent_only_to_the_page_that_asks_and_lies_on_the_wall(stage: Stage) -> None:
    asks, other = stage.page(), stage.page()
    asks.want(lidar=[SCAN], joints={})
    stage.sim.run(0.06)
    asks.until(lambda: "lidar" in asks.packets)
    head, arrays = asks.packets["lidar"]
    assert head["lidars"] == [[SCAN, 9]]
    assert arrays["points"][:, 0] == pytest.approx([1.95] * 9, abs=0.01)
    other.read()
    assert "lidar" not in other.packets
    assert stage.sim.communication.bus.subscriptions() == []


def test_a_cloud_is_read_only_while_a_page_shows_it(stage: Stage) -> None:
    page = stage.page()
    assert stage.scene()[0]["clouds"] == ["/scan/points"]
    page.want(**{"cloud:/scan/points": {}, "cloud:not a topic": {}})
    page.until(lambda: len(stage.sim.communication.bus.subscriptions()) > 0)
    stage.sim.run(0.1)
    page.until(lambda: "points" in page.packets.get("cloud:/scan/points", ({}, {}))[1])
    points = page.packets["cloud:/scan/points"][1]["points"]
    assert points[:, 0] == pytest.approx([1.95] * 9, abs=0.01)
    page.want()
    page.until(lambda: len(stage.sim.communication.bus.subscriptions()) == 0)


def test_a_spawned_and_a_removed_model_change_the_scene(stage: Stage) -> None:
    page = stage.page()
    box = "<geometry><box><size>1 1 1</size></box></geometry>"
    xml = f'<sdf version="1.9"><model name="crate"><link name="l"><visual name="v">{box}</visual></link></model></sdf>'
    assert page.ask("spawn", source=xml, x=3.0, y=1.0, z=0.5)["ok"] == "crate"
    page.until(lambda: page.packets["scene_changed"][0]["revision"] == 2)
    assert [model["name"] for model in stage.scene()[0]["models"]] == ["ground", "wall", "stone", "rover", "crate"]
    page.ask("move", name="crate", position=[1.0, 2.0, 3.0], quaternion=[1, 0, 0, 0])
    assert stage.sim.model("crate").pose.position == pytest.approx([1.0, 2.0, 3.0])
    page.ask("remove", name="crate")
    page.until(lambda: page.packets["scene_changed"][0]["revision"] == 3)
    assert [model["name"] for model in stage.scene()[0]["models"]] == ["ground", "wall", "stone", "rover"]


def test_a_light_and_a_colour_that_change_are_sent(stage: Stage) -> None:
    page = stage.page()
    stage.sim.light("sun").switch(False)
    stage.sim.visual("wall::l::v").set_colour(1.0, 0.0, 0.0)
    page.until(lambda: "appearance" in page.packets)
    arrays = page.packets["appearance"][1]
    assert arrays["light_active"].tolist() == [0]
    assert [1.0, 0.0, 0.0, 1.0] in arrays["geom_rgba"].tolist()


# ---------------------------------------------------------------------- requests


def test_a_page_pauses_steps_and_resets(stage: Stage) -> None:
    page = stage.page()
    page.ask("pause", value=True)
    page.ask("step", count=25)
    page.until(lambda: page.packets["state"][0]["tick"] == 25)
    assert page.packets["state"][0]["paused"]
    page.ask("pace", value=0.5)
    page.until(lambda: page.packets["state"][0]["pace"] == 0.5)
    page.ask("reset")
    page.until(lambda: page.packets["state"][0]["tick"] == 0)


def test_a_page_drives_within_the_limits_and_the_robot_stops_when_the_page_closes(stage: Stage) -> None:
    page, sim = stage.page(), stage.sim
    sent = sim.subscribe("/cmd_vel")
    (target,) = page.ask("targets")["ok"]
    assert (target["topic"], target["model"]) == ("/cmd_vel", "rover")
    assert page.ask("drive", topic="/cmd_vel", ahead=0.5, turn=0.2)["ok"] == [0.5, 0.0, 0.2]
    stage.view.driving.send_due()
    assert (sent.latest.linear.x, sent.latest.angular.z) == (0.5, 0.2)
    page.socket.close()
    other = stage.page()
    sim.step()
    other.until(lambda: sent.latest.linear.x == 0.0)


def test_a_joint_moves_within_its_limits(stage: Stage) -> None:
    page = stage.page()
    page.ask("joint", name="rover::turn", value=0.4)
    assert stage.sim.joint("rover::turn").position == pytest.approx(0.4)
    page.ask("joint", name="rover::turn", value=3.0)
    assert stage.sim.joint("rover::turn").position == pytest.approx(1.0)


def test_goals_and_initial_poses_are_published_as_rviz_does(stage: Stage) -> None:
    page = stage.page()
    goals, estimates = stage.sim.subscribe("/goal_pose"), stage.sim.subscribe("/initialpose")
    answer = page.ask("pose", kind="goal", x=1.5, y=-2.0, yaw=np.pi / 2)["ok"]
    assert answer == {"topic": "/goal_pose", "missing": ""}
    page.ask("pose", kind="initial", x=0.5, y=0.0)
    goal = goals.latest
    assert (goal.header.frame_id, goal.pose.position.x, goal.pose.position.y) == ("map", 1.5, -2.0)
    assert goal.pose.orientation.z == pytest.approx(np.sqrt(0.5))
    assert estimates.latest.pose.covariance[0] == 0.25


def test_a_pose_that_only_a_recorder_receives_needs_a_navigator(stage: Stage, tmp_path: Path) -> None:
    page = stage.page()
    with Recorder(stage.sim, tmp_path / "a.mcap", topics=["*"]):
        goal = page.ask("pose", kind="goal", x=1.0, y=0.0)["ok"]
        assert "no navigator subscribes to /goal_pose" in goal["missing"] and "--nav" in goal["missing"]
        estimate = page.ask("pose", kind="initial", x=1.0, y=0.0)["ok"]
        assert "no localisation subscribes to /initialpose" in estimate["missing"]


def test_the_present_command_is_sent_until_it_is_stopped(stage: Stage) -> None:
    page = stage.page()
    page.want(driving={})
    page.ask("drive", topic="/cmd_vel", ahead=0.3, turn=0.2)
    commands = lambda: page.packets["driving"][0]["commands"]  # noqa: E731 - short
    page.until(lambda: commands() == {"/cmd_vel": [[0.3, 0.0, 0.2], None, ""]})
    page.ask("key", topic="/cmd_vel", key="s")
    page.until(lambda: commands() == {"/cmd_vel": [[0.0, 0.0, 0.0], None, ""]})


def test_the_command_of_another_program_is_sent_with_its_time(stage: Stage) -> None:
    page = stage.page()
    page.want(driving={})
    page.until(lambda: page.packets["driving"][0]["commands"] == {"/cmd_vel": [[0.0, 0.0, 0.0], 0.0, ""]})
    stage.sim.run(0.5)
    stage.sim.publish("/cmd_vel", {"linear": {"x": 0.25}})
    stage.sim.run(0.1)
    page.until(lambda: page.packets["driving"][0]["commands"]["/cmd_vel"][0] == [0.25, 0.0, 0.0])
    assert page.packets["driving"][0]["commands"]["/cmd_vel"][1] == pytest.approx(0.5, abs=0.003)
    stage.sim.reset()
    page.until(lambda: page.packets["driving"][0]["commands"] == {"/cmd_vel": [[0.0, 0.0, 0.0], 0.0, ""]})
    stage.sim.run(0.7)  # the time of the command comes again
    page.until(lambda: page.packets["state"][0]["time"] > 0.6)
    assert page.packets["driving"][0]["commands"]["/cmd_vel"][0] == [0.0, 0.0, 0.0]


NONSENSE: tuple[str | bytes, ...] = (
    '{"do": "pace", "value": ' + "9" * 400 + "}",
    *("", "{", "[]", "null", '"x"', "{}", '{"do": 1}', '{"do": "fly"}', '{"do": "step", "count": -1}', "[" * 5000),
    *('{"do": "pace", "value": 0}', '{"do": "drive", "topic": "/none"}', '{"do": "pause", "value": "yes"}'),
    *('{"do": "joint", "name": "none", "value": 1}', '{"do": "want", "streams": {"none": 1}}', b"\x00\xff"),
    *('{"do": "move", "name": "rover", "position": [1], "quaternion": [1, 0, 0, 0]}', '{"do": "spawn", "source": "<"}'),
)


def test_a_page_that_sends_nonsense_changes_nothing(stage: Stage) -> None:
    page, before = stage.page(), state_hash(stage.sim)
    for text in NONSENSE:
        page.socket.send(text)
    assert page.ask("travel")["ok"].keys() == {"stone", "rover"}
    assert state_hash(stage.sim) == before and not stage.sim.paused
    assert page.state()["revision"] == 1
    assert len([answer for answer in page.answers if "error" in answer]) == len(NONSENSE) - 1


# ---------------------------------------------------------------------- bits, and slow pages


@pytest.mark.parametrize("pages", [1, 8])
def test_a_run_has_the_same_bits_with_pages_and_without(stage: Stage, pages: int) -> None:
    with simkit.load(YARD) as alone:
        alone.publish("/cmd_vel", {"linear": {"x": 0.3}, "angular": {"z": 0.5}})
        alone.run(1.0)
        expected = state_hash(alone)
    for _ in range(pages):
        stage.page().want(lidar=[SCAN], contacts={}, joints={})
    stage.sim.publish("/cmd_vel", {"linear": {"x": 0.3}, "angular": {"z": 0.5}})
    for _ in range(100):
        stage.sim.step(5)
        stage.view._last = 0.0  # so that each of these steps is sent
        stage.view.update()
    assert state_hash(stage.sim) == expected


def test_a_page_that_reads_nothing_holds_one_packet_of_each_stream(stage: Stage) -> None:
    slow, quick = stage.page(), stage.page()
    server = stage.view.server
    slow.want(big={})
    quick.want(last={})
    quick.until(lambda: {"big", "last"} <= server.wants.keys())
    for number in range(200):
        server.send({"big": make_packet({"kind": "big", "number": number}, {"x": np.zeros(50_000, np.float32)})})
    server.send({"last": make_packet({"kind": "last"}, {})})
    quick.until(lambda: "last" in quick.packets)
    waiting = [packet for client in server._clients for packet in client.slots.values()]
    assert sum(map(len, waiting)) < 400_000  # two big packets; small ones of other streams may wait
    slow.until(lambda: slow.packets.get("big", [{}])[0].get("number") == 199)


def test_a_script_that_steps_updates_the_page_and_keeps_its_bits() -> None:
    hashes = []
    for has_view in (False, True):
        with simkit.load(YARD) as sim:
            if has_view:
                address = sim.view()
                assert address == sim.view() and address.startswith("http://127.0.0.1:")
                assert f'page = "{address}"' in address._repr_html_()
            sim.publish("/cmd_vel", {"linear": {"x": 0.3}})
            sim.run(0.5)
            sim.step(3)
            hashes.append((sim.tick, state_hash(sim)))
    assert hashes[0] == hashes[1]


# ---------------------------------------------------------------------- who may connect


@pytest.mark.parametrize(
    "path, headers, status",
    [
        ("/?token=TOKEN", {}, 200),
        ("/scene?token=TOKEN", {}, 200),
        ("/app.js", {}, 200),
        ("/app.css", {}, 200),
        ("/", {}, 403),
        ("/?token=wrong", {}, 403),
        ("/?token=", {}, 403),
        ("/scene", {}, 403),
        ("/ws", {}, 403),
        ("/../pyproject.toml", {}, 403),
        ("/../page_server.py?token=TOKEN", {}, 404),
        ("/page_server.py?token=TOKEN", {}, 404),
        ("/scene", {"Host": "evil.example"}, 403),
        ("/scene?token=TOKEN", {"Host": "proxy.example", "Origin": "https://proxy.example"}, 200),
        ("/?token=TOKEN", {"Origin": "http://evil.example"}, 403),
        ("/?token=TOKEN", {"Origin": "null"}, 403),
        ("/ws?token=TOKEN", {"Origin": "http://127.0.0.1:1"}, 403),
        ("/?token=TOKEN", {"Host": "localhost:PORT"}, 200),
    ],
)
def test_only_the_page_itself_is_served(view: LiveView, path: str, headers: dict[str, str], status: int) -> None:
    token, port = view.address.rpartition("=")[2], view.server.port
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    sent = {name: value.replace("PORT", str(port)) for name, value in headers.items()}
    connection.request("GET", path.replace("TOKEN", token), headers=sent)
    answer = connection.getresponse()
    answer.read()
    connection.close()
    assert answer.status == status
    policy = answer.headers["Content-Security-Policy"]
    assert "script-src 'self';" in policy and "unsafe" not in policy


def test_a_port_in_use_is_an_error_with_a_remedy(view: LiveView) -> None:
    with pytest.raises(simkit.InputError, match=r"SK-WEB-006 127.0.0.1:\d+ cannot be used.*\n.*another port"):
        LiveView(view.sim, port=view.server.port)


def test_the_page_loads_nothing_from_outside() -> None:
    page = (PAGE / "index.html").read_text(encoding="utf-8")
    assert "://" not in page and "<script>" not in page and "style=" not in page
    assert "://" not in (PAGE / "app.css").read_text(encoding="utf-8").replace("data:image", "")
    assert sum(path.stat().st_size for path in PAGE.iterdir()) < 1_000_000
    assert "MIT" in (PAGE / "LICENSES.txt").read_text(encoding="utf-8")


def test_packets_are_plain_json_without_nan(stage: Stage) -> None:
    json.dumps(stage.scene()[0], allow_nan=False)


# ---------------------------------------------------------------------- recordings


def _bag(folder: Path) -> Path:
    """Record a drive of the rover's twin, which has odometry, in `folder`."""
    with simkit.load(YARD.replace("</model></world>", f"{ODOMETRY}</model></world>")) as sim:
        with Recorder(sim, folder / "drive.mcap"):
            sim.publish("/cmd_vel", {"linear": {"x": 0.5}})
            sim.run(2.0)
        assert sim.model("rover").pose.position[0] == pytest.approx(1.0, abs=0.02)
    return folder / "drive.mcap"


ODOMETRY = """<plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">
<odom_frame>odom</odom_frame><robot_base_frame>base</robot_base_frame><odom_topic>/odom</odom_topic>
<odom_publish_frequency>50</odom_publish_frequency></plugin>"""


@pytest.mark.parametrize("world", [YARD, MARKER.format(name="bag")])
def test_a_bag_moves_its_robot_and_shows_its_scans(tmp_path: Path, world: str) -> None:
    with open_bag_to_read(_bag(tmp_path)) as bag, simkit.load(world) as sim:
        before = state_hash(sim)
        head, arrays = read_packet(make_recording(sim, bag))
        body = scene_packet.moving_bodies(sim.mj_model).tolist().index(sim.mj_model.body(_base(world)).id)
        assert state_hash(sim) == before
    assert arrays["times"][-1] == pytest.approx(2.0, abs=0.1)
    places = arrays["poses"][:, body, 0]
    assert places[-1] - places[0] == pytest.approx(1.0, abs=0.05)
    assert np.abs(np.diff(places, 2)[3:-3]).max() < 0.02  # steadily, without jumps
    assert [(lidar["topic"], lidar["count"]) for lidar in head["lidars"]] == [("/scan", 9)]
    ends = arrays["lidar0.poses"][:, 0] + arrays["lidar0.ranges"][:, 4] / 1000 - places[0]
    assert ends == pytest.approx([1.95] * len(ends), abs=0.05)  # the wall stays where it is


def _base(world: str) -> str:
    return "rover::base" if world == YARD else "robot::base"


def test_one_file_has_the_page_and_its_data_and_no_address(tmp_path: Path) -> None:
    with open_bag_to_read(_bag(tmp_path)) as bag, simkit.load(YARD) as sim:
        text = html_file("drive", scene_packet.make_scene_packet(sim, 1, {"recording": True}), make_recording(sim, bag))
    assert len(text) < 500_000
    assert not re.search(r"""(src|href)=["']?(https?:)?//""", text) and "<link" not in text
    assert "three.js authors" in text
