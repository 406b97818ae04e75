"""`libgazebo_ros_control.so`: controllers, names, gains and services of ROS 1."""

from __future__ import annotations

from pathlib import Path

import pytest
from control_robots import arm, opened, position, states

import simkit

ROS_1 = "libgazebo_ros_control.so"


def transmissions(interface: str) -> str:
    return "".join(
        f'<transmission name="t_{joint}"><type>transmission_interface/SimpleTransmission</type>'
        f'<joint name="{joint}"><hardwareInterface>hardware_interface/{interface}</hardwareInterface></joint>'
        f'<actuator name="m_{joint}"><mechanicalReduction>1</mechanicalReduction></actuator></transmission>'
        for joint in ("j1", "j2")
    )


def robot(
    interface: str, plugin: str = "<robotNamespace>/rrbot</robotNamespace><controlPeriod>0.002</controlPeriod>"
) -> str:
    plugin += "<simkit:parameters>arm.yaml</simkit:parameters>"
    return arm("", plugin, ROS_1, more=transmissions(interface))


def yaml(kind: str, rest: str) -> str:
    return (
        "rrbot:\n  joint_state_controller: {type: joint_state_controller/JointStateController, publish_rate: 50}\n"
        f"  one:\n    type: {kind}\n    joint: j1\n{rest}"
    )


def send(sim: simkit.Simulation, value: float) -> None:
    sim.publish("/rrbot/one/command", simkit.msgs.make("std_msgs/msg/Float64", data=value))


def test_an_effort_loop_reaches_a_position_and_publishes_its_state(tmp_path: Path) -> None:
    gains = "    pid: {p: 300.0, i: 50.0, d: 20.0, i_clamp: 30.0}\n"
    with opened(
        tmp_path, robot("EffortJointInterface"), yaml("effort_controllers/JointPositionController", gains)
    ) as sim:
        heard = sim.subscribe("/rrbot/one/state")
        sent = sim.subscribe("/rrbot/joint_states")
        send(sim, 0.5)
        sim.run(8.0)
        assert position(sim, "j1") == pytest.approx([0.5], abs=0.01)
        state = heard.messages[-1]
        assert state.set_point == 0.5
        assert state.error == pytest.approx(0.5 - state.process_value)
        assert (state.p, state.i, state.d, state.i_clamp) == (300.0, 50.0, 20.0, 30.0)
        assert len(sent.messages) == pytest.approx(400, abs=2)


def test_the_plugin_of_cob_runs_one_controller_of_a_joint_with_several_interfaces(tmp_path: Path) -> None:
    one, other = (f"<hardwareInterface>{kind}JointInterface</hardwareInterface>" for kind in ("Position", "Velocity"))
    text = robot(
        "PositionJointInterface", "<robotNamespace>rrbot</robotNamespace><filterJointsParam>j</filterJointsParam>"
    )
    text = (
        text.replace("hardware_interface/", "").replace(one, one + other).replace(ROS_1, f"libhwi_switch_{ROS_1[3:]}")
    )
    with opened(tmp_path, text, yaml("position_controllers/JointPositionController", "")) as sim:
        assert not [d for d in sim.diagnostics if d.code in ("SK-PLUGIN-001", "SK-PARAM-003")]
        send(sim, 0.5)
        sim.run(2.0)
        assert position(sim, "j1") == pytest.approx([0.5], abs=0.01)


def test_services_use_the_states_of_ros_1(tmp_path: Path) -> None:
    kind = "position_controllers/JointPositionController"
    with opened(tmp_path, robot("PositionJointInterface"), yaml(kind, "")) as sim:
        manager = "/rrbot/controller_manager"
        assert states(sim, manager) == {"joint_state_controller": "running", "one": "running"}
        assert sim.call(f"{manager}/switch_controller", {"stop_controllers": ["one"], "strictness": 2}).ok
        assert states(sim, manager)["one"] == "stopped"
        assert sim.call(f"{manager}/unload_controller", {"name": "one"}).ok
        assert sim.call(f"{manager}/load_controller", {"name": "one"}).ok
        assert states(sim, manager)["one"] == "stopped"
        assert sim.call(f"{manager}/switch_controller", {"start_controllers": ["one"], "strictness": 2}).ok
        send(sim, 0.4)
        sim.run(2.0)
        assert position(sim, "j1") == pytest.approx([0.4], abs=1e-3)


def test_a_velocity_of_one_joint(tmp_path: Path) -> None:
    kind = "velocity_controllers/JointVelocityController"
    with opened(tmp_path, robot("VelocityJointInterface"), yaml(kind, "")) as sim:
        send(sim, 0.5)
        sim.run(1.0)
        assert float(sim.joint("arm::j1").velocity) == pytest.approx(0.5, abs=0.01)


def test_an_effort_loop_holds_a_velocity(tmp_path: Path) -> None:
    gains = "    pid: {p: 50.0, i: 100.0, d: 0.0, i_clamp: 40.0}\n"
    with opened(
        tmp_path, robot("EffortJointInterface"), yaml("effort_controllers/JointVelocityController", gains)
    ) as sim:
        send(sim, 0.3)
        sim.run(3.0)
        assert float(sim.joint("arm::j1").velocity) == pytest.approx(0.3, abs=0.03)


def test_gains_of_the_simulation_drive_its_position_joints(tmp_path: Path) -> None:
    gains = "  gazebo_ros_control:\n    pid_gains:\n      j1: {p: 100.0, i: 0.0, d: 20.0}\n"
    kind = "position_controllers/JointPositionController"
    with opened(tmp_path, robot("PositionJointInterface"), yaml(kind, "") + gains) as sim:
        send(sim, 0.5)
        sim.run(8.0)
        held = 9.8 * (0.75 + 0.25) * 0.5  # about m g l sin q, of both links
        assert 0.5 < position(sim, "j1")[0] < 0.5 + 1.3 * held / 100


def test_the_default_namespace_is_the_models_name(tmp_path: Path) -> None:
    text = yaml("position_controllers/JointPositionController", "").replace("rrbot:", "arm:")
    with opened(tmp_path, robot("PositionJointInterface", ""), text) as sim:
        assert states(sim, "/arm/controller_manager")["one"] == "running"
        assert "/arm/joint_states" in sim.topics()


def test_without_a_file_nothing_is_loaded_and_a_note_has_the_remedy(tmp_path: Path) -> None:
    plain = arm("", "<robotNamespace>/r</robotNamespace>", ROS_1, more=transmissions("EffortJointInterface"))
    with opened(tmp_path, plain) as sim:
        assert states(sim, "/r/controller_manager") == {}
        assert any(d.code == "SK-CONTROL-018" for d in sim.diagnostics)
        sim.run(0.5)  # joints of effort fall, as in Gazebo


def test_the_help_names_the_file_that_the_launch_file_loads(tmp_path: Path) -> None:
    """The file is in another package of the same project; files for other robots are not named."""
    text = robot("EffortJointInterface").replace("<simkit:parameters>arm.yaml</simkit:parameters>", "")
    for name, joint in (("a_control", "elbow"), ("b_control", "j1")):
        folder = tmp_path / name / "config"
        folder.mkdir(parents=True)
        (folder / "control.yaml").write_text(
            yaml("effort_controllers/JointPositionController", "").replace("j1", joint)
        )
    described = tmp_path / "description/urdf/arm.urdf"
    described.parent.mkdir(parents=True)
    described.write_text(text)
    with simkit.load(described) as sim:
        (problem,) = [d for d in sim.diagnostics if d.code == "SK-CONTROL-018"]
        assert f"--params-file {tmp_path / 'b_control/config/control.yaml'}" in problem.hint
