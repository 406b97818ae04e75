"""Pictures: beside raw passes, mujoco.Renderer and PyBullet; the whole loop beside one by hand; noise; recording.

python benchmarks/cameras.py [--rounds N]

Bare times are of the tightest code that reads the same. Where the render thread is on, wall time counts, else CPU time
of all threads.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

os.environ.setdefault("MUJOCO_GL", "egl")  # mujoco.Renderer asks for a display otherwise

import mujoco
import numpy as np
from measure import arguments, report

import simkit
from simkit import msgs
from simkit.cli.bench_bare_mujoco import BareCamera, HandWrittenLoop
from simkit.cli.bench_figures import Figure, time_interleaved
from simkit.compiler.geom_groups import VISUAL
from simkit.recording.bags.recorder import Recorder
from simkit.sensors.cameras.rendered_camera import RenderedCamera
from simkit.sensors.cameras.rendering.view import aim

EYE = "turtlebot3::camera_rgb_frame::camera"
PLAIN = """<sdf version="1.9"><model name="plain"><static>true</static><link name="l">
  <sensor name="camera" type="camera"><update_rate>30</update_rate><camera><horizontal_fov>1.05</horizontal_fov>
  <image><width>{0}</width><height>{1}</height></image><clip><near>0.05</near><far>10</far></clip>
  <noise><type>gaussian</type><mean>0</mean><stddev>0.007</stddev></noise></camera></sensor></link></model></sdf>"""
_PICTURES = 5  # of each side at a time


def eye_of(sim: Any) -> RenderedCamera:
    found: RenderedCamera = sim.sensor(EYE)
    return found


@contextlib.contextmanager
def without_noise(eye: RenderedCamera) -> Iterator[None]:
    """While it lasts, a sample's reading is its truth."""
    eye.perturb = lambda reading, index: reading  # type: ignore[method-assign]
    try:
        yield
    finally:
        del eye.perturb


def single(size: tuple[int, int], rounds: int, *, depth: bool) -> Iterator[Figure]:
    """A sample with its messages, without noise and with it, beside a raw pass: the robot's camera, or a plain one."""
    with simkit.load("turtlebot3_world", render_thread=False) as sim:
        if not depth:
            sim.spawn(PLAIN.format(*size), pose=eye_of(sim).pose)
        sim.run(0.5)
        eye = eye_of(sim) if depth else sim.sensor("plain::l::camera")
        sim.engine.physics.fresh_accelerations()
        for product, topic in eye._topics.items():
            if product == "image" or (depth and product == "depth_image"):
                sim.communication.bus.tap(topic, _ignore)
        bare = BareCamera(sim, eye)

        def clean() -> None:
            with without_noise(eye):
                noisy()

        def noisy() -> None:
            for _ in range(_PICTURES):
                eye.sample(sim.tick)

        ours, with_noise, theirs = time_interleaved([clean, noisy, lambda: bare.draw_many(_PICTURES)], rounds)
        name = f"{'RGB-D' if depth else 'colour'} {size[0]}x{size[1]}, no noise"
        yield Figure(name, "picture", ours / _PICTURES, theirs / _PICTURES, 1.15)
        share = 1.25 if depth else 1.15
        yield Figure(f"{name}: with noise beside without", "picture", with_noise / _PICTURES, ours / _PICTURES, share)
        bare.free()


def beside_mujoco(rounds: int) -> Figure:
    """Colour and depth by `mujoco.Renderer`, called twice as its documentation does."""
    with simkit.load("turtlebot3_world", render_thread=False) as sim:
        sim.run(0.5)
        eye = eye_of(sim)
        model, data, view = sim.mj_model, sim.engine.physics.fresh(), eye.shots()[0].view
        taps = [sim.communication.bus.tap(eye._topics[product], _ignore) for product in ("image", "depth_image")]
        option, sides = mujoco.MjvOption(), mujoco.MjvCamera()
        option.geomgroup[:] = 0
        option.geomgroup[VISUAL] = 1
        model.vis.global_.offwidth, model.vis.global_.offheight = view.width, view.height
        with mujoco.Renderer(model, view.height, view.width) as theirs:

            def twice() -> Any:
                found = []
                for is_depth in (False, True):
                    (theirs.enable_depth_rendering if is_depth else theirs.disable_depth_rendering)()
                    theirs.update_scene(data, sides, option)
                    aim(theirs.scene, *eye._frame_in_world(data), view)
                    found.append(theirs.render())
                return found

            def ours() -> None:
                for _ in range(_PICTURES):
                    eye.sample(sim.tick)

            with without_noise(eye):
                times = time_interleaved([ours, twice], rounds)
        del taps
    return Figure("RGB-D 640x480, beside mujoco.Renderer twice", "picture", times[0] / _PICTURES, times[1], 0.125)


def whole_loop(rounds: int) -> Iterator[Figure]:
    """IMU 200 Hz, lidar 5 Hz, RGB-D 30 Hz, with noise: a simulated second, and every message of it looked at."""
    for is_on, aim_, clock in ((False, 1 / 0.9, time.process_time), (True, 1 / 1.3, time.perf_counter)):
        with simkit.load("turtlebot3_world", render_thread=is_on) as sim:
            sensors = [
                s for s in sim.contents.sensors.values() if s.kind in ("imu", "lidar") or isinstance(s, RenderedCamera)
            ]
            topics = [s.topic for s in sensors]
            topics.append(eye_of(sim)._topics["depth_image"])
            second = round(1.0 / sim.timestep)
            sim.step(second)
            bare = HandWrittenLoop(sim, {s.topic: round(second / s.update_rate) for s in sensors})

            def ours(sim: Any = sim, topics: list[str] = topics, second: int = second) -> None:
                subs = [sim.subscribe(topic) for topic in topics]
                sim.step(second)
                for sub in subs:
                    assert len(sub.messages) > 3
                    sub.close()

            def theirs(bare: HandWrittenLoop = bare, second: int = second) -> None:
                bare.step(second)

            times = time_interleaved([ours, theirs], rounds, clock)
            how = "with the render thread, wall time" if is_on else "on one thread"
            yield Figure(f"loop of imu, lidar, RGB-D, {how}", "second", *times, aim_)


def messages(rounds: int) -> Figure:
    """Making and serialising all messages of a simulated second, beside the whole loop."""
    with simkit.load("turtlebot3_world", render_thread=False) as sim:
        sensors = [
            s for s in sim.contents.sensors.values() if s.kind in ("imu", "lidar") or isinstance(s, RenderedCamera)
        ]
        topics = [s.topic for s in sensors] + [eye_of(sim)._topics["depth_image"]]
        sim.step(1000)
        made: list[Any] = []
        taps = [sim.communication.bus.tap(topic, made.append) for topic in topics]
        seconds = []
        for _ in range(rounds):
            made.clear()
            start = time.process_time()
            sim.step(1000)
            seconds.append(time.process_time() - start)
        again = {s: (s._products, s._sample) for s in sensors}

        def make() -> None:
            for sensor, (products, sample) in again.items():
                count = round(sensor.update_rate)
                is_eye = isinstance(sensor, RenderedCamera)
                names = ("image", "depth_image") if is_eye else (next(iter(sensor._topics)),)
                for _ in range(count):
                    for name in names:
                        msgs.serialize(products[name].make(sample.noisy, sample.time_ns))

        (took,) = time_interleaved([make], rounds)
        del taps
    return Figure("messages and CDR of that, of the loop", "second", took, float(np.median(seconds)), 0.05)


def recording(rounds: int) -> Iterator[Figure]:
    """A simulated second of RGB-D at 30 Hz to MCAP, with and without the render thread, beside real time."""
    for is_on in (False, True):
        with simkit.load("turtlebot3_world", render_thread=is_on) as sim, tempfile.TemporaryDirectory() as folder:
            eye = eye_of(sim)
            topics = [eye._topics[product] for product in ("image", "depth_image")]
            sim.run(0.2)
            with Recorder(sim, Path(folder) / "x.mcap", topics=topics):
                (took,) = time_interleaved([lambda sim=sim: sim.run(1.0)], rounds, time.perf_counter)
            size = (Path(folder) / "x.mcap").stat().st_size / (rounds + 1) / 1e6
            how = "with the render thread" if is_on else "on one thread"
            yield Figure(f"recording RGB-D at 30 Hz, {how}, {size:.0f} MB", "second", took, 1.0, 1.0)


def beside_pybullet(rounds: int) -> Figure | None:
    """The same picture of the same shapes by PyBullet's renderer in software."""
    try:
        import pybullet
    except ImportError:
        print("pybullet is not installed: its figure is left out")
        return None
    with simkit.load("turtlebot3_world", render_thread=False) as sim:
        sim.run(0.5)
        eye, data = eye_of(sim), sim.engine.physics.fresh()
        client = pybullet.connect(pybullet.DIRECT)
        _copy_visuals(pybullet, sim.mj_model, data)
        view = eye.shots()[0].view
        place, turn = eye._frame_in_world(data)
        seen = pybullet.computeViewMatrix(place.tolist(), (place + turn[:, 0]).tolist(), turn[:, 2].tolist())
        edges = [float(e) * 0.05 for e in (view.left, view.right, view.bottom, view.top)]
        through = pybullet.computeProjectionMatrix(*edges, 0.05, eye.options.model.far)
        taps = [sim.communication.bus.tap(eye._topics[product], _ignore) for product in ("image", "depth_image")]

        def theirs() -> Any:
            return pybullet.getCameraImage(
                view.width, view.height, seen, through, renderer=pybullet.ER_TINY_RENDERER,
                shadow=0, flags=pybullet.ER_NO_SEGMENTATION_MASK,
            )  # fmt: skip

        def ours() -> None:
            for _ in range(_PICTURES):
                eye.sample(sim.tick)

        _compare(theirs(), eye.measure(sim.mj_model, data), 0.05, eye.options.model.far)
        with without_noise(eye):
            times = time_interleaved([ours, theirs], rounds)
        pybullet.disconnect(client)
        del taps
    return Figure("RGB-D 640x480, beside PyBullet's", "picture", times[0] / _PICTURES, times[1], 0.125)


def _copy_visuals(pybullet: Any, model: Any, data: Any) -> None:
    """Visuals of the compiled model, each a body of PyBullet's."""
    for geom in np.flatnonzero(model.geom_group == VISUAL).tolist():
        kind, (x, y, z) = int(model.geom_type[geom]), model.geom_size[geom].tolist()
        colour = model.geom_rgba[geom].tolist()
        shapes: dict[int, Callable[[], dict[str, Any]]] = {
            0: lambda: {"shapeType": pybullet.GEOM_BOX, "halfExtents": (20, 20, 1e-4)},
            2: lambda: {"shapeType": pybullet.GEOM_SPHERE, "radius": x},  # noqa: B023
            5: lambda: {"shapeType": pybullet.GEOM_CYLINDER, "radius": x, "length": 2 * y},  # noqa: B023
            6: lambda: {"shapeType": pybullet.GEOM_BOX, "halfExtents": (x, y, z)},  # noqa: B023
            7: lambda: {"shapeType": pybullet.GEOM_MESH, **_mesh(model, int(model.geom_dataid[geom]))},  # noqa: B023
        }
        shape = pybullet.createVisualShape(rgbaColor=colour, **shapes[kind]())
        quaternion = np.empty(4)
        mujoco.mju_mat2Quat(quaternion, data.geom_xmat[geom])
        w, i, j, k = quaternion.tolist()
        place = data.geom_xpos[geom].tolist()
        pybullet.createMultiBody(0, -1, shape, basePosition=place, baseOrientation=(i, j, k, w))


def _mesh(model: Any, mesh: int) -> dict[str, Any]:
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    start, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    return {
        "vertices": model.mesh_vert[first : first + count].tolist(),
        "indices": model.mesh_face[start : start + faces].ravel().tolist(),
    }


def _compare(theirs: Any, ours: Any, near: float, far: float) -> None:
    """Says how far PyBullet's depths are from ours, so that it is known that the same is drawn."""
    buffer = np.asarray(theirs[3], dtype=np.float64).reshape(ours.depths.shape)
    depths = far * near / (far - (far - near) * buffer)
    both = np.isfinite(ours.depths) & (buffer < 1)
    print(f"PyBullet's depths: median difference {np.median(np.abs(depths[both] - ours.depths[both])) * 1e3:.1f} mm")


def _ignore(_: Any) -> None:
    return None


def main() -> None:
    rounds = arguments(__doc__, rounds=9).rounds
    report(single((640, 480), rounds, depth=True))
    report(single((640, 480), rounds, depth=False))
    report(single((1920, 1080), rounds, depth=False))
    report([beside_mujoco(rounds)])
    report(whole_loop(rounds))
    report([messages(rounds)])
    report(recording(max(2, rounds // 3)))
    figure = beside_pybullet(rounds)
    if figure is not None:
        report([figure])


if __name__ == "__main__":
    main()
