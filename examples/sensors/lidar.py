"""A lidar's scan of the TurtleBot3 world, reading and truth, and what each ray hit: `python lidar.py [OUT.png]`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import plots

import simkit

COLOURS = (plots.BLUE, plots.ORANGE, plots.GREEN, plots.RED, plots.SKY, plots.PURPLE)


def main(out: Path) -> None:
    with simkit.load("turtlebot3_world", seed=1) as sim:
        lidar = sim.sensor("turtlebot3::base_scan::lds")
        sim.run(1.0)
        scan, truth, hits = lidar.latest, lidar.truth, lidar.hits
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    figure, (map_, errors) = plots.figure("Lidar: 360 rays in the TurtleBot3 world", columns=2)
    for i, name in enumerate(sorted(set(hits) - {""})):
        seen = hits == name
        angle, true = angles[seen], truth.ranges[seen]
        style = {"markersize": 4, "color": COLOURS[i % len(COLOURS)]}
        map_.plot(true * np.cos(angle), true * np.sin(angle), ".", **style)
        errors.plot(angle, 1000 * (scan.ranges[seen] - true), ".", **style)
    map_.plot(0, 0, "^", color=plots.TRUTH)
    map_.set(xlabel="x [m], forward", ylabel="y [m], left", title="truth, a colour for each thing hit")
    map_.set_aspect("equal")
    errors.set(xlabel="angle [rad]", ylabel="reading less truth [mm]", title="noise, standard deviation 10 mm")
    plots.save(figure, out)


if __name__ == "__main__":
    plots.run(main, "lidar.png")
