"""Range plugin `libgazebo_ros_range.so`: the nearest ray of a lidar as a Range."""

from __future__ import annotations

import numpy as np
import pytest

import simkit

BOX = """<model name="b"><static>true</static><pose>2 0.1 1 0 0 0</pose><link name="l"><collision name="c">
  <geometry><box><size>1 0.02 2</size></box></geometry></collision></link></model>"""
FAN = """<ray><scan><horizontal><samples>5</samples><min_angle>-0.1</min_angle><max_angle>0.1</max_angle></horizontal>
  <vertical><samples>5</samples><min_angle>-0.1</min_angle><max_angle>0.1</max_angle></vertical></scan>
  <range><min>0.05</min><max>4</max></range></ray>"""


def robot(plugin: str, kind: str = "ray", inside: str = FAN) -> str:
    return f"""<sdf version="1.6"><world name="w">{BOX}<model name="m"><static>true</static><pose>0 0 1 0 0 0</pose>
      <link name="l"><sensor name="s" type="{kind}"><update_rate>50</update_rate>{inside}
      <plugin name="p" filename="libgazebo_ros_range.so">{plugin}</plugin></sensor></link></model></world></sdf>"""


FULL = """<robotNamespace>r</robotNamespace><topicName>front</topicName><frameName>sonar_link</frameName>
  <radiation>infrared</radiation><fov>0.2</fov><gaussianNoise>0.02</gaussianNoise><updateRate>20</updateRate>"""


def test_the_nearest_ray_is_published() -> None:
    with simkit.load(robot("")) as sim:
        sub = sim.subscribe("/range")
        sim.run(0.1)
        message = sub.latest
        # only the ray at 0.05 rad meets the box within its 1 m, on its side at y = 0.09
        assert message.range == pytest.approx(0.09 / np.sin(0.05), rel=1e-6)
        assert (message.radiation_type, message.header.frame_id) == (0, "l")
        assert message.field_of_view == pytest.approx(0.05)
        assert (message.min_range, message.max_range) == pytest.approx((0.05, 4.0))


def test_rate_names_and_noise_of_the_plugin_apply() -> None:
    with simkit.load(robot(FULL), seed=1) as sim:
        sub = sim.subscribe("/r/front")
        sim.run(20.0)
        assert len(sub.messages) == pytest.approx(400, abs=1)
        ranges = np.array([m.range for m in sub.messages])
        message = sub.latest
        assert (message.radiation_type, message.header.frame_id) == (1, "sonar_link")
        assert message.field_of_view == pytest.approx(0.2)
        truth = sim.sensor("m::l::s").truth.range
        assert truth == pytest.approx(0.09 / np.sin(0.05), rel=1e-6)
        assert ranges.std() == pytest.approx(0.02, rel=0.15)
        assert ranges.mean() == pytest.approx(truth, abs=0.004)


def test_an_empty_range_is_infinite() -> None:
    with simkit.load(robot(FULL).replace("<max>4</max>", "<max>1</max>")) as sim:
        sim.run(0.2)
        assert sim.sensor("m::l::s").latest.range == np.inf


def test_noise_repeats_after_a_reset() -> None:
    with simkit.load(robot(FULL), seed=5) as sim:
        sub = sim.subscribe("/r/front")
        sim.run(0.5)
        first = [m.range for m in sub.messages]
        sim.reset()
        sim.run(0.5)
        assert [m.range for m in sub.messages][len(first) :] == first


def test_on_another_kind_it_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003"):
        simkit.load(robot("", "imu", ""))


def test_a_wrong_radiation_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="ultrasound, infrared"):
        simkit.load(robot("<radiation>sound</radiation>"))
