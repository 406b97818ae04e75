"""Laser plugins of ROS 1: a scan, or a block of points, on the topic of the file."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from plugin_worlds import element, stamps, world

import simkit
from simkit import msgs

WALL = "<model name='wall'><static>true</static><link name='l'><pose>2.5 0 1 0 0 0</pose>{}</link></model>".format(
    "".join(
        f"<{part} name='{part}'>{retro}<geometry><box><size>1 40 1</size></box></geometry></{part}>"
        for part, retro in (("collision", "<laser_retro>80</laser_retro>"), ("visual", ""))
    )
)  # its face is at x = 2 m, and 1 m high


def laser(library: str, kind: str = "ray", rays: int = 3, layers: int = 1, rate: float = 10, **values: Any) -> str:
    """A lidar 1 m high that looks at the wall with ±0.5 rad, and up and down with ±0.4 rad."""
    plugin = element("plugin", values, f"name='laser' filename='libgazebo_ros_{library}.so'")
    scan = "".join(
        f"<{way}><samples>{count}</samples><min_angle>-{angle}</min_angle><max_angle>{angle}</max_angle></{way}>"
        for way, count, angle in (("horizontal", rays, 0.5), ("vertical", layers, 0.4))
        if count > 1
    )
    ray = f"<ray><scan>{scan}</scan><range><min>0.1</min><max>5</max></range></ray>"
    return world(
        WALL,
        "<model name='bot'><static>true</static><link name='eye'><pose>0 0 1 0 0 0</pose>"
        f"<sensor name='s' type='{kind}'><update_rate>{rate}</update_rate>{ray}{plugin}</sensor></link></model>",
    )


def heard(source: str, topic: str, seconds: float = 0.001, seed: int = 0) -> list[Any]:
    with simkit.load(source, seed=seed) as sim:
        subscription = sim.subscribe(topic)
        sim.run(seconds)
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        return list(subscription.messages)


def points(cloud: Any) -> np.ndarray:
    return np.array([(p.x, p.y, p.z) for p in cloud.points])


@pytest.mark.parametrize(("library", "kind"), [("laser", "ray"), ("gpu_laser", "gpu_ray"), ("laser", "gpu_ray")])
def test_a_laser_publishes_its_scan(library: str, kind: str) -> None:
    source = laser(library, kind, topicName="scan", frameName="base_scan", robotNamespace="tb")
    messages = heard(source, "/tb/scan", 0.5)
    assert stamps(messages).tolist() == [1_000_000, *(100_000_000 * k for k in range(1, 6))]
    scan = messages[-1]
    assert msgs.type_name(scan) == "sensor_msgs/msg/LaserScan"
    assert scan.header.frame_id == "base_scan"
    np.testing.assert_allclose(scan.ranges, 2 / np.cos([-0.5, 0, 0.5]), rtol=1e-5)
    assert (scan.range_min, scan.range_max, scan.angle_increment) == pytest.approx((0.1, 5, 0.5))


@pytest.mark.parametrize("library", ["laser", "gpu_laser", "block_laser"])
def test_by_default_the_topic_is_gazebos_and_the_frame_the_links(library: str) -> None:
    with simkit.load(laser(library)) as sim:
        subscription = sim.subscribe("/world")
        sim.step(1)
        assert subscription.latest.header.frame_id == "eye"
        assert "SK-PLUGIN-062" in {d.code for d in sim.diagnostics}


def test_a_block_has_a_point_for_every_ray_of_every_layer() -> None:
    """Layers from the lowest, rays from the right; those over the wall's edge end at 5 m."""
    source = laser("block_laser", rays=5, layers=3, topicName="cloud", frameName="map")
    (cloud,) = heard(source, "/cloud")
    assert msgs.type_name(cloud) == "sensor_msgs/msg/PointCloud"
    assert cloud.header.frame_id == "map"
    azimuth, elevation = (a.ravel() for a in np.meshgrid(np.linspace(-0.5, 0.5, 5), [-0.4, 0, 0.4]))
    ray = np.stack((np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)), 1)
    hit = elevation == 0
    expected = ray * np.where(hit, 2 / ray[:, 0], 5.0)[:, None]
    np.testing.assert_allclose(points(cloud), expected, atol=1e-5)
    (channel,) = cloud.channels
    np.testing.assert_allclose(channel.values, np.where(hit, 80.0, 0.0))


def test_noise_is_on_every_coordinate_of_a_hit_and_on_every_intensity() -> None:
    source = laser("block_laser", rays=3, layers=3, rate=0, topicName="cloud", gaussianNoise=0.02)
    clouds = heard(source, "/cloud", 1.0, seed=2)
    quiet = heard(laser("block_laser", rays=3, layers=3, topicName="cloud"), "/cloud")[0]
    error = np.array([points(cloud) for cloud in clouds]) - points(quiet)
    hits = error[:, 3:6]
    np.testing.assert_allclose(hits.std(axis=0), 0.02, rtol=0.1)
    np.testing.assert_allclose(hits.mean(axis=0), 0, atol=0.0026)
    np.testing.assert_allclose(error[:, [0, 1, 2, 6, 7, 8]], 0, atol=1e-6)  # none where there is no reading
    bright = np.array([cloud.channels[0].values for cloud in clouds]) - quiet.channels[0].values
    np.testing.assert_allclose(bright.std(axis=0), 0.02, rtol=0.1)


def test_the_truth_of_a_block_has_no_noise() -> None:
    with simkit.load(laser("block_laser", topicName="cloud", gaussianNoise=0.5)) as sim:
        sim.step(1)
        sensor = sim.sensor("bot::eye::s")
        np.testing.assert_allclose(points(sensor.truth)[:, 0], 2, atol=1e-5)
        assert abs(points(sensor.latest)[:, 0] - 2).max() > 0.01


def test_parameters_without_effect_in_gazebo_are_reported() -> None:
    with simkit.load(laser("block_laser", topicName="c", hokuyoMinIntensity=101, updateRate=5)) as sim:
        messages = [d.message for d in sim.diagnostics if d.code == "SK-PLUGIN-061"]
        assert len(messages) == 2
        subscription = sim.subscribe("/c")
        sim.run(1.0)
        assert len(subscription.messages) == 11
        assert subscription.latest.channels[0].values.max() == 80


@pytest.mark.parametrize("library", ["laser", "gpu_laser", "block_laser"])
def test_the_plugin_needs_a_lidar(library: str) -> None:
    plugin = f"<plugin name='laser' filename='libgazebo_ros_{library}.so'><topicName>scan</topicName></plugin>"
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003.*type ray"):
        simkit.load(
            world(f"<model name='m'><link name='l'><sensor name='s' type='imu'>{plugin}</sensor></link></model>")
        )
