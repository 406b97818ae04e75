"""Plots of `docs/realism.md`: a real ROSMASTER X3 beside the simulated one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

Run = tuple[dict[str, Any], dict[str, Any], dict[float, dict[str, Any]]]


def draw_x3(
    folder: Path, real: Run, ideal: Run, sigmas: Mapping[float, float], shares: Mapping[float, float],
    cells: Sequence[Sequence[float]], frames: Mapping[int, float],
) -> None:  # fmt: skip
    """Draw all plots.

    Args:
        folder: folder of the images.
        real: values, data and walls of the run with the set of the robot.
        ideal: those of the run with ideal sensors.
        sigmas, shares: noise [mm] and shares of valid pixels [%] of the real camera by distance [m].
        cells: shares of valid pixels of the real image at 0.45 m [%].
        frames: shares of the frames from one cloud to the next.
    """
    folder.mkdir(parents=True, exist_ok=True)
    _draw_depth(folder / "x3_depth.png", real[2], sigmas, shares)
    _draw_wedge(folder / "x3_wedge.png", real[2][0.45], ideal[2][0.45], cells)
    _draw_scan(folder / "x3_scan.png", real[1], ideal[1])
    _draw_gaps(folder / "x3_gaps.png", real[1]["gaps"], frames)


def _save(figure: Any, file: Path) -> None:
    figure.tight_layout()
    figure.savefig(file, dpi=100, metadata={"Software": None})
    plt.close(figure)


def _draw_depth(
    file: Path, walls: Mapping[float, Any], sigmas: Mapping[float, float], shares: Mapping[float, float]
) -> None:
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.4))
    distances = sorted(walls)
    left.loglog(list(sigmas), list(sigmas.values()), "ko", label="real camera")
    left.loglog(distances, [1e3 * walls[d]["sigma"] for d in distances], "C0-", label="simkit")
    left.set(xlabel="distance of the wall [m]", ylabel="σ of the depths [mm]")
    left.set_xticks([0.5, 1, 2, 3], ["0.5", "1", "2", "3"])
    left.set_yticks([1, 2, 5, 10, 20, 40], ["1", "2", "5", "10", "20", "40"])
    left.minorticks_off()
    right.plot(list(shares), list(shares.values()), "ko", label="real camera")
    right.plot(distances, [walls[d]["valid"] for d in distances], "C0-", label="simkit")
    right.set(xlabel="distance of the wall [m]", ylabel="valid pixels [%]", ylim=(0, 100))
    for axes in (left, right):
        axes.grid(alpha=0.3)
        axes.legend()
    _save(figure, file)


def _draw_wedge(
    file: Path, real: Mapping[str, Any], ideal: Mapping[str, Any], cells: Sequence[Sequence[float]]
) -> None:
    figure, axes = plt.subplots(1, 3, figsize=(10, 2.9))
    titles = "real camera, valid pixels [%]", "simkit, rosmaster_x3", "simkit, ideal"
    for plot, title, grid in zip(axes, titles, (np.array(cells), real["grid"], ideal["grid"]), strict=True):
        plot.imshow(grid, vmin=0, vmax=100, cmap="viridis", aspect="auto")
        for (row, column), share in np.ndenumerate(grid):
            plot.text(
                column, row, f"{share:.0f}", ha="center", va="center", fontsize=7, color="w" if share < 60 else "k"
            )
        plot.set_title(title, fontsize=9)
        plot.set_xticks([])
        plot.set_yticks([])
    _save(figure, file)


def _draw_scan(file: Path, real: Mapping[str, Any], ideal: Mapping[str, Any]) -> None:
    figure, axes = plt.subplots(1, 2, figsize=(9, 4.2))
    for plot, title, data in zip(axes, ("ideal", "rosmaster_x3"), (ideal, real), strict=True):
        ranges = data["scan"]
        angles = np.linspace(-np.pi, np.pi, len(ranges)) + np.pi
        seen = np.isfinite(ranges)
        plot.plot((ranges * np.cos(angles))[seen], (ranges * np.sin(angles))[seen], ".", markersize=2)
        lost = angles[~seen]
        for radius in (0.4, 0.6, 0.8):
            label = "rays without a return" if radius == 0.8 else None
            plot.plot(radius * np.cos(lost), radius * np.sin(lost), "r.", markersize=0.6, label=label)
        plot.set(title=f"scan, {title}", xlabel="x [m]", ylabel="y [m]", aspect="equal")
        if lost.size:
            plot.legend(loc="lower left", fontsize=8)
    _save(figure, file)


def _draw_gaps(file: Path, gaps: Any, frames: Mapping[int, float]) -> None:
    figure, axes = plt.subplots(figsize=(7, 3))
    counts = np.bincount(gaps, minlength=36) / len(gaps)
    axes.bar(np.array(list(frames)) - 0.2, list(frames.values()), 0.4, color="k", label="real robot, 988 clouds")
    axes.bar(np.arange(len(counts)) + 0.2, counts, 0.4, color="C0", label=f"simkit, {len(gaps)} clouds")
    axes.set(xlabel="frames from one cloud to the next", ylabel="share", xlim=(0, 36), yscale="log", ylim=(5e-4, 0.6))
    axes.legend()
    _save(figure, file)
