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

_CHUNK = 500  # steps a round
_CAMERAS = frozenset({"sensor_msgs/msg/Image"})
_SCANS = frozenset({"ray", "gpu_ray", "lidar", "gpu_lidar"})


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


def measure(source: str, *, rounds: int = 9, resource_paths: Sequence[Any] = (), plugin_paths: Sequence[Any] = ()) -> Iterator[Figure]:
    """Each figure of a world as soon as it is known."""

    def load() -> Any:
        return build.load(source, resource_paths=resource_paths, plugin_paths=plugin_paths)

    with load() as sim:
        yield stepping(sim, rounds)
    with load() as sim:
        yield everything_read(sim, rounds)
    for name in _sensor_names(load):
        with load() as read, load() as unread:
            figure = sensor_cost(read, unread, name, rounds)
            if figure is not None:
                yield figure


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


def sensor_cost(read: Any, unread: Any, name: str, rounds: int) -> Figure | None:
    """What reading one sensor adds, a reading; a planar scan beside `mj_multiRay` with as many rays."""
    sensor = read.sensor(name)
    for output in sensor.outputs:
        read.bus.tap(output.topic, _ignore)
    period = read.timestep if sensor.update_rate <= 0 else 1.0 / sensor.update_rate
    readings = max(1, min(20, round(1.0 / period)))
    ticks = max(1, round(readings * period / read.timestep))
    sides: list[Callable[[], object]] = [lambda: read.step(ticks), lambda: unread.step(ticks)]
    rays = _bare_scan(read, sensor) if sensor.kind in _SCANS else None
    if rays is not None:
        sides.append(lambda: [rays() for _ in range(readings)])
    times = interleaved(sides, max(3, rounds // 2))
    bare = times[2] / readings if rays is not None else None
    return Figure(f"{sensor.kind} {name}", "reading", max(times[0] - times[1], 0.0) / readings, bare)


class Bare:
    """The same model and state in the engine alone."""

    def __init__(self, sim: Any) -> None:
        self.model = copy.copy(sim.mj_model)
        self.data = copy.copy(sim.mj_data)

    def step(self, count: int) -> None:
        mujoco.mj_step(self.model, self.data, count)


def _bare_scan(sim: Any, sensor: Any) -> Callable[[], None] | None:
    """The engine's own scan of as many rays from the same place."""
    message = sensor.latest
    if message is None:
        sim.run(1.0)
        message = sensor.latest
    if message is None or not hasattr(message, "ranges"):
        return None
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


def _sensor_names(load: Callable[[], Any]) -> list[str]:
    with load() as sim:
        return list(sim.sensors)


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
