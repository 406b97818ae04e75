"""Heaps of round bodies come to rest and sleep, and what rolls alone or on a slope rolls on."""

from __future__ import annotations

import math
import pickle
import random

import numpy as np
import pytest

import simkit
from simkit_verification.testing.bundles.bundle_staging import model_hash

RADIUS = 0.03
PLANE = "<plane><normal>0 0 1</normal><size>100 100</size></plane>"
BALL = f"<sphere><radius>{RADIUS}</radius></sphere>"
CAPSULE = "<capsule><radius>0.02</radius><length>0.06</length></capsule>"
GRAVITY = "0 0 -9.8"


def fixed(name: str, shape: str, place: str = "0 0 0") -> str:
    return f"""<model name="{name}"><static>true</static><pose>{place} 0 0 0</pose><link name="l">
<collision name="c"><geometry>{shape}</geometry></collision></link></model>"""


def body(name: str, place: tuple[float, float, float], shape: str = BALL, inside: str = "", more: str = "") -> str:
    x, y, z = place
    return f"""<model name="{name}"><pose>{x} {y} {z} 0 1.57 {x * 40}</pose>{inside}<link name="l">
<inertial><mass>0.2</mass><inertia><ixx>7.2e-5</ixx><iyy>7.2e-5</iyy><izz>7.2e-5</izz></inertia></inertial>
<collision name="c"><geometry>{shape}</geometry>{more}</collision></link></model>"""


def world(*parts: str, gravity: str = GRAVITY, engine: str = "ode") -> str:
    return f"""<sdf version="1.9"><world name="w"><gravity>{gravity}</gravity>
<physics name="p" type="{engine}"><max_step_size>0.001</max_step_size></physics>{"".join(parts)}</world></sdf>"""


def tray(side: float) -> str:
    wall = side / 2 + 0.05
    places = (f"{wall} 0 0.2", f"{-wall} 0 0.2", f"0 {wall} 0.2", f"0 {-wall} 0.2")
    sizes = (f"0.1 {side} 0.6",) * 2 + (f"{side + 0.2} 0.1 0.6",) * 2
    walls = zip(places, sizes, strict=True)
    return fixed("floor", PLANE) + "".join(
        fixed(f"wall_{i}", f"<box><size>{size}</size></box>", place) for i, (place, size) in enumerate(walls)
    )


def heap(shape: str = BALL, count: int = 12, **more: str) -> str:
    """Return a world in which bodies fall into a tray."""
    draw = random.Random(5)
    bodies = [
        body(f"b{i}", (draw.uniform(-0.06, 0.06), draw.uniform(-0.06, 0.06), 0.06 + 0.07 * i), shape, **more)
        for i in range(count)
    ]
    return world(tray(0.22), *bodies)


def speeds(sim: simkit.Simulation) -> np.ndarray:
    """Return the speeds of the bodies [m/s]."""
    found: np.ndarray = np.linalg.norm(sim.mj_data.qvel.reshape(-1, 6)[:, :3], axis=1)
    return found


def sleepers(sim: simkit.Simulation) -> int:
    return int((sim.engine.physics.fresh().tree_asleep >= 0).sum())


def resisted(sim: simkit.Simulation) -> int:
    """Return the number of bodies with rolling resistance."""
    return int((sim.mj_model.dof_frictionloss > 0.0).sum()) // 3


def bits(sim: simkit.Simulation) -> bytes:
    return bytes(sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes())


def rolling(*places: tuple[float, float], v: float, gravity: str = GRAVITY, more: str = "") -> simkit.Simulation:
    """Return a world in which balls at some places roll along x with the same speed [m/s]."""
    balls = [body(f"b{i}", (x, y, RADIUS), more=more) for i, (x, y) in enumerate(places)]
    sim = simkit.load(world(fixed("floor", PLANE), *balls, gravity=gravity))
    sim.run(0.05)
    for i in range(len(places)):
        sim.model(f"b{i}").set_velocity((v, 0, 0), (0, v / RADIUS, 0))
    return sim


# ---------------------------------------------------------------------- heaps


@pytest.mark.parametrize("shape", [BALL, CAPSULE])
def test_a_heap_is_at_rest_three_seconds_after_it_begins_to_fall_and_asleep_one_later(shape: str) -> None:
    sim = simkit.load(heap(shape))
    sim.run(3.0)
    assert speeds(sim).max() < 1e-3
    sim.run(1.0)
    assert sleepers(sim) == 12


def test_a_heap_repeats_its_bits_after_a_reset_and_after_restores_while_it_comes_to_rest() -> None:
    sim = simkit.load(heap())
    sim.run(1.55)
    assert resisted(sim) > 3
    first = sim.snapshot()
    sim.run(0.05)
    second = sim.snapshot()
    sim.run(0.4)
    before = bits(sim)
    other = simkit.load(heap())
    other.restore(pickle.loads(pickle.dumps(second)))
    other.run(2.0 - other.time)
    assert bits(other) == before
    for snapshot in (first, second):
        sim.restore(snapshot)
        sim.run(2.0 - sim.time)
        assert bits(sim) == before
    sim.reset()
    assert resisted(sim) == 0
    sim.run(2.0)
    assert bits(sim) == before


def test_the_model_of_a_bundle_is_the_same_while_a_heap_comes_to_rest() -> None:
    sim = simkit.load(heap())
    before = model_hash(sim.mj_model, {})
    sim.run(1.6)
    assert resisted(sim) > 3
    assert model_hash(sim.mj_model, {}) == before


def test_readers_and_the_division_into_steps_do_not_change_a_heap() -> None:
    one, other = simkit.load(heap()), simkit.load(heap())
    one.run(1.8)
    for _ in range(600):
        other.step(3)
        assert other.link("b3::l").linear_acceleration.shape == (3,)
    assert resisted(one) > 3
    assert bits(one) == bits(other)


@pytest.mark.parametrize("override", ["physics.sleep=false", "physics.contact_law=mujoco"])
def test_without_sleep_and_with_the_engine_s_own_law_a_heap_has_no_resistance(override: str) -> None:
    sim = simkit.load(heap(), overrides=[override])
    for _ in range(4):
        sim.run(0.5)
        assert resisted(sim) == 0


def test_bodies_that_may_not_sleep_have_no_resistance() -> None:
    sim = simkit.load(heap(inside="<allow_auto_disable>false</allow_auto_disable>"))
    sim.run(1.6)
    assert resisted(sim) == 0


def test_boxes_in_a_heap_have_no_resistance() -> None:
    sim = simkit.load(heap("<box><size>0.05 0.04 0.06</size></box>"))
    sim.run(1.6)
    assert resisted(sim) == 0


def test_bodies_with_rolling_friction_in_the_file_keep_this_friction_alone() -> None:
    friction = "<surface><friction><bullet><rolling_friction>0.001</rolling_friction></bullet></friction></surface>"
    source = heap(more=friction).replace('type="ode"', 'type="bullet"')
    sim = simkit.load(source)
    sim.run(1.6)
    assert sim.mj_model.geom_condim[-1] == 6
    assert resisted(sim) == 0


# ---------------------------------------------------------------------- what rolls on


@pytest.mark.parametrize(
    "places",
    [
        ((0.0, 0.0),),
        ((0.0, 0.0), (2 * RADIUS, 0.0)),  # two that touch
        ((0.0, 0.0), (0.0, 0.1), (0.0, 0.2)),  # three side by side, none touches another
    ],
)
def test_slow_balls_that_are_not_in_a_heap_roll_on(places: tuple[tuple[float, float], ...]) -> None:
    sim = rolling(*places, v=0.02)
    sim.run(4.0)
    assert speeds(sim) == pytest.approx(0.02, rel=0.02)


def test_fast_balls_roll_on_even_beside_each_other() -> None:
    sim = rolling((0.0, 0.0), (0.0, 2 * RADIUS), (0.0, 4 * RADIUS), v=0.5)
    sim.run(2.0)
    assert speeds(sim) == pytest.approx(0.5, rel=0.002)


@pytest.mark.parametrize("turn", [0.0, math.radians(45)])
def test_balls_in_a_heap_roll_down_a_slope_of_one_degree(turn: float) -> None:
    along = 9.8 * math.sin(math.radians(1))
    gravity = f"{along * math.cos(turn)} {along * math.sin(turn)} {-9.8 * math.cos(math.radians(1))}"
    box = "<box><size>0.06 0.06 0.06</size></box>"
    stack = [body(f"box_{i}", (0.0, -0.1, RADIUS * (1 + 2 * i)), box) for i in range(2)]
    balls = [body(f"b{i}", (x, y, RADIUS)) for i, (x, y) in enumerate(((0.0, 0.0), (0.0, 0.1), (0.08, 0.05)))]
    sim = simkit.load(world(fixed("floor", PLANE), *balls, *stack, gravity=gravity))
    sim.run(0.2)
    assert resisted(sim) == 3
    sim.run(4.8)
    assert (speeds(sim)[:3] > 0.2).all()
    assert resisted(sim) == 0  # they are fast


@pytest.mark.parametrize("is_measured", [False, True])
def test_balls_under_a_plate_with_a_sensor_have_no_resistance(is_measured: bool) -> None:
    plate = "<box><size>0.2 0.2 0.02</size></box>"
    load = body("load", (0.0, 0.0, 2 * RADIUS + 0.01), plate).replace("0 1.57 0.0<", "0 0 0<")
    if is_measured:
        imu = '<sensor name="imu" type="imu"><update_rate>10</update_rate></sensor></link>'
        load = load.replace("</link>", imu)
    places = ((0.05, 0.0), (-0.03, 0.05), (-0.03, -0.05))
    balls = [body(f"b{i}", (x, y, RADIUS)) for i, (x, y) in enumerate(places)]
    sim = simkit.load(world(fixed("floor", PLANE), *balls, load))
    sim.run(0.3)
    assert resisted(sim) == (0 if is_measured else 3)
