"""Base class of the entity component manager: entities by number, with simkit's handles, readings and commands."""

from __future__ import annotations

import copy
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from simkit.extend import SharedByCopies
from simkit_gz_python.sim.entity_table import EntityRecord, EntityTable, Handle
from simkit_gz_python.sim.physics_commands import PhysicsCommands

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.runtime import WorldStructure


class EntityView(SharedByCopies):
    """Entities of a simulation by number; without a simulation, only custom entities and custom data.

    Args:
        sim: simulation that contains the entities, or None.

    Attributes:
        table: entities by number.
        commands: commands for the next step.
        checks: enabled readings: the tick at which a reading was enabled, by (entity, reading).
        values: values that a system has set for an actor, by (entity, name of the value).
        custom: data of custom components, by name of the component and by entity.
        hub: `SystemHub` of the simulation; None until the first system needs it.
        warned: cause and scoped name of the warnings that were reported, so that no warning is reported twice.
        published: function that returns the scoped names of the joints whose states a gz plugin publishes.
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

    # ------------------------------------------------------------------ the simulation

    @property
    def simulation(self) -> Simulation:
        """Simulation that contains the entities.

        Raises:
            RuntimeError: the manager has no simulation.
        """
        sim = self._sim() if self._sim is not None else None
        if sim is None:
            raise RuntimeError("this EntityComponentManager has no simulation; use the one that a hook receives")
        return sim

    @property
    def is_live(self) -> bool:
        """True if the manager has a simulation."""
        return self._sim is not None

    def sync(self) -> EntityTable:
        """Update the table of entities if the world has changed, and return the table."""
        if self._sim is not None:
            sim = self.simulation
            if sim.engine.structure is not self._structure:
                self._structure = sim.engine.structure
                self.table.rebuild(sim.world, list(sim.engine.structure.models.values()))
        return self.table

    def record(self, entity: int, kind: str = "") -> EntityRecord | None:
        """Return the record of an entity; None if the entity does not exist or is of another kind than `kind`."""
        record = self.sync().records.get(entity)
        return record if record is not None and (not kind or record.kind == kind) else None

    def handle(self, entity: int, kind: str) -> Handle:
        """Return simkit's handle of an entity (model, link, joint, light or sensor); None if it is not simulated."""
        record = self.record(entity, kind)
        if record is None:
            return None
        if record.handle is None:
            record.handle = self.simulation.contents.handles.tables[kind].get(record.scene.scoped)
        return record.handle

    # ------------------------------------------------------------------ readings, which a system must enable

    def enable(self, entity: int, reading: str, enable: bool) -> None:
        """Enable or disable a reading. As in gz-sim, an enabled reading has no value before the next step."""
        if not enable:
            self.checks.pop((entity, reading), None)
        else:
            self.checks.setdefault((entity, reading), self.simulation.tick)

    def is_enabled(self, entity: int, reading: str) -> bool | None:
        """Return None for a disabled reading, False before the first step after `enable`, and True later."""
        since = self.checks.get((entity, reading))
        if since is None and reading in ("position", "velocity") and entity in self._published_joints():
            since = 0
        return None if since is None else self.simulation.tick != since

    def _published_joints(self) -> frozenset[int]:
        """Return the joints of JointStatePublisher plugins; as in gz-sim, their position and velocity are enabled."""
        sim = self.simulation
        if sim.tick == 0 or sim.engine.structure is not self._published[0]:  # at tick 0, the load may still add plugins
            names = self.published(sim)
            joints = (r.entity for r in self.sync() if r.kind == "joint" and r.scene.scoped in names)
            self._published = (sim.engine.structure, frozenset(joints))
        return self._published[1]

    # ------------------------------------------------------------------ state

    def get_state(self) -> dict[str, object]:
        """Return the state for a snapshot."""
        custom_entities = [r.entity for r in self.table.records.values() if not r.kind]
        return {
            "next": self.table.next,
            "numbers": dict(self.table.numbers),
            "made": custom_entities,
            "commands": self.commands.copy(),
            "checks": dict(self.checks),
            "values": copy.deepcopy(self.values),
            "custom": copy.deepcopy(self.custom),
        }

    def set_state(self, state: dict[str, Any]) -> None:
        """Restore a state from `get_state`."""
        self.table.next, self.table.numbers = state["next"], dict(state["numbers"])
        self.table.records = {entity: EntityRecord(entity, "", "", None, 0) for entity in state["made"]}
        self.commands, self.checks = state["commands"].copy(), dict(state["checks"])
        self.values, self.custom = copy.deepcopy(state["values"]), copy.deepcopy(state["custom"])
        self._structure = None
