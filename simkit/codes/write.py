"""What another format has no word for."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import command

_MASS = '<inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'
_PLANAR = f"""<robot name="robot">
  <link name="base">{_MASS}</link>
  <link name="puck">{_MASS}</link>
  <joint name="table" type="planar"><parent link="base"/><child link="puck"/><axis xyz="0 0 1"/></joint>
</robot>
"""
_SAFE = f"""<robot name="robot">
  <link name="base">{_MASS}</link>
  <link name="arm">{_MASS}</link>
  <joint name="elbow" type="revolute">
    <parent link="base"/><child link="arm"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="10" velocity="1"/>
    <safety_controller k_velocity="10" soft_lower_limit="-0.9" soft_upper_limit="0.9"/>
  </joint>
</robot>
"""
_NEGATIVE = f"""<robot name="robot">
  <link name="base">{_MASS}</link>
  <link name="antenna">
    <inertial><mass value="1e-6"/><inertia ixx="1e-9" iyy="1e-9" izz="1e-9" ixy="3e-9" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="mount" type="fixed"><parent link="base"/><child link="antenna"/></joint>
</robot>
"""
_LINE = "simkit convert robot.urdf -o robot.sdf --verbose"

CODES: tuple[Code, ...] = (
    Code(
        "SK-WRITE-001",
        "warning",
        "a joint of a type that SDF does not have",
        "",
        command(_LINE, {"robot.urdf": _PLANAR}),
    ),
    Code(
        "SK-WRITE-002",
        "warning",
        "something that the format written has no word for; it is left out",
        "",
        command(_LINE, {"robot.urdf": _SAFE}),
    ),
    Code(
        "SK-WRITE-003",
        "warning",
        "a negative moment of inertia, which SDF refuses; the nearest one that it takes is written",
        "`simkit check --fix-inertia`",
        command(_LINE, {"robot.urdf": _NEGATIVE}),
    ),
)
