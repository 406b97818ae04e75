"""Localisation plugin, compared with the true pose of a robot in rooms without symmetry."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rooms import rooms

import simkit
from simkit_navigation.plugins.localisation.likelihood_field import Hits, LikelihoodMap
from simkit_navigation.plugins.localisation.motion_models import differential
from simkit_navigation.plugins.localisation.particle_filter import Adaptation, ParticleFilter

SHARP = "<laser_model_type>likelihood_field_prob</laser_model_type><max_beams>20</max_beams>"
LOST = "<recovery_alpha_slow>0.001</recovery_alpha_slow><recovery_alpha_fast>0.3</recovery_alpha_fast>"


def initial_pose(x: float, y: float, yaw: float, deviation: float = 0.3, frame: str = "map") -> dict[str, Any]:
    covariance = np.diag([deviation**2, deviation**2, 0, 0, 0, 0.1]).reshape(-1)
    pose = {"position": {"x": x, "y": y}, "orientation": {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}}
    return {"header": {"frame_id": frame}, "pose": {"pose": pose, "covariance": covariance}}


def errors(sim: simkit.Simulation) -> tuple[float, float]:
    """Return the errors of the newest transform: position [m] and heading [°]."""
    latest = sim.subscribe("/tf", keep=20)
    sim.run(0.21)
    corrections = [t for m in latest.messages for t in m.transforms if t.child_frame_id == "odom"]
    found = simkit.msgs.pose(corrections[-1]) @ sim.tf.lookup("odom", "base_footprint")
    truth = sim.model("robot").pose
    turned = math.remainder(found.rpy[2] - truth.rpy[2], math.tau)
    return math.dist(found.position[:2], truth.position[:2]), abs(math.degrees(turned))


def drive(sim: simkit.Simulation, ahead: float, turn: float, seconds: float) -> None:
    sim.publish("/cmd_vel", {"linear": {"x": ahead}, "angular": {"z": turn}})
    sim.run(seconds)


def test_a_wrong_initial_pose_is_corrected_while_the_robot_moves() -> None:
    with simkit.load(rooms(SHARP), seed=1) as sim:
        poses = sim.subscribe("/amcl_pose")
        sim.publish("/initialpose", initial_pose(1.3, 0.8, 0.2))
        sim.run(0.5)
        drive(sim, 0.1, 0.5, 8.0)
        distance, turned = errors(sim)
        assert distance < 0.05 and turned < 1.5
        deviations = np.sqrt(np.asarray(poses.latest.pose.covariance)[[0, 7, 35]])
        assert (deviations < (0.1, 0.1, 0.1)).all() and (deviations > 1e-3).all()
        assert poses.latest.header.frame_id == "map"


@pytest.mark.parametrize(("options", "seed"), [(SHARP, 1), ("", 2)])
def test_global_localisation_finds_the_robot(options: str, seed: int) -> None:
    with simkit.load(rooms(options), seed=seed) as sim:
        sim.model("robot").set_pose(simkit.Pose.from_rpy(4.5, 3.3, 0.1, 0, 0, seed))
        clouds = sim.subscribe("/particle_cloud", keep=1)
        sim.call("/reinitialize_global_localization")
        first = clouds.latest
        assert len(first.particles) == 2000 and sum(p.weight for p in first.particles) == pytest.approx(1.0)
        drive(sim, 0.0, 0.6, 10.2)
        drive(sim, 0.1, 0.4, 15.0)
        distance, turned = errors(sim)
        assert distance < 0.10 and turned < 3.0
        assert len(clouds.latest.particles) < 1000


def test_a_robot_that_is_elsewhere_than_all_particles_is_found() -> None:
    with simkit.load(rooms(SHARP + LOST), seed=1) as sim:
        sim.publish("/initialpose", initial_pose(1.0, 1.0, 0.5))
        drive(sim, 0.0, 0.6, 5.0)
        sim.publish("/initialpose", initial_pose(4.5, 3.3, 2.0, 0.1))
        drive(sim, 0.0, 0.6, 0.4)
        assert errors(sim)[0] > 1.0
        drive(sim, 0.1, 0.4, 12.0)
        distance, turned = errors(sim)
        assert distance < 0.10 and turned < 3.0


def test_a_robot_at_rest_updates_only_on_request() -> None:
    begin = "<initial_pose><x>1</x><y>1</y><yaw>.5</yaw></initial_pose>"
    with simkit.load(rooms("<set_initial_pose>true</set_initial_pose>" + begin)) as sim:
        poses = sim.subscribe("/amcl_pose")
        sim.run(2.0)
        assert len(poses.messages) == 1
        assert poses.latest.pose.pose.position.x == pytest.approx(1.0, abs=0.1)
        sim.call("/request_nomotion_update")
        sim.run(1.0)
        assert len(poses.messages) == 2
        sim.call("/set_initial_pose", {"pose": initial_pose(2.0, 1.5, 0.0, 0.01)})
        sim.run(0.5)
        assert poses.latest.pose.pose.position.x == pytest.approx(2.0, abs=0.05)


NAV2 = """
amcl:
  ros__parameters:
    alpha1: 0.3
    base_frame_id: "base_footprint"
    scan_topic: scan
    set_initial_pose: true
    initial_pose: {x: 1.5, y: 1.2, z: 0.0, yaw: 0.4}
"""


def test_a_parameter_file_of_nav2_is_read(tmp_path: Path) -> None:
    (tmp_path / "nav2.yaml").write_text(NAV2, "utf-8")
    (tmp_path / "rooms.sdf").write_text(rooms("<ros><argument>--params-file nav2.yaml</argument></ros>"), "utf-8")
    with simkit.load(tmp_path / "rooms.sdf") as sim:
        found = sim.communication.parameters["/amcl"]
        names = ("alpha1", "alpha2", "initial_pose.x", "initial_pose.yaw")
        assert [found[name].value for name in names] == [0.3, 0.2, 1.5, 0.4]
        poses = sim.subscribe("/amcl_pose", keep=1)
        sim.run(0.5)
        assert poses.latest is not None


def test_the_transform_is_valid_for_the_tolerance_and_can_be_switched_off() -> None:
    with simkit.load(rooms("<transform_tolerance>0.3</transform_tolerance>")) as sim:
        received: list[Any] = []
        sim.subscribe("/tf", lambda m: received.extend((sim.time, t) for t in m.transforms))
        sim.publish("/initialpose", initial_pose(1.0, 1.0, 0.5))
        sim.run(1.0)
        now, newest = next((now, t) for now, t in reversed(received) if t.child_frame_id == "odom")
        assert newest.header.frame_id == "map"
        assert simkit.msgs.stamp_ns(newest.header.stamp) * 1e-9 == pytest.approx(now + 0.3, abs=0.05)
        sim.set_parameter("/amcl", "tf_broadcast", False)
        sim.run(0.1)
        received.clear()
        sim.run(1.0)
        assert {t.child_frame_id for _, t in received} == {"base_footprint"}


def test_the_same_seed_gives_the_same_particles_after_a_restore_and_after_a_reset() -> None:
    with simkit.load(rooms(LOST), seed=5) as sim:
        clouds = sim.subscribe("/particle_cloud", keep=1)

        def run() -> bytes:
            sim.call("/reinitialize_global_localization")
            drive(sim, 0.05, 0.6, 2.0)
            return simkit.msgs.serialize(clouds.latest)

        first = run()
        kept = sim.snapshot()
        second = run()
        assert second != first
        sim.restore(kept)
        assert run() == second
        sim.reset()
        assert run() == first
        sim.reset(seed=6)
        assert run() != first


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ("<odom_frame_id>odometry</odom_frame_id>", "SK-TF-001 unknown frame 'odometry'"),
        ("<odom_frame_id></odom_frame_id>", "the target frame must be a text that is not empty"),
        ("<map_topic>plan</map_topic>", "there is no map"),
        ("<global_frame_id>earth</global_frame_id>", "the map is in the frame 'map', <global_frame_id> is 'earth'"),
    ],
)
def test_what_is_missing_is_reported_once(options: str, words: str) -> None:
    with simkit.load(rooms(options + "<set_initial_pose>true</set_initial_pose>")) as sim:
        sim.run(2.5)
        found = [d for d in sim.diagnostics if d.code == "SK-AMCL-001"]
        assert len(found) == 1 and words in found[0].message


def test_a_scan_without_a_frame_is_reported_once() -> None:
    with simkit.load(rooms("<set_initial_pose>true</set_initial_pose><scan_topic>other</scan_topic>")) as sim:
        sim.advertise("/other", "sensor_msgs/msg/LaserScan").publish({"ranges": [1.0]})
        sim.run(2.0)
        (found,) = [d for d in sim.diagnostics if d.code == "SK-AMCL-001"]
        assert "scans are not used: the source frame must be a text that is not empty" in found.message


@pytest.mark.parametrize(
    ("pose", "words"),
    [
        (initial_pose(1.0, 1.0, 0.0, frame="odom"), "an initial pose in the frame 'odom' is ignored"),
        (initial_pose(math.nan, 1.0, 0.0), "an initial pose with a NaN or infinite number is ignored"),
        (initial_pose(1.0, 1.0, 0.0, math.inf), "an initial pose with a NaN or infinite number is ignored"),
    ],
)
def test_an_invalid_initial_pose_is_ignored(pose: dict[str, Any], words: str) -> None:
    with simkit.load(rooms()) as sim:
        poses = sim.subscribe("/amcl_pose")
        sim.publish("/initialpose", pose)
        sim.run(0.5)
        assert any(words in d.message for d in sim.diagnostics) and not poses.messages


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ("<min_particles>900</min_particles><max_particles>300</max_particles>", "at most <max_particles>, 300"),
        ("<laser_model_type>beam</laser_model_type>", "likelihood_field_prob"),
        ("<sigma_hit>0</sigma_hit>", "sigma_hit"),
    ],
)
def test_invalid_parameters_stop_the_load(options: str, words: str) -> None:
    with pytest.raises(simkit.LoadError, match=words):
        simkit.load(rooms(options))


def test_an_update_with_500_particles_and_360_rays_takes_less_than_2_ms() -> None:
    random = np.random.default_rng(1)
    cells = np.zeros((80, 120), bool)
    cells[0] = cells[-1] = cells[:, 0] = cells[:, -1] = True
    from scipy.ndimage import distance_transform_edt

    field = LikelihoodMap(distance_transform_edt(~cells) * 0.05, np.argwhere(~cells), 0.05, (0.0, 0.0, 0.0))
    particles = ParticleFilter.of((3.0, 2.0, 0.0) + random.normal(size=(500, 3)) * (0.1, 0.1, 0.05))
    points = 3.0 * np.column_stack([f(np.arange(360) * math.tau / 360) for f in (np.cos, np.sin)])
    hits, adaptation = Hits(0.2, 0.9, 0.03, 2.0, True), Adaptation(500, 500, 0.05, 0.99, 0.0, 0.0)
    best = math.inf
    for _ in range(30):
        begin = time.thread_time()
        particles.poses = differential(particles.poses, (0.01, 0.0, 0.0), (0.05,) * 5, random)
        means = field.mean_terms(particles.poses, points, hits)
        particles.weigh(hits.likelihoods(means, 360), hits.agreements(means), adaptation)
        particles.estimate()
        particles.resample(adaptation, lambda n: field.random_poses(n, random), random)
        best = min(best, time.thread_time() - begin)
    assert best < 2e-3


def grid(count: int = 100, resolution: float = 0.1, x: float = 0.0, value: int = 0) -> Any:
    origin = {"position": {"x": x}, "orientation": {"w": 1.0}}
    info = {"resolution": resolution, "width": 10, "height": 10, "origin": origin}
    cells = np.full(count, value, np.int8)
    return simkit.msgs.make("nav_msgs/msg/OccupancyGrid", header={"frame_id": "map"}, info=info, data=cells)


@pytest.mark.parametrize("message", [grid(3), grid(resolution=0.0), grid(resolution=math.nan), grid(x=math.nan)])
def test_an_invalid_map_is_ignored_after_a_warning(message: Any) -> None:
    with simkit.load(rooms()) as sim:
        sim.publish("/initialpose", initial_pose(1.0, 1.0, 0.5))
        sim.publish("/map", message)
        poses = sim.subscribe("/amcl_pose", keep=1)
        sim.run(0.6)
        assert poses.latest is not None
        assert [d.message for d in sim.diagnostics if d.code == "SK-AMCL-001" and "not valid" in d.message]


def test_a_map_without_free_cells_needs_no_random_particles() -> None:
    with simkit.load(rooms(LOST)) as sim:
        sim.publish("/initialpose", initial_pose(1.0, 1.0, 0.5))
        drive(sim, 0.0, 0.6, 1.0)
        sim.publish("/map", grid(value=-1))  # no scan agrees with it, so the robot seems to be lost
        drive(sim, 0.0, 0.6, 1.5)


@pytest.mark.parametrize("options", ["<map_topic>scan</map_topic>", "<scan_topic>/tf</scan_topic>"])
def test_a_topic_of_another_type_is_reported(options: str) -> None:
    with simkit.load(rooms(options)) as sim:
        sim.run(0.3)
        (found,) = [d.message for d in sim.diagnostics if d.code == "SK-AMCL-001" and "ignored" in d.message]
        assert "are ignored; expected" in found


def test_an_initial_pose_and_a_scan_with_extreme_numbers_are_ignored() -> None:
    with simkit.load(rooms()) as sim:
        clouds, poses = sim.subscribe("/particle_cloud", keep=1), sim.subscribe("/amcl_pose", keep=1)
        sim.publish("/initialpose", initial_pose(1e300, 1.0, 0.5))
        sim.publish("/initialpose", initial_pose(1.0, 1.0, 0.5, 1e154))
        sim.step()
        assert clouds.latest is None
        sim.publish("/initialpose", initial_pose(1.0, 1.0, 0.5))
        header = {"frame_id": "base_footprint", "stamp": simkit.msgs.time(sim.time_ns)}
        fields = {"angle_min": math.nan, "range_max": 4.0, "ranges": np.ones(9, np.float32)}
        sim.publish("/scan", simkit.msgs.make("sensor_msgs/msg/LaserScan", header=header, **fields))
        assert poses.latest is None
        assert sum(d.code == "SK-PLUGIN-041" for d in sim.diagnostics) == 2
