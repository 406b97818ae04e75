"""What of a simulation is due when, in document order; hooks of plugins of one kind as one task."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from simkit.runtime.engine import sleep, velocity_servos
from simkit.runtime.engine.scheduler import Scheduler, Task

if TYPE_CHECKING:
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.engine.entity_structure import AttachedPlugin, AttachedSensor
    from simkit.runtime.engine.plugin_faults import PluginFaults

MIN_GROUP_SIZE = 4
"""So few are as soon called one by one."""


class PluginGroup:
    """The plugins of one task; going through them notes whose turn it is, so that who raises can be named.

    Attributes:
        plugins: in the order of the document.
        turn: whose turn it is.
    """

    def __init__(self, plugins: Sequence[AttachedPlugin]) -> None:
        self.plugins, self.turn = list(plugins), plugins[0]

    def __iter__(self) -> Iterator[AttachedPlugin]:
        for plugin in self.plugins:
            self.turn = plugin
            yield plugin


GroupHook = Callable[[Sequence["AttachedPlugin"]], Callable[[PluginGroup], None]]
"""Makes of plugins what calls a hook of all of them."""

HookTasks = Iterator[tuple[float | None, Task]]
"""Rates [Hz] and tasks."""


def hook_tasks(faults: PluginFaults, plugins: Iterable[AttachedPlugin], hook: str) -> HookTasks:
    """The hooks of these plugins with their rates [Hz], in the order of the document.

    Hooks of plugins of one kind that are due together are one task where the plugin's class defines beside the hook a
    class method of the hook's name with `_together` after it:

        @classmethod
        def before_step_together(cls, plugins):
            ...                       # once for each schedule: look up what all need
            def run(group):
                for plugin in group:  # the same bits, and in the same order, as one after the other
                    ...
            return run

    Only plugins that follow on each other are taken together, so that hooks keep the order of the document.

    Args:
        faults: calls the plugins.
        plugins: those that are at work.
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


def _can_group(one: AttachedPlugin, other: AttachedPlugin, hook: str) -> bool:
    return type(one) is type(other) and _hook_rate(one, hook) == _hook_rate(other, hook)


def _hook_rate(plugin: AttachedPlugin, hook: str) -> float | None:
    rate: float | None = getattr(plugin, f"{hook}_rate")
    return rate


def _group_tasks(faults: PluginFaults, run: list[AttachedPlugin], hook: str) -> HookTasks:
    together = _group_hook(type(run[0]), hook) if len(run) >= MIN_GROUP_SIZE else None
    # who may be left out when it raises is called by itself
    if together is None or any(faults.policy(plugin) != "stop" for plugin in run):
        for plugin in run:
            yield _hook_rate(plugin, hook), faults.task(plugin, hook)
    else:
        yield _hook_rate(run[0], hook), _guard_group(faults, PluginGroup(run), hook, together(run))


def _group_hook(kind: type, hook: str) -> GroupHook | None:
    """What a class gives for many of its plugins; None where a class below it has another hook than that is for."""
    for cls in kind.__mro__:
        if f"{hook}_together" in vars(cls):
            found: GroupHook = getattr(kind, f"{hook}_together")
            return found
        if hook in vars(cls):
            return None
    return None


def _guard_group(faults: PluginFaults, rota: PluginGroup, hook: str, run: Callable[[PluginGroup], None]) -> Task:
    def task(_: int = 0) -> None:
        try:
            run(rota)
        except Exception as error:  # noqa: BLE001 - what a plugin calls may raise anything
            faults.meet(rota.turn, hook, error)

    return task


_LIMIT_SHARE = 0.999  # of the sum of squares of velocities over their limits
_NO_LIMIT = 1e6  # [rad/s or m/s] from which on a limit of the file is none
_LIMIT_RATE = 100.0  # [Hz] at which a velocity limit of the file is held on a joint that nothing drives
_CAMERA_INFO = "sensor_msgs/msg/CameraInfo"
_RANGE = "sensor_msgs/msg/Range"
_BLIND_KINDS = frozenset(  # kinds that do not look around
    ("imu", "force_torque", "contact", "altimeter", "magnetometer", "air_pressure", "air_speed", "navsat", "gps")
)


class LimitedJoint(Protocol):
    """Joint with a limit of its velocity."""

    @property
    def mj_dofs(self) -> Sequence[int]:
        """Indices among MuJoCo's degrees of freedom."""

    @property
    def least_velocity_limit(self) -> float:
        """The least limit of its axes [rad/s or m/s]."""

    def clamp_velocity(self, _tick: int = 0) -> None:
        """Brings the velocity within its limits."""


def fill_schedule(
    engine: Engine, scheduler: Scheduler, joints: Iterable[LimitedJoint], exact_limits: Collection[LimitedJoint]
) -> None:
    """Fills an empty scheduler.

    Args:
        engine: whose sensors and plugins are scheduled.
        scheduler: gets the tasks.
        joints: all that are there.
        exact_limits: joints whose velocity limit is held at every step.
    """
    resting = engine.physics.sleep

    def look_for_rest(_tick: int) -> None:
        if not engine.physics.sleep.rests:
            engine.physics.sleep.look(engine.physics.fresh())

    if resting.watches:
        scheduler.every(sleep.RATE, look_for_rest, "after")
    coasting = []
    for joint in joints:
        if joint in exact_limits:
            scheduler.every(None, joint.clamp_velocity, "sense")
        elif joint.mj_dofs and joint.least_velocity_limit < _NO_LIMIT:
            coasting.append(joint)

    if coasting:
        scheduler.every(_LIMIT_RATE, _velocity_limiter(engine, coasting), "sense")
    if engine.velocity_servos.are_there:  # before any command of the step: the last one had no time to be obeyed
        scheduler.every(velocity_servos.RATE, engine.velocity_servos.correct, "before")
    _report_shared_topics(engine)
    _group_sensors(engine)
    plugins = [plugin for plugin in engine.structure.all_plugins() if not engine.faults.is_disabled(plugin)]
    _schedule_scenery(engine, scheduler, plugins)
    for sensor in engine.structure.all_sensors():
        scheduler.on(sensor.timetable(), sensor.sample, "sense")
    for rate, task in hook_tasks(engine.faults, plugins, "before_step"):
        scheduler.every(rate, task, "before")
    for plugin in plugins:
        if getattr(plugin, "is_gz_system", False):  # every system's update comes after every system's pre_update
            scheduler.every(None, engine.faults.task(plugin, "update_step"), "before")
    for rate, task in hook_tasks(engine.faults, plugins, "after_step"):
        scheduler.every(rate, task, "after")


def _schedule_scenery(engine: Engine, scheduler: Scheduler, plugins: Sequence[Any]) -> None:
    """Has what moves by itself put where it is before anything is sensed, and at the ticks at which sensors look."""
    for plugin in plugins:
        if hasattr(plugin, "move_scenery"):
            task = engine.faults.task(plugin, "move_scenery")
            scheduler.every(plugin.scenery_rate, task, "sense")
            for sensor in engine.structure.all_sensors():
                if sensor.scene.kind not in _BLIND_KINDS:
                    scheduler.on(sensor.timetable(), task, "sense")


def _velocity_limiter(engine: Engine, joints: Sequence[LimitedJoint]) -> Task:
    """Holds the velocity limits of joints, as one task: which are beyond them is found in one go."""
    dofs = np.array([dof for joint in joints for dof in joint.mj_dofs], dtype=np.intp)
    owners = [joint for joint in joints for _ in joint.mj_dofs]
    # of several axes the least; the joint itself looks closer. Whoever sets one makes a new schedule
    limits = np.array([joint.least_velocity_limit for joint in owners])
    shares = np.zeros(engine.mj_model.nv)
    shares[dofs] = 1.0 / np.maximum(limits, 1e-9)
    physics = engine.physics

    def hold(tick: int) -> None:
        velocities = physics.data.qvel
        found = velocities * shares
        if found.dot(found) < _LIMIT_SHARE:  # then none of them can be beyond its own
            return
        for place in np.flatnonzero(np.abs(velocities[dofs]) > limits).tolist():
            owners[place].clamp_velocity(tick)

    return hold


def _group_sensors(engine: Engine) -> None:
    """Has sensors of one kind work together."""
    kinds: dict[type, list[AttachedSensor]] = {}
    for sensor in engine.structure.all_sensors():
        kinds.setdefault(type(sensor), []).append(sensor)
    for kind, sensors in kinds.items():
        kind.make_batches(sensors)  # type: ignore[attr-defined]


def _report_shared_topics(engine: Engine) -> None:
    """Tells of a topic on which sensors publish two messages: whoever reads it gets both in turn."""
    first: dict[str, tuple[str, str]] = {}
    for sensor in engine.structure.all_sensors():
        types = [(topic, sensor._products[product].type_name) for product, topic in sensor._topics.items()]
        told: set[str] = set()
        # what goes with a picture comes last: where the pictures share a topic too, that is enough to say
        for topic, kind in sorted(types, key=lambda pair: (pair[1] == _CAMERA_INFO, pair)):
            if topic not in first:
                first[topic] = sensor.scoped, kind
                continue
            other, other_kind = first[topic]
            if kind == other_kind == _RANGE and other != sensor.scoped:
                continue  # as ROS has it for a ring of sonars: each message names its sensor's frame
            if kind != _CAMERA_INFO or kind != other_kind or other not in told:
                _report_shared_topic(engine, sensor, topic, other, {other_kind, kind})
            told.add(other)


def _report_shared_topic(engine: Engine, sensor: AttachedSensor, topic: str, other: str, kinds: set[str]) -> None:
    """Tells that a sensor and another, perhaps itself, publish messages of these types on one topic."""
    where = sensor.scene.where
    if other == sensor.scoped:
        message = f"sensor {other!r} publishes two messages on one topic, {topic!r}"
    else:
        message = f"sensors {other!r} and {sensor.scoped!r} publish on one topic, {topic!r}"
    if len(kinds) > 1:
        message = f"{message}: {' and '.join(sorted(kinds))}, and ROS gives a reader one type only"
        engine.reports.warning("SK-SENSOR-128", message, where, "give each a topic of its own")
    elif kinds == {_CAMERA_INFO}:
        hint = "a <camera_info_topic> for each, where readers have to tell them apart otherwise than by frame"
        engine.reports.note("SK-SENSOR-127", message, where, hint)
    else:
        own = "camera a name" if other == sensor.scoped else "a <topic>"
        engine.reports.warning("SK-SENSOR-027", message, where, f"give each {own} of its own, or leave it out")
