"""A swinging joint and its encoder of 256 counts per revolution: positions, and velocities told from the counts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from plots import BLUE, ORANGE, TRUTH, figure, run, save

import simkit

ENCODER = """
        <sensor name="{name}" type="custom" gz:type="encoder">
          <update_rate>100</update_rate>
          <topic>{name}</topic>
          <simkit:encoder>
            <counts_per_revolution>256</counts_per_revolution>
            <velocity><window>{window}</window></velocity>
          </simkit:encoder>
        </sensor>
"""
WORLD = f"""
<sdf version="1.9" xmlns:gz="http://gazebosim.org/schema" xmlns:simkit="simkit">
  <world name="swing">
    <model name="arm">
      <link name="rod">
        <inertial>
          <pose>0 0 -0.5 0 0 0</pose><mass>1</mass>
          <inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia>
        </inertial>
      </link>
      <joint name="hinge" type="revolute">
        <parent>world</parent><child>rod</child>
        <axis><xyz>0 1 0</xyz></axis>
        {ENCODER.format(name="short", window=0)}
        {ENCODER.format(name="long", window=0.1)}
      </joint>
    </model>
  </world>
</sdf>
"""


def main(out: Path) -> None:
    with simkit.load(WORLD) as sim:
        sim.joint("arm::hinge").set_position(0.3)
        short, long = sim.sensor("arm::hinge::short"), sim.sensor("arm::hinge::long")
        rows = []
        for _ in range(200):
            sim.step(10)
            true = short.truth
            told = short.latest
            values = true.position, told.position, true.velocity, told.velocity, long.latest.velocity
            rows.append((sim.time, *(float(v[0]) for v in values)))
    time, angle, counted, speed, quick, slow = np.array(rows).T

    fig, axes = figure("An encoder of 256 counts per revolution", rows=2, sharex=True)
    axes[0].step(time, counted, where="post", color=BLUE, label="nearest count")
    axes[0].plot(time, angle, color=TRUTH, lw=1, label="the joint")
    axes[0].set_ylabel("position [rad]")
    axes[1].plot(time, quick, ".", ms=3, color=BLUE, label="from two samples")
    axes[1].plot(time, slow, color=ORANGE, label="over a window of 0.1 s")
    axes[1].plot(time, speed, color=TRUTH, lw=1, label="the joint")
    axes[1].set(xlabel="time [s]", ylabel="velocity [rad/s]")
    for ax in axes:
        ax.margins(y=0.3)
        ax.legend(loc="upper right", ncols=3)
    save(fig, out)


if __name__ == "__main__":
    run(main, "encoder.png")
