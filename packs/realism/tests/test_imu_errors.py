"""Scale, misalignment, bandwidth and range of an IMU are those of the file; the ground truth has none of them."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit
from simkit_realism.artefacts.imu_errors import low_pass

# an arm that turns about its vertical axis; gravity acts on the IMU along its z axis
WORLD = """<sdf version="1.9" xmlns:simkit="simkit"><world name="w">
  <physics type="ode"><max_step_size>0.001</max_step_size></physics><model name="m">
  <link name="base"><inertial><mass>1e6</mass>
    <inertia><ixx>1e6</ixx><iyy>1e6</iyy><izz>1e6</izz></inertia></inertial></link>
  <link name="arm"><sensor name="s" type="imu"><update_rate>{rate}</update_rate><topic>i</topic>
    <imu>{noise}</imu>{errors}</sensor></link>
  <joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
  <joint name="j" type="revolute"><parent>base</parent><child>arm</child><axis><xyz>0 0 1</xyz></axis></joint>
  </model></world></sdf>"""


def world(errors: str, rate: float = 0, noise: str = "") -> str:
    return WORLD.format(errors=errors, rate=rate, noise=noise)


def motion_of(message: object) -> np.ndarray:
    rate, force = message.angular_velocity, message.linear_acceleration
    return np.array((rate.x, rate.y, rate.z, force.x, force.y, force.z))


def test_scale_and_misalignment_turn_a_vector_into_the_products_of_the_matrix() -> None:
    errors = """<simkit:calibration_error>
      <angular_velocity><scale>0 0 0.03</scale><misalignment>0 0.01 0 -0.02 0 0</misalignment></angular_velocity>
      <linear_acceleration><scale>0 0 -0.02</scale><misalignment>0 0.005 0 0.001 0 0</misalignment>
      </linear_acceleration></simkit:calibration_error>"""
    with simkit.load(world(errors)) as sim:
        sim.joint("m::j").set_velocity(2.0)
        sim.step(5)
        sensor = sim.sensor("m::arm::s")
        reading, truth = motion_of(sensor.latest), motion_of(sensor.truth)
    np.testing.assert_allclose(truth, (0, 0, 2, 0, 0, 9.8), atol=1e-6)
    expected = (0.02, -0.04, 2.06, 0.049, 0.0098, 9.604)
    np.testing.assert_allclose(reading, expected, atol=1e-6)


def test_drawn_parts_have_the_spread_of_the_file_and_stay_constant_in_a_run() -> None:
    errors = """<simkit:calibration_error><linear_acceleration><scale>0 0 0.01</scale>
      <scale_stddev>0.02</scale_stddev><misalignment_stddev>0.005</misalignment_stddev></linear_acceleration>
      </simkit:calibration_error>"""
    rows = []
    with simkit.load(world(errors)) as sim:
        for seed in range(300):
            sim.reset(seed=seed)
            sim.step(1)
            first = motion_of(sim.sensor("m::arm::s").latest)
            sim.step(1)
            assert (motion_of(sim.sensor("m::arm::s").latest) == first).all()
            rows.append(first[3:] / 9.8)
    x, y, z = np.array(rows).T
    for found, mean, stddev in ((x, 0, 0.005), (y, 0, 0.005), (z, 1.01, 0.02)):
        assert abs(found.mean() - mean) < 4 * stddev / math.sqrt(300)
        assert abs(found.std() / stddev - 1) < 4 / math.sqrt(600)


@pytest.mark.parametrize(("order", "slope"), [(1, 10.0), (2, 100.0)])
def test_the_response_is_3_db_lower_at_the_frequency_and_falls_with_the_order(order: int, slope: float) -> None:
    """Ten times above the frequency the amplitude is a tenth, or a hundredth."""
    b0, b1, b2, a1, a2 = low_pass(20.0, 1e-5, order)
    for frequency, gain in ((20.0, math.sqrt(0.5)), (200.0, 1 / slope)):
        z = np.exp(-2j * math.pi * frequency * 1e-5)
        response = abs((b0 + b1 * z + b2 * z * z) / (1 + a1 * z + a2 * z * z))
        assert response == pytest.approx(gain, rel=6e-3)
    assert b0 + b1 + b2 == pytest.approx(1 + a1 + a2)  # constant input


@pytest.mark.parametrize("order", [1, 2])
def test_an_oscillation_at_the_bandwidth_loses_3_db(order: int) -> None:
    frequency = 50.0
    errors = f"""<simkit:bandwidth><angular_velocity>{frequency}</angular_velocity><order>{order}</order>
      </simkit:bandwidth>"""
    readings, truths = [], []
    with simkit.load(world(errors)) as sim:
        sensor, joint = sim.sensor("m::arm::s"), sim.joint("m::j")
        for step in range(300):
            joint.set_velocity(2.0 * math.sin(2 * math.pi * frequency * step * 1e-3))
            sim.step(1)
            readings.append(motion_of(sensor.latest))
            truths.append(motion_of(sensor.truth))
    # five whole periods after the start
    phase = np.exp(-2j * math.pi * frequency * np.arange(100) * 1e-3)
    reading, truth = (abs((np.array(rows)[-100:, 2] * phase).mean()) for rows in (readings, truths))
    assert reading / truth == pytest.approx(math.sqrt(0.5), rel=1e-3)
    assert (np.array(readings)[:, 3:] == np.array(truths)[:, 3:]).all()  # no filter of the acceleration


FILTERED = "<simkit:bandwidth><angular_velocity>10</angular_velocity><order>2</order></simkit:bandwidth>"


def swing(sim: simkit.Simulation, steps: int, first: int = 0) -> list[bytes]:
    rows = []
    sensor, joint = sim.sensor("m::arm::s"), sim.joint("m::j")
    for step in range(first, first + steps):
        joint.set_velocity(math.sin(0.03 * step * step))
        sim.step(1)
        if step % 10 == 0:
            rows.append(motion_of(sensor.latest).tobytes())
    return rows


def test_a_filter_repeats_its_bits_after_reset_and_restore() -> None:
    with simkit.load(world(FILTERED, rate=250)) as sim:
        first = swing(sim, 100)
        state = sim.snapshot()
        second = swing(sim, 100, 100)
        sim.restore(state)
        assert swing(sim, 100, 100) == second
        sim.reset()
        assert swing(sim, 100) == first


def test_a_filter_does_not_depend_on_who_listens() -> None:
    ends = []
    for listens in (False, True):
        with simkit.load(world(FILTERED, rate=250)) as sim:
            kept = sim.subscribe("/i") if listens else None
            joint = sim.joint("m::j")
            for step in range(200):
                joint.set_velocity(math.sin(0.03 * step * step))
                sim.step(1)
            ends.append(motion_of(sim.sensor("m::arm::s").latest).tobytes())
            assert kept is None or len(kept.messages) == 51
            assert kept is None or motion_of(kept.messages[-1]).tobytes() == ends[0]
    assert ends[0] == ends[1]


def test_a_bandwidth_above_half_the_rate_is_reported_and_changes_nothing() -> None:
    errors = "<simkit:bandwidth><angular_velocity>60</angular_velocity></simkit:bandwidth>"
    with simkit.load(world(errors, rate=100)) as sim:
        assert "SK-SENSOR-246" in {d.code for d in sim.diagnostics}
        sim.joint("m::j").set_velocity(2.0)
        sim.step(11)
        sensor = sim.sensor("m::arm::s")
        assert motion_of(sensor.latest)[2] == motion_of(sensor.truth)[2] == pytest.approx(2.0)


def test_values_beyond_the_range_have_the_limit_after_noise_and_scale() -> None:
    errors = """<simkit:calibration_error><angular_velocity><scale>0 0 0.5</scale></angular_velocity>
      </simkit:calibration_error><simkit:saturation><angular_velocity>2.5</angular_velocity>
      <linear_acceleration>9.8</linear_acceleration></simkit:saturation>"""
    noise = """<linear_acceleration><z><noise type="gaussian"><stddev>0.1</stddev></noise></z></linear_acceleration>"""
    with simkit.load(world(errors, noise=noise)) as sim:
        sim.joint("m::j").set_velocity(2.0)
        kept = sim.subscribe("/i")
        sim.step(400)
        rows = np.array([motion_of(message) for message in kept.messages])
    assert (rows[1:, 2] == 2.5).all()
    assert rows[:, 5].max() == 9.8
    assert abs((rows[:, 5] == 9.8).mean() - 0.5) < 4 * 0.5 / math.sqrt(len(rows))


def test_quantisation_is_the_precision_of_the_noise() -> None:
    noise = """<linear_acceleration><z><noise type="gaussian"><stddev>0.05</stddev><precision>0.01</precision></noise>
      </z></linear_acceleration>"""
    with simkit.load(world("", noise=noise)) as sim:
        kept = sim.subscribe("/i")
        sim.step(200)
        steps = np.array([motion_of(message)[5] for message in kept.messages]) / 0.01
    assert np.abs(steps - np.round(steps)).max() < 1e-9 and len(set(np.round(steps))) > 10
