"""A plan of a launch file becomes one run: the world of its simulator, and programs with conditions."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

import pytest

from simkit import RunSpec
from simkit.diagnostics import Where
from simkit_launch.launch_plan import LaunchedProcess, LaunchPlan, StartCondition
from simkit_launch.run_plan import NO_WORLD, SHUTDOWN, run_spec_of
from simkit_launch.simulator_command import SimulatorCommand, simulator_command

TALKER = "import rclpy\nrclpy.init()\n"


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("gz", "sim", "-r", "-v", "4", "shapes.sdf"), SimulatorCommand("shapes.sdf")),
        (("gz", "sim", "-r -v4 shapes.sdf --seed 7"), SimulatorCommand("shapes.sdf", seed=7)),
        (("/usr/bin/gz", "sim", "-s -r", "'a b.sdf'"), SimulatorCommand("a b.sdf")),
        (("ign", "gazebo", "shapes.sdf"), SimulatorCommand("shapes.sdf", waits=True)),
        (("gz", "sim", "-g"), SimulatorCommand(is_client=True, waits=True)),
        (("gzserver", "-s", "libgazebo_ros_init.so", "--verbose", "w.world"), SimulatorCommand("w.world")),
        (("gzserver", "", "--ros-args", "--params-file", "p.yaml"), SimulatorCommand()),
        (("gzserver", "--ros-args", "-p", "a:=1", "--", "w.world"), SimulatorCommand("w.world")),
        (("gazebo", "--pause", "w.world"), SimulatorCommand("w.world", waits=True)),
        (("gzclient",), SimulatorCommand(is_client=True)),
        (("gz", "topic", "-l"), None),
        (("ros2", "topic", "list"), None),
    ],
)
def test_commands_that_start_a_simulator_are_known(words: tuple[str, ...], expected: SimulatorCommand | None) -> None:
    assert simulator_command(LaunchedProcess(1, "command", arguments=words)) == expected


@pytest.fixture
def talker(tmp_path: Path) -> str:
    (tmp_path / "talker.py").write_text(TALKER, encoding="utf-8")
    return str(tmp_path / "talker.py")


@pytest.fixture
def plan(tmp_path: Path) -> LaunchPlan:
    return LaunchPlan(tmp_path / "robot.launch.py")


def nodes_of(spec: RunSpec) -> list[dict[str, Any]]:
    return [dict(cast("Mapping[str, Any]", node)) for node in spec.nodes]


def test_a_launch_file_without_a_simulator_runs_in_an_empty_world(plan: LaunchPlan, talker: str) -> None:
    plan.processes.append(LaunchedProcess(1, "command", arguments=(talker, "--loud"), respawn_delay=2.0))
    spec = run_spec_of(plan)
    assert (spec.world, spec.name) == (NO_WORLD, "robot")
    assert nodes_of(spec) == [{"program": talker, "label": "talker.py-1", "args": ("--loud",), "respawn": 2.0}]


def test_a_command_with_the_path_of_an_installed_executable_is_the_executable(plan: LaunchPlan) -> None:
    program = str(plan.file.parent / "lib" / "topic_tools" / "relay")
    plan.processes.append(LaunchedProcess(1, "command", arguments=(program, "a", "b")))
    assert nodes_of(run_spec_of(plan)) == [{"program": "topic_tools/relay", "label": "relay-1", "args": ("a", "b")}]


def test_what_waits_for_a_left_out_process_waits_for_what_that_waited_for(plan: LaunchPlan, talker: str) -> None:
    """A process in C++ cannot run; the timers before and after it add up."""
    driver = LaunchedProcess(
        2, "node", "driver", "driver_node", condition=StartCondition("exit", 1, 2.0), where=Where("robot.launch.py", 7)
    )
    last = LaunchedProcess(3, "command", arguments=(talker,), condition=StartCondition("exit", 2, 3.0))
    plan.processes += [LaunchedProcess(1, "command", arguments=(talker,)), driver, last]
    nodes = nodes_of(run_spec_of(plan))
    assert [node["label"] for node in nodes] == ["talker.py-1", "talker.py-3"]
    assert (nodes[1]["after"], nodes[1]["delay"]) == ({"exit": "talker.py-1"}, 5.0)
    (warning,) = plan.diagnostics
    assert (warning.code, warning.line) == ("SK-LAUNCH-040", 7)
    assert "driver/driver_node does not run here" in warning.message
    assert "starts without it" in warning.message


def test_parameters_remaps_and_names_are_those_of_the_node(plan: LaunchPlan, talker: str) -> None:
    speaker = LaunchedProcess(
        1,
        "command",
        arguments=(talker,),
        name="speaker",
        namespace="/robot",
        parameters=(Path("/p/one.yaml"), {"rate": 2.0, "gains": {"p": 1}}, {"rate": 3.0}),
        remappings=(("chatter", "speech"), ("chatter", "second")),
        environment={"MODEL": "waffle"},
        ends_run=True,
    )
    plan.processes.append(speaker)
    assert nodes_of(run_spec_of(plan)) == [
        {
            "program": talker,
            "label": "speaker-1",
            "name": "speaker",
            "namespace": "/robot",
            "remap": {"chatter": "speech"},
            "params": {"rate": 3.0, "gains": {"p": 1}},
            "args": ("--ros-args", "--params-file", "/p/one.yaml"),
            "ends_run": True,
            "env": {"MODEL": "waffle"},
        }
    ]


def test_an_end_of_the_launch_is_a_node_that_ends_the_run(plan: LaunchPlan, talker: str) -> None:
    end = LaunchedProcess(2, "shutdown", condition=StartCondition("exit", 1))
    plan.processes += [LaunchedProcess(1, "command", arguments=(talker,)), end]
    assert nodes_of(run_spec_of(plan))[1] == {
        "program": SHUTDOWN,
        "label": "shutdown-2",
        "after": {"exit": "talker.py-1"},
        "ends_run": True,
    }


def test_the_first_world_counts_and_a_second_simulator_is_told(plan: LaunchPlan) -> None:
    for number, world in enumerate(("shapes.sdf", "two.sdf"), 1):
        plan.processes.append(LaunchedProcess(number, "command", arguments=("gz", "sim", "-r", world)))
    assert Path(run_spec_of(plan).world).name == "shapes.sdf"
    assert [each.code for each in plan.diagnostics] == ["SK-LAUNCH-042"]


def test_a_node_whose_name_is_not_valid_is_left_out_and_the_others_run(plan: LaunchPlan, talker: str) -> None:
    """In ROS the program ends at once."""
    plan.processes.append(LaunchedProcess(1, "command", arguments=(talker,), name="talker_/"))
    plan.processes.append(LaunchedProcess(2, "command", arguments=(talker,)))
    assert [node["label"] for node in nodes_of(run_spec_of(plan))] == ["talker.py-2"]
    (warning,) = plan.diagnostics
    assert warning.code == "SK-LAUNCH-040"
    assert "'talker_/'" in warning.message


def test_a_later_parameter_file_replaces_an_earlier_value(plan: LaunchPlan, talker: str, tmp_path: Path) -> None:
    """As in ROS; values that no later file has stay with the node."""
    file = tmp_path / "late.yaml"
    file.write_text("/**: {ros__parameters: {rate: 5.0}}\n", encoding="utf-8")
    early = ({"rate": 2.0}, file, {"gain": 1})
    plan.processes.append(LaunchedProcess(1, "command", arguments=(talker,), parameters=early))
    plan.processes.append(LaunchedProcess(2, "command", arguments=(talker,), parameters=({"gain": 1}, file)))
    first, second = nodes_of(run_spec_of(plan))
    assert first["params"] == {"gain": 1}
    written = Path(first["args"][2])
    assert written.read_text(encoding="utf-8") == "/**:\n  ros__parameters:\n    rate: 2.0\n"
    assert first["args"][3:] == ("--params-file", str(file))
    assert second["params"] == {"gain": 1}
    assert second["args"] == ("--ros-args", "--params-file", str(file))
