"""Known programs that spawn and remove models: `create`, `spawn_entity.py`, `spawn_model`, `remove`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import simkit
from simkit import Simulation
from simkit.testing.scenarios.scenario_run import open_scenario

FOLDER = Path(__file__).with_name("worlds")
WORLD = (FOLDER / "field.sdf").read_text()
ROBOT = (FOLDER / "cart.urdf").read_text()

CREATE = "ros_gz_sim/create"
STATES = "robot_state_publisher/robot_state_publisher"


@pytest.fixture
def sim() -> Iterator[Simulation]:
    with simkit.load(WORLD) as simulation:
        yield simulation


@pytest.fixture
def file(tmp_path: Path) -> str:
    """File with the robot."""
    path = tmp_path / "cart.urdf"
    path.write_text(ROBOT)
    return str(path)


def test_create_waits_for_the_description_on_its_topic(sim: Simulation) -> None:
    words = ["-topic", "robot_description", "-name", "cart", "-x", "1", "-y=2", "--z", "0.5", "-Y", "1.5"]
    create = sim.add_node(CREATE, args=words)
    sim.run(2.5)
    assert "cart" not in sim.models
    assert sum("Waiting messages on topic [robot_description]." in line for line in create.log) == 3
    sim.add_node(STATES, params={"robot_description": ROBOT})
    sim.run(0.01)
    assert sim.models["cart"].pose.position == pytest.approx([1, 2, 0.5], abs=0.01)
    assert sim.models["cart"].pose.rpy[2] == pytest.approx(1.5, abs=0.01)
    assert (create.done, create.exit_code) == (True, 0)
    assert create.log[-1].endswith("Entity creation successfull.")


def test_a_second_model_of_a_name_is_an_error_or_gets_a_number(sim: Simulation, file: str) -> None:
    nodes = [sim.add_node(CREATE, args=["-file", file, *more]) for more in ([], [], ["-allow_renaming", "true"])]
    sim.run(0.01)
    assert [node.exit_code for node in nodes] == [0, 1, 0]
    assert "a model 'cart' already exists" in nodes[1].log[-1]
    assert list(sim.models) == ["ground", "cart", "cart_0"]


def test_create_takes_parameters_of_its_node_before_its_command_line(sim: Simulation, file: str) -> None:
    params = {"string": ROBOT, "name": "first", "x": 3.0}
    sim.add_node(CREATE, params=params, args=["-file", file, "-name", "second", "-y", "1"])
    sim.run(0.01)
    assert sim.models["first"].pose.position[:2] == pytest.approx([3, 1], abs=0.01)


def test_a_file_that_does_not_exist_and_an_unknown_flag_end_create(sim: Simulation) -> None:
    missing = sim.add_node(CREATE, args=["-file", "no.urdf"])
    unknown = sim.add_node(CREATE, args=["-fil", "no.urdf"])
    nothing = sim.add_node(CREATE)
    sim.run(0.01)
    assert missing.exit_code == 1 and any("SK-LOAD-002" in line for line in missing.log)
    assert unknown.exit_code == 1 and "unknown command line flag 'fil'" in unknown.log[-1]
    assert nothing.exit_code == 255 and "Must specify either -file" in nothing.log[-1]


def test_a_world_of_another_name_is_reported_and_that_of_the_run_is_taken(sim: Simulation, file: str) -> None:
    create = sim.add_node(CREATE, args=["-file", file, "-world", "empty"])
    sim.run(0.1)
    assert create.exit_code == 0 and "cart" in sim.models
    (report,) = [report for report in sim.diagnostics if report.code == "SK-LAUNCH-060"]
    assert "'empty' is named, such as by ros_gz_sim, but the run has 'field'" in report.message


def test_spawn_entity_of_classic_sets_pose_namespace_and_joints(sim: Simulation, file: str) -> None:
    words = ["-entity", "bot", "-x", "1", "-z", "0.3", "-robot_namespace", "/r1", "-J", "left_joint", "0.5", "-file"]
    node = sim.add_node("gazebo_ros/spawn_entity.py", args=[*words, file])
    sim.run(0.01)
    assert node.exit_code == 0
    assert sim.joint("bot::left_joint").position == pytest.approx(0.5, abs=0.01)
    assert "Spawn status: SpawnEntity: Successfully spawned entity [bot]" in "\n".join(node.log)


def test_spawn_entity_fails_as_the_original(sim: Simulation, file: str) -> None:
    first = sim.add_node("gazebo_ros/spawn_entity.py", args=["-entity", "ground", "-file", file])
    second = sim.add_node("gazebo_ros/spawn_entity.py", args=["-file", file])
    sim.run(0.01)
    assert first.exit_code == 1 and first.log[-1].endswith("Spawn service failed. Exiting.")
    assert second.exit_code == 2 and "the following arguments are required: -entity" in second.log[-1]


def test_spawn_model_of_ros_1_reads_a_parameter(sim: Simulation) -> None:
    missing = sim.add_node("gazebo_ros/spawn_model", args=["-urdf", "-param", "description", "-model", "a"])
    sim.run(0.01)
    assert missing.exit_code == 1 and "param does not exist" in missing.log[-1]
    sim.add_node(f"{Path(__file__).with_name('programs') / 'set_description.py'}", args=[ROBOT])
    sim.run(0.01)
    found = sim.add_node("gazebo_ros/spawn_model", args=["-urdf", "-param", "description", "-model", "b", "-y", "2"])
    sim.run(0.01)
    assert found.exit_code == 0, found.log
    assert sim.models["b"].pose.position[1] == pytest.approx(2, abs=0.01)


def test_remove_removes_a_model(sim: Simulation) -> None:
    node = sim.add_node("ros_gz_sim/remove", params={"entity_name": "ground"})
    again = sim.add_node("ros_gz_sim/remove", params={"entity_name": "ground"})
    sim.run(0.01)
    assert (node.exit_code, again.exit_code, list(sim.models)) == (0, 1, [])


def test_a_launch_file_that_only_spawns_has_level_ground(tmp_path: Path, file: str) -> None:
    launch_file = tmp_path / "spawn.launch"
    words = f"-urdf -file {file} -model cart -z 0.05"
    node = f'<node name="spawn" pkg="gazebo_ros" type="spawn_model" args="{words}"/>'
    launch_file.write_text(f"<launch>{node}</launch>")
    with open_scenario(simkit.launch(launch_file)) as sim:
        sim.run(1.0)
        assert sim.models["cart"].pose.position[2] == pytest.approx(0, abs=0.01)
