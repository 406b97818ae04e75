"""Baxter's plugin: modes of the arms against analytic motions, enabling, head, grippers, states and bad commands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

import simkit

ROBOT = "baxter"
JOINTS = ("s0", "s1", "e0", "e1", "w0", "w1", "w2")
NEUTRAL = (0.0, -0.55, 0.0, 0.75, 0.0, 1.26, 0.0)
POSITION, VELOCITY, TORQUE, RAW = 1, 2, 3, 4
STEP = "physics.max_step_size=0.002"
IGNORED = "SK-PLUGIN-041"


@pytest.fixture(scope="module")
def world() -> Iterator[simkit.Simulation]:
    with simkit.load("empty", spawn=[f"{ROBOT}:0,0,0"], overrides=[STEP]) as sim:
        yield sim


@pytest.fixture
def sim(world: simkit.Simulation) -> simkit.Simulation:
    """A Baxter that is disabled, with both arms down."""
    world.reset()
    return world


@pytest.fixture
def arm(sim: simkit.Simulation) -> simkit.Simulation:
    """A Baxter that is enabled, with its left arm at rest in the neutral pose."""
    enable(sim)
    place(sim, NEUTRAL)
    sim.run(0.5)  # the arm leaves the torque mode after 0.2 s and holds its position
    return sim


def enable(sim: simkit.Simulation, value: bool = True) -> None:
    sim.publish("/robot/set_super_enable", {"data": value})
    sim.run(0.01)


def place(sim: simkit.Simulation, positions: Sequence[float]) -> None:
    """Move the left arm at once; in the torque mode, no drive pulls it back."""
    command(sim, TORQUE, {"s0": 0.0})
    sim.run(0.004)
    sim.model(ROBOT).set_joint_positions({f"left_{j}": p for j, p in zip(JOINTS, positions, strict=True)})


def command(sim: simkit.Simulation, mode: int, values: Mapping[str, float]) -> None:
    names = [f"left_{joint}" for joint in values]
    sim.publish("/robot/limb/left/joint_command", {"mode": mode, "names": names, "command": list(values.values())})


def drive(sim: simkit.Simulation, mode: int, values: Mapping[str, float], seconds: float) -> None:
    """Send a command at 20 Hz."""
    for _ in range(round(seconds / 0.05)):
        command(sim, mode, values)
        sim.run(0.05)


def positions(sim: simkit.Simulation) -> np.ndarray:
    return np.array([float(sim.joint(f"{ROBOT}::left_{joint}").position) for joint in JOINTS])


def velocity(sim: simkit.Simulation, joint: str) -> float:
    return float(sim.joint(f"{ROBOT}::left_{joint}").velocity)


def latest(sim: simkit.Simulation, topic: str) -> Any:
    """Run until the next message on a topic."""
    messages = sim.subscribe(topic, keep=1)
    sim.run(0.02)
    return messages.latest


def warnings(sim: simkit.Simulation) -> list[str]:
    return [d.message for d in sim.diagnostics if d.code == IGNORED]


# ------------------------------------------------------------------ enabling


def test_a_disabled_robot_ignores_commands_and_holds_its_arms(sim: simkit.Simulation) -> None:
    before = positions(sim)
    drive(sim, POSITION, {"s0": 1.0}, 0.2)
    drive(sim, VELOCITY, {"s1": -1.0}, 0.2)
    sim.publish("/robot/head/command_head_pan", {"target": 0.5})
    sim.publish("/robot/end_effector/left_gripper/command", {"command": "release"})
    sim.run(0.3)
    assert positions(sim) == pytest.approx(before, abs=1e-9)
    assert float(sim.joint(f"{ROBOT}::head_pan").position) == pytest.approx(0.0, abs=1e-9)
    assert any("a joint command is ignored, because the robot is not enabled" in text for text in warnings(sim))
    goal = sim.send_goal("/robot/limb/left/follow_joint_trajectory", trajectory(NEUTRAL, 1))
    sim.run(0.02)
    assert goal.status.name == "REJECTED"


def test_a_stop_needs_a_reset_before_the_robot_is_enabled_again(sim: simkit.Simulation) -> None:
    seen = []
    for topic, message in (
        ("enable", {"data": True}),
        ("stop", {}),
        ("enable", {"data": True}),
        ("reset", {}),
        ("enable", {"data": True}),
        ("enable", {"data": False}),
    ):
        sim.publish(f"/robot/set_super_{topic}", message)
        state = latest(sim, "/robot/state")
        seen.append((state.enabled, state.stopped, state.estop_source))
    on, off, stopped = (True, False, 0), (False, False, 0), (False, True, 2)
    assert seen == [on, stopped, stopped, off, on, off]


def test_without_holding_the_arms_of_a_disabled_robot_fall() -> None:
    text = (Path(__file__).resolve().parents[3] / "assets" / "baxter" / "model.sdf").read_text(encoding="utf-8")
    options = "<hold_joints>false</hold_joints><enabled>true</enabled><initial_positions>"
    with simkit.load(text.replace("<initial_positions>", options), model_world="ground", overrides=[STEP]) as sim:
        place(sim, NEUTRAL)
        drive(sim, TORQUE, {"s0": 0.0}, 0.3)
        assert positions(sim) == pytest.approx(NEUTRAL, abs=5e-3)
        enable(sim, False)
        sim.run(0.5)
        assert positions(sim)[1] > NEUTRAL[1] + 0.2


# ------------------------------------------------------------------ modes of an arm


def test_a_position_is_approached_at_the_speed_ratio_and_a_raw_position_at_the_velocity_limit(
    arm: simkit.Simulation,
) -> None:
    before = positions(arm)
    command(arm, POSITION, {"s0": 0.6})
    arm.run(0.5)
    assert positions(arm)[0] == pytest.approx(0.3 * 1.5 * 0.5, abs=0.005)
    arm.publish("/robot/limb/left/set_speed_ratio", {"data": 0.6})
    arm.run(0.2)
    assert velocity(arm, "s0") == pytest.approx(0.6 * 1.5, rel=0.02)
    arm.run(0.8)
    assert positions(arm) == pytest.approx([0.6, *before[1:]], abs=1e-4)
    command(arm, RAW, {"w2": 2.0})
    arm.run(0.4)
    assert velocity(arm, "w2") == pytest.approx(4.0, rel=0.02)
    arm.run(0.6)
    assert positions(arm)[6] == pytest.approx(2.0, abs=1e-4)


def test_a_velocity_lasts_until_the_time_limit(arm: simkit.Simulation) -> None:
    drive(arm, VELOCITY, {"s0": 0.5, "w2": -1.0}, 0.5)
    assert (velocity(arm, "s0"), velocity(arm, "w2")) == pytest.approx((0.5, -1.0), rel=5e-3)
    before = positions(arm)
    arm.run(0.6)
    moved = positions(arm) - before
    assert moved[[0, 6]] == pytest.approx([0.5 * 0.15, -0.15], abs=0.02)  # 0.05 s after the last command
    assert abs(velocity(arm, "s0")) < 1e-3

    arm.publish("/robot/limb/left/joint_command_timeout", {"data": 0.6})
    command(arm, VELOCITY, {"s0": -0.5})
    before = positions(arm)
    arm.run(0.59)
    assert velocity(arm, "s0") == pytest.approx(-0.5, rel=5e-3)
    arm.run(0.5)
    assert positions(arm)[0] - before[0] == pytest.approx(-0.5 * 0.6, abs=0.02)


def test_a_torque_accelerates_a_joint_against_its_damping(arm: simkit.Simulation) -> None:
    """Compare with v = (τ / c) (1 − exp(−c t / J)), with c = 0.7 N·m·s/rad and J about the axis of the last joint."""
    model, data = arm.mj_model, arm.mj_data
    dof, column = arm.joint(f"{ROBOT}::left_w2").mj_dofs[0], np.zeros(model.nv)
    mujoco.mj_mulM(model, data, column, np.eye(model.nv)[dof])
    constant = column[dof] / 0.7
    assert 0.0375 < column[dof] < 0.0395  # [kg·m²]: the rotor of the drive, and the hand
    start = positions(arm)
    for k in range(1, 9):
        drive(arm, TORQUE, {"w2": 0.7}, 0.05)
        assert velocity(arm, "w2") == pytest.approx(1.0 - np.exp(-0.05 * k / constant), abs=0.04)
    drive(arm, TORQUE, {"w2": 0.7}, 0.4)
    assert velocity(arm, "w2") == pytest.approx(1.0, rel=1e-3)
    assert positions(arm)[:6] == pytest.approx(start[:6], abs=1e-3)


def test_without_torques_gravity_is_balanced_until_it_is_suppressed(arm: simkit.Simulation) -> None:
    before = positions(arm)
    drive(arm, TORQUE, {"s0": 0.0}, 3.0)
    assert positions(arm) == pytest.approx(before, abs=1e-4)
    for _ in range(4):
        arm.publish("/robot/limb/left/suppress_gravity_compensation", {})
        drive(arm, TORQUE, {"s0": 0.0}, 0.05)
    assert velocity(arm, "s1") > 0.5  # the arm falls
    arm.run(2.0)  # the time limit ends the torque mode
    assert abs(velocity(arm, "s1")) < 0.01


def test_the_published_torques_are_the_slope_of_the_potential_energy(arm: simkit.Simulation) -> None:
    message = latest(arm, "/robot/limb/left/gravity_compensation_torques")
    assert message.name == [f"left_{joint}" for joint in JOINTS]
    model, data = arm.mj_model, mujoco.MjData(arm.mj_model)

    def energy(q: np.ndarray) -> float:
        data.qpos[:] = arm.mj_data.qpos
        for joint, value in zip(JOINTS, q, strict=True):
            data.qpos[model.jnt_qposadr[model.dof_jntid[arm.joint(f"{ROBOT}::left_{joint}").mj_dofs[0]]]] = value
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        return float(9.8 * model.body_mass @ data.xipos[:, 2])

    q, h = positions(arm), 1e-5
    slope = [(energy(q + h * unit) - energy(q - h * unit)) / (2 * h) for unit in np.eye(7)]
    assert message.gravity_model_effort == pytest.approx(slope, abs=1e-3)
    assert message.gravity_model_effort[1] == pytest.approx(-50.15, abs=0.1)
    assert message.actual_effort == pytest.approx(message.gravity_model_effort, abs=1e-2)
    assert message.actual_position == pytest.approx(NEUTRAL, abs=5e-3)
    enable(arm, False)
    assert not np.any(latest(arm, "/robot/limb/left/gravity_compensation_torques").gravity_model_effort)


def test_the_state_of_the_end_point_shows_pose_twist_and_an_outer_force(arm: simkit.Simulation) -> None:
    link, base = arm.link(f"{ROBOT}::left_gripper"), arm.link(f"{ROBOT}::base")
    messages = arm.subscribe("/robot/limb/left/endpoint_state", keep=1)
    for _ in range(250):
        link.apply_wrench((0.0, 0.0, -5.0))
        arm.run(0.002)
    message = messages.latest
    expected = (base.pose.inverse() @ link.pose).position
    assert [message.pose.position.x, message.pose.position.y, message.pose.position.z] == pytest.approx(
        expected, abs=1e-3
    )
    force = message.wrench.force
    assert message.header.frame_id == "base"
    assert (force.x, force.y, force.z) == pytest.approx((0.0, 0.0, -5.0), abs=0.1)
    drive(arm, VELOCITY, {"s0": 0.4}, 0.5)
    twist, x, y = messages.latest.twist, message.pose.position.x, message.pose.position.y
    radius = np.hypot(x - 0.064027, y - 0.259027)  # from the axis of the shoulder
    assert twist.angular.z == pytest.approx(0.4, rel=5e-3)
    assert np.hypot(twist.linear.x, twist.linear.y) == pytest.approx(0.4 * radius, rel=5e-3)


def trajectory(goal: Sequence[float], seconds: int) -> dict[str, Any]:
    point = {"positions": list(goal), "time_from_start": {"sec": seconds}}
    return {"trajectory": {"joint_names": [f"left_{joint}" for joint in JOINTS], "points": [point]}}


def test_a_trajectory_takes_over_and_reaches_its_goal(arm: simkit.Simulation) -> None:
    target = (0.2, -0.3, 0.4, 1.0, 0.2, 0.8, -0.5)
    drive(arm, VELOCITY, {"s0": 0.3}, 0.2)
    goal = arm.send_goal("/robot/limb/left/follow_joint_trajectory", trajectory(target, 2))
    arm.run(2.1)
    assert goal.status.name == "SUCCEEDED" and goal.result.error_code == 0
    assert positions(arm) == pytest.approx(target, abs=1e-3)
    too_fast = arm.send_goal("/robot/limb/left/follow_joint_trajectory", trajectory((-1.5, *target[1:]), 0))
    arm.run(0.5)
    assert too_fast.status.name == "ABORTED" and too_fast.result.error_code == -4  # an error above 0.2 rad


# ------------------------------------------------------------------ head and grippers


def test_the_head_turns_at_its_speed_ratio_and_nods(arm: simkit.Simulation) -> None:
    head = arm.subscribe("/robot/head/head_state", keep=1)
    arm.publish("/robot/head/command_head_pan", {"target": 0.5, "speed_ratio": 0.5})
    arm.publish("/robot/head/command_head_nod", {"data": True})
    arm.run(0.5)
    state = head.latest
    assert state.pan == pytest.approx(0.25, abs=0.01) and state.is_turning and state.is_nodding
    arm.run(0.7)
    state = head.latest
    assert state.pan == pytest.approx(0.5, abs=1e-4) and not state.is_turning and not state.is_nodding
    arm.publish("/robot/head/command_head_pan", {"target": 3.0})
    arm.run(1.2)
    assert head.latest.pan == pytest.approx(1.3963, abs=1e-3)  # the limit of the joint


def gripper(sim: simkit.Simulation, command: str, args: str = "") -> None:
    message = {"command": command, "args": args, "sender": "test", "sequence": 7}
    sim.publish("/robot/end_effector/left_gripper/command", message)


def test_a_gripper_opens_and_closes_at_its_speed(arm: simkit.Simulation) -> None:
    state = arm.subscribe("/robot/end_effector/left_gripper/state", keep=1)
    gripper(arm, "release")
    arm.run(0.4)
    assert state.latest.position == pytest.approx(100 * 0.025 * 0.4 / 0.020833, abs=2.0) and state.latest.moving
    arm.run(0.6)
    now = state.latest
    assert (now.position, now.moving, now.gripping, now.missed) == (pytest.approx(100.0, abs=0.1), 0, 0, 0)
    assert (now.command, now.command_sender, now.command_sequence) == ("release", "test", 7)
    joints = [float(arm.joint(f"{ROBOT}::l_gripper_{side}_finger_joint").position) for side in "lr"]
    assert joints == pytest.approx([0.020833, -0.020833], abs=1e-5)
    gripper(arm, "configure", '{"velocity": 100.0}')
    arm.run(0.01)
    gripper(arm, "go", '{"position": 30.0}')
    arm.run(0.5)
    assert state.latest.position == pytest.approx(30.0, abs=0.1)
    gripper(arm, "grip")
    arm.run(0.4)
    assert state.latest.position == pytest.approx(0.0, abs=0.1) and state.latest.missed
    properties = latest(arm, "/robot/end_effector/left_gripper/properties")
    assert (properties.id, properties.ui_type) == (65538, 2)


BLOCK = """<sdf version="1.12"><model name="block"><link name="link">
<inertial><mass>0.2</mass><inertia><ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz></inertia></inertial>
<collision name="c"><geometry><box><size>0.04 0.04 0.06</size></box></geometry>
<surface><friction><ode><mu>1</mu><mu2>1</mu2></ode></friction></surface></collision></link></model></sdf>"""
SHELF = """<sdf version="1.12"><model name="shelf"><static>true</static><link name="link"><collision name="c">
<geometry><box><size>0.1 0.1 0.02</size></box></geometry></collision></link></model></sdf>"""


def test_a_gripper_holds_a_block_while_the_arm_lifts_it() -> None:
    with simkit.load("empty", spawn=[f"{ROBOT}:0,0,0"], overrides=[STEP]) as sim:
        enable(sim)
        place(sim, NEUTRAL)
        gripper(sim, "release")
        sim.run(1.0)
        tip = sim.link(f"{ROBOT}::left_gripper").pose
        yaw = np.arctan2(*(tip.transform((0.0, 1.0, 0.0)) - tip.position)[1::-1])
        x, y, z = tip.position
        sim.spawn(SHELF, name="shelf", pose=simkit.Pose.from_rpy(x, y, z - 0.03, 0, 0, yaw))
        block = sim.spawn(BLOCK, name="block", pose=simkit.Pose.from_rpy(x, y, z + 0.01, 0, 0, yaw))
        sim.run(0.1)
        gripper(sim, "grip")
        sim.run(1.0)
        state = latest(sim, "/robot/end_effector/left_gripper/state")
        assert state.gripping and not state.moving and state.force > 5.0
        assert state.position == pytest.approx(100 * (0.04 - 0.016) / 2 / 0.020833, abs=3.0)
        before = block.pose.position
        command(sim, POSITION, {"s1": -0.8})
        sim.run(2.0)
        inside = sim.link(f"{ROBOT}::left_gripper").pose.inverse() @ block.pose
        assert block.pose.position[2] - before[2] > 0.15
        assert np.linalg.norm(inside.position) < 0.03


# ------------------------------------------------------------------ bad commands and other files


def test_invalid_commands_are_reported_and_ignored(arm: simkit.Simulation) -> None:
    before = positions(arm)
    topic = "/robot/limb/left/joint_command"
    arm.publish(topic, {"mode": 7, "names": ["left_s0"], "command": [1.0]})
    arm.publish(topic, {"mode": 1, "names": ["left_s0", "left_s1"], "command": [1.0]})
    arm.run(0.01)
    arm.publish(topic, {"mode": 1, "names": ["left_s0"], "command": [float("nan")]})
    arm.run(0.01)
    arm.publish(topic, {"mode": 1, "names": ["left_e2"], "command": [1.0]})
    arm.publish("/robot/limb/left/joint_command_timeout", {"data": -1.0})
    gripper(arm, "gripp")
    arm.run(0.01)
    gripper(arm, "go", "[50]")
    arm.run(0.5)
    assert positions(arm) == pytest.approx(before, abs=1e-4)
    found = "\n".join(warnings(arm))
    for text in (
        "a joint command of mode 7 is ignored",
        "a joint command with 2 names and 1 value is ignored",
        "a joint command with a NaN or infinite number is ignored",
        "the left arm has no joint 'left_e2'",
        "a time limit of -1 s",
        "the gripper command 'gripp' is not known",
        "the gripper command 'go' has the arguments '[50]'",
    ):
        assert text in found


GAINS = """robot:
  left_joint_position_controller:
    type: baxter_sim_controllers/BaxterPositionController
    topic: /robot/limb/left/joint_command
    joints:
      left_s0_controller: {joint: left_s0, pid: {p: 200.0, i: 0.01, d: 5.0}}
      left_s1_controller: {joint: left_s1, pid: {p: 800.0, i: 0.01, d: 10.0}}
      left_e0_controller: {joint: left_e0}
      left_e1_controller: {joint: left_e1}
      left_w0_controller: {joint: left_w0}
      left_w1_controller: {joint: left_w1}
      left_w2_controller: {joint: left_w2}
  left_s0_position_controller:
    type: effort_controllers/JointPositionController
    joint: left_s0
    pid: {p: 200.0, i: 0.01, d: 0.1}
"""


def test_gains_of_baxter_sim_controllers_run_without_gravity_compensation(tmp_path: Path) -> None:
    """With a PD loop of 800 N·m/rad, the shoulder sags by the torque of gravity over 800."""
    file = tmp_path / "baxter_sim_controllers.yaml"
    file.write_text(GAINS)
    with simkit.load("empty", spawn=[f"{ROBOT}:0,0,0"], overrides=[STEP], params_files=[file]) as sim:
        assert [str(d) for d in sim.diagnostics if d.severity in ("warning", "error")] == []
        enable(sim)
        command(sim, POSITION, {"s1": 0.6})
        sim.run(6.0)
        torque = latest(sim, "/robot/limb/left/gravity_compensation_torques").gravity_model_effort[1]
        assert positions(sim)[1] - 0.6 == pytest.approx(-torque / 800.0, rel=0.02)


def test_a_model_without_the_arms_of_baxter_is_reported() -> None:
    model = """<sdf version="1.12"><world name="w"><model name="box"><link name="l"/>
    <plugin name="b" filename="libbaxter_gazebo_ros_control.so"><initial_positions><left_s9>1</left_s9>
    </initial_positions></plugin></model></world></sdf>"""
    with simkit.load(model) as sim:
        found = [d.message for d in sim.diagnostics if d.code == "SK-CONTROL-008"]
    assert any("has no arm of Baxter" in text for text in found)
    assert any("'left_s9', which Baxter does not have" in text for text in found)


def test_a_snapshot_in_torque_mode_continues_equally(arm: simkit.Simulation) -> None:
    arm.publish("/robot/limb/left/suppress_gravity_compensation", {})
    drive(arm, TORQUE, {"w1": 2.0}, 0.1)
    snapshot = arm.snapshot()
    ends = []
    for _ in range(2):
        arm.restore(snapshot)
        arm.run(0.5)
        ends.append(positions(arm))
    assert np.array_equal(*ends)
