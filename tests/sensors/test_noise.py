"""Noise: bias, wandering bias, quantisation, independence."""

from __future__ import annotations

import math

import numpy as np
import pytest

from simkit.diagnostics import Diagnostics
from simkit.params import Params
from simkit.runtime.random import RandomStreams
from simkit.sensors.image_noise import ImageNoise
from simkit.sensors.noise import NO_NOISE, Noise, NoiseModel, UniformNoise, quantise, read_noise, variance


def samples(model: NoiseModel, count: int, dt: float = 0.01, seed: int = 1) -> np.ndarray:
    noise = Noise([model], RandomStreams(seed), "a::s", "x")
    out = []
    for index in range(1, count + 1):
        noise.evolve(index, dt)
        out.append(noise.apply(np.zeros(1), index)[0])
    return np.array(out)


def test_a_bias_keeps_its_sign_and_is_drawn_once() -> None:
    assert (samples(NoiseModel(bias_mean=0.5), 5) == 0.5).all()
    drawn = [samples(NoiseModel(bias_mean=1.0, bias_stddev=0.1), 3, seed=seed) for seed in range(200)]
    assert all((d == d[0]).all() for d in drawn)
    firsts = np.array([d[0] for d in drawn])
    assert firsts.mean() == pytest.approx(1.0, abs=4 * 0.1 / math.sqrt(200))
    assert firsts.std() == pytest.approx(0.1, rel=0.2)


@pytest.mark.parametrize("dt", [0.01, 0.1])
def test_a_wandering_bias_has_its_spread_and_its_memory(dt: float) -> None:
    tau, sigma = 0.5, 0.3
    x = samples(NoiseModel(dynamic_bias_stddev=sigma, dynamic_bias_correlation_time=tau), 40_000, dt)
    assert x.std() == pytest.approx(sigma * math.sqrt(tau / 2), rel=0.1)
    assert np.corrcoef(x[1:], x[:-1])[0, 1] == pytest.approx(math.exp(-dt / tau), abs=0.02)


def test_halves_are_rounded_away_from_zero() -> None:
    values = np.array((0.25, -0.25, 0.24, 1.0, math.inf, -math.inf))
    np.testing.assert_array_equal(quantise(values, np.array([0.5])), (0.5, -0.5, 0.0, 1.0, math.inf, -math.inf))
    np.testing.assert_array_equal(quantise(values, np.array([0.0])), values)


def test_a_draw_depends_on_its_index_alone() -> None:
    one, other = (Noise([NoiseModel(stddev=1.0)] * 3, RandomStreams(3), "a::s", "x") for _ in range(2))
    for index in (1, 2, 3):
        one.apply(np.zeros(3), index)
    assert one.apply(np.zeros(3), 9).tolist() == other.apply(np.zeros(3), 9).tolist()


def test_noise_on_one_channel_leaves_anothers_draw_alone() -> None:
    streams = RandomStreams(3)
    both = Noise([NoiseModel(stddev=1.0), NoiseModel(stddev=1.0)], streams, "a::s", "x").apply(np.zeros(2), 4)
    second = Noise([NO_NOISE, NoiseModel(stddev=1.0)], streams, "a::s", "x").apply(np.zeros(2), 4)
    assert second[0] == 0.0
    assert second[1] == both[1]


def test_no_deviation_draws_nothing() -> None:
    class NoDraws:
        def stream(self, *_: object) -> object:
            raise AssertionError("drawn")

    still = NoiseModel(mean=1.0, bias_mean=2.0, precision=0.5)
    assert Noise([still], NoDraws(), "s", "x").apply(np.zeros(1), 1)[0] == 3.0  # type: ignore[arg-type]
    assert UniformNoise(still, 2, NoDraws(), "s", "x").apply(np.zeros(2), 1).tolist() == [3.0, 3.0]  # type: ignore[arg-type]


def test_infinite_ranges_stay_infinite() -> None:
    noise = UniformNoise(NoiseModel(mean=5.0, stddev=1.0), 3, RandomStreams(1), "s", "x")
    out = noise.apply(np.array((math.inf, -math.inf, 1.0)), 1)
    assert out[0] == math.inf
    assert out[1] == -math.inf
    assert math.isfinite(out[2])


def test_variances_stand_on_the_diagonal() -> None:
    covariance = variance([NoiseModel(stddev=s) for s in (1.0, 2.0, 3.0)])
    np.testing.assert_array_equal(covariance.reshape(3, 3), np.diag((1.0, 4.0, 9.0)))


@pytest.mark.parametrize("form", ["attribute", "element"])
def test_the_type_may_be_an_attribute_or_an_element(form: str) -> None:
    children = [Params("stddev", "0.5")]
    block = Params("noise", attributes={"type": "gaussian"}, children=children)
    if form == "element":
        block = Params("noise", children=[Params("type", "gaussian"), *children])
    assert read_noise(Params("x", children=[block])).stddev == 0.5


def test_an_unknown_type_is_an_error() -> None:
    found = Diagnostics()
    block = Params("noise", attributes={"type": "pink"}, diagnostics=found)
    read_noise(Params("x", children=[block], diagnostics=found))
    assert [d.code for d in found] == ["SK-PARAM-002"]


# ---------------------------------------------------------------------- pictures


def image_noise(stddev: float, mean: float = 0.0, seed: int = 1) -> ImageNoise:
    return ImageNoise(NoiseModel(mean=mean, stddev=stddev), RandomStreams(seed), "a::c")


def test_image_noise_has_its_spread_and_is_the_same_on_all_channels() -> None:
    grey = np.full((240, 320, 3), 128, dtype=np.uint8)
    out = image_noise(0.02).on_colours(grey, 1).astype(int) - 128
    assert (out == out[..., :1]).all()
    # rounding to whole levels adds a variance of 1/12
    assert out[..., 0].std() == pytest.approx(math.sqrt((0.02 * 255) ** 2 + 1 / 12), rel=0.02)
    assert abs(out[..., 0].mean()) < 4 * 5.1 / math.sqrt(240 * 320)


def test_image_noise_is_clipped() -> None:
    out = image_noise(0.2).on_colours(np.zeros((50, 50), dtype=np.uint8), 1)
    assert 0.4 < (out == 0).mean() < 0.6
    assert image_noise(0.0, mean=2.0).on_colours(np.zeros((5, 5, 3), dtype=np.uint8), 1).min() == 255


def test_frames_and_pixels_are_not_correlated() -> None:
    flat = np.zeros((256, 256), dtype=np.float32)
    noise = image_noise(1.0)
    frames = np.stack([noise.on_depths(flat, k) for k in range(1, 13)]).reshape(12, -1)
    assert frames.std() == pytest.approx(1.0, abs=0.01)
    limit = 5 / math.sqrt(frames.shape[1])
    between = np.corrcoef(frames)
    assert np.abs(between - np.eye(12)).max() < limit
    pixels = frames.reshape(12, 256, 256)
    for shift in ((0, 1), (1, 0), (1, 1), (0, 64), (64, 0), (128, 128)):
        moved = np.roll(pixels, shift, axis=(1, 2))
        assert abs((pixels * moved).mean()) < limit
    # no tile of words comes back within a frame or in another
    rows = frames.reshape(-1, 64)
    assert len(np.unique(rows, axis=0)) == len(rows)


def test_image_noise_depends_on_seed_name_and_frame_alone() -> None:
    flat = np.zeros((16, 16), dtype=np.float32)
    late = image_noise(1.0).on_depths(flat, 7)
    noise = image_noise(1.0)
    for k in range(1, 7):
        noise.on_depths(flat, k)
    np.testing.assert_array_equal(noise.on_depths(flat, 7), late)
    assert not np.array_equal(image_noise(1.0, seed=2).on_depths(flat, 7), late)
