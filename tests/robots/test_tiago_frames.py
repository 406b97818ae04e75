"""The tree of frames that a ROS program sees: every link of TIAGo hangs on `odom`, each on one parent, where it is."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

import simkit
from simkit.pose import IDENTITY, Pose

ASSETS = Path(__file__).parents[2] / "assets"


def tree(sim: simkit.Simulation) -> dict[str, tuple[str, Pose]]:
    """Parent and place in it, by frame, as the newest messages have them; no frame may have two parents."""
    heard = [sim.subscribe(topic, keep=200) for topic in ("/tf", "/tf_static")]
    sim.run(1.2)  # what is fixed in a robot that came is told within a second
    found: dict[str, tuple[str, Pose]] = {}
    parents: dict[str, set[str]] = defaultdict(set)
    for message in (m for subscription in heard for m in subscription.messages):
        for one in message.transforms:
            t, r = one.transform.translation, one.transform.rotation
            found[one.child_frame_id] = one.header.frame_id, Pose((t.x, t.y, t.z), (r.w, r.x, r.y, r.z))
            parents[one.child_frame_id].add(one.header.frame_id)
    assert not {frame: both for frame, both in parents.items() if len(both) > 1}
    return found


def placed(frames: dict[str, tuple[str, Pose]], name: str, root: str) -> Pose:
    pose = IDENTITY
    while name != root:
        assert name in frames, f"{name} hangs on nothing"
        name, place = frames[name]
        pose = place @ pose
    return pose


@pytest.mark.parametrize("name", ["tiago", "tiago_no_arm", "pmb2"])
def test_every_link_hangs_on_odom_where_it_is(name: str) -> None:
    links = [e.get("name") for e in ElementTree.parse(ASSETS / "tiago" / f"{name}.urdf").iter("link")]
    with simkit.load("empty") as sim:
        robot = sim.spawn(name)
        frames = tree(sim)
        base = robot.link("base_footprint").pose.inverse()
        for link in filter(None, links):
            placed(frames, link, "odom")
            told, true = placed(frames, link, "base_footprint"), base @ robot.link(link).pose
            assert np.allclose(told.matrix, true.matrix, atol=1e-3), link


def test_frames_of_a_raised_arm_and_torso_are_where_the_links_are() -> None:
    with simkit.load("empty") as sim:
        robot = sim.spawn("tiago")
        robot.set_joint_positions({"torso_lift_joint": 0.2, "arm_1_joint": 1.0, "arm_4_joint": 1.5})
        sim.run(0.5)
        told = placed(tree(sim), "gripper_grasping_frame", "base_footprint")
        true = robot.link("base_footprint").pose.inverse() @ robot.link("gripper_grasping_frame").pose
        assert np.allclose(told.position, true.position, atol=2e-3)


def test_the_joints_in_joint_states_are_all_that_move() -> None:
    with simkit.load("empty") as sim:
        robot = sim.spawn("tiago")
        heard: Any = sim.subscribe("/joint_states", keep=1)
        sim.run(0.1)
        assert set(heard.latest.name) == {n for n, joint in robot.joints.items() if joint.type != "fixed"}
