"""A glider that flies through a headwind, read as speeds: `python air_speed.py [OUT.png]`."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import plots

import simkit

WIND = 6.0  # [m/s] towards -x
WORLD = f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>
  <wind><linear_velocity>-{WIND} 0 0</linear_velocity></wind>
  <model name="glider"><pose>0 0 500 0 0 0</pose><link name="nose">
    <sensor name="pitot" type="air_speed"><update_rate>20</update_rate><air_speed><pressure>
      <noise type="gaussian"><stddev>6</stddev></noise></pressure></air_speed></sensor></link></model></world></sdf>"""
DENSITY = 1.1673  # [kg/m3] at 500 m, table I of the U.S. Standard Atmosphere, 1976


def main(out: Path) -> None:
    times, over_ground, read, true = [], [], [], []
    with simkit.load(WORLD, seed=1) as sim:
        sensor = sim.sensor("glider::nose::pitot")
        for _ in range(400):
            speed = 20 + 12 * math.sin(0.6 * sim.time)
            sim.model("glider").set_velocity((speed, 0, 0), (0, 0, 0))
            sim.run(0.05)
            times.append(sim.time)
            over_ground.append(speed)
            read.append(sensor.latest.diff_pressure)
            true.append(sensor.truth.diff_pressure)
    figure, axes = plots.figure("Air speed: a glider at 500 m, 6 m/s of wind from ahead", rows=2, sharex=True)
    axes[0].plot(times, read, ".", markersize=3, label="reading")
    axes[0].plot(times, true, color=plots.TRUTH, label="truth")
    axes[0].set_ylabel("diff_pressure [Pa]")
    speeds = np.sqrt(2 * np.maximum(read, 0) / DENSITY)
    axes[1].plot(times, speeds, ".", markersize=3, label="√(2 Δp / ρ)")
    axes[1].plot(times, np.array(over_ground) + WIND, color=plots.TRUTH, label="speed over ground + wind")
    axes[1].plot(times, over_ground, "--", color=plots.ORANGE, label="speed over ground")
    axes[1].set_ylabel("speed [m/s]")
    axes[1].set_xlabel("time [s]")
    for ax in axes:
        ax.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=3, frameon=False)
    plots.save(figure, out)


if __name__ == "__main__":
    plots.run(main, "air_speed.png")
