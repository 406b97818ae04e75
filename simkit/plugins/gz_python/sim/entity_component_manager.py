"""The entity component manager: what systems of gz-sim see of a simulation."""

from __future__ import annotations

import copy
import weakref
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Final

from simkit.plugins.gz_python.math.missing_names import missing_name_error
from simkit.plugins.gz_python.sim.entity_table import EntityRecord, EntityTable
from simkit.plugins.gz_python.sim.physics_commands import PhysicsCommands

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_INSTEAD: Final = {
    "request_remove_entity": "use simkit's own sim.remove(name)",
    "clone": "use simkit's own sim.spawn(source, name)",
    "entity_by_components": "use Model.link_by_name, World.model_by_name and their like, or each",
    "children_by_components": "use Model.links, Link.collisions and their like, or each",
    "entities_by_components": "use World.models, Model.links and their like, or each",
    "component_types": "use entity_has_component_type",
    "state": "use simkit's own sim.snapshot()",
    "changed_state": "use simkit's own sim.snapshot()",
    "descendants": "use Model.links, Model.models and their like",
    "pin_entity": "entities are never taken away by levels",
    **dict.fromkeys(("each_new", "each_new_data", "each_removed", "each_removed_data"), "use each_data and has_entity"),
    "component_state": "use component_data: nothing is sent of components, so none is marked as changed",
}


class EntityComponentManager:
    """Entities by number, and what they have.

    Of a simulation it is a view: components of gz-sim that simkit has a twin of are read from the simulation and
    commands among them go to it. Made by itself it holds only what is put into it.

    Attributes:
        published: of a simulation, the joints whose state a plugin of gz publishes, by scoped name.
    """

    def __init__(self) -> None:
        self._sim: weakref.ref[Simulation] | None = None
        self._structure: Any = None
        self.table = EntityTable()
        self.commands = PhysicsCommands()
        self.checks: dict[tuple[int, str], int] = {}
        self.values: dict[tuple[int, str], Any] = {}
        self.custom: dict[str, dict[int, Any]] = {}
        self.published: Callable[[Any], frozenset[str]] = lambda _: frozenset()
        self._published: tuple[Any, frozenset[int]] = (None, frozenset())

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
        """Whether it shows a simulation."""
        return self._sim is not None

    def sync(self) -> EntityTable:
        """The entities there are now."""
        if self._sim is not None:
            sim = self.simulation
            if sim.structure is not self._structure:
                self._structure = sim.structure
                self.table.rebuild(sim.world, list(sim.structure.models.values()))
        return self.table

    def record(self, entity: int, kind: str = "") -> EntityRecord | None:
        """An entity, where it is there and of a kind."""
        found = self.sync().records.get(entity)
        return found if found is not None and (not kind or found.kind == kind) else None

    def handle(self, entity: int, kind: str) -> Any:
        """simkit's handle of a model, link, joint, light or sensor; None where the entity is none, or not simulated."""
        record = self.record(entity, kind)
        if record is None:
            return None
        if record.handle is None:
            record.handle = self.simulation.entities.tables[kind].get(record.scene.scoped)
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
        if sim.tick == 0 or sim.structure is not self._published[0]:  # while loading, plugins still come
            names = self.published(sim)
            own = (r.entity for r in self.sync() if r.kind == "joint" and r.scene.scoped in names)
            self._published = (sim.structure, frozenset(own))
        return self._published[1]

    # ------------------------------------------------------------------ state

    def get_state(self) -> dict[str, Any]:
        """What a snapshot has to keep."""
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

    def __deepcopy__(self, memo: dict[int, Any]) -> EntityComponentManager:
        return self

    # ------------------------------------------------------------------ what gz-sim's binding offers

    def create_entity(self) -> int:
        """A new entity that nothing of the simulation knows."""
        self.sync()
        return self.table.make().entity

    def has_entity(self, entity: int) -> bool:
        return self.record(entity) is not None

    def entity_count(self) -> int:
        return len(self.sync().records)

    def parent_entity(self, entity: int) -> int:
        """0 of the world and of what has no parent."""
        record = self.record(entity)
        return record.parent if record is not None else 0

    def set_parent_entity(self, child: int, parent: int) -> bool:
        """Hangs an entity made by hand below another one.

        Raises:
            NotImplementedError: the child is of the world's file.
        """
        record = self.record(child)
        if record is None or (parent and self.record(parent) is None):
            return False
        if record.kind:
            raise NotImplementedError(f"{record.kind} {record.name!r} is of the file; its parent stays what it is")
        record.parent = parent
        return True

    def component(self, entity: int, kind: Any) -> Any:
        """The data of a component; None where the entity has none."""
        from simkit.plugins.gz_python.sim import components

        return components.read_component(self, entity, kind)

    component_data = component  # its name in later versions

    def create_component(self, entity: int, kind: Any, *data: Any) -> None:
        """Gives an entity a component, or other data to the one it has."""
        from simkit.plugins.gz_python.sim import components

        components.write_component(self, entity, kind, *data)

    def set_component_data(self, entity: int, kind: Any, data: Any, compare: bool = True) -> bool:
        """Other data for a component; False where it had the same and `compare`."""
        if compare and self.component(entity, kind) == data:
            return False
        self.create_component(entity, kind, data)
        return True

    def entity_has_component_type(self, entity: int, kind: Any) -> bool:
        return self.component(entity, kind) is not None

    def remove_component(self, entity: int, kind: Any) -> bool:
        """Takes a component away that was given from here; whether it was there."""
        from simkit.plugins.gz_python.sim import components

        return components.remove_component(self, entity, kind)

    def set_changed(self, entity: int, kind: Any, state: Any = None) -> None:
        """Says that the data of a component was changed in place.

        Raises:
            NotImplementedError: of something that the simulation says, which then stays as it is.
        """
        from simkit.plugins.gz_python.sim import components

        components.mark_changed(self, entity, kind)

    def each(self, kinds: Any) -> Iterator[Any]:
        """Entities that have every one of some components: `.entity`, `.components`; one object moves along."""
        from simkit.plugins.gz_python.sim import components

        return components.each_entity(self, list(kinds))

    def each_data(self, *kinds: Any) -> list[tuple[Any, ...]]:
        """The same as a list, as later versions have it: (entity, data, data, …)."""
        return [(item.entity, *item.components) for item in self.each(kinds)]

    def __getattr__(self, name: str) -> Any:
        raise missing_name_error("EntityComponentManager", name, dir(type(self)), _INSTEAD)


_managers: weakref.WeakKeyDictionary[Any, EntityComponentManager] = weakref.WeakKeyDictionary()


def manager_of(sim: Simulation) -> EntityComponentManager:
    """The one manager of a simulation."""
    found = _managers.get(sim)
    if found is None:
        found = _managers[sim] = EntityComponentManager()
        found._sim = weakref.ref(sim)
    return found
