"""Messages and services of the controller manager (`controller_manager_msgs`), as ROS 2 Humble has them.

`start_controllers` and `stop_controllers` are the older names of `activate_controllers` and `deactivate_controllers`,
and ROS 1's.
"""

from __future__ import annotations

MESSAGES: dict[str, str] = {
    "controller_manager_msgs/msg/ChainConnection": """
string name
string[] reference_interfaces
""",
    "controller_manager_msgs/msg/ControllerState": """
string name
string state
string type
string[] claimed_interfaces
string[] required_command_interfaces
string[] required_state_interfaces
bool is_chainable
bool is_chained
string[] reference_interfaces
controller_manager_msgs/ChainConnection[] chain_connections
""",
    "controller_manager_msgs/msg/HardwareInterface": """
string name
bool is_available
bool is_claimed
""",
    "controller_manager_msgs/msg/HardwareComponentState": """
string name
string type
string class_type
lifecycle_msgs/State state
controller_manager_msgs/HardwareInterface[] command_interfaces
controller_manager_msgs/HardwareInterface[] state_interfaces
""",
    "control_msgs/msg/InterfaceValue": """
string[] interface_names
float64[] values
""",
    "control_msgs/msg/DynamicJointState": """
std_msgs/Header header
string[] joint_names
control_msgs/InterfaceValue[] interface_values
""",
    "control_msgs/msg/JointControllerState": """
std_msgs/Header header
float64 set_point
float64 process_value
float64 process_value_dot
float64 error
float64 time_step
float64 command
float64 p
float64 i
float64 d
float64 i_clamp
bool antiwindup
""",
}

_NAME = "string name\n---\nbool ok\n"

SERVICES: dict[str, str] = {
    "controller_manager_msgs/srv/ListControllers": """---
controller_manager_msgs/ControllerState[] controller
""",
    "controller_manager_msgs/srv/ListControllerTypes": """---
string[] types
string[] base_classes
""",
    "controller_manager_msgs/srv/LoadController": _NAME,
    "controller_manager_msgs/srv/ConfigureController": _NAME,
    "controller_manager_msgs/srv/UnloadController": _NAME,
    "controller_manager_msgs/srv/ReloadControllerLibraries": "bool force_kill\n---\nbool ok\n",
    "controller_manager_msgs/srv/SwitchController": """string[] activate_controllers
string[] deactivate_controllers
string[] start_controllers
string[] stop_controllers
int32 strictness
int32 BEST_EFFORT=1
int32 STRICT=2
bool start_asap
bool activate_asap
builtin_interfaces/Duration timeout
---
bool ok
""",
    "controller_manager_msgs/srv/ListHardwareComponents": """---
controller_manager_msgs/HardwareComponentState[] component
""",
    "controller_manager_msgs/srv/ListHardwareInterfaces": """---
controller_manager_msgs/HardwareInterface[] command_interfaces
controller_manager_msgs/HardwareInterface[] state_interfaces
""",
    "controller_manager_msgs/srv/SetHardwareComponentState": """string name
lifecycle_msgs/State target_state
---
bool ok
lifecycle_msgs/State state
""",
}
