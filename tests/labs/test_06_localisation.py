"""Lab 6: the solution and simkit's amcl against the truth, the map of the lab, and the picture of its README."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

import simkit
from simkit.cli import app

pytestmark = pytest.mark.labs

LAB = Path(__file__).parents[2] / "labs" / "06_localisation"
AMCL = """<plugin filename="libsimkit_amcl.so" name="amcl"><laser_model_type>likelihood_field_prob</laser_model_type>
<max_beams>20</max_beams><max_particles>3000</max_particles><update_min_d>0.1</update_min_d>
<recovery_alpha_slow>0.001</recovery_alpha_slow><recovery_alpha_fast>0.3</recovery_alpha_fast></plugin>"""
STARTS = [
    (1.0, 1.0, 0.0),
    (2.0, 3.2, 1.0),
    (5.0, 1.0, 2.0),
    (4.5, 3.3, 3.0),
    (2.8, 1.2, -2.0),
    (1.0, 3.0, -1.0),
    (3.0, 2.8, 0.5),
    (5.3, 2.3, 1.5),
    (2.0, 0.5, -3.0),
    (4.3, 0.6, 2.5),
]  # x, y [m] and yaw [rad]
SCALE = 70  # [px/m] of the picture
SHOWN = (-0.1, -0.1, 6.1, 4.1)  # [m], its part of the map
INK, PATH, PARTICLE, PAPER, WALL = (40, 40, 40), (60, 160, 60), (200, 110, 30), (255, 255, 255), (90, 90, 90)


@contextmanager
def tour(start: tuple[float, float, float], seed: int, localisation: str = "") -> Iterator[simkit.Simulation]:
    """Load the lab's world with a start pose, and with another plugin in place of the student's."""
    text = (LAB / "lab.sdf").read_text("utf-8")
    if localisation:
        text = re.sub(r"<plugin filename=\"localise.py\".*?/>", localisation, text)
    folders: dict[str, Any] = {"plugin_paths": [LAB / "solution", LAB], "resource_paths": [LAB]}
    with simkit.load(text, seed=seed, overrides={"robot.pose": "{} {} 0 0 0 {}".format(*start)}, **folders) as sim:
        yield sim


def plugin(sim: simkit.Simulation, name: str) -> Any:
    return next(one for one in sim.plugins.values() if type(one).__name__ == name)


@pytest.mark.parametrize("localisation", ["", AMCL], ids=["solution", "amcl"])
def test_the_filter_is_exact_from_ten_of_ten_starts_and_finds_nine_of_ten_carried_robots(localisation: str) -> None:
    errors, found_again = [], []
    for number, start in enumerate(STARTS):
        with tour(start, number, localisation) as sim:
            position, heading = (sim.subscribe(f"/referee/{name}_error", keep=1) for name in ("position", "heading"))
            done = sim.subscribe("/referee/done", keep=1)
            while done.latest is None and sim.time < 45:
                sim.run(0.5)
            errors.append((position.latest.data, heading.latest.data))
            driver = plugin(sim, "Tour")
            driver.carried = STARTS[(number + 3) % 10]
            x, y, yaw = driver.carried
            sim.model("robot").set_pose(simkit.Pose.from_rpy(x, y, 0, 0, 0, yaw))
            driver.next(driver.drive)
            until = sim.time + 21.5
            sim.run(3.0)
            while sim.time < until and not (position.latest.data < 0.10 and heading.latest.data < 3):
                sim.run(0.5)
            found_again.append(sim.time < until)
    assert all(position < 0.10 and heading < 3 for position, heading in errors), errors
    assert sum(found_again) >= 9, found_again


def test_the_map_of_the_lab_is_the_true_one(tmp_path: Path) -> None:
    bare = re.sub(r"<plugin.*?(/>|</plugin>)", "", (LAB / "lab.sdf").read_text("utf-8"))
    (tmp_path / "bare.sdf").write_text(bare, "utf-8")
    assert CliRunner().invoke(app, ["map", str(tmp_path / "bare.sdf"), "-o", str(tmp_path / "rooms")]).exit_code == 0
    for name in ("rooms.pgm", "rooms.yaml"):
        assert (tmp_path / name).read_bytes() == (LAB / name).read_bytes()


def pixel(x: float, y: float) -> tuple[int, int]:
    return round((x - SHOWN[0]) * SCALE), round((SHOWN[3] - y) * SCALE)


def panel(title: str, poses: Any, path: list[tuple[float, float]], robot: simkit.Pose) -> Any:
    """Draw the map, the particles, the path of the robot, and its true pose."""
    cells = cv2.imread(str(LAB / "rooms.pgm"), cv2.IMREAD_GRAYSCALE)
    assert cells is not None
    left, low, right, high = (round((v - o) / 0.05) for v, o in zip(SHOWN, (-0.65, -0.6, -0.65, -0.6), strict=True))
    part = cells[len(cells) - high : len(cells) - low, left:right]
    size = round((SHOWN[2] - SHOWN[0]) * SCALE), round((SHOWN[3] - SHOWN[1]) * SCALE)
    walls = cv2.resize(part, size, interpolation=cv2.INTER_NEAREST) < 100
    image = np.where(walls[..., None], WALL, PAPER).astype(np.uint8)
    for x, y, yaw in poses:
        cv2.line(image, pixel(x, y), pixel(x + 0.07 * np.cos(yaw), y + 0.07 * np.sin(yaw)), PARTICLE, 1)
    if path:
        cv2.polylines(image, [np.array([pixel(x, y) for x, y in path])], False, PATH, 2, cv2.LINE_AA)
    x, y, yaw = robot.position[0], robot.position[1], robot.rpy[2]
    cv2.circle(image, pixel(x, y), 9, PATH, 2, cv2.LINE_AA)
    cv2.line(image, pixel(x, y), pixel(x + 0.2 * np.cos(yaw), y + 0.2 * np.sin(yaw)), PATH, 2, cv2.LINE_AA)
    banner = np.full((28, size[0], 3), 255, np.uint8)
    cv2.putText(banner, title, (8, 20), cv2.FONT_HERSHEY_SIMPLEX, 0.55, INK, 1, cv2.LINE_AA)
    return cv2.copyMakeBorder(np.concatenate([banner, image]), 4, 4, 4, 4, cv2.BORDER_CONSTANT, value=PAPER)


def test_the_picture_shows_the_particles_of_the_solution(tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names."""
    panels, path = [], []
    with tour(STARTS[0], 0) as sim:
        particles, robot, done = plugin(sim, "Localise"), sim.model("robot"), sim.subscribe("/referee/done", keep=1)
        sim.run(0.55)
        panels.append(panel("0.5 s: 3000 particles, everywhere", particles.poses, path, robot.pose))
        sim.run(0.3)
        panels.append(panel(f"after one scan: {len(particles.poses)} particles", particles.poses, path, robot.pose))
        sim.run(4.0)
        panels.append(panel("after a turn", particles.poses, path, robot.pose))
        while done.latest is None and sim.time < 45:
            sim.run(0.2)
            path.append((robot.pose.position[0], robot.pose.position[1]))
        panels.append(panel("after 3 m", particles.poses, path, robot.pose))
    rows = [np.concatenate(panels[i : i + 2], axis=1) for i in (0, 2)]
    drawn = np.concatenate(rows)
    cv2.imwrite(str(tmp_path / "particles.png"), drawn, [cv2.IMWRITE_PNG_COMPRESSION, 9])
    shown = cv2.imread(str(LAB / "particles.png"))
    assert shown is not None and shown.shape == drawn.shape, tmp_path / "particles.png"
    differs = (np.abs(shown.astype(int) - drawn) > 60).any(axis=2).mean()
    assert differs < 0.02, tmp_path / "particles.png"  # a few particles may differ on another machine
