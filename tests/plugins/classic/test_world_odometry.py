"""PAL's ground truth pose of a link in the world."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from moved_models import INERTIA, box
from plugin_worlds import element, stamps, world, xyz, yaw

import simkit
from simkit.plugins.classic.world_odometry import GazeboWorldOdometry

FILE = "name='truth' filename='libgazebo_world_odometry.so'"
ARM = (
    f"<link name='arm'><pose>0.5 0 0 0 0 0</pose><inertial><mass>1</mass>{INERTIA}</inertial></link>"
    "<joint name='hinge' type='continuous'><parent>base</parent><child>arm</child><axis><xyz>0 0 1</xyz></axis></joint>"
)


def opened(seed: int = 0, **values: Any) -> simkit.Simulation:
    model = box(element("plugin", values, FILE), pose="1 2 3 0 0 0.5", extra=ARM)
    sim = simkit.load(world("<gravity>0 0 0</gravity>", model), seed=seed)
    sim.model("box").set_velocity((0.3, 0.4, 0.2), (0, 0, 0.6))
    return sim


def test_the_pose_is_in_the_world_with_the_named_frame_id() -> None:
    with opened(frameName="base", topicName="floating_base_pose_simulated") as sim:
        odometry = sim.subscribe("/floating_base_pose_simulated")
        sim.run(0.1)
        published, link = odometry.latest, sim.link("box::base")
        assert len(odometry.messages) == 100
        assert (published.header.frame_id, published.child_frame_id) == ("base", "base")
        np.testing.assert_allclose(xyz(published.pose.pose.position), link.pose.position, atol=1e-12)
        assert yaw(published.pose.pose.orientation) == pytest.approx(link.pose.rpy[2])


def test_files_for_ros_2_have_the_same_elements_with_underscores() -> None:
    with opened(body_name="arm", frame_name="world", topic_name="truth", update_rate=100) as sim:
        odometry = sim.subscribe("/truth")
        sim.run(0.1)
        assert [d for d in sim.diagnostics if d.severity != "note"] == []
        assert odometry.latest.child_frame_id == "arm"
        assert len(odometry.messages) == 10


def test_linear_velocity_is_in_the_worlds_axes_and_angular_in_the_links() -> None:
    with opened(bodyName="arm", topicName="truth", robotNamespace="pmb2", updateRate=100) as sim:
        odometry = sim.subscribe("/pmb2/truth")
        sim.run(0.1)
        published = odometry.latest
        np.testing.assert_array_equal(stamps(odometry.messages), np.arange(1, 11) * 10_000_000)
        assert (published.header.frame_id, published.child_frame_id) == ("world", "arm")
        np.testing.assert_allclose(xyz(published.twist.twist.linear), sim.link("box::arm").linear_velocity, atol=1e-12)
        np.testing.assert_allclose(xyz(published.twist.twist.angular), (0, 0, 0.6), atol=1e-3)


def test_offsets_may_change_during_a_run() -> None:
    with opened(bodyName="base", topicName="truth") as sim:
        odometry = sim.subscribe("/truth")
        (node,) = sim.communication.parameters
        for name, value in (("x_offset", 1.0), ("y_offset", -2.0), ("yaw_offset", 0.25)):
            sim.set_parameter(node, name, value)
        sim.run(0.1)
        published, pose = odometry.latest.pose.pose, sim.link("box::base").pose
    np.testing.assert_allclose(xyz(published.position), pose.position + np.array((1, -2, 0)), atol=1e-12)
    assert yaw(published.orientation) == pytest.approx(pose.rpy[2] + 0.25)


def test_noise_is_a_random_walk_fixed_by_the_seed() -> None:
    def ways(seed: int, listens: bool) -> np.ndarray[Any, Any]:
        with opened(seed, bodyName="base", topicName="truth", gaussian_noise=0.01) as sim:
            early = sim.subscribe("/truth") if listens else None
            sim.run(0.2)
            odometry = early or sim.subscribe("/truth")
            sim.run(0.2)
            return np.array(xyz(odometry.latest.pose.pose.position)) - sim.link("box::base").pose.position

    first = ways(1, True)
    np.testing.assert_array_equal(first, ways(1, False))
    assert 0.02 < np.linalg.norm(first) < 1 and first[2] == 0  # 400 steps of 0.01: 0.2 each
    assert not np.array_equal(first, ways(2, True))


def test_a_missing_link_is_an_error_with_the_closest_name() -> None:
    with pytest.raises(simkit.LoadError, match=r"SK-PLUGIN-003.*'arn'") as caught:
        opened(bodyName="arn", topicName="truth")
    assert "arm" in str(caught.value)
    with pytest.raises(simkit.LoadError, match="SK-PARAM-001.*body_name"):
        opened(topicName="truth")


def test_the_random_walk_continues_after_a_restore() -> None:
    with opened(1, bodyName="base", topicName="truth") as sim:
        (node,) = sim.communication.parameters
        sim.set_parameter(node, "gaussian_noise", 0.01)
        sim.run(0.1)
        snapshot = sim.snapshot()
        sim.run(0.1)
        odometry = sim.subscribe("/truth")
        sim.run(0.01)
        first = xyz(odometry.latest.pose.pose.position)
        sim.set_parameter(node, "gaussian_noise", 0.0)
        odometry.close()
        sim.run(0.1)
        sim.restore(snapshot)
        sim.run(0.1)
        odometry = sim.subscribe("/truth")
        sim.run(0.01)
        np.testing.assert_array_equal(xyz(odometry.latest.pose.pose.position), first)


def test_no_callback_runs_without_subscribers(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[int] = []
    monkeypatch.setattr(GazeboWorldOdometry, "publish", lambda self: calls.append(self.sim.tick))
    with opened(bodyName="base", topicName="truth") as sim:
        sim.run(0.05)
        assert not calls
        odometry = sim.subscribe("/truth")
        sim.run(0.005)
        assert calls == [51, 52, 53, 54, 55]
        odometry.close()
        sim.run(0.05)
        assert len(calls) == 5
