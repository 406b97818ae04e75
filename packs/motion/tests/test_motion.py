"""`simkit motion`: what a robot knows, and how it plays it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import planar_arm as arm
import pytest
from typer.testing import CliRunner, Result

from simkit.cli import app


def motion(*words: object) -> Result:
    return CliRunner().invoke(app, ["motion", *map(str, words)], catch_exceptions=False)


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """A world with an arm that plays motions."""
    arm.load(tmp_path).close()
    return tmp_path / "lab.sdf"


def test_every_motion_is_a_line_with_its_duration_joints_and_description(lab: Path) -> None:
    lines = motion("list", lab.with_name("motions.yaml")).stdout.splitlines()
    assert [line.split()[0] for line in lines] == ["rest", "bow", "nod", "curl", "too_far", "open", "close"]
    assert lines[1].split("  ")[0] == "bow" and "3 s" in lines[1] and "2 points" in lines[1]
    assert "shoulder, elbow, wrist" in lines[1] and lines[1].endswith("There and elsewhere.")


def test_a_robot_lists_its_own_motions_and_those_of_files(lab: Path) -> None:
    more = lab.with_name("more.yaml")
    more.write_text("play_motion:\n  motions:\n    tilt:\n      joints: [wrist]\n      points:\n"
                    "      - {positions: [0.1], time_from_start: 1.0}\n")  # fmt: skip
    found = json.loads(motion("list", lab, "--motions", more, "--json").stdout)
    assert [one["key"] for one in found][-2:] == ["close", "tilt"]
    assert found[-1]["positions"] == [0.1] and found[-1]["duration"] == 1.0


def test_motions_are_played_one_after_another(lab: Path) -> None:
    result = motion("play", "bow", "rest", "--world", lab)
    assert result.exit_code == 0
    first, second = result.stdout.splitlines()
    assert first.startswith("bow: done in 3.0") and second.startswith("rest: done in 2.0")
    found = json.loads(motion("play", "bow", "--world", lab, "--json").stdout)
    assert found[0]["motion"] == "bow" and abs(found[0]["off"]) < 5e-3


def test_a_speed_scale_slows_a_motion_down_also_beyond_twice_its_time(lab: Path) -> None:
    """The motion takes 3 s at full speed, and its time limit follows the scale."""
    for factor, seconds in (("0.5", "6.0"), ("0.25", "12.")):
        result = motion("play", "bow", "--speed", factor, "--world", lab)
        assert result.stdout.startswith(f"bow: done in {seconds}"), result.stdout
    assert motion("play", "bow", "--speed", "0").exit_code == 2


def test_a_robot_without_motions_gets_them_from_a_file(lab: Path) -> None:
    bare = lab.with_name("bare.sdf")
    bare.write_text(arm.world(arm.model()))
    refused = motion("play", "nod", "--world", bare)
    assert refused.exit_code == 2 and "SK-MOTION-010" in refused.stderr
    played = motion("play", "nod", "--world", bare, "--motions", lab.with_name("motions.yaml"))
    assert played.exit_code == 0 and played.stdout.startswith("nod: done in 1.8")  # 0.4 rad at 0.5 rad/s, and a second


def test_an_unknown_motion_is_reported_before_anything_moves(lab: Path) -> None:
    result = motion("play", "rest", "bowl", "--world", lab)
    assert result.exit_code == 2
    assert "SK-MOTION-011 there is no motion 'bowl'; did you mean 'bow'?" in result.stderr and not result.stdout


def test_a_refused_motion_ends_the_run_with_its_reason(lab: Path) -> None:
    result = motion("play", "nod", "curl", "--world", lab)
    assert result.exit_code == 1 and result.stdout.startswith("nod: done")
    assert "motion 'curl' collides on the way to its first point: upper and hand overlap by" in result.stderr
    assert "SK-MOTION-012" in result.stderr
    limits = motion("play", "too_far", "--world", lab)
    assert limits.exit_code == 1 and "elbow would be at 3.5 rad" in limits.stderr


def test_a_motion_of_many_hours_is_refused_before_it_is_played(lab: Path) -> None:
    more = lab.with_name("more.yaml")
    more.write_text("play_motion2:\n  ros__parameters:\n    motions:\n"
                    "      slow: {joints: [wrist], positions: [0.4, 0], times_from_start: [0.5, 1e9]}\n")  # fmt: skip
    result = motion("play", "slow", "--world", lab, "--motions", more)
    assert result.exit_code == 1
    assert "SK-MOTION-012 motion 'slow' would take 1e+09 s; expected up to 10000 s" in result.stderr


def test_a_run_can_be_recorded(lab: Path) -> None:
    bag = lab.with_name("nod.mcap")
    assert motion("play", "nod", "--world", lab, "--record", bag).exit_code == 0
    assert bag.stat().st_size > 1000


def test_of_several_robots_one_is_chosen(lab: Path) -> None:
    # each plays under its own namespace, without a controller manager here
    both = "".join(
        arm.model(name, arm.play_motion().replace("<motions>", f"<ros><namespace>{name}</namespace></ros><motions>"))
        for name in ("left", "right")
    ).replace('<plugin filename="libgazebo_ros2_control.so" name="control">', '<plugin filename="none" name="none">')
    file = lab.with_name("both.sdf")
    file.write_text(arm.world(both))
    result = motion("list", file)
    assert result.exit_code == 2 and "choose one with --model NAME: left, right" in result.stderr
    assert len(motion("list", file, "--model", "left").stdout.splitlines()) == 7
    wrong = motion("list", file, "--model", "lefd")
    assert wrong.exit_code == 2 and "did you mean 'left'?" in wrong.stderr


def test_a_file_of_motions_that_is_not_there(lab: Path) -> None:
    result = motion("play", "nod", "--world", lab, "--motions", "nowhere.yaml")
    assert result.exit_code == 2 and "SK-MOTION-001" in result.stderr


def test_a_broken_file_of_motions_stops_before_anything_is_run(lab: Path) -> None:
    broken = lab.with_name("broken.yaml")
    broken.write_text("play_motion2: {ros__parameters: {motions: [")
    for words in (("play", "bow", "--world", lab), ("list", lab)):
        result = motion(*words, "--motions", broken)
        assert result.exit_code == 2 and not result.stdout and "SK-CONTROL-002" in result.stderr
    gone = motion("list", lab.with_name("gone.yaml"))
    assert gone.exit_code == 2 and "SK-MOTION-001" in gone.stderr


def test_a_robot_that_the_world_already_has_is_not_spawned_again() -> None:
    result = motion("play", "open", "--world", "tiago_table", "--robot", "tiago")
    assert result.exit_code == 2 and "leave out --robot" in result.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device that is always full is Linux's")
def test_a_full_disk_is_reported_in_one_line(lab: Path) -> None:
    words = [sys.executable, "-m", "simkit", "motion", "list", str(lab)]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(words, stdout=full, stderr=subprocess.PIPE, text=True, check=False, timeout=120)
    assert done.returncode == 1 and "error: cannot write the output: " in done.stderr and "Traceback" not in done.stderr
