"""Gravity compensation."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import INERTIAL, model

_ROBOT = (
    f'<link name="base">{INERTIAL}</link>\n<link name="arm">{INERTIAL}</link>\n'
    '<joint name="shoulder" type="revolute"><parent>base</parent><child>arm</child>'
    "<axis><xyz>0 1 0</xyz></axis></joint>\n"
    '<plugin filename="libgz_ros2_control-system.so" name="gz_ros2_control::GazeboSimROS2ControlPlugin">\n'
    "  <parameters>arm.yaml</parameters>\n</plugin>"
)
_YAML = """controller_manager:
  ros__parameters:
    update_rate: 100
    weightless: {type: pal_controllers/GravityCompensationController}
weightless:
  ros__parameters:
    command_joints: [shoulder]
    control_type: [POSITION]
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-CONTROL-050",
        "error",
        "a gravity compensation controller has no joints, or control types that are not theirs",
        "name the joints in `command_joints`, and in `control_type` COMMAND or ZERO_TORQUE for each of them",
        model(_ROBOT, files={"arm.yaml": _YAML}),
    ),
)
