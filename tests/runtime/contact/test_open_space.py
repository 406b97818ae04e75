"""Bodies far from everything are stepped by the engine alone, with the same bits as by the contact law."""

from __future__ import annotations

import pickle

import mujoco
import numpy as np
import pytest

import simkit
from simkit.runtime.contact.open_space import OpenSpace

GROUND = '<geom type="plane" size="1 1 .1"/>'
WALL = '<geom type="box" size="1 1 1" pos="5 0 0"/>'
FLYER = """<body pos="{}"><freejoint/><geom type="box" size=".2 .1 .05"/>
  <body pos=".2 0 0"><joint type="{}" axis="1 0 0"/><geom type="capsule" size=".02 .1"/></body></body>"""


def space(*elements, height=10.0, speed=0.0):
    """Return whether the first body of a model with these elements can touch nothing within 64 ms."""
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{''.join(elements)}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    data.qpos[2], data.qvel[2] = height, speed
    return OpenSpace(model, 0.064).is_open(data)


@pytest.mark.parametrize(
    ("height", "speed", "expected"), [(10.0, 0.0, True), (1.1, 0.0, True), (0.9, 0.0, False), (10.0, 80.0, False)]
)
def test_a_flyer_needs_room_for_its_size_and_its_speed(height, speed, expected):
    # radius 0.32 m and twice 5 m/s for 64 ms: 0.96 m above the ground
    assert space(GROUND, FLYER.format("0 0 0", "hinge"), height=height, speed=speed) is expected


def test_the_space_around_a_box_is_not_open():
    flyer = FLYER.format("5 0 0", "hinge")
    assert space(WALL, flyer, height=4.0)
    assert not space(WALL, flyer, height=2.0)


def test_two_flyers_that_may_meet_are_not_alone():
    assert space(GROUND, FLYER.format("0 0 5", "hinge"), FLYER.format("5 0 10", "hinge"))
    assert not space(GROUND, FLYER.format("0 0 5", "hinge"), FLYER.format("1 0 10", "hinge"))


def test_models_without_a_bound_of_their_size_are_never_alone():
    assert not space(GROUND, FLYER.format("0 0 5", "slide"))
    assert not space(GROUND, '<body mocap="true"><geom size=".1"/></body>', FLYER.format("0 0 5", "hinge"))
    assert not space(GROUND, FLYER.format("0 0 5", "hinge"), height=np.nan)


def test_a_changed_place_or_size_makes_the_check_out_of_date():
    model = mujoco.MjModel.from_xml_string(
        f"<mujoco><worldbody>{WALL}{FLYER.format('0 0 9', 'hinge')}</worldbody></mujoco>"
    )
    for field in ("geom_pos", "geom_rbound", "body_pos"):
        found = OpenSpace(model, 0.064)
        assert found.is_current()
        getattr(model, field)[-1] += 1.0
        assert not found.is_current()


def test_a_wall_that_is_moved_under_a_falling_ball_stops_it(tmp_path):
    world = tmp_path / "world.sdf"
    world.write_text("""<sdf version="1.9"><world name="w"><model name="plate"><static>true</static>
      <pose>0 0 -50 0 0 0</pose><link name="l"><collision name="c"><geometry><box><size>2 2 0.2</size></box></geometry>
      </collision></link></model>
      <model name="ball"><pose>0 0 4 0 0 0</pose><link name="l"><inertial auto="true"/><collision name="c">
      <geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link></model></world></sdf>""")
    with simkit.load(world) as sim:
        sim.run(0.5)
        space = sim.engine.physics._space
        plate = int(np.flatnonzero(sim.mj_model.geom_bodyid == 0)[0])
        sim.engine.touch("geom_pos")[plate] = (0.0, 0.0, -0.1)
        sim.run(2.0)
        assert sim.engine.physics._space is not space
        assert sim.model("ball").pose.position[2] == pytest.approx(0.1, abs=5e-3)


def test_a_fall_has_the_same_bits_with_and_without_the_check(tmp_path):
    world = tmp_path / "world.sdf"
    world.write_text("""<sdf version="1.9"><world name="w">
      <model name="step"><static>true</static><link name="l"><collision name="c"><geometry>
      <box><size>2 2 0.2</size></box></geometry></collision></link></model>
      <model name="ball"><pose>0.9 0.3 4 0.3 0.2 0</pose><link name="l"><inertial auto="true"/><collision name="c">
      <geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link></model></world></sdf>""")
    runs = []
    for is_known in (True, False):
        with simkit.load(world) as sim:
            assert sim.engine.physics._space.is_known
            sim.engine.physics._space.is_known = is_known
            states = []
            for _ in range(150):  # it hits at 0.88 s
                sim.run(0.013)
                states.append(sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes())
            assert sim.model("ball").pose.position[2] < 0.3
            runs.append(states)
    assert runs[0] == runs[1]


PLANE_AND_BODY = """<sdf version="1.9"><world name="w">
  <physics type="ode"><max_step_size>{step}</max_step_size></physics>
  <model name="floor"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
  </link></model>
  <model name="b"><pose>0 0 2 0 0 0</pose><link name="l"><inertial><pose>{offset} 0 0 0 0 0</pose><mass>1</mass>
  <inertia><ixx>.01</ixx><iyy>.1</iyy><izz>.1</izz></inertia></inertial><collision name="c"><pose>{offset} 0 0 0 0 0
  </pose><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link></model></world></sdf>"""


def throw(sim):
    sim.model("b").set_velocity((0.0, 0.0, -100.0))


def kick(sim):
    sim.model("b").link("l").apply_wrench((0.0, 0.0, -60.0 / sim.timestep))  # 60 m/s after one step


def push(sim):
    body = sim.mj_model.nbody - 1
    sim.engine.physics.set_persistent_wrenches({body: np.array([0.0, 0.0, -1500.0, 0.0, 0.0, 0.0])})


def pull(sim):
    sim.gravity = (0.0, 0.0, -1500.0)


def spin(sim):
    sim.model("b").set_velocity((0.0, 0.0, 0.0), (0.0, 80.0, 0.0))  # the centre of mass, at 1 m, moves at 80 m/s


def states_after(world, change, *, is_known, is_restored=False):
    """Return the state after each of 90 steps; the motion changes in the second step of an open window."""
    with simkit.load(world) as sim:
        physics = sim.engine.physics
        physics._space.is_known = is_known
        sim.run(sim.timestep)
        assert (physics.window.is_open, bool(physics.window.uses_law)) == (is_known, not is_known)
        change(sim)
        states, lowest = [], 2.0
        for step in range(90):
            if is_restored and step % 7 == 0:
                kept = sim.snapshot()
                sim.run(3 * sim.timestep)
                sim.restore(pickle.loads(pickle.dumps(kept)) if step % 2 else kept)
            sim.run(sim.timestep)
            states.append(sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes())
            lowest = min(lowest, *sim.mj_data.geom_xpos[1:, 2].tolist())
        assert lowest < 0.11  # it hits the ground
        return states


@pytest.mark.parametrize("step", [0.001, 0.002])
@pytest.mark.parametrize(("change", "offset"), [(throw, 0.0), (kick, 0.0), (push, 0.0), (pull, 0.0), (spin, 1.0)])
def test_a_body_that_becomes_fast_in_open_space_lands_with_the_same_bits(tmp_path, change, offset, step):
    world = tmp_path / "world.sdf"
    world.write_text(PLANE_AND_BODY.format(step=step, offset=offset))
    expected = states_after(world, change, is_known=False)
    assert states_after(world, change, is_known=True) == expected
    assert states_after(world, change, is_known=True, is_restored=True) == expected
