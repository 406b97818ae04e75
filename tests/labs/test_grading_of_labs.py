"""`simkit lab grade` uses the exercise, the world and the checks of the lab, and only the hand-in of the student."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from simkit.cli import app

CART = """<sdf version="1.9"><world name="track"><model name="cart"><pose>0 0 0.05 0 0 0</pose><link name="body">
<gravity>false</gravity><inertial><mass>1</mass></inertial></link></model>
<plugin name="push" filename="push.py"/></world></sdf>"""

EXERCISE = """
world: cart.sdf
plugin_paths: [.]
duration: 0.2
goals:
  - {name: goes far, that: "pose('cart').x > 0.1"}
exercise:
  title: Push the cart
  hand_in: push.py
"""

STUB = """
from simkit import WorldPlugin

class Push(WorldPlugin):
    def load(self, parent, params):
        self.cart = parent.model("cart")

    def before_step(self):
        pass
"""
SOLUTION = STUB.replace("pass", "self.cart.set_velocity((1, 0, 0))")


@pytest.fixture
def teacher(tmp_path: Path) -> Path:
    """A lab of a teacher, which is not installed."""
    folder = tmp_path / "teacher"
    (folder / "solution").mkdir(parents=True)
    (folder / "cart.sdf").write_text(CART)
    (folder / "exercise.yaml").write_text(EXERCISE)
    (folder / "push.py").write_text(STUB)
    (folder / "tools.py").write_text("speed = 0.0\n")
    (folder / "solution" / "push.py").write_text(SOLUTION)
    return folder


@pytest.fixture
def student(teacher: Path, tmp_path: Path) -> Path:
    folder = tmp_path / "student"
    folder.mkdir()
    for name in ("cart.sdf", "exercise.yaml", "push.py", "tools.py"):
        (folder / name).write_text((teacher / name).read_text())
    return folder


def lab(*arguments: object) -> Any:
    return CliRunner().invoke(app, ["lab", *map(str, arguments)])


@pytest.mark.slow
def test_an_edited_exercise_or_world_is_told_and_not_used(teacher: Path, student: Path) -> None:
    (student / "exercise.yaml").write_text(EXERCISE.replace("> 0.1", "> -1"))
    (student / "cart.sdf").write_text(CART.replace("<pose>0 0", "<pose>5 0"))
    (student / "tools.py").write_text("speed = 1.0\n")
    found = lab("grade", student, "--exercise", teacher, "--allow-code")
    assert found.exit_code == 5
    assert f"lab teacher: push.py of {student}" in found.output
    assert "note: not used, because the lab has its own: cart.sdf, exercise.yaml, tools.py" in found.output
    assert "pose('cart').x was 0" in found.output
    report = json.loads(lab("grade", student, "--exercise", teacher / "exercise.yaml", "--allow-code", "--json").stdout)
    assert report[0]["points"] == 0.0


@pytest.mark.slow
def test_the_hand_in_of_the_student_is_used_with_its_further_modules(teacher: Path, student: Path) -> None:
    (student / "push.py").write_text("import helper\n" + SOLUTION.replace("(1, 0, 0)", "helper.velocity"))
    (student / "helper.py").write_text("import tools\nvelocity = (1.0 - tools.speed, 0, 0)\n")
    found = lab("grade", student, "--exercise", teacher, "--allow-code")
    assert (found.exit_code, "note:" in found.output) == (0, False)


@pytest.mark.slow
def test_a_further_module_replaces_none_of_the_lab(teacher: Path, student: Path) -> None:
    (student / "push.py").write_text("import tools\n" + SOLUTION.replace("(1, 0, 0)", "(tools.speed, 0, 0)"))
    (student / "tools").mkdir()
    (student / "tools" / "__init__.py").write_text("speed = 1.0\n")
    assert lab("grade", student, "--exercise", teacher, "--allow-code").exit_code == 5


def test_an_error_names_the_file_of_the_student(teacher: Path, student: Path) -> None:
    (student / "push.py").write_text("this is no Python\n")
    found = lab("grade", student, "--exercise", teacher, "--allow-code")
    assert found.exit_code == 5 and str(student / "push.py") in found.output and "simkit-grade-" not in found.output


def test_a_hand_in_that_links_out_of_its_folder_is_not_read(teacher: Path, student: Path, tmp_path: Path) -> None:
    secret = tmp_path / "secret.py"
    secret.write_text("password = 'seven words'\n")
    (student / "push.py").unlink()
    (student / "push.py").symlink_to(secret)
    found = lab("grade", student, "--exercise", teacher, "--allow-code")
    assert found.exit_code == 5 and "SK-URI-003" in found.output and "seven words" not in found.output


def test_a_folder_tells_its_lab(tmp_path: Path) -> None:
    assert lab("start", "1", tmp_path / "turtle").exit_code == 0
    marker = tmp_path / "turtle" / ".simkit-lab"
    assert marker.read_text() == "01_turtlesim\n"
    marker.write_text("../../etc\n")
    (tmp_path / "turtle" / "square.py").unlink()  # nothing runs: the file to hand in is missing
    found = lab("grade", tmp_path / "turtle")
    assert found.exit_code == 2 and "does not tell its lab" in found.stderr and "--lab NAME" in found.stderr
    marker.unlink()
    for arguments in ((), ("--lab", "1"), ("--lab", "01_turtlesim")):  # without the marker, the title tells it
        found = lab("grade", tmp_path / "turtle", *arguments)
        assert found.exit_code == 2 and "SK-SCEN-007 no file" in found.stderr and "square.py" in found.stderr
    (tmp_path / "turtle" / "exercise.yaml").write_text("title: nothing\n")
    found = lab("grade", tmp_path / "turtle")
    assert found.exit_code == 2 and "does not tell its lab" in found.stderr
    assert "did you mean '01_turtlesim'" in lab("grade", tmp_path / "turtle", "--lab", "01_turtelsim").stderr


@pytest.mark.labs
def test_the_two_known_cheats_get_no_full_points(tmp_path: Path) -> None:
    assert lab("start", "1", tmp_path / "turtle").exit_code == 0
    exercise = tmp_path / "turtle" / "exercise.yaml"
    exercise.write_text(exercise.read_text("utf-8").partition("goals:")[0] + EASY, "utf-8")
    (tmp_path / "turtle" / "square.py").write_text(REPLACES_THE_GRADER)
    found = lab("grade", tmp_path / "turtle", "--json")
    (report,) = json.loads(found.stdout)
    assert (found.exit_code, report["of"]) == (5, 27.0) and report["points"] <= 3.0


EASY = """goals:
  - "true"
exercise:
  title: A square with a turtle
  hand_in: square.py
  robot: turtle1
"""
REPLACES_THE_GRADER = """
import sys
from dataclasses import replace

import simkit_verification.testing.grading.grading_process as grading_process
from simkit import ModelPlugin


class Square(ModelPlugin):
    def load(self, parent, params):
        for module in (sys.modules["__main__"], grading_process):
            run = module.run_scenario

            def fake(*arguments, _run=run, **more):
                ended = _run(*arguments, **more)
                return replace(ended, results=tuple(replace(one, passed=True) for one in ended.results))

            module.run_scenario = fake
"""
