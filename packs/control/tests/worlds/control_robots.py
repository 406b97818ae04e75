"""Small robots with control hardware, and files that declare their controllers."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import simkit

LINK = """
<link name="{name}">
  <inertial><origin xyz="0 0 0.25"/><mass value="1"/>
    <inertia ixx="0.02" iyy="0.02" izz="0.005" ixy="0" ixz="0" iyz="0"/></inertial>
</link>"""
JOINT = """
<joint name="{name}" type="{kind}">
  <origin xyz="0 0 {height}"/><parent link="{parent}"/><child link="{child}"/><axis xyz="0 1 0"/>
  <limit lower="-2" upper="2" effort="40" velocity="3"/>{more}
</joint>"""
ALL = ("position", "velocity", "effort")
CLASSIC = "libgazebo_ros2_control.so"


def interfaces(commands: tuple[str, ...], states: tuple[str, ...] = ALL) -> str:
    """Return the interfaces of one joint in `<ros2_control>`."""
    found = [f'<command_interface name="{name}"/>' for name in commands]
    return "".join(found + [f'<state_interface name="{name}"/>' for name in states])


def arm(
    hardware: str | None = None,
    plugin: str = "<parameters>arm.yaml</parameters>",
    library: str = CLASSIC,
    second: str = "",
    more: str = "",
) -> str:
    """Two links of 1 kg in a vertical plane, j1 at the world and j2 0.5 m above it.

    Args:
        hardware: inside `<ros2_control>`; both joints by position where not given; empty for no such block.
        plugin: inside the plugin.
        library: the plugin's file name.
        second: further elements of j2.
        more: further elements of the robot.
    """
    if hardware is None:
        hardware = "".join(f'<joint name="{j}">{interfaces(("position",))}</joint>' for j in ("j1", "j2"))
    block = (
        '<ros2_control name="arm" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>'
        f"{hardware}</ros2_control>"
    )
    return f"""<robot name="arm">
<link name="world"/>{LINK.format(name="l1")}{LINK.format(name="l2")}
{JOINT.format(name="j1", kind="revolute", height=0, parent="world", child="l1", more="")}
{JOINT.format(name="j2", kind="revolute", height=0.5, parent="l1", child="l2", more=second)}
{block if hardware else ""}{more}
<gazebo><plugin filename="{library}" name="control">{plugin}</plugin></gazebo>
</robot>"""


POSITIONS = """
controller_manager:
  ros__parameters:
    update_rate: 100
    joint_state_broadcaster:
      type: joint_state_broadcaster/JointStateBroadcaster
    arm_controller:
      type: position_controllers/JointGroupPositionController
arm_controller:
  ros__parameters:
    joints: [j1, j2]
"""


def files(folder: Path, robot: str, yaml: str = POSITIONS) -> Path:
    """Write the robot's file with its parameter file beside it."""
    (folder / "arm.yaml").write_text(dedent(yaml), encoding="utf-8")
    path = folder / "arm.urdf"
    path.write_text(robot, encoding="utf-8")
    return path


def opened(folder: Path, robot: str | None = None, yaml: str = POSITIONS) -> simkit.Simulation:
    """Load a robot."""
    return simkit.load(files(folder, arm() if robot is None else robot, yaml))


def command(sim: simkit.Simulation, controller: str, *values: float) -> None:
    """Send a command to a forward command controller."""
    data = list(values)
    sim.publish(f"/{controller}/commands", simkit.msgs.make("std_msgs/msg/Float64MultiArray", data=data))


def position(sim: simkit.Simulation, *joints: str) -> list[float]:
    """Return the positions of joints [rad or m]."""
    scoped = [name for joint in joints for name in sim.engine.names.joints if name.endswith(f"::{joint}")]
    return [float(sim.joint(name).position) for name in scoped]


def states(sim: simkit.Simulation, manager: str = "/controller_manager") -> dict[str, str]:
    """Return the state of each controller from the manager's service."""
    return {c.name: c.state for c in sim.call(f"{manager}/list_controllers").controller}


def reported_messages(sim: simkit.Simulation, code: str) -> list[str]:
    """Return the messages of one code, from the load and the run."""
    return [d.message for d in dict.fromkeys((*sim.diagnostics, *sim.engine.reports)) if d.code == code]
