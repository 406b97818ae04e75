"""Burger, waffle and waffle_pi: the same robot from SDF and from URDF, and a robot that stands, drives and turns."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import simkit

FOLDER = Path(__file__).resolve().parents[2] / "assets" / "turtlebot3"
ROBOTS = ("burger", "waffle", "waffle_pi")
BOTH = list(itertools.product(ROBOTS, ("sdf", "urdf")))
AXLE_END = {"burger": 0.080, "waffle": 0.144, "waffle_pi": 0.144}
CASTERS = {
    "burger": ["caster_back_link"],
    "waffle": ["caster_back_left_link", "caster_back_right_link"],
    "waffle_pi": ["caster_back_left_link", "caster_back_right_link"],
}
TOPICS = {
    "/imu": "sensor_msgs/msg/Imu",
    "/scan": "sensor_msgs/msg/LaserScan",
    "/odom": "nav_msgs/msg/Odometry",
    "/joint_states": "sensor_msgs/msg/JointState",
    "/cmd_vel": "geometry_msgs/msg/Twist",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/tf_static": "tf2_msgs/msg/TFMessage",
}
IMAGES = {"/camera/image_raw": "sensor_msgs/msg/Image", "/camera/camera_info": "sensor_msgs/msg/CameraInfo"}


def file_of(robot: str, form: str) -> Path:
    if form == "sdf":
        return FOLDER / f"turtlebot3_{robot}" / "model.sdf"
    return FOLDER / "urdf" / f"turtlebot3_{robot}.urdf"


def described(robot: str, form: str) -> dict[str, Any]:
    return simkit.describe(file_of(robot, form))["model"]


def named(entries: list[dict[str, Any]]) -> dict[str, dict[str, Any]]:
    return {entry["name"]: entry for entry in entries}


# ------------------------------------------------------------------ the same robot twice


@pytest.fixture(scope="module", params=ROBOTS)
def twins(request: pytest.FixtureRequest) -> tuple[str, dict[str, Any], dict[str, Any]]:
    return request.param, described(request.param, "sdf"), described(request.param, "urdf")


def numbers_of(entry: Any) -> list[float]:
    """All numbers inside, in order of their names."""
    if isinstance(entry, dict):
        return [n for key in sorted(entry) for n in numbers_of(entry[key])]
    if isinstance(entry, list):
        return [n for item in entry for n in numbers_of(item)]
    return [float(entry)] if isinstance(entry, (int, float, bool)) else []


def test_links_have_equal_frames_masses_and_inertias(twins: tuple[str, dict[str, Any], dict[str, Any]]) -> None:
    _, sdf, urdf = twins
    ours, theirs = named(sdf["links"]), named(urdf["links"])
    assert list(ours) == list(theirs)
    for name, link in ours.items():
        for what in ("pose_world", "mass", "com_world", "inertia_com_linkframe"):
            assert numbers_of(theirs[name][what]) == pytest.approx(numbers_of(link[what]), abs=1e-9, rel=1e-9), name


def test_links_have_equal_shapes(twins: tuple[str, dict[str, Any], dict[str, Any]]) -> None:
    _, sdf, urdf = twins
    for ours, theirs in zip(sdf["links"], urdf["links"], strict=True):
        for kind in ("collisions", "visuals"):
            assert [s["name"] for s in theirs[kind]] == [s["name"] for s in ours[kind]]
            assert [s["geom"]["type"] for s in theirs[kind]] == [s["geom"]["type"] for s in ours[kind]]
            assert numbers_of(theirs[kind]) == pytest.approx(numbers_of(ours[kind]), abs=1e-9)


def test_joints_have_equal_axes_and_limits(twins: tuple[str, dict[str, Any], dict[str, Any]]) -> None:
    """All but the casters', which are balls in SDF and fixed in URDF: that format has no ball joint."""
    robot, sdf, urdf = twins
    ours, theirs = named(sdf["joints"]), named(urdf["joints"])
    assert list(ours) == list(theirs)
    for name, joint in ours.items():
        other = theirs[name]
        if joint["child_link"].rsplit("::", 1)[-1] in CASTERS[robot]:
            assert (joint["type"], other["type"]) == ("ball", "fixed")
            assert numbers_of(other["pose_world"]) == pytest.approx(numbers_of(joint["pose_world"]), abs=1e-9)
            continue
        assert [other[k] for k in ("type", "parent_link", "child_link")] == [
            joint[k] for k in ("type", "parent_link", "child_link")
        ]
        for what in ("pose_world", "axes"):
            assert numbers_of(other[what]) == pytest.approx(numbers_of(joint[what]), abs=1e-9), name


def test_sensors_and_plugins_are_equal(twins: tuple[str, dict[str, Any], dict[str, Any]]) -> None:
    _, sdf, urdf = twins
    for ours, theirs in zip(sdf["links"], urdf["links"], strict=True):
        assert [(s["name"], s["type"], s["topic"]) for s in theirs["sensors"]] == [
            (s["name"], s["type"], s["topic"]) for s in ours["sensors"]
        ]
        assert numbers_of(theirs["sensors"]) == pytest.approx(numbers_of(ours["sensors"]), abs=1e-9)
    assert urdf["plugins"] == sdf["plugins"]


def test_another_reader_of_urdf_sees_the_same_frames(twins: tuple[str, dict[str, Any], dict[str, Any]]) -> None:
    yourdfpy = pytest.importorskip("yourdfpy")
    robot, sdf, _ = twins
    other = yourdfpy.URDF.load(str(file_of(robot, "urdf")), load_meshes=False, build_scene_graph=True)
    for link in sdf["links"]:
        pose = simkit.Pose(link["pose_world"][:3], link["pose_world"][3:])
        matrix = other.get_transform(link["name"], "base_footprint")
        np.testing.assert_allclose(matrix[:3, 3], pose.position, atol=1e-9, err_msg=link["name"])
        for axis in np.eye(3):
            turned = (pose @ simkit.Pose(axis)).position - pose.position
            np.testing.assert_allclose(matrix[:3, :3] @ axis, turned, atol=1e-9, err_msg=link["name"])


# ------------------------------------------------------------------ the published numbers


@pytest.mark.parametrize(
    "robot, base, wheel, total",
    [("burger", 0.825735, 0.1, 1.14474), ("waffle", 1.37291, 0.1, 1.72391), ("waffle_pi", 1.37291, 0.0284989, 1.58091)],
)
def test_the_masses_are_the_published_ones(robot: str, base: float, wheel: float, total: float) -> None:
    """`total` is the published mass without the phantom kilograms of frames; a frame weighs a gram here."""
    links = named(described(robot, "sdf")["links"])
    assert links["base_link"]["mass"] == pytest.approx(base, abs=1e-6)
    assert links["wheel_left_link"]["mass"] == links["wheel_right_link"]["mass"] == pytest.approx(wheel, abs=1e-6)
    assert sum(link["mass"] for link in links.values()) == pytest.approx(total + 0.006, abs=0.006)


def test_the_parts_of_the_burger_are_where_they_were_published() -> None:
    links = named(described("burger", "sdf")["links"])
    places = {
        "base_link": (0, 0, 0.010),
        "wheel_left_link": (0, 0.080, 0.033),
        "wheel_right_link": (0, -0.080, 0.033),
        "caster_back_link": (-0.081, 0, 0.006),
        "imu_link": (-0.032, 0, 0.078),
        "base_scan": (-0.032, 0, 0.181),
    }
    assert {n: tuple(links[n]["pose_world"][:3]) for n in places} == {n: pytest.approx(p) for n, p in places.items()}
    assert links["base_link"]["collisions"][0]["geom"]["size"] == pytest.approx([0.14, 0.14, 0.14])


def test_the_camera_of_the_waffle_pi_is_the_published_one() -> None:
    links = named(described("waffle_pi", "sdf")["links"])
    (camera,) = links["camera_rgb_frame"]["sensors"]
    assert (camera["type"], camera["update_rate"]) == ("camera", 30)
    assert camera["camera"] == pytest.approx({"width": 640, "height": 480, "hfov": 1.085595, "near": 0.03, "far": 100})
    assert camera["pose_world"][:3] == pytest.approx([0.076, 0, 0.103], abs=1e-9)


@pytest.mark.parametrize("robot, form", BOTH)
def test_every_robot_checks_clean_even_strictly(robot: str, form: str) -> None:
    found = simkit.build.check(file_of(robot, form))
    assert [str(d) for d in found if d.severity != "note"] == []


@pytest.mark.parametrize("robot, form", BOTH)
def test_every_robot_is_found_by_its_bare_name(robot: str, form: str) -> None:
    name = f"turtlebot3_{robot}" + (".urdf" if form == "urdf" else "")
    assert simkit.describe(name)["model"]["name"] == f"turtlebot3_{robot}"


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_environment_variable_picks_the_robot(robot: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TURTLEBOT3_MODEL", robot)
    with simkit.load("turtlebot3_empty") as sim:
        links = {link.rsplit("::", 1)[-1] for link in sim.model("turtlebot3").links}
        assert set(CASTERS[robot]) <= links
        end = sim.link("turtlebot3::wheel_left_link").pose.position[1]
        assert end == pytest.approx(AXLE_END[robot], abs=1e-9)


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_bare_name_without_a_kind_is_the_robot_of_the_variable(robot: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TURTLEBOT3_MODEL", robot)
    assert simkit.describe("turtlebot3")["model"]["name"] == f"turtlebot3_{robot}"
    monkeypatch.setenv("TURTLEBOT3_MODEL", "pancake")
    with pytest.raises(simkit.LoadError, match="pancake"):
        simkit.describe("turtlebot3")


def test_a_solar_sensor_without_any_world_is_silent_and_says_so() -> None:
    with simkit.load("turtlebot3_waffle") as sim:
        readings = sim.subscribe("/sunloin_imu")
        sim.run(0.2)
        assert readings.latest is None
        assert "SK-PLUGIN-009" in {d.code for d in sim.diagnostics}


# ------------------------------------------------------------------ how it behaves


@dataclass(frozen=True)
class Trial:
    """What a robot did: stood a minute, drove a metre, turned once."""

    robot: str
    form: str
    topics: dict[str, str]
    touching: set[str]
    drift: float
    tilt: float
    straight: np.ndarray
    said_straight: float
    turned: float
    said_turned: float


def step_angle(before: float, after: float) -> float:
    return (after - before + math.pi) % (2 * math.pi) - math.pi


def touching_ground(sim: simkit.Simulation) -> set[str]:
    """Links that touch anything."""
    model, data = sim.mj_model, sim.mj_data
    geoms = {g for contact in data.contact for g in (contact.geom1, contact.geom2)}
    names = [model.geom(int(g)).name for g in geoms]
    return {name.split("::")[1] for name in names if name.startswith("robot::")}


def tried(robot: str, form: str, step: float) -> Trial:
    with simkit.load("empty", overrides=[f"physics.max_step_size={step}"]) as sim:
        model = sim.spawn(file_of(robot, form), name="robot")
        odometry = sim.subscribe("/odom", keep=1)
        sim.run(2.0)
        before = model.pose
        sim.run(60.0)
        stood = before.inverse() @ model.pose
        touching = touching_ground(sim)

        before, said_before = model.pose, odometry.latest.pose.pose.position.x
        sim.publish("/cmd_vel", {"linear": {"x": 0.2}})
        sim.run(5.0)
        sim.publish("/cmd_vel", {})
        sim.run(1.0)
        drove = before.inverse() @ model.pose
        said = odometry.latest.pose.pose.position.x - said_before

        turned = said_turned = 0.0
        yaw, said_yaw = model.pose.rpy[2], heading(odometry.latest)
        sim.publish("/cmd_vel", {"angular": {"z": 1.0}})
        for k in range(29):
            if k == 25:
                sim.publish("/cmd_vel", {"angular": {"z": 4 * (2 * math.pi - 6.25)}})
            if k == 26:
                sim.publish("/cmd_vel", {})
            sim.run(0.25)
            turned += step_angle(yaw, model.pose.rpy[2])
            said_turned += step_angle(said_yaw, heading(odometry.latest))
            yaw, said_yaw = model.pose.rpy[2], heading(odometry.latest)
        return Trial(
            robot,
            form,
            sim.topics(),
            touching,
            float(np.linalg.norm(stood.position)),
            float(np.linalg.norm(stood.rpy)),
            np.array(drove.position),
            said,
            turned,
            said_turned,
        )


def heading(message: Any) -> float:
    q = message.pose.pose.orientation
    return 2 * math.atan2(q.z, q.w)


QUICK_STEPS = {"sdf": 0.001, "urdf": 0.004}
"""Step [s] of the trials that are not slow: each robot at the shortest and at the longest step."""
TRIALS = [
    pytest.param(
        (robot, form, step), id=f"{robot}-{form}-{step}", marks=() if step == QUICK_STEPS[form] else pytest.mark.slow
    )
    for robot, form in BOTH
    for step in (0.001, 0.002, 0.004)
]


@pytest.fixture(scope="module", params=TRIALS)
def trial(request: pytest.FixtureRequest) -> Trial:
    return tried(*request.param)


def test_it_stands_still_for_a_minute(trial: Trial) -> None:
    assert trial.drift < 1e-4
    assert trial.tilt < math.radians(0.01)


def test_it_stands_on_its_wheels_and_casters_alone(trial: Trial) -> None:
    """A fixed caster's shape may belong to the body that it is fixed to."""
    assert {"wheel_left_link", "wheel_right_link"} <= trial.touching
    assert len(trial.touching) == 2 + len(CASTERS[trial.robot])


def test_it_drives_a_metre_straight(trial: Trial) -> None:
    assert trial.straight[0] == pytest.approx(1.0, rel=0.01)
    assert abs(trial.straight[1]) < 0.01
    assert trial.said_straight == pytest.approx(trial.straight[0], rel=5e-3)


def test_it_turns_once_around(trial: Trial) -> None:
    assert trial.turned == pytest.approx(2 * math.pi, rel=0.01)
    assert trial.said_turned == pytest.approx(trial.turned, rel=0.01)


def test_it_speaks_on_the_usual_topics(trial: Trial) -> None:
    expected = TOPICS if trial.robot == "burger" else TOPICS | IMAGES
    assert {name: trial.topics.get(name) for name in expected} == expected
    assert ("/camera/image_raw" in trial.topics) == (trial.robot != "burger")
    assert ("/camera/depth/image_raw" in trial.topics) == (trial.robot == "waffle")
