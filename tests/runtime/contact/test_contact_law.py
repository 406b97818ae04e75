"""Contact law: sliding bodies obey Coulomb's law, hitting bodies stop, overlapping bodies separate slowly."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.runtime.engine.physics_step import STALE, VELOCITY

G = 9.8


def mu(value: float) -> str:
    return f"<surface><friction><ode><mu>{value}</mu><mu2>{value}</mu2></ode></friction></surface>"


def body(name: str, shape: str, pose: str, friction: float = 0.5, mass: float = 1.0, inertia: float = 4e-3) -> str:
    tensor = "".join(f"<{axis}>{inertia}</{axis}>" for axis in ("ixx", "iyy", "izz"))
    return f"""<model name="{name}"><pose>{pose}</pose><link name="l"><inertial><mass>{mass}</mass>
      <inertia>{tensor}</inertia></inertial><collision name="c"><geometry>{shape}</geometry>{mu(friction)}</collision>
      </link></model>"""


def ground(friction: float = 2.0) -> str:
    return f"""<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane>
      <normal>0 0 1</normal><size>100 100</size></plane></geometry>{mu(friction)}</collision></link></model>"""


def world(*models: str, step: float = 0.001, physics: str = "") -> str:
    return f"""<sdf version="1.9"><world name="w"><physics name="p" type="ode"><max_step_size>{step}</max_step_size>
      {physics}</physics>{"".join(models)}</world></sdf>"""


FLAT = "<box><size>0.3 0.3 0.06</size></box>"
SHAPES = {  # shape, height of its origin, roll
    "box": (FLAT, 0.03, 0.0),
    "cylinder on its end": ("<cylinder><radius>0.1</radius><length>0.06</length></cylinder>", 0.03, 0.0),
    "cylinder on its side": (
        "<cylinder><radius>0.05</radius><length>0.3</length></cylinder>",
        0.05,
        math.pi / 2,
    ),
    "capsule": ("<capsule><radius>0.05</radius><length>0.2</length></capsule>", 0.05, math.pi / 2),
}


def slide(sim: Any, name: str, speed: float, seconds: float, direction: float = 0.0) -> tuple[float, float, float]:
    """Set a body in motion; return the fraction of steps with a contact, the highest rise [m] and the travel [m]."""
    model = sim.model(name)
    model.set_velocity((speed * math.cos(direction), speed * math.sin(direction), 0.0), (0.0, 0.0, 0.0))
    start, height = model.pose.position.copy(), float(model.pose.position[2])
    touches, rise, steps = 0, 0.0, round(seconds / sim.timestep)
    for _ in range(steps):
        sim.step()
        touches += sim.engine.physics.fresh().ncon > 0
        rise = max(rise, float(sim.mj_data.qpos[2]) - height)
    return touches / steps, rise, float(np.linalg.norm(model.pose.position[:2] - start[:2]))


@pytest.mark.parametrize("step", [0.0005, 0.001, 0.002, 0.004])
@pytest.mark.parametrize(("friction", "speed"), [(0.05, 1.0), (0.5, 3.0), (1.0, 10.0), (2.0, 20.0)])
def test_a_sliding_box_keeps_contact_and_stops_at_the_distance_of_coulombs_law(
    friction: float, speed: float, step: float
) -> None:
    with simkit.load(world(ground(), body("b", FLAT, "0 0 0.03 0 0 0", friction), step=step)) as sim:
        sim.run(0.2)
        seconds = min(1.0, 0.9 * speed / (friction * G))
        contact, rise, way = slide(sim, "b", speed, seconds)
        assert contact == 1.0
        assert rise < 5e-6
        # the integrator uses the velocity at the end of a step, so the total travel is v dt / 2 shorter
        lost = friction * G * seconds * step / 2.0
        assert way == pytest.approx(speed * seconds - friction * G * seconds**2 / 2.0 - lost, rel=1e-3)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("direction", [0.0, 0.7])
def test_every_shape_slides_with_the_same_friction_in_every_direction(shape: str, direction: float) -> None:
    geometry, height, roll = SHAPES[shape]
    across = direction if shape in ("box", "cylinder on its end") else math.pi / 2  # else the shape would roll
    with simkit.load(world(ground(), body("b", geometry, f"0 0 {height} {roll} 0 0"))) as sim:
        sim.run(0.2)
        contact, rise, way = slide(sim, "b", 5.0, 0.5, across)
        assert contact == 1.0
        assert rise < 5e-6
        assert way == pytest.approx(5.0 * 0.5 - 0.5 * G * 0.5**2 / 2.0, rel=2e-3)
        velocity = sim.link("b::l").linear_velocity
        assert math.atan2(velocity[1], velocity[0]) == pytest.approx(across, abs=1e-3)


def test_a_sliding_ball_finally_rolls_at_five_sevenths_of_its_speed() -> None:
    ball = body("b", "<sphere><radius>0.1</radius></sphere>", "0 0 0.1 0 0 0", inertia=0.4 * 0.01)
    with simkit.load(world(ground(), ball)) as sim:
        sim.run(0.2)
        contact, rise, _ = slide(sim, "b", 5.0, 1.0)
        assert (contact, rise < 5e-6) == (1.0, True)
        assert sim.link("b::l").linear_velocity[0] == pytest.approx(5.0 * 5.0 / 7.0, rel=1e-3)


def test_a_spinning_plate_stays_on_the_ground() -> None:
    with simkit.load(world(ground(), body("b", FLAT, "0 0 0.03 0 0 0", inertia=0.015))) as sim:
        sim.run(0.2)
        sim.model("b").set_velocity((0, 0, 0), (0, 0, 50.0))
        heights = []
        for _ in range(500):
            sim.step()
            heights.append(float(sim.mj_data.qpos[2]))
        assert max(heights) - min(heights) < 1e-5
        # friction acts at the four corners, 0.212 m from the middle: a torque of mu m g times this lever
        assert sim.link("b::l").angular_velocity[2] == pytest.approx(
            50.0 - 0.5 * G * 0.15 * math.sqrt(2) / 0.015 * 0.5, rel=2e-3
        )


def test_a_stack_slides_as_one_and_its_upper_box_slides_on_the_lower() -> None:
    low, high = body("low", FLAT, "0 0 0.03 0 0 0", 0.2), body("high", FLAT, "0 0 0.09 0 0 0", 0.5)
    with simkit.load(world(ground(), low, high)) as sim:
        sim.run(0.2)
        for name in ("low", "high"):
            sim.model(name).set_velocity((3, 0, 0), (0, 0, 0))
        sim.run(0.5)
        for name in ("low", "high"):
            assert sim.link(f"{name}::l").linear_velocity[0] == pytest.approx(3.0 - 0.2 * G * 0.5, rel=2e-3)
        sim.model("high").set_velocity((3, 0, 0), (0, 0, 0))
        before = sim.link("high::l").linear_velocity[0]
        sim.run(0.05)
        # the smaller coefficient of both boxes acts between them
        assert before - sim.link("high::l").linear_velocity[0] == pytest.approx(0.2 * G * 0.05, rel=1e-2)
        assert sim.model("high").pose.position[2] == pytest.approx(0.09, abs=2e-5)


@pytest.mark.parametrize("condim", [4, 6])
def test_torsional_and_rolling_friction_do_not_lift_the_ball(condim: int, tmp_path: Path) -> None:
    path = tmp_path / "world.xml"
    path.write_text(
        f"""<mujoco><option cone="elliptic" impratio="100" integrator="implicitfast" timestep="0.001"/>
        <default><geom condim="{condim}" friction="0.5 0.02 0.002" solref="0.004 1"/></default>
        <worldbody><geom type="plane" size="9 9 1"/><body name="b" pos="0 0 0.1"><freejoint/>
        <geom type="sphere" size="0.1" mass="1"/></body></worldbody></mujoco>"""
    )
    with simkit.load(path) as sim:
        sim.run(0.3)
        rest = float(sim.mj_data.qpos[2])
        sim.mj_data.qvel[:] = [3, 0, 0, 0, 0, 20]
        sim.engine.physics.changed(VELOCITY)
        rises = []
        for _ in range(500):
            sim.step()
            rises.append(float(sim.mj_data.qpos[2]) - rest)
        assert max(rises) < 5e-6
        sim.mj_data.qvel[:] = [0, 0, 0, 0, 0, 20]
        sim.mj_data.qpos[3:] = [1, 0, 0, 0]
        sim.engine.physics.changed(STALE)
        sim.run(0.2)
        # torsional friction: 0.02 m times the weight, on an inertia of 0.004 kg m²
        assert sim.mj_data.qvel[5] == pytest.approx(20.0 - 0.02 * 9.81 / 0.004 * 0.2, rel=0.01)


@pytest.mark.parametrize("cone", ["elliptic", "pyramidal"])
@pytest.mark.parametrize("integrator", ["implicitfast", "implicit", "Euler", "RK4"])
def test_sliding_follows_the_law_with_every_integrator_and_both_cones(
    integrator: str, cone: str, tmp_path: Path
) -> None:
    path = tmp_path / "world.xml"
    path.write_text(
        f"""<mujoco><option cone="{cone}" impratio="100" integrator="{integrator}" timestep="0.001"/>
        <default><geom friction="0.5" solref="0.004 1"/></default>
        <worldbody><geom type="plane" size="50 50 1"/><body name="b" pos="0 0 0.03"><freejoint/>
        <geom type="box" size="0.15 0.15 0.03" mass="1"/></body></worldbody></mujoco>"""
    )
    with simkit.load(path) as sim:
        sim.run(0.3)
        rest, start = float(sim.mj_data.qpos[2]), float(sim.mj_data.qpos[0])
        sim.mj_data.qvel[0] = 4.0
        sim.engine.physics.changed(VELOCITY)
        for _ in range(500):
            sim.step()
            assert abs(float(sim.mj_data.qpos[2]) - rest) < 5e-6
        lost = 0.0 if integrator == "RK4" else 0.5 * 9.81 * 0.5 * 0.001 / 2.0
        way = float(sim.mj_data.qpos[0]) - start
        assert way == pytest.approx(4.0 * 0.5 - 0.5 * 9.81 * 0.5**2 / 2.0 - lost, rel=1e-3)


@pytest.mark.parametrize("step", [0.001, 0.002])
def test_a_falling_cube_comes_to_rest_without_a_bounce(step: float) -> None:
    cube = body("b", "<box><size>0.05 0.05 0.05</size></box>", "0 0 1.6 0 0 0", mass=0.1, inertia=4.2e-5)
    with simkit.load(world(ground(), cube, step=step)) as sim:
        speeds = []
        assert sim.run_until(lambda s: s.model("b").pose.position[2] < 0.025, 1.0)
        for _ in range(round(0.1 / step)):
            sim.step()
            speeds.append(float(sim.link("b::l").linear_velocity[2]))
        assert max(speeds) < 0.01 * 5.56
        assert abs(speeds[-1]) < 1e-3


@pytest.mark.slow
def test_overlapping_cubes_separate_slowly_and_do_not_sink_into_the_ground() -> None:
    cube = "<box><size>1 1 1</size></box>"
    first, second = (body(n, cube, p, inertia=1 / 6) for n, p in (("a", "0 0 .5 0 0 0"), ("b", ".1 .1 .6 0 0 0")))
    with simkit.load(world(ground(), first, second)) as sim:
        lowest, fastest = 1.0, 0.0
        for _ in range(200):
            sim.run(0.05)
            for name in "ab":
                lowest = min(lowest, float(sim.model(name).pose.position[2]))
                fastest = max(fastest, float(np.linalg.norm(sim.link(f"{name}::l").linear_velocity[:2])))
        assert lowest > 0.498
        assert fastest < 0.2


def test_a_world_can_use_the_engines_own_contacts() -> None:
    box = body("b", FLAT, "0 0 0.03 0 0 0")
    with simkit.load(world(ground(), box, physics="<contact_law>mujoco</contact_law>")) as sim:
        sim.run(0.2)
        contact, rise, _ = slide(sim, "b", 3.0, 0.3)
        assert contact < 0.5 and rise > 1e-3
    with simkit.load(world(ground(), box), overrides=["physics.contact_law=mujoco"]) as sim:
        sim.run(0.2)
        assert slide(sim, "b", 3.0, 0.3)[0] < 0.5


def test_a_wheel_turns_on_the_spot_about_the_middle_of_its_tread() -> None:
    """If the two wheels of 4 cm width rolled on one edge, the robot would turn 14 % too slowly."""
    wheels = "".join(
        f"""<link name="{n}"><pose>0 {y} 0.1 -1.5707963267948966 0 0</pose><inertial><mass>0.5</mass><inertia>
        <ixx>2e-3</ixx><iyy>2e-3</iyy><izz>3e-3</izz></inertia></inertial><collision name="c"><geometry><cylinder>
        <radius>0.1</radius><length>0.04</length></cylinder></geometry>{mu(1.0)}</collision></link>
        <joint name="{n}_joint" type="revolute"><parent>base</parent><child>{n}</child><axis><xyz>0 0 1</xyz></axis>
        </joint>"""
        for n, y in (("left", 0.14), ("right", -0.14))
    )
    cart = f"""<model name="cart"><link name="base"><pose>0 0 0.1 0 0 0</pose><inertial><mass>4</mass><inertia>
      <ixx>0.03</ixx><iyy>0.03</iyy><izz>0.05</izz></inertia></inertial><collision name="c">
      <pose>-0.15 0 -0.07 0 0 0</pose><geometry><sphere><radius>0.03</radius></sphere></geometry>{mu(0.3)}</collision>
      </link>{wheels}
      <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"><left_joint>left_joint</left_joint>
      <right_joint>right_joint</right_joint><wheel_separation>0.28</wheel_separation><wheel_radius>0.1</wheel_radius>
      <topic>/cmd_vel</topic></plugin></model>"""
    with simkit.load(world(ground(), cart)) as sim:
        sim.run(0.5)
        sim.publish("/cmd_vel", {"angular": {"z": 1.0}})
        sim.run(1.0)
        before = [sim.joint(f"cart::{n}_joint").position for n in ("left", "right")]
        yaw = sim.model("cart").pose.rpy[2]
        sim.run(1.0)
        after = [sim.joint(f"cart::{n}_joint").position for n in ("left", "right")]
        said = (after[1] - before[1] - after[0] + before[0]) * 0.1 / 0.28
        assert said == pytest.approx(1.0, rel=5e-3)
        assert sim.model("cart").pose.rpy[2] - yaw == pytest.approx(said, rel=0.015)


def test_a_box_slides_down_an_even_height_map_over_the_borders_of_its_cells(tmp_path: Path) -> None:
    """Regression: an inner wall between the prisms of MuJoCo's height field stopped the box."""
    image = pytest.importorskip("PIL.Image")
    image.fromarray(np.tile(np.linspace(65535, 0, 33).round().astype(np.uint16), (33, 1))).save(tmp_path / "ramp.png")
    tilt = math.atan(8.0 / 32.0)
    x, z = -13.0 + 0.05 * math.sin(tilt), 8.0 - 3.0 * 0.25 + 0.05 * math.cos(tilt)
    shape = "<heightmap><uri>ramp.png</uri><size>32 32 8</size><pos>0 0 0</pos></heightmap>"
    ramp = f"""<model name="ramp"><static>true</static><link name="l"><collision name="c"><geometry>{shape}</geometry>
      {mu(2.0)}</collision></link></model>"""
    box = body("b", "<box><size>0.4 0.3 0.1</size></box>", f"{x} 0.13 {z} 0 {tilt} 0", 0.1, mass=5.0, inertia=0.06)
    (tmp_path / "world.sdf").write_text(world(ramp, box))
    with simkit.load(tmp_path / "world.sdf") as sim:
        start = sim.model("b").pose.position.copy()
        sim.run(2.0)
        way = np.linalg.norm(sim.model("b").pose.position - start)
        assert way == pytest.approx((math.sin(tilt) - 0.1 * math.cos(tilt)) * G * 2.0, rel=5e-3)


def test_a_command_that_makes_wheels_slip_does_not_lift_them_in_its_first_step(tmp_path: Path) -> None:
    path = tmp_path / "world.xml"
    path.write_text(
        """<mujoco><option cone="elliptic" impratio="100" integrator="implicitfast" timestep="0.001"/>
        <default><geom friction="0.7" solref="0.004 1"/></default>
        <worldbody><geom type="plane" size="9 9 1"/><body name="base" pos="0 0 0.1"><freejoint/>
        <geom type="box" size="0.3 0.2 0.02" mass="8" contype="0" conaffinity="0"/>"""
        + "".join(
            f"""<body name="w{n}" pos="{x} {y} 0"><joint name="j{n}" type="hinge" axis="0 1 0" armature="0.002"/>
            <geom type="cylinder" size="0.1 0.02" euler="90 0 0" mass="0.5"/></body>"""
            for n, (x, y) in enumerate(((0.2, 0.25), (0.2, -0.25), (-0.2, 0.25), (-0.2, -0.25)))
        )
        + "</body></worldbody><actuator>"
        + "".join(f'<velocity name="a{n}" joint="j{n}" kv="6"/>' for n in range(4))
        + "</actuator></mujoco>"
    )
    with simkit.load(path) as sim:
        sim.run(0.305)
        rest = float(sim.mj_data.qpos[2])
        sim.mj_data.ctrl[:] = [2.5, -2.5, 2.5, -2.5]
        for _ in range(100):
            sim.step()
            assert float(sim.mj_data.qpos[2]) - rest < 2e-5


def test_a_surface_with_a_stiffness_of_its_own_stays_soft() -> None:
    """A hit at 2 m/s on a surface of 2000 N/m stops 1 kg within many steps; a rigid contact needs one step."""
    soft = "<contact><ode><kp>2000</kp><kd>1</kd></ode></contact></surface>"
    ball = body("b", "<sphere><radius>0.1</radius></sphere>", "0 0 0.31 0 0 0").replace("</surface>", soft)
    with simkit.load(world(ground(), ball)) as sim:
        assert sim.run_until(lambda s: s.model("b").pose.position[2] < 0.1, 1.0)
        sim.step(3)
        assert sim.link("b::l").linear_velocity[2] < -1.0
