"""Three rooms without symmetry, 6 m × 4 m, with a robot that has a lidar, and with the true map."""

from __future__ import annotations

_BOX = '<collision name="{}"><pose>{} 0.25 0 0 {}</pose><geometry><box><size>{} 0.5</size></box></geometry></collision>'
_BOXES = (
    ("south", "3 -0.05", 0, "6.2 0.1"),
    ("north", "3 4.05", 0, "6.2 0.1"),
    ("west", "-0.05 2", 0, "0.1 4"),
    ("east", "6.05 2", 0, "0.1 4"),
    ("across", "1.2 2.2", 0, "2.4 0.1"),
    ("inner", "3.6 0.7", 0, "0.1 1.4"),
    ("shelf", "5.6 3.2", 0, "0.8 0.4"),
    ("crate", "4.6 2.2", 0.3, "0.3 0.3"),
    ("chest", "0.3 0.3", 0.4, "0.4 0.3"),
)
_ROBOT = """<model name="robot"><pose>1 1 0.1 0 0 0.5</pose><link name="base_footprint">
<inertial><mass>1</mass></inertial></link><link name="base_scan"><pose>-0.03 0 0.1 0 0 0</pose>
<inertial><mass>0.1</mass></inertial><sensor name="lidar" type="ray"><update_rate>5</update_rate><ray><scan><horizontal>
<samples>360</samples><min_angle>0</min_angle><max_angle>6.28</max_angle></horizontal></scan><range><min>0.12</min>
<max>3.5</max></range><noise><type>gaussian</type><stddev>0.01</stddev></noise></ray>
<plugin filename="libgazebo_ros_ray_sensor.so" name="lidar"><ros><remapping>~/out:=scan</remapping></ros>
<output_type>sensor_msgs/LaserScan</output_type><frame_name>base_scan</frame_name></plugin></sensor></link>
<joint name="j" type="fixed"><parent>base_footprint</parent><child>base_scan</child></joint>
<plugin filename="libgazebo_ros_planar_move.so" name="move"><update_rate>50</update_rate><publish_rate>20</publish_rate>
<odometry_frame>odom</odometry_frame><robot_base_frame>base_footprint</robot_base_frame></plugin></model>"""
_ROOMS = """<sdf version="1.9"><world name="rooms"><gravity>0 0 0</gravity>
<physics type="ode"><max_step_size>0.01</max_step_size></physics>
<model name="walls"><static>true</static><link name="l">{walls}</link></model>{robot}
<plugin filename="libsimkit_map_server.so" name="map_server"/>
<plugin filename="libsimkit_amcl.so" name="amcl">{options}</plugin></world></sdf>"""


def rooms(options: str = "") -> str:
    """Return the world with options of `amcl`."""
    walls = "".join(_BOX.format(name, at, yaw, size) for name, at, yaw, size in _BOXES)
    return _ROOMS.format(walls=walls, robot=_ROBOT, options=options)
