"""Force plugin of ROS 1 on a model."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from plugin_worlds import GROUND, element, world, xyz

import simkit

G = 9.8
STONE = (
    "<link name='stone'><pose>{pose}</pose><inertial><mass>3</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz>"
    "</inertia></inertial><collision name='c'><geometry><sphere><radius>0.5</radius></sphere></geometry></collision>"
    "</link>"
)


def loaded(pose: str, **values: Any) -> simkit.Simulation:
    settings = {"bodyName": "stone", "topicName": "force", **values}
    plugin = element("plugin", settings, "name='f' filename='libgazebo_ros_f3d.so'")
    return simkit.load(world(GROUND, f"<model name='m'>{STONE.format(pose=pose)}{plugin}</model>"))


def six(message: Any) -> np.ndarray:
    return np.concatenate((xyz(message.wrench.force), xyz(message.wrench.torque)))


def test_a_falling_stone_has_its_weight_at_every_step() -> None:
    with loaded("0 0 9 0.3 0 0", robotNamespace="arm") as sim:
        assert sim.topics()["/arm/force"] == "geometry_msgs/msg/WrenchStamped"
        heard = sim.subscribe("/arm/force")
        sim.step(10)
        assert len(heard.messages) == 10
        assert heard.latest.header.frame_id == "world"
        np.testing.assert_allclose(six(heard.latest), (0, 0, -3 * G, 0, 0, 0), atol=1e-6)
        assert not [d for d in sim.diagnostics if d.severity != "note"]


def test_on_a_stone_at_rest_all_forces_cancel() -> None:
    with loaded("0 0 0.5 0 0 0", frameName="/map") as sim:
        sim.run(1.0)
        heard = sim.subscribe("/force")
        sim.step(1)
        assert heard.latest.header.frame_id == "map"
        np.testing.assert_allclose(six(heard.latest), 0, atol=1e-2)


def test_an_external_force_is_in_the_sum() -> None:
    with loaded("0 0 9 0 0 0") as sim:
        heard = sim.subscribe("/force")
        sim.link("m::stone").apply_wrench((6, 0, 0), (0, 0, 0.2))
        sim.step(1)
        np.testing.assert_allclose(six(heard.latest), (6, 0, -3 * G, 0, 0, 0.2), atol=1e-6)
        assert sim.link("m::stone").linear_velocity[0] == pytest.approx(6 / 3 * 0.001)


def test_body_and_topic_are_required() -> None:
    with pytest.raises(simkit.LoadError) as caught:
        loaded("0 0 9 0 0 0", bodyName=None, topicName=None)
    errors = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert [d.code for d in errors] == ["SK-PARAM-001"] * 2
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003"):
        loaded("0 0 9 0 0 0", bodyName="stick")
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003.*no link ''"):
        loaded("0 0 9 0 0 0", bodyName="")
