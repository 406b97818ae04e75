"""A compass that turns once around, in Zurich and near the magnetic pole: `python magnetometer.py [OUT.png]`."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import plots

import simkit

WORLD = """<sdf version="1.9"><world name="w">
  <spherical_coordinates><latitude_deg>{}</latitude_deg><longitude_deg>{}</longitude_deg></spherical_coordinates>
  <model name="compass"><static>true</static><link name="l">
    <sensor name="s" type="magnetometer"><magnetometer>
      <x><noise type="gaussian"><stddev>4e-7</stddev></noise></x>
      <y><noise type="gaussian"><stddev>4e-7</stddev></noise></y>
    </magnetometer></sensor></link></model></world></sdf>"""
PLACES = {"Zurich, 47.4° N 8.5° E": (47.4, 8.5), "Resolute, 74.7° N 94.8° W": (74.7, -94.8)}


def turn(place: tuple[float, float]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Yaw [rad] from north, clockwise; horizontal field forward and left [µT], read and true."""
    yaws, read, true = np.linspace(0, 2 * math.pi, 145), [], []
    with simkit.load(WORLD.format(*place), seed=1) as sim:
        sensor = sim.sensor("compass::l::s")
        for yaw in yaws:
            sim.model("compass").set_pose(simkit.Pose.from_rpy(0, 0, 0, 0, 0, math.pi / 2 - yaw))
            sim.step(1)
            for message, kept in ((sensor.latest, read), (sensor.truth, true)):
                field = message.magnetic_field
                kept.append((field.x * 1e6, field.y * 1e6))
    return yaws, np.array(read), np.array(true)


def main(out: Path) -> None:
    figure, axes = plots.figure("Magnetometer: a compass turned once around, pointing north at 0°", rows=2, sharex=True)
    for ax, (name, place) in zip(axes, PLACES.items(), strict=True):
        yaws, read, true = turn(place)
        degrees = np.degrees(yaws)
        ax.plot(degrees, read, ".", markersize=3)
        ax.plot(degrees, true, color=plots.TRUTH)
        declination = math.degrees(math.atan2(-true[0, 1], true[0, 0]))
        ax.axvline(declination % 360, color=plots.RED, linestyle="--", label=f"magnetic north, {declination:+.1f}°")
        ax.set_title(name)
        ax.set_ylabel("field [µT]")
        names = ["forward (x)", "left (y)", ax.lines[-1].get_label()]
        ax.legend(
            [*ax.lines[:2], ax.lines[-1]], names, loc="lower right", bbox_to_anchor=(1, 1), ncols=3, frameon=False
        )
    axes[1].set_xlabel("heading of the sensor's x from true north, clockwise [°]")
    plots.save(figure, out)


if __name__ == "__main__":
    plots.run(main, "magnetometer.png")
