"""Joints at a commanded velocity."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from joint_worlds import codes, gz, load, rotor, velocity

import simkit
from simkit import LoadError
from simkit.runtime.engine.physics_step import FRESH, Physics

A, B = "<joint_name>j_a</joint_name>", "<joint_name>j_b</joint_name>"
FORCE = "<use_force_commands>true</use_force_commands>"
CMD = "/model/m/joint/j_a/cmd_vel"


def two(content: str, **a: Any) -> simkit.Simulation:
    return load(rotor("a", damping=0.05, **a), rotor("b", damping=0.05), velocity(content))


def test_a_velocity_is_reached_within_one_step_and_held() -> None:
    sim = two(f"{A}<initial_velocity>5</initial_velocity>")
    sim.step()
    assert sim.joint("m::j_a").velocity == 0.0  # Gazebo creates the joint's state in the first step
    sim.step()
    assert sim.joint("m::j_a").velocity == pytest.approx(5.0, abs=1e-4)
    sim.publish(CMD, {"data": -2.0})
    sim.step(500)
    assert sim.joint("m::j_a").velocity == pytest.approx(-2.0, abs=1e-4)


def test_with_an_effort_limit_the_velocity_is_reached_later() -> None:
    sim = two(f"{A}<initial_velocity>5</initial_velocity>", limit="<limit><effort>0.4</effort></limit>")
    sim.run(0.5)
    # I v' = τ - d v from rest
    expected = 0.4 / 0.05 * (1.0 - math.exp(-0.05 / 0.2 * 0.499))
    assert sim.joint("m::j_a").velocity == pytest.approx(expected, rel=1e-3)
    assert sim.joint("m::j_a").effort == pytest.approx(0.4)


def test_the_velocity_is_limited() -> None:
    sim = two(f"{A}<initial_velocity>5</initial_velocity>", limit="<limit><velocity>3</velocity></limit>")
    sim.step(10)
    assert sim.joint("m::j_a").velocity == pytest.approx(3.0, abs=1e-4)


def test_it_stops_at_a_position_limit() -> None:
    limit = "<limit><lower>-1</lower><upper>0.5</upper></limit>"
    sim = two(f"{A}<initial_velocity>5</initial_velocity>", limit=limit)
    sim.run(0.5)
    assert sim.joint("m::j_a").position == pytest.approx(0.5, abs=1e-4)
    assert abs(sim.joint("m::j_a").velocity) < 1e-4


def test_one_topic_commands_several_joints() -> None:
    sim = two(f"{A}{B}<sub_topic>both</sub_topic>")
    sim.publish("/model/m/both", {"data": 3.0})
    sim.step(5)
    assert [sim.joint(f"m::j_{n}").velocity for n in "ab"] == pytest.approx([3.0, 3.0], abs=1e-4)
    assert two(f"{A}<sub_topic>x</sub_topic><topic>/own</topic>").topics()["/own"] == "std_msgs/msg/Float64"


def test_the_ignition_spelling_is_the_same_plugin() -> None:
    plugin = (
        '<plugin filename="libignition-gazebo6-joint-controller-system.so" '
        f'name="ignition::gazebo::systems::JointController">{A}<initial_velocity>2</initial_velocity></plugin>'
    )
    sim = load(rotor("a"), plugin)
    sim.step(3)
    assert sim.joint("m::j_a").velocity == pytest.approx(2.0, abs=1e-4)


def test_an_actuator_message_commands_by_number() -> None:
    sim = two(f"{A}<use_actuator_msg>true</use_actuator_msg><actuator_number>1</actuator_number>")
    sim.publish("/actuators", {"velocity": [1.0, 4.0]})
    sim.step(2)
    assert sim.joint("m::j_a").velocity == pytest.approx(4.0, abs=1e-4)
    sim.publish("/actuators", {"velocity": [9.0]})
    sim.step(2)
    assert sim.joint("m::j_a").velocity == pytest.approx(4.0, abs=1e-4)
    assert "and none for actuator 1" in codes(sim.diagnostics, "SK-PLUGIN-041")[0]


def test_without_an_actuator_number_float_messages_are_used_with_a_warning() -> None:
    sim = two(f"{A}<use_actuator_msg>true</use_actuator_msg>")
    assert len(codes(sim.diagnostics, "SK-PLUGIN-042")) == 1
    assert CMD in sim.topics()


def test_a_nan_command_is_ignored_and_reported_once() -> None:
    sim = two(f"{A}<initial_velocity>1</initial_velocity>")
    for _ in range(2):
        sim.publish(CMD, {"data": math.nan})
        sim.step(2)
    assert sim.joint("m::j_a").velocity == pytest.approx(1.0, abs=1e-4)
    assert len(codes(sim.diagnostics, "SK-PLUGIN-041")) == 1


def test_with_force_commands_a_pid_reaches_the_velocity() -> None:
    sim = two(f"{A}{FORCE}<p_gain>2</p_gain>")
    sim.publish(CMD, {"data": 4.0})
    sim.run(1.0)
    # I v' = p (4 - v) - d v, the first step without a command
    end = 2.0 * 4.0 / 2.05
    assert sim.joint("m::j_a").velocity == pytest.approx(end * (1.0 - math.exp(-2.05 / 0.2 * 0.999)), abs=1e-3)


def test_without_braking_it_coasts() -> None:
    sim = two(f"{A}{FORCE}<p_gain>2</p_gain><disable_braking>true</disable_braking>")
    joint = sim.joint("m::j_a")
    for target in (1.0, 0.0):
        joint.set_velocity(8.0)
        sim.publish(CMD, {"data": target})
        sim.run(1.0)
        assert joint.velocity == pytest.approx(8.0 * math.exp(-0.05 / 0.2), rel=2e-3)


def test_numbers_of_a_pid_without_force_commands_are_reported() -> None:
    sim = two(f"{A}<p_gain>2</p_gain><i_gain>1</i_gain>")
    assert codes(sim.diagnostics, "SK-PLUGIN-043") == [
        "plugin 'gz::sim::systems::JointController': <p_gain>, <i_gain> have no effect without <use_force_commands>"
    ]


def test_gains_are_live() -> None:
    sim = two(f"{A}{FORCE}<p_gain>2</p_gain>")
    node = "/model/m/joint/j_a/velocity_controller"
    assert list(sim.communication.parameters[node]) == [
        "p_gain", "i_gain", "d_gain", "i_max", "i_min", "cmd_max", "cmd_min", "cmd_offset",
    ]  # fmt: skip
    sim.publish(CMD, {"data": 4.0})
    sim.run(2.0)
    assert sim.joint("m::j_a").velocity == pytest.approx(4.0 * 2.0 / 2.05, abs=1e-4)
    kept = sim.snapshot()
    sim.set_parameter(node, "p_gain", 20.0)
    sim.run(2.0)
    assert sim.joint("m::j_a").velocity == pytest.approx(4.0 * 20.0 / 20.05, abs=1e-4)
    sim.restore(kept)
    sim.run(0.2)
    assert sim.joint("m::j_a").velocity == pytest.approx(4.0 * 2.0 / 2.05, abs=1e-4)


def test_wrong_names_are_reported_together_with_the_closest_ones() -> None:
    with pytest.raises(LoadError) as caught:
        two("<joint_name>j_aa</joint_name><joint_name>jb</joint_name><joint_name/>")
    found = [(d.message, d.hint) for d in caught.value.diagnostics if d.severity == "error"]
    assert len(found) == 3
    assert "no joint 'j_aa'" in found[0][0] and "j_a" in found[0][1]
    assert "no joint 'jb'" in found[1][0] and "j_b" in found[1][1]
    assert "empty <joint_name>" in found[2][0]


# ---------------------------------------------------------------------- loads and obstacles


def cart(slope: float, more: str = "", *, by_velocity: bool = True) -> simkit.Simulation:
    """Return a cart of 10.4 kg on four wheels of radius 0.1 m and inertia 1e-4 kg m², on a slope [rad]."""
    parts = [
        "<link name='base'><pose>0 0 0.1 0 0 0</pose><inertial><mass>10</mass><inertia><ixx>1</ixx><iyy>1</iyy>"
        "<izz>1</izz></inertia></inertial></link>"
    ]
    for name, (x, y) in {"fl": (0.2, 0.2), "fr": (0.2, -0.2), "rl": (-0.2, 0.2), "rr": (-0.2, -0.2)}.items():
        parts.append(
            f"<link name='{name}'><pose>{x} {y} 0.1 -1.5707963267948966 0 0</pose><inertial><mass>0.1</mass><inertia>"
            "<ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz></inertia></inertial><collision name='c'><geometry><sphere>"
            f"<radius>0.1</radius></sphere></geometry></collision></link><joint name='j_{name}' type='continuous'>"
            f"<parent>base</parent><child>{name}</child><axis><xyz>0 0 1</xyz>"
            "<limit><effort>4</effort></limit></axis></joint>"
        )
    parts.append(more)
    for one, other in (("fl", "rl"), ("fr", "rr")) if by_velocity else ():
        names = f"<joint_name>j_{one}</joint_name><joint_name>j_{other}</joint_name>"
        parts.append(velocity(f"{names}<topic>/wheels</topic>"))
    ground = "<model name='g'><static>true</static><link name='l'><collision name='c'><geometry><plane/></geometry>"
    gravity = f"{-9.81 * math.sin(slope)} 0 {-9.81 * math.cos(slope)}"
    return load(*parts, gravity=gravity, extra=f"{ground}</collision></link></model>")


def test_wheels_carry_a_cart_uphill_at_their_velocity() -> None:
    sim = cart(0.2)
    sim.publish("/wheels", {"data": 5.0})
    sim.run(1.0)
    wheels = [sim.joint(f"m::j_{n}") for n in ("fl", "fr", "rl", "rr")]
    assert [w.velocity for w in wheels] == pytest.approx([5.0] * 4, abs=2e-3)
    assert sim.model("m").pose.position[0] == pytest.approx(0.45, abs=0.06)
    # m g sin(slope) at the radius of the wheels
    assert sum(w.effort for w in wheels) == pytest.approx(10.4 * 9.81 * math.sin(0.2) * 0.1, rel=0.01)


def test_a_joint_without_an_effort_limit_does_not_push_through_the_floor() -> None:
    arm = """<pose>0 0 0.3 0 0 0</pose><link name="arm"><pose>0.25 0 0 0 0 0</pose><inertial><mass>1</mass><inertia>
    <ixx>0.02</ixx><iyy>0.02</iyy><izz>0.02</izz></inertia></inertial><collision name="c"><geometry><box>
    <size>0.5 0.05 0.05</size></box></geometry></collision></link><joint name="j" type="revolute"><pose>-0.25 0 0 0 0 0
    </pose><parent>world</parent><child>arm</child><axis><xyz>0 1 0</xyz></axis></joint>"""
    ground = "<model name='g'><static>true</static><link name='l'><collision name='c'><geometry><plane/></geometry>"
    controller = velocity("<joint_name>j</joint_name><initial_velocity>1</initial_velocity>")
    sim = load(arm, controller, gravity="0 0 -9.81", extra=f"{ground}</collision></link></model>")
    sim.run(0.5)
    assert sim.joint("m::j").velocity == pytest.approx(1.0, abs=1e-4)  # gravity does not matter
    sim.run(1.0)
    # the corner is on the floor: 0.3 = 0.5 sin(q) + 0.025 cos(q)
    touching = math.asin(0.3 / math.hypot(0.5, 0.025)) - math.atan2(0.025, 0.5)
    assert sim.joint("m::j").position == pytest.approx(touching, abs=0.01)
    assert abs(sim.joint("m::j").velocity) < 0.02


def test_joints_of_a_chain_under_controllers_of_their_own_do_not_disturb_each_other() -> None:
    arm = rotor("a") + rotor("b", parent="a")
    sim = load(arm, velocity(f"{A}<initial_velocity>2</initial_velocity>"), velocity(B))
    sim.step(2)
    assert [sim.joint(f"m::j_{n}").velocity for n in "ab"] == pytest.approx([2.0, 0.0], abs=1e-4)


def test_runs_after_a_reset_and_a_restore_are_equal_bit_for_bit() -> None:
    sim = cart(0.1)

    def drive() -> np.ndarray:
        sim.publish("/wheels", {"data": 3.0})
        sim.step(60)
        return sim.mj_data.qpos.copy()

    first = drive()
    kept = sim.snapshot()
    on = drive()
    sim.restore(kept)
    assert np.array_equal(drive(), on)
    sim.reset()
    assert np.array_equal(drive(), first)


def spinner(name: str, speed: float) -> str:
    plugin = velocity(f"{A}<initial_velocity>{speed}</initial_velocity>")
    return f'<sdf version="1.9"><model name="{name}">{rotor("a")}{plugin}</model></sdf>'


def test_other_joints_keep_turning_while_models_are_spawned_and_removed() -> None:
    sim = two(f"{A}<initial_velocity>1</initial_velocity>")
    sim.step(5)
    for name, speed in (("n", 2.0), ("o", 3.0)):
        sim.spawn(spinner(name, speed), name=name)
    sim.step(5)
    assert [sim.joint(f"{m}::j_a").velocity for m in "mno"] == pytest.approx([1.0, 2.0, 3.0], abs=1e-4)
    kept = sim.snapshot()
    sim.remove("o")
    sim.publish("/model/n/joint/j_a/cmd_vel", {"data": -2.0})
    sim.step(5)
    assert [sim.joint(f"{m}::j_a").velocity for m in "mn"] == pytest.approx([1.0, -2.0], abs=1e-4)
    sim.restore(kept)
    sim.step(5)
    assert [sim.joint(f"{m}::j_a").velocity for m in "mno"] == pytest.approx([1.0, 2.0, 3.0], abs=1e-4)


def test_of_two_commands_to_one_joint_the_later_in_the_file_counts() -> None:
    plugins = [velocity(f"{A}<initial_velocity>{v}</initial_velocity>") for v in (1, 4)]
    sim = load(rotor("a"), *plugins)
    sim.step(3)
    assert sim.joint("m::j_a").velocity == pytest.approx(4.0, abs=1e-4)


@pytest.mark.slow
def test_a_run_in_another_process_is_identical() -> None:
    script = (
        "import sys; sys.path[:0] = sys.argv[1:]\n"
        "from test_joint_controller import cart\n"
        "sim = cart(0.1); sim.publish('/wheels', {'data': 3.0}); sim.step(80); print(sim.mj_data.qpos.tobytes().hex())"
    )
    folders = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "worlds")]
    seen = {
        subprocess.run(
            [sys.executable, "-c", script, *folders],
            env={**os.environ, "PYTHONHASHSEED": seed},
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        for seed in ("1", "2")
    }
    assert len(seen) == 1


# ---------------------------------------------------------------------- cost and robustness


def forward_passes_per_step(sim: simkit.Simulation, steps: int, monkeypatch: pytest.MonkeyPatch) -> float:
    """Return the number of forward passes per step."""
    passes = 0
    fresh = Physics.fresh

    def counted(physics: Any) -> Any:
        nonlocal passes
        passes += physics.stage != FRESH
        return fresh(physics)

    with monkeypatch.context() as patched:
        patched.setattr(Physics, "fresh", counted)
        sim.step(steps)
    return passes / steps


def test_in_steady_motion_a_step_needs_one_forward_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    sim = two(f"{A}{B}<initial_velocity>2</initial_velocity>")
    sim.step(5)
    assert forward_passes_per_step(sim, 50, monkeypatch) == 1.0
    rolling = cart(0.1)
    rolling.publish("/wheels", {"data": 3.0})
    rolling.step(300)
    assert forward_passes_per_step(rolling, 100, monkeypatch) < 2.0


def test_efforts_of_many_models_are_found_in_common_forward_passes(monkeypatch: pytest.MonkeyPatch) -> None:
    models = "".join(
        f"<model name='m{i}'>{rotor('a', damping=0.01 * (i % 3), inertia=0.1 + 0.01 * i)}{rotor('b', parent='a')}"
        f"{velocity(f'{A}<initial_velocity>{i}</initial_velocity>')}</model>"
        for i in range(40)
    )
    sim = load(rotor("a"), velocity(f"{A}<initial_velocity>-1</initial_velocity>"), extra=models, step=0.005)
    sim.step(5)
    assert [sim.joint(f"m{i}::j_a").velocity for i in range(40)] == pytest.approx(range(40), abs=1e-4)
    assert sim.joint("m::j_a").velocity == pytest.approx(-1.0, abs=1e-4)
    assert forward_passes_per_step(sim, 5, monkeypatch) <= 2.0


@pytest.mark.parametrize("inertias", [(1e-12, 1.0), (1.0, 1e-12), (1e9, 1e-9), (1e-30, 1e-30)])
def test_very_different_inertias_do_not_matter(inertias: tuple[float, float]) -> None:
    arm = rotor("a", inertia=inertias[0]) + rotor("b", parent="a", inertia=inertias[1])
    sim = load(arm, velocity(f"{A}{B}<initial_velocity>2</initial_velocity>"))
    sim.step(20)
    assert [sim.joint(f"m::j_{n}").velocity for n in "ab"] == pytest.approx([2.0, 2.0], abs=1e-4)


def test_a_joint_that_is_held_fast_stays_where_it_is() -> None:
    lock = "<joint name='lock' type='fixed'><parent>world</parent><child>a</child></joint>"
    sim = load(rotor("a"), lock, velocity(f"{A}<initial_velocity>2</initial_velocity>"))
    sim.step(100)
    assert abs(sim.joint("m::j_a").position) < 1e-4


def test_damping_that_is_set_during_the_run_is_compensated() -> None:
    sim = load(rotor("a"), velocity(f"{A}<initial_velocity>2</initial_velocity>"), step=0.02)
    sim.step(5)
    sim.engine.touch("dof_damping")[:] = 5.0
    sim.step(5)
    assert sim.joint("m::j_a").velocity == pytest.approx(2.0, abs=1e-4)
    assert sim.joint("m::j_a").effort == pytest.approx(10.0, abs=1e-3)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("speed", ["1e12", "1e300"])
def test_a_huge_velocity_diverges_and_the_message_names_the_plugin(speed: str) -> None:
    sim = load(rotor("a"), velocity(f"{A}<initial_velocity>{speed}</initial_velocity>"))
    with pytest.raises(simkit.SimulationDiverged, match="JointController.*moves joint 'm::j_a' at 1e"):
        sim.step(5)


def test_a_reset_restores_the_gains_of_the_file() -> None:
    sim = two(f"{A}{FORCE}<p_gain>2</p_gain><initial_velocity>4</initial_velocity>")
    sim.run(0.5)
    first = sim.joint("m::j_a").velocity
    sim.set_parameter("/model/m/joint/j_a/velocity_controller", "p_gain", 20.0)
    sim.run(0.5)
    sim.reset()
    sim.run(0.5)
    assert sim.joint("m::j_a").velocity == first


def test_two_controllers_of_one_joint_have_parameters_of_their_own() -> None:
    sim = load(rotor("a"), *[velocity(f"{A}{FORCE}<p_gain>{p}</p_gain>") for p in (2, 3)])
    node = "/model/m/joint/j_a/velocity_controller"
    assert [sim.communication.parameters[n]["p_gain"].value for n in (node, f"{node}_2")] == [2.0, 3.0]


def test_a_turret_keeps_its_velocity_while_its_base_starts_and_turns() -> None:
    turret = "<link name='turret'><pose>0 0 0.2 0 0 0</pose><inertial><mass>0.1</mass><inertia><ixx>1e-3</ixx>"
    turret += "<iyy>1e-3</iyy><izz>1e-3</izz></inertia></inertial></link><joint name='turn' type='revolute'>"
    turret += "<parent>base</parent><child>turret</child><axis><xyz>0 0 1</xyz></axis></joint>"
    turret += velocity("<joint_name>turn</joint_name><initial_velocity>0.4</initial_velocity>")
    drive = gz(
        "diff-drive",
        "DiffDrive",
        "<left_joint>j_fl</left_joint><left_joint>j_rl</left_joint><right_joint>j_fr</right_joint>"
        "<right_joint>j_rr</right_joint><wheel_separation>0.4</wheel_separation><wheel_radius>0.1</wheel_radius>",
    )
    sim = cart(0.0, drive + turret, by_velocity=False)
    sim.publish("/model/m/cmd_vel", {"linear": {"x": 0.5}, "angular": {"z": 2.0}})
    sim.step(5)
    for _ in range(200):
        sim.step()
        assert sim.joint("m::turn").velocity == pytest.approx(0.4, abs=1e-3)
