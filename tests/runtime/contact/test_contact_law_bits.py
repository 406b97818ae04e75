"""The contact law gives the same bits for each division of a run, with readers, and after restore and reset."""

from __future__ import annotations

import copy
import math
import random
import threading
from collections.abc import Callable

import mujoco
import numpy as np
import pytest

import simkit
from simkit.errors import SimulationDiverged
from simkit.runtime.contact import centripetal_friction, contact_law
from simkit.runtime.contact.array_contact_correction import ArrayContactCorrection
from simkit.runtime.contact.contact_law import window_length
from simkit.runtime.engine.physics_step import STALE, VELOCITY

UPRIGHT = (1.0, 0.0, 0.0, 0.0)
SENSORS = """<sensor name="imu" type="imu"><update_rate>1000</update_rate></sensor>
<sensor name="touch" type="contact"><contact><collision>c</collision></contact><update_rate>70</update_rate></sensor>"""
BOUNCE = "<bounce><restitution_coefficient>0.6</restitution_coefficient><threshold>0</threshold></bounce>"
BALL = "<sphere><radius>0.1</radius></sphere>"
WALL = """<model name="wall"><static>true</static><pose>1 0 0 0 0 0</pose><link name="l"><collision name="c"><geometry>
<box><size>0.02 4 4</size></box></geometry></collision></link></model>"""
GROUND = """<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
<surface><friction><ode><mu>0.5</mu><mu2>0.5</mu2></ode></friction></surface></collision></link></model>"""
WHEEL = """<link name="{side}"><pose>0 {y} 0 -1.5708 0 0</pose>{inertia}<collision name="c"><geometry><cylinder>
<radius>0.05</radius><length>0.03</length></cylinder></geometry></collision></link>
<joint name="{side}_joint" type="revolute"><parent>base</parent><child>{side}</child><axis><xyz>0 0 1</xyz></axis>
</joint>
"""


def inertial(mass: float, inertia: float) -> str:
    tensor = "".join(f"<{i}>{inertia}</{i}>" for i in ("ixx", "iyy", "izz"))
    return f"<inertial><mass>{mass}</mass><inertia>{tensor}</inertia></inertial>"


def body(name: str, pose: str, size: float = 0.2, shape: str = "", surface: str = "", sensors: str = "") -> str:
    mass = 125.0 * size**3
    shape = shape or f"<box><size>{size} {size} {size}</size></box>"
    return f"""<model name="{name}"><pose>{pose}</pose><link name="l">{inertial(mass, mass * size**2 / 6)}
    <collision name="c"><geometry>{shape}</geometry><surface>{surface}</surface></collision>{sensors}</link></model>"""


def world(*models: str, head: str = "") -> str:
    return f"""<sdf version="1.9" xmlns:simkit="https://simkit"><world name="w"><physics type="ode">
    <max_step_size>0.001</max_step_size>{head}</physics>{GROUND}{"".join(models)}</world></sdf>"""


def chain(pose: str, root: str = "world") -> str:
    text = ""
    for i in range(9):
        text += f"""<link name="l{i}"><pose>{0.1 * i + 0.05} 0 0 0 0 0</pose>{inertial(0.1, 1e-4)}<collision name="c">
        <geometry><sphere><radius>0.03</radius></sphere></geometry></collision></link>"""
        if parent := f"l{i - 1}" if i else root:
            text += f"""<joint name="j{i}" type="revolute"><parent>{parent}</parent><child>l{i}</child>
            <pose>-0.05 0 0 0 0 0</pose><axis><xyz>0 1 0</xyz></axis></joint>"""
    return f'<model name="chain"><pose>{pose}</pose>{text}</model>'


def robot(name: str, y: float) -> str:
    wheels = "".join(WHEEL.format(side=s, y=at, inertia=inertial(0.1, 1e-4)) for s, at in (("l", 0.12), ("r", -0.12)))
    return f"""<model name="{name}"><pose>0 {y} 0.05 0 0 0</pose><link name="base">{inertial(2, 0.02)}
    <collision name="c"><pose>-0.08 0 -0.03 0 0 0</pose><geometry><sphere><radius>0.02</radius></sphere></geometry>
    <surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction></surface></collision>{SENSORS}</link>{wheels}
    <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"><left_joint>l_joint</left_joint>
    <right_joint>r_joint</right_joint><wheel_separation>0.24</wheel_separation><wheel_radius>0.05</wheel_radius>
    </plugin></model>"""


def drive(sim: simkit.Simulation) -> None:
    for name in sim.models:
        if name.startswith("robot"):
            sim.publish(f"/model/{name}/cmd_vel", {"linear": {"x": 0.3}, "angular": {"z": 1.5}})


def sliding() -> simkit.Simulation:
    sim = simkit.load(
        world(
            body("a", "0 0 0.1 0 0 0", sensors=SENSORS), body("b", "0 2 0.3 0.3 0.2 0"), body("c", "0.4 0 0.1 0 0 0.2")
        )
    )
    sim.model("a").set_velocity((4, 0, 0), (0, 0, 0.5))
    return sim


def bouncing() -> simkit.Simulation:
    ball = body("a", "0 0 0.2 0 0 0", shape=BALL, surface=BOUNCE, sensors=SENSORS)
    sim = simkit.load(world(ball, body("b", "0 0 0.5 0.3 0.2 0", surface=BOUNCE)))
    sim.model("a").set_velocity((2, 0, -1), (0, 3, 0.5))
    return sim


def fast() -> simkit.Simulation:
    sim = simkit.load(
        world(WALL, body("a", "0.3 0 0.5 0 0 0", 0.04, sensors=SENSORS), body("b", "0 1 0.5 0 0 0", 0.04))
    )
    sim.model("a").set_velocity((40, 0, 0), (0, 30, 0.5))
    sim.model("b").set_velocity((25, 3, 0), (10, 3, 0.5))
    return sim


def swinging() -> simkit.Simulation:
    sim = simkit.load(world(chain("0 0 0.6 0 0 0"), body("a", "1 1 0.1 0 0 0", sensors=SENSORS)))
    sim.model("a").set_velocity((3, 0, 0))
    return sim


def turning() -> simkit.Simulation:
    sim = simkit.load(world(robot("robot", 0.0), robot("robot_2", 1.5)))
    drive(sim)
    return sim


LOG = "<cylinder><radius>0.05</radius><length>0.3</length></cylinder>"
TABLE = """<model name="table"><static>true</static><pose>1 0 0.1 0 0 0</pose><link name="l"><collision name="c">
<geometry><box><size>0.4 1 0.2</size></box></geometry></collision></link></model>"""


def logs() -> simkit.Simulation:
    places = ("-0.05 0 0.05 1.5708 0 0.002", "0.05 0.01 0.05 1.5708 0 0", "0 0 0.137 1.5708 0 -0.003")
    pile = [body(f"log_{i}", place, shape=LOG) for i, place in enumerate(places)]
    sim = simkit.load(world(TABLE, body("a", "1.19 0 0.25 1.5708 0 0.01", shape=LOG, sensors=SENSORS), *pile))
    sim.model("a").set_velocity((0.3, 0, 0), (0, 6, 0))
    return sim


def heaping() -> simkit.Simulation:
    """Bodies that fall on each other, in several islands, while one slides."""
    boxes = [body("abcd"[i], f"{0.05 * i} {0.03 * i} {0.2 + 0.25 * i} {0.4 * i} 0.3 0", 0.15) for i in range(4)]
    boxes[0] = body("a", "0 0 0.2 0 0.3 0", 0.15, sensors=SENSORS)
    balls = [body(f"ball_{i}", f"{1.0 + 0.03 * i} 1 {0.15 + 0.22 * i} 0 0 0", shape=BALL) for i in range(3)]
    sim = simkit.load(world(*boxes, *balls, body("slider", "0 -2 0.1 0 0 0")))
    sim.model("slider").set_velocity((3, 1, 0))
    sim.model("d").set_velocity((0.3, 0, -3), (2, 1, 0))
    sim.model("ball_2").set_velocity((0, 0.2, -2))
    return sim


WORLDS = {
    "logs": logs,
    "heaping": heaping,
    "sliding": sliding,
    "bouncing": bouncing,
    "fast": fast,
    "swinging": swinging,
    "turning": turning,
}
STEPS = 120


def bits(sim: simkit.Simulation) -> bytes:
    return bytes(sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes())


def readings(sim: simkit.Simulation) -> list[str]:
    return [repr(sensor.latest) for sensor in sim.contents.sensors.values()]


def read_randomly(sim: simkit.Simulation) -> None:
    """Make one of several readings, or none."""
    random.choice(
        (
            lambda: None,
            lambda: [model.pose for model in sim.models.values()],
            lambda: readings(sim),
            sim.engine.physics.fresh_velocities,
            sim.engine.physics.fresh_accelerations,
            lambda: sim.engine.physics.data_of(sim.engine.physics.hold()),
        )
    )()


# ---------------------------------------------------------------------- chunks, readers, snapshots


@pytest.mark.parametrize("name", WORLDS)
def test_chunks_of_steps_and_readers_do_not_change_any_bit(name: str) -> None:
    random.seed(3)
    alone = WORLDS[name]()
    states = [bits(alone)]
    for _ in range(STEPS):
        alone.step()
        states.append(bits(alone))
    for reads in (False, True):
        sim = WORLDS[name]()
        while sim.tick < STEPS:
            sim.step(min(1 if reads else random.choice((2, 3, 7, 8, 9, 31)), STEPS - sim.tick))
            if reads:
                read_randomly(sim)
            assert bits(sim) == states[sim.tick]
        assert readings(sim) == readings(alone)


@pytest.mark.parametrize("name", WORLDS)
def test_a_run_restored_to_any_tick_of_a_window_repeats(name: str) -> None:
    random.seed(5)
    alone = WORLDS[name]()
    states = [bits(alone)]
    for _ in range(STEPS):
        alone.step()
        states.append(bits(alone))
    sim = WORLDS[name]()
    sim.step(40)
    for _ in range(2 * window_length(0.001) + 1):
        here, tick = sim.snapshot(), sim.tick
        for count in (5, 20):
            sim.model("ground").pose  # noqa: B018 - a reader
            sim.mj_data.qvel[:] *= 0.5
            sim.engine.physics.changed(VELOCITY)
            sim.step(count)
            sim.restore(here)
            read_randomly(sim)
            sim.step(count)
            assert bits(sim) == states[tick + count]
            sim.restore(here)
        sim.step()


CHANGES: dict[str, Callable[[simkit.Simulation], object]] = {
    "velocity": lambda sim: sim.model("a").set_velocity((1, 2, 0.5), (0, 0, 2)),
    "pose": lambda sim: sim.model("a").set_pose(simkit.Pose((0, 0.5, 0.11), UPRIGHT)),
    "wrench": lambda sim: sim.link("a::l").apply_wrench((3, 1, 20), (0, 0.1, 0)),
    "gravity": lambda sim: setattr(sim, "gravity", (1, 0, -5)),
    "friction": lambda sim: sim.engine.touch("geom_friction").__imul__(0.3),
    "collisions": lambda sim: setattr(sim.link("a::l"), "collisions_enabled", False),
    "spawn": lambda sim: sim.spawn(f'<sdf version="1.9">{body("z", "0.3 0.5 0.4 0 0 0")}</sdf>'),
    "remove": lambda sim: sim.remove("b"),
    "reset": lambda sim: sim.reset(),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_change_within_a_window_gives_the_same_bits_with_readers_and_after_a_restore(change: str) -> None:
    random.seed(7)
    found = []
    for how in ("alone", "read", "restored"):
        sim = sliding()
        sim.step(35)
        if how == "read":
            sim.engine.physics.fresh_accelerations()
        CHANGES[change](sim)
        if how == "restored":
            here = sim.snapshot()
            sim.step(3)
            sim.spawn(f'<sdf version="1.9">{body("y", "5 5 0.1 0 0 0")}</sdf>')
            sim.step(3)
            sim.restore(here)
        for _ in range(1 if how == "alone" else 40):
            if how == "read":
                read_randomly(sim)
            sim.step(40 if how == "alone" else 1)
        found.append((bits(sim), readings(sim)))
    assert found[0] == found[1] == found[2]


@pytest.mark.parametrize("name", WORLDS)
def test_a_stored_state_gives_the_accelerations_and_forces_of_its_step(name: str) -> None:
    """A stored state that is read later has the same accelerations and forces as its step, bit for bit."""
    sim, live = WORLDS[name](), WORLDS[name]()
    held = []
    for _ in range(60):
        sim.step()
        live.step()
        data = live.engine.physics.fresh_accelerations()
        held.append((sim.engine.physics.hold(), data.qacc.copy(), data.cacc.copy(), data.efc_force.copy()))
    random.Random(1).shuffle(held)
    for state, *values in held:
        data = sim.engine.physics.data_of(state)
        for got, expected in zip((data.qacc, data.cacc, data.efc_force), values, strict=True):
            assert np.array_equal(got, expected)


def test_a_stored_state_has_the_controls_of_its_tick() -> None:
    """A direct write to the engine's controls, before the stored state is measured, has no effect on it."""
    sim = simkit.load("""<mujoco><worldbody><body><joint name="j" axis="0 1 0"/><geom size="0.1" mass="1"/></body>
    </worldbody><actuator><motor joint="j"/></actuator></mujoco>""")
    sim.step(3)
    held = sim.engine.physics.hold()
    sim.mj_data.ctrl[0] = 5.0
    assert sim.engine.physics.data_of(held).qacc[0] == 0.0
    sim.step()
    assert sim.engine.physics.data_of(held).qacc[0] == 0.0


# ---------------------------------------------------------------------- plain numbers, arrays and fleets


@pytest.mark.parametrize("name", ["sliding", "bouncing", "fast", "heaping"])
def test_plain_numbers_and_arrays_give_the_same_bits(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    found = set()
    for many in (0, 10**9):
        monkeypatch.setattr(contact_law, "ARRAY_THRESHOLD", many)
        monkeypatch.setattr(centripetal_friction, "ARRAY_THRESHOLD", many)
        sim = WORLDS[name]()
        sim.step(200)
        found.add(bits(sim))
    assert len(found) == 1


@pytest.mark.parametrize("condim", [1, 4, 6])
def test_plain_numbers_and_arrays_give_the_same_bits_with_every_friction_dimension(
    condim: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = set()
    for many in (0, 10**9):
        monkeypatch.setattr(contact_law, "ARRAY_THRESHOLD", many)
        sim = simkit.load(mjcf("implicitfast", "elliptic", condim))
        push(sim)
        sim.step(150)
        found.add(bits(sim))
    assert len(found) == 1


def test_a_robot_in_a_fleet_moves_like_a_single_robot() -> None:
    fleet = simkit.load(world(*(robot(f"robot_{i}", 1.5 * i) for i in range(8))))
    alone = simkit.load(world(robot("robot_0", 0.0)))
    assert mujoco.mj_isSparse(fleet.mj_model)
    assert not mujoco.mj_isSparse(alone.mj_model)
    for sim in (fleet, alone):
        drive(sim)
        sim.run(0.6)
    one, other = fleet.model("robot_0").pose, alone.model("robot_0").pose
    assert np.allclose(one.position, other.position, atol=1e-4)  # all islands share the solver's tolerance
    assert np.allclose(one.quaternion, other.quaternion, atol=1e-4)


def test_with_the_engines_own_contacts_a_run_has_the_bits_of_mujoco() -> None:
    models = body("a", "0 0 0.1 0 0 0"), body("b", "0 2 0.3 0.3 0.2 0", surface=BOUNCE), WALL
    sim = simkit.load(world(*models, head="<simkit:contact_law>mujoco</simkit:contact_law>"))
    sim.model("a").set_velocity((40, 0, 0), (0, 0, 0.5))
    model, data = copy.copy(sim.mj_model), copy.copy(sim.mj_data)
    mujoco.mj_step(model, data, 200)
    for _ in range(20):
        sim.step(10)
        sim.engine.physics.fresh_accelerations()
    assert data.qpos.tobytes() == sim.mj_data.qpos.tobytes()


# ---------------------------------------------------------------------- effects of earlier steps


def test_a_chain_that_slept_moves_the_same_with_and_without_a_reader() -> None:
    found = []
    for reads in (False, True):
        sim = simkit.load(world(chain("0 0 0.03 0 0 0", root=""), body("a", "0 5 0.1 0 0 0")))
        sim.run(4.0)
        assert (sim.mj_data.tree_asleep >= 0).all()
        sim.model("chain").set_pose(simkit.Pose((0, 0, 3), (0.995, 0, 0.1, 0)))
        if reads:
            sim.engine.physics.fresh()
        sim.step()
        found.append(bits(sim))
    assert found[0] == found[1]


def test_a_body_whose_collisions_are_enabled_after_a_spawn_does_not_pass_a_wall() -> None:
    sim = simkit.load(world(WALL, body("a", "0 0 0.5 0 0 0", 0.04)))
    sim.link("a::l").collisions_enabled = False
    sim.step(3)
    sim.spawn(f'<sdf version="1.9">{body("z", "-5 5 0.1 0 0 0")}</sdf>')
    sim.link("a::l").collisions_enabled = True
    sim.model("a").set_pose(simkit.Pose((0, 0, 0.5), UPRIGHT))
    sim.model("a").set_velocity((100, 0, 0))
    sim.step(40)
    assert sim.model("a").pose.position[0] < 1.0


def test_repeated_readings_between_two_steps_need_no_more_memory() -> None:
    sim = turning()
    sim.step(400)
    base, used = sim.link("robot::base"), []
    for _ in range(3):
        for _ in range(200):
            base.apply_wrench((1e-9, 0, 0))
            sim.engine.physics.fresh()
        used.append(int(sim.mj_data.maxuse_arena))
    assert used[0] == used[2]


def test_a_spawn_while_servos_have_no_gain_keeps_their_corrections_limited() -> None:
    sim = turning()
    sim.step(203)
    gains = sim.engine.touch("actuator_gainprm")
    before = gains.copy()
    gains[:, 0] = 0.0
    sim.spawn(f'<sdf version="1.9">{body("z", "5 5 0.5 0 0 0")}</sdf>')
    sim.step(100)
    sim.engine.touch("actuator_gainprm")[:] = before
    sim.step(200)
    assert np.abs(sim.mj_data.ctrl).max() < 20.0
    assert not sim.mj_data.warning.number.any()


@pytest.mark.parametrize("speed", [1e9, math.nan])
def test_a_diverging_chain_is_reported_and_the_engine_options_are_restored(speed: float) -> None:
    sim = swinging()
    option = sim.mj_model.opt
    before = option.timestep, option.integrator, option.disableflags, option.enableflags
    sim.mj_data.qvel[:] = speed
    sim.engine.physics.changed(VELOCITY)
    with pytest.raises(SimulationDiverged):
        sim.step(100)
    sim.reset()
    assert (option.timestep, option.integrator, option.disableflags, option.enableflags) == before
    sim.step(50)
    other = swinging()
    other.reset()
    other.step(50)
    assert bits(sim) == bits(other)


# ---------------------------------------------------------------------- Runge-Kutta, whose stages follow the law


def mjcf(integrator: str, cone: str = "pyramidal", condim: int = 3) -> str:
    shapes = ("box", "sphere", "cylinder", "capsule")
    bodies = "".join(
        f'<body pos="{0.5 * k} 0 {0.1 + 0.1 * (k % 2)}"><freejoint/><geom type="{shapes[k % 4]}" size="0.1 0.1 0.1" '
        f'condim="{condim}" friction="0.5 0.02 0.01" mass="1"/></body>'
        for k in range(5)
    )
    return f"""<mujoco><option timestep="0.001" integrator="{integrator}" cone="{cone}"/><worldbody>
    <geom type="plane" size="5 5 1"/>{bodies}</worldbody></mujoco>"""


def push(sim: simkit.Simulation) -> None:
    sim.mj_data.qvel[:] = np.random.default_rng(1).normal(size=sim.mj_model.nv)
    sim.engine.physics.changed(STALE)


@pytest.mark.slow
def test_worlds_under_runge_kutta_step_on_several_threads_while_others_load() -> None:
    expected = simkit.load(mjcf("RK4"))
    push(expected)
    expected.step(300)
    sims = [simkit.load(mjcf("RK4")) for _ in range(3)]

    def advance(sim: simkit.Simulation) -> None:
        push(sim)
        for _ in range(30):
            sim.step(10)

    threads = [threading.Thread(target=advance, args=(sim,)) for sim in sims]
    for thread in threads:
        thread.start()
    for _ in range(5):
        simkit.load(mjcf("implicitfast"))
    for thread in threads:
        thread.join()
    assert [bits(sim) == bits(expected) for sim in sims] == [True] * 3
    assert mujoco.get_mjcb_control() is None


def test_a_control_callback_of_the_user_is_called_in_the_stages_too() -> None:
    sim = simkit.load(mjcf("RK4"))
    push(sim)
    calls = []

    def own(_model: object, _data: object) -> None:
        calls.append(sim.tick)

    mujoco.set_mjcb_control(own)
    try:
        sim.step(4)
        assert mujoco.get_mjcb_control() is own
    finally:
        mujoco.set_mjcb_control(None)
    assert all(calls.count(tick) >= 4 for tick in range(4))


def test_an_interrupt_within_a_stage_is_raised_and_removes_the_callback(monkeypatch: pytest.MonkeyPatch) -> None:
    sim = simkit.load(mjcf("RK4"))
    push(sim)
    sim.step(3)
    correct, calls = ArrayContactCorrection.correct, []

    def interrupted(self: ArrayContactCorrection, *args: object) -> bool:
        calls.append(0)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return correct(self, *args)  # type: ignore[arg-type]

    monkeypatch.setattr(ArrayContactCorrection, "correct", interrupted)
    with pytest.raises(KeyboardInterrupt):
        sim.step(2)
    assert mujoco.get_mjcb_control() is None
    sim.step(3)
