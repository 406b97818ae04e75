"""A small arm in a plane, with a gripper, for tests of motions: three joints about upright axes, and two fingers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import simkit
from simkit_motion.plugins.play_motion.play_motion_plugin import PlayMotion

SPEED = 2.0  # [rad/s] of the joints
CONTROLLERS = """
controller_manager:
  ros__parameters:
    update_rate: 100
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
    gripper_controller: {type: joint_trajectory_controller/JointTrajectoryController}
arm_controller:
  ros__parameters:
    joints: [shoulder, elbow, wrist]
    command_interfaces: [position]
    state_interfaces: [position, velocity]
gripper_controller:
  ros__parameters:
    joints: [left_finger, right_finger]
    command_interfaces: [position]
    state_interfaces: [position, velocity]
"""
MOTIONS = """
play_motion2:
  ros__parameters:
    motions:
      rest:
        joints: [shoulder, elbow, wrist]
        positions: [0.0, 0.0, 0.0]
        times_from_start: [0.5]
      bow:
        joints: [shoulder, elbow, wrist]
        positions: [0.5, 0.5, 0.0,
                    1.0, -0.5, 0.2]
        times_from_start: [1.0, 3.0]
        meta: {name: Bow, usage: test, description: 'There and elsewhere.'}
      nod:
        joints: [wrist]
        positions: [0.4, 0.0]
        times_from_start: [0.5, 1.5]
      curl:
        joints: [shoulder, elbow, wrist]
        positions: [0.0, 2.6, 2.6]
        times_from_start: [1.0]
      too_far:
        joints: [shoulder, elbow]
        positions: [0.0, 0.0, 1.0, 3.5]
        times_from_start: [1.0, 2.0]
      open:
        joints: [left_finger, right_finger]
        positions: [0.04, 0.04]
        times_from_start: [0.5]
      close:
        joints: [left_finger, right_finger]
        positions: [0.0, 0.0]
        times_from_start: [0.5]
"""


def link(name: str, x: float, size: str, at: float, mass: float = 0.5) -> str:
    return f"""
    <link name="{name}"><pose>{x} 0 0.5 0 0 0</pose>
      <inertial><pose>{at} 0 0 0 0 0</pose><mass>{mass}</mass>
        <inertia><ixx>0.004</ixx><iyy>0.004</iyy><izz>0.004</izz></inertia></inertial>
      <collision name="shape"><pose>{at} 0 0 0 0 0</pose><geometry><box><size>{size}</size></box></geometry></collision>
    </link>"""


def joint(name: str, parent: str, child: str, axis: str = "0 0 1", limit: float = 2.8) -> str:
    kind = "prismatic" if "finger" in name else "revolute"
    lower, speed = (0.0, 0.1) if kind == "prismatic" else (-limit, SPEED)
    return f"""
    <joint name="{name}" type="{kind}"><parent>{parent}</parent><child>{child}</child>
      <axis><xyz>{axis}</xyz><limit><lower>{lower}</lower><upper>{limit}</upper><effort>60</effort>
      <velocity>{speed}</velocity></limit><dynamics><damping>0.5</damping></dynamics></axis></joint>"""


def model(name: str = "arm", extra: str = "", place: str = "0 0 0 0 0 0") -> str:
    fingers = "".join(
        link(f"{side}_finger_link", 0.95, "0.08 0.01 0.04", 0.04, 0.05).replace("0 0.5 0 0 0", f"{y} 0.5 0 0 0", 1)
        for side, y in (("left", 0.005), ("right", -0.005))
    )
    return f"""
  <model name="{name}"><pose>{place}</pose>
    <link name="foot"><pose>0 0 0.25 0 0 0</pose><inertial><mass>5</mass></inertial>
      <collision name="shape"><geometry><box><size>0.1 0.1 0.4</size></box></geometry></collision></link>
    <joint name="standing" type="fixed"><parent>world</parent><child>foot</child></joint>
    {link("upper", 0, "0.26 0.04 0.04", 0.15)}{joint("shoulder", "foot", "upper")}
    {link("lower", 0.3, "0.26 0.04 0.04", 0.15)}{joint("elbow", "upper", "lower")}
    {link("hand", 0.6, "0.34 0.04 0.04", 0.18)}{joint("wrist", "lower", "hand")}
    {fingers}
    {joint("left_finger", "hand", "left_finger_link", "0 1 0", 0.04)}
    {joint("right_finger", "hand", "right_finger_link", "0 -1 0", 0.04)}
    <plugin filename="libgazebo_ros2_control.so" name="control">
      <parameters>controllers.yaml</parameters></plugin>
    {extra}
  </model>"""


def world(content: str) -> str:
    return f'<sdf version="1.9"><world name="lab"><gravity>0 0 0</gravity>{content}</world></sdf>'


def box(name: str, pose: str, size: str, static: bool = True) -> str:
    shape = f"<geometry><box><size>{size}</size></box></geometry>"
    mass = "<inertial><mass>0.1</mass><inertia><ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz></inertia></inertial>"
    return f"""<model name="{name}"><static>{str(static).lower()}</static><pose>{pose}</pose>
      <link name="body">{mass}<collision name="shape">{shape}</collision></link></model>"""


def play_motion(element: str = "") -> str:
    return f"""<plugin filename="libsimkit_play_motion.so" name="play_motion2">
      <motions>motions.yaml</motions>{element}</plugin>"""


def load(
    folder: Path, content: str = "", element: str = "", motions: str = MOTIONS, seed: int = 0
) -> simkit.Simulation:
    """Load the arm in a world with this content."""
    (folder / "controllers.yaml").write_text(CONTROLLERS)
    (folder / "motions.yaml").write_text(motions)
    file = folder / "lab.sdf"
    file.write_text(world(model(extra=play_motion(element)) + content))
    return simkit.load(file, seed=seed)


def player(sim: simkit.Simulation) -> PlayMotion:
    return next(p for p in sim.engine.structure.all_plugins() if isinstance(p, PlayMotion))


def play(sim: simkit.Simulation, name: str, action: str = "/play_motion2", **fields: Any) -> Any:
    """Send a goal and run until it has ended."""
    goal = sim.send_goal(action, {"motion_name": name, **fields})
    assert sim.run_until(lambda _: goal.is_done, timeout=20.0)
    return goal


def codes(sim: simkit.Simulation) -> list[str]:
    return [d.code for d in sim.diagnostics if "MOTION" in d.code]


def positions(sim: simkit.Simulation, *names: str) -> list[float]:
    return [float(sim.joint(f"arm::{name}").position) for name in names]
