"""Tests of launch files in Python: what they start, and what is reported."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from simkit.errors import LoadError
from simkit_launch.launch_file import declared_arguments, read_launch_file
from simkit_launch.launch_plan import LaunchPlan, StartCondition

HEADER = """
import os
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import *
from launch.event_handlers import *
from launch.substitutions import *
from launch_ros.actions import *
from launch_ros.descriptions import *
from launch_ros.substitutions import *
"""

Plan = Callable[..., LaunchPlan]


@pytest.fixture
def plan(tmp_path: Path) -> Plan:
    """Return a function that writes a launch file and returns its plan."""

    def read(text: str, arguments: Mapping[str, str] | None = None) -> LaunchPlan:
        file = tmp_path / "robot.launch.py"
        file.write_text(HEADER + text)
        return read_launch_file(file, arguments or {})

    return read


def description(*items: str) -> str:
    return f"def generate_launch_description():\n    return LaunchDescription([{', '.join(items)}])\n"


def messages(plan: LaunchPlan) -> list[str]:
    return [each.message for each in plan.diagnostics]


def test_a_node_has_the_values_of_its_action_and_the_line_of_the_file(plan: Plan, tmp_path: Path) -> None:
    text = """
def generate_launch_description():
    node = Node(package='a_package', executable='driver', name='left', namespace='robot', arguments=['-x', '1'],
                remappings=[('scan', '/scan')], parameters=[{'rate': 2.0, 'gains': {'p': 1, 'names': ['a', 'b']}}])
    return LaunchDescription([node])
"""
    (process,) = plan(text).processes
    assert (process.package, process.executable, process.name) == ("a_package", "driver", "left")
    assert (process.namespace, process.arguments) == ("/robot", ("-x", "1"))
    assert process.remappings == (("scan", "/scan"),)
    assert process.parameters == ({"rate": 2.0, "gains.p": 1, "gains.names": ["a", "b"]},)
    assert process.where.line == 13
    assert process.where.file == str(tmp_path / "robot.launch.py")
    assert process.condition == StartCondition()


def test_an_argument_has_its_default_unless_it_is_given(plan: Plan) -> None:
    text = description(
        "DeclareLaunchArgument('side', default_value='left')",
        "Node(package='p', executable=LaunchConfiguration('side'))",
    )
    assert plan(text).processes[0].executable == "left"
    assert plan(text, {"side": "right"}).processes[0].executable == "right"


def test_all_missing_arguments_are_named(plan: Plan) -> None:
    text = description("DeclareLaunchArgument('map', description='the map')", "DeclareLaunchArgument('robot')")
    with pytest.raises(LoadError) as error:
        plan(text)
    (problem,) = error.value.diagnostics
    assert problem.code == "SK-LAUNCH-004"
    assert "map (the map), robot" in problem.message


def test_conditions_leave_actions_out(plan: Plan) -> None:
    text = description(
        "DeclareLaunchArgument('sim', default_value='True')",
        "Node(package='p', executable='a', condition=IfCondition(LaunchConfiguration('sim')))",
        "Node(package='p', executable='b', condition=UnlessCondition(LaunchConfiguration('sim')))",
        "Node(package='p', executable='c', condition=UnlessCondition(PythonExpression([LaunchConfiguration('sim')])))",
        "Node(package='p', executable='d', condition=LaunchConfigurationEquals('sim', 'True'))",
        "Node(package='p', executable='e', condition=LaunchConfigurationNotEquals('sim', 'True'))",
    )
    assert [each.executable for each in plan(text).processes] == ["a", "d"]


def test_a_chain_of_handlers_becomes_a_chain_of_conditions(plan: Plan) -> None:
    text = """
def generate_launch_description():
    create = Node(package='p', executable='create')
    first, second = Node(package='p', executable='first'), Node(package='p', executable='second')
    return LaunchDescription([
        create,
        RegisterEventHandler(OnProcessExit(target_action=create, on_exit=[first])),
        RegisterEventHandler(OnProcessExit(target_action=first, on_exit=[TimerAction(period=2.0, actions=[second])])),
        RegisterEventHandler(OnProcessStart(target_action=create, on_start=[Node(package='p', executable='beside')])),
        TimerAction(period=3, actions=[Node(package='p', executable='late')]),
    ])
"""
    found = {each.executable: each.condition for each in plan(text).processes}
    assert found == {
        "create": StartCondition(),
        "beside": StartCondition("start", 1),
        "late": StartCondition("begin", 0, 3.0),
        "first": StartCondition("exit", 1),
        "second": StartCondition("exit", 4, 2.0),
    }


def test_a_shutdown_at_the_end_of_a_process_ends_the_run(plan: Plan) -> None:
    text = description(
        "Node(package='p', executable='a', on_exit=Shutdown())",
        "Node(package='p', executable='b', respawn=True, respawn_delay=2.0)",
        "TimerAction(period=5.0, actions=[Shutdown(reason='done')])",
    )
    first, second, third = plan(text).processes
    assert (first.ends_run, first.respawn_delay) == (True, None)
    assert (second.ends_run, second.respawn_delay) == (False, 2.0)
    assert (third.kind, third.condition.delay) == ("shutdown", 5.0)


def test_the_launch_file_changes_nothing_of_the_process(plan: Plan) -> None:
    path, modules, variables = list(sys.path), set(sys.modules), dict(os.environ)
    text = "import sys\nos.environ['A_NEW_ONE'] = '1'\nsys.path.append('/nowhere')\nprint('read')\n" + description()
    assert "read" in plan(text).log
    assert (sys.path, dict(os.environ)) == (path, variables)
    assert "launch" not in sys.modules or "launch" in modules


def test_an_exception_has_the_line_of_the_launch_file(plan: Plan) -> None:
    with pytest.raises(LoadError) as error:
        plan("def generate_launch_description():\n    return LaunchDescription([nothing])\n")
    (problem,) = error.value.diagnostics
    assert (problem.code, problem.line) == ("SK-LAUNCH-002", 12)
    assert problem.message == "NameError: name 'nothing' is not defined"


def test_declared_arguments_are_known_without_a_start(tmp_path: Path) -> None:
    file = tmp_path / "a.launch.py"
    arguments = "DeclareLaunchArgument('map', choices=['a', 'b'])", "DeclareLaunchArgument('x', default_value='1')"
    file.write_text(HEADER + description(*arguments))
    first, second = declared_arguments(file)
    assert (first.name, first.default, first.choices) == ("map", None, ("a", "b"))
    assert (second.name, second.default) == ("x", "1")


def test_the_output_of_ros2_param_get_is_the_value_that_the_node_will_have(plan: Plan) -> None:
    """A robot's controller manager often takes its description from the node that is started before it."""
    text = description(
        "Node(package='robot_state_publisher', executable='robot_state_publisher',"
        " parameters=[{'robot_description': '<robot/>'}])",
        "Node(package='controller_manager', executable='ros2_control_node', parameters=[{'robot_description':"
        " Command('ros2 param get --hide-type /robot_state_publisher robot_description')}])",
    )
    found = plan(text)
    assert found.processes[1].parameters == ({"robot_description": "<robot/>"},)
    assert not messages(found)
