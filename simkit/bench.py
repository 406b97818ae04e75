"""Speed beside bare MuJoCo on the same compiled model: both sides in turn, medians of each."""

from __future__ import annotations

import copy
import statistics
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from simkit import build
from simkit.compiler import groups
from simkit.sensors import gl

_CHUNK = 500  # steps a round
_APART = 5  # steps between two readings of a sensor
_CAMERAS = frozenset({"sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo", "sensor_msgs/msg/PointCloud2"})


@dataclass(frozen=True)
class Figure:
    """One comparison; times in seconds.

    Attributes:
        ours, bare: median time of one unit; `bare` is None where there is nothing to compare with.
    """

    name: str
    unit: str
    ours: float
    bare: float | None = None

    @property
    def ratio(self) -> float | None:
        return None if not self.bare else self.ours / self.bare


def interleaved(sides: Sequence[Callable[[], object]], rounds: int) -> list[float]:
    """Median CPU time of one call of each side [s]; the sides alternate, so that a busy machine hits all alike."""
    taken: list[list[float]] = [[] for _ in sides]
    for side in sides:
        side()
    for _ in range(rounds):
        for side, times in zip(sides, taken, strict=True):
            start = time.process_time()
            side()
            times.append(time.process_time() - start)
    return [statistics.median(times) for times in taken]


def measure(
    source: str, *, rounds: int = 9, resource_paths: Sequence[Any] = (), plugin_paths: Sequence[Any] = ()
) -> Iterator[Figure]:
    """Each figure of a world as soon as it is known."""

    def load() -> Any:
        return build.load(source, resource_paths=resource_paths, plugin_paths=plugin_paths)

    with load() as sim:
        yield stepping(sim, rounds)
    with load() as sim:
        yield everything_read(sim, rounds)
    with load() as read, load() as unread:
        for sim in (read, unread):
            sim.run(1.0)
        for sensor in read.sensors.values():
            if sensor.topic:
                yield sensor_cost(read, unread, sensor, rounds)


def memory_growth(sim: Any, duration: float) -> float:
    """Bytes a simulated second adds to the process; the first half is left to settle."""
    sim.run(duration / 2)
    before = _resident()
    sim.run(duration / 2)
    return (_resident() - before) / (duration / 2)


def stepping(sim: Any, rounds: int) -> Figure:
    """Steps with nothing due beside `mj_step` on a copy of the same model and state."""
    sim.step(100)
    sim.scheduler.clear()
    sim.scheduler.rewind(sim.tick)
    bare = Bare(sim)
    ours, theirs = interleaved([lambda: sim.step(_CHUNK), lambda: bare.step(_CHUNK)], rounds)
    return Figure("step, nothing due", "step", ours / _CHUNK, theirs / _CHUNK)


def everything_read(sim: Any, rounds: int) -> Figure:
    """The world with its plugins and every sensor that needs no renderer read, beside `mj_step`."""
    for topic, type_name in sim.topics().items():
        if type_name not in _CAMERAS:
            sim.bus.tap(topic, _ignore)
    sim.step(100)
    bare = Bare(sim)
    ours, theirs = interleaved([lambda: sim.step(_CHUNK), lambda: bare.step(_CHUNK)], rounds)
    return Figure("step, all plugins, all sensors read but images", "step", ours / _CHUNK, theirs / _CHUNK)


def sensor_cost(read: Any, unread: Any, sensor: Any, rounds: int) -> Figure:
    """What reading one sensor adds, a reading; a scan beside as many bare rays, a picture beside one bare pass.

    Args:
        read: where the sensor is read while this lasts.
        unread: the same world, in which nobody reads anything.
        sensor: of `read`.
        rounds: timings of each side.
    """
    tap = read.bus.tap(sensor.topic, _ignore)
    rate = sensor.update_rate
    # Readings close together: at a sensor's own rate the difference would drown in that of the steps between.
    for sim in (read, unread):
        sim.sensor(sensor.scoped).set_rate(1.0 / (_APART * sim.timestep))
    readings = 10 if read.topics()[sensor.topic] in _CAMERAS else 50
    ticks = readings * _APART
    sides: list[Callable[[], object]] = [lambda: read.step(ticks), lambda: unread.step(ticks)]
    bare = _bare_reading(read, sensor)
    if bare is not None:
        sides.append(lambda: [bare() for _ in range(readings)])
    times = interleaved(sides, max(3, rounds // 2))
    tap.close()
    for sim in (read, unread):
        sim.sensor(sensor.scoped).set_rate(rate)
    return Figure(
        f"{sensor.kind} {sensor.scoped}",
        "reading",
        max(times[0] - times[1], 0.0) / readings,
        times[2] / readings if bare is not None else None,
    )


class Bare:
    """The same model and state in the engine alone."""

    def __init__(self, sim: Any) -> None:
        self.model = copy.copy(sim.mj_model)
        self.data = copy.copy(sim.mj_data)

    def step(self, count: int) -> None:
        mujoco.mj_step(self.model, self.data, count)


def _bare_reading(sim: Any, sensor: Any) -> Callable[[], None] | None:
    message = sensor.latest
    if hasattr(message, "ranges"):
        return _bare_scan(sim, sensor, message)
    if hasattr(message, "encoding"):
        return _bare_pass(sim, message.width, message.height)
    return None


def _bare_scan(sim: Any, sensor: Any, message: Any) -> Callable[[], None]:
    """The engine's own scan of as many rays from the same place."""
    count = len(message.ranges)
    pose = sensor.pose
    angles = message.angle_min + np.arange(count) * message.angle_increment
    local = np.stack((np.cos(angles), np.sin(angles), np.zeros(count)), axis=1)
    directions = np.ascontiguousarray(local @ pose.matrix.T).reshape(-1)
    start = np.array(pose.position)
    shown = (groups.VISUAL,) if sensor.kind.startswith("gpu") else (groups.COLLISION, groups.COLLISION_RAY)
    seen = np.array([1 if g in shown else 0 for g in range(6)], np.uint8)
    ids, distances = np.zeros(count, np.int32), np.zeros(count)
    model, data = sim.mj_model, sim.mj_data

    def scan() -> None:
        mujoco.mj_multiRay(model, data, start, directions, seen, 1, -1, ids, distances, None, count, message.range_max)

    return scan


def _bare_pass(sim: Any, width: int, height: int) -> Callable[[], None]:
    """One picture of the engine's own, colour and depth read together, without shadows and multisampling."""
    model, data = copy.copy(sim.mj_model), sim.mj_data
    model.vis.quality.offsamples = 0
    model.vis.global_.offwidth, model.vis.global_.offheight = width, height
    rectangle = mujoco.MjrRect(0, 0, width, height)
    colours, depths = np.empty((height, width, 3), np.uint8), np.empty((height, width), np.float32)
    scene, camera, option = mujoco.MjvScene(model, model.ngeom + 100), mujoco.MjvCamera(), mujoco.MjvOption()
    scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
    every = int(mujoco.mjtCatBit.mjCAT_ALL)
    with gl.current():
        context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)

    def draw() -> None:
        with gl.current():
            mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, context)
            mujoco.mjv_updateScene(model, data, option, None, camera, every, scene)
            mujoco.mjr_render(rectangle, scene, context)
            mujoco.mjr_readPixels(colours, depths, rectangle, context)

    return draw


def _ignore(_: Any) -> None:
    return None


def _resident() -> int:
    """Memory of this process in use now [B]; the highest so far where the system does not say."""
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            pages = int(file.read().split()[1])
        import resource

        return pages * resource.getpagesize()
    except OSError:
        import resource

        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
