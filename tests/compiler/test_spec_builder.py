"""Spawning, removing, copying."""

from __future__ import annotations

import mujoco
import numpy as np

from simkit.compiler import SpecBuilder
from simkit.diagnostics import Diagnostics
from simkit.pose import Pose
from simkit.scene import Axis, Box, Cone, SceneJoint, SceneLight, Sphere


def arm(make, name="arm"):
    """A servo-driven arm on a free base."""
    axis = (0.0, 1.0, 0.0)
    base = make.link(f"{name}::base", Box((0.4, 0.4, 0.2)), Pose((0, 0, 0.1)), mass=5.0, inertia=0.2)
    tip = make.link(f"{name}::tip", Sphere(0.05), Pose((0.3, 0, 0.5)))
    hinge = SceneJoint(
        "j", f"{name}::j", "revolute", f"{name}::base", f"{name}::tip", Pose((0, 0, 0.5)), (Axis(axis, axis),)
    )
    return make.model(name, base, tip, joints=(hinge,))


def test_others_keep_their_bits_over_a_spawn_and_a_removal(make):
    builder = SpecBuilder(make.world(make.ground(), arm(make)), Diagnostics())
    ref = builder.add_position_servo("arm::j", max_effort=5.0, owner="test")
    c = builder.compile()
    c.data.ctrl[c.names.actuator(ref)] = 0.5
    mujoco.mj_step(c.model, c.data, 321)
    before = {f: getattr(c.data, f).copy() for f in ("qpos", "qvel", "act", "ctrl", "qacc_warmstart")}
    time = c.data.time

    builder = builder.copy()
    builder.add_model(make.solid("extra", Cone(0.2, 0.4), Pose((2, 0, 3))))
    more = builder.recompile(c, c.data)
    joint = more.names.joint("arm::j")
    assert more.data.qpos[joint.qpos[0]] == before["qpos"][c.names.joint("arm::j").qpos[0]]
    np.testing.assert_array_equal(more.data.qpos[:8], before["qpos"])
    np.testing.assert_array_equal(more.data.qvel[:7], before["qvel"])
    assert more.data.qpos[more.names.link("extra::link").root_joint_qpos + 2] == 3.0
    assert more.data.time == time

    builder = builder.copy()
    builder.remove_model("extra")
    after = builder.recompile(more, more.data)
    for field in ("qpos", "qvel", "act", "ctrl"):
        np.testing.assert_array_equal(getattr(after.data, field), before[field])
    assert after.model.nmesh == c.model.nmesh
    assert after.model.actuator_gainprm[0, 0] == c.model.actuator_gainprm[0, 0]


def test_a_copy_can_be_changed_without_touching_the_original(make):
    builder = SpecBuilder(make.world(arm(make)), Diagnostics())
    first = builder.compile()
    other = builder.copy()
    other.remove_model("arm")
    assert other.compile().model.nbody == 1
    assert builder.compile().model.nbody == first.model.nbody == 3


def test_everything_a_model_added_leaves_with_it(make):
    lamp = SceneLight("lamp", "arm2::base::lamp", "point", link="arm2::base")
    builder = SpecBuilder(make.world(make.ground()), Diagnostics())
    empty = builder.compile().model
    model = arm(make, "arm2")
    base = make.link("arm2::base", Cone(0.1, 0.2), lights=(lamp,))
    model = make.model("arm2", base, *model.links[1:], joints=model.joints)
    builder.add_model(model)
    builder.add_velocity_servo("arm2::j", max_effort=1.0, owner="x")
    builder.add_site("arm2::tip", Pose(), "eye")
    full = builder.compile().model
    assert (full.nu, full.nsite, full.nlight, full.nexclude) == (1, 1, 1, 1)
    builder.remove_model("arm2")
    after = builder.compile().model
    for count in ("nbody", "ngeom", "nmesh", "nmat", "nu", "nsite", "nlight", "nexclude", "neq", "njnt"):
        assert getattr(after, count) == getattr(empty, count), count


def test_a_static_model_leaves_the_world_body_clean_and_comes_back_movable(make):
    block = make.model("block", make.link("block::link", Box((1, 1, 1)), Pose((3, 0, 0))), static=True)
    builder = SpecBuilder(make.world(make.ground(), block), Diagnostics())
    c = builder.compile()
    builder = builder.copy()
    builder.remove_model("block")
    builder.add_model(block, movable=True)
    again = builder.recompile(c, c.data)
    binding = again.names.link("block::link")
    again.data.mocap_pos[binding.mocap] = (4, 0, 0)
    mujoco.mj_forward(again.model, again.data)
    np.testing.assert_allclose(again.data.xpos[binding.body], (4, 0, 0))
    assert again.model.ngeom == c.model.ngeom


def test_a_weld_can_be_let_go(make):
    a, b = (
        make.solid("a", Box((0.1,) * 3), Pose((0, 0, 5)), gravity=False),
        make.solid("b", Box((0.1,) * 3), Pose((0, 0, 4))),
    )
    builder = SpecBuilder(make.world(a, b), Diagnostics())
    name = builder.add_weld("hold", "a::link", "b::link")
    c = builder.compile()
    number = c.names.equality(name)
    mujoco.mj_step(c.model, c.data, 10)
    apart = c.data.qpos[2] - c.data.qpos[9]
    assert abs(apart - 1.0) < 1e-3
    c.data.eq_active[number] = 0
    mujoco.mj_step(c.model, c.data, 200)
    assert c.data.qpos[2] - c.data.qpos[9] > 1.1
    builder.remove_model("b")
    assert builder.compile().model.neq == 0
