"""Every place of SDF and URDF that holds a number, in small documents that load, and odd numbers for each of them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from lxml import etree
from samples import picture
from wide_sdf import AXIS, LIGHT, MATERIAL, POSE, SHAPES, SURFACE

VALUES = ("nan", "inf", "-inf", "1e308", "1e9", "1e-9", "-1", "0", "", "text", "1e400", "1 2")
NUMBERS = re.compile(r"\s*(?:[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?\s*)+")
MASS = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
BOX = f"<geometry>{SHAPES[1]}</geometry>"
NOISE = """<noise type="gaussian"><mean>0</mean><stddev>0.01</stddev><bias_mean>0</bias_mean>
  <bias_stddev>0</bias_stddev>  <precision>0.001</precision><dynamic_bias_stddev>0.1</dynamic_bias_stddev>
  <dynamic_bias_correlation_time>1</dynamic_bias_correlation_time></noise>"""
DATA_SHEET = """<noise type="gaussian_quantized"><noise_density>0.01</noise_density>
  <bias_instability>0.01</bias_instability><random_walk>0.01</random_walk><correlation_time>10</correlation_time><bias_mean>0.1</bias_mean></noise>"""
TIMING = """<phase>0.01</phase><jitter>0.01</jitter><latency>0.03</latency><latency_jitter>0.01</latency_jitter>"""
SCAN = f"""<scan><horizontal><samples>9</samples><resolution>1</resolution><min_angle>-1</min_angle>
  <max_angle>1</max_angle></horizontal><vertical><samples>2</samples><resolution>1</resolution><min_angle>0</min_angle>
  <max_angle>0.1</max_angle></vertical></scan><range><min>0.1</min><max>9</max><resolution>0.01</resolution></range>
  <visibility_mask>255</visibility_mask>{NOISE}"""
CAMERA = f"""<camera><horizontal_fov>1</horizontal_fov><image><width>8</width><height>6</height>
  <anti_aliasing>2</anti_aliasing></image><clip><near>0.1</near><far>9</far></clip><depth_camera><clip><near>0.1</near>
  <far>5</far></clip></depth_camera><distortion><k1>0.1</k1><k2>0</k2><k3>0</k3><p1>0</p1><p2>0</p2>
  <center>0.5 0.5</center></distortion><lens><intrinsics><fx>8</fx><fy>8</fy><cx>4</cx><cy>3</cy><s>0</s></intrinsics>
  <projection><p_fx>8</p_fx><p_fy>8</p_fy><p_cx>4</p_cx><p_cy>3</p_cy><tx>0</tx><ty>0</ty></projection></lens>
  <visibility_mask>255</visibility_mask>{NOISE}</camera>"""
FRAME = "<image><width>8</width><height>6</height></image><clip><near>0.1</near><far>9</far></clip>"
LENS = """<lens><type>custom</type><custom_function><c1>1</c1><c2>2</c2><c3>0</c3><f>1</f><fun>sin</fun>
  </custom_function><scale_to_hfov>1</scale_to_hfov><cutoff_angle>1.5</cutoff_angle><env_texture_size>64</env_texture_size></lens>"""
IMU = f"""<imu><orientation_reference_frame><localization>CUSTOM</localization><custom_rpy>0 0 0</custom_rpy>
  <grav_dir_x>1 0 0</grav_dir_x></orientation_reference_frame><angular_velocity><x>{NOISE}</x></angular_velocity>
  <linear_acceleration><z>{NOISE}</z></linear_acceleration></imu>"""
BEAM = "<beam><aperture>0.05</aperture><rotation>0.7</rotation><tilt>0.5</tilt></beam>"
SENSORS = {
    "lidar": f"<lidar>{SCAN}</lidar>",
    "ray": f"<ray>{SCAN}</ray>",
    "gpu_lidar": f"<lidar>{SCAN}</lidar>",
    "imu": IMU,
    "sonar": f"""<sonar><min>0.02</min><max>4</max><radius>0.5</radius><axis>1 0 0</axis>{NOISE}</sonar>{TIMING}""",
    "altimeter": f"""<altimeter><vertical_position>{NOISE}</vertical_position><vertical_velocity>{DATA_SHEET}
      </vertical_velocity></altimeter>{TIMING}""",
    "air_pressure": f"""<air_pressure><reference_altitude>400</reference_altitude><pressure>{NOISE}</pressure>
      </air_pressure>""",
    "air_speed": f"<air_speed><pressure>{DATA_SHEET}</pressure></air_speed>",
    "magnetometer": f"<magnetometer><date>2026.5</date><x>{NOISE}</x><y>{DATA_SHEET}</y></magnetometer>",
    "navsat": f"""<navsat><position_sensing><horizontal>{NOISE}</horizontal><vertical>{DATA_SHEET}</vertical>
      </position_sensing><velocity_sensing><horizontal>{NOISE}</horizontal></velocity_sensing></navsat>""",
    "solar": f"""<solar><field_of_view>3</field_of_view><irradiance>900</irradiance><panel><area>0.5</area>
      <efficiency>0.2</efficiency><normal>0 0 1</normal></panel><normal>0 0.1 1</normal>
      <angular_noise>0.01</angular_noise>{NOISE}</solar>""",
    "dvl": f"""<gz:dvl><resolution>0.01</resolution><minimum_range>0.1</minimum_range>
      <maximum_range>80</maximum_range><arrangement>{BEAM * 3}</arrangement></gz:dvl>""",
    "wireless_receiver": """<transceiver><min_frequency>2412</min_frequency><max_frequency>2484</max_frequency>
      <gain>2.5</gain><power>14</power><sensitivity>-90</sensitivity></transceiver>""",
    "camera": CAMERA,
    "depth_camera": CAMERA,
    "rgbd_camera": CAMERA,
    "wide_angle_camera": f"<camera><horizontal_fov>3</horizontal_fov>{FRAME}{LENS}</camera>",
    "segmentation": f"<camera><horizontal_fov>1</horizontal_fov>{FRAME}</camera>",
    "boundingbox": f"<camera><horizontal_fov>1</horizontal_fov>{FRAME}</camera>",
    "thermal": f"""<camera><horizontal_fov>1</horizontal_fov>{FRAME}</camera>
      <plugin filename="gz-sim-thermal-sensor-system" name="gz::sim::systems::ThermalSensor"><min_temp>250</min_temp>
      <max_temp>670</max_temp><resolution>3.0</resolution></plugin>""",
    "multicamera": f"""<camera name="a">{POSE}<horizontal_fov>1</horizontal_fov>{FRAME}</camera>
      <camera name="b">{POSE}<horizontal_fov>1</horizontal_fov>{FRAME}</camera>""",
    "logical_camera": """<logical_camera><near>0.5</near><far>5</far><aspect_ratio>1.3</aspect_ratio>
      <horizontal_fov>1</horizontal_fov></logical_camera>""",
}
JOINT_SENSORS = {
    "force_torque": f"<force_torque><force><x>{NOISE}</x></force><torque><z>{DATA_SHEET}</z></torque></force_torque>",
    "encoder": f"""<encoder><resolution>0.001</resolution><absolute>0</absolute><position>{NOISE}</position><velocity>
      <window>0.05</window><resolution>0.01</resolution>{DATA_SHEET}</velocity></encoder>""",
    "encoder ": "<encoder><counts_per_revolution>4096</counts_per_revolution></encoder>",
}
OUR_OWN = ("encoder", "solar", "dvl")
ODOMETRY_NOISE = """<odometry_noise><wheel_variance>1e-4</wheel_variance><left_radius_error>0.01</left_radius_error>
      <right_radius_error>-0.01</right_radius_error><separation_error>0.02</separation_error><counts_per_revolution>1000
      </counts_per_revolution></odometry_noise>"""
SUN = """<light name="sun" type="directional"><irradiance>800</irradiance></light><plugin filename="simkit-sun"
  name="simkit::Sun"><start>2024-06-21T10:30:00Z</start><time_scale>100</time_scale><latitude_deg>46</latitude_deg>
  <longitude_deg>6</longitude_deg><elevation>400</elevation><heading_deg>10</heading_deg><irradiance>900</irradiance>
  <pressure>96000</pressure><temperature>290</temperature><update_rate>10</update_rate></plugin>"""
PLACE = """<spherical_coordinates><latitude_deg>46.5</latitude_deg><longitude_deg>6.6</longitude_deg>
  <elevation>400</elevation></spherical_coordinates>"""
DRIVE = "<left_joint>a</left_joint><right_joint>b</right_joint>"
_FOUR = "".join(
    f'<link name="w{n}"/><joint name="{n}" type="revolute"><parent>l</parent><child>w{n}</child><axis/></joint>'
    for n in "abcd"
)
MECANUM = f"""<link name="l"/>{_FOUR}<plugin filename="gz-sim-mecanum-drive-system" name="p">
  <front_left_joint>a</front_left_joint><front_right_joint>b</front_right_joint><back_left_joint>c</back_left_joint>
  <back_right_joint>d</back_right_joint><wheel_separation>1</wheel_separation><wheelbase>1</wheelbase>
  <wheel_radius>0.1</wheel_radius><odom_publish_frequency>50</odom_publish_frequency></plugin>"""
SLIP = f"""<link name="l"/><link name="w">{MASS}<collision name="c">{BOX}</collision></link><joint name="a"
  type="revolute"><parent>l</parent><child>w</child><axis/></joint><plugin filename="gz-sim-wheel-slip-system" name="p">
  <wheel link_name="w"><slip_compliance_lateral>1</slip_compliance_lateral><wheel_normal_force>10</wheel_normal_force>
  <slip_compliance_longitudinal>1</slip_compliance_longitudinal><wheel_radius>0.1</wheel_radius></wheel></plugin>"""
PLUGINS = {
    "gz-sim-diff-drive-system": f"""{DRIVE}<wheel_separation>1</wheel_separation><wheel_radius>0.1</wheel_radius>
      <odom_publish_frequency>50</odom_publish_frequency><max_velocity>1</max_velocity><min_velocity>-1</min_velocity>
      <min_linear_acceleration>-1</min_linear_acceleration><max_linear_acceleration>1</max_linear_acceleration>
      <max_angular_jerk>1</max_angular_jerk>""",
    "gz-sim-diff-drive-system ": f"""{DRIVE}<wheel_separation>1</wheel_separation><wheel_radius>0.1</wheel_radius>
      {ODOMETRY_NOISE}""",
    "gz-sim-ackermann-steering-system": f"""{DRIVE}<left_steering_joint>a</left_steering_joint>
      <right_steering_joint>b</right_steering_joint><wheel_base>1</wheel_base><kingpin_width>1</kingpin_width>
      <wheel_separation>1</wheel_separation><wheel_radius>0.1</wheel_radius><steering_limit>0.5</steering_limit>
      <steer_p_gain>1</steer_p_gain><steer_i_gain>0</steer_i_gain><steer_d_gain>0</steer_d_gain>
      <steer_i_max>0</steer_i_max><steer_i_min>0</steer_i_min><steer_cmd_max>10</steer_cmd_max>
      <steer_cmd_min>-10</steer_cmd_min><steer_cmd_offset>0</steer_cmd_offset>""",
    "gz-sim-ackermann-steering-system ": """<steering_only>1</steering_only><use_actuator_msg>1</use_actuator_msg>
      <actuator_number>0</actuator_number><left_steering_joint>a</left_steering_joint>
      <right_steering_joint>b</right_steering_joint>""",
    "gz-sim-touchplugin-system": """<target>l</target><time>0.1</time><namespace>n</namespace><enabled>1</enabled>""",
    "gz-sim-linearbatteryplugin-system": """<battery_name>b</battery_name><voltage>12</voltage><capacity>1</capacity>
      <open_circuit_voltage_constant_coef>12</open_circuit_voltage_constant_coef><initial_charge>1</initial_charge>
      <open_circuit_voltage_linear_coef>-3</open_circuit_voltage_linear_coef><resistance>0.06</resistance>
      <smooth_current_tau>1</smooth_current_tau><power_load>5</power_load><enable_recharge>1</enable_recharge>
      <charging_time>1</charging_time><start_draining>1</start_draining>""",
    "libLinearBatteryPlugin.so": """<link_name>l</link_name><battery_name>b</battery_name><capacity>1</capacity>
      <open_circuit_voltage_constant_coef>12</open_circuit_voltage_constant_coef><initial_charge>1</initial_charge>
      <open_circuit_voltage_linear_coef>-3</open_circuit_voltage_linear_coef><resistance>0.06</resistance>
      <smooth_current_tau>1</smooth_current_tau>""",
    "gz-sim-kinetic-energy-monitor-system": """<link_name>l</link_name>
      <kinetic_energy_threshold>1</kinetic_energy_threshold>""",
    "gz-sim-performer-detector-system": """<geometry><box><size>1 1 1</size></box></geometry>
      <pose>0 0 1 0 0 0</pose>""",
    "gz-sim-joint-controller-system": """<joint_name>a</joint_name><initial_velocity>1</initial_velocity>
      <use_force_commands>1</use_force_commands><p_gain>1</p_gain><i_gain>1</i_gain><d_gain>1</d_gain><i_max>1</i_max>
      <i_min>-1</i_min><cmd_max>1</cmd_max><cmd_min>-1</cmd_min><cmd_offset>0</cmd_offset>""",
    "gz-sim-joint-controller-system ": """<joint_name>a</joint_name><use_actuator_msg>1</use_actuator_msg>
      <actuator_number>0</actuator_number>""",
    "gz-sim-joint-position-controller-system": """<joint_name>a</joint_name><joint_index>0</joint_index>
      <initial_position>1</initial_position><p_gain>1</p_gain><i_gain>1</i_gain><d_gain>1</d_gain><i_max>1</i_max>
      <i_min>-1</i_min><cmd_max>1</cmd_max><cmd_min>-1</cmd_min><cmd_offset>0</cmd_offset>""",
    "gz-sim-joint-position-controller-system ": """<joint_name>a</joint_name><initial_position>1</initial_position>
      <use_velocity_commands>1</use_velocity_commands><cmd_max>1</cmd_max>""",
    "gz-sim-joint-trajectory-controller-system": """<joint_name>a</joint_name><initial_position>1</initial_position>
      <position_p_gain>1</position_p_gain><position_i_gain>1</position_i_gain><position_d_gain>1</position_d_gain>
      <position_i_max>1</position_i_max><position_i_min>-1</position_i_min><velocity_cmd_max>1</velocity_cmd_max>
      <velocity_cmd_min>-1</velocity_cmd_min><velocity_cmd_offset>0</velocity_cmd_offset>""",
    "libgazebo_ros_joint_pose_trajectory.so": "<update_rate>100</update_rate>",
    "gz-sim-odometry-publisher-system": """<odom_publish_frequency>50</odom_publish_frequency>
      <xyz_offset>0 0 0</xyz_offset><rpy_offset>0 0 0</rpy_offset><dimensions>3</dimensions>
      <gaussian_noise>0.1</gaussian_noise>""",
    "gz-sim-apply-link-wrench-system": """<persistent><entity_name>m::l</entity_name><entity_type>link</entity_type>
      <force>1 0 0</force><torque>0 0 1</torque></persistent>""",
    "gz-sim-lift-drag-system": """<link_name>l</link_name><cla>4</cla><cda>0.1</cda><cma>0.1</cma>
      <alpha_stall>0.3</alpha_stall><cla_stall>-1</cla_stall><cda_stall>1</cda_stall><cma_stall>0</cma_stall><a0>0.1</a0>
      <air_density>1.2</air_density>
      <area>1</area><cp>0 0 0</cp><forward>1 0 0</forward><upward>0 0 1</upward><radial_symmetry>0</radial_symmetry>
      <reversible>1</reversible><control_joint_name>a</control_joint_name><cm_delta>0.1</cm_delta>
      <control_joint_rad_to_cl>4</control_joint_rad_to_cl>""",
    "libBuoyancyPlugin.so": """<fluid_density>1000</fluid_density><link name="l"><volume>1</volume>
      <center_of_volume>0 0 0</center_of_volume></link>""",
    "gz-sim-track-controller-system": """<link>l</link><track_orientation>0 0 1</track_orientation>
      <odometry_publish_frequency>50</odometry_publish_frequency><max_command_age>1</max_command_age>
      <min_velocity>-1</min_velocity><max_velocity>1</max_velocity><min_acceleration>-1</min_acceleration>
      <max_acceleration>1</max_acceleration><min_jerk>-1</min_jerk><max_jerk>1</max_jerk><debug>0</debug>""",
    "gz-sim-tracked-vehicle-system": """<left_track><link>l</link></left_track><right_track><link>l</link></right_track>
      <tracks_separation>1</tracks_separation><tracks_height>0.2</tracks_height>
      <steering_efficiency>0.5</steering_efficiency><odom_publish_frequency>50</odom_publish_frequency>
      <linear_velocity><max_velocity>1</max_velocity></linear_velocity>
      <angular_velocity><min_acceleration>-1</min_acceleration></angular_velocity><debug>0</debug>""",
    "libSimpleTrackedVehiclePlugin.so": """<body>l</body><left_track>l</left_track><right_track>l</right_track>
      <steering_efficiency>0.5</steering_efficiency><tracks_separation>0.4</tracks_separation>
      <max_linear_speed>1</max_linear_speed><max_angular_speed>1</max_angular_speed><track_mu>1</track_mu>
      <track_mu2>0.5</track_mu2><collide_without_contact_bitmask>1</collide_without_contact_bitmask>""",
    "gz-sim-joint-state-publisher-system": "<update_rate>50</update_rate>",
    "libgazebo_ros_joint_state_publisher.so": "<update_rate>50</update_rate><joint_name>a</joint_name>",
    "libgazebo_ros_diff_drive.so": f"""{DRIVE}<num_wheel_pairs>1</num_wheel_pairs><wheel_separation>1</wheel_separation>
      <wheel_diameter>0.1</wheel_diameter><max_wheel_torque>20</max_wheel_torque><update_rate>50</update_rate>
      <max_wheel_acceleration>1</max_wheel_acceleration><odometry_source>1</odometry_source><publish_odom>1</publish_odom>
      <covariance_x>0.1</covariance_x><covariance_y>0.1</covariance_y><covariance_yaw>0.1</covariance_yaw>""",
    "libsolar_sensor.so": """<light_name>sun</light_name><rpy_noise>0.1</rpy_noise>
      <update_rate>50</update_rate>""",
    "gz-sim-trajectory-follower-system": """<link_name>l</link_name><force>1</force><torque>1</torque><loop>1</loop>
      <range_tolerance>0.5</range_tolerance><bearing_tolerance>2</bearing_tolerance><zero_vel_on_bearing_reached>1
      </zero_vel_on_bearing_reached><waypoints><waypoint>1 2</waypoint></waypoints>""",
    "gz-sim-trajectory-follower-system ": "<link_name>l</link_name><circle><radius>2</radius></circle>",
    "gz-sim-trajectory-follower-system  ": """<link_name>l</link_name><line><direction>1</direction><length>2</length>
      </line>""",
    "gz-sim-drive-to-pose-controller-system": """<linear_p_gain>1</linear_p_gain><angular_p_gain>2</angular_p_gain>
      <linear_deviation>0.1</linear_deviation><angular_deviation>0.05</angular_deviation>""",
    "libgazebo_ros_elevator.so": """<lift_joint>a</lift_joint><door_joint>b</door_joint><floor_height>3</floor_height>
      <door_wait_time>5</door_wait_time><bottom_floor>0</bottom_floor><top_floor>4</top_floor>""",
    "libgazebo_ros_vacuum_gripper.so": "<link_name>l</link_name><max_distance>0.1</max_distance>",
    "libgazebo_ros_vacuum_gripper.so ": """<bodyName>l</bodyName><topicName>t</topicName><maxDistance>0.1</maxDistance>
      <maxForce>20</maxForce><minDistance>0.01</minDistance>""",
    "libgazebo_ros_hand_of_god.so": "<link_name>l</link_name><kl>200</kl><ka>200</ka>",
}
_COURSE = f"<time_for_rise>1</time_for_rise>{NOISE}"
_FLOATING = f"""<model name="m"><link name="l"><enable_wind>1</enable_wind>{MASS}
  <collision name="c">{BOX}</collision></link></model><plugin name="p" """
AIR = {
    "wind": f"""{_FLOATING} filename="gz-sim-wind-effects-system"><horizontal><magnitude>{_COURSE}<sin>
      <amplitude_percent>0.1</amplitude_percent><period>9</period></sin></magnitude><direction>{_COURSE}<sin>
      <amplitude>5</amplitude><period>9</period></sin></direction></horizontal><vertical>{_COURSE}</vertical>
      <force_approximation_scaling_factor><when xge="-9" xlt="9"><k>1</k><px>0 0 0 1</px><qy>0 1 0 1</qy>
      <rz>0 0 0 1</rz></when></force_approximation_scaling_factor></plugin>""",
    "wind factor": f"""{_FLOATING} filename="gz-sim-wind-effects-system"><force_approximation_scaling_factor>2
      </force_approximation_scaling_factor></plugin>""",
    "water": f"""{_FLOATING} filename="gz-sim-buoyancy-system">
      <uniform_fluid_density>1000</uniform_fluid_density></plugin>""",
    "sea": f"""{_FLOATING} filename="gz-sim-buoyancy-system"><graded_buoyancy><default_density>1000</default_density>
      <density_change><above_depth>0</above_depth><density>1</density></density_change></graded_buoyancy></plugin>""",
}
WORLD = """<physics name="p"><max_step_size>0.001</max_step_size><real_time_factor>1</real_time_factor>
  <real_time_update_rate>1000</real_time_update_rate><update_rate>1000</update_rate><max_contacts>10</max_contacts><ode><solver><iters>50</iters>
  <sor>1.3</sor></solver><constraints><cfm>0</cfm><erp>0.2</erp></constraints></ode></physics>
  <gravity>0 0 -9.8</gravity><magnetic_field>0 0 0</magnetic_field><wind><linear_velocity>1 0 0</linear_velocity></wind>
  <atmosphere type="adiabatic"><temperature>288</temperature><temperature_gradient>-0.0065</temperature_gradient>
  <pressure>101325</pressure></atmosphere><scene><ambient>1 1 1 1</ambient><background>1 1 1 1</background>
  <fog><type>linear</type><color>1 1 1 1</color><start>1</start><end>9</end><density>0.1</density></fog></scene>
  <spherical_coordinates><surface_model>CUSTOM_SURFACE</surface_model><latitude_deg>1</latitude_deg>
  <longitude_deg>1</longitude_deg><elevation>1</elevation><heading_deg>0</heading_deg>
  <surface_axis_equatorial>1</surface_axis_equatorial><surface_axis_polar>1</surface_axis_polar></spherical_coordinates>
  <model name="m"><link name="l"/></model>"""
CAN = '<model name="{}"><link name="l"/></model><model_count>2</model_count><pose>0 0 0 0 0 0</pose>'
POPULATION = f"""<population name="many">{CAN.format("can")}<box><size>1 1 1</size></box><distribution>
  <type>random</type></distribution></population>
  <population name="grid">{CAN.format("tin")}<distribution><type>grid</type><rows>1</rows>
  <cols>2</cols><step>1 1 0</step></distribution></population><population name="round">{CAN.format("pot")}
  <cylinder><radius>1</radius><length>1</length></cylinder>
  <distribution><type>uniform</type></distribution></population>"""
STATE = f"""<model name="m"><link name="l"/></model><state world_name="w"><sim_time>1 0</sim_time>
  <iterations>1</iterations>
  <model name="m">{POSE}<scale>1 1 1</scale><link name="l">{POSE}<velocity>0 0 0 0 0 0</velocity>
  <acceleration>0 0 0 0 0 0</acceleration><wrench>0 0 0 0 0 0</wrench></link></model></state>"""
OLD_STATE = f"""<model name="m"><link name="l"/></model>{LIGHT}<state world_name="w"><real_time>1 0</real_time>
  <wall_time>1 0  </wall_time><model_state name="m">{POSE}<link_state name="l">{POSE}</link_state></model_state>
  <light_state name="LAMP">{POSE}</light_state></state><frame name="g">{POSE}</frame>"""
ACTOR = f"""<actor name="walker">{POSE}<skin><filename>w.dae</filename><scale>1</scale></skin><animation name="walk">
  <filename>w.dae</filename><scale>1</scale><interpolate_x>1</interpolate_x></animation><script>
  <loop>1</loop><auto_start>1</auto_start><delay_start>0</delay_start><trajectory id="0" type="walk">
  <tension>0</tension><waypoint><time>0</time>{POSE}</waypoint></trajectory></script><simkit:person><height>1.7</height>
  <shirt>0.1 0.2 0.3</shirt><trousers>0.1 0.2 0.3</trousers><skin>0.8 0.6 0.5</skin><hair>0.1 0.1 0.1</hair>
  </simkit:person></actor>"""
ELEVATOR = """<link name="l"/><link name="floor_0"/><link name="w"/><joint name="lift" type="prismatic">
  <parent>l</parent><child>w</child><axis/></joint><joint name="door_0" type="prismatic"><parent>l</parent>
  <child>floor_0</child><axis><limit><upper>1</upper></limit></axis></joint><plugin name="p"
  filename="gz-sim-elevator-system"><update_rate>10</update_rate><state_publish_rate>5</state_publish_rate>
  <open_door_wait_duration>5</open_door_wait_duration></plugin>"""
FOLLOWER = """<model name="m"><static>1</static><link name="l"/></model><actor name="walker"><plugin name="p"
  filename="gz-sim-follow-actor-system"><target>m</target><velocity>1</velocity><min_distance>1</min_distance>
  <max_distance>4</max_distance><animation_x_vel>2</animation_x_vel></plugin></actor>"""
ROBOT = """<robot name="r"><material name="red"><color rgba="1 0 0 1"/></material>
<link name="base"><inertial><origin xyz="0 0 0" rpy="0 0 0"/><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0 0 0" quat_xyzw="0 0 0 1"/><geometry><box size="1 1 1"/></geometry></collision>
<collision><geometry><cylinder radius="1" length="1"/></geometry></collision>
<collision><geometry><capsule radius="1" length="1"/></geometry></collision>
<visual><geometry><sphere radius="1"/></geometry><material name="red"/></visual>
<visual><geometry><mesh filename="a.obj" scale="1 1 1"/></geometry></visual></link>
<link name="arm"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
<link name="tip"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
<joint name="j" type="revolute"><origin xyz="0 0 1" rpy="0 0 0"/><parent link="base"/><child link="arm"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="10" velocity="1"/><dynamics damping="0.1" friction="0.1"/>
<safety_controller soft_lower_limit="-1" soft_upper_limit="1" k_position="1" k_velocity="1"/>
<calibration rising="0" falling="0"/></joint>
<joint name="k" type="prismatic"><parent link="arm"/><child link="tip"/><axis xyz="1 0 0"/>
<limit lower="-1" upper="1" effort="10" velocity="1"/><mimic joint="j" multiplier="1" offset="0"/></joint>
<transmission name="t"><type>transmission_interface/SimpleTransmission</type><joint name="j"><offset>0</offset></joint>
<actuator name="x"><mechanicalReduction>50</mechanicalReduction></actuator></transmission>
<gazebo reference="arm"><mu1>1</mu1><mu2>1</mu2><fdir1>1 0 0</fdir1><kp>1e6</kp><kd>1</kd><minDepth>0.001</minDepth>
<maxVel>0.1</maxVel><softCfm>0</softCfm><softErp>0.2</softErp><laserRetro>1</laserRetro><dampingFactor>0.1</dampingFactor>
<gravity>1</gravity><selfCollide>0</selfCollide></gazebo>
<gazebo reference="j"><springStiffness>1</springStiffness><springReference>0</springReference>
<stopCfm>0</stopCfm><stopErp>0.2</stopErp><implicitSpringDamper>1</implicitSpringDamper></gazebo></robot>"""
OBJ = b"o x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
COMPANIONS = {"a.png": picture("PNG", "L"), "a.obj": OBJ}


@dataclass(frozen=True)
class Place:
    """One element or attribute with a number in it.

    Attributes:
        document: name of the document.
        path: element names from the root, an attribute with `@`.
        index: which of the document's places it is.
    """

    document: str
    path: str
    index: int

    def __str__(self) -> str:
        return f"{self.document}: {self.path}"


@cache
def documents() -> dict[str, str]:
    """Name -> a document that loads; the name ends with the suffix of its file."""
    found = {
        "world.sdf": _world(WORLD),
        "population.sdf": _world(POPULATION),
        "state.sdf": _world(STATE),
        "old state.sdf": _world(OLD_STATE),
        "actor.sdf": _world(ACTOR),
        "follower.sdf": _world(FOLLOWER),
        "elevator.sdf": _model(ELEVATOR),
        "mecanum.sdf": _model(MECANUM),
        "slip.sdf": _model(SLIP),
        "light.sdf": _world(LIGHT),
        "include.sdf": _world("<include><uri>model://sun</uri><pose>0 0 1 0 0 0</pose><static>1</static></include>"),
        "robot.urdf": ROBOT,
        "link.sdf": _model(
            f"""<link name="l"><pose>0 0 0 0 0 0</pose><inertial><pose>0 0 0 0 0 0</pose><mass>1</mass><inertia>
            <ixx>1</ixx><iyy>1</iyy><izz>1</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia><fluid_added_mass><xx>1</xx>
            </fluid_added_mass></inertial><velocity_decay><linear>0.1</linear><angular>0.1</angular></velocity_decay>
            <collision name="c">{BOX}{SURFACE}<laser_retro>0</laser_retro><max_contacts>1</max_contacts></collision>
            <gravity>1</gravity></link>"""
        ),
        "auto.sdf": _model(
            f"""<link name="l"><inertial auto="true"><density>2</density></inertial><collision name="c">
            <pose>1 0 0 0 0 0            </pose>{BOX}<density>3</density></collision></link>"""
        ),
        "visual.sdf": _model(
            f"""<link name="l"><visual name="v">{POSE}{BOX}{MATERIAL}<transparency>0.5</transparency><visibility_flags>1
            </visibility_flags><laser_retro>0</laser_retro></visual></link>"""
        ).replace("<specular>1 1 1 1", "<shininess>1</shininess><render_order>0</render_order><specular>1 1 1 1"),
    }
    for shape in SHAPES:
        name = shape[1:].partition(">")[0].split()[0].strip("/")
        solid = f'<collision name="c"><geometry>{shape}</geometry></collision>'
        drawn = f'<visual name="v"><geometry>{shape}</geometry></visual>'
        text = _model(f'<static>{int(name == "heightmap")}</static><link name="l">{MASS}{solid}{drawn}</link>')
        found[f"{name}.sdf"] = text
        if name != "heightmap":
            found[f"{name} auto.sdf"] = _model(f'<link name="l"><inertial auto="true"/>{solid}</link>')
    inside = {
        "screw": "<thread_pitch>1</thread_pitch><screw_thread_pitch>1</screw_thread_pitch>",
        "gearbox": "<gearbox_ratio>2</gearbox_ratio><gearbox_reference_body>a</gearbox_reference_body>",
    }
    for kind in ("revolute", "prismatic", "universal", "revolute2", "screw", "gearbox", "ball"):
        axis = AXIS.replace('joint="{leader}"', 'joint="leader"')
        second = f"<axis2>{axis}</axis2>" if kind in ("universal", "revolute2", "gearbox") else ""
        found[f"{kind}.sdf"] = _model(
            f"""<link name="a"/><link name="b"/><link name="c"/><joint name="leader" type="revolute"><parent>b</parent>
            <child>c</child><axis/></joint><joint name="j" type="{kind}"><parent>a</parent><child>b</child>{POSE}
            <axis>{axis}</axis>{second}{inside.get(kind, "")}</joint>"""
        )
    found["sun.sdf"] = _world(SUN)
    found |= {f"{name}.sdf": _world(text) for name, text in AIR.items()}
    for kind, block in {**SENSORS, **JOINT_SENSORS}.items():
        plain = kind.strip()
        name = f'type="custom" gz:type="{plain}"' if plain in OUR_OWN else f'type="{plain}"'
        sensor = f'<sensor name="s" {name}>{POSE}<update_rate>2</update_rate><always_on>1</always_on>{block}</sensor>'
        around = SUN if plain == "solar" else PLACE if plain in ("navsat", "magnetometer") else ""
        if kind in JOINT_SENSORS:
            joint = f'<joint name="j" type="revolute"><parent>l</parent><child>k</child><axis/>{sensor}</joint>'
            model = f'<model name="m"><link name="l"/><link name="k"/>{joint}</model>'
        else:
            model = f'<model name="m"><link name="l">{sensor}</link></model>'
        found[f"{kind} sensor.sdf"] = _world(around + model)
    for filename, block in PLUGINS.items():
        moving = "".join(
            f'<link name="w{n}"/><joint name="{n}" type="revolute"><parent>l</parent><child>w{n}</child><axis/></joint>'
            for n in "ab"
        )
        plugin = f'<plugin name="p" filename="{filename.strip()}">{block}</plugin>'
        model = f'<model name="m"><link name="l"/>{moving}'
        at = f"{model}</model>{plugin}" if "wrench" in filename else f"{model}{plugin}</model>"
        found[f"{filename}.sdf"] = _world(f'<light name="sun" type="directional"/>{at}')
    return found


def places() -> list[Place]:
    """Every number of every document."""
    found = []
    for name, text in documents().items():
        found += [
            Place(name, path, index) for index, (path, _) in enumerate(_spots(etree.fromstring(text, _lenient())))
        ]
    return found


def with_value(place: Place, value: str) -> bytes:
    """The document with another text at a place; of several numbers only the last becomes another one."""
    root = etree.fromstring(documents()[place.document], _lenient())
    _, (element, attribute) = list(_spots(root))[place.index]
    old = (element.text if attribute is None else element.get(attribute)) or ""
    parts = old.split()
    is_number = value not in ("", "text", "1 2")
    new = " ".join([*parts[:-1], value]) if is_number and len(parts) > 1 else value
    if attribute is None:
        element.text = new
    else:
        element.set(attribute, new)
    return bytes(etree.tostring(root))


def _spots(root: etree._Element) -> Iterator[tuple[str, tuple[etree._Element, str | None]]]:
    for element in root.iter():
        if not isinstance(element.tag, str):
            continue
        path = "/".join([*(str(a.tag) for a in reversed(list(element.iterancestors()))), element.tag])
        if len(element) == 0 and element.text and NUMBERS.fullmatch(element.text):
            yield path, (element, None)
        for name, value in element.attrib.items():
            if NUMBERS.fullmatch(str(value)) and name not in ("version", "name"):
                yield f"{path}@{name}", (element, str(name))


def _lenient() -> etree.XMLParser:
    return etree.XMLParser(recover=True, resolve_entities=False)


def _world(content: str) -> str:
    return f'<sdf version="1.11"><world name="w">{content}</world></sdf>'


def _model(content: str) -> str:
    return _world(f'<model name="m">{content}</model>')
