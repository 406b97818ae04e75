"""Each type of joint moves as in theory; loops stay closed; mimic joints follow their leaders."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.errors import InputError

G = 9.8
WEIGHTLESS = "<gravity>0 0 0</gravity>"


def link(name: str, pose: str = "0 0 0 0 0 0", mass: float = 2.0, moments: str = "0.1 0.2 0.3", com: str = "") -> str:
    x, y, z = moments.split()
    place = f"<pose>{com}</pose>" if com else ""
    return (
        f'<link name="{name}"><pose>{pose}</pose><inertial>{place}<mass>{mass}</mass><inertia><ixx>{x}</ixx>'
        f"<iyy>{y}</iyy><izz>{z}</izz></inertia></inertial></link>"
    )


def joint(name: str, kind: str, parent: str, child: str, *axes: str, pose: str = "", more: str = "") -> str:
    """Return a joint; an axis is `x y z`, optionally followed by `|` and further elements of the axis."""
    text = ""
    for tag, axis in zip(("axis", "axis2"), axes, strict=False):
        xyz, _, rest = axis.partition("|")
        text += f"<{tag}><xyz>{xyz}</xyz>{rest}</{tag}>"
    place = f"<pose>{pose}</pose>" if pose else ""
    return (
        f'<joint name="{name}" type="{kind}">{place}<parent>{parent}</parent><child>{child}</child>{text}{more}</joint>'
    )


def world(*content: str, gravity: str = "", name: str = "m", more: str = "") -> str:
    model = f'<model name="{name}">{"".join(content)}</model>'
    return f'<sdf version="1.9"><world name="w">{gravity}{model}{more}</world></sdf>'


def one(kind: str, *axes: str, more: str = "", pose: str = "", gravity: str = WEIGHTLESS, com: str = "") -> Any:
    """Load a link `b` on a joint `j` to the world, without gravity."""
    return simkit.load(
        world(link("b", com=com), joint("j", kind, "world", "b", *axes, more=more, pose=pose), gravity=gravity)
    )


# ------------------------------------------------------------------ one joint, analytic


@pytest.mark.parametrize(("kind", "inertia"), [("revolute", 0.3), ("continuous", 0.3), ("prismatic", 2.0)])
def test_a_constant_effort_accelerates_evenly(kind: str, inertia: float) -> None:
    sim = one(kind, "0 0 1")
    j = sim.joint("m::j")
    for _ in range(500):
        j.set_effort(0.6)
        sim.step()
    assert j.velocity == pytest.approx(0.6 / inertia * 0.5, rel=1e-9)
    # the integrator is of first order: its error is half the travel of one step
    assert j.position == pytest.approx(0.5 * 0.6 / inertia * 0.25, rel=3e-3)


def test_damping_slows_down_exponentially() -> None:
    sim = one("revolute", "0 0 1|<dynamics><damping>0.6</damping></dynamics>")
    j = sim.joint("m::j")
    j.set_velocity(1.0)
    sim.run(1.0)
    assert j.velocity == pytest.approx(math.exp(-0.6 / 0.3), rel=2e-3)


def test_friction_slows_down_evenly_and_then_holds() -> None:
    sim = one("revolute", "0 0 1|<dynamics><friction>0.3</friction></dynamics>")
    j = sim.joint("m::j")
    j.set_velocity(1.0)
    sim.run(0.5)
    assert j.velocity == pytest.approx(0.5, abs=0.01)
    sim.run(1.0)
    assert abs(j.velocity) < 1e-4
    for _ in range(200):
        j.set_effort(0.27)
        sim.step()
    assert abs(j.velocity) < 1e-3


def test_a_spring_oscillates_at_its_natural_frequency_about_its_reference() -> None:
    spring = (
        "0 0 1|<dynamics><spring_stiffness>12</spring_stiffness><spring_reference>0.2</spring_reference></dynamics>"
    )
    sim = one("revolute", spring)
    j = sim.joint("m::j")
    readings = []
    for _ in range(2000):
        sim.step()
        readings.append(j.position)
    assert np.mean(readings) == pytest.approx(0.2, abs=0.02)
    up = [i for i in range(1, 2000) if readings[i - 1] < 0.2 <= readings[i]]
    # the spring is integrated explicitly: no loss in the period
    assert (up[-1] - up[0]) / (len(up) - 1) * 1e-3 == pytest.approx(2 * math.pi * math.sqrt(0.3 / 12), rel=2e-3)


def test_a_limit_stops_and_an_effort_is_clipped() -> None:
    sim = one("revolute", "0 0 1|<limit><lower>-0.2</lower><upper>0.3</upper><effort>0.5</effort></limit>")
    j = sim.joint("m::j")
    for _ in range(100):
        j.set_effort(100.0)
        sim.step()
    assert j.effort == pytest.approx(0.5)
    assert j.velocity == pytest.approx(0.5 / 0.3 * 0.1, rel=1e-6)
    for _ in range(2000):
        j.set_effort(100.0)
        sim.step()
    assert j.position == pytest.approx(0.3, abs=2e-3)


def test_a_ball_joint_turns_about_the_given_vector_in_the_joint_frame() -> None:
    sim = one("ball", pose="0 0 0 0.3 0.4 0.5", com="0 0 0 0.3 0.4 0.5")
    j = sim.joint("m::j")
    j.set_position((0.3, -0.2, 0.4))
    assert j.position == pytest.approx((0.3, -0.2, 0.4), abs=1e-12)
    joint_frame = simkit.Pose.from_rpy(0, 0, 0, 0.3, 0.4, 0.5)
    turned = joint_frame.inverse() @ sim.link("m::b").pose @ joint_frame
    half = np.linalg.norm((0.3, -0.2, 0.4)) / 2
    assert turned.quaternion[0] == pytest.approx(math.cos(half))
    assert turned.quaternion[1:] / turned.quaternion[1] == pytest.approx((1, -0.2 / 0.3, 0.4 / 0.3))
    j.set_position((0, 0, 0))
    for _ in range(100):
        j.set_effort((0, 0, 0.3))
        sim.step()
    # the inertial frame and the joint have the same axes, so the inertia about z is 0.3 kg m²
    assert j.velocity == pytest.approx((0, 0, 0.1), abs=1e-6)
    assert j.effort == pytest.approx((0, 0, 0.3))


def test_the_second_axis_of_a_universal_joint_turns_with_the_first() -> None:
    sim = one("universal", "1 0 0", "0 1 0")
    j = sim.joint("m::j")
    j.set_position((0.5, 0.7))
    expected = simkit.Pose.from_rpy(0, 0, 0, 0.5, 0, 0) @ simkit.Pose.from_rpy(0, 0, 0, 0, 0.7, 0)
    assert sim.link("m::b").pose.quaternion == pytest.approx(expected.quaternion, abs=1e-12)
    assert j.dof == 2


def test_a_screw_advances_by_its_pitch_under_load() -> None:
    sim = one("screw", "0 0 1", more="<screw_thread_pitch>0.05</screw_thread_pitch>", gravity="")
    j, b = sim.joint("m::j"), sim.link("m::b")
    worst = 0.0
    for _ in range(2000):
        j.set_effort(0.4)  # the weight of 19.6 N has a torque of 0.156 N m on the thread
        sim.step()
        z = float(b.pose.position[2])
        if abs(j.position) > 0.5:
            worst = max(worst, abs(z / j.position - 0.05 / (2 * math.pi)) / (0.05 / (2 * math.pi)))
    assert j.position > 1.0
    assert worst < 1e-3
    pitch = 0.05 / (2 * math.pi)
    accelerated = (0.4 - 2.0 * G * pitch) / (0.3 + 2.0 * pitch**2)
    assert j.velocity == pytest.approx(accelerated * 2.0, rel=2e-3)


def test_planar_joints_slide_and_turn(tmp_path: Any) -> None:
    text = f"""<robot name="r"><link name="base"/><link name="b">{URDF_MASS}</link>
    <joint name="j" type="planar"><parent link="base"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>"""
    sim = simkit.load(text, base="fixed")
    j = sim.joint("r::j")
    assert j.dof == 3
    j.set_position((0.4, -0.3, 0.6))
    expected = simkit.Pose.from_rpy(0.4, -0.3, 0, 0, 0, 0.6)
    assert sim.link("r::b").pose.position == pytest.approx(expected.position, abs=1e-12)
    assert sim.link("r::b").pose.quaternion == pytest.approx(expected.quaternion, abs=1e-12)
    sim.run(1.0)
    assert sim.link("r::b").pose.position == pytest.approx(expected.position, abs=1e-9)


URDF_MASS = '<inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'


def test_the_child_of_a_floating_joint_below_a_moving_link_moves_freely() -> None:
    text = f"""<robot name="r"><link name="base">{URDF_MASS}</link><link name="arm">{URDF_MASS}</link>
    <link name="bird">{URDF_MASS}</link>
    <joint name="hinge" type="continuous"><origin xyz="0 0 1"/><parent link="base"/><child link="arm"/>
      <axis xyz="0 0 1"/></joint>
    <joint name="air" type="floating"><origin xyz="0.5 0 0" rpy="0 0 1.5707963267948966"/><parent link="arm"/>
      <child link="bird"/></joint></robot>"""
    sim = simkit.load(text, base="fixed")
    hinge, air, bird = sim.joint("r::hinge"), sim.joint("r::air"), sim.link("r::bird")
    assert (air.dof, len(air.mj_dofs)) == (6, 6)
    assert air.position == pytest.approx((0, 0, 0, 1, 0, 0, 0), abs=1e-12)
    hinge.set_position(0.5)
    air.set_position((0.1, 0.2, 0.3, 1, 0, 0, 0))
    assert air.position == pytest.approx((0.1, 0.2, 0.3, 1, 0, 0, 0), abs=1e-12)
    arm = sim.link("r::arm").pose @ simkit.Pose.from_rpy(0.5, 0, 0, 0, 0, math.pi / 2)
    assert bird.pose.position == pytest.approx((arm @ simkit.Pose((0.1, 0.2, 0.3))).position, abs=1e-12)
    hinge.set_velocity(2.0)
    air.set_velocity((0, 0, 0, 0, 0, 1.0))
    assert air.velocity == pytest.approx((0, 0, 0, 0, 0, 1.0), abs=1e-9)
    assert bird.angular_velocity[2] == pytest.approx(3.0)
    before, snapshot = float(bird.pose.position[2]), sim.snapshot()
    sim.run(0.5)
    fallen = float(bird.pose.position[2])
    assert fallen == pytest.approx(before - G / 8, abs=0.5 * G * 0.5 * 1e-3 + 1e-4)  # half a step's travel too far
    sim.restore(snapshot)
    sim.run(0.5)
    assert float(bird.pose.position[2]) == fallen
    with pytest.raises(InputError, match="apply_wrench"):
        air.set_effort((0, 0, 0, 0, 0, 0))


# ------------------------------------------------------------------ reversed joints


@pytest.mark.parametrize(
    ("kind", "axes", "position"),
    [
        ("revolute", ("0 0.6 0.8",), 0.4),
        ("prismatic", ("0 0.6 0.8",), 0.3),
        ("universal", ("1 0 0", "0 1 0"), (0.4, -0.7)),
        ("revolute2", ("0 0 1", "1 0 0"), (0.4, -0.7)),
        ("ball", (), (0.3, -0.5, 0.2)),
        ("screw", ("0 0 1",), 1.2),
    ],
)
def test_a_joint_reads_the_same_with_a_fixed_parent_and_a_fixed_child(kind: str, axes: Any, position: Any) -> None:
    a, b = link("a", "0.3 0.1 0 0.2 0 0"), link("b", "0.5 0 0.7 0 0.3 0.1")
    j = joint("j", kind, "a", "b", *axes, pose="0.1 0.2 0 0.1 0.2 0.3")
    apart = []
    for held in ("a", "b"):
        sim = simkit.load(world(a, b, j, joint("fix", "fixed", "world", held), gravity=WEIGHTLESS))
        handle = sim.joint("m::j")
        handle.set_position(position)
        assert handle.position == pytest.approx(position, abs=1e-12)
        moved = np.atleast_1d(np.asarray(position, float)) * 0 + (0.5, 0.3, -0.4)[: handle.dof]
        handle.set_velocity(moved if handle.dof > 1 else float(moved[0]))
        relative = sim.link("m::a").pose.inverse() @ sim.link("m::b").pose
        turning = (
            sim.link("m::a")
            .pose.inverse()
            .rotate(sim.link("m::b").angular_velocity - sim.link("m::a").angular_velocity)
        )
        apart.append(
            np.concatenate([relative.position, relative.quaternion * np.sign(relative.quaternion[0]), turning])
        )
    assert apart[0] == pytest.approx(apart[1], abs=1e-9)


# ------------------------------------------------------------------ couplings


def test_a_gearbox_keeps_its_ratio_under_load() -> None:
    sim = simkit.load(
        world(
            link("base"),
            link("b", "1 0 0 0 0 0"),
            link("c", "2 0 0 0 0 0"),
            joint("fix", "fixed", "world", "base"),
            joint("in", "revolute", "base", "b", "0 0 1"),
            joint("out", "revolute", "base", "c", "0 0 1"),
            joint(
                "gear",
                "gearbox",
                "b",
                "c",
                "0 0 1",
                "0 0 1",
                more="<gearbox_ratio>4</gearbox_ratio><gearbox_reference_body>base</gearbox_reference_body>",
            ),
        )
    )
    first, second = sim.joint("m::in"), sim.joint("m::out")
    worst = 0.0
    for _ in range(2000):
        first.set_effort(3.0)
        second.set_effort(0.5)  # a load against the rotation
        sim.step()
        if abs(first.position) > 0.1:
            worst = max(worst, abs(second.position / first.position / -4.0 - 1.0))
    assert worst < 1e-3
    # a torque of 3 - 4 · 0.5 N m accelerates an inertia of 0.3 + 16 · 0.3 kg m²
    assert first.velocity == pytest.approx(1.0 / (17 * 0.3) * 2.0, rel=2e-3)
    first.set_position(0.25)
    assert second.position == pytest.approx(-1.0)


def mimic(leader: str, multiplier: float, offset: float = 0.0, reference: float = 0.0, axis: str = "axis") -> str:
    return (
        f'<mimic joint="{leader}" axis="{axis}"><multiplier>{multiplier}</multiplier><offset>{offset}</offset>'
        f"<reference>{reference}</reference></mimic>"
    )


def test_mimics_follow_through_chains_and_kinds_and_second_axes() -> None:
    sim = simkit.load(
        world(
            link("base"),
            *(link(n, f"{i + 1} 0 0 0 0 0") for i, n in enumerate("bcde")),
            joint("fix", "fixed", "world", "base"),
            joint("cross", "universal", "base", "b", "1 0 0", "0 1 0"),
            joint("slide", "prismatic", "base", "c", f"0 0 1|{mimic('cross', 0.5, 0.1, 0.2, 'axis2')}"),
            joint("last", "revolute", "base", "d", f"0 0 1|{mimic('slide', -3.0, 0.05)}"),
        ),
    )
    cross, slide, last = (sim.joint(f"m::{n}") for n in ("cross", "slide", "last"))
    # the mimic joints have their positions before the first step
    assert slide.position == pytest.approx(0.1 - 0.5 * 0.2)
    assert last.position == pytest.approx(0.05)
    worst = 0.0
    for i in range(2000):
        cross.set_effort((0.0, math.sin(3e-3 * i)))
        last.set_effort(0.2)
        sim.step()
        q = float(np.asarray(cross.position)[1])
        worst = max(worst, abs(slide.position - 0.5 * (q - 0.2) - 0.1), abs(last.position + 3 * slide.position - 0.05))
    assert abs(q) > 0.05
    assert worst < 2e-4
    cross.set_position((0.0, 0.6))
    assert slide.position == pytest.approx(0.5 * 0.4 + 0.1)
    assert last.position == pytest.approx(-3 * 0.3 + 0.05)


def test_the_limits_of_a_mimic_joint_limit_its_leader() -> None:
    sim = simkit.load(
        world(
            link("b"),
            link("c"),
            joint("lead", "revolute", "world", "b", "0 0 1"),
            joint("follow", "revolute", "world", "c", f"0 0 1|<limit><upper>0.4</upper></limit>{mimic('lead', 2.0)}"),
        )
    )
    for _ in range(1500):
        sim.joint("m::lead").set_effort(0.3)
        sim.step()
    assert sim.joint("m::follow").position == pytest.approx(0.4, abs=3e-3)
    assert sim.joint("m::lead").position == pytest.approx(0.2, abs=2e-3)


# ------------------------------------------------------------------ loops

A, B, C, D = (0.0, 0.0), (0.0, 0.4), (1.0, 0.8), (1.0, 0.0)


def bar(name: str, p: Any, q: Any, mass: float) -> str:
    return link(name, f"{(p[0] + q[0]) / 2} 0 {(p[1] + q[1]) / 2} 0 0 0", mass, "0.01 0.02 0.015")


def hinge(name: str, kind: str, parent: str, child: str, at: Any, axis: str = "0 1 0", more: str = "") -> str:
    pose = f'<pose relative_to="__model__">{at[0]} 0 {at[1]} 0 0 0</pose>'
    tags = f"<axis><xyz>{axis}</xyz></axis>" if axis else ""
    return (
        f'<joint name="{name}" type="{kind}">{pose}<parent>{parent}</parent><child>{child}</child>{tags}{more}</joint>'
    )


def linkage(kind: str = "revolute", axis: str = "0 1 0") -> str:
    """Return a four-bar linkage: crank A-B, coupler B-C, rocker D-C; the joint at C closes the loop."""
    return world(
        bar("crank", A, B, 1.0),
        bar("coupler", B, C, 2.0),
        bar("rocker", D, C, 1.0),
        hinge("a", "revolute", "world", "crank", A),
        hinge("b", "revolute", "crank", "coupler", B),
        hinge("d", "revolute", "world", "rocker", D),
        hinge("c", kind, "coupler", "rocker", C, axis),
    )


def angles(crank: float) -> tuple[float, float]:
    """Return the angles of coupler and rocker [rad] about y for an angle of the crank, by the law of cosines.

    Of the two solutions, this is the one in which the file starts.
    """
    b = np.array((0.4 * math.sin(crank), 0.4 * math.cos(crank)))
    to_d = np.array(D) - b
    far, long, short = float(np.hypot(*to_d)), math.hypot(1.0, 0.4), 0.8
    at_b = math.acos((far**2 + long**2 - short**2) / (2 * far * long))
    direction = math.atan2(to_d[1], to_d[0]) + at_b
    c = b + long * np.array((math.cos(direction), math.sin(direction)))
    rocker = math.atan2(c[1], c[0] - 1.0) - math.pi / 2
    return -(direction - math.atan2(0.4, 1.0)), -rocker


def wrapped(angle: float) -> float:
    return (angle + math.pi) % (2 * math.pi) - math.pi


def test_a_four_bar_linkage_stays_closed_under_load_and_its_loop_joint_reads_the_analytic_angle() -> None:
    sim = simkit.load(linkage())
    a, c = sim.joint("m::a"), sim.joint("m::c")
    coupler, rocker = sim.link("m::coupler"), sim.link("m::rocker")
    open_by = off_by = turned = 0.0
    for i in range(10_000):
        a.set_effort(12.0 * math.sin(2e-3 * i) - 2.0 * a.velocity)
        sim.step()
        if i % 10 == 0:
            on_coupler = (coupler.pose @ simkit.Pose((0.5, 0, 0.2))).position
            on_rocker = (rocker.pose @ simkit.Pose((0, 0, 0.4))).position
            open_by = max(open_by, float(np.linalg.norm(on_coupler - on_rocker)))
            by_coupler, by_rocker = angles(a.position)
            off_by = max(off_by, abs(wrapped(by_rocker - by_coupler - c.position)))
            turned = max(turned, abs(a.position))
    assert turned > 5.0
    assert open_by < 1e-4
    assert off_by < 1e-3
    assert sum(sim.mj_model.body_mass) == pytest.approx(4.0)


def test_a_loop_joint_cannot_be_set_but_follows_the_other_joints() -> None:
    sim = simkit.load(linkage())
    c = sim.joint("m::c")
    with pytest.raises(InputError, match="closes a loop"):
        c.set_position(0.1)
    with pytest.raises(InputError, match="closes a loop"):
        c.set_velocity(0.1)
    coupler, rocker = angles(0.8)
    sim.model("m").set_joint_positions({"a": 0.8, "b": coupler - 0.8, "d": rocker})
    assert c.position == pytest.approx(rocker - coupler, abs=1e-9)
    crank = sim.joint("m::a")
    crank.set_velocity(0.0)
    sim.step()
    assert abs(c.velocity) < 0.5  # the loop is still closed
    assert crank.position == pytest.approx(0.8, abs=1e-3)


def test_a_loop_joint_has_limits_damping_and_effort_like_any_other() -> None:
    sim = simkit.load(linkage())
    c, a = sim.joint("m::c"), sim.joint("m::a")
    for _ in range(200):
        c.set_effort(5.0)
        sim.step()
    assert c.velocity > 0.1
    c.upper = c.position + 0.05
    for _ in range(1500):
        c.set_effort(5.0)
        a.set_effort(-3.0 * a.velocity)
        sim.step()
    assert c.position < c.upper + 5e-3


@pytest.mark.parametrize(
    ("kind", "axis", "more", "free"),
    [
        ("fixed", "", "", ()),
        ("revolute", "0 1 0", "", ("ry",)),
        ("continuous", "0 1 0", "", ("ry",)),
        ("prismatic", "1 0 0", "", ("x",)),
        ("ball", "", "", ("rx", "ry", "rz")),
        ("screw", "1 0 0", "<screw_thread_pitch>0.2</screw_thread_pitch>", ("x", "rx")),
    ],
)
def test_a_loop_joint_of_any_type_constrains_the_right_directions(kind: str, axis: str, more: str, free: Any) -> None:
    """Push a body in every direction; only the loop joint constrains the body, which has six free axes of its own."""
    rail = [link(n, mass=0.5, moments="0.05 0.05 0.05") for n in "pqrst"]
    axes = ("prismatic", "1 0 0"), ("prismatic", "0 1 0"), ("prismatic", "0 0 1"), ("revolute", "1 0 0")
    axes = *axes, ("revolute", "0 1 0"), ("revolute", "0 0 1")
    names = ["world", *"pqrst", "body"]
    chain = [joint(f"g{i}", k, names[i], names[i + 1], xyz) for i, (k, xyz) in enumerate(axes)]
    tags = f"<axis><xyz>{axis}</xyz></axis>" if axis else ""
    closing = f'<joint name="loop" type="{kind}"><parent>world</parent><child>body</child>{tags}{more}</joint>'
    sim = simkit.load(world(*rail, link("body"), *chain, closing, gravity=WEIGHTLESS))
    body, loop = sim.link("m::body"), sim.joint("m::loop")
    for _ in range(300):
        body.apply_wrench((1.0, 2.0, 3.0), (0.04, 0.05, 0.06))
        sim.step()
    moved = dict(zip(("x", "y", "z", "rx", "ry", "rz"), (*body.pose.position, *body.pose.rpy), strict=True))
    for name, value in moved.items():
        if name in free:
            assert abs(value) > 4e-4, name
        else:
            assert abs(value) < 1e-4, name
    if kind == "screw":
        assert moved["x"] == pytest.approx(0.2 / (2 * math.pi) * moved["rx"], rel=1e-2)
    if len(free) == 1:
        assert loop.position == pytest.approx(moved[free[0]], abs=1e-5)
    if kind == "fixed":
        body.apply_wrench((1.0, 2.0, 3.0), (0.04, 0.05, 0.06))
        force, torque = loop.transmitted_wrench
        assert force == pytest.approx((-1, -2, -3), abs=1e-3)
        assert torque == pytest.approx((-0.04, -0.05, -0.06), abs=1e-3)


# ------------------------------------------------------------------ between models


def pair(kind: str = "revolute", axis: str = "0 0 1") -> str:
    models = "".join(
        f'<model name="{n}"><pose>{x} 0 1 0 0 0</pose>{link("l")}</model>' for n, x in (("a", 0), ("b", 1))
    )
    tags = f"<axis><xyz>{axis}</xyz></axis>" if axis else ""
    tie = f'<joint name="tie" type="{kind}"><parent>a::l</parent><child>b::l</child>{tags}</joint>'
    return f'<sdf version="1.9"><world name="w">{WEIGHTLESS}{models}{tie}</world></sdf>'


def test_a_joint_of_the_world_connects_two_models_until_one_is_removed() -> None:
    sim = simkit.load(pair())
    tie, a, b = sim.joint("tie"), sim.link("a::l"), sim.link("b::l")
    for _ in range(500):
        tie.set_effort(0.1)
        a.apply_wrench((0, 3.0, 0))
        sim.step()
    assert tie.position > 0.02
    pivot = a.pose @ simkit.Pose((1, 0, 0))
    assert b.pose.position == pytest.approx(pivot.position, abs=1e-4)
    turned = (a.pose.inverse() @ b.pose).rpy[2]
    assert tie.position == pytest.approx(turned, abs=1e-5)
    sim.spawn(f'<sdf version="1.9"><model name="c"><pose>5 0 0 0 0 0</pose>{link("l")}</model></sdf>')
    assert tie.position == pytest.approx(turned, abs=1e-5)
    sim.remove("b")
    with pytest.raises(InputError, match="removed"):
        tie.position  # noqa: B018
    assert float(sum(sim.mj_model.body_mass)) == pytest.approx(4.0)
    sim.step(10)
    sim.reset()
    sim.step(10)
    assert sim.joint("tie").position == pytest.approx(0.0, abs=1e-9)


def test_moving_one_of_two_connected_models_does_not_break_the_joint() -> None:
    sim = simkit.load(pair())
    sim.model("a").set_pose(simkit.Pose.from_rpy(1, -1, 1, 0, 0, math.pi / 2))
    assert sim.joint("tie").position == pytest.approx(-math.pi / 2, abs=1e-9)
    sim.run(0.1)
    assert np.linalg.norm(sim.link("b::l").linear_velocity) < 1e-3
