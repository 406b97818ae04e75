"""Pictures: path and scan where they belong."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

import simkit
from simkit import msgs
from simkit.errors import InputError, RenderError
from simkit.pose import Pose
from simkit.recording.run_picture import DrivenPath, check_target, save_picture, scan_points
from simkit.sensors.cameras.overview_image import render_view

WORLD = """
<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>
  <model name="rover"><pose>0 0 0.1 0 0 0</pose><link name="body">
    <inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>
    <visual name="v"><geometry><box><size>0.1 0.1 0.1</size></box></geometry></visual>
    <sensor name="eye" type="gpu_lidar"><pose>0 0 0.2 0 0 0</pose><update_rate>10</update_rate><topic>scan</topic>
      <lidar><scan><horizontal><samples>90</samples><min_angle>-3.1</min_angle><max_angle>3.1</max_angle></horizontal></scan>
      <range><min>0.05</min><max>10</max></range></lidar></sensor>
  </link></model>
  <model name="wall"><static>true</static><pose>2 0 0.5 0 0 0</pose><link name="l">
    <visual name="v"><geometry><box><size>0.1 2 1</size></box></geometry></visual>
    <collision name="c"><geometry><box><size>0.1 2 1</size></box></geometry></collision></link></model>
</world></sdf>
"""


def test_points_of_a_scan_lie_where_the_rays_hit() -> None:
    scan = msgs.make(
        "sensor_msgs/msg/LaserScan",
        angle_min=0.0,
        angle_increment=np.pi / 2,
        ranges=[2.0, 1.0, float("inf"), float("-inf")],
    )
    points = scan_points(scan, Pose.from_rpy(1, 0, 0.5, 0, 0, np.pi / 2))
    np.testing.assert_allclose(points, [[1, 2, 0.5], [0, 0, 0.5]], atol=1e-6)


def test_paths_follow_moving_models_and_leave_out_static_ones() -> None:
    with simkit.load(WORLD) as sim:
        driven = DrivenPath(sim)
        sim.model("rover").set_velocity((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        for _ in range(10):
            sim.run(0.05)
            driven.sample()
        assert set(driven.tracks) == {"rover"}
        np.testing.assert_allclose([p[0] for p in driven.tracks["rover"]], np.arange(11) * 0.05, atol=1e-9)


def test_a_model_that_was_removed_and_spawned_again_begins_a_new_path() -> None:
    with simkit.load(WORLD) as sim:
        driven = DrivenPath(sim)
        for x in (3.0, 5.0):
            ball = f'<sdf version="1.9"><model name="ball"><pose>{x} 0 1 0 0 0</pose><link name="l"/></model></sdf>'
            sim.spawn(ball)
            driven.sample()
            sim.remove("ball")
        sim.spawn(ball)
        driven.sample()
        np.testing.assert_allclose(driven.tracks["ball"], [[5.0, 0.0, 1.0]], atol=1e-9)
        assert len(driven.tracks["rover"]) == 1


def test_a_path_leaves_out_a_diverged_state() -> None:
    with simkit.load(WORLD) as sim:
        driven = DrivenPath(sim)
        sim.mj_data.qpos[0] = np.nan
        driven.sample()
        assert len(driven.tracks["rover"]) == 1


def viewpoint(tmp_path: Path, world: str) -> tuple[np.ndarray, np.ndarray]:
    """Return eye and target of the picture of a world."""
    seen: list[tuple[np.ndarray, np.ndarray]] = []

    def render(_sim: object, width: int, height: int, *, eye: np.ndarray, target: np.ndarray, **_: object) -> object:
        seen.append((eye, target))
        return np.zeros((height, width, 3), np.uint8)

    with simkit.load(world) as sim:
        save_picture(sim, tmp_path / "seen.png", render)
    return seen[0]


def test_a_tall_robot_is_seen_to_its_top(tmp_path: Path) -> None:
    eye, target = viewpoint(
        tmp_path, WORLD.replace("0.1 0.1 0.1</size>", "0.1 0.1 3</size>").replace("0 0 0.1 0 0 0", "0 0 1.5 0 0 0")
    )
    up_to_top = np.array((0.0, 0.0, 3.0)) - eye
    angle = np.arccos(up_to_top @ (target - eye) / np.linalg.norm(up_to_top) / np.linalg.norm(target - eye))
    assert angle < 0.4  # [rad] half of the picture's opening angle


def test_a_model_fills_the_picture_whatever_its_size(tmp_path: Path) -> None:
    world = WORLD[: WORLD.index("<sensor")] + "</link></model></world></sdf>"
    small = viewpoint(tmp_path, world)
    large = viewpoint(tmp_path, world.replace("0.1 0.1 0.1</size>", "1 1 1</size>"))
    assert np.linalg.norm(large[0] - large[1]) == pytest.approx(10 * np.linalg.norm(small[0] - small[1]))
    assert np.linalg.norm(small[0] - small[1]) < 0.3  # [m] for a box of 0.1 m


def test_a_link_that_is_fixed_to_the_world_belongs_to_the_picture(tmp_path: Path) -> None:
    model = WORLD[: WORLD.index("<sensor")].replace("0.1 0.1 0.1</size>", "0.1 0.1 4</size>")
    fixed = model + '</link><joint name="j" type="fixed"><parent>world</parent><child>body</child></joint>'
    eye, target = viewpoint(tmp_path, fixed + "</model></world></sdf>")
    assert np.linalg.norm(eye - target) > 3.0  # [m] the whole height of 4 m is in the image


def test_a_picture_shows_path_and_scan(tmp_path: Path) -> None:
    with simkit.load(WORLD) as sim:
        driven = DrivenPath(sim)
        sim.model("rover").set_velocity((0.8, 0.0, 0.0), (0.0, 0.0, 0.0))
        for _ in range(20):
            sim.run(0.05)
            driven.sample()
        try:
            save_picture(sim, tmp_path / "out.png", render_view, driven)
        except RenderError as error:
            pytest.skip(str(error))
        blue, green, red = (c.astype(int) for c in cv2.split(cv2.imread(str(tmp_path / "out.png"))))
    assert int(((red > 150) & (green < 110) & (blue < 110)).sum()) > 100  # points of the scan on the wall
    assert int(((blue > 150) & (red < 90)).sum()) > 100  # the path behind the rover


def test_a_moving_model_without_visuals_is_drawn_by_its_collisions(tmp_path: Path) -> None:
    model = WORLD[: WORLD.index("<sensor")].replace("visual", "collision") + "</link></model></world></sdf>"
    with simkit.load(model) as sim:
        try:
            image = render_view(sim, 64, 64, eye=np.array((0.0, -1.0, 0.1)), target=np.array((0.0, 0.0, 0.1)))
        except RenderError as error:
            pytest.skip(str(error))
        assert (image[32, 32] != image[2, 2]).any(), "the box is in the middle of the image"


@pytest.mark.parametrize(
    ("name", "reason"), [("out.gif", "expected .png or .jpg"), ("no/out.png", "no does not exist")]
)
def test_an_unwritable_picture_is_reported_before_the_run(tmp_path: Path, name: str, reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        check_target(tmp_path / name)


def test_a_reset_begins_new_paths_and_forgets_goals() -> None:
    with simkit.load(WORLD) as sim:
        goals = sim.advertise("/goal_pose", "geometry_msgs/msg/PoseStamped")
        driven = DrivenPath(sim)
        sim.run(0.2)
        sim.model("rover").set_pose(simkit.Pose((3.0, 0.0, 1.0)))
        goals.publish({"header": {"frame_id": "map"}, "pose": {"position": {"x": 1.0}}})
        driven.sample()
        assert len(driven.paths()["rover"]) > 1 and "/goal_pose" in driven.goals
        sim.reset()
        driven.sample()
        assert (driven.paths(), driven.goals) == ({}, {})
        goals.publish({"header": {"frame_id": "map"}, "pose": {"position": {"x": 2.0}}})
        assert driven.goals["/goal_pose"][0] == 2.0
