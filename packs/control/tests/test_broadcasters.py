"""Broadcasters: joint states, inertial sensor, force and torque."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from control_robots import arm, command, interfaces, opened, reported_messages

import simkit

BOTH = "".join(f'<joint name="{j}">{interfaces(("position",))}</joint>' for j in ("j1", "j2"))
MIXED = (
    f'<joint name="j1">{interfaces(("position",), ("position", "velocity"))}</joint>'
    f'<joint name="j2">{interfaces((), ("position",))}</joint>'
)
SENSORS = (
    '<sensor name="wrist"><state_interface name="force.x"/><state_interface name="force.y"/>'
    '<state_interface name="force.z"/><state_interface name="torque.x"/><state_interface name="torque.y"/>'
    '<state_interface name="torque.z"/></sensor><sensor name="imu">'
    + "".join(f'<state_interface name="orientation.{a}"/>' for a in "xyzw")
    + "".join(f'<state_interface name="{p}.{a}"/>' for p in ("angular_velocity", "linear_acceleration") for a in "xyz")
    + "</sensor>"
)
FITTED = """
<gazebo reference="l2"><sensor name="imu" type="imu"><update_rate>100</update_rate></sensor></gazebo>
<gazebo reference="j2"><sensor name="wrist" type="force_torque"><update_rate>100</update_rate></sensor></gazebo>
"""
ARM = "    arm: {type: position_controllers/JointGroupPositionController}\n"


def yaml(kind: str, parameters: str, more: str = "") -> str:
    return (
        f"controller_manager:\n  ros__parameters:\n    update_rate: 100\n    out: {{type: {kind}}}\n{more}"
        f"out:\n  ros__parameters: {{{parameters}}}\narm:\n  ros__parameters: {{joints: [j1, j2]}}\n"
    )


def states(parameters: str, more: str = "") -> str:
    return yaml("joint_state_broadcaster/JointStateBroadcaster", parameters, more)


def test_joint_states_have_every_joint_in_the_order_of_the_hardware(tmp_path: Path) -> None:
    with opened(tmp_path, arm(BOTH), states("", ARM)) as sim:
        messages = sim.subscribe("/joint_states")
        command(sim, "arm", 0.5, -0.3)
        sim.run(2.0)
        last = messages.messages[-1]
        assert list(last.name) == ["j1", "j2"]
        assert last.position == pytest.approx([0.5, -0.3], abs=1e-3)
        assert last.velocity == pytest.approx([0.0, 0.0], abs=1e-3)
        # both links hang on j1: m g (0.25 s1 + 0.5 s1 + 0.25 s12), s of the angles from the vertical
        held = 9.8 * (0.75 * np.sin(0.5) + 0.25 * np.sin(0.2))
        assert -last.effort[0] == pytest.approx(held, rel=0.01)
        assert last.header.stamp.sec == 1 and last.header.frame_id == ""


def test_a_missing_interface_is_nan_and_extra_joints_are_0(tmp_path: Path) -> None:
    with opened(tmp_path, arm(MIXED), states("extra_joints: [wheel], frame_id: base")) as sim:
        messages = sim.subscribe("/joint_states")
        sim.run(0.1)
        last = messages.messages[-1]
        assert list(last.name) == ["j1", "j2", "wheel"]
        assert np.isnan(last.velocity).tolist() == [False, True, False]
        assert np.isnan(last.effort).tolist() == [True, True, False]
        assert last.position[2] == 0.0
        assert last.header.frame_id == "base"


def test_joints_and_interfaces_select_states_and_local_topics_are_in_the_controllers_node(tmp_path: Path) -> None:
    chosen = "joints: [j2], interfaces: [position], use_local_topics: true"
    with opened(tmp_path, arm(BOTH), states(chosen)) as sim:
        messages = sim.subscribe("/out/joint_states")
        everything = sim.subscribe("/out/dynamic_joint_states")
        sim.run(0.1)
        assert list(messages.messages[-1].name) == ["j2"]
        assert list(everything.messages[-1].joint_names) == ["j2"]
        assert list(everything.messages[-1].interface_values[0].interface_names) == ["position"]


def test_joints_without_interfaces_select_nothing_and_are_a_warning(tmp_path: Path) -> None:
    with opened(tmp_path, arm(BOTH), states("joints: [j2]")) as sim:
        messages = sim.subscribe("/joint_states")
        sim.run(0.1)
        assert list(messages.messages[-1].name) == ["j1", "j2"]
        assert any(
            "set 'joints' and 'interfaces' together" in message for message in reported_messages(sim, "SK-CONTROL-011")
        )


def test_dynamic_joint_states_have_sensors_too(tmp_path: Path) -> None:
    with opened(tmp_path, arm(BOTH + SENSORS, more=FITTED), states("")) as sim:
        everything = sim.subscribe("/dynamic_joint_states")
        states_ = sim.subscribe("/joint_states")
        sim.run(0.1)
        assert list(everything.messages[-1].joint_names) == ["j1", "j2", "wrist", "imu"]
        assert list(states_.messages[-1].name) == ["j1", "j2"]


def test_the_imu_is_published_as_measured(tmp_path: Path) -> None:
    kind = "imu_sensor_broadcaster/IMUSensorBroadcaster"
    parameters = "sensor_name: imu, frame_id: l2, static_covariance_angular_velocity: [1, 0, 0, 0, 2, 0, 0, 0, 3]"
    with opened(tmp_path, arm(BOTH + SENSORS, more=FITTED), yaml(kind, parameters, ARM)) as sim:
        messages = sim.subscribe("/out/imu")
        command(sim, "arm", 0.5, -0.3)
        sim.run(2.0)
        last = messages.messages[-1]
        assert last.header.frame_id == "l2"
        # the link leans 0.2 rad: gravity's reaction is along −x and z of its own frame
        felt = [last.linear_acceleration.x, last.linear_acceleration.y, last.linear_acceleration.z]
        assert felt == pytest.approx([-9.8 * np.sin(0.2), 0.0, 9.8 * np.cos(0.2)], abs=0.05)
        assert last.orientation.y == pytest.approx(np.sin(0.1), abs=1e-3)
        assert last.angular_velocity_covariance.tolist()[4] == 2.0


def test_the_wrench_is_published_with_offset_and_multiplier(tmp_path: Path) -> None:
    kind = "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster"
    parameters = "sensor_name: wrist, frame_id: l1, offset: {force: {x: 1.0}}, multiplier: {force: {z: 2.0}}"
    with opened(tmp_path, arm(BOTH + SENSORS, more=FITTED), yaml(kind, parameters, ARM)) as sim:
        messages = sim.subscribe("/out/wrench")
        sim.run(1.0)
        wrench = sim.sensor("arm::j2::wrist").latest.wrench
        last = messages.messages[-1].wrench
        assert abs(wrench.force.z) == pytest.approx(9.8, rel=0.01)  # 1 kg hangs on it
        assert last.force.z == pytest.approx(2.0 * wrench.force.z, rel=1e-3)
        assert last.force.x == pytest.approx(wrench.force.x + 1.0, abs=1e-3)


def test_several_broadcasters_can_be_active_at_once(tmp_path: Path) -> None:
    text = yaml(
        "imu_sensor_broadcaster/IMUSensorBroadcaster",
        "sensor_name: imu, frame_id: l2",
        "    ft: {type: force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster}\n"
        "    jsb: {type: joint_state_broadcaster/JointStateBroadcaster}\n",
    )
    text += "ft:\n  ros__parameters: {sensor_name: wrist, frame_id: l1}\n"
    with opened(tmp_path, arm(BOTH + SENSORS, more=FITTED), text) as sim:
        heard = [sim.subscribe(topic) for topic in ("/out/imu", "/ft/wrench", "/joint_states", "/dynamic_joint_states")]
        sim.run(0.5)
        assert [len(one.messages) for one in heard] == [49, 49, 49, 49]
        everything = heard[3].messages[-1]
        values = dict(zip(everything.joint_names, everything.interface_values, strict=True))
        assert values["wrist"].values[2] == heard[1].messages[-1].wrench.force.z


def test_single_interfaces_of_a_wrench_leave_the_others_unmeasured(tmp_path: Path) -> None:
    kind = "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster"
    parameters = "frame_id: l1, interface_names: {force: {z: wrist/force.z}}"
    with opened(tmp_path, arm(BOTH + SENSORS, more=FITTED), yaml(kind, parameters)) as sim:
        messages = sim.subscribe("/out/wrench")
        sim.run(0.5)
        last = messages.messages[-1].wrench
        assert np.isnan(last.force.x) and np.isnan(last.torque.z)
        assert abs(last.force.z) == pytest.approx(9.8, rel=0.02)


@pytest.mark.parametrize(
    ("kind", "parameters", "code"),
    [
        ("imu_sensor_broadcaster/IMUSensorBroadcaster", "frame_id: l2", "SK-PARAM-001"),
        ("imu_sensor_broadcaster/IMUSensorBroadcaster", "sensor_name: imuu, frame_id: l2", "SK-CONTROL-012"),
        (
            "imu_sensor_broadcaster/IMUSensorBroadcaster",
            "sensor_name: imu, frame_id: l2, static_covariance_orientation: [1, 2]",
            "SK-PARAM-002",
        ),
        ("force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster", "frame_id: l1", "SK-PARAM-001"),
    ],
)
def test_a_missing_parameter_of_a_broadcaster_stops_the_load(
    tmp_path: Path, kind: str, parameters: str, code: str
) -> None:
    with pytest.raises(simkit.LoadError, match=rf"arm\.yaml:\d+: error {code}"):
        opened(tmp_path, arm(BOTH + SENSORS, more=FITTED), yaml(kind, parameters))


def test_a_broadcaster_without_subscriber_makes_no_messages(tmp_path: Path) -> None:
    with opened(tmp_path, arm(BOTH), states("")) as sim:
        sim.run(0.1)
        late = sim.subscribe("/joint_states")
        sim.run(0.1)
        assert len(late.messages) == 10
