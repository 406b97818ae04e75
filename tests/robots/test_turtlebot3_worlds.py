"""TurtleBot3's own worlds, as they come: of Gazebo Classic and of gz, the robot drives as told and sees the walls."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import simkit
from simkit import Pose

SHARED = pathlib.Path(__file__).resolve().parents[3].joinpath("shared").resolve()  # messages show no text behind a link
GZ = SHARED / "corpus" / "files" / "ROBOTIS-GIT+turtlebot3_simulations" / "turtlebot3_gazebo"
COURSE = SHARED / "course"
ROBOT = "turtlebot3_waffle"
TRACK, SEPARATION = 0.288, 0.287  # [m] between the wheels of the model, and what its drive is told
NOISE = 0.01  # [m] standard deviation of its lidar

pytestmark = pytest.mark.skipif(
    not (GZ.is_dir() and COURSE.is_dir()), reason="needs the corpus and the course files in ../shared"
)

WORLDS = {
    "gz stage 1": (GZ / "worlds" / "turtlebot3_dqn_stage1.world", GZ),
    "gz stage 2": (GZ / "worlds" / "turtlebot3_dqn_stage2.world", GZ),
    "gz stage 3": (GZ / "worlds" / "turtlebot3_dqn_stage3.world", GZ),
    "classic": (COURSE / "worlds" / "waffle.model", COURSE),
}


def opened(name: str, place: tuple[float, float] = (-0.5, -0.5)) -> simkit.Simulation:
    """A world with the robot, which is spawned where the world has none, as its launch files do."""
    world, folder = WORLDS[name]
    models = folder / "models"
    sim = simkit.load(world, resource_paths=[models, models / "turtlebot3_dqn_world"])
    if ROBOT not in sim.models:
        sim.spawn(models / ROBOT / "model.sdf", name=ROBOT, pose=Pose((*place, 0.01)))
    sim.run(0.3)
    return sim


@pytest.fixture(params=WORLDS, scope="module")
def sim(request: pytest.FixtureRequest) -> Iterator[simkit.Simulation]:
    with opened(request.param) as opened_world:
        yield opened_world


def moved(sim: simkit.Simulation, seconds: float) -> Pose:
    """How far the robot gets, in its own frame."""
    model = sim.model(ROBOT)
    start = model.pose
    sim.run(seconds)
    return start.inverse() @ model.pose


def test_it_drives_as_it_is_told_and_says_so(sim: simkit.Simulation) -> None:
    odometry, joints = sim.subscribe("/odom"), sim.subscribe("/joint_states")
    sim.publish("/cmd_vel", {"linear": {"x": 0.2}})
    sim.run(1.0)
    way = moved(sim, 1.0)
    np.testing.assert_allclose(way.position[:2], (0.2, 0), atol=2e-4)
    assert odometry.latest.twist.twist.linear.x == pytest.approx(0.2, abs=2e-3)
    assert (odometry.latest.header.frame_id, odometry.latest.child_frame_id) == ("odom", "base_footprint")
    states = dict(zip(joints.latest.name, joints.latest.velocity, strict=True))
    assert set(states) == {"wheel_left_joint", "wheel_right_joint"}
    np.testing.assert_allclose(list(states.values()), 0.2 / 0.033, rtol=0.01)

    sim.publish("/cmd_vel", {"angular": {"z": 0.5}})
    sim.run(0.6)
    turn = moved(sim, 1.0)
    assert turn.rpy[2] == pytest.approx(0.5 * SEPARATION / TRACK, abs=1e-3)
    assert odometry.latest.twist.twist.angular.z == pytest.approx(0.5, abs=3e-3)

    sim.publish("/cmd_vel", {})
    sim.run(0.6)
    assert np.linalg.norm(moved(sim, 0.2).position) < 1e-5


def test_it_scans_at_its_rate_on_the_topics_of_its_bringup(sim: simkit.Simulation) -> None:
    rate = sim.sensor(f"{ROBOT}::base_scan::hls_lfcd_lds").update_rate
    scans, imu = sim.subscribe("/scan"), sim.subscribe("/imu")
    sim.run(1.0)
    assert len(scans.messages) == rate
    assert len(imu.messages) == 200
    assert len(scans.latest.ranges) == 360
    assert scans.latest.header.frame_id == "base_scan"
    assert np.isfinite(imu.latest.linear_acceleration.z) and imu.latest.linear_acceleration.z > 9


def beams(sim: simkit.Simulation, scan: Any) -> tuple[np.ndarray, np.ndarray]:
    """Where the rays of a scan start in the world, and their directions."""
    eye = sim.sensor(f"{ROBOT}::base_scan::hls_lfcd_lds").pose
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    ways = np.stack((np.cos(angles), np.sin(angles), 0 * angles), 1) @ eye.matrix.T
    return np.asarray(eye.position)[:2], ways[:, :2]


def test_in_the_square_of_gz_every_ray_ends_on_its_wall() -> None:
    """The walls' inner faces are 2.35 m from the middle; what is farther than 3.5 m is not seen."""
    with opened("gz stage 1") as sim:
        scans = sim.subscribe("/scan")
        sim.publish("/cmd_vel", {"linear": {"x": 0.1}, "angular": {"z": 0.4}})
        sim.run(2.0)  # the newest scan is of now: 10 Hz
        start, ways = beams(sim, scans.latest)
        with np.errstate(divide="ignore"):
            expected = ((np.sign(ways) * 2.35 - start) / ways).min(axis=1)
        ranges = np.asarray(scans.latest.ranges)
        far, near = expected > 3.5 + 5 * NOISE, expected < 3.5 - 5 * NOISE
        assert far.sum() > 10 and near.sum() > 200
        assert np.isposinf(ranges[far]).all()
        error = ranges[near] - expected[near]
        assert abs(error).max() < 5 * NOISE
        assert error.std() == pytest.approx(NOISE, rel=0.2)
        assert abs(error.mean()) < 4 * NOISE / np.sqrt(near.sum())


def test_in_the_arena_of_classic_rays_end_on_the_pillars() -> None:
    """Nine pillars of 0.15 m, 1.1 m apart; the robot stands between them."""
    with opened("classic") as sim:
        scans = sim.subscribe("/scan")
        sim.run(0.2)
        start, ways = beams(sim, scans.latest)
        ranges = np.asarray(scans.latest.ranges)
        pillars = [np.array((x, y)) for x in (-1.1, 0.0, 1.1) for y in (-1.1, 0.0, 1.1)]
        along = np.array([ways @ (pillar - start) for pillar in pillars])
        off = np.array([((pillar - start) ** 2).sum() for pillar in pillars])[:, None] - along**2
        depth = np.where((along > 0) & (off < 0.15**2), along - np.sqrt(np.maximum(0.15**2 - off, 0)), np.inf)
        expected = depth.min(axis=0)
        grazing = ((along > 0) & (off > 0.148**2) & (off < 0.152**2)).any(axis=0)
        sure = ~grazing & (expected < 3.4)
        assert sure.sum() > 40
        assert abs(ranges[sure] - expected[sure]).max() < 5 * NOISE


def test_the_pillars_of_stage_3_turn_about_the_middle() -> None:
    """The four pillars of gz turn at a constant rate, once in 80 s."""
    with opened("gz stage 3") as sim:
        assert not [d for d in sim.diagnostics if d.code == "SK-PLUGIN-001"]
        start = sim.model("obstacles").pose.rpy[2]
        sim.run(2.0)
        assert sim.model("obstacles").pose.rpy[2] - start == pytest.approx(2.0 * 2 * np.pi / 80, rel=0.01)


def test_a_plugin_that_is_the_worlds_own_is_reported_and_the_rest_runs() -> None:
    with simkit.load(COURSE / "worlds" / "hello.world") as sim:
        (told,) = [d for d in sim.diagnostics if d.code == "SK-PLUGIN-001"]
        assert "libgazebo_tutorials.so" in told.message
