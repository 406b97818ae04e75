"""Speed of simkit and of bare MuJoCo on the same compiled model, measured in turn and reported as medians."""

from __future__ import annotations

import functools
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from simkit import build
from simkit.cli.bench_bare_mujoco import BareCamera, BareEngine, HandWrittenLoop, cast_bare_scan
from simkit.plugins import WorldPlugin
from simkit.run_spec import RunSpec
from simkit.runtime.engine.scheduler import Phase
from simkit.sensors.cameras.rendered_camera import RenderedCamera
from simkit.sensors.cameras.renderer_choice import GL, chosen_renderer
from simkit.sensors.rays.lidar import Lidar

if TYPE_CHECKING:
    from simkit.runtime import Simulation, Subscription
    from simkit.sensors.base import Sensor

_CHUNK = 500  # steps per round
_CAMERAS = frozenset({"sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo", "sensor_msgs/msg/PointCloud2"})


@dataclass(frozen=True)
class Figure:
    """Comparison of two times [s].

    Attributes:
        name, unit: name of the comparison, and the unit of both times (a step or a sample).
        ours, bare: median time of one unit; `bare` is None if there is no counterpart in MuJoCo.
        aim: target for the highest ratio, or None.
        most: target for the longest time, or None.
    """

    name: str
    unit: str
    ours: float
    bare: float | None = None
    aim: float | None = None
    most: float | None = None

    @property
    def ratio(self) -> float | None:
        return None if not self.bare else self.ours / self.bare


class EveryStepPlugin(WorldPlugin):
    """Minimal plugin that is called after every step."""

    def load(self, parent: object, params: object) -> None:
        self.calls = 0

    def after_step(self) -> None:
        self.calls += 1


def time_interleaved(
    sides: Sequence[Callable[[], object]], rounds: int, clock: Callable[[], float] = time.process_time
) -> list[float]:
    """Return the median time of one call of each side [s].

    The functions are timed in turn, so that a busy machine slows all of them alike.

    Args:
        sides: functions to time.
        rounds: number of timings of each function.
        clock: clock to read; default: CPU time of all threads.
    """
    durations: list[list[float]] = [[] for _ in sides]
    for side in sides:
        side()
    for _ in range(rounds):
        for side, times in zip(sides, durations, strict=True):
            start = clock()
            side()
            times.append(clock() - start)
    return [statistics.median(times) for times in durations]


def compare_with_bare_mujoco(spec: RunSpec, *, rounds: int = 9, what: str = "all") -> Iterator[Figure]:
    """Yield each figure of a world as soon as it is measured.

    Args:
        spec: world and load options; the comparison chooses the durations.
        rounds: number of timings of each side.
        what: "steps", "sensors" or "all".
    """

    def load(*plugins: WorldPlugin) -> Simulation:
        return build.load(spec.world, **replace(spec, plugins=plugins).load_arguments())

    if what != "sensors":
        yield from _step_figures(load, rounds)
    if what != "steps":
        with load() as sim:
            sim.run(1.0)
            for sensor in sim.contents.sensors.values():
                if sensor.topic:
                    yield compare_sensor(sim, sensor, rounds)


def _step_figures(load: Callable[..., Simulation], rounds: int) -> Iterator[Figure]:
    with load() as sim:
        yield compare_stepping(sim, rounds)
    plugin = EveryStepPlugin()
    with load(plugin) as sim:
        _schedule_only(sim, None, sim.engine.faults.task(plugin, "after_step"), "after")
        yield _compare_step(sim, rounds, "step, only a Python plugin after each", 1.20)
    with load() as sim:
        imu = next((s for s in sim.contents.sensors.values() if s.kind == "imu" and s.topic), None)
        if imu:
            _schedule_only(sim, imu.update_rate, imu.sample, "sense")
            latest = sim.communication.bus.subscribe(imu.topic, keep=1)
            yield _compare_step(sim, rounds, f"step, only an imu at {imu.update_rate:g} Hz, looked at later", 1.10)
            latest.close()
            sim.communication.bus.tap(imu.topic, _ignore_message)
            yield _compare_step(sim, rounds, f"step, only an imu at {imu.update_rate:g} Hz, each message made", 1.10)
    for how in ("looked at later", "each message made"):
        with load() as sim:
            kinds = [s for s in sim.contents.sensors.values() if s.topic and (s.kind == "imu" or isinstance(s, Lidar))]
            if len(kinds) > 1:
                yield compare_motion_and_scans(sim, {s.topic for s in kinds}, rounds, how)
    with load() as sim:
        yield compare_all_readings(sim, rounds)


def measure_import_time(rounds: int) -> float:
    """Measure the time that `import simkit` adds to the start of an interpreter [s], wall time."""
    # import the same copy of simkit as this process
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    durations: dict[str, list[float]] = {"pass": [], "import simkit": []}
    for _ in range(rounds):
        for statement, times in durations.items():
            start = time.perf_counter()
            subprocess.run([sys.executable, "-P", "-c", statement], check=True, env=environment)
            times.append(time.perf_counter() - start)
    empty, ours = (statistics.median(times) for times in durations.values())
    return ours - empty


def measure_memory_growth(sim: Simulation, duration: float) -> float:
    """Measure the memory growth of the process [bytes per simulated second] with all topics read except images.

    The first half of the duration is not counted: caches fill up in it.
    """
    _count_messages(sim, _topics_without_images(sim))
    sim.run(duration / 2)
    before = _resident_memory()
    sim.run(duration / 2)
    return (_resident_memory() - before) / (duration / 2)


def _topics_without_images(sim: Simulation) -> set[str]:
    """Return the topics that need no rendering. Bounding boxes of a camera, for example, need rendering."""
    drawn = {t for s in sim.contents.sensors.values() if isinstance(s, RenderedCamera) for t in s.topics.values()}
    return {topic for topic, type_name in sim.communication.bus.topics().items() if type_name not in _CAMERAS} - drawn


def compare_stepping(sim: Simulation, rounds: int) -> Figure:
    """Compare steps without due plugins and sensors with `mj_step` on a copy of the same model and state."""
    sim.step(100)
    sim.engine.scheduler.clear()
    sim.engine.scheduler.rewind(sim.tick)
    return _compare_step(sim, rounds, "step, nothing due", 1.05)


def _schedule_only(sim: Simulation, rate: float | None, task: Callable[[int], None], phase: Phase) -> None:
    """Remove all tasks of the simulation except `task`."""
    sim.engine.scheduler.clear()
    sim.engine.scheduler.every(rate, task, phase)
    sim.engine.scheduler.rewind(sim.tick)


def _compare_step(sim: Simulation, rounds: int, name: str, aim: float) -> Figure:
    sim.step(100)
    bare = BareEngine(sim)
    ours, theirs = time_interleaved([lambda: sim.step(_CHUNK), lambda: bare.step(_CHUNK)], rounds)
    return Figure(name, "step", ours / _CHUNK, theirs / _CHUNK, aim)


def compare_motion_and_scans(sim: Simulation, topics: set[str], rounds: int, how: str) -> Figure:
    """Compare the world with its plugins, IMUs and lidars with a hand-written loop that takes only these readings.

    Args:
        sim: simulation to time.
        topics: topics of the IMUs and lidars.
        rounds: number of timings of each side.
        how: "looked at later" queues the newest message of each topic; "each message made" calls back with every one.
    """
    name = f"step, all plugins, imu and lidar read, {how}"
    if how == "looked at later":
        for topic in topics:
            sim.communication.bus.subscribe(topic, keep=1)
    return _compare_hand_written(sim, topics, rounds, name, 1 / 0.9, keeps_counting=how != "looked at later")


def compare_all_readings(sim: Simulation, rounds: int) -> Figure:
    """Compare the world with its plugins and all topics except images with a hand-written loop of the same readings."""
    topics = _topics_without_images(sim)
    return _compare_hand_written(sim, topics, rounds, "step, all plugins, all sensors read but images", 1 / 0.85)


def _compare_hand_written(
    sim: Simulation, topics: set[str], rounds: int, name: str, aim: float, *, keeps_counting: bool = True
) -> Figure:
    """Compare a simulation with a hand-written loop.

    The messages of each topic are counted to determine its period. With `keeps_counting`, the counting continues while
    the loop is timed.
    """
    second = round(1.0 / sim.timestep)
    sim.step(second)  # skip the first sample: all sensors publish it at tick 1
    counts, taps = _count_messages(sim, topics)
    sim.step(second)
    periods = {topic: max(1, round(second / n)) for topic, n in counts.items() if n > 1}
    if not keeps_counting:
        for tap in taps:
            tap.close()
    bare = HandWrittenLoop(sim, periods)
    ours, theirs = time_interleaved([lambda: sim.step(second), lambda: bare.step(second)], rounds)
    return Figure(name, "step", ours / second, theirs / second, aim)


def compare_sensor(sim: Simulation, sensor: Sensor, rounds: int) -> Figure:
    """Compare one sample of a sensor, including its message, with bare MuJoCo on up-to-date data.

    A scan is compared with its bare rays, an image of OpenGL with one bare rendering pass. Images have no noise here,
    and point clouds are not built.
    """
    topics = [t for p, t in sensor.topics.items() if sensor.product_type(p) != "sensor_msgs/msg/PointCloud2"]
    taps = [sim.communication.bus.tap(topic, _ignore_message) for topic in topics]
    sim.engine.physics.fresh_accelerations()
    name, aim = f"{sensor.kind} {sensor.scoped}", None
    bare: Callable[[], object] | None = None
    one_pass: BareCamera | None = None
    count = 200
    if isinstance(sensor, RenderedCamera):
        count = 5
        vars(sensor)["perturb"] = lambda reading, _index: reading  # for this sensor only
        is_colour = len(sensor.shots()) == 1 and not sensor.shots()[0].ids
        if is_colour and chosen_renderer(sim) == GL:
            one_pass, aim = BareCamera(sim, sensor), 1.15
        name += ", no noise"
    elif isinstance(sensor, Lidar):
        bare, aim = cast_bare_scan(sensor, sim.mj_model, sim.mj_data), 1.15
    tick = sim.tick

    def sample_all() -> None:
        for _ in range(count):
            sensor.sample(tick)

    sides: list[Callable[[], object]] = [sample_all]
    if one_pass is not None:
        bare = functools.partial(one_pass.draw_many, count)
        sides.append(bare)
    elif bare is not None:
        cast = bare
        sides.append(lambda: [cast() for _ in range(count)])
    times = time_interleaved(sides, max(3, rounds))
    if one_pass is not None:
        one_pass.free()
    for tap in taps:
        tap.close()
    most = 12e-6 if sensor.kind == "imu" else None
    return Figure(name, "sample", times[0] / count, times[1] / count if bare is not None else None, aim, most)


def _count_messages(sim: Simulation, topics: set[str]) -> tuple[dict[str, int], list[Subscription]]:
    """Subscribe to topics; return the numbers of their messages, by topic, and the subscriptions."""
    counts: dict[str, int] = {}

    def count(topic: str) -> Callable[[object], None]:
        def increment(_: object) -> None:
            counts[topic] = counts.get(topic, 0) + 1

        return increment

    return counts, [sim.communication.bus.tap(topic, count(topic)) for topic in sorted(topics)]


def _ignore_message(_: object) -> None:
    return None


def _resident_memory() -> int:
    """Return the memory that this process uses now [bytes]; without /proc, an estimate from Python's memory blocks."""
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, AttributeError):  # Windows has neither the file nor `sysconf`
        return sys.getallocatedblocks() * 64
