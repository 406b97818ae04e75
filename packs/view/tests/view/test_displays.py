"""Displays of topics in the scene: where messages are drawn, what is told, and what stays after a change."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import simkit
from packs.view.tests.view.conftest import YARD, Stage, TestPage
from simkit.msgs.transform_tree import TransformTree
from simkit.recording import Recorder
from simkit.recording.bags.reader import open_bag_to_read
from simkit.runtime.engine.snapshot import state_hash
from simkit_view.displays.frame_poses import FramePoses
from simkit_view.displays.kinds import DISPLAYS, SimulationTools
from simkit_view.view import topic_display
from simkit_view.view.bag_recording import MARKER, make_recording
from simkit_view.view.packet import read_packet

Packet = tuple[dict[str, Any], dict[str, np.ndarray]]
ODOM, MAP = {"frame_id": "odom"}, {"frame_id": "map"}
RED = {"r": 1.0, "a": 1.0}
CUBE = {"x": 0.1, "y": 0.2, "z": 0.3}


@pytest.fixture(autouse=True)
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw each change, however soon it comes."""
    monkeypatch.setattr(topic_display, "_PERIOD", 0.0)


def shown(stage: Stage, topic: str, type_name: str, *messages: dict[str, Any]) -> tuple[TestPage, Packet]:
    """Publish messages on a topic that a page shows, and return the page and its newest drawing."""
    page, publisher = stage.page(), stage.sim.advertise(topic, type_name)
    page.want(**{f"display:{topic}": {}})
    page.until(lambda: stage.sim.communication.bus.wanted(topic))
    for message in messages:
        publisher.publish(message)
    return page, page.until(lambda: page.packets[f"display:{topic}"])


def marker(kind: int, number: int = 1, **fields: Any) -> dict[str, Any]:
    found = {"header": MAP, "ns": "a", "id": number, "type": kind, "scale": CUBE, "color": RED}
    return {**found, "pose": {"orientation": {"w": 1.0}}, **fields}


def points(*rows: tuple[float, float, float]) -> list[dict[str, float]]:
    return [dict(zip("xyz", row, strict=True)) for row in rows]


# ---------------------------------------------------------------------- where


def test_the_topics_that_can_be_drawn_are_listed_with_their_types(stage: Stage) -> None:
    page = stage.page()
    page.want(displays={})
    page.until(lambda: "displays" in page.packets)
    stage.sim.advertise("/plan", "nav_msgs/msg/Path")
    stage.sim.advertise("/text", "std_msgs/msg/String")
    page.until(lambda: page.packets["displays"][0]["topics"] == [["/plan", "nav_msgs/msg/Path"]])


def test_a_path_in_the_frame_of_a_link_lies_where_the_link_was(stage: Stage) -> None:
    stage.sim.model("rover").set_pose(simkit.Pose((1.0, 2.0, 0.1), (np.sqrt(0.5), 0, 0, np.sqrt(0.5))))
    poses = [{"pose": {"position": {"x": x}}} for x in (0.0, 1.0, 3.0)]
    _, (head, arrays) = shown(stage, "/plan", "nav_msgs/msg/Path", {"header": {"frame_id": "base"}, "poses": poses})
    assert head["problems"] == []
    ends = arrays["g0.lines0"]
    assert ends[:, :2] == pytest.approx(np.array([(1, 2), (1, 3), (1, 3), (1, 5)]), abs=1e-5)


def test_a_frame_without_a_link_lies_where_transforms_put_it(stage: Stage) -> None:
    sim = stage.sim
    sim.model("rover").set_pose(simkit.Pose((5.0, 0.0, 0.1)))
    transforms = sim.advertise("/tf", "tf2_msgs/msg/TFMessage")
    page, publisher = stage.page(), sim.advertise("/plan", "geometry_msgs/msg/PoseArray")
    page.want(**{"display:/plan": {}})
    page.until(lambda: sim.communication.bus.wanted("/tf"))
    publisher.publish({"header": ODOM, "poses": [{"orientation": {"w": 1.0}}]})
    page.until(lambda: page.packets["display:/plan"][0]["problems"] == ["the frame 'odom' is unknown"])
    offset = {"translation": {"x": 2.0}, "rotation": {"w": 1.0}}
    transforms.publish({"transforms": [{"header": ODOM, "child_frame_id": "base", "transform": offset}]})
    page.until(lambda: page.packets["display:/plan"][0]["problems"] == [])
    assert page.packets["display:/plan"][1]["g0.lines0"][0, :2] == pytest.approx([3.0, 0.0], abs=1e-5)


def test_a_locked_marker_follows_its_link_and_another_stays(stage: Stage) -> None:
    locked = marker(1, header={"frame_id": "base"}, frame_locked=True)
    stays = marker(1, 2, header={"frame_id": "base"})
    message = {"markers": [locked, stays]}
    page, (head, arrays) = shown(stage, "/m", "visualization_msgs/msg/MarkerArray", message)
    bodies = {head["groups"][i]["body"]: arrays[f"g{i}.cube"][0, :3] for i in (0, 1)}
    rover = stage.sim.mj_model.body("rover::base").id
    assert bodies.keys() == {0, rover}
    assert bodies[0] == pytest.approx(stage.sim.link("rover::base").pose.position, abs=1e-4)
    assert bodies[rover] == pytest.approx([0, 0, 0])
    before = page.packets.pop("display:/m")
    stage.sim.spawn(BALL)  # the bodies get other numbers, and the markers stay
    page.until(lambda: "display:/m" in page.packets)
    assert len(page.packets["display:/m"][0]["groups"]) == len(before[0]["groups"]) == 2


BALL = """<sdf version="1.9"><model name="ball"><pose>4 4 1 0 0 0</pose><link name="l"><visual name="v"><geometry>
<sphere><radius>0.1</radius></sphere></geometry></visual></link></model></sdf>"""


# ---------------------------------------------------------------------- what


@pytest.mark.parametrize(
    "kind, arrays",
    [
        (0, {"g0.cylinder": 1, "g0.cone": 1}),
        (1, {"g0.cube": 1}),
        (2, {"g0.sphere": 1}),
        (3, {"g0.cylinder": 1}),
        (4, {"g0.lines0": 10}),
        (5, {"g0.lines0": 6}),
        (6, {"g0.cube": 6}),
        (7, {"g0.sphere": 6}),
        (8, {"g0.points0": 6}),
        (11, {"g0.triangles0": 6}),
    ],
)
def test_each_type_of_marker_becomes_its_shapes(stage: Stage, kind: int, arrays: dict[str, int]) -> None:
    corners = points(*((float(i), 0.0, float(i % 2)) for i in range(2 if kind == 0 else 6)))
    message = marker(kind, points=corners)
    _, (head, found) = shown(stage, "/m", "visualization_msgs/msg/Marker", message)
    assert head["problems"] == []
    assert {name: len(values) for name, values in found.items() if not name.endswith("colours")} == arrays


DOOR = ["door", 0.0, 0.0, 0.0, 0.2, 1.0, 0.0, 0.0, 1.0]


def test_a_mesh_is_found_in_the_resource_paths_and_nowhere_else(tmp_path: Path) -> None:
    (tmp_path / "part.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
    uri = f"file://{tmp_path}/part.obj"
    with simkit.load(YARD) as sim, pytest.raises(simkit.SimkitError, match="outside the resource folders"):
        SimulationTools(sim, FramePoses(sim, TransformTree())).read_mesh(uri)
    with simkit.load(YARD, resource_paths=[tmp_path]) as sim:
        found = SimulationTools(sim, FramePoses(sim, TransformTree())).read_mesh(uri)
    assert found["corners"].tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_a_marker_lives_for_its_lifetime_and_can_be_deleted(stage: Stage) -> None:
    short, long = marker(1, 1, lifetime={"nanosec": 100_000_000}), marker(1, 2)
    page, (_, arrays) = shown(stage, "/m", "visualization_msgs/msg/MarkerArray", {"markers": [short, long]})
    assert len(arrays["g0.cube"]) == 2
    stage.sim.run(0.2)
    page.until(lambda: len(page.packets["display:/m"][1]["g0.cube"]) == 1)
    stage.sim.publish("/m", {"markers": [marker(9, 3, text="door", scale={"z": 0.2})]})
    page.until(lambda: page.packets["display:/m"][0]["groups"][0]["texts"][:1] == [DOOR])
    stage.sim.publish("/m", {"markers": [marker(1, 2, action=2)]})
    page.until(lambda: "g0.cube" not in page.packets["display:/m"][1])
    stage.sim.publish("/m", {"markers": [marker(1, 2, action=3, ns="")]})
    page.until(lambda: page.packets["display:/m"][0]["groups"] == [])


def test_an_arrow_points_from_its_first_point_to_its_second(stage: Stage) -> None:
    message = marker(0, points=points((1, 1, 0), (1, 3, 0)), scale={"x": 0.1, "y": 0.2, "z": 0.5})
    _, (_, arrays) = shown(stage, "/m", "visualization_msgs/msg/Marker", message)
    assert arrays["g0.cylinder"][0, [0, 1, 9]] == pytest.approx([1.0, 1.75, 1.5])
    assert arrays["g0.cone"][0, [0, 1, 9]] == pytest.approx([1.0, 2.75, 0.5])


def test_updates_change_cells_of_a_costmap(stage: Stage) -> None:
    grid = {"header": MAP, "info": {"resolution": 0.5, "width": 3, "height": 2, "origin": {"position": {"x": -1.0}}}}
    updates = stage.sim.advertise("/local_costmap_updates", "map_msgs/msg/OccupancyGridUpdate")
    page, (head, arrays) = shown(
        stage, "/local_costmap", "nav_msgs/msg/OccupancyGrid", {**grid, "data": [0, 100, -1, 0, 0, 0]}
    )
    (found,) = head["groups"][0]["grids"]
    assert (found["colours"], found["resolution"], found["pose"][:2]) == ("costmap", 0.5, [-1.0, 0.0])
    assert arrays["g0.grid0"].tolist() == [[0, 100, 255], [0, 0, 0]]
    updates.publish({"header": MAP, "x": 1, "y": 1, "width": 2, "height": 1, "data": [7, 99]})
    page.until(lambda: page.packets["display:/local_costmap"][1]["g0.grid0"].tolist()[1] == [0, 7, 99])
    updates.publish({"header": MAP, "x": 9, "y": 9, "width": 2, "height": 1, "data": [7, 99]})
    page.until(lambda: "does not fit" in str(page.packets["display:/local_costmap"][0]["problems"]))


def test_a_covariance_is_an_ellipse_of_one_standard_deviation(stage: Stage) -> None:
    covariance = np.zeros((6, 6))
    covariance[0, 0], covariance[1, 1], covariance[5, 5] = 0.09, 0.25, 0.04
    pose = {"pose": {"orientation": {"w": 1.0}}, "covariance": covariance.ravel().tolist()}
    topic_type = "geometry_msgs/msg/PoseWithCovarianceStamped"
    _, (_, arrays) = shown(stage, "/pose", topic_type, {"header": MAP, "pose": pose})
    assert sorted(arrays["g0.sphere"][0, 7:10]) == pytest.approx([0.004, 0.6, 1.0])
    rim = arrays["g0.triangles0"].reshape(-1, 3, 3)[[0, -1], [1, 2]]
    assert np.arctan2(rim[:, 1], rim[:, 0]) == pytest.approx([-0.2, 0.2])


def test_odometry_leaves_arrows_until_a_reset(stage: Stage) -> None:
    rows = [{"header": MAP, "pose": {"pose": {"position": {"x": x}, "orientation": {"w": 1.0}}}} for x in (0, 0.05, 1)]
    page, _ = shown(stage, "/odom", "nav_msgs/msg/Odometry", *rows)
    page.until(lambda: page.packets["display:/odom"][1]["g0.cone"][:, 0] == pytest.approx([0.41, 1.41, 1.41]))


# ---------------------------------------------------------------------- invalid and large content

NAN = float("nan")
INVALID = [
    ("nav_msgs/msg/Path", {"header": MAP, "poses": [{"pose": {"position": {"x": NAN}}}] * 2}, "NaN"),
    ("nav_msgs/msg/Path", {"header": {"frame_id": ""}, "poses": []}, "names no frame"),
    ("nav_msgs/msg/OccupancyGrid", {"header": MAP, "info": {"width": 3, "height": 2}, "data": [1]}, "1 cell"),
    ("nav_msgs/msg/OccupancyGrid", {"header": MAP, "info": {"width": 1, "height": 1}, "data": [1]}, "resolution"),
    ("visualization_msgs/msg/Marker", marker(1, color={"r": 1.0}), "transparent"),
    ("visualization_msgs/msg/Marker", marker(1, scale={"x": 1.0, "y": 0.0, "z": 1.0}), "has a 0"),
    ("visualization_msgs/msg/Marker", marker(1, pose={"position": {"x": NAN}}), "NaN"),
    ("visualization_msgs/msg/Marker", marker(99), "type 99"),
    ("visualization_msgs/msg/Marker", marker(1, action=7), "action 7"),
    ("visualization_msgs/msg/Marker", marker(11, points=points((0, 0, 0))), "multiple of 3"),
    ("visualization_msgs/msg/Marker", marker(10, mesh_resource="package://none/a.stl"), "cannot be drawn"),
    ("visualization_msgs/msg/Marker", marker(10, mesh_resource="<&>"), "cannot be drawn"),
    ("geometry_msgs/msg/PoseStamped", {"header": MAP, "pose": {"position": {"x": 1e300}}}, "very large"),
]


@pytest.mark.parametrize("type_name, message, problem", INVALID)
def test_what_cannot_be_drawn_is_told(stage: Stage, type_name: str, message: dict[str, Any], problem: str) -> None:
    before = state_hash(stage.sim)
    _, (head, _) = shown(stage, "/x", type_name, message)
    assert problem in "; ".join(head["problems"])
    assert state_hash(stage.sim) == before


@pytest.mark.slow
def test_large_messages_are_drawn_coarser(stage: Stage) -> None:
    info = {"resolution": 0.05, "width": 5000, "height": 100}
    cells = np.zeros(500_000, np.int8)
    cells[-1] = 100
    page, (head, arrays) = shown(
        stage, "/g", "nav_msgs/msg/OccupancyGrid", {"header": MAP, "info": info, "data": cells}
    )
    assert arrays["g0.grid0"].shape == (34, 1667) and arrays["g0.grid0"][-1, -1] == 100
    assert "3 times coarser" in head["problems"][0]
    many = marker(8, points=points((0, 0, 0)) * 201_000)
    page, (head, arrays) = shown(stage, "/p", "visualization_msgs/msg/Marker", many)
    assert len(arrays["g0.points0"]) == 199_998
    assert page.packets["state"]


@pytest.mark.parametrize("type_name", list(DISPLAYS))
def test_an_empty_message_of_each_type_is_drawn_as_nothing(stage: Stage, type_name: str) -> None:
    _, (head, arrays) = shown(stage, "/x", type_name, {})
    assert head["problems"] != [] or head["groups"] == [] or type_name == "geometry_msgs/msg/Polygon"
    assert all(np.isfinite(values).all() for values in arrays.values())


# ---------------------------------------------------------------------- bits, and bags


def test_displays_leave_the_run_and_its_topics_as_they_were(stage: Stage) -> None:
    with simkit.load(YARD) as alone:
        alone.run(0.5)
        expected = state_hash(alone)
    page, _ = shown(stage, "/m", "visualization_msgs/msg/Marker", marker(1))
    stage.sim.run(0.5)
    page.want()
    page.until(lambda: stage.sim.communication.bus.subscriptions() == [])
    assert state_hash(stage.sim) == expected


@pytest.mark.parametrize("world", [YARD, MARKER.format(name="bag")])
def test_a_bag_plays_its_displays(tmp_path: Path, world: str) -> None:
    with simkit.load(YARD) as sim, Recorder(sim, tmp_path / "a.mcap"):
        markers = sim.advertise("/m", "visualization_msgs/msg/MarkerArray")
        sim.advertise("/map", "nav_msgs/msg/OccupancyGrid", latched=True).publish(
            {"header": MAP, "info": {"resolution": 1.0, "width": 1, "height": 1}, "data": [100]}
        )
        markers.publish({"markers": [marker(1)]})
        sim.run(1.0)
        markers.publish({"markers": [marker(1, 2)]})
        sim.run(0.1)
    with open_bag_to_read(tmp_path / "a.mcap") as bag, simkit.load(world) as sim:
        head, arrays = read_packet(make_recording(sim, bag))
    assert [found["topic"] for found in head["displays"]] == ["/m", "/map"]
    found, data = head["displays"][0], arrays["display0"].tobytes()
    assert found["times"] == pytest.approx([0.0, 1.0], abs=0.01)
    begin, end = found["ends"]
    assert [len(read_packet(p)[1]["g0.cube"]) for p in (data[:begin], data[begin:end])] == [1, 2]
