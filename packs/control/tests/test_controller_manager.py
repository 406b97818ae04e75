"""Controller manager: loading, claims, services, reset and restore."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pytest
from control_robots import ALL, POSITIONS, arm, command, files, interfaces, opened, position, reported_messages, states

import simkit

TWO = """
controller_manager:
  ros__parameters:
    update_rate: 100
    by_position: {type: position_controllers/JointGroupPositionController}
    by_effort: {type: effort_controllers/JointGroupEffortController}
by_position:
  ros__parameters: {joints: [j1, j2]}
by_effort:
  ros__parameters: {joints: [j2]}
"""
ALL_THREE = "".join(f'<joint name="{j}">{interfaces(ALL)}</joint>' for j in ("j1", "j2"))
SWITCH = "/controller_manager/switch_controller"


def switch(
    sim: simkit.Simulation, *, on: list[str] | None = None, off: list[str] | None = None, strict: int = 2
) -> bool:
    request = {"activate_controllers": on or [], "deactivate_controllers": off or [], "strictness": strict}
    return bool(sim.call(SWITCH, request).ok)


def test_controllers_of_the_file_are_loaded_and_active_in_their_order(tmp_path: Path) -> None:
    with opened(tmp_path) as sim:
        assert states(sim) == {"joint_state_broadcaster": "active", "arm_controller": "active"}
        one = sim.call("/controller_manager/list_controllers").controller[1]
        assert one.type == "position_controllers/JointGroupPositionController"
        assert list(one.claimed_interfaces) == ["j1/position", "j2/position"]


def test_a_position_command_moves_the_joints_and_they_hold(tmp_path: Path) -> None:
    with opened(tmp_path) as sim:
        command(sim, "arm_controller", 0.5, -0.3)
        sim.run(3.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.5, -0.3], abs=1e-3)


def test_joints_hold_where_they_are_before_the_first_command(tmp_path: Path) -> None:
    with opened(tmp_path) as sim:
        sim.run(2.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.0, 0.0], abs=1e-4)


@pytest.mark.parametrize(
    "library", ["gz_ros2_control-system", "libign_ros2_control-system.so", "libgazebo_ros2_control.so"]
)
def test_every_spelling_of_the_plugin_is_known(tmp_path: Path, library: str) -> None:
    with opened(tmp_path, arm(library=library)) as sim:
        assert states(sim)["arm_controller"] == "active"


def test_manager_controllers_and_topics_are_in_the_namespace(tmp_path: Path) -> None:
    plugin = "<ros><namespace>/r1</namespace></ros><parameters>arm.yaml</parameters>"
    yaml = "/r1:\n" + "".join(f"  {line}\n" for line in POSITIONS.splitlines())
    with opened(tmp_path, arm(plugin=plugin), yaml) as sim:
        assert states(sim, "/r1/controller_manager")["arm_controller"] == "active"
        assert "/r1/joint_states" in sim.topics()
        assert "/r1/arm_controller/commands" in sim.topics()


def test_several_files_are_read_and_a_subset_is_loaded(tmp_path: Path) -> None:
    (tmp_path / "more.yaml").write_text(
        "controller_manager:\n  ros__parameters:\n"
        "    other: {type: position_controllers/JointGroupPositionController}\n"
        "other:\n  ros__parameters: {joints: [j1]}\n"
    )
    plugin = (
        "<parameters>arm.yaml</parameters><parameters>more.yaml</parameters>"
        "<simkit:controllers>other</simkit:controllers>"
    )
    with opened(tmp_path, arm(plugin=plugin)) as sim:
        assert states(sim) == {"other": "active"}


def test_the_first_of_two_controllers_claims_their_common_joint(tmp_path: Path) -> None:
    with opened(tmp_path, arm(ALL_THREE), TWO) as sim:
        assert states(sim) == {"by_position": "active", "by_effort": "inactive"}
        assert "'j2/effort' (of 'by_position')" in reported_messages(sim, "SK-CONTROL-014")[0]


def test_the_conflict_message_names_the_switch_service_with_its_namespace(tmp_path: Path) -> None:
    plugin = "<ros><namespace>/r1</namespace></ros><parameters>arm.yaml</parameters>"
    yaml = "/r1:\n" + "".join(f"  {line}\n" for line in TWO.splitlines())
    with opened(tmp_path, arm(ALL_THREE, plugin=plugin), yaml) as sim:
        assert states(sim, "/r1/controller_manager") == {"by_position": "active", "by_effort": "inactive"}
        (conflict,) = [d for d in sim.diagnostics if d.code == "SK-CONTROL-014"]
        assert conflict.hint.startswith("call /r1/controller_manager/switch_controller to activate by_effort")
        assert "/r1/controller_manager/switch_controller" in sim.communication.services.names()


def test_switching_changes_the_mode_of_one_joint_and_the_others_hold(tmp_path: Path) -> None:
    with opened(tmp_path, arm(ALL_THREE), TWO) as sim:
        command(sim, "by_position", 0.4, 0.2)
        sim.run(2.0)
        assert switch(sim, on=["by_effort"], off=["by_position"])
        assert states(sim) == {"by_position": "inactive", "by_effort": "active"}
        start = position(sim, "j2")[0]
        command(sim, "by_effort", 10.0)
        sim.run(0.05)
        # 10 N·m less 1 kg · 9.81 m/s² · 0.25 m at most, on 0.0825 kg·m² and what its drive adds
        assert position(sim, "j2")[0] > start + 0.02
        assert position(sim, "j1")[0] == pytest.approx(0.4, abs=0.02)


def test_a_strict_switch_is_all_or_nothing(tmp_path: Path) -> None:
    with opened(tmp_path, arm(ALL_THREE), TWO) as sim:
        assert not switch(sim, on=["by_effort"])  # the joint is taken
        assert not switch(sim, off=["by_position", "by_positoin"])
        assert states(sim) == {"by_position": "active", "by_effort": "inactive"}
        messages = reported_messages(sim, "SK-CONTROL-010")
        assert any("is already claimed (by 'by_position')" in m for m in messages)
        assert any("no controller with this name exists; did you mean 'by_position'?" in m for m in messages)


def test_best_effort_switches_the_possible_controllers(tmp_path: Path) -> None:
    with opened(tmp_path, arm(ALL_THREE), TWO) as sim:
        assert switch(sim, on=["nobody", "by_effort"], off=["by_position"], strict=1)
        assert states(sim) == {"by_position": "inactive", "by_effort": "active"}
        assert not switch(sim, on=["nobody"], strict=1)


def test_an_active_controller_can_be_restarted_and_not_started_twice(tmp_path: Path) -> None:
    with opened(tmp_path) as sim:
        assert switch(sim, on=["arm_controller"], off=["arm_controller"])
        assert not switch(sim, on=["arm_controller"])
        assert "since it is already active" in reported_messages(sim, "SK-CONTROL-010")[-1]


def test_a_controller_can_be_unloaded_and_loaded_again(tmp_path: Path) -> None:
    with opened(tmp_path) as sim:
        ask = {"name": "arm_controller"}
        assert not sim.call("/controller_manager/unload_controller", ask).ok  # it is active
        assert switch(sim, off=["arm_controller"])
        assert sim.call("/controller_manager/unload_controller", ask).ok
        assert "arm_controller" not in states(sim)
        command(sim, "arm_controller", 1.0, 1.0)  # finds nobody
        sim.run(1.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.0, 0.0], abs=1e-3)
        assert sim.call("/controller_manager/load_controller", ask).ok
        assert not sim.call("/controller_manager/load_controller", ask).ok  # there is one of that name
        assert states(sim)["arm_controller"] == "unconfigured"
        assert not switch(sim, on=["arm_controller"])
        assert sim.call("/controller_manager/configure_controller", ask).ok
        assert switch(sim, on=["arm_controller"])
        command(sim, "arm_controller", 0.3, 0.3)
        sim.run(2.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.3, 0.3], abs=1e-3)


def test_the_manager_lists_its_hardware_and_types(tmp_path: Path) -> None:
    with opened(tmp_path) as sim:
        found = sim.call("/controller_manager/list_hardware_interfaces")
        assert [(i.name, i.is_claimed) for i in found.command_interfaces] == [
            ("j1/position", True),
            ("j2/position", True),
        ]
        component = sim.call("/controller_manager/list_hardware_components").component[0]
        assert (component.name, component.state.label) == ("arm", "active")
        types = sim.call("/controller_manager/list_controller_types").types
        assert {"joint_state_broadcaster/JointStateBroadcaster", "diff_drive_controller/DiffDriveController"} <= set(
            types
        )
        set_state = "/controller_manager/set_hardware_component_state"
        assert sim.call(set_state, {"name": "arm", "target_state": {"id": 3}}).ok
        assert not sim.call(set_state, {"name": "arm", "target_state": {"id": 2}}).ok
        assert not sim.call(set_state, {"name": "leg", "target_state": {"id": 3}}).ok
        reload = "/controller_manager/reload_controller_libraries"
        assert not sim.call(reload, {"force_kill": False}).ok
        assert sim.call(reload, {"force_kill": True}).ok
        assert states(sim) == {}


def test_controllers_are_updated_at_their_own_rate(tmp_path: Path) -> None:
    yaml = POSITIONS + "joint_state_broadcaster:\n  ros__parameters: {update_rate: 30}\n"
    with opened(tmp_path, yaml=yaml) as sim:
        subscription = sim.subscribe("/joint_states")
        sim.run(2.0)
        assert len(subscription.messages) == pytest.approx(60, abs=1)


def test_reset_and_restore_recover_controllers_and_motion(tmp_path: Path) -> None:
    with opened(tmp_path, arm(ALL_THREE), TWO) as sim:
        command(sim, "by_position", 0.5, 0.1)
        sim.run(0.3)
        kept = sim.snapshot()
        sim.run(0.5)
        first = np.array(sim.mj_data.qpos)
        assert switch(sim, on=["by_effort"], off=["by_position"])
        sim.run(0.2)
        sim.restore(kept)
        assert states(sim) == {"by_position": "active", "by_effort": "inactive"}
        sim.run(0.5)
        np.testing.assert_array_equal(sim.mj_data.qpos, first)
        sim.reset()
        assert states(sim) == {"by_position": "active", "by_effort": "inactive"}
        sim.run(0.5)
        assert position(sim, "j1", "j2") == pytest.approx([0.0, 0.0], abs=1e-4)  # the command is forgotten
        command(sim, "by_position", 0.5, 0.1)
        sim.run(2.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.5, 0.1], abs=1e-3)


def test_a_spawned_robot_has_controllers_and_other_robots_may_spawn_and_go(tmp_path: Path) -> None:
    robot = files(tmp_path, arm())
    with simkit.load("<sdf version='1.9'><world name='w'/></sdf>") as sim:
        sim.spawn(robot, name="robot")
        command(sim, "arm_controller", 0.4, -0.2)
        sim.run(1.0)
        box = "<sdf version='1.9'><model name='box'><pose>3 0 0 0 0 0</pose><link name='l'/></model></sdf>"
        sim.spawn(box, name="box")
        sim.run(1.0)
        sim.remove("box")
        sim.run(1.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.4, -0.2], abs=1e-3)
        sim.remove("robot")
        assert not [name for name in sim.communication.services.names() if "controller_manager" in name]


def test_a_subscriber_may_remove_the_robot(tmp_path: Path) -> None:
    robot = files(tmp_path, arm())
    with simkit.load("<sdf version='1.9'><world name='w'/></sdf>") as sim:
        sim.spawn(robot, name="robot")
        sim.subscribe("/joint_states", lambda _: sim.remove("robot"))
        sim.run(0.5)
        assert "robot" not in sim.models


def test_a_second_equal_robot_has_its_models_name_as_namespace(tmp_path: Path) -> None:
    robot = files(tmp_path, arm())
    with simkit.load("<sdf version='1.9'><world name='w'/></sdf>") as sim:
        sim.spawn(robot, name="one")
        sim.spawn(robot, name="two")
        assert states(sim) == states(sim, "/two/controller_manager")
        assert "'/two'" in reported_messages(sim, "SK-CONTROL-001")[0]
        data = simkit.msgs.make("std_msgs/msg/Float64MultiArray", data=[0.3, 0.0])
        sim.publish("/two/arm_controller/commands", data)
        sim.run(2.0)
        assert position(sim, "j1") == pytest.approx([0.0, 0.3], abs=1e-3)
        assert {"/joint_states", "/two/joint_states"} <= set(sim.topics())


def looked_at(sim: simkit.Simulation, _: object) -> None:
    sim.engine.physics.fresh()


def test_subscribers_change_no_motion(tmp_path: Path) -> None:
    ends = []
    for listens in (False, True):
        with opened(tmp_path, arm(ALL_THREE), TWO) as sim:
            if listens:
                sim.subscribe("/clock", partial(looked_at, sim))
            command(sim, "by_position", 0.5, 0.1)
            sim.run(0.7)
            ends.append(np.array(sim.mj_data.qpos))
    np.testing.assert_array_equal(ends[0], ends[1])


# ------------------------------------------------------------------ what is wrong with a file


def test_an_unknown_type_is_not_loaded_and_the_closest_is_suggested(tmp_path: Path) -> None:
    yaml = POSITIONS.replace("JointGroupPositionController", "JointGroupPositonController")
    with opened(tmp_path, yaml=yaml) as sim:
        assert states(sim) == {"joint_state_broadcaster": "active"}
        found = next(d for d in sim.diagnostics if d.code == "SK-CONTROL-013")
        assert found.severity == "warning"
        assert (found.file or "").endswith("arm.yaml")
        assert found.line == 7
        assert "did you mean 'position_controllers/JointGroupPositionController'?" in found.message


def test_an_unknown_joint_stops_the_load_at_its_line_with_a_suggestion(tmp_path: Path) -> None:
    with pytest.raises(simkit.LoadError, match="SK-CONTROL-012(.|\n)*'j3/position'(.|\n)*did you mean 'j"):
        opened(tmp_path, yaml=POSITIONS.replace("[j1, j2]", "[j1, j3]"))


@pytest.mark.leaves_out
@pytest.mark.parametrize(
    ("joints", "code"),
    [("joints: [j1, j3]", "SK-CONTROL-012"), ("rate: 1", "SK-PARAM-001")],
    ids=["joint", "parameter"],
)
def test_a_controller_with_errors_is_left_out_and_the_others_run(tmp_path: Path, joints: str, code: str) -> None:
    yaml = POSITIONS.replace("joints: [j1, j2]", joints)
    with opened(tmp_path, yaml=yaml) as sim:
        assert states(sim)["joint_state_broadcaster"] == "active"
        assert states(sim)["arm_controller"] != "active"
        assert code in [d.code for d in sim.diagnostics if d.severity == "warning"]
        left_out = [d.message for d in sim.diagnostics if d.code in ("SK-LOAD-013", "SK-LOAD-014")]
        assert len(left_out) == 1
        assert "controller 'arm_controller'" in left_out[0]
        sim.step(10)


def test_a_missing_parameter_stops_the_load(tmp_path: Path) -> None:
    with pytest.raises(simkit.LoadError, match=r"arm.yaml:\d+: error SK-PARAM-001: <arm_controller> needs <joints>"):
        opened(tmp_path, yaml=POSITIONS.replace("joints: [j1, j2]", "rate: 1"))


def test_an_unused_parameter_is_a_warning(tmp_path: Path) -> None:
    with opened(tmp_path, yaml=POSITIONS + "    jionts: [j1]\n") as sim:
        assert any("<jionts> is not used" in message for message in reported_messages(sim, "SK-CONTROL-011"))


def test_parameters_of_a_misspelt_controller_are_a_warning(tmp_path: Path) -> None:
    with opened(tmp_path, yaml=POSITIONS + "arm_controler:\n  ros__parameters: {joints: [j1]}\n") as sim:
        assert "'arm_controler'" in reported_messages(sim, "SK-CONTROL-019")[0]


def test_a_missing_file_is_a_warning_and_the_robot_holds(tmp_path: Path) -> None:
    with opened(tmp_path, arm(plugin="<parameters>package://nowhere/config/none.yaml</parameters>")) as sim:
        assert "none.yaml is not found" in reported_messages(sim, "SK-CONTROL-015")[0]
        sim.run(1.0)
        assert position(sim, "j1", "j2") == pytest.approx([0.0, 0.0], abs=1e-3)


def test_a_broken_file_stops_the_load_with_its_line(tmp_path: Path) -> None:
    with pytest.raises(simkit.LoadError, match=r"arm.yaml:\d+: error SK-CONTROL-002"):
        opened(tmp_path, yaml="controller_manager:\n  ros__parameters: [\n")


def test_a_file_beside_the_robot_replaces_a_path_of_another_machine(tmp_path: Path) -> None:
    for uri in (
        "$(find my_config)/config/arm.yaml",
        "package://my_config/config/arm.yaml",
        "/opt/ros/share/x/arm.yaml",
    ):
        with opened(tmp_path, arm(plugin=f"<parameters>{uri}</parameters>")) as sim:
            assert states(sim)["arm_controller"] == "active"


def test_a_rate_above_the_step_rate_is_a_warning(tmp_path: Path) -> None:
    with opened(tmp_path, yaml=POSITIONS.replace("update_rate: 100", "update_rate: 5000")) as sim:
        assert "above the step rate of 1000 Hz" in reported_messages(sim, "SK-CONTROL-017")[0]


def test_a_command_of_wrong_length_or_with_nan_is_a_warning_and_ignored(tmp_path: Path) -> None:
    with opened(tmp_path) as sim:
        for values in ((1.0,), (1.0, 1.0, 1.0), (float("nan"), 1.0)):
            command(sim, "arm_controller", *values)
            sim.run(0.1)
        assert len(reported_messages(sim, "SK-CONTROL-016")) == 3
        assert position(sim, "j1", "j2") == pytest.approx([0.0, 0.0], abs=1e-4)
