"""Joint trajectories in Gazebo Classic that set positions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from joint_worlds import codes, load, rotor

from simkit import LoadError

ARM = rotor("a") + rotor("b", parent="a")
TOPIC = "/set_joint_trajectory"


def poses(content: str = "") -> str:
    return f'<plugin name="poses" filename="libgazebo_ros_joint_pose_trajectory.so">{content}</plugin>'


def send(sim: Any, points: list[tuple[float, list[float]]], topic: str = TOPIC, frame: str = "world") -> None:
    listed = [{"positions": q, "time_from_start": {"sec": int(t), "nanosec": round((t % 1) * 1e9)}} for t, q in points]
    message = {"header": {"frame_id": frame}, "joint_names": ["j_a", "j_b"], "points": listed}
    sim.publish(topic, message)


def positions(sim: Any) -> list[float]:
    return [sim.joint(f"m::j_{n}").position for n in "ab"]


def test_points_are_set_one_after_another_with_gazebos_times() -> None:
    sim = load(ARM, poses())
    assert sim.topics()[TOPIC] == "trajectory_msgs/msg/JointTrajectory"
    send(sim, [(0.1, [0.3, -0.3]), (0.2, [0.6, 0.0]), (0.0, [0.9, 0.2])])
    seen = []
    for _ in range(400):
        sim.step()
        if not seen or seen[-1][1] != positions(sim):
            seen.append((sim.tick - 1, positions(sim)))
    # at the first update, then 0.1 s later, then another 0.2 s
    assert [q for _, q in seen[1:]] == [[0.3, -0.3], [0.6, 0.0], [0.9, 0.2]]
    assert [tick for tick, _ in seen[1:]] == [10, 100, 300]


def test_points_may_be_set_at_their_own_times() -> None:
    sim = load(ARM, poses("<simkit:point_times>from_start</simkit:point_times><update_rate>0</update_rate>"))
    send(sim, [(0.1, [0.3, 0.0]), (0.2, [0.6, 0.0])])
    seen = []
    for _ in range(300):
        sim.step()
        seen.append(sim.joint("m::j_a").position)
    assert (seen.index(0.3), seen.index(0.6)) == (100, 200)


def test_between_two_points_a_joint_is_free() -> None:
    slider = rotor("a", kind="prismatic") + rotor("b", parent="a")
    sim = load(slider, poses(), gravity="0 0 -10")
    sim.run(0.02)
    send(sim, [(0.0, [1.0, 0.0])])
    sim.step()
    before = sim.joint("m::j_a").position
    assert before == pytest.approx(1.0, abs=1e-3)
    sim.run(0.1)
    assert sim.joint("m::j_a").position < before - 0.04


def test_a_reference_link_may_keep_its_pose() -> None:
    base = "<link name='base'><inertial><mass>1</mass></inertial></link>"
    arm = rotor("a", parent="base") + "<link name='tip'><pose>1 0 0 0 0 0</pose></link>"
    weld = "<joint name='weld' type='fixed'><parent>a</parent><child>tip</child></joint>"
    sim = load(base, arm, rotor("b", parent="a"), weld, poses())
    sim.run(0.02)
    send(sim, [(0.0, [1.0, 0.0])], frame="m::tip")
    sim.step(2)
    np.testing.assert_allclose(sim.link("m::tip").pose.position, [1.0, 0.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(sim.link("m::base").pose.rpy, [0.0, 0.0, -1.0], atol=1e-9)
    assert sim.joint("m::j_a").position == pytest.approx(1.0)


def test_the_spelling_of_ros_1_sets_at_every_step() -> None:
    sim = load(ARM, poses("<robotNamespace>lab</robotNamespace><topicName>go</topicName><updateRate>5</updateRate>"))
    assert len(codes(sim.diagnostics, "SK-PLUGIN-046")) == 1
    send(sim, [(0.0, [0.1, 0.0]), (0.0, [0.2, 0.0])], topic="/lab/go", frame="/map")
    sim.step()
    assert sim.joint("m::j_a").position == pytest.approx(0.1)
    sim.step()
    assert sim.joint("m::j_a").position == pytest.approx(0.2)


def test_an_invalid_trajectory_is_ignored_and_reported() -> None:
    sim = load(ARM, poses())
    send(sim, [(0.0, [1.0, 1.0])], frame="m::aa")
    send(sim, [(0.0, [1.0])])
    sim.publish(TOPIC, {"joint_names": ["j_c"], "points": [{"positions": [1.0]}]})
    sim.run(0.1)
    found = [(d.message, d.hint) for d in sim.diagnostics if d.code == "SK-PLUGIN-041"]
    assert "frame_id 'm::aa'" in found[0][0] and "m::a" in found[0][1]
    assert "no joint 'j_c'" in found[1][0] and "j_" in found[1][1]
    assert positions(sim) == [0.0, 0.0]
    send(sim, [(0.0, [1.0])])
    sim.run(0.1)
    assert any("1 position for 2 joint names" in m for m in codes(sim.diagnostics, "SK-PLUGIN-041"))
    with pytest.raises(LoadError, match="at least 0"):
        load(ARM, poses("<update_rate>-5</update_rate>"))


def test_a_reset_clears_the_trajectory() -> None:
    sim = load(ARM, poses())
    send(sim, [(0.2, [0.3, 0.0]), (0.0, [0.6, 0.0])])
    sim.run(0.1)
    sim.reset()
    sim.run(0.5)
    assert positions(sim) == [0.0, 0.0]


def test_at_a_tiny_rate_no_point_is_set_for_a_long_time() -> None:
    sim = load(ARM, poses("<update_rate>1e-300</update_rate>"))
    send(sim, [(0.0, [0.5, 0.2]), (0.0, [1.0, 0.4])])
    sim.step(20)
    assert positions(sim) == [0.0, 0.0]
