"""Labs of the course: each solution gets full points, a stub and typical mistakes do not and are told why."""

from __future__ import annotations

import json
import runpy
from pathlib import Path
from typing import Any

import pytest
import yaml
from typer.testing import CliRunner

from simkit.cli import app

HERE = Path(__file__).parent
LABS = sorted(path.parent.name for path in (HERE.parents[1] / "labs").glob("*/exercise.yaml"))

MISTAKES = {
    (file.stem, title): mistake
    for file in sorted((HERE / "mistakes").glob("*.py"))
    for title, mistake in runpy.run_path(str(file))["MISTAKES"].items()
}
"""Lab and mistake -> title of the check that fails, file, and a text of the solution and what stands there instead.

A file `mistakes/LAB.py` has them as `MISTAKES`: title of the mistake -> (check, file of the lab, text, other text).
"""


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


@pytest.mark.labs
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


@pytest.mark.labs
@pytest.mark.parametrize("mistake", MISTAKES, ids=" ".join)
def test_a_typical_mistake_fails_the_check_that_names_it(mistake: tuple[str, str], tmp_path: Path) -> None:
    check, name, text, other = MISTAKES[mistake]
    assert lab("start", mistake[0], tmp_path / "lab", "--solution").exit_code == 0
    file = tmp_path / "lab" / name
    solution = file.read_text("utf-8")
    assert solution.count(text) == 1
    file.write_text(solution.replace(text, other), "utf-8")
    exercises = sorted((tmp_path / "lab").glob("exercise*.yaml"))
    first = next(file for file in exercises if check in file.read_text("utf-8"))  # one of them is enough
    document = yaml.safe_load(first.read_text("utf-8"))
    if "runs" in document["exercise"]:  # one run is enough; the last one differs most from the world file
        document["exercise"]["runs"] = document["exercise"]["runs"][-1:]
        first.write_text(yaml.safe_dump(document), "utf-8")
    found = CliRunner().invoke(app, ["grade", str(first), "--json", "--plugin-path", str(first.parent)])
    assert found.exit_code == 5
    assert check in failed_checks(found.stdout)


def test_each_lab_has_at_least_three_mistakes() -> None:
    counts = {name: sum(key[0] == name for key in MISTAKES) for name in LABS}
    assert {name: count for name, count in counts.items() if count < 3} == {}


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


def test_a_lab_names_the_packages_that_are_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("simkit_verification.cli.lab._is_installed", lambda package: package != "pin")
    started = lab("start", "08", tmp_path / "lab")
    assert started.exit_code == 0
    assert 'this lab needs pin: pip install "simkit-robotics[labs] @ git+https://' in started.output
    graded = lab("grade", tmp_path / "lab")
    assert graded.exit_code == 2 and "SK-CLI-056" in graded.stderr
    monkeypatch.setattr("sys.platform", "win32")
    assert "no such packages for Windows" in lab("start", "10", tmp_path / "other").output
