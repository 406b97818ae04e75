"""Velocity servos under load: skid steering, slopes, towing, a torque on a wheel."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import trimesh
from plugin_worlds import GROUND, element, world

import simkit
from simkit.plugins.joints.velocity_servo import _tree_by_tree

RADIUS = 0.1
WHEELS = ("front_left", "rear_left", "front_right", "rear_right")
SHAPES = {
    "cylinder": f"<cylinder><radius>{RADIUS}</radius><length>0.05</length></cylinder>",
    "sphere": f"<sphere><radius>{RADIUS}</radius></sphere>",
    "mesh": "<mesh><uri>wheel.obj</uri></mesh>",
}


@pytest.fixture(scope="session")
def meshes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the mesh of a wheel: a prism with 48 sides."""
    folder = tmp_path_factory.mktemp("meshes")
    trimesh.creation.cylinder(RADIUS, 0.05, sections=48).export(folder / "wheel.obj")
    return folder


def inertial(mass: float, size: float) -> str:
    values = "".join(f"<{axis}>{mass * size}</{axis}>" for axis in ("ixx", "iyy", "izz"))
    return f"<inertial><mass>{mass}</mass><inertia>{values}</inertia></inertial>"


def surface(mu: float) -> str:
    return f"<surface><friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction></surface>"


def vehicle(
    mass: float = 10.0,
    mu: float = 1.0,
    shape: str = "sphere",
    width: float = 0.5,
    length: float = 0.4,
    effort: float | None = None,
    extra: str = "",
) -> str:
    """Return a chassis with a DiffDrive on four wheels, each with a twentieth of its mass."""
    limit = "" if effort is None else f"<limit><effort>{effort}</effort></limit>"
    parts = [f"<link name='base'><pose>0 0 0.15 0 0 0</pose>{inertial(mass, 0.03)}</link>"]
    for name in WHEELS:
        x = length / 2 if "front" in name else -length / 2
        y = width / 2 if "left" in name else -width / 2
        parts.append(
            f"<link name='{name}'><pose>{x} {y} {RADIUS} -1.5707963267948966 0 0</pose>{inertial(mass / 20, 0.004)}"
            f"<collision name='tyre'><geometry>{SHAPES[shape]}</geometry>{surface(mu)}</collision></link>"
            f"<joint name='{name}_joint' type='continuous'><parent>base</parent><child>{name}</child>"
            f"<axis><xyz>0 0 1</xyz>{limit}</axis></joint>"
        )
    joints = "".join(f"<{n.split('_')[1]}_joint>{n}_joint</{n.split('_')[1]}_joint>" for n in WHEELS)
    attributes = "name='gz::sim::systems::DiffDrive' filename='gz-sim-diff-drive-system'"
    plugin = element("plugin", {"wheel_separation": width, "wheel_radius": RADIUS}, attributes)
    plugin = plugin.replace("</plugin>", f"{joints}</plugin>")
    return f"<model name='cart'>{''.join(parts)}{extra}{plugin}</model>"


def opened(
    step: float = 0.001, slope: float = 0.0, held: bool = False, folder: Path | None = None, **values: object
) -> simkit.Simulation:
    """Load the vehicle on a plane inclined by `slope` [rad] (gravity points partly along +x), or with a fixed chassis.

    Args:
        folder: holds the meshes.
    """
    folders = [] if folder is None else [folder]
    gravity = f"<gravity>{9.81 * math.sin(slope)} 0 {-9.81 * math.cos(slope)}</gravity>"
    if held:
        weld = "<joint name='hold' type='fixed'><parent>world</parent><child>base</child></joint>"
        return simkit.load(world("<gravity>0 0 0</gravity>", vehicle(extra=weld, **values), step=step))  # type: ignore[arg-type]
    text = world(gravity, GROUND, vehicle(**values), step=step)  # type: ignore[arg-type]
    return simkit.load(text, resource_paths=folders)


def drive(sim: simkit.Simulation, linear: float = 0.0, angular: float = 0.0) -> None:
    sim.publish("/model/cart/cmd_vel", {"linear": {"x": linear}, "angular": {"z": angular}})


def wheel(sim: simkit.Simulation, name: str = "front_left") -> simkit.Joint:
    return sim.joint(f"cart::{name}_joint")


def speeds(sim: simkit.Simulation, seconds: float, torque: float = 0.0) -> np.ndarray:
    """Return the velocities of one wheel [rad/s] after each step, while a torque [N·m] acts on the wheel."""
    found = []
    for _ in range(round(seconds / sim.timestep)):
        if torque:
            wheel(sim).set_effort(torque)
        sim.step()
        found.append(wheel(sim).velocity)
    return np.array(found)


@pytest.mark.parametrize(
    ("values", "step"),
    [
        ({"mass": 10.0, "mu": 1.0, "shape": "cylinder"}, 0.001),
        ({"mass": 50.0, "mu": 1.0, "shape": "cylinder"}, 0.001),
        ({"mass": 50.0, "mu": 0.3, "shape": "cylinder"}, 0.001),
        ({"mass": 10.0, "mu": 0.3, "shape": "sphere"}, 0.001),
        ({"mass": 50.0, "mu": 1.0, "shape": "sphere"}, 0.002),
        ({"mass": 50.0, "mu": 1.0, "shape": "cylinder"}, 0.004),
        *(({"mass": mass, "mu": mu, "shape": "mesh"}, 0.001) for mass in (10.0, 50.0) for mu in (0.3, 1.0)),
        ({"mass": 10.0, "mu": 1.0, "width": 0.6, "length": 0.35}, 0.001),
        ({"mass": 50.0, "mu": 1.0, "width": 0.4, "length": 0.5}, 0.001),
    ],
)
def test_skid_steering_on_the_spot_turns_at_the_rate_of_the_coulomb_balance(
    values: dict[str, object], step: float, meshes: Path
) -> None:
    """Each wheel slips against its friction; without a net torque the yaw rate is W²/(W²+L²) of the wheels'."""
    width, length = values.get("width", 0.5), values.get("length", 0.4)
    with opened(step, folder=meshes, **values) as sim:
        sim.run(0.5)
        drive(sim, angular=0.5)
        sim.run(1.0)
        before = sim.model("cart").pose
        sim.run(2.0)
        turned = (before.inverse() @ sim.model("cart").pose).rpy[2]
        rims = [abs(wheel(sim, name).velocity) * RADIUS for name in WHEELS]
        assert rims == pytest.approx([0.5 * width / 2] * 4, rel=0.01 if step < 0.004 else 0.02)
    assert turned == pytest.approx(0.5 * 2.0 * width**2 / (width**2 + length**2), rel=0.02)


@pytest.mark.parametrize("step", [0.0005, 0.001, 0.002, 0.004])
def test_a_constant_torque_on_a_wheel_is_compensated_within_a_quarter_of_a_second(step: float) -> None:
    with opened(step, held=True) as sim:
        drive(sim, linear=0.1)
        start = speeds(sim, 0.5)
        loaded = speeds(sim, 0.5, torque=-0.6)
        released = speeds(sim, 0.5)
    assert start.max() <= 1.0 + 1e-6
    assert loaded.min() < 0.98
    assert loaded[round(0.25 / step) :] == pytest.approx(1.0, abs=0.002)
    assert released.max() <= 1.0 + (1.0 - loaded.min()) + 1e-3
    assert released[round(0.25 / step) :] == pytest.approx(1.0, abs=0.002)
    assert released.min() > 0.99


def test_friction_and_damping_of_the_wheel_joints_do_not_slow_the_robot_down() -> None:
    # as in Stretch's file: at 5 rad/s 110 N·m, five times the effort that the tyres can transmit
    losses = "<xyz>0 0 1</xyz><dynamics><damping>20</damping><friction>10</friction></dynamics>"
    with simkit.load(world(GROUND, vehicle().replace("<xyz>0 0 1</xyz>", losses))) as sim:
        drive(sim, linear=0.5)
        sim.run(2.0)
        assert speeds(sim, 0.5) == pytest.approx(5.0, rel=0.01)
        drive(sim)
        sim.run(0.5)
        assert abs(wheel(sim).velocity) < 1e-3


@pytest.mark.parametrize("step", [0.001, 0.002])
def test_a_servo_at_its_effort_limit_does_not_wind_up(step: float) -> None:
    """With 2 N·m against 3 N·m, the wheel turns backwards, and recovers without overshoot."""
    with opened(step, held=True, effort=2.0) as sim:
        drive(sim, linear=0.5)
        speeds(sim, 0.3)
        for _ in range(round(1.0 / step)):
            # beyond what a joint's own effort limit lets through
            sim.mj_data.qfrc_applied[sim.engine.names.joint("cart::front_left_joint").dofs[0]] = -3.0
            sim.engine.physics.one_shot = True
            sim.step()
        assert wheel(sim).velocity < -10.0
        released = speeds(sim, 2.0)
    back = int(np.argmax(released >= 5.0))
    assert back > 0
    assert released.max() < 5.0 + 2.0 * step / 0.004  # [kg·m²]: as far as the whole effort takes it in one step
    assert released[back + 5 :] == pytest.approx(5.0, rel=0.002)


@pytest.mark.parametrize("effort", [None, 5.0])
@pytest.mark.parametrize("mass", [10.0, 50.0])
def test_an_abrupt_start_and_stop_on_level_ground_cause_no_oscillation(mass: float, effort: float | None) -> None:
    with opened(mass=mass, effort=effort) as sim:
        sim.run(0.5)
        drive(sim, linear=0.3)
        start = speeds(sim, 1.0) * RADIUS
        drive(sim)
        stop = speeds(sim, 1.0) * RADIUS
    assert start.max() < 0.3 * 1.03
    assert stop.min() > -0.3 * 0.03
    assert start[400:] == pytest.approx(0.3, rel=0.003)
    assert stop[400:] == pytest.approx(0.0, abs=1e-5)


@pytest.mark.parametrize("mass", [10.0, 50.0])
def test_on_a_slope_it_holds_and_climbs_at_the_commanded_speed(mass: float) -> None:
    with opened(slope=math.radians(10), mass=mass) as sim:
        sim.run(1.0)
        before = sim.model("cart").pose.position[0]
        sim.run(5.0)
        assert abs(sim.model("cart").pose.position[0] - before) < 2e-5
        drive(sim, linear=-0.3)
        climbing = speeds(sim, 1.0) * RADIUS
        assert climbing[250:] == pytest.approx(-0.3, rel=0.01)
        drive(sim)
        sim.run(1.0)
        before = sim.model("cart").pose.position[0]
        sim.run(5.0)
        assert abs(sim.model("cart").pose.position[0] - before) < 2e-5


def test_a_towed_load_does_not_slow_it_down() -> None:
    sledge = (
        f"<link name='sledge'><pose>-1 0 0.1 0 0 0</pose>{inertial(30.0, 0.01)}<collision name='box'><geometry><box>"
        f"<size>0.3 0.3 0.2</size></box></geometry>{surface(0.5)}</collision></link>"
        "<joint name='rod' type='revolute'><parent>base</parent><child>sledge</child><axis><xyz>0 1 0</xyz></axis>"
        "</joint>"
    )
    with opened(mass=50.0, extra=sledge) as sim:
        sim.run(0.5)
        drive(sim, linear=0.3)
        sim.run(0.4)
        before = sim.model("cart").pose.position[0]
        sim.run(2.0)
        assert sim.model("cart").pose.position[0] - before == pytest.approx(0.6, rel=0.01)


def test_the_loads_of_a_turn_are_gone_when_the_robot_has_stopped() -> None:
    """The loads of a turn vanish when the robot has stopped, so nothing moves it."""
    with opened(mass=50.0) as sim:
        sim.run(0.5)
        drive(sim, angular=0.5)
        sim.run(1.0)
        drive(sim)
        sim.run(1.0)
        before = sim.model("cart").pose
        sim.run(10.0)
        moved = before.inverse() @ sim.model("cart").pose
    assert np.linalg.norm(moved.position) < 1e-6
    assert np.linalg.norm(moved.rpy) < 1e-6


def test_a_wheel_whose_position_is_set_keeps_its_speed() -> None:
    with opened(held=True) as sim:
        drive(sim, linear=0.1)
        sim.run(0.5)
        wheel(sim).set_position(wheel(sim).position + 2.0)
        assert speeds(sim, 0.2) == pytest.approx(1.0, abs=1e-3)


def test_the_correction_is_kept_after_a_spawn() -> None:
    with opened(held=True) as sim:
        drive(sim, linear=0.1)
        speeds(sim, 0.5, torque=-0.6)
        ball = f"<model name='ball'><pose>3 0 1 0 0 0</pose><link name='l'>{inertial(1.0, 0.01)}</link></model>"
        sim.spawn(f"<sdf version='1.9'>{ball}</sdf>")
        assert speeds(sim, 0.3, torque=-0.6) == pytest.approx(1.0, abs=0.002)


def state(sim: simkit.Simulation) -> bytes:
    return b"".join(values.tobytes() for values in (sim.mj_data.qpos, sim.mj_data.qvel, sim.mj_data.ctrl))


def run_in(sim: simkit.Simulation, chunk: int, *, reads: bool) -> bytes:
    drive(sim, angular=0.5)
    for _ in range(600 // chunk):
        sim.step(chunk)
        if reads:
            assert math.isfinite(wheel(sim).effort + sim.link("cart::base").linear_acceleration[0])
    return state(sim)


def test_reading_chunked_runs_and_snapshots_change_no_bit() -> None:
    with opened(mass=50.0) as sim:
        whole = run_in(sim, 600, reads=False)
        for chunk, reads in ((1, True), (1, False), (6, True), (50, False)):
            sim.reset()
            assert run_in(sim, chunk, reads=reads) == whole
        sim.reset()
        drive(sim, angular=0.5)
        sim.step(333)
        snapshot = sim.snapshot()
        sim.step(267)
        ends = [state(sim)]
        drive(sim, linear=1.0)
        sim.step(100)
        sim.restore(snapshot)
        sim.step(267)
        ends.append(state(sim))
        assert ends == [whole, whole]


def test_a_tree_with_a_singular_inverse_inertia_gets_zero_gains_and_the_others_keep_theirs() -> None:
    fine, singular = np.diag([2.0, 4.0]), np.full((2, 2), 2.5565e103)
    for one, other in ((fine, singular), (singular, fine)):
        found = _tree_by_tree(np.linalg.inv, np.stack([one, other]))
        expected = [np.diag([0.5, 0.25]) if each is fine else np.zeros((2, 2)) for each in (one, other)]
        assert np.array_equal(found, np.stack(expected))
