"""Parts of a particle filter: motion, likelihood field, number of particles, and estimate, against their formulas."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.random import default_rng

from simkit import msgs
from simkit_navigation.plugins.localisation.likelihood_field import Hits, LikelihoodMap
from simkit_navigation.plugins.localisation.motion_models import differential, omnidirectional
from simkit_navigation.plugins.localisation.particle_filter import Adaptation, ParticleFilter

MANY = 40_000
ADAPTATION = Adaptation(100, 5000, 0.05, 2.33, 0.0, 0.0)


def wall_map(yaw: float = 0.0) -> LikelihoodMap:
    """Return a map of 10 × 20 cells of 0.1 m whose last column is occupied."""
    cells = np.zeros((10, 20), np.int8)
    cells[:, 19], cells[0, 0] = 100, -1
    origin = {"position": {"x": 1.0, "y": 2.0}, "orientation": {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}}
    info = {"resolution": 0.1, "width": 20, "height": 10, "origin": origin}
    return LikelihoodMap.from_message(msgs.make("nav_msgs/msg/OccupancyGrid", info=info, data=cells.reshape(-1)))


def test_the_differential_motion_has_the_means_and_variances_of_its_model() -> None:
    poses = differential(np.zeros((MANY, 3)), (1.0, 0.0, 0.4), (0.01, 0.02, 0.03, 0.04, 9.0), default_rng(1))
    yaw, travel = poses[:, 2], np.hypot(poses[:, 0], poses[:, 1])
    assert (travel.mean(), yaw.mean()) == pytest.approx((1.0, 0.4), abs=5e-3)
    assert travel.var() == pytest.approx(0.03 * 1.0 + 0.04 * 0.4**2, rel=0.03)
    assert yaw.var() == pytest.approx(0.02 + (0.01 * 0.4**2 + 0.02), rel=0.03)  # of both turns


def test_a_robot_that_drives_backwards_has_the_noise_of_one_that_drives_ahead() -> None:
    alphas = (0.1, 0.0, 0.01, 0.0, 0.0)
    back = differential(np.zeros((MANY, 3)), (-1.0, 0.0, 0.0), alphas, default_rng(1))
    assert back.mean(axis=0) == pytest.approx((-1, 0, 0), abs=5e-3)
    assert back.var(axis=0) == pytest.approx((0.01, 0, 0), abs=5e-4)


def test_the_omnidirectional_motion_has_noise_to_the_side() -> None:
    poses = omnidirectional(np.zeros((MANY, 3)), (0.0, 2.0, 0.3), (0.0, 0.01, 0.02, 0.0, 0.05), default_rng(1))
    assert poses.mean(axis=0) == pytest.approx((0, 2, 0.3), abs=0.01)
    assert poses.var(axis=0) == pytest.approx((0.05 * 4, 0.02 * 4, 0.01 * 4), rel=0.03)


@pytest.mark.parametrize("yaw", [0.0, 2.0])
def test_the_likelihood_of_an_end_point_is_that_of_its_distance_to_the_wall(yaw: float) -> None:
    found = wall_map(yaw)
    cos, sin = math.cos(yaw), math.sin(yaw)
    along = np.array([0.55, 0.95, 1.85])  # the wall's nearest cell has its centre at 1.95 m
    poses = np.column_stack((1 + cos * along - sin * 0.5, 2 + sin * along + cos * 0.5, np.full(3, yaw)))
    points = np.array([[0.1, 0.0], [0.1, 0.2]])
    hits = Hits(0.2, 0.8, 0.05, 0.7, False)
    expected = 0.8 * np.exp(-(np.minimum([1.3, 0.9, 0.0], 0.7) ** 2) / 0.08) + 0.05
    means = found.mean_terms(poses, points, hits)
    assert hits.likelihoods(means, 2) == pytest.approx(1 + 2 * expected**3, rel=1e-5)
    assert hits.agreements(means) == pytest.approx(expected**3, rel=1e-5)
    hits = replace(hits, is_product=True)
    means = found.mean_terms(poses, points, hits)
    product = hits.likelihoods(means, 2)
    assert product / product[2] == pytest.approx((expected / expected[2]) ** 2, rel=1e-4)
    assert hits.agreements(means) == pytest.approx(expected, rel=1e-5)


def test_places_outside_of_the_map_are_far_from_every_wall() -> None:
    outside = np.array([[-50.0, 2.5, 0.0], [1.5, 90.0, 0.0], [3.4, 2.5, 0.0]])
    hits = Hits(0.2, 1.0, 0.0, 2.0, False)
    assert wall_map().mean_terms(outside, np.array([[0.0, 0.0]]), hits) == pytest.approx(0.0)


def test_random_poses_lie_in_free_cells_only() -> None:
    poses = wall_map().random_poses(MANY, default_rng(1))
    x, y = poses[:, 0] - 1, poses[:, 1] - 2
    assert x.max() < 1.9 and x.min() > 0 and not ((x < 0.1) & (y < 0.1)).any()
    assert (x.mean(), y.mean(), poses[:, 2].mean()) == pytest.approx((0.955, 0.502, 0.0), abs=0.03)


def test_the_number_of_particles_is_that_of_kld_sampling() -> None:
    needed = ADAPTATION.needed(np.array([1, 2, 60, 3000]))
    k = 59  # chi-square quantile by Wilson and Hilferty, divided by twice the error
    expected = math.ceil(k / 0.1 * (1 - 2 / (9 * k) + math.sqrt(2 / (9 * k)) * 2.33) ** 3)
    assert needed.tolist() == [100, 100, expected, 5000]
    assert expected == pytest.approx(87.17 / 0.1, rel=2e-3)  # 99 % quantile of chi-square with 59 degrees: 87.17


@pytest.mark.parametrize("spread", [0.01, 1.0, 20.0])
def test_resampling_ends_when_the_occupied_cells_have_enough_particles(spread: float) -> None:
    random = default_rng(1)
    particles = ParticleFilter.of(0.25 + random.normal(size=(5000, 3)) * (spread, spread, 0.01))
    particles.resample(ADAPTATION, lambda n: np.zeros((n, 3)), random)
    cells = np.floor(particles.poses / (0.5, 0.5, math.radians(10)))
    needed = ADAPTATION.needed(np.array([len(np.unique(cells, axis=0))]))[0]
    assert len(particles.poses) == pytest.approx(needed, abs=1)
    assert needed == {0.01: 100, 20.0: 5000}.get(spread, needed)
    assert particles.weights.sum() == pytest.approx(1.0)


def test_resampling_draws_in_proportion_to_the_weights() -> None:
    particles = ParticleFilter(np.diag([1.0, 2.0, 3.0]) * 0.1, np.array([0.5, 0.3, 0.2]))
    particles.resample(Adaptation(MANY, MANY, 0.05, 2.33, 0, 0), lambda n: np.zeros((n, 3)), default_rng(1))
    shares = [(particles.poses[:, i] > 0).mean() for i in range(3)]
    assert shares == pytest.approx([0.5, 0.3, 0.2], abs=0.01)


def test_random_particles_are_added_while_the_agreement_is_below_its_average() -> None:
    adaptation = Adaptation(1000, 1000, 0.05, 2.33, 0.1, 0.5)
    particles = ParticleFilter.of(np.ones((1000, 3)))
    for agreement in (*[1.0] * 10, 0.4):
        particles.weigh(np.ones(1000), np.full(1000, agreement), adaptation)
    assert (particles.slow, particles.fast) == pytest.approx((0.94, 0.7))
    particles.resample(adaptation, lambda n: np.zeros((n, 3)), default_rng(1))
    assert (particles.poses == 0).mean() == pytest.approx(1 - 0.7 / 0.94, abs=0.04)


def test_the_estimate_is_the_mean_of_the_heaviest_cluster_also_at_half_a_turn() -> None:
    random = default_rng(1)
    poses = np.concatenate((random.normal(size=(600, 3)), random.normal(size=(400, 3)))) * (0.1, 0.2, 0.1)
    poses += np.repeat([(4.0, -3.0, math.pi), (-4.0, 1.0, 0.0)], (600, 400), axis=0)
    poses[:, 2] = np.remainder(poses[:, 2] + math.pi, math.tau) - math.pi
    found = ParticleFilter.of(poses).estimate()
    assert found.share == pytest.approx(0.6, abs=0.01)
    assert found.pose[:2] == pytest.approx((4, -3), abs=0.02)
    assert abs(found.pose[2]) == pytest.approx(math.pi, abs=0.02)
    assert np.sqrt(np.diag(found.covariance)) == pytest.approx((0.1, 0.2, 0.1), rel=0.1)


def test_weights_without_any_likelihood_are_equal() -> None:
    particles = ParticleFilter(np.zeros((4, 3)), np.array([0.7, 0.1, 0.1, 0.1]))
    particles.weigh(np.zeros(4), np.zeros(4), ADAPTATION)
    assert particles.weights.tolist() == [0.25] * 4
