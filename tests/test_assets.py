"""Our own robot and worlds: what a user runs first has the published numbers, and every world runs."""

from __future__ import annotations

import importlib
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import yaml

import simkit

ROOT = Path(__file__).resolve().parents[1]
ROBOT_FOLDER = ROOT / "assets" / "turtlebot3"
ROBOT_FILE = ROBOT_FOLDER / "turtlebot3_waffle" / "model.sdf"
WORLDS = sorted([*ROOT.glob("worlds/*.sdf"), *ROOT.glob("packs/*/simkit_*/worlds/*.sdf")])
PILLARS = [(1.1 * i, 1.1 * j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
REACH = math.hypot(0.1975, 0.1325)  # from the axle's middle to a rear corner of the body [m]


@pytest.fixture(autouse=True)
def no_robot_chosen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("TURTLEBOT3_MODEL", raising=False)


@pytest.fixture(scope="module")
def robot() -> dict[str, dict]:
    """What `simkit inspect` says about the waffle, links and joints by name."""
    model = simkit.describe(ROBOT_FILE)["model"]
    return {kind: {entry["name"]: entry for entry in model[kind]} for kind in ("links", "joints", "plugins")}


# ------------------------------------------------------------------ the waffle


def test_links_have_the_published_masses(robot: dict[str, dict]) -> None:
    published = {
        "base_link": 1.3729096,
        "wheel_left_link": 0.1,
        "wheel_right_link": 0.1,
        "base_scan": 0.114,
        "camera_rgb_frame": 0.035,
        "caster_back_left_link": 0.001,
        "caster_back_right_link": 0.001,
    }
    assert {name: robot["links"][name]["mass"] for name in published} == pytest.approx(published)


def test_no_link_carries_a_phantom_kilogram(robot: dict[str, dict]) -> None:
    """The whole robot weighs what its parts do: 1.724 kg published, and a few grams of frames and solar cell."""
    total = sum(link["mass"] for link in robot["links"].values())
    assert total == pytest.approx(1.72391 + 0.011, abs=1e-4)


@pytest.mark.parametrize("side, y", [("left", 0.144), ("right", -0.144)])
def test_a_wheel_turns_about_its_axle_and_touches_the_ground(robot: dict[str, dict], side: str, y: float) -> None:
    wheel, joint = robot["links"][f"wheel_{side}_link"], robot["joints"][f"wheel_{side}_joint"]
    assert wheel["pose_world"][:3] == pytest.approx([0, y, 0.033], abs=1e-9)
    assert joint["pose_world"][:3] == pytest.approx([0, y, 0.033], abs=1e-9)
    assert joint["axes"][0]["xyz_world"] == pytest.approx([0, 1, 0], abs=1e-9)
    assert joint["axes"][0]["effort"] == pytest.approx(20)
    shape = wheel["collisions"][0]["geom"]
    assert (shape["type"], shape["radius"], shape["length"]) == ("cylinder", 0.033, 0.018)


@pytest.mark.parametrize("side, y", [("left", 0.064), ("right", -0.064)])
def test_a_caster_is_a_ball_a_millimetre_above_the_ground(robot: dict[str, dict], side: str, y: float) -> None:
    caster = robot["links"][f"caster_back_{side}_link"]
    assert caster["pose_world"][:3] == pytest.approx([-0.177, y, 0.006], abs=1e-9)
    assert caster["collisions"][0]["geom"]["radius"] == pytest.approx(0.005)
    assert robot["joints"][f"caster_back_{side}_joint"]["type"] == "ball"


def test_sensors_are_where_and_what_was_published(robot: dict[str, dict]) -> None:
    sensors = {s["name"]: s for link in robot["links"].values() for s in link["sensors"]}
    assert {n: s["update_rate"] for n, s in sensors.items()} == {"imu": 200, "lds": 5, "camera": 30}
    assert sensors["lds"]["lidar"] == pytest.approx(
        {
            "h_samples": 360,
            "h_min": 0,
            "h_max": 6.28,
            "v_samples": 1,
            "v_min": 0,
            "v_max": 0,
            "range_min": 0.12,
            "range_max": 3.5,
        }
    )
    assert sensors["lds"]["pose_world"][:3] == pytest.approx([-0.064, 0, 0.131], abs=1e-9)
    assert sensors["camera"]["camera"] == pytest.approx(
        {"width": 640, "height": 480, "hfov": 1.02974, "near": 0.05, "far": 10}
    )
    assert sensors["camera"]["pose_world"][:3] == pytest.approx([0.069, -0.047, 0.117], abs=1e-9)


def test_the_optical_frame_looks_along_the_camera(robot: dict[str, dict]) -> None:
    """z of the optical frame is the camera's x, its x points to the right."""
    optical = simkit.Pose(quaternion=robot["links"]["camera_rgb_optical_frame"]["pose_world"][3:])
    for axis, direction in (((0, 0, 1), (1, 0, 0)), ((1, 0, 0), (0, -1, 0))):
        np.testing.assert_allclose((optical @ simkit.Pose(axis)).position, direction, atol=1e-9)


def test_nothing_of_the_waffle_is_ignored() -> None:
    """Our own file gives no errors and no warnings."""
    found = simkit.describe(ROBOT_FILE)["diagnostics"]
    assert [d for d in found if d["severity"] != "note"] == []


def test_the_robot_speaks_on_the_topics_of_the_course() -> None:
    with simkit.load("turtlebot3_world") as sim:
        topics = sim.topics()
    expected = {
        "/imu": "sensor_msgs/msg/Imu",
        "/scan": "sensor_msgs/msg/LaserScan",
        "/odom": "nav_msgs/msg/Odometry",
        "/joint_states": "sensor_msgs/msg/JointState",
        "/cmd_vel": "geometry_msgs/msg/Twist",
        "/camera/image_raw": "sensor_msgs/msg/Image",
        "/camera/camera_info": "sensor_msgs/msg/CameraInfo",
        "/camera/depth/image_raw": "sensor_msgs/msg/Image",
        "/sunloin_imu": "sensor_msgs/msg/Imu",
    }
    assert {name: topics.get(name) for name in expected} == expected


# ------------------------------------------------------------------ worlds


@pytest.mark.parametrize("world", WORLDS, ids=lambda p: p.stem)
def test_every_world_loads_clean_and_steps(world: Path) -> None:
    with simkit.load(world) as sim:
        # an arm robot among people has twice the time for a step; turtlesim has its own period
        assert sim.timestep == pytest.approx(
            {"simple_office_with_people": 0.002, "turtlesim": 0.016, "turtlesim_board": 0.016}.get(world.stem, 0.001)
        )
        assert "sun" in sim.contents.lights
        if world.stem == "turtlesim_board":  # its nodes add the squares
            assert not sim.models
        else:
            assert ("square" if world.stem == "turtlesim" else "ground_plane") in sim.models
        sim.step()
        assert sim.time == sim.timestep
        assert [str(d) for d in sim.diagnostics if d.severity != "note"] == []


@pytest.mark.parametrize("world", WORLDS, ids=lambda p: p.stem)
def test_every_world_is_found_by_its_bare_name(world: Path) -> None:
    with simkit.load(world.stem) as sim:
        assert sim.models or world.stem == "turtlesim_board"


def test_an_unknown_robot_is_an_error_that_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TURTLEBOT3_MODEL", "pancake")
    with pytest.raises(simkit.LoadError, match="pancake"):
        simkit.load("turtlebot3_world")


def test_the_scan_sees_pillars_and_walls_where_they_stand() -> None:
    """Without noise each reading is the distance to the nearest circle or wall along its ray, to a millimetre."""
    with simkit.load("turtlebot3_world") as sim:
        sim.run(1.0)
        lidar = sim.sensor("turtlebot3::base_scan::lds")
        scan, pose = lidar.truth, lidar.pose
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    rays = np.array([(pose @ simkit.Pose((math.cos(a), math.sin(a), 0))).position for a in angles]) - pose.position
    expected = np.array([distance_to_arena(np.array(pose.position[:2]), ray) for ray in rays])
    expected[expected > 3.5] = np.inf
    clear = np.abs(np.gradient(np.minimum(expected, 9.0))) < 0.05  # not at the edge of a pillar
    assert clear.sum() > 300
    np.testing.assert_allclose(np.asarray(scan.ranges)[clear], expected[clear], atol=2e-3)


def test_the_arena_is_a_model_for_worlds_of_the_user() -> None:
    """The layout of the course includes the model in a static model of the same name; the same scan is seen there."""
    text = (ROOT / "worlds" / "turtlebot3_world.sdf").read_text(encoding="utf-8")
    inner, outer = text.index('<model name="arena">'), text.index("<include>")
    include = "<model name='turtlebot3_world'><static>1</static><include><uri>model://turtlebot3_world</uri></include></model>"
    scans = []
    for world in (text, text[:inner] + include + text[outer:]):
        with simkit.load(world) as sim:
            sim.run(0.5)
            scans.append(np.asarray(sim.sensor("turtlebot3::base_scan::lds").truth.ranges))
            assert [d for d in sim.diagnostics if d.severity != "note"] == []
    np.testing.assert_allclose(scans[1], scans[0], atol=1e-6)


def distance_to_arena(origin: np.ndarray, ray: np.ndarray) -> float:
    """Along the unit vector `ray` from `origin` (x, y) to the first pillar or wall [m]."""
    flat = float(np.hypot(ray[0], ray[1]))
    x, y = ray[0] / flat, ray[1] / flat
    hits = []
    for i in range(6):
        nx, ny = math.cos(math.radians(30 + 60 * i)), math.sin(math.radians(30 + 60 * i))
        along = nx * x + ny * y
        if along > 1e-9:
            hits.append((2.5 - origin[0] * nx - origin[1] * ny) / along)
    for cx, cy in PILLARS:
        ahead = (cx - origin[0]) * x + (cy - origin[1]) * y
        aside = (cx - origin[0]) * y - (cy - origin[1]) * x
        if ahead > 0 and abs(aside) < 0.15:
            hits.append(ahead - math.sqrt(0.15**2 - aside**2))
    return min(hits) / flat


def test_the_drive_of_the_first_run_touches_nothing() -> None:
    """The scripted loop keeps the robot's corners clear of all pillars and walls, and ends near where it began."""
    entries = yaml.safe_load((ROOT / "worlds" / "turtlebot3_world_drive.yaml").read_text(encoding="utf-8"))
    track = []
    with simkit.load("turtlebot3_world") as sim:
        robot = sim.model("turtlebot3")
        for entry, following in zip(entries, [*entries[1:], {"at": 36.0}], strict=True):
            sim.run(entry["at"] - sim.time)
            sim.publish(entry["topic"], entry["message"])
            while sim.time < following["at"] - 0.1:
                sim.run(0.1)
                track.append(robot.pose.position[:2])
    x, y = np.array(track).T
    assert min(np.hypot(x - cx, y - cy).min() - 0.15 for cx, cy in PILLARS) > REACH
    for i in range(6):
        angle = math.radians(30 + 60 * i)
        assert (2.5 - x * math.cos(angle) - y * math.sin(angle)).min() > REACH
    assert x.max() > 1.4, "it goes round the last pillar"
    assert x[-1] < -1.6, "and comes home"


# ------------------------------------------------------------------ the house

FURNITURE = ("sofa", "coffee_table", "dining_table", "chair_1", "counter", "bed", "wardrobe", "bathtub", "desk")
MOVABLE = {"ball": 0.3, "parcel": 1.0, "waste_bin": 0.6, "stool": 2.0}


def test_the_house_has_rooms_with_furniture_that_stands_still_and_things_that_can_be_pushed() -> None:
    with simkit.load("turtlebot3_house") as sim:
        house = sim.model("house")
        assert house.static
        assert set(FURNITURE) <= {link.name for link in house.links.values()}
        assert {name: sim.link(f"{name}::link").mass for name in MOVABLE} == pytest.approx(MOVABLE)
        sim.run(1.0)
        before = {name: sim.model(name).pose.position for name in MOVABLE}
        sim.run(5.0)
        for name, place in before.items():
            assert np.linalg.norm(sim.model(name).pose.position - place) < 1e-4, name


def test_the_houses_furniture_is_geoms_of_the_world_body() -> None:
    """So hundreds of shapes cost little: only the robot and what can be pushed are bodies."""
    with simkit.load("turtlebot3_house") as sim:
        bodies = {sim.mj_model.body(i).name.split("::")[0] for i in range(1, sim.mj_model.nbody)}
        assert bodies == {"turtlebot3", *MOVABLE}


def test_a_scan_in_the_house_sees_the_rooms_walls() -> None:
    """From the middle of the hall: its walls 0.54 m to the left and right, the bedroom's wardrobe through the door."""
    with simkit.load("turtlebot3_house") as sim:
        robot = sim.model("turtlebot3")
        robot.set_pose(simkit.Pose((-2.5 + 0.064, 1.0, 0.0)))  # the lidar stands opposite the bedroom's door
        sim.run(0.5)
        lidar = sim.sensor("turtlebot3::base_scan::lds")
        assert lidar.pose.position[0] == pytest.approx(-2.5, abs=2e-3)
        ranges = np.asarray(lidar.truth.ranges)
    angle = np.arange(len(ranges)) * 6.28 / 359
    for degrees in (45, 255, 270, 285):
        i = int(np.argmin(np.abs(angle - math.radians(degrees))))
        assert ranges[i] == pytest.approx(0.54 / abs(math.sin(angle[i])), abs=0.02), (
            f"the hall's wall at {degrees} degrees"
        )
    assert ranges[90] == pytest.approx(3.69 - 1.0, abs=0.03), "the wardrobe's front, through the door"


def test_the_scan_at_the_start_has_many_distances() -> None:
    with simkit.load("turtlebot3_house") as sim:
        sim.run(0.5)
        ranges = np.asarray(sim.sensor("turtlebot3::base_scan::lds").truth.ranges)
    seen = ranges[np.isfinite(ranges)]
    assert len(seen) > 250
    assert seen.min() > 0.5
    assert np.ptp(seen) > 2.5


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["burger", "waffle", "waffle_pi"])
def test_the_drive_through_the_house_touches_nothing(robot: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Living room, kitchen, hall and home again: 0.15 m to spare around a waffle, 0.19 m from lidar to corner."""
    monkeypatch.setenv("TURTLEBOT3_MODEL", robot)
    entries = yaml.safe_load((ROOT / "worlds" / "turtlebot3_house_drive.yaml").read_text(encoding="utf-8"))
    track, nearest = [], []
    with simkit.load("turtlebot3_house", overrides=["physics.max_step_size=0.002"]) as sim:
        model, lidar = sim.model("turtlebot3"), sim.sensor("turtlebot3::base_scan::lds")
        for entry, following in zip(entries, [*entries[1:], {"at": 73.0}], strict=True):
            sim.run(entry["at"] - sim.time)
            sim.publish(entry["topic"], entry["message"])
            while sim.time < following["at"] - 0.4:
                sim.run(0.4)
                track.append(model.pose.position[:2])
                nearest.append(float(np.min(lidar.truth.ranges)))
    x, y = np.array(track).T
    assert min(nearest) > 0.34
    assert x.max() > 2.4, "it was in the kitchen"
    assert y.max() > 0.9 and x[y > 0.9].min() < -0.9, "and went along the hall"
    assert (x[-1], y[-1]) == pytest.approx((-2.0, -0.5), abs=0.15), "and came home"


def test_the_robot_pushes_the_parcel() -> None:
    with simkit.load("turtlebot3_house") as sim:
        robot, parcel = sim.model("turtlebot3"), sim.model("parcel")
        robot.set_pose(simkit.Pose((3.6, 1.05, 0.0)))
        sim.run(0.5)
        before = parcel.pose.position[0]
        sim.publish("/cmd_vel", {"linear": {"x": 0.2}})
        sim.run(4.0)
        assert parcel.pose.position[0] - before > 0.1


# ------------------------------------------------------------------ what the scripts write


@pytest.fixture(scope="module")
def scripts() -> Iterator[None]:
    """The scripts beside the robots, importable."""
    pytest.importorskip("shapely", reason="the drawing script needs shapely")
    before = set(sys.modules)
    sys.path.insert(0, str(ROBOT_FOLDER))
    yield
    sys.path.remove(str(ROBOT_FOLDER))
    for name in set(sys.modules) - before:
        if str(ROBOT_FOLDER) in str(getattr(sys.modules[name], "__file__", "")):
            del sys.modules[name]


@pytest.fixture(scope="module")
def drawing(scripts: None) -> ModuleType:
    return importlib.import_module("make_meshes")


@pytest.mark.parametrize("script", ["make_models", "make_house", "make_arena"])
def test_the_committed_files_are_what_the_script_writes(scripts: None, script: str) -> None:
    for path, text in importlib.import_module(script).files().items():
        assert (ROBOT_FOLDER / path).read_text(encoding="utf-8") == text, f"run assets/turtlebot3/{script}.py"


def test_every_mesh_is_drawn_by_the_script_and_used(drawing: ModuleType) -> None:
    texts = [p.read_text(encoding="utf-8") for p in ROBOT_FOLDER.glob("*/model.sdf")]
    for folder, parts in drawing.PARTS.items():
        files = {p.stem for p in (ROBOT_FOLDER / folder / "meshes").glob("*")}
        assert files == set(parts)
        assert {f for f in files if any(f"{folder}/meshes/{f}.obj" in text for text in texts)} == files


def test_the_committed_meshes_have_the_shape_that_the_script_draws(drawing: ModuleType) -> None:
    """In outer size; how a plate is cut into triangles depends on a library's version."""
    for folder, parts in drawing.PARTS.items():
        for name, draw in parts.items():
            text = (ROBOT_FOLDER / folder / "meshes" / f"{name}.obj").read_text(encoding="utf-8")
            written = np.array([line.split()[1:] for line in text.splitlines() if line.startswith("v ")], dtype=float)
            drawn = np.vstack([part.vertices for part in draw()])
            np.testing.assert_allclose(written.min(axis=0), drawn.min(axis=0), atol=2e-5, err_msg=name)
            np.testing.assert_allclose(written.max(axis=0), drawn.max(axis=0), atol=2e-5, err_msg=name)


@pytest.mark.parametrize(
    "size, body, y, lidar, front",
    [
        ((0.138, 0.178, 0.192), "turtlebot3_burger/plates", 0.080, (-0.032, 0, 0.181), None),
        ((0.281, 0.306, 0.141), "turtlebot3_common/waffle_plates", 0.144, (-0.064, 0, 0.131), (0.069, -0.047, 0.117)),
    ],
    ids=["burger", "waffle"],
)
def test_the_meshes_have_the_published_outer_size(
    drawing: ModuleType,
    size: tuple[float, ...],
    body: str,
    y: float,
    lidar: tuple[float, ...],
    front: tuple[float, ...] | None,
) -> None:
    """Width and height to 2 mm, length to 15 mm, as the parts stand on the robot."""
    common = drawing.PARTS["turtlebot3_common"]
    folder, plates = body.split("/")
    parts = [(common["tyre"], (0, y, 0.033)), (common["tyre"], (0, -y, 0.033)), (common["lidar_head"], lidar)]
    parts.append((drawing.PARTS[folder][plates], (0, 0, 0.010)))
    if front is not None:
        parts.append((drawing.PARTS["turtlebot3_waffle"]["camera_body"], front))
    corners = np.vstack([part.vertices + place for draw, place in parts for part in draw()])
    assert np.ptp(corners[:, 0]) == pytest.approx(size[0], abs=0.015)
    assert np.ptp(corners[:, 1]) == pytest.approx(size[1], abs=0.002)
    assert corners[:, 2].min() == pytest.approx(0, abs=5e-4)
    assert corners[:, 2].max() == pytest.approx(size[2], abs=0.002)


def test_a_tyre_rolls_on_the_wheels_radius(drawing: ModuleType) -> None:
    """No tread rib is outside the collision cylinder."""
    vertices = np.vstack([part.vertices for part in drawing.tyre()])
    assert np.hypot(vertices[:, 0], vertices[:, 2]).max() == pytest.approx(0.033, abs=1e-5)
    assert np.abs(vertices[:, 1]).max() == pytest.approx(0.009, abs=1e-5)
