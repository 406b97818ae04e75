"""Files of motions in the layouts of play_motion2 and play_motion."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from textwrap import dedent

import pytest

from simkit.diagnostics import NOWHERE, Diagnostics
from simkit.plugins.play_motion.motion import Motion
from simkit.plugins.play_motion.motion_files import MotionFile, read_motions

BOW = Motion("bow", ("shoulder", "elbow"), (0.5, 2.0), ((0.0, 0.1), (0.2, 0.3)), (), "Bow", "demo", "Bends down.")
ROS_2 = """
    play_motion2:
      ros__parameters:
        motions:
          bow:
            joints: [shoulder, elbow]
            positions: [0.0, 0.1,
                        0.2, 0.3]
            times_from_start: [0.5, 2.0]
            meta: {name: Bow, usage: demo, description: 'Bends down.'}
"""
ROS_1 = """
    play_motion:
      motions:
        bow:
          joints: [shoulder, elbow]
          points:
          - positions: [0.0, 0.1]
            time_from_start: 0.5
          - positions: [0.2, 0.3]
            time_from_start: 2
          meta: {name: Bow, usage: demo, description: 'Bends down.'}
"""


def read(folder: Path, text: str) -> tuple[MotionFile, list[str]]:
    """What a text holds, and what is said about it."""
    file, said = folder / "motions.yaml", Diagnostics()
    file.write_text(dedent(text))
    return read_motions(file, said), [f"{d.code} {d.line} {d.message} {d.hint}" for d in said]


@pytest.mark.parametrize(
    "text",
    [
        ROS_2,
        ROS_1,
        ROS_2.replace("play_motion2:", "/play_motion2:"),
        ROS_2.replace("play_motion2:", "/**:"),
        ROS_2.replace("play_motion2:", "play_motion2_mgr:"),
        ROS_1.replace("    play_motion:\n", ""),
        ROS_1.replace("play_motion:", "robot: {ns: {a: 1}}\n    play_motion:"),
        """
        robot:
          play_motion2:
            ros__parameters:
              motions.bow.joints: [shoulder, elbow]
              motions.bow.positions: [0, 0.1, 0.2, 0.3]
              motions.bow.times_from_start: [0.5, 2]
              motions.bow.meta.name: Bow
              motions.bow.meta.usage: demo
              motions.bow.meta.description: Bends down.
        """,
    ],
)
def test_a_motion_is_the_same_in_every_layout(tmp_path: Path, text: str) -> None:
    found, said = read(tmp_path, text)
    assert not said
    assert replace(found.motions["bow"], where=NOWHERE) == BOW


def test_ros_1_may_give_velocities(tmp_path: Path) -> None:
    text = ROS_1.replace("time_from_start: 0.5", "time_from_start: 0.5\n            velocities: [0.0, 0.0]")
    text = text.replace("time_from_start: 2", "time_from_start: 2\n            velocities: [0.3, 0.0]")
    assert read(tmp_path, text)[0].motions["bow"].velocities == ((0.0, 0.0), (0.3, 0.0))


def test_a_motion_knows_its_line(tmp_path: Path) -> None:
    where = read(tmp_path, ROS_2)[0].motions["bow"].where
    assert where.line == 5 and str(where.file).endswith("motions.yaml")


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ("joints: [shoulder, elbow]", "joint: [shoulder, elbow]", "it needs 'joints'; did you mean 'joint'?"),
        ("joints: [shoulder, elbow]", "joints: []", "it names no joint"),
        ("joints: [shoulder, elbow]", "joints: [elbow, elbow]", "it names joint 'elbow' twice"),
        ("joints: [shoulder, elbow]", "joints: shoulder", "'joints' is no list"),
        ("0.2, 0.3]", "0.2]", "it has 3 positions, 2 joints at 2 times need 4"),
        ("0.2, 0.3]", "0.2, nan]", "a number that is not finite"),
        ("0.2, 0.3]", "0.2, far]", "'positions' holds 'far', allowed are numbers"),
        ("[0.5, 2.0]", "[0.5, 0.5]", "its times do not rise: 0.5 s comes after 0.5 s"),
        ("[0.5, 2.0]", "[-1.0, 2.0]", "its first time is -1 s"),
        ("times_from_start: [0.5, 2.0]", "", "it needs 'times_from_start'"),
    ],
)
def test_a_motion_that_is_none_is_left_out_and_the_others_stay(
    tmp_path: Path, before: str, after: str, words: str
) -> None:
    assert before in ROS_2
    good = "          wait: {joints: [elbow], positions: [0.0], times_from_start: [1.0]}\n"
    found, said = read(tmp_path, ROS_2.replace(before, after) + good)
    assert list(found.motions) == ["wait"]
    left_out = [text for text in said if text.startswith("SK-MOTION-002")]
    assert len(left_out) == 1 and words in left_out[0] and "'bow'" in left_out[0]


def test_a_key_that_is_not_used_is_told_with_the_closest(tmp_path: Path) -> None:
    found, said = read(tmp_path, ROS_2.replace("meta:", "metta:"))
    assert "bow" in found.motions
    assert len(said) == 1 and said[0].startswith("SK-MOTION-006 10") and "did you mean 'meta'?" in said[0]


@pytest.mark.parametrize("text", ["", "play_motion2: {ros__parameters: {a: 1}}"])
def test_a_file_without_motions_says_so(tmp_path: Path, text: str) -> None:
    assert [s.split()[0] for s in read(tmp_path, text)[1]] == ["SK-MOTION-003"]


def test_broken_yaml_is_an_error_with_its_line(tmp_path: Path) -> None:
    found, said = read(tmp_path, ROS_2.replace("[0.5, 2.0]", "[0.5, 2.0"))
    assert not found.motions and said[0].startswith("SK-CONTROL-002 1")


def test_the_planner_says_how_fast_the_first_point_is_approached(tmp_path: Path) -> None:
    settings = """\
        motion_planner:
          approach_velocity: 0.25
          approach_min_duration: 1.5
          exclude_from_planning_joints: [left_finger]
          planning_groups: [arm]
"""
    found, said = read(tmp_path, ROS_2 + settings)
    assert not said
    assert (found.approach_velocity, found.approach_min_duration) == (0.25, 1.5)
    assert found.excluded_joints == ("left_finger",)
    ros_1 = "    approach_planner: {skip_planning_approach_vel: 0.75, joint_tolerance: 0.01}\n"
    assert read(tmp_path, ROS_1 + "  " + ros_1)[0].approach_velocity == 0.75


def test_a_speed_of_nothing_is_left_out(tmp_path: Path) -> None:
    found, said = read(tmp_path, ROS_2 + "        motion_planner: {approach_velocity: 0}\n")
    assert found.approach_velocity is None and "allowed is a number above 0" in said[0]


def test_velocities_that_are_not_finite_leave_a_motion_out(tmp_path: Path) -> None:
    text = ROS_1.replace("time_from_start: 0.5", "time_from_start: 0.5\n            velocities: [.nan, 0.0]")
    found, said = read(tmp_path, text.replace("_start: 2\n", "_start: 2\n            velocities: [0.0, .inf]\n"))
    assert not found.motions and "a number that is not finite (nan)" in said[0]


@pytest.mark.parametrize("key", ["' '", '"a\\nb"', '"a\\e[31mb"'])
def test_a_motion_has_a_name_that_can_be_called(tmp_path: Path, key: str) -> None:
    found, said = read(tmp_path, ROS_2.replace("bow:", f"{key}:"))
    assert not found.motions and "no name that can be called" in said[0]


@pytest.mark.parametrize("value", [".nan", ".inf", "-.inf", "-1", "fast", "[1]"])
def test_a_speed_that_is_none_is_left_out(tmp_path: Path, value: str) -> None:
    settings = f"        approach_velocity: {value}\n        approach_min_duration: {value}\n"
    found, said = read(tmp_path, ROS_2 + settings)
    assert found.approach_velocity is None and found.approach_min_duration is None
    assert [text.split()[0] for text in said] == ["SK-MOTION-002"] * 2


@pytest.mark.parametrize("value", ["wrist", "{wrist: 1}", "-1"])
def test_joints_that_are_free_to_touch_are_a_list(tmp_path: Path, value: str) -> None:
    found, said = read(tmp_path, ROS_2 + f"        exclude_from_planning_joints: {value}\n")
    assert found.excluded_joints is None and "allowed is a list of joints" in said[0]


def test_what_has_no_effect_is_told(tmp_path: Path) -> None:
    found, said = read(tmp_path, ROS_2 + "        aproach_velocity: 0.2\n")
    assert found.approach_velocity is None and "did you mean 'approach_velocity'?" in said[0]
    found, said = read(tmp_path, ROS_2.replace("{name: Bow, usage: demo, description: 'Bends down.'}", "Bow"))
    assert "bow" in found.motions and "'meta' is not used" in said[0]
    found, said = read(tmp_path, ROS_1 + "          times_from_start: [1.0]\n")
    assert found.motions["bow"].times == (0.5, 2.0) and "not used beside 'points'" in said[0]
