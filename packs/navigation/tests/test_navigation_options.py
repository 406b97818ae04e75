"""`simkit run WORLD --nav --slam`, and parameter files of Nav2 for plugins and nodes of a run."""

from __future__ import annotations

from pathlib import Path

import pytest
from navigation_worlds import pose, run_until_done
from rooms import rooms
from typer.testing import CliRunner, Result

import simkit
from simkit.cli import app
from simkit_navigation.navigation_nodes import MAP_MODEL, default_parameters, navigation_nodes

SERVERS = """<plugin filename="libsimkit_costmap_2d.so" name="global_costmap"/>
<plugin filename="libsimkit_planner_server.so" name="planner_server">{}</plugin>"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder with a world, which is the working folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "rooms.sdf").write_text(world(), "utf-8")
    return tmp_path


def world(more: str = "") -> str:
    """Return the rooms with a robot and without a map server and AMCL."""
    text = rooms()
    return text[: text.index('<plugin filename="libsimkit_map_server.so"')] + more + "</world></sdf>"


def run(*words: str) -> Result:
    return CliRunner().invoke(app, ["run", *words])


def parameters(**blocks: str) -> str:
    """Return a parameter file."""
    return "".join(f"{name}:\n  ros__parameters:\n{lines}" for name, lines in blocks.items())


@pytest.mark.slow  # a drive
def test_a_robot_reaches_a_goal_on_the_true_map(folder: Path) -> None:
    with simkit.load("rooms.sdf", spawn=[{"model": MAP_MODEL}]) as sim:
        for node in navigation_nodes():
            sim.add_node(**node)
        sim.run(1.0)
        task = sim.send_goal("/navigate_to_pose", {"pose": pose(2.2, 1.2)})
        run_until_done(sim, task)
        assert task.status.name == "SUCCEEDED"
        x, y, _ = sim.model("robot").pose.position
        assert abs(x - 2.2) < 0.3 and abs(y - 1.2) < 0.3
        sim.check_nodes()


@pytest.mark.slow
def test_the_option_adds_the_servers_of_nav2_and_localises_the_robot_where_it_is(folder: Path) -> None:
    found = run("rooms.sdf", "--nav", "--duration", "2", "--assert", "topic('/amcl_pose').pose.pose.position.x > 0.9")
    assert found.exit_code == 0, found.output
    assert "node planner_server: running" in found.output and "node velocity_smoother: running" in found.output


def test_a_map_that_does_not_exist_is_an_error_before_anything_is_loaded(folder: Path) -> None:
    found = run("rooms.sdf", "--nav", "lost.yaml", "--duration", "1")
    assert found.exit_code == 2 and "SK-NAV-020 there is no map lost.yaml" in found.output


def test_a_map_and_slam_exclude_each_other(folder: Path) -> None:
    found = run("rooms.sdf", "--nav", "rooms.yaml", "--slam", "--duration", "1")
    assert found.exit_code == 2 and "SK-NAV-020 found --nav rooms.yaml and --slam" in found.output


def test_a_parameter_file_of_nav2_replaces_that_of_simkit(folder: Path) -> None:
    (folder / "nav2.yaml").write_text(parameters(planner_server="    planner_plugins: [Mine]\n"), "utf-8")
    (folder / "arm.yaml").write_text(parameters(arm_controller="    joints: [a]\n"), "utf-8")
    default = ["--ros-args", "--params-file", str(default_parameters())]
    assert all(node["args"] == default for node in navigation_nodes(params_files=["arm.yaml"]))
    assert not any("args" in node for node in navigation_nodes(params_files=["arm.yaml", "nav2.yaml"]))


def test_a_collision_monitor_of_the_parameter_file_is_the_last_of_the_velocities(folder: Path) -> None:
    (folder / "nav2.yaml").write_text(parameters(collision_monitor="    polygons: []\n"), "utf-8")
    without, with_monitor = navigation_nodes(), navigation_nodes(params_files=["nav2.yaml"])
    smoothers = [
        next(node for node in nodes if "velocity_smoother" in node["program"]) for nodes in (without, with_monitor)
    ]
    assert smoothers[0]["remap"]["cmd_vel_smoothed"] == "cmd_vel" and "cmd_vel_smoothed" not in smoothers[1]["remap"]
    assert with_monitor[-1]["params"]["node_names"][-1] == "collision_monitor"


def test_plugins_of_navigation_read_the_blocks_of_their_nodes(folder: Path) -> None:
    lines = (
        "    planner_plugins: [Mine]\n    Mine:\n      plugin: nav2_navfn_planner/NavfnPlanner\n      tolerance: 0.7\n"
    )
    (folder / "nav2.yaml").write_text(parameters(planner_server=lines), "utf-8")
    with simkit.load(world(SERVERS.format("")), params_files="nav2.yaml") as sim:
        assert sim.plugins["planner_server"].parts["Mine"]._options.tolerance == 0.7
        assert not [item for item in sim.diagnostics if item.severity == "warning"]


def test_a_file_in_the_ros_block_is_read_after_that_of_the_run(folder: Path) -> None:
    for name, value in (("run.yaml", 0.7), ("own.yaml", 0.3)):
        lines = f"    planner_plugins: [GridBased]\n    GridBased:\n      tolerance: {value}\n"
        (folder / name).write_text(parameters(planner_server=lines), "utf-8")
    (folder / "w.sdf").write_text(
        world(SERVERS.format("<ros><argument>--params-file own.yaml</argument></ros>")), "utf-8"
    )
    with simkit.load("w.sdf", params_files="run.yaml") as sim:
        assert sim.plugins["planner_server"].parts["GridBased"]._options.tolerance == 0.3


def test_problems_of_a_parameter_file_have_its_lines(folder: Path) -> None:
    lines = "    wrong: 1\n    planner_plugins: [GridBased]\n    GridBased:\n      tolerance: -1\n"
    (folder / "nav2.yaml").write_text(parameters(planner_server=lines), "utf-8")
    (folder / "w.sdf").write_text(world(SERVERS.format("")), "utf-8")
    found = run("w.sdf", "--params-file", "nav2.yaml", "--duration", "0.1")
    assert found.exit_code == 2
    assert "nav2.yaml:6: error SK-PARAM-002: found <tolerance>-1</tolerance>" in found.output
    assert "nav2.yaml:3: warning SK-NAV-002: plugin 'planner_server': no effect here: wrong" in found.output


@pytest.mark.slow
def test_a_server_with_an_invalid_parameter_ends_the_run_and_the_log_names_the_line(folder: Path) -> None:
    lines = "    planner_plugins: [GridBased]\n    GridBased:\n      tolerance: -1\n"
    (folder / "nav2.yaml").write_text(parameters(planner_server=lines), "utf-8")
    found = run("rooms.sdf", "--nav", "--params-file", "nav2.yaml", "--duration", "60")
    assert found.exit_code == 4
    assert "nav2.yaml:5: " in found.output and "Failed to change state for node: planner_server" in found.output


def test_parameter_files_of_a_run_reach_its_nodes_before_their_own_arguments(folder: Path) -> None:
    (folder / "talker.py").write_text(
        "import rclpy\n"
        "rclpy.init()\n"
        "node = rclpy.create_node('talker')\n"
        "values = [node.declare_parameter(name, 0.0).value for name in ('speed', 'turn')]\n"
        "node.get_logger().info(f'values {values}')\n",
        "utf-8",
    )
    (folder / "run.yaml").write_text(parameters(talker="    speed: 0.7\n    turn: 0.1\n"), "utf-8")
    node = ("--node", "talker.py", "--ros-args", "-p", "turn:=0.4", "--")
    found = run("empty", *node, "--params-file", "run.yaml", "--duration", "0.1")
    assert "values [0.7, 0.4]" in found.output and "SK-CONTROL-060" not in found.output
    assert "SK-CONTROL-060" in run("empty", "--params-file", "run.yaml", "--duration", "0.1").output


def test_an_element_of_the_world_comes_before_a_default_of_nav2(folder: Path) -> None:
    nested = "global_costmap:\n  global_costmap:\n    ros__parameters:\n      robot_radius: 0.3\n"
    (folder / "nav2.yaml").write_text(nested, "utf-8")
    frame = "<robot_base_frame>base_footprint</robot_base_frame><footprint_padding>0</footprint_padding>"
    text = SERVERS.format("").replace('name="global_costmap"/>', f'name="global_costmap">{frame}</plugin>')
    with simkit.load(world(text), params_files="nav2.yaml") as sim:
        costmap = sim.plugins["global_costmap"]
        assert costmap.options.robot_base_frame == "base_footprint"
        assert costmap.inscribed_radius == pytest.approx(0.3, abs=0.005)  # of a polygon around the circle


def test_the_map_of_slam_has_the_frame_of_the_world(folder: Path) -> None:
    with simkit.load("rooms.sdf") as sim:
        for node in navigation_nodes(navigates=False, makes_map=True):
            sim.add_node(**node)
        frames = sim.tf  # transforms are kept from here on
        sim.run(1.5)
        pose = frames.lookup("map", "base_footprint")
        x, y, _ = sim.model("robot").pose.position
        assert pose.position[:2] == pytest.approx((x, y), abs=0.01) and pose.rpy[2] == pytest.approx(0.5, abs=0.01)


def test_a_strict_run_reads_parameter_files_of_nodes_and_a_value_of_another_type_has_the_default(folder: Path) -> None:
    lines = "    smoothing_frequency: 30\n    max_velocity: fast\n"
    text = parameters(velocity_smoother=lines, planner_server="    planner_plugins: [GridBased]\n")
    (folder / "nav2.yaml").write_text(text, "utf-8")
    found = run("rooms.sdf", "--nav", "--params-file", "nav2.yaml", "--strict", "--duration", "0.1")
    assert found.exit_code == 0 and "SK-CONTROL-060" not in found.output and "Traceback" not in found.output
    assert "nav2.yaml:3: warning SK-NAV-005: /velocity_smoother: smoothing_frequency is 30" in found.output
    assert "nav2.yaml:4: warning SK-NAV-005: /velocity_smoother: max_velocity is 'fast'" in found.output


def test_a_map_with_an_invalid_value_is_an_error_before_anything_is_loaded(folder: Path) -> None:
    (folder / "bad.yaml").write_text("image: bad.pgm\nresolution: 0\norigin: [0, 0, 0]\n", "utf-8")
    found = run("rooms.sdf", "--nav", "bad.yaml", "--duration", "1")
    assert found.exit_code == 2 and "SK-NAV-020 bad.yaml: resolution: found 0" in found.output


def test_a_world_without_a_lidar_is_a_warning(folder: Path) -> None:
    found = run("empty", "--slam", "--duration", "0.1")
    assert "SK-NAV-021: --slam: the world has no laser scan and no odometry" in found.output
    assert "SK-NAV-021" not in run("rooms.sdf", "--slam", "--duration", "0.1").output


def test_a_reset_of_a_run_with_servers_repeats_it_bit_for_bit(folder: Path) -> None:
    with simkit.load("rooms.sdf", spawn=[{"model": MAP_MODEL}]) as sim:
        for node in navigation_nodes(navigates=False):
            sim.add_node(**node)
        transforms = sim.subscribe("/tf")

        def messages() -> list[object]:
            count = len(transforms.messages)
            sim.run(0.7)
            return transforms.messages[count:]

        first = messages()
        sim.reset()
        assert messages() == first


def test_blocks_that_no_server_reads_are_told(folder: Path) -> None:
    other = "robot1:\n  planner_server:\n    ros__parameters: {planner_plugins: [A]}\n"
    (folder / "nav2.yaml").write_text(other + parameters(local_costmap="    width: 5\n"), "utf-8")
    found = run("rooms.sdf", "--nav", "--params-file", "nav2.yaml", "--duration", "0.3")
    assert "nav2.yaml: warning SK-NAV-022: the parameters of /robot1/planner_server are not used" in found.output
    text = "no effect here: width of local_costmap; write local_costmap: {local_costmap: {ros__parameters: …}}"
    assert "nav2.yaml:6: warning SK-NAV-002" in found.output and text in found.output
