"""Shared state of the gz systems in a simulation: the time for their hooks, and the application of their commands."""

from __future__ import annotations

from datetime import timedelta
from typing import TYPE_CHECKING, Any, Protocol

from simkit.extend import SharedByCopies
from simkit_gz_python.sim.entity_component_manager import manager_of

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.runtime import WorldStructure


class UpdateInfo:
    """Time of an update.

    Attributes:
        iterations: number of steps since the start, including the current step.
        paused: true if the physics is paused.
    """

    __slots__ = ("_dt_ns", "_time_ns", "iterations", "paused")

    def __init__(self, time_ns: int = 0, dt_ns: int = 0, iterations: int = 0, paused: bool = True) -> None:
        self._time_ns, self._dt_ns = time_ns, dt_ns
        self.iterations, self.paused = iterations, paused

    @property
    def sim_time(self) -> timedelta:
        """Simulated time at the end of the step, rounded to microseconds."""
        return timedelta(microseconds=self._time_ns / 1000)

    @sim_time.setter
    def sim_time(self, value: timedelta) -> None:
        self._time_ns = _nanoseconds(value)

    real_time = sim_time
    """The same as `sim_time`: the time of the machine's clock would make two runs differ."""

    @property
    def dt(self) -> timedelta:
        """Duration of the step; 0 while the physics is paused."""
        return timedelta(microseconds=self._dt_ns / 1000)

    @dt.setter
    def dt(self, value: timedelta) -> None:
        self._dt_ns = _nanoseconds(value)

    def __copy__(self) -> UpdateInfo:
        return UpdateInfo(self._time_ns, self._dt_ns, self.iterations, self.paused)

    def __repr__(self) -> str:
        state = ", paused" if self.paused else ""
        return f"<UpdateInfo iteration {self.iterations}, {self._time_ns / 1e9:g} s{state}>"


def _nanoseconds(value: timedelta) -> int:
    return (value.days * 86400 + value.seconds) * 1_000_000_000 + value.microseconds * 1000


class EventManager:
    """Argument of the hook `configure`; as in gz's Python, the class has no methods."""


class SystemPlugin(Protocol):
    """Plugin that calls the hooks of a gz system."""

    is_gz_system: bool

    def call(self, hook: str, info: UpdateInfo) -> None:
        """Call a hook of the system, if the system has this hook."""


def systems_of(sim: Simulation) -> list[SystemPlugin]:
    """Return the plugins that call the hooks of gz systems, in the order of their steps, without disabled plugins."""
    plugins: list[Any] = sim.engine.structure.all_plugins()
    return [p for p in plugins if getattr(p, "is_gz_system", False) and not sim.engine.faults.is_disabled(p)]


class SystemHub(SharedByCopies):
    """State that the systems of one simulation share.

    Attributes:
        ecm: entity component manager of the simulation.
        first: first system; its plugin stores the shared state in snapshots.
        last: last system; its plugin applies the commands of all systems.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim, self.ecm = sim, manager_of(sim)
        self._structure: WorldStructure | None = None
        self._fault_count = -1
        self.first: SystemPlugin | None = None
        self.last: SystemPlugin | None = None
        self._info = UpdateInfo(0, sim.engine.clock.time_ns(1), 0, False)

    def look(self) -> None:
        """Update `first` and `last` after a system was added, removed or disabled."""
        structure, fault_count = self._sim.engine.structure, len(self._sim.engine.faults.get_state())
        if structure is not self._structure or fault_count != self._fault_count:
            systems = systems_of(self._sim)
            self.first, self.last = (systems[0], systems[-1]) if systems else (None, None)
            self._structure, self._fault_count = structure, fault_count

    def info(self, ahead: int) -> UpdateInfo:
        """Return the time for the hooks of a step: the next step with `ahead` = 1, the finished step with 0."""
        tick = self._sim.tick + ahead
        info = self._info
        if info.iterations != tick:
            info = self._info = UpdateInfo(
                self._sim.engine.clock.time_ns(tick), self._sim.engine.clock.time_ns(1), tick, False
            )
        return info

    def carry_out(self) -> None:
        """Apply the commands of all systems to the simulation."""
        if not self.ecm.commands.is_empty:
            self.ecm.commands.carry_out(self._sim, self.ecm.handle)


def hub_of(sim: Simulation) -> SystemHub:
    """Return the hub of a simulation; the first call creates it."""
    ecm = manager_of(sim)
    if not isinstance(ecm.hub, SystemHub):
        ecm.hub = SystemHub(sim)
    return ecm.hub


def update_paused(sim: Simulation) -> None:
    """Call the update hooks of all systems once while the physics is paused."""
    info = UpdateInfo(sim.time_ns, 0, sim.tick, True)
    for hook in ("pre_update", "update", "post_update"):
        for system in systems_of(sim):
            system.call(hook, info)
