"""Several Classic plugins on one sensor: each publishes, and none replaces another."""

from __future__ import annotations

import pytest

import simkit

OUTPUTS = ("PointCloud2", "PointCloud", "LaserScan", "Range")
PLUGINS = "".join(
    f"""<plugin name="{output}" filename="libgazebo_ros_ray_sensor.so"><ros><namespace>/ray</namespace>
      <argument>~/out:={output}</argument></ros><output_type>sensor_msgs/{output}</output_type></plugin>"""
    for output in OUTPUTS
)


def lidar(plugins: str) -> str:
    return f"""<sdf version="1.6"><world name="w"><gravity>0 0 0</gravity>
      <model name="wall"><static>true</static><pose>3.5 0 0 0 0 0</pose><link name="l"><collision name="c"><geometry>
        <box><size>1 9 9</size></box></geometry></collision></link></model>
      <model name="m"><link name="eye"><sensor name="s" type="ray"><update_rate>10</update_rate>
        <ray><scan><horizontal><samples>5</samples><min_angle>-0.5</min_angle><max_angle>0.5</max_angle></horizontal></scan>
          <range><min>0.1</min><max>10</max></range></ray>{plugins}</sensor></link></model></world></sdf>"""


def test_each_output_is_published() -> None:
    with simkit.load(lidar(PLUGINS)) as sim:
        subs = {output: sim.subscribe(f"/ray/{output}") for output in OUTPUTS}
        sim.step(150)
        assert not [t for t in sim.topics() if t.startswith("/world/") and t not in sim.communication.bus.aside]
        assert all(sim.topics()[f"/ray/{output}"] == f"sensor_msgs/msg/{output}" for output in OUTPUTS)
        assert {output: len(sub.messages) for output, sub in subs.items()} == dict.fromkeys(OUTPUTS, 2)
        assert subs["Range"].latest.range == pytest.approx(3.0)
        assert subs["LaserScan"].latest.ranges[2] == pytest.approx(3.0)
        assert subs["PointCloud2"].latest.width == len(subs["PointCloud"].latest.points) == 5
        assert {sub.latest.header.frame_id for sub in subs.values()} == {"eye"}


def test_the_same_output_is_published_on_two_topics() -> None:
    twice = "".join(
        f"""<plugin name="{name}" filename="libgazebo_ros_ray_sensor.so">
        <output_type>sensor_msgs/LaserScan</output_type><ros><remapping>~/out:={name}</remapping></ros></plugin>"""
        for name in ("front", "copy")
    )
    with simkit.load(lidar(twice)) as sim:
        front, copy = sim.subscribe("/front"), sim.subscribe("/copy")
        sim.step(150)
        assert sim.sensor("m::eye::s").topic == "/front"
        assert len(front.messages) == len(copy.messages) == 2
        assert list(front.latest.ranges) == list(copy.latest.ranges)
        sim.reset()
        sim.step(50)
        assert sorted(t for t in sim.topics() if t in ("/front", "/copy")) == ["/copy", "/front"]
        assert list(copy.latest.ranges) == list(front.latest.ranges)
