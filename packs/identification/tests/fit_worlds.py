"""Small worlds for fits, and recordings of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import simkit
from simkit.recording import Recorder

FORCE = "/model/cart/joint/slide/cmd_force"
STATES = """<plugin filename="gz-sim-joint-state-publisher-system" name="gz::sim::systems::JointStatePublisher">
<topic>joint_states</topic></plugin>"""


def slider(mass: float = 1.0, damping: float = 1.0, noise: float = 0.0, latency: float = 0.0) -> str:
    """Return a mass on a rail with a damper, a force as command, and an accelerometer."""
    return f"""<sdf version="1.9"><world name="w"><physics type="ignored"><max_step_size>0.005</max_step_size></physics>
<model name="cart"><link name="rail"/>
<joint name="fix" type="fixed"><parent>world</parent><child>rail</child></joint>
<link name="car"><inertial><mass>{mass}</mass></inertial>
  <sensor name="imu" type="imu"><update_rate>50</update_rate><topic>imu</topic><latency>{latency}</latency><imu>
    <linear_acceleration><x><noise type="gaussian"><mean>0</mean><stddev>{noise}</stddev></noise></x>
    </linear_acceleration></imu></sensor></link>
<joint name="slide" type="prismatic"><parent>rail</parent><child>car</child>
  <axis><xyz>1 0 0</xyz><dynamics><damping>{damping}</damping></dynamics></axis></joint>
<plugin filename="gz-sim-apply-joint-force-system" name="gz::sim::systems::ApplyJointForce">
<joint_name>slide</joint_name></plugin>{STATES}</model></world></sdf>"""


def push(sim: simkit.Simulation, duration: float = 1.0) -> None:
    """Push the slider forwards and backwards."""
    for number in range(round(duration / 0.1)):
        sim.publish(FORCE, {"data": 3.0 if number // 3 % 2 == 0 else -2.0})
        sim.run(0.1)


def pendulum(damping: float = 0.05, length: float = 0.5) -> str:
    """Return a pendulum that hangs and takes a torque."""
    return f"""<sdf version="1.9"><world name="w"><physics type="ignored"><max_step_size>0.005</max_step_size></physics>
<model name="swing"><link name="base"/>
<joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
<link name="bob"><inertial><pose>0 0 {-length} 0 0 0</pose><mass>1</mass>
<inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial></link>
<joint name="hinge" type="revolute"><parent>base</parent><child>bob</child>
  <axis><xyz>0 1 0</xyz><dynamics><damping>{damping}</damping></dynamics></axis></joint>
<plugin filename="gz-sim-apply-joint-force-system" name="gz::sim::systems::ApplyJointForce">
<joint_name>hinge</joint_name></plugin>{STATES}</model></world></sdf>"""


def swing(sim: simkit.Simulation) -> None:
    """Push the pendulum once, and let it swing."""
    sim.publish("/model/swing/joint/hinge/cmd_force", {"data": 2.0})
    sim.run(0.3)
    sim.publish("/model/swing/joint/hinge/cmd_force", {"data": 0.0})
    sim.run(1.7)


def servo(p: float = 20.0, d: float = 2.0) -> str:
    """Return a joint with a PID position controller."""
    return f"""<sdf version="1.9"><world name="w"><physics type="ignored"><max_step_size>0.005</max_step_size></physics>
<gravity>0 0 0</gravity><model name="arm"><link name="base"/>
<joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
<link name="rod"><inertial><mass>1</mass><inertia><ixx>0.2</ixx><iyy>0.2</iyy><izz>0.2</izz></inertia></inertial></link>
<joint name="turn" type="revolute"><parent>base</parent><child>rod</child><axis><xyz>0 0 1</xyz></axis></joint>
<plugin filename="gz-sim-joint-position-controller-system" name="gz::sim::systems::JointPositionController">
<joint_name>turn</joint_name><topic>/turn</topic><p_gain>{p}</p_gain><i_gain>0</i_gain><d_gain>{d}</d_gain></plugin>
{STATES}</model></world></sdf>"""


def turn(sim: simkit.Simulation) -> None:
    """Command two positions."""
    for angle in (0.5, -0.3):
        sim.publish("/turn", {"data": angle})
        sim.run(0.6)


def record(world: str, path: Path, drive: Callable[[simkit.Simulation], Any], seed: int = 3, **options: Any) -> Path:
    """Record a run of a world; return the bag."""
    with simkit.load(world, seed=seed) as sim, Recorder(sim, path, overwrite=True, **options):
        drive(sim)
    return path
