"""Systems of gz in a simulation: the time for their hooks, and the work that is done once for all of them."""

from __future__ import annotations

from datetime import timedelta
from typing import TYPE_CHECKING, Any, Protocol

from simkit.plugins.gz_python.sim.entity_component_manager import manager_of
from simkit.plugins.not_deep_copied import SharedByCopies

if TYPE_CHECKING:
    from simkit.runtime import Simulation, WorldStructure


class UpdateInfo:
    """Time of an update.

    Attributes:
        iterations: number of steps, including the step of this update.
        paused: true if the physics is paused.
    """

    __slots__ = ("_dt_ns", "_time_ns", "iterations", "paused")

    def __init__(self, time_ns: int = 0, dt_ns: int = 0, iterations: int = 0, paused: bool = True) -> None:
        self._time_ns, self._dt_ns = time_ns, dt_ns
        self.iterations, self.paused = iterations, paused

    @property
    def sim_time(self) -> timedelta:
        """Simulated time at the end of the step, to the microsecond."""
        return timedelta(microseconds=self._time_ns / 1000)

    @sim_time.setter
    def sim_time(self, value: timedelta) -> None:
        self._time_ns = _nanoseconds(value)

    @property
    def real_time(self) -> timedelta:
        """Simulated time as well: a dependence on the machine's clock would make runs differ."""
        return self.sim_time

    @real_time.setter
    def real_time(self, value: timedelta) -> None:
        self._time_ns = _nanoseconds(value)

    @property
    def dt(self) -> timedelta:
        """Length of the step; 0 while paused."""
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
    """Argument of `configure`; gz's binding has no methods on it either."""


class SystemPlugin(Protocol):
    """Plugin that represents a system of gz."""

    is_gz_system: bool

    def call(self, hook: str, info: UpdateInfo) -> None:
        """Call a hook of the system, if it has the hook."""


def systems_of(sim: Simulation) -> list[SystemPlugin]:
    """Return the plugins that represent systems of gz, in order, without disabled ones."""
    plugins: list[Any] = sim.engine.structure.all_plugins()
    return [p for p in plugins if getattr(p, "is_gz_system", False) and not sim.engine.faults.is_disabled(p)]


class SystemHub(SharedByCopies):
    """State that the systems of one simulation share.

    Attributes:
        ecm: entities of the simulation.
        first: first system, which stores the state of all.
        last: last system, which applies the commands.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim, self.ecm = sim, manager_of(sim)
        self._structure: WorldStructure | None = None
        self._fault_count = -1
        self.first: SystemPlugin | None = None
        self.last: SystemPlugin | None = None
        self._info = UpdateInfo(0, sim.engine.clock.time_ns(1), 0, False)

    def look(self) -> None:
        """Update `first` and `last` to the current systems."""
        structure, fault_count = self._sim.engine.structure, len(self._sim.engine.faults.get_state())
        if structure is not self._structure or fault_count != self._fault_count:
            systems = systems_of(self._sim)
            self.first, self.last = (systems[0], systems[-1]) if systems else (None, None)
            self._structure, self._fault_count = structure, fault_count

    def info(self, ahead: int) -> UpdateInfo:
        """Return the time for hooks, one object a step: the next step (`ahead` 1), or the finished one (0)."""
        tick = self._sim.tick + ahead
        info = self._info
        if info.iterations != tick:
            info = self._info = UpdateInfo(
                self._sim.engine.clock.time_ns(tick), self._sim.engine.clock.time_ns(1), tick, False
            )
        return info

    def carry_out(self) -> None:
        """Apply the commands of all systems."""
        if not self.ecm.commands.is_empty:
            self.ecm.commands.carry_out(self._sim, self.ecm.handle)


def hub_of(sim: Simulation) -> SystemHub:
    """Return the hub of a simulation; every simulation has one."""
    ecm = manager_of(sim)
    if not isinstance(ecm.hub, SystemHub):
        ecm.hub = SystemHub(sim)
    return ecm.hub


def update_paused(sim: Simulation) -> None:
    """Run one iteration with paused physics."""
    info = UpdateInfo(sim.time_ns, 0, sim.tick, True)
    for hook in ("pre_update", "update", "post_update"):
        for system in systems_of(sim):
            system.call(hook, info)
