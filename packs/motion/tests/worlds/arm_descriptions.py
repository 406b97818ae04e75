"""Descriptions of the planar arm for MoveIt: URDF without shapes, and SRDF with groups and named states."""

from __future__ import annotations

_LINKS = ("foot", "upper", "lower", "hand", "tool", "left_finger_link", "right_finger_link")


def _joint(name: str, parent: str, child: str, kind: str = "revolute") -> str:
    limits = {"revolute": (-2.8, 2.8), "prismatic": (0.0, 0.04)}
    limit = "<limit lower='{}' upper='{}' effort='60' velocity='2'/>".format(*limits[kind]) if kind in limits else ""
    return f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>{limit}</joint>"


URDF = f"""<robot name="arm">
  {"".join(f"<link name='{link}'/>" for link in _LINKS)}
  {_joint("wrist", "lower", "hand")}{_joint("shoulder", "foot", "upper")}{_joint("elbow", "upper", "lower")}
  {_joint("tool_joint", "hand", "tool", "fixed")}
  {_joint("left_finger", "hand", "left_finger_link", "prismatic")}
  {_joint("right_finger", "hand", "right_finger_link", "prismatic")}
</robot>"""

SRDF = """<robot name="arm">
  <group name="manipulator"><chain base_link="foot" tip_link="hand"/></group>
  <group name="fingers"><joint name="right_finger"/><joint name="left_finger"/></group>
  <group name="whole"><group name="manipulator"/><group name="fingers"/></group>
  <group_state name="bent" group="manipulator">
    <joint name="shoulder" value="0.6"/><joint name="elbow" value="-0.8"/><joint name="wrist" value="0.3"/>
  </group_state>
  <group_state name="open" group="fingers">
    <joint name="left_finger" value="0.03"/><joint name="right_finger" value="0.03"/>
  </group_state>
  <end_effector name="gripper" parent_link="hand" group="fingers" parent_group="manipulator"/>
  <virtual_joint name="ground" type="fixed" parent_frame="world" child_link="foot"/>
  <disable_collisions link1="foot" link2="lower" reason="Never"/>
</robot>"""
