"""Friction that differs along and across a direction, and contacts that slip with the force on them."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit

G = 9.8
ELLIPTIC, PYRAMIDAL = 0.002, 0.004  # [s], steps that choose the cone


def world(friction, step=ELLIPTIC, gravity=(0.0, 0.0), yaw=0.0, under="<mu>2</mu><mu2>2</mu2>", more=""):
    """A box of 2 kg on a plane; with an own direction of its friction."""
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
    """Of a box that is pulled with 0.8 of its weight in a direction, from rest: what friction takes of it, over g."""
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
def test_each_direction_has_its_coefficient_and_turns_with_the_body(turned, mu, yaw, step):
    """What slides at long steps hops, with the same coefficient both ways too."""
    assert slide(TWO, yaw + turned, yaw=yaw, step=step) == pytest.approx(mu, abs=0.01 if step == ELLIPTIC else 0.06)


def test_of_both_surfaces_the_smaller_coefficient_counts_in_each_direction():
    under = "<mu>0.3</mu><mu2>0.3</mu2>"
    assert slide(TWO, 0.0, under=under) == pytest.approx(0.2, abs=0.01)
    assert slide(TWO, math.pi / 2, under=under) == pytest.approx(0.3, abs=0.01)


def test_the_ground_may_have_the_direction():
    assert slide("<mu>1</mu><mu2>1</mu2>", 0.0, under=TWO, yaw=0.4) == pytest.approx(0.2, abs=0.01)
    assert slide("<mu>1</mu><mu2>1</mu2>", math.pi / 2, under=TWO, yaw=0.4) == pytest.approx(0.5, abs=0.01)


def test_a_direction_may_be_told_in_another_link():
    other = """<link name="top"><pose>0 0 0.2 0 0 1.5707963267948966</pose>
    <inertial><mass>1e-3</mass><inertia><ixx>1e-6</ixx><iyy>1e-6</iyy><izz>1e-6</izz></inertia></inertial></link>
    <joint name="j" type="fixed"><parent>l</parent><child>top</child></joint>"""
    friction = TWO.replace("<fdir1>", '<fdir1 gz:expressed_in="top">')
    assert slide(friction, 0.0, more=other) == pytest.approx(0.5, abs=0.01)
    assert slide(friction, math.pi / 2, more=other) == pytest.approx(0.2, abs=0.01)


def test_a_direction_that_stands_on_the_surface_is_none():
    """Then the smaller coefficient is used both ways."""
    upright = TWO.replace("1 0 0", "0 0 1")
    assert slide(upright, 0.0) == pytest.approx(0.2, abs=0.01)
    assert slide(upright, math.pi / 2) == pytest.approx(0.2, abs=0.01)


@pytest.mark.parametrize("compliance", [0.002, 0.01, 0.05])
@pytest.mark.parametrize("step", [ELLIPTIC, PYRAMIDAL])
def test_a_contact_slips_at_compliance_times_force(compliance, step):
    """Four corners carry a quarter of the force each: c F / 4."""
    text = world(slipping(compliance, compliance, ""), step, gravity=(0.6, 0.8))
    speed = final_speed(text, 1.5 if step == ELLIPTIC else 6.0)
    assert speed == pytest.approx(compliance * 2 * np.array([0.6, 0.8]) / 4, rel=2e-3)


def test_a_slip_is_reached_at_the_pace_of_a_damper():
    """m v' = F - v n / c: a time constant of m c / n, 25 ms here."""
    sim = simkit.load(world(slipping(0.05, 0.05), gravity=(1.0, 0.0)))
    sim.run(0.025)
    early = sim.link("box::l").linear_velocity[0]
    # it falls into its place in the first milliseconds, before which nothing rubs
    assert early == pytest.approx(0.025 * (1 - math.exp(-1)), rel=0.1)


@pytest.mark.parametrize(("one", "other"), [(0.05, 0.005), (0.001, 0.05), (0.02, 0.01)])
def test_compliances_may_differ_along_and_across(one, other):
    speed = final_speed(world(slipping(one, other), gravity=(0.6, 0.8)), 1.0)
    assert speed == pytest.approx((one * 0.3, other * 0.4), rel=1e-2)


def test_what_is_not_to_slip_slips_a_fiftieth_of_the_other_way():
    speed = final_speed(world(slipping(0.05, 0.0), gravity=(0.6, 0.8)), 1.0)
    assert speed == pytest.approx((0.05 * 0.3, 0.02 * 0.05 * 0.4), rel=1e-2)


def test_more_than_friction_holds_slides_away():
    """Down 0.6 g with a coefficient of 0.3 the other 0.3 g accelerate."""
    friction = "<mu>0.3</mu><mu2>0.3</mu2><slip1>0.01</slip1><slip2>0.01</slip2>"
    assert final_speed(world(friction, gravity=(0.6 * G, 0.0)), 0.5)[0] == pytest.approx(0.3 * G * 0.5, rel=0.03)


def test_slips_that_differ_need_a_direction():
    sim = simkit.load(world(slipping(0.05, 0.01, ""), gravity=(1.0, 0.0)))
    assert "SK-PHYS-006" in {found.code for found in sim.diagnostics}
    sim.run(1.0)
    assert abs(sim.link("box::l").linear_velocity[0]) < 1e-4


def test_a_world_without_any_of_it_has_no_law():
    assert simkit.load(world("<mu>1</mu><mu2>1</mu2>")).engine.physics.shaper is None


def test_who_reads_in_between_changes_no_bits():
    def run(reads):
        sim = simkit.load(world(TWO + "<slip1>0.01</slip1><slip2>0.02</slip2>", gravity=(3.0, 2.0)))
        for _ in range(200):
            sim.step()
            if reads:
                sim.engine.physics.fresh_accelerations()
                sim.snapshot()
        return sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes()

    assert run(False) == run(True)


def test_steps_at_once_and_one_by_one_are_the_same_bits():
    one, many = (simkit.load(world(TWO, gravity=(3.0, 2.0))) for _ in range(2))
    many.step(300)
    for _ in range(300):
        one.step()
    assert one.mj_data.qpos.tobytes() == many.mj_data.qpos.tobytes()


def test_it_is_the_same_after_a_reset_a_restore_and_a_spawn():
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


def test_boxes_with_a_direction_fall_asleep_and_wake():
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


def test_a_velocity_that_is_set_after_a_reading_counts_as_without_one():
    """What the contacts had been given was taken for what they are: the smaller coefficient stood both ways."""

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
    """A box whose direction, x, is told in a frame."""
    friction = TWO.replace("<fdir1>", f'<fdir1 gz:expressed_in="{name}">')
    return world(friction, more=inner, gravity=(0.8 * G, 0.0))


def test_a_direction_may_be_told_in_a_frame_of_the_model():
    frame = '<frame name="aside" attached_to="l"><pose>0 0 0.3 0 0 1.5707963267948966</pose></frame>'
    sim = simkit.load(framed("aside", frame))
    assert not [found for found in sim.diagnostics if found.severity == "warning"]
    sim.run(0.3)
    # along x the coefficient is that across: 0.8 g less 0.5 g accelerate
    assert sim.link("box::l").linear_velocity[0] == pytest.approx(0.3 * G * 0.3, rel=0.04)
    own = simkit.load(framed("__model__"))
    assert not [found for found in own.diagnostics if found.severity == "warning"]
    own.run(0.3)
    assert own.link("box::l").linear_velocity[0] == pytest.approx(0.6 * G * 0.3, rel=0.04)


def test_a_frame_that_is_not_there_is_told_with_its_line_and_the_closest():
    sim = simkit.load(framed("ll"))
    (found,) = [one for one in sim.diagnostics if one.severity == "warning"]
    assert (found.code, found.line) == ("SK-SDF-040", 8)
    assert "'ll'" in found.message and "'l'" in found.hint
    sim.run(0.3)
    assert sim.link("box::l").linear_velocity[0] == pytest.approx(0.6 * G * 0.3, rel=0.04)


YARD = """<mujoco><option integrator="{}"/><worldbody><geom type="plane" size="5 5 1"/></worldbody></mujoco>"""


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "RK4", "discrete"])
def test_an_integrator_that_has_no_place_for_it_is_told_of_once(integrator, tmp_path):
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
