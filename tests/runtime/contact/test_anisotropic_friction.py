"""Friction that differs along and across a direction, and contacts that slip in proportion to their force."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit

G = 9.8
ELLIPTIC, PYRAMIDAL = 0.002, 0.004  # [s] steps with which the compiler chooses the elliptic and the pyramidal cone


def world(friction, step=ELLIPTIC, gravity=(0.0, 0.0), yaw=0.0, under="<mu>2</mu><mu2>2</mu2>", more=""):
    """Return a world with a box of 2 kg on a plane; the box has its own friction."""
    x, y = gravity
    return f"""<sdf version="1.9"><world name="w"><gravity>{x} {y} {-G}</gravity>
<physics type="ode"><max_step_size>{step}</max_step_size></physics>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
  <surface><friction><ode>{under}</ode></friction></surface></collision></link></model>
<model name="box" xmlns:gz="http://gazebosim.org/schema"><pose>0 0 0.05 0 0 {yaw}</pose>
<link name="l"><inertial><mass>2</mass><inertia><ixx>.01</ixx><iyy>.01</iyy><izz>.01</izz></inertia></inertial>
  <collision name="c"><geometry><box><size>0.4 0.4 0.1</size></box></geometry>
  <surface><friction><ode>{friction}</ode></friction></surface></collision></link>{more}</model>
</world></sdf>"""


def slide(friction, heading, **more):
    """Pull a box from rest with 0.8 of its weight, and return the deceleration by friction in units of g."""
    pull = (0.8 * G * math.cos(heading), 0.8 * G * math.sin(heading))
    sim = simkit.load(world(friction, gravity=pull, **more))
    sim.run(0.3)
    speed = sim.link("box::l").linear_velocity[:2]
    assert speed @ (-math.sin(heading), math.cos(heading)) == pytest.approx(0.0, abs=0.03)
    return 0.8 - float(speed @ (math.cos(heading), math.sin(heading))) / 0.3 / G


def final_speed(text, duration=1.5):
    sim = simkit.load(text)
    sim.run(duration)
    return sim.link("box::l").linear_velocity[:2]


def slipping(one, other, direction="<fdir1>1 0 0</fdir1>"):
    return f"<mu>1</mu><mu2>1</mu2>{direction}<slip1>{one}</slip1><slip2>{other}</slip2>"


TWO = "<mu>0.2</mu><mu2>0.5</mu2><fdir1>1 0 0</fdir1>"


@pytest.mark.parametrize(("turned", "mu"), [(0.0, 0.2), (math.pi / 2, 0.5)])
@pytest.mark.parametrize("yaw", [0.0, 0.7])
@pytest.mark.parametrize("step", [ELLIPTIC, PYRAMIDAL])
def test_each_friction_direction_has_its_coefficient_and_rotates_with_the_body(turned, mu, yaw, step):
    """At long steps a sliding box hops, and the friction coefficients still hold on average."""
    assert slide(TWO, yaw + turned, yaw=yaw, step=step) == pytest.approx(mu, abs=0.01 if step == ELLIPTIC else 0.06)


def test_each_direction_uses_the_smaller_coefficient_of_both_surfaces():
    under = "<mu>0.3</mu><mu2>0.3</mu2>"
    assert slide(TWO, 0.0, under=under) == pytest.approx(0.2, abs=0.01)
    assert slide(TWO, math.pi / 2, under=under) == pytest.approx(0.3, abs=0.01)


def test_the_ground_may_define_the_friction_direction():
    assert slide("<mu>1</mu><mu2>1</mu2>", 0.0, under=TWO, yaw=0.4) == pytest.approx(0.2, abs=0.01)
    assert slide("<mu>1</mu><mu2>1</mu2>", math.pi / 2, under=TWO, yaw=0.4) == pytest.approx(0.5, abs=0.01)


def test_a_friction_direction_may_be_given_in_the_frame_of_another_link():
    other = """<link name="top"><pose>0 0 0.2 0 0 1.5707963267948966</pose>
    <inertial><mass>1e-3</mass><inertia><ixx>1e-6</ixx><iyy>1e-6</iyy><izz>1e-6</izz></inertia></inertial></link>
    <joint name="j" type="fixed"><parent>l</parent><child>top</child></joint>"""
    friction = TWO.replace("<fdir1>", '<fdir1 gz:expressed_in="top">')
    assert slide(friction, 0.0, more=other) == pytest.approx(0.5, abs=0.01)
    assert slide(friction, math.pi / 2, more=other) == pytest.approx(0.2, abs=0.01)


def test_a_friction_direction_perpendicular_to_the_surface_is_ignored():
    """The smaller coefficient is then used in both directions."""
    upright = TWO.replace("1 0 0", "0 0 1")
    assert slide(upright, 0.0) == pytest.approx(0.2, abs=0.01)
    assert slide(upright, math.pi / 2) == pytest.approx(0.2, abs=0.01)


@pytest.mark.parametrize("compliance", [0.002, 0.01, 0.05])
@pytest.mark.parametrize("step", [ELLIPTIC, PYRAMIDAL])
def test_a_contact_slips_at_compliance_times_force(compliance, step):
    """Each of the four corners carries a quarter of the force, so the slip velocity is c F / 4."""
    text = world(slipping(compliance, compliance, ""), step, gravity=(0.6, 0.8))
    speed = final_speed(text, 1.5 if step == ELLIPTIC else 6.0)
    assert speed == pytest.approx(compliance * 2 * np.array([0.6, 0.8]) / 4, rel=2e-3)


def test_the_slip_velocity_is_reached_with_the_time_constant_of_a_damper():
    """The motion m v' = F - v n / c has the time constant m c / n, here 25 ms."""
    sim = simkit.load(world(slipping(0.05, 0.05), gravity=(1.0, 0.0)))
    sim.run(0.025)
    early = sim.link("box::l").linear_velocity[0]
    # in the first milliseconds the box falls onto the plane, without friction
    assert early == pytest.approx(0.025 * (1 - math.exp(-1)), rel=0.1)


@pytest.mark.parametrize(("one", "other"), [(0.05, 0.005), (0.001, 0.05), (0.02, 0.01)])
def test_compliances_may_differ_along_and_across(one, other):
    speed = final_speed(world(slipping(one, other), gravity=(0.6, 0.8)), 1.0)
    assert speed == pytest.approx((one * 0.3, other * 0.4), rel=1e-2)


def test_a_direction_without_slip_gets_a_fiftieth_of_the_other_compliance():
    speed = final_speed(world(slipping(0.05, 0.0), gravity=(0.6, 0.8)), 1.0)
    assert speed == pytest.approx((0.05 * 0.3, 0.02 * 0.05 * 0.4), rel=1e-2)


def test_a_force_above_the_friction_limit_accelerates_the_box():
    """A force of 0.6 g against a friction of 0.3 g leaves an acceleration of 0.3 g."""
    friction = "<mu>0.3</mu><mu2>0.3</mu2><slip1>0.01</slip1><slip2>0.01</slip2>"
    assert final_speed(world(friction, gravity=(0.6 * G, 0.0)), 0.5)[0] == pytest.approx(0.3 * G * 0.5, rel=0.03)


def test_different_slip_compliances_need_a_friction_direction():
    sim = simkit.load(world(slipping(0.05, 0.01, ""), gravity=(1.0, 0.0)))
    assert "SK-PHYS-006" in {found.code for found in sim.diagnostics}
    sim.run(1.0)
    assert abs(sim.link("box::l").linear_velocity[0]) < 1e-4


def test_a_world_without_directional_friction_has_no_contact_shaper():
    assert simkit.load(world("<mu>1</mu><mu2>1</mu2>")).engine.physics.shaper is None


def test_readers_between_steps_do_not_change_any_bit():
    def run(reads):
        sim = simkit.load(world(TWO + "<slip1>0.01</slip1><slip2>0.02</slip2>", gravity=(3.0, 2.0)))
        for _ in range(200):
            sim.step()
            if reads:
                sim.engine.physics.fresh_accelerations()
                sim.snapshot()
        return sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes()

    assert run(False) == run(True)


def test_many_steps_in_one_call_and_single_steps_give_the_same_bits():
    one, many = (simkit.load(world(TWO, gravity=(3.0, 2.0))) for _ in range(2))
    many.step(300)
    for _ in range(300):
        one.step()
    assert one.mj_data.qpos.tobytes() == many.mj_data.qpos.tobytes()


def test_directional_friction_survives_a_reset_a_restore_and_a_spawn():
    sim = simkit.load(world(TWO, gravity=(3.0, 2.0)))
    sim.run(0.2)
    kept, here = sim.snapshot(), sim.mj_data.qpos.tobytes()
    sim.run(0.2)
    there = sim.mj_data.qpos.tobytes()
    sim.restore(kept)
    sim.run(0.2)
    assert sim.mj_data.qpos.tobytes() == there
    sim.reset()
    sim.run(0.2)
    assert sim.mj_data.qpos.tobytes() == here
    lone = '<sdf version="1.9"><model name="lone"><pose>5 5 1 0 0 0</pose><link name="l"/></model></sdf>'
    sim.spawn(lone, "lone")
    assert sim.engine.physics.shaper is not None
    sim.remove("box")
    assert sim.engine.physics.shaper is None


def test_boxes_with_directional_friction_fall_asleep_and_wake():
    box = (
        world(TWO)
        .split("<model", 2)[2]
        .split("</model>")[0]
        .replace('"box"', '"second"')
        .replace("0 0 0.05", "2 0 0.05")
    )
    sim = simkit.load(world(TWO).replace("</world>", f"<model{box}</model></world>"))
    sim.run(4.0)
    assert sim.engine.physics.sleep.rests
    sim.link("second::l").set_velocity((0.0, 1.0, 0.0))
    sim.run(0.1)
    assert sim.link("second::l").pose.position[1] > 0.02
    assert sim.link("box::l").pose.position[1] == pytest.approx(0.0, abs=1e-6)


def test_a_velocity_set_after_a_reading_has_the_same_effect_as_without_the_reading():
    """Regression: a reading had changed the coefficients of the contacts, so that the smaller one was used in both
    directions.
    """

    def run(reads):
        sim = simkit.load(world(TWO, gravity=(1.0, 0.5)))
        sim.run(0.1)
        for turn in range(5):
            if reads:
                sim.engine.physics.fresh_accelerations()
            sim.link("box::l").set_velocity((0.5, 0.2 * turn, 0.0))
            sim.run(0.02)
        return sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes()

    assert run(False) == run(True)


def framed(name, inner=""):
    """Return a world with a box whose friction direction is the x axis of a frame."""
    friction = TWO.replace("<fdir1>", f'<fdir1 gz:expressed_in="{name}">')
    return world(friction, more=inner, gravity=(0.8 * G, 0.0))


def test_a_friction_direction_may_be_given_in_a_frame_of_the_model():
    frame = '<frame name="aside" attached_to="l"><pose>0 0 0.3 0 0 1.5707963267948966</pose></frame>'
    sim = simkit.load(framed("aside", frame))
    assert not [found for found in sim.diagnostics if found.severity == "warning"]
    sim.run(0.3)
    # the frame is rotated by 90°, so the coefficient along x is 0.5: 0.8 g - 0.5 g accelerate the box
    assert sim.link("box::l").linear_velocity[0] == pytest.approx(0.3 * G * 0.3, rel=0.04)
    own = simkit.load(framed("__model__"))
    assert not [found for found in own.diagnostics if found.severity == "warning"]
    own.run(0.3)
    assert own.link("box::l").linear_velocity[0] == pytest.approx(0.6 * G * 0.3, rel=0.04)


def test_a_missing_frame_is_reported_with_its_line_and_the_closest_name():
    sim = simkit.load(framed("ll"))
    (found,) = [one for one in sim.diagnostics if one.severity == "warning"]
    assert (found.code, found.line) == ("SK-SDF-040", 8)
    assert "'ll'" in found.message and "'l'" in found.hint
    sim.run(0.3)
    assert sim.link("box::l").linear_velocity[0] == pytest.approx(0.6 * G * 0.3, rel=0.04)


YARD = """<mujoco><option integrator="{}"/><worldbody><geom type="plane" size="5 5 1"/></worldbody></mujoco>"""


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "RK4", "discrete"])
def test_an_integrator_without_support_is_reported_once(integrator, tmp_path):
    path = tmp_path / "yard.xml"
    path.write_text(YARD.format(integrator))
    sim = simkit.load(path)
    model = f"<model{world(TWO).split('<model', 2)[2].split('</model>')[0]}</model>"
    for name in ("one", "two"):
        sim.spawn(f'<sdf version="1.9">{model}</sdf>', name)
    found = [one.code for one in sim.diagnostics]
    assert found.count("SK-PHYS-030") == (1 if integrator == "discrete" else 0)
    assert (sim.engine.physics.shaper is None) == (integrator == "discrete")
    sim.run(0.05)
