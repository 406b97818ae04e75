"""Systems of gz that hang on a simulation: the time that their hooks get, and what is done once for all of them."""

from __future__ import annotations

from datetime import timedelta
from typing import TYPE_CHECKING, Any, Protocol

from simkit.plugins.gz_python.sim.entity_component_manager import manager_of
from simkit.plugins.shared_by_copies import SharedByCopies

if TYPE_CHECKING:
    from simkit.runtime import Simulation, WorldStructure


class UpdateInfo:
    """The time of an update.

    Attributes:
        iterations: steps, the one this update belongs to included.
        paused: whether the physics stands still.
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
        """The simulated time too: what depends on the machine's clock would make runs differ."""
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
    """Handed to `configure`; gz's binding offers nothing on it either."""


class SystemPlugin(Protocol):
    """A plugin that stands for a system of gz."""

    is_gz_system: bool

    def call(self, hook: str, info: UpdateInfo) -> None:
        """Calls a hook of the system, where it has it."""


def systems_of(sim: Simulation) -> list[SystemPlugin]:
    """The plugins that stand for systems of gz, in order, without those that raised and are left out."""
    plugins: list[Any] = sim.engine.structure.all_plugins()
    return [p for p in plugins if getattr(p, "is_gz_system", False) and not sim.engine.faults.is_disabled(p)]


class SystemHub(SharedByCopies):
    """State that the systems of one simulation share.

    Attributes:
        ecm: the entities.
        first, last: the first and the last system; the one keeps the state of all, the other carries out commands.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim, self.ecm = sim, manager_of(sim)
        self._structure: WorldStructure | None = None
        self._count = -1
        self.first: SystemPlugin | None = None
        self.last: SystemPlugin | None = None
        self._info = UpdateInfo(0, sim.engine.clock.time_ns(1), 0, False)

    def look(self) -> None:
        """Takes note of who is there now."""
        structure, out = self._sim.engine.structure, len(self._sim.engine.faults.get_state())
        if structure is not self._structure or out != self._count:
            systems = systems_of(self._sim)
            self.first, self.last = (systems[0], systems[-1]) if systems else (None, None)
            self._structure, self._count = structure, out

    def info(self, ahead: int) -> UpdateInfo:
        """The time for hooks: of the step that comes (`ahead` 1) or that is done (0); one object for all of a step."""
        tick = self._sim.tick + ahead
        info = self._info
        if info.iterations != tick:
            info = self._info = UpdateInfo(
                self._sim.engine.clock.time_ns(tick), self._sim.engine.clock.time_ns(1), tick, False
            )
        return info

    def carry_out(self) -> None:
        """Puts the commands of all systems into effect."""
        if not self.ecm.commands.is_empty:
            self.ecm.commands.carry_out(self._sim, self.ecm.handle)


def hub_of(sim: Simulation) -> SystemHub:
    """The one hub of a simulation."""
    ecm = manager_of(sim)
    if not isinstance(ecm.hub, SystemHub):
        ecm.hub = SystemHub(sim)
    return ecm.hub


def update_paused(sim: Simulation) -> None:
    """One iteration in which the physics stands still."""
    info = UpdateInfo(sim.time_ns, 0, sim.tick, True)
    for hook in ("pre_update", "update", "post_update"):
        for system in systems_of(sim):
            system.call(hook, info)
