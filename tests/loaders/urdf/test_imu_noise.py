"""Noise of an IMU in a robot's `<gazebo>` block, as robots wrote it for SDF 1.4: shared by all axes."""

from __future__ import annotations

import simkit

ROBOT = """<robot name="r"><link name="base"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <gazebo reference="base"><sensor name="imu" type="imu"><update_rate>100</update_rate><imu>{}</imu></sensor></gazebo>
</robot>"""
ONCE = """<noise><type>gaussian</type><rate><mean>0</mean><stddev>2e-4</stddev><bias_mean>7.5e-6</bias_mean></rate>
  <accel><mean>0</mean><stddev>1.7e-2</stddev><bias_mean>0.1</bias_mean></accel></noise>"""
OWN = "<angular_velocity><x><noise type='gaussian'><stddev>0.5</stddev></noise></x></angular_velocity>"


def test_shared_noise_of_an_imu_is_copied_to_every_axis() -> None:
    with simkit.load(ROBOT.format(ONCE)) as sim:
        options = sim.sensor("r::base::imu").options
        assert [(n.stddev, n.bias_mean) for n in options.angular_velocity] == [(2e-4, 7.5e-6)] * 3
        assert [(n.stddev, n.bias_mean) for n in options.linear_acceleration] == [(1.7e-2, 0.1)] * 3
        assert not [d for d in sim.diagnostics if "noise" in d.message]


def test_an_axis_with_its_own_noise_keeps_it() -> None:
    with simkit.load(ROBOT.format(OWN + ONCE)) as sim:
        options = sim.sensor("r::base::imu").options
        assert [n.stddev for n in options.angular_velocity] == [0.5, 0.0, 0.0]
        assert [n.stddev for n in options.linear_acceleration] == [1.7e-2] * 3
