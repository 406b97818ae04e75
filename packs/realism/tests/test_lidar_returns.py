"""Errors of range, intensities, mixed pixels, several returns, glass and mirrors."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from lidar_worlds import box, lidar, many_ranges, readings, shell, world

import simkit
from simkit_realism.beam_echoes import EchoList, beam_directions
from simkit_realism.optical_rays import Returns

WALL = shell("wall", 4.0)
ANGLES = np.linspace(-0.5, 0.5, 720)


def test_bias_scale_and_noise_by_range_are_measured_back() -> None:
    # the noise of a depth camera of a ROSMASTER X3: max(2 mm, 1.9 mm · d^2.36)
    error = """<simkit:range_error><bias>0.01</bias><scale>-0.012</scale>
      <stddev><coefficient>0.0019</coefficient><exponent>2.36</exponent><least>0.002</least></stddev></simkit:range_error>"""
    for far in (0.5, 4.0):
        found, true = many_ranges(world(lidar(error, samples=500, view=0.001), shell("wall", far)), 40)
        stddev = max(0.002, 0.0019 * far**2.36)
        difference = found - true
        assert difference.mean() == pytest.approx(0.01 - 0.012 * far, abs=4 * stddev / math.sqrt(20000))
        assert difference.std() == pytest.approx(stddev, rel=4 / math.sqrt(2 * 20000))


def test_a_resolution_rounds_ranges() -> None:
    found, true = readings(world(lidar("<simkit:range_error><resolution>0.02</resolution></simkit:range_error>"), WALL))
    steps = found.ranges / 0.02
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-4)
    assert np.abs(found.ranges - true.ranges).max() <= 0.01 + 1e-6


def test_the_steps_of_a_triangulation_lidar_grow_with_the_square_of_the_range() -> None:
    error = "<simkit:range_error><inverse_resolution>0.001</inverse_resolution></simkit:range_error>"
    for far in (2.0, 8.0):
        found, _ = readings(world(lidar(error, view=0.4), shell("wall", far)))
        values = np.unique(found.ranges)
        middle = 0.5 * (values[1:] + values[:-1])
        np.testing.assert_allclose(np.diff(values), 0.001 * middle**2, rtol=0.02)


def test_intensity_is_reflectivity_times_cosine_with_or_without_the_range() -> None:
    paint = "<simkit:reflectivity>0.8</simkit:reflectivity>"
    calibrated = "<simkit:intensity><scale>100</scale></simkit:intensity>"
    found, _ = readings(world(lidar(calibrated), shell("wall", 4.0, paint)))
    np.testing.assert_allclose(found.intensities, 80 * np.cos(ANGLES), rtol=1e-5)
    raw = "<simkit:intensity><scale>100</scale><reference_range>2</reference_range></simkit:intensity>"
    found, true = readings(world(lidar(raw), shell("wall", 4.0, paint)))
    np.testing.assert_allclose(found.intensities, 80 * np.cos(ANGLES) * (2 / true.ranges) ** 2, rtol=1e-5)
    limited = "<simkit:intensity><scale>100</scale><maximum>50</maximum><resolution>10</resolution></simkit:intensity>"
    found, _ = readings(world(lidar(limited), shell("wall", 4.0, paint)))
    assert (found.intensities == 50).all()


# ---------------------------------------------------------------------- beam

POST = box("post", "2 0 0 0 0 0", "0.1 0.4 2")  # edges at atan(0.2/1.95) = ±0.1022 rad


def beam(text: str) -> str:
    return f"<simkit:beam><divergence>0.01</divergence>{text}</simkit:beam>"


def test_the_parts_of_a_beam_fill_its_cone_evenly() -> None:
    axis = np.array(((0.6, 0.0, 0.8),))
    parts = np.concatenate((axis, beam_directions(axis, 0.02, 3)))
    assert len(parts) == 37
    angles = np.arccos(np.clip(parts @ axis[0], -1, 1))
    assert angles.max() < 0.01
    # the mean square radius of a disc is half the square of its radius
    assert (angles**2).mean() == pytest.approx(0.5 * 0.01**2, rel=0.02)
    np.testing.assert_allclose(parts[1:].sum(axis=0) / 36, axis[0] * np.cos(angles[1:]).mean(), atol=1e-12)


def test_surfaces_within_the_resolution_mix_between_them() -> None:
    found, true = readings(world(lidar(beam("<resolution>5</resolution>")), POST, WALL))
    near_edge = np.abs(np.abs(ANGLES) - 0.1022) < 0.005
    is_between = (found.ranges > 2.0) & (found.ranges < 3.9)
    assert is_between.sum() >= 8
    assert not (is_between & ~near_edge).any()
    away = np.abs(np.abs(ANGLES) - 0.1022) > 0.006
    np.testing.assert_allclose(found.ranges[away], true.ranges[away], atol=2e-4)


def test_mixed_pixels_may_read_the_nearest_surface() -> None:
    text = beam("<resolution>5</resolution><mixing>nearest</mixing>")
    found, true = readings(world(lidar(text), POST, WALL))
    assert not ((found.ranges > 2.0) & (found.ranges < 3.9)).any()
    assert (found.ranges < 2.0).sum() > (true.ranges < 2.0).sum()  # the post is wider by the footprint


@pytest.mark.parametrize("mode", ["first", "last", "strongest"])
def test_separated_surfaces_give_an_echo_each(mode: str) -> None:
    found, true = readings(world(lidar(beam(f"<resolution>0.5</resolution><returns>{mode}</returns>")), POST, WALL))
    assert not ((found.ranges > 2.1) & (found.ranges < 3.9)).any()
    wider = (found.ranges < 2.1).sum() - (true.ranges < 2.1).sum()
    # the post has the nearer and, at equal reflectivity, the stronger echo
    assert wider < 0 if mode == "last" else wider > 0


def test_echoes_of_a_beam_are_sorted_by_strength() -> None:
    ranges = np.array(((2.0,), (2.1,), (5.0,), (np.inf,)))
    ones = np.ones(4)
    parts = Returns(ranges.ravel(), np.arange(4), np.zeros((4, 3)), ones, np.array((0.2, 0.2, 8.0, 0.0)))
    echoes = EchoList(parts, 1, 0.5, False)
    strongest, first, second = (echoes.returns(e) for e in (echoes.strongest, echoes.first, echoes.second))
    assert strongest.ranges[0] == 5.0  # 8/25 against 0.2/4 + 0.2/4.41
    assert first.ranges[0] == pytest.approx((0.2 / 2.0 + 0.2 / 2.1) / (0.2 / 4.0 + 0.2 / 4.41))
    assert second.ranges[0] == first.ranges[0]
    assert first.reflectivities[0] == pytest.approx(0.1)  # the echo has half of the beam


DUAL = beam("<resolution>0.5</resolution><returns>dual</returns>")


def messages_of(text: str, *suffixes: str) -> dict[str, Any]:
    """Return the last message of some topics of the sensor."""
    found: dict[str, Any] = {}
    with simkit.load(text) as sim:
        topic = sim.sensor("m::l::scan").topic
        for suffix in suffixes:
            sim.subscribe(topic + suffix, lambda message, key=suffix: found.update({key: message}))
        sim.run(0.15)
    return found


def test_a_dual_return_has_messages_of_its_own() -> None:
    found = messages_of(world(lidar(DUAL), POST, WALL), "", "/points2", "/echoes")
    echoes, cloud, scan = found["/echoes"], found["/points2"], found[""]
    counts = np.array([len(echo.echoes) for echo in echoes.ranges])
    assert set(counts.tolist()) == {1, 2}
    double = np.flatnonzero(counts == 2)
    assert (np.abs(np.abs(ANGLES[double]) - 0.1022) < 0.005).all()
    for i in double:
        assert echoes.ranges[i].echoes[0] == scan.ranges[i]
        near, far = sorted(echoes.ranges[i].echoes)
        assert near < 2.1 and far > 3.9
    assert cloud.width == 720
    x = np.frombuffer(bytes(cloud.data), np.uint8).reshape(720, -1)[:, :4].copy().view(np.float32)[:, 0]
    assert (np.isfinite(x) == (counts == 2)).all()


def test_a_second_return_takes_the_place_of_a_lost_first_one() -> None:
    black = box("post", "2 0 0 0 0 0", "0.1 0.4 2", "<simkit:reflectivity>0.01</simkit:reflectivity>")
    zone = "<simkit:blind_zone><range>3</range></simkit:blind_zone>"
    found, _ = readings(world(lidar(DUAL + zone), POST, WALL))
    assert (found.ranges > 3.9).all()  # at the edges, the wall
    assert black
    assert np.isinf(found.ranges).sum() > 100


# ---------------------------------------------------------------------- glass and mirrors

PANE = "<simkit:transmittance>0.9</simkit:transmittance><simkit:specularity>0.05</simkit:specularity>"
MIRROR = "<simkit:specularity>0.95</simkit:specularity>"


@pytest.mark.parametrize("kind", ["lidar", "gpu_lidar"])
def test_glass_is_seen_near_its_normal_alone(kind: str) -> None:
    glass = "<simkit:glass_and_mirrors><normal_angle>0.1</normal_angle></simkit:glass_and_mirrors>"
    found, true = readings(world(lidar(glass, kind=kind), box("pane", "2 0 0 0 0 0", "0.02 8 2", PANE), WALL))
    np.testing.assert_allclose(true.ranges, 1.99 / np.cos(ANGLES), rtol=1e-6)
    is_normal = np.abs(ANGLES) < 0.1
    np.testing.assert_allclose(found.ranges[is_normal], true.ranges[is_normal])
    np.testing.assert_allclose(found.ranges[~is_normal], 4.0 / np.cos(ANGLES[~is_normal]), rtol=1e-6)


def test_nothing_behind_glass_is_no_return() -> None:
    found, _ = readings(world(lidar("<simkit:glass_and_mirrors/>"), box("pane", "2 0 0 0 0 0", "0.02 8 2", PANE)))
    assert np.isinf(found.ranges[np.abs(ANGLES) > 0.1]).all()


def test_glass_takes_light_twice() -> None:
    signal = "<simkit:signal><range>4</range><reflectivity>0.45</reflectivity></simkit:signal>"
    text = world(lidar("<simkit:glass_and_mirrors/>" + signal), box("pane", "2 0 0 0 0 0", "0.02 8 2", PANE), WALL)
    # the wall has reflectivity 0.5, and 0.5·0.81 through the glass
    assert np.isinf(readings(text)[0].ranges[np.abs(ANGLES) > 0.1]).all()
    assert np.isfinite(readings(world(lidar(signal, view=0.1), WALL))[0].ranges).all()


def test_a_mirror_shows_a_ghost_at_the_length_of_the_way() -> None:
    # a mirror at 45° turns the rays to +y, where a wall is 3 m away
    mirror = box("mirror", "2 0 0 0 0 -0.785398163397", "0.02 1 1", MIRROR)
    wall = box("side", "2 3.05 0 0 0 0", "6 0.1 4")
    found, true = readings(world(lidar("<simkit:glass_and_mirrors/>", samples=3, view=0.02), mirror, wall))
    front = 2 - 0.01 * math.sqrt(2)
    np.testing.assert_allclose(true.ranges[1], front, atol=1e-6)
    np.testing.assert_allclose(found.ranges[1], front + 3.0, atol=1e-5)
    assert (np.asarray(found.ranges) > 4.5).all()


def test_the_beam_goes_through_glass_too() -> None:
    both = beam("<resolution>0.5</resolution>") + "<simkit:glass_and_mirrors/>"
    found, _ = readings(
        world(lidar(both), box("pane", "2 0 0 0 0 0", "0.02 8 2", PANE), POST.replace("2 0 0", "3 0 0"), WALL)
    )
    wide = np.abs(ANGLES) > 0.2
    np.testing.assert_allclose(found.ranges[wide], 4.0 / np.cos(ANGLES[wide]), atol=1e-3)
