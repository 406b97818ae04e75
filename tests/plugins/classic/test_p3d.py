"""Ground truth pose of a link in Gazebo Classic."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from moved_models import INERTIA, box
from plugin_worlds import element, stamps, world, xyz, yaw

import simkit

FILE = "name='truth' filename='libgazebo_ros_p3d.so'"
ARM = (
    f"<link name='arm'><pose>0.5 0 0 0 0 0</pose><inertial><mass>1</mass>{INERTIA}</inertial></link>"
    "<joint name='hinge' type='continuous'><parent>base</parent><child>arm</child><axis><xyz>0 0 1</xyz></axis></joint>"
)


def opened(seed: int = 0, **values: Any) -> simkit.Simulation:
    plugin = element("plugin", values, FILE)
    model = box(plugin, pose="1 2 3 0 0 0.5", extra=ARM)
    return simkit.load(world("<gravity>0 0 0</gravity>", model), seed=seed)


def moving(sim: simkit.Simulation) -> simkit.Simulation:
    """The whole model turns with 0.6 rad/s about its origin, which goes with (0.3, 0.4, 0.2) m/s."""
    sim.model("box").set_velocity((0.3, 0.4, 0.2), (0, 0, 0.6))
    return sim


def test_in_the_world_pose_and_twist_are_the_links_in_the_worlds_axes() -> None:
    with moving(opened(ros="", body_name="arm")) as sim:
        odometry = sim.subscribe("/odom")
        sim.run(0.5)
        link = sim.link("box::arm")
        message = odometry.latest
        assert len(odometry.messages) == 500  # rate 0: every step
        assert (message.header.frame_id, message.child_frame_id) == ("world", "arm")
        np.testing.assert_allclose(xyz(message.pose.pose.position), link.pose.position, atol=1e-12)
        assert yaw(message.pose.pose.orientation) == pytest.approx(link.pose.rpy[2])
        np.testing.assert_allclose(xyz(message.twist.twist.linear), link.linear_velocity, atol=1e-12)
        np.testing.assert_allclose(xyz(message.twist.twist.angular), (0, 0, 0.6), atol=1e-3)


def test_rate_topic_and_offsets_of_ros_2() -> None:
    values = {"update_rate": 100, "xyz_offset": "1 0 -3", "rpy_offset": "0 0 0.25"}
    with opened(ros="<remapping>odom:=truth</remapping>", body_name="base", **values) as sim:
        odometry = sim.subscribe("/truth")
        sim.run(0.1)
    np.testing.assert_array_equal(stamps(odometry.messages), np.arange(1, 11) * 10_000_000)
    np.testing.assert_allclose(xyz(odometry.latest.pose.pose.position), (2, 2, 0), atol=1e-12)
    assert yaw(odometry.latest.pose.pose.orientation) == pytest.approx(0.75)


def test_old_names_of_the_offsets_are_read_and_new_names_override_them() -> None:
    with opened(body_name="base", xyz_offsets="1 0 0", rpy_offsets="0 0 0.1", rpy_offset="0 0 0.2") as sim:
        odometry = sim.subscribe("/odom")
        sim.step()
        assert not [d for d in sim.diagnostics if d.code == "SK-PARAM-003"]
    assert odometry.latest.pose.pose.position.x == pytest.approx(2)
    assert yaw(odometry.latest.pose.pose.orientation) == pytest.approx(0.7)


def test_an_offset_turns_the_attitude_about_the_frames_axes() -> None:
    with opened(body_name="base", rpy_offset="1.5707963267948966 0 0") as sim:
        odometry = sim.subscribe("/odom")
        sim.step()
    q = odometry.latest.pose.pose.orientation
    turned = simkit.Pose((0, 0, 0), (q.w, q.x, q.y, q.z)).rotate((1, 0, 0))
    np.testing.assert_allclose(turned, (math.cos(0.5), 0, math.sin(0.5)), atol=1e-12)


def test_relative_to_another_link_the_twist_is_the_rate_of_the_pose() -> None:
    with opened(ros="", body_name="base", frame_name="arm") as sim:
        sim.model("box").set_velocity((0.3, 0.4, 0.2), (0, 0, 0.6))
        sim.joint("box::hinge").set_velocity(2.0)
        odometry = sim.subscribe("/odom")
        sim.run(0.5)
        expected = sim.link("box::arm").pose.inverse() @ sim.link("box::base").pose
    old, message = odometry.messages[-2:]
    assert message.header.frame_id == "arm"
    np.testing.assert_allclose(xyz(message.pose.pose.position), expected.position, atol=1e-12)
    assert yaw(message.pose.pose.orientation) == pytest.approx(expected.rpy[2])
    change = (xyz(message.pose.pose.position) - xyz(old.pose.pose.position)) / 0.001
    np.testing.assert_allclose(xyz(message.twist.twist.linear), change, atol=3e-3)
    assert np.linalg.norm(change) == pytest.approx(0.5 * abs(message.twist.twist.angular.z), abs=3e-3)


def test_the_ros_1_spelling_gives_the_same_odometry() -> None:
    values = {
        "robotNamespace": "one",
        "alwaysOn": "true",
        "updateRate": 50,
        "bodyName": "base",
        "topicName": "truth",
        "frameName": "/map",
        "xyzOffset": "0 0 1",
        "rpyOffset": "0 0 0.25",
        "gaussianNoise": 0.0,
    }
    with opened(**values) as sim:
        assert not [d for d in sim.diagnostics if d.severity == "warning"]
        odometry = sim.subscribe("/one/truth")
        sim.run(0.1)
    assert len(odometry.messages) == 5
    assert odometry.latest.header.frame_id == "map"
    np.testing.assert_allclose(xyz(odometry.latest.pose.pose.position), (1, 2, 4), atol=1e-12)
    assert yaw(odometry.latest.pose.pose.orientation) == pytest.approx(0.75)


def test_noise_is_on_the_twist_and_its_variance_in_both_covariances() -> None:
    with opened(body_name="base", gaussian_noise=0.1) as sim:
        odometry = sim.subscribe("/odom")
        sim.run(1.0)
    parts = np.array([(*xyz(m.twist.twist.linear), *xyz(m.twist.twist.angular)) for m in odometry.messages])
    np.testing.assert_allclose(parts.std(axis=0), 0.1, rtol=0.1)
    assert np.abs(np.corrcoef(parts.T) - np.eye(6)).max() < 0.15
    for covariance in (odometry.latest.pose.covariance, odometry.latest.twist.covariance):
        np.testing.assert_allclose(np.reshape(covariance, (6, 6)), np.eye(6) * 0.01, atol=1e-15)
    assert odometry.latest.pose.pose.position.x == pytest.approx(1, abs=1e-12)


def test_a_late_subscriber_gets_the_same_noise_and_another_seed_differs() -> None:
    last = []
    for seed, late in ((1, False), (1, True), (2, False)):
        with opened(seed=seed, body_name="base", gaussian_noise=0.1, update_rate=10) as sim:
            odometry = None if late else sim.subscribe("/odom")
            sim.run(0.9)
            odometry = odometry or sim.subscribe("/odom")
            sim.run(0.1)
            last.append(odometry.latest.twist.twist.linear.x)
    assert last[0] == last[1] != last[2]


def test_a_missing_or_unknown_body_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-001.*body_name"):
        opened(ros="")
    with pytest.raises(simkit.LoadError, match="(?s)SK-PLUGIN-003.*'bse'.*did you mean 'base'"):
        opened(body_name="bse")
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003.*no link ''"):
        opened(body_name="")
    with pytest.raises(simkit.LoadError, match="SK-PARAM-001.*topicName"):
        opened(bodyName="base")


def test_an_unknown_frame_is_reported_and_the_pose_is_in_the_world_frame() -> None:
    with opened(body_name="base", frame_name="amr") as sim:
        (found,) = (d for d in sim.diagnostics if d.code == "SK-PLUGIN-054")
        assert "'arm'" in found.hint
        odometry = sim.subscribe("/odom")
        sim.step()
    assert odometry.latest.header.frame_id == "amr"
    assert odometry.latest.pose.pose.position.x == pytest.approx(1)


def test_a_negative_rate_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002.*update_rate"):
        opened(body_name="base", update_rate=-5)
