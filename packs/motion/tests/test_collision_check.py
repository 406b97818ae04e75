"""Collisions of a robot's links at other joint positions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import planar_arm as arm
import pytest

import simkit
from simkit_motion.plugins.play_motion.collision_check import CollisionCheck, LinkCollision

JOINTS = ("shoulder", "elbow", "wrist")
FINGERS = ("left_finger", "right_finger")


def collision_check(sim: simkit.Simulation, *names: str, free: tuple[str, ...] = FINGERS) -> CollisionCheck:
    robot = sim.model("arm")
    return CollisionCheck(sim, robot, [robot.joints[name] for name in names or JOINTS], free)


def collision_at(sim: simkit.Simulation, *positions: float) -> LinkCollision | None:
    return collision_check(sim).deepest_collision(np.array(positions))


def test_links_in_free_space_do_not_collide_and_the_state_is_unchanged(tmp_path: Path) -> None:
    with arm.load(tmp_path) as sim:
        before = sim.mj_data.qpos.copy()
        assert collision_at(sim, 0.0, 0.0, 0.0) is None
        assert collision_at(sim, 1.0, -1.0, 0.5) is None
        assert sim.mj_data.qpos == pytest.approx(before, abs=0)


def test_a_hand_at_the_upper_arm_collides_with_it(tmp_path: Path) -> None:
    with arm.load(tmp_path) as sim:
        found = collision_at(sim, 0.0, 2.6, 2.4)
        assert found is not None
        assert {found.first, found.second} == {"upper", "hand"}
        assert str(found).startswith("upper and hand overlap by ") and str(found).endswith(" mm")


def test_neighbours_may_overlap_at_their_joint(tmp_path: Path) -> None:
    """At 2.8 rad the lower arm overlaps the upper arm, its neighbour."""
    with arm.load(tmp_path) as sim:
        assert collision_at(sim, 0.0, 2.8, 0.0) is None


def test_a_collision_with_the_surroundings_has_their_scoped_name_and_the_depth(tmp_path: Path) -> None:
    # the end of the hand is at x = 0.95 and its centre line swings through y
    wall = arm.box("wall", "0.6 0.3 0.5 0 0 0", "2 0.1 1")
    with arm.load(tmp_path, wall) as sim:
        found = collision_at(sim, np.pi / 2, 0.0, 0.0)
        assert found is not None and found.second == "wall::body"
        assert collision_at(sim, 0.1, 0.0, 0.0) is None
    with arm.load(tmp_path, arm.box("wall", "0.5 0.5 0.5 0 0 0", "1 0.1 1")) as sim:
        # y of the hand's far corner at a turn a: (0.95) sin a + 0.02 cos a; the wall begins at 0.45
        turn = 0.47
        reach = 0.95 * np.sin(turn) + 0.02 * np.cos(turn)
        found = collision_check(sim, free=()).deepest_collision(np.array([turn, 0.0, 0.0]))
        fingers = 1.03 * np.sin(turn) + 0.01 * np.cos(turn)
        assert found is not None and reach < fingers
        assert found.depth == pytest.approx(fingers - 0.45, abs=2e-3)


def test_a_shape_without_a_collide_bitmask_does_not_collide(tmp_path: Path) -> None:
    shape = "<geometry><box><size>2 0.1 1</size></box></geometry>"
    ghost = f"""<model name="ghost"><static>true</static><pose>0.6 0.3 0.5 0 0 0</pose><link name="body">
        <collision name="c">{shape}<surface><contact><collide_bitmask>0</collide_bitmask></contact></surface>
        </collision>
        </link></model>"""
    with arm.load(tmp_path, ghost) as sim:
        assert collision_at(sim, np.pi / 2, 0.0, 0.0) is None


def test_links_that_do_not_move_are_not_checked(tmp_path: Path) -> None:
    """The foot is inside a box; the arm can still move."""
    with arm.load(tmp_path, arm.box("socket", "0 0 0.1 0 0 0", "0.3 0.3 0.2")) as sim:
        assert collision_at(sim, 0.5, 0.0, 0.0) is None


def test_an_existing_contact_may_stay_but_not_get_deeper(tmp_path: Path) -> None:
    """The arm is 2 mm deep in a board: motion along the board is allowed, motion into it is not."""
    with arm.load(tmp_path, arm.box("board", "0.5 -0.068 0.5 0 0 0", "2 0.1 1")) as sim:
        assert collision_check(sim, free=()).deepest_collision(np.zeros(3)) is None
        into = collision_check(sim, free=()).deepest_collision(np.array([-0.1, 0.0, 0.0]))
        assert into is not None and into.second == "board::body"


def test_fingers_may_touch_loose_objects_but_not_static_ones(tmp_path: Path) -> None:
    for static in (False, True):
        cube = arm.box("cube", "1.0 0 0.5 0 0 0", "0.04 0.03 0.04", static=static)
        with arm.load(tmp_path, cube) as sim:
            robot: Any = sim.model("arm")
            robot.set_joint_positions(dict.fromkeys(FINGERS, 0.04))
            closing = CollisionCheck(sim, robot, [robot.joints[name] for name in FINGERS], FINGERS)
            found = closing.deepest_collision(np.zeros(2))
            assert (found is not None) == static
            assert found is None or found.second == "cube::body"


def test_a_held_object_moves_with_the_hand_and_is_checked_too(tmp_path: Path) -> None:
    cube = arm.box("cube", "1.1 0 0.5 0 0 0", "0.3 0.03 0.04", static=False)
    post = arm.box("post", "1.0 0.65 0.5 0 0 0", "0.06 0.06 1")
    with arm.load(tmp_path, cube + post) as sim:
        # fingers 0.5 mm into the cube on both sides hold it
        sim.model("arm").set_joint_positions(dict.fromkeys(FINGERS, 0.0145))
        # the arm's own tip goes to 1.03 m, the post's nearest corner is 1.15 m away: only the cube reaches it
        found = collision_check(sim).deepest_collision(np.array([np.arctan2(0.65, 1.0), 0.0, 0.0]))
        assert found is not None
        assert (found.first, found.second) == ("cube::body", "post::body")
        sim.model("cube").set_pose(simkit.Pose((3.0, 0.0, 0.5)))
        assert collision_check(sim).deepest_collision(np.array([np.arctan2(0.65, 1.0), 0.0, 0.0])) is None
