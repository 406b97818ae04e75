"""`simkit launch`, `simkit.launch` and the key `launch` of scenario files, on a robot with a node of its own."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner, Result

import simkit
from simkit.cli import app
from simkit.errors import LoadError
from simkit.testing import open_scenario, run_scenario
from simkit.testing.scenarios.scenario_file import read_scenario

ROBOT = """<robot name="cart">
  <link name="base"><inertial><mass value="2"/><inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size=".4 .3 .1"/></geometry></collision></link>
  <gazebo><plugin name="gz::sim::systems::VelocityControl" filename="gz-sim-velocity-control-system">
    <topic>cmd_vel</topic></plugin></gazebo>
</robot>"""

DRIVER = """import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.speed = self.declare_parameter("speed", 0.1).value
        self.publisher = self.create_publisher(Twist, "cmd_vel", 1)
        self.create_timer(0.1, self.drive)

    def drive(self):
        message = Twist()
        message.linear.x = self.speed
        self.publisher.publish(message)


def main():
    rclpy.init()
    rclpy.spin(Driver())


if __name__ == "__main__":
    main()
"""

LAUNCH = """import os
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

HERE = os.path.dirname(os.path.abspath(__file__))


def generate_launch_description():
    with open(os.path.join(HERE, "cart.urdf")) as file:
        description = file.read()
    gz = PathJoinSubstitution([FindPackageShare("ros_gz_sim"), "launch", "gz_sim.launch.py"])
    return LaunchDescription([
        DeclareLaunchArgument("speed", default_value="0.2", description="forward speed [m/s]"),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(gz), launch_arguments={"gz_args": "-r empty.sdf"}.items()
        ),
        Node(package="robot_state_publisher", executable="robot_state_publisher",
             parameters=[{"robot_description": description}]),
        Node(package="ros_gz_sim", executable="create",
             arguments=["-topic", "robot_description", "-name", "cart", "-z", "0.05"]),
        ExecuteProcess(cmd=["python3", os.path.join(HERE, "driver.py"), "--ros-args", "-p",
                            ["speed:=", LaunchConfiguration("speed")]]),
    ])
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a robot, its launch file and its node."""
    for name, text in (("cart.urdf", ROBOT), ("driver.py", DRIVER), ("cart.launch.py", LAUNCH)):
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def line(folder: Path) -> Callable[..., Result]:
    return lambda *words: CliRunner().invoke(app, list(map(str, words)))


def test_a_robot_is_spawned_and_driven_by_its_launch_file_alone(line: Callable[..., Result]) -> None:
    result = line("launch", "cart.launch.py", "speed:=0.3", "--duration", "2", "--until", "pose('cart').x > 0.3")
    assert result.exit_code == 0, result.output
    assert "until: pose('cart').x > 0.3" in result.output or "1." in result.output


def test_the_report_has_the_nodes_and_the_topics(line: Callable[..., Result]) -> None:
    report = json.loads(line("launch", "cart.launch.py", "--duration", "1", "--json").stdout)
    states = {node["name"]: node["state"] for node in report["nodes"]}
    assert states["robot_state_publisher"] == "running"
    assert states["create"] == "ended"
    assert {"/cmd_vel", "/robot_description", "/tf_static"} <= {topic["topic"] for topic in report["topics"]}


def test_the_arguments_are_listed_and_nothing_starts(line: Callable[..., Result]) -> None:
    shown = line("launch", "cart.launch.py", "--show-args").stdout
    assert shown.startswith(
        "Arguments (pass arguments as '<name>:=<value>'):\n\n    'speed':\n        forward speed [m/s]"
    )
    assert "(default: '0.2')" in shown


def test_the_printed_run_is_a_scenario_that_does_the_same(folder: Path, line: Callable[..., Result]) -> None:
    printed = line("launch", "cart.launch.py", "speed:=0.3", "--print").stdout
    assert [Path(node["program"]).name for node in yaml.safe_load(printed)["nodes"]] == [
        "robot_state_publisher",
        "create",
        "driver.py",
    ]
    (folder / "printed.yaml").write_text(printed, encoding="utf-8")
    scenario = read_scenario("printed.yaml", allow_code=True)
    launched = simkit.launch("cart.launch.py", {"speed": "0.3"})
    places = []
    for spec in (scenario, launched):
        with open_scenario(spec) as sim:
            run_scenario(spec.with_values({"duration": 1.0}), sim)
            places.append(sim.model("cart").pose.position.tolist())
    assert places[0] == places[1]
    assert places[0][0] == pytest.approx(0.3 * 0.9, abs=0.02)


@pytest.mark.slow
def test_a_scenario_runs_a_launch_file_with_permission_only(folder: Path) -> None:
    text = "launch: cart.launch.py\narguments: {speed: 0.5}\nduration: 1\n"
    (folder / "run.yaml").write_text(text, encoding="utf-8")
    (folder / "cart.launch.py").write_text(
        f"import pathlib; pathlib.Path('executed').touch()\n{LAUNCH}", encoding="utf-8"
    )
    refused = read_scenario("run.yaml")
    with pytest.raises(LoadError, match="launch names the launch file 'cart.launch.py'") as error:
        open_scenario(refused)
    assert [each.code for each in error.value.diagnostics] == ["SK-SCEN-008"]
    assert not (folder / "executed").exists()
    for spec in (read_scenario("run.yaml", allow_code=True), read_scenario("run.yaml", plugin_paths=[folder])):
        with open_scenario(spec) as sim:
            run_scenario(spec, sim)
            assert sim.model("cart").pose.position[0] == pytest.approx(0.5 * 0.9, abs=0.03)


def test_a_permission_for_a_folder_does_not_hold_for_nodes_elsewhere(folder: Path, tmp_path_factory: Any) -> None:
    elsewhere = tmp_path_factory.mktemp("elsewhere") / "driver.py"
    elsewhere.write_text(DRIVER, encoding="utf-8")
    text = LAUNCH.replace('os.path.join(HERE, "driver.py")', repr(str(elsewhere)))
    (folder / "cart.launch.py").write_text(text, encoding="utf-8")
    (folder / "run.yaml").write_text("launch: cart.launch.py\nduration: 1\n", encoding="utf-8")
    with pytest.raises(LoadError, match=r"the launch file starts the program .*driver\.py") as error:
        read_scenario("run.yaml", plugin_paths=[folder])
    assert error.value.diagnostics[0].file == str(folder / "cart.launch.py")


def test_no_command_for_worlds_starts_a_launch_file(line: Callable[..., Result], folder: Path) -> None:
    (folder / "w.launch").write_text("<launch><node pkg='a' type='b' name='c'/></launch>", encoding="utf-8")
    result = line("run", "w.launch")
    assert result.exit_code == 2
    assert "run it with `simkit launch FILE`" in result.output


def test_overrides_reach_the_robot_of_a_launch_file(line: Callable[..., Result]) -> None:
    """The robot is loaded with the world, so that a sweep can change it."""
    result = line("launch", "cart.launch.py", "--duration", "0.1", "--set", "cart::base.inertial.mass=9")
    assert result.exit_code == 0, result.output
    wrong = line("launch", "cart.launch.py", "--duration", "0.1", "--set", "cart::bas.inertial.mass=9")
    assert wrong.exit_code == 2


@pytest.mark.slow
def test_a_bundle_repeats_a_launched_run_without_its_nodes(line: Callable[..., Result], folder: Path) -> None:
    (folder / "run.yaml").write_text("launch: cart.launch.py\nduration: 1\n", encoding="utf-8")
    assert line("bundle", "run.yaml", "-o", "run.zip", "--allow-code").exit_code == 0
    replayed = line("replay", "run.zip")
    assert replayed.exit_code == 0, replayed.output
    assert "identical" in replayed.output


def test_strict_refuses_what_cannot_run(line: Callable[..., Result], folder: Path) -> None:
    (folder / "d.launch.xml").write_text("<launch>\n<node pkg='cpp' exec='driver'/>\n</launch>", encoding="utf-8")
    told = line("launch", "d.launch.xml", "--duration", "0.1")
    assert told.exit_code == 0
    assert "d.launch.xml:2: warning SK-LAUNCH-040" in told.output
    refused = line("launch", "d.launch.xml", "--duration", "0.1", "--strict")
    assert refused.exit_code == 2
    assert "SK-LAUNCH-040" in refused.output


def test_a_word_that_is_no_argument_is_a_usage_error(line: Callable[..., Result]) -> None:
    result = line("launch", "cart.launch.py", "x", "y")
    assert result.exit_code == 2
    assert "'x' is no argument" in result.output


RELAY = """import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

rclpy.init()
node = Node("relay")
publisher = node.create_publisher(Twist, "cmd_vel", 1)
node.create_subscription(Twist, "goal", publisher.publish, 1)
rclpy.spin(node)
"""


@pytest.mark.slow
def test_an_environment_of_gymnasium_acts_on_a_topic_that_a_node_creates(folder: Path) -> None:
    """Each episode waits for the topic, and both have the same bits."""
    (folder / "driver.py").write_text(RELAY, encoding="utf-8")
    with simkit.gym.make(
        simkit.launch("cart.launch.py"),
        observation={"x": "pose('cart').x"},
        action={"/goal": {"linear.x": (-1.0, 1.0)}},
        reward="pose('cart').x",
        time_limit=1.0,
    ) as env:
        ends: list[list[float]] = []
        for _ in range(2):
            env.reset(seed=1)
            ended = False
            while not ended:
                observation, _, _, ended, _ = env.step(np.array([0.5]))
            assert isinstance(observation, dict)
            ends.append(observation["x"].tolist())
    assert ends[0] == ends[1] == pytest.approx([0.5], abs=0.1)
