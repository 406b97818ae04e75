"""Every block of code of `docs/scenarios.md` works as it stands there."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner

from simkit.cli import app
from simkit.testing.scenarios.scenario_file import read_scenario
from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario
from simkit_verification.testing.grading.exercise import read_exercise

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "scenarios.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
(DRIVE, LEAVE), (COMPUTED, PROGRAM) = ([text for kind, text in BLOCKS if kind == one] for one in ("yaml", "python"))


def test_each_block_is_known() -> None:
    assert [kind for kind, _ in BLOCKS] == ["yaml", "python", "python", "yaml", "sh"]


def test_the_scenario_holds_what_it_asks_for(tmp_path):
    (tmp_path / "drive.yaml").write_text(DRIVE)
    scenario = read_scenario(tmp_path / "drive.yaml")
    with open_scenario(scenario) as sim:
        ended = run_scenario(scenario, sim)
    assert [result.message for result in ended.results if not result.passed] == []


def test_the_scenario_in_python_is_one(tmp_path):
    (tmp_path / "drive.py").write_text(COMPUTED)
    scenario = read_scenario(tmp_path / "drive.py")
    with open_scenario(scenario) as sim:
        assert run_scenario(scenario, sim).passed


def test_the_program_prints_what_held(capsys):
    exec(compile(PROGRAM, "scenarios.md", "exec"), {})
    assert capsys.readouterr().out.startswith("time > 0.5 True was reached at t = 0.501 s")


@pytest.mark.slow
def test_the_exercise_is_graded_by_the_commands(tmp_path, monkeypatch):
    """With one short run in place of three of 20 s: what the runs of an exercise are is tested elsewhere."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "leave.yaml").write_text(LEAVE)
    assert len(read_exercise("leave.yaml").runs) == 3
    (tmp_path / "leave.yaml").write_text(re.sub(r"runs:\n.*", "runs: [{duration: 0.5}]\n", LEAVE, flags=re.DOTALL))
    (tmp_path / "hand_ins").mkdir()
    for place in (".", "hand_ins"):
        shutil.copy(ROOT / "examples" / "exercise" / "wander.py", place)
    for line in BLOCKS[-1][1].splitlines():
        words = [word for part in shlex.split(line, comments=True)[1:] for word in map(str, found(part))]
        done = CliRunner().invoke(app, words)
        assert done.exit_code == 5 and "2 of 4 points" in done.stdout, done.output
    assert (tmp_path / "out.xml").is_file()


def found(word: str) -> list[object]:
    """What a shell makes of a word."""
    return sorted(Path().glob(word)) if "*" in word else [word]
