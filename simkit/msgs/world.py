"""Messages and services about a world as a whole: its control, its entities, its state, as Gazebo's bridges type them.

The interfaces of `ros_gz_interfaces` and `gazebo_msgs` (as of ROS 2) are published ones: field names, types and order
are theirs. What gz offers and no published ROS interface carries is in `simkit_msgs`, made of published messages.
"""

from __future__ import annotations

MESSAGES: dict[str, str] = {
    "ros_gz_interfaces/msg/WorldReset": """
bool all
bool time_only
bool model_only
""",
    "ros_gz_interfaces/msg/WorldControl": """
bool pause
bool step
uint32 multi_step
ros_gz_interfaces/WorldReset reset
uint32 seed
builtin_interfaces/Time run_to_sim_time
""",
    "ros_gz_interfaces/msg/LogPlaybackStatistics": """
std_msgs/Header header
builtin_interfaces/Time start_time
builtin_interfaces/Time end_time
""",
    "ros_gz_interfaces/msg/WorldStatistics": """
std_msgs/Header header
builtin_interfaces/Time sim_time
builtin_interfaces/Time pause_time
builtin_interfaces/Time real_time
bool paused
uint64 iterations
int32 model_count
ros_gz_interfaces/LogPlaybackStatistics log_playback_statistics
float64 real_time_factor
builtin_interfaces/Time step_size
bool stepping
""",
    "ros_gz_interfaces/msg/EntityFactory": """
string name
bool allow_renaming
string sdf
string sdf_filename
string clone_name
geometry_msgs/Pose pose
string relative_to
""",
    "ros_gz_interfaces/msg/Light": """
uint8 POINT=0
uint8 SPOT=1
uint8 DIRECTIONAL=2
std_msgs/Header header
string name
uint8 type
geometry_msgs/Pose pose
std_msgs/ColorRGBA diffuse
std_msgs/ColorRGBA specular
float32 attenuation_constant
float32 attenuation_linear
float32 attenuation_quadratic
geometry_msgs/Vector3 direction
float32 range
bool cast_shadows
float32 spot_inner_angle
float32 spot_outer_angle
float32 spot_falloff
uint32 id
uint32 parent_id
float32 intensity
""",
    "ros_gz_interfaces/msg/MaterialColor": """
uint8 FIRST=0
uint8 ALL=1
std_msgs/Header header
ros_gz_interfaces/Entity entity
std_msgs/ColorRGBA ambient
std_msgs/ColorRGBA diffuse
std_msgs/ColorRGBA specular
std_msgs/ColorRGBA emissive
float64 shininess
uint8 entity_match
""",
    "gazebo_msgs/msg/EntityState": """
string name
geometry_msgs/Pose pose
geometry_msgs/Twist twist
string reference_frame
""",
    "gazebo_msgs/msg/ModelState": """
string model_name
geometry_msgs/Pose pose
geometry_msgs/Twist twist
string reference_frame
""",
    "gazebo_msgs/msg/LinkState": """
string link_name
geometry_msgs/Pose pose
geometry_msgs/Twist twist
string reference_frame
""",
    "gazebo_msgs/msg/ModelStates": """
string[] name
geometry_msgs/Pose[] pose
geometry_msgs/Twist[] twist
""",
    "gazebo_msgs/msg/LinkStates": """
string[] name
geometry_msgs/Pose[] pose
geometry_msgs/Twist[] twist
""",
    "gazebo_msgs/msg/ODEPhysics": """
bool auto_disable_bodies
uint32 sor_pgs_precon_iters
uint32 sor_pgs_iters
float64 sor_pgs_w
float64 sor_pgs_rms_error_tol
float64 contact_surface_layer
float64 contact_max_correcting_vel
float64 cfm
float64 erp
uint32 max_contacts
""",
    "gazebo_msgs/msg/ODEJointProperties": """
float64[] damping
float64[] hi_stop
float64[] lo_stop
float64[] erp
float64[] cfm
float64[] stop_erp
float64[] stop_cfm
float64[] fudge_factor
float64[] fmax
float64[] vel
""",
    "simkit_msgs/msg/Wind": """
std_msgs/Header header
geometry_msgs/Vector3 linear_velocity
bool enable_wind
""",
    "simkit_msgs/msg/SceneEntity": """
ros_gz_interfaces/Entity entity
string parent
geometry_msgs/Pose pose
bool is_static
""",
}

_GZ: dict[str, str] = {
    "ros_gz_interfaces/srv/ControlWorld": """
ros_gz_interfaces/WorldControl world_control
---
bool success
""",
    "ros_gz_interfaces/srv/SpawnEntity": """
ros_gz_interfaces/EntityFactory entity_factory
---
bool success
""",
    "ros_gz_interfaces/srv/DeleteEntity": """
ros_gz_interfaces/Entity entity
---
bool success
""",
    "ros_gz_interfaces/srv/SetEntityPose": """
ros_gz_interfaces/Entity entity
geometry_msgs/Pose pose
---
bool success
""",
}

_OWN: dict[str, str] = {
    "simkit_msgs/srv/SpawnEntities": """
ros_gz_interfaces/EntityFactory[] entity_factories
---
bool success
string status_message
""",
    "simkit_msgs/srv/SetEntityPoses": """
ros_gz_interfaces/Entity[] entities
geometry_msgs/Pose[] poses
---
bool success
string status_message
""",
    "simkit_msgs/srv/SetLight": """
ros_gz_interfaces/Light light
---
bool success
string status_message
""",
    "simkit_msgs/srv/SetWheelSlip": """
ros_gz_interfaces/Entity entity
float64 slip_compliance_lateral
float64 slip_compliance_longitudinal
---
bool success
string status_message
""",
    "simkit_msgs/srv/SetMaterialColor": """
ros_gz_interfaces/MaterialColor material_color
---
bool success
string status_message
""",
    "simkit_msgs/srv/EntityRequest": """
ros_gz_interfaces/Entity entity
---
bool success
string status_message
""",
    "simkit_msgs/srv/SetSphericalCoordinates": """
uint8 EARTH_WGS84=0
uint8 MOON_SCS=1
uint8 surface_model
float64 latitude_deg
float64 longitude_deg
float64 elevation
float64 heading_deg
ros_gz_interfaces/Entity entity
---
bool success
string status_message
""",
    "simkit_msgs/srv/WindInfo": """
---
simkit_msgs/Wind wind
geometry_msgs/Vector3 velocity
""",
    "simkit_msgs/srv/GenerateWorldSdf": """
---
bool success
string status_message
string sdf
""",
    "simkit_msgs/srv/GetScene": """
---
string name
std_msgs/Header header
simkit_msgs/SceneEntity[] entities
std_msgs/ColorRGBA ambient
std_msgs/ColorRGBA background
bool shadows
bool grid
bool sky
""",
}

_DONE = "bool success\nstring status_message\n"
_STATUS = f"---\n{_DONE}"
_WRENCH = """string reference_frame
geometry_msgs/Point reference_point
geometry_msgs/Wrench wrench
builtin_interfaces/Time start_time
builtin_interfaces/Duration duration
"""
_INERTIA = """geometry_msgs/Pose com
bool gravity_mode
float64 mass
float64 ixx
float64 ixy
float64 ixz
float64 iyy
float64 iyz
float64 izz
"""
_LIGHT = """std_msgs/ColorRGBA diffuse
float64 attenuation_constant
float64 attenuation_linear
float64 attenuation_quadratic
"""
_CLASSIC: dict[str, str] = {
    "gazebo_msgs/srv/SpawnEntity": f"""string name
string xml
string robot_namespace
geometry_msgs/Pose initial_pose
string reference_frame
{_STATUS}""",
    "gazebo_msgs/srv/SpawnModel": f"""string model_name
string model_xml
string robot_namespace
geometry_msgs/Pose initial_pose
string reference_frame
{_STATUS}""",
    "gazebo_msgs/srv/DeleteEntity": f"string name\n{_STATUS}",
    "gazebo_msgs/srv/DeleteModel": f"string model_name\n{_STATUS}",
    "gazebo_msgs/srv/GetModelList": "---\nstd_msgs/Header header\nstring[] model_names\nbool success\n",
    "gazebo_msgs/srv/GetWorldProperties": (
        f"---\nfloat64 sim_time\nstring[] model_names\nbool rendering_enabled\n{_DONE}"
    ),
    "gazebo_msgs/srv/GetEntityState": """string name
string reference_frame
---
std_msgs/Header header
gazebo_msgs/EntityState state
bool success
""",
    "gazebo_msgs/srv/SetEntityState": "gazebo_msgs/EntityState state\n---\nbool success\n",
    "gazebo_msgs/srv/GetModelState": f"""string model_name
string relative_entity_name
---
std_msgs/Header header
geometry_msgs/Pose pose
geometry_msgs/Twist twist
{_DONE}""",
    "gazebo_msgs/srv/SetModelState": f"gazebo_msgs/ModelState model_state\n{_STATUS}",
    "gazebo_msgs/srv/GetLinkState": f"""string link_name
string reference_frame
---
gazebo_msgs/LinkState link_state
{_DONE}""",
    "gazebo_msgs/srv/SetLinkState": f"gazebo_msgs/LinkState link_state\n{_STATUS}",
    "gazebo_msgs/srv/SetModelConfiguration": f"""string model_name
string urdf_param_name
string[] joint_names
float64[] joint_positions
{_STATUS}""",
    "gazebo_msgs/srv/GetModelProperties": f"""string model_name
---
string parent_model_name
string canonical_body_name
string[] body_names
string[] geom_names
string[] joint_names
string[] child_model_names
bool is_static
{_DONE}""",
    "gazebo_msgs/srv/GetJointProperties": f"""string joint_name
---
uint8 REVOLUTE=0
uint8 CONTINUOUS=1
uint8 PRISMATIC=2
uint8 FIXED=3
uint8 BALL=4
uint8 UNIVERSAL=5
uint8 type
float64[] damping
float64[] position
float64[] rate
{_DONE}""",
    "gazebo_msgs/srv/SetJointProperties": f"""string joint_name
gazebo_msgs/ODEJointProperties ode_joint_config
{_STATUS}""",
    "gazebo_msgs/srv/GetLinkProperties": f"string link_name\n---\n{_INERTIA}{_DONE}",
    "gazebo_msgs/srv/SetLinkProperties": f"string link_name\n{_INERTIA}{_STATUS}",
    "gazebo_msgs/srv/GetLightProperties": f"string light_name\n---\n{_LIGHT}{_DONE}",
    "gazebo_msgs/srv/SetLightProperties": f"string light_name\n{_LIGHT}{_STATUS}",
    "gazebo_msgs/srv/GetPhysicsProperties": f"""---
float64 time_step
bool pause
float64 max_update_rate
geometry_msgs/Vector3 gravity
gazebo_msgs/ODEPhysics ode_config
{_DONE}""",
    "gazebo_msgs/srv/SetPhysicsProperties": f"""float64 time_step
float64 max_update_rate
geometry_msgs/Vector3 gravity
gazebo_msgs/ODEPhysics ode_config
{_STATUS}""",
    "gazebo_msgs/srv/ApplyLinkWrench": f"string link_name\n{_WRENCH}{_STATUS}",
    "gazebo_msgs/srv/ApplyBodyWrench": f"string body_name\n{_WRENCH}{_STATUS}",
    "gazebo_msgs/srv/ApplyJointEffort": f"""string joint_name
float64 effort
builtin_interfaces/Time start_time
builtin_interfaces/Duration duration
{_STATUS}""",
    "gazebo_msgs/srv/LinkRequest": "string link_name\n---\n",
    "gazebo_msgs/srv/BodyRequest": "string body_name\n---\n",
    "gazebo_msgs/srv/JointRequest": "string joint_name\n---\n",
}

SERVICES: dict[str, str] = {**_GZ, **_OWN, **_CLASSIC}
