"""View of a simulation as entities by number: their records, simkit's handles of them, readings and commands."""

from __future__ import annotations

import copy
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from simkit.plugins.gz_python.sim.entity_table import EntityRecord, EntityTable, Handle
from simkit.plugins.gz_python.sim.physics_commands import PhysicsCommands
from simkit.plugins.shared_by_copies import SharedByCopies

if TYPE_CHECKING:
    from simkit.runtime import Simulation, WorldStructure


class EntityView(SharedByCopies):
    """Entities of a simulation by number; without a simulation it holds only entities and data made by hand.

    Args:
        sim: the simulation; None for none.

    Attributes:
        table: entities by number.
        commands: commands that wait for the next step.
        checks: readings that are turned on: (entity, reading) -> the tick at which each was.
        values: what is set of actors, by entity and name.
        custom: data of components made by hand, by component and entity.
        hub: what the systems of the simulation share; None before there is one.
        warned: warnings that were given, which are given once each.
        published: of a simulation, the joints whose state a plugin of gz publishes, by scoped name.
    """

    def __init__(self, sim: Simulation | None = None) -> None:
        self._sim: weakref.ref[Simulation] | None = weakref.ref(sim) if sim is not None else None
        self.hub: object = None
        self.warned: set[tuple[str, str]] = set()
        self._structure: WorldStructure | None = None
        self.table = EntityTable()
        self.commands = PhysicsCommands()
        self.checks: dict[tuple[int, str], int] = {}
        self.values: dict[tuple[int, str], object] = {}
        self.custom: dict[str, dict[int, object]] = {}
        self.published: Callable[[Simulation], frozenset[str]] = lambda _: frozenset()
        self._published: tuple[WorldStructure | None, frozenset[int]] = (None, frozenset())

    # ------------------------------------------------------------------ the simulation behind it

    @property
    def simulation(self) -> Simulation:
        """The simulation it shows.

        Raises:
            RuntimeError: it shows none.
        """
        sim = self._sim() if self._sim is not None else None
        if sim is None:
            raise RuntimeError("this EntityComponentManager shows no simulation; hooks are given one that does")
        return sim

    @property
    def is_live(self) -> bool:
        """Check whether it shows a simulation."""
        return self._sim is not None

    def sync(self) -> EntityTable:
        """The entities there are now."""
        if self._sim is not None:
            sim = self.simulation
            if sim.engine.structure is not self._structure:
                self._structure = sim.engine.structure
                self.table.rebuild(sim.world, list(sim.engine.structure.models.values()))
        return self.table

    def record(self, entity: int, kind: str = "") -> EntityRecord | None:
        """An entity, where it is there and of a kind."""
        found = self.sync().records.get(entity)
        return found if found is not None and (not kind or found.kind == kind) else None

    def handle(self, entity: int, kind: str) -> Handle:
        """simkit's handle of a model, link, joint, light or sensor; None where the entity is none, or not simulated."""
        record = self.record(entity, kind)
        if record is None:
            return None
        if record.handle is None:
            record.handle = self.simulation.contents.handles.tables[kind].get(record.scene.scoped)
        return record.handle

    # ------------------------------------------------------------------ readings that must be asked for

    def enable(self, entity: int, what: str, enable: bool) -> None:
        """Turns a reading on or off; as in gz-sim it is 0 until a step has passed."""
        if not enable:
            self.checks.pop((entity, what), None)
        else:
            self.checks.setdefault((entity, what), self.simulation.tick)

    def is_enabled(self, entity: int, what: str) -> bool | None:
        """None where a reading was not asked for; False until a step has passed since."""
        since = self.checks.get((entity, what))
        if since is None and what in ("position", "velocity") and entity in self._published_joints():
            since = 0
        return None if since is None else self.simulation.tick != since

    def _published_joints(self) -> frozenset[int]:
        """Joints of a JointStatePublisher: as in gz-sim it has position and velocity read for everybody."""
        sim = self.simulation
        if sim.tick == 0 or sim.engine.structure is not self._published[0]:  # while loading, plugins still come
            names = self.published(sim)
            own = (r.entity for r in self.sync() if r.kind == "joint" and r.scene.scoped in names)
            self._published = (sim.engine.structure, frozenset(own))
        return self._published[1]

    # ------------------------------------------------------------------ state

    def get_state(self) -> dict[str, object]:
        """Return the state that a snapshot keeps."""
        made = [r.entity for r in self.table.records.values() if not r.kind]
        return {
            "next": self.table.next,
            "numbers": dict(self.table.numbers),
            "made": made,
            "commands": self.commands.copy(),
            "checks": dict(self.checks),
            "values": copy.deepcopy(self.values),
            "custom": copy.deepcopy(self.custom),
        }

    def set_state(self, state: dict[str, Any]) -> None:
        """Back to a state from `get_state`."""
        self.table.next, self.table.numbers = state["next"], dict(state["numbers"])
        self.table.records = {entity: EntityRecord(entity, "", "", None, 0) for entity in state["made"]}
        self.commands, self.checks = state["commands"].copy(), dict(state["checks"])
        self.values, self.custom = copy.deepcopy(state["values"]), copy.deepcopy(state["custom"])
        self._structure = None
