"""Entity component manager: the interface of gz-sim's systems to a simulation."""

from __future__ import annotations

import weakref
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, NoReturn

from simkit.plugins.gz_python.math.missing_names import missing_name_error
from simkit.plugins.gz_python.sim import components
from simkit.plugins.gz_python.sim.entity_view import EntityView

if TYPE_CHECKING:
    from simkit.runtime import Simulation


class EntityComponentManager(EntityView):
    """Entities by number and their components, with the interface of gz-sim's Python.

    For a simulation it is a view: supported components of gz-sim are read from the simulation, and commands go to it.
    Without a simulation it holds only custom entities and data.
    """

    def create_entity(self) -> int:
        """Create an entity that is not part of the simulation."""
        self.sync()
        return self.table.make().entity

    def has_entity(self, entity: int) -> bool:
        return self.record(entity) is not None

    def entity_count(self) -> int:
        return len(self.sync().records)

    def parent_entity(self, entity: int) -> int:
        """Return the parent; 0 for the world and for entities without a parent."""
        record = self.record(entity)
        return record.parent if record is not None else 0

    def set_parent_entity(self, child: int, parent: int) -> bool:
        """Set the parent of a custom entity.

        Raises:
            NotImplementedError: the child comes from the world file.
        """
        record = self.record(child)
        if record is None or (parent and self.record(parent) is None):
            return False
        if record.kind:
            raise NotImplementedError(
                f"the parent of {record.kind} {record.name!r} is set by the world file and cannot change"
            )
        record.parent = parent
        return True

    def component(self, entity: int, kind: components.ComponentProxy) -> Any:
        """Return the data of a component; None if the entity does not have it."""
        return components.read_component(self, entity, kind)

    component_data = component  # its name in later versions

    def create_component(self, entity: int, kind: components.ComponentProxy, *data: object) -> None:
        """Set a component of an entity, or replace its data."""
        components.write_component(self, entity, kind, *data)

    def set_component_data(
        self, entity: int, kind: components.ComponentProxy, data: object, compare: bool = True
    ) -> bool:
        """Replace the data of a component; return false if it is unchanged and `compare` is set."""
        if compare and self.component(entity, kind) == data:
            return False
        self.create_component(entity, kind, data)
        return True

    def entity_has_component_type(self, entity: int, kind: components.ComponentProxy) -> bool:
        return self.component(entity, kind) is not None

    def remove_component(self, entity: int, kind: components.ComponentProxy) -> bool:
        """Remove a component that was set before; return true if it existed."""
        return components.remove_component(self, entity, kind)

    def set_changed(self, entity: int, kind: components.ComponentProxy, state: object = None) -> None:
        """Mark the data of a component as changed in place.

        Raises:
            NotImplementedError: the component is read-only, and keeps its value.
        """
        components.mark_changed(self, entity, kind)

    def each(self, kinds: Iterable[components.ComponentProxy]) -> Iterator[components.ComponentCursor]:
        """Yield entities with all the components, as one cursor with `.entity` and `.components`."""
        return components.each_entity(self, list(kinds))

    def each_data(self, *kinds: components.ComponentProxy) -> list[tuple[object, ...]]:
        """Return the same as a list, as in later versions: (entity, data, data, …)."""
        return [(item.entity, *item.components) for item in self.each(kinds)]

    def __getattr__(self, name: str) -> NoReturn:
        raise missing_name_error("EntityComponentManager", name, dir(type(self)))


_managers: weakref.WeakKeyDictionary[Simulation, EntityComponentManager] = weakref.WeakKeyDictionary()


def manager_of(sim: Simulation) -> EntityComponentManager:
    """Return the manager of a simulation; every simulation has one."""
    found = _managers.get(sim)
    if found is None:
        found = _managers[sim] = EntityComponentManager(sim)
    return found
