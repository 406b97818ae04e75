"""Motion files in the layouts of play_motion2 and play_motion."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from textwrap import dedent

import pytest

from simkit.diagnostics import NOWHERE
from simkit.extend import Diagnostics
from simkit_motion.plugins.play_motion.motion import Motion
from simkit_motion.plugins.play_motion.motion_files import MotionFile, read_motions

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
    """Read a motion file, and return its contents with the reports."""
    file, reports = folder / "motions.yaml", Diagnostics()
    file.write_text(dedent(text))
    return read_motions(file, reports), [f"{d.code} {d.line} {d.message} {d.hint}" for d in reports]


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
    found, reports = read(tmp_path, text)
    assert not reports
    assert replace(found.motions["bow"], where=NOWHERE) == BOW


def test_ros_1_may_give_velocities(tmp_path: Path) -> None:
    text = ROS_1.replace("time_from_start: 0.5", "time_from_start: 0.5\n            velocities: [0.0, 0.0]")
    text = text.replace("time_from_start: 2", "time_from_start: 2\n            velocities: [0.3, 0.0]")
    assert read(tmp_path, text)[0].motions["bow"].velocities == ((0.0, 0.0), (0.3, 0.0))


def test_a_motion_has_the_line_of_its_definition(tmp_path: Path) -> None:
    where = read(tmp_path, ROS_2)[0].motions["bow"].where
    assert where.line == 5 and str(where.file).endswith("motions.yaml")


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        ("joints: [shoulder, elbow]", "joint: [shoulder, elbow]", "it needs 'joints'; did you mean 'joint'?"),
        ("joints: [shoulder, elbow]", "joints: []", "it has no joints"),
        ("joints: [shoulder, elbow]", "joints: [elbow, elbow]", "joint 'elbow' is listed twice"),
        ("joints: [shoulder, elbow]", "joints: shoulder", "'joints' is not a list"),
        ("0.2, 0.3]", "0.2]", "it has 3 positions, but 2 joints at 2 times need 4"),
        ("0.2, 0.3]", "0.2, nan]", "a NaN or infinite number"),
        ("0.2, 0.3]", "0.2, 1e308]", "it has the number 1e+308; the largest is 1e+15"),
        ("[0.5, 2.0]", "[0.5, 1e308]", "it has the number 1e+308; the largest is 1e+15"),
        ("0.2, 0.3]", "0.2, far]", "'positions' holds 'far'; expected numbers"),
        ("[0.5, 2.0]", "[0.5, 0.5]", "its times must increase, but 0.5 s comes after 0.5 s"),
        ("[0.5, 2.0]", "[-1.0, 2.0]", "its first time is -1 s"),
        ("times_from_start: [0.5, 2.0]", "", "it needs 'times_from_start'"),
    ],
)
def test_an_invalid_motion_is_left_out_and_the_others_are_kept(
    tmp_path: Path, before: str, after: str, expected: str
) -> None:
    assert before in ROS_2
    good = "          wait: {joints: [elbow], positions: [0.0], times_from_start: [1.0]}\n"
    found, reports = read(tmp_path, ROS_2.replace(before, after) + good)
    assert list(found.motions) == ["wait"]
    warnings = [text for text in reports if text.startswith("SK-MOTION-002")]
    assert len(warnings) == 1 and expected in warnings[0] and "'bow'" in warnings[0]


def test_an_unknown_key_is_reported_with_the_closest_known_one(tmp_path: Path) -> None:
    found, reports = read(tmp_path, ROS_2.replace("meta:", "metta:"))
    assert "bow" in found.motions
    assert len(reports) == 1 and reports[0].startswith("SK-MOTION-006 10") and "did you mean 'meta'?" in reports[0]


@pytest.mark.parametrize("text", ["", "play_motion2: {ros__parameters: {a: 1}}"])
def test_a_file_without_motions_is_reported(tmp_path: Path, text: str) -> None:
    assert [s.split()[0] for s in read(tmp_path, text)[1]] == ["SK-MOTION-003"]


def test_broken_yaml_is_an_error_with_its_line(tmp_path: Path) -> None:
    found, reports = read(tmp_path, ROS_2.replace("[0.5, 2.0]", "[0.5, 2.0"))
    assert not found.motions and reports[0].startswith("SK-CONTROL-002 1")


def test_the_planner_block_sets_the_approach(tmp_path: Path) -> None:
    settings = """\
        motion_planner:
          approach_velocity: 0.25
          approach_min_duration: 1.5
          exclude_from_planning_joints: [left_finger]
          planning_groups: [arm]
"""
    found, reports = read(tmp_path, ROS_2 + settings)
    assert not reports
    assert (found.approach_velocity, found.approach_min_duration) == (0.25, 1.5)
    assert found.excluded_joints == ("left_finger",)
    ros_1 = "    approach_planner: {skip_planning_approach_vel: 0.75, joint_tolerance: 0.01}\n"
    assert read(tmp_path, ROS_1 + "  " + ros_1)[0].approach_velocity == 0.75


def test_an_approach_speed_of_zero_is_ignored(tmp_path: Path) -> None:
    found, reports = read(tmp_path, ROS_2 + "        motion_planner: {approach_velocity: 0}\n")
    assert found.approach_velocity is None and "expected a number above 0" in reports[0]


def test_a_motion_with_infinite_velocities_is_left_out(tmp_path: Path) -> None:
    text = ROS_1.replace("time_from_start: 0.5", "time_from_start: 0.5\n            velocities: [.nan, 0.0]")
    found, reports = read(tmp_path, text.replace("_start: 2\n", "_start: 2\n            velocities: [0.0, .inf]\n"))
    assert not found.motions and "a NaN or infinite number (nan)" in reports[0]


@pytest.mark.parametrize("key", ["' '", '"a\\nb"', '"a\\e[31mb"'])
def test_a_motion_without_a_printable_key_is_left_out(tmp_path: Path, key: str) -> None:
    found, reports = read(tmp_path, ROS_2.replace("bow:", f"{key}:"))
    assert not found.motions and "its key is empty or not printable" in reports[0]


@pytest.mark.parametrize("value", [".nan", ".inf", "-.inf", "-1", "fast", "[1]", "1e300"])
def test_an_invalid_approach_speed_is_ignored(tmp_path: Path, value: str) -> None:
    settings = f"        approach_velocity: {value}\n        approach_min_duration: {value}\n"
    found, reports = read(tmp_path, ROS_2 + settings)
    assert found.approach_velocity is None and found.approach_min_duration is None
    assert [text.split()[0] for text in reports] == ["SK-MOTION-002"] * 2


@pytest.mark.parametrize("value", ["wrist", "{wrist: 1}", "-1"])
def test_excluded_joints_must_be_a_list(tmp_path: Path, value: str) -> None:
    found, reports = read(tmp_path, ROS_2 + f"        exclude_from_planning_joints: {value}\n")
    assert found.excluded_joints is None and "expected a list of joints" in reports[0]


def test_entries_without_effect_are_reported(tmp_path: Path) -> None:
    found, reports = read(tmp_path, ROS_2 + "        aproach_velocity: 0.2\n")
    assert found.approach_velocity is None and "did you mean 'approach_velocity'?" in reports[0]
    found, reports = read(tmp_path, ROS_2.replace("{name: Bow, usage: demo, description: 'Bends down.'}", "Bow"))
    assert "bow" in found.motions and "'meta' is not used" in reports[0]
    found, reports = read(tmp_path, ROS_1 + "          times_from_start: [1.0]\n")
    assert found.motions["bow"].times == (0.5, 2.0) and "not used together with 'points'" in reports[0]
