"""TIAGo's own motions: what PAL publishes, within its limits, and free of collisions from its home."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.diagnostics import Diagnostics
from simkit_motion.plugins.play_motion.motion import Motion
from simkit_motion.plugins.play_motion.motion_files import read_motions
from simkit_motion.plugins.play_motion.motion_planning import Approach, active_controllers, course_from, plan_motion
from simkit_motion.plugins.play_motion.motion_session import empty_world_with, motion_players, play_motions
from simkit_motion.plugins.play_motion.play_motion_plugin import PlayMotion

FILES = Path(__file__).resolve().parents[2] / "assets" / "tiago" / "motions"
# points, time of the last one [s], and the last one, as tiago_bringup (humble) has them
PUBLISHED = {
    "home": (3, 7.0, (0.15, 0.2, -1.34, -0.2, 1.94, -1.57, 1.37, 0.0)),
    "unfold_arm": (2, 6.0, (0.3, 0.21, -0.2, -2.2, 1.15, -1.57, 0.2, 0.0)),
    "reach_floor": (3, 7.0, (0.16, 1.6, -0.55, 0.0, 1.03, -1.57, -0.07, 0.0)),
    "reach_max": (3, 7.0, (0.35, 0.9, 1.0, -3.45, 0.45, 2.05, 1.0, 0.0)),
    "prepare_grasp": (3, 10.5, (0.34, 0.1, 0.47, -0.2, 1.56, 1.6, 0.25, 1.19)),
    "inspect_surroundings": (5, 7.0, (0.0, -0.85)),
    "open": (1, 0.5, (0.044, 0.044)),
    "close": (1, 0.5, (0.0, 0.0)),
    "close_half": (1, 0.5, (0.024, 0.024)),
    "wave": (4, 3.0, (0.09, -0.7354, -2.9396, 1.8341, -1.1201, -0.031, -2.0)),
    "do_weights": (7, 12.0, (1.6, -1.18, -3.16, 2.0, -1.57, -0.07, 0.0)),
    "offer": (1, 0.0, (0.296, 1.61, -0.93, -3.14, 1.83, -1.577, -0.62, -1.577, 0.044, 0.044)),
    "shake_hands": (7, 11.0, (0.044, 0.044, 0.296, 1.61, -0.93, -3.14, 1.83, -1.577, -0.53, -1.577)),
    "pick_from_floor": (4, 9.0, (0.27, 0.21, -1.153, -1.538, 2.26, 1.965, 0.394, -0.082, 0.0, 0.0)),
    "head_tour": (8, 21.0, (0.0, 0.0)),
    "pick_demo": (3, 7.0, (0.34, 0.21, -0.2, -2.2, 1.15, -1.57, 0.2, 0.0)),
}


@pytest.fixture(scope="module")
def motions() -> dict[str, Motion]:
    said = Diagnostics()
    found = read_motions(FILES / "motions.yaml", said).motions
    assert not list(said)
    return found


@pytest.fixture
def sim() -> Any:
    text, folders = empty_world_with("tiago")
    with simkit.load(text, resource_paths=folders) as sim:
        yield sim


def test_the_file_has_the_published_numbers(motions: dict[str, Motion]) -> None:
    for key, (points, end, last) in PUBLISHED.items():
        motion = motions[key]
        assert (len(motion.times), motion.duration, motion.positions[-1]) == (points, end, last), key
    assert motions["home"].joints == ("torso_lift_joint", *(f"arm_{k}_joint" for k in range(1, 8)))
    assert motions["wave"].times == (0.0, 1.0, 2.0, 3.0)


def test_every_motion_is_one_of_the_robots_and_says_what_it_is_for(sim: Any, motions: dict[str, Motion]) -> None:
    assert not [str(d) for d in sim.diagnostics if "MOTION" in d.code and d.severity != "note"]
    assert motion_players(sim)["tiago"].motions.keys() == motions.keys()
    assert all(m.name and m.usage and m.description for m in motions.values())
    stretched = [d.message.split("'")[1] for d in sim.diagnostics if d.code == "SK-MOTION-005"]
    assert stretched == ["reach_max", "prepare_grasp", "pick_from_floor", "pregrasp_demo", "grasp_demo"]


def test_from_home_every_motion_can_be_played(sim: Any, motions: dict[str, Motion]) -> None:
    robot = sim.model("tiago")
    robot.set_joint_positions(dict(zip(motions["home"].joints, motions["home"].positions[-1], strict=True)))
    for motion in motions.values():
        course = plan_motion(sim, robot, motion, active_controllers(sim, robot), Approach())
        limits = np.array([robot.joints[name].scene.axes[0].velocity for name in motion.joints])
        assert course.duration >= motion.duration
        assert np.all(np.abs(course.velocities) <= limits * (1 + 1e-6))


def test_the_torso_takes_its_time() -> None:
    lift = Motion("up", ("torso_lift_joint",), (0.5,), ((0.35,),))
    assert course_from(np.zeros(1), lift, np.array([0.07]), Approach()).duration == pytest.approx(7.5)


def test_home_is_reached_and_the_base_stays(sim: Any) -> None:
    for played in play_motions(sim, motion_players(sim)["tiago"], ["home", "open"]):
        joint, off = played.furthest
        assert abs(off) < 0.01, f"{played.motion.key}: {joint}"
    assert np.linalg.norm(sim.model("tiago").pose.position[:2]) < 1e-3


def test_a_wall_before_the_robot_is_named(motions: dict[str, Motion]) -> None:
    wall = """<model name="wall"><static>true</static><pose>0.6 0 0.6 0 0 0</pose><link name="body"><collision name="c">
      <geometry><box><size>0.05 3 1.2</size></box></geometry></collision></link></model>"""
    text, folders = empty_world_with("tiago")
    with simkit.load(text.replace("</world>", f"{wall}</world>"), resource_paths=folders) as sim:
        robot = sim.model("tiago")
        robot.set_joint_positions(dict(zip(motions["home"].joints, motions["home"].positions[-1], strict=True)))
        player = motion_players(sim)["tiago"]
        assert isinstance(player, PlayMotion)
        goal = sim.send_goal("/play_motion2", {"motion_name": "reach_max"})
        sim.run(0.1)
        assert goal.status.name == "ABORTED"
        assert "wall::body overlap" in goal.result.error and "_link and wall::body" in goal.result.error


def test_without_an_arm_the_head_has_its_motions() -> None:
    text, folders = empty_world_with("tiago_no_arm")
    with simkit.load(text, resource_paths=folders) as sim:
        assert not [str(d) for d in sim.diagnostics if "MOTION" in d.code and d.severity != "note"]
        assert list(motion_players(sim)["tiago_no_arm"].motions) == ["inspect_surroundings", "head_tour"]
        goal = sim.send_goal("/play_motion2", {"motion_name": "inspect_surroundings"})
        assert sim.run_until(lambda _: goal.is_done, timeout=15.0)
        assert goal.status.name == "SUCCEEDED", goal.result.error
        assert float(sim.joint("tiago_no_arm::head_2_joint").position) == pytest.approx(-0.85, abs=5e-3)


def test_a_head_that_would_turn_into_the_arm_is_refused(sim: Any, motions: dict[str, Motion]) -> None:
    robot = sim.model("tiago")
    robot.set_joint_positions(dict(zip(motions["reach_max"].joints, motions["reach_max"].positions[-1], strict=True)))
    goal = sim.send_goal("/play_motion2", {"motion_name": "inspect_surroundings"})
    sim.run(0.1)
    assert goal.status.name == "ABORTED" and "head_2_link and arm_4_link overlap" in goal.result.error
