"""Wave fields: dispersion, spectrum, growth, and the plugins that set them."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from simkit_water_and_air.plugins.fluids.wave_field import WaveField, WaveParameters

CWR = WaveParameters(model="CWR", number=3, scale=1.5, angle=0.4, amplitude=0.3, period=6.0, direction=(3.0, 4.0))


def test_every_component_obeys_the_dispersion_of_deep_water() -> None:
    for parameters in (CWR, WaveParameters(), replace(CWR, number=8)):
        for wave in parameters.waves():
            assert wave.frequency**2 == pytest.approx(9.8 * wave.wavenumber)
            assert math.hypot(wave.x, wave.y) == pytest.approx(1)


def test_waves_of_constant_ratio_have_the_scale_between_their_lengths_and_amplitudes() -> None:
    waves = CWR.waves()
    assert [wave.amplitude for wave in waves] == pytest.approx([0.2, 0.3, 0.45])
    assert [waves[1].wavenumber / wave.wavenumber for wave in waves] == pytest.approx([1 / 1.5, 1, 1.5])
    assert waves[1].frequency == pytest.approx(2 * math.pi / 6)
    angles = [math.atan2(wave.y, wave.x) for wave in waves]
    assert angles == pytest.approx([math.atan2(4, 3) + n * 0.4 for n in (-1, 0, 1)])


def test_the_spectrum_of_pierson_and_moskowitz_gives_the_amplitudes() -> None:
    parameters = WaveParameters(scale=1.1, period=5.0, gain=0.3)
    peak = 2 * math.pi / 5
    widths = (peak * (1 - 1 / 1.1), peak * (1.1 - 1 / 1.1) / 2, peak * 0.1)
    for wave, width, n in zip(parameters.waves(), widths, (-1, 0, 1), strict=True):
        assert wave.frequency == pytest.approx(peak * 1.1**n)
        density = 0.0081 * 9.81**2 / wave.frequency**5 * math.exp(-1.25 * (peak / wave.frequency) ** 4)
        assert wave.amplitude == pytest.approx(0.3 * math.sqrt(2 * density * width))


def test_the_surface_is_the_sum_of_the_components_and_grows_from_calm_water() -> None:
    field = WaveField(CWR.waves(), 2.0)
    assert field.height(3.0, -2.0, 0.0) == 0.0
    time = 50.0
    total = sum(w.amplitude * math.cos(w.wavenumber * (3 * w.x - 2 * w.y) - w.frequency * time) for w in CWR.waves())
    assert field.height(3.0, -2.0, time) == pytest.approx(total, abs=1e-9)
    assert field.height(0.0, 0.0, 1.0) == pytest.approx(
        (1 - math.exp(-0.5)) * sum(w.amplitude * math.cos(w.frequency) for w in CWR.waves())
    )
    step = 1e-5
    rate = (field.height(3.0, -2.0, time + step) - field.height(3.0, -2.0, time - step)) / (2 * step)
    assert field.vertical_velocity(3.0, -2.0, time) == pytest.approx(rate, rel=1e-6)
    assert WaveField().height(1.0, 2.0, 3.0) == 0.0


@pytest.mark.parametrize(
    "change",
    [
        {"model": "JONSWAP"},
        {"number": 4},
        {"period": 0.0},
        {"direction": (0.0, 0.0)},
        {"gain": math.nan},
        {"tau": -1.0},
    ],
)
def test_invalid_parameters_are_described(change: dict[str, object]) -> None:
    assert WaveParameters().find_fault() == ""
    assert replace(WaveParameters(), **change).find_fault()
