"""Friction of a cube from recorded tosses: `simkit fit` on the recordings of ContactNets.

python benchmarks/fit_tosses.py --tosses FOLDER [--count N] [--window S] [--jobs N] [--step S]

FOLDER is `data` of github.com/DAIRLab/contact-nets (Pfrommer, Halm and Posa 2020), whose authors state μ = 0.18. Each
toss is cut into short parts that begin with the recorded state.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import measure  # noqa: F401  (finds simkit beside it)
import numpy as np
from contact_tosses import HALF_WIDTH, read_tensor

import simkit
from simkit.pose import quat_rotate
from simkit_identification.fitting.motion import Motion

MU = "cube::cube::c.surface.friction.ode.mu"


def world(settings: dict[str, float], step: float, mu: float) -> str:
    """World with the cube of the recordings on a plane."""
    inertia = settings["inertia"] * HALF_WIDTH**2
    size = 2 * HALF_WIDTH
    friction = "<surface><friction><ode><mu>{0}</mu><mu2>{0}</mu2></ode></friction></surface>"
    # the smaller coefficient of two surfaces counts, so the ground's is high
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 {-settings["g"] * HALF_WIDTH}</gravity>
<physics type="ignored"><max_step_size>{step}</max_step_size></physics>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane><normal>0 0 1</normal>
</plane></geometry>{friction.format(5)}</collision></link></model>
<model name="cube"><pose>0 0 0.5 0 0 0</pose><link name="cube"><inertial><mass>{settings["mass"]}</mass>
<inertia><ixx>{inertia}</ixx><iyy>{inertia}</iyy><izz>{inertia}</izz></inertia></inertial><collision name="c"><geometry>
<box><size>{size} {size} {size}</size></box></geometry>{friction.format(mu)}</collision></link></model></world></sdf>"""


def motion(path: Path, period: float) -> Motion:
    """Recorded toss in metres and the axes of the world."""
    rows = read_tensor(path)
    turns = rows[:, 3:7] / np.linalg.norm(rows[:, 3:7], axis=1)[:, None]
    angular = np.array([quat_rotate(q, w) for q, w in zip(turns, rows[:, 10:13], strict=True)])
    times = period * np.arange(len(rows))
    return Motion("cube", times, HALF_WIDTH * rows[:, :3], turns, HALF_WIDTH * rows[:, 7:10], angular, path.name)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--tosses", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--count", type=int, default=60, help="number of tosses, evenly spread over the recordings")
    parser.add_argument("--first", type=int, default=0, help="first toss")
    parser.add_argument("--window", type=float, default=0.1, help="length of a part [s]; 0 for whole tosses")
    parser.add_argument("--step", type=float, default=0.00097, help="time step of the simulation [s]")
    parser.add_argument("--jobs", type=int, default=1)
    args = parser.parse_args()
    settings = json.loads((args.tosses / "params_processed" / "experiment.json").read_text(encoding="utf-8"))
    settings["inertia"] *= 1.0
    files = sorted((args.tosses / "tosses_processed").glob("*.pt"), key=lambda path: int(path.stem))[args.first :]
    chosen = files[:: max(1, len(files) // args.count)][: args.count]
    motions = [motion(path, settings["dt"]) for path in chosen]
    stride = max(1, round(settings["dt"] / args.step))
    source = world(settings, settings["dt"] / stride, 0.5)
    result = simkit.fit(
        source, motions, f"{MU}=0.02:0.5:1.5", window=args.window or None, jobs=args.jobs, on_stage=print
    )
    print(*result.lines(), *result.diagnostics, sep="\n")
    low, high = result.intervals[MU]
    print(f"mu = {result.values[MU]:.4f} ({low:.4f} to {high:.4f}); stated {settings['mu']}")


if __name__ == "__main__":
    main()
