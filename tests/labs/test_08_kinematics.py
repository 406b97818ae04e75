"""Lab 8: the straight way collides in the simulation, the plans do not; the picture of the README shows both."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

import simkit

LAB = Path(__file__).parents[2] / "labs" / "08_kinematics"
CAMERA = (
    '<sdf version="1.9"><model name="watcher"><static>true</static><link name="l"><sensor name="camera" type="camera">'
    "<update_rate>5</update_rate><topic>/watcher</topic><camera><horizontal_fov>0.46</horizontal_fov>"
    "<image><width>480</width><height>540</height></image><clip><near>0.1</near><far>20</far></clip></camera></sensor></link>"
    "</model></sdf>"
)
VIEW = simkit.Pose.from_rpy(1.9, -2.1, 1.15, 0, 0.2, 2.3)


def lab_folder(folder: Path, *changes: tuple[str, str]) -> Path:
    """Copy the lab with its solution, in which texts are replaced."""
    shutil.copytree(LAB, folder, ignore=shutil.ignore_patterns("solution", "__pycache__"))
    text = (LAB / "solution" / "arm.py").read_text("utf-8")
    for old, new in changes:
        assert text.count(old) == 1
        text = text.replace(old, new)
    (folder / "arm.py").write_text(text, "utf-8")
    return folder


def run(folder: Path, picture_at: float) -> tuple[dict[str, list[float]], Any]:
    """Return what the referee published, and the picture of a camera at a time [s]."""
    with simkit.load(folder / "lab.sdf", plugin_paths=[folder], overrides=["tiago.self_collide=true"]) as sim:
        sim.spawn(CAMERA, name="watcher", pose=VIEW)
        names = ("pose_error", "turn_error", "joint_error", "self_contacts", "over_limit")
        heard = {name: sim.subscribe(f"/referee/{name}") for name in names}
        image = sim.subscribe("/watcher", keep=1)
        sim.run(picture_at)
        shown = np.asarray(image.latest.data).reshape(540, 480, 3)[:, :, ::-1].copy()
        image.close()
        sim.run(10.0 - picture_at)
        return {name: [message.data for message in found.messages] for name, found in heard.items()}, shown


@pytest.mark.labs
def test_the_straight_way_collides_and_the_plan_does_not(tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names."""
    straight = ("    path = connect(arm, start, goal, random)\n", "    path = [start, goal]\n")
    naive, left = run(lab_folder(tmp_path / "naive", straight), 2.0)
    assert max(naive["self_contacts"]) > 0
    right = left
    for seed in (1, 5):
        folder = lab_folder(tmp_path / f"seed{seed}", ("SEED = 1 ", f"SEED = {seed} "))
        planned, picture = run(folder, 2.6)
        right = picture if seed == 1 else right
        assert max(planned["self_contacts"]) == 0 and max(planned["over_limit"]) < 0.02
        best = int(np.argmin(planned["pose_error"]))
        assert planned["pose_error"][best] < 0.002 and planned["turn_error"][best] < np.radians(0.5)
        assert planned["joint_error"][-1] < 0.005
    drawn = np.hstack([left, right])
    cv2.imwrite(str(tmp_path / "plan.png"), drawn)
    shown = cv2.imread(str(LAB / "plan.png"))
    # renderers differ at edges; an arm that moved by a centimetre changes more than 2 % of the pixels
    assert shown is not None and np.mean(np.abs(shown.astype(int) - drawn).max(axis=2) > 40) < 0.02, (
        tmp_path / "plan.png"
    )
