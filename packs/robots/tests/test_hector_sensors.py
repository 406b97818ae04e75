"""IMU, GPS, magnetometer and sonar of hector_gazebo_plugins: readings, errors, rates, and their random drift."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

import simkit
from simkit import msgs

STEP = 0.01


def world(name: str, parameters: str = "", body: str = "", before: str = "") -> str:
    return f"""<sdf version="1.6"><world name="w">
      <physics name="p" type="ode"><max_step_size>{STEP}</max_step_size></physics>{before}
      <model name="robot"><pose>100 -50 2 0 0 0.5</pose><link name="base"><inertial><mass>1</mass></inertial></link>
      {body or '<joint name="held" type="fixed"><parent>world</parent><child>base</child></joint>'}
      <plugin filename="libhector_gazebo_ros_{name}.so" name="{name}">{parameters}</plugin></model></world></sdf>"""


def readings(text: str, topic: str, time: float = 1.0, seed: int = 0) -> list:
    with simkit.load(text, seed=seed) as sim:
        found = sim.subscribe(topic)
        sim.run(time)
        return found.messages


def plain_state(plugin: object) -> str:
    """Return the state of a plugin without the addresses of its objects and the numbers of subscribers."""
    return re.sub(r"0x[0-9a-f]+|\d+ subscribers?", "", str(plugin.get_state()))


def array(vector: object) -> np.ndarray:
    return np.array((vector.x, vector.y, vector.z))


def test_an_imu_at_rest_measures_the_reaction_to_gravity_in_its_axes() -> None:
    *_, last = readings(world("imu", "<updateRate>50</updateRate><frameId>imu_link</frameId>"), "/imu")
    assert array(last.linear_acceleration) == pytest.approx([0, 0, 9.8], abs=1e-9)
    assert last.orientation.z == pytest.approx(math.sin(0.25)) and last.header.frame_id == "imu_link"


def test_the_rate_and_the_topic_of_an_imu_are_those_of_the_file() -> None:
    found = readings(world("imu", "<updateRate>20</updateRate><topicName>imu/data</topicName>"), "/imu/data")
    assert len(found) == 20
    assert len(readings(world("imu"), "/imu")) == 100  # every step


def test_a_falling_imu_measures_no_acceleration_and_its_turning_rate() -> None:
    with simkit.load(world("imu", body="<!-- free -->")) as sim:
        found = sim.subscribe("/imu", keep=1)
        sim.link("robot::base").set_velocity((0, 0, 0), (0, 0, 2))
        sim.run(0.1)
        last = found.messages[-1]
        assert array(last.linear_acceleration) == pytest.approx([0, 0, 0], abs=1e-9)
        assert array(last.angular_velocity) == pytest.approx([0, 0, 2], abs=1e-9)


def test_offsets_shift_acceleration_rate_and_orientation() -> None:
    errors = "<accelOffset>0.98 0 0</accelOffset><rateOffset>0 0 0.3</rateOffset><headingOffset>0.2</headingOffset>"
    *_, last = readings(world("imu", errors), "/imu")
    assert array(last.linear_acceleration) == pytest.approx([0.98, 0, 9.8], abs=1e-9)
    assert array(last.angular_velocity) == pytest.approx([0, 0, 0.3], abs=1e-9)
    q = last.orientation
    yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y**2 + q.z**2))
    pitch = math.asin(2 * (q.w * q.y - q.z * q.x))
    assert yaw == pytest.approx(0.7, abs=1e-6)
    assert abs(pitch) == pytest.approx(math.atan2(0.98, 9.8), rel=1e-6)


@pytest.mark.parametrize("value", ["-1", "0 -1 0", "nan"])
@pytest.mark.parametrize("name", ["accelDriftFrequency", "rateDrift", "accelGaussianNoise"])
def test_a_negative_deviation_or_frequency_is_an_error(name: str, value: str) -> None:
    with pytest.raises(simkit.InputError, match=f"SK-PARAM-002.*{name}"):
        simkit.load(world("imu", f"<{name}>{value}</{name}>"))


def test_noise_has_its_standard_deviation_and_its_covariance() -> None:
    noise = "<accelGaussianNoise>0.5 0.5 0.5</accelGaussianNoise><rateGaussianNoise>0.1</rateGaussianNoise>"
    found = readings(world("imu", noise), "/imu", 20.0)
    x = np.array([m.linear_acceleration.x for m in found])
    assert x.std() == pytest.approx(0.5, rel=0.05)
    assert np.std([m.angular_velocity.y for m in found]) == pytest.approx(0.1, rel=0.05)
    assert found[-1].linear_acceleration_covariance[0] == pytest.approx(0.25)
    assert found[-1].angular_velocity_covariance[4] == pytest.approx(0.01)


@pytest.mark.slow
def test_a_drift_has_its_standard_deviation_and_correlation_time_at_any_rate() -> None:
    for rate in (100, 10):
        drift = f"<updateRate>{rate}</updateRate><rateDrift>0.2</rateDrift><rateDriftFrequency>2</rateDriftFrequency>"
        values = np.array([array(m.angular_velocity) for m in readings(world("imu", drift), "/imu", 120.0)])
        settled = values[5 * rate :]
        assert settled.std() == pytest.approx(0.2, rel=0.2)
        lag = rate // 2  # 0.5 s, one correlation time
        correlation = float((settled[:-lag] * settled[lag:]).mean() / (settled**2).mean())
        assert correlation == pytest.approx(math.exp(-1), abs=0.2)


def test_the_service_sets_the_drift_of_the_turning_rate_to_zero() -> None:
    drift = "<rateDrift>0.2 0.2 0.2</rateDrift><rateDriftFrequency>1e-4</rateDriftFrequency>"
    with simkit.load(world("imu", drift)) as sim:
        found = sim.subscribe("/imu", keep=1)
        sim.run(5.0)
        assert np.abs(array(found.messages[-1].angular_velocity)).max() > 1e-3
        sim.call("/imu/calibrate")
        sim.run(STEP)
        assert np.abs(array(found.messages[-1].angular_velocity)).max() < 1e-3


def test_errors_depend_on_the_seed_alone() -> None:
    text = world("imu", "<rateDrift>0.2 0.2 0.2</rateDrift><accelGaussianNoise>0.1</accelGaussianNoise>")
    one, same, other = (readings(text, "/imu", 0.5, seed)[-1] for seed in (1, 1, 2))
    assert msgs.serialize(one) == msgs.serialize(same) != msgs.serialize(other)
    with simkit.load(text, seed=1) as sim:  # a late subscriber sees the same drift
        sim.run(0.4)
        found = sim.subscribe("/imu", keep=1)
        sim.run(0.1)
        assert msgs.serialize(found.messages[-1]) == msgs.serialize(one)


@pytest.mark.parametrize(("name", "topic"), [("imu", "/imu"), ("magnetic", "/magnetic"), ("gps", "/fix_velocity")])
def test_an_idle_sensor_without_a_drift_takes_no_time_and_subscribers_do_not_change_its_state(
    name: str, topic: str
) -> None:
    with simkit.load(world(name, "<updateRate>50</updateRate>")) as sim:
        (sensor,) = (plugin for plugin in sim.engine.structure.all_plugins() if plugin.name == name)
        state, instant, calls = plain_state(sensor), sensor.instant, []
        sensor.instant = lambda: calls.append(sim.time) or instant()
        sim.run(0.5)
        assert not calls
        found = sim.subscribe(topic)
        sim.run(0.5)
        del sensor.instant
        assert len(calls) == len(found.messages) == 25
        assert state == plain_state(sensor)


def test_a_gps_maps_x_to_north_by_its_heading() -> None:
    place = "<referenceLatitude>49.9</referenceLatitude><referenceLongitude>8.9</referenceLongitude>" + (
        "<referenceHeading>0</referenceHeading><referenceAltitude>100</referenceAltitude>"
    )
    found = readings(world("gps", place), "/fix")
    assert len(found) == 4
    last = found[-1]
    metre = 180 / math.pi / 6.371e6
    assert last.latitude - 49.9 == pytest.approx(100 * metre, rel=0.01)
    assert last.longitude - 8.9 == pytest.approx(50 * metre / math.cos(math.radians(49.9)), rel=0.01)  # y is west
    assert last.altitude == pytest.approx(102, abs=0.01)


def test_a_gps_without_a_reference_uses_the_place_of_the_world() -> None:
    place = "<latitude_deg>46</latitude_deg><longitude_deg>7</longitude_deg>"
    place = f"<spherical_coordinates>{place}</spherical_coordinates>"
    last = readings(world("gps", before=place), "/fix")[-1]
    assert last.longitude - 7 == pytest.approx(100 * 180 / math.pi / 6.371e6 / math.cos(math.radians(46)), rel=0.01)


def test_the_velocity_of_a_gps_points_north_west_and_up() -> None:
    with simkit.load(world("gps", "<velocityTopicName>speed</velocityTopicName>", body="<!-- free -->")) as sim:
        found = sim.subscribe("/speed", keep=1)
        sim.link("robot::base").set_velocity((3, 0, 0))
        sim.run(0.25)
        assert array(found.messages[-1].vector) == pytest.approx([0, -3, -9.8 * 0.25], abs=0.1)  # x is east


def test_errors_of_a_gps_move_its_fix() -> None:
    still = readings(world("gps"), "/fix")[-1]
    moved = readings(world("gps", "<offset>0 0 5</offset><velocityOffset>0 0 1</velocityOffset>"), "/fix")[-1]
    assert moved.altitude - still.altitude == pytest.approx(5 + 1.0, abs=1e-6)


def test_a_magnetometer_turns_with_its_link() -> None:
    values = "<magnitude>60</magnitude><referenceHeading>0</referenceHeading><inclination>30</inclination>"
    last = readings(world("magnetic", values), "/magnetic")[-1]
    across = 60 * math.cos(math.radians(30))
    assert array(last.vector) == pytest.approx([across * math.cos(0.5), -across * math.sin(0.5), -30], abs=1e-9)
    field = readings(world("magnetic", values + "<useMagneticFieldMsgs>true</useMagneticFieldMsgs>"), "/magnetic")[-1]
    assert array(field.magnetic_field) == pytest.approx(array(last.vector))


def test_a_sonar_publishes_its_nearest_ray() -> None:
    text = """<sdf version="1.6"><world name="w">
      <model name="wall"><static>true</static><pose>2 0 0 0 0 0</pose><link name="l">
      <collision name="c"><geometry><box><size>1 4 4</size></box></geometry></collision></link></model>
      <model name="robot"><static>true</static><link name="base"><sensor name="s" type="ray">
      <update_rate>40</update_rate>
      <ray><scan><horizontal><samples>5</samples><min_angle>-0.3</min_angle><max_angle>0.3</max_angle></horizontal>
      </scan>      <range><min>0.1</min><max>5</max></range></ray>
      <plugin filename="libhector_gazebo_ros_sonar.so" name="sonar"><topicName>front</topicName></plugin>
      </sensor></link></model></world></sdf>"""
    found = readings(text, "/front")
    assert len(found) == 11  # the first at the start
    assert found[-1].range == pytest.approx(1.5, abs=1e-6) and found[-1].header.frame_id == "sonar_link"


def test_a_link_that_is_missing_is_an_error() -> None:
    with pytest.raises(simkit.InputError, match="SK-PLUGIN-003"):
        simkit.load(world("imu", "<bodyName>none</bodyName>"))
