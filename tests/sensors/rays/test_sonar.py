"""Sonar, compared with the geometry of a cone."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from sensor_worlds import box, noise, sensor, world

import simkit
from simkit.sensors.rays.nearest_in_cone import MAX_RINGS, MIN_RAY_ANGLE, cone_directions

FORWARD = "<axis>1 0 0</axis>"
HALF = math.atan2(0.5, 4.0)  # of the cone below


def sonar(inside: str = FORWARD, *, low: float = 0.02, high: float = 4.0, radius: float = 0.5, rate: float = 20) -> str:
    block = f"<sonar><min>{low}</min><max>{high}</max><radius>{radius}</radius>{inside}</sonar>"
    return sensor("sonar", block, rate=rate)


def reading(text: str, seed: int = 0) -> Any:
    with simkit.load(text, seed=seed) as sim:
        sim.run(0.1)
        device = sim.sensor("m::l::s")
        return device.latest, device.hit, [d for d in sim.diagnostics if d.severity != "note"]


def ball(pose: str, radius: float) -> str:
    shape = f"<geometry><sphere><radius>{radius}</radius></sphere></geometry>"
    return f"""<model name="ball"><static>true</static><pose>{pose}</pose><link name="l">
      <collision name="c">{shape}</collision></link></model>"""


def pole(pose: str, radius: float) -> str:
    shape = f"<geometry><cylinder><radius>{radius}</radius><length>4</length></cylinder></geometry>"
    return f"""<model name="pole"><static>true</static><pose>{pose}</pose><link name="l">
      <collision name="c">{shape}</collision></link></model>"""


def test_a_wall_across_is_exactly_its_distance_away() -> None:
    message, hit, problems = reading(world(sonar(), others=box("wall", "2.5 0 1 0 0 0", "1 9 9")))
    assert message.range == pytest.approx(2.0, abs=1e-9)
    assert hit == "wall::l::c"
    assert message.radiation_type == 0
    assert message.field_of_view == pytest.approx(2 * HALF)
    assert (message.min_range, message.max_range) == pytest.approx((0.02, 4.0))
    assert problems == []


def test_a_slightly_rotated_wall_is_detected_at_the_foot_of_the_perpendicular() -> None:
    """The wall is rotated by 5 degrees, less than the half angle, so the foot of the perpendicular is in the cone."""
    turn = math.radians(5)
    message, *_ = reading(world(sonar(), others=box("wall", f"3 0 1 0 0 {turn}", "0.002 9 9")))
    assert message.range == pytest.approx(3 * math.cos(turn) - 0.001, rel=1e-4)


def test_a_strongly_rotated_wall_is_detected_on_the_edge_of_the_cone() -> None:
    """The wall is rotated by 40 degrees, so the nearest point is on the edge of the cone."""
    turn = math.radians(40)
    message, *_ = reading(world(sonar(), others=box("wall", f"2 0 1 0 0 {turn}", "0.0002 9 9")))
    expected = 2 * math.cos(turn) / math.cos(turn - HALF)
    assert message.range == pytest.approx(expected, rel=1e-3)
    assert message.range >= expected - 2e-4


@pytest.mark.parametrize("away", [0.0, 0.1, 0.3])
def test_a_ball_in_the_cone_is_detected_at_its_nearest_point(away: float) -> None:
    message, hit, _ = reading(world(sonar(), others=ball(f"3 {away} 1 0 0 0", 0.15)))
    exact = math.hypot(3, away) - 0.15
    spacing = HALF / math.ceil(HALF / MIN_RAY_ANGLE)
    # off by at most 0.75 of a spacing, on a surface that curves away
    assert exact - 1e-9 <= message.range <= exact + (3 * 0.75 * spacing) ** 2 / (2 * 0.15) * 1.1
    assert hit == "ball::l::c"


@pytest.mark.parametrize("roll", [0.1, 0.7, 1.3])
@pytest.mark.parametrize("turn", [30, 60, 80])
def test_a_steep_wall_is_detected_on_the_edge_of_the_cone_in_every_direction(turn: float, roll: float) -> None:
    """The nearest point is between two rays of the edge; without denser rays the range was up to 2 cm too large."""
    tilt = math.radians(turn)
    wall = box("wall", f"2 0 1 0 0 {tilt}", "0.0002 9 9")
    message, *_ = reading(world(sonar(), others=wall, pose=f"0 0 1 {roll} 0 0"))
    expected = 2 * math.cos(tilt) / math.cos(tilt - HALF)
    assert message.range == pytest.approx(expected, abs=5e-4)


@pytest.mark.parametrize("roll", [0.0, 0.4, 1.1])
@pytest.mark.parametrize("side", [0.02, 0.1, 0.2, 0.24])
def test_a_box_that_is_partly_in_the_cone_is_detected_at_its_edge(side: float, roll: float) -> None:
    others = box("crate", f"2.5 {side + 0.5} 1 0 0 0", "1 1 4")
    message, hit, _ = reading(world(sonar(), others=others, pose=f"0 0 1 {roll} 0 0"))
    assert message.range == pytest.approx(math.hypot(2, side), abs=2e-4)
    assert hit == "crate::l::c"


def test_of_two_objects_the_nearer_one_is_found_between_the_rays() -> None:
    """The edge of the crate is nearer than the pole, but each ray that hits the crate hits it farther away."""
    edge = 2 * math.tan(HALF - math.radians(0.1))
    others = box("crate", f"2.5 {edge + 0.5} 1 0 0 0", "1 1 4") + pole(f"{math.hypot(2, edge) + 0.101} 0 1 0 0 0", 0.1)
    message, hit, _ = reading(world(sonar(), others=others, pose="0 0 1 0.3 0 0"))
    assert message.range == pytest.approx(math.hypot(2, edge), abs=2e-4)
    assert hit == "crate::l::c"


def test_a_ball_beside_the_cone_is_not_detected() -> None:
    for angle, seen in ((HALF - 0.02, True), (HALF + 0.06, False)):
        place = f"{2 * math.cos(angle)} {2 * math.sin(angle)} 1 0 0 0"
        message, *_ = reading(world(sonar(), others=ball(place, 0.1)))
        assert math.isfinite(message.range) == seen, angle


def test_a_thin_pole_is_detected() -> None:
    """The pole covers half a degree at 2.3 m and crosses the cone."""
    message, *_ = reading(world(sonar(), others=pole("2.3 0.11 1 0 0 0", 0.01)))
    assert message.range == pytest.approx(math.hypot(2.3, 0.11) - 0.01, abs=4e-3)


def test_without_an_axis_the_cone_points_down_as_in_classic() -> None:
    """The sensor is 1 m above the ground with a range of 2 m: it reads 1 m, and inf after it turns sideways."""
    ground = box("ground", "0 0 -0.5 0 0 0", "20 20 1")
    down = sonar("", low=0, high=2, radius=0.2)
    assert reading(world(down, others=ground))[0].range == pytest.approx(1.0)
    assert reading(world(down, others=ground, pose="0 0 1 0 1.5707963 0"))[0].range == math.inf


def test_nearer_and_farther_than_its_range_are_infinite() -> None:
    near = world(sonar(low=0.5), others=box("wall", "0.8 0 1 0 0 0", "1 9 9"))
    assert reading(near)[0].range == -math.inf
    far = world(sonar(), others=box("wall", "5 0 1 0 0 0", "1 9 9"))
    assert reading(far)[0].range == math.inf
    assert reading(far)[1] == ""


def test_a_sphere_looks_all_around() -> None:
    around = sonar("<geometry>sphere</geometry>", radius=0)
    for pose in ("0 0 2.75 0 0 0", "0 -1.75 1 0 0 0", "-1.75 0 1 0 0 0"):
        message, *_ = reading(world(around, others=box("wall", pose, "0.5 0.5 0.5")))
        assert message.range == pytest.approx(1.5, abs=1e-9)
        assert message.field_of_view == pytest.approx(2 * math.pi)


def test_its_own_link_is_not_met() -> None:
    shell = '<collision name="shell"><geometry><sphere><radius>0.3</radius></sphere></geometry></collision>'
    wall = box("wall", "2.5 0 1 0 0 0", "1 9 9")
    for static in (True, False):
        text = world(sonar(), others=wall, body=shell, static=static, top="<gravity>0 0 0</gravity>")
        assert reading(text)[0].range == pytest.approx(2.0, abs=1e-6)


def test_its_noise_has_the_deviation_asked_for_and_never_leaves_the_range() -> None:
    wall = box("wall", "2.5 0 1 0 0 0", "1 9 9")
    with simkit.load(world(sonar(FORWARD + noise(0.01), rate=0), others=wall), seed=2) as sim:
        sub = sim.subscribe(sim.sensor("m::l::s").topic)
        sim.run(2.0)
        ranges = np.array([m.range for m in sub.messages])
        assert ranges.std() == pytest.approx(0.01, rel=0.06)
        assert ranges.mean() == pytest.approx(2.0, abs=1e-3)
        assert sim.sensor("m::l::s").truth.range == pytest.approx(2.0, abs=1e-9)
    at_the_end = world(sonar(FORWARD + noise(0.5), rate=0), others=box("wall", "4.49 0 1 0 0 0", "1 9 9"))
    with simkit.load(at_the_end, seed=2) as sim:
        sub = sim.subscribe(sim.sensor("m::l::s").topic)
        sim.run(0.5)
        ranges = np.array([m.range for m in sub.messages])
        assert np.isfinite(ranges).all()
        assert ranges.max() == 4.0


def test_gazebos_topic_and_inspect() -> None:
    with simkit.load(world(sonar())) as sim:
        assert sim.sensor("m::l::s").topic == "/world/w/model/m/link/l/sensor/s/sonar"
    shown = simkit.describe(world(sonar()))["worlds"][0]["models"][0]["links"][0]["sensors"][0]["sonar"]
    assert shown["field_of_view"] == pytest.approx(2 * HALF)
    assert (shown["range_min"], shown["range_max"], shown["axis"]) == (0.02, 4.0, [1, 0, 0])


@pytest.mark.parametrize(
    ("block", "said"),
    [
        ("<min>3</min><max>2</max>", "from 3 to 2 m"),
        ("<radius>-1</radius>", "at least 0"),
        ("<geometry>pyramid</geometry>", "cone, sphere"),
        ("<axis>0 0 0</axis>", "length 0"),
    ],
)
def test_invalid_values_are_reported(block: str, said: str) -> None:
    with pytest.raises(simkit.LoadError, match=said):
        simkit.load(world(sensor("sonar", f"<sonar>{block}</sonar>")))


@pytest.mark.parametrize("half_angle", [0.0, 1e-4, math.radians(7.5), math.radians(26), math.radians(80), math.pi])
def test_rays_fill_the_cone_and_stay_in_it(half_angle: float) -> None:
    axis = (0.6, 0.0, -0.8)
    rays = cone_directions(half_angle, axis)
    np.testing.assert_allclose(np.linalg.norm(rays, axis=1), 1.0)
    np.testing.assert_allclose(rays[0], axis, atol=1e-12)
    angles = np.arccos(np.clip(rays @ np.array(axis), -1, 1))
    assert angles.max() <= half_angle + 1e-7
    if half_angle < 0.01 or half_angle >= math.pi:
        return
    assert angles.max() == pytest.approx(half_angle)
    rings = min(math.ceil(half_angle / MIN_RAY_ANGLE), MAX_RINGS)
    rng = np.random.default_rng(0)
    tilt, turn = half_angle * np.sqrt(rng.random(4000)), 2 * np.pi * rng.random(4000)
    upright = np.stack((np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)), -1)
    gaps = np.arccos(np.clip((upright @ cone_directions(half_angle, (0, 0, 1)).T).max(axis=1), -1, 1))
    assert gaps.max() < 0.75 * half_angle / rings
