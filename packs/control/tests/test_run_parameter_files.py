"""`--params-file`: controllers of robots whose plugin names no file."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import pytest
from control_robots import CLASSIC, POSITIONS, arm, command, position, reported_messages, states
from test_ros_1_control import ROS_1, transmissions
from typer.testing import CliRunner

import simkit
from simkit.cli import app
from simkit.errors import LoadError
from simkit.testing import count_left_out

OF_ROS_1 = """
joint_state_controller: {type: joint_state_controller/JointStateController, publish_rate: 50}
arm_controller:
  type: position_controllers/JointGroupPositionController
  joints: [j1, j2]
"""
PIDS = "gazebo_ros_control: {pid_gains: {j1: {p: 100.0, i: 0.0, d: 20.0}}}\n"
DECLARED = {"joint_state_controller": "running", "arm_controller": "running"}


def saved(folder: Path, yaml: str, name: str = "given.yaml") -> Path:
    path = folder / name
    path.write_text(dedent(yaml), encoding="utf-8")
    return path


def robot_of_ros_1(namespace: str = "<robotNamespace/>") -> str:
    return arm("", namespace, ROS_1, more=transmissions("PositionJointInterface"))


def sent(sim: simkit.Simulation, topic: str, *values: float) -> None:
    sim.publish(topic, simkit.msgs.make("std_msgs/msg/Float64MultiArray", data=list(values)))


def test_a_ros_1_robot_runs_the_controllers_of_a_given_file(tmp_path: Path) -> None:
    with simkit.load(robot_of_ros_1(), params_files=[saved(tmp_path, OF_ROS_1)]) as sim:
        assert states(sim) == DECLARED
        assert not reported_messages(sim, "SK-CONTROL-018")
        sent(sim, "/arm_controller/command", 0.4, -0.2)
        sim.run(2.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.4, -0.2], abs=1e-3)


def test_a_ros_1_file_is_below_the_robots_namespace_with_or_without_its_name(tmp_path: Path) -> None:
    """As `<group ns="...">` of a launch file puts it there."""
    plain = saved(tmp_path, OF_ROS_1 + PIDS)
    inside = saved(tmp_path, "r:\n" + "".join(f"  {line}\n" for line in (OF_ROS_1 + PIDS).splitlines()), "in.yaml")
    ends = []
    for path in (plain, inside):
        with simkit.load(robot_of_ros_1("<robotNamespace>/r</robotNamespace>"), params_files=path) as sim:
            assert states(sim, "/r/controller_manager") == DECLARED
            sent(sim, "/r/arm_controller/command", 0.5, 0.0)
            sim.run(5.0)
            ends.append(position(sim, "j1")[0])
    assert ends[0] == ends[1] > 0.51  # its loop has no integral: it gives way to the weight


def test_several_files_are_merged_and_the_later_overrides_the_earlier(tmp_path: Path) -> None:
    over = saved(tmp_path, "arm_controller: {joints: [j2]}\n", "over.yaml")
    with simkit.load(robot_of_ros_1(), params_files=[saved(tmp_path, OF_ROS_1), over]) as sim:
        sent(sim, "/arm_controller/command", 0.3)
        sim.run(2.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.0, 0.3], abs=1e-3)


def test_a_given_file_overrides_the_file_of_a_ros_2_plugin(tmp_path: Path) -> None:
    saved(tmp_path, POSITIONS, "arm.yaml")
    (tmp_path / "arm.urdf").write_text(arm(), encoding="utf-8")
    given = saved(tmp_path, "/arm_controller: {ros__parameters: {joints: [j2]}}\n")
    with simkit.load(tmp_path / "arm.urdf", params_files=[given]) as sim:
        command(sim, "arm_controller", 0.3)
        sim.run(2.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.0, 0.3], abs=1e-3)


def test_a_ros_2_file_works_for_a_ros_1_robot(tmp_path: Path) -> None:
    for namespace, below in (("<robotNamespace/>", ""), ("<robotNamespace>/r</robotNamespace>", "/r")):
        with simkit.load(robot_of_ros_1(namespace), params_files=[saved(tmp_path, POSITIONS)]) as sim:
            assert states(sim, f"{below}/controller_manager") == {
                "joint_state_broadcaster": "running",
                "arm_controller": "running",
            }


def test_a_ros_1_file_works_for_a_ros_2_robot_except_its_gains(tmp_path: Path) -> None:
    with simkit.load(arm(plugin="", library=CLASSIC), params_files=[saved(tmp_path, OF_ROS_1 + PIDS)]) as sim:
        assert states(sim) == dict.fromkeys(DECLARED, "active")
        assert "gazebo_ros_control has gains for the plugin of ROS 1" in reported_messages(sim, "SK-CONTROL-011")[0]
        command(sim, "arm_controller", 0.4, -0.2)
        sim.run(2.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.4, -0.2], abs=1e-3)


def test_a_file_can_be_limited_to_a_model_that_is_spawned_later(tmp_path: Path) -> None:
    path, robot = saved(tmp_path, OF_ROS_1), tmp_path / "r.urdf"
    robot.write_text(robot_of_ros_1(""), encoding="utf-8")  # the namespace is the model's name
    spawn = [f"{robot}:0,0,0:one", f"{robot}:0,3,0:two"]
    with simkit.load("empty", spawn=spawn, params_files=[f"two={path}", ("three", path)]) as sim:
        assert states(sim, "/one/controller_manager") == {}
        assert states(sim, "/two/controller_manager") == DECLARED
        assert "given.yaml is for the model 'three'" in reported_messages(sim, "SK-CONTROL-060")[0]
        sim.spawn(robot, name="three")
        assert states(sim, "/three/controller_manager") == DECLARED
        sim.reset()
        assert states(sim, "/two/controller_manager") == DECLARED


def test_an_unused_file_is_a_warning(tmp_path: Path) -> None:
    path = saved(tmp_path, OF_ROS_1)
    with simkit.load("empty", params_files=[path]) as sim:
        assert "no model has a control plugin" in reported_messages(sim, "SK-CONTROL-060")[0]
    with simkit.load(robot_of_ros_1(), params_files=[f"amr={path}"]) as sim:
        (found,) = (d for d in sim.diagnostics if d.code == "SK-CONTROL-060")
        assert "'arm'" in found.hint
        assert "--params-file" in next(d.hint for d in sim.diagnostics if d.code == "SK-CONTROL-018")


def test_a_wrong_value_is_reported_with_its_text_and_the_file_counts_as_used(tmp_path: Path) -> None:
    path = saved(tmp_path, "controller_manager: {ros__parameters: {update_rate: fast}}\n")
    with pytest.raises(LoadError) as caught:
        simkit.load("empty", spawn=["tiago:0,0,0"], params_files=[path])
    errors = [d for d in caught.value.diagnostics if d.severity != "note"]
    assert [d.code for d in errors] == ["SK-PARAM-002"]
    assert "found update_rate: fast; expected a number" in errors[0].message


def test_missing_and_broken_files_stop_the_load_all_in_one_pass(tmp_path: Path) -> None:
    broken = saved(tmp_path, "arm_controller: [\n")
    with pytest.raises(LoadError) as raised:
        simkit.load(robot_of_ros_1(), params_files=[tmp_path / "givn.yaml", broken, "package://nowhere/x.yaml"])
    found = [d for d in raised.value.diagnostics if d.severity == "error"]
    assert [d.code for d in found] == ["SK-CONTROL-015", "SK-CONTROL-002", "SK-CONTROL-015"]
    assert "given.yaml" in found[0].hint
    assert found[1].file == str(broken)


def test_a_file_of_two_robots_is_broken_once(tmp_path: Path) -> None:
    robot = tmp_path / "r.urdf"
    robot.write_text(robot_of_ros_1(""), encoding="utf-8")
    spawn, path = [f"{robot}:0,0,0:one", f"{robot}:0,3,0:two"], saved(tmp_path, "[a]")
    with pytest.raises(LoadError) as raised:
        simkit.load("empty", spawn=spawn, params_files=[path, path])
    assert [d.code for d in raised.value.diagnostics if d.severity == "error"] == ["SK-CONTROL-002"]


def test_the_command_line_accepts_a_parameter_file(tmp_path: Path) -> None:
    (tmp_path / "r.urdf").write_text(robot_of_ros_1(), encoding="utf-8")
    path = saved(tmp_path, OF_ROS_1)
    words = ["run", str(tmp_path / "r.urdf"), "--duration", "0.2", "--params-file"]
    done = CliRunner().invoke(app, [*words, str(path)])
    assert done.exit_code == 0 and "/joint_states" in done.stdout
    for word in (f"r={tmp_path}/none.yaml", "none.yaml", str(saved(tmp_path, "a: {", "broken.yaml"))):
        done = CliRunner().invoke(app, [*words, word])
        assert done.exit_code == 2 and "SK-CONTROL-0" in done.stderr


def test_diagnostics_of_a_model_spawned_during_the_load_are_reported(tmp_path: Path) -> None:
    robot, words = tmp_path / "r.urdf", "<parameters>arm.yaml</parameters>"
    robot.write_text(robot_of_ros_1("<controlPeriode>1</controlPeriode>"), encoding="utf-8")
    with simkit.load("empty", spawn=[f"{robot}:0,0,0"]) as sim:
        assert (
            reported_messages(sim, "SK-CONTROL-018") and "<controlPeriode>" in reported_messages(sim, "SK-PARAM-003")[0]
        )
    saved(tmp_path, "[a]", "arm.yaml")
    robot.write_text(robot_of_ros_1(words), encoding="utf-8")
    with pytest.raises(LoadError, match="SK-CONTROL-002"):
        simkit.load("empty", spawn=[f"{robot}:0,0,0"])


def test_more_errors_than_the_limit_in_a_parameter_file_are_errors_of_the_file(tmp_path: Path) -> None:
    names = "[" + ", ".join(["0.5"] * 1200) + "]"
    text = OF_ROS_1.replace("position_controllers/JointGroupPositionController", "TYPE").replace("[j1, j2]", names)
    path = saved(tmp_path, text.replace("TYPE", "position_controllers/JointTrajectoryController"))
    with pytest.raises(LoadError, match="SK-CONTROL-024"):
        simkit.load(robot_of_ros_1(), params_files=[path])


def test_the_path_of_a_parameter_file_can_have_spaces(tmp_path: Path) -> None:
    folder = tmp_path / "my robots"
    folder.mkdir()
    text = "controller_manager:\n  ros__parameters:\n    b: {type: joint_state_broadcaster/JointStateBroadcaster}\n"
    saved(folder, text, "arm.yaml")
    (tmp_path / "robot.urdf").write_text(arm(plugin="<parameters>my robots/arm.yaml</parameters>"))
    with simkit.load(tmp_path / "robot.urdf") as sim:
        assert states(sim) == {"b": "active"}


@pytest.mark.leaves_out
def test_a_controller_with_errors_is_left_out_but_not_if_the_user_named_its_file(tmp_path: Path) -> None:
    saved(tmp_path, POSITIONS.replace("j2", "j7"), "arm.yaml")
    (tmp_path / "arm.urdf").write_text(arm(), encoding="utf-8")
    with simkit.load(tmp_path / "arm.urdf") as sim:
        assert next(iter(count_left_out(sim.diagnostics))).startswith("controller 'arm_controller' (")
    given = saved(tmp_path, "/arm_controller: {ros__parameters: {joints: [j1, j8]}}\n")
    with pytest.raises(LoadError) as caught:
        simkit.load(tmp_path / "arm.urdf", params_files=[given])
    (error,) = {(d.code, d.file) for d in caught.value.diagnostics if d.severity == "error"}
    assert error == ("SK-CONTROL-012", str(given))


@pytest.mark.leaves_out
def test_a_controller_of_a_type_of_the_repository_is_told_at_the_end_of_a_run_again(tmp_path: Path) -> None:
    own = POSITIONS.replace("position_controllers/JointGroupPositionController", "my_robot/ArmController")
    saved(tmp_path, own, "arm.yaml")
    (tmp_path / "arm.urdf").write_text(arm(), encoding="utf-8")
    with simkit.load(tmp_path / "arm.urdf") as sim:
        assert count_left_out(sim.diagnostics) == {"controller 'arm_controller' (type 'my_robot/ArmController')": 1}
    result = CliRunner().invoke(app, ["run", str(tmp_path / "arm.urdf"), "--duration", "0.01"])
    assert result.exit_code == 0 and result.output.count("SK-CONTROL-013") == 2
