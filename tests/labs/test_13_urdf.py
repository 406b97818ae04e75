"""Lab 13: the referee tells the student's value and the true one; the picture of its README shows the solution."""

from __future__ import annotations

import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest

import simkit
from simkit import render_view

LAB = Path(__file__).parents[2] / "labs" / "13_urdf"


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """Return a folder with the solved lab."""
    folder = tmp_path / "lab"
    shutil.copytree(LAB, folder, ignore=shutil.ignore_patterns("solution", "__pycache__"))
    shutil.copytree(LAB / "solution", folder, dirs_exist_ok=True)
    return folder


def opened(lab: Path) -> simkit.Simulation:
    return simkit.load(lab / "lab.sdf", plugin_paths=[lab], spawn=[f"{lab / 'robot.urdf.xacro'}:0,0,0.08,0"])


def test_the_referee_tells_the_value_of_the_student_and_the_true_one(lab: Path) -> None:
    robot = lab / "robot.urdf.xacro"
    text = robot.read_text("utf-8").replace('mass="0.3"', 'mass="0.4"').replace('lower="-1.4"', 'lower="-1.5"')
    robot.write_text(text.replace('<origin xyz="-0.06 0 0.10"/>', '<origin xyz="0.06 0 0.10"/>'), "utf-8")
    with opened(lab) as sim:
        found = {name: sim.subscribe(f"/referee/{name}", keep=1) for name in ("names", "masses", "joints", "limits")}
        sim.run(0.05)
        said = {name: feed.latest.data for name, feed in found.items()}
    assert said == {
        "names": "right",
        "masses": "forearm: yours 0.4 kg, true 0.3 kg",
        "joints": "shoulder_joint: yours at (0.06, 0, 0.1) m, true (-0.06, 0, 0.1) m",
        "limits": "shoulder_joint: lower yours -1.5, true -1.4",
    }


@pytest.mark.labs
def test_the_picture_shows_the_robot_of_the_solution(lab: Path, tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names."""
    views = []
    with opened(lab) as sim:
        for time in (10.8, 12.9, 14.9):
            sim.run(time - sim.time)
            x, y, _ = sim.model("carrier").pose.position
            eye, target = np.array((x + 0.6, y - 0.9, 0.5)), np.array((x - 0.05, y, 0.3))
            views.append(render_view(sim, 330, 330, eye=eye, target=target, passes=8))
    picture = tmp_path / "robot.png"
    cv2.imwrite(str(picture), np.hstack(views)[:, :, ::-1], [cv2.IMWRITE_PNG_COMPRESSION, 9])
    shown, drawn = (cv2.imread(str(file)) for file in (LAB / "robot.png", picture))
    assert shown is not None and drawn is not None and shown.shape == drawn.shape, picture
    assert np.abs(shown.astype(float) - drawn).mean() < 2.0, picture
