"""Labs of the course: each solution gets full points, a stub and typical mistakes do not and are told why."""

from __future__ import annotations

import json
import runpy
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

import simkit
from simkit.cli import app

HERE = Path(__file__).parent
LABS = sorted(path.parent.name for path in (HERE.parents[1] / "labs").glob("*/exercise.yaml"))

MISTAKES = {
    ("01_turtlesim", "drives by time"): ("closes the square to 1 cm", HERE / "turtle_by_time.py"),
    ("01_turtlesim", "drives while it turns"): (
        "takes no detours",
        ("min(SPEED_GAIN * distance, 1.0) if abs(error) < 0.02 else 0.0", "min(SPEED_GAIN * distance, 2.0)"),
    ),
    ("01_turtlesim", "publishes nothing at the end"): (
        "has stopped",
        ("        self.command.publish", "        self.next < len(CORNERS) and self.command.publish"),
    ),
}
"""Lab and mistake -> the check that fails, and the file, or a text of the solution and what stands there instead."""


def lab(*arguments: object) -> Any:
    return CliRunner().invoke(app, ["lab", *map(str, arguments)])


def failed_checks(report: str) -> set[str]:
    return {
        check["title"]
        for grade in json.loads(report)
        for run in grade["runs"]
        for check in run["checks"]
        if not check["passed"]
    }


def test_the_list_has_a_name_a_line() -> None:
    found = lab("list")
    assert (found.exit_code, found.stdout.splitlines()) == (0, LABS)


@pytest.mark.slow
@pytest.mark.parametrize("name", LABS)
def test_a_solution_gets_full_points_and_the_stub_does_not(name: str, tmp_path: Path) -> None:
    assert lab("start", name, tmp_path / "solved", "--solution").exit_code == 0
    solved = lab("grade", tmp_path / "solved", "--json")
    assert (solved.exit_code, failed_checks(solved.stdout)) == (0, set())
    assert lab("start", name, tmp_path / "stub").exit_code == 0
    assert {"README.md", "exercise.yaml"} < {path.name for path in (tmp_path / "stub").iterdir()}
    assert not (tmp_path / "stub" / "solution").exists()
    stub = lab("grade", tmp_path / "stub")
    assert stub.exit_code == 5
    assert "hint:" in stub.output and "Traceback" not in stub.output


@pytest.mark.slow
@pytest.mark.parametrize("mistake", MISTAKES, ids=" ".join)
def test_a_typical_mistake_fails_the_check_that_names_it(mistake: tuple[str, str], tmp_path: Path) -> None:
    check, change = MISTAKES[mistake]
    assert lab("start", mistake[0], tmp_path / "lab", "--solution").exit_code == 0
    hand_in = next((tmp_path / "lab").glob("*.py"))
    solution = hand_in.read_text("utf-8")
    if isinstance(change, Path):
        hand_in.write_bytes(change.read_bytes())
    else:
        assert solution.count(change[0]) == 1
        hand_in.write_text(solution.replace(*change), "utf-8")
    found = lab("grade", tmp_path / "lab", "--json")
    assert found.exit_code == 5
    assert check in failed_checks(found.stdout)


def test_the_picture_of_the_turtle_is_that_of_the_solution(tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names."""
    assert lab("start", "01_turtlesim", tmp_path / "lab", "--solution").exit_code == 0
    square = runpy.run_path(str(tmp_path / "lab" / "square.py"))["Square"]
    with simkit.load("turtlesim", plugins=[("turtle1", square())]) as sim:
        window = sim.subscribe("/turtlesim/image", keep=1)
        sim.run(18.0)
        image = np.asarray(window.latest.data).reshape(500, 500, 3)[:, :, ::-1]
    cv2.imwrite(str(tmp_path / "square.png"), image)
    shown = cv2.imread(str(HERE.parents[1] / "labs" / "01_turtlesim" / "square.png"))
    assert shown is not None and np.array_equal(shown, image), tmp_path / "square.png"


def test_each_lab_has_three_mistakes() -> None:
    assert {name: sum(key[0] == name for key in MISTAKES) for name in LABS} == dict.fromkeys(LABS, 3)


def test_a_folder_with_files_is_not_overwritten(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine", "utf-8")
    found = lab("start", LABS[0], tmp_path)
    assert found.exit_code == 2 and "SK-CLI-016" in found.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def test_a_lab_is_started_in_an_empty_folder_that_stays(tmp_path: Path) -> None:
    before = tmp_path.stat().st_ino
    assert lab("start", LABS[0], tmp_path).exit_code == 0
    assert (tmp_path.stat().st_ino, (tmp_path / "README.md").is_file()) == (before, True)


def test_an_unknown_lab_and_a_folder_without_one_are_errors(tmp_path: Path) -> None:
    found = lab("start", "01_turtelsim", tmp_path / "a")
    assert found.exit_code == 2 and "did you mean '01_turtlesim'" in found.stderr
    found = lab("grade", tmp_path)
    assert found.exit_code == 2 and "simkit lab start NAME" in found.stderr
    assert list(tmp_path.iterdir()) == []
