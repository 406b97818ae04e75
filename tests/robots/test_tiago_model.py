"""TIAGo, TIAGo without arm and PMB2: the published numbers, the same robot from SDF and from URDF, and its files."""

from __future__ import annotations

import importlib
import itertools
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import yaml

import simkit

FOLDER = Path(__file__).resolve().parents[2] / "assets" / "tiago"
MASSES = {"tiago": 85.4785, "tiago_no_arm": 75.499, "pmb2": 53.034}
ROBOTS = tuple(MASSES)

# joint: type, parent, child, lower, upper, effort, velocity, damping, friction, mass carried rigidly by the child
BASE_JOINTS: dict[str, tuple[Any, ...]] = {
    **{
        f"suspension_{side}_joint": (
            *("prismatic", "base_link", f"suspension_{side}_link"),
            *(-0.005, 0.005, 100, 1, 100, 0, 10),
        )
        for side in ("right", "left")
    },
    **{
        f"wheel_{side}_joint": (
            *("continuous", f"suspension_{side}_link", f"wheel_{side}_link"),
            *(None, None, 6, 10.1523, 1, 2, 1.824),
        )
        for side in ("right", "left")
    },
    **{
        f"caster_{place}_{part}_joint": (
            *("continuous", "base_link" if part == 1 else f"caster_{place}_1_link", f"caster_{place}_{part}_link"),
            *(None, None, None, None, 0.015, 0, 0.05145 if part == 1 else 0.08856),
        )
        for place in ("front_right", "front_left", "back_right", "back_left")
        for part in (1, 2)
    },
}
UPPER_JOINTS: dict[str, tuple[Any, ...]] = {
    "torso_lift_joint": ("prismatic", "torso_fixed_link", "torso_lift_link", 0, 0.35, 2000, 0.07, 1000, 0, 6.932),
    "head_1_joint": ("revolute", "torso_lift_link", "head_1_link", -1.309, 1.309, 5.197, 3, 0.5, 1, 0.6222),
    "head_2_joint": ("revolute", "head_1_link", "head_2_link", -1.0472, 0.785398, 2.77, 3, 0.5, 1, 0.8869),
}
ARM_JOINTS: dict[str, tuple[Any, ...]] = {
    "arm_1_joint": ("revolute", "torso_lift_link", "arm_1_link", 0, 2.74889, 43, 1.95, 40, 1, 1.563),
    "arm_2_joint": ("revolute", "arm_1_link", "arm_2_link", -1.5708, 1.09083, 43, 1.95, 40, 1, 1.8),
    "arm_3_joint": ("revolute", "arm_2_link", "arm_3_link", -3.53429, 1.5708, 26, 2.35, 40, 1, 1.8),
    "arm_4_joint": ("revolute", "arm_3_link", "arm_4_link", -0.392699, 2.35619, 26, 2.35, 40, 1, 1.433),
    "arm_5_joint": ("revolute", "arm_4_link", "arm_5_link", -2.0944, 2.0944, 3, 1.95, 1, 1, 1.656),
    "arm_6_joint": ("revolute", "arm_5_link", "arm_6_link", -1.41372, 1.41372, 6.6, 1.76, 1, 1, 0.3701),
    "arm_7_joint": ("revolute", "arm_6_link", "arm_7_link", -2.0944, 2.0944, 6.6, 1.76, 1, 1, 0.3343),
    **{
        f"gripper_{side}_finger_joint": (
            *("prismatic", "gripper_link", f"gripper_{side}_finger_link"),
            *(0, 0.045, 16, 0.05, 80, 2, 0.11),
        )
        for side in ("right", "left")
    },
}
MOVING = {
    "tiago": {**BASE_JOINTS, **UPPER_JOINTS, **ARM_JOINTS},
    "tiago_no_arm": {**BASE_JOINTS, **UPPER_JOINTS},
    "pmb2": BASE_JOINTS,
}
SOFT = {  # soft limits of the safety controllers, with (k_position, k_velocity)
    **{f"suspension_{side}_joint": (-0.005, 0.005, 0, 10) for side in ("right", "left")},
    "torso_lift_joint": (0, 0.35, 20, 20),
    "head_1_joint": (-1.239, 1.239, 20, 20),
    "head_2_joint": (-0.977198, 0.715398, 20, 20),
    "arm_1_joint": (0.07, 2.67889, 20, 20),
    "arm_2_joint": (-1.5008, 1.02083, 20, 20),
    "arm_3_joint": (-3.46429, 1.5008, 20, 20),
    "arm_4_joint": (-0.322699, 2.28619, 20, 20),
    "arm_5_joint": (-2.0744, 2.0744, 20, 20),
    "arm_6_joint": (-1.39372, 1.39372, 20, 20),
    "arm_7_joint": (-2.0744, 2.0744, 20, 20),
    **{f"gripper_{side}_finger_joint": (0.001, 0.044, 20, 20) for side in ("right", "left")},
}
BASE_FRAMES = {
    *(f"base_{what}_link" for what in ("laser", "sonar_01", "sonar_02", "sonar_03", "cover", "imu")),
    *(f"base_antenna_{side}_link" for side in ("left", "right")),
    *(f"base_mic_{end}_{side}_link" for end in ("front", "back") for side in ("left", "right")),
    "base_link",
}
CAMERA_FRAMES = {
    f"head_front_camera_{what}"
    for what in (
        *("link", "optical_frame", "orbbec_aux_joint_frame", "depth_frame", "depth_optical_frame"),
        *("rgb_frame", "rgb_optical_frame"),
    )
}
TORSO_FRAMES = {"torso_fixed_link", "torso_fixed_column_link", "rgbd_laser_link"}
TOOL_FRAMES = {
    *("arm_tool_link", "wrist_ft_link", "wrist_ft_tool_link"),
    *("gripper_link", "gripper_tool_link", "gripper_grasping_frame"),
}
FIXED = {
    "tiago": BASE_FRAMES | CAMERA_FRAMES | TORSO_FRAMES | TOOL_FRAMES,
    "tiago_no_arm": BASE_FRAMES | CAMERA_FRAMES | TORSO_FRAMES,
    "pmb2": BASE_FRAMES,
}
PLACES = {  # where a link is in base_footprint when every joint is at 0 [m]
    "base_link": (0, 0, 0.0985),
    "base_laser_link": (0.202, 0, 0.0945),
    "base_sonar_01_link": (-0.183, -0.183, 0.2715),
    "base_sonar_02_link": (-0.259, 0, 0.2715),
    "base_sonar_03_link": (-0.183, 0.183, 0.2715),
    "wheel_left_link": (0, 0.2022, 0.0985),
    "wheel_right_link": (0, -0.2022, 0.0985),
    "caster_front_left_2_link": (0.1535, 0.102, 0.025),
    "torso_lift_link": (-0.062, 0, 0.8885),
    "head_1_link": (0.12, 0, 0.8885),
    "head_front_camera_rgb_frame": (0.2158, 0.022, 1.0665),
    "arm_1_link": (0.09305, 0.014, 0.7375),
    "gripper_grasping_frame": (0.11405, -0.931075, 0.7065),
}


def file_of(robot: str, form: str) -> Path:
    if form == "urdf":
        return FOLDER / f"{robot}.urdf"
    return FOLDER / ("" if robot == "tiago" else robot) / "model.sdf"


@pytest.fixture(scope="module")
def models() -> dict[tuple[str, str], dict[str, Any]]:
    pairs = itertools.product(ROBOTS, ("sdf", "urdf"))
    return {pair: simkit.describe(file_of(*pair))["model"] for pair in pairs}


def named(entries: list[dict[str, Any]]) -> dict[str, dict[str, Any]]:
    return {entry["name"]: entry for entry in entries}


def numbers_of(entry: Any) -> list[float]:
    """All numbers inside, in order of their names."""
    if isinstance(entry, dict):
        return [n for key in sorted(entry) for n in numbers_of(entry[key])]
    if isinstance(entry, list):
        return [n for item in entry for n in numbers_of(item)]
    if isinstance(entry, str):
        return [float(entry)] if entry in ("inf", "-inf") else []
    return [float(entry)] if isinstance(entry, (int, float, bool)) else []


# ------------------------------------------------------------------ the same robot twice

Models = dict[tuple[str, str], dict[str, Any]]


@pytest.mark.parametrize("robot", ROBOTS)
def test_sdf_and_urdf_hold_the_same_robot(models: Models, robot: str) -> None:
    sdf, urdf = models[robot, "sdf"], models[robot, "urdf"]
    for kind in ("links", "joints"):
        ours, theirs = named(sdf[kind]), named(urdf[kind])
        assert list(ours) == list(theirs)
        for name, one in ours.items():
            assert numbers_of(theirs[name]) == pytest.approx(numbers_of(one), abs=1e-9, rel=1e-9), name
            for what in ("type", "parent_link", "child_link"):
                assert theirs[name].get(what) == one.get(what)
    for ours, theirs in zip(sdf["links"], urdf["links"], strict=True):
        for kind in ("collisions", "visuals", "sensors"):
            assert [s["name"] for s in theirs[kind]] == [s["name"] for s in ours[kind]]
    assert urdf["plugins"] == sdf["plugins"]


@pytest.mark.parametrize("robot", ROBOTS)
def test_another_reader_of_urdf_sees_the_same_frames(models: Models, robot: str) -> None:
    yourdfpy = pytest.importorskip("yourdfpy")
    other = yourdfpy.URDF.load(str(file_of(robot, "urdf")), load_meshes=False, build_scene_graph=True)
    for link in models[robot, "sdf"]["links"]:
        pose = simkit.Pose(link["pose_world"][:3], link["pose_world"][3:])
        matrix = other.get_transform(link["name"], "base_footprint")
        np.testing.assert_allclose(matrix[:3, 3], pose.position, atol=1e-9, err_msg=link["name"])
        for axis in np.eye(3):
            turned = (pose @ simkit.Pose(axis)).position - pose.position
            np.testing.assert_allclose(matrix[:3, :3] @ axis, turned, atol=1e-9, err_msg=link["name"])


@pytest.mark.parametrize("robot, form", list(itertools.product(ROBOTS, ("sdf", "urdf"))))
def test_nothing_in_the_files_is_warned_of(robot: str, form: str) -> None:
    """Published moments of inertia that no body has are mended, and no element is without effect."""
    found = simkit.check(file_of(robot, form))
    assert [str(d) for d in found if d.severity != "note"] == []


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_robots_are_found_by_bare_name(robot: str) -> None:
    for name in (robot, f"{robot}.urdf"):
        with simkit.load("empty") as sim:
            assert sim.spawn(name).name == robot


# ------------------------------------------------------------------ the published numbers


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_masses_are_the_published_ones(models: Models, robot: str) -> None:
    model = models[robot, "sdf"]
    assert sum(link["mass"] for link in model["links"]) == pytest.approx(MASSES[robot], abs=5e-4)


def test_links_and_joints_are_as_many_as_published(models: Models) -> None:
    model = models["tiago", "urdf"]
    kinds = [joint["type"] for joint in model["joints"]]
    assert (len(model["links"]), len(kinds)) == (54, 53)
    assert [kinds.count(kind) for kind in ("continuous", "prismatic", "revolute")] == [10, 5, 9]


@pytest.mark.parametrize("robot", ROBOTS)
def test_fixed_frames_have_their_names(models: Models, robot: str) -> None:
    joints = models[robot, "urdf"]["joints"]
    fixed = {j["child_link"].rsplit("::", 1)[-1] for j in joints if j["type"] == "fixed"}
    assert fixed == FIXED[robot]
    assert {j["name"] for j in joints if j["type"] != "fixed"} == set(MOVING[robot])


@pytest.mark.parametrize("robot", ROBOTS)
def test_moving_joints_have_the_published_limits(models: Models, robot: str) -> None:
    joints = named(models[robot, "urdf"]["joints"])
    for name, (kind, parent, child, *values) in MOVING[robot].items():
        joint = joints[name]
        ends = [joint[end].rsplit("::", 1)[-1] for end in ("parent_link", "child_link")]
        assert (joint["type"], *ends) == (kind, parent, child), name
        (axis,) = joint["axes"]
        found = [axis[k] for k in ("lower", "upper", "effort", "velocity", "damping", "friction")]
        for wanted, value in zip(values[:-1], found, strict=True):
            if wanted is None:
                assert math.isinf(float(value)), name
            else:
                assert value == pytest.approx(wanted, rel=1e-5, abs=1e-9), name


@pytest.mark.parametrize("robot", ROBOTS)
def test_moving_links_have_the_published_masses(models: Models, robot: str) -> None:
    """With what is fixed to them, up to the force-torque sensor: its joint is kept and what follows weighs on it."""
    model = models[robot, "urdf"]
    masses = {link["name"]: link["mass"] for link in model["links"]}
    for joint in reversed(model["joints"]):
        if joint["type"] == "fixed" and joint["name"] not in ("wrist_ft_joint", "wrist_tool_joint"):
            parent, child = (joint[end].rsplit("::", 1)[-1] for end in ("parent_link", "child_link"))
            masses[parent] += masses[child]
    for name, (_, _, child, *_, mass) in MOVING[robot].items():
        assert masses[child] == pytest.approx(mass, rel=1e-3), name


@pytest.mark.parametrize("form", ["sdf", "urdf"])
def test_the_left_finger_follows_the_right_one(models: Models, form: str) -> None:
    followers = {joint["name"]: joint["mimic"] for joint in models["tiago", form]["joints"] if joint["mimic"]}
    assert list(followers) == ["gripper_left_finger_joint"]
    rule = followers["gripper_left_finger_joint"]
    assert "gripper_right_finger_joint" in str(rule) and sorted(numbers_of(rule))[-1] == 1


def test_soft_limits_are_the_published_ones() -> None:
    import xml.etree.ElementTree as ElementTree

    root = ElementTree.parse(FOLDER / "tiago.urdf").getroot()
    found = {}
    for joint in root.iter("joint"):
        safety = joint.find("safety_controller")
        if safety is not None:
            keys = ("soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity")
            found[joint.get("name")] = tuple(float(safety.get(key, "nan")) for key in keys)
    assert set(found) == set(SOFT)
    for name, values in SOFT.items():
        assert found[name] == pytest.approx(values, rel=1e-5, abs=1e-9), name


def test_the_parts_are_where_they_were_published(models: Models) -> None:
    links = named(models["tiago", "sdf"]["links"])
    for name, place in PLACES.items():
        assert links[name]["pose_world"][:3] == pytest.approx(place, abs=1e-6), name


# ------------------------------------------------------------------ sensors, interfaces, controllers


def sensors_of(model: dict[str, Any]) -> dict[str, dict[str, Any]]:
    owners = [*model["links"], *model["joints"]]
    return {s["name"]: {**s, "on": owner["name"]} for owner in owners for s in owner["sensors"]}


def test_sensors_are_the_published_ones(models: Models) -> None:
    sensors = sensors_of(models["tiago", "urdf"])
    table = {name: (s["on"], s["type"], s["update_rate"]) for name, s in sensors.items()}
    assert table == {
        "base_laser": ("base_laser_link", "ray", 10),
        "base_sonar_01": ("base_sonar_01_link", "ray", 5),
        "base_sonar_02": ("base_sonar_02_link", "ray", 5),
        "base_sonar_03": ("base_sonar_03_link", "ray", 5),
        "imu_sensor": ("base_imu_link", "imu", 10),
        "base_imu_sensor": ("base_imu_link", "imu", 100),
        "head_front_camera_frame_sensor": ("head_front_camera_rgb_frame", "depth", 30),
        "wrist_ft_sensor": ("wrist_ft_joint", "force_torque", 100),
    }
    laser, sonar = sensors["base_laser"]["lidar"], sensors["base_sonar_02"]["lidar"]
    assert (laser["h_samples"], laser["range_min"], laser["range_max"]) == (666, 0.05, 25)
    assert (laser["h_min"], laser["h_max"]) == pytest.approx((-math.radians(110), math.radians(110)))
    assert (sonar["h_samples"], sonar["v_samples"], sonar["range_min"], sonar["range_max"]) == (5, 5, 0.02, 1)
    assert (sonar["h_max"] - sonar["h_min"], sonar["v_max"] - sonar["v_min"]) == (0.5, 0.5)
    picture = sensors["head_front_camera_frame_sensor"]["camera"]
    assert (picture["width"], picture["height"]) == (640, 480)
    assert picture["hfov"] == pytest.approx(math.radians(63))
    assert set(sensors_of(models["pmb2", "urdf"])) == {name for name in sensors if "base" in name or name[:3] == "imu"}


def interfaces_of(robot: str) -> dict[str, tuple[set[str], set[str]]]:
    import xml.etree.ElementTree as ElementTree

    (block,) = ElementTree.parse(FOLDER / f"{robot}.urdf").getroot().iter("ros2_control")
    found = {}
    for part in [*block.findall("joint"), *block.findall("sensor")]:
        sets = ({e.get("name", "") for e in part.findall(kind)} for kind in ("command_interface", "state_interface"))
        found[part.get("name", "")] = tuple(sets)
    return found  # type: ignore[return-value]


def test_each_joint_has_its_interfaces() -> None:
    found = interfaces_of("tiago")
    every = {"position", "velocity", "effort"}
    assert all(found[f"arm_{k}_joint"] == (every, every) for k in range(1, 8))
    assert all(found[j] == ({"position"}, every) for j in (*UPPER_JOINTS, *list(ARM_JOINTS)[-2:]))
    assert all(found[f"wheel_{side}_joint"][0] == {"velocity"} for side in ("left", "right"))
    assert len(found["base_imu_sensor"][1]) == 10 and len(found["wrist_ft_sensor"][1]) == 6
    assert set(interfaces_of("tiago_no_arm")) == set(found) - {*ARM_JOINTS, "wrist_ft_sensor"}
    assert set(interfaces_of("pmb2")) == {"wheel_left_joint", "wheel_right_joint", "base_imu_sensor"}


def test_the_wrist_has_a_differential_and_every_other_driven_joint_a_motor_of_its_own() -> None:
    import xml.etree.ElementTree as ElementTree

    (block,) = ElementTree.parse(FOLDER / "tiago.urdf").getroot().iter("ros2_control")
    kinds = {}
    for transmission in block.findall("transmission"):
        joints = tuple(joint.get("name") for joint in transmission.findall("joint"))
        kinds[joints] = (transmission.findtext("plugin") or "").rsplit("/", 1)[-1]
    assert kinds.pop(("arm_6_joint", "arm_7_joint")) == "DifferentialTransmission"
    driven = {name for name, (commands, _) in interfaces_of("tiago").items() if commands}
    assert {joint for (joint,) in kinds} == driven - {"arm_6_joint", "arm_7_joint"}
    assert set(kinds.values()) == {"SimpleTransmission"}


def parameters(file: str) -> dict[str, dict[str, Any]]:
    text = (FOLDER / "config" / file).read_text(encoding="utf-8")
    return {name: node["ros__parameters"] for name, node in yaml.safe_load(text).items()}


def test_controllers_have_the_published_parameters() -> None:
    nodes = parameters("controllers.yaml")
    assert nodes["controller_manager"]["update_rate"] == 100
    arm, torso, head, gripper = (nodes[f"{part}_controller"] for part in ("arm", "torso", "head", "gripper"))
    assert arm["joints"] == [f"arm_{k}_joint" for k in range(1, 8)]
    assert torso["joints"] == ["torso_lift_joint"] and head["joints"] == ["head_1_joint", "head_2_joint"]
    assert sorted(gripper["joints"]) == ["gripper_left_finger_joint", "gripper_right_finger_joint"]
    for node, goal_time, goal in ((arm, 0.6, 0.02), (torso, 0.6, 0.02), (head, 2.0, 0.5), (gripper, 0.6, None)):
        rules = node["constraints"]
        assert (rules["goal_time"], rules["stopped_velocity_tolerance"]) == (goal_time, 5.0)
        assert node["command_interfaces"] == ["position"]
        assert goal is None or all(rules[f"{joint}.goal"] == goal for joint in node["joints"])
    assert nodes["ft_sensor_controller"] == {"sensor_name": "wrist_ft_sensor", "frame_id": "wrist_ft_link"}


def test_the_arm_gives_way_with_the_gains_of_the_robot() -> None:
    node = parameters("controllers.yaml")["arm_impedance_controller"]
    gains = [(6, 1), (6, 0.8), (-6, -0.8), (-6, -0.8), (-0.02, -0.02), (0.2, 0.02), (0.2, 0.02)]
    assert [(g["kp"], g["kd"]) for g in node["impedance_gains"].values()] == gains
    assert [m["reduction_ratio"] for m in node["motor_params"].values()] == [100] * 4 + [336] * 3
    assert list(node["motor_params"]) == list(node["impedance_gains"]) == node["joints"]


@pytest.mark.parametrize("file", ["controllers.yaml", "controllers_no_arm.yaml", "controllers_base.yaml"])
def test_the_base_is_driven_alike_on_every_robot(file: str) -> None:
    base = parameters(file)["mobile_base_controller"]
    assert (base["wheel_radius"], base["wheel_separation"]) == (0.0985, 0.4044)
    assert (base["publish_rate"], base["cmd_vel_timeout"], base["base_frame_id"]) == (50, 0.25, "base_footprint")
    assert (base["linear.x.min_velocity"], base["linear.x.max_velocity"]) == (-0.2, 1.0)
    assert (base["linear.x.max_acceleration"], base["angular.z.max_acceleration"]) == (1.0, 2.09)
    assert base["angular.z.max_velocity"] == 2.09
    extra = parameters(file)["joint_state_broadcaster"]["extra_joints"]
    assert len(extra) == 10 and set(extra) <= set(BASE_JOINTS)


# ------------------------------------------------------------------ what the scripts write


@pytest.fixture(scope="module")
def scripts() -> Iterator[None]:
    """The scripts beside the robots, importable."""
    pytest.importorskip("shapely", reason="the drawing script needs shapely")
    before = set(sys.modules)
    sys.path.insert(0, str(FOLDER))
    yield
    sys.path.remove(str(FOLDER))
    for name in set(sys.modules) - before:
        if str(FOLDER) in str(getattr(sys.modules[name], "__file__", "")):
            del sys.modules[name]


@pytest.fixture(scope="module")
def drawing(scripts: None) -> ModuleType:
    return importlib.import_module("make_meshes")


def test_the_committed_files_are_what_the_script_writes(scripts: None) -> None:
    for path, text in importlib.import_module("make_models").files().items():
        assert (FOLDER / path).read_text(encoding="utf-8") == text, "run assets/tiago/make_models.py"


def test_every_mesh_is_drawn_by_the_script_and_used(drawing: ModuleType) -> None:
    text = (FOLDER / "tiago.urdf").read_text(encoding="utf-8")
    files = {p.stem for p in (FOLDER / "meshes").glob("*")}
    assert files == set(drawing.PARTS)
    assert {f for f in files if f"tiago/meshes/{f}.obj" in text} == files


def test_the_committed_meshes_have_the_shape_that_the_script_draws(drawing: ModuleType) -> None:
    """In outer size; how a plate is cut into triangles depends on a library's version."""
    for name, draw in drawing.PARTS.items():
        lines = (FOLDER / "meshes" / f"{name}.obj").read_text(encoding="utf-8").splitlines()
        points = np.array([line.split()[1:] for line in lines if line.startswith("v ")], float)
        corners = np.concatenate([part.triangles.reshape(-1, 3) for part in draw()])
        np.testing.assert_allclose(points.min(axis=0), corners.min(axis=0), atol=2e-5, err_msg=name)
        np.testing.assert_allclose(points.max(axis=0), corners.max(axis=0), atol=2e-5, err_msg=name)
