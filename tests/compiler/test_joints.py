"""Every kind of joint, loops, couplings."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest

from simkit.compiler import SpecBuilder
from simkit.compiler.tree import plan_tree
from simkit.diagnostics import Diagnostics
from simkit.pose import IDENTITY, Pose
from simkit.scene import Axis, Mimic, SceneJoint

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
    assert c.model.neq == 2
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
