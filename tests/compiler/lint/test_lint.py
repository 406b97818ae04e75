"""The physics lint: what it finds, with which numbers, and what it leaves alone."""

from __future__ import annotations

from pathlib import Path

import pytest

import simkit
from simkit.compiler.lint.time_step import rate_pattern

ROOT = Path(__file__).resolve().parents[3]
INERTIAL = "<inertial><mass>{0}</mass><inertia><ixx>{1}</ixx><iyy>{1}</iyy><izz>{1}</izz></inertia></inertial>"
BOX = "<collision name='c'><geometry><box><size>{0} {0} {0}</size></box></geometry></collision>"


def lint_codes(text: str) -> dict[str, str]:
    return {d.code: d.message for d in simkit.check(text) if d.code.startswith("SK-LINT")}


def world(content: str, step: float = 0.001) -> str:
    physics = f"<physics type='ode'><max_step_size>{step}</max_step_size></physics>"
    return f"<sdf version='1.9'><world name='w'>{physics}{content}</world></sdf>"


def arm(axis: str = "", plugin: str = "", inertia: float = 1e-4) -> str:
    links = f"<link name='base'>{INERTIAL.format(1, 0.1)}</link><link name='arm'>{INERTIAL.format(0.1, inertia)}</link>"
    hinge = "<joint name='j' type='revolute'><parent>world</parent><child>arm</child>"
    return world(f"<model name='m'>{links}{hinge}<axis><xyz>0 0 1</xyz>{axis}</axis></joint>{plugin}</model>")


@pytest.mark.parametrize(
    ("rate", "step", "said"),
    [
        (30, 0.001, "30 Hz at a step of 1 ms: stamps every 33 or 34 ms"),
        (60, 0.004, "60 Hz at a step of 4 ms: stamps every 16 or 20 ms"),
        (2000, 0.001, "2000 Hz is more than the 1000 steps per second: samples come at 1000 Hz"),
        (50, 0.001, ""),
        (0, 0.001, ""),
        (12.5, 0.002, ""),
    ],
)
def test_a_rate_that_the_step_cannot_keep_is_told_with_its_pattern(rate: float, step: float, said: str) -> None:
    assert rate_pattern(rate, step) == said


def test_a_damping_gain_is_judged_by_the_inertia_that_the_joint_feels() -> None:
    """d·dt/I = 2 is the edge of an explicit force: at I = 1e-4 and 1 ms that is 0.2."""
    controller = (
        "<plugin filename='gz-sim-joint-position-controller-system' name='gz::sim::systems::JointPositionController'>"
        "<joint_name>j</joint_name><p_gain>1</p_gain><d_gain>{0}</d_gain></plugin>"
    )
    assert "SK-LINT-003" not in lint_codes(arm(plugin=controller.format(0.19)))
    found = [d for d in simkit.check(arm(plugin=controller.format(0.3))) if d.code == "SK-LINT-003"]
    assert ["<d_gain> 0.3" in d.message and "at most 0.2" in d.hint for d in found] == [True]


@pytest.mark.parametrize(
    ("integrator", "actuator", "most"),
    [
        ("Euler", "velocity kv='0.19'", None),
        ("Euler", "velocity kv='0.21'", "0.2"),
        ("implicitfast", "velocity kv='0.21'", None),
        ("Euler", "position kp='390'", None),
        ("implicitfast", "position kp='410'", "400"),
        ("Euler", "position kp='110' kv='0.15'", "0.145"),
        ("implicitfast", "position kp='110' kv='0.15'", None),
    ],
)
def test_actuators_of_mjcf_are_judged_by_the_integrator_and_diverge_if_they_are_reported(
    integrator: str, actuator: str, most: str | None
) -> None:
    """d·dt/I = 2 is the edge of the integrator Euler, p·dt²/I = 4 that of both: I = 1e-4, step 1 ms."""
    text = (
        f"<mujoco><option timestep='0.001' integrator='{integrator}'/><worldbody><body><joint name='j' axis='0 0 1'/>"
        "<inertial pos='0 0 0' mass='1' diaginertia='1e-4 1e-4 1e-4'/></body></worldbody>"
        f"<actuator><{actuator} name='a' joint='j'/></actuator></mujoco>"
    )
    limits = [d.hint.split(",")[0] for d in simkit.check(text) if d.code == "SK-LINT-003"]
    assert limits == ([] if most is None else [f"use at most {most}"])
    with simkit.load(text) as sim:
        sim.mj_data.ctrl[:] = 1.0
        if most is None:
            sim.run(5.0)
            return
        with pytest.raises(simkit.SimulationDiverged, match=f"use at most {most},"):
            sim.run(5.0)


def test_a_spring_is_judged_by_the_inertia_that_it_swings() -> None:
    """k·dt²/I = 1 at k = 100 for I = 1e-4 and 1 ms."""
    spring = "<dynamics><spring_stiffness>{0}</spring_stiffness></dynamics>"
    assert "SK-LINT-004" not in lint_codes(arm(spring.format(99)))
    assert "SK-LINT-004" in lint_codes(arm(spring.format(101)))


def test_kilograms_that_nobody_wrote_are_counted() -> None:
    links = f"<link name='base'>{INERTIAL.format(2, 0.1)}</link><link name='a'/><link name='b'/>"
    said = lint_codes(world(f"<model name='m'>{links}</model>"))["SK-LINT-007"]
    assert "2 kg of its 4 kg" in said
    assert "(a, b)" in said


def test_a_model_that_writes_no_inertia_at_all_is_left_to_its_note() -> None:
    assert "SK-LINT-007" not in lint_codes(world("<model name='m'><link name='a'/></model>"))


def test_an_inertia_in_other_units_is_told_by_the_size_of_the_link() -> None:
    """1 kg in a box of 1 m has 1/6 kg m2; the same number for a box of 1 cm is 10 000 times too much."""
    model = "<model name='m'><link name='a'>{0}{1}</link></model>"
    assert lint_codes(world(model.format(INERTIAL.format(1, 1 / 6), BOX.format(1)))) == {}
    assert "SK-LINT-008" in lint_codes(world(model.format(INERTIAL.format(1, 1 / 6), BOX.format(0.01))))


def test_a_density_that_nothing_has_is_told_with_the_number() -> None:
    model = "<model name='m'><link name='a'>{0}{1}</link></model>"
    said = lint_codes(world(model.format(INERTIAL.format(100, 0.01), BOX.format(0.1))))
    assert "1e+05 kg/m3" in said["SK-LINT-009"]


def test_a_step_is_judged_only_where_something_moves_and_collides() -> None:
    moving = f"<model name='m'><link name='a'>{INERTIAL.format(1, 1 / 6)}{BOX.format(1)}</link></model>"
    assert "SK-LINT-001" in lint_codes(world(moving, 0.01))
    assert "SK-LINT-001" not in lint_codes(world(moving, 0.005))
    assert "SK-LINT-001" not in lint_codes(world(moving.replace("<link", "<static>1</static><link"), 0.01))


def test_torsional_friction_that_a_more_slippery_surface_switches_off_is_reported() -> None:
    friction = "<surface><friction><ode><mu>{0}</mu><mu2>{0}</mu2></ode>{1}</friction></surface></collision>"
    patch = "<torsional><patch_radius>0.01</patch_radius></torsional>"
    model = "<model name='{0}'>{3}<link name='a'>{1}{2}</link></model>"
    inertial, static = INERTIAL.format(1, 1 / 6), "<static>1</static>"
    round_foot = BOX.format(1).replace("</collision>", friction.format(0.8, patch))
    for mu, is_reported in ((0.5, True), (0.8, False), (1.0, False)):
        floor = BOX.format(1).replace("</collision>", friction.format(mu, ""))
        models = model.format("m", inertial, round_foot, "") + model.format("floor", "", floor, static)
        found = lint_codes(world(models)).get("SK-LINT-011", "")
        assert ("'floor::a::c', whose friction coefficient is smaller (0.5 instead of 0.8)" in found) == is_reported


@pytest.mark.parametrize("path", sorted((ROOT / "worlds").glob("*.sdf")), ids=lambda p: p.name)
def test_our_own_worlds_have_no_warning_of_the_lint(path: Path) -> None:
    found = [d for d in simkit.check(path) if d.code.startswith("SK-LINT") and d.severity != "note"]
    assert not found


def test_nothing_of_the_lint_is_said_when_a_world_is_loaded() -> None:
    text = world(f"<model name='m'><link name='a'>{INERTIAL.format(1, 1)}{BOX.format(0.01)}</link></model>")
    with simkit.load(text) as sim:
        assert not [d for d in sim.diagnostics if d.code.startswith("SK-LINT")]
