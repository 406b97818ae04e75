"""Friction, bounce, softness and masks."""

from __future__ import annotations

import math
from itertools import pairwise

import mujoco
import numpy as np
import pytest

from simkit.compiler import SpecBuilder
from simkit.compiler.contact_friction import MU_MOST, contact_properties, friction_priority
from simkit.compiler.model_compilation import report_overlaps
from simkit.diagnostics import NOWHERE, Diagnostics
from simkit.pose import Pose
from simkit.runtime.engine.physics_step import Physics
from simkit.runtime.engine.simulated_time import Clock
from simkit.scene import Box, Sphere, Surface

G = 9.8


def slide(make, compiled, mu_slope, mu_box, heading=0.0):
    """Speed after one second down a 30 degree slope that faces `heading`."""
    tilt = Pose.from_rpy(0, 0, 0, 0, 0, heading) @ Pose.from_rpy(0, 0, 0, 0, math.pi / 6, 0)
    normal = tuple(tilt.rotate((0, 0, 1)))
    box = make.solid("box", Box((0.4, 0.4, 0.1)), tilt @ Pose((0, 0, 0.05)), surface=Surface(mu=mu_box, mu2=mu_box))
    c = compiled(make.ground(mu_slope, normal), box)
    physics = Physics(c.model, c.data, Clock(0.001))
    physics.advance(1000)
    return float(np.linalg.norm(c.data.qvel[:3]))


@pytest.mark.parametrize(("mu_slope", "mu_box"), [(1.0, 0.01), (0.01, 1.0)])
def test_of_two_surfaces_the_smaller_coefficient_counts(make, compiled, mu_slope, mu_box):
    expected = G * (math.sin(math.pi / 6) - 0.01 * math.cos(math.pi / 6))
    assert slide(make, compiled, mu_slope, mu_box) == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("heading", [0.0, 0.4, math.pi / 4])
def test_friction_is_the_same_in_every_direction(make, compiled, heading):
    expected = G * (math.sin(math.pi / 6) - 0.3 * math.cos(math.pi / 6))
    assert slide(make, compiled, 1.0, 0.3, heading) == pytest.approx(expected, rel=2e-2)


def test_a_body_on_a_rough_slope_stays(make, compiled):
    tilt = Pose.from_rpy(0, 0, 0, 0, math.pi / 6, 0)
    box = make.solid("box", Box((0.4, 0.4, 0.1)), tilt @ Pose((0, 0, 0.05)))
    c = compiled(make.ground(1.0, tuple(tilt.rotate((0, 0, 1)))), box)
    mujoco.mj_step(c.model, c.data, 500)
    before = c.data.qpos[:3].copy()
    mujoco.mj_step(c.model, c.data, 2000)
    assert np.linalg.norm(c.data.qpos[:3] - before) < 2e-5


def test_without_friction_a_box_slides_freely(make, compiled):
    assert slide(make, compiled, 1.0, 0.0) == pytest.approx(G * 0.5, rel=1e-6)


def test_priority_rises_strictly_as_the_coefficient_falls():
    coefficients = [MU_MOST, 1.5, 1.0, 0.999, 0.5, 0.1, 1e-4, 0.0]
    ranks = [friction_priority(mu) for mu in coefficients]
    assert ranks[0] == 0
    assert all(a < b for a, b in pairwise(ranks))
    assert ranks[-1] < 2**31


def test_a_huge_coefficient_is_capped_and_reported():
    found = Diagnostics()
    contact = contact_properties(Surface(mu=1e5, mu2=1e5), 0.001, 1.0, found)
    assert contact.friction[0] == MU_MOST
    assert [d.code for d in found] == ["SK-PHYS-002"]


def rebounds(make, compiled, shape, restitution, speed, step):
    """Ratios of the speeds after and before each of up to ten hits of a body dropped upright, and its energies [J].

    Ends at a hit after which it flies for less than ten steps.
    """
    height = speed**2 / (2 * G)
    body = make.solid("body", shape, Pose((0, 0, 0.1 + height)), surface=Surface(restitution=restitution))
    c = compiled(make.ground(), body, step=step)
    ratios, energies, before = [], [], 0.0
    while len(ratios) < 10:
        down = before
        mujoco.mj_step(c.model, c.data)
        before = float(c.data.qvel[2])
        if down < 0.0 < before:
            ratios.append(-before / down)
            # of the form that the engine's step keeps in free fall
            energies.append(before**2 / 2 + G * (float(c.data.qpos[2]) - 0.1) - G * step * before / 2)
            if before < 5 * G * step:
                break
    return ratios[: -1 if len(ratios) < 10 else None], [speed**2 / 2, *energies]


@pytest.mark.parametrize("shape", [Sphere(0.1), Box((0.2, 0.2, 0.2))], ids=["sphere", "box"])
@pytest.mark.parametrize("step", [0.0005, 0.001, 0.002, 0.004])
@pytest.mark.parametrize("restitution", [0.2, 0.5, 0.8, 1.0])
def test_each_of_ten_hits_has_its_restitution_and_adds_no_energy(make, compiled, shape, step, restitution):
    for speed in (1.0, 3.0, 10.0):
        ratios, energies = rebounds(make, compiled, shape, restitution, speed, step)
        assert ratios or restitution * speed < 10 * G * step
        assert ratios == pytest.approx([restitution] * len(ratios), rel=5e-3)
        slack = 1e-4 if step < 0.004 else 4e-4  # the contacts of long steps are pyramids
        assert all(after < before + slack * energies[0] for before, after in pairwise(energies))


def test_two_balls_exchange_momentum_by_their_restitution(make, compiled):
    balls = [
        make.solid("a", Sphere(0.1), Pose((0.0, 0, 0)), surface=Surface(restitution=0.8)),
        make.solid("b", Sphere(0.1), Pose((0.3, 0, 0)), surface=Surface(restitution=0.8)),
    ]
    c = compiled(*balls, gravity=(0.0, 0.0, 0.0))
    c.data.qvel[0] = 3.0
    mujoco.mj_step(c.model, c.data, 200)
    assert c.data.qvel[[0, 6]] == pytest.approx([3.0 * 0.1, 3.0 * 0.9], abs=0.01)


def test_a_box_that_bounces_comes_to_rest(make, compiled):
    box = make.solid("box", Box((0.2, 0.2, 0.2)), Pose((0, 0, 0.6)), surface=Surface(restitution=0.5))
    c = compiled(make.ground(), box)
    mujoco.mj_step(c.model, c.data, 1200)  # 0.96 s of flights by theory
    assert np.abs(c.data.qvel).max() < 1e-3
    assert c.data.qpos[2] == pytest.approx(0.1, abs=1e-4)


@pytest.mark.parametrize("step", [0.0005, 0.001, 0.002])
def test_a_cube_of_one_kilogram_carries_ten_tonnes(make, compiled, step):
    cubes = [
        make.solid(f"c{i}", Box((0.1,) * 3), Pose((0, 0, 0.05 + 0.1 * i)), mass=mass, inertia=mass / 600)
        for i, mass in enumerate((1.0, 1e4))
    ]
    c = compiled(make.ground(), *cubes, step=step)
    deepest = 0.0
    for _ in range(round(2.0 / step)):
        mujoco.mj_step(c.model, c.data)
        deepest = max(deepest, -float(c.data.contact.dist.min(initial=0.0)))
    assert 1e-4 < deepest < 1e-3
    assert np.abs(c.data.qpos[7:9]).max() < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize(
    "masses", [(1.0, 1000.0) * 5, (1000.0, 1.0) * 5, [1000.0 ** (i / 9) for i in range(10)]],
    ids=["light_heavy", "heavy_light", "rising"],
)  # fmt: skip
def test_a_stack_of_ten_cubes_of_very_different_mass_stands(make, compiled, masses):
    cubes = [
        make.solid(f"c{i}", Box((0.1,) * 3), Pose((0, 0, 0.05 + 0.1 * i)), mass=mass, inertia=mass / 600)
        for i, mass in enumerate(masses)
    ]
    c = compiled(make.ground(), *cubes)
    mujoco.mj_step(c.model, c.data, 60_000)
    places = c.data.qpos.reshape(10, 7)
    assert np.abs(places[:, :2]).max() < 1e-3
    assert places[:, 2] == pytest.approx(0.05 + 0.1 * np.arange(10), abs=5e-3)


def test_stiff_kp_counts_as_rigid_and_soft_kp_gives_way(make, compiled):
    depths = []
    for kp in (1e5, 1e3):
        ball = make.solid("ball", Sphere(0.1), Pose((0, 0, 0.1)), surface=Surface(kp=kp, kd=1.0))
        c = compiled(make.ground(), ball)
        mujoco.mj_step(c.model, c.data, 3000)
        depths.append(0.1 - float(c.data.qpos[2]))
    assert depths[0] < 1e-4
    assert 3e-4 < depths[1] < 2e-2


def test_masks_without_a_common_bit_do_not_touch(make, compiled):
    ball = make.solid("ball", Sphere(0.1), Pose((0, 0, 0.2)), surface=Surface(collide_bitmask=0x2))
    c = compiled(make.ground(collide_bitmask=0x1), ball)
    mujoco.mj_step(c.model, c.data, 1000)
    assert c.data.qpos[2] == pytest.approx(0.2 - G / 2, abs=0.01)


def test_a_deep_overlap_at_the_start_is_reported(make):
    found = Diagnostics()
    box = make.solid("box", Box((0.2, 0.2, 0.2)), Pose((0, 0, 0.05)))
    c = SpecBuilder(make.world(make.ground(), box), found).compile()
    report_overlaps(c.model, c.data, c.names, found, NOWHERE)
    assert [d.code for d in found] == ["SK-PHYS-024"]


# ------------------------------------------------------------------ spinning and rolling


def test_a_torsional_patch_stops_a_spinning_body_evenly(make, compiled):
    """The torque is 3 pi / 16 · radius · coefficient · N."""
    surface = Surface(torsional=0.8, patch_radius=0.05)
    ball = make.solid("ball", Sphere(0.1), Pose((0, 0, 0.1)), surface=surface)
    c = compiled(make.ground(), ball)
    mujoco.mj_step(c.model, c.data, 300)
    c.data.qvel[5] = 20.0
    mujoco.mj_step(c.model, c.data, 500)
    torque = 3 * math.pi / 16 * 0.05 * 0.8 * 1.0 * G
    assert c.data.qvel[5] == pytest.approx(20.0 - torque / 0.01 * 0.5, rel=0.01)


def test_rolling_friction_slows_a_rolling_ball_evenly(make, compiled):
    """Of the torque μ N [m · N] and the friction at the ground: a = μ g / r / (1 + I / (m r²))."""
    ball = make.solid("ball", Sphere(0.1), Pose((0, 0, 0.1)), surface=Surface(rolling=0.002), inertia=0.004)
    c = compiled(make.ground(), ball, engine="bullet")
    mujoco.mj_step(c.model, c.data, 300)
    c.data.qvel[0], c.data.qvel[4] = 1.0, 10.0
    mujoco.mj_step(c.model, c.data, 1000)
    slowed = 0.002 * G / 0.1 / (1 + 0.004 / 0.01)
    assert c.data.qvel[0] == pytest.approx(1.0 - slowed, rel=0.01)


def test_without_bullet_a_ball_rolls_on_and_a_note_says_so(make):
    ball = make.solid("ball", Sphere(0.1), Pose((0, 0, 0.1)), surface=Surface(rolling=0.1), inertia=0.004)
    builder = SpecBuilder(make.world(make.ground(), ball), Diagnostics())
    c = builder.compile()
    mujoco.mj_step(c.model, c.data, 300)
    c.data.qvel[0], c.data.qvel[4] = 1.0, 10.0
    mujoco.mj_step(c.model, c.data, 1000)
    assert c.data.qvel[0] == pytest.approx(1.0, rel=1e-3)
    assert [d.code for d in builder.diagnostics] == ["SK-PHYS-007"]


def test_the_slip_of_torsional_friction_is_reported(make):
    surface = Surface(torsional=1.0, patch_radius=0.1, torsional_slip=0.5)
    ball = make.solid("ball", Sphere(0.1), Pose((0, 0, 0.1)), surface=surface)
    builder = SpecBuilder(make.world(make.ground(), ball), Diagnostics())
    builder.compile()
    assert [d.code for d in builder.diagnostics] == ["SK-PHYS-007"]


def test_without_a_patch_spinning_goes_on(make, compiled):
    ball = make.solid("ball", Sphere(0.1), Pose((0, 0, 0.1)), surface=Surface(torsional=1.0))
    c = compiled(make.ground(), ball)
    c.data.qvel[5] = 20.0
    mujoco.mj_step(c.model, c.data, 500)
    assert c.data.qvel[5] == pytest.approx(20.0, rel=1e-3)


# ------------------------------------------------------------------ who touches whom


def test_links_of_a_large_model_pass_through_each_other_but_not_through_others(make, compiled):
    """Beyond some number of pairs a bit of the mask stands for the excludes."""
    stack = [make.link(f"m::l{i}", Sphere(0.1), Pose((0.3 * i, 0, 0.1))) for i in range(80)]
    inside = make.link("m::inside", Sphere(0.1), Pose((0.05, 0, 0.1)))
    other = make.solid("other", Sphere(0.1), Pose((0.6, 0, 0.35)))
    twin = [make.link(f"n::l{i}", Sphere(0.1), Pose((0.3 * i, 0, 1.1))) for i in range(80)]
    c = compiled(make.ground(), make.model("m", *stack, inside), make.model("n", *twin), other)
    assert c.model.nexclude == 0
    mujoco.mj_step(c.model, c.data, 1500)

    def height(name):
        return float(c.data.xpos[c.names.link(name).body][2])

    assert height("m::l0") == pytest.approx(0.1, abs=2e-3)
    assert height("m::inside") == pytest.approx(0.1, abs=2e-3)
    assert height("other::link") > 0.09
    # the upper model's links came to rest on the lower one's, or beside them on the ground, but not within them
    apart = [
        np.linalg.norm(c.data.xpos[c.names.link(f"m::l{i}").body] - c.data.xpos[c.names.link(f"n::l{i}").body])
        for i in range(80)
    ]
    assert min(apart) > 0.195


@pytest.mark.parametrize("on", ["model", "link"])
def test_self_collision_is_asked_for_by_the_model_or_by_a_link(make, compiled, on):
    a = make.link("m::a", Sphere(0.5), self_collide=on == "link")
    b = make.link("m::b", Sphere(0.5), Pose((0.8, 0, 0)))
    c = compiled(make.model("m", a, b, self_collide=on == "model"))
    mujoco.mj_forward(c.model, c.data)
    assert c.data.ncon == 1


def test_category_and_collide_masks_meet_either_way(make, compiled):
    """ODE's rule: one's category is in what the other collides with."""
    ball = make.solid(
        "ball", Sphere(0.1), Pose((0, 0, 0.1)), surface=Surface(category_bitmask=0x4, collide_bitmask=0x1)
    )
    for mask, rests in ((0x4, True), (0x2, False)):
        c = compiled(make.ground(category_bitmask=0x8, collide_bitmask=mask), ball)
        mujoco.mj_step(c.model, c.data, 500)
        assert bool(c.data.qpos[2] > 0.09) is rests


# ------------------------------------------------------------------ links of a kind


def test_a_kinematic_link_moves_as_it_was_set_and_nothing_stops_it(make, compiled):
    wall = make.solid("wall", Box((0.2, 2.0, 2.0)), Pose((1.0, 0, 1.0)), mass=1.0)
    pusher = make.solid("pusher", Box((0.2, 0.2, 0.2)), Pose((0, 0, 1.0)), kinematic=True)
    c = compiled(make.ground(), wall, pusher)
    start = c.names.link("pusher::link").root_joint_qpos
    c.data.qvel[c.names.link("pusher::link").root_joint_dof] = 1.0
    mujoco.mj_step(c.model, c.data, 1500)
    assert c.data.qpos[start] == pytest.approx(1.5, abs=1e-5)
    assert c.data.qpos[start + 2] == pytest.approx(1.0, abs=1e-6)
    assert c.data.qpos[c.names.link("wall::link").root_joint_qpos] > 1.5
    assert c.model.body_mass.sum() == pytest.approx(2.0)


def test_velocity_decay_takes_its_part_at_every_step(make, compiled):
    body = make.solid("b", Box((0.1,) * 3), gravity=False, velocity_decay=(0.002, 0.004), inertia=0.02, mass=3.0)
    c = compiled(body)
    c.data.qvel[:] = (1, 0, 0, 0, 2, 0)
    mujoco.mj_step(c.model, c.data, 500)
    assert c.data.qvel[0] == pytest.approx(0.998**500, rel=1e-6)
    assert c.data.qvel[4] == pytest.approx(2 * 0.996**500, rel=1e-6)


def test_collide_without_contact_is_reported_and_touches_nothing(make):
    found = Diagnostics()
    ball = make.solid("ball", Sphere(0.1), Pose((0, 0, 0.1)), surface=Surface(collide_without_contact=True))
    c = SpecBuilder(make.world(make.ground(), ball), found).compile()
    mujoco.mj_step(c.model, c.data, 500)
    assert c.data.qpos[2] < -1.0
    assert "SK-PHYS-014" in [d.code for d in found]
