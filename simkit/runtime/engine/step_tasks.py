"""Tasks of a simulation and their rates, in document order; hooks of similar plugins become one task."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from simkit.runtime.engine import sleep, stray_bodies, velocity_servos
from simkit.runtime.engine.scheduler import Scheduler, SilentTask, Task
from simkit.runtime.engine.simulated_time import TickGrid
from simkit.runtime.engine.velocity_limits import LimitedDof, velocity_limiter

if TYPE_CHECKING:
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.engine.entity_structure import AttachedPlugin, AttachedSensor
    from simkit.runtime.engine.plugin_faults import PluginFaults

MIN_GROUP_SIZE = 4
"""Least number of plugins in a group; calling fewer plugins one by one is as fast."""


class PluginGroup:
    """Plugins of one task. The iteration records the current plugin, so that an exception can be attributed.

    Attributes:
        plugins: plugins in document order.
        turn: current plugin.
    """

    def __init__(self, plugins: Sequence[AttachedPlugin]) -> None:
        self.plugins, self.turn = list(plugins), plugins[0]

    def __iter__(self) -> Iterator[AttachedPlugin]:
        for plugin in self.plugins:
            self.turn = plugin
            yield plugin


GroupHook = Callable[[Sequence["AttachedPlugin"]], Callable[[PluginGroup], None]]
"""Function that receives several plugins and returns one function, which calls a hook of all these plugins."""

HookTasks = Iterator[tuple[float | None, Task]]
"""Pairs of rate [Hz] and task."""


def hook_tasks(faults: PluginFaults, plugins: Iterable[AttachedPlugin], hook: str) -> HookTasks:
    """Yield the rate [Hz] and the task of each hook, or of each group of hooks, in document order.

    Hooks of plugins of one class that are due together become one task, if the class also defines a class method with
    the hook's name and the suffix `_together`:

        @classmethod
        def before_step_together(cls, plugins):
            ...                       # once for each schedule: look up shared data
            def run(group):
                for plugin in group:  # same bits and order as separate calls
                    ...
            return run

    Only consecutive plugins are grouped, so that hooks keep the document order.

    Args:
        faults: caller of the plugins.
        plugins: enabled plugins.
        hook: `before_step` or `after_step`.
    """
    run: list[AttachedPlugin] = []
    for plugin in plugins:
        if not plugin.has_hook(hook):
            continue
        if run and not (_can_group(run[-1], plugin, hook)):
            yield from _group_tasks(faults, run, hook)
            run = []
        run.append(plugin)
    yield from _group_tasks(faults, run, hook)


def _can_group(first: AttachedPlugin, second: AttachedPlugin, hook: str) -> bool:
    return type(first) is type(second) and _hook_rate(first, hook) == _hook_rate(second, hook)


def _hook_rate(plugin: AttachedPlugin, hook: str) -> float | None:
    rate: float | None = getattr(plugin, f"{hook}_rate")
    return rate


def _group_tasks(faults: PluginFaults, run: list[AttachedPlugin], hook: str) -> HookTasks:
    together = _group_hook(type(run[0]), hook) if len(run) >= MIN_GROUP_SIZE else None
    # a plugin that may be disabled when it raises is called separately
    if together is None or faults.is_observed or any(faults.policy(plugin) != "stop" for plugin in run):
        for plugin in run:
            yield _hook_rate(plugin, hook), faults.task(plugin, hook)
    else:
        yield _hook_rate(run[0], hook), _guard_group(faults, PluginGroup(run), hook, together(run))


def _group_hook(kind: type, hook: str) -> GroupHook | None:
    """Return the group hook of a class; None if a derived class overrides the single hook."""
    for cls in kind.__mro__:
        if f"{hook}_together" in vars(cls):
            group_hook: GroupHook = getattr(kind, f"{hook}_together")
            return group_hook
        if hook in vars(cls):
            return None
    return None


def _guard_group(faults: PluginFaults, group: PluginGroup, hook: str, run: Callable[[PluginGroup], None]) -> Task:
    def task(_: int = 0) -> None:
        try:
            run(group)
        except Exception as error:  # noqa: BLE001 - what a plugin calls may raise anything
            faults.meet(group.turn, hook, error)

    return task


LIMIT_RATE = 100.0
"""Rate [Hz] at which the velocity limit of an undriven joint is enforced."""

_Limiter = tuple[object, list[LimitedDof], Task]
"""Velocity limiter, after the model and the limits from which it was made."""

_CAMERA_INFO = "sensor_msgs/msg/CameraInfo"
_RANGE = "sensor_msgs/msg/Range"


class StepTasks:
    """Tasks of all parts of a simulation.

    Args:
        engine: engine of the sensors and plugins.
    """

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._checked_topics: object = None  # sensors and their topics that were searched for shared topics
        self._limiters: dict[float | None, _Limiter] = {}  # by rate
        self._is_repeatable = False
        self._limits: list[object] = []

    def inputs(self, limits: list[object], wanted: list[bool]) -> tuple[object, ...] | None:
        """Return what the schedule depends on and a restored state of the same structure may change.

        Args:
            limits: velocity limits of the joints; a change replaces these objects.
            wanted: which tasks on demand are needed.

        Returns:
            None if tasks have a state of their own, so that each restored state needs new ones: timetables of delayed
            or shifted samples, batches of sensors, groups of plugins, and plugins that move scenery.
        """
        if not self._is_repeatable:
            return None
        engine, structure = self._engine, self._engine.structure
        plugins = [(plugin.before_step_rate, plugin.after_step_rate) for plugin in structure.all_plugins()]
        sensors = [(sensor.update_rate, sensor.is_manual) for sensor in structure.all_sensors()]
        identities = list(map(id, limits))
        self._limits = limits  # they stay alive, so that no other object gets their identity
        return engine.physics.sleep.watches, engine.faults.disabled, plugins, sensors, identities, wanted

    def fill(self, scheduler: Scheduler, exact: list[LimitedDof], coasting: list[LimitedDof]) -> None:
        """Fill an empty scheduler.

        Args:
            scheduler: scheduler that receives the tasks.
            exact: degrees of freedom whose velocity limit is enforced at every step.
            coasting: other degrees of freedom with a velocity limit.
        """
        engine = self._engine
        engine.faults.begin_schedule()
        if engine.physics.sleep.watches:
            scheduler.every(sleep.RATE, engine.look_for_rest, "after")
        scheduler.every(stray_bodies.RATE, engine.stray_bodies.look, "after")
        self._schedule_velocity_limits(scheduler, exact, coasting)
        if engine.velocity_servos.are_there:  # before the commands of the step, which have had no time to take effect
            scheduler.every(velocity_servos.RATE, engine.velocity_servos.correct, "before")
        topics = [(sensor, *sensor.topics.items()) for sensor in engine.structure.all_sensors()]
        if topics != self._checked_topics:
            _report_shared_topics(engine)
            self._checked_topics = topics
        self._is_repeatable = _schedule_sensors_and_plugins(engine, scheduler)

    def _schedule_velocity_limits(
        self, scheduler: Scheduler, exact: list[LimitedDof], coasting: list[LimitedDof]
    ) -> None:
        physics = self._engine.physics
        last, self._limiters = self._limiters, {}
        for rate, dofs in ((None, exact), (LIMIT_RATE, coasting)):
            if dofs:
                model, known = physics.model, last.get(rate)
                if known is None or known[0] is not model or known[1] != dofs:
                    known = model, dofs, velocity_limiter(physics, dofs)
                self._limiters[rate] = known
                scheduler.sample(scheduler.clock.grid(rate or 0.0, from_start=True), known[2], SilentTask())


def _schedule_sensors_and_plugins(engine: Engine, scheduler: Scheduler) -> bool:
    """Schedule sensors and hooks, and return whether the tasks fit every restored state with the same rates."""
    is_repeatable = not _group_sensors(engine)
    plugins = [plugin for plugin in engine.structure.all_plugins() if not engine.faults.is_disabled(plugin)]
    _schedule_scenery(engine, scheduler, plugins)
    for sensor in engine.structure.all_sensors():
        if not sensor.is_manual:
            grid = sensor.timetable()
            is_repeatable &= grid is None or isinstance(grid, TickGrid)
            scheduler.sample(grid, sensor.sample, sensor)
    for rate, task in hook_tasks(engine.faults, plugins, "before_step"):
        scheduler.every(rate, task, "before")
    for plugin in plugins:
        if getattr(plugin, "is_gz_system", False):  # all updates of Gazebo systems follow all pre_updates
            scheduler.every(None, engine.faults.task(plugin, "update_step"), "before")
    for rate, task in hook_tasks(engine.faults, plugins, "after_step"):
        scheduler.every(rate, task, "after")
    engine.faults.end_schedule()
    can_group = max(Counter(map(type, plugins)).values(), default=0) >= MIN_GROUP_SIZE
    return is_repeatable and not can_group and not any(hasattr(plugin, "move_scenery") for plugin in plugins)


def _schedule_scenery(engine: Engine, scheduler: Scheduler, plugins: Sequence[Any]) -> None:
    """Schedule plugins that move scenery, before sensors are sampled and at the ticks at which sensors see it."""
    for plugin in plugins:
        if hasattr(plugin, "move_scenery"):
            task = engine.faults.task(plugin, "move_scenery")
            scheduler.every(plugin.scenery_rate, task, "sense")
            for sensor in engine.structure.all_sensors():
                if sensor.sees_scene:
                    scheduler.on(sensor.scene_timetable(), task, "sense")


def _group_sensors(engine: Engine) -> bool:
    """Group the sensors of one kind into batches, and return whether a kind has several sensors."""
    kinds: dict[type, list[AttachedSensor]] = {}
    for sensor in engine.structure.all_sensors():
        kinds.setdefault(type(sensor), []).append(sensor)
    for kind, sensors in kinds.items():
        kind.make_batches(sensors)  # type: ignore[attr-defined]
    return any(len(sensors) > 1 for sensors in kinds.values())


def _report_shared_topics(engine: Engine) -> None:
    """Report topics on which sensors publish two messages: a subscriber receives both in turn."""
    first: dict[str, tuple[str, str]] = {}
    for sensor in engine.structure.all_sensors():
        types = [(topic, sensor.product_type(product)) for product, topic in sensor.topics.items()]
        reported: set[str] = set()
        # camera infos come last: if the images share a topic too, one report is enough
        for topic, kind in sorted(types, key=lambda pair: (pair[1] == _CAMERA_INFO, pair)):
            if topic not in first:
                first[topic] = sensor.scoped, kind
                continue
            other, other_kind = first[topic]
            if kind == other_kind == _RANGE and other != sensor.scoped:
                continue  # usual in ROS for a ring of sonars: each message names its sensor's frame
            if kind != _CAMERA_INFO or kind != other_kind or other not in reported:
                _report_shared_topic(engine, sensor, topic, other, {other_kind, kind})
            reported.add(other)


def _report_shared_topic(engine: Engine, sensor: AttachedSensor, topic: str, other: str, kinds: set[str]) -> None:
    """Report that a sensor and another sensor, perhaps the same, publish messages of these types on one topic."""
    where = sensor.scene.where
    if other == sensor.scoped:
        message = f"sensor {other!r} publishes two messages on one topic, {topic!r}"
    else:
        message = f"sensors {other!r} and {sensor.scoped!r} publish on one topic, {topic!r}"
    if len(kinds) > 1:
        message = f"{message}: {' and '.join(sorted(kinds))}, but a ROS topic has only one type"
        engine.reports.warning("SK-SENSOR-128", message, where, "give each message its own topic")
    elif kinds == {_CAMERA_INFO}:
        hint = "give each camera a <camera_info_topic> if subscribers must distinguish them by more than the frame"
        engine.reports.note("SK-SENSOR-127", message, where, hint)
    else:
        owner, item = ("camera", "name") if other == sensor.scoped else ("sensor", "<topic>")
        hint = f"give each {owner} its own {item}, or remove the {item} of each {owner}"
        if other.split("::")[0] != sensor.scoped.split("::")[0]:
            hint = f"give each robot a namespace, --spawn MODEL:x,y,yaw:NAME:NAMESPACE; or {hint}"
        engine.reports.warning("SK-SENSOR-027", message, where, hint)
