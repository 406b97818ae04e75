"""Groups of joints for the panel: chains, fingers and wheels of robots, and their headings."""

from __future__ import annotations

import simkit
from simkit_view.view.joint_groups import joint_groups


def robot(joints: dict[str, tuple[str, str, str]]) -> str:
    """Return a world with a robot: parent, type and axis of each joint; the parent is `base` or another joint."""
    links = "".join(f"<link name='l {name}'><inertial><mass>1</mass></inertial></link>" for name in ("base", *joints))
    text = "".join(
        f"<joint name='{name}' type='{kind}'><parent>l {parent}</parent><child>l {name}</child><axis><xyz>{axis}</xyz>"
        f"{'' if kind == 'continuous' else '<limit><lower>-1</lower><upper>1</upper></limit>'}</axis></joint>"
        for name, (parent, kind, axis) in joints.items()
    )
    return f"<sdf version='1.9'><world name='w'><model name='bot'>{links}{text}</model></world></sdf>"


def groups(joints: dict[str, tuple[str, str, str]]) -> list[tuple[str, list[str]]]:
    with simkit.load(robot(joints)) as sim:
        found = list(sim.contents.handles.tables["joint"].values())
        return [(heading, [found[number].name for number in numbers]) for heading, numbers in joint_groups(sim, found)]


def test_the_longest_chain_and_its_fingers_come_before_the_others_and_wheels_last() -> None:
    hinge, wheel = ("revolute", "0 0 1"), ("continuous", "0 1 0")
    found = groups(
        {
            "wheel_left_joint": ("base", *wheel),
            "wheel_right_joint": ("base", *wheel),
            "head_pan_joint": ("base", *hinge),
            "arm_1_joint": ("base", *hinge),
            "arm_2_joint": ("arm_1_joint", *hinge),
            "grip_left_joint": ("arm_2_joint", "prismatic", "0 1 0"),
            "grip_right_joint": ("arm_2_joint", "prismatic", "0 1 0"),
        }
    )
    assert found == [
        ("arm", ["arm_1_joint", "arm_2_joint"]),
        ("grip", ["grip_left_joint", "grip_right_joint"]),
        ("head pan", ["head_pan_joint"]),
        ("wheels", ["wheel_left_joint", "wheel_right_joint"]),
    ]


def test_a_mast_that_turns_without_limits_is_no_wheel() -> None:
    assert [heading for heading, _ in groups({"radar": ("base", "continuous", "0 0 1")})] == ["radar"]


def test_names_without_common_words_give_the_first_and_the_last_as_heading() -> None:
    found = groups({"shoulder": ("base", "revolute", "0 0 1"), "elbow_joint": ("shoulder", "revolute", "0 1 0")})
    assert found == [("shoulder … elbow", ["shoulder", "elbow_joint"])]
    found = groups({"joint_1": ("base", "revolute", "0 0 1"), "joint_2": ("joint_1", "revolute", "0 1 0")})
    assert found == [("joint 1 … joint 2", ["joint_1", "joint_2"])]
