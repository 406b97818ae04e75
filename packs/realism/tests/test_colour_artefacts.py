"""Statistics of the artefacts of colour cameras are those of the file."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

import simkit
from simkit.sensors.cameras.tone_curve import WHITE, light_table

WORLD = """
<sdf version="1.9" xmlns:simkit="simkit"><world name="w"><scene><background>{grey} {grey} {grey}</background></scene>
  <model name="m"><static>true</static><link name="l">{sensors}</link></model>
</world></sdf>"""
CAMERA = """<sensor name="{name}" type="camera"><update_rate>10</update_rate><camera>
  <image><width>{width}</width><height>{height}</height></image></camera>{artefacts}</sensor>"""


def camera(artefacts: str, name: str = "eye", width: int = 160, height: int = 120) -> str:
    return CAMERA.format(name=name, width=width, height=height, artefacts=artefacts)


def element(name: str, **options: object) -> str:
    texts = "".join(f"<{option}>{value}</{option}>" for option, value in options.items())
    return f"<simkit:{name}>{texts}</simkit:{name}>"


def load(*sensors: str, grey: float = 0.7, seed: int = 0) -> simkit.Simulation:
    return simkit.load(WORLD.format(grey=grey, sensors="".join(sensors)), seed=seed)


def pixels(message: simkit.msgs.Image) -> npt.NDArray[np.uint8]:
    return np.asarray(message.data).reshape(message.height, message.width, -1)


def light(message: simkit.msgs.Image) -> npt.NDArray[np.float64]:
    return light_table()[pixels(message)] / WHITE


LINEAR = element("tone_curve", type="linear")


def test_the_photon_transfer_curve_is_a_line_with_the_system_gain_and_the_read_noise() -> None:
    full_well, gain, read = 1000.0, 6.0, 12.0
    noise = element("image_sensor", full_well=full_well, gain=gain, read_noise=read, bit_depth=8, black_level=0.1)
    values = 0.0, -0.5, -1.0, -2.0, -3.0
    eyes = [
        camera(element("exposure_control", exposure_value=value) + noise + LINEAR, f"eye{number}", 320, 240)
        for number, value in enumerate(values)
    ]
    with load(*eyes, grey=0.85) as sim:
        sim.run(0.05)
        pictures = [pixels(sim.sensor(f"m::l::eye{number}").latest).astype(float) for number in range(len(values))]
    means, variances = [p.mean() for p in pictures], [p.var() for p in pictures]
    assert max(means) < 240  # white would limit the variance
    slope, offset = np.polyfit(means, variances, 1)
    system_gain = 255 * 10 ** (gain / 20) / full_well
    assert abs(slope / system_gain - 1) < 0.03
    dark = offset + slope * 0.1 * 255  # the numbers of dark pixels are 10 % of white
    assert abs(dark / (system_gain**2 * read**2 + 1 / 12) - 1) < 0.05


def test_the_image_sensor_keeps_the_mean_and_its_noise_is_independent_from_image_to_image() -> None:
    with load(camera(element("image_sensor", full_well=5000) + LINEAR, width=320, height=240)) as sim:
        eye = sim.sensor("m::l::eye")
        sim.run(0.05)
        first, true = pixels(eye.latest).astype(float), light(eye.truth).mean() * 255
        sim.run(0.1)
        second = pixels(eye.latest).astype(float)
    assert abs(first.mean() - true) < 4 * first.std() / np.sqrt(first.size) + 0.005
    correlation = np.corrcoef(first.ravel(), second.ravel())[0, 1]
    assert abs(correlation) < 4 / np.sqrt(first.size)
    channels = np.corrcoef(first.reshape(-1, 3).T)
    assert abs(channels[0, 1]) < 4 / np.sqrt(first.size / 3)


def test_pixels_differ_by_prnu_and_dsnu_in_each_image_equally() -> None:
    options = {"full_well": 1e6, "prnu": 0.02, "dsnu": 5000, "bit_depth": 16, "black_level": 0.1}
    sensor = element("image_sensor", **options) + LINEAR
    eyes = camera(sensor, "day"), camera(element("exposure_control", exposure_value=-20) + sensor, "night")
    with load(*eyes) as sim:
        sim.run(0.05)
        day, night = (sim.sensor(f"m::l::{name}") for name in ("day", "night"))
        first, dark, true = pixels(day.latest) / 255, pixels(night.latest) / 255, light(day.truth).mean()
        sim.run(0.1)
        second = pixels(day.latest) / 255
    rounding = 1 / 255**2 / 12
    assert abs((dark.var() - rounding) / 0.005**2 - 1) < 0.05
    assert abs((first.var() - rounding - 0.005**2 - 1e-6 * true) / (0.02 * true) ** 2 - 1) < 0.06
    assert np.corrcoef(first.ravel(), second.ravel())[0, 1] > 0.9


def test_hot_pixels_are_white_in_every_image() -> None:
    with load(camera(element("image_sensor", full_well=1e8, hot_pixels=0.01)), grey=0.2) as sim:
        sim.run(0.05)
        eye = sim.sensor("m::l::eye")
        first = pixels(eye.latest) == 255
        sim.run(0.1)
        assert (first == (pixels(eye.latest) == 255)).all()
    assert abs(first.mean() - 0.01) < 4 * np.sqrt(0.01 / first.size)


def test_the_dark_current_adds_electrons_with_the_exposure_time() -> None:
    options = {"full_well": 10_000, "dark_current": 20_000, "exposure_time": 0.1}
    with load(camera(element("image_sensor", **options) + LINEAR), grey=0.0) as sim:
        sim.run(0.05)
        dark = pixels(sim.sensor("m::l::eye").latest) / 255
    assert abs(dark.mean() - 0.2) < 0.001
    assert abs(dark.var() / (2000 / 10_000**2 + 1 / 255**2 / 12) - 1) < 0.05


def test_vignetting_is_cos4_of_the_angle_to_the_axis_or_a_polynomial() -> None:
    polynomial = element("vignetting", coefficients="-0.3 0.1 -0.05")
    with load(camera(element("vignetting") + LINEAR, "lens"), camera(polynomial + LINEAR, "fitted")) as sim:
        sim.run(0.05)
        lens, fitted = sim.sensor("m::l::lens"), sim.sensor("m::l::fitted")
        true = light(lens.truth)[0, 0, 0] * 255
        focal = lens.options.model.fx
        for row, column in ((0, 0), (60, 159), (59, 80), (119, 30)):
            x, y = column + 0.5 - 80, row + 0.5 - 60
            angle = np.arctan(np.hypot(x, y) / focal)
            assert abs(pixels(lens.latest)[row, column, 0] - true * np.cos(angle) ** 4) <= 0.51
            rho = np.hypot(x, y) / 100
            share = 1 - 0.3 * rho**2 + 0.1 * rho**4 - 0.05 * rho**6
            assert abs(pixels(fitted.latest)[row, column, 0] - true * share) <= 0.51


def test_a_fixed_exposure_value_multiplies_the_light_by_a_power_of_two() -> None:
    with load(camera(element("exposure_control", exposure_value=-1)), grey=0.9) as sim:
        sim.run(0.05)
        eye = sim.sensor("m::l::eye")
        assert abs(light(eye.latest).mean() / light(eye.truth).mean() - 0.5) < 0.005


def exposure_values(readers: bool, control: str) -> list[float]:
    """Return log2 of the light of each image relative to the truth."""
    with load(camera(control), grey=0.3) as sim:
        eye, found = sim.sensor("m::l::eye"), []
        if readers:
            sim.subscribe(eye.topic, lambda message: None)
        for number in range(12):
            sim.run(0.1)
            if readers or number == 11:
                found.append(float(np.log2(light(eye.latest).mean() / light(eye.truth).mean())))
    return found


def test_the_exposure_control_reaches_its_target_with_its_time_constant_whoever_reads() -> None:
    control = element("exposure_control", mode="auto", target=0.2, time_constant=2, max_exposure_value=4)
    found = exposure_values(True, control)
    goal = np.log2(0.2 / (light_table()[round(0.3 * 255)] / WHITE))
    # the first image has the exposure value 0; `run(0.1)` takes the images 1 and 2
    expected = [goal * (1 - np.exp(-number / 2)) for number in range(1, 13)]
    assert np.allclose(found, expected, atol=0.03)
    assert exposure_values(False, control) == found[-1:]


def test_the_exposure_control_keeps_its_limits_and_is_in_snapshots() -> None:
    control = element("exposure_control", mode="auto", target=0.9, time_constant=20, max_exposure_value=1)
    with load(camera(control), grey=0.3) as sim:
        eye = sim.sensor("m::l::eye")
        sim.run(0.25)
        snapshot = sim.snapshot()
        sim.run(2.0)
        last = pixels(eye.latest).copy()
        assert abs(np.log2(light(eye.latest).mean() / light(eye.truth).mean()) - 1) < 0.03
        sim.restore(snapshot)
        sim.run(0.2)
        middle = pixels(eye.latest).copy()
        sim.reset()
        sim.run(0.25)
        sim.run(0.2)
        assert (pixels(eye.latest) == middle).all()
        assert (middle != last).any()


def test_white_balance_gains_and_a_gamma_curve_act_on_light() -> None:
    curve = element("white_balance", gains="0.8 1 0.5") + element("tone_curve", gamma=2)
    with load(camera(curve), grey=0.6) as sim:
        sim.run(0.05)
        eye = sim.sensor("m::l::eye")
        true, found = light(eye.truth)[0, 0, 0], pixels(eye.latest)[0, 0]
    assert np.abs(found - 255 * np.sqrt(true * np.array([0.8, 1.0, 0.5]))).max() <= 0.51


def test_images_repeat_with_the_seed_and_the_truth_has_no_artefacts() -> None:
    artefacts = element("image_sensor", full_well=2000, read_noise=5)
    with load(camera(artefacts)) as one, load(camera(artefacts)) as same, load(camera(artefacts), seed=1) as other:
        sims = one, same, other
        for sim in sims:
            sim.run(0.15)
        first, again, different = (pixels(sim.sensor("m::l::eye").latest) for sim in sims)
        truth = pixels(one.sensor("m::l::eye").truth)
    assert (first == again).all()
    assert (first != different).any()
    assert (truth == truth[0, 0]).all()


def test_cameras_of_one_sensor_and_grey_cameras_have_artefacts_of_their_own() -> None:
    block = '<camera name="{}"><image><width>32</width><height>24</height>{}</image></camera>'
    blocks = block.format("left", "") + block.format("right", "<format>L8</format>")
    artefacts = element("image_sensor", full_well=2000) + element("white_balance", gains="0.5 1 1")
    rig = f'<sensor name="rig" type="multicamera"><update_rate>10</update_rate>{blocks}{artefacts}</sensor>'
    with load(rig) as sim:
        got = {}
        for side in ("left", "right"):
            sim.subscribe(sim.sensor("m::l::rig").topics[f"{side}/image"], lambda m, s=side: got.__setitem__(s, m))
        sim.run(0.05)
    left, right = pixels(got["left"]).astype(float), pixels(got["right"]).astype(float)
    assert left.shape == (24, 32, 3)
    assert right.shape == (24, 32, 1)
    assert left[..., 0].mean() < 0.8 * left[..., 1].mean()
    assert right.std() > 1
    assert abs(np.corrcoef(left[..., 1].ravel(), right.ravel())[0, 1]) < 0.2
