"""Bodies that could pass through an obstacle within one step stop at it, and nothing else changes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import simkit
from simkit.runtime.contact.contact_law import window_length
from simkit.runtime.contact.speculative_contacts import SPECULATIVE_FLAG

SHAPES = {
    "ball": "<sphere><radius>0.02</radius></sphere>",
    "box": "<box><size>0.04 0.04 0.04</size></box>",
    "cylinder": "<cylinder><radius>0.02</radius><length>0.04</length></cylinder>",
}
TILTED = (0.83, 0.31, -0.24, 0.4)


def body(name: str, geometry: str, pose: str = "-0.3 0.03 0.02 0 0 0", inertia: float = 3e-5) -> str:
    tensor = "".join(f"<{i}>{inertia}</{i}>" for i in ("ixx", "iyy", "izz"))
    return f"""<model name="{name}"><pose>{pose}</pose><link name="l"><inertial><mass>0.1</mass>
      <inertia>{tensor}</inertia></inertial>
      <collision name="c"><geometry>{geometry}</geometry></collision></link></model>"""


def fixed(geometry: str) -> str:
    return f"""<model name="wall"><static>true</static><link name="l"><collision name="c">
      <geometry>{geometry}</geometry></collision></link></model>"""


def wall(thickness: float) -> str:
    return fixed(f"<box><size>{thickness} 2 2</size></box>")


def world(*models: str, step: float = 0.001, gravity: str = "0 0 0") -> str:
    return f"""<sdf version="1.9"><world name="w"><gravity>{gravity}</gravity><physics type="ode">
      <max_step_size>{step}</max_step_size></physics>{"".join(models)}</world></sdf>"""


def shoot(
    text: str, speed: float, quaternion: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0), **more: object
) -> simkit.Simulation:
    """Run a world in which model `b` flies along x, until the model must have hit the obstacle."""
    sim = simkit.load(text, **more)
    turn = tuple(np.array(quaternion) / np.linalg.norm(quaternion))
    sim.model("b").set_pose(simkit.Pose(sim.model("b").pose.position, turn))
    sim.model("b").set_velocity((speed, 0, 0), (0, 0, 0))
    sim.run(0.4 / speed + 0.05)
    return sim


def codes(sim: simkit.Simulation) -> list[str]:
    return [d.code for d in sim.diagnostics if d.code == "SK-PHYS-031"]


# ---------------------------------------------------------------------- fast bodies stop


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("speed", "thickness"), [(18, 0.01), (40, 0.01), (80, 0.05), (300, 0.01)])
def test_a_fast_body_does_not_pass_through_a_wall(shape: str, speed: float, thickness: float) -> None:
    sim = shoot(world(wall(thickness), body("b", SHAPES[shape])), speed)
    assert sim.model("b").pose.position[0] < 0.0
    # remaining speed after the impact: an ordinary soft contact leaves 2.4 m/s at 18 m/s
    assert abs(sim.link("b::l").linear_velocity[0]) < max(3.0, 0.02 * speed)


@pytest.mark.parametrize("shape", ["box", "cylinder"])
@pytest.mark.parametrize("step", [0.0005, 0.001, 0.002])
@pytest.mark.parametrize("travel", [0.015, 0.04, 0.07])
def test_a_body_that_hits_a_wall_with_an_edge_does_not_pass_through(shape: str, step: float, travel: float) -> None:
    sim = shoot(world(wall(0.01), body("b", SHAPES[shape]), step=step), travel / step, TILTED)
    assert sim.model("b").pose.position[0] < 0.0


@pytest.mark.parametrize("shape", ["ball", "box"])
@pytest.mark.parametrize("speed", [8.0, 18.0, 100.0])
@pytest.mark.parametrize("restitution", [0.3, 0.8, 1.0])
def test_a_fast_body_bounces_with_its_restitution(shape: str, speed: float, restitution: float) -> None:
    bounce = f"<restitution_coefficient>{restitution}</restitution_coefficient><threshold>0</threshold>"
    surface = f"</geometry><surface><bounce>{bounce}</bounce></surface>"
    sim = shoot(world(wall(0.01), body("b", SHAPES[shape])).replace("</geometry>", surface), speed)
    # exact for a flat hit, because the whole impulse acts within one step
    assert sim.link("b::l").linear_velocity[0] == pytest.approx(-restitution * speed, rel=2e-3)


def test_two_fast_bodies_do_not_pass_through_each_other() -> None:
    sim = simkit.load(world(body("a", SHAPES["ball"], "-1 0 0 0 0 0"), body("b", SHAPES["ball"], "1 0 0 0 0 0")))
    sim.model("a").set_velocity((60, 0, 0), (0, 0, 0))
    sim.model("b").set_velocity((-47, 0, 0), (0, 0, 0))
    sim.run(0.05)
    a, b = (sim.model(name).pose.position[0] for name in "ab")
    assert a < b
    # equal masses without bounce: both continue with the mean of their velocities, except for a rest of the impact
    speeds = [sim.link(f"{name}::l").linear_velocity[0] for name in "ab"]
    assert sum(speeds) == pytest.approx(13.0, abs=1e-6)
    assert speeds[1] - speeds[0] < 3.0


def test_a_long_spinning_rod_hits_a_thin_post() -> None:
    rod = body("b", "<box><size>1 0.01 0.01</size></box>", "0 0 0 0 0 0", 0.01)
    sim = simkit.load(
        world(rod, fixed("<box><size>0.01 0.01 0.4</size></box>").replace("<link", "<pose>0 0.45 0 0 0 0</pose><link"))
    )
    sim.model("b").set_velocity((0, 0, 0), (0, 0, 150))  # the ends of the rod move at 75 m/s
    for _ in range(40):
        sim.step()
        if abs(sim.link("b::l").angular_velocity[2]) < 140.0:
            break
    assert sim.tick <= 12  # a quarter of a turn takes 10.5 steps


def test_a_velocity_set_in_the_middle_of_a_window_takes_effect_at_once() -> None:
    sim = simkit.load(world(wall(0.01), body("b", SHAPES["ball"], "-0.05 0.03 0.02 0 0 0")))
    sim.step(3)
    sim.model("b").set_velocity((40, 0, 0), (0, 0, 0))
    sim.step(20)
    assert sim.model("b").pose.position[0] < 0.0


def test_a_wall_with_a_non_convex_mesh_stops_a_fast_body(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    parts = [trimesh.creation.box((0.01, 2, 2)), trimesh.creation.box((0.01, 2, 2))]
    parts[1].apply_translation((0.5, 0, 0))
    parts.append(trimesh.creation.icosphere(2, 0.1))
    parts[2].apply_translation((0.25, 0, 0))
    parts[2].vertices[:, 1] += 2.0 * (parts[2].vertices[:, 0] - 0.25) ** 2 * 20  # a bent wall, so not convex
    trimesh.util.concatenate(parts).export(tmp_path / "wall.stl")
    path = tmp_path / "world.sdf"
    path.write_text(world(fixed("<mesh><uri>wall.stl</uri></mesh>"), body("b", SHAPES["ball"])))
    sim = shoot(str(path), 80)
    assert sim.model("b").pose.position[0] < 0.0
    assert codes(sim) == []


def test_a_fast_body_wakes_a_sleeping_board_and_does_not_pass_through_it() -> None:
    ground = fixed("<plane><normal>0 0 1</normal><size>20 20</size></plane>")
    board = body("board", "<box><size>0.1 0.4 0.4</size></box>", "0 0 0.2 0 0 0", 0.01)
    ball = body("b", SHAPES["ball"], "-5 0 0.02 0 0 0")
    sim = simkit.load(world(ground, board, ball, gravity="0 0 -9.8"))
    sim.run(3.0)
    assert (sim.mj_data.tree_asleep >= 0).any()
    sim.model("b").set_pose(simkit.Pose((-1.0, 0.03, 0.2)))
    sim.model("b").set_velocity((150, 0, 0), (0, 0, 0))
    sim.step(30)
    assert sim.model("b").pose.position[0] < sim.model("board").pose.position[0]
    assert sim.link("board::l").linear_velocity[0] > 1.0


# ---------------------------------------------------------------------- disabled without fast bodies


def test_speculative_contacts_are_enabled_only_while_a_fast_body_is_near() -> None:
    sim = simkit.load(world(wall(0.01), body("b", SHAPES["ball"], "-3 0.03 0.02 0 0 0")))
    sim.model("b").set_velocity((40, 0, 0), (0, 0, 0))
    on = []
    window = window_length(sim.timestep)
    for _ in range(160):
        sim.step()
        on.append(bool(sim.mj_model.opt.enableflags & SPECULATIVE_FLAG))
    assert not any(on[: 2 * window])  # 1.7 m from the wall; a window at twice the speed is 1.3 m
    assert any(on)
    assert not any(on[-2 * window :])  # the ball rests at the wall


@pytest.mark.parametrize(("speed", "is_fast"), [(12.0, False), (13.0, True)])
def test_the_limit_is_a_quarter_of_both_thicknesses_in_a_step(speed: float, is_fast: bool) -> None:
    # (0.04 + 0.01) / 4 = 12.5 mm in 1 ms
    sim = simkit.load(world(wall(0.01), body("b", SHAPES["ball"], "-0.1 0.03 0.02 0 0 0")))
    sim.model("b").set_velocity((speed, 0, 0), (0, 0, 0))
    assert sim.engine.physics.fast_bodies.wants(sim.mj_data) is is_fast


def test_a_plane_and_a_spinning_ball_need_no_speculative_contacts() -> None:
    plane = fixed("<plane><normal>0 0 1</normal><size>10 10</size></plane>")
    sim = simkit.load(world(plane, body("b", SHAPES["ball"], "0 0 1 0 0 0")))
    sim.model("b").set_velocity((0, 0, -300), (500, 0, 0))
    assert not sim.engine.physics.fast_bodies.wants(sim.mj_data)
    sim = simkit.load(world(wall(0.01), body("b", SHAPES["ball"], "-0.1 0 0 0 0 0")))
    sim.model("b").set_velocity((0, 0, 0), (0, 5000, 0))
    assert not sim.engine.physics.fast_bodies.wants(sim.mj_data)


def test_the_speed_of_a_body_on_a_joint_is_that_of_its_farthest_point() -> None:
    arm = """<model name="arm"><joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
      <link name="base"/><joint name="j" type="revolute"><parent>base</parent><child>blade</child>
      <axis><xyz>0 0 1</xyz></axis></joint><link name="blade"><pose>0.5 0 0 0 0 0</pose><inertial><mass>1</mass>
      <inertia><ixx>0.01</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial><collision name="c"><geometry><box>
      <size>1 0.01 0.1</size></box></geometry></collision></link></model>"""
    arm = arm.replace('<link name="base"/>', '<link name="base"><inertial><mass>1</mass></inertial></link>')
    sim = simkit.load(world(arm, wall(0.01).replace("<link", "<pose>0.9 0.6 0 0 0 1.57</pose><link")))
    joint, wants = sim.joint("arm::j"), sim.engine.physics.fast_bodies.wants
    joint.set_velocity(2.0)  # the end moves at 2 m/s: 2 mm per step, of 5 mm allowed
    assert not wants(sim.mj_data)
    joint.set_velocity(20.0)
    assert wants(sim.mj_data)


def test_slow_bodies_have_the_same_bits_as_without_the_detector() -> None:
    text = world(wall(0.01), body("b", SHAPES["box"], "-0.3 0.03 0.02 0.3 0.2 0.1"), gravity="0 0 -9.8")
    runs = []
    for looks in (True, False):
        sim = simkit.load(text)
        sim.engine.physics.fast_bodies.can_be_fast = looks
        sim.model("b").set_velocity((8, 0, 0), (3, 2, 1))
        sim.run(0.2)
        runs.append((sim.mj_data.qpos.tobytes(), sim.mj_data.qvel.tobytes()))
    assert runs[0] == runs[1]


# ---------------------------------------------------------------------- the same bits with readers


def _pair() -> simkit.Simulation:
    sim = simkit.load(world(wall(0.01), body("b", SHAPES["box"]), body("c", SHAPES["ball"], "-0.5 0.1 0 0 0 0")))
    sim.model("b").set_velocity((30, 0, 0), (5, 3, 2))
    sim.model("c").set_velocity((90, 0, 0), (0, 0, 0))
    return sim


def _bits(sim: simkit.Simulation) -> bytes:
    return sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes()


@pytest.mark.parametrize("chunks", [[1] * 60, [7] * 8 + [4], [13, 1, 1, 40, 5]])
def test_chunks_of_steps_and_readers_do_not_change_any_bit(chunks: list[int]) -> None:
    whole = _pair()
    whole.step(60)
    for reads in (False, True):
        sim = _pair()
        for count in chunks:
            sim.step(count)
            if reads:
                _ = sim.engine.physics.fresh().ncon, sim.link("b::l").linear_acceleration
        assert _bits(sim) == _bits(whole)


@pytest.mark.parametrize("tick", [3, 8, 9, 12, 17])
def test_a_run_restored_in_the_middle_of_a_window_repeats(tick: int) -> None:
    sim = _pair()
    sim.step(tick)
    snapshot = sim.snapshot()
    sim.step(30)
    once = _bits(sim)
    sim.restore(snapshot)
    sim.step(30)
    assert _bits(sim) == once
    sim.reset()
    sim.model("b").set_velocity((30, 0, 0), (5, 3, 2))
    sim.model("c").set_velocity((90, 0, 0), (0, 0, 0))
    sim.step(tick + 30)
    assert _bits(sim) == once


# ---------------------------------------------------------------------- warnings


def test_a_height_map_that_a_body_may_pass_is_reported_once_per_pair(tmp_path: Path) -> None:
    from PIL import Image

    Image.fromarray(np.full((33, 33), 128, np.uint8)).save(tmp_path / "flat.png")
    shape = "<heightmap><uri>flat.png</uri><size>8 8 0.5</size><pos>0 0 0</pos></heightmap>"
    path = tmp_path / "world.sdf"
    balls = [body(name, SHAPES["ball"], f"{x} 0 2 0 0 0") for name, x in (("b", 0), ("c", 1))]
    path.write_text(world(fixed(shape), *balls))
    sim = simkit.load(path)
    for _ in range(2):
        for name, speed in (("b", -200), ("c", -2)):
            sim.model(name).set_pose(simkit.Pose((0.0 if name == "b" else 1.0, 0.0, 2.0)))
            sim.model(name).set_velocity((0, 0, speed), (0, 0, 0))
        sim.step(16)
    (found,) = [d for d in sim.diagnostics if d.code == "SK-PHYS-031"]
    assert found.severity == "warning"
    assert "b::l::c may pass through the height map wall::l::c" in found.message
    assert "200 m/s" in found.message
    # a travel of (0.04 + 0.1) / 4 m at 200 m/s takes 0.175 ms
    assert found.hint == "<max_step_size>0.0001</max_step_size>"


def test_a_box_that_is_far_too_fast_is_reported_but_a_ball_is_not() -> None:
    assert codes(shoot(world(wall(0.01), body("b", SHAPES["ball"])), 300)) == []
    assert len(codes(shoot(world(wall(0.01), body("b", SHAPES["box"])), 300))) == 1
    assert codes(shoot(world(wall(0.01), body("b", SHAPES["box"])), 40)) == []


def test_a_body_that_flies_past_is_not_reported() -> None:
    sim = simkit.load(world(wall(0.01), body("b", SHAPES["box"])))
    sim.model("b").set_velocity((0, 0, 300), (0, 0, 0))
    sim.run(0.05)
    assert codes(sim) == []
