"""Two robots with a navigation each: names below their namespaces, and poses from prefixed frames."""

from __future__ import annotations

import math
from pathlib import Path

from navigation_worlds import GROUND, PHYSICS, POSTS, pose, run_until_done

import simkit

WHEEL = """<link name="{side}"><pose>0 {y} 0.05 -1.5708 0 0</pose><inertial><mass>0.1</mass><inertia>
  <ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz></inertia></inertial>
  <collision name="c"><geometry><cylinder><radius>0.05</radius><length>0.02</length></cylinder></geometry></collision>
  </link><joint name="{side}_joint" type="revolute"><parent>base_footprint</parent><child>{side}</child>
  <axis><xyz>0 0 1</xyz></axis></joint>"""
ROBOT = """<model name="{name}"><pose>{place} 0 0 0 0</pose><link name="base_footprint"><inertial>
  <pose>-0.05 0 0.03 0 0 0</pose><mass>2</mass><inertia><ixx>0.02</ixx><iyy>0.02</iyy>
  <izz>0.02</izz></inertia></inertial><collision name="caster"><pose>-0.1 0 0.025 0 0 0</pose><geometry>
  <sphere><radius>0.025</radius></sphere></geometry><surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction>
  </surface></collision></link>{left}{right}
  <plugin filename="libgazebo_ros_diff_drive.so" name="drive"><ros><namespace>{name}</namespace></ros>
  <left_joint>left_joint</left_joint><right_joint>right_joint</right_joint><wheel_separation>0.3</wheel_separation>
  <wheel_diameter>0.1</wheel_diameter><publish_odom>true</publish_odom><publish_odom_tf>true</publish_odom_tf>
  <odometry_frame>{name}/odom</odometry_frame><robot_base_frame>{name}/base_footprint</robot_base_frame></plugin>{nodes}
  </model>"""
NODES = """<plugin filename="libsimkit_fake_localization.so" name="fake_localization">{own}
  <base_frame_id>{name}/base_footprint</base_frame_id><odom_frame_id>{name}/odom</odom_frame_id></plugin>
  <plugin filename="libsimkit_costmap_2d.so" name="global_costmap">{own}{base}</plugin>
  <plugin filename="libsimkit_planner_server.so" name="planner_server">{own}{base}</plugin>
  <plugin filename="libsimkit_controller_server.so" name="controller_server">{own}{base}</plugin>
  <plugin filename="libsimkit_bt_navigator.so" name="bt_navigator">{own}{base}</plugin>"""


def robot(name: str, place: str) -> str:
    own = f"<ros><namespace>{name}</namespace></ros>"
    nodes = NODES.format(name=name, own=own, base=f"<robot_base_frame>{name}/base_footprint</robot_base_frame>")
    left, right = (WHEEL.format(side=side, y=y) for side, y in (("left", 0.15), ("right", -0.15)))
    return ROBOT.format(name=name, place=place, left=left, right=right, nodes=nodes)


def test_two_robots_navigate_below_their_namespaces_without_other_names_of_topics(tmp_path: Path) -> None:
    server = '<plugin filename="libsimkit_map_server.so" name="map_server"/>'
    robots = robot("one", "0 1") + robot("two", "0 -1")
    file = tmp_path / "two.sdf"
    text = f'<sdf version="1.9"><world name="w">{PHYSICS}{GROUND}{POSTS}{server}{robots}</world></sdf>'
    file.write_text(text, "utf-8")
    with simkit.load(file) as sim:
        sim.run(1.5)
        goals = {
            name: sim.send_goal(f"/{name}/navigate_to_pose", {"pose": pose(1.5, y)})
            for name, y in (("one", 1.5), ("two", -1.5))
        }
        for goal in goals.values():
            run_until_done(sim, goal)
        assert {name: goal.status.name for name, goal in goals.items()} == dict.fromkeys(goals, "SUCCEEDED")
        for name, y in (("one", 1.5), ("two", -1.5)):
            assert math.dist(sim.model(name).pose.position[:2], (1.5, y)) < 0.26  # the default tolerance is 0.25 m
        assert [d.message for d in sim.diagnostics if d.severity != "note"] == []


def test_a_frame_of_two_robots_has_no_true_pose(tmp_path: Path) -> None:
    robots = robot("one", "0 1").replace("one/base", "base") + robot("two", "0 -1")
    file = tmp_path / "two.sdf"
    file.write_text(f'<sdf version="1.9"><world name="w">{PHYSICS}{GROUND}{robots}</world></sdf>', "utf-8")
    with simkit.load(file) as sim:
        sim.run(0.2)
        (found,) = [d for d in sim.diagnostics if d.code == "SK-PLUGIN-132"]
    assert "2 models have a link 'base_footprint'" in found.message
    assert found.hint == "set <base_frame_id> to LINK, or to MODEL/LINK"
