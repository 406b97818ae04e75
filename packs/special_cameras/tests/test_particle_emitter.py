"""Particle emitters: places, commands, images, echoes, reset and restore."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit
from simkit.recording.pictures.subject import find_subject
from simkit.runtime.particle_clouds import ParticleCloud, ParticleSource

COMMAND = "/model/fire/link/l/particle_emitter/smoke/cmd"
LIDAR = """<sensor name="lidar" type="{kind}"><update_rate>10</update_rate><topic>scan</topic><lidar><scan><horizontal>
<samples>201</samples><min_angle>-0.1</min_angle><max_angle>0.1</max_angle></horizontal></scan>
<range><min>0.1</min><max>30</max></range></lidar></sensor>"""
CAMERA = """<sensor name="eye" type="{kind}"><update_rate>10</update_rate><topic>eye</topic><camera>
<horizontal_fov>0.4</horizontal_fov><image><width>64</width><height>48</height></image></camera></sensor>"""
WALL = """<model name="wall"><static>true</static><pose>5 0 1 0 0 0</pose><link name="l">
<collision name="c"><geometry><box><size>0.2 9 9</size></box></geometry></collision>
<visual name="v"><geometry><box><size>0.2 9 9</size></box></geometry>
<material><ambient>0 0 1 1</ambient><diffuse>0 0 1 1</diffuse></material></visual></link></model>"""


def world(emitter: str = "", kind: str = "box", sensor: str = "", place: str = "0 0 1 0 0 0", link: str = "") -> str:
    """Return a world with an emitter, a sensor 4 m behind it that looks along x, and a wall 4.9 m before it."""
    return f"""<sdf version="1.9"><world name="w">
<physics name="p" type="ode"><max_step_size>0.01</max_step_size></physics>
<gravity>0 0 0</gravity><light name="sun" type="directional"><direction>1 0.3 -1</direction></light>
<model name="robot"><static>true</static><pose>-4 0 1 0 0 0</pose><link name="l">{sensor}</link></model>
<model name="fire"><pose>{place}</pose><link name="l">{link}
<particle_emitter name="smoke" type="{kind}">{emitter}</particle_emitter></link></model>{WALL}</world></sdf>"""


def cloud(sim: simkit.Simulation) -> ParticleCloud | None:
    sources = [p for p in sim.engine.structure.all_plugins() if isinstance(p, ParticleSource)]
    return sources[0].cloud_at(sim.time)


STILL = "<min_velocity>0</min_velocity><max_velocity>0</max_velocity><lifetime>2</lifetime><rate>50</rate>"


def test_particles_appear_at_the_rate_and_end_after_their_lifetime() -> None:
    with simkit.load(world("<rate>20</rate><lifetime>2</lifetime>")) as sim:
        sim.run(1.0)
        assert len(cloud(sim).radii) == pytest.approx(20, abs=1)
        sim.run(4.0)
        assert len(cloud(sim).radii) == pytest.approx(40, abs=1)


@pytest.mark.parametrize("kind", ["point", "box", "cylinder", "ellipsoid"])
def test_particles_begin_inside_the_shape(kind: str) -> None:
    with simkit.load(world(f"{STILL}<size>2 4 1</size>", kind)) as sim:
        sim.run(2.0)
        along, across, up = (cloud(sim).positions - (0, 0, 1)).T
    if kind == "point":
        assert not (along.any() or across.any() or up.any())
        return
    assert abs(along).max() == pytest.approx(0.5, abs=0.1 if kind != "ellipsoid" else 0.2)
    assert abs(across).max() == pytest.approx(1.0, abs=0.2)
    assert abs(up).max() == pytest.approx(2.0, abs=0.4)
    if kind == "cylinder":
        assert (across**2 + (up / 2) ** 2).max() <= 1.0
    if kind == "ellipsoid":
        assert (across**2 + (up / 2) ** 2 + (along / 0.5) ** 2).max() <= 1.0 + 1e-9


def test_particles_move_along_the_x_axis_of_the_emitter_and_grow() -> None:
    upwards = "<pose>0 0 0 0 -1.5707963267948966 0</pose><min_velocity>1</min_velocity><max_velocity>1</max_velocity>"
    with simkit.load(
        world(f"{upwards}<rate>1</rate><particle_size>.2 .4 1</particle_size><scale_rate>0.1</scale_rate>", "point")
    ) as sim:
        sim.run(3.0)
        particles = cloud(sim)
        assert particles.positions[0] == pytest.approx([0, 0, 1 + 2.0], abs=1e-9)  # born at 1 s
        assert 2 * particles.radii[0] == pytest.approx(0.3 + 0.1 * 2.0)


def test_particles_of_a_moving_link_stay_where_they_began() -> None:
    mass = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
    with simkit.load(world(f"{STILL}", "point", link=mass)) as sim:
        sim.model("fire").set_velocity((0.0, 1.0, 0.0), (0.0, 0.0, 0.0))
        sim.run(1.0)
        y = cloud(sim).positions[:, 1]
        assert y.min() < 0.05 and y.max() == pytest.approx(1.0, abs=0.05)


def test_commands_switch_and_change_the_emission() -> None:
    with simkit.load(world("<rate>10</rate><lifetime>1</lifetime>")) as sim:
        sim.publish(COMMAND, {"data": False})
        sim.run(2.0)
        assert cloud(sim) is None
        parameters = [{"name": "rate", "value": {"type": 3, "double_value": 40.0}}]
        parameters.append({"name": "emitting", "value": {"type": 1, "bool_value": True}})
        sim.publish(COMMAND, {"params": parameters})
        sim.run(2.0)
        assert len(cloud(sim).radii) == pytest.approx(40, abs=1)


def test_an_unknown_parameter_of_a_command_is_reported() -> None:
    with simkit.load(world()) as sim:
        sim.publish(COMMAND, {"params": [{"name": "rat", "value": {"type": 3, "double_value": 40.0}}]})
        sim.run(0.1)
        assert any(d.code == "SK-PLUGIN-041" and "'rat'" in d.message for d in sim.diagnostics)


def test_the_emission_ends_after_its_duration() -> None:
    with simkit.load(world("<duration>1</duration><rate>10</rate><lifetime>1.5</lifetime>")) as sim:
        sim.run(2.0)
        assert 0 < len(cloud(sim).radii) <= 10
        sim.run(2.0)
        assert cloud(sim) is None


def test_a_rendered_lidar_has_echoes_of_the_scatter_ratio_and_never_behind_the_wall() -> None:
    dense = f"{STILL}<size>1 1 1</size><particle_scatter_ratio>0.4</particle_scatter_ratio>"
    with simkit.load(world(dense, sensor=LIDAR.format(kind="gpu_lidar"))) as sim:
        ranges = []
        for _ in range(20):
            sim.run(0.1)
            ranges.append(np.asarray(sim.sensor("robot::l::lidar").latest.ranges))
        late = np.array(ranges[10:])
    assert np.mean(late < 8.8) == pytest.approx(0.4, abs=0.05)
    assert late.max() <= 8.95 and late.min() > 3.0


def test_a_lidar_that_detects_collisions_has_no_echoes() -> None:
    with simkit.load(world(f"{STILL}<size>1 1 1</size>", sensor=LIDAR.format(kind="lidar"))) as sim:
        sim.run(2.0)
        assert np.asarray(sim.sensor("robot::l::lidar").latest.ranges).min() > 8.8


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["rgbd_camera", "depth_camera"])
def test_a_depth_camera_has_echoes(kind: str) -> None:
    with simkit.load(world(f"{STILL}<size>1 1 1</size>", sensor=CAMERA.format(kind=kind))) as sim:
        topic = "/eye/depth_image" if kind == "rgbd_camera" else "/eye"
        images = sim.subscribe(topic, keep=1)
        sim.run(2.0)
        depths = simkit.msgs.image(images.latest)
    assert depths.min() > 3.0
    assert np.mean(depths[20:28, 28:36] < 8.8) == pytest.approx(0.65, abs=0.2)


def test_a_camera_shows_particles() -> None:
    red = "<material><diffuse>1 0 0 1</diffuse></material>"
    with simkit.load(world(f"{STILL}{red}<emitting>false</emitting>", sensor=CAMERA.format(kind="camera"))) as sim:
        images = sim.subscribe("/eye", keep=1)
        sim.run(0.1)
        before = simkit.msgs.image(images.latest).astype(int)[24, 32]
        sim.publish(COMMAND, {"data": True})
        sim.run(2.0)
        after = simkit.msgs.image(images.latest).astype(int)[24, 32]
    assert before[2] > before[0]
    assert after[0] > after[2] + 50


def test_a_picture_of_smoke_alone_frames_the_smoke() -> None:
    smoke = f'<particle_emitter name="smoke" type="box">{STILL}</particle_emitter>'
    model = f'<model name="fire"><static>true</static><pose>20 20 1 0 0 0</pose><link name="l">{smoke}</link></model>'
    with simkit.load(f'<sdf version="1.9"><world name="w">{model}</world></sdf>') as sim:
        sim.run(2.0)
        points = find_subject(sim, []).points
        assert points.mean(axis=0) == pytest.approx([20, 20, 1], abs=0.3)


def test_reset_and_restore_repeat_the_particles() -> None:
    with simkit.load(world(sensor=LIDAR.format(kind="gpu_lidar")), seed=3) as sim:
        sim.run(1.0)
        snapshot = sim.snapshot()
        sim.run(1.0)
        first, scan = cloud(sim), np.asarray(sim.sensor("robot::l::lidar").latest.ranges)
        sim.restore(snapshot)
        sim.run(1.0)
        np.testing.assert_array_equal(cloud(sim).positions, first.positions)
        np.testing.assert_array_equal(np.asarray(sim.sensor("robot::l::lidar").latest.ranges), scan)
        sim.reset()
        assert cloud(sim) is None
        sim.run(2.0)
        np.testing.assert_array_equal(cloud(sim).positions, first.positions)
        np.testing.assert_array_equal(np.asarray(sim.sensor("robot::l::lidar").latest.ranges), scan)


def test_the_marker_has_all_particles() -> None:
    with simkit.load(world("<rate>10</rate>")) as sim:
        markers = sim.subscribe(COMMAND.replace("/cmd", "/particles"), keep=1)
        sim.run(2.0)
        assert len(markers.latest.points) == len(cloud(sim).radii)
        assert markers.latest.header.frame_id == "w"


def test_the_system_of_gazebo_is_a_note() -> None:
    system = '<plugin filename="gz-sim-particle-emitter-system" name="gz::sim::systems::ParticleEmitter"/>'
    material = (
        "<material><specular>1 0 0</specular><pbr><metal><albedo_map>fog.png</albedo_map></metal></pbr></material>"
    )
    with simkit.load(world(material).replace("<gravity>", f"{system}<gravity>")) as sim:
        assert {d.severity for d in sim.diagnostics} == {"note"}


def test_an_emitter_is_not_moved_by_a_nan_command() -> None:
    with simkit.load(world()) as sim:
        sim.publish(COMMAND, {"params": [{"name": "rate", "value": {"type": 3, "double_value": math.nan}}]})
        sim.run(0.5)
        assert len(cloud(sim).radii) == pytest.approx(5, abs=1)
