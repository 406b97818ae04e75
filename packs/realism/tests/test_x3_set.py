"""The set of a ROSMASTER X3 gives a run the statistics that its owners measured on the real robot."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import simkit
from simkit.sensors.presets import presets
from simkit.sensors.realism import realism_sets

WALL = """<sdf version="1.11"><world name="wall">
  <model name="floor"><static>true</static><link name="l"><visual name="v"><geometry><plane><normal>0 0 1</normal>
    <size>30 30</size></plane></geometry></visual></link></model>
  <model name="wall"><static>true</static><pose>{x} 0 5 0 0 0</pose><link name="l"><visual name="v"><geometry><box>
    <size>0.2 30 10</size></box></geometry></visual></link></model>
  <model name="x3"><static>true</static><pose>0 0 0.109 0 0 0</pose><link name="base_link">
    <sensor name="{name}" type="{kind}"><update_rate>5</update_rate>{block}</sensor></link></model>
</world></sdf>"""
CAMERA = """<camera><horizontal_fov>1.5184</horizontal_fov><image><width>424</width><height>240</height></image>
  <clip><near>0.05</near><far>8</far></clip></camera>"""


def near(kind: str, name: str, block: str, distance: float) -> simkit.Simulation:
    """Load a sensor of the robot at a distance [m] from a wall."""
    text = WALL.format(x=distance + 0.1, name=name, kind=kind, block=block)
    return simkit.load(text, realism="rosmaster_x3")


def depths(message: Any) -> np.ndarray:
    return np.frombuffer(bytes(message.data), np.float32).reshape(message.height, message.width)


@pytest.mark.parametrize(("distance", "valid"), [(0.63, 61.1), (1.12, 57.0), (3.6, 48.0)])
def test_scale_noise_and_valid_pixels_in_front_of_a_wall(distance: float, valid: float) -> None:
    with near("depth_camera", "depth", CAMERA, distance) as sim:
        sensor = sim.sensor("x3::base_link::depth")
        sim.run(0.1)
        image, truth = depths(sensor.latest), depths(sensor.truth)
        assert image.shape == (240, 320)
        assert 100 * np.isfinite(image).mean() == pytest.approx(valid, abs=2.0)
        seen = image[np.isfinite(image)]
        sigma = max(0.002, 0.0019 * (distance / 1.012) ** 2.36)
        assert seen.std() == pytest.approx(sigma, rel=0.05)
        assert seen.mean() / distance - 1 == pytest.approx(-0.011858, abs=4 * sigma / distance / np.sqrt(seen.size))
        is_floor = np.isfinite(truth) & (truth < distance - 1e-3)
        assert is_floor.any() and np.isnan(image[is_floor]).all()


def test_the_wedge_at_a_short_distance_comes_from_the_left() -> None:
    with near("depth_camera", "depth", CAMERA, 0.45) as sim:
        sim.run(0.1)
        seen = np.isfinite(depths(sim.sensor("x3::base_link::depth").latest))
        assert 100 * seen.mean() == pytest.approx(35.4, abs=4.0)
        assert not seen[120:160, :100].any() and seen[:40, 160:280].mean() > 0.85


def test_a_quarter_of_the_rays_has_no_return_and_a_scan_comes_one_turn_late() -> None:
    block = "<lidar><range><min>0.05</min><max>12</max></range></lidar>"
    with near("gpu_lidar", "lidar", block, 2.0) as sim:
        found: list[tuple[float, Any]] = []
        topic = sim.sensor("x3::base_link::lidar").topic
        sim.subscribe(topic, lambda message: found.append((sim.time, message)))
        sim.run(4.5)
        sensor = sim.sensor("x3::base_link::lidar")
        hits = np.isfinite(sensor.truth.ranges)
        lost = ~np.isfinite([message.ranges[hits] for _, message in found])
        assert 100 * lost.mean() == pytest.approx(25.3, abs=1.0)
        late = [time - m.header.stamp.sec - 1e-9 * m.header.stamp.nanosec for time, m in found]
        assert np.median(late) == pytest.approx(0.1357, abs=0.001)
        assert found[-1][1].time_increment == pytest.approx(0.0001245, abs=1e-7)


@pytest.mark.slow
def test_clouds_have_the_gaps_of_the_real_robot() -> None:
    with near("rgbd_camera", "cloud", CAMERA, 2.0) as sim:
        stamps: list[float] = []
        topic = next(name for name in sim.topics() if name.endswith("/points"))
        sim.subscribe(topic, lambda m: stamps.append(m.header.stamp.sec + 1e-9 * m.header.stamp.nanosec), keep=1)
        sim.run(30.0)
        frames = np.rint(30 * np.diff(stamps))
        # mean 3.63 and deviation 4.0 of the published histogram
        assert frames.mean() == pytest.approx(3.63, abs=4 * 4.0 / np.sqrt(frames.size))
        assert (frames == 1).mean() == pytest.approx(0.331, abs=4 * np.sqrt(0.331 * 0.669 / frames.size))
        assert frames.min() >= 1 and frames.max() <= 34


def test_all_sets_load_on_their_robots() -> None:
    assert set(realism_sets()) == {"create3", "rosmaster_x3", "tiago", "turtlebot3_burger", "turtlebot3_waffle_pi"}
    for robot in ("turtlebot3_burger", "turtlebot3_waffle_pi"):
        with simkit.load(robot, realism=robot) as sim:
            assert [d for d in sim.diagnostics if d.severity == "warning"] == []
    with simkit.load("x3_room", realism="rosmaster_x3") as sim:
        assert [d for d in sim.diagnostics if d.severity == "warning"] == []


def test_no_preset_has_an_element_that_no_pack_provides() -> None:
    from simkit.sensors.artefacts import artefact_elements
    from simkit.sensors.presets.preset import TIMING_ELEMENTS

    known = {*artefact_elements(), *TIMING_ELEMENTS}
    assert [(p.name, name) for p in presets() for name in p.beside if name not in known] == []
