"""Fans of many rays are cast by several threads, and each ray alone, so that the bits do not depend on the threads."""

from __future__ import annotations

import os
import pathlib
import subprocess
import sys
import threading
from typing import Any

import numpy as np
import pytest
import trimesh

import simkit
from simkit.sensors.rays import lidar_batch, ray_fan
from simkit.sensors.rays.embree_rays import has_embree
from simkit.sensors.rays.ray_fan import RayFan, fan_directions
from simkit.sensors.rays.ray_threads import RayThreads, ray_threads

GROUPS = (0, 3, 4, 5)
AZIMUTHS, ELEVATIONS = np.linspace(-3.1, 3.1, 900), np.linspace(-0.6, 0.4, 40)
INERTIAL = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"


def world() -> str:
    """Return a ground plane, static walls, moving balls of triangles and moving shapes around the origin."""
    shapes = {
        "mesh": "<mesh><uri>ball.stl</uri></mesh>",
        "box": "<box><size>0.7 0.4 0.5</size></box>",
        "can": "<cylinder><radius>0.3</radius><length>0.6</length></cylinder>",
        "egg": "<sphere><radius>0.4</radius></sphere>",
    }
    parts = []
    for i in range(16):
        kind = list(shapes)[i % 4]
        pose = f"{2.5 * np.cos(i):.3f} {2.5 * np.sin(i):.3f} {0.3 * np.sin(3 * i):.3f} {0.1 * i} 0.3 {0.4 * i}"
        parts.append(
            f'<model name="m{i}"><pose>{pose}</pose><link name="l"><gravity>false</gravity>{INERTIAL}'
            f'<collision name="c"><geometry>{shapes[kind]}</geometry></collision></link></model>'
        )
    for i in range(4):
        parts.append(
            f'<model name="w{i}"><static>true</static><pose>{4 * np.cos(i):.3f} {4 * np.sin(i):.3f} 0 0 0 {i}</pose>'
            f'<link name="l"><collision name="c"><geometry><box><size>0.2 3 2</size></box></geometry></collision>'
            "</link></model>"
        )
    plane = "<plane><normal>0 0 1</normal><size>20 20</size></plane>"
    parts.append(
        '<model name="g"><static>true</static><pose>0 0 -1 0 0 0</pose><link name="l">'
        f'<collision name="c"><geometry>{plane}</geometry></collision></link></model>'
    )
    return f'<sdf version="1.9"><world name="w">{"".join(parts)}</world></sdf>'


@pytest.fixture(autouse=True)
def small_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fans of a test are smaller than those for which threads are faster."""
    for module in (ray_fan, lidar_batch):
        monkeypatch.setattr(module, "RAYS_PER_THREAD", 1 << 12)


def cast(sim: simkit.Simulation, grid: Any, threads: int) -> tuple[bytes, bytes]:
    fan = RayFan(fan_directions(AZIMUTHS, ELEVATIONS), GROUPS, 30.0, grid=grid)
    fan.bind(sim.mj_model, sim.engine.names, 0, ())
    turn = np.array(((0.8, -0.6, 0.0), (0.6, 0.8, 0.0), (0.0, 0.0, 1.0)))
    with ray_threads.use(threads):
        fan.cast(sim.mj_model, sim.engine.physics.fresh(), np.array((0.1, 0.2, 0.3)), turn, 0.05)
    assert np.isfinite(fan.distances).mean() > 0.3
    assert len(set(fan.geoms.tolist())) > 15
    return fan.distances.tobytes(), fan.geoms.tobytes()


@pytest.mark.parametrize("grid", [None, (ELEVATIONS, AZIMUTHS)], ids=["directions", "grid"])
def test_the_bits_of_a_scan_do_not_depend_on_the_number_of_threads(grid: Any, tmp_path: pathlib.Path) -> None:
    trimesh.creation.icosphere(2, 0.4).export(tmp_path / "ball.stl")
    with simkit.load(world(), resource_paths=[str(tmp_path)]) as sim:
        alone = cast(sim, grid, 1)
        assert cast(sim, grid, 2) == alone
        assert cast(sim, grid, 4) == alone


@pytest.mark.skipif(not has_embree(), reason="embreex is not installed")
def test_a_grid_finds_the_rays_towards_moving_triangles_that_a_test_of_all_rays_finds(tmp_path: pathlib.Path) -> None:
    trimesh.creation.icosphere(2, 0.4).export(tmp_path / "ball.stl")
    with simkit.load(world(), resource_paths=[str(tmp_path)]) as sim:
        assert cast(sim, (ELEVATIONS, AZIMUTHS), 1) == cast(sim, None, 1)


LIDAR = """<sensor name="s" type="lidar"><update_rate>20</update_rate><lidar><scan><horizontal><samples>250</samples>
  <min_angle>-3</min_angle><max_angle>3</max_angle></horizontal><vertical><samples>12</samples><min_angle>-0.5</min_angle>
  <max_angle>0.4</max_angle></vertical></scan><range><min>0.1</min><max>20</max></range></lidar></sensor>"""


@pytest.mark.parametrize("threads", [1, 3])
def test_lidars_that_cast_together_have_the_bits_of_each_alone(
    threads: int, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    trimesh.creation.icosphere(2, 0.4).export(tmp_path / "ball.stl")
    text = world()
    for i in (0, 1, 4, 5, 8):  # balls of triangles and boxes carry a lidar
        text = text.replace(f'<model name="m{i}">', f'<model name="r{i}">')
        begin = text.index("<gravity>", text.index(f'<model name="r{i}">'))
        text = text[:begin] + LIDAR + text[begin:]
    with simkit.load(text, resource_paths=[str(tmp_path)]) as sim, ray_threads.use(threads):
        lidars = [sim.sensor(f"r{i}::l::s") for i in (0, 1, 4, 5, 8)]
        for lidar in lidars:
            sim.subscribe(lidar.topic)
        sim.run(0.0501)
        assert len({id(lidar.batch) for lidar in lidars}) == 1
        assert lidars[0].batch is not None
        jobs: list[int] = []
        run = ray_threads.run
        monkeypatch.setattr(ray_threads, "run", lambda parts: (jobs.append(len(parts)), run(parts)))
        lidars[0].batch.capture_all(lidars[0].computed_data())
        assert jobs == [threads]
        together = [lidar.batch.captured(lidar.batch_index) for lidar in lidars]
        for lidar, reading in zip(lidars, together, strict=True):
            alone = lidar.measure_now()
            assert 0.3 < np.isfinite(alone.ranges).mean() < 1.0
            assert reading.ranges.tobytes() == alone.ranges.tobytes()
            assert reading.hits.tobytes() == alone.hits.tobytes()


def test_the_error_of_a_job_reaches_the_caller() -> None:
    def fail() -> None:
        raise ValueError("job")

    done: list[int] = []
    with pytest.raises(ValueError, match="job"):
        RayThreads().run([lambda: done.append(1), fail])
    assert done == [1]


def test_an_error_of_the_first_job_is_raised_when_no_other_job_writes_any_more() -> None:
    began, may_end, done = threading.Event(), threading.Event(), []

    def slow() -> None:
        began.set()
        may_end.wait()
        done.append(1)

    def fail() -> None:
        began.wait()
        threading.Timer(0.01, may_end.set).start()
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        RayThreads().run([fail, slow])
    assert done == [1]


def test_rays_are_cast_while_the_interpreter_ends() -> None:
    program = """if True:
        import atexit
        from simkit.sensors.rays.ray_threads import RayThreads
        done = []
        def at_exit():
            RayThreads().run([lambda i=i: done.append(i) for i in range(3)])
            print(done)
        atexit.register(at_exit)
    """
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert (ended.stdout, ended.stderr) == ("[0, 1, 2]\n", "")


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the system has no fork")
def test_a_fork_starts_threads_of_its_own() -> None:
    threads, done = RayThreads(), [0, 0]

    def jobs() -> list[Any]:
        return [lambda i=i: done.__setitem__(i, os.getpid()) for i in range(2)]

    threads.run(jobs())
    child = os.fork()
    if not child:
        threads.run(jobs())
        os._exit(0 if done == [os.getpid()] * 2 else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
