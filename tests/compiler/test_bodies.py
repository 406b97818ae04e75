"""Frames, masses and inertias of links; static and movable models; excludes."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest

from simkit.compiler import SpecBuilder, geom_groups
from simkit.diagnostics import Diagnostics
from simkit.pose import Pose
from simkit.scene import Box, Inertial, SceneJoint, SceneVisual, Sphere


def test_body_frame_is_the_link_frame_and_inertia_is_in_link_axes(make, compiled):
    pose = Pose.from_rpy(1, 2, 3, 0.3, -0.2, 0.9)
    inertia = (0.3, 0.4, 0.5, 0.02, -0.03, 0.01)
    c = compiled(make.model("m", make.link("m::a", pose=pose, inertial=Inertial(2.0, (0.1, 0.2, 0.3), inertia))))
    body = c.names.link("m::a").body
    mujoco.mj_forward(c.model, c.data)
    np.testing.assert_allclose(c.data.xpos[body], pose.position, atol=1e-12)
    np.testing.assert_allclose(c.data.xmat[body].reshape(3, 3), pose.matrix, atol=1e-12)
    turned = np.zeros(9)
    mujoco.mju_quat2Mat(turned, c.model.body_iquat[body])
    r = turned.reshape(3, 3)
    full = r @ np.diag(c.model.body_inertia[body]) @ r.T
    np.testing.assert_allclose(full, [[0.3, 0.02, -0.03], [0.02, 0.4, 0.01], [-0.03, 0.01, 0.5]], atol=1e-12)
    np.testing.assert_allclose(c.model.body_ipos[body], (0.1, 0.2, 0.3))


def test_a_zero_inertia_is_mended_and_reported(make):
    found = Diagnostics()
    link = make.link("m::a", inertial=Inertial(1.0, (0, 0, 0), (0, 0, 0, 0, 0, 0)))
    c = SpecBuilder(make.world(make.model("m", link)), found).compile()
    assert c.model.body_inertia[1] == pytest.approx((1e-8, 1e-8, 1e-8), rel=1e-6)
    assert "SK-PHYS-011" in [d.code for d in found]


def test_an_inertia_that_only_the_engines_compiler_refuses_is_simulated_as_written_and_reported(make):
    found = Diagnostics()
    link = make.link("m::a", inertial=Inertial(1.0, (0, 0, 0), (1, 1, 3, 0, 0, 0)))
    c = SpecBuilder(make.world(make.model("m", link)), found).compile()
    assert sorted(c.model.body_inertia[1]) == pytest.approx((1, 1, 3), rel=1e-12)
    full = np.zeros((6, 6))
    mujoco.mj_forward(c.model, c.data)
    mujoco.mj_fullM(c.model, c.data, full)
    assert np.diag(full)[3:] == pytest.approx((1, 1, 3), rel=1e-12)
    assert [d.severity for d in found if d.code == "SK-INERTIA-001"] == ["warning"]


def test_a_negative_inertia_is_an_error_with_the_moments(make):
    found = Diagnostics()
    link = make.link("m::a", inertial=Inertial(1.0, (0, 0, 0), (1, 1, -1, 0, 0, 0)))
    SpecBuilder(make.world(make.model("m", link)), found)
    assert ["(-1, 1, 1)" in d.message for d in found if d.code == "SK-INERTIA-002"] == [True]


def test_static_links_are_geoms_of_the_world(make, compiled):
    block = make.link("m::a", Box((1, 1, 1)), Pose((5, 0, 0)), shape_pose=Pose((0, 1, 0)))
    c = compiled(make.model("m", block, static=True))
    binding = c.names.link("m::a")
    assert (c.model.nbody, binding.body, binding.static, binding.mocap) == (1, 0, True, -1)
    assert binding.offset == Pose((5, 0, 0))
    np.testing.assert_allclose(c.model.geom_pos[binding.geoms[0]], (5, 1, 0))
    assert c.names.geom_owner(binding.geoms[0]) == ("m::a", "m::a::c", False)


def test_a_movable_static_model_is_a_mocap_body(make):
    builder = SpecBuilder(make.world(), Diagnostics())
    builder.add_model(make.model("m", make.link("m::a", Box((1, 1, 1)), Pose((5, 0, 0))), static=True), movable=True)
    c = builder.compile()
    binding = c.names.link("m::a")
    assert binding.mocap == 0
    assert binding.body == 1
    assert binding.static
    np.testing.assert_allclose(c.data.mocap_pos[0], (5, 0, 0))


def test_links_of_one_model_pass_through_each_other_unless_it_self_collides(make, compiled):
    for self_collide, touching in ((False, 0), (True, 1)):
        a = make.link("m::a", Sphere(0.5))
        b = make.link("m::b", Sphere(0.5), Pose((0.8, 0, 0)))
        c = compiled(make.model("m", a, b, self_collide=self_collide))
        mujoco.mj_forward(c.model, c.data)
        assert c.data.ncon == touching


def test_jointed_links_never_touch_even_when_the_model_self_collides(make, compiled):
    a, b = make.link("m::a", Sphere(0.5)), make.link("m::b", Sphere(0.5), Pose((0.8, 0, 0)))
    hinge = SceneJoint("j", "m::j", "ball", "m::a", "m::b", Pose())
    c = compiled(make.model("m", a, b, joints=(hinge,), self_collide=True))
    mujoco.mj_forward(c.model, c.data)
    assert c.data.ncon == 0


def test_a_link_without_gravity_floats(make, compiled):
    c = compiled(make.model("m", make.link("m::a", gravity=False)))
    mujoco.mj_step(c.model, c.data, 1000)
    assert abs(c.data.qvel).max() < 1e-12


def test_visuals_are_drawn_and_do_not_collide(make, compiled):
    visual = SceneVisual("v", "m::a::v", Pose(), Box((1, 1, 1)))
    c = compiled(make.model("m", make.link("m::a", visuals=(visual,))))
    (geom,) = c.names.link("m::a").visuals
    assert c.model.geom_group[geom] == geom_groups.VISUAL
    assert c.model.geom_contype[geom] == c.model.geom_conaffinity[geom] == 0
    assert c.model.body_mass[1] == 1.0


def test_sites_of_static_links_land_in_the_world_body(make):
    builder = SpecBuilder(
        make.world(make.model("m", make.link("m::a", pose=Pose((1, 0, 0))), static=True)), Diagnostics()
    )
    name = builder.add_site("m::a", Pose((0, 2, 0)), "eye")
    c = builder.compile()
    site = c.names.site(name)
    assert c.model.site_bodyid[site] == 0
    np.testing.assert_allclose(c.model.site_pos[site], (1, 2, 0))


def test_an_unknown_link_is_answered_with_the_closest_name(make):
    builder = SpecBuilder(make.world(make.model("m", make.link("m::arm"))), Diagnostics())
    with pytest.raises(KeyError, match="m::arm"):
        builder.add_site("m::amr", Pose(), "eye")


def test_extent_ignores_planes(make, compiled):
    c = compiled(make.ground(), make.solid("box", Box((1, 1, 1)), Pose((0, 0, 0.5))))
    assert c.model.stat.extent == pytest.approx(math.sqrt(3) * math.sqrt(3) / 2, rel=0.2)
