"""Layouts of today's parameter files: a controller's type in its own block, repeated blocks, wildcards, arguments."""

from __future__ import annotations

from pathlib import Path

import pytest
from control_robots import arm, command, files, opened, position, reported_messages, states

import simkit
from simkit.extend import Diagnostics
from simkit.loaders import Resolver, load_scene
from simkit.writers.sdf_world import sdf_text

FORWARD = "position_controllers/JointGroupPositionController"
OWN_TYPE = f"""
controller_manager:
  ros__parameters: {{update_rate: 100}}
arm_controller:
  ros__parameters: {{type: {FORWARD}, joints: [j1, j2]}}
"""


def test_a_controller_with_its_type_in_its_own_block_is_loaded_and_moves_the_arm(tmp_path: Path) -> None:
    with opened(tmp_path, yaml=OWN_TYPE) as sim:
        assert states(sim) == {"arm_controller": "active"}
        assert not [d for d in sim.diagnostics if d.code.startswith("SK-CONTROL")]
        command(sim, "arm_controller", 0.3, -0.2)
        sim.run(2.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.3, -0.2], abs=1e-3)


def test_controllers_of_the_manager_come_before_controllers_with_their_own_type(tmp_path: Path) -> None:
    yaml = f"""
    /**/second: {{ros__parameters: {{type: {FORWARD}, joints: [j2]}}}}
    /*: {{ros__parameters: {{first: {{type: {FORWARD}}}}}}}
    first: {{ros__parameters: {{joints: [j1]}}}}
    planner: {{ros__parameters: {{type: fast}}}}
    """
    with opened(tmp_path, yaml=yaml) as sim:
        assert list(states(sim)) == ["first", "second"]


REPEATED = f"""
/**:
  controller_manager:
    ros__parameters:
      arm_controller: {{type: {FORWARD}}}
/**:
  arm_controller:
    ros__parameters: {{joints: [j1]}}
/**:
  arm_controller:
    ros__parameters: {{joints: [j1, j2]}}
"""


def test_a_repeated_block_is_merged_and_only_a_repeated_value_is_reported(tmp_path: Path) -> None:
    with opened(tmp_path, yaml=REPEATED) as sim:
        assert states(sim) == {"arm_controller": "active"}
        assert sim.call("/controller_manager/list_controllers").controller[0].claimed_interfaces == [
            "j1/position",
            "j2/position",
        ]
        assert reported_messages(sim, "SK-CONTROL-004") == [
            "'joints' occurs twice, first in line 8; the later value is used"
        ]


def test_a_later_file_overrides_single_values_of_an_earlier_file(tmp_path: Path) -> None:
    (tmp_path / "more.yaml").write_text("/**/arm_controller: {ros__parameters: {joints: [j2]}}", encoding="utf-8")
    plugin = "<parameters>arm.yaml</parameters><parameters>more.yaml</parameters>"
    with opened(tmp_path, arm(plugin=plugin), OWN_TYPE) as sim:
        command(sim, "arm_controller", 0.4)
        sim.run(2.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.0, 0.4], abs=1e-3)


SPLIT = """<argument>--ros-args</argument><argument>--params-file</argument><argument>arm.yaml</argument>
<argument>-r</argument><argument>arm_controller:~/commands:=/go</argument>"""
WHOLE = """<argument>--ros-args --params-file 'arm.yaml' --log-level info --disable-rosout-logs
-r ~/commands:=/go</argument>"""


@pytest.mark.parametrize("arguments", [SPLIT, WHOLE])
def test_arguments_name_the_parameter_file_and_remap_topics_of_a_controller(tmp_path: Path, arguments: str) -> None:
    with opened(tmp_path, arm(plugin=f"<ros>{arguments}</ros>"), OWN_TYPE) as sim:
        assert not [d for d in sim.diagnostics if d.severity == "warning"]
        sim.publish("/go", simkit.msgs.make("std_msgs/msg/Float64MultiArray", data=[0.3, 0.1]))
        sim.run(2.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.3, 0.1], abs=1e-3)


def test_parameters_and_names_of_arguments_override_the_files(tmp_path: Path) -> None:
    arguments = "-p arm_controller:joints:=[j2] -p update_rate:=50 -r __ns:=/left -r __node:=boss"
    plugin = f"<parameters>arm.yaml</parameters><ros><argument>--ros-args {arguments}</argument></ros>"
    yaml = OWN_TYPE.replace("controller_manager:", "/**/boss:").replace("arm_controller:", "/**/arm_controller:")
    with opened(tmp_path, arm(plugin=plugin), yaml) as sim:
        (listed,) = sim.call("/left/boss/list_controllers").controller
        assert (listed.name, listed.claimed_interfaces) == ("arm_controller", ["j2/position"])


@pytest.mark.parametrize(
    ("argument", "found", "hint"),
    [
        ("--parms-file arm.yaml", "--parms-file", "did you mean '--params-file'?"),
        ("-p", "-p", ""),
        ("-p update_rate", "-p update_rate", ""),
        ("-r odom", "-r odom", ""),
    ],
)
def test_an_invalid_argument_is_an_error_at_its_line(tmp_path: Path, argument: str, found: str, hint: str) -> None:
    plugin = f"<parameters>arm.yaml</parameters><ros><argument>{argument}</argument></ros>"
    with pytest.raises(simkit.LoadError) as caught:
        opened(tmp_path, arm(plugin=plugin), OWN_TYPE)
    problem = next(d for d in caught.value.diagnostics if d.severity == "error")
    assert problem.code == "SK-PARAM-002" and f"<argument>{found}</argument>" in problem.message
    assert hint in problem.hint and problem.line


def test_a_parameter_file_of_an_argument_that_is_missing_is_reported(tmp_path: Path) -> None:
    with opened(tmp_path, arm(plugin="<ros><argument>--params-file none.yaml</argument></ros>"), OWN_TYPE) as sim:
        assert "none.yaml" in reported_messages(sim, "SK-CONTROL-015")[0]


@pytest.mark.parametrize(
    ("kind", "reason"),
    [
        ("admittance_controller/AdmittanceController", "is not supported: it commands the references of another"),
        ("ur_controllers/GPIOController", "it talks to the control box of a real UR robot"),
        ("my_controllers/Fancy", "is not known; the table of controllers in docs/ros2_control.md"),
    ],
)
def test_a_controller_that_does_not_exist_is_refused_with_the_reason(tmp_path: Path, kind: str, reason: str) -> None:
    with opened(tmp_path, yaml=OWN_TYPE.replace(FORWARD, kind)) as sim:
        (message,) = reported_messages(sim, "SK-CONTROL-013")
        assert reason in message and kind in message and "the controller is not loaded" in message


def test_a_robot_without_loaded_controllers_says_so_once(tmp_path: Path) -> None:
    no_plugin = arm()[: arm().index("<gazebo>")] + "</robot>"
    with opened(tmp_path, no_plugin) as sim:
        (message,) = reported_messages(sim, "SK-CONTROL-061")
        assert "model 'arm' has <ros2_control>, but no plugin" in message
        hint = next(d.hint for d in sim.diagnostics if d.code == "SK-CONTROL-061")
    plugin = hint.removeprefix("add ").replace("FILE.yaml", "arm.yaml")
    with opened(tmp_path, no_plugin.replace("</robot>", f"{plugin}</robot>")) as sim:
        assert states(sim)["arm_controller"] == "active"
    with opened(tmp_path, arm(plugin="")) as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-CONTROL-018"] == ["warning"]


def test_a_controller_without_any_type_or_in_another_namespace_is_reported(tmp_path: Path) -> None:
    yaml = OWN_TYPE.replace(f"type: {FORWARD}, ", "") + f"/other/wrist: {{ros__parameters: {{type: {FORWARD}}}}}"
    with opened(tmp_path, yaml=yaml) as sim:
        assert "the 'type' param of controller 'arm_controller'" in reported_messages(sim, "SK-CONTROL-013")[0]
        assert "'/other/wrist', outside the manager's namespace" in reported_messages(sim, "SK-CONTROL-019")[0]


def test_parameters_of_a_plugin_of_gazebo_classic_set_its_live_parameters(tmp_path: Path) -> None:
    module = """
import simkit
class Gain(simkit.ModelPlugin):
    def load(self, parent, params):
        self.gain = self.declare("gain", 1.0)
"""
    (tmp_path / "gain.py").write_text(module, encoding="utf-8")
    (tmp_path / "gain.yaml").write_text("gain: {ros__parameters: {gain: 3.0}}", encoding="utf-8")
    for ros, value, unused in [
        ('<parameter name="gain" type="double">2.5</parameter>', 2.5, 0),
        ("<argument>--params-file gain.yaml</argument>", 3.0, 0),
        ("<argument>-p gain:=4.0 -p gian:=1.0 -p use_sim_time:=true</argument>", 4.0, 1),
    ]:
        robot = arm(more=f'<gazebo><plugin filename="gain.py" name="gain"><ros>{ros}</ros></plugin></gazebo>')
        with simkit.load(files(tmp_path, robot), plugin_paths=[tmp_path]) as sim:
            assert sim.call("/gain/get_parameters", {"names": ["gain"]}).values[0].double_value == value
            assert len(reported_messages(sim, "SK-PARAM-003")) == unused


def test_a_controller_of_another_robot_in_the_same_file_is_a_warning_and_a_misspelt_joint_an_error(
    tmp_path: Path,
) -> None:
    other = f"\nspine: {{ros__parameters: {{type: {FORWARD}, joints: [lift_column]}}}}"
    with opened(tmp_path, yaml=OWN_TYPE + other) as sim:
        assert states(sim)["arm_controller"] == "active"
        (message,) = reported_messages(sim, "SK-CONTROL-012")
        assert "'spine' is not loaded: the robot does not have lift_column/position" in message
    velocity = "velocity_controllers/JointGroupVelocityController"
    by_velocity = f"\nfast: {{ros__parameters: {{type: {velocity}, joints: [j1]}}}}"
    with opened(tmp_path, yaml=OWN_TYPE + by_velocity) as sim:
        assert "the robot does not have j1/velocity" in reported_messages(sim, "SK-CONTROL-012")[0]
    with pytest.raises(simkit.LoadError, match="SK-CONTROL-012"):
        opened(tmp_path, yaml=OWN_TYPE + other.replace("[lift_column]", "[j1, lift_column]"))


VARIABLES = f"""
controller_manager:
  ros__parameters: {{update_rate: $(var rate), $(var side)_controller: {{type: {FORWARD}}}}}
$(var side)_controller:
  ros__parameters: {{joints: [$(var prefix)j1, "$(arg prefix)j2"]}}
"""


def with_arguments(folder: Path, prefix: str | None) -> Path:
    """Write a xacro robot with the arguments `side`, `rate` and, if given, `prefix`; return its file."""
    declared = '<xacro:arg name="side" default="left"/><xacro:arg name="rate" default="50"/>'
    if prefix is not None:
        declared += f'<xacro:arg name="prefix" default="{prefix}"/>'
    robot = arm().replace('<robot name="arm">', f'<robot name="arm" xmlns:xacro="http://ros.org/wiki/xacro">{declared}')
    for joint in ("j1", "j2"):
        robot = robot.replace(f'joint name="{joint}"', f'joint name="{prefix or ""}{joint}"')
    return files(folder, robot, VARIABLES)


def test_values_of_a_launch_file_are_the_arguments_of_the_xacro_file(tmp_path: Path) -> None:
    with simkit.load(with_arguments(tmp_path, "a_"), xacro_args={"side": "right"}) as sim:
        assert states(sim) == {"right_controller": "active"}
        assert not reported_messages(sim, "SK-CONTROL-003")
        assert sim.call("/controller_manager/list_controllers").controller[0].claimed_interfaces == [
            "a_j1/position",
            "a_j2/position",
        ]


def test_a_name_without_a_value_is_empty_and_reported_once(tmp_path: Path) -> None:
    with simkit.load(with_arguments(tmp_path, None)) as sim:
        assert states(sim) == {"left_controller": "active"}
        found = reported_messages(sim, "SK-CONTROL-003")
        assert found == ["$(var prefix) has no value, because the robot has no xacro argument 'prefix'; it is empty"]
        assert sim.call("/controller_manager/list_controllers").controller[0].claimed_interfaces == [
            "j1/position",
            "j2/position",
        ]


def test_a_model_in_sdf_has_its_own_hardware(tmp_path: Path) -> None:
    (tmp_path / "arm.yaml").write_text(OWN_TYPE.replace("[j1, j2]", "[j1]"), encoding="utf-8")
    model = """<sdf version="1.9"><model name="arm"><link name="l1"><inertial><mass>1</mass><inertia><ixx>0.1</ixx>
    <iyy>0.1</iyy><izz>0.1</izz></inertia></inertial></link><joint name="j1" type="revolute"><parent>world</parent>
    <child>l1</child><axis><xyz>0 0 1</xyz><limit><effort>40</effort></limit></axis></joint>
    <ros2_control name="arm" type="system"><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
    <joint name="j1"><command_interface name="position"/><state_interface name="position"/></joint></ros2_control>
    <plugin filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin">
    <parameters>arm.yaml</parameters></plugin></model></sdf>"""
    (tmp_path / "arm.sdf").write_text(model, encoding="utf-8")
    with simkit.load(tmp_path / "arm.sdf") as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        command(sim, "arm_controller", 0.4)
        sim.run(2.0)
        assert position(sim, "j1") == pytest.approx([0.4], abs=1e-3)
    scene = load_scene(tmp_path / "arm.sdf", resolver=Resolver(), diagnostics=Diagnostics())
    (tmp_path / "written.sdf").write_text(sdf_text(scene, Diagnostics()), encoding="utf-8")
    with simkit.load(tmp_path / "written.sdf") as again:
        assert states(again) == {"arm_controller": "active"}
