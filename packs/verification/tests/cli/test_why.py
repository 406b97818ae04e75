"""`simkit why`: a moment of a world, a scenario, a golden run and a bundle."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import simkit as simkit_module
from simkit.cli import app
from simkit.recording import Recorder

REPOSITORY = Path(__file__).resolve().parents[4]
HILL = """<sdf version="1.9"><world name="hill"><gravity>0 0 -10</gravity>
<model name="ground"><static>true</static><link name="l"><collision name="plane">
<geometry><plane><normal>0 0 1</normal></plane></geometry></collision></link></model>
<model name="box"><pose>0 0 0.05 0 0 0</pose><link name="l"><inertial><mass>2</mass>
<inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial>
<collision name="hull"><geometry><box><size>0.4 0.4 0.1</size></box></geometry></collision></link></model>
<plugin filename="gz-sim-apply-link-wrench-system" name="gz::sim::systems::ApplyLinkWrench"/></world></sdf>"""
# the friction is at most 20 N
SCENARIO = """world: hill.sdf
duration: 0.5
commands:
- {at: 0.1, topic: /world/hill/wrench/persistent, message: {entity: {name: box, type: 2}, wrench: {force: {x: 30}}}}
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "hill.sdf").write_text(HILL)
    (tmp_path / "push.yaml").write_text(SCENARIO)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def simkit(*words: str) -> Any:
    return CliRunner().invoke(app, list(words))


def why(*words: str) -> dict[str, Any]:
    """Return the JSON object of `simkit why`."""
    found = simkit("why", *words, "--json")
    assert found.exit_code == 0, found.output
    read: dict[str, Any] = json.loads(found.stdout)
    return read


def test_the_text_says_what_a_box_at_rest_touches(folder: Path) -> None:
    found = simkit("why", "hill.sdf", "-t", "0.5")
    assert found.exit_code == 0, found.output
    assert found.stdout.splitlines()[:3] == [
        "hill at t = 0.5 s (step 500)",
        "  Nothing slides or slips, and no joint has reached a limit.",
        "contacts",
    ]
    assert "box::l::hull on ground::l::plane, 4 points: normal force 20 N" in found.stdout


def test_quiet_prints_only_the_findings(folder: Path) -> None:
    still = simkit("why", "hill.sdf", "-t", "0.1", "-q")
    assert still.stdout == "Nothing slides or slips, and no joint has reached a limit.\n"
    moving = simkit("why", "push.yaml", "-t", "0.3", "-q")
    assert moving.stdout == "box::l::hull slides on ground::l::plane at 1 m/s.\n"


def test_a_scenario_runs_with_its_commands_up_to_the_time(folder: Path) -> None:
    before, after = why("push.yaml", "-t", "0.1"), why("push.yaml", "-t", "0.3")
    assert (before["tick"], after["tick"]) == (100, 300)
    assert (before["contacts"][0]["slides"], after["contacts"][0]["slides"]) == (False, True)
    assert after["contacts"][0]["slip_speed"] == pytest.approx(1.0, rel=0.01)  # 0.2 s at 5 m/s²


def test_without_a_time_the_end_of_the_run_is_explained(folder: Path) -> None:
    assert why("push.yaml")["time"] == 0.5


def test_a_bundle_repeats_its_own_run(folder: Path) -> None:
    assert simkit("bundle", "push.yaml", "-o", "run.zip").exit_code == 0
    for time in ("0.1", "0.3"):
        assert why("run.zip", "-t", time) == why("push.yaml", "-t", time)
    assert why("run.zip")["time"] == 0.5


def test_a_bundle_of_a_failed_run_ends_before_its_failure(folder: Path) -> None:
    words = ("run", "hill.sdf", "--duration", "0.4", "--assert", "pose('box').x > 1", "--bundle-on-failure", "kept")
    assert simkit(*words).exit_code == 5
    (bundle,) = (folder / "kept").iterdir()
    assert why(str(bundle))["time"] == 0.4


def test_a_golden_run_is_repeated(folder: Path) -> None:
    assert simkit("golden", "record", "push.yaml", "-o", "golden").exit_code == 0
    assert why("golden", "-t", "0.3") == why("push.yaml", "-t", "0.3")


def test_a_time_after_the_end_of_the_run_is_an_error(folder: Path) -> None:
    found = simkit("why", "push.yaml", "-t", "2")
    assert found.exit_code == 2
    assert "SK-CLI-064 push.yaml: the run ends at t = 0.5 s, before --time 2" in found.output
    found = simkit("why", "push.yaml", "-t", "inf")
    assert "SK-CLI-064 push.yaml: the run ends at t = 0.5 s, before --time inf" in found.output


def test_a_bundle_takes_no_options_of_a_run(folder: Path) -> None:
    assert simkit("bundle", "push.yaml", "-o", "run.zip").exit_code == 0
    found = simkit("why", "run.zip", "--seed", "3")
    assert found.exit_code == 2
    assert "SK-CLI-064 run.zip is a bundle, which repeats one run; omit --seed" in found.output


def test_an_unknown_model_suggests_the_closest_name(folder: Path) -> None:
    found = simkit("why", "hill.sdf", "-t", "0.1", "--model", "bx")
    assert found.exit_code == 2
    assert "SK-NAME-006 no model 'bx'; did you mean 'box'?" in found.output


@pytest.fixture
def bag(folder: Path) -> str:
    """Return the name of a recording of the scenario, with another seed and pose."""
    (folder / "push_script.yaml").write_text(SCENARIO.partition("commands:\n")[2])
    words = ("--script", "push_script.yaml", "--duration", "0.5", "--seed", "3", "--set", "box.pose=1 0 0.05 0 0 0")
    assert simkit("run", "hill.sdf", *words, "--record", "push.mcap").exit_code == 0
    return "push.mcap"


def test_a_bag_is_played_in_its_world_with_its_options(bag: str) -> None:
    options = ("--seed", "3", "--set", "box.pose=1 0 0.05 0 0 0", "-t", "0.3")
    assert why(bag, "-t", "0.3") == why("push.yaml", *options)
    assert why(bag)["time"] == 0.5
    assert why("hill.sdf", "--play", bag, *options) == why("push.yaml", *options)


def test_a_bag_without_commands_and_a_folder_are_repeated(folder: Path) -> None:
    assert simkit("run", "hill.sdf", "--duration", "0.2", "--record", "still").exit_code == 0
    assert why("still") == why("hill.sdf", "-t", "0.2")


def test_the_world_of_a_bag_may_not_change_or_be_missing(bag: str) -> None:
    world = Path("hill.sdf")
    world.write_text(HILL + "<!-- changed -->")
    found = simkit("why", bag)
    assert found.exit_code == 2
    assert "SK-CLI-064 push.mcap: the files of hill.sdf differ from those of the recording" in found.output
    assert "simkit why WORLD --play push.mcap" in found.output
    world.unlink()
    found = simkit("why", bag)
    assert found.exit_code == 2
    assert "SK-CLI-064 push.mcap was recorded in hill.sdf, which does not exist" in found.output


def test_a_bag_without_its_commands_is_not_repeated(folder: Path) -> None:
    words = ("--duration", "0.1", "--record", "part.mcap", "--skip", "/world/*")
    assert simkit("run", "hill.sdf", *words).exit_code == 0
    found = simkit("why", "part.mcap")
    assert found.exit_code == 2
    assert "SK-CLI-064 part.mcap was recorded without /world/hill/wrench" in found.output


def test_a_bag_that_does_not_describe_its_run_needs_a_world(folder: Path) -> None:
    with simkit_module.load("hill.sdf") as sim:
        sim.run(0.1)
        with Recorder(sim, "late.mcap"):  # the state at the begin of the recording is not in it
            sim.run(0.1)
    found = simkit("why", "late.mcap")
    assert found.exit_code == 2
    assert "SK-CLI-064 late.mcap does not name the world of its recording" in found.output


@pytest.mark.slow
def test_the_bag_of_the_first_run_repeats_its_moments(folder: Path) -> None:
    script = str(REPOSITORY / "worlds" / "turtlebot3_world_drive.yaml")
    words = ("--script", script, "--duration", "13", "--record", "first_run.mcap", "--skip", "/camera/*")
    assert simkit("run", "turtlebot3_world", *words).exit_code == 0
    played = why("first_run.mcap", "-t", "12.5", "--model", "turtlebot3")
    assert played == why("turtlebot3_world", "--script", script, "-t", "12.5", "--model", "turtlebot3")
    assert played["findings"] == []  # the drive touches nothing, and the wheels roll
    left, right = played["wheels"]
    assert (left["rim_speed"], right["rim_speed"]) == (pytest.approx(0.327, abs=1e-3), pytest.approx(0.193, abs=1e-3))
    assert max(abs(left["ratio"]), abs(right["ratio"])) < 1e-4
