"""What of a simulation is due when, in document order."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from simkit.runtime import overlap, sleep
from simkit.runtime.joint import Joint
from simkit.runtime.loop import guarded
from simkit.runtime.scheduler import Scheduler

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation

_LIMIT_GRID = 100.0  # [Hz] at which a velocity limit of the file is held on a joint that nothing drives
_INFO = "sensor_msgs/msg/CameraInfo"


def fill(sim: Simulation, scheduler: Scheduler, exact_limits: Sequence[Joint]) -> None:
    """Fills an empty scheduler.

    Args:
        exact_limits: joints whose velocity limit is held at every step.
    """
    resting = sim.physics.sleep

    def look_for_rest(_tick: int) -> None:
        if not sim.physics.sleep.rests:
            sim.physics.sleep.look(sim.physics.fresh())

    if resting.watches:
        scheduler.every(sleep.RATE, look_for_rest, "after")
    if overlap.is_any_gentle(sim.mj_model):
        scheduler.every(overlap.RATE, lambda _: overlap.harden(sim), "sense")
    coasting = []
    for joint in sim.entities.tables["joint"].values():
        if joint in exact_limits:
            scheduler.every(None, joint.clamp_velocity, "sense")
        elif _coasts_over_limit(joint):
            coasting.append(joint)

    def hold_limits(tick: int) -> None:
        for joint in coasting:
            joint.clamp_velocity(tick)

    if coasting:
        scheduler.every(_LIMIT_GRID, hold_limits, "sense")
    _report_shared_topics(sim)
    for sensor in sim.structure.all_sensors():
        scheduler.on(sensor.timetable(), sensor.sample, "sense")
    for plugin in sim.structure.all_plugins():
        if plugin.has_hook("before_step"):
            scheduler.every(plugin.before_step_rate, guarded(sim, plugin, "before_step"), "before")
        if plugin.has_hook("after_step"):
            scheduler.every(plugin.after_step_rate, guarded(sim, plugin, "after_step"), "after")


def _report_shared_topics(sim: Simulation) -> None:
    """Tells of a topic on which two messages are published: whoever reads it gets both in turn."""
    first: dict[str, tuple[str, str]] = {}
    of_sensors: dict[str, set[str]] = {}
    for sensor in sim.structure.all_sensors():
        types = [(topic, sensor._products[product].type_name) for product, topic in sensor._topics.items()]
        told: set[str] = set()
        # what goes with a picture comes last: where the pictures share a topic too, that is enough to say
        for topic, kind in sorted(types, key=lambda pair: (pair[1] == _INFO, pair)):
            if topic not in first:
                first[topic] = sensor.scoped, kind
                of_sensors[topic] = {kind}
                continue
            of_sensors[topic].add(kind)
            other, other_kind = first[topic]
            if kind != _INFO or kind != other_kind or other not in told:
                _report_shared(sim, sensor, topic, other, {other_kind, kind})
            told.add(other)
    for topic, kinds in of_sensors.items():
        others = {end.type_name for end in sim.bus._publishers.get(topic, ()) if end.active} - kinds
        if others:
            sensor = sim.sensor(first[topic][0])
            message = f"sensor {sensor.scoped!r} publishes {' and '.join(sorted(kinds))} on {topic!r}, where a plugin"
            says = f"{message} publishes {' and '.join(sorted(others))}, and ROS gives a reader one type only"
            sim.reports.warning("SK-SENSOR-128", says, sensor.scene.where, "give it a <topic> of its own")


def _report_shared(sim: Simulation, sensor: Any, topic: str, other: str, kinds: set[str]) -> None:
    """Tells that a sensor and another, perhaps itself, publish messages of these types on one topic."""
    where = sensor.scene.where
    if other == sensor.scoped:
        message = f"sensor {other!r} publishes two messages on one topic, {topic!r}"
    else:
        message = f"sensors {other!r} and {sensor.scoped!r} publish on one topic, {topic!r}"
    if len(kinds) > 1:
        message = f"{message}: {' and '.join(sorted(kinds))}, and ROS gives a reader one type only"
        sim.reports.warning("SK-SENSOR-128", message, where, "give each a topic of its own")
    elif kinds == {_INFO}:
        hint = "a <camera_info_topic> for each, where readers have to tell them apart otherwise than by frame"
        sim.reports.note("SK-SENSOR-127", message, where, hint)
    else:
        own = "camera a name" if other == sensor.scoped else "a <topic>"
        sim.reports.warning("SK-SENSOR-027", message, where, f"give each {own} of its own, or leave it out")


def _coasts_over_limit(joint: Joint) -> bool:
    """Whether a joint has a velocity limit of the file that no servo keeps."""
    return joint.dof > 0 and bool((joint._velocity_limit < 1e6).any())
