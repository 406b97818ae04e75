"""Artefacts of lidars that sweep: each ray has its own pose and time, and so have the surfaces that it hits."""

from __future__ import annotations

import numpy as np
from lidar_worlds import box, lidar, readings, shell, world

import simkit

SWEEP = "<simkit:sweep><duration>0.09</duration></simkit:sweep>"
RADIUS = 0.5
BALL = f"""<model name="ball"><pose>2 -0.3 0.1 0 0 0</pose><link name="l"><gravity>false</gravity>
  <collision name="c"><geometry><sphere><radius>{RADIUS}</radius></sphere></geometry></collision></link></model>"""
CAR = """<model name="m"><pose>0 0 0 0 0 0</pose><link name="l"><gravity>false</gravity>{sensor}</link></model>"""


def test_the_incidence_on_a_moving_body_is_that_at_the_time_of_the_ray() -> None:
    text = world(lidar("<simkit:intensity><scale>100</scale></simkit:intensity>" + SWEEP), BALL)
    with simkit.load(text) as sim:
        ball = sim.link("ball::l")
        sim.model("ball").set_velocity((0.5, 2.0, 0.3))
        times, centres = [], []
        while sim.time_ns < 200_000_000:
            times.append(sim.time_ns * 1e-9)
            centres.append(np.array(ball.pose.position))
            sim.run(0.001)
        sensor = sim.sensor("m::l::scan")
        scan, ray_times = sensor.latest, sensor.ray_times
        stamp = scan.header.stamp.sec + 1e-9 * scan.header.stamp.nanosec
        at = stamp + np.asarray(ray_times)
        centre = np.column_stack([np.interp(at, times, np.array(centres)[:, i]) for i in range(3)])
    is_hit = np.isfinite(scan.ranges)
    assert is_hit.sum() > 100
    square, far = (centre**2).sum(axis=1)[is_hit], np.asarray(scan.ranges, float)[is_hit]
    cosine = (square - far**2 - RADIUS**2) / (2 * far * RADIUS)  # law of cosines: sensor, hit, centre
    np.testing.assert_allclose(scan.intensities[is_hit], 50 * cosine, atol=0.02)


def test_a_beam_without_width_changes_no_range_of_a_sweep() -> None:
    artefact = "<simkit:beam><divergence>1e-9</divergence></simkit:beam><simkit:glass_and_mirrors/>"
    parts = shell("wall", 4.0), box("post", "2 0.3 0 0 0 0.3", "0.1 0.4 2"), BALL
    found, true = readings(world(lidar(artefact + SWEEP), *parts), 0.2)
    assert (np.isfinite(found.ranges) == np.isfinite(true.ranges)).all()
    assert np.isclose(found.ranges, true.ranges, atol=1e-5).mean() > 0.99  # rays at edges may take either side


def test_a_turning_sensor_sees_through_glass_at_each_rays_own_pose() -> None:
    pane = "<simkit:transmittance>0.9</simkit:transmittance>"
    static = lidar("<simkit:glass_and_mirrors/>" + SWEEP, samples=181)
    car = CAR.format(sensor=static[static.index("<sensor") : static.index("</link>")])
    parts = shell("wall", 4.0), box("pane", "2 0 0 0 0 0", "0.02 8 2", pane)
    with simkit.load(world(car, *parts)) as sim:
        sim.model("m").set_velocity((0, 0, 0), (0, 0, 3.0))
        sim.run(0.1)
        sensor = sim.sensor("m::l::scan")
        scan, truth = sensor.latest, sensor.truth
        stamp = scan.header.stamp.sec + 1e-9 * scan.header.stamp.nanosec
        yaw = 3.0 * (stamp + np.asarray(sensor.ray_times))
    angles = np.linspace(-0.5, 0.5, 181) + yaw
    np.testing.assert_allclose(truth.ranges, 1.99 / np.cos(angles), rtol=1e-4)
    is_oblique = np.abs(angles) > 0.1
    assert is_oblique.sum() > 50
    assert (np.abs(angles) < 0.08).sum() > 5
    np.testing.assert_allclose(scan.ranges[is_oblique], 4.0 / np.cos(angles[is_oblique]), rtol=1e-4)
    is_normal = np.abs(angles) < 0.08
    np.testing.assert_allclose(scan.ranges[is_normal], truth.ranges[is_normal])
