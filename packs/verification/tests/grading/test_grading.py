"""Grades of submitted plugins, including plugins that fail in any way."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from simkit.cli import app
from simkit.errors import InputError, LoadError
from simkit_verification.testing.grading.exercise import read_exercise
from simkit_verification.testing.grading.exercise_grading import (
    grade,
    grade_all,
    grade_json,
    grade_text,
    junit_cases,
    short_labels,
)
from simkit_verification.testing.grading.report_words import read_words

CART = """<sdf version="1.9"><world name="track"><model name="cart"><pose>0 0 0.05 0 0 0</pose><link name="body">
<gravity>false</gravity><inertial><mass>1</mass></inertial></link></model></world></sdf>"""

EXERCISE = """
world: cart.sdf
duration: 1
goals:
  - {name: goes half a metre, that: "pose('cart').x > 0.5", points: 2, hint: push it}
limits:
  - {name: stays on its line, that: "abs(pose('cart').y) < 0.01"}
exercise:
  title: Push the cart
  hand_in: push.py
  robot: cart
  pass: 0.5
  runs:
    - {name: as it stands}
    - {name: slowly, seed: 2, parameters: {speed: 0.1}}
"""

PUSH = """
from simkit import ModelPlugin

class Push(ModelPlugin):
    def load(self, parent, params):
        self.cart, self.speed = parent, params.number("speed", 1.0)
        print("here I am")

    def before_step(self):
        BODY
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "cart.sdf").write_text(CART)
    (tmp_path / "push.yaml").write_text(EXERCISE)
    hand_in(tmp_path, "self.cart.set_velocity((self.speed, 0, 0))")
    return tmp_path


def hand_in(folder: Path, body: str) -> Path:
    file = folder / "push.py"
    file.write_text(PUSH.replace("BODY", body))
    return file


def keep_one_run(folder: Path) -> None:
    """Remove the second run of the exercise: each run starts two processes."""
    (folder / "push.yaml").write_text(EXERCISE.partition("    - {name: slowly")[0])


@pytest.mark.slow
def test_each_run_and_check_gets_its_points_and_the_reason(folder):
    graded = grade(read_exercise(folder / "push.yaml"), folder / "push.py")
    first, second = graded.outcomes
    assert [mark.points for mark in first.marks] == [2.0, 1.0]
    assert [mark.points for mark in second.marks] == [0.0, 1.0]
    assert (graded.points, graded.worth, graded.passed) == (4.0, 6.0, True)
    assert first.marks[0].time == pytest.approx(0.501, abs=0.002)
    assert (second.seed, second.printed) == (2, "here I am")
    text = "\n".join(grade_text(graded))
    assert "hint: push it" in text and "4 of 6 points (67%), 50% needed: passed" in text
    assert [case.failure is None for case in junit_cases(graded)] == [True, True, False, True]
    assert json.loads(json.dumps(grade_json(graded)))["points"] == 4.0


@pytest.mark.slow
def test_a_plugin_that_raises_is_reported_with_its_line(folder):
    keep_one_run(folder)
    file = hand_in(folder, "self.cart.set_velocity((1 / 0, 0, 0))")
    graded = grade(read_exercise(folder / "push.yaml"), file)
    assert not graded.passed and graded.points == 0.0
    sentence, code = graded.outcomes[0].error.splitlines()
    assert sentence == "push.py:10: ZeroDivisionError: division by zero, in before_step at t = 0 s"
    assert code == "self.cart.set_velocity((1 / 0, 0, 0))"
    text = "\n".join(grade_text(graded))
    assert "hint:" not in text and "required:" not in text  # they are not about the exception


@pytest.mark.slow
def test_a_failed_check_tells_the_value_and_the_condition(folder):
    keep_one_run(folder)
    hand_in(folder, "pass")
    graded = grade(read_exercise(folder / "push.yaml"), folder / "push.py")
    text = "\n".join(grade_text(graded))
    assert "was 0" in text and "          required: " in text
    french = "\n".join(grade_text(graded, read_words(folder, "fr")))
    assert "ÉCHEC" in french and "indice : push it" in french
    (folder / "messages.fr.yaml").write_text("push it: poussez-le\n")
    assert "indice : poussez-le" in "\n".join(grade_text(graded, read_words(folder, "fr")))
    (folder / "messages.fr.yaml").write_text("[push it]\n")
    with pytest.raises(InputError, match="not a mapping from texts to texts"):
        read_words(folder, "fr")


@pytest.mark.slow
def test_a_plugin_that_ends_the_process_gets_no_points(folder):
    file = hand_in(folder, "__import__('os')._exit(0)")
    graded = grade(read_exercise(folder / "push.yaml"), file)
    assert graded.points == 0.0 and "the process ended with 0" in graded.outcomes[1].error


@pytest.mark.slow
def test_a_file_without_a_plugin_is_reported(folder):
    file = folder / "push.py"
    file.write_text("x = 1\n")
    graded = grade(read_exercise(folder / "push.yaml"), file)
    assert "SK-PLUGIN-008" in graded.outcomes[0].error and graded.points == 0.0


@pytest.mark.slow
def test_an_error_in_a_plugin_that_the_world_names_is_one_of_the_plugin(folder):
    world = CART.replace("</model>", '<plugin name="Push" filename="push.py"/></model>')
    (folder / "cart.sdf").write_text(world)
    (folder / "push.yaml").write_text(EXERCISE.replace("  robot: cart\n", "").replace("parameters: {speed: 0.1}", ""))
    exercise = read_exercise(folder / "push.yaml")
    hand_in(folder, "this is no Python")
    graded = grade(exercise, folder / "push.py")
    assert graded.points == 0.0 and "SyntaxError" in graded.outcomes[0].error
    (folder / "push.py").write_text("import no_such_module\n")
    graded = grade(exercise, folder / "push.py")
    assert graded.points == 0.0 and "no_such_module" in graded.outcomes[0].error
    (folder / "cart.sdf").write_text(world.replace("<mass>1", "<mass>-1"))
    with pytest.raises(InputError, match="has mass -1 kg"):  # the exercise is wrong too
        grade(exercise, folder / "push.py")


@pytest.mark.slow
def test_the_command_grades_several_and_writes_junit(folder):
    weak = folder / "weak.py"
    weak.write_text(PUSH.replace("BODY", "pass"))
    line = ["grade", str(folder / "push.yaml"), str(folder / "push.py"), str(weak), "--junit", str(folder / "o.xml")]
    done = CliRunner().invoke(app, line)
    assert done.exit_code == 5
    assert "4 of 6 points" in done.stdout and "2 of 6 points" in done.stdout
    assert (folder / "o.xml").read_text().count("<failure") == 3


def test_every_problem_of_an_exercise_is_reported(tmp_path):
    (tmp_path / "e.yaml").write_text(
        "world: cart.sdf\nexercise:\n  titel: x\n  pass: 3\n  runs:\n    - {seed: -1, duration: long}\n"
    )
    with pytest.raises(LoadError) as caught:
        read_exercise(tmp_path / "e.yaml")
    found = sorted((d.line or 0, d.code) for d in caught.value.diagnostics)
    assert [code for _, code in found] == ["SK-SCEN-006", "SK-SCEN-002", "SK-SCEN-003", "SK-SCEN-003", "SK-SCEN-003"]
    assert [line for line, _ in found[1:]] == [3, 4, 6, 6]


@pytest.mark.slow
def test_errors_of_the_exercise_are_not_reported_as_errors_of_the_plugin(folder):
    file = folder / "push.yaml"
    file.write_text(EXERCISE.replace("pose('cart').x", "pose('cat').x"))
    done = CliRunner().invoke(app, ["grade", str(file), str(folder / "push.py")])
    assert done.exit_code == 2
    assert "push.yaml:5" in done.stderr and "'cart'" in done.stderr
    file.write_text(EXERCISE.replace("cart.sdf", "card.sdf"))
    assert CliRunner().invoke(app, ["grade", str(file), str(folder / "push.py")]).exit_code == 2


HOSTILE = {
    # code of the plugin -> text in the grade; empty if the plugin passes
    "import subprocess, sys; subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(9)'])": "",
    "__import__('os').chdir('/')": "",
    "print('x' * 5_000_000)": "",
    "raise KeyboardInterrupt": "KeyboardInterrupt ended the run\npush.py:",
    "raise simkit.InputError('mine', 'SK-X-001')": "push.py:",
    "self.advertise('/out', 'std_msgs/msg/String')": "cannot compare a text with a number",
    "import json; json.dumps = lambda found: '{}'": "",
    "from simkit.testing.conditions import Watch; Watch.results = lambda self, reason: ()": "",
}


@pytest.mark.slow
def test_a_faulty_submission_does_not_affect_other_submissions(folder, monkeypatch):
    """The folder also contains files with the names of libraries."""
    exercise = EXERCISE.partition("  runs:")[0].replace("duration: 1\n", "duration: 0.6\n")
    (folder / "push.yaml").write_text(exercise.replace("limits:", "limits:\n  - \"topic('/out').data > 3\""))
    files = []
    for number, line in enumerate(HOSTILE):
        file = folder / str(number) / "push.py"
        file.parent.mkdir()
        text = PUSH.replace("BODY", "self.cart.set_velocity((self.speed, 0, 0))").replace('print("here I am")', line)
        file.write_text("import simkit\n" + text)
        files.append(file)
    (folder / "numpy.py").write_text((folder / "push.py").read_text())
    monkeypatch.chdir(folder)
    found = list(grade_all(read_exercise("push.yaml"), [*files, Path("numpy.py")], jobs=2))
    for graded, told in zip(found, [*HOSTILE.values(), ""], strict=True):
        (outcome,) = graded.outcomes
        assert told in outcome.error and bool(told) == bool(outcome.error), (graded.hand_in, outcome)
        assert next(mark.passed for mark in outcome.marks) is not bool(told)
    assert [graded.label for graded in found] == [*(f"{number}_push" for number in range(len(HOSTILE))), "numpy"]
    assert len(found[2].outcomes[0].printed) <= 500


def test_files_with_the_same_name_get_different_labels():
    files = [Path("a/x.py"), Path("b/x.py"), Path("c/a/x.py"), Path("y.py"), None]
    assert short_labels(files) == ["a_x_1", "b_x", "a_x_2", "y", ""]
