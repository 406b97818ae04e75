"""Lab 1: the picture of its README is the window of the turtlesim after the solution has run."""

from __future__ import annotations

import runpy
from pathlib import Path

import cv2
import numpy as np

import simkit

LAB = Path(__file__).parents[2] / "labs" / "01_turtlesim"


def test_the_picture_of_the_turtle_is_that_of_the_solution(tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names."""
    square = runpy.run_path(str(LAB / "solution" / "square.py"))["Square"]
    with simkit.load("turtlesim", plugins=[("turtle1", square())]) as sim:
        window = sim.subscribe("/turtlesim/image", keep=1)
        sim.run(18.0)
        image = np.asarray(window.latest.data).reshape(500, 500, 3)[:, :, ::-1]
    cv2.imwrite(str(tmp_path / "square.png"), image)
    shown = cv2.imread(str(LAB / "square.png"))
    assert shown is not None and np.array_equal(shown, image), tmp_path / "square.png"
