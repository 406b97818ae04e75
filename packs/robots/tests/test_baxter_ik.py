"""The inverse kinematics service of Baxter: poses that the arm has reached, seeds, and poses without a solution."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pytest

import simkit

JOINTS = tuple(f"right_{joint}" for joint in ("s0", "s1", "e0", "e1", "w0", "w1", "w2"))
LOWER = np.array((-1.70, -2.147, -3.05, -0.05, -3.05, -1.57, -3.05))
UPPER = np.array((1.70, 1.047, 3.05, 2.618, 3.05, 2.094, 3.05))
INVALID, USER, CURRENT, FIXED = range(4)


@pytest.fixture(scope="module")
def sim() -> Iterator[simkit.Simulation]:
    with simkit.load("baxter") as loaded:
        yield loaded


def place(sim: simkit.Simulation, angles: Sequence[float]) -> simkit.Pose:
    """Move the right arm, and return the pose of its end in the base frame."""
    robot = sim.model("baxter")
    robot.set_joint_positions(dict(zip(JOINTS, (float(a) for a in angles), strict=True)))
    return robot.link("base").pose.inverse() @ robot.link("right_gripper").pose


def stamped(pose: simkit.Pose, frame: str = "base") -> dict[str, Any]:
    position = dict(zip("xyz", pose.position.tolist(), strict=True))
    orientation = dict(zip("wxyz", pose.quaternion.tolist(), strict=True))
    return {"header": {"frame_id": frame}, "pose": {"position": position, "orientation": orientation}}


def solve(sim: simkit.Simulation, poses: list[dict[str, Any]], **fields: Any) -> Any:
    return sim.call("/ExternalTools/right/PositionKinematicsNode/IKService", {"pose_stamp": poses, **fields})


def difference(first: simkit.Pose, second: simkit.Pose) -> float:
    apart = first.inverse() @ second
    return float(max(np.linalg.norm(apart.position), np.linalg.norm(apart.rpy)))


def test_every_pose_of_the_arm_has_a_solution_within_the_limits(sim: simkit.Simulation) -> None:
    random = np.random.default_rng(5)
    poses = [place(sim, random.uniform(LOWER, UPPER)) for _ in range(10)]
    place(sim, np.zeros(7))
    before = sim.mj_data.qpos.copy()
    found = solve(sim, [stamped(pose) for pose in poses])
    assert np.array_equal(sim.mj_data.qpos, before)  # the robot does not move
    assert all(found.is_valid) and set(found.result_type) <= {CURRENT, FIXED}
    for pose, joints in zip(poses, found.joints, strict=True):
        assert tuple(joints.name) == JOINTS
        angles = np.array(joints.position)
        assert np.all((angles >= LOWER - 0.01) & (angles <= UPPER + 0.01))
        assert difference(place(sim, angles), pose) < 5e-5


def test_the_solution_is_near_the_seed(sim: simkit.Simulation) -> None:
    angles = np.array((0.4, -0.6, 0.3, 1.1, 0.5, 0.7, -0.3))
    pose = place(sim, angles)
    place(sim, np.zeros(7))
    seed = {"name": list(JOINTS), "position": (angles + 0.02).tolist()}
    found = solve(sim, [stamped(pose)], seed_angles=[seed])
    assert list(found.result_type) == [USER]
    assert found.joints[0].position == pytest.approx(angles, abs=0.05)
    assert list(solve(sim, [stamped(pose)], seed_mode=FIXED).result_type) == [FIXED]
    assert list(solve(sim, [stamped(pose)], seed_mode=USER).result_type) == [INVALID]  # without a seed


def test_poses_may_be_in_other_frames_and_some_have_no_solution(sim: simkit.Simulation) -> None:
    pose = place(sim, (0.4, -0.6, 0.3, 1.1, 0.5, 0.7, -0.3))
    robot = sim.model("baxter")
    base = robot.link("base").pose
    in_world, in_head = stamped(base @ pose, "world"), stamped(robot.link("head").pose.inverse() @ base @ pose, "head")
    far = stamped(simkit.Pose((3.0, 0.0, 0.0)))
    invalid = stamped(pose)
    invalid["pose"]["position"]["x"] = float("nan")
    found = solve(sim, [in_world, in_head, far, stamped(pose, "nowhere"), invalid])
    assert list(found.is_valid) == [True, True, False, False, False]
    assert [len(joints.position) for joints in found.joints] == [7, 7, 0, 0, 0]
