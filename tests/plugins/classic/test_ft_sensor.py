"""Force-torque plugin of Gazebo Classic: on joints and links, in both spellings."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import simkit

G = 9.8
FILE = 'filename="libgazebo_ros_ft_sensor.so"'


def world(plugin: str, more: str = "", top: str = "") -> str:
    inertia = "<inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.3</izz></inertia>"
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 -{G}</gravity>{top}<model name="m">
<link name="beam"><pose>0 0 1 0.4 0 0</pose>
<inertial><pose>0.5 0 0 0 0 0</pose><mass>2</mass>{inertia}</inertial></link>
<joint name="wall" type="revolute"><parent>world</parent><child>beam</child>
<axis><xyz expressed_in="__model__">0 0 1</xyz></axis></joint>
{more}{plugin}</model></world></sdf>"""


def six(message: Any) -> Any:
    force, torque = message.wrench.force, message.wrench.torque
    return np.array((force.x, force.y, force.z, torque.x, torque.y, torque.z))


def test_the_wrench_of_a_joint_is_that_of_the_child_in_the_childs_axes() -> None:
    ros = "<ros><namespace>arm</namespace><remapping>wrench:=ft</remapping></ros>"
    plugin = f'<plugin name="n" {FILE}>{ros}<joint_name>wall</joint_name><update_rate>50</update_rate></plugin>'
    with simkit.load(world(plugin)) as sim:
        assert sim.topics()["/arm/ft"] == "geometry_msgs/msg/WrenchStamped"
        sub = sim.subscribe("/arm/ft")
        sim.run(1.0)
        assert len(sub.messages) == 50
        assert sub.latest.header.frame_id == "beam"
        weight = np.array((0, -2 * G * np.sin(0.4), -2 * G * np.cos(0.4)))
        expected = np.concatenate((weight, np.cross((0.5, 0, 0), weight)))
        np.testing.assert_allclose(six(sub.latest), expected, atol=1e-6)
        assert not [d for d in sim.diagnostics if d.code == "SK-PARAM-003"]


def test_ros_1_spelling_names_topic_joint_and_rate() -> None:
    plugin = (
        f'<plugin name="n" {FILE}><jointName>wall</jointName><topicName>ft</topicName><updateRate>10</updateRate>'
        "<robotNamespace>/r</robotNamespace><gaussianNoise>0.0</gaussianNoise></plugin>"
    )
    with simkit.load(world(plugin)) as sim:
        sub = sim.subscribe("/r/ft")
        sim.run(1.0)
        assert len(sub.messages) == 10
        assert np.linalg.norm(six(sub.latest)[:3]) == pytest.approx(2 * G)
        assert not [d for d in sim.diagnostics if d.code == "SK-PARAM-003"]


def test_the_wrench_of_a_link_is_mass_times_acceleration_in_the_world() -> None:
    """On its circle the beam is pulled to the middle by m ω² r; its weight is held, so the sum has none of it."""
    plugin = f'<plugin name="n" {FILE}><body_name>beam</body_name></plugin>'
    with simkit.load(world(plugin)) as sim:
        sub = sim.subscribe("/wrench")
        sim.joint("m::wall").set_velocity(3.0)
        sim.step(1)
        assert sub.latest.header.frame_id == "world"
        np.testing.assert_allclose(six(sub.latest)[:2], (-2 * 9 * 0.5, 0), atol=0.1)
        assert six(sub.latest)[2] == pytest.approx(0, abs=1e-6)


def test_a_falling_link_has_its_weight_and_no_torque() -> None:
    free = '<link name="stone"><pose>3 0 9 0 0 0</pose><inertial><mass>3</mass></inertial></link>'
    plugin = f'<plugin name="n" {FILE}><body_name>stone</body_name><frame_name>map</frame_name></plugin>'
    with simkit.load(world(plugin, free)) as sim:
        sub = sim.subscribe("/wrench")
        sim.step(5)
        assert sub.latest.header.frame_id == "map"
        np.testing.assert_allclose(six(sub.latest), (0, 0, -3 * G, 0, 0, 0), atol=1e-6)


def test_noise_does_not_depend_on_earlier_subscribers() -> None:
    plugin = f'<plugin name="n" {FILE}><joint_name>wall</joint_name><gaussian_noise>0.5</gaussian_noise></plugin>'
    with simkit.load(world(plugin), seed=3) as early, simkit.load(world(plugin), seed=3) as late:
        first = early.subscribe("/wrench")
        early.step(1000)
        late.step(500)
        second = late.subscribe("/wrench")
        late.step(500)
        values = np.array([six(m) for m in first.messages])
        assert values.std(axis=0) == pytest.approx(np.full(6, 0.5), rel=0.1)
        np.testing.assert_array_equal(values[500:], [six(m) for m in second.messages])
        early.reset()
        early.step(10)
        np.testing.assert_array_equal(values[:10], [six(m) for m in first.messages[-10:]])


def test_a_body_resting_on_a_static_link_still_has_its_weight() -> None:
    shape = '<collision name="c"><geometry><box><size>1 1 0.2</size></box></geometry></collision>'
    plate = f'<link name="plate"><pose>5 0 0 0 0 0</pose><inertial><mass>1</mass></inertial>{shape}</link>'
    plate += '<joint name="floor" type="fixed"><parent>world</parent><child>plate</child></joint>'
    load = f'<model name="load"><pose>5 0 0.2 0 0 0</pose><link name="l"><inertial><mass>4</mass></inertial>{shape}'
    plugin = f'<plugin name="n" {FILE}><joint_name>floor</joint_name></plugin>'
    with simkit.load(world(plugin, plate, load + "</link></model>")) as sim:
        sub = sim.subscribe("/wrench", keep=1)
        sim.run(2.0)
        assert six(sub.latest)[2] == pytest.approx(-5 * G, abs=1e-3)


@pytest.mark.parametrize(
    ("content", "code"),
    [
        ("", "SK-PARAM-001"),
        ("<joint_name>wal</joint_name>", "SK-PLUGIN-003"),
        ("<body_name>bean</body_name>", "SK-PLUGIN-003"),
        ("<joint_name>wall</joint_name><gaussian_noise>-1</gaussian_noise>", "SK-PARAM-002"),
    ],
)
def test_a_missing_or_misspelt_name_is_an_error(content: str, code: str) -> None:
    with pytest.raises(simkit.LoadError, match=code):
        simkit.load(world(f'<plugin name="n" {FILE}>{content}</plugin>'))


def test_a_frame_is_reported_as_unused_for_a_joint() -> None:
    plugin = f'<plugin name="n" {FILE}><joint_name>wall</joint_name><frame_name>tool</frame_name></plugin>'
    with simkit.load(world(plugin)) as sim:
        assert any(d.code == "SK-PARAM-003" and "frame_name" in d.message for d in sim.diagnostics)
