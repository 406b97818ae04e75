"""Pose publisher of Gazebo: entities, frames, topics and rates."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from plugin_worlds import GROUND, rover, stamps, world, xyz, yaw

import simkit
from simkit import Pose
from simkit.diagnostics import Diagnostic

PLUGIN = "<plugin name='gz::sim::systems::PosePublisher' filename='gz-sim-pose-publisher-system'>{}</plugin>"
VECTOR = "<use_pose_vector_msg>true</use_pose_vector_msg>"
LIMBS = ["rover::base", "rover::left", "rover::right", "rover::front", "rover::rear"]


def load(inner: str, pose: str = "0 0 0 0 0 0", extra: str = "") -> simkit.Simulation:
    return simkit.load(world(GROUND, rover(PLUGIN.format(inner), pose=pose, extra=extra)))


def received(sim: simkit.Simulation, topic: str, seconds: float) -> list[Any]:
    subscription = sim.subscribe(topic)
    sim.run(seconds)
    return list(subscription.messages)


def warnings(sim: simkit.Simulation) -> list[Diagnostic]:
    return [d for d in sim.diagnostics if d.severity != "note"]


def expected(sim: simkit.Simulation, link: str) -> Pose:
    """Return the pose of a link in its model."""
    return sim.model("rover").pose.inverse() @ sim.link(f"rover::{link}").pose


def assert_is(transform: Any, pose: Pose) -> None:
    place, turn = transform.transform.translation, transform.transform.rotation
    np.testing.assert_allclose(xyz(place), pose.position, atol=1e-12)
    np.testing.assert_allclose((turn.w, turn.x, turn.y, turn.z), pose.quaternion, atol=1e-12)


def test_each_link_is_published_at_every_step_in_the_frame_of_its_model() -> None:
    with load("", pose="1 2 0 0 0 0.5") as sim:
        assert sim.topics()["/model/rover/pose"] == "geometry_msgs/msg/TransformStamped"
        assert "/model/rover/pose_static" not in sim.topics()
        sim.joint("rover::left_wheel").set_velocity(3.0)
        messages = received(sim, "/model/rover/pose", 0.01)
        assert len(messages) == 10 * 5
        assert sorted({m.child_frame_id for m in messages}) == sorted(LIMBS)
        assert {m.header.frame_id for m in messages} == {"rover"}
        np.testing.assert_array_equal(np.unique(stamps(messages)), np.arange(1, 11) * 1_000_000)
        for message in messages[-5:]:
            assert_is(message, expected(sim, message.child_frame_id.rsplit("::", 1)[-1]))
        assert not warnings(sim)


def test_the_vector_contains_all_poses_at_the_given_rate() -> None:
    with load(VECTOR + "<update_frequency>20</update_frequency>") as sim:
        assert sim.topics()["/model/rover/pose"] == "tf2_msgs/msg/TFMessage"
        messages = received(sim, "/model/rover/pose", 1.0)
        assert len(messages) == 20
        assert sorted(t.child_frame_id for t in messages[0].transforms) == sorted(LIMBS)
        assert stamps([m.transforms[0] for m in messages]).tolist() == [k * 50_000_000 for k in range(1, 21)]


def test_the_pose_of_the_model_is_in_the_frame_of_the_world() -> None:
    inner = VECTOR + "<publish_link_pose>false</publish_link_pose><publish_model_pose>true</publish_model_pose>"
    with load(inner, pose="1 -2 0 0 0 0.5") as sim:
        (transform,) = received(sim, "/model/rover/pose", 0.001)[0].transforms
        assert (transform.header.frame_id, transform.child_frame_id) == ("lab", "rover")
        np.testing.assert_allclose(xyz(transform.transform.translation), (1, -2, 0), atol=1e-3)
        assert yaw(transform.transform.rotation) == pytest.approx(0.5, abs=1e-3)


def test_publish_model_pose_defaults_to_publish_nested_model_pose() -> None:
    nested = "<model name='tray'><pose>0 0 0.3 0 0 0</pose><link name='plate'/></model>"
    nested += "<joint name='screw' type='fixed'><parent>base</parent><child>tray::plate</child></joint>"
    only = VECTOR + "<publish_link_pose>0</publish_link_pose>"
    both = only + "<publish_nested_model_pose>true</publish_nested_model_pose>"
    one = both + "<publish_model_pose>false</publish_model_pose>"
    for inner, frames in (
        (only, []),
        (both, [("lab", "rover"), ("rover", "rover::tray")]),
        (one, [("rover", "rover::tray")]),
    ):
        with load(inner, extra=nested) as sim:
            transforms = received(sim, "/model/rover/pose", 0.001)[0].transforms
            assert [(t.header.frame_id, t.child_frame_id) for t in transforms] == frames
            if frames:
                np.testing.assert_allclose(xyz(transforms[-1].transform.translation), (0, 0, 0.3), atol=1e-9)


def test_visuals_collisions_and_sensors_are_in_the_frame_of_their_link() -> None:
    eye = (
        "<link name='mast'><pose>0 0 0.4 0 0 0</pose><visual name='pole'><pose>0 0 0.1 0 0 1</pose><geometry><sphere>"
        "<radius>0.1</radius></sphere></geometry></visual><sensor name='imu' type='imu'><pose>0 0 0.2 0 0 0</pose>"
        "</sensor></link><joint name='foot' type='revolute'><pose>0 0 -0.1 0 0 0</pose><parent>base</parent>"
        "<child>mast</child><axis><xyz>0 0 1</xyz></axis><sensor name='scale' type='force_torque'/></joint>"
    )
    inner = VECTOR + "<publish_link_pose>false</publish_link_pose>"
    inner += "".join(f"<publish_{kind}_pose>true</publish_{kind}_pose>" for kind in ("visual", "collision", "sensor"))
    with load(inner, extra=eye) as sim:
        transforms = received(sim, "/model/rover/pose", 0.001)[0].transforms
        poses = {
            t.child_frame_id: (t.header.frame_id, xyz(t.transform.translation).round(9).tolist()) for t in transforms
        }
        assert poses["rover::mast::pole"] == ("rover::mast", [0, 0, 0.1])
        assert poses["rover::mast::imu"] == ("rover::mast", [0, 0, 0.2])
        assert poses["rover::foot::scale"] == ("rover::foot", [0, 0, 0])
        assert poses["rover::base::shape"] == ("rover::base", [0, 0, 0])
        assert len(poses) == 5 + 3


def test_static_poses_have_their_own_topic_and_rate() -> None:
    inner = VECTOR + (
        "<static_publisher>true</static_publisher><publish_model_pose>true</publish_model_pose>"
        "<update_frequency>50</update_frequency><static_update_frequency>5</static_update_frequency>"
    )
    with load(inner) as sim:
        resting = sim.subscribe("/model/rover/pose_static")
        moving = received(sim, "/model/rover/pose", 1.0)
        assert (len(moving), len(resting.messages)) == (50, 5)
        assert {t.child_frame_id for t in moving[0].transforms} == {"rover::left", "rover::right"}
        still = {"rover", "rover::base", "rover::front", "rover::rear"}  # the model's own pose too, as in gz
        assert {t.child_frame_id for t in resting.latest.transforms} == still
        assert stamps([m.transforms[0] for m in resting.messages]).tolist() == [k * 200_000_000 for k in range(1, 6)]


@pytest.mark.parametrize(("moving", "resting"), [(30, 20), (20, 30), (30, -1), (-1, 30), (40, 40)])
def test_two_rates_keep_their_own_grids(moving: float, resting: float) -> None:
    inner = VECTOR + (
        f"<static_publisher>true</static_publisher><update_frequency>{moving}</update_frequency>"
        f"<static_update_frequency>{resting}</static_update_frequency>"
    )

    def grid(rate: float) -> list[int]:
        """Return the ticks of 1 ms at or after k / rate, within half a second."""
        return [-(-k * 1000 // int(rate)) for k in range(1, int(rate) // 2 + 1)] if rate > 0 else list(range(1, 501))

    with load(inner) as sim:
        still = sim.subscribe("/model/rover/pose_static")
        messages = received(sim, "/model/rover/pose", 0.5)
        for found, rate in ((messages, moving), (still.messages, resting)):
            assert (stamps([m.transforms[0] for m in found]) // 1_000_000).tolist() == grid(rate)


def test_the_static_rate_defaults_to_the_other_rate() -> None:
    with load(VECTOR + "<static_publisher>1</static_publisher><update_frequency>10</update_frequency>") as sim:
        assert len(received(sim, "/model/rover/pose_static", 1.0)) == 10


def test_topic_and_message_type_can_be_set() -> None:
    inner = "<topic>where is it</topic><static_publisher>true</static_publisher>"
    inner += "<simkit:pose_type>geometry_msgs/msg/PoseStamped</simkit:pose_type>"
    with load(inner) as sim:
        assert sim.topics()["/where_is_it_static"] == "geometry_msgs/msg/PoseStamped"
        message = received(sim, "/where_is_it", 0.001)[0]
        assert message.header.frame_id == "rover"
        np.testing.assert_allclose(xyz(message.pose.position), expected(sim, "left").position, atol=1e-12)
        assert not warnings(sim)


@pytest.mark.parametrize("kind", ["Pose", "Transform"])
def test_a_type_without_frames_gives_the_same_numbers(kind: str) -> None:
    with load(f"<simkit:pose_type>geometry_msgs/msg/{kind}</simkit:pose_type>") as sim:
        first = received(sim, "/model/rover/pose", 0.001)[0]
        place = first.position if kind == "Pose" else first.translation
        np.testing.assert_allclose(xyz(place), (0, 0, 0.13), atol=1e-9)


def test_on_a_nested_model_the_topic_names_both() -> None:
    nested = f"<model name='tray'><link name='plate'/>{PLUGIN.format('')}</model>"
    nested += "<joint name='screw' type='fixed'><parent>base</parent><child>tray::plate</child></joint>"
    with simkit.load(world(GROUND, rover(nested))) as sim:
        (message,) = received(sim, "/model/rover/model/tray/pose", 0.001)
        assert (message.header.frame_id, message.child_frame_id) == ("rover::tray", "rover::tray::plate")


def test_a_moved_model_has_the_right_pose_after_a_reset_and_a_restore() -> None:
    with load(VECTOR + "<publish_model_pose>true</publish_model_pose>") as sim:
        start = sim.snapshot()
        first = received(sim, "/model/rover/pose", 0.02)
        sim.model("rover").set_pose(Pose((5, 0, 0)))
        assert xyz(received(sim, "/model/rover/pose", 0.001)[0].transforms[0].transform.translation)[0] > 4.9
        sim.restore(start)
        again = received(sim, "/model/rover/pose", 0.02)
        sim.reset()
        third = received(sim, "/model/rover/pose", 0.02)
        assert repr(first) == repr(again) == repr(third)


def test_invalid_values_are_errors() -> None:
    inner = "<publish_link_pose>maybe</publish_link_pose><update_frequency>often</update_frequency>"
    with pytest.raises(simkit.LoadError) as caught:
        load(inner)
    assert [d.code for d in caught.value.diagnostics if d.severity == "error"] == ["SK-PARAM-002"] * 2


def next_poses(sim: simkit.Simulation, topic: str) -> dict[str, Any]:
    """Return the transforms of the next step's vector, by child frame."""
    (message,) = received(sim, topic, 0.001)
    return {t.child_frame_id: t for t in message.transforms}


def test_poses_stay_right_when_models_are_spawned_removed_and_moved() -> None:
    arm = (
        "<model name='arm'>{}<pose>{}</pose><link name='foot'/><link name='hand'><pose>0 0 1 0.2 0 0</pose></link>"
        "<joint name='weld' type='fixed'><parent>world</parent><child>foot</child></joint>"
        "<joint name='elbow' type='revolute'><parent>foot</parent><child>hand</child><axis><xyz>0 1 0</xyz></axis>"
        "</joint>"
        "{}</model>"
    )
    shelf = "<static>true</static><link name='board'><pose>0 0 0.5 0 0 1</pose></link>"
    plugin = PLUGIN.format(VECTOR + "<publish_model_pose>true</publish_model_pose>")
    source = world(arm.format("", "3 0 0 0 0 0.3", plugin), f"<model name='shelf'>{shelf}{plugin}</model>")
    with simkit.load(source) as sim:

        def check() -> None:
            for model in ("arm", "shelf"):
                found, pose = next_poses(sim, f"/model/{model}/pose"), sim.model(model).pose
                assert_is(found.pop(model), pose)
                for name, transform in found.items():
                    assert_is(transform, pose.inverse() @ sim.link(name).pose)

        sim.joint("arm::elbow").set_position(0.7)
        check()
        sim.spawn("<sdf version='1.9'><model name='ball'><link name='l'/></model></sdf>", pose=Pose((9, 0, 5)))
        check()
        sim.model("arm").set_pose(Pose.from_rpy(-2, 1, 0, 0, 0, 1))
        sim.model("shelf").set_pose(Pose.from_rpy(0, 5, 0, 0, 0.5, 1))
        check()
        sim.remove("ball")
        check()
        np.testing.assert_allclose(
            xyz(next_poses(sim, "/model/shelf/pose")["shelf"].transform.translation), (0, 5, 0), atol=1e-12
        )
