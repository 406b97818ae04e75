"""Robots whose joints nothing drives: they fold, are told, and stand with `hold_joints`."""

from __future__ import annotations

import pytest

import simkit
from simkit.runtime.folded_models import find_folded_models

INERTIA = "<inertial><mass value='1'/><inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' ixz='0' iyz='0'/></inertial>"
LEG = f"""<link name='thigh_{{0}}'>{INERTIA}</link><link name='calf_{{0}}'>{INERTIA}<collision><origin xyz='0 0 -0.2'/>
<geometry><box size='0.2 0.04 0.02'/></geometry></collision></link>
<joint name='hip_{{0}}' type='revolute'><parent link='trunk'/><child link='thigh_{{0}}'/><origin xyz='0 {{1}} 0'/>
<axis xyz='0 1 0'/><limit lower='-1.5' upper='1.5' effort='{{2}}' velocity='10'/></joint>
<joint name='knee_{{0}}' type='revolute'><parent link='thigh_{{0}}'/><child link='calf_{{0}}'/>
<origin xyz='0.05 0 -0.2'/><axis xyz='0 1 0'/><limit lower='-1.5' upper='1.5' effort='{{2}}' velocity='10'/></joint>"""


def robot(effort: float = 60.0, extra: str = "") -> str:
    legs = LEG.format(1, 0.2, effort) + LEG.format(2, -0.2, effort)
    return f"<robot name='legs'><link name='trunk'>{INERTIA}</link>{legs}{extra}</robot>"


def sunk(text: str, **options: bool) -> tuple[float, list[str]]:
    """Run for 1 s; return how much the base sank [m] and the codes of the warnings at the end."""
    with simkit.load(text, model_world="ground", **options) as sim:
        before = sim.model("legs").pose.position[2]
        sim.run(1.0)
        return float(before - sim.model("legs").pose.position[2]), [d.code for d in find_folded_models(sim)]


def test_a_robot_without_controllers_folds_and_is_told() -> None:
    depth, codes = sunk(robot())
    assert depth > 0.1 and codes == ["SK-JOINT-020"]


def test_it_stands_if_its_joints_are_held() -> None:
    depth, codes = sunk(robot(), hold_joints=True)
    assert depth == pytest.approx(0.0, abs=0.01) and not codes  # servos yield by less than 10 mm


def test_a_held_joint_yields_beyond_its_effort_limit() -> None:
    depth, _ = sunk(robot(effort=0.05), hold_joints=True)
    assert depth > 0.1


def test_a_joint_that_a_plugin_drives_is_not_held() -> None:
    plugin = "<plugin name='turn' filename='gz-sim-joint-controller-system'><joint_name>knee_1</joint_name></plugin>"
    with simkit.load(robot(extra=f"<gazebo>{plugin}</gazebo>"), hold_joints=True, base="fixed") as sim:
        sim.publish("/model/legs/joint/knee_1/cmd_vel", {"data": 0.5})
        sim.run(1.0)
        assert sim.joint("legs::knee_1").position == pytest.approx(0.5, abs=0.02)
        assert sim.joint("legs::knee_2").position == pytest.approx(0.0, abs=0.01)


def test_a_reset_holds_the_initial_positions_again() -> None:
    with simkit.load(robot(), hold_joints=True, model_world="ground") as sim:
        sim.run(0.2)
        state = sim.mj_data.qpos.tobytes()
        sim.reset()
        sim.run(0.2)
        assert sim.mj_data.qpos.tobytes() == state
