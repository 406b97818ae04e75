"""gz.msgs as far as simkit's topics carry it: `from gz.msgs10.twist_pb2 import Twist` and their like.

The classes behave as those protobuf makes, but for wire formats: nothing here is written as bytes.
"""

from __future__ import annotations

import re
from typing import Any, Final

from simkit.plugins.gz_python.math.missing_names import missing_name_error
from simkit.plugins.gz_python.msgs.message import MESSAGE_CLASSES, Message, define_messages

_DEFINITIONS: Final = """
Time sec:i nsec:i
Map key:s value:s[]
Header stamp:Time data:Map[]
Boolean header:Header data:b
Double header:Header data:f
Float header:Header data:f
Int32 header:Header data:i
UInt32 header:Header data:i
Int64 header:Header data:i
Float_V header:Header data:f[]
Int32_V header:Header data:i[]
Double_V header:Header data:f[]
StringMsg header:Header data:s
Empty unused:b
Color header:Header r:f g:f b:f a:f
Vector2d header:Header x:f y:f
Vector3d header:Header x:f y:f z:f
Quaternion header:Header x:f y:f z:f w:f
Pose header:Header name:s id:i position:Vector3d orientation:Quaternion
Pose_V header:Header pose:Pose[]
Twist header:Header linear:Vector3d angular:Vector3d
Wrench header:Header force:Vector3d torque:Vector3d force_offset:Vector3d
Clock header:Header system:Time real:Time sim:Time
Odometry header:Header pose:Pose twist:Twist
IMU header:Header entity_name:s orientation:Quaternion angular_velocity:Vector3d linear_acceleration:Vector3d
LaserScan header:Header frame:s angle_min:f angle_max:f angle_step:f range_min:f range_max:f count:i vertical_count:i ranges:f[] intensities:f[]
NavSat header:Header latitude_deg:f longitude_deg:f altitude:f velocity_east:f velocity_north:f velocity_up:f frame_id:s
Magnetometer header:Header field_tesla:Vector3d
FluidPressure header:Header pressure:f variance:f
Altimeter header:Header vertical_position:f vertical_velocity:f vertical_reference:f
BatteryState header:Header voltage:f current:f charge:f capacity:f percentage:f power_supply_status:i
Axis xyz:Vector3d position:f velocity:f force:f
Joint header:Header name:s id:i parent:s child:s pose:Pose axis1:Axis axis2:Axis
Model header:Header name:s id:i joint:Joint[] pose:Pose
Actuators header:Header position:f[] velocity:f[] normalized:f[]
Entity header:Header id:i name:s type:i
EntityWrench header:Header entity:Entity wrench:Wrench
JointWrench header:Header body_1_name:s body_1_id:i body_2_name:s body_2_id:i body_1_wrench:Wrench body_2_wrench:Wrench
Contact header:Header collision1:Entity collision2:Entity position:Vector3d[] depth:f[] wrench:JointWrench[] normal:Vector3d[]
Contacts header:Header contact:Contact[]
Image header:Header width:i height:i pixel_format_type:i step:i data:y
EntityFactory header:Header sdf:s sdf_filename:s clone_name:s pose:Pose name:s allow_renaming:b
WorldReset header:Header all:b time_only:b model_only:b
WorldControl header:Header pause:b step:b multi_step:i reset:WorldReset seed:i run_to_sim_time:Time
"""  # noqa: E501
define_messages(_DEFINITIONS)
_ENTITY_TYPES: Final = ("NONE", "LIGHT", "MODEL", "LINK", "VISUAL", "COLLISION", "SENSOR", "JOINT", "ACTOR", "WORLD")
for _number, _kind in enumerate(_ENTITY_TYPES):
    setattr(MESSAGE_CLASSES["Entity"], _kind, _number)  # as in `Entity.MODEL`
for _number, _kind in enumerate(("UNKNOWN", "CHARGING", "DISCHARGING", "NOT_CHARGING", "FULL")):
    setattr(MESSAGE_CLASSES["BatteryState"], _kind, _number)
_ONE_WORD: Final = ("LaserScan", "NavSat", "StringMsg")


def _file_of(name: str) -> str:
    apart = name if name in _ONE_WORD else re.sub("(?<=[a-z])(?=[A-Z])", "_", name)
    return f"{apart.lower()}_pb2"


_FILES: Final = {_file_of(name): name for name in MESSAGE_CLASSES if name != "Map"}
"""Module of gz.msgs -> the message it holds."""


def message_class(name: str) -> type[Message]:
    """A message class by name."""
    return MESSAGE_CLASSES[name]


def contents_of(module: str) -> dict[str, Any]:
    """What a module such as `twist_pb2` holds.

    Raises:
        ModuleNotFoundError: it is none that simkit has.
    """
    name = _FILES.get(module)
    if name is None:
        listed = ", ".join(sorted(_FILES))
        raise ModuleNotFoundError(f"simkit has no gz.msgs.{module}; it has {listed}", name=f"gz.msgs.{module}")
    return {name: MESSAGE_CLASSES[name], "__all__": [name]}


def __getattr__(name: str) -> Any:
    if name in MESSAGE_CLASSES:
        return MESSAGE_CLASSES[name]
    raise missing_name_error("gz.msgs", name, MESSAGE_CLASSES, {})
