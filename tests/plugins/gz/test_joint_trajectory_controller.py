"""Trajectories of joints."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from joint_worlds import INERTIA, codes, load, rotor, trajectory

from simkit import LoadError

A, B = "<joint_name>j_a</joint_name>", "<joint_name>j_b</joint_name>"
TOPIC = "/model/m/joint_trajectory"


def at(seconds: float, **fields: list[float]) -> dict[str, Any]:
    whole = int(seconds)
    return {**fields, "time_from_start": {"sec": whole, "nanosec": round((seconds - whole) * 1e9)}}


def send(sim: Any, names: list[str], *points: dict[str, Any], **header: int) -> None:
    sim.publish(TOPIC, {"header": {"stamp": header}, "joint_names": names, "points": list(points)})


def servo(kind: str, count: int = 1) -> str:
    """Return gains that reach a position within milliseconds."""
    return (f"<{kind}_p_gain>2000</{kind}_p_gain><{kind}_d_gain>40</{kind}_d_gain>") * count


def test_efforts_change_on_the_step_after_the_time_of_a_point() -> None:
    sim = load(rotor("a"), trajectory(A))
    sim.step()
    send(sim, ["j_a"], at(0.1, effort=[0.4]), at(0.3, effort=[-0.2]))
    sim.step(101)  # at 0 … 0.1 s after the start
    assert sim.joint("m::j_a").velocity == pytest.approx(0.4 / INERTIA * 0.101, rel=1e-9)
    sim.step(100)
    assert sim.joint("m::j_a").velocity == pytest.approx((0.4 * 0.101 - 0.2 * 0.1) / INERTIA, rel=1e-9)
    sim.step(500)  # the last point is held
    assert sim.joint("m::j_a").velocity == pytest.approx((0.4 * 0.101 - 0.2 * 0.6) / INERTIA, rel=1e-9)


def test_the_progress_is_published_when_the_target_changes() -> None:
    sim = load(rotor("a"), trajectory(A))
    progress = sim.subscribe(f"{TOPIC}_progress")
    assert sim.topics()[f"{TOPIC}_progress"] == "std_msgs/msg/Float32"
    when = []
    send(sim, ["j_a"], *(at(t, positions=[0.0]) for t in (0.1, 0.2, 0.3, 0.4)))
    for k in range(500):
        sim.step()
        when += [k] * (len(progress.messages) - len(when))
    assert [m.data for m in progress.messages] == pytest.approx([0.25, 0.5, 0.75, 1.0])
    assert when == [0, 101, 201, 301]


def test_positions_velocities_and_efforts_add_up_and_missing_fields_keep_their_targets() -> None:
    gains = "<position_p_gain>3</position_p_gain><velocity_p_gain>0.5</velocity_p_gain>"
    sim = load(rotor("a"), trajectory(A + gains))
    sim.step()
    send(sim, ["j_a"], at(0.0, positions=[1.0]), at(0.001, velocities=[2.0], effort=[0.1]), at(9.0))
    q = v = 0.0
    for k in range(200):
        target = 2.0 if k else 0.0
        v += 0.001 * (3.0 * (1.0 - q) + 0.5 * (target - v) + (0.1 if k else 0.0)) / INERTIA
        q += 0.001 * v
    sim.step(200)
    assert sim.joint("m::j_a").position == pytest.approx(q, abs=1e-9)


def test_numbers_are_for_the_joints_in_the_order_of_their_names() -> None:
    sim = load(rotor("a"), rotor("b"), trajectory(
        f"{B}<position_p_gain>10</position_p_gain><position_d_gain>3</position_d_gain>"
        f"{A}<position_p_gain>0</position_p_gain><initial_position>0.5</initial_position>"
    ))  # fmt: skip
    sim.run(2.0)
    assert sim.joint("m::j_b").position == pytest.approx(0.5, abs=1e-3)
    assert sim.joint("m::j_a").position == 0.0


def test_without_names_all_joints_with_one_axis_are_controlled() -> None:
    ball = rotor("c", kind="ball")
    sim = load(rotor("a"), ball, rotor("b"), trajectory(servo("position", 2)))
    send(sim, ["j_b", "j_a"], at(0.0, positions=[0.2, -0.1]))
    sim.run(1.0)
    assert [sim.joint(f"m::j_{n}").position for n in "ab"] == pytest.approx([-0.1, 0.2], abs=1e-4)


def test_a_new_trajectory_replaces_the_active_one() -> None:
    sim = load(rotor("a"), trajectory(A + servo("position")))
    send(sim, ["j_a"], at(1.0, positions=[1.0]), at(2.0, positions=[2.0]))
    sim.run(0.5)
    send(sim, ["j_a"], at(1.0, positions=[-1.0]))
    sim.run(3.0)
    assert sim.joint("m::j_a").position == pytest.approx(-1.0, abs=1e-4)


@pytest.mark.parametrize("spelling", ["<use_header_start_time>true</use_header_start_time>", "attribute"])
def test_the_header_can_define_the_start_time(spelling: str) -> None:
    element = trajectory(A + servo("position"))
    if spelling == "attribute":
        element = element.replace("<plugin ", '<plugin use_header_start_time="true" ')
    else:
        element = trajectory(A + servo("position") + spelling)
    sim = load(rotor("a"), element)
    send(sim, ["j_a"], at(0.1, positions=[1.0]), at(0.2, positions=[2.0]), sec=1, nanosec=0)
    sim.run(0.9)
    assert sim.joint("m::j_a").position == 0.0
    sim.run(0.19)
    assert sim.joint("m::j_a").position == pytest.approx(1.0, abs=0.02)
    sim.run(0.5)
    assert sim.joint("m::j_a").position == pytest.approx(2.0, abs=1e-3)
    send(sim, ["j_a"], at(0.1, positions=[5.0]), at(9.0, positions=[3.0]), sec=1, nanosec=0)
    sim.run(0.5)  # points in the past are skipped
    assert sim.joint("m::j_a").position == pytest.approx(3.0, abs=0.02)


@pytest.mark.parametrize("rule", ["linear", "cubic", "quintic"])
def test_interpolation_moves_the_joint_smoothly_between_two_points(rule: str) -> None:
    smooth = f"<simkit:interpolation>{rule}</simkit:interpolation><velocity_p_gain>40</velocity_p_gain>"
    element = trajectory(A + "<position_p_gain>2000</position_p_gain>" + smooth)
    sim = load(rotor("a"), element)
    sim.step()
    send(sim, ["j_a"], at(1.0, positions=[1.0]))
    found = []
    for _ in range(1000):
        sim.step()
        found.append(sim.joint("m::j_a").position)
    s = np.arange(1, 1001) / 1000.0
    target = {"linear": s, "cubic": 3 * s**2 - 2 * s**3, "quintic": 10 * s**3 - 15 * s**4 + 6 * s**5}[rule]
    # the error is that of the acceleration, I a / p, at most 0.2 · 6 / 2000, and the jump of the linear rule
    assert np.abs(np.array(found) - target).max() < (0.02 if rule == "linear" else 2.5e-3)


def test_unusable_trajectories_are_ignored_and_reported() -> None:
    sim = load(rotor("a"), trajectory(A + servo("position")))
    send(sim, ["j_a", "j_aa"], at(0.0, positions=[0.3, 1.0]))
    sim.run(0.5)
    assert sim.joint("m::j_a").position == pytest.approx(0.3, abs=1e-3)
    send(sim, ["j_a"], at(1.0, positions=[1.0]), at(0.5, positions=[2.0]))
    send(sim, ["j_a"], at(1.0, positions=[float("nan")]))
    send(sim, [], at(0.0))
    send(sim, ["j_a"])
    sim.run(0.5)
    assert sim.joint("m::j_a").position == pytest.approx(0.3, abs=1e-4)
    found = codes(sim.diagnostics, "SK-PLUGIN-041")
    assert [any(word in m for m in found) for word in ("'j_aa'", "at 0.5 s", "NaN or infinite", "names no joints")] == [
        True
    ] * 4
    (unknown,) = [d for d in sim.diagnostics if "'j_aa'" in d.message]
    assert "j_a" in unknown.hint
    send(sim, ["j_a"], at(0.0, positions=[0.3], accelerations=[1.0]))
    sim.step()
    assert len(codes(sim.diagnostics, "SK-PLUGIN-045")) == 1


def test_wrong_elements_are_reported_together() -> None:
    with pytest.raises(LoadError) as caught:
        load(rotor("a"), rotor("c", kind="ball"), trajectory(
            "<joint_name>j_aa</joint_name><joint_name>j_c</joint_name><position_p_gain>much</position_p_gain>"
            "<simkit:interpolation>cubik</simkit:interpolation>"
        ))  # fmt: skip
    text = str(caught.value)
    assert "no joint 'j_aa'" in text and "is ball" in text
    with pytest.raises(LoadError, match="cubik"):
        load(rotor("a"), trajectory("<simkit:interpolation>cubik</simkit:interpolation>"))
    with pytest.raises(LoadError, match="needs a joint with one axis"):
        load(rotor("a", kind="ball"), trajectory(""))
    twice = load(rotor("a"), trajectory(A + A + servo("position", 2)))
    assert len(codes(twice.diagnostics, "SK-PLUGIN-044")) == 3  # the name, and both numbers


def test_gains_are_live() -> None:
    sim = load(rotor("a"), trajectory(A + "<initial_position>1</initial_position>", name="follow"))
    assert len(sim.communication.parameters["/follow"]) == 16
    sim.run(0.5)
    assert sim.joint("m::j_a").position == 0.0
    sim.set_parameter("/follow", "j_a.position_p_gain", 2000.0)
    sim.set_parameter("/follow", "j_a.position_d_gain", 40.0)
    sim.run(1.0)
    assert sim.joint("m::j_a").position == pytest.approx(1.0, abs=1e-4)
    sim.reset()
    sim.run(0.5)
    assert sim.joint("m::j_a").position == 0.0


def test_a_snapshot_during_a_trajectory_continues_bit_for_bit() -> None:
    smooth = "<simkit:interpolation>cubic</simkit:interpolation>"
    sim = load(rotor("a"), trajectory(A + servo("position") + smooth))
    send(sim, ["j_a"], at(0.3, positions=[1.0]), at(0.6, positions=[-1.0]))
    sim.run(0.2)
    kept = sim.snapshot()
    sim.run(0.3)
    end = sim.joint("m::j_a").position
    sim.run(0.2)
    sim.restore(kept)
    sim.run(0.3)
    assert sim.joint("m::j_a").position == end
