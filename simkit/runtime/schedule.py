"""What of a simulation is due when, in document order."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from simkit.runtime import overlap, sleep
from simkit.runtime.joint import Joint
from simkit.runtime.loop import guarded
from simkit.runtime.scheduler import Scheduler

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation

_LIMIT_GRID = 100.0  # [Hz] at which a velocity limit of the file is held on a joint that nothing drives


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
    """Warns of a topic on which two sensors publish: whoever reads it gets both in turn."""
    owners: dict[str, str] = {}
    for sensor in sim.structure.all_sensors():
        for topic in sorted(set(sensor._topics.values())):
            other = owners.setdefault(topic, sensor.scoped)
            if other != sensor.scoped:
                message = f"sensors {other!r} and {sensor.scoped!r} publish on one topic, {topic!r}"
                hint = "give each a <topic> of its own, or leave <topic> out"
                sim.reports.warning("SK-SENSOR-027", message, sensor.scene.where, hint)


def _coasts_over_limit(joint: Joint) -> bool:
    """Whether a joint has a velocity limit of the file that no servo keeps."""
    return joint.dof > 0 and bool((joint._velocity_limit < 1e6).any())
