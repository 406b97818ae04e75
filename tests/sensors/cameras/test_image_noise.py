"""Noise of images: correct standard deviation, independent for every pixel of every frame, without any pattern."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from sensor_worlds import colours, depths, noise, sensor, world

import simkit
from simkit.runtime.engine.random_streams import RandomStreams
from simkit.sensors.cameras.image_noise import ImageNoise
from simkit.sensors.noise import NoiseModel

SIZE = (120, 160)
FRAMES = 12


def new_noise(stddev: float, mean: float = 0.0, name: str = "m::l::s", *, seed: int = 1, **how: Any) -> ImageNoise:
    return ImageNoise(NoiseModel(mean=mean, stddev=stddev), RandomStreams(seed), name, **how)


def on_grey(of: ImageNoise, level: int = 128, frames: int = FRAMES) -> npt.NDArray[np.float64]:
    """Return the noise of plain grey images, shape (frames, h, w), in units of white."""
    plain = np.full((*SIZE, 3), level, np.uint8)
    found = np.stack([of.on_colours(plain, i).astype(np.float64) for i in range(1, frames + 1)])
    assert (found == found[..., :1]).all()  # one draw for the three channels
    added: npt.NDArray[np.float64] = (found[..., 0] - level) / 255.0
    return added


def on_depth(of: ImageNoise, frames: int = FRAMES) -> npt.NDArray[np.float64]:
    plain = np.full(SIZE, 3.0, np.float32)
    return np.stack([of.on_depths(plain, i).astype(np.float64) - 3.0 for i in range(1, frames + 1)])


def correlation(a: npt.NDArray[np.float64], b: npt.NDArray[np.float64]) -> float:
    """Return the correlation of two arrays, divided by the expected correlation of as many independent draws."""
    return float(np.corrcoef(a.ravel(), b.ravel())[0, 1]) * math.sqrt(a.size)


BOTH = pytest.mark.parametrize("added", [on_grey(new_noise(0.1)), on_depth(new_noise(0.1))], ids=["colours", "depths"])


# ---------------------------------------------------------------------- no pattern


@BOTH
def test_neighbours_in_a_row_a_column_and_time_are_uncorrelated(added: npt.NDArray[np.float64]) -> None:
    for lag in (1, 2, 3, 4, 8, 64):
        assert abs(correlation(added[:, :, lag:], added[:, :, :-lag])) < 4
        assert abs(correlation(added[:, lag:], added[:, :-lag])) < 4
        if lag < FRAMES:
            assert abs(correlation(added[lag:], added[:-lag])) < 4


@BOTH
def test_no_frequency_stands_out(added: npt.NDArray[np.float64]) -> None:
    """Without a pattern, the power of a frequency is exponentially distributed; the largest of n is near log n."""
    for axis in (0, 1, 2):
        power = (np.abs(np.fft.rfft(added - added.mean(), axis=axis)) ** 2).mean(axis=tuple({0, 1, 2} - {axis}))
        assert power[1:-1].max() < 1.5 * power[1:-1].mean()
    whole = np.abs(np.fft.fft2(added[0] - added[0].mean())).ravel() ** 2
    assert whole.max() < 2 * math.log(whole.size) * whole.mean()


@BOTH
def test_no_pixel_and_no_frame_is_special(added: npt.NDArray[np.float64]) -> None:
    spread = added.std()
    assert np.abs(added.mean(axis=(1, 2))).max() < 4.5 * spread / math.sqrt(added[0].size)
    assert np.abs(added.mean(axis=0)).max() < 5.5 * spread / math.sqrt(FRAMES)
    assert np.abs(added.mean(axis=(0, 1))).max() < 5 * spread / math.sqrt(FRAMES * SIZE[0])


def test_cameras_channels_and_seeds_have_noise_of_their_own() -> None:
    of_one = on_grey(new_noise(0.1))
    for other in (on_grey(new_noise(0.1, name="m::l::t")), on_grey(new_noise(0.1, seed=2)), on_depth(new_noise(0.1))):
        assert abs(correlation(of_one, other)) < 4
        assert abs(correlation(of_one[1:], other[:-1])) < 4


def test_a_frames_noise_is_its_own_whatever_was_drawn_before() -> None:
    one, other = new_noise(0.1), new_noise(0.1)
    plain = np.full((*SIZE, 3), 90, np.uint8)
    for i in (1, 2, 3):
        one.on_colours(plain, i)
    np.testing.assert_array_equal(one.on_colours(plain, 5), other.on_colours(plain, 5))


@pytest.mark.parametrize("size", [(1, 1), (3, 5), (7, 1), (1, 300), (481, 641)])
def test_every_size_has_its_noise(size: tuple[int, int]) -> None:
    found = new_noise(0.1).on_colours(np.full((*size, 3), 128, np.uint8), 1).astype(float)
    assert found.shape == (*size, 3)
    if found.size > 10_000:
        rows = (found[..., 0] - 128) / 255
        assert rows.std() == pytest.approx(0.1, rel=0.02)
        assert np.abs(rows.std(axis=1) / 0.1 - 1).max() < 0.15


# ---------------------------------------------------------------------- of the right size


@pytest.mark.parametrize("stddev", [0.004, 0.02, 0.1])
@pytest.mark.parametrize("mean", [0.0, 0.05, -0.1])
def test_mean_and_deviation_are_those_of_the_file(mean: float, stddev: float) -> None:
    added, lengths = on_grey(new_noise(stddev, mean)), on_depth(new_noise(stddev, mean))
    rounded = math.hypot(stddev, 1 / 255 / math.sqrt(12))
    error = 4 * stddev / math.sqrt(added.size)
    assert added.std() == pytest.approx(rounded if stddev > 0.005 else added.std(), rel=0.01)
    assert added.mean() == pytest.approx(mean, abs=error + 2e-4)
    assert lengths.mean() == pytest.approx(mean, abs=error + 1e-6)
    assert lengths.std() == pytest.approx(stddev, rel=0.01)


def test_it_is_normally_distributed() -> None:
    lengths = on_depth(new_noise(0.1)).ravel() / 0.1
    for bound, share in ((1, 0.317311), (2, 0.045500), (3, 0.0026998)):
        found = (np.abs(lengths) > bound).mean()
        assert found == pytest.approx(share, abs=4 * math.sqrt(share / lengths.size))
    assert 4.0 < np.abs(lengths).max() < 5.0


@pytest.mark.parametrize(("stddev", "mean"), [(0.3, 0.0), (1.0, 0.2), (5.0, -3.0)])
def test_large_noise_is_clipped_at_black_and_white(stddev: float, mean: float) -> None:
    """The fractions of black and white pixels and the mean of all others agree with the normal distribution."""
    level = 100
    added = on_grey(new_noise(stddev, mean), level)
    found = np.rint(added * 255 + level)

    def below(value: float) -> float:
        return 0.5 * (1 + math.erf((value - level - 255 * mean) / 255 / stddev / math.sqrt(2)))

    for value, share in ((0, below(0.5)), (255, 1 - below(254.5)), (150, below(150.5) - below(149.5))):
        spread = math.sqrt(max(share, 1e-5) * (1 - share) / found.size)
        assert (found == value).mean() == pytest.approx(share, abs=5 * spread + 2e-5)


def test_a_mean_alone_shifts_everything_and_draws_nothing() -> None:
    assert (on_grey(new_noise(0.0, 0.1)) == 26 / 255).all()
    assert (on_grey(new_noise(0.0, -0.9)) == -128 / 255).all()
    np.testing.assert_allclose(on_depth(new_noise(0.0, 0.25)), 0.25, atol=1e-6)
    assert new_noise(0.0).is_silent


def test_infinite_depths_stay() -> None:
    plain = np.array([[math.inf, -math.inf, 1.0, 2.0]], np.float32)
    assert new_noise(0.1).on_depths(plain, 1)[0, :2].tolist() == [math.inf, -math.inf]


def test_gazebos_formula_distorts_the_noise() -> None:
    straight, bent = on_depth(new_noise(0.3)), on_grey(new_noise(0.3, as_ogre=True))
    expected = np.sort(np.sign(straight) * np.abs(straight) ** 2.1, axis=None)
    quarters = [round(q * bent.size) for q in (0.05, 0.25, 0.75, 0.95)]
    np.testing.assert_allclose(np.sort(bent, axis=None)[quarters], expected[quarters], atol=0.006)
    # with Gazebo's formula, noise of a common size changes no pixel
    assert np.abs(on_grey(new_noise(0.007, as_ogre=True))).max() == 0


def test_grey_images_have_the_same_noise() -> None:
    of = new_noise(0.1)
    wide = of.on_colours(np.full((*SIZE, 3), 128, np.uint8), 3)
    np.testing.assert_array_equal(of.on_colours(np.full(SIZE, 128, np.uint8), 3), wide[..., 0])


# ---------------------------------------------------------------------- on messages


def eyes(more: str = "") -> str:
    block = f"""<camera><image><width>64</width><height>48</height></image>
      <clip><near>0.1</near><far>9</far></clip>{noise(0.05)}</camera>"""
    both = sensor("rgbd_camera", block, name="a", extra="<topic>a</topic>") + sensor(
        "camera", block, name="b", extra="<topic>b</topic>"
    )
    scene = "<scene><ambient>1 1 1 1</ambient><background>0.5 0.5 0.5 1</background></scene>" + more
    wall = """<model name="wall"><static>true</static><pose>3 0 1 0 0 0</pose><link name="l"><visual name="v">
      <geometry><box><size>0.1 9 9</size></box></geometry></visual></link></model>"""
    return world(both, others=wall, top=scene)


def test_messages_carry_it_and_their_truth_does_not() -> None:
    with simkit.load(eyes()) as sim:
        one, other, far = (sim.subscribe(topic) for topic in ("/a/image", "/b", "/a/depth_image"))
        sim.run(0.2)
        truth = colours(sim.sensor("m::l::b").truth).astype(float)
        assert truth.std(axis=(0, 1)).max() < 1
        added = [np.stack([colours(m)[..., 0] - truth[..., 0] for m in sub.messages]) / 255 for sub in (one, other)]
        assert len(added[0]) == len(added[1]) == 21
        for each in added:
            inner = each[:, 2:-2, 2:-2]
            assert inner.std() == pytest.approx(0.05, rel=0.02)
            assert abs(correlation(inner[1:], inner[:-1])) < 4
        assert abs(correlation(added[0], added[1])) < 4
        lengths = np.stack([depths(m) for m in far.messages])
        assert np.isfinite(lengths).all()
        assert (lengths - 2.95).std() == pytest.approx(0.05, rel=0.02)


def test_with_gazebos_quirks_small_noise_is_not_seen_on_colours() -> None:
    with simkit.load(eyes("<gazebo_quirks>true</gazebo_quirks>")) as sim:
        image, far = sim.subscribe("/b"), sim.subscribe("/a/depth_image")
        sim.run(0.02)
        truth = colours(sim.sensor("m::l::b").truth)
        assert (colours(image.latest).astype(float) - truth).std() < 1  # 12.8 of the straight rule
        assert depths(far.latest).std() == pytest.approx(0.05, rel=0.06)
