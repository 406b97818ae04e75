"""Foot contact of Unitree's quadrupeds."""

from __future__ import annotations

import numpy as np
import pytest

import simkit

TOPIC = "/visual/FR_foot_contact/the_force"
SENSOR = """<sensor name="FR_foot_contact" type="{}"><update_rate>100</update_rate><contact><collision>foot</collision>
  </contact><plugin filename="libunitreeFootContactPlugin.so" name="contactPlugin"/></sensor>"""


def world(pose: str, kind: str = "contact", visual: str = "") -> str:
    return f"""<sdf version="1.6"><world name="w"><gravity>0 0 -10</gravity>
      <include><uri>model://ground_plane</uri></include><model name="leg"><pose>{pose}</pose><link name="calf">
      <inertial><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>
      <collision name="foot"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>
      {visual}{SENSOR.format(kind)}</link>
      </model></world></sdf>"""


def forces(text: str, seconds: float) -> np.ndarray:
    """Return the published forces, shape (n, 3)."""
    with simkit.load(text) as sim:
        heard = sim.subscribe(TOPIC)
        sim.run(seconds)
        assert {message.header.frame_id for message in heard.messages} == {"calf"}
        return np.array([(m.wrench.force.x, m.wrench.force.y, m.wrench.force.z) for m in heard.messages])


def test_a_resting_foot_measures_its_weight_100_times_a_second_in_the_axes_of_its_link() -> None:
    found = forces(world("0 0 0.1 0 1.5707963267948966 0"), 2.0)  # the link's x axis points down
    assert len(found) == 200
    assert found[-1] == pytest.approx((-20.0, 0.0, 0.0), abs=0.2)


def test_a_foot_in_the_air_measures_zero() -> None:
    assert forces(world("0 0 5 0 0 0"), 0.5) == pytest.approx(np.zeros((50, 3)), abs=1e-12)


def test_the_plugin_of_another_sensor_says_which_sensor_it_needs() -> None:
    with pytest.raises(simkit.LoadError, match="needs a sensor of type contact"):
        simkit.load(world("0 0 0.1 0 0 0", "imu"))


def test_the_plugin_that_draws_the_force_is_a_note() -> None:
    visual = """<visual name="v"><geometry><sphere><radius>0.02</radius></sphere></geometry>
      <plugin name="drawForcePlugin" filename="libunitreeDrawForcePlugin.so"><topicName>FR_foot_contact</topicName>
      </plugin></visual>"""
    with simkit.load(world("0 0 0.1 0 0 0", visual=visual)) as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-PLUGIN-002"] == ["note"]
