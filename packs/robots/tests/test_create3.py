"""Bumper, cliff, infrared, IMU, wheel drop and optical mouse of the Create 3 base."""

from __future__ import annotations

import math

import pytest

import simkit

STILL = '<joint name="held" type="fixed"><parent>world</parent><child>base_link</child></joint>'


def plugin(name: str, more: str = "") -> str:
    remapping = f"<ros><remapping>~/out:={name}</remapping></ros>"
    return f'<plugin name="{name}" filename="libgazebo_ros_create_{name}.so">{remapping}{more}</plugin>'


def ray(inner: str, most: float = 0.4) -> str:
    return f"""<sensor name="s" type="ray"><update_rate>50</update_rate><ray><scan><horizontal><samples>3</samples>
      <min_angle>-0.02</min_angle><max_angle>0.02</max_angle></horizontal></scan>
      <range><min>0.01</min><max>{most}</max></range></ray>{inner}</sensor>"""


def world(link: str = "", model: str = STILL, wall: float = 0.3, height: float = 0.5) -> str:
    return f"""<sdf version="1.6"><world name="w">
      <model name="wall"><static>true</static><pose>{wall} 0 {height} 0 0 0</pose><link name="l"><collision name="c">
      <geometry><box><size>0.1 4 0.6</size></box></geometry></collision></link></model>
      <model name="create3"><pose>0 0 {height} 0 0 0</pose><link name="base_link"><inertial><mass>2</mass></inertial>
      <collision name="bumper"><geometry><cylinder><radius>0.17</radius><length>0.08</length></cylinder></geometry>
      </collision>{link}</link>{model}</model></world></sdf>"""


def contact_sensor(inner: str) -> str:
    contact = "<contact><collision>bumper</collision></contact>"
    return f'<sensor name="b" type="contact"><update_rate>50</update_rate>{contact}{inner}</sensor>'


SLIDE = """<joint name="slide" type="prismatic"><parent>world</parent><child>base_link</child><axis><xyz>1 0 0</xyz>
  <limit><lower>-1</lower><upper>1</upper></limit></axis></joint>"""


@pytest.mark.parametrize(
    ("yaw", "zone"),
    [(0, "bump_front_center"), (-0.6, "bump_front_left"), (0.6, "bump_front_right"), (1.2, "bump_right")],
)
def test_the_zone_of_a_bump_follows_from_the_direction_of_the_contact(yaw: float, zone: str) -> None:
    turned = world(contact_sensor(plugin("bumper")), SLIDE).replace(
        '<model name="create3"><pose>0 0 0.5 0 0 0</pose>', f'<model name="create3"><pose>0 0 0.5 0 0 {yaw}</pose>'
    )
    turned = turned.replace("<xyz>1 0 0</xyz>", f"<xyz>{math.cos(yaw)} {-math.sin(yaw)} 0</xyz>")
    with simkit.load(turned) as sim:
        found = sim.subscribe("/bumper")
        for _ in range(500):
            sim.joint("create3::slide").set_effort(5)
            sim.step()
        assert {(m.header.frame_id, m.type) for m in found.messages} == {(zone, 1)}
        assert 5 < len(found.messages) < 26


def test_without_a_contact_the_bumper_is_silent() -> None:
    with simkit.load(world(contact_sensor(plugin("bumper")))) as sim:
        found = sim.subscribe("/bumper")
        sim.run(0.5)
        assert not found.messages


@pytest.mark.parametrize(("wall", "expected"), [(0.3, 0), (0.45, 50)])
def test_a_cliff_is_farther_than_the_threshold(wall: float, expected: int) -> None:
    sensor = ray(plugin("cliff_sensor", "<detection_threshold>0.3</detection_threshold>"))
    with simkit.load(world(sensor, wall=wall)) as sim:
        found = sim.subscribe("/cliff_sensor")
        sim.run(1.0)
        assert len(found.messages) == pytest.approx(expected, abs=1)
        assert all(m.type == 2 and m.header.frame_id == "base_link" for m in found.messages)


def test_the_infrared_intensity_falls_exponentially() -> None:
    with simkit.load(world(ray(plugin("ir_intensity_sensor")))) as sim:
        found = sim.subscribe("/ir_intensity_sensor")
        sim.run(0.5)
        assert found.messages[-1].value == int(3500 * math.exp(-2 * math.e * 0.25 / 0.4))


def test_a_lidar_fits_where_a_ray_sensor_fits_and_its_scan_is_a_hidden_topic() -> None:
    sensor = ray(plugin("ir_intensity_sensor")).replace('type="ray"', 'type="gpu_lidar"')
    with simkit.load(world(sensor)) as sim:
        found = sim.subscribe("/ir_intensity_sensor")
        sim.run(0.5)
        assert found.messages
        scans = [topic for topic, _, (kind, *_), _ in sim.communication.bus.endpoints() if kind.endswith("LaserScan")]
        assert scans == ["/ir_intensity_sensor/_raw"]


def test_the_imu_has_no_gravity() -> None:
    sensor = f'<sensor name="i" type="imu"><update_rate>50</update_rate>{plugin("imu")}</sensor>'
    with simkit.load(world(sensor)) as sim:
        found = sim.subscribe("/imu")
        sim.run(0.5)
        a = found.messages[-1].linear_acceleration
        assert (a.x, a.y, a.z) == pytest.approx((0, 0, 0), abs=1e-6)


def test_a_wheel_has_dropped_between_its_two_thresholds() -> None:
    wheel = """<link name="wheel"><inertial><mass>0.1</mass></inertial></link><joint name="drop" type="prismatic">
      <parent>base_link</parent><child>wheel</child><axis><xyz>0 0 -1</xyz>
      <limit><lower>0</lower><upper>0.1</upper></limit></axis></joint>"""
    settings = "<joint_name>drop</joint_name><detection_threshold>0.03</detection_threshold><frame_id>left</frame_id>"
    with simkit.load(world(model=STILL + wheel + plugin("wheel_drop", settings))) as sim:
        found = sim.subscribe("/wheel_drop")

        def count(position: float) -> int:
            before = len(found.messages)
            for _ in range(100):
                sim.joint("create3::drop").set_position(position)
                sim.joint("create3::drop").set_velocity(0)
                sim.step()
            return len(found.messages) - before

        dropped = [position for position in (0.0, 0.025, 0.029, 0.026, 0.02, 0.027) if count(position)]
        assert dropped == [0.029, 0.026]
        assert found.messages[0].type == 4 and found.messages[0].header.frame_id == "left"


def test_the_mouse_measures_the_way_in_the_axes_of_its_link() -> None:
    with simkit.load(world(model=plugin("optical_mouse"), wall=5)) as sim:
        found = sim.subscribe("/optical_mouse")
        base = sim.link("create3::base_link")
        base.set_pose(simkit.Pose((0, 0, 0.5), (math.sqrt(0.5), 0, 0, math.sqrt(0.5))))
        sim.run(0.02)
        first = found.messages[-1]
        for _ in range(500):
            base.set_velocity((0, 0.2, 0))
            sim.step()
        last = found.messages[-1]
        assert last.integrated_x - first.integrated_x == pytest.approx(0.1, rel=0.05)
        assert last.integrated_y - first.integrated_y == pytest.approx(0, abs=1e-3)


def test_a_plugin_on_another_kind_of_sensor_is_an_error() -> None:
    with pytest.raises(simkit.InputError, match="SK-PLUGIN-003.* contact"):
        simkit.load(world(ray(plugin("bumper"))))


def test_a_missing_joint_is_an_error() -> None:
    with pytest.raises(simkit.InputError, match="SK-PLUGIN-003"):
        simkit.load(world(model=STILL + plugin("wheel_drop", "<joint_name>none</joint_name>")))
