"""Friction, bounce, softness and masks."""

from __future__ import annotations

import math
from itertools import pairwise

import mujoco
import numpy as np
import pytest

from simkit.compiler import SpecBuilder
from simkit.compiler.friction import MU_MOST, contact_of, priority_of
from simkit.diagnostics import Diagnostics
from simkit.pose import Pose
from simkit.scene import Box, Sphere, Surface

G = 9.8


def slide(make, compiled, mu_slope, mu_box, heading=0.0):
    """Speed after one second down a 30 degree slope that faces `heading`."""
    tilt = Pose.from_rpy(0, 0, 0, 0, 0, heading) @ Pose.from_rpy(0, 0, 0, 0, math.pi / 6, 0)
    normal = tuple(tilt.rotate((0, 0, 1)))
    box = make.solid("box", Box((0.4, 0.4, 0.1)), tilt @ Pose((0, 0, 0.05)), surface=Surface(mu=mu_box, mu2=mu_box))
    c = compiled(make.ground(mu_slope, normal), box)
    mujoco.mj_step(c.model, c.data, 1000)
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
    ranks = [priority_of(mu) for mu in coefficients]
    assert ranks[0] == 0
    assert all(a < b for a, b in pairwise(ranks))
    assert ranks[-1] < 2**31


def test_a_huge_coefficient_is_capped_and_reported():
    found = Diagnostics()
    contact = contact_of(Surface(mu=1e5, mu2=1e5), 0.001, 1.0, found)
    assert contact.friction[0] == MU_MOST
    assert [d.code for d in found] == ["SK-PHYS-002"]


@pytest.mark.parametrize("restitution", [0.3, 0.6, 0.9])
def test_a_ball_rebounds_with_its_restitution(make, compiled, restitution):
    ball = make.solid("ball", Sphere(0.1), Pose((0, 0, 1.1)), surface=Surface(restitution=restitution))
    c = compiled(make.ground(), ball)
    speed_down, speed_up = 0.0, 0.0
    for _ in range(900):
        mujoco.mj_step(c.model, c.data)
        v = float(c.data.qvel[2])
        speed_down, speed_up = max(speed_down, -v), max(speed_up, v)
    assert speed_up / speed_down == pytest.approx(restitution, abs=0.05)
    assert "SK-PHYS-003" in [d.code for d in c.builder.diagnostics]


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
    SpecBuilder(make.world(make.ground(), box), found).compile()
    assert "SK-PHYS-024" in [d.code for d in found]
