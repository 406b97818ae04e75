"""The systems of gz that hang on a simulation, and what is done once for all of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from simkit.plugins.gz_python.sim.entity_component_manager import manager_of
from simkit.plugins.gz_python.sim.update_info import UpdateInfo

if TYPE_CHECKING:
    from simkit.runtime import Simulation, WorldStructure


class SystemPlugin(Protocol):
    """A plugin that stands for a system of gz."""

    is_gz_system: bool

    def call(self, hook: str, info: UpdateInfo) -> None:
        """Calls a hook of the system, where it has it."""


def systems_of(sim: Simulation) -> list[SystemPlugin]:
    """The plugins that stand for systems of gz, in order, without those that raised and are left out."""
    plugins: list[Any] = sim.engine.structure.all_plugins()
    return [p for p in plugins if getattr(p, "is_gz_system", False) and not sim.engine.faults.is_disabled(p)]


class SystemHub:
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

    def __deepcopy__(self, memo: dict[int, object]) -> SystemHub:
        return self


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
