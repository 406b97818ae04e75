"""Lab 7: with AMCL, the solution reaches ten of ten goals on the true pose, without a contact; the pictures."""

from __future__ import annotations

import math
import re
import shutil
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

import simkit
from simkit.run_spec import Check
from simkit.testing.conditions import Watch

pytestmark = pytest.mark.labs

LAB = Path(__file__).parents[2] / "labs" / "07_navigation"
GOALS = {
    "turtlebot3_world": "-1.65 0.55 1.57, -0.55 1.65 0, 0.55 0.55 -1.57, 0.55 -0.55 3.1, -0.55 -1.65 -2",
    "turtlebot3_house": "-1.3 -1.5 -2, -1.3 1.0 0, 0.4 2.2 1.57, 2.5 1.0 0, 2.4 -0.2 -1.57",
}
SCALE = 4  # [px] of a cell


def colours(costs: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return the colours (BGR) of costs: white for free, through orange and red to black for obstacles."""
    share = np.clip(costs[..., None] / 253.0, 0.0, 1.0)
    found = np.where(share < 1.0, np.array([255, 255, 255]) + share * (np.array([60, 110, 230]) - 255.0), (40, 30, 150))
    return np.where(costs[..., None] == 254, 0, found).astype(np.uint8)


def with_amcl(file: Path) -> None:
    """Use AMCL in place of the true pose, as question 5 of the lab asks."""
    text = file.read_text("utf-8")
    true_pose = '    <plugin filename="libsimkit_fake_localization.so" name="fake_localization"/>\n'
    assert true_pose in text
    text = re.sub(r"<!-- Question 5: [^\n]*\n(.*?)-->", r"\1", text.replace(true_pose, ""), flags=re.DOTALL)
    file.write_text(text, "utf-8")


def drawn(costmap: Any, places: list[Any], goals: list[list[float]]) -> np.ndarray[Any, Any]:
    """Return the picture of a costmap, the path of the robot (blue) and the goals (green)."""
    info = costmap.metadata
    cells = np.asarray(costmap.data).reshape(info.size_y, info.size_x)
    image = np.repeat(np.repeat(colours(cells[::-1]), SCALE, axis=0), SCALE, axis=1)

    def pixel(x: float, y: float) -> tuple[int, int]:
        column, row = (x - info.origin.position.x) / info.resolution, (y - info.origin.position.y) / info.resolution
        return round(column * SCALE), round((info.size_y - row) * SCALE)

    cv2.polylines(image, [np.array([pixel(x, y) for x, y in places])], False, (200, 80, 0), 2, cv2.LINE_AA)
    for x, y, yaw in goals:
        tip = pixel(x + 0.3 * math.cos(yaw), y + 0.3 * math.sin(yaw))
        cv2.arrowedLine(image, pixel(x, y), tip, (60, 150, 0), 2, cv2.LINE_AA, 0, 0.35)
        cv2.circle(image, pixel(x, y), 4, (60, 150, 0), -1, cv2.LINE_AA)
    return image


@pytest.mark.parametrize("name", GOALS)
def test_all_goals_are_reached_without_a_contact(name: str, tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names."""
    lab = tmp_path / "lab"
    shutil.copytree(LAB, lab)
    shutil.copytree(LAB / "solution", lab, dirs_exist_ok=True)
    with_amcl(lab / "navigation.sdf")
    goals, places = [[*map(float, text.split())] for text in GOALS[name].split(",")], []
    overrides = {"navigation::referee.goals": GOALS[name], "physics.max_step_size": 0.002}
    with (
        simkit.load(name, seed=1, spawn=[str(lab / "navigation.sdf")], plugin_paths=[lab], overrides=overrides) as sim,
        Watch(sim, [Check("apart", models=("turtlebot3",))]) as watch,
    ):
        costmap = sim.subscribe("/global_costmap/costmap_raw", keep=1)
        heard = {
            key: sim.subscribe(f"/referee/{key}", keep=1) for key in ("finished", "succeeded", "distance", "angle")
        }
        while heard["finished"].latest is None or heard["finished"].latest.data < len(goals):
            sim.run(0.25)
            places.append(sim.model("turtlebot3").pose.position[:2])
            assert sim.time < 120.0
        found = {key: values.latest.data for key, values in heard.items()}
        (apart,) = watch.results("duration")
        assert apart.passed, apart.message
        image = drawn(costmap.latest, places, goals)
    assert found["succeeded"] == len(goals)
    assert found["distance"] < 0.10 and found["angle"] < math.radians(5.0)
    file = tmp_path / f"{name}.png"
    cv2.imwrite(str(file), image, [cv2.IMWRITE_PNG_COMPRESSION, 9])
    shown = cv2.imread(str(LAB / f"{name}.png"))
    assert shown is not None and shown.shape == image.shape, file
    assert (np.abs(shown.astype(int) - image).max(axis=2) > 40).mean() < 0.01, (
        file
    )  # a path that differs by some pixels
