"""One hall as four laser scanners see it: what they reach, how far around, how densely, and with how much noise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from plots import BLUE, ORANGE, TRUTH, figure, run, save

import simkit

DEVICES = ("LDS-01", "URG-04LX", "TiM571", "RPLIDAR A3")
HALL = (14.0, 8.0)  # [m]
BLOCKS = ((2.5, 1.2), (-2.0, -2.2), (1.5, -1.5))  # centres of cubes of 0.8 m [m]


def block(name: str, x: float, y: float, length: float, width: float) -> str:
    shape = f"<geometry><box><size>{length} {width} 2</size></box></geometry>"
    return f"""<model name="{name}"><static>true</static><pose>{x} {y} 0 0 0 0</pose>
      <link name="l"><collision name="c">{shape}</collision></link></model>"""


def world() -> str:
    length, width = HALL
    walls = [
        block("north", 0, width / 2 + 0.1, length, 0.2),
        block("south", 0, -width / 2 - 0.1, length, 0.2),
        block("east", length / 2 + 0.1, 0, 0.2, width),
        block("west", -length / 2 - 0.1, 0, 0.2, width),
    ]
    cubes = [block(f"cube{i}", x, y, 0.8, 0.8) for i, (x, y) in enumerate(BLOCKS)]
    sensors = [f'<sensor name="{name}" type="lidar"><preset>{name}</preset></sensor>' for name in DEVICES]
    mast = f'<model name="mast"><static>true</static><link name="l">{"".join(sensors)}</link></model>'
    return f'<sdf version="1.9"><world name="w">{"".join(walls + cubes)}{mast}</world></sdf>'


def main(out: Path) -> None:
    fig, axes = figure("One hall, four presets", 2, 2, sharex=True, sharey=True)
    with simkit.load(world(), seed=1) as sim:
        sim.run(0.3)
        for ax, name in zip(axes.flat, DEVICES, strict=True):
            scan = sim.sensor(f"mast::l::{name}").latest
            angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
            hit = np.isfinite(scan.ranges)
            x, y = scan.ranges[hit] * np.cos(angles[hit]), scan.ranges[hit] * np.sin(angles[hit])
            ax.plot(x, y, ".", color=BLUE, markersize=2)
            ax.plot(0, 0, ">", color=ORANGE)
            ax.add_patch(_outline(HALL[0], HALL[1]))
            ax.set_title(f"{name}: {len(angles)} rays, {scan.range_max:g} m")
            ax.set_aspect("equal")
    for ax in axes[1]:
        ax.set_xlabel("x [m]")
    for ax in axes[:, 0]:
        ax.set_ylabel("y [m]")
    save(fig, out)


def _outline(length: float, width: float) -> object:
    from matplotlib.patches import Rectangle

    return Rectangle((-length / 2, -width / 2), length, width, fill=False, edgecolor=TRUTH, linewidth=0.5)


if __name__ == "__main__":
    run(main, "presets.png")
