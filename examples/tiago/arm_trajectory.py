"""Two points for the arm, after 2 s and after 4 s, with velocities: `python arm_trajectory.py [OUT.png]`.

The first point is not a stop: the arm passes through it at 1 rad/s in every joint. The controller lays cubic pieces
through positions and velocities, and a cubic takes a run-up: arm_1 comes to 0.2 rad from below, at 1 rad/s. From the
arm's folded place it would have to go below 0, where that joint ends; so here it starts from 1 rad.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from moves import ARM, Point, Vector, follow, move, picture_of, tiago_in

START = {"arm_1_joint": 1.0}
POINTS = (
    Point(2.0, (0.2, 0.0, -1.5, 1.94, -1.57, -0.5, 0.0), (1.0,) * 7),
    Point(4.0, (2.5, 0.2, -2.1, 1.9, 1.0, -0.5, 0.0), (0.0,) * 7),
)


class Motion(NamedTuple):
    """What the arm did.

    Attributes:
        times: since the goal was taken [s], shape (n,).
        desired, actual: positions [rad], shape (n, 7).
        result: of the action: its `error_code` is 0 where all went well.
        final: positions a second after the end [rad], shape (7,).
    """

    times: Vector
    desired: Vector
    actual: Vector
    result: Any
    final: Vector

    @property
    def error(self) -> float:
        """The largest distance of a joint from where it should be [rad]."""
        return float(np.abs(self.desired - self.actual).max())


def run(seed: int = 0) -> Motion:
    with tiago_in("empty", seed=seed) as sim:
        move(sim, "torso", {"torso_lift_joint": 0.25}, 4.0)  # so that the arm has room
        move(sim, "arm", START, 2.0)
        states = sim.subscribe("/arm_controller/controller_state", keep=1000)
        start = sim.time
        goal = follow(sim, "arm", ARM, POINTS)
        rows = [
            (seconds(m), m.reference.positions, m.feedback.positions) for m in states.messages if seconds(m) > start
        ]
        sim.run(1.0)
        final = np.array([sim.model("tiago").joint(name).position for name in ARM])
        times, desired, actual = (np.array(column) for column in zip(*rows, strict=True))
        return Motion(times - start, desired, actual, goal.result, final)


def seconds(message: Any) -> float:
    return float(message.header.stamp.sec + message.header.stamp.nanosec * 1e-9)


def draw(motion: Motion, out: Path) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(8.0, 4.2), dpi=110, layout="constrained")
    for i, name in enumerate(ARM):
        (line,) = axes.plot(motion.times, motion.actual[:, i], label=name.removesuffix("_joint"))
        axes.plot(motion.times, motion.desired[:, i], ":", color=line.get_color())
        axes.plot([p.seconds for p in POINTS], [p.positions[i] for p in POINTS], "o", color=line.get_color())
    axes.set(xlabel="time [s]", ylabel="position [rad]", title="Two points with velocities: wanted (dotted) and done")
    axes.legend(ncols=7, fontsize=8, loc="lower center")
    figure.savefig(out, pil_kwargs={"optimize": True})
    plt.close(figure)
    print(f"wrote {out}")


def main(arguments: list[str]) -> None:
    picture = picture_of(__doc__ or "", arguments)
    if picture is not None and importlib.util.find_spec("matplotlib") is None:
        sys.exit("the picture needs matplotlib: pip install matplotlib")
    motion = run()
    print(f"result {motion.result.error_code} {motion.result.error_string!r}, tracked within {motion.error:.4f} rad")
    if picture is not None:
        draw(motion, picture)


if __name__ == "__main__":
    main(sys.argv[1:])
