"""Commands with huge, NaN and infinite numbers: ignored with a warning, or named by the error of the run."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import pytest

import simkit
from simkit import SimulationDiverged

ROBOT = """<model name="{name}"><pose>{x} 0 0.2 0 0 0</pose><link name="base"><inertial><mass>5</mass><inertia>
<ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial><collision name="c"><geometry><box>
<size>0.4 0.3 0.2</size></box></geometry></collision></link><link name="wl"><pose>0 0.2 -0.05 -1.57 0 0
</pose><collision name="c"><geometry><cylinder><radius>0.1</radius><length>0.05</length></cylinder>
</geometry></collision></link><link name="wr"><pose>0 -0.2 -0.05 -1.57 0 0</pose><collision name="c">
<geometry><cylinder><radius>0.1</radius><length>0.05</length></cylinder></geometry></collision></link>
<joint name="jl" type="revolute"><parent>base</parent><child>wl</child><axis><xyz>0 0 1</xyz></axis>
</joint><joint name="jr" type="revolute"><parent>base</parent><child>wr</child><axis><xyz>0 0 1</xyz>
</axis></joint>{plugin}</model>"""
DRIVE = """
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"><left_joint>jl</left_joint>
<right_joint>jr</right_joint><wheel_separation>0.4</wheel_separation><wheel_radius>0.1</wheel_radius>
<topic>{topic}</topic></plugin>"""
JOINTS = """
<plugin filename="gz-sim-joint-controller-system" name="gz::sim::systems::JointController"><joint_name>jl</joint_name>
<topic>/speed</topic></plugin>
<plugin filename="gz-sim-joint-position-controller-system" name="gz::sim::systems::JointPositionController">
<joint_name>jr</joint_name><topic>/angle</topic></plugin>
<plugin filename="gz-sim-apply-joint-force-system" name="gz::sim::systems::ApplyJointForce"><joint_name>jl</joint_name>
</plugin>
<plugin filename="gz-sim-thruster-system" name="gz::sim::systems::Thruster"><joint_name>jr</joint_name>
<topic>/thrust</topic></plugin>
<plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl"><topic>/twist</topic>
</plugin>"""
WORLD = """<sdf version="1.9"><world name="w"><physics type="ode"><max_step_size>0.002</max_step_size></physics>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
</link></model>{robots}</world></sdf>"""
TWO = WORLD.format(
    robots=ROBOT.format(name="bot", x=0, plugin=DRIVE.format(topic="/cmd_vel"))
    + ROBOT.format(name="other", x=5, plugin=DRIVE.format(topic="/other/cmd_vel"))
)
ONE = WORLD.format(robots=ROBOT.format(name="bot", x=0, plugin=JOINTS))
FLOAT = {"/speed", "/angle", "/thrust", "/model/bot/joint/jl/cmd_force"}


def bounds(sim: simkit.Simulation) -> list[str]:
    return [d.message for d in sim.diagnostics if d.code == "SK-PHYS-033"]


@pytest.mark.parametrize("speed", [1e4, -1e9])
def test_a_drive_without_limits_gets_a_bound_and_says_so_once(speed: float) -> None:
    """The bound is 0.2 rad in a step, or 150 rad/s; without it the run ended with SK-PHYS-001."""
    with simkit.load(TWO) as sim:
        sim.publish("/other/cmd_vel", {"linear": {"x": 0.2}})
        sim.publish("/cmd_vel", {"linear": {"x": speed}})
        sim.run(1.0)
        (message,) = bounds(sim)
        assert "plugin 'gz::sim::systems::DiffDrive': a command asks joint bot::jl for" in message
        assert "so it gets 100 rad/s at most" in message
        assert abs(sim.joint("bot::jl").velocity) < 110
        sim.publish("/cmd_vel", {"linear": {"x": 2 * speed}})
        sim.run(0.1)
        assert len(bounds(sim)) == 1


def test_a_joint_with_a_velocity_limit_has_that_limit_and_no_bound() -> None:
    limit = "<xyz>0 0 1</xyz><limit><velocity>180</velocity></limit>"
    with simkit.load(TWO.replace("<xyz>0 0 1</xyz>", limit).replace("0.002", "0.001")) as sim:
        sim.publish("/cmd_vel", {"linear": {"x": 1e4}})
        sim.run(0.3)
        assert bounds(sim) == []
        assert sim.joint("bot::jl").velocity == pytest.approx(180, abs=5)


@pytest.mark.parametrize("topic", ["/twist", "/move"])
def test_a_drive_that_sets_velocities_gets_a_bound_too(topic: str) -> None:
    moves = """<plugin filename="libgazebo_ros_planar_move.so" name="move"><ros><remapping>cmd_vel:=move</remapping>
      </ros></plugin>"""
    text = ONE if topic == "/twist" else WORLD.format(robots=ROBOT.format(name="bot", x=0, plugin=moves))
    with simkit.load(text) as sim:
        sim.publish(topic, {"linear": {"x": 1e6}, "angular": {"z": 1e4}})
        sim.run(0.2)
        (message,) = bounds(sim)
        assert "the model gets 500 m/s and 100 rad/s at most" in message
        sim.publish(topic, {"linear": {"x": 0.5}, "angular": {"z": 0.1}})
        sim.run(0.2)
        assert float(sim.link("bot::base").angular_velocity[2]) == pytest.approx(0.1, abs=2e-3)


def test_a_run_that_a_command_ends_names_the_command_and_its_plugin() -> None:
    with simkit.load(ONE) as sim:
        sim.publish("/model/bot/joint/jl/cmd_force", {"data": 1e9})
        with pytest.raises(SimulationDiverged, match=r"SK-PHYS-001 .*'bot::") as found:
            sim.run(1.0)
    assert "the last command on /model/bot/joint/jl/cmd_force for plugin" in str(found.value)
    assert "has data = 1e+09" in found.value.hint


def test_a_reset_forgets_the_command() -> None:
    with simkit.load(ONE) as sim:
        sim.publish("/model/bot/joint/jl/cmd_force", {"data": 1e9})
        with pytest.raises(SimulationDiverged):
            sim.run(1.0)
        sim.reset()
        sim.run(0.1)
        sim.model("bot").set_velocity((0.0, 0.0, 0.0), (0.0, 1e12, 0.0))
        with pytest.raises(SimulationDiverged) as found:
            sim.run(1.0)
    assert "command on" not in str(found.value)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e11, 1e300, 1e308])
def test_numbers_that_no_physics_can_follow_are_ignored_with_a_warning(value: float) -> None:
    with simkit.load(TWO) as sim:
        sim.publish("/cmd_vel", {"angular": {"z": value}})
        sim.publish("/other/cmd_vel", {"linear": {"x": 0.2}})
        sim.run(1.0)
        (warning,) = [d for d in sim.diagnostics if d.code == "SK-PLUGIN-041"]
        assert "a command with a NaN or infinite number is ignored" in warning.message
        assert abs(sim.joint("other::jl").velocity) > 1.5 and abs(sim.joint("bot::jl").velocity) < 0.1


@pytest.mark.needs_packs
@pytest.mark.parametrize("topic", [*sorted(FLOAT), "/twist"])
@pytest.mark.parametrize("value", [math.nan, math.inf, 1e11, 1e308])
def test_every_kind_of_command_is_checked(topic: str, value: float) -> None:
    with simkit.load(ONE) as sim:
        sim.publish(topic, {"data": value} if topic in FLOAT else {"linear": {"x": value}})
        sim.run(0.05)
        is_clamped = topic == "/thrust" and not math.isnan(value)  # the thruster has limits of its own
        expected = [] if is_clamped else ["SK-PLUGIN-041"]
        assert [d.code for d in sim.diagnostics if d.severity == "warning"] == expected


@pytest.mark.slow
def test_the_command_line_names_the_bound_and_does_not_ask_for_a_ground(tmp_path: Path) -> None:
    robot = ROBOT.format(name="bot", x=0, plugin=DRIVE.format(topic="/cmd_vel"))
    (tmp_path / "w.sdf").write_text(WORLD.format(robots=robot))
    command = [sys.executable, "-m", "simkit", "run", "w.sdf", "--cmd-vel", "1e4,0", "--duration", "1"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    ignored = subprocess.run([*command[:6], "1e11,0", *command[7:]], cwd=tmp_path, capture_output=True, text=True)
    assert ignored.returncode == 0 and "warning SK-PLUGIN-041" in ignored.stderr
    assert done.returncode == 0, done.stderr
    assert "warning SK-PHYS-033" in done.stderr and "w.sdf:" in done.stderr
    assert "ground" not in done.stderr
