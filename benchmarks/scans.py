"""Lidar scans: beside `mj_multiRay` on the same rays, near meshes, among moving bodies, and beside PyBullet.

Rays beside Embree: the ranges of a lidar (distances in float64, geoms), and `run` of the binding embreex alone with the
same rays on the same triangles, which lie in one scene at their present poses. Both in millions of rays per second.

python benchmarks/scans.py [--rounds N]
"""

from __future__ import annotations

import itertools
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import trimesh
from measure import arguments, report

import simkit
from simkit.cli.bench_bare_mujoco import cast_bare_scan
from simkit.cli.bench_figures import Figure, compare_sensor, time_interleaved

LAYERS, COLUMNS = 64, 1024
TURTLEBOT = "turtlebot3::base_scan::lds"
_LIDAR = f"""<model name="m"><static>true</static><pose>0.1 0.2 2 0 0 0</pose><link name="l">
<sensor name="s" type="{{kind}}"><update_rate>10</update_rate><lidar><scan>
<horizontal><samples>{COLUMNS}</samples><min_angle>-3.1416</min_angle><max_angle>3.1416</max_angle></horizontal>
<vertical><samples>{LAYERS}</samples><min_angle>-0.4</min_angle><max_angle>0.4</max_angle></vertical></scan>
<range><min>0.1</min><max>60</max></range><noise type="gaussian"><stddev>0.01</stddev></noise></lidar></sensor></link>
</model>"""


def terrain(cells: int, bumps: float, folder: Path) -> Path:
    """A surface of 2·cells² triangles, 40 m wide, smooth or with `bumps` [m] at every corner."""
    along = np.linspace(-20, 20, cells + 1)
    x, y = np.meshgrid(along, along)
    z = 0.5 + 0.3 * np.sin(x) * np.cos(y) + np.random.default_rng(0).uniform(0, bumps, x.shape)
    corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    right, above, across = corner + 1, corner + cells + 1, corner + cells + 2
    faces = np.vstack((np.column_stack((corner, right, across)), np.column_stack((corner, across, above))))
    path = folder / f"terrain_{cells}_{bumps:g}.stl"
    trimesh.Trimesh(np.column_stack((x.ravel(), y.ravel(), z.ravel())), faces, process=False).export(path)
    return path


def world(mesh: Path, kind: str, moving: int) -> str:
    """The terrain, a dense lidar 1.5 m above it, and boxes that move."""
    shape = f"<geometry><mesh><uri>{mesh}</uri></mesh></geometry>"
    box = "<geometry><box><size>0.5 0.5 0.5</size></box></geometry>"
    boxes = "".join(
        f'<model name="b{i}"><pose>{2 + i % 5} {i // 5 - 2} 2 0 0 0.3</pose><link name="l"><gravity>false</gravity>'
        f'<collision name="c">{box}</collision><visual name="v">{box}</visual></link></model>'
        for i in range(moving)
    )
    ground = f'<link name="l"><collision name="c">{shape}</collision><visual name="v">{shape}</visual></link>'
    return f"""<sdf version="1.9"><world name="w"><model name="ground"><static>true</static>{ground}</model>
      {_LIDAR.format(kind=kind)}{boxes}</world></sdf>"""


def dense(folder: Path, rounds: int) -> Iterator[Figure]:
    """64 x 1024 rays: the ranges alone, and all of a sample with noise and cloud, beside the bare rays."""
    for cells, bumps in ((224, 0.0), (316, 0.0), (224, 0.3)):
        mesh = terrain(cells, bumps, folder)
        name = f"64 x 1024 rays, {2 * cells**2 // 1000}k triangles, {'rough' if bumps else 'smooth'}"
        (alone, sample, bare), (among, _, _) = (timed(world(mesh, "lidar", n), folder, rounds) for n in (0, 20))
        yield Figure(f"{name}: ranges", "sample", alone, bare, 0.05)
        yield Figure(f"{name}: with noise and cloud", "sample", sample, bare, 0.05)
        yield Figure(f"{name}: ranges, 20 boxes, beside none", "sample", among, alone, 1.5)


def timed(text: str, folder: Path, rounds: int) -> list[float]:
    """Ranges alone, a whole sample with its cloud, and the bare rays [s]."""
    with simkit.load(text, resource_paths=[str(folder)]) as sim:
        sim.run(0.05)
        sensor = sim.sensor("m::l::s")
        data, bare = sim.engine.physics.fresh(), cast_bare_scan(sensor, sim.mj_model, sim.mj_data)
        sim.communication.bus.tap(sensor.topic + "/points", lambda _: None)
        sides = [lambda: sensor.measure(sim.mj_model, data), lambda: sensor.sample(sim.tick), bare]
        return time_interleaved(sides, rounds)


def beside_embree(folder: Path, rounds: int) -> None:
    """Ranges of many rays near a large mesh and among moving bodies, beside the bare ray tracer on its triangles."""
    from simkit.sensors.rays.ray_threads import ray_threads

    trimesh.creation.icosphere(3, 0.3).export(folder / "ball.stl")
    box, ball = "<box><size>0.5 0.5 0.5</size></box>", f"<mesh><uri>{folder / 'ball.stl'}</uri></mesh>"
    print(
        "triangles       rays moving |  million rays/s a core: embreex, simkit, ratio |  two threads: by the clock, CPU"
    )
    for (cells, bumps), (layers, columns), moving in itertools.product(
        ((224, 0.0), (316, 0.3)), ((16, 1024), (64, 1024), (64, 1800)), ("none", "boxes", "meshes")
    ):
        text = world(terrain(cells, bumps, folder), "lidar", 0 if moving == "none" else 20)
        text = text.replace(box, ball) if moving == "meshes" else text
        text = text.replace(f"<samples>{LAYERS}<", f"<samples>{layers}<").replace(
            f"<samples>{COLUMNS}<", f"<samples>{columns}<"
        )
        with simkit.load(text, resource_paths=[str(folder)]) as sim:
            sim.run(0.05)
            sensor, data = sim.sensor("m::l::s"), sim.engine.physics.fresh()
            frame = sensor.ray_frame(data)

            def cast(threads: int) -> None:
                with ray_threads.use(threads):
                    sensor.fan.cast(sim.mj_model, data, *frame, sensor._start)  # noqa: B023

            sides = [bare_embree(sensor, data), lambda: cast(1), lambda: cast(2)]
            bare, ours, both = time_interleaved(sides, 3 * rounds)
            (wall,) = time_interleaved(sides[2:], rounds, time.perf_counter)
            millions = layers * columns / 1e6
            print(
                f"{2 * cells**2 // 1000:>7}k {millions * 1e6:>10.0f} {moving:>6} | {millions / bare:>25.2f} "
                f"{millions / ours:>7.2f} {bare / ours:>6.2f} | {millions / wall:>10.2f} {both / ours:>6.2f}",
                flush=True,
            )


def many_lidars(folder: Path, rounds: int) -> None:
    """Scans of the lidars of a fleet on a large mesh, beside the bare ray tracer with the same rays in one scene."""
    trimesh.creation.icosphere(2, 0.3).export(folder / "ball.stl")
    print("lidars      rays | million rays/s: embreex, simkit, ratio |   [µs a lidar: embreex, simkit]")
    for (layers, columns), count in itertools.product(((1, 360), (16, 1024)), (10, 50, 100)):
        text = fleet(terrain(224, 0.0, folder), folder, layers, columns, count)
        with simkit.load(text, resource_paths=[str(folder)]) as sim:
            sim.run(0.05)
            lidars, data = [sim.sensor(f"r{i}::l::s") for i in range(count)], sim.engine.physics.fresh()
            bare = [bare_embree(lidar, data) for lidar in lidars[:1]]  # all lidars see nearly the same triangles
            for lidar in lidars:
                sim.communication.bus.tap(lidar.topic, lambda _: None)

            def scan() -> None:
                batch = lidars[0].batch  # noqa: B023
                if batch is None:
                    for lidar in lidars:  # noqa: B023
                        lidar.measure(sim.mj_model, data)  # noqa: B023
                else:
                    batch.capture_all(data)  # noqa: B023

            theirs, ours = time_interleaved([bare[0], scan], rounds)
            theirs, millions = theirs * count, layers * columns * count / 1e6
            print(
                f"{count:>6} {layers:>4}x{columns:<4} | {millions / theirs:>23.2f} {millions / ours:>7.2f} "
                f"{theirs / ours:>6.2f} | {theirs / count * 1e6:>20.0f} {ours / count * 1e6:>8.0f}",
                flush=True,
            )


def fleet(mesh: Path, folder: Path, layers: int, columns: int, count: int) -> str:
    """Robots with a body of triangles and a lidar, in rows above a terrain."""
    ground = f"<geometry><mesh><uri>{mesh}</uri></mesh></geometry>"
    ball = f"<geometry><mesh><uri>{folder / 'ball.stl'}</uri></mesh></geometry>"
    vertical = f"<vertical><samples>{layers}</samples><min_angle>-0.4</min_angle><max_angle>0.4</max_angle></vertical>"
    horizontal = f"<samples>{columns}</samples><min_angle>-3.1416</min_angle><max_angle>3.1416</max_angle>"
    scan = f"<horizontal>{horizontal}</horizontal>{vertical if layers > 1 else ''}"
    lidar = (
        f'<sensor name="s" type="lidar"><update_rate>10</update_rate><lidar><scan>{scan}</scan>'
        "<range><min>0.1</min><max>60</max></range></lidar></sensor>"
    )
    robots = "".join(
        f'<model name="r{i}"><pose>{1.5 * (i % 10) - 7} {1.5 * (i // 10) - 7} 1.6 0 0 0.3</pose><link name="l">'
        f'<gravity>false</gravity><collision name="c">{ball}</collision>{lidar}</link></model>'
        for i in range(count)
    )
    return (
        f'<sdf version="1.9"><world name="w"><model name="ground"><static>true</static><link name="l">'
        f'<collision name="c">{ground}</collision></link></model>{robots}</world></sdf>'
    )


def bare_embree(sensor: Any, data: Any) -> Callable[[], object]:
    """Return a function that casts the rays of a lidar with embreex alone, in one scene of all that they can hit."""
    from embreex.mesh_construction import TriangleMesh
    from embreex.rtcore_scene import EmbreeScene

    from simkit.sensors.rays.embree_rays import triangles_of

    model, vertices, faces, count = sensor.fan.targets.model, [], [], 0
    for geom in sensor.fan.targets.geoms.tolist():
        corners, triangles = triangles_of(model, geom)
        body = model.geom_bodyid[geom]
        vertices.append(corners @ data.xmat[body].reshape(3, 3).T + data.xpos[body])
        faces.append(triangles + count)
        count += len(corners)
    scene = EmbreeScene(robust=True)
    TriangleMesh(scene, np.concatenate(vertices).astype(np.float32), np.concatenate(faces).astype(np.int32))
    origin, rotation = sensor.ray_frame(data)
    directions = np.ascontiguousarray((sensor.fan.directions @ rotation.T).astype(np.float32))
    origins = np.ascontiguousarray(np.broadcast_to(origin.astype(np.float32), directions.shape))
    return lambda: scene.run(origins, directions)


def accuracy() -> float:
    """Greatest error of a range [m] on a ball 100 m away and 30 m wide, near its middle: analytic."""
    lidar = """<lidar><scan><horizontal><samples>65</samples><min_angle>-0.1</min_angle><max_angle>0.1</max_angle>
      </horizontal><vertical><samples>64</samples><min_angle>-0.1</min_angle><max_angle>0.1</max_angle></vertical></scan>
      <range><min>0.1</min><max>200</max></range></lidar>"""
    ball = '<collision name="c"><geometry><sphere><radius>15</radius></sphere></geometry></collision>'
    text = f"""<sdf version="1.9"><world name="w"><model name="m"><static>true</static><link name="l">
      <sensor name="s" type="lidar"><update_rate>10</update_rate>{lidar}</sensor></link></model>
      <model name="ball"><static>true</static><pose>100 0 0 0 0 0</pose><link name="l">{ball}</link></model>
      </world></sdf>"""
    with simkit.load(text) as sim:
        sim.run(0.01)
        sensor = sim.sensor("m::l::s")
        found = sensor.measure(sim.mj_model, sim.engine.physics.fresh()).ranges
        along = 100 * sensor._directions[:, 0]
        exact = along - np.sqrt(np.maximum(15**2 - (100**2 - along**2), 0))
        return float(np.abs(found - exact).max())


def beside_pybullet(rounds: int) -> Figure | None:
    """The planar scan of the TurtleBot3 world, message and noise included, beside `rayTestBatch` on the same shapes."""
    try:
        import pybullet
    except ImportError:
        print("pybullet is not installed: its figure is left out")
        return None
    with simkit.load("turtlebot3_world") as sim:
        sim.run(1.0)
        sensor = sim.sensor(TURTLEBOT)
        sim.communication.bus.tap(sensor.topic, lambda _: None)
        data = sim.engine.physics.fresh()
        client = pybullet.connect(pybullet.DIRECT)
        _copy_shapes(pybullet, sim.mj_model, data, sensor._body)
        place, turn = sensor._frame_in_world(data)
        ways = sensor._directions @ turn.T
        options = sensor.options
        starts, ends = (place + options.range_min * ways).tolist(), (place + options.range_max * ways).tolist()
        theirs = pybullet.rayTestBatch(starts, ends)
        length = options.range_max - options.range_min
        hit = np.array([t[2] for t in theirs])
        found = np.where(hit < 1.0, options.range_min + hit * length, np.inf)
        ours = sensor.measure(sim.mj_model, data).ranges
        both = np.isfinite(found) & np.isfinite(ours)
        worst = np.abs(found[both] - ours[both]).max()
        print(f"PyBullet's scan is the same within {worst:.1e} m")
        times = time_interleaved(
            [
                lambda: [sensor.sample(sim.tick) for _ in range(100)],
                lambda: [pybullet.rayTestBatch(starts, ends) for _ in range(10)],
            ],
            rounds,
        )
        pybullet.disconnect(client)
    return Figure("a scan of 360 rays, beside PyBullet's", "sample", times[0] / 100, times[1] / 10, 0.1)


def _copy_shapes(pybullet: Any, model: Any, data: Any, own_body: int) -> None:
    """Collisions of the compiled model but the lidar's own, each a body of PyBullet's."""
    from simkit.compiler.geom_groups import COLLISION

    for geom in np.flatnonzero(model.geom_group == COLLISION).tolist():
        if model.geom_bodyid[geom] == own_body:
            continue
        kind, (x, y, z) = int(model.geom_type[geom]), model.geom_size[geom].tolist()
        shape = {
            0: lambda: pybullet.createCollisionShape(pybullet.GEOM_PLANE),
            2: lambda: pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=x),  # noqa: B023
            5: lambda: pybullet.createCollisionShape(pybullet.GEOM_CYLINDER, radius=x, height=2 * y),  # noqa: B023
            6: lambda: pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=(x, y, z)),  # noqa: B023
        }[kind]()
        quaternion = np.empty(4)
        mujoco.mju_mat2Quat(quaternion, data.geom_xmat[geom])
        w, i, j, k = quaternion.tolist()
        pybullet.createMultiBody(0, shape, basePosition=data.geom_xpos[geom].tolist(), baseOrientation=(i, j, k, w))


def main() -> None:
    rounds = arguments(__doc__, rounds=9).rounds
    with simkit.load("turtlebot3_world") as sim:
        sim.run(1.0)
        report([compare_sensor(sim, sim.sensor(TURTLEBOT), 5 * rounds)])
    figure = beside_pybullet(rounds)
    if figure is not None:
        report([figure])
    with tempfile.TemporaryDirectory() as folder:
        report(dense(Path(folder), rounds))
        beside_embree(Path(folder), rounds)
        many_lidars(Path(folder), rounds)
    error = accuracy()
    print(f"greatest error on a ball 100 m away: {error:.1e} m   aim <= 1e-3")


if __name__ == "__main__":
    main()
