"""Noise: bias, drifting bias, quantisation, independence."""

from __future__ import annotations

import math

import numpy as np
import pytest
from sensor_worlds import box, sensor, world

import simkit
from simkit.diagnostics import Diagnostics
from simkit.params import Params
from simkit.runtime.engine.random_streams import RandomStreams
from simkit.sensors.bias_drift import ALLAN_FLOOR, ALLAN_PEAK, FLICKER_TIMES
from simkit.sensors.cameras.image_noise import ImageNoise
from simkit.sensors.noise import NO_NOISE, Noise, NoiseModel, UniformNoise, quantise, read_noise


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


def test_numbers_at_the_limits_of_their_range_stay_finite() -> None:
    far = np.array([1e100, -1e300, math.inf])
    np.testing.assert_array_equal(quantise(far, np.array([1e-300])), far)
    with np.errstate(all="raise", under="ignore"):
        odd = NoiseModel(bias_instability=1e100, correlation_time=1e-308, dynamic_bias_stddev=1e100)
        assert np.isfinite(samples(odd, 5)).all()
        odd = NoiseModel(dynamic_bias_stddev=1e100, dynamic_bias_correlation_time=1e-308, precision=1e-308)
        assert np.isfinite(samples(odd, 5, dt=1e6)).all()


@pytest.mark.parametrize("element", ["mean", "stddev", "bias_mean", "bias_stddev", "dynamic_bias_stddev"])
def test_a_channel_that_leaves_the_numbers_is_an_error(element: str) -> None:
    text = f'<altimeter><vertical_position><noise type="gaussian"><{element}>1e101</{element}></noise>'
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002.*1e\\+100"):
        simkit.load(world(sensor("altimeter", f"{text}</vertical_position></altimeter>")))


@pytest.mark.parametrize("dt", [0.01, 0.1])
def test_a_drifting_bias_has_its_variance_and_autocorrelation(dt: float) -> None:
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


def test_noise_without_deviation_draws_no_numbers() -> None:
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


def test_variances_are_on_the_diagonal() -> None:
    noise = Noise([NoiseModel(stddev=s) for s in (5.0, 1.0, 2.0, 3.0)], RandomStreams(1), "s", "x")
    np.testing.assert_array_equal(noise.covariance(1).reshape(3, 3), np.diag((1.0, 4.0, 9.0)))
    assert noise.variance(3) == 9.0


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


def read(text: str, kind: str = "gaussian") -> tuple[NoiseModel, list[str]]:
    """Read a noise model from words `name=value`; return the model and the codes of all diagnostics."""
    found = Diagnostics()
    children = [Params(*word.split("="), diagnostics=found) for word in text.split()]
    block = Params("noise", attributes={"type": kind} if kind else {}, children=children, diagnostics=found)
    return read_noise(Params("x", children=[block], diagnostics=found)), [d.code for d in found]


@pytest.mark.parametrize("text", ["precision=-0.1", "stddev=-1", "noise_density=-1", "correlation_time=x"])
def test_a_negative_deviation_or_precision_is_an_error(text: str) -> None:
    assert read(text)[1] == ["SK-PARAM-002"]


def test_without_a_type_noise_is_reported_as_none_except_data_sheet_noise() -> None:
    assert read("stddev=0.1", "") == (NO_NOISE, ["SK-SENSOR-020"])
    assert read("stddev=0.0", "") == (NO_NOISE, [])
    assert read("stddev=0.1", "none") == (NO_NOISE, [])
    assert read("noise_density=0.1", "") == (NoiseModel(noise_density=0.1), [])


def test_data_sheet_elements_replace_gazebos_duplicates() -> None:
    model, codes = read("stddev=2 noise_density=0.1 mean=1 bias_mean=3 precision=0.5")
    assert (model.stddev, model.noise_density, model.mean, model.bias_mean, model.precision) == (0, 0.1, 1, 3, 0.5)
    assert codes == ["SK-SENSOR-021"]
    model, codes = read("random_walk=2 dynamic_bias_stddev=0.1 dynamic_bias_correlation_time=3 stddev=1")
    assert (model.dynamic_bias_stddev, model.random_walk, model.stddev) == (0, 2, 1)
    assert codes == ["SK-SENSOR-021"]
    assert read("noise_density=1 correlation_time=3")[1] == ["SK-SENSOR-021"]


# ---------------------------------------------------------------------- data sheets


@pytest.mark.parametrize("dt", [0.005, 0.04])
def test_a_density_is_white_noise_by_the_root_of_the_rate(dt: float) -> None:
    x = samples(NoiseModel(noise_density=0.02), 20_000, dt)
    assert x[1:].std() == pytest.approx(0.02 / math.sqrt(dt), rel=0.03)
    assert abs(np.corrcoef(x[1:], x[:-1])[0, 1]) < 0.03


def test_each_interval_has_its_own_white_noise_and_the_covariance_follows() -> None:
    noise = Noise([NoiseModel(noise_density=0.1)] * 3, RandomStreams(1), "s", "x", interval=0.01)
    found = {}
    for index, dt in enumerate((0.0, 0.04, 0.01, 0.04), start=1):
        noise.evolve(index, dt)
        found[index] = noise.variance()
        assert noise.covariance()[4] == noise.variance()
    assert [found[i] for i in (1, 2, 3, 4)] == pytest.approx([1.0, 0.25, 1.0, 0.25])


def test_a_random_walk_grows_with_the_root_of_time() -> None:
    ends = [samples(NoiseModel(random_walk=0.3), 20, 0.5, seed)[-1] for seed in range(800)]
    # the first sample also evolves by one interval
    assert np.std(ends) == pytest.approx(0.3 * math.sqrt(20 * 0.5), rel=0.07)
    assert abs(np.mean(ends)) < 4 * 0.95 / math.sqrt(800)


def test_a_correlation_time_bounds_a_random_walk() -> None:
    x = samples(NoiseModel(random_walk=0.3, correlation_time=0.5), 40_000, 0.1)
    assert x.std() == pytest.approx(0.3 * math.sqrt(0.5 / 2), rel=0.1)
    assert np.corrcoef(x[1:], x[:-1])[0, 1] == pytest.approx(math.exp(-0.1 / 0.5), abs=0.02)


def allan(x: np.ndarray, n: int) -> float:
    """Return the overlapping Allan deviation of readings x for averages over n readings."""
    theta = np.concatenate(([0.0], np.cumsum(x)))
    second = theta[2 * n :] - 2 * theta[n:-n] + theta[: -2 * n]
    return math.sqrt((second**2).mean() / 2) / n


def markov_peak() -> float:
    x = np.linspace(0.5, 5, 20_001)
    return float(np.sqrt(2 / x * (1 - (3 - 4 * np.exp(-x) + np.exp(-2 * x)) / (2 * x))).max())


def test_the_constants_of_the_allan_deviation_are_those_of_the_formulas() -> None:
    assert pytest.approx(0.664, abs=5e-4) == ALLAN_FLOOR
    assert pytest.approx(markov_peak(), rel=1e-4) == ALLAN_PEAK


def test_the_processes_of_flicker_noise_make_a_flat_floor() -> None:
    def variance_at(tau: float) -> float:
        x = tau / np.array(FLICKER_TIMES)
        share = 2 / x * (1 - (3 - 4 * np.exp(-x) + np.exp(-2 * x)) / (2 * x))
        return math.log(10) / math.pi * float(share.sum())

    taus = np.geomspace(1.0, 1000.0, 200)
    floor = np.sqrt([variance_at(t) for t in taus])
    assert np.abs(floor / ALLAN_FLOOR - 1).max() < 0.025


def test_bias_instability_is_the_floor_of_the_allan_deviation() -> None:
    # mean over several seeds, because one run of this length estimates its floor only to about 10 %
    floors = []
    for seed in range(8):
        x = samples(NoiseModel(bias_instability=0.2), 20_000, 0.5, seed)
        floors.append([allan(x, n) for n in (10, 30, 100, 300)])
    np.testing.assert_allclose(np.sqrt(np.square(floors).mean(axis=0)), 0.664 * 0.2, rtol=0.12)


def test_with_a_correlation_time_the_floor_is_the_peak_at_189_percent_of_that_time() -> None:
    tau = 2.0
    model = NoiseModel(bias_instability=0.2, correlation_time=tau)
    x = samples(model, 60_000, 0.2)
    assert allan(x, round(1.89 * tau / 0.2)) == pytest.approx(0.664 * 0.2, rel=0.05)
    starts = [samples(model, 1, 0.2, seed)[0] for seed in range(800)]
    assert np.std(starts) == pytest.approx(
        0.2 * ALLAN_FLOOR / ALLAN_PEAK, rel=0.1
    )  # in its steady state from the start


def test_an_imu_at_rest_for_20_minutes_shows_its_density_and_instability() -> None:
    density, instability, rate = 6e-3, 6e-3, 10
    block = gaussian(f"<noise_density>{density}</noise_density><bias_instability>{instability}</bias_instability>")
    step = "<physics name='p' type='ode'><max_step_size>0.1</max_step_size></physics>"
    source = imu(block, rate=rate, top=step).replace("<x>", f"<y>{block}</y><z>{block}</z><x>")
    with simkit.load(source, seed=2) as sim:
        read = sim.subscribe("/i")
        sim.run(1200)
        x = np.array([(m.angular_velocity.x, m.angular_velocity.y, m.angular_velocity.z) for m in read.messages]).T
    # between two readings there is almost only white noise; flicker noise changes little in 0.1 s
    found = math.sqrt(np.diff(x).var() / 2 / rate)
    assert found == pytest.approx(density, rel=0.05)
    floor = [np.mean([allan(axis, n) ** 2 for axis in x]) - found**2 * rate / n for n in (60, 100, 200, 400)]
    assert math.sqrt(np.mean(floor)) / 0.664 == pytest.approx(instability, rel=0.1)


# ---------------------------------------------------------------------- in a world

DYNAMIC = (
    "<dynamic_bias_stddev>0.3</dynamic_bias_stddev><dynamic_bias_correlation_time>5</dynamic_bias_correlation_time>"
)


def imu(noise: str, kind: str = "imu", rate: float = 100, extra: str = "", top: str = "") -> str:
    block = "<imu><angular_velocity><x>{}</x></angular_velocity></imu>"
    if kind == "magnetometer":
        block = "<magnetometer><x>{}</x></magnetometer>"
    return world(sensor(kind, block.format(noise), rate=rate, extra="<topic>i</topic>" + extra), top=top)


def gaussian(content: str) -> str:
    return f'<noise type="gaussian">{content}</noise>'


def test_the_white_noise_of_a_density_and_its_covariance_follow_the_rate() -> None:
    with simkit.load(imu(gaussian("<noise_density>0.01</noise_density>"), rate=100)) as sim:
        found, read = {}, sim.subscribe("/i")
        for rate in (100, 400, 0):
            sim.sensor("m::l::s").set_rate(rate)
            sim.run(0.02)
            before = len(read.messages)
            sim.run(4)
            new = read.messages[before:]
            assert {m.angular_velocity_covariance[4] for m in new} == {0.0}
            found[rate] = np.std([m.angular_velocity.x for m in new]), new[-1].angular_velocity_covariance[0]
    for rate, (deviation, variance) in found.items():
        assert deviation == pytest.approx(0.01 * math.sqrt(rate or 1000), rel=0.12)
        if rate != 400:  # 2 and 3 steps in turn
            assert variance == pytest.approx(0.01**2 * (rate or 1000), rel=1e-9)


def test_a_message_that_waits_has_the_bias_of_its_own_sample() -> None:
    world_of = imu(gaussian("<stddev>0.01</stddev>" + DYNAMIC))
    with simkit.load(world_of) as sim, simkit.load(world_of) as other:
        kept, heard = sim.subscribe("/i"), []
        other.subscribe("/i", callback=heard.append)
        sim.run(2)
        other.run(2)
        biases = [m.angular_velocity.x for m in kept.messages]
        assert biases == [m.angular_velocity.x for m in heard]
        assert np.ptp(biases) > 0.1  # the bias has drifted
        assert sim.sensor("m::l::s").latest.angular_velocity.x == other.sensor("m::l::s").latest.angular_velocity.x


def test_the_bias_of_an_unread_sensor_drifts_like_that_of_a_read_sensor() -> None:
    world_of = imu(gaussian(DYNAMIC + "<bias_stddev>1</bias_stddev>"))
    with simkit.load(world_of) as sim, simkit.load(world_of) as other:
        other.subscribe("/i")
        sim.run(1.5)
        other.run(1.5)
        late, read = sim.subscribe("/i"), other.subscribe("/i")
        sim.run(0.5)
        other.run(0.5)
        assert [m.angular_velocity.x for m in late.messages] == [m.angular_velocity.x for m in read.messages]


def test_gazebos_bias_has_either_sign_by_channel_and_seed() -> None:
    block = gaussian("<bias_mean>2</bias_mean>")
    source = imu(block, top="<gazebo_quirks>true</gazebo_quirks>").replace("<x>", f"<y>{block}</y><x>")
    signs = []
    for seed in range(24):
        with simkit.load(source, seed=seed) as sim:
            sim.run(0.01)
            v = sim.sensor("m::l::s").latest.angular_velocity
            assert (abs(v.x), abs(v.y), v.z) == (2.0, 2.0, 0.0)
            signs.append((v.x > 0, v.y > 0))
    assert len(set(signs)) == 4
    assert 5 <= sum(x for x, _ in signs) <= 19
    with simkit.load(imu(block)) as sim:
        sim.run(0.01)
        assert sim.sensor("m::l::s").latest.angular_velocity.x == 2.0


@pytest.mark.parametrize(("kind", "wanders"), [("imu", True), ("magnetometer", False)])
def test_gazebo_ignores_a_dynamic_bias_where_it_passes_no_time(kind: str, wanders: bool) -> None:
    def values(top: str) -> list[float]:
        with simkit.load(imu(gaussian(DYNAMIC), kind, top=top)) as sim:
            read = sim.subscribe("/i")
            sim.run(1)
            messages = read.messages
            return [m.angular_velocity.x if kind == "imu" else m.magnetic_field.x for m in messages]

    assert bool(np.ptp(values("<gazebo_quirks>true</gazebo_quirks>")) > 1e-9) is wanders
    assert np.ptp(values("")) > 1e-9


def test_gazebo_ignores_a_precision_of_a_millionth() -> None:
    fine = NoiseModel(precision=5e-7, dynamic_bias_stddev=1.0)
    assert fine.as_gazebo(True).precision == 0.0
    assert fine.as_gazebo(False).dynamic_bias_stddev == 0.0
    assert NoiseModel(precision=2e-6).as_gazebo(True).precision == 2e-6


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
    # no tile of random words repeats within a frame or in another frame
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


def test_without_a_type_the_kind_has_sdfs_default() -> None:
    """SDF's default is `none`, and `gaussian` for rays and cameras."""
    wall = box("wall", "3.5 0 1 0 0 0", "1 4 4")
    biased = "<noise><mean>1</mean></noise>"
    ray = "<scan><horizontal><samples>1</samples></horizontal></scan><range><min>0.1</min><max>10</max></range>"
    sensors = sensor("lidar", f"<lidar>{ray}{biased}</lidar>", name="rays")
    sensors += sensor("altimeter", f"<altimeter><vertical_position>{biased}</vertical_position></altimeter>", name="up")
    with simkit.load(world(sensors, others=wall)) as sim:
        sim.step()
        assert sim.sensor("m::l::rays").latest.ranges[0] == pytest.approx(4.0)
        assert sim.sensor("m::l::up").latest.vertical_position == 0.0
        assert [d.code for d in sim.diagnostics if d.severity == "warning"] == ["SK-SENSOR-020"]
