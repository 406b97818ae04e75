"""An arm that is set turning and slows down, as an IMU feels it, beside the formula: `python imu.py [OUT.png]`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import plots

import simkit

RADIUS, INERTIA, DAMPING, START = 0.5, 0.2, 0.1, 6.0  # m, kg m2, N m s/rad, rad/s

WORLD = f"""<sdf version="1.9"><world name="laboratory">
  <model name="table"><link name="base"/>
    <link name="arm"><inertial><mass>1</mass>
        <inertia><ixx>1</ixx><iyy>1</iyy><izz>{INERTIA}</izz></inertia></inertial>
      <sensor name="imu" type="imu"><pose>{RADIUS} 0 0 0 0 1.5707963</pose><update_rate>100</update_rate><imu>
        <angular_velocity><z><noise type="gaussian"><stddev>0.05</stddev></noise></z></angular_velocity>
        <linear_acceleration>
          <x><noise type="gaussian"><stddev>0.3</stddev></noise></x>
          <y><noise type="gaussian"><stddev>0.3</stddev></noise></y>
          <z><noise type="gaussian"><stddev>0.3</stddev><bias_mean>0.2</bias_mean></noise></z>
        </linear_acceleration>
        <orientation_reference_frame><localization>ENU</localization></orientation_reference_frame>
      </imu></sensor></link>
    <joint name="floor" type="fixed"><parent>world</parent><child>base</child></joint>
    <joint name="bearing" type="revolute"><parent>base</parent><child>arm</child>
      <axis><xyz>0 0 1</xyz><dynamics><damping>{DAMPING}</damping></dynamics></axis></joint>
  </model></world></sdf>"""


def main(out: Path) -> None:
    with simkit.load(WORLD, seed=1) as sim:
        sensor = sim.sensor("table::arm::imu")
        received = sim.subscribe(sensor.topic)
        sim.joint("table::bearing").set_velocity(START)
        sim.run(6.0)
        messages = received.messages
    times = plots.stamps(messages)
    force = np.array([(m.linear_acceleration.x, m.linear_acceleration.y, m.linear_acceleration.z) for m in messages])
    speed = START * np.exp(-DAMPING / INERTIA * times)
    figure, axes = plots.figure("IMU: 0.5 m out on an arm that slows down", rows=2, sharex=True)
    axes[0].plot(times, [m.angular_velocity.z for m in messages], ".", markersize=3, label="z of the rate")
    axes[0].plot(times, speed, color=plots.TRUTH, label="formula")
    axes[0].set_ylabel("angular velocity [rad/s]")
    names = (r"y: inwards, $\omega^2 r$", "z: up, $g$ and a bias of 0.2", r"x: along the turn, $\dot\omega r$")
    formulas = (RADIUS * speed**2, np.full_like(times, 9.8 + 0.2), -RADIUS * DAMPING / INERTIA * speed)
    for name, column, formula in zip(names, (1, 2, 0), formulas, strict=True):
        axes[1].plot(times, force[:, column], ".", markersize=3, label=name)
        axes[1].plot(times, formula, color=plots.TRUTH)
    axes[1].set_ylabel("specific force [m/s²]")
    axes[1].set_xlabel("time [s]")
    axes[0].legend(loc="upper right")
    axes[1].legend(loc="center right")
    plots.save(figure, out)


if __name__ == "__main__":
    plots.run(main, "imu.png")
