"""Aircraft with stability derivatives: every force and moment against its formula, and the trimmed glide."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit

RHO, AREA, RATIO, EFFICIENCY, CHORD, STALL, MASS = 1.2041, 0.34, 6.5, 0.97, 0.22, 0.339, 1.0
INERTIA = (0.1976, 0.1459, 0.1477)
SPAN = math.sqrt(AREA * RATIO)
# derivatives of the size of those of PX4's advanced_plane; all are different from zero, so that each has an effect
STEADY = {"CL0": 0.152, "CD0": 0.029, "Cem0": 0.075, "CLa": 5.0, "CYa": 0.03, "Cella": 0.02, "Cema": -0.46}
STEADY |= {"Cena": 0.01, "CLb": 0.04, "CYb": -0.26, "Cellb": -0.039, "Cemb": 0.05, "Cenb": 0.1, "Cema_stall": 0.3}
NAMES = ("CD", "CY", "CL", "Cell", "Cem", "Cen")
RATES = {f"{name}{rate}": 0.1 + 0.07 * i + 0.3 * j for i, name in enumerate(NAMES) for j, rate in enumerate("pqr")}
SURFACE = {"CD": 3e-4, "CY": -4e-3, "CL": 1e-2, "Cell": -3e-3, "Cem": -2e-2, "Cen": 1.6e-3}
PLUGIN = 'filename="gz-sim-advanced-lift-drag-system" name="gz::sim::systems::AdvancedLiftDrag"'


def tags(values: dict[str, float]) -> str:
    return "".join(f"<{name}>{value}</{name}>" for name, value in values.items())


def surface(direction: int = -1) -> str:
    effects = tags({f"{name}_ctrl": value for name, value in SURFACE.items()})
    named = f"<name>flap</name><index>0</index><direction>{direction}</direction>"
    return f"<control_surface>{named}{effects}</control_surface>"


def world(parameters: str, *, wind: str = "0 0 0", gravity: float = 0.0, quirks: str = "") -> str:
    xx, yy, zz = INERTIA
    light = "<inertial><mass>1e-6</mass><inertia><ixx>1e-9</ixx><iyy>1e-9</iyy><izz>1e-9</izz></inertia></inertial>"
    return f"""<sdf version="1.9" xmlns:simkit="https://simkit/schema"><world name="w"><gravity>0 0 {-gravity}</gravity>
    {quirks}<wind><linear_velocity>{wind}</linear_velocity></wind><model name="plane"><link name="body"><inertial>
    <mass>{MASS}</mass><inertia><ixx>{xx}</ixx><iyy>{yy}</iyy><izz>{zz}</izz></inertia></inertial></link>
    <link name="elevator">{light}</link><joint name="flap" type="revolute"><parent>body</parent><child>elevator</child>
      <axis><xyz>0 1 0</xyz></axis></joint>
    <plugin {PLUGIN}><link_name>body</link_name><area>{AREA}</area><AR>{RATIO}</AR><eff>{EFFICIENCY}</eff>
      <mac>{CHORD}</mac><alpha_stall>{STALL}</alpha_stall>{parameters}</plugin></model></world></sdf>"""


def wrench(sim: simkit.Simulation) -> np.ndarray:
    """Return force and moment of the next step in the axes of the link, which are those of the world."""
    link = sim.link("plane::body")
    before = np.concatenate((link.linear_velocity, link.angular_velocity))
    sim.step()
    rate = (np.concatenate((link.linear_velocity, link.angular_velocity)) - before) / sim.timestep
    spin = before[3:]
    moment = rate[3:] * INERTIA + np.cross(spin, spin * INERTIA)
    return np.concatenate((rate[:3] * MASS, moment))


def expected(velocity: tuple[float, ...], spin: tuple[float, ...], flap: float = 0.0) -> np.ndarray:
    """Return force and moment from the formulas of the plugin's documentation, in axes x forward, y left, z up."""
    u, v, w = velocity[0], -velocity[1], -velocity[2]
    p, q, r = spin[0], -spin[1], -spin[2]
    speed = math.hypot(u, w)
    alpha, beta = math.atan2(w, u), math.atan2(v, u)
    s, deflection = STEADY, -math.degrees(flap)
    blend = (1 + math.exp(-15 * (alpha - STALL)) + math.exp(15 * (alpha + STALL))) / (
        (1 + math.exp(-15 * (alpha - STALL))) * (1 + math.exp(15 * (alpha + STALL)))
    )
    lift = (1 - blend) * (s["CL0"] + s["CLa"] * alpha)
    lift += blend * 2 * math.copysign(1, alpha) * math.sin(alpha) ** 2 * math.cos(alpha)
    lift += s["CLb"] * beta + SURFACE["CL"] * deflection
    plate = 2 / (1 + math.exp(-0.224 - 0.115 * RATIO))
    drag = (1 - blend) * (s["CD0"] + lift**2 / (math.pi * RATIO * EFFICIENCY))
    drag += blend * plate * (0.5 - 0.5 * math.cos(2 * alpha))
    held = min(max(alpha, -STALL), STALL)
    pitch = s["Cem0"] + s["Cema"] * held + s["Cema_stall"] * (alpha - held) + s["Cemb"] * beta
    found = dict.fromkeys(NAMES, 0.0)
    found |= {"CD": drag, "CL": lift, "Cem": pitch + SURFACE["Cem"] * deflection}
    found["CD"] += SURFACE["CD"] * deflection
    for name in ("CY", "Cell", "Cen"):
        found[name] = s[f"{name}a"] * alpha + s[f"{name}b"] * beta + SURFACE[name] * deflection
    rates = {"p": p * SPAN / 2 / speed, "q": q * CHORD / 2 / speed, "r": r * SPAN / 2 / speed}
    total = {name: c + sum(RATES[name + rate] * value for rate, value in rates.items()) for name, c in found.items()}
    pressed = 0.5 * RHO * speed**2 * AREA
    along, up = np.array((u, 0, -w)) / speed, np.array((w, 0, u)) / speed
    force = pressed * (total["CL"] * up - total["CD"] * along + total["CY"] * np.array((0, -1, 0)))
    moment = pressed * np.array((total["Cell"] * SPAN, -total["Cem"] * CHORD, -total["Cen"] * SPAN))
    return np.concatenate((force, moment))


@pytest.mark.parametrize("degrees", [-170, -60, -19.4, -5, 0, 4, 15, 19.4, 25, 89, 120])
def test_forces_and_moments_at_every_angle_of_attack(degrees: float) -> None:
    angle = math.radians(degrees)
    velocity = 15 * math.cos(angle), 2.0, -15 * math.sin(angle)
    spin = 0.4, -0.3, 0.2
    parameters = tags(STEADY) + tags(RATES) + surface() + "<num_ctrl_surfaces>1</num_ctrl_surfaces>"
    with simkit.load(world(parameters)) as sim:
        sim.joint("plane::flap").set_position(0.1)
        sim.model("plane").set_velocity(velocity, spin)
        np.testing.assert_allclose(wrench(sim), expected(velocity, spin, 0.1), rtol=2e-3, atol=5e-3)


def test_the_air_moves_with_the_wind_and_forces_act_at_the_reference_point() -> None:
    parameters = tags(STEADY) + "<cp>-0.12 0 0</cp>"
    with simkit.load(world(parameters, wind="-15 0 1")) as sim:
        found = wrench(sim)
    still = expected((15.0, 0.0, -1.0), (0.0, 0.0, 0.0))
    np.testing.assert_allclose(found[:3], still[:3], rtol=1e-3)
    assert found[4] == pytest.approx(still[4] + 0.12 * still[2], rel=1e-3)


def test_the_aircraft_glides_where_lift_and_drag_balance_its_weight() -> None:
    # pitch stiffness and damping hold the angle of attack at which Cem is zero; then tan(path) = CD / CL
    symmetric = {name: STEADY[name] for name in ("CL0", "CD0", "Cem0", "CLa", "Cema", "CYb", "Cellb", "Cenb")}
    parameters = tags({**symmetric, "Cemq": -12.1, "CLq": 8.0, "Cellp": -0.49, "Cenr": -0.09})
    far_from_stall = world(parameters, gravity=9.8).replace(f"<alpha_stall>{STALL}", "<alpha_stall>1.2")
    with simkit.load(far_from_stall) as sim:
        alpha = -STEADY["Cem0"] / STEADY["Cema"]
        lift = STEADY["CL0"] + STEADY["CLa"] * alpha
        drag = STEADY["CD0"] + lift**2 / (math.pi * RATIO * EFFICIENCY)
        speed = math.sqrt(2 * MASS * 9.8 / (RHO * AREA * math.hypot(lift, drag)))
        path = math.atan2(drag, lift)
        plane = sim.model("plane")
        plane.set_pose(simkit.Pose.from_rpy(0, 0, 500, 0, path - alpha, 0))
        plane.set_velocity((speed * math.cos(path), 0, -speed * math.sin(path)), (0, 0, 0))
        sim.run(10.0)
        vx, _, vz = sim.link("plane::body").linear_velocity
        assert -vz / vx == pytest.approx(drag / lift, rel=2e-3)
        assert math.hypot(vx, vz) == pytest.approx(speed, rel=2e-3)


def test_the_pitching_moment_of_gazebo_follows_only_the_sideslip() -> None:
    quirks = "<simkit:gazebo_quirks>true</simkit:gazebo_quirks>"
    with simkit.load(world(tags(STEADY), wind="-15 0 1", quirks=quirks)) as sim:
        assert wrench(sim)[4] == pytest.approx(0, abs=1e-9)


def test_without_a_stream_there_is_no_force_and_the_elements_of_px4_models_are_known() -> None:
    extra = "<a0>0</a0><CLa_stall>-3.85</CLa_stall><CDa_stall>-0.92</CDa_stall>"
    with simkit.load(world(tags(STEADY) + extra + "<CL_0>1</CL_0>")) as sim:
        assert np.all(wrench(sim) == 0)
        unread = [found.message for found in sim.diagnostics if found.severity == "warning"]
    assert len(unread) == 1
    assert "CL_0" in unread[0]


def test_the_plugin_of_px4_for_gazebo_classic_has_the_same_forces() -> None:
    text = world(tags(STEADY), wind="-15 0 -1")
    classic = text.replace(PLUGIN, 'filename="libAdvancedLiftDragPlugin.so" name="wing"')
    with (
        simkit.load(text) as sim,
        simkit.load(classic.replace("<CL0>", "<windSubTopic>w</windSubTopic><CL0>")) as other,
    ):
        assert not [found for found in other.diagnostics if found.severity == "warning"]
        expected = wrench(sim)
        assert np.any(expected != 0)
        assert np.array_equal(wrench(other), expected)


def test_the_number_of_control_surfaces_is_compared_with_their_elements() -> None:
    for count, effect in (("", 0.0), ("<num_ctrl_surfaces>2</num_ctrl_surfaces>", -SURFACE["CL"] * math.degrees(0.1))):
        with simkit.load(world(surface() + count, wind="-15 0 0")) as sim:
            sim.joint("plane::flap").set_position(0.1)
            assert "SK-PLUGIN-119" in {found.code for found in sim.diagnostics}
            pressed = 0.5 * RHO * 15**2 * AREA
            assert wrench(sim)[2] == pytest.approx(pressed * effect, rel=1e-2, abs=1e-9)


@pytest.mark.parametrize(
    ("bad", "code"),
    [("<forward>0 0 1</forward>", "SK-PLUGIN-110"), (surface().replace("flap", "flop"), "SK-PLUGIN-003")],
)
def test_wrong_parameters_are_errors(bad: str, code: str) -> None:
    with pytest.raises(simkit.LoadError, match=code):
        simkit.load(world(bad + "<num_ctrl_surfaces>1</num_ctrl_surfaces>"))


def test_the_aspect_ratio_is_required() -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-001"):
        simkit.load(world("").replace(f"<AR>{RATIO}</AR>", ""))
