"""Golden runs are checked, blessed and reported, by functions and by the command line."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from falling import ball
from typer.testing import CliRunner

from simkit.cli import app
from simkit.errors import InputError
from simkit.testing.golden.check import check_golden
from simkit.testing.golden.store import read_golden, read_history
from simkit.version import __version__

HEAVY = ("<radius>0.1</radius>", "<radius>0.101</radius>")


def simkit(*words: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, [str(word) for word in words], catch_exceptions=False)
    return result.exit_code, result.output


@pytest.fixture
def golden(tmp_path: Path) -> Path:
    code, said = simkit("golden", "record", ball(tmp_path), "--out", tmp_path / "golden" / "ball", "--duration", 0.5)
    assert code == 0, said
    assert re.search(r"ball: 4 topics, \d+ messages, \d+\.\d kB", said)
    return tmp_path / "golden" / "ball"


def test_an_unchanged_world_passes(golden: Path) -> None:
    code, said = simkit("golden", "check", golden)
    assert code == 0 and said.startswith("ok"), said
    assert simkit("golden", "check", golden, "--quiet") == (0, "")


def test_the_tests_pass_in_another_working_directory(golden: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir("/")
    assert simkit("golden", "check", golden)[0] == 0
    monkeypatch.chdir(golden)
    assert simkit("golden", "check", ".")[0] == 0


def test_a_difference_exits_with_code_5_and_shows_the_cause(golden: Path, tmp_path: Path) -> None:
    ball(tmp_path, HEAVY)
    code, said = simkit("golden", "check", golden)
    assert code == 5
    assert said.startswith("FAILED") and "radius 0.1 → 0.101" in said


def test_the_page_shows_what_was_compared_and_both_worlds(golden: Path, tmp_path: Path) -> None:
    page = tmp_path / "report.html"
    assert simkit("golden", "check", golden, "--html", page)[0] == 0
    text = page.read_text(encoding="utf-8")
    assert "physics states" in text and "the same bits" in text
    assert len(re.findall(r"<tr><td>/", text)) == 4  # topics
    assert "data:image" not in text
    ball(tmp_path, HEAVY)
    assert simkit("golden", "check", golden, "--html", page, "--no-causes")[0] == 5
    text = page.read_text(encoding="utf-8")
    if "no pictures of the worlds" in text:
        pytest.skip("there is no renderer; apt install libegl1 libopengl0 libgl1-mesa-dri")
    pictures = re.findall(r'alt="world of the (\w+)" src="data:image/jpeg;base64,([^"]+)"', text)
    assert [name for name, _ in pictures] == ["golden", "run"]
    assert pictures[0][1] != pictures[1][1]


def test_a_scenario_file_is_read_again(tmp_path: Path) -> None:
    ball(tmp_path)
    scenario = tmp_path / "fall.yaml"
    scenario.write_text("world: ball.sdf\nduration: 0.3\n")
    assert simkit("golden", "record", scenario, "--out", tmp_path / "g")[0] == 0
    assert simkit("golden", "check", tmp_path / "g")[0] == 0
    scenario.write_text("world: ball.sdf\nduration: 0.3\nseed: 3\n")
    code, said = simkit("golden", "check", tmp_path / "g")
    assert code == 5 and "seed" in said
    scenario.unlink()
    code, said = simkit("golden", "check", tmp_path / "g")
    assert code == 2 and "SK-GOLDEN-006" in said


def test_a_scenario_that_no_longer_fits_lists_the_world_changes(tmp_path: Path) -> None:
    plugin = '<plugin filename="gz-sim-apply-link-wrench-system" name="gz::sim::systems::ApplyLinkWrench"/>'
    world = (
        f'<sdf version="1.9"><world name="w">{plugin}<model name="m"><link name="l">'
        "<inertial><mass>2</mass></inertial></link></model></world></sdf>"
    )
    (tmp_path / "w.sdf").write_text(world)
    scenario = tmp_path / "push.yaml"
    scenario.write_text(
        "world: w.sdf\nduration: 0.1\ncommands:\n"
        "  - {at: 0, topic: /world/w/wrench, message: {entity: {name: m, type: 2}, wrench: {force: {z: 1}}}}\n"
    )
    code, said = simkit("golden", "record", scenario, "--out", tmp_path / "g")
    assert code == 0, said
    heavy = world.replace(plugin, "").replace(">2<", ">3<")
    (tmp_path / "w.sdf").write_text(heavy)
    code, said = simkit("golden", "check", tmp_path / "g")
    assert code == 2 and "push.yaml:4: SK-CLI-011 no topic '/world/w/wrench'" in said
    changed = [line.strip() for line in said.splitlines() if "changed since the golden run" in line]
    assert any("ApplyLinkWrench is gone" in line for line in changed), said
    assert any("mass" in line and "2 → 3" in line and "w.sdf:1" in line for line in changed), said
    (tmp_path / "w.sdf").write_text("<sdf")
    code, said = simkit("golden", "check", tmp_path / "g")
    assert code == 2 and "changed since the golden run" not in said


def test_a_blessing_needs_a_reason_and_keeps_it(golden: Path, tmp_path: Path) -> None:
    ball(tmp_path, HEAVY)
    with pytest.raises(InputError, match="SK-GOLDEN-007"):
        check_golden(golden, bless=" ")
    code, said = simkit("golden", "check", golden, "--bless", "the ball was measured")
    assert code == 0 and "ball: updated, with " in said
    history = read_history(golden)
    assert [one["reason"] for one in history] == ["recorded", "the ball was measured"]
    assert history[1]["changed"] and history[1]["mujoco"]
    assert simkit("golden", "check", golden)[0] == 0


def test_a_blessing_without_a_difference_changes_nothing(golden: Path) -> None:
    before = {path.name: path.read_bytes() for path in golden.iterdir()}
    assert simkit("golden", "check", golden, "--bless", "for the sake of it")[0] == 0
    assert {path.name: path.read_bytes() for path in golden.iterdir()} == before


def test_a_blessing_of_the_same_outputs_stores_another_version(golden: Path) -> None:
    file = golden / "golden.json"
    file.write_text(file.read_text().replace(f'"simkit": "{__version__}"', '"simkit": "0.0.1"'))
    assert simkit("golden", "check", golden, "--bless", "a new version")[0] == 0
    assert read_golden(golden).fingerprint["simkit"] == __version__
    assert [one["reason"] for one in read_history(golden)] == ["recorded", "a new version"]


def test_an_existing_golden_run_is_not_overwritten(golden: Path, tmp_path: Path) -> None:
    code, said = simkit("golden", "record", tmp_path / "ball.sdf", "--out", golden)
    assert code == 2 and "SK-GOLDEN-005" in said
    words = ("golden", "record", tmp_path / "ball.sdf", "--out", golden, "--duration", 0.1, "--force")
    assert simkit(*words)[0] == 0
    assert read_golden(golden).scenario.duration == 0.1


def test_the_worst_result_is_the_first_of_several(golden: Path, tmp_path: Path) -> None:
    simkit("golden", "record", ball(tmp_path), "--out", golden.parent / "apples", "--duration", 0.1)
    (golden.parent / "pears").mkdir()
    (golden.parent / "pears" / "golden.json").write_text("{")
    main = golden / "golden.json"
    main.write_text(main.read_text().replace('"seed": 0', '"seed": 1').replace('"duration": 0.5', '"duration": 0.4'))
    done = CliRunner().invoke(app, ["golden", "check", str(golden.parent), "--json"])
    assert done.exit_code == 2
    found = json.loads(done.stdout)["results"]
    assert [Path(one["folder"]).name for one in found] == ["pears", "ball", "apples"]
    assert found[0]["error"]["code"] == "SK-GOLDEN-003"
    assert found[1]["differences"] and found[2]["passed"]


def test_reports_are_written(golden: Path, tmp_path: Path) -> None:
    ball(tmp_path, HEAVY)
    page, cases = tmp_path / "out.html", tmp_path / "out.xml"
    assert simkit("golden", "check", golden, "--html", page, "--junit", cases)[0] == 5
    assert "radius" in page.read_text() and "<failure" in cases.read_text()


def test_a_run_that_fails_is_not_recorded(tmp_path: Path) -> None:
    (tmp_path / "faulty.py").write_text(
        "import simkit\nclass Faulty(simkit.WorldPlugin):\n    def load(self, sim, params):\n        pass\n"
        "    def after_step(self):\n        raise ValueError('the wheel fell off')\n"
    )
    path = ball(tmp_path, ("</world>", '<plugin filename="faulty.py" name="Faulty"/></world>'))
    code, said = simkit("golden", "record", path, "--out", tmp_path / "g", "--plugin-path", tmp_path)
    assert code == 4 and "the wheel fell off" in said
    assert not (tmp_path / "g").exists()


@pytest.mark.slow
def test_parallel_checks_give_the_same_results(golden: Path, tmp_path: Path) -> None:
    simkit("golden", "record", tmp_path / "ball.sdf", "--out", golden.parent / "other", "--duration", 0.1)
    code, said = simkit("golden", "check", golden.parent, "-n", 2)
    assert code == 0 and "2 of 2 golden runs passed" in said


@pytest.mark.parametrize("value", ["a\0b", "\ud800"])
def test_an_environment_variable_that_cannot_be_set_is_damage(golden: Path, value: str) -> None:
    main = golden / "golden.json"
    content = json.loads(main.read_text())
    main.write_text(json.dumps({**content, "environment": {"TURTLEBOT3_MODEL": value}}))
    code, said = simkit("golden", "check", golden)
    assert code == 2 and "SK-GOLDEN-003" in said
