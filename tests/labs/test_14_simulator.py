"""Lab 14: the solution follows simkit, which the picture of its README shows; the bench tells where it is left."""

from __future__ import annotations

import math
import shutil
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

import simkit

LAB = Path(__file__).parents[2] / "labs" / "14_simulator"


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """Return a folder with the solved lab."""
    folder = tmp_path / "lab"
    shutil.copytree(LAB, folder, ignore=shutil.ignore_patterns("solution", "__pycache__"))
    shutil.copytree(LAB / "solution", folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    return folder


def test_the_simulator_of_the_solution_has_at_most_60_lines() -> None:
    text = (LAB / "solution" / "simulator.py").read_text("utf-8")
    lines = [line for line in text[text.index("def swing") :].splitlines() if line.strip()]
    assert len(lines) <= 60


@pytest.mark.labs
def test_the_bench_tells_the_value_of_the_student_and_the_true_one(lab: Path) -> None:
    file = lab / "simulator.py"
    file.write_text(file.read_text("utf-8").replace("- ball.radius <= 0.0", "<= 0.0"), "utf-8")
    with simkit.load(lab / "lab.sdf", plugin_paths=[lab]) as sim:
        found = {name: sim.subscribe(f"/bench/{name}", keep=1) for name in ("touch", "height", "pendulum")}
        sim.run(6.0)
        said = {name: feed.latest.data for name, feed in found.items()}
    assert said["pendulum"] == "right"
    assert said["touch"].startswith("yours touches at 0.4") and ", true at 0.4" in said["touch"]
    assert ": yours 0.0" in said["height"] and " m, true 0.1" in said["height"]


@pytest.mark.labs
def test_the_picture_shows_the_solution_beside_simkit(lab: Path, tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names."""
    pyplot = pytest.importorskip("matplotlib.pyplot")
    rows = []
    with simkit.load(lab / "lab.sdf", plugin_paths=[lab]) as sim:
        bench: Any = next(plugin for plugin in sim.plugins.values() if type(plugin).__name__ == "Bench")
        ball, hinge, scan = sim.model("ball"), sim.joint("pendulum::hinge"), sim.subscribe("/scan", keep=1)
        while sim.time < 5.0:
            sim.run(0.01)
            place = ball.pose.position
            rows.append((sim.time, place[0], place[2], *bench.ball.place, hinge.position, bench.pendulum.angle))
            if abs(sim.time - 0.51) < 1e-6:
                ranges, first, step = list(scan.latest.ranges), scan.latest.angle_min, scan.latest.angle_increment
                seen = place[0], place[2]
    times, x, z, my_x, my_z, angle, my_angle = np.array(rows).T
    assert np.abs(z - my_z).max() < 0.015 and np.abs(angle - my_angle).max() < 0.01
    figure, (left, middle, right) = pyplot.subplots(1, 3, figsize=(10, 3.3), constrained_layout=True)
    left.plot(x, z, "k-", lw=1.5, label="simkit")
    left.plot(my_x, my_z, "--", color="#d55e00", lw=1.2, label="yours")
    left.set(title="path of the ball", xlabel="x [m]", ylabel="z [m]", xlim=(-0.1, 2.05), ylim=(0, 1.1))
    first_part = times < 3.0
    middle.plot(times[first_part], angle[first_part], "k-", lw=1.5, label="simkit")
    middle.plot(times[first_part], my_angle[first_part], "--", color="#d55e00", lw=1.2, label="yours")
    middle.set(title="angle of the pendulum", xlabel="time [s]", ylabel="angle [rad]", ylim=(-1.1, 1.6))
    for k, distance in enumerate(ranges):
        direction = first + k * step
        end = min(float(distance), 6.0)
        right.plot(
            [-0.5, -0.5 + end * math.cos(direction)],
            [0.4, 0.4 + end * math.sin(direction)],
            "-",
            color="#0072b2",
            lw=0.7,
        )
    right.add_patch(pyplot.Circle(seen, 0.1, color="#d55e00"))
    right.set(
        title="one scan of the lidar",
        xlabel="x [m]",
        ylabel="z [m]",
        xlim=(-0.6, 2.1),
        ylim=(-0.05, 2.0),
        aspect="equal",
    )
    left.legend(fontsize=8)
    middle.legend(fontsize=8, loc="upper right")
    picture = tmp_path / "simulator.png"
    figure.savefig(picture, dpi=90)
    pyplot.close(figure)
    shown, drawn = (cv2.imread(str(file)) for file in (LAB / "simulator.png", picture))
    assert shown is not None and drawn is not None and shown.shape == drawn.shape, picture
    assert (np.abs(shown.astype(float) - drawn).max(axis=2) > 100).mean() < 0.003, picture
