"""Measure the speed of simkit and of bare MuJoCo on the same compiled model, in turn; report medians."""

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
from simkit.sensors.rays.lidar import Lidar

if TYPE_CHECKING:
    from simkit.runtime import Simulation, Subscription
    from simkit.sensors.base import Sensor

_CHUNK = 500  # steps a round
_CAMERAS = frozenset({"sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo", "sensor_msgs/msg/PointCloud2"})


@dataclass(frozen=True)
class Figure:
    """Comparison of two times [s].

    Attributes:
        ours, bare: median time of one unit; `bare` is None where there is nothing to compare with.
        aim: highest ratio aimed at, or None.
        most: longest time aimed at, or None.
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
    """The least that a plugin can do: it is called after every step."""

    def load(self, parent: object, params: object) -> None:
        self.calls = 0

    def after_step(self) -> None:
        self.calls += 1


def time_interleaved(
    sides: Sequence[Callable[[], object]], rounds: int, clock: Callable[[], float] = time.process_time
) -> list[float]:
    """Median time of one call of each side [s]; the sides alternate, so that a busy machine hits all alike.

    Args:
        sides: what is timed.
        rounds: how often.
        clock: CPU time of all threads by default.
    """
    taken: list[list[float]] = [[] for _ in sides]
    for side in sides:
        side()
    for _ in range(rounds):
        for side, times in zip(sides, taken, strict=True):
            start = clock()
            side()
            times.append(clock() - start)
    return [statistics.median(times) for times in taken]


def compare_with_bare_mujoco(spec: RunSpec, *, rounds: int = 9, what: str = "all") -> Iterator[Figure]:
    """Yield each figure of a world as soon as it is known.

    Args:
        spec: the world and how it is loaded; the figures decide what is run.
        rounds: timings of each side.
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
    """Measure what `import simkit` adds to a fresh interpreter [s], wall time."""
    # the same simkit as this one, wherever it was imported from
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    taken: dict[str, list[float]] = {"pass": [], "import simkit": []}
    for _ in range(rounds):
        for statement, times in taken.items():
            start = time.perf_counter()
            subprocess.run([sys.executable, "-c", statement], check=True, env=environment)
            times.append(time.perf_counter() - start)
    empty, ours = (statistics.median(times) for times in taken.values())
    return ours - empty


def measure_memory_growth(sim: Simulation, duration: float) -> float:
    """Bytes a simulated second adds to the process with all but images read; the first half is left to settle."""
    _count_messages(sim, _topics_without_images(sim))
    sim.run(duration / 2)
    before = _resident_memory()
    sim.run(duration / 2)
    return (_resident_memory() - before) / (duration / 2)


def _topics_without_images(sim: Simulation) -> set[str]:
    """The topics for which nothing is drawn; boxes around what is seen are for example not among them."""
    drawn = {t for s in sim.contents.sensors.values() if isinstance(s, RenderedCamera) for t in s._topics.values()}
    return {topic for topic, type_name in sim.topics().items() if type_name not in _CAMERAS} - drawn


def compare_stepping(sim: Simulation, rounds: int) -> Figure:
    """Steps with nothing due beside `mj_step` on a copy of the same model and state."""
    sim.step(100)
    sim.engine.scheduler.clear()
    sim.engine.scheduler.rewind(sim.tick)
    return _compare_step(sim, rounds, "step, nothing due", 1.05)


def _schedule_only(sim: Simulation, rate: float | None, task: Callable[[int], None], phase: Phase) -> None:
    """Nothing but `task` is due in this simulation from now on."""
    sim.engine.scheduler.clear()
    sim.engine.scheduler.every(rate, task, phase)
    sim.engine.scheduler.rewind(sim.tick)


def _compare_step(sim: Simulation, rounds: int, name: str, aim: float) -> Figure:
    sim.step(100)
    bare = BareEngine(sim)
    ours, theirs = time_interleaved([lambda: sim.step(_CHUNK), lambda: bare.step(_CHUNK)], rounds)
    return Figure(name, "step", ours / _CHUNK, theirs / _CHUNK, aim)


def compare_motion_and_scans(sim: Simulation, topics: set[str], rounds: int, how: str) -> Figure:
    """The world with its plugins, IMUs and lidars read, beside a hand-written loop that takes these readings alone.

    Args:
        topics: of the sensors.
        how: "looked at later" keeps the newest message of each, "each message made" is called back with it.
    """
    name = f"step, all plugins, imu and lidar read, {how}"
    if how == "looked at later":
        for topic in topics:
            sim.communication.bus.subscribe(topic, keep=1)
    return _compare_hand_written(sim, topics, rounds, name, 1 / 0.9, keeps_counting=how != "looked at later")


def compare_all_readings(sim: Simulation, rounds: int) -> Figure:
    """The world with its plugins and every topic but images read, beside a hand-written loop of the same readings."""
    topics = _topics_without_images(sim)
    return _compare_hand_written(sim, topics, rounds, "step, all plugins, all sensors read but images", 1 / 0.85)


def _compare_hand_written(
    sim: Simulation, topics: set[str], rounds: int, name: str, aim: float, *, keeps_counting: bool = True
) -> Figure:
    """Each topic's messages are counted to learn its period; where asked for, that goes on while it is timed."""
    second = round(1.0 / sim.timestep)
    sim.step(second)  # the first sample of all comes early
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
    """A whole sample with its message, of data that are up to date; a scan beside its bare rays, a picture beside one
    bare pass. Pictures are without noise, and clouds are not made."""
    clouds = [p for p, product in sensor._products.items() if product.type_name == "sensor_msgs/msg/PointCloud2"]
    taps = [sim.communication.bus.tap(t, _ignore_message) for p, t in sensor._topics.items() if p not in clouds]
    sim.engine.physics.fresh_accelerations()
    name, aim = f"{sensor.kind} {sensor.scoped}", None
    bare: Callable[[], object] | None = None
    one_pass: BareCamera | None = None
    count = 200
    if isinstance(sensor, RenderedCamera):
        count = 5
        vars(sensor)["perturb"] = lambda reading, _index: reading  # of this one sensor
        if len(sensor.shots()) == 1 and not sensor.shots()[0].ids:
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
        one = bare
        sides.append(lambda: [one() for _ in range(count)])
    times = time_interleaved(sides, max(3, rounds))
    if one_pass is not None:
        one_pass.free()
    for tap in taps:
        tap.close()
    most = 12e-6 if sensor.kind == "imu" else None
    return Figure(name, "sample", times[0] / count, times[1] / count if bare is not None else None, aim, most)


def _count_messages(sim: Simulation, topics: set[str]) -> tuple[dict[str, int], list[Subscription]]:
    """Reads these topics; gives how many messages came, by topic, and the subscriptions."""
    counts: dict[str, int] = {}

    def count(topic: str) -> Callable[[object], None]:
        def one_more(_: object) -> None:
            counts[topic] = counts.get(topic, 0) + 1

        return one_more

    return counts, [sim.communication.bus.tap(topic, count(topic)) for topic in sorted(topics)]


def _ignore_message(_: object) -> None:
    return None


def _resident_memory() -> int:
    """Memory of this process in use now [B]; an estimate from Python's blocks where the system does not say."""
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        return sys.getallocatedblocks() * 64
