"""World plugins that publish `/clock` and gz's data about a whole world: statistics, clock, and all poses."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator
from functools import cache, partial
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.msgs.cdr_template import CdrTemplate, packs
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import WorldPlugin
from simkit.plugins.drives.entity_poses import EntityPoses, PosedEntity, PoseSample, pose_numbers, transforms_message
from simkit.plugins.drives.odometry_messages import TRANSFORMS
from simkit.plugins.not_deep_copied import SharedByCopies

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.runtime.communication.publisher import Tally
    from simkit.scene import SceneModel

CLOCK: Final = "rosgraph_msgs/msg/Clock"
STATISTICS: Final = "ros_gz_interfaces/msg/WorldStatistics"
STATISTICS_RATE: Final = 5.0
"""Rate of the statistics [Hz of simulated time]; in gz's server this is a rate of real time."""
CLOCK_RATE: Final = 100.0
POSE_RATE: Final = 60.0
"""Rate of the poses [Hz of simulated time], the same number as gz's default of `dynamic_pose_hertz`."""
_NS: Final = 1_000_000_000
_WINDOW: Final = 20  # number of statistics in the average real-time factor, as in gz's server


class WallClock(SharedByCopies):
    """Wall-clock duration of a run; the simulated world must not depend on this duration.

    The duration is not part of a world's state: snapshots exclude it, and restoring a run does not reset it.

    Attributes:
        real: wall-clock time [s] while the world was running.
        paused: wall-clock time [s] while the world was paused.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self.real = self.paused = 0.0
        self._last, self._was_paused = time.perf_counter(), sim.paused
        self._recent: deque[tuple[float, float]] = deque(maxlen=_WINDOW)

    def look(self) -> None:
        """Add the time since the last call to `real` or `paused`."""
        now = time.perf_counter()
        if self._was_paused:
            self.paused += now - self._last
        else:
            self.real += now - self._last
        self._last, self._was_paused = now, self._sim.paused

    def factor(self) -> float:
        """Return simulated time / real time, averaged over the last statistics; 0 before the second statistics."""
        simulated, recent = self._sim.time, self._recent
        if recent and simulated < recent[-1][0]:
            recent.clear()  # the run was reset or restored
        recent.append((simulated, self.real))
        elapsed = recent[-1][1] - recent[0][1]
        return (recent[-1][0] - recent[0][0]) / elapsed if elapsed > 0.0 else 0.0


class WorldStats(WorldPlugin):
    """Publishes statistics, clock and poses of a world; every world has this plugin.

    Without subscribers the plugin costs no time. `/stats` and `/world/<world>/stats`
    (`ros_gz_interfaces/msg/WorldStatistics`) are published at 5 Hz of simulated time, and at once when the world is
    paused or resumed. `real_time`, `pause_time` and `real_time_factor` come from the wall clock and differ between
    runs; all other fields are the same in every run. `/world/<world>/clock` is published at 100 Hz.
    `/world/<world>/pose/info` has the poses of all models, links, visuals and lights.
    `/world/<world>/dynamic_pose/info` has the poses of the models and links that are not static. Both are published at
    60 Hz; each pose is in the frame of the entity's parent (`tf2_msgs/msg/TFMessage`). A recorder records these topics
    only if the user names them. All topics except the statistics are listed only while they have subscribers.
    """

    only_publishes = True

    def load(self, parent: Simulation, params: Params) -> None:
        sim, prefix = self.sim, valid_topic(f"/world/{self.sim.world.name}")
        self._wall = WallClock(sim)
        on_demand = sim.communication.on_demand
        both = {"/stats": STATISTICS, f"{prefix}/stats": STATISTICS}
        self._stats = on_demand.broadcast(both, STATISTICS_RATE, self._statistics, is_listed=True)
        on_demand.broadcast({f"{prefix}/clock": CLOCK}, CLOCK_RATE, self._clock)
        on_demand.broadcast({f"{prefix}/pose/info": TRANSFORMS}, POSE_RATE, self._all_poses)
        on_demand.broadcast({f"{prefix}/dynamic_pose/info": TRANSFORMS}, POSE_RATE, self._moving_poses)
        sim.control.pausing.on_change(self._on_pause)

    def _on_pause(self) -> None:
        self._wall.look()
        for topic, publisher in self._stats.items():
            if publisher.wanted:
                publisher.publish(self._statistics(topic))

    def _statistics(self, _topic: str) -> msgs.WorldStatistics:
        sim, wall = self.sim, self._wall
        wall.look()
        step_ns = sim.engine.clock.time_ns(1)
        statistics: msgs.WorldStatistics = msgs.make(
            STATISTICS,
            header=msgs.header(sim.time_ns, ""),
            sim_time=msgs.time(sim.time_ns),
            real_time=msgs.time(round(wall.real * 1e9)),
            pause_time=msgs.time(round(wall.paused * 1e9)),
            paused=sim.paused,
            iterations=sim.tick,
            model_count=len(sim.contents.handles.tables["model"]),
            real_time_factor=wall.factor(),
            step_size=msgs.time(0 if sim.paused else step_ns),
            stepping=sim.control.pausing.is_stepping and not sim.paused,
        )
        return statistics

    def _clock(self, _topic: str) -> Callable[[], msgs.Clock]:
        return partial(clock_message, self.sim.time_ns)

    def _all_poses(self, _topic: str) -> Callable[[], msgs.TFMessage]:
        sim = self.sim
        lights = [light for light in sim.contents.lights.values() if not light.scene.link]
        placed = [(sim.world.name, light.scoped, pose_numbers(light.pose)) for light in lights]
        return partial(transforms_message, sim.time_ns, self._take("all poses", with_all=True), placed)

    def _moving_poses(self, _topic: str) -> Callable[[], msgs.TFMessage]:
        return partial(transforms_message, self.sim.time_ns, self._take("moving poses", with_all=False))

    def _take(self, name: str, *, with_all: bool) -> PoseSample:
        """Return the current poses of all models with their visuals, or only of models that may move."""
        poses: EntityPoses = self.sim.engine.names.shared(name, lambda: EntityPoses(self.sim, self._parts(with_all)))
        return poses.take()

    def _parts(self, with_all: bool) -> list[PosedEntity]:
        scenes = [s for s in self.sim.engine.structure.models.values() if with_all or not s.static]
        return [part for scene in scenes for part in self._of_model(scene, with_all)]

    def _of_model(self, scene: SceneModel, with_visuals: bool) -> Iterator[PosedEntity]:
        sim, outer = self.sim, scene.scoped.rpartition("::")[0]
        model = sim.model(scene.scoped)
        within = sim.model(outer) if outer else None
        yield PosedEntity(outer or sim.world.name, scene.scoped, handle=model, within=within)
        for link in scene.links:
            yield PosedEntity(scene.scoped, link.scoped, handle=sim.link(link.scoped), within=model)
            for visual in link.visuals if with_visuals else ():
                yield PosedEntity(link.scoped, visual.scoped, visual.pose_link)
        for nested in scene.models:
            yield from self._of_model(nested, with_visuals)


def clock_message(time_ns: int) -> msgs.Clock:
    """Return a `rosgraph_msgs/msg/Clock` with a time [ns]."""
    message: msgs.Clock = msgs.type_of(CLOCK)(msgs.time(time_ns))
    return message


@packs(clock_message)
def _pack_clock(time_ns: int) -> tuple[str, bytes]:
    return CLOCK, _clock_packer()(time_ns // _NS, time_ns % _NS)


@cache
def _clock_packer() -> Callable[..., bytes]:
    return CdrTemplate(clock_message(0), ("clock.sec", "clock.nanosec")).packer()


class ClockPublisher(WorldPlugin):
    """Publishes `rosgraph_msgs/msg/Clock` on `/clock` at 100 Hz of simulated time; every world has this plugin."""

    after_step_rate = 100.0
    only_publishes = True

    def load(self, parent: Simulation, params: Params) -> None:
        self._clock = self.advertise("/clock", CLOCK)
        self._clock.tally = self._tally

    def _tally(self) -> Tally:
        clock, tick = self.sim.engine.clock, self.sim.tick
        grid = clock.grid(self.after_step_rate or 0.0)
        count = tick if grid is None else grid.index(tick)
        return count, clock.time_ns(tick if grid is None else grid.tick(count)), grid

    def after_step(self) -> None:
        if self._clock.wanted:
            self._clock.publish_later(partial(clock_message, self.sim.time_ns))
