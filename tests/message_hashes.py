"""Program: run worlds of simkit and print the hash of all messages of each topic, as one JSON object a line.

    python tests/message_hashes.py [WORLD...]

The processor settings of the environment apply to it, or an emulator runs it, so that
`tests/test_same_bits_on_processors.py` and `.ci/blas_kernels` can compare the hashes.
"""

from __future__ import annotations

import hashlib
import json
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import simkit
from simkit import msgs
from simkit_navigation.plugins.localisation.amcl import Amcl
from simkit_navigation.plugins.maps.map_server import MapServer

DRIVE = {"linear": {"x": 0.2}, "angular": {"z": 0.4}}
GOAL = {"header": {"frame_id": "map"}, "pose": {"position": {"x": -1.0, "y": -0.5}, "orientation": {"w": 1.0}}}
NAVIGATION = """<sdf version="1.9">
  <model name="navigation">
    <static>true</static>
    <link name="link"/>
    <plugin filename="libsimkit_robot_localization.so" name="ekf_filter_node">
      <two_d_mode>true</two_d_mode>
      <base_link_frame>base_footprint</base_link_frame>
      <publish_tf>false</publish_tf>
      <odom0>odom</odom0>
      <odom0_config>0 0 0  0 0 0  1 1 0  0 0 0  0 0 0</odom0_config>
      <imu0>imu</imu0>
      <imu0_config>0 0 0  0 0 0  0 0 0  0 0 1  0 0 0</imu0_config>
    </plugin>
    <plugin filename="libsimkit_costmap_2d.so" name="global_costmap"><robot_radius>0.24</robot_radius></plugin>
    <plugin filename="libsimkit_costmap_2d.so" name="local_costmap">
      <global_frame>odom</global_frame>
      <rolling_window>true</rolling_window>
      <width>3</width>
      <height>3</height>
      <robot_radius>0.24</robot_radius>
      <plugins>obstacle_layer inflation_layer</plugins>
    </plugin>
    <plugin filename="libsimkit_planner_server.so" name="planner_server"/>
    <plugin filename="libsimkit_controller_server.so" name="controller_server"/>
    <plugin filename="libsimkit_behavior_server.so" name="behavior_server"/>
    <plugin filename="libsimkit_bt_navigator.so" name="bt_navigator"/>
  </model>
</sdf>"""


def run_drive(sim: simkit.Simulation, seconds: float) -> None:
    """Drive in a circle."""
    sim.publish("/cmd_vel", DRIVE)
    sim.run(seconds)


def run_arm(sim: simkit.Simulation, seconds: float) -> None:
    """Move TIAGo's arm and base."""
    joints = [f"arm_{number}_joint" for number in range(1, 8)]
    point = {"positions": [0.4, 0.2, -1.0, 1.5, 0.5, 0.3, 0.2], "time_from_start": {"sec": 1}}
    sim.publish("/arm_controller/joint_trajectory", {"joint_names": joints, "points": [point]})
    sim.publish("/mobile_base_controller/cmd_vel", DRIVE)
    sim.run(seconds)


def run_navigation(sim: simkit.Simulation, seconds: float) -> None:
    """Find the pose with AMCL and drive to a goal."""
    sim.run(0.5)
    start = {"position": {"x": -2.0, "y": -0.5}, "orientation": {"w": 1.0}}
    sim.publish("/initialpose", {"header": {"frame_id": "map"}, "pose": {"pose": start}})
    sim.run(1.5)
    sim.send_goal("/navigate_to_pose", {"pose": GOAL})
    sim.run(seconds)


def hashes(
    source: str, seconds: float, act: Callable[[simkit.Simulation, float], None], **options: object
) -> dict[str, str]:
    """Return topic -> hash of all messages that a run published, except wall times and file paths (stats, rosout)."""
    pictures = bool(options.pop("pictures", False))
    with simkit.load(source, seed=1, **options) as sim:
        kinds = sim.topics()
        topics = {
            topic: sim.subscribe(topic)
            for topic, kind in kinds.items()
            if not topic.endswith(("/stats", "/rosout"))
            and (pictures or ("Image" not in kind and not topic.endswith("points")))
        }
        act(sim, seconds)
        found = {}
        for topic, subscription in sorted(topics.items()):
            if subscription.messages:
                digest = hashlib.sha256(b"".join(map(msgs.serialize, subscription.messages)))
                found[topic] = f"{len(subscription.messages)} {digest.hexdigest()[:16]}"
        state = hashlib.sha256(sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes())
        return {**found, "state": state.hexdigest()[:16]}


def navigation_hashes() -> dict[str, str]:
    """Return the hashes of a run in which a robot localises itself and drives to a goal."""
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder, "navigation.sdf")
        model.write_text(NAVIGATION)
        return hashes("turtlebot3_world", 3.0, run_navigation, plugins=[MapServer(), Amcl()], spawn=[str(model)])


WORLDS: dict[str, Callable[[], dict[str, str]]] = {
    "turtlebot3_world": lambda: hashes("turtlebot3_world", 3.0, run_drive),
    "tiago_table": lambda: hashes("tiago_table", 1.5, run_arm),
    "sensor_bench": lambda: hashes("sensor_bench", 1.0, run_drive),
    "cameras": lambda: hashes("sensor_bench", 0.1, run_drive, renderer="software", pictures=True),
    "simple_office_with_people": lambda: hashes("simple_office_with_people", 1.0, run_arm, spawn=["tiago:0,0,0"]),
    "navigation": navigation_hashes,
}

if __name__ == "__main__":
    for name in sys.argv[1:] or WORLDS:
        sys.stdout.write(json.dumps({"world": name, "hashes": WORLDS[name]()}) + "\n")
