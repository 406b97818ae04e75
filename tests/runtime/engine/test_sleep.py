"""Bodies at rest sleep until another body reaches them, without any measurable effect."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import simkit

GROUND = """<model name="ground"><static>true</static><link name="l"><collision name="c">
<geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry></collision></link></model>"""
TABLE = """<model name="table"><static>true</static><pose>5 0 0.5 0 0 0</pose><link name="l"><collision name="c">
<geometry><box><size>1 1 0.1</size></box></geometry></collision></link></model>"""
BOX = "<box><size>0.4 0.4 0.4</size></box>"
BALL = "<sphere><radius>0.1</radius></sphere>"
ASLEEP = 0.5  # [s] time after which a box that starts at rest sleeps


def body(name: str, place: str, shape: str = BOX, inside: str = "", surface: str = "") -> str:
    return f"""<model name="{name}"><pose>{place} 0 0 0</pose>{inside}<link name="l">
<inertial><mass>1</mass><inertia><ixx>0.02</ixx><iyy>0.02</iyy><izz>0.02</izz></inertia></inertial>
<collision name="c"><geometry>{shape}</geometry>{surface}</collision></link></model>"""


def world(*parts: str, gravity: str = "0 0 -9.8") -> str:
    return f"""<sdf version="1.9"><world name="w"><gravity>{gravity}</gravity>
<physics name="p" type="ode"><max_step_size>0.001</max_step_size></physics>{"".join(parts)}</world></sdf>"""


def asleep(sim: simkit.Simulation) -> list[str]:
    """Return the names of the models that sleep."""
    data = sim.engine.physics.fresh()
    links = {name: sim.engine.names.links[f"{name}::l"].body for name in sim.models}
    return [name for name, b in links.items() if b and sim.engine.physics.sleep.is_asleep(b, data)]


def state(sim: simkit.Simulation) -> bytes:
    return bytes(sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes()) + str(sim.tick).encode()


TWO = (GROUND, body("a", "0 0 0.2"), body("b", "2 0 0.2"))


# ---------------------------------------------------------------------- bodies that fall asleep


def test_boxes_at_rest_fall_asleep_at_their_poses_and_time_continues() -> None:
    sim = simkit.load(world(*TWO))
    sim.run(ASLEEP)
    assert asleep(sim) == ["a", "b"]
    before = sim.model("a").pose
    sim.run(1000.0)
    assert sim.time == 1000.0 + ASLEEP
    assert sim.mj_data.time == pytest.approx(sim.time, abs=1e-6)
    assert sim.model("a").pose == before
    assert not sim.link("a::l").linear_velocity.any() and not sim.link("a::l").angular_velocity.any()
    assert not sim.link("a::l").linear_acceleration.any()


@pytest.mark.parametrize("loaded", [(GROUND,), (GROUND, body("a", "0 0 0.2"))])
def test_a_model_spawned_into_a_world_with_one_body_or_none_falls_asleep(loaded: tuple[str, ...]) -> None:
    sim = simkit.load(world(*loaded))
    for name, x in (("b", 2.0), ("c", 4.0)):
        model = f'<sdf version="1.9">{body(name, "0 0 0.2")}</sdf>'
        sim.spawn(model, name=name, pose=simkit.Pose((x, 0.0, 0.2)))
    sim.run(ASLEEP)
    assert asleep(sim) == sorted(name for name in sim.models if name != "ground")
    sim.reset()
    sim.run(ASLEEP)
    assert asleep(sim) == []  # a single tree is stepped without islands, as after loading


def test_sleep_changes_no_measurable_position() -> None:
    with_sleep, without = (simkit.load(world(*TWO), sleep=sleep) for sleep in (True, False))
    for sim in (with_sleep, without):
        sim.run(5.0)
    assert asleep(with_sleep) == ["a", "b"] and asleep(without) == []
    assert np.abs(with_sleep.mj_data.qpos - without.mj_data.qpos).max() < 1e-9


def test_the_engines_time_advances_step_by_step_even_while_all_bodies_sleep() -> None:
    with_sleep, without = (simkit.load(world(*TWO), sleep=sleep) for sleep in (True, False))
    for sim in (with_sleep, without):
        sim.run(3.0)
    assert with_sleep.mj_data.time == without.mj_data.time


@pytest.mark.parametrize("overrides", [("physics.sleep=false",), ("a.allow_auto_disable=false",)])
def test_sleep_can_be_disabled_for_the_world_and_for_a_model(overrides: tuple[str, ...]) -> None:
    sim = simkit.load(world(*TWO), overrides=overrides)
    sim.run(2.0)
    assert "a" not in asleep(sim)


def test_a_model_that_may_not_be_disabled_stays_awake() -> None:
    never = "<allow_auto_disable>false</allow_auto_disable>"
    sim = simkit.load(world(GROUND, body("a", "0 0 0.2", inside=never), body("b", "2 0 0.2")))
    sim.run(2.0)
    assert asleep(sim) == ["b"]


def test_a_robot_with_a_sensor_and_the_bodies_that_touch_it_never_sleep() -> None:
    imu = '<sensor name="imu" type="imu"><update_rate>100</update_rate></sensor></link>'
    robot = body("robot", "0 0 0.2").replace("</link>", imu)
    sim = simkit.load(world(GROUND, robot, body("on_it", "0 0 0.6"), body("b", "2 0 0.2")))
    sim.run(3.0)
    assert asleep(sim) == ["b"]
    assert sim.sensor("robot::l::imu").latest.linear_acceleration.z == pytest.approx(9.8, abs=1e-3)


def test_an_immediate_and_a_later_reading_beside_sleeping_bodies_are_equal() -> None:
    imu = '<sensor name="imu" type="imu"><update_rate>100</update_rate></sensor></link>'
    source = world(GROUND, body("robot", "0 0 0.2").replace("</link>", imu), body("a", "3 0 0.2"), body("b", "2 0 0.2"))
    at_once, later = simkit.load(source), simkit.load(source)
    messages = at_once.subscribe(at_once.sensor("robot::l::imu").topic)
    for sim in (at_once, later):
        sim.run(2.0)
    assert asleep(later) == ["a", "b"]
    a, b = messages.latest, later.sensor("robot::l::imu").latest
    assert (a.linear_acceleration.x, a.linear_acceleration.y, a.linear_acceleration.z) == (
        b.linear_acceleration.x,
        b.linear_acceleration.y,
        b.linear_acceleration.z,
    )
    assert state(at_once) == state(later)


# ---------------------------------------------------------------------- bodies that must stay awake


def test_a_satellite_that_drifts_at_a_tenth_of_a_millimetre_per_second_does_not_stop() -> None:
    sim = simkit.load(world(body("a", "0 0 0"), body("b", "9 0 0"), gravity="0 0 0"))
    sim.model("a").set_velocity((1e-4, 0, 0))
    sim.run(20.0)
    assert sim.model("a").pose.position[0] == pytest.approx(2e-3, rel=1e-6)


def test_a_ball_at_the_top_of_a_slow_throw_comes_down() -> None:
    sim = simkit.load(world(body("a", "0 0 5", BALL), body("b", "9 0 5", BALL), gravity="0 0 -0.001"))
    sim.model("a").set_velocity((0, 0, 1e-3))  # at the top after 1 s, where a speed limit would stop it
    sim.run(4.0)
    assert sim.model("a").pose.position[2] == pytest.approx(5 + 4e-3 - 0.008, abs=1e-5)


def test_a_slowly_rolling_body_does_not_stop() -> None:
    sim = simkit.load(world(GROUND, body("a", "0 0 0.1", BALL), body("b", "9 0 0.1", BALL)))
    sim.run(0.1)
    sim.model("a").set_velocity((1e-4, 0, 0), (0, 1e-3, 0))
    sim.run(20.0)
    assert asleep(sim) == ["b"]
    assert sim.model("a").pose.position[0] == pytest.approx(2e-3, rel=0.05)


def test_a_slowly_sliding_body_without_friction_does_not_stop() -> None:
    ice = "<surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction></surface>"
    sim = simkit.load(world(GROUND, body("a", "0 0 0.2", surface=ice), body("b", "9 0 0.2")))
    sim.run(0.1)
    sim.model("a").set_velocity((1e-3, 0, 0))
    sim.run(10.0)
    assert sim.model("a").pose.position[0] == pytest.approx(1e-2, rel=1e-3)


def test_a_pendulum_does_not_fall_asleep_at_its_turning_point_or_near_upright() -> None:
    pendulum = """<model name="pendulum"><pose>{x} 0 3 0 0 0</pose><link name="l"><pose>0 0 {z} 0 0 0</pose><inertial>
<mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial></link>
<joint name="j" type="revolute"><parent>world</parent><child>l</child><pose>0 0 {up} 0 0 0</pose>
<axis><xyz>0 1 0</xyz></axis></joint></model>"""
    hanging = pendulum.format(x=0, z=-1, up=1)
    upright = pendulum.format(x=5, z=1, up=-1).replace('"pendulum"', '"upright"')
    trajectories = []
    for sleep in (True, False):
        sim = simkit.load(world(GROUND, hanging, upright, body("b", "9 0 0.2")), sleep=sleep)
        sim.joint("pendulum::j").set_position(0.001)
        sim.joint("upright::j").set_position(1e-9)
        sim.run(8.0)
        trajectories.append((sim.joint("pendulum::j").position, sim.joint("upright::j").position))
    assert trajectories[0] == trajectories[1]
    assert abs(trajectories[0][1]) > 1.0  # the pendulum has fallen


def test_a_box_that_begins_to_tip_over_very_slowly_is_not_stopped() -> None:
    # balanced on a narrow foot, with an offset of one micrometre
    foot = '<model name="post"><static>true</static><pose>0 0 0.5 0 0 0</pose><link name="l"><collision name="c">'
    foot += "<geometry><sphere><radius>0.5</radius></sphere></geometry></collision></link></model>"
    sim = simkit.load(world(GROUND, foot, body("a", "0.000001 0 1.2"), body("b", "9 0 0.2")))
    reference = simkit.load(world(GROUND, foot, body("a", "0.000001 0 1.2"), body("b", "9 0 0.2")), sleep=False)
    for s in (sim, reference):
        s.run(10.0)
    assert np.allclose(sim.model("a").pose.position, reference.model("a").pose.position, atol=1e-3)


# ---------------------------------------------------------------------- waking


def test_a_sleeping_box_that_a_ball_hits_moves_as_if_it_had_never_slept() -> None:
    poses = []
    slippery = "<surface><friction><ode><mu>0.01</mu><mu2>0.01</mu2></ode></friction></surface>"
    for sleep in (True, False):
        source = world(GROUND, body("a", "0 0 0.2", surface=slippery), TWO[2], body("ball", "-3 0 3", BALL))
        sim = simkit.load(source, sleep=sleep)
        sim.model("ball").set_velocity((3.75, 0, 0))
        sim.run(0.7)
        if sleep:
            assert asleep(sim) == ["a", "b"]
        sim.run(0.3)
        poses.append(sim.mj_data.qpos.copy())
    assert np.abs(poses[0] - poses[1]).max() < 1e-6
    assert abs(poses[0][0]) > 1e-3  # the box was pushed


def test_removing_the_table_under_a_sleeping_cup_makes_it_fall() -> None:
    sim = simkit.load(world(GROUND, TABLE, body("cup", "5 0 0.75"), body("b", "2 0 0.2")))
    sim.run(ASLEEP)
    assert asleep(sim) == ["cup", "b"]
    sim.remove("table")
    sim.run(0.1)
    assert sim.model("cup").pose.position[2] == pytest.approx(0.75 - 0.049, abs=2e-3)
    sim.run(1.0)
    assert sim.model("cup").pose.position[2] == pytest.approx(0.2, abs=1e-3)


def test_moving_the_table_away_makes_the_cup_fall_and_a_reset_puts_it_back() -> None:
    sim = simkit.load(world(GROUND, TABLE, body("cup", "5 0 0.75"), body("b", "2 0 0.2")))
    sim.run(ASLEEP)
    sim.model("table").set_pose(simkit.Pose((9, 9, 0.5)))
    sim.run(1.0)
    assert sim.model("cup").pose.position[2] == pytest.approx(0.2, abs=1e-3)
    sim.reset()
    sim.run(ASLEEP)
    assert sim.model("cup").pose.position[2] == pytest.approx(0.75, abs=1e-3)


def test_switching_off_the_table_s_collisions_or_the_cup_s_makes_it_fall() -> None:
    for link in ("table::l", "cup::l"):
        sim = simkit.load(world(GROUND, TABLE, body("cup", "5 0 0.75"), body("b", "2 0 0.2")))
        sim.run(ASLEEP)
        sim.link(link).collisions_enabled = False
        sim.run(0.2)
        assert sim.model("cup").pose.position[2] < 0.6


def test_a_model_spawned_onto_a_sleeping_body_pushes_it() -> None:
    sim = simkit.load(world(*TWO))
    sim.run(ASLEEP)
    sim.spawn(f'<sdf version="1.9">{body("c", "0.1 0 2.6")}</sdf>')
    sim.run(0.6)
    assert asleep(sim) == ["a", "b"]
    sim.run(0.1)
    assert asleep(sim) == ["b"]  # the box is hit after 0.64 s
    sim.run(3.0)
    assert sim.model("c").pose.position[2] == pytest.approx(0.6, abs=0.01)
    assert asleep(sim) == ["a", "b", "c"]


def test_a_change_of_gravity_wakes_all_bodies() -> None:
    sim = simkit.load(world(*TWO))
    sim.run(ASLEEP)
    sim.mj_model.opt.gravity[:] = (0, 0, 1.0)
    sim.run(1.0)
    assert sim.model("a").pose.position[2] == pytest.approx(0.7, abs=1e-2)


def test_a_value_set_on_a_sleeping_body_takes_effect_at_once() -> None:
    sim = simkit.load(world(*TWO))
    sim.run(ASLEEP)
    sim.link("a::l").apply_wrench((0, 0, 1000.0))
    assert sim.link("a::l").linear_acceleration[2] > 900
    sim.step()
    assert sim.link("a::l").linear_velocity[2] == pytest.approx(1.0, abs=0.02)
    sim.run(3.0)
    assert asleep(sim) == ["a", "b"]
    sim.model("a").set_velocity((0, 0, 2.0))
    assert sim.link("a::l").linear_velocity[2] == 2.0
    sim.run(0.1)
    assert sim.model("a").pose.position[2] == pytest.approx(0.2 + 0.2 - 0.049, abs=2e-3)
    sim.run(3.0)
    sim.model("a").set_pose(simkit.Pose((0, 3, 1.0)))
    assert sim.link("a::l").pose.position[2] == 1.0
    sim.run(0.1)
    assert sim.model("a").pose.position[2] == pytest.approx(1.0 - 0.049, abs=2e-3)


def test_direct_writes_to_the_engines_data_wake_bodies() -> None:
    sim = simkit.load(world(*TWO))
    sim.run(ASLEEP)
    sim.mj_data.qvel[2] = 2.0
    sim.run(0.1)
    assert sim.model("a").pose.position[2] == pytest.approx(0.2 + 0.2 - 0.049, abs=2e-3)


def test_hooks_and_commands_work_as_usual_while_all_bodies_sleep() -> None:
    class Kick(simkit.WorldPlugin):
        before_step_rate = 1.0
        calls = 0

        def load(self, parent: object, params: object) -> None: ...

        def before_step(self) -> None:
            self.calls += 1
            if self.calls == 3:
                self.sim.link("a::l").apply_wrench((0, 0, 1000.0))

    kick = Kick()
    sim = simkit.load(world(*TWO), plugins=[kick])
    clock = sim.subscribe("/clock")
    sim.run(2.9)
    assert asleep(sim) == ["a", "b"] and kick.calls == 2
    sim.run(0.2)
    assert sim.model("a").pose.position[2] > 0.25
    assert len(clock.messages) == 310


def test_reading_the_wrench_on_a_joint_of_a_sleeping_body_wakes_no_body() -> None:
    inertia = "<inertia><ixx>0.02</ixx><iyy>0.02</iyy><izz>0.02</izz></inertia>"
    rig = f"""<model name="rig"><pose>0 0 0.2 0 0 0</pose><link name="l"><inertial><mass>1</mass>{inertia}</inertial>
<collision name="c"><geometry>{BOX}</geometry></collision></link><link name="top"><pose>0 0 0.3 0 0 0</pose>
<inertial><mass>2</mass>{inertia}</inertial></link>
<joint name="j" type="fixed"><parent>l</parent><child>top</child></joint></model>"""
    sim = simkit.load(world(GROUND, rig, body("b", "3 0 0.2")))
    sim.run(1.0)
    assert asleep(sim) == ["rig", "b"]
    force, torque = sim.joint("rig::j").transmitted_wrench
    assert force == pytest.approx((0, 0, 2 * 9.8), abs=1e-3)
    assert torque == pytest.approx((0, 0, 0), abs=1e-3)
    assert asleep(sim) == ["rig", "b"]


# ---------------------------------------------------------------------- the same bits

EVENTS = (*TWO, body("ball", "0.1 0 6", BALL), body("c", "-3 0 0.3"), body("d", "-3.1 0 0.75"))


def test_chunks_of_steps_and_readers_change_no_bits() -> None:
    whole, single, read = (simkit.load(world(*EVENTS)) for _ in range(3))
    whole.run(3.0)
    for _ in range(3000):
        single.step()
    for k in range(1000):
        read.step(3)
        if k % 7 == 0:
            assert read.link("a::l").linear_acceleration.shape == (3,)
            assert len(read.model("d").joints) == 0
    assert asleep(whole) == asleep(single) == asleep(read) != []
    assert state(whole) == state(single) == state(read)


@pytest.mark.parametrize("when", [0.05, 0.3, 0.301, 1.09, 1.2, 2.5])
def test_a_run_restored_while_some_bodies_sleep_repeats_its_bits(when: float) -> None:
    sim = simkit.load(world(*EVENTS))
    sim.run(when)
    snapshot = sim.snapshot()
    sim.run(2.0)
    first, slept = state(sim), asleep(sim)
    sim.model("a").set_pose(simkit.Pose((0, 0, 3)))
    sim.mj_model.opt.gravity[:] = (0, 0, -1)
    sim.run(1.0)
    sim.restore(snapshot)
    sim.run(2.0)
    assert (state(sim), asleep(sim)) == (first, slept)
    fresh = simkit.load(world(*EVENTS))
    fresh.run(when)
    fresh.run(2.0)
    assert state(fresh) == first


def test_reset_repeats_the_bits() -> None:
    sim = simkit.load(world(*EVENTS))
    sim.run(3.0)
    first = state(sim)
    sim.link("a::l").collisions_enabled = False
    sim.run(1.0)
    sim.reset()
    sim.run(3.0)
    assert state(sim) == first


def test_a_restore_over_a_spawn_and_a_removal_repeats_the_bits() -> None:
    sim = simkit.load(world(*EVENTS, TABLE))
    sim.run(1.0)
    snapshot = sim.snapshot()
    states = []
    for _ in range(2):
        sim.spawn(f'<sdf version="1.9">{body("e", "0 0 3")}</sdf>', name="e")
        sim.run(1.0)
        sim.remove("table")
        sim.run(1.0)
        states.append(state(sim))
        sim.restore(snapshot)
    assert states[0] == states[1]
    sim.run(1.0)
    plain = simkit.load(world(*EVENTS, TABLE))
    plain.run(2.0)
    assert state(sim) == state(plain)


@pytest.mark.slow
def test_two_processes_give_the_same_bits(tmp_path: Path) -> None:
    file = tmp_path / "world.sdf"
    file.write_text(world(*EVENTS), encoding="utf-8")
    code = f"""import simkit
sim = simkit.load({str(file)!r})
sim.run(3.0)
print(sim.mj_data.qpos.tobytes().hex())"""
    root = str(Path(simkit.__file__).resolve().parents[1])
    outputs = {subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True).stdout for _ in range(2)}
    assert len(outputs) == 1 and len(outputs.pop()) > 100


def test_a_pile_falls_asleep_without_moving() -> None:
    rows = [body(f"p{i}_{j}", f"0 {0.42 * j + 0.21 * i} {0.2 + 0.4 * i}") for i in range(3) for j in range(3 - i)]
    sim = simkit.load(world(GROUND, *rows))
    reference = simkit.load(world(GROUND, *rows), sleep=False)
    for s in (sim, reference):
        s.run(12.0)
    assert len(asleep(sim)) == len(rows)
    assert np.abs(sim.mj_data.qpos - reference.mj_data.qpos).max() < 2e-4


def test_lidar_rays_hit_sleeping_bodies() -> None:
    lidar = """<sensor name="s" type="lidar"><update_rate>10</update_rate><lidar><scan><horizontal><samples>1</samples>
<min_angle>0</min_angle><max_angle>0</max_angle></horizontal></scan><range><min>0.1</min><max>10</max></range></lidar>
</sensor></link>"""
    tower = '<model name="tower"><static>true</static><pose>-3 0 0.2 0 0 0</pose><link name="l"></link></model>'
    sim = simkit.load(world(*TWO, tower.replace("</link>", lidar)))
    sim.run(1.0)
    assert asleep(sim) == ["a", "b"]
    assert math.isclose(float(sim.sensor("tower::l::s").latest.ranges[0]), 2.8, abs_tol=1e-3)
