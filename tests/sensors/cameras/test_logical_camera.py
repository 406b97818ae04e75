"""Logical cameras: the models in the frustum, their poses and their order."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.pose import Pose
from simkit.sensors.cameras.logical_camera import Frustum, LogicalCameraOptions

TOPIC = "/world/w/model/eye/link/l/sensor/s/logical_camera"
IMAGE = "ros_gz_interfaces/msg/LogicalCameraImage"
FRUSTUM = "<near>0.55</near><far>5</far><horizontal_fov>1.04719755</horizontal_fov><aspect_ratio>1.778</aspect_ratio>"


def ball_model(name: str, pose: str, more: str = "") -> str:
    return (
        f'<model name="{name}"><pose>{pose}</pose><link name="l"><collision name="c"><geometry><sphere><radius>0.1'
        f"</radius></sphere></geometry></collision></link>{more}</model>"
    )


def world(models: str, block: str = FRUSTUM, *, pose: str = "0.25 0 0.5 0 0 0", top: str = "", extra: str = "") -> str:
    return f"""<sdf version="1.9" xmlns:simkit="https://simkit.invalid"><world name="w">
      {top or "<gravity>0 0 0</gravity>"}
      <model name="eye"><static>true</static><link name="l">
        <sensor name="s" type="logical_camera"><pose>{pose}</pose><update_rate>20</update_rate>{extra}
        <logical_camera>{block}</logical_camera></sensor></link></model>
      {models}</world></sdf>"""


def poses_by_name(sim: Any) -> dict[str, Any]:
    return {m.name: m.pose for m in sim.sensor("eye::l::s").latest.model}


def numbers(pose: Any) -> list[float]:
    p, q = pose.position, pose.orientation
    return [p.x, p.y, p.z, q.w, q.x, q.y, q.z]


def first(text: str) -> list[str]:
    with simkit.load(text) as sim:
        sim.run(0.05)
        return list(poses_by_name(sim))


# ---------------------------------------------------------------------- the frustum


@pytest.mark.parametrize(
    ("point", "inside"),
    [
        ((0.999, 0, 0), False),
        ((1.001, 0, 0), True),
        ((3.999, 0, 0), True),
        ((4.001, 0, 0), False),
        ((-2, 0, 0), False),
        ((2, 1.999, 0), True),
        ((2, 2.001, 0), False),
        ((2, -1.999, 0), True),
        ((2, -2.001, 0), False),
        ((2, 0, 0.999), True),
        ((2, 0, 1.001), False),
        ((2, 0, -0.999), True),
        ((2, 0, -1.001), False),
        ((4, 4, 2), True),
    ],
)
def test_a_right_angle_twice_as_wide_as_high_is_cut_where_it_should_be(point: tuple[float, ...], inside: bool) -> None:
    frustum = Frustum(LogicalCameraOptions(near=1, far=4, horizontal_fov=math.pi / 2, aspect_ratio=2))
    assert frustum.contains(np.array([point], float)).tolist() == [inside]


def test_random_points_are_inside_when_their_angles_and_depth_say_so() -> None:
    options = LogicalCameraOptions(near=0.2, far=3, horizontal_fov=1.3, aspect_ratio=1.5)
    points = np.random.default_rng(3).uniform(-4, 4, (4000, 3))
    found = Frustum(options).contains(points)
    x, y, z = points.T
    high = math.atan(math.tan(0.65) / 1.5)
    expected = (x > 0.2) & (x < 3) & (np.abs(np.arctan2(y, x)) < 0.65) & (np.abs(np.arctan2(z, x)) < high)
    assert 40 < expected.sum() < 1000
    np.testing.assert_array_equal(found, expected)


def test_defaults_are_those_of_sdf() -> None:
    text = world(ball_model("in", "0.9 0 0 0 0 0") + ball_model("far", "1.1 0 0 0 0 0"), "", pose="0 0 0 0 0 0")
    with simkit.load(text) as sim:
        options = sim.sensor("eye::l::s").options
        assert (options.near, options.far, options.horizontal_fov, options.aspect_ratio) == (0, 1, 1, 1)
        sim.run(0.05)
        assert list(poses_by_name(sim)) == ["eye", "in"]


@pytest.mark.parametrize(
    "block",
    [
        "<near>2</near><far>1</far>",
        "<near>-1</near>",
        "<horizontal_fov>0</horizontal_fov>",
        "<horizontal_fov>3.2</horizontal_fov>",
        "<aspect_ratio>0</aspect_ratio>",
        "<far>nan</far>",
    ],
)
def test_an_invalid_frustum_is_an_error(block: str) -> None:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(world("", block))
    assert [d.code for d in caught.value.diagnostics if d.severity == "error"] == ["SK-PARAM-002"]


# ---------------------------------------------------------------------- what is told


def test_the_pose_is_that_of_the_model_in_the_sensors_frame() -> None:
    """The box and pose of gz-sensors' own test, and a rotated sensor that looks at the box from the side."""
    for place in ((0.25, 0, 0.5, 0, 0, 0), (2, 2, 0.5, 0, 0, -1.57), (2.1, -0.1, 3, 0.3, math.pi / 2, 0.2)):
        text = world(ball_model("box", "2 0 0.5 0.1 0.2 1.57"), pose=" ".join(map(str, place)))
        with simkit.load(text) as sim:
            sim.run(0.05)
            message = sim.sensor("eye::l::s").latest
            eye = Pose.from_rpy(*place)
            expected = eye.inverse() @ Pose.from_rpy(2, 0, 0.5, 0.1, 0.2, 1.57)
            np.testing.assert_allclose(numbers(message.pose), eye.as_list(), atol=1e-12)
            (found,) = message.model
            assert found.name == "box"
            turn = np.sign(np.dot(numbers(found.pose)[3:], expected.quaternion))
            np.testing.assert_allclose(numbers(found.pose)[:3], expected.position, atol=1e-12)
            np.testing.assert_allclose(np.array(numbers(found.pose)[3:]) * turn, expected.quaternion, atol=1e-12)


def test_models_are_sorted_by_name_in_any_order_of_the_file() -> None:
    a, b, c = ball_model("a", "2 0 0.5 0 0 0"), ball_model("b", "3 0 0.5 0 0 0"), ball_model("B", "2 0.3 0.5 0 0 0")
    assert first(world(a + b + c)) == first(world(c + b + a)) == ["B", "a", "b"]


def test_nothing_hides_anything_and_size_does_not_matter() -> None:
    big = """<model name="wall"><static>true</static><pose>1 0 0.5 0 0 0</pose><link name="l"><collision name="c">
      <geometry><box><size>0.1 9 9</size></box></geometry></collision></link></model>
      <model name="beside"><static>true</static><pose>2 4 0.5 0 0 0</pose><link name="l"><collision name="c">
      <geometry><box><size>0.1 20 9</size></box></geometry></collision></link></model>"""
    assert first(world(big + ball_model("behind", "3 0 0.5 0 0 0"))) == ["behind", "wall"]


def test_nested_models_have_their_scoped_names_and_their_own_poses() -> None:
    inner = '<model name="in"><pose>1 0.2 0 0 0 0.5</pose><link name="l"/></model>'
    with simkit.load(world(ball_model("out", "2 0 0.5 0 0 0", inner))) as sim:
        sim.run(0.05)
        found = poses_by_name(sim)
        assert list(found) == ["out", "out::in"]
        expected = [2.75, 0.2, 0, math.cos(0.25), 0, 0, math.sin(0.25)]
        np.testing.assert_allclose(numbers(found["out::in"]), expected, atol=1e-12)


def test_the_origin_counts_and_not_the_canonical_link() -> None:
    """The link is outside the view, and the origin of its model is inside."""
    far = '<model name="far"><pose>2 0 0.5 0 0 0</pose><link name="l"><pose>0 9 0 0 0 0</pose></link></model>'
    with simkit.load(world(far)) as sim:
        sim.run(0.05)
        np.testing.assert_allclose(numbers(poses_by_name(sim)["far"]), [1.75, 0, 0, 1, 0, 0, 0], atol=1e-12)


def test_its_own_model_counts_where_its_origin_is_in_view() -> None:
    assert first(world("", "<near>0</near><far>5</far>", pose="-1 0 0 0 0 0")) == ["eye"]
    assert first(world("", "<near>0.1</near><far>5</far>", pose="0 0 0 0 0 0")) == []


def test_an_image_without_models_is_published_too() -> None:
    with simkit.load(world("")) as sim:
        sub = sim.subscribe(TOPIC)
        sim.run(0.5)
        assert len(sub.messages) == 11
        assert all(not m.model for m in sub.messages)
        assert sub.latest.header.frame_id == "eye::l::s"


# ---------------------------------------------------------------------- as things move


def test_a_model_that_passes_is_seen_while_it_is_inside() -> None:
    """The model moves at 1 m/s through a frustum, which is 2·2·tan(0.5) m wide at a distance of 2 m."""
    block = "<near>0.1</near><far>5</far><horizontal_fov>1</horizontal_fov>"
    with simkit.load(world(ball_model("ball", "2 -2 0.5 0 0 0"), block, pose="0 0 0.5 0 0 0")) as sim:
        sim.model("ball").set_velocity((0, 1, 0))
        sub = sim.subscribe(TOPIC)
        sim.run(4)
        inside = [m.header.stamp.sec + m.header.stamp.nanosec * 1e-9 for m in sub.messages if m.model]
    half = 2 * math.tan(0.5)
    assert inside[0] == pytest.approx(2 - half, abs=0.051)
    assert inside[-1] == pytest.approx(2 + half, abs=0.051)
    assert len(inside) == pytest.approx(2 * half / 0.05, abs=1)


def test_an_image_that_is_read_later_shows_the_state_at_its_stamp() -> None:
    with simkit.load(world(ball_model("ball", "2 0 0.5 0 0 0"))) as sim:
        sim.model("ball").set_velocity((1, 0, 0))
        sim.run(0.07)
        assert numbers(poses_by_name(sim)["ball"])[0] == pytest.approx(1.75 + 0.05, abs=1e-9)


def test_spawned_removed_and_changed_models_show_in_the_next_image() -> None:
    with simkit.load(world(ball_model("a", "2 0 0.5 0 0 0"))) as sim:
        sim.run(0.05)
        sim.spawn(f'<sdf version="1.9">{ball_model("c", "3 0 0.5 0 0 0")}</sdf>', name="b")
        assert list(poses_by_name(sim)) == ["a"]
        sim.run(0.05)
        assert list(poses_by_name(sim)) == ["a", "b"]
        sim.remove("a")
        sim.run(0.05)
        assert list(poses_by_name(sim)) == ["b"]
        sim.model("b").set_pose(Pose((9, 0, 0)))
        sim.run(0.05)
        assert list(poses_by_name(sim)) == []
        sim.reset()
        sim.run(0.05)
        assert list(poses_by_name(sim)) == ["a"]


def test_a_static_model_that_is_moved_is_where_it_was_put() -> None:
    post = '<model name="post"><static>true</static><pose>9 0 0 0 0 0</pose><link name="l"/></model>'
    with simkit.load(world(post)) as sim:
        sim.run(0.05)
        assert list(poses_by_name(sim)) == []
        sim.model("post").set_pose(Pose((2, 0, 0.5)))
        sim.run(0.05)
        np.testing.assert_allclose(numbers(poses_by_name(sim)["post"])[:3], (1.75, 0, 0), atol=1e-12)


def test_sleeping_bodies_are_seen() -> None:
    ground = "<include><uri>model://ground_plane</uri></include>"
    box = """<model name="box"><pose>2 0 0.5 0 0 0</pose><link name="l"><collision name="c"><geometry><box><size>1 1 1
      </size></box></geometry></collision></link></model>"""
    block = "<near>0.1</near><far>5</far><horizontal_fov>1</horizontal_fov>"
    with simkit.load(world(ground + box, block, pose="0 0 0.5 0 0 0", top="<gravity>0 0 -9.8</gravity>")) as sim:
        sim.run(3)
        np.testing.assert_allclose(numbers(poses_by_name(sim)["box"])[:3], (2, 0, 0), atol=2e-3)


# ---------------------------------------------------------------------- topics


def test_image_and_frustum_have_gazebos_topics_and_the_bridges_type() -> None:
    with simkit.load(world("")) as sim:
        assert sim.topics()[TOPIC] == IMAGE
        sub = sim.subscribe(TOPIC + "/frustum")
        sim.run(0.1)
        told = sub.latest
    assert len(sub.messages) == 3
    assert (told.near_clip, told.far_clip, told.horizontal_fov, told.aspect_ratio) == (0.55, 5, 1.04719755, 1.778)


def test_the_frustum_topic_is_below_the_sensors_own_topic() -> None:
    with simkit.load(world("", extra="<topic>/what is/there</topic>")) as sim:
        assert {"/what_is/there", "/what_is/there/frustum"} <= set(sim.topics())


def test_gazebos_system_may_be_named() -> None:
    top = '<plugin filename="gz-sim-logical-camera-system" name="gz::sim::systems::LogicalCamera"/>'
    with simkit.load(world("", top=top)) as sim:
        assert {d.severity for d in sim.diagnostics} == {"note"}


# ---------------------------------------------------------------------- Gazebo's quirks


def quirky(models: str, block: str, pose: str = "0 0 0 0 0 0") -> list[str]:
    return first(world(models, block, pose=pose, top="<simkit:gazebo_quirks>true</simkit:gazebo_quirks>"))


def test_with_near_0_gazebos_frustum_contains_models_on_all_sides() -> None:
    """If <near> is 0, two equal corners define four of the six planes, so these planes have no direction."""
    models = (
        ball_model("behind", "-3 0.1 0 0 0 0") + ball_model("left", "1 9 0 0 0 0") + ball_model("above", "1 0 9 0 0 0")
    )
    models += ball_model("right", "1 -9 0 0 0 0") + ball_model("far", "6 0 0 0 0 0")
    assert quirky(models, "<far>5</far>") == ["above", "eye", "left"]
    assert quirky(models + ball_model("b2", "-3 9 0 0 0 0"), "<far>5</far>") == ["above", "b2", "eye", "left"]
    assert quirky(models, "<near>0.01</near><far>5</far>") == []


def test_gazebo_treats_a_nested_model_as_a_top_level_model() -> None:
    inner = '<model name="in"><pose>1 0.2 0 0 0 0</pose><link name="l"/></model>'
    models = ball_model("out", "20 0 0.5 0 0 0", inner)
    assert quirky(models, "<near>0.1</near><far>5</far>") == ["in"]
    assert first(world(models, "<near>0.1</near><far>5</far>")) == []
