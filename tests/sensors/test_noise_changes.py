"""The noise of a sensor is set during a run."""

from __future__ import annotations

from dataclasses import replace

import pytest

import simkit
from simkit.errors import InputError
from simkit.sensors.noise import NoiseModel

IMU = """
<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="m"><link name="l">
  <sensor name="imu" type="imu"><update_rate>50</update_rate><topic>imu</topic><imu><angular_velocity><x>
    <noise type="gaussian"><stddev>0.1</stddev></noise></x></angular_velocity></imu></sensor></link></model>
</world></sdf>
"""
STDDEV = "m::l::imu.imu.angular_velocity.x.noise.stddev"


def rates(sim: simkit.Simulation, seconds: float = 1.0) -> list[float]:
    messages = sim.subscribe("/imu")
    sim.run(seconds)
    assert len(messages.messages) >= 50
    return [message.angular_velocity.x for message in messages.messages]


def change(sim: simkit.Simulation, stddev: float) -> None:
    imu = sim.sensor("m::l::imu")
    first, *rest = imu.noise_models()
    imu.noise = [replace(first, stddev=stddev), *rest]


def test_noise_that_is_set_at_the_start_gives_the_readings_of_an_override() -> None:
    with simkit.load(IMU, overrides=[f"{STDDEV}=0.5"]) as loaded, simkit.load(IMU) as sim:
        change(sim, 0.5)
        assert rates(sim) == rates(loaded)


def test_snapshots_and_resets_restore_the_noise() -> None:
    with simkit.load(IMU) as sim:
        first = rates(sim)
        before = sim.snapshot()
        change(sim, 0.0)
        sim.run(0.5)
        assert sim.sensor("m::l::imu").latest.angular_velocity.x == 0.0
        sim.restore(before)
        assert sim.sensor("m::l::imu").noise_models()[0].stddev == 0.1
        sim.reset()
        assert rates(sim) == first
        change(sim, 0.0)
        sim.reset(keep_changes=True)
        assert set(rates(sim)) == {0.0}


def test_a_number_is_the_standard_deviation_of_all_channels() -> None:
    with simkit.load(IMU) as sim:
        sim.sensor("m::l::imu").noise = 0.25
        assert sim.sensor("m::l::imu").noise_models() == [NoiseModel(stddev=0.25)] * 6


def test_noise_needs_one_model_for_each_channel() -> None:
    with simkit.load(IMU) as sim, pytest.raises(ValueError, match="6 NoiseModels"):
        sim.sensor("m::l::imu").noise = [NoiseModel()]


def test_the_noise_of_an_image_cannot_change() -> None:
    image = "<image><width>4</width><height>4</height></image>"
    camera = f'<sensor name="s" type="camera"><camera>{image}</camera></sensor>'
    text = f'<sdf version="1.9"><model name="m"><link name="l">{camera}</link></model></sdf>'
    with simkit.load(text) as sim, pytest.raises(InputError, match="cannot change during a run"):
        sim.sensor("m::l::s").noise = 0.1
