"""Moving obstacles of TurtleBot3's worlds."""

from __future__ import annotations

import math

import pytest

import simkit

PILLAR = """<link name="link"><collision name="c"><geometry><cylinder><radius>0.12</radius><length>0.25</length>
  </cylinder></geometry></collision></link>"""


def load(plugin: str, *, pose: str = "0 0 0 0 0 0", more: str = "", rest: str = "") -> simkit.Simulation:
    return simkit.load(f"""<sdf version="1.9"><world name="w"><include><uri>model://ground_plane</uri></include>
      <model name="pillar"><pose>{pose}</pose>{more}{PILLAR}{plugin}</model>{rest}</world></sdf>""")


CLASSIC = '<plugin name="obstacle1" filename="libobstacle1.so"/>'
GZ = '<plugin name="turtlebot3_gazebo::Obstacle1Plugin" filename="libobstacle1.so"/>'


@pytest.mark.parametrize("more", ["", "<static>true</static>"])
def test_the_obstacle_of_gazebo_classic_passes_its_key_frames(more: str) -> None:
    with load(CLASSIC, more=more) as sim:
        sim.run(5.0)  # the middle and 1/8 of the difference of the tangents (-0.25, -0.5) and (-1.75, -0.5)
        assert sim.model("pillar").pose.position == pytest.approx((-0.25 + 0.1875, -0.5, 0), abs=0.001)


def test_the_four_pillars_of_gazebo_classic_turn_once_in_40_s() -> None:
    plugin = '<plugin name="obstacles" filename="libobstacles.so"/>'
    with load(plugin, more="<static>true</static>") as sim:
        sim.run(5.0)  # part t = 1/4 of half a turn: πt - π/2 t(1 - t)², as Gazebo's spherical spline gives
        assert sim.model("pillar").pose.rpy[2] == pytest.approx(0.5645, abs=0.001)


def test_the_obstacle_of_gz_moves_straight_at_a_tenth_of_a_metre_per_second() -> None:
    with load(GZ, pose="2 2 0.25 0 0 0") as sim:
        sim.run(5.0)
        length = math.hypot(0.5, 1.0)
        expected = (2.0 - 0.25 / length, 2.0 - 0.5 / length, 0.25)
        assert sim.model("pillar").pose.position == pytest.approx(expected, abs=0.001)


def test_the_obstacle_pushes_a_box_in_its_way() -> None:
    box = """<model name="box"><pose>1.9 1.76 0.2 0 0 0</pose><link name="l"><gravity>false</gravity>
      <inertial><mass>0.2</mass><inertia>
      <ixx>0.001</ixx><iyy>0.001</iyy><izz>0.001</izz></inertia></inertial><collision name="c"><geometry><box>
      <size>0.2 0.2 0.2</size></box></geometry></collision></link></model>"""
    with load(GZ, pose="2 2 0.25 0 0 0", rest=box) as sim:
        before = sim.model("box").pose.position[1]
        sim.run(1.0)
        assert sim.model("box").pose.position[1] < before - 0.05


def test_a_reset_and_a_snapshot_repeat_the_path_bit_for_bit() -> None:
    with load(CLASSIC) as sim:
        sim.run(1.0)
        saved = sim.snapshot()
        sim.run(1.0)
        expected = sim.model("pillar").pose
        sim.restore(saved)
        sim.run(1.0)
        assert sim.model("pillar").pose == expected
        sim.reset()
        sim.run(2.0)
        assert sim.model("pillar").pose == expected


def test_two_plugins_on_one_model_load() -> None:
    with load(CLASSIC + CLASSIC.replace("obstacle1", "obstacle2")) as sim:
        sim.run(0.1)
        assert not [d for d in sim.diagnostics if d.severity == "error"]
