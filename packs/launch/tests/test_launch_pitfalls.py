"""Tests of what launch files in Python do besides describing a launch: they read files, variables and packages."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from simkit.errors import LoadError
from simkit_launch.launch_file import read_launch_file
from simkit_launch.launch_plan import LaunchPlan, StartCondition

HEADER = """
import os
from launch import LaunchContext, LaunchDescription, LaunchService
from launch.actions import *
from launch.conditions import *
from launch.event_handlers import *
from launch.launch_description_sources import *
from launch.substitutions import *
from launch_ros.actions import *
from launch_ros.descriptions import *
from launch_ros.substitutions import *
from ament_index_python.packages import *
"""
NODE = "Node(package='p', executable='e', parameters=[{'value': %s}])"

Plan = Callable[..., LaunchPlan]


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """Return the folder of the package `robot` in a workspace."""
    package = tmp_path / "src" / "robot"
    (package / "launch").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>robot</name></package>")
    return package


@pytest.fixture
def plan(workspace: Path) -> Plan:
    """Return a function that writes a launch file of the package `robot`, and returns its plan."""

    def read(text: str, arguments: Mapping[str, str] | None = None) -> LaunchPlan:
        file = workspace / "launch" / "robot.launch.py"
        file.write_text(HEADER + text)
        return read_launch_file(file, arguments or {})

    return read


def description(*items: str) -> str:
    return f"def generate_launch_description():\n    return LaunchDescription([{', '.join(items)}])\n"


def value_of(plan: LaunchPlan) -> object:
    (parameters,) = plan.processes[-1].parameters
    assert not isinstance(parameters, Path)
    return parameters["value"]


def messages(plan: LaunchPlan) -> list[str]:
    return [each.message for each in plan.diagnostics]


def test_sys_exit_is_an_error_with_its_line(plan: Plan) -> None:
    with pytest.raises(LoadError) as error:
        plan("import sys\ndef generate_launch_description():\n    sys.exit('no robot')\n")
    (problem,) = error.value.diagnostics
    assert (problem.code, problem.line) == ("SK-LAUNCH-002", 15)
    assert problem.message == "the launch file ended itself with sys.exit('no robot')"


def test_arguments_can_be_read_from_the_command_line(plan: Plan) -> None:
    text = "import sys\nVALUE = [each for each in sys.argv if each.startswith('robot:=')]\n"
    text += description(NODE % "VALUE[0]", "DeclareLaunchArgument('robot')")
    assert value_of(plan(text, {"robot": "two"})) == "robot:=two"


def test_search_paths_can_be_extended_without_being_set(plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH"):
        monkeypatch.delenv(name, raising=False)
    text = "os.environ['GZ_SIM_RESOURCE_PATH'] += os.pathsep + '/models'\nos.environ['GAZEBO_MODEL_PATH'] += ':/old'\n"
    found = plan(text + description(NODE % "1"))
    assert found.resource_paths == ["/models", "/old"]
    assert dict(found.processes[0].environment)["GAZEBO_MODEL_PATH"] == ":/old"


def test_the_model_of_turtlebot3_is_waffle_with_a_note(plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("TURTLEBOT3_MODEL", raising=False)
    found = plan("MODEL = os.environ['TURTLEBOT3_MODEL']\n" + description(NODE % "MODEL"))
    assert value_of(found) == "waffle"
    (note,) = found.diagnostics
    assert (note.code, note.severity, note.line) == ("SK-LAUNCH-021", "note", 13)
    monkeypatch.setenv("TURTLEBOT3_MODEL", "burger")
    assert value_of(plan(description(NODE % "os.environ['TURTLEBOT3_MODEL']"))) == "burger"


def test_modules_of_other_packages_are_imported(plan: Plan, workspace: Path) -> None:
    other = workspace.parent / "common"
    (other / "common_launch").mkdir(parents=True)
    (other / "package.xml").write_text("<package><name>common</name></package>")
    (other / "common_launch" / "__init__.py").write_text("")
    (other / "common_launch" / "names.py").write_text("NAME = 'of_common'\n")
    text = "from common_launch.names import NAME\n" + description(NODE % "NAME")
    assert value_of(plan(text)) == "of_common"


def test_a_folder_launch_with_an_init_file_does_not_hide_the_module_launch(plan: Plan, workspace: Path) -> None:
    (workspace / "launch" / "__init__.py").write_text("raise RuntimeError('imported')\n")
    assert value_of(plan(description(NODE % "1"))) == 1


def test_paths_are_joined_with_a_slash(plan: Plan, workspace: Path) -> None:
    text = description(
        "DeclareLaunchArgument('file', default_value=FindPackageShare('robot') / 'config' / 'a.yaml')",
        NODE % "PathJoinSubstitution(['/a', ['b_', LaunchConfiguration('file')]]) / 'c'",
    )
    assert value_of(plan(text)) == f"/a/b_{workspace}/config/a.yaml/c"


def test_a_list_is_joined_without_a_separator(plan: Plan) -> None:
    text = description("DeclareLaunchArgument('n', default_value='3')", NODE % "['robot_', LaunchConfiguration('n')]")
    assert value_of(plan(text)) == "robot_3"


@pytest.mark.parametrize(
    "source",
    [
        "FILE",
        "[DIR, '/inner.launch.py']",
        "PythonLaunchDescriptionSource(FILE)",
        "ThisLaunchFileDir() / 'inner.launch.py'",
    ],
)
@pytest.mark.parametrize("pairs", ["{'a': '1'}", "{'a': '1'}.items()", "[('a', '1')]"])
def test_an_include_takes_any_source_and_any_pairs(plan: Plan, workspace: Path, source: str, pairs: str) -> None:
    (workspace / "launch" / "inner.launch.py").write_text(HEADER + description(NODE % "LaunchConfiguration('a')"))
    text = "DIR = os.path.dirname(__file__)\nFILE = os.path.join(DIR, 'inner.launch.py')\n"
    text += description(f"IncludeLaunchDescription({source}, launch_arguments={pairs})")
    assert value_of(plan(text)) == 1


def test_an_included_file_sees_and_changes_the_arguments_of_the_includer(plan: Plan, workspace: Path) -> None:
    inner = description(NODE % "LaunchConfiguration('a')", "SetLaunchConfiguration('a', 'changed')")
    (workspace / "launch" / "inner.launch.py").write_text(HEADER + inner)
    include = "IncludeLaunchDescription(os.path.join(os.path.dirname(__file__), 'inner.launch.py'))"
    text = description("DeclareLaunchArgument('a', default_value='first')", include, NODE % "LaunchConfiguration('a')")
    values = [each.parameters[0] for each in plan(text).processes]
    assert values == [{"value": "first"}, {"value": "changed"}]


def test_a_group_ends_its_launch_configurations_and_variables(plan: Plan) -> None:
    text = description(
        "SetLaunchConfiguration('a', 'outside')",
        "GroupAction([SetLaunchConfiguration('a', 'inside'), SetEnvironmentVariable('V', '1'), "
        f"PushRosNamespace('robot'), {NODE % 'LaunchConfiguration(chr(97))'}])",
        NODE % "LaunchConfiguration('a')",
    )
    inside, outside = plan(text).processes
    assert (inside.parameters, inside.namespace, inside.environment) == (({"value": "inside"},), "/robot", {"V": "1"})
    assert (outside.parameters, outside.namespace, outside.environment) == (({"value": "outside"},), "", {})


def test_a_package_that_is_not_there_leaves_out_what_comes_from_it(plan: Plan) -> None:
    text = "SHARE = get_package_share_directory('gone')\n" + description(
        "IncludeLaunchDescription(os.path.join(SHARE, 'launch', 'x.launch.py'))",
        "Node(package='p', executable='e', parameters=[os.path.join(SHARE, 'a.yaml')])",
    )
    found = plan(text)
    assert [each.executable for each in found.processes] == ["e"]
    assert found.processes[0].parameters == ()
    first, second, third = found.diagnostics
    assert (first.code, first.line) == ("SK-LAUNCH-020", 13)
    assert second.message == "the launch file gone/x.launch.py is not included: the package 'gone' is not there"
    assert third.message.endswith("the package 'gone' is not there")


def test_a_launch_file_can_handle_a_missing_package_itself(plan: Plan) -> None:
    text = """
try:
    SHARE = get_package_share_directory('gone')
except PackageNotFoundError:
    SHARE = 'another'
"""
    found = plan(text + description(NODE % "SHARE"))
    assert value_of(found) == "another"
    assert not list(found.diagnostics)


def test_files_of_a_source_tree_are_found_where_a_build_installs_them(plan: Plan, workspace: Path) -> None:
    (workspace / "config").mkdir()
    (workspace / "config" / "names.yaml").write_text("name: of_config")
    text = "import yaml\nSHARE = get_package_share_directory('robot')\n"
    text += "with open(os.path.join(SHARE, 'names.yaml')) as file:\n    NAME = yaml.safe_load(file)['name']\n"
    assert value_of(plan(text + description(NODE % "NAME"))) == "of_config"


def test_a_function_reads_the_values_of_arguments(plan: Plan) -> None:
    text = """
def start(context, prefix):
    count = int(LaunchConfiguration('count').perform(context))
    return [Node(package='p', executable=f'{prefix}{number}') for number in range(count)]

def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument('count', default_value='2'),
                              OpaqueFunction(function=start, args=['robot'])])
"""
    assert [each.executable for each in plan(text).processes] == ["robot0", "robot1"]
    assert len(plan(text, {"count": "3"}).processes) == 3


def test_xacro_is_expanded_as_a_command_and_as_a_module(plan: Plan, workspace: Path) -> None:
    (workspace / "urdf").mkdir()
    text = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="n" default="base"/>'
    (workspace / "urdf" / "r.xacro").write_text(text + '<link name="$(arg n)"/></robot>')
    launch = """
import subprocess, xacro
FILE = os.path.join(get_package_share_directory('robot'), 'urdf', 'r.xacro')
with open(FILE) as file:
    DOCUMENT = xacro.parse(file)
xacro.process_doc(DOCUMENT)
TEXTS = [
    Command([FindExecutable(name='xacro'), ' ', FILE, ' n:=a']),
    xacro.process_file(FILE, mappings={'n': 'b'}).toxml(),
    DOCUMENT.toprettyxml(indent=' '),
    subprocess.check_output(['xacro', FILE, 'n:=d'], text=True),
]
def generate_launch_description():
    return LaunchDescription([Node(package='p', executable='e', parameters=[{'value': each}]) for each in TEXTS])
"""
    texts = [str(dict(each.parameters[0])["value"]) for each in plan(launch).processes]  # type: ignore[arg-type]
    assert all(f'<link name="{name}"/>' in text for name, text in zip(["a", "b", "base", "d"], texts, strict=True))


def test_a_xacro_file_that_is_not_there_leaves_out_the_model(plan: Plan) -> None:
    text = "import xacro\n" + description(NODE % "xacro.process_file('/nothing.xacro').toxml()")
    found = plan(text)
    assert value_of(found) == ""
    assert [each.code for each in found.diagnostics] == ["SK-LAUNCH-022"]


def test_parameters_are_converted_as_in_ros(plan: Plan, workspace: Path) -> None:
    (workspace / "a.yaml").write_text("/**: {ros__parameters: {rate: $(var rate)}}")
    text = """
from typing import List
from launch_ros.parameter_descriptions import ParameterFile, ParameterValue
def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('rate', default_value='5'),
        Node(package='p', executable='e', parameters=[
            {'a': LaunchConfiguration('rate'), 'b': ParameterValue(LaunchConfiguration('rate'), value_type=str)},
            {'c': {'d': [1, 2.5]}, 'e': ['x', 'y'], 'f': '5', 'g': [True, False]},
            {'h': ParameterValue(['[', LaunchConfiguration('rate'), ', 6]'], value_type=List[int])},
            ParameterFile(os.path.join(os.path.dirname(__file__), '..', 'a.yaml'), allow_substs=True)])])
"""
    *tables, file = plan(text).processes[0].parameters
    assert tables == [
        {"a": 5, "b": "5"},
        {"c.d": [1.0, 2.5], "e": ["x", "y"], "f": "5", "g": [True, False]},
        {"h": [5, 6]},
    ]
    assert isinstance(file, Path)
    assert file.read_text() == "/**: {ros__parameters: {rate: 5}}"


def test_parameters_and_remappings_of_a_group_come_before_those_of_its_nodes(plan: Plan) -> None:
    node = "Node(package='p', executable='e', parameters=[{'a': 1}], remappings=[('x', 'y')])"
    text = description(
        f"GroupAction([SetParameter('use_sim_time', True), SetRemap('/tf', 'tf'), {node}])",
        node,
    )
    inside, outside = plan(text).processes
    assert inside.parameters == ({"use_sim_time": True}, {"a": 1})
    assert inside.remappings == (("/tf", "tf"), ("x", "y"))
    assert (outside.parameters, outside.remappings) == (({"a": 1},), (("x", "y"),))


def test_nav2_rewrites_files_of_parameters(plan: Plan, workspace: Path) -> None:
    (workspace / "nav.yaml").write_text("amcl: {ros__parameters: {yaml: <map>, use_sim_time: false}}")
    text = """
from nav2_common.launch import HasNodeParams, ReplaceString, RewrittenYaml
FILE = os.path.join(os.path.dirname(__file__), '..', 'nav.yaml')
def generate_launch_description():
    file = RewrittenYaml(source_file=ReplaceString(FILE, {'<map>': 'a.yaml'}), root_key='robot',
                         param_rewrites={'use_sim_time': 'True'}, convert_types=True)
    return LaunchDescription([Node(package='p', executable='e', parameters=[file],
                                   condition=IfCondition(HasNodeParams(FILE, 'amcl')))])
"""
    first = plan(text).processes[0].parameters
    (file,) = first
    assert isinstance(file, Path)
    expected = "robot:\n  amcl:\n    ros__parameters:\n      yaml: a.yaml\n      use_sim_time: true\n"
    assert file.read_text() == expected
    assert plan(text).processes[0].parameters == first


def test_nodes_of_a_container_are_components(plan: Plan) -> None:
    component = "ComposableNode(package='image_proc', plugin='image_proc::RectifyNode', name='%s')"
    container = (
        "ComposableNodeContainer(name='box', namespace='cam', package='rclcpp_components', "
        f"executable='component_container', composable_node_descriptions=[{component % 'one'}])"
    )
    loaded = f"LoadComposableNodes(target_container='cam/box', composable_node_descriptions=[{component % 'two'}])"
    box, one, two = plan(description(container, loaded)).processes
    assert (box.kind, box.name, box.namespace) == ("node", "box", "/cam")
    assert (one.kind, one.source, one.name) == ("component", "image_proc/image_proc::RectifyNode", "one")
    assert (one.container, two.container, two.name) == ("/cam/box", "cam/box", "two")


def test_a_script_with_a_launch_service_is_a_launch_file(plan: Plan) -> None:
    text = "import sys\ndef main():\n    service = LaunchService(argv=sys.argv[1:])\n"
    text += f"    service.include_launch_description(LaunchDescription([{NODE % 1}]))\n    return service.run()\n"
    assert value_of(plan(text + "if __name__ == '__main__':\n    sys.exit(main())\n")) == 1


def test_lines_of_a_shell_become_commands_one_after_the_other(plan: Plan) -> None:
    line = "sleep 5 && A=1 ros2 control list > /dev/null; echo ready | cat"
    text = description(f"ExecuteProcess(cmd=['{line}'], shell=True, on_exit=[{NODE % 1}])")
    first, second, third, last = plan(text).processes
    assert [first.arguments, second.arguments, third.arguments] == [
        ("sleep", "5"),
        ("ros2", "control", "list"),
        ("echo", "ready"),
    ]
    assert second.environment == {"A": "1"}
    assert [each.condition for each in (first, second, third, last)] == [
        StartCondition(),
        StartCondition("exit", 1),
        StartCondition("exit", 2),
        StartCondition("exit", 3),
    ]


def test_what_waits_for_the_output_of_a_process_starts_with_it(plan: Plan) -> None:
    text = """
def generate_launch_description():
    server = Node(package='p', executable='server')
    client = Node(package='p', executable='client')
    started = lambda event: client if 'ready' in event.text.decode() else None
    return LaunchDescription([server, RegisterEventHandler(OnProcessIO(target_action=server, on_stdout=started))])
"""
    found = plan(text)
    assert found.processes[1].condition == StartCondition("start", 1)
    assert "is not known before the run" in messages(found)[0]


def test_states_of_a_node_change_one_after_the_other(plan: Plan) -> None:
    text = """
import lifecycle_msgs.msg
from launch.events import matches_action
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
def change(node, transition):
    return EmitEvent(event=ChangeState(lifecycle_node_matcher=matches_action(node), transition_id=transition))
def generate_launch_description():
    node = LifecycleNode(package='p', executable='e', name='driver', namespace='/robot')
    activate = change(node, lifecycle_msgs.msg.Transition.TRANSITION_ACTIVATE)
    return LaunchDescription([
        node,
        RegisterEventHandler(OnStateTransition(target_lifecycle_node=node, goal_state='inactive', entities=[activate])),
        change(node, lifecycle_msgs.msg.Transition.TRANSITION_CONFIGURE)])
"""
    _, configure, activate = plan(text).processes
    assert configure.arguments == ("ros2", "lifecycle", "set", "/robot/driver", "configure")
    assert activate.arguments[-1] == "activate"
    assert activate.condition == StartCondition("exit", configure.number)


def test_handlers_that_start_themselves_are_an_error(plan: Plan) -> None:
    text = """
def again(event, context):
    return [Node(package='p', executable='e')]
def generate_launch_description():
    return LaunchDescription([RegisterEventHandler(OnProcessExit(on_exit=again)), Node(package='p', executable='e')])
"""
    with pytest.raises(LoadError) as error:
        plan(text)
    assert "starts more than 2000 processes" in error.value.diagnostics[-1].message


def test_an_argument_that_the_launch_file_does_not_know_is_a_warning(plan: Plan) -> None:
    text = description("DeclareLaunchArgument('world', default_value='')")
    (warning,) = plan(text, {"wrold": "a"}).diagnostics
    assert (warning.code, warning.hint) == ("SK-LAUNCH-005", "did you mean 'world'?")


def test_strict_reading_makes_what_is_left_out_an_error(workspace: Path) -> None:
    file = workspace / "launch" / "a.launch.py"
    file.write_text(HEADER + description("IncludeLaunchDescription('/nothing.launch.py')"))
    with pytest.raises(LoadError, match="is not included"):
        read_launch_file(file, {}, strict=True)


def test_a_coroutine_runs_to_its_end_without_a_wait(plan: Plan) -> None:
    text = """
import asyncio
async def work(context, text):
    await asyncio.sleep(1000.0)
    print(text)
"""
    found = plan(text + description("OpaqueCoroutine(coroutine=work, args=['worked'])"))
    assert found.log == ["worked"]


def test_the_keywords_of_older_versions_are_accepted(plan: Plan) -> None:
    text = description("Node(package='p', node_executable='e', node_name='n', node_namespace='/s')")
    (process,) = plan(text).processes
    assert (process.executable, process.name, process.namespace) == ("e", "n", "/s")


def test_modules_of_ros_are_found_by_their_full_names(plan: Plan) -> None:
    text = """
from launch.actions.execute_process import ExecuteProcess as A
from launch.actions.include_launch_description import IncludeLaunchDescription as B
from launch.launch_description_sources.python_launch_description_source import PythonLaunchDescriptionSource as C
from launch_ros.actions.node import Node as D
from launch_ros.descriptions.composable_node import ComposableNode as E
import launch, launch_ros.actions, launch.substitutions.launch_configuration
SAME = all([A is ExecuteProcess, B is IncludeLaunchDescription, C is PythonLaunchDescriptionSource, D is Node,
            E is ComposableNode, launch.actions.LogInfo is LogInfo, launch_ros.actions.Node is Node,
            launch.substitutions.launch_configuration.LaunchConfiguration is LaunchConfiguration,
            LogInfo.__module__.startswith('launch.actions')])
"""
    assert value_of(plan(text + description(NODE % "SAME"))) is True


def test_moveit_reads_its_configuration_package(plan: Plan, workspace: Path) -> None:
    package = workspace.parent / "arm_moveit_config"
    (package / "config").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>arm_moveit_config</name></package>")
    (package / "config" / "arm.urdf.xacro").write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="n" default="base"/>'
        '<link name="$(arg n)"/></robot>'
    )
    (package / "config" / "arm.srdf").write_text(
        '<robot name="r"><virtual_joint name="v" type="fixed" parent_frame="world" child_link="base"/></robot>'
    )
    (package / "config" / "kinematics.yaml").write_text("arm: {kinematics_solver: kdl}")
    (package / "config" / "moveit_controllers.yaml").write_text(
        "moveit_simple_controller_manager: {controller_names: [arm_controller]}"
    )
    text = """
from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launches import generate_spawn_controllers_launch, generate_static_virtual_joint_tfs_launch
def generate_launch_description():
    configs = MoveItConfigsBuilder('arm').robot_description(mappings={'n': 'mapped'}).to_moveit_configs()
    return LaunchDescription([
        *generate_spawn_controllers_launch(configs).entities,
        *generate_static_virtual_joint_tfs_launch(configs).entities,
        Node(package='moveit_ros_move_group', executable='move_group', parameters=[configs.to_dict()])])
"""
    first, second, frames, group = plan(text).processes
    assert (first.arguments, second.arguments) == (("arm_controller",), ("joint_state_broadcaster",))
    assert frames.arguments[-2:] == ("world", "base")
    (parameters,) = group.parameters
    assert not isinstance(parameters, Path)
    assert parameters["robot_description_kinematics.arm.kinematics_solver"] == "kdl"
    assert '<link name="mapped"/>' in parameters["robot_description"]


def test_launch_files_that_include_each_other_are_an_error(plan: Plan) -> None:
    with pytest.raises(LoadError) as error:
        plan(description("IncludeLaunchDescription(__file__)"))
    (problem,) = error.value.diagnostics
    assert problem.message == "launch files include each other without an end"


def test_the_folder_of_the_launch_file_is_the_own_one_after_an_include(plan: Plan, workspace: Path) -> None:
    (workspace / "other").mkdir()
    (workspace / "other" / "inner.launch.py").write_text(HEADER + description(NODE % "ThisLaunchFileDir()"))
    include = "IncludeLaunchDescription([ThisLaunchFileDir(), '/../other/inner.launch.py'])"
    found = plan(description(include, NODE % "ThisLaunchFileDir()"))
    values = [each.parameters[0] for each in found.processes]
    assert values == [{"value": str(workspace / "other")}, {"value": str(workspace / "launch")}]


def test_a_path_of_another_computer_is_found_in_the_workspace(plan: Plan, workspace: Path) -> None:
    (workspace / "urdf").mkdir()
    (workspace / "urdf" / "robot.urdf").write_text("<robot/>")
    text = "with open('/mnt/ros2_ws/src/robot/urdf/robot.urdf') as file:\n    TEXT = file.read()\n"
    found = plan(text + description(NODE % "TEXT"))
    assert value_of(found) == "<robot/>"
    (warning,) = found.diagnostics
    assert (warning.code, warning.line) == ("SK-LAUNCH-006", 13)
    assert f"{workspace}/urdf/robot.urdf is used" in warning.message


def test_an_unknown_path_is_an_error_of_python(plan: Plan) -> None:
    with pytest.raises(LoadError, match="FileNotFoundError"):
        plan("open('/mnt/urdf/robot.urdf')\n" + description())


def test_a_launch_file_that_waits_for_ever_is_an_error(plan: Plan) -> None:
    with pytest.raises(LoadError, match="waits for something that never comes"):
        plan("import time\nwhile True:\n    time.sleep(100.0)\n")
    with pytest.raises(LoadError, match="waits for something that never comes"):
        plan("import threading\nthreading.Event().wait()\n" + description())


def test_temporary_files_have_the_same_name_in_each_run(plan: Plan, tmp_path: Path) -> None:
    text = """
import tempfile
with tempfile.NamedTemporaryFile('w', suffix='.yaml', delete=False) as file:
    file.write('/**: {ros__parameters: {rate: 5}}')
"""
    text += description("Node(package='p', executable='e', parameters=[file.name], arguments=['-c', file.name])")
    first, second = plan(text).processes[0], plan(text).processes[0]
    assert (first.parameters, first.arguments) == (second.parameters, second.arguments)
    (path,) = first.parameters
    assert isinstance(path, Path)
    assert path.read_text() == "/**: {ros__parameters: {rate: 5}}"


def test_remappings_in_a_set_have_an_order(plan: Plan) -> None:
    text = description("Node(package='p', executable='e', remappings={('b', '1'), ('a', '2'), ('c', '3')})")
    assert plan(text).processes[0].remappings == (("a", "2"), ("b", "1"), ("c", "3"))
