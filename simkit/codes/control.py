"""Controllers, their hardware and their parameter files."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import python

_INERTIAL = '<inertial><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'
_JOINT = '<joint name="elbow"><command_interface name="position"/><state_interface name="position"/></joint>'
_TYPE = "position_controllers/JointGroupPositionController"
_YAML = (
    "controller_manager:\n  ros__parameters:\n    update_rate: 100\n"
    f"    arm: {{type: {_TYPE}}}\n"
    "arm:\n  ros__parameters: {joints: [elbow]}\n"
)


def _urdf(hardware: str, plugin: str, more: str = "") -> str:
    """A robot with one joint, `elbow`."""
    block = (
        '<ros2_control name="arm" type="system">\n'
        "    <hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>\n"
        f"    {hardware}\n  </ros2_control>"
    )
    return f"""<robot name="arm">
  <link name="world"/>
  <link name="forearm">{_INERTIAL}</link>
  <joint name="elbow" type="revolute">
    <parent link="world"/><child link="forearm"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="10" velocity="1"/>
  </joint>
  {block if hardware else ""}{more}
  <gazebo><plugin filename="libgz_ros2_control-system.so" name="control">{plugin}</plugin></gazebo>
</robot>
"""


def _robot(hardware: str = _JOINT, plugin: str = "<parameters>arm.yaml</parameters>", yaml: str = _YAML) -> Example:
    return Example(_urdf(hardware, plugin), files={"arm.yaml": yaml}, suffix=".urdf")


def _running(lines: str) -> Example:
    script = f"import simkit\n\nsim = simkit.load('arm.urdf')\n{lines}"
    return python(script, {"arm.urdf": _urdf(_JOINT, "<parameters>arm.yaml</parameters>"), "arm.yaml": _YAML})


_SHORT = """
message = simkit.msgs.make("std_msgs/msg/Float64MultiArray", data=[1.0, 2.0])
sim.publish("/arm/commands", message)
sim.run(0.1)
"""
_TWO = (
    "controller_manager:\n  ros__parameters:\n"
    f"    first: {{type: {_TYPE}}}\n    second: {{type: {_TYPE}}}\n"
    "/**:\n  ros__parameters: {joints: [elbow]}\n"
)

CODES: tuple[Code, ...] = (
    Code(
        "SK-CONTROL-001",
        "note",
        "a second robot has a controller manager of the same name: its topics and services are below its model's name",
        "give each robot a `<namespace>` in the plugin's `<ros>`",
        _running("sim.spawn('arm.urdf', name='second')\n"),
    ),
    Code(
        "SK-CONTROL-002",
        "error",
        "a controllers' parameter file cannot be read, is not YAML, or not a file of parameters",
        "the line is shown; check indentation, quotes and brackets",
        _robot(yaml="arm:\n  ros__parameters: {joints: [elbow}\n"),
    ),
    Code(
        "SK-CONTROL-003",
        "warning",
        "a controllers' parameter file is empty, declares no controller, or has a word that is nearly "
        "`ros__parameters`",
        "ROS 2 wants `<node>: ros__parameters: ...`; without that word a file is read as ROS 1's",
        _robot(yaml="# to be written\n"),
    ),
    Code(
        "SK-CONTROL-004",
        "warning",
        "a name comes twice: a key of a parameter file (the later counts), a joint of `<ros2_control>` (the first), or "
        "one that another plugin drives too",
        "",
        _robot(yaml=_YAML.replace("joints: [elbow]", "joints: [elbow], joints: [elbow]")),
    ),
    Code(
        "SK-CONTROL-005",
        "note",
        "a model has neither `<ros2_control>` nor `<transmission>`: all its joints with one axis can be commanded",
        "put `<ros2_control>` into the URDF, or into the plugin's element",
        _robot(hardware=""),
    ),
    Code(
        "SK-CONTROL-006",
        "note",
        "something of the simulation stands for what `<ros2_control>` names: the hardware's class, or a sensor",
        "",
        Example(
            _urdf(_JOINT, "<parameters>arm.yaml</parameters>").replace("gz_ros2_control/GazeboSimSystem", "my/Driver"),
            files={"arm.yaml": _YAML},
            suffix=".urdf",
        ),
    ),
    Code(
        "SK-CONTROL-007",
        "warning",
        "`<gpio>` of `<ros2_control>` has nothing that it stands for; it is left out",
        "",
        _robot(f'{_JOINT}<gpio name="lamp"><command_interface name="on"/></gpio>'),
    ),
    Code(
        "SK-CONTROL-008",
        "warning",
        "`<ros2_control>` names a joint, sensor or element that there is not, or one that does not fit",
        "the closest name is given",
        _robot(_JOINT + '<joint name="ellbow"><command_interface name="position"/></joint>'),
    ),
    Code(
        "SK-CONTROL-009",
        "warning",
        "an interface of a joint that is neither position, velocity nor effort; it is left out",
        "",
        _robot(_JOINT.replace("<command", '<command_interface name="torque"/><command', 1)),
    ),
    Code(
        "SK-CONTROL-010",
        "warning",
        "a request to the controller manager that it cannot meet; the answer says `ok: false`",
        "what is wrong is said, as ros2_control does",
        _running("sim.call('/controller_manager/switch_controller', {'activate_controllers': ['amr']})\n"),
    ),
    Code(
        "SK-CONTROL-011",
        "warning",
        "a parameter of a controller or of the manager that is not used",
        "the closest name is given",
        _robot(yaml=_YAML.replace("[elbow]", "[elbow], jionts: [elbow]")),
    ),
    Code(
        "SK-CONTROL-012",
        "error, warning",
        "a controller needs an interface that the hardware does not have",
        "the closest one is given, or those there are",
        _robot(yaml=_YAML.replace("[elbow]", "[wrist]")),
    ),
    Code(
        "SK-CONTROL-013",
        "error, warning",
        "a controller cannot be loaded: its type is missing or not known, or no file declares it",
        "the closest name is given",
        _robot(yaml=_YAML.replace(_TYPE, "position_controllers/JointGroupPositon")),
    ),
    Code(
        "SK-CONTROL-014",
        "note",
        "a controller stays inactive, since one that comes first drives a joint of it",
        "`switch_controller` changes over; `<simkit:controllers>` names those that are to be loaded",
        _robot(yaml=_TWO),
    ),
    Code(
        "SK-CONTROL-015",
        "error, warning",
        "a controllers' parameter file is not found: no controller of it is loaded; an error from `--params-file`",
        "`--package-path NAME=DIR`, put the file beside the robot's, or name it with `--params-file`",
        _robot(plugin="<parameters>package://nowhere/config/none.yaml</parameters>"),
    ),
    Code(
        "SK-CONTROL-016",
        "warning",
        "a command that a controller cannot use is left out: of another length, or with what is no number",
        "",
        _running(_SHORT),
    ),
    Code(
        "SK-CONTROL-017",
        "warning",
        "the controller manager's rate is more than there are steps, or a controller's more than the manager's",
        "lower `update_rate`, or `<max_step_size>`",
        _robot(yaml=_YAML.replace("update_rate: 100", "update_rate: 20000")),
    ),
    Code(
        "SK-CONTROL-018",
        "note",
        "a controllers' plugin names no parameter file, so no controller is loaded",
        "`--params-file FILE`, as a launch file of ROS would load; or `<simkit:parameters>`, which Gazebo does not see",
        _robot(plugin=""),
    ),
    Code(
        "SK-CONTROL-019",
        "warning",
        "a file has parameters for a node that nobody is, and whose name is nearly a controller's",
        "the closest name is given",
        _robot(yaml=_YAML + "arn:\n  ros__parameters: {joints: [elbow]}\n"),
    ),
)
