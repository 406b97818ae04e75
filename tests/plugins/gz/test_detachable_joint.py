"""Detachable joint of Gazebo: detach and attach."""

from __future__ import annotations

import re

import numpy as np
import pytest

import simkit
from simkit.errors import LoadError

G = 9.8


def body(name: str, pose: str, more: str = "") -> str:
    return f"""<model name="{name}"><pose>{pose}</pose><link name="body"><inertial><mass>1</mass><inertia><ixx>0.1</ixx>
    <iyy>0.1</iyy><izz>0.1</izz></inertia></inertial></link>{more}</model>"""


def plugin(parameters: str = "", child: str = "load") -> str:
    return f"""<plugin filename="gz-sim-detachable-joint-system" name="gz::sim::systems::DetachableJoint">
    <parent_link>body</parent_link><child_model>{child}</child_model><child_link>body</child_link>{parameters}</plugin>"""


HOLD = '<joint name="hold" type="fixed"><parent>world</parent><child>body</child></joint>'


def crane(parameters: str = "", with_load: bool = True) -> str:
    load = body("load", "0.3 0 4 0 0 0.5") if with_load else ""
    tower = body("crane", "0 0 5 0 0 0", HOLD + plugin(parameters))
    return f'<sdf version="1.9"><world name="w">{tower}{load}</world></sdf>'


def test_the_load_hangs_until_it_is_detached() -> None:
    sim = simkit.load(crane())
    load = sim.model("load")
    before = load.pose
    sim.run(1.0)
    assert load.pose.position == pytest.approx(before.position, abs=1e-4)
    assert load.pose.rpy == pytest.approx(before.rpy, abs=1e-4)
    sim.publish("/model/crane/detachable_joint/detach", {})
    sim.run(0.5)
    assert before.position[2] - load.pose.position[2] == pytest.approx(G / 8, rel=5e-3)


def test_a_reattached_load_keeps_its_pose_of_that_moment() -> None:
    sim = simkit.load(crane())
    sim.run(0.01)
    sim.publish("/model/crane/detachable_joint/detach", {})
    sim.run(0.3)
    load = sim.model("load")
    load.set_velocity((0, 0, 0))
    sim.publish("/model/crane/detachable_joint/attach", {})
    sim.step(2)
    held = load.pose
    sim.run(1.0)
    assert load.pose.position == pytest.approx(held.position, abs=1e-3)
    assert float(held.position[2]) < 3.6


def test_each_change_is_published() -> None:
    sim = simkit.load(crane("<output_topic>/crane/state</output_topic>"))
    states = sim.subscribe("/crane/state")
    sim.run(0.1)
    sim.publish("/model/crane/detachable_joint/detach", {})
    sim.publish("/model/crane/detachable_joint/detach", {})
    sim.run(0.1)
    sim.publish("/model/crane/detachable_joint/attach", {})
    sim.run(0.1)
    assert [m.data for m in states.messages] == ["attached", "detached", "attached"]


def test_it_can_start_detached_and_use_other_topics() -> None:
    names = "<attach_topic>/grab</attach_topic><detach_topic>/drop</detach_topic>"
    sim = simkit.load(crane(f"<initial_attach>false</initial_attach>{names}"))
    load = sim.model("load")
    sim.run(0.2)
    assert load.pose.position[2] < 3.9
    sim.publish("/grab", {})
    sim.run(0.2)
    held = float(load.pose.position[2])
    sim.run(0.5)
    assert load.pose.position[2] == pytest.approx(held, abs=2e-3)
    sim.publish("/drop", {})
    sim.run(0.2)
    assert load.pose.position[2] < held - 0.1
    assert "/model/load/detachable_joint/state" in sim.topics()


def test_a_missing_child_is_attached_when_it_is_spawned() -> None:
    sim = simkit.load(crane(with_load=False))
    assert "SK-JOINT-013" in [d.code for d in sim.diagnostics]
    quiet = simkit.load(crane("<suppress_child_warning>true</suppress_child_warning>", with_load=False))
    assert "SK-JOINT-013" not in [d.code for d in quiet.diagnostics]
    sim.run(0.1)
    load = sim.spawn(f'<sdf version="1.9">{body("load", "0.3 0 4 0 0 0.5")}</sdf>')
    sim.run(1.0)
    assert load.pose.position == pytest.approx((0.3, 0, 4), abs=1e-3)
    sim.publish("/model/crane/detachable_joint/detach", {})
    sim.run(0.3)
    assert load.pose.position[2] < 3.7


def test_a_removed_child_can_be_attached_again_after_it_is_spawned_again() -> None:
    sim = simkit.load(crane())
    sim.run(0.1)
    sim.remove("load")
    sim.run(0.1)
    load = sim.spawn(f'<sdf version="1.9">{body("load", "0.3 0 4 0 0 0.5")}</sdf>')
    sim.publish("/model/crane/detachable_joint/attach", {})
    sim.step(2)
    held = float(load.pose.position[2])
    sim.run(0.5)
    assert load.pose.position[2] == pytest.approx(held, abs=2e-3)


def test_reset_and_restore_include_the_attachment() -> None:
    sim = simkit.load(crane())
    load = sim.model("load")
    sim.run(0.1)
    sim.publish("/model/crane/detachable_joint/detach", {})
    sim.run(0.3)
    fallen, snapshot = load.pose.position.copy(), sim.snapshot()
    sim.run(0.2)
    end = load.pose.position.copy()
    sim.reset()
    sim.run(0.5)
    assert load.pose.position == pytest.approx((0.3, 0, 4), abs=1e-4)
    sim.restore(snapshot)
    np.testing.assert_array_equal(load.pose.position, fallen)
    sim.run(0.2)
    np.testing.assert_array_equal(load.pose.position, end)


def test_a_link_of_the_same_model_can_be_the_child() -> None:
    second = """<link name="tool"><pose>1 0 0 0 0 0</pose><inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy>
    <izz>0.1</izz></inertia></inertial></link>"""
    own = plugin(child="__model__").replace("<child_link>body", "<child_link>tool")
    sim = simkit.load(
        f'<sdf version="1.9"><world name="w">{body("crane", "0 0 5 0 0 0", HOLD + second + own)}</world></sdf>'
    )
    sim.run(0.5)
    assert sim.link("crane::tool").pose.position == pytest.approx((1, 0, 5), abs=1e-4)
    sim.publish("/model/crane/detachable_joint/detach", {})
    sim.run(0.5)
    assert sim.link("crane::tool").pose.position[2] < 4.0


def test_a_missing_parent_link_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003"):
        simkit.load(crane().replace("<parent_link>body", "<parent_link>boddy"))


@pytest.mark.parametrize("element", ["parent_link", "child_model", "child_link"])
def test_empty_names_are_errors(element: str) -> None:
    text = re.sub(f"<{element}>.*?</{element}>", f"<{element}></{element}>", crane())
    with pytest.raises(LoadError):
        simkit.load(text)


def test_an_empty_topic_is_the_default_and_one_without_a_letter_an_error() -> None:
    with simkit.load(crane("<detach_topic/><topic/>")) as sim:
        assert "/model/crane/detachable_joint/detach" in sim.topics()
    with pytest.raises(LoadError, match="found <output_topic>/</output_topic>"):
        simkit.load(crane("<output_topic>/</output_topic>"))
