"""A weather balloon's barometer up to 40 km, and a lift's over 30 m: `python air_pressure.py [OUT.png]`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import plots

import simkit

WORLD = """<sdf version="1.9"><world name="w">
  <model name="balloon"><static>true</static><link name="l">
    <sensor name="s" type="air_pressure"><air_pressure><pressure>
      <noise type="gaussian"><stddev>8</stddev></noise></pressure></air_pressure></sensor>
  </link></model></world></sdf>"""
# geometric height [km], pressure [Pa]: U.S. Standard Atmosphere, 1976, table I
TABLE = [(0, 101325), (5, 54048), (11, 22699), (20, 5529.3), (32, 889.06), (40, 287.14)]


def rise(heights: np.ndarray) -> tuple[list[float], list[float]]:
    """Pressure [Pa] at each height [m], read and true."""
    read, true = [], []
    with simkit.load(WORLD, seed=1) as sim:
        sensor = sim.sensor("balloon::l::s")
        for height in heights:
            sim.model("balloon").set_pose(simkit.Pose((0, 0, height)))
            sim.step(1)
            read.append(sensor.latest.fluid_pressure)
            true.append(sensor.truth.fluid_pressure)
    return read, true


def main(out: Path) -> None:
    figure, (left, right) = plots.figure("Air pressure, with noise of 8 Pa", columns=2)
    high, low = np.linspace(0, 40e3, 161), np.linspace(0, 30, 301)
    left.semilogy(high / 1e3, rise(high)[1], color=plots.TRUTH, label="truth")
    left.semilogy(*zip(*TABLE, strict=True), "o", color=plots.ORANGE, label="table of the standard")
    left.set_title("a balloon")
    left.set_xlabel("height [km]")
    left.set_ylabel("pressure [Pa]")
    read, true = rise(low)
    right.plot(low, read, ".", markersize=3, label="reading")
    right.plot(low, true, color=plots.TRUTH, label="truth")
    right.set_title("a lift")
    right.set_xlabel("height [m]")
    for ax in (left, right):
        ax.legend()
    plots.save(figure, out)


if __name__ == "__main__":
    plots.run(main, "air_pressure.png")
