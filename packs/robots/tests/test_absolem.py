"""Flippers and lidar of the robots Absolem and MARV."""

from __future__ import annotations

import math

import pytest

import simkit

FLIPPER = """<plugin name="cras::FlipperControlPlugin" filename="{file}"><joint_name>flipper</joint_name>
  <max_velocity>0.8</max_velocity>{more}</plugin>"""
LASER = """<plugin name="cras::LaserRotatePlugin" filename="liblaser_rotate_plugin.so"><joint_name>flipper</joint_name>
  <initial_velocity>{first}</initial_velocity><rotation_angular_limit>0.5</rotation_angular_limit></plugin>"""


def robot(plugin: str, effort: float = 100.0) -> str:
    return f"""<sdf version="1.9"><world name="cave"><physics name="p" type="ode"><max_step_size>0.004</max_step_size>
      </physics><model name="robot"><link name="base"><inertial><mass>50</mass><inertia><ixx>5</ixx><iyy>5</iyy>
      <izz>5</izz></inertia></inertial></link><link name="arm"><inertial><pose>0.2 0 0 0 0 0</pose><mass>2</mass>
      <inertia><ixx>0.02</ixx><iyy>0.02</iyy><izz>0.02</izz></inertia></inertial></link>
      <joint name="fixed" type="fixed"><parent>world</parent><child>base</child></joint>
      <joint name="flipper" type="revolute"><parent>base</parent><child>arm</child><axis><xyz>0 1 0</xyz>
      <limit><lower>-3</lower><upper>3</upper><effort>{effort}</effort></limit></axis></joint>{plugin}
      </model></world></sdf>"""


def flipper(file: str = "libflipper_control_plugin.so", more: str = "") -> str:
    return robot(FLIPPER.format(file=file, more=more))


@pytest.mark.parametrize("file", ["libflipper_control_plugin.so", "flipper_control_plugin"])
def test_a_flipper_turns_at_the_commanded_velocity_and_holds_its_position(file: str) -> None:
    with simkit.load(flipper(file)) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        joint = sim.joint("robot::flipper")
        sim.run(0.5)
        assert joint.position == pytest.approx(0.0, abs=math.radians(1))
        sim.publish("/model/robot/joint/flipper/cmd_vel", {"data": 0.5})
        sim.run(1.0)
        assert joint.velocity == pytest.approx(0.5, abs=1e-3)
        sim.publish("/model/robot/joint/flipper/cmd_vel", {"data": 0.0})
        sim.run(0.1)
        stopped = joint.position
        sim.run(2.0)
        assert joint.position == pytest.approx(stopped, abs=math.radians(1))
        assert stopped == pytest.approx(0.5, abs=0.02)


def test_a_flipper_moves_to_a_position_and_by_an_angle_no_faster_than_its_limits() -> None:
    with simkit.load(flipper()) as sim:
        joint = sim.joint("robot::flipper")
        sim.publish("/model/robot/joint/flipper/cmd_pos", {"data": 1.2})
        sim.run(1.0)
        assert joint.velocity == pytest.approx(0.8, abs=1e-3)
        sim.run(1.0)
        assert joint.position == pytest.approx(1.2, abs=math.radians(1.01))
        sim.publish("/model/robot/joint/flipper/cmd_pos_max_vel", {"data": 0.1})
        sim.publish("/model/robot/joint/flipper/cmd_pos_rel", {"data": -0.4})
        sim.run(1.0)
        assert joint.velocity == pytest.approx(-0.1, abs=1e-3)
        sim.run(5.0)
        assert joint.position == pytest.approx(0.8, abs=math.radians(2))


def test_a_weaker_flipper_falls() -> None:
    with simkit.load(flipper(more="<max_torque>50</max_torque>")) as sim:
        sim.publish("/model/robot/joint/flipper/cmd_max_torque", {"data": 1.0})
        sim.run(2.0)
        assert sim.joint("robot::flipper").position > 0.5  # 2 kg at 0.2 m need 3.9 N·m


def test_a_lidar_turns_to_and_fro_and_stops() -> None:
    with simkit.load(robot(LASER.format(first=1.0))) as sim:
        joint, places = sim.joint("robot::flipper"), []
        for _ in range(100):
            sim.run(0.04)
            places.append(float(joint.position))
        assert (min(places), max(places)) == pytest.approx((-0.5, 0.5), abs=0.05)
        sim.publish("/model/robot/joint/flipper/cmd_vel", {"data": 5.0})
        sim.run(0.1)
        assert abs(joint.velocity) == pytest.approx(1.2, abs=1e-3)
        sim.publish("/model/robot/joint/flipper/cmd_vel", {"data": 0.0})
        sim.run(0.5)
        assert joint.velocity == pytest.approx(0.0, abs=1e-6)


def test_a_wrong_joint_is_an_error() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003"):
        simkit.load(flipper().replace("<joint_name>flipper", "<joint_name>fliper"))
