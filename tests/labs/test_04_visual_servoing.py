"""Lab 4: the errors of the solution decay as they should from other starts too, and the picture of its README."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from simkit import Simulation, msgs
from simkit.testing.scenarios.scenario_run import open_scenario
from simkit_verification.testing.grading.exercise import read_exercise

pytestmark = pytest.mark.labs
LAB = Path(__file__).parents[2] / "labs" / "04_visual_servoing"
ROBOTS = {
    "exercise.yaml": ("TurtleBot3", "/camera/image_raw", 141.4, ("$x$",)),
    "exercise_turtlebot2.yaml": ("TurtleBot 2", "/camera/rgb/image_raw", 138.6, ("$x$", "distance")),
    "exercise_baxter.yaml": ("Baxter", "/cameras/left_hand_camera/image", 119.2, ("$x$", "$y$", "distance")),
}
"""Exercise -> name, topic of the images, focal length [pixels] and features."""


def opened(exercise: str, overrides: tuple[str, ...] = ()) -> Any:
    spec = read_exercise(LAB / exercise).runs[0].scenario
    return open_scenario(spec, plugin_paths=(LAB / "solution", LAB), overrides=(*spec.overrides, *overrides))


@pytest.mark.parametrize("yaw", [0.2, 0.65, 0.8])
def test_the_ball_may_be_anywhere_in_the_image_at_the_start(yaw: float) -> None:
    """Only the first part is run: the ball is at the image coordinates -0.24, 0.23 and 0.40 at first."""
    with opened("exercise.yaml", (f"turtlebot3.pose.yaw={yaw}",)) as sim:
        said = {name: sim.subscribe(f"/referee/{name}") for name in ("in_sight", "first_decay", "saturation", "error")}
        sim.run(5.4)
    assert all(message.data for message in said["in_sight"].messages)
    assert max(message.data for message in said["saturation"].messages) <= 1.000001
    assert said["first_decay"].latest.data == pytest.approx(1.0, abs=0.1)
    assert abs(said["error"].latest.data[0]) < 0.05


# ---------------------------------------------------------------------- the picture


@dataclass
class Run:
    """Record of one exercise: images of the first part, places of the ball in them, and errors over time."""

    images: list[Any]
    places: list[tuple[float, float]]
    times: np.ndarray
    errors: np.ndarray
    decays: list[float]
    begin: float


def record(sim: Simulation, topic: str, duration: float) -> Run:
    times: list[float] = []
    images, balls, errors = (
        sim.subscribe(topic, keep=1000),
        sim.subscribe("/ball", keep=1000),
        sim.subscribe("/referee/error", keep=1000, callback=lambda _: times.append(sim.time)),
    )
    decays = [sim.subscribe(f"/referee/{part}_decay") for part in ("first", "second")]
    sim.run(duration)
    table = np.array([message.data for message in errors.messages])
    begin = times[int(np.argmax(np.abs(np.diff(table[:, 0])))) + 1]  # the ball is moved
    places = [(m.point.x, m.point.y) for m in balls.messages if msgs.stamp_ns(m.header.stamp) * 1e-9 < begin]
    return Run(list(images.messages), places, np.array(times), table, [d.latest.data for d in decays], begin)


def draw(runs: dict[str, Run], file: Path) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({"font.size": 8, "axes.titlesize": "medium", "axes.titlelocation": "left"})
    figure, axes = plt.subplots(2, 3, figsize=(9.0, 5.6), dpi=100, layout="constrained", height_ratios=(1.15, 1))
    for (exercise, run), above, below in zip(runs.items(), *axes, strict=True):
        name, _, focal, features = ROBOTS[exercise]
        image = msgs.image(run.images[0])
        height, width = image.shape[:2]
        above.imshow(image, extent=(0, width, height, 0))
        columns, rows = np.array(run.places).T * focal + [[width / 2], [height / 2]]
        above.plot(columns, rows, color="white", linewidth=3)
        above.plot(columns, rows, color="black", linewidth=1, marker=".", markersize=3)
        above.axvline(width / 2, color="black", linewidth=0.5, linestyle=":")
        above.set(title=f"{name}: first image, path of the ball", xticks=[], yticks=[])
        for values, feature, colour in zip(run.errors.T, features, ("#0072b2", "#d55e00", "#009e73"), strict=False):
            below.semilogy(run.times, np.abs(values), color=colour, label=feature)
        for gain, first, last in ((0.5, 2.5, run.begin), (0.8, run.begin + 1.5, run.times[-1])):
            start = np.abs(run.errors[np.searchsorted(run.times, first), 0])
            span = np.array([first, last])
            label = r"$e^{-\lambda t}$" if gain == 0.5 else None
            below.semilogy(span, start * np.exp(-gain * (span - first)), "k--", linewidth=1, label=label, zorder=3)
        rates = " and ".join(f"{rate:.2f}" for rate in run.decays)
        below.set(title=f"measured rate / gain: {rates}", xlabel="time [s]", ylim=(0.003, 2), xlim=(0, run.times[-1]))
        below.grid(alpha=0.3)
        below.legend(loc="lower left", fontsize=7)
    axes[1][0].set_ylabel("|error|, in the image or [m]")
    figure.savefig(file)
    plt.close(figure)
    image = cv2.imread(str(file))
    assert image is not None
    cv2.imwrite(str(file), image, [cv2.IMWRITE_PNG_COMPRESSION, 9])


def test_the_picture_shows_the_runs_of_the_solution(tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names.

    The fonts of matplotlib differ a little between versions: a mean difference of 2 of 255 is a few moved letters.
    """
    pytest.importorskip("matplotlib")
    runs = {}
    for exercise, (_, topic, _, _) in ROBOTS.items():
        duration = read_exercise(LAB / exercise).runs[0].scenario.duration
        assert duration is not None
        with opened(exercise) as sim:
            runs[exercise] = record(sim, topic, duration)
    file = tmp_path / "visual_servoing.png"
    draw(runs, file)
    drawn, shown = (cv2.imread(str(one)) for one in (file, LAB / "visual_servoing.png"))
    assert shown is not None and drawn is not None and drawn.shape == shown.shape, file
    assert np.abs(drawn.astype(int) - shown.astype(int)).mean() < 2.0, file
