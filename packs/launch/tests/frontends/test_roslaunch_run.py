"""What a launch file of ROS 1 starts runs with its parameters, names, arguments and conditions."""

from __future__ import annotations

from pathlib import Path

import pytest

import simkit
from simkit.testing import open_scenario

PROGRAM = """
import os
import sys

import rospy

rospy.init_node("talker")
print(rospy.get_name(), rospy.resolve_name("out"), rospy.myargv(sys.argv)[1:], os.environ.get("MODE"))
print(rospy.get_param("~speed"), rospy.get_param("~count"), rospy.get_param("/limits/v"), rospy.get_param("~words"))
print(rospy.get_time() >= 0.5)
"""

LAUNCH = """
<launch>
  <arg name="speed" default="0.1"/>
  <rosparam>limits: {v: 2.5}</rosparam>
  <param name="~words" value="all nodes"/>
  <group ns="robot">
    <env name="MODE" value="fast"/>
    <node pkg="bot" type="talk.py" name="talk" args="-x 1 _count:=3" launch-prefix="bash -c 'sleep 0.5; $0 $@'">
      <param name="speed" value="$(arg speed)"/>
      <remap from="out" to="/heard"/>
    </node>
  </group>
</launch>
"""


@pytest.mark.slow
def test_a_node_gets_its_parameters_names_words_variables_and_delay(tmp_path: Path) -> None:
    script = tmp_path / "scripts" / "talk.py"
    script.parent.mkdir()
    script.write_text(PROGRAM)
    script.chmod(0o755)
    (tmp_path / "package.xml").write_text("<package><name>bot</name></package>")
    file = tmp_path / "talk.launch"
    file.write_text(LAUNCH)
    with open_scenario(simkit.launch(file, {"speed": "0.7"})) as sim:
        sim.run(1.0)
        (node,) = sim.nodes
        assert node.error is None
        assert node.log == [
            "/robot/talk /heard ['-x', '1'] fast",
            "0.7 3 2.5 all nodes",
            "True",
        ]
