"""The TurtleBot 2: the same robot from SDF and from URDF, and a robot that stands, drives, turns and has events."""

from __future__ import annotations

import importlib
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import simkit

FOLDER = Path(__file__).resolve().parents[2] / "assets" / "turtlebot2"
FILES = {"sdf": FOLDER / "model.sdf", "urdf": FOLDER / "turtlebot2.urdf"}
VELOCITY = "/mobile_base/commands/velocity"
EVENTS = "/mobile_base/events"
LEAN = math.atan(0.0022 / 0.135)  # the back caster ends 2.2 mm above the plane of the wheels, 0.135 m behind the axle
SCENERY = {
    "wall": "<pose>0.7 0 0.2 0 0 0</pose><link name='l'><collision name='c'><geometry><box><size>0.1 4 0.4</size></box>"
    "</geometry></collision></link>",
    "table": "<pose>0 0 0.35 0 0 0</pose><link name='l'><collision name='c'><geometry><box><size>2 2 0.7</size></box>"
    "</geometry></collision></link>",
}


def load(scenery: str = "", pose: str = "0 0 0 0 0 0") -> simkit.Simulation:
    """Load the robot on level ground, with a wall at x = 0.65 m or on a table of 2 x 2 m."""
    model = f"<model name='{scenery}'><static>true</static>{SCENERY[scenery]}</model>" if scenery else ""
    return simkit.load(
        f"""<sdf version='1.9'><world name='w'><physics type='ode'><max_step_size>0.002</max_step_size></physics>{model}
        <include><uri>model://ground_plane</uri></include><include><uri>model://turtlebot2</uri><pose>{pose}</pose>
        </include></world></sdf>"""
    )


def drive(sim: simkit.Simulation, seconds: float, linear: float = 0.0, angular: float = 0.0) -> None:
    """Publish a command at least every 0.5 s: its timeout is 0.6 s."""
    count = math.ceil(seconds / 0.5)
    for _ in range(count):
        sim.publish(VELOCITY, {"linear": {"x": linear}, "angular": {"z": angular}})
        sim.run(seconds / count)


def yaw_of(orientation: Any) -> float:
    return 2 * math.atan2(orientation.z, orientation.w)


@pytest.fixture
def robot() -> Iterator[tuple[simkit.Simulation, Any]]:
    with load() as sim:
        sim.run(1.0)
        yield sim, sim.model("turtlebot2")


# ------------------------------------------------------------------ numbers


@pytest.fixture(scope="module")
def twins() -> tuple[dict[str, Any], dict[str, Any]]:
    sdf, urdf = (simkit.describe(FILES[form])["model"] for form in ("sdf", "urdf"))
    return sdf, urdf


def numbers_of(entry: Any) -> list[float]:
    """All numbers inside, in order of their names."""
    if isinstance(entry, dict):
        return [n for key in sorted(entry) for n in numbers_of(entry[key])]
    if isinstance(entry, list):
        return [n for item in entry for n in numbers_of(item)]
    return [float(entry)] if isinstance(entry, (int, float, bool)) else []


def test_both_files_describe_the_same_robot(twins: tuple[dict[str, Any], dict[str, Any]]) -> None:
    """Only the casters differ: they are balls in SDF, and fixed in URDF, which has no ball joint."""
    sdf, urdf = twins
    for ours, theirs in zip(sdf["links"], urdf["links"], strict=True):
        assert ours["name"] == theirs["name"]
        for what in ("pose_world", "mass", "com_world", "inertia_com_linkframe", "collisions", "visuals", "sensors"):
            assert numbers_of(theirs[what]) == pytest.approx(numbers_of(ours[what]), abs=1e-9, rel=1e-9), ours["name"]
    kinds = {
        ours["name"]: (ours["type"], theirs["type"])
        for ours, theirs in zip(sdf["joints"], urdf["joints"], strict=True)
        if ours["type"] != theirs["type"]
    }
    assert kinds == dict.fromkeys(("caster_front_joint", "caster_back_joint"), ("ball", "fixed"))
    assert urdf["plugins"] == sdf["plugins"]


def test_links_have_the_published_masses_and_places(twins: tuple[dict[str, Any], dict[str, Any]]) -> None:
    links = {link["name"]: link for link in twins[0]["links"]}
    assert sum(link["mass"] for link in links.values()) == pytest.approx(
        2.4 + 4 * 0.01 + 3 * 0.52 + 6 * 0.008 + 4 * 0.012 + 4 * 0.06 + 2 * 0.02 + 0.564 + 0.0003, abs=0.01
    )
    for side, y in (("left", 0.115), ("right", -0.115)):
        wheel = links[f"wheel_{side}_link"]
        assert wheel["pose_world"][:3] == pytest.approx([0, y, 0.0352])
        assert wheel["collisions"][0]["geom"]["radius"] == pytest.approx(0.0352)
    assert links["camera_rgb_frame"]["pose_world"][:3] == pytest.approx([-0.087, -0.0125, 0.2972])
    assert links["plate_top_link"]["pose_world"][:3] == pytest.approx([-0.01364, 0, 0.4068])
    assert links["cliff_sensor_front_link"]["pose_world"][:3] == pytest.approx([0.156, 0, 0.0316])
    sensors = {s["name"]: s["update_rate"] for link in links.values() for s in link["sensors"]}
    cliffs = dict.fromkeys((f"cliff_sensor_{side}" for side in ("left", "right", "front")), 50)
    assert sensors == {"bumpers": 50, "imu": 50, "camera": 20, **cliffs}


@pytest.mark.parametrize("form", FILES)
def test_no_element_is_ignored(form: str) -> None:
    assert [d for d in simkit.describe(FILES[form])["diagnostics"] if d["severity"] != "note"] == []


# ------------------------------------------------------------------ standing and driving


def test_it_leans_on_its_back_caster_and_stands_still(robot: tuple[simkit.Simulation, Any]) -> None:
    sim, model = robot
    before = model.pose
    assert before.rpy[1] == pytest.approx(-LEAN, abs=2e-4)
    sim.run(5.0)
    moved = before.inverse() @ model.pose
    assert np.linalg.norm(moved.position) < 1e-5
    assert np.linalg.norm(moved.rpy) < math.radians(0.001)


def test_it_drives_a_metre_straight_and_the_odometry_agrees(robot: tuple[simkit.Simulation, Any]) -> None:
    sim, model = robot
    odometry = sim.subscribe("/odom", keep=1)
    sim.run(0.1)
    before, said = model.pose.position, odometry.latest.pose.pose.position.x
    drive(sim, 5.0, linear=0.2)
    drive(sim, 0.5)
    moved = model.pose.position - before
    assert moved[0] == pytest.approx(1.0, abs=0.005)
    assert abs(moved[1]) < 1e-3
    assert odometry.latest.pose.pose.position.x - said == pytest.approx(moved[0], abs=0.005)


def test_a_full_turn_ends_where_it_began_and_the_imu_agrees(robot: tuple[simkit.Simulation, Any]) -> None:
    sim, model = robot
    odometry = sim.subscribe("/odom", keep=1)
    before = model.pose
    drive(sim, math.pi, angular=2.0)
    drive(sim, 0.5)
    moved = before.inverse() @ model.pose
    assert abs(moved.rpy[2]) < math.radians(2)
    assert np.linalg.norm(moved.position[:2]) < 1e-3
    error = yaw_of(odometry.latest.pose.pose.orientation) - model.pose.rpy[2]
    assert math.remainder(error, 2 * math.pi) == pytest.approx(0, abs=math.radians(1))


def test_it_stops_without_commands(robot: tuple[simkit.Simulation, Any]) -> None:
    sim, model = robot
    before = model.pose.position[0]
    sim.publish(VELOCITY, {"linear": {"x": 0.3}})
    sim.run(2.0)
    # 0.6 s at 0.3 m/s, and one control period at each end
    assert model.pose.position[0] - before == pytest.approx(0.18, abs=0.01)


# ------------------------------------------------------------------ sensors


def test_a_wall_presses_the_bumper() -> None:
    with load("wall") as sim:
        events = sim.subscribe(f"{EVENTS}/bumper")
        drive(sim, 3.0, linear=0.2)
        assert [(m.bumper, m.state) for m in events.messages] == [(1, 1)]
        assert sim.model("turtlebot2").pose.position[0] == pytest.approx(0.65 - 0.178, abs=0.005)
        drive(sim, 1.0, linear=-0.2)
        assert [(m.bumper, m.state) for m in events.messages] == [(1, 1), (1, 0)]


def test_the_cliff_sensors_see_the_edge_of_a_table_in_time() -> None:
    """The robot stops at the first event, with its wheels on the table."""
    with load("table", "0.5 0 0.7 0 0 0") as sim:
        events = sim.subscribe(f"{EVENTS}/cliff")
        while not events.messages and sim.time < 5:
            drive(sim, 0.1, linear=0.2)
        drive(sim, 1.0)
        assert [(m.sensor, m.state) for m in events.messages] == [(1, 1)]
        place = sim.model("turtlebot2").pose.position
        assert 1 - 0.156 - 0.005 < place[0] < 1 - 0.115
        assert place[2] == pytest.approx(0.7, abs=0.005)


def test_a_lifted_robot_drops_its_wheels(robot: tuple[simkit.Simulation, Any]) -> None:
    sim, model = robot
    events = sim.subscribe(f"{EVENTS}/wheel_drop")
    drive(sim, 1.0, linear=0.3)
    assert not events.messages
    model.set_pose(simkit.Pose((0, 0, 0.3)))
    sim.run(0.15)
    assert [(m.wheel, m.state) for m in events.messages] == [(0, 1), (1, 1)]


def test_the_imu_measures_the_turn_and_gravity(robot: tuple[simkit.Simulation, Any]) -> None:
    sim, _ = robot
    imu = sim.subscribe("/mobile_base/sensors/imu_data")
    drive(sim, 2.0, angular=1.0)
    rates = np.array([m.angular_velocity.z for m in imu.messages[50:]])
    lift = np.array([m.linear_acceleration.z for m in imu.messages[50:]])
    assert len(imu.messages) == 100
    assert rates.mean() == pytest.approx(1.0, abs=0.01)
    assert lift.mean() == pytest.approx(9.8 * math.cos(LEAN), abs=0.02)


# ------------------------------------------------------------------ what the scripts write


@pytest.fixture(scope="module")
def scripts() -> Iterator[dict[str, ModuleType]]:
    """The scripts beside the robot."""
    pytest.importorskip("shapely", reason="the drawing script needs shapely")
    before, path = dict(sys.modules), list(sys.path)
    for name in ("make_models", "make_meshes", "robots", "robots_text", "write_obj", "write_sdf", "write_urdf"):
        sys.modules.pop(name, None)
    sys.path.insert(0, str(FOLDER))
    yield {name: importlib.import_module(name) for name in ("make_models", "make_meshes")}
    sys.path[:] = path
    for name in set(sys.modules) - set(before):
        if "assets" in str(getattr(sys.modules[name], "__file__", "")):
            del sys.modules[name]


def test_the_committed_files_are_what_the_script_writes(scripts: dict[str, ModuleType]) -> None:
    for path, text in scripts["make_models"].files().items():
        assert (FOLDER / path).read_text(encoding="utf-8") == text, "run assets/turtlebot2/make_models.py"


def test_every_mesh_is_drawn_by_the_script_and_used(scripts: dict[str, ModuleType]) -> None:
    drawing = scripts["make_meshes"]
    text = FILES["sdf"].read_text(encoding="utf-8")
    assert {file.stem for file in (FOLDER / "meshes").iterdir()} == set(drawing.PARTS)
    for name, draw in drawing.PARTS.items():
        assert f"turtlebot2/meshes/{name}.obj" in text
        written = (FOLDER / "meshes" / f"{name}.obj").read_text(encoding="utf-8")
        assert written == drawing.obj_text(name, draw()), "run assets/turtlebot2/make_meshes.py"
