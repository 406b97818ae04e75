"""Every kind of joint, loops, couplings."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest

import simkit
from simkit.compiler import SpecBuilder
from simkit.compiler.kinematic_tree import plan_tree
from simkit.diagnostics import Diagnostics, Where
from simkit.pose import IDENTITY, Pose
from simkit.scene import Axis, Inertial, Mimic, SceneJoint, Sphere

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def joint(name, kind, parent, child, pose=IDENTITY, *axes, **more):
    """A joint of model `m`; axes are `Axis` or world directions."""
    made = tuple(a if isinstance(a, Axis) else Axis(a, a) for a in axes)
    ends = [e if e == "world" else f"m::{e}" for e in (parent, child)]
    return SceneJoint(name, f"m::{name}", kind, *ends, pose, made, **more)


def chain(make, *joints, links=("a", "b"), poses=None, **more):
    poses = poses or {}
    made = [make.link(f"m::{n}", pose=poses.get(n, Pose((i, 0, 0)))) for i, n in enumerate(links)]
    return make.model("m", *made, joints=joints, **more)


@pytest.mark.parametrize(
    ("kind", "axes", "dofs"),
    [
        ("fixed", (), 0),
        ("revolute", (Z,), 1),
        ("continuous", (Z,), 1),
        ("prismatic", (Z,), 1),
        ("ball", (), 3),
        ("universal", (X, Y), 2),
        ("revolute2", (X, Y), 2),
        ("planar", (Z,), 3),
        ("screw", (Z,), 1),
        ("floating", (), 6),
    ],
)
def test_each_kind_has_its_degrees_of_freedom(make, compiled, kind, axes, dofs):
    c = compiled(chain(make, joint("base", "fixed", "world", "a"), joint("j", kind, "a", "b", Pose((1, 0, 0)), *axes)))
    binding = c.names.joint("m::j")
    assert (binding.type, len(binding.dofs)) == (kind, dofs)
    assert c.model.nv == dofs + len(binding.followers)


def test_anchor_and_axis_are_those_of_the_joint_frame(make, compiled):
    pose = Pose.from_rpy(0.4, 0.1, 0.2, -1.57, 0, 0)
    axis = tuple(float(v) for v in pose.rotate(Z))
    model = chain(
        make,
        joint("base", "fixed", "world", "a"),
        joint("j", "revolute", "a", "b", pose, axis),
        poses={"b": Pose.from_rpy(1, 0, 0, 0.5, 0.2, 0.1)},
    )
    c = compiled(model)
    mujoco.mj_forward(c.model, c.data)
    (number,) = c.names.joint("m::j").joint_ids
    np.testing.assert_allclose(c.data.xanchor[number], pose.position, atol=1e-12)
    np.testing.assert_allclose(c.data.xaxis[number], (0, 0.9999997, 0.000796), atol=1e-6)


def test_a_link_without_joint_is_free_and_fixed_to_the_world_is_not(make, compiled):
    free = compiled(chain(make, links=("a",)))
    assert free.names.link("m::a").root_joint_qpos == 0
    tied = compiled(chain(make, joint("j", "fixed", "world", "a"), links=("a",)))
    assert tied.model.nv == 0
    assert compiled(chain(make, links=("a",), base="fixed")).model.nv == 0


def test_a_joint_whose_child_hangs_on_the_world_is_turned_round(make, compiled):
    pose = Pose((0.5, 0, 0))
    model = chain(make, joint("j", "revolute", "a", "b", pose, Z), joint("base", "fixed", "world", "b"))
    c = compiled(model)
    binding = c.names.joint("m::j")
    assert binding.is_reversed
    assert c.model.nv == 1
    assert c.model.neq == 0
    c.data.qpos[binding.qpos[0]] = 0.3
    mujoco.mj_forward(c.model, c.data)
    a, b = (c.data.xmat[c.names.link(f"m::{n}").body].reshape(3, 3) for n in "ab")
    relative = a.T @ b
    assert math.atan2(relative[1, 0], relative[0, 0]) == pytest.approx(0.3)


def test_limits_damping_friction_and_spring_are_kept(make, compiled):
    axis = Axis(Z, Z, lower=-0.5, upper=1.0, damping=0.2, friction=0.1, stiffness=3.0, spring_ref=0.4)
    c = compiled(chain(make, joint("base", "fixed", "world", "a"), joint("j", "revolute", "a", "b", Pose(), axis)))
    m = c.model
    np.testing.assert_allclose(m.jnt_range[0], (-0.5, 1.0))
    assert bool(m.jnt_limited[0])
    assert m.dof_damping[0] == pytest.approx(0.2)
    assert m.dof_frictionloss[0] == pytest.approx(0.1)
    assert m.jnt_stiffness[0] == pytest.approx(3.0)
    assert m.qpos_spring[0] == pytest.approx(0.4)


def test_a_joint_without_range_is_held(make, compiled):
    axis = Axis(Y, Y, lower=0.0, upper=0.0)
    c = compiled(chain(make, joint("base", "fixed", "world", "a"), joint("j", "revolute", "a", "b", Pose(), axis)))
    mujoco.mj_step(c.model, c.data, 1000)
    assert abs(c.data.qpos[0]) < 2e-3


def test_a_mimic_follows_its_leader(make, compiled):
    follower = Axis(Z, Z, mimic=Mimic("m::lead", 0, multiplier=-2.0, offset=0.1, reference=0.05))
    model = chain(
        make,
        joint("base", "fixed", "world", "a"),
        joint("follow", "revolute", "a", "c", Pose((2, 0, 0)), follower),
        joint("lead", "revolute", "a", "b", Pose((1, 0, 0)), Z),
        links=("a", "b", "c"),
    )
    c = compiled(model)
    lead, follow = (c.names.joint(f"m::{n}") for n in ("lead", "follow"))
    c.data.qfrc_applied[lead.dofs[0]] = 0.05
    mujoco.mj_step(c.model, c.data, 500)
    q = float(c.data.qpos[lead.qpos[0]])
    assert abs(q) > 0.02
    assert c.data.qpos[follow.qpos[0]] == pytest.approx(-2.0 * (q - 0.05) + 0.1, abs=1e-3)


def test_a_screw_advances_by_its_pitch_under_load(make, compiled):
    model = chain(
        make, joint("base", "fixed", "world", "a"), joint("j", "screw", "a", "b", Pose((1, 0, 0)), Z, thread_pitch=0.1)
    )
    c = compiled(model)
    binding = c.names.joint("m::j")
    mujoco.mj_step(c.model, c.data, 1000)
    turned = float(c.data.qpos[binding.qpos[0]])
    slid = float(c.data.qpos[binding.followers[0].qpos])
    assert slid < -0.01
    assert slid / turned == pytest.approx(0.1 / (2 * math.pi), rel=1e-3)


def test_a_gearbox_turns_backwards_by_its_ratio(make, compiled):
    model = chain(
        make,
        joint("base", "fixed", "world", "a"),
        joint("in", "revolute", "a", "b", Pose((1, 0, 0)), Z),
        joint("out", "revolute", "a", "c", Pose((2, 0, 0)), Z),
        joint("gear", "gearbox", "b", "c", Pose(), Z, Z, gearbox_ratio=5.0, gearbox_reference="m::a"),
        links=("a", "b", "c"),
    )
    c = compiled(model)
    first, second = c.names.joint("m::in"), c.names.joint("m::out")
    c.data.qfrc_applied[first.dofs[0]] = 0.5
    mujoco.mj_step(c.model, c.data, 500)
    q = float(c.data.qpos[first.qpos[0]])
    assert q > 0.1
    assert c.data.qpos[second.qpos[0]] == pytest.approx(-5.0 * q, rel=1e-3)


def test_a_loop_is_closed_by_a_constraint_and_reported(make):
    found = Diagnostics()
    poses = {"a": Pose((0.5, 0, 0)), "b": Pose((1, 0, 0.5)), "c": Pose((0.5, 0, 1.0))}
    model = chain(
        make,
        joint("left", "revolute", "world", "c", Pose((0, 0, 1.0)), Y),
        joint("foot", "revolute", "world", "a", Pose((0, 0, 0)), Y),
        joint("knee", "revolute", "a", "b", Pose((1, 0, 0)), Y),
        joint("top", "revolute", "c", "b", Pose((1, 0, 1)), Y),
        links=("a", "b", "c"),
        poses=poses,
    )
    c = SpecBuilder(make.world(model), found).compile()
    assert c.names.joint("m::top").is_loop
    assert c.model.neq == 1
    assert c.model.body_mass.sum() == pytest.approx(3.0)
    mujoco.mj_step(c.model, c.data, 500)
    b, top = c.names.link("m::b").body, c.names.link("m::c").body
    on_b = c.data.xpos[b] + c.data.xmat[b].reshape(3, 3) @ (0, 0, 0.5)
    on_c = c.data.xpos[top] + c.data.xmat[top].reshape(3, 3) @ (0.5, 0, 0)
    assert np.linalg.norm(on_b - on_c) < 1e-3
    assert "SK-PHYS-020" in [d.code for d in found]


def test_a_ring_of_joints_still_has_a_root(make):
    model = chain(make, joint("ab", "ball", "a", "b"), joint("ba", "ball", "b", "a"))
    tree = plan_tree(model.links, model.joints)
    assert [link.name for link in tree.order] == ["a", "b"]
    assert [j.name for j in tree.loops] == ["ba"]


def test_joints_of_a_static_model_are_known_by_name(make, compiled):
    c = compiled(chain(make, joint("j", "revolute", "a", "b", Pose(), Z), static=True))
    assert c.names.joint("m::j").dofs == ()
    assert c.model.nv == 0


# ------------------------------------------------------------------ links without mass


NOTHING = Inertial(0.0, (0.0, 0.0, 0.0), (0.0,) * 6, given=False)


def found_of(make, model, **more):
    found = Diagnostics()
    compiled = SpecBuilder(make.world(model, **more), found).compile()
    return compiled, [d.code for d in found]


def test_a_frame_on_a_fixed_joint_weighs_nothing_and_stands_where_it_should(make, compiled):
    frame = make.link("m::f", pose=Pose.from_rpy(0.5, 0, 0, 0, 0, 0.3), inertial=NOTHING)
    model = make.model("m", make.link("m::a"), frame, joints=(joint("j", "fixed", "a", "f"),))
    c = compiled(model)
    assert c.model.body_mass.sum() == pytest.approx(1.0)
    mujoco.mj_step(c.model, c.data, 100)
    a, f = c.names.link("m::a").body, c.names.link("m::f").body
    np.testing.assert_allclose(c.data.xpos[f] - c.data.xpos[a], (0.5, 0, 0), atol=1e-12)


def test_a_root_frame_floats_on_the_mass_that_is_fixed_to_it(make, compiled):
    root = make.link("m::root", inertial=NOTHING)
    deeper = make.link("m::mid", inertial=NOTHING)
    joints = (joint("j", "fixed", "root", "mid"), joint("k", "fixed", "mid", "a"))
    c = compiled(make.model("m", root, deeper, make.link("m::a", pose=Pose((0, 0, 1)), mass=3.0), joints=joints))
    mujoco.mj_step(c.model, c.data, 1000)
    assert c.model.body_mass.sum() == pytest.approx(3.0)
    assert c.data.qpos[2] == pytest.approx(-4.9, abs=0.01)


def test_a_massless_link_between_two_moving_joints_carries_what_hangs_on_it(make, compiled):
    """Two crossed hinges with nothing between them swing like the universal joint they are."""
    between = make.link("m::x", inertial=NOTHING)
    load = make.link("m::b", pose=Pose((0.3, 0, -1)), inertial=Inertial(2.0, (0, 0, 0), (0.1, 0.2, 0.3, 0, 0, 0)))
    hinges = make.model(
        "m",
        between,
        load,
        joints=(joint("j", "revolute", "world", "x", Pose(), X), joint("k", "revolute", "x", "b", Pose(), Y)),
    )
    cross = make.model("m", load, joints=(joint("j", "universal", "world", "b", Pose(), X, Y),))
    one, two = compiled(hinges), compiled(cross)
    for c in (one, two):
        c.data.qvel[:] = (0.4, -0.3)
        mujoco.mj_step(c.model, c.data, 1000)
    np.testing.assert_allclose(one.data.qpos, two.data.qpos, atol=1e-6)


@pytest.mark.parametrize(
    ("kind", "armature"), [("revolute", 1e-4), ("prismatic", 1e-2), ("ball", 1e-4), ("universal", 1e-4)]
)
def test_a_joint_that_moves_nothing_with_mass_gets_an_armature(make, kind, armature):
    axes = {"ball": (), "universal": (X, Y)}.get(kind, (Z,))
    tip = make.link("m::tip", inertial=NOTHING)
    hinge = joint("j", kind, "a", "tip", Pose(), *axes, where=Where("robot.urdf", 17))
    found = Diagnostics()
    builder = SpecBuilder(make.world(make.model("m", make.link("m::a"), tip, joints=(hinge,))), found)
    c = builder.compile()
    (problem,) = found
    assert (problem.severity, problem.code, problem.file, problem.line) == ("warning", "SK-JOINT-016", "robot.urdf", 17)
    assert "m::tip" in problem.message
    assert "m::j" in problem.message
    assert f"{armature:g}" in problem.message
    np.testing.assert_array_equal(c.model.dof_armature[list(c.names.joint("m::j").dofs)], armature)
    builder.compile()
    assert len(found) == 1


def test_a_link_without_mass_leaves_the_dynamics_of_the_rest_alone(make, compiled):
    """A finger without mass, driven to its stop, does not move the arm that carries it."""
    arm = make.link("m::arm", pose=Pose((1, 0, 0)))
    tip = make.link("m::tip", pose=Pose((1, 0, 0)), inertial=NOTHING)
    joints = (
        joint("j", "revolute", "world", "arm", Pose(), Y),
        joint("k", "revolute", "arm", "tip", Pose((1, 0, 0)), Y),
    )
    bare, both = (compiled(make.model("m", *ls, joints=joints[: len(ls)])) for ls in ((arm,), (arm, tip)))
    for c in (bare, both):
        mujoco.mj_step(c.model, c.data, 500)
    assert both.data.qpos[0] == pytest.approx(bare.data.qpos[0], abs=1e-6)
    assert np.isfinite(both.data.qpos).all()


def test_a_massless_link_whose_load_turns_by_itself_gets_an_armature(make):
    """Both hinges have one axis, so nothing that hangs on the frame weighs on its own hinge."""
    frame = make.link("m::f", inertial=NOTHING)
    hinges = (joint("j", "revolute", "a", "f", Pose(), Z), joint("k", "revolute", "f", "b", Pose(), Z))
    model = make.model("m", make.link("m::a"), frame, make.link("m::b"), joints=hinges)
    assert found_of(make, model)[1].count("SK-JOINT-016") == 1


def test_a_model_without_any_mass_is_an_error_unless_its_base_is_fixed(make):
    a, b = make.link("m::a", inertial=NOTHING), make.link("m::b", inertial=NOTHING)
    fix = (joint("j", "fixed", "a", "b"),)
    assert "SK-JOINT-010" in found_of(make, make.model("m", a, b, joints=fix))[1]
    assert "SK-JOINT-010" not in found_of(make, make.model("m", a, b, joints=fix, base="fixed"))[1]


# ------------------------------------------------------------------ nonsense


def hinged(make, axis):
    return chain(make, joint("base", "fixed", "world", "a"), joint("j", "revolute", "a", "b", Pose(), axis))


@pytest.mark.parametrize(
    ("axis", "code"),
    [
        (Axis((0.0, 0.0, 0.0), Z), "SK-JOINT-002"),
        (Axis((0.0, 0.0, math.nan), Z), "SK-JOINT-003"),
        (Axis(Z, Z, damping=math.inf), "SK-JOINT-003"),
        (Axis(Z, Z, lower=math.nan), "SK-JOINT-003"),
        (Axis(Z, Z, lower=1.0, upper=-1.0), "SK-JOINT-006"),
        (Axis(Z, Z, velocity=0.0), "SK-JOINT-008"),
        (Axis(Z, Z, friction=-1.0), "SK-JOINT-009"),
        (Axis(Z, Z, lower=-1.0, upper=1.0, limit_stiffness=10.0), "SK-JOINT-014"),
    ],
)
def test_an_axis_that_cannot_be_meant_is_reported(make, axis, code):
    assert code in found_of(make, hinged(make, axis))[1]


def test_a_motor_without_effort_is_reported(make):
    found = Diagnostics()
    builder = SpecBuilder(make.world(hinged(make, Axis(Z, Z, effort=0.0))), found)
    builder.add_velocity_servo("m::j", max_effort=5.0, owner="drive")
    assert "SK-JOINT-011" in [d.code for d in found]


def test_joints_that_mimic_each_other_are_an_error(make):
    a, b = (Axis(Z, Z, mimic=Mimic(f"m::{n}")) for n in ("second", "first"))
    model = chain(
        make,
        joint("first", "revolute", "world", "a", Pose(), a),
        joint("second", "revolute", "world", "b", Pose(), b),
    )
    codes = found_of(make, model)[1]
    assert "SK-JOINT-001" in codes


def test_a_gearbox_whose_axes_lie_across_its_joints_is_left_out(make):
    model = chain(
        make,
        joint("base", "fixed", "world", "a"),
        joint("in", "revolute", "a", "b", Pose((1, 0, 0)), X),
        joint("out", "revolute", "a", "c", Pose((2, 0, 0)), Z),
        joint("gear", "gearbox", "b", "c", Pose(), Z, Z, gearbox_ratio=5.0, gearbox_reference="m::a"),
        links=("a", "b", "c"),
    )
    c, codes = found_of(make, model)
    assert "SK-PHYS-021" in codes
    assert c.model.neq == 0


def test_a_joint_between_two_static_links_is_reported(make):
    door = SceneJoint("door", "door", "revolute", "a::link", "b::link", Pose(), (Axis(Z, Z),))
    a, b = (make.model(n, make.link(f"{n}::link"), static=True) for n in "ab")
    found = Diagnostics()
    c = SpecBuilder(make.world(a, b, joints=(door,)), found).compile()
    assert "SK-JOINT-004" in [d.code for d in found]
    assert c.names.joint("door").dofs == ()


# ------------------------------------------------------------------ large models


@pytest.mark.slow
def test_long_chains_and_many_joints_are_built_within_seconds(make, compiled):
    long = [make.link(f"m::l{i}", pose=Pose((0.1 * i, 0, 0))) for i in range(300)]
    ties = tuple(joint(f"j{i}", "revolute", f"l{i}", f"l{i + 1}", Pose((0.1 * i, 0, 0)), Y) for i in range(299))
    assert compiled(make.model("m", *long, joints=ties)).model.nv == 305
    many = [make.link(f"m::l{i}", Sphere(0.01), pose=Pose((0.1 * i, 0, 0))) for i in range(2001)]
    star = tuple(joint(f"j{i}", "revolute", "l0", f"l{i}", Pose((0.1 * i, 0, 0)), Y) for i in range(1, 2001))
    c = compiled(make.model("m", *many, joints=star))
    assert c.model.njnt == 2001
    assert c.model.nexclude == 0


def test_a_chain_deeper_than_the_engine_takes_is_an_error(make):
    long = [make.link(f"m::l{i}") for i in range(1200)]
    ties = tuple(joint(f"j{i}", "fixed", f"l{i}", f"l{i + 1}") for i in range(1199))
    found = Diagnostics()
    SpecBuilder(make.world(make.model("m", *long, joints=ties)), found)
    assert [d.code for d in found] == ["SK-JOINT-015"]


@pytest.mark.parametrize(("step", "most"), [(0.0005, 1e-4), (0.001, 2e-4), (0.002, 6e-4)])
def test_a_four_bar_that_turns_at_35_radians_a_second_stays_closed(step, most):
    """Crank 0.1 m, coupler 0.3 m, rocker 0.25 m, ground 0.3 m; a heavy crank holds the speed."""
    crank, coupler, rocker, ground = 0.1, 0.3, 0.25, 0.3
    across = math.hypot(crank, ground)
    turn = math.acos((coupler**2 + across**2 - rocker**2) / (2 * coupler * across)) - math.atan2(crank, ground)
    end = np.array([coupler * math.cos(turn), crank + coupler * math.sin(turn)])
    lean = math.atan2(end[1], end[0] - ground)

    def link(name, x, y, yaw, length, inertia):
        return (
            f'<link name="{name}"><pose>{x} {y} 0 0 0 {yaw}</pose><inertial><pose>{length / 2} 0 0 0 0 0</pose>'
            f"<mass>1</mass><inertia><ixx>{inertia}</ixx><iyy>{inertia}</iyy><izz>{inertia}</izz></inertia></inertial>"
            "</link>"
        )

    def hinge(name, parent, child, x=0.0):
        return (
            f'<joint name="{name}" type="revolute"><parent>{parent}</parent><child>{child}</child>'
            f"<pose>{x} 0 0 0 0 0</pose><axis><xyz>0 0 1</xyz></axis></joint>"
        )

    sim = simkit.load(
        f"""<sdf version="1.9"><world name="w"><physics name="p" type="p"><max_step_size>{step}</max_step_size>
        </physics><model name="m">{link("crank", 0, 0, math.pi / 2, crank, 50.0)}
        {link("coupler", 0, crank, turn, coupler, 7.5e-3)}{link("rocker", ground, 0, lean, rocker, 5e-3)}
        {hinge("a", "world", "crank")}{hinge("b", "crank", "coupler")}
        {hinge("d", "world", "rocker")}{hinge("c", "coupler", "rocker", rocker)}</model></world></sdf>"""
    )
    model, data = sim.mj_model, sim.mj_data
    bodies = [sim.engine.names.link(f"m::{name}").body for name in ("coupler", "rocker")]
    lengths, dof = (coupler, rocker), sim.engine.names.joints["m::a"].dofs[0]
    widest = 0.0
    while data.time < 2.0:
        data.qfrc_applied[dof] = 3000.0 if data.qvel[dof] < 35.0 else 0.0
        mujoco.mj_step(model, data)
        mujoco.mj_kinematics(model, data)
        one, other = (data.xpos[b] + data.xmat[b].reshape(3, 3)[:, 0] * x for b, x in zip(bodies, lengths, strict=True))
        widest = max(widest, float(np.linalg.norm(one - other)))
    assert data.qvel[dof] == pytest.approx(35.0, rel=0.05)
    assert 1e-6 < widest < most
