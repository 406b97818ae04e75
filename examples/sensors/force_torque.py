"""A pendulum that falls from level: the sensor in its joint feels the weight and the pull of the swing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from plots import BLUE, ORANGE, TRUTH, figure, run, save

import simkit

MASS, LENGTH, G = 2.0, 0.5, 9.8
WORLD = f"""
<sdf version="1.9">
  <world name="swing">
    <gravity>0 0 -{G}</gravity>
    <model name="pendulum">
      <link name="bob">
        <inertial>
          <pose>{LENGTH} 0 0 0 0 0</pose><mass>{MASS}</mass>
          <inertia><ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz></inertia>
        </inertial>
      </link>
      <joint name="pivot" type="revolute">
        <parent>world</parent><child>bob</child>
        <axis><xyz>0 1 0</xyz></axis>
        <sensor name="wrench" type="force_torque">
          <update_rate>200</update_rate>
          <topic>wrench</topic>
          <force_torque>
            <frame>child</frame>
            <measure_direction>child_to_parent</measure_direction>
            <force>
              <x><noise type="gaussian"><stddev>0.6</stddev></noise></x>
              <z><noise type="gaussian"><stddev>0.6</stddev></noise></z>
            </force>
          </force_torque>
        </sensor>
      </joint>
    </model>
  </world>
</sdf>
"""


def main(out: Path) -> None:
    with simkit.load(WORLD, seed=1) as sim:
        pivot, sensor = sim.joint("pendulum::pivot"), sim.sensor("pendulum::pivot::wrench")
        rows = []
        for _ in range(500):
            sim.step(5)
            force = sensor.latest.wrench.force
            rows.append((sim.time, pivot.position, force.x, force.z))
    time, angle, along, across = np.array(rows).T
    # Newton along and across the rod, the speed from the height fallen; the bob pulls on the joint
    pull = 3 * MASS * G * np.sin(angle)
    drag = -MASS * G * np.cos(angle) * 1e-4 / (MASS * LENGTH**2 + 1e-4)

    fig, axes = figure("Force of a falling pendulum on its joint, in the pendulum's axes", rows=2, sharex=True)
    for ax, label, values, truth, colour in (
        (axes[0], "along the rod [N]", along, pull, BLUE),
        (axes[1], "across it [N]", across, drag, ORANGE),
    ):
        ax.plot(time, values, ".", ms=2.5, color=colour, label="readings, σ = 0.6 N")
        ax.plot(time, truth, color=TRUTH, label="analytic: 3 m g sin θ" if ax is axes[0] else "analytic")
        ax.set_ylabel(label)
        ax.margins(y=0.25)
        ax.legend(loc="upper right", ncols=2)
    axes[1].set_xlabel("time [s]")
    save(fig, out)


if __name__ == "__main__":
    run(main, "force_torque.png")
