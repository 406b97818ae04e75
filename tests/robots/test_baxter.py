"""Baxter: the published numbers and kinematics, the same robot from SDF and URDF, its files, and rest at a table."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import yaml

import simkit

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "assets" / "baxter"
FILES = {"sdf": FOLDER / "model.sdf", "urdf": FOLDER / "baxter.urdf"}
JOINTS = ("s0", "s1", "e0", "e1", "w0", "w1", "w2")
LIMITS = {  # lower, upper, effort, velocity
    "s0": (-1.70168, 1.70168, 50, 1.5),
    "s1": (-2.147, 1.047, 50, 1.5),
    "e0": (-3.05418, 3.05418, 50, 1.5),
    "e1": (-0.05, 2.618, 50, 1.5),
    "w0": (-3.059, 3.059, 15, 4),
    "w1": (-1.5708, 2.094, 15, 4),
    "w2": (-3.059, 3.059, 15, 4),
}
ARM_MASS = 5.70044 + 3.22698 + 4.31272 + 2.07206 + 2.24665 + 1.60979 + 0.35093 + 0.19125
TORSO_MASS, PEDESTAL_MASS, HEAD_MASS = 35.336455, 60.86397744, 0.547767 + 0.440171
GRIPPER_MASS = 0.3 + 2 * (0.02 + 0.01)
TOPICS = {
    "/robot/joint_states": "sensor_msgs/msg/JointState",
    "/robot/state": "baxter_core_msgs/msg/AssemblyState",
    "/robot/head/head_state": "baxter_core_msgs/msg/HeadState",
    "/robot/limb/right/joint_command": "baxter_core_msgs/msg/JointCommand",
    "/robot/limb/left/endpoint_state": "baxter_core_msgs/msg/EndpointState",
    "/robot/limb/left/gravity_compensation_torques": "baxter_core_msgs/msg/SEAJointState",
    "/robot/end_effector/right_gripper/state": "baxter_core_msgs/msg/EndEffectorState",
    "/cameras/head_camera/image": "sensor_msgs/msg/Image",
    "/cameras/left_hand_camera/camera_info": "sensor_msgs/msg/CameraInfo",
    "/robot/range/left_hand_range/state": "sensor_msgs/msg/Range",
}

# Denavit-Hartenberg parameters of an arm, from the axis of s0 to the hand: theta offset, d, a, alpha
# (R. L. Williams II, "Baxter Humanoid Robot Kinematics", 2017; lengths of the older description, 0.07 mm shorter)
DH = (
    (0.0, 0.27035, 0.069, -np.pi / 2),
    (np.pi / 2, 0.0, 0.0, np.pi / 2),
    (0.0, 0.36435, 0.069, -np.pi / 2),
    (0.0, 0.0, 0.0, np.pi / 2),
    (0.0, 0.37429, 0.010, -np.pi / 2),
    (0.0, 0.0, 0.0, np.pi / 2),
    (0.0, 0.229525, 0.0, 0.0),
)
POSES = (
    (0.0,) * 7,
    (0.0, -0.55, 0.0, 0.75, 0.0, 1.26, 0.0),
    (0.5, 0.3, -1.2, 1.5, 0.8, -0.6, 2.0),
    (-1.1, -1.4, 2.2, 0.4, -2.5, 1.7, -0.9),
)


def hand_by_dh(side: str, angles: Sequence[float]) -> np.ndarray:
    """Return the pose of a hand in the base frame as a matrix, by the Denavit-Hartenberg parameters."""
    sign = 1.0 if side == "left" else -1.0
    c, s = np.cos(0.7854), sign * np.sin(0.7854)
    pose = np.array([[c, -s, 0, 0.024645], [s, c, 0, sign * 0.219645], [0, 0, 1, 0.118588], [0, 0, 0, 1]])
    pose = pose @ np.array([[1, 0, 0, 0.055695], [0, 1, 0, 0], [0, 0, 1, 0.011038], [0, 0, 0, 1]])
    for angle, (offset, d, a, alpha) in zip(angles, DH, strict=True):
        (ct, st), (ca, sa) = ((np.cos(x), np.sin(x)) for x in (angle + offset, alpha))
        rows = [[ct, -st * ca, st * sa, a * ct], [st, ct * ca, -ct * sa, a * st], [0, sa, ca, d], [0, 0, 0, 1]]
        pose = pose @ np.array(rows)
    return pose


@pytest.fixture(scope="module")
def models() -> dict[str, dict[str, Any]]:
    return {form: simkit.describe(file)["model"] for form, file in FILES.items()}


def named(entries: list[dict[str, Any]]) -> dict[str, dict[str, Any]]:
    return {entry["name"]: entry for entry in entries}


def numbers_of(entry: Any) -> list[float]:
    """All numbers inside, in order of their names."""
    if isinstance(entry, dict):
        return [n for key in sorted(entry) for n in numbers_of(entry[key])]
    if isinstance(entry, list):
        return [n for item in entry for n in numbers_of(item)]
    return [float(entry)] if isinstance(entry, (int, float, bool)) else []


# ------------------------------------------------------------------ the files


def test_sdf_and_urdf_hold_the_same_robot(models: dict[str, dict[str, Any]]) -> None:
    shift = np.array([0.0, 0.0, 0.93])  # the model of the SDF file stands on the ground
    for kind in ("links", "joints"):
        ours, theirs = (named(models[form][kind]) for form in ("sdf", "urdf"))
        assert list(ours) == list(theirs)
        for name, one in ours.items():
            other = theirs[name]
            assert np.array(one["pose_world"][:3]) - shift == pytest.approx(other["pose_world"][:3], abs=1e-9), name
            for what in ("mass", "inertia_com_linkframe", "axes", "mimic"):
                assert numbers_of(other.get(what)) == pytest.approx(numbers_of(one.get(what)), abs=1e-9), name
    assert models["urdf"]["plugins"] == models["sdf"]["plugins"]


@pytest.mark.parametrize("form", FILES)
def test_nothing_in_the_files_is_warned_of(form: str) -> None:
    assert [str(d) for d in simkit.check(FILES[form]) if d.severity != "note"] == []


@pytest.fixture(scope="module")
def scripts() -> Iterator[None]:
    """The scripts beside the robots, importable."""
    pytest.importorskip("shapely", reason="the drawing script needs shapely")
    before, path = set(sys.modules), list(sys.path)
    sys.path.insert(0, str(FOLDER))
    yield
    sys.path[:] = path
    for name in set(sys.modules) - before:
        if str(ROOT / "assets") in str(getattr(sys.modules[name], "__file__", "")):
            del sys.modules[name]


def script(name: str) -> ModuleType:
    return importlib.import_module(name)


def test_the_committed_files_are_what_the_script_writes(scripts: None) -> None:
    for path, text in script("make_models").files().items():
        assert (FOLDER / path).read_text(encoding="utf-8") == text, "run assets/baxter/make_models.py"


def test_every_mesh_is_drawn_by_the_script_and_used(scripts: None) -> None:
    parts, text = script("make_meshes").PARTS, FILES["sdf"].read_text(encoding="utf-8")
    assert {file.stem for file in (FOLDER / "meshes").glob("*.obj")} == set(parts)
    for name, draw in parts.items():
        assert f"baxter/meshes/{name}.obj" in text
        lines = (FOLDER / "meshes" / f"{name}.obj").read_text(encoding="utf-8").splitlines()
        written = np.array([line.split()[1:] for line in lines if line.startswith("v ")], dtype=float)
        drawn = np.vstack([part.vertices for part in draw()])
        for end in ("min", "max"):
            np.testing.assert_allclose(getattr(written, end)(axis=0), getattr(drawn, end)(axis=0), atol=2e-5)


# ------------------------------------------------------------------ the published numbers


def test_masses_and_limits_are_the_published_ones(models: dict[str, dict[str, Any]]) -> None:
    model = models["urdf"]
    total = 2 * (ARM_MASS + GRIPPER_MASS) + TORSO_MASS + PEDESTAL_MASS + HEAD_MASS
    assert sum(link["mass"] for link in model["links"]) == pytest.approx(total, abs=3e-3)  # frames of 0.1 g
    joints = named(model["joints"])
    for side in ("left", "right"):
        for joint, limits in LIMITS.items():
            (axis,) = joints[f"{side}_{joint}"]["axes"]
            found = [axis[what] for what in ("lower", "upper", "effort", "velocity")]
            assert (*found, axis["damping"]) == pytest.approx((*limits, 0.7), abs=1e-5)
    moving = [name for name, joint in joints.items() if joint["type"] != "fixed"]
    assert len(moving) == 2 * 7 + 1 + 4


@pytest.fixture(scope="module")
def sim() -> Iterator[simkit.Simulation]:
    with simkit.load("baxter") as sim:
        yield sim


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("angles", POSES)
def test_the_hand_is_where_the_denavit_hartenberg_parameters_place_it(
    sim: simkit.Simulation, side: str, angles: tuple[float, ...]
) -> None:
    robot = sim.model("baxter")
    robot.set_joint_positions({f"{side}_{j}": a for j, a in zip(JOINTS, angles, strict=True)})
    pose = robot.link("base").pose.inverse() @ robot.link(f"{side}_hand").pose
    expected = hand_by_dh(side, angles)
    assert pose.position == pytest.approx(expected[:3, 3], abs=1e-4)
    for axis, column in zip(np.eye(3), expected[:3, :3].T, strict=True):
        assert np.array(pose.transform(axis)) - pose.position == pytest.approx(column, abs=1e-6)


def test_at_zero_the_hand_is_at_the_published_place(sim: simkit.Simulation) -> None:
    """The transforms of the URDF file at zero, by hand: 0.958 m from the shoulder, at 45° outwards."""
    robot = sim.model("baxter")
    robot.set_joint_positions({f"left_{joint}": 0.0 for joint in JOINTS})
    pose = robot.link("base").pose.inverse() @ robot.link("left_hand").pose
    reach = 0.055695 + 0.069 + 0.102 + 0.26242 + 0.10359 + 0.2707 + 0.115975 + 0.11355
    x, y = 0.024645 + reach * np.cos(0.7854), 0.219645 + reach * np.sin(0.7854)
    z = 0.118588 + 0.011038 + 0.27035 - 0.069 - 0.01
    assert pose.position == pytest.approx((x, y, z), abs=1e-6)


# ------------------------------------------------------------------ the world


def test_baxter_rests_at_the_table_and_publishes_its_topics() -> None:
    with simkit.load("baxter_table", overrides=["physics.max_step_size=0.002"]) as sim:
        assert [str(d) for d in sim.diagnostics if d.severity != "note"] == []
        found = sim.topics()
        assert {name: found.get(name) for name in TOPICS} == TOPICS
        robot, things = sim.model("baxter"), ("cube", "post", "can", "ball", "milk", "book")
        frames = sim.subscribe("/tf", keep=1)
        sim.run(1.0)
        before, angles = robot.pose, [float(joint.position) for joint in robot.joints.values() if joint.dof]
        places = {name: sim.model(name).pose.position for name in things}
        sim.run(4.0)
        drift = before.inverse() @ robot.pose
        assert np.linalg.norm(drift.position) < 1e-5 and np.linalg.norm(drift.rpy) < 1e-5
        after = [float(joint.position) for joint in robot.joints.values() if joint.dof]
        assert after == pytest.approx(angles, abs=1e-6)
        for name, place in places.items():
            assert np.linalg.norm(sim.model(name).pose.position - place) < 1e-4, name
        assert {"left_wrist", "head"} <= {t.child_frame_id for t in frames.latest.transforms}


def test_the_range_of_the_hand_sees_the_table() -> None:
    """The left hand points down at the table from 0.2 m above it."""
    with simkit.load("baxter_table") as sim:
        sim.publish("/robot/set_super_enable", {"data": True})
        sim.run(0.01)
        names = [f"left_{joint}" for joint in JOINTS]
        zeros = {"mode": 3, "names": names, "command": [0.0] * 7}
        sim.publish("/robot/limb/left/joint_command", zeros)  # in the torque mode, no drive pulls the arm back
        sim.run(0.01)
        angles = (-0.7, -0.35, 0.0, 0.95, 0.0, 0.97, 0.0)
        sim.model("baxter").set_joint_positions(dict(zip(names, angles, strict=True)))
        ranges = sim.subscribe("/robot/range/left_hand_range/state", keep=1)
        sim.run(0.5)
        sensor = sim.link("baxter::left_hand_range").pose
        along = sensor.transform((1.0, 0.0, 0.0)) - sensor.position
        assert along[2] < -0.99
        expected = (sensor.position[2] - 0.78) / -along[2]
        assert 0.05 < expected < 0.4
        assert ranges.latest.range == pytest.approx(expected, abs=0.02)  # noise of 5 mm
        assert ranges.latest.header.frame_id == "left_hand_range"


@pytest.mark.slow
def test_the_script_of_the_table_lifts_the_cube() -> None:
    """0.14 m up, within 2 mm of the point over its place, and without slip for ten seconds."""
    entries = yaml.safe_load((ROOT / "worlds" / "baxter_table_pick.yaml").read_text(encoding="utf-8"))
    with simkit.load("baxter_table") as sim:
        cube, tip = sim.model("cube"), sim.link("baxter::left_gripper")
        for entry in entries:
            sim.run(max(entry["at"] - sim.time, 0.0))
            sim.publish(entry["topic"], entry["message"])
        sim.run(11.0 - sim.time)
        assert cube.pose.position == pytest.approx((0.72, 0.26, 0.9385), abs=2e-3)
        inside = (tip.pose.inverse() @ cube.pose).position
        sim.run(10.0)
        assert (tip.pose.inverse() @ cube.pose).position == pytest.approx(inside, abs=1e-3)
