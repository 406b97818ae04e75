"""Noise of an IMU in files before SDF 1.6, shared by all axes."""

from __future__ import annotations

import pytest

import simkit

IMU = """<sdf version="{version}"><world name="w"><model name="m"><static>true</static><link name="l">
  <sensor name="s" type="imu"><update_rate>1000</update_rate><imu>{more}<noise><type>gaussian</type>
    <rate><mean>0.5</mean><stddev>0.0</stddev></rate>
    <accel><mean>-2</mean><bias_mean>0.25</bias_mean></accel></noise></imu></sensor></link></model></world></sdf>"""


@pytest.mark.parametrize("version", ["1.3", "1.4", "1.5"])
def test_shared_noise_is_copied_to_every_axis(version: str) -> None:
    with simkit.load(IMU.format(version=version, more="")) as sim:
        sim.step()
        rate, force = sim.sensor("m::l::s").latest.angular_velocity, sim.sensor("m::l::s").latest.linear_acceleration
        assert (rate.x, rate.y, rate.z) == pytest.approx((0.5, 0.5, 0.5))
        assert (force.x, force.y, force.z) == pytest.approx((-1.75, -1.75, 8.05))
        assert "SK-PARAM-003" not in [d.code for d in sim.diagnostics]


def test_noise_of_an_axis_overrides_the_shared_noise() -> None:
    newer = "<angular_velocity><x><noise type='gaussian'><mean>3</mean></noise></x></angular_velocity>"
    with simkit.load(IMU.format(version="1.5", more=newer)) as sim:
        sim.step()
        rate = sim.sensor("m::l::s").latest.angular_velocity
        assert (rate.x, rate.y, rate.z) == pytest.approx((3, 0, 0))


def test_shared_noise_is_not_copied_in_newer_files() -> None:
    with simkit.load(IMU.format(version="1.6", more="")) as sim:
        sim.step()
        assert sim.sensor("m::l::s").latest.angular_velocity.x == 0
        assert "SK-PARAM-003" in [d.code for d in sim.diagnostics]
