"""Plugins that publish: joint states, poses, what sensors of Gazebo Classic read."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import model, sensor

_RAY = (
    "<ray>\n  <scan><horizontal><samples>9</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal>"
    "</scan>\n  <range><min>0.1</min><max>10</max></range>\n</ray>\n"
)


def _laser(kind: str, parameters: str) -> str:
    return f'{_RAY}<plugin name="laser" filename="libgazebo_ros_{kind}.so">{parameters}</plugin>'


CODES: tuple[Code, ...] = (
    Code(
        "SK-PLUGIN-060",
        "note",
        "the IMU plugin of ROS 1 tells accelerations with gravity's reaction, which Gazebo's leaves out",
        "`<simkit:gazebo_quirks>true</simkit:gazebo_quirks>` in the world has it as Gazebo",
        model(
            '<link name="base"/>\n<plugin name="imu" filename="libgazebo_ros_imu.so">'
            "<bodyName>base</bodyName><topicName>imu</topicName></plugin>"
        ),
    ),
    Code(
        "SK-PLUGIN-061",
        "note",
        "a parameter that Gazebo's plugin reads and then does nothing with",
        "take it out; the sensor's own `<update_rate>` counts",
        sensor("ray", _laser("block_laser", "<topicName>cloud</topicName><updateRate>5</updateRate>")),
    ),
    Code(
        "SK-PLUGIN-062",
        "note",
        "a laser plugin of ROS 1 that names no topic publishes on `/world`, as in Gazebo",
        "give it a `<topicName>`",
        sensor("ray", _laser("laser", "")),
    ),
    Code(
        "SK-PLUGIN-063",
        "warning",
        "a joint state publisher of gz names a joint twice; it is told once, as in gz",
        "take one of the two out",
        model(
            '<link name="base"/><link name="arm"/>\n<joint name="elbow" type="revolute">'
            "<parent>base</parent><child>arm</child><axis><xyz>0 0 1</xyz></axis></joint>\n"
            '<plugin name="gz::sim::systems::JointStatePublisher" filename="gz-sim-joint-state-publisher-system">\n'
            "  <joint_name>elbow</joint_name>\n  <joint_name>elbow</joint_name>\n</plugin>"
        ),
    ),
)
