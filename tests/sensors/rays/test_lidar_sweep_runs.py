"""A sweep in a run: time stamps, readers, reset, snapshots, changes of the world, methods of casting and errors."""

from __future__ import annotations

import math
import pickle
from typing import Any

import numpy as np
import pytest
from lidar_sweep_worlds import ANGULAR, INERTIA, LINEAR, POSE, SWEEP, WALL, fan, flyer, launch, target, world
from sensor_worlds import box, sensor

import simkit
from simkit.pose import Pose
from simkit.runtime.array_rules import CannotBatchError
from simkit.sensors.base import sensor_rule
from simkit.sensors.rays import ray_fan
from simkit.sensors.rays.embree_rays import has_embree
from simkit.sensors.rays.ray_targets import RayTargets

CRATE = target("crate", "<box><size>0.8 1.2 1.6</size></box>", "-1.5 1.8 1.2 0.3 0.2 0.1")
HAT = target("hat", "<cone><radius>0.6</radius><length>1.4</length></cone>", "-1 -2.5 1.3 0 0 0")
CAN = target("can", "<cylinder><radius>0.5</radius><length>1.4</length></cylinder>", "0.5 2.6 1 0.1 0 0")
MOVES = {"m": (LINEAR, ANGULAR), "crate": ((0.7, -0.3, 0.1), (1.0, 2.0, -1.5)), "hat": ((0.2, 0.4, 0), (0, 1, 1))}
ANGLES = [i * math.pi / 4 for i in range(8)]
NOISE = '<noise type="gaussian"><mean>0</mean><stddev>0.01</stddev></noise></lidar>'


def lidar(columns: int = 36, layers: int = 1, *, rate: float = 10, extra: str = SWEEP, noise: bool = True) -> str:
    block = fan(columns, layers)
    return sensor("lidar", block.replace("</lidar>", NOISE) if noise else block, rate=rate, pose=POSE, extra=extra)


def load(text: str, **options: Any) -> Any:
    sim = simkit.load(text, **options)
    for name, velocity in MOVES.items():
        if name in sim.models:
            launch(sim, name, *velocity)
    return sim


def stamp(message: Any) -> float:
    return float(message.header.stamp.sec + message.header.stamp.nanosec * 1e-9)


def bits(messages: list[Any]) -> list[tuple[float, bytes]]:
    return [(stamp(message), np.asarray(message.ranges).tobytes()) for message in messages]


MOVING = world(flyer(lidar()), WALL, CRATE, HAT)


def test_a_run_from_a_snapshot_in_mid_scan_repeats_the_bits() -> None:
    with load(MOVING) as sim:
        scans = sim.subscribe(sim.sensor("m::l::s").topic, keep=100)
        sim.run(0.25)
        snapshot = sim.snapshot()
        sim.run(0.3)
        first = bits(scans.messages)[2:]
        for _ in range(2):
            sim.restore(snapshot)
            before = len(scans.messages)
            sim.run(0.3)
            assert bits(scans.messages)[before:] == first
        assert len(first) == 3


def test_a_snapshot_in_bytes_continues_in_another_simulation() -> None:
    with load(MOVING) as sim, load(MOVING) as other:
        sim.run(0.25)
        snapshot = pickle.loads(pickle.dumps(sim.snapshot()))
        sim.run(0.1)
        other.restore(snapshot)
        other.run(0.1)
        assert bits([sim.sensor("m::l::s").latest]) == bits([other.sensor("m::l::s").latest])


def test_a_reset_in_mid_scan_repeats_the_bits() -> None:
    with simkit.load(MOVING) as sim:
        scans = sim.subscribe(sim.sensor("m::l::s").topic, keep=100)
        for name, velocity in MOVES.items():
            launch(sim, name, *velocity)
        sim.run(0.35)
        first = bits(scans.messages)
        sim.reset()
        before = len(scans.messages)
        for name, velocity in MOVES.items():
            launch(sim, name, *velocity)
        sim.run(0.35)
        assert bits(scans.messages)[before:] == first


def test_a_scan_without_readers_is_the_one_that_a_subscriber_gets() -> None:
    with load(MOVING) as sim, load(MOVING) as read:
        scans = read.subscribe(read.sensor("m::l::s").topic, keep=100)
        sim.run(0.33)
        for _ in range(33):
            read.run(0.01)
        assert bits([sim.sensor("m::l::s").latest]) == bits(scans.messages[-1:])
        assert np.array_equal(sim.sensor("m::l::s").truth.ranges, read.sensor("m::l::s").truth.ranges)


def test_a_snapshot_does_not_change_the_scan_that_it_interrupts() -> None:
    with load(MOVING) as sim, load(MOVING) as other:
        sim.run(0.3)
        other.run(0.15)
        other.snapshot()
        other.sensor("m::l::s").take_held()  # as before a change of the model: the scan is measured in parts
        other.run(0.15)
        assert bits([sim.sensor("m::l::s").latest]) == bits([other.sensor("m::l::s").latest])


def test_an_object_that_appears_or_disappears_in_mid_scan_is_seen_by_half_of_the_rays() -> None:
    ring = "".join(
        box(f"b{i}", f"{2 * math.cos(a)} {2 * math.sin(a)} 1 0 0 {a}", "0.2 2 8") for i, a in enumerate(ANGLES)
    )
    with simkit.load(world(flyer(lidar(72, noise=False)))) as sim:
        sim.run(0.15)
        sim.spawn(f'<sdf version="1.9"><model name="ring"><static>true</static>{_links(ring)}</model></sdf>')
        sim.run(0.06)
        seen = np.isfinite(sim.sensor("m::l::s").latest.ranges)
        assert not seen[:36].any()
        assert seen[37:].all()
        sim.run(0.04)
        sim.remove("ring")
        sim.run(0.06)
        seen = np.isfinite(sim.sensor("m::l::s").latest.ranges)
        assert seen[:36].all()
        assert not seen[37:].any()


def _links(boxes: str) -> str:
    """Return the links of static models as links of one model."""
    links = boxes.replace("<static>true</static>", "").split("<model name=")[1:]
    parts = []
    for number, text in enumerate(links):
        pose = text[text.index("<pose>") : text.index("</pose>") + 7]
        body = text[text.index('<link name="l">') + 15 : text.index("</link>")]
        parts.append(f'<link name="l{number}">{pose}{body}</link>')
    return "".join(parts)


@pytest.mark.parametrize("layers", [1, 60])
def test_a_lidar_at_rest_among_objects_at_rest_has_the_scan_of_one_instant(layers: int) -> None:
    plane = target("floor", "<plane><normal>0 0 1</normal></plane>", "0 0 0 0 0 0").replace(INERTIA, "")
    plane = plane.replace("<link", "<static>true</static><link")
    parts = (flyer(lidar(72, layers, noise=False)), WALL, CRATE, HAT, CAN, plane)
    with simkit.load(world(*parts)) as sim, simkit.load(world(*parts).replace(SWEEP, "")) as other:
        sim.run(0.25)
        other.run(0.15)
        swept, whole = (s.sensor("m::l::s") for s in (sim, other))
        assert stamp(swept.latest) == stamp(whole.latest)
        difference = swept._true_reading().ranges, whole._true_reading().ranges
        assert np.array_equal(np.isfinite(difference[0]), np.isfinite(difference[1]))
        near = np.isfinite(difference[0])
        assert near.mean() > 0.1
        assert np.abs(difference[0][near] - difference[1][near]).max() < 1e-6
        assert (swept.hits == whole.hits).mean() > 0.995
        assert swept.latest.time_increment > 0 == whole.latest.time_increment


@pytest.mark.skipif(not has_embree(), reason="embreex is not installed")
def test_the_engine_numpy_and_embree_measure_the_same_sweep(monkeypatch: pytest.MonkeyPatch) -> None:
    text = world(flyer(lidar(90, 3, noise=False)), WALL, CRATE, HAT, CAN)

    def ranges() -> np.ndarray[Any, Any]:
        with load(text) as sim:
            sim.run(0.22)
            found: np.ndarray[Any, Any] = sim.sensor("m::l::s")._true_reading().ranges
            return found

    few = ranges()
    monkeypatch.setattr(ray_fan, "MANY_RAYS", 1)
    many = ranges()
    monkeypatch.setattr(RayTargets, "has_embree", property(lambda self: False))
    whole = ranges()
    assert 0.2 < np.isfinite(few).mean() < 1
    for other in (many, whole):
        assert np.array_equal(np.isfinite(few), np.isfinite(other))
        near = np.isfinite(few)
        assert np.abs(few[near] - other[near]).max() < 1e-6


def test_a_lidar_on_a_static_link_sees_a_moving_box_at_the_time_of_each_ray() -> None:
    # a wall that moves by 1 m/s towards the sensor, whose rays ahead are 1 m/s · t shorter
    post = lidar(noise=False).replace(f"<pose>{POSE}</pose>", "")
    post = f'<model name="p"><static>true</static><pose>0 0 1 0 0 0</pose><link name="l">{post}</link></model>'
    wall = target("wall", "<box><size>0.2 40 40</size></box>", "5 0 1 0 0 0")
    with simkit.load(world(post, wall)) as sim:
        launch(sim, "wall", (-1, 0, 0), (0, 0, 0))
        sim.run(0.3)
        reading, swept = sim.sensor("p::l::s")._true_reading(), sim.sensor("p::l::s")
        start, ahead = stamp(swept.latest), np.isfinite(reading.ranges)
        depth = reading.ranges[ahead] * reading.sweep.directions[ahead, 0]
        assert ahead.sum() > 10
        assert np.abs(depth - (4.9 - start - swept.ray_times[ahead])).max() < 1e-9


def test_latency_jitter_and_phase_apply_to_a_sweep() -> None:
    extra = SWEEP + "<simkit:latency>0.03</simkit:latency><simkit:phase>0.02</simkit:phase>"
    with load(world(flyer(lidar(extra=extra)), WALL)) as sim:
        arrivals = []
        sim.subscribe(sim.sensor("m::l::s").topic, callback=lambda m: arrivals.append((sim.time, stamp(m))))
        sim.run(0.4)
    # the last of 36 rays is 97.2 ms after the first, in the step that ends at 98 ms
    assert np.allclose(arrivals, [(0.148, 0.02), (0.248, 0.12), (0.348, 0.22)])


def test_overlapping_sweeps_by_jitter_keep_their_order_and_times() -> None:
    extra = SWEEP + "<simkit:jitter>0.02</simkit:jitter>"
    with load(world(flyer(lidar(extra=extra)), WALL)) as sim:
        arrivals = []
        sim.subscribe(sim.sensor("m::l::s").topic, callback=lambda m: arrivals.append((sim.time, stamp(m))))
        sim.run(1.2)
    late = np.diff(np.array(arrivals), axis=1)
    assert len(arrivals) >= 10
    assert np.allclose(late, -0.098)


def test_a_changed_rate_changes_the_times_of_the_next_scan() -> None:
    with load(world(flyer(lidar()), WALL)) as sim:
        swept = sim.sensor("m::l::s")
        arrivals = []
        sim.subscribe(swept.topic, callback=lambda m: arrivals.append((sim.time, stamp(m), m.time_increment)))
        sim.run(0.15)
        swept.set_rate(20)
        sim.run(0.2)
    times = [(round(time, 3), round(at, 3)) for time, at, _ in arrivals]
    assert times[:3] == [(0.1, 0.002), (0.198, 0.1), (0.25, 0.2)]
    assert arrivals[2][2] == pytest.approx(0.05 / 36, rel=1e-6)
    with pytest.raises(simkit.InputError) as error, load(world(flyer(lidar()), WALL)) as sim:
        sim.sensor("m::l::s").set_rate(0)
    assert error.value.code == "SK-SENSOR-203"


def test_a_clockwise_scan_begins_with_the_largest_angle() -> None:
    clockwise = "<simkit:sweep><direction>clockwise</direction></simkit:sweep>"
    with load(world(flyer(lidar(extra=clockwise, noise=False)), WALL)) as sim, load(MOVING) as other:
        sim.run(0.25)
        other.run(0.1)
        scan, swept = sim.sensor("m::l::s").latest, sim.sensor("m::l::s")
        assert scan.angle_min > scan.angle_max
        assert scan.angle_increment < 0 < scan.time_increment
        assert np.array_equal(scan.ranges, swept._true_reading().ranges.astype(np.float32)[::-1])
        assert swept.ray_times[0] == pytest.approx(35 * scan.time_increment, rel=1e-6)


def test_firing_offsets_delay_the_layers() -> None:
    offsets = "<simkit:sweep><duration>0.05</duration><firing_offsets>0 0.001 0.002</firing_offsets></simkit:sweep>"
    with load(world(flyer(lidar(36, 3, extra=offsets, noise=False)), WALL, CRATE)) as sim:
        sim.run(0.2)
        swept = sim.sensor("m::l::s")
        times = swept.ray_times.reshape(3, 36)
        assert np.allclose(times[:, 0], [0, 0.001, 0.002])
        assert np.allclose(times[0], np.linspace(0, 0.05, 36))
        assert swept.latest.time_increment == pytest.approx(0.05 / 35)


@pytest.mark.parametrize(
    ("extra", "rate", "code"),
    [
        (SWEEP, 0, "SK-SENSOR-200"),
        ("<simkit:sweep><duration>0.2</duration></simkit:sweep>", 10, "SK-SENSOR-201"),
        ("<simkit:sweep><firing_offsets>-1</firing_offsets></simkit:sweep>", 10, "SK-SENSOR-202"),
    ],
)
def test_an_impossible_sweep_is_an_error_with_a_code(extra: str, rate: float, code: str) -> None:
    with pytest.raises(simkit.LoadError) as error:
        simkit.load(world(flyer(lidar(rate=rate, extra=extra))))
    assert code in str(error.value)


def test_the_element_inside_the_lidar_and_an_override_switch_the_sweep_on() -> None:
    inside = world(flyer(lidar(extra="").replace("<scan>", f"{SWEEP}<scan>")))
    with simkit.load(inside) as sim:
        assert sim.sensor("m::l::s").options.sweep is not None
    with simkit.load(world(flyer(lidar(extra=""))), overrides=["m::l::s.sweep=true"]) as sim:
        assert sim.sensor("m::l::s").options.sweep is not None
    with simkit.load(MOVING, overrides=["m::l::s.sweep=false"]) as sim:
        assert sim.sensor("m::l::s").options.sweep is None


def test_a_falling_and_tumbling_sensor_has_the_poses_of_each_tick() -> None:
    free = flyer(lidar(noise=False)).replace("<gravity>false</gravity>", "").replace("<iyy>0.1", "<iyy>0.15")
    with load(world(free, WALL)) as sim:
        positions = {}
        for tick in range(1, 130):
            sim.step()
            positions[tick] = sim.model("m").link("l").pose.position
        rows = sim.sensor("m::l::s")._true_reading().sweep.poses
        body = sim.sensor("m::l::s").body
        first = next(t for t, p in positions.items() if np.array_equal(p, rows.positions[0, body]))
        for i in range(len(rows.positions)):
            assert np.array_equal(rows.positions[i, body], positions[first + i])


def test_a_sweep_is_not_batched_and_the_message_says_so() -> None:
    with load(MOVING) as sim, pytest.raises(CannotBatchError, match="sweep of sensor 'm::l::s'"):
        sensor_rule(sim.sensor("m::l::s"))


@pytest.mark.parametrize("plugin", ["velodyne_laser", "block_laser"])
def test_clouds_of_plugins_arrive_after_the_last_ray(plugin: str) -> None:
    cloud = f'<plugin name="p" filename="libgazebo_ros_{plugin}.so"><topicName>/cloud</topicName></plugin>'
    text = sensor("ray", fan(40, 3, "ray"), rate=10, pose=POSE, extra=SWEEP + cloud)
    with load(world(flyer(text), WALL)) as sim:
        arrivals = []
        sim.subscribe("/cloud", callback=lambda m: arrivals.append((sim.time, stamp(m))))
        sim.run(0.25)
    assert np.allclose(arrivals, [(0.1, 0.002), (0.198, 0.1)])


def _spawned(integrator: str) -> Any:
    """Return the moving world in an MJCF world with an integrator."""
    sim = simkit.load(
        f'<mujoco><option timestep="0.002" gravity="0 0 0" integrator="{integrator}"/><worldbody/></mujoco>'
    )
    for part in (flyer(lidar(72, noise=False)), WALL, CRATE, HAT):
        sim.spawn(f'<sdf version="1.9">{part}</sdf>')
    for name, velocity in MOVES.items():
        launch(sim, name, *velocity)
    return sim


def test_a_sweep_with_the_integrator_rk4_has_the_ranges_of_another_integrator() -> None:
    # the bodies' velocities are constant, so that both integrators move them on the same ways
    with _spawned("RK4") as sim, _spawned("implicitfast") as other:
        assert sim.mj_model.opt.integrator != other.mj_model.opt.integrator
        sim.run(0.25)
        other.run(0.25)
        found, expected = (s.sensor("m::l::s")._true_reading().ranges for s in (sim, other))
        near = np.isfinite(expected)
        assert 0.2 < near.mean() < 1
        assert np.array_equal(np.isfinite(found), near)
        assert np.abs(found[near] - expected[near]).max() < 1e-5


def test_a_teleport_in_mid_scan_moves_the_rays_after_it() -> None:
    """The rays before the teleport start at the old place, those at least a step later at the new one."""
    walls = box("left", "0 6 1 0 0 0", "40 0.2 4") + box("right", "0 -6 1 0 0 0", "40 0.2 4")
    swept = flyer(lidar(72, noise=False).replace(f"<pose>{POSE}</pose>", ""))
    with simkit.load(world(swept, walls)) as sim:
        sim.run(0.15)  # the scan that began at 0.1 s is half done: it has covered the right side
        sim.model("m").set_pose(Pose((0, 2, 1)))
        sim.run(0.06)
        swept_by = sim.sensor("m::l::s")
        reading = swept_by._true_reading()
        seen = np.isfinite(reading.ranges)
        side = np.abs(np.where(seen, reading.ranges, 0.0) * reading.sweep.directions[:, 1])
        late = swept_by.ray_times > 0.05 + 1e-9
        early = swept_by.ray_times < 0.05 - 0.002
        assert (seen & early).sum() > 20
        assert (seen & late).sum() > 20
        assert side[seen & early] == pytest.approx(5.9, abs=1e-6)
        assert side[seen & late] == pytest.approx(3.9, abs=1e-6)


def test_a_sweep_hits_a_body_asleep_where_it_lies() -> None:
    floor = box("floor", "0 0 -0.1 0 0 0", "40 40 0.2")
    crate = target("crate", "<box><size>1 1 1</size></box>", "3 0 0.5 0 0 0").replace("<gravity>false</gravity>", "")
    parts = (flyer(lidar(72, noise=False).replace(f"<pose>{POSE}</pose>", ""), pose="0 0 0.5 0 0 0"), floor, crate)
    readings = []
    for sleeps in (True, False):
        with simkit.load(world(*parts), overrides=[f"physics.sleep={str(sleeps).lower()}"]) as sim:
            launch(sim, "m", (0.5, 0.3, 0.0), (0.0, 0.0, 0.4))
            sim.run(1.55)
            link = sim.model("crate").link("l")
            assert sim.engine.physics.sleep.is_asleep(link._body, sim.engine.physics.fresh()) == sleeps
            readings.append(sim.sensor("m::l::s")._true_reading().ranges)
    near = np.isfinite(readings[1])
    assert 2 < near.sum() < 36
    assert np.array_equal(np.isfinite(readings[0]), near)
    assert np.abs(readings[0][near] - readings[1][near]).max() < 1e-4
