"""Definitions of the services that simkit offers, in the `.srv` form of ROS 2: the request, `---`, the response.

They are published interfaces: field names, types and order are theirs. A service of type `<package>/srv/<Name>` has
the messages `<package>/srv/<Name>_Request` and `<package>/srv/<Name>_Response`.
"""

from __future__ import annotations

from simkit.msgs import control, controller_manager, motions, world

SERVICES: dict[str, str] = {
    "std_srvs/srv/Empty": """
---
""",
    "std_srvs/srv/Trigger": """
---
bool success
string message
""",
    "std_srvs/srv/SetBool": """
bool data
---
bool success
string message
""",
    "rcl_interfaces/srv/GetParameters": """
string[] names
---
rcl_interfaces/ParameterValue[] values
""",
    "rcl_interfaces/srv/GetParameterTypes": """
string[] names
---
uint8[] types
""",
    "rcl_interfaces/srv/SetParameters": """
rcl_interfaces/Parameter[] parameters
---
rcl_interfaces/SetParametersResult[] results
""",
    "rcl_interfaces/srv/SetParametersAtomically": """
rcl_interfaces/Parameter[] parameters
---
rcl_interfaces/SetParametersResult result
""",
    "rcl_interfaces/srv/ListParameters": """
uint64 DEPTH_RECURSIVE=0
string[] prefixes
uint64 depth
---
rcl_interfaces/ListParametersResult result
""",
    "rcl_interfaces/srv/DescribeParameters": """
string[] names
---
rcl_interfaces/ParameterDescriptor[] descriptors
""",
    **control.SERVICES,
    **controller_manager.SERVICES,
    **world.SERVICES,
    **motions.SERVICES,
}
