"""Definitions of message types that rosbags' ROS 2 Jazzy store lacks, with the published fields in the published order.

Constants are part of a definition but not of its hash; field names, types and order are.
"""

from __future__ import annotations

DEFINITIONS: dict[str, str] = {
    "ros_gz_interfaces/msg/Entity": """
uint8 NONE=0
uint8 LIGHT=1
uint8 MODEL=2
uint8 LINK=3
uint8 VISUAL=4
uint8 COLLISION=5
uint8 SENSOR=6
uint8 JOINT=7
uint64 id
string name
uint8 type
""",
    "ros_gz_interfaces/msg/EntityWrench": """
std_msgs/Header header
ros_gz_interfaces/Entity entity
geometry_msgs/Wrench wrench
""",
    "ros_gz_interfaces/msg/JointWrench": """
std_msgs/Header header
std_msgs/String body_1_name
std_msgs/UInt32 body_1_id
std_msgs/String body_2_name
std_msgs/UInt32 body_2_id
geometry_msgs/Wrench body_1_wrench
geometry_msgs/Wrench body_2_wrench
""",
    "ros_gz_interfaces/msg/Contact": """
ros_gz_interfaces/Entity collision1
ros_gz_interfaces/Entity collision2
geometry_msgs/Vector3[] positions
geometry_msgs/Vector3[] normals
float64[] depths
ros_gz_interfaces/JointWrench[] wrenches
""",
    "ros_gz_interfaces/msg/Contacts": """
std_msgs/Header header
ros_gz_interfaces/Contact[] contacts
""",
    "gazebo_msgs/msg/WheelSlip": """
string[] name
float64[] lateral_slip
float64[] longitudinal_slip
""",
    "gazebo_msgs/msg/ContactState": """
string info
string collision1_name
string collision2_name
geometry_msgs/Wrench[] wrenches
geometry_msgs/Wrench total_wrench
geometry_msgs/Vector3[] contact_positions
geometry_msgs/Vector3[] contact_normals
float64[] depths
""",
    "gazebo_msgs/msg/ContactsState": """
std_msgs/Header header
gazebo_msgs/ContactState[] states
""",
    "ros_gz_interfaces/msg/Altimeter": """
std_msgs/Header header
float64 vertical_position
float64 vertical_velocity
float64 vertical_reference
""",
    "ros_gz_interfaces/msg/AirSpeed": """
std_msgs/Header header
float64 diff_pressure
float64 temperature
""",
    "ros_gz_interfaces/msg/LogicalCameraImageModel": """
string name
geometry_msgs/Pose pose
""",
    "ros_gz_interfaces/msg/LogicalCameraImage": """
std_msgs/Header header
geometry_msgs/Pose pose
ros_gz_interfaces/LogicalCameraImageModel[] model
""",
    "simkit_msgs/msg/LogicalCameraSensor": """
std_msgs/Header header
float64 near_clip
float64 far_clip
float64 horizontal_fov
float64 aspect_ratio
""",
    "ros_gz_interfaces/msg/Float32Array": """
float32[] data
""",
    "actuator_msgs/msg/Actuators": """
std_msgs/Header header
float64[] position
float64[] velocity
float64[] normalized
""",
    "gps_msgs/msg/GPSStatus": """
int16 STATUS_NO_FIX=-1
int16 STATUS_FIX=0
int16 STATUS_SBAS_FIX=1
int16 STATUS_GBAS_FIX=2
int16 STATUS_DGPS_FIX=18
int16 STATUS_RTK_FIX=19
int16 STATUS_RTK_FLOAT=20
int16 STATUS_WAAS_FIX=33
uint16 SOURCE_NONE=0
uint16 SOURCE_GPS=1
uint16 SOURCE_POINTS=2
uint16 SOURCE_DOPPLER=4
uint16 SOURCE_ALTIMETER=8
uint16 SOURCE_MAGNETIC=16
uint16 SOURCE_GYRO=32
uint16 SOURCE_ACCEL=64
std_msgs/Header header
uint16 satellites_used
int32[] satellite_used_prn
uint16 satellites_visible
int32[] satellite_visible_prn
int32[] satellite_visible_z
int32[] satellite_visible_azimuth
int32[] satellite_visible_snr
int16 status
uint16 motion_source
uint16 orientation_source
uint16 position_source
""",
    "gps_msgs/msg/GPSFix": """
uint8 COVARIANCE_TYPE_UNKNOWN=0
uint8 COVARIANCE_TYPE_APPROXIMATED=1
uint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2
uint8 COVARIANCE_TYPE_KNOWN=3
std_msgs/Header header
gps_msgs/GPSStatus status
float64 latitude
float64 longitude
float64 altitude
float64 track
float64 speed
float64 climb
float64 pitch
float64 roll
float64 dip
float64 time
float64 gdop
float64 pdop
float64 hdop
float64 vdop
float64 tdop
float64 err
float64 err_horz
float64 err_vert
float64 err_track
float64 err_speed
float64 err_climb
float64 err_time
float64 err_pitch
float64 err_roll
float64 err_dip
float64[9] position_covariance
uint8 position_covariance_type
""",
    "vision_msgs/msg/ObjectHypothesis": """
string class_id
float64 score
""",
    "vision_msgs/msg/ObjectHypothesisWithPose": """
vision_msgs/ObjectHypothesis hypothesis
geometry_msgs/PoseWithCovariance pose
""",
    "vision_msgs/msg/Point2D": """
float64 x
float64 y
""",
    "vision_msgs/msg/Pose2D": """
vision_msgs/Point2D position
float64 theta
""",
    "vision_msgs/msg/BoundingBox2D": """
vision_msgs/Pose2D center
float64 size_x
float64 size_y
""",
    "vision_msgs/msg/BoundingBox3D": """
geometry_msgs/Pose center
geometry_msgs/Vector3 size
""",
    "vision_msgs/msg/Detection2D": """
std_msgs/Header header
vision_msgs/ObjectHypothesisWithPose[] results
vision_msgs/BoundingBox2D bbox
string id
""",
    "vision_msgs/msg/Detection2DArray": """
std_msgs/Header header
vision_msgs/Detection2D[] detections
""",
    "vision_msgs/msg/Detection3D": """
std_msgs/Header header
vision_msgs/ObjectHypothesisWithPose[] results
vision_msgs/BoundingBox3D bbox
string id
""",
    "vision_msgs/msg/Detection3DArray": """
std_msgs/Header header
vision_msgs/Detection3D[] detections
""",
}
