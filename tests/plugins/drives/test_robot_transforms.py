"""Transforms of moving joints on `/tf`."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import simkit


def arm(name: str = "arm", element: str = "") -> str:
    def link(n: str, x: float) -> str:
        mass = "<inertial><mass>1</mass><inertia><ixx>.01</ixx><iyy>.01</iyy><izz>.01</izz></inertia></inertial>"
        return f'<link name="{n}"><pose>{x} 0 1 0 0 0</pose>{mass}</link>'

    axis = "<axis><xyz>0 0 1</xyz></axis>"
    return f"""<model name="{name}">{link("foot", 0)}{link("rod", 0.5)}{link("tip", 1)}
      <joint name="stand" type="fixed"><parent>world</parent><child>foot</child></joint>
      <joint name="turn" type="revolute"><parent>foot</parent><child>rod</child>{axis}</joint>
      <joint name="hold" type="fixed"><parent>rod</parent><child>tip</child></joint>
      <plugin name="simkit::RobotStatePublisher" filename="libsimkit_robot_state_publisher.so">{element}</plugin>
      </model>"""


def load(content: str) -> simkit.Simulation:
    return simkit.load(f'<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>{content}</world></sdf>')


def test_a_link_that_a_joint_moves_is_published_in_its_parent() -> None:
    with load(arm(element="<publish_frequency>10</publish_frequency>")) as sim:
        transforms: Any = sim.subscribe("/tf", keep=100)
        sim.joint("arm::turn").set_position(0.8)
        sim.run(1.0)
        assert len(transforms.messages) == 10
        (transform,) = transforms.latest.transforms  # the fixed ones are on /tf_static
        assert (transform.header.frame_id, transform.child_frame_id) == ("foot", "rod")
        t, r = transform.transform.translation, transform.transform.rotation
        assert (t.x, t.y, t.z) == pytest.approx((0.5, 0, 0))
        assert 2 * np.arctan2(r.z, r.w) == pytest.approx(0.8)


def test_frames_have_the_names_of_tf_static_also_with_a_second_robot() -> None:
    with load(arm()) as sim:
        transforms: Any = sim.subscribe("/tf", keep=10)
        sim.run(0.1)
        sim.spawn(f'<sdf version="1.9">{arm("other")}</sdf>')
        sim.run(0.1)
        children = [m.transforms[0].child_frame_id for m in transforms.messages[-2:]]
        assert sorted(children) == ["other/rod", "rod"]
