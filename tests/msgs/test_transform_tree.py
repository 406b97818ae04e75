"""Poses between frames: interpolation, histories, chains, and errors that name what is missing."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from simkit import msgs
from simkit.errors import ArgumentTypeError, ArgumentValueError, TransformError
from simkit.msgs.transform_tree import TransformTree
from simkit.pose import IDENTITY, Pose

TYPE = "tf2_msgs/msg/TFMessage"


def put(
    tree: TransformTree, parent: str, child: str, pose: Pose = IDENTITY, at: float = 0.0, static: bool = False
) -> None:
    header = msgs.header(round(at * 1e9), parent)
    stamped = msgs.pose_message(pose, "geometry_msgs/msg/TransformStamped", header, child)
    tree.take(msgs.make(TYPE, transforms=[stamped]), is_static=static)


def filled() -> TransformTree:
    """Return map → odom (fixed) → base (moves from 1 s to 2 s) → lidar (fixed), and map → door (fixed)."""
    tree = TransformTree()
    put(tree, "map", "odom", Pose((5.0, 0.0, 0.0)), static=True)
    put(tree, "odom", "base", Pose.from_rpy(0, 0, 0, 0, 0, 0.2), 1.0)
    put(tree, "odom", "base", Pose.from_rpy(1, 2, 0, 0, 0, 1.2), 2.0)
    put(tree, "base", "lidar", Pose((0.1, 0.0, 0.3)), static=True)
    put(tree, "map", "door", Pose.from_rpy(0, 1, 0, 0, 0, math.pi / 2), static=True)
    return tree


def test_a_pose_is_that_of_the_source_in_the_target() -> None:
    tree = filled()
    assert tree.lookup("odom", "base", 1.0) == Pose.from_rpy(0, 0, 0, 0, 0, 0.2)
    assert tree.lookup("map", "lidar", 1.0).position == pytest.approx(
        [5 + 0.1 * math.cos(0.2), 0.1 * math.sin(0.2), 0.3]
    )
    expected = (
        Pose.from_rpy(0, 1, 0, 0, 0, math.pi / 2).inverse() @ Pose((5.0, 0.0, 0.0)) @ tree.lookup("odom", "lidar")
    )
    found = tree.lookup("door", "lidar")
    assert found.position == pytest.approx(expected.position) and found.quaternion == pytest.approx(expected.quaternion)
    there_and_back = tree.lookup("lidar", "door") @ tree.lookup("door", "lidar")
    assert there_and_back.position == pytest.approx(np.zeros(3), abs=1e-12)
    assert tree.lookup("base", "base") == Pose()


def test_positions_are_interpolated_linearly_and_rotations_on_the_shortest_arc() -> None:
    first, second = Pose.from_rpy(1, 2, 3, 0.3, -0.2, 3.0), Pose.from_rpy(2, 0, 3, -0.5, 0.9, -2.5)
    tree = TransformTree()
    put(tree, "a", "b", first, 1.0)
    put(tree, "a", "b", Pose(second.position, -second.quaternion), 2.0)  # the same rotation with the other sign
    turns = Rotation.from_quat(np.roll([first.quaternion, second.quaternion], -1, axis=1))
    for time in (1.0, 1.25, 1.9, 2.0):
        found = tree.lookup("a", "b", time)
        assert found.position == pytest.approx([time, 2 - 2 * (time - 1), 3.0])
        difference = Slerp([1.0, 2.0], turns)(time).inv() * Rotation.from_quat(np.roll(found.quaternion, -1))
        assert difference.magnitude() == pytest.approx(0.0, abs=1e-7)


def test_a_time_is_seconds_or_a_stamp_and_none_is_the_latest_common_time() -> None:
    tree = filled()
    put(tree, "base", "arm", Pose((1.0, 0.0, 0.0)), 0.5)
    put(tree, "base", "arm", Pose((2.0, 0.0, 0.0)), 1.5)
    assert tree.lookup("odom", "base", msgs.time(1_500_000_000)) == tree.lookup("odom", "base", 1.5)
    assert tree.lookup("odom", "arm") == tree.lookup("odom", "arm", 1.5)
    assert tree.lookup("odom", "base") == tree.lookup("odom", "base", 2.0)
    put(tree, "base", "new", Pose((7.0, 0.0, 0.0)), 3.0)  # known later than all others
    assert tree.lookup("odom", "new") == Pose.from_rpy(1, 2, 0, 0, 0, 1.2) @ Pose((7.0, 0.0, 0.0))


def test_the_latest_pose_is_computed_once_until_the_transforms_change() -> None:
    tree = filled()
    first = tree.lookup("map", "lidar")
    assert tree.lookup("map", "lidar") is first
    state = tree.copied()
    put(tree, "odom", "base", Pose((4.0, 0.0, 0.0)), 3.0)
    assert tree.lookup("map", "lidar").position == pytest.approx([9.1, 0.0, 0.3])
    tree.replace(state)
    assert tree.lookup("map", "lidar") == first
    tree.advance("tf", 5)
    tree.advance("tf", 1)  # a reset: only fixed frames stay
    with pytest.raises(TransformError):
        tree.lookup("map", "lidar")


def test_late_and_repeated_transforms_are_put_in_order() -> None:
    tree = TransformTree()
    for at, x in ((1.0, 1.0), (3.0, 3.0), (2.0, 5.0), (3.0, 4.0)):
        put(tree, "a", "b", Pose((x, 0.0, 0.0)), at)
    assert [tree.lookup("a", "b", t).position[0] for t in (1.0, 1.5, 2.0, 3.0)] == [1.0, 3.0, 5.0, 4.0]


def test_the_history_has_ten_seconds_and_another_length_if_it_is_set() -> None:
    for length, first in ((None, 10.0), (3.0, 17.0)):
        tree = TransformTree()
        if length is not None:
            tree.length = length
        for second in range(21):
            put(tree, "a", "b", Pose((second, 0.0, 0.0)), second)
        assert tree.lookup("a", "b", first).position[0] == first
        with pytest.raises(TransformError, match=f"is known from t={first:g} s to t=20 s, not at t={first - 0.5:g} s"):
            tree.lookup("a", "b", first - 0.5)
    with pytest.raises(ArgumentValueError, match="length of the history"):
        tree.length = -1.0


def test_nothing_is_extrapolated() -> None:
    tree = filled()
    with pytest.raises(TransformError, match="'odom' → 'base' is known from t=1 s to t=2 s, not at t=2.01 s") as caught:
        tree.lookup("map", "lidar", 2.01)
    assert caught.value.code == "SK-TF-003" and isinstance(caught.value, LookupError)
    assert tree.lookup("map", "door", 99.0) == tree.lookup("map", "door")  # fixed transforms are valid at all times


def test_an_unknown_frame_is_named_with_the_closest_one() -> None:
    with pytest.raises(
        TransformError, match=r"unknown frames 'mop' \(did you mean 'map'\?\) and 'xyz'; the known"
    ) as caught:
        filled().lookup("mop", "xyz")
    assert caught.value.code == "SK-TF-001"
    with pytest.raises(TransformError, match="unknown frame 'a'; no frame is known yet"):
        TransformTree().lookup("a", "a")


def test_separate_trees_are_named_with_the_ends_of_both_chains() -> None:
    tree = filled()
    put(tree, "world", "robot2/odom", static=True)
    put(tree, "robot2/odom", "robot2/base", at=1.0)
    chains = "'robot2/base' → 'robot2/odom' → 'world' ends there and 'lidar' → 'base' → 'odom' → 'map' ends there"
    with pytest.raises(TransformError, match=re.escape(chains)) as caught:
        tree.lookup("lidar", "robot2/base")
    assert "no transform connects 'world' with 'map'" in str(caught.value) and caught.value.code == "SK-TF-002"


def test_a_circle_of_frames_is_an_error_and_no_endless_loop() -> None:
    tree = TransformTree()
    for parent, child in (("a", "b"), ("b", "c"), ("c", "a")):
        put(tree, parent, child, static=True)
    with pytest.raises(TransformError, match="form a circle: 'a' → 'c' → 'b' → 'a'"):
        tree.lookup("a", "c")


def test_a_frame_that_gets_another_parent_has_the_old_one_in_the_past() -> None:
    tree = TransformTree()
    put(tree, "world", "table", Pose((1.0, 0.0, 0.0)), static=True)
    put(tree, "world", "gripper", Pose((9.0, 0.0, 0.0)), static=True)
    put(tree, "table", "cube", Pose((0.0, 0.0, 1.0)), 1.0)
    put(tree, "gripper", "cube", Pose((0.0, 0.0, 2.0)), 2.0)
    assert tree.lookup("world", "cube", 1.5).position.tolist() == [1.0, 0.0, 1.0]
    assert tree.lookup("world", "cube").position.tolist() == [9.0, 0.0, 2.0]
    assert tree.frames() == {"cube": "gripper", "gripper": "world", "table": "world", "world": ""}


@pytest.mark.parametrize(
    "fields",
    [
        {"header": {"frame_id": "a"}, "child_frame_id": "a"},
        {"header": {"frame_id": ""}, "child_frame_id": "b"},
        {"header": {"frame_id": "a"}, "child_frame_id": "/"},
        {"header": {"frame_id": "a"}, "child_frame_id": "b", "transform": {"translation": {"x": math.nan}}},
        {"header": {"frame_id": "a"}, "child_frame_id": "b", "transform": {"rotation": {"w": 0.0}}},
        {"header": {"frame_id": "a"}, "child_frame_id": "b", "transform": {"rotation": {"x": math.inf}}},
    ],
)
def test_invalid_transforms_are_ignored_and_counted(fields: dict[str, Any]) -> None:
    tree = TransformTree()
    tree.take(msgs.make(TYPE, transforms=[fields]), is_static=False)
    tree.take(msgs.make("std_msgs/msg/String"), is_static=False)
    assert (tree.frames(), tree.ignored) == ({}, 1)


def test_arguments_of_a_wrong_kind_are_refused() -> None:
    tree = filled()
    with pytest.raises(ArgumentTypeError, match="the source frame must be a text"):
        tree.lookup("map", 3)  # type: ignore[arg-type]
    with pytest.raises(ArgumentTypeError, match="the time must be"):
        tree.lookup("map", "odom", "now")
    with pytest.raises(ArgumentTypeError, match="the time must be seconds, a stamp of a message, or None"):
        tree.lookup("map", "odom", msgs.header(0, ""))
    with pytest.raises(ArgumentValueError, match="the time must be a finite number"):
        tree.lookup("map", "odom", math.inf)


def test_a_time_that_goes_back_forgets_what_moved_and_keeps_what_is_fixed() -> None:
    tree = filled()
    for now in (1.0, 2.0):
        tree.advance("/tf", round(now * 1e9))
    tree.advance("/other_tf", 0)  # another topic has times of its own
    assert tree.latest("odom", "base")[1] == 2_000_000_000
    tree.advance("/tf", 500_000_000)
    assert list(tree.frames()) == ["base", "door", "lidar", "map", "odom"]
    with pytest.raises(TransformError, match="transforms are received|not connected"):
        tree.lookup("odom", "base")
    put(tree, "odom", "base", Pose((7.0, 0.0, 0.0)), 0.5)
    pose, stamp = tree.latest("odom", "lidar")
    assert (pose.position.tolist(), stamp) == ([7.1, 0.0, 0.3], 500_000_000)
