"""The solar tracker follows the sun through a day, waits in the chimney's shadow, and gains by it."""

from __future__ import annotations

import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("pvlib", reason="the sun's position is pvlib's")

import simkit

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "solar_tracker"


@pytest.fixture(scope="module")
def days() -> Any:
    return runpy.run_path(str(EXAMPLE / "day.py"))["run"]()


def between(day: Any, first: float, last: float) -> Any:
    return (day.hours > first) & (day.hours < last)


def test_the_panel_follows_the_sun_within_three_degrees(days: Any) -> None:
    tracker = days["tracker"]
    # the sun moves 15 degrees an hour, 0.087 rad in a second of the run; the gain is 2 per second
    followed = np.degrees(tracker.incidence[between(tracker, 5, 13) | between(tracker, 15, 19)])
    assert followed.max() < 3.5
    # at noon the sun stands 26.6 degrees from the zenith, the stand's normal 35 degrees
    assert np.degrees(days["stand"].incidence.min()) == pytest.approx(35 - (50.08 - 23.44), abs=0.1)


def test_it_gains_half_as_much_again_as_a_panel_on_a_stand(days: Any) -> None:
    gain = days["tracker"].energy / days["stand"].energy
    assert 1.4 < gain < 1.6
    # of 1.25 m² with 20 % of some 920 W/m²
    assert days["tracker"].power.max() == pytest.approx(0.25 * 925, rel=0.03)


def test_there_is_no_power_in_shadow_and_at_night(days: Any) -> None:
    tracker, stand = days["tracker"], days["stand"]
    assert set(tracker.shadow) == {"", "chimney::link::bricks"}
    assert not tracker.power[tracker.shadow != ""].any()
    night = (tracker.hours < 2.9) | (tracker.hours > 19.3)
    assert not tracker.power[night].any() and not stand.power[night].any()
    assert (tracker.power[between(tracker, 4, 13)] > 0).all()


def test_the_shadow_is_where_geometry_puts_it() -> None:
    low, high = np.array((-6.8, -3.8, 0.0)), np.array((-5.2, -2.2, 10.0))
    seen = set()
    with simkit.load(EXAMPLE / "world.sdf", plugin_paths=[EXAMPLE]) as sim:
        sensor, sun = sim.sensor("tracker::panel::sun"), sim.light("sun")
        sim.run(31)
        for _ in range(80):
            sim.run(0.1)
            origin, towards = sensor.pose.position, -sun.direction
            ends = np.sort(np.array(((low - origin) / towards, (high - origin) / towards)), axis=0)
            is_hit = ends[0].max() < ends[1].min()
            assert (sensor.shadow == "chimney::link::bricks") is bool(is_hit)
            seen.add(bool(is_hit))
    assert seen == {True, False}


def test_the_same_seed_gives_the_same_day(days: Any) -> None:
    with simkit.load(EXAMPLE / "world.sdf", plugin_paths=[EXAMPLE], seed=0) as sim:
        sim.run(30)
        found = sim.sensor("tracker::panel::sun").reading
    index = 30 * 10 - 1  # a reading every 0.1 s
    assert found.power == days["tracker"].power[index]
    assert found.incidence == days["tracker"].incidence[index]
