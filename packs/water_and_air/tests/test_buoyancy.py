"""Buoyancy: Archimedes' principle, in one fluid and in layers."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np
import pytest

import simkit

G = 9.8
BOX = "<box><size>1 1 1</size></box>"
BALL = "<sphere><radius>0.5</radius></sphere>"
SEA = """<graded_buoyancy><default_density>1000</default_density><density_change><above_depth>0</above_depth>
<density>1</density></density_change></graded_buoyancy>"""

COARSE = ('<world name="w">', '<world name="w"><physics type="ode"><max_step_size>0.004</max_step_size></physics>')


def body(
    name: str, shape: str, mass: float, pose: str = "0 0 0 0 0 0", com: str = "0 0 0", static: bool = False
) -> str:
    moments = "".join(f"<{axis}>{0.2 * mass}</{axis}>" for axis in ("ixx", "iyy", "izz"))
    return f"""<model name="{name}"><pose>{pose}</pose><static>{static}</static><link name="hull"><inertial>
    <pose>{com} 0 0 0</pose><mass>{mass}</mass><inertia>{moments}</inertia></inertial>
    <collision name="c"><geometry>{shape}</geometry></collision></link></model>"""


def world(
    bodies: str, fluid: str = "<uniform_fluid_density>1000</uniform_fluid_density>", gravity: str = "0 0 -9.8"
) -> str:
    return f"""<sdf version="1.9"><world name="w"><gravity>{gravity}</gravity>{bodies}
    <plugin filename="gz-sim-buoyancy-system" name="gz::sim::systems::Buoyancy">{fluid}</plugin></world></sdf>"""


def height(sim: simkit.Simulation, name: str) -> float:
    return float(sim.link(f"{name}::hull").pose.position[2])


VOLUMES = {
    BOX: 1.0,
    BALL: math.pi / 6,
    "<cylinder><radius>0.5</radius><length>2</length></cylinder>": math.pi / 2,
    "<capsule><radius>0.5</radius><length>1</length></capsule>": math.pi / 4 + math.pi / 6,
    "<ellipsoid><radii>0.5 1 2</radii></ellipsoid>": 4 / 3 * math.pi,
    "<cone><radius>0.6</radius><length>2</length></cone>": math.pi * 0.36 * 2 / 3,
    "<polyline><point>0 0</point><point>2 0</point><point>0 1</point><height>3</height></polyline>": 3.0,
}


@pytest.mark.parametrize("shape", VOLUMES)
def test_the_force_is_the_weight_of_the_fluid_that_a_shape_displaces(shape: str) -> None:
    sim = simkit.load(world(body("b", shape, 700)))
    sim.step()
    com = sim.link("b::hull").linear_velocity  # of the origin, which the turning of a lopsided shape moves too
    turning = sim.link("b::hull").angular_velocity
    assert not turning.any() or "cone" in shape or "polyline" in shape
    assert com[2] / 0.001 == pytest.approx(G * (VOLUMES[shape] * 1000 / 700 - 1), rel=1e-9)


def test_a_neutral_body_floats_in_place_and_constant_forces_need_no_callback() -> None:
    sim = simkit.load(
        world(
            body("heavy", BOX, 2000) + body("even", BOX, 1000, "3 0 0 0.3 1 0") + body("light", BOX, 500, "6 0 0 0 0 0")
        )
    )
    assert sim.link("light::hull").linear_acceleration == pytest.approx((0, 0, G))
    sim.step(1000)
    assert not sim.link("even::hull").linear_velocity.any()
    assert sim.link("heavy::hull").linear_velocity[2] == pytest.approx(-G / 2, rel=1e-9)
    assert sim.link("light::hull").linear_velocity[2] == pytest.approx(G, rel=1e-9)
    (plugin,) = (p for p in sim.contents.plugins.values() if type(p).__name__ == "Buoyancy")
    assert plugin.before_step_rate == 1e-9


def test_the_force_acts_at_the_centre_of_volume() -> None:
    """A body with a low centre of mass swings like a pendulum of length 0.4 m."""
    sim = simkit.load(world(body("buoy", BOX, 1000, "0 0 0 0.05 0 0", com="0 0 -0.4")))
    moment = 0.2 * 1000
    period = 2 * math.pi * math.sqrt(moment / (1000 * G * 0.4))
    angles = []
    for _ in range(2000):
        sim.step()
        angles.append(float(sim.link("buoy::hull").pose.rpy[0]))
    crossings = [i for i, (a, b) in enumerate(itertools.pairwise(angles)) if a > 0 >= b]
    assert (crossings[1] - crossings[0]) * 0.001 == pytest.approx(period, rel=2e-3)


def test_several_collisions_add_up() -> None:
    twin = body("twin", BALL, 1000, com="0 0.5 0").replace(
        "</link>", f'<collision name="d"><pose>0 1 0 0 0 0</pose><geometry>{BALL}</geometry></collision></link>'
    )
    sim = simkit.load(world(twin))
    sim.step()
    assert sim.link("twin::hull").linear_velocity[2] / 0.001 == pytest.approx(G * (math.pi / 3 - 1), rel=1e-9)


def test_the_draught_of_a_box_matches_its_mass() -> None:
    """A box of 600 kg oscillates around the draught at which it displaces its mass: 0.6 m of 1 m."""
    sim = simkit.load(world(body("raft", BOX, 600, "0 0 -0.15 0 0 0"), SEA))
    heights = []
    for _ in range(2500):
        sim.step()
        heights.append(height(sim, "raft"))
    middle = -0.1 + 0.001 * 0.4  # the air carries a small part of the weight
    assert (max(heights) + min(heights)) / 2 == pytest.approx(middle, abs=2e-3)
    # undamped oscillation of constant amplitude, with the period of ρ g A / m
    assert max(heights) - middle == pytest.approx(0.05, rel=0.03)
    rises = [i for i, (a, b) in enumerate(itertools.pairwise(heights)) if a < middle <= b]
    period = (rises[-1] - rises[0]) / (len(rises) - 1) * 0.001
    assert period == pytest.approx(2 * math.pi * math.sqrt(600 / (999 * G)), rel=2e-3)


@pytest.mark.parametrize("shape", [BALL, "<cylinder><radius>0.4</radius><length>1</length></cylinder>"])
def test_bobbing_conserves_energy(shape: str) -> None:
    sim = simkit.load(world(body("buoy", shape, 200, "0 0 0.1 0.4 0.2 0"), SEA).replace(*COARSE))
    heights = []
    for _ in range(2000):
        sim.step()
        heights.append(height(sim, "buoy"))
    early, late = heights[:1000], heights[1000:]
    assert max(late) == pytest.approx(max(early), abs=0.02) and min(late) == pytest.approx(min(early), abs=0.02)


def test_a_tilted_raft_rights_itself() -> None:
    """A flat box is stable, because its lower side displaces more water. Metacentric height: width²/12/draught − …"""
    flat = "<box><size>2 2 0.4</size></box>"
    sim = simkit.load(world(body("raft", flat, 800, "0 0 0 0.05 0 0"), SEA))
    sim.step()
    assert sim.link("raft::hull").angular_velocity[0] < 0
    draught, centre = 800 / (1000 * 4), -0.1
    metacentre = 2**2 / 12 / draught + centre - 0.0 + 0.0  # above the centre of buoyancy, that above the middle
    torque = -800 * G * math.sin(0.05) * (metacentre + 0.0)
    moment = 0.2 * 800
    # displaced as it lies: the waterline through its middle, as a draught of 0.2 m has it
    assert sim.link("raft::hull").angular_velocity[0] / 0.001 == pytest.approx(torque / moment, rel=0.02)


def test_layers_of_several_fluids() -> None:
    """A ball of 1000 kg/m³ rests half in oil of 800 kg/m³ and half in brine of 1200 kg/m³."""
    fluid = """<graded_buoyancy><default_density>1200</default_density>
    <density_change><above_depth>2</above_depth><density>1</density></density_change>
    <density_change><above_depth>-1</above_depth><density>800</density></density_change></graded_buoyancy>"""
    ball = body("ball", BALL, 1000 * math.pi / 6, "0 0 -1 0 0 0")
    sim = simkit.load(world(ball, fluid))
    sim.step(500)
    assert height(sim, "ball") == pytest.approx(-1, abs=1e-9)
    sim.model("ball").set_pose(simkit.Pose((0, 0, 1)))
    sim.step()
    assert sim.link("ball::hull").linear_velocity[2] / 0.001 == pytest.approx(-G * 0.2, rel=1e-9)


def test_only_enabled_models_and_links_float() -> None:
    nested = body("ship", BOX, 1000).replace("</model>", body("boat", BOX, 1000, "0 0 5 0 0 0") + "</model>")
    fluid = "<uniform_fluid_density>1000</uniform_fluid_density><enable>{}</enable>"
    for name, floats in (("ship", (1, 1)), ("ship::boat", (0, 1)), ("ship::hull", (1, 0))):
        sim = simkit.load(world(nested, fluid.format(name)))
        sim.step(100)
        falls = [sim.link(n).linear_velocity[2] for n in ("ship::hull", "ship::boat::hull")]
        assert [int(abs(v) < 1e-9) for v in falls] == list(floats)
    sim = simkit.load(world(nested, fluid.format("shop")))
    (warning,) = (d for d in sim.diagnostics if d.code == "SK-PLUGIN-113")
    assert "shop" in warning.message and "ship" in warning.hint


def test_static_models_and_planes_do_not_float() -> None:
    plane = body("floor", "<plane><normal>0 0 1</normal></plane>", 1, static=True)
    sim = simkit.load(world(plane + body("box", BOX, 500, "0 0 3 0 0 0", static=True)))
    sim.step(10)
    assert not [d for d in sim.diagnostics if d.code.startswith("SK-PLUGIN")]


def test_a_change_of_gravity_changes_the_force() -> None:
    sim = simkit.load(world(body("b", BOX, 500)))
    sim.step(10)
    sim.gravity = (1.0, 0, -3.0)
    start = sim.link("b::hull").linear_velocity.copy()
    sim.step(100)
    assert (sim.link("b::hull").linear_velocity - start) / 0.1 == pytest.approx((-1, 0, 3), rel=1e-9)


def test_spawned_and_removed_models_and_state() -> None:
    for fluid in ("<uniform_fluid_density>1000</uniform_fluid_density>", SEA):
        sim = simkit.load(world(body("one", BOX, 500, "0 0 -5 0 0 0"), fluid))
        sim.step(20)
        snapshot = sim.snapshot()
        sim.spawn(f'<sdf version="1.9">{body("two", BOX, 500, "3 0 -5 0 0 0")}</sdf>')
        sim.step(20)
        assert sim.link("two::hull").linear_velocity[2] == pytest.approx(G * 0.02, rel=1e-9)
        sim.remove("one")
        sim.step(20)
        assert sim.link("two::hull").linear_velocity[2] == pytest.approx(G * 0.04, rel=1e-9)
        sim.restore(snapshot)
        sim.step(20)
        assert sim.link("one::hull").linear_velocity[2] == pytest.approx(G * 0.04, rel=1e-9)
        sim.reset()
        sim.step(20)
        assert sim.link("one::hull").linear_velocity[2] == pytest.approx(G * 0.02, rel=1e-9)


TETRAHEDRON = "o x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n{}"
MESH = "<mesh><uri>{}</uri><scale>2 2 2</scale></mesh>"


def test_closed_meshes_use_their_scaled_volume_and_open_ones_their_convex_hull(tmp_path: Path) -> None:
    closed, opened = tmp_path / "closed.obj", tmp_path / "open.obj"
    closed.write_text(TETRAHEDRON.format("f 3 1 4\n"))
    opened.write_text(TETRAHEDRON.format(""))
    for file, codes in ((closed, []), (opened, ["SK-PLUGIN-112"])):
        text = world(body("m", MESH.format(file.name), 1000, com="0.5 0.5 0.5"))
        (tmp_path / "w.sdf").write_text(text)
        sim = simkit.load(tmp_path / "w.sdf")
        assert [d.code for d in sim.diagnostics if d.code.startswith("SK-PLUGIN")] == codes
        sim.step()
        assert sim.link("m::hull").linear_velocity[2] / 0.001 == pytest.approx(G * (8 / 6 - 1), rel=1e-6)


def test_the_default_fluid_is_water() -> None:
    sim = simkit.load(world(body("b", BOX, 1000), ""))
    assert "SK-PLUGIN-114" in [d.code for d in sim.diagnostics]
    sim.step(100)
    assert not sim.link("b::hull").linear_velocity.any()


@pytest.mark.parametrize(
    "bad",
    [
        "<uniform_fluid_density>-1</uniform_fluid_density>",
        "<graded_buoyancy><density_change><density>1</density></density_change></graded_buoyancy>",
        "<graded_buoyancy><density_change><above_depth>0</above_depth></density_change></graded_buoyancy>",
        "<graded_buoyancy><default_density>nan</default_density></graded_buoyancy>",
    ],
)
def test_invalid_values_are_errors(bad: str) -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-00"):
        simkit.load(world(body("b", BOX, 1), bad))


def classic(parameters: str = "", shape: str = BOX, mass: float = 999.1026) -> str:
    text = body("sub", shape, mass).replace(
        "</model>", f'<plugin name="float" filename="libBuoyancyPlugin.so">{parameters}</plugin></model>'
    )
    return f'<sdf version="1.6"><world name="w"><gravity>0 0 -9.8</gravity>{text}</world></sdf>'


def test_classic_floats_one_model_in_water_of_15_degrees() -> None:
    sim = simkit.load(classic())
    sim.step(100)
    assert sim.link("sub::hull").linear_velocity == pytest.approx((0, 0, 0), abs=1e-12)
    sim = simkit.load(classic("<fluid_density>500</fluid_density>", mass=1000))
    sim.step(100)
    assert sim.link("sub::hull").linear_velocity[2] == pytest.approx(-G / 2 * 0.1, rel=1e-9)


def test_classic_reads_volume_and_centre_of_a_link_from_the_file() -> None:
    given = """<link name="hull"><center_of_volume>0 0.1 0</center_of_volume><volume>2</volume></link>
    <fluid_density>1000</fluid_density>"""
    sim = simkit.load(classic(given, mass=1000))
    sim.step()
    assert sim.link("sub::hull").linear_velocity[2] == pytest.approx(G * 0.001, rel=1e-9)
    assert sim.link("sub::hull").angular_velocity[0] == pytest.approx(2000 * G * 0.1 / 200 * 0.001, rel=1e-9)


@pytest.mark.parametrize(
    "bad",
    [
        "<link><center_of_volume>0 0 0</center_of_volume><volume>1</volume></link>",
        '<link name="hall"><center_of_volume>0 0 0</center_of_volume><volume>1</volume></link>',
        '<link name="hull"><volume>1</volume></link>',
        '<link name="hull"><center_of_volume>0 0 0</center_of_volume><volume>0</volume></link>',
    ],
)
def test_classic_reports_invalid_values(bad: str) -> None:
    with pytest.raises(simkit.LoadError):
        simkit.load(classic(bad))


def test_many_hulls_get_the_same_forces_as_each_alone() -> None:
    tops = [-0.7, -0.3, 0.0, 0.2, 0.6]
    shapes = [BOX, BALL, "<cylinder><radius>0.5</radius><length>1</length></cylinder>", BOX, BALL]
    alone = []
    for top, shape in zip(tops, shapes, strict=True):
        sim = simkit.load(world(body("b", shape, 300, f"0 0 {top} 0.3 0.1 0"), SEA))
        sim.step(30)
        alone.append(sim.link("b::hull").linear_velocity)
    many = "".join(
        body(f"b{i}", s, 300, f"{3 * i} 0 {t} 0.3 0.1 0") for i, (t, s) in enumerate(zip(tops, shapes, strict=True))
    )
    sim = simkit.load(world(many, SEA))
    sim.step(30)
    assert np.array([sim.link(f"b{i}::hull").linear_velocity for i in range(5)]) == pytest.approx(
        np.array(alone), abs=1e-12
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    "shape", ["<box><size>1 1 1</size></box>", "<capsule><radius>.3</radius><length>1</length></capsule>"]
)
def test_a_fleet_floats_like_each_ship_alone(shape: str) -> None:
    """Few hulls are computed one by one and many with arrays: in two layers, between layers, and rotated."""
    layers = """<graded_buoyancy><default_density>1000</default_density><density_change><above_depth>-0.3</above_depth>
    <density>600</density></density_change><density_change><above_depth>0</above_depth><density>1</density>
    </density_change></graded_buoyancy>"""
    ship = """<model name="s{n}"><pose>{x} 0 0 0.3 0.4 0.1</pose><link name="l"><inertial><pose>0.02 0 -0.1 0 0 0</pose>
    <mass>300</mass><inertia><ixx>50</ixx><iyy>60</iyy><izz>70</izz></inertia></inertial><collision name="c">
    <pose>0.1 0 0 0.5 0 0.2</pose><geometry>{shape}</geometry></collision></link></model>"""

    def sailed(count: int) -> np.ndarray:
        ships = "".join(ship.format(n=n, x=5 * n, shape=shape) for n in range(count))
        plugin = 'filename="gz-sim-buoyancy-system" name="gz::sim::systems::Buoyancy"'
        world = f'<sdf version="1.9"><world name="w">{ships}<plugin {plugin}>{layers}</plugin></world></sdf>'
        with simkit.load(world) as sim:
            sim.step(200)
            pose, link = sim.model("s0").pose, sim.link("s0::l")
            return np.concatenate([pose.position, pose.quaternion, link.linear_velocity, link.angular_velocity])

    assert sailed(40) == pytest.approx(sailed(1), rel=1e-10, abs=1e-10)


def test_a_plugin_with_persistent_wrenches_may_stand_before_the_buoyancy() -> None:
    """ApplyLinkWrench asks for the rates of all plugins while it loads; the buoyancy was not loaded then."""
    wrench = '<plugin filename="gz-sim-apply-link-wrench-system" name="gz::sim::systems::ApplyLinkWrench"/>'
    ball = body("ball", BALL, 100.0)
    with simkit.load(world(f"{wrench}{ball}", SEA)) as sim:
        sim.step(10)
        assert height(sim, "ball") > 0.0  # the ball has a fifth of the density of water
