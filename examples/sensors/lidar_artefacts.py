"""A room as an ideal lidar and one with losses measure it: `python lidar_artefacts.py [OUT.png]`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import plots

import simkit

BOX = """<model name="{0}"><static>true</static><pose>{1}</pose><link name="l"><visual name="v"><geometry><box>
  <size>{2}</size></box></geometry>{3}</visual></link></model>"""
DARK, GLASS = "<simkit:reflectivity>0.03</simkit:reflectivity>", "<simkit:transmittance>0.9</simkit:transmittance>"
BOXES = (
    ("front", "5 0 1 0 0 0", "0.1 8 2", ""), ("back", "-4 0 1 0 0 0", "0.1 8 2", DARK),
    ("left", "0.5 4 1 0 0 0", "9 0.1 2", ""), ("right", "0.5 -4 1 0 0 0", "9 0.1 2", ""),
    ("pane", "2 1.5 1 0 0 0", "0.02 2 2", GLASS), ("crate", "2.5 -1.5 1 0 0 0.5", "1 1 2", ""),
    ("post", "1.2 -0.2 1 0 0 0", "0.1 0.1 2", ""),
)  # fmt: skip
LOSSES = """<simkit:glass_and_mirrors/><simkit:beam><divergence>0.03</divergence><rings>2</rings></simkit:beam>
  <simkit:range_error><stddev><constant>0.01</constant><coefficient>0.005</coefficient></stddev></simkit:range_error>
  <simkit:signal><range>5</range><reflectivity>0.2</reflectivity><spread>0.2</spread></simkit:signal>
  <simkit:dropout><probability>0.05</probability><burst_length>3</burst_length></simkit:dropout>"""
LIDARS = {"ideal": "", "with losses": LOSSES}
SENSOR = """<sensor name="s{0}" type="gpu_lidar"><update_rate>10</update_rate><topic>scan{0}</topic>
  <lidar><scan><horizontal><samples>720</samples><min_angle>-3.14159</min_angle><max_angle>3.13286</max_angle></horizontal></scan>
  <range><min>0.1</min><max>12</max></range></lidar>{1}</sensor>"""
WORLD = """<sdf version="1.9" xmlns:simkit="simkit"><world name="room"><model name="rig"><static>true</static>
  <pose>0 0 1 0 0 0</pose><link name="l">{}</link></model>{}</world></sdf>"""


def main(out: Path) -> None:
    sensors = "".join(SENSOR.format(i, losses) for i, losses in enumerate(LIDARS.values()))
    with simkit.load(WORLD.format(sensors, "".join(BOX.format(*box) for box in BOXES)), seed=1) as sim:
        sim.run(0.1)
        scans = [np.array(sim.sensor(f"rig::l::s{i}").latest.ranges) for i in range(len(LIDARS))]
    angles = np.linspace(-3.14159, 3.13286, 720)
    figure, axes = plots.figure("One room, two lidars", columns=2, rows=1, figsize=(8.0, 3.9))
    for axis, name, ranges in zip(axes.flat, LIDARS, scans, strict=True):
        seen = np.isfinite(ranges)
        axis.plot(ranges[seen] * np.cos(angles[seen]), ranges[seen] * np.sin(angles[seen]), ".", markersize=2)
        axis.set(title=f"{name}: {seen.mean():.0%} with a return", xlabel="x [m]", ylabel="y [m]", aspect="equal")
        axis.set(xlim=(-4.6, 5.6), ylim=(-4.6, 4.6))
    plots.save(figure, out)


if __name__ == "__main__":
    plots.run(main, "lidar_artefacts.png")
