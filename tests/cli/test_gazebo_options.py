"""Options of Gazebo and arguments of ROS launch files on the command line of `simkit run`."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from simkit.cli import app, gazebo_options
from simkit.cli.gazebo_options import remove_gazebo_options
from simkit.errors import LoadError

OPTIONS = {"--name", "--record", "--play-topic", "--cmd-vel", "--duration"}


@pytest.fixture
def world(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "w.sdf").write_text('<sdf version="1.9"><world name="w"/></sdf>')
    return "w.sdf"


def run(*words: str) -> Result:
    return CliRunner().invoke(app, ["run", *words])


def answers(*words: str) -> list[str]:
    with pytest.raises(LoadError) as refused:
        remove_gazebo_options(words, OPTIONS)
    return [d.message for d in refused.value.diagnostics]


@pytest.mark.parametrize("words", [["-r"], ["-s"], ["-r", "-s"], ["-rs"], ["-sr"], ["--headless-rendering"]])
def test_options_that_change_nothing_are_accepted_with_one_note_each(words: list[str], world: str) -> None:
    result = run(*words, world, "--duration", "0.01")
    assert result.exit_code == 0
    assert "simulated 0.010 s" in result.stdout
    notes = [line for line in result.stderr.splitlines() if line.startswith("note: gz sim -")]
    assert len(notes) == len(words)


@pytest.mark.parametrize(
    ("words", "option", "instead"),
    [
        ("-v 4", "gz sim -v 4", "`simkit run w.sdf -v`"),
        ("-v4", "gz sim -v4", "`simkit run w.sdf -v`"),
        ("--verbose=3", "gz sim --verbose=3", "`simkit run w.sdf -v`"),
        ("--iterations 100", "gz sim --iterations 100", "`simkit run w.sdf --duration S`"),
        ("-z 500", "gz sim -z 500", "`simkit run w.sdf --rtf X`"),
        ("--render-engine ogre2", "gz sim --render-engine ogre2", "`simkit run w.sdf`"),
        ("--gui-config my.config", "gz sim --gui-config my.config", "`simkit run w.sdf`"),
        ("--network-role primary", "gz sim --network-role primary", "`simkit run w.sdf`"),
        ("--record", "gz sim --record", "`simkit run w.sdf --record OUT.mcap`"),
        ("--record-topic /scan", "gz sim --record-topic /scan", "--topic '/scan'`"),
        ("--levels", "gz sim --levels", "`simkit run w.sdf`"),
        ("--playback log", "gz sim --playback log", "`simkit run WORLD --play BAG`"),
        ("-g", "gz sim -g", "`simkit run w.sdf --view`"),
        ("-u", "gazebo -u", "`simkit run w.sdf --paused`"),
        ("-s libgazebo_ros_factory.so", "gazebo -s libgazebo_ros_factory.so", "`simkit run w.sdf`"),
        ("gui:=false", "ros2 launch gui:=false", "`simkit run w.sdf`"),
        ("use_sim_time:=true", "ros2 launch use_sim_time:=true", "/clock"),
        ("model:=burger", "ros2 launch model:=burger", "`TURTLEBOT3_MODEL=burger simkit run w.sdf`"),
        ("anything:=7", "ros2 launch anything:=7", "`simkit run --help`"),
    ],
)
def test_other_options_are_answered_with_what_to_write(words: str, option: str, instead: str) -> None:
    for line in (["w.sdf", *words.split()], *([[*words.split(), "w.sdf"]] if words != "--record" else [])):
        (answer,) = answers(*line)
        assert answer.startswith(f"{option}: ")
        assert instead in answer


def test_all_options_are_answered_in_one_pass_with_exit_code_2(world: str) -> None:
    result = run("-s", world, "--levels", "gui:=false", "--record", "--iterations", "5")
    assert result.exit_code == 2
    found = re.findall(r"error SK-CLI-052: (?:gz sim|ros2 launch) (\S+)", result.stderr)
    assert found == ["--levels:", "gui:=false:", "--record:", "--iterations"]


def test_values_of_the_options_of_simkit_are_not_answered() -> None:
    words = ["w.sdf", "--play-topic", "/a:=/b", "--name", "-r", "--record", "-.mcap"[1:], "--cmd-vel", "-1,0", "-v"]
    assert remove_gazebo_options(words, OPTIONS) == (words, [])
    assert remove_gazebo_options(["--", "-r"], OPTIONS) == (["--", "-r"], [])


def test_the_patterns_of_the_table_are_valid_and_have_the_value_that_their_answer_names() -> None:
    table = tomllib.loads(gazebo_options._TABLE.read_text(encoding="utf-8"))["option"]
    assert len({entry["pattern"] for entry in table}) == len(table)
    for entry in table:
        assert re.compile(entry["pattern"])
        assert ("{value}" not in entry["answer"]) or "(?P<value>" in entry["pattern"]
