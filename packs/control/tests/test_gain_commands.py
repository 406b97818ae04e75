"""Joints whose stiffness and damping are commands: effort = e + kp (position − x) + kd (velocity − v)."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from control_robots import command, interfaces, opened, position

import simkit

GAINS = ("position", "velocity", "effort", "kp", "kd")
BLOCK = '<ros2_control name="c" type="system"><hardware><plugin>{hardware}</plugin></hardware>{joint}</ros2_control>'
TRANSMISSION = """<transmission name="t"><type>transmission_interface/SimpleTransmission</type>
<joint name="slide"><hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface></joint>
<actuator name="a"/></transmission>"""


def cart(library: str, block: str, parameters: str = "<parameters>arm.yaml</parameters>") -> str:
    """Return a cart of 2 kg on a rail; 100 N at most."""
    return f"""<robot name="cart"><link name="world"/><link name="cart"><inertial><mass value="2"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="slide" type="prismatic"><parent link="world"/><child link="cart"/><axis xyz="1 0 0"/>
<limit lower="-50" upper="50" effort="100" velocity="30"/></joint>{block}
<gazebo><plugin filename="{library}" name="control">{parameters}</plugin></gazebo></robot>"""


QUADRUPED = cart(
    "gz_quadruped_hardware-system",
    BLOCK.format(
        hardware="gz_quadruped_hardware/GazeboSimSystem", joint=f'<joint name="slide">{interfaces(GAINS)}</joint>'
    ),
)
ROS_2 = "controller_manager:\n  ros__parameters:\n    update_rate: 1000\n" + "".join(
    f"    {name}: {{type: forward_command_controller/ForwardCommandController}}\n" for name in GAINS
)
ROS_2 += "".join(f"{n}:\n  ros__parameters: {{joints: [slide], interface_name: {n}}}\n" for n in GAINS)
ALL_AT_ONCE = f"""controller_manager:
  ros__parameters:
    update_rate: 1000
    all: {{type: forward_command_controller/MultiInterfaceForwardCommandController}}
all:
  ros__parameters: {{joint: slide, interface_names: [{", ".join(GAINS)}]}}
"""


def load_legged(folder: Path, names: tuple[str, ...] = GAINS, more: str = "") -> simkit.Simulation:
    """Load a cart with the hardware of legged_control, a controller of the named interfaces and further ones."""
    parameters = "<robotNamespace>/</robotNamespace><parameters>arm.yaml</parameters>"
    robot = cart("liblegged_hw_sim.so", TRANSMISSION, parameters)
    text = f"{more}all:\n  type: forward_command_controller/MultiInterfaceForwardCommandController\n"
    text += f"  joint: slide\n  interface_names: [{', '.join(names)}]\n"
    return opened(folder, robot, text)


def send(sim: simkit.Simulation, **commands: float) -> None:
    """Send a command to the controllers of several interfaces."""
    for name, value in commands.items():
        command(sim, name, value)


@pytest.mark.slow
def test_a_joint_follows_its_spring_and_damper(tmp_path: Path) -> None:
    with opened(tmp_path, QUADRUPED, ROS_2) as sim:
        codes = [d.code for d in sim.diagnostics]
        send(sim, kp=50.0, kd=4.0, position=0.4)
        sim.run(0.5)
        # damped oscillation of 2 kg from 0 to 0.4 m: x = 0.4 - 0.4 exp(-a t) (cos wt + a/w sin wt)
        a, w = 1.0, math.sqrt(24.0)
        expected = 0.4 - 0.4 * math.exp(-a * 0.5) * (math.cos(w * 0.5) + a / w * math.sin(w * 0.5))
        assert position(sim, "slide") == pytest.approx([expected], abs=5e-3)
        sim.run(10.0)
        assert position(sim, "slide") == pytest.approx([0.4], abs=1e-3)
        send(sim, effort=5.0)
        sim.run(10.0)
        assert position(sim, "slide") == pytest.approx([0.5], abs=1e-3)  # 5 N on 50 N/m
    assert "SK-CONTROL-009" not in codes


def test_a_damper_alone_moves_the_joint_at_its_velocity(tmp_path: Path) -> None:
    with opened(tmp_path, QUADRUPED, ALL_AT_ONCE) as sim:
        sim.publish("/all/commands", {"data": [0.0, 0.3, 0.0, 0.0, 20.0]})
        sim.run(2.0)
        assert float(sim.joint("cart::slide").velocity) == pytest.approx(0.3, abs=1e-3)


def test_without_commands_the_joint_is_free_and_the_effort_is_limited(tmp_path: Path) -> None:
    with opened(tmp_path, QUADRUPED, ROS_2) as sim:
        sim.link("cart::cart").apply_wrench((2000.0, 0, 0))  # 1 m/s after a step of 1 ms
        sim.run(0.5)
        assert float(sim.joint("cart::slide").velocity) == pytest.approx(1.0, abs=0.01)
        send(sim, kp=1e5, position=40.0)
        sim.run(0.1)
        speed = float(sim.joint("cart::slide").velocity)
        sim.run(0.1)
        assert float(sim.joint("cart::slide").velocity) - speed == pytest.approx(100 / 2 * 0.1, rel=0.02)


def test_a_restored_snapshot_repeats_the_motion_with_its_gains(tmp_path: Path) -> None:
    with opened(tmp_path, QUADRUPED, ROS_2) as sim:
        send(sim, kp=50.0, kd=4.0, position=0.4)
        sim.run(0.3)
        snapshot = sim.snapshot()
        sim.run(0.5)
        assert 0.2 < position(sim, "slide")[0] < 0.6
        first = position(sim, "slide")
        send(sim, kp=500.0, kd=40.0)
        sim.run(0.5)
        sim.restore(snapshot)
        sim.run(0.5)
        assert position(sim, "slide") == first
        sim.reset()
        sim.run(0.5)
        assert position(sim, "slide") == [0.0]


def test_legged_hardware_has_gains_at_its_effort_joints_and_forgets_them_on_release(tmp_path: Path) -> None:
    with load_legged(tmp_path) as sim:
        sim.publish("/all/command", {"data": [0.4, 0.0, 0.0, 50.0, 20.0]})
        sim.run(4.0)
        assert position(sim, "slide") == pytest.approx([0.4], abs=1e-3)
        request = {"deactivate_controllers": ["all"], "strictness": 2}
        assert sim.call("/controller_manager/switch_controller", request).ok
        sim.link("cart::cart").apply_wrench((2000.0, 0, 0))
        sim.run(0.5)
        assert float(sim.joint("cart::slide").velocity) == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("names", [("velocity", "kd"), ("kd", "velocity")])
def test_a_controller_may_claim_a_gain_without_a_position(tmp_path: Path, names: tuple[str, str]) -> None:
    with load_legged(tmp_path, names) as sim:
        commands = {"velocity": 0.3, "kd": 20.0}
        sim.publish("/all/command", {"data": [commands[name] for name in names]})
        sim.run(2.0)
        assert float(sim.joint("cart::slide").velocity) == pytest.approx(0.3, abs=1e-3)


def test_a_stiff_pid_of_an_effort_joint_with_gains_acts_and_is_restored(tmp_path: Path) -> None:
    pid = (
        "stiff:\n  type: effort_controllers/JointPositionController\n  joint: slide\n  pid: {p: 3000, i: 0, d: 3000}\n"
    )
    to_gains = {"activate_controllers": ["all"], "deactivate_controllers": ["stiff"], "strictness": 2}
    with load_legged(tmp_path, more=pid) as sim:
        sim.publish("/stiff/command", {"data": 0.4})
        sim.run(1.0)
        # the damper of 2000 N s/m, which is the largest stable one, and the spring of 3000 N/m
        first = position(sim, "slide")
        assert first == pytest.approx([0.4 * (1 - math.exp(-1.5))], rel=0.03)
        snapshot = sim.snapshot()
        sim.run(1.0)
        later = position(sim, "slide")
        assert sim.call("/controller_manager/switch_controller", to_gains).ok
        sim.publish("/all/command", {"data": [0.0, 0.0, 0.0, 50.0, 20.0]})
        sim.run(4.0)
        assert position(sim, "slide") == pytest.approx([0.0], abs=1e-3)
        sim.restore(snapshot)
        sim.run(1.0)
        assert position(sim, "slide") == later
        sim.reset()
        sim.publish("/stiff/command", {"data": 0.4})
        sim.run(1.0)
        assert position(sim, "slide") == first
