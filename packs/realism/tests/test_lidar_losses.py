"""Lost returns of lidars: each test measures the statistic back."""

from __future__ import annotations

import math

import numpy as np
import pytest
from lidar_worlds import box, lidar, many_ranges, readings, shell, world

import simkit

WALL = shell("wall", 4.0)


def dropout(text: str) -> str:
    return f"<simkit:dropout>{text}</simkit:dropout>"


def lost_by_column(text: str, samples: int = 60) -> tuple[np.ndarray, np.ndarray]:
    """Return the share of lost returns of each ray, and the true ranges."""
    found, true = many_ranges(text, samples)
    return np.isinf(found).mean(axis=0), true[0]


def tolerance(share: float, count: int) -> float:
    """Return four standard deviations of the share of `count` independent losses."""
    return 4.0 * math.sqrt(share * (1.0 - share) / count)


def test_losses_follow_a_table_by_range() -> None:
    law = dropout("<by_range><table>0 0  4 0  6 0.5</table></by_range>")
    near, far = box("near", "3.5 1 0 0 0 0", "1 2 4"), box("far", "5.5 -1 0 0 0 0", "1 2 4")
    lost, true = lost_by_column(world(lidar(law, samples=400, view=0.3), near, far))
    expected = np.interp(true, (0, 4, 6), (0, 0, 0.5))
    assert lost[true < 4].max() == 0.0
    is_far = true > 4.9
    assert abs((lost - expected)[is_far].mean()) < tolerance(0.25, 60 * is_far.sum())


def test_losses_follow_a_power_of_the_range() -> None:
    law = dropout("<by_range><coefficient>0.01</coefficient><exponent>2</exponent></by_range>")
    lost, true = lost_by_column(world(lidar(law), WALL))
    assert abs((lost - 0.01 * true**2).mean()) < tolerance(0.17, 60 * 720)


def test_losses_follow_the_angle_of_incidence() -> None:
    law = dropout("<by_incidence><table>0 0  1.0 0  1.4 0.8</table></by_incidence>")
    lost, true = lost_by_column(world(lidar(law, samples=600, view=1.4), shell("wall", 2.0)))
    angles = np.linspace(-1.4, 1.4, 600)
    is_wall = np.isclose(true, 2.0 / np.cos(angles), rtol=1e-6)
    assert is_wall.sum() > 400
    expected = np.interp(np.abs(angles), (0, 1.0, 1.4), (0, 0, 0.8))
    assert lost[is_wall & (np.abs(angles) < 1.0)].max() == 0.0
    steep = is_wall & (np.abs(angles) > 1.1)
    assert abs((lost - expected)[steep].mean()) < tolerance(0.5, 60 * steep.sum())


@pytest.mark.parametrize("kind", ["lidar", "gpu_lidar"])
def test_losses_follow_the_reflectivity_of_collisions_and_visuals(kind: str) -> None:
    law = dropout("<by_reflectivity><table>0 1  0.5 0</table></by_reflectivity>")
    black = box("black", "3 -1 0 0 0 0", "0.1 2 2", "<simkit:reflectivity>0.1</simkit:reflectivity>")
    plain = box("plain", "3 1 0 0 0 0", "0.1 2 2")
    lost, _ = lost_by_column(world(lidar(law, samples=200, view=0.3, kind=kind), black, plain))
    assert abs(lost[:99].mean() - 0.8) < tolerance(0.8, 60 * 99)
    assert lost[101:].max() == 0.0


def test_bursts_keep_the_share_and_have_the_mean_length() -> None:
    law = dropout("<probability>0.25</probability><burst_length>6</burst_length>")
    found, _ = many_ranges(world(lidar(law), WALL), 80)
    is_lost = np.isinf(found)
    # a run of six rays counts as one draw
    assert abs(is_lost.mean() - 0.25) < tolerance(0.25, 80 * 720 // 6)
    begins = is_lost & ~np.roll(is_lost, 1, axis=1)
    begins[:, 0] = is_lost[:, 0]
    # neighbouring runs that are both lost look like one: the mean burst is 6 / (1 - 0.25) rays
    assert is_lost.sum() / begins.sum() == pytest.approx(8.0, rel=0.06)


def test_a_weak_return_is_lost_at_the_range_of_its_reflectivity_and_incidence() -> None:
    signal = "<simkit:signal><range>2</range><reflectivity>0.1</reflectivity></simkit:signal>"
    # reflectivity 0.5 at incidence a is seen up to 2·sqrt(5·cos a); on a wall at 3 m, r = 3/cos a
    found, true = readings(world(lidar(signal, view=0.9), shell("wall", 3.0)))
    angles = np.linspace(-0.9, 0.9, 720)
    is_seen = 3.0 / np.cos(angles) <= 2.0 * np.sqrt(5.0 * np.cos(angles))
    assert 100 < is_seen.sum() < 700
    assert (np.isfinite(found.ranges) == is_seen).mean() > 0.997  # at most the rays on the limit
    assert np.isfinite(true.ranges).all()


def test_the_spread_of_the_signal_makes_the_loss_a_probability() -> None:
    signal = "<simkit:signal><range>4</range><reflectivity>0.5</reflectivity><spread>0.2</spread></simkit:signal>"
    lost, _ = lost_by_column(world(lidar(signal, samples=100, view=0.001), WALL), 80)
    assert abs(lost.mean() - 0.5) < tolerance(0.5, 8000)  # exactly at the threshold
    lost, _ = lost_by_column(world(lidar(signal, samples=100, view=0.001), shell("wall", 4.0 / math.sqrt(1.2))), 80)
    expected = 0.5 * math.erfc((0.2 / 1.2) / 0.2 / math.sqrt(2))  # 1.2·(1 + 0.2·n) < 1
    assert abs(lost.mean() - expected) < tolerance(expected, 8000)


def test_a_blind_zone_loses_near_returns_and_falsifies_the_rest() -> None:
    limits = "<range>1</range><probability>0.7</probability><false_range>0.2</false_range>"
    zone = f"<simkit:blind_zone>{limits}</simkit:blind_zone>"
    near = box("near", "0.9 0.5 0 0 0 0", "0.1 1 1")
    found, true = many_ranges(world(lidar(zone), near, WALL), 40)
    is_near = true < 1.0
    assert (found[~is_near] == true[~is_near]).all()
    share = np.isinf(found[is_near]).mean()
    assert abs(share - 0.7) < tolerance(0.7, int(is_near.sum()))
    kept = found[is_near & np.isfinite(found)]
    np.testing.assert_allclose(kept, 0.2, atol=1e-6)


def test_sectors_are_blocked_or_read_the_housing() -> None:
    zone = """<simkit:blind_zone><sector><min_angle>0.1</min_angle><max_angle>0.2</max_angle></sector>
      <sector><min_angle>6.083</min_angle><max_angle>6.183</max_angle><range>0.15</range></sector></simkit:blind_zone>"""
    found, true = readings(world(lidar(zone), WALL))
    angles = np.linspace(-0.5, 0.5, 720)
    assert np.isinf(found.ranges[(angles > 0.1005) & (angles < 0.1995)]).all()
    np.testing.assert_allclose(found.ranges[(angles > -0.1995) & (angles < -0.1005)], 0.15, atol=1e-6)
    rest = np.abs(np.abs(angles) - 0.15) > 0.0505
    assert (found.ranges[rest] == true.ranges[rest]).all()


SUN = """<light name="sun" type="directional"><direction>-1 0 0</direction></light>"""


def test_the_sun_blinds_the_rays_around_it_unless_it_is_hidden() -> None:
    sun = "<simkit:sun><angle>0.2</angle><probability>0.6</probability></simkit:sun>"
    post = box("post", "3 0.4 0 0 0 0", "0.1 0.5 1")  # beside the line to the sun
    lost, true = lost_by_column(world(lidar(sun), post, SUN), 80)
    angles = np.linspace(-0.5, 0.5, 720)
    is_post = np.isfinite(true)
    blinded = is_post & (angles < 0.199)
    assert blinded.sum() > 50
    assert abs(lost[blinded].mean() - 0.6) < tolerance(0.6, 80 * int(blinded.sum()))
    assert lost[is_post & (angles > 0.201)].max() == 0.0
    lost, _ = lost_by_column(world(lidar(sun), WALL, SUN), 2)
    assert lost.max() == 0.0


def test_sunlit_surfaces_lose_returns_by_the_cosine_to_the_sun() -> None:
    sun = """<simkit:sun><angle>0</angle><probability>0</probability><lit_probability>0.8</lit_probability>
      <azimuth>3.141592653589793</azimuth><elevation>1.0471975511965976</elevation></simkit:sun>"""
    lost, _ = lost_by_column(world(lidar(sun), WALL), 40)
    assert abs(lost.mean() - 0.4) < tolerance(0.4, 40 * 720)  # the wall faces -x: cos 60°


def test_a_missing_return_reads_what_the_driver_writes() -> None:
    for value, expected in (("zero", 0.0), ("maximum", 30.0), ("nan", math.nan), ("inf", math.inf)):
        artefact = f"<simkit:no_return><value>{value}</value></simkit:no_return>"
        found, true = readings(world(lidar(artefact, samples=3), box("b", "4 0 0 0 0 0", "1 0.1 1")))
        np.testing.assert_allclose(found.ranges, (expected, 3.5, expected), atol=1e-6)
        assert math.isinf(true.ranges[0])


@pytest.mark.parametrize(
    ("artefact", "code"),
    [
        (dropout("<by_range><table>0 0 1</table></by_range>"), "SK-SENSOR-210"),
        (dropout("<by_range><table>1 0  0 0.5</table></by_range>"), "SK-SENSOR-210"),
        (dropout("<by_range><table>0 0  1 1.5</table></by_range>"), "SK-SENSOR-210"),
        ("<simkit:blind_zone><sector><min_angle>1</min_angle><max_angle>0</max_angle></sector></simkit:blind_zone>",
         "SK-SENSOR-212"),
    ],
)  # fmt: skip
def test_impossible_options_are_errors_at_their_place(artefact: str, code: str) -> None:
    with pytest.raises(simkit.errors.SimkitError) as raised:
        simkit.load(world(lidar(artefact)))
    assert code in str(raised.value)


@pytest.mark.parametrize(
    ("artefact", "code"),
    [
        (dropout("<probability>0</probability>"), "SK-SENSOR-211"),
        ("<simkit:blind_zone/>", "SK-SENSOR-211"),
        ("<simkit:sun/>", "SK-SENSOR-213"),
    ],
)
def test_artefacts_without_effect_are_reported(artefact: str, code: str) -> None:
    with simkit.load(world(lidar(artefact))) as sim:
        assert code in [d.code for d in sim.diagnostics]
