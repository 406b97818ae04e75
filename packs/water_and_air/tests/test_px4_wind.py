"""Wind of PX4's worlds for Gazebo Classic."""

from __future__ import annotations

import math

import pytest

import simkit


def world(parameters: str) -> str:
    return f"""<sdf version="1.6"><world name="windy"><physics name="p" type="ode"><max_step_size>0.01</max_step_size>
      </physics><plugin name="wind_plugin" filename="libgazebo_wind_plugin.so"><frameId>base_link</frameId>
      <robotNamespace/>
      {parameters}<windPubTopic>world_wind</windPubTopic></plugin></world></sdf>"""


def winds(text: str, seconds: int, seed: int = 0) -> list[tuple[float, float, float]]:
    """Return the wind at each half of a second, after it has changed."""
    with simkit.load(text, seed=seed) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        return [tuple(sim.engine.wind.at(50 * half + 1)) for half in range(2 * seconds)]


MEAN = "<windVelocityMean>4.0</windVelocityMean><windVelocityMax>20.0</windVelocityMax>"


def test_the_mean_wind_blows_from_the_first_message_on() -> None:
    found = winds(world(f"{MEAN}<windDirectionMean>0 2 0</windDirectionMean>"), 2)
    assert found[0] == (0.0, 0.0, 0.0)
    assert found[1:] == [(0.0, 4.0, 0.0)] * 3


def test_a_gust_and_a_ramp_are_added() -> None:
    gust = "<windGustStart>2</windGustStart><windGustDuration>1</windGustDuration><windGustVelocityMean>3"
    ramp = "<windRampStart>4</windRampStart><windChangeRampDuration>2</windChangeRampDuration>"
    text = world(
        f"{MEAN}{gust}</windGustVelocityMean>{ramp}<windRampWindVectorComponents>0 0 8</windRampWindVectorComponents>"
    )
    found = winds(text, 8)
    assert found[3:7] == [(4.0, 0.0, 0.0), (4.0, 3.0, 0.0), (4.0, 3.0, 0.0), (4.0, 0.0, 0.0)]
    assert [w[2] for w in found[8:14]] == pytest.approx([0.0, 2.0, 4.0, 6.0, 8.0, 8.0])


def test_strength_and_direction_vary_and_follow_the_seed() -> None:
    variances = "<windVelocityVariance>1</windVelocityVariance><windDirectionVariance>0.01</windDirectionVariance>"
    first = winds(world(MEAN + variances), 200, seed=1)
    assert first == winds(world(MEAN + variances), 200, seed=1) != winds(world(MEAN + variances), 200, seed=2)
    speeds = [math.hypot(*w) for w in first[1:]]
    mean = math.fsum(speeds) / len(speeds)
    assert mean == pytest.approx(4.0, abs=0.2)
    assert math.sqrt(math.fsum((s - mean) ** 2 for s in speeds) / len(speeds)) == pytest.approx(1.08, abs=0.15)
    assert math.fsum(w[1] for w in first[1:]) / len(speeds) == pytest.approx(0.0, abs=0.1)
