"""Artefacts change readings, not the ground truth, and repeat with the seed."""

from __future__ import annotations

import numpy as np

import simkit

WORLD = """
<sdf version="1.9" xmlns:simkit="simkit"><world name="w">
  <model name="m"><static>true</static><link name="l">
    <sensor name="scan" type="lidar"><update_rate>10</update_rate>
      <lidar><scan><horizontal><samples>720</samples><min_angle>-0.5</min_angle><max_angle>0.5</max_angle></horizontal></scan>
        <range><min>0.1</min><max>10</max></range></lidar>
      {artefact}
    </sensor>
  </link></model>
  <model name="wall"><static>true</static><pose>2.5 0 0 0 0 0</pose><link name="l">
    <collision name="c"><geometry><box><size>1 6 6</size></box></geometry></collision></link></model>
</world></sdf>"""
DROPOUT = "<simkit:dropout><probability>0.25</probability></simkit:dropout>"


def ranges_of(text: str, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    with simkit.load(text, seed=seed) as sim:
        sim.run(1.0)
        sensor = sim.sensor("m::l::scan")
        return np.asarray(sensor.latest.ranges), np.asarray(sensor.truth.ranges)


def test_a_quarter_of_the_rays_has_no_return_and_the_truth_has_all() -> None:
    ranges, truth = ranges_of(WORLD.format(artefact=DROPOUT))
    assert np.isfinite(truth).all()
    assert abs(np.isinf(ranges).mean() - 0.25) < 4 * np.sqrt(0.25 * 0.75 / 720)
    is_kept = np.isfinite(ranges)
    assert (ranges[is_kept] == truth[is_kept]).all()


def test_the_lost_rays_depend_on_the_seed_alone() -> None:
    text = WORLD.format(artefact=DROPOUT)
    assert (ranges_of(text)[0] == ranges_of(text)[0]).all()
    assert (ranges_of(text)[0] != ranges_of(text, seed=1)[0]).any()


def test_an_artefact_of_another_kind_of_sensor_is_an_unknown_element() -> None:
    text = WORLD.format(artefact="<simkit:rolling_shutter/>")
    with simkit.load(text) as sim:
        assert any("rolling_shutter" in d.message for d in sim.diagnostics)
