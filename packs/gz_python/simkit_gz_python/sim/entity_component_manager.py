"""Entity component manager: the object through which systems of gz-sim access a simulation."""

from __future__ import annotations

import weakref
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, NoReturn

from simkit_gz_python.math.missing_names import missing_name_error
from simkit_gz_python.sim import components
from simkit_gz_python.sim.entity_view import EntityView

if TYPE_CHECKING:
    from simkit import Simulation


class EntityComponentManager(EntityView):
    """Entities and their components, with the interface of gz-sim's Python class of this name.

    The manager of a simulation reads components from the simulation and sends commands to it. A manager without a
    simulation only stores custom entities and custom data.
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
        """Return the number of the parent entity; 0 for the world and for entities without a parent."""
        record = self.record(entity)
        return record.parent if record is not None else 0

    def set_parent_entity(self, child: int, parent: int) -> bool:
        """Set the parent of a custom entity; return false if one of the two entities does not exist.

        Raises:
            NotImplementedError: the child is described in the world file.
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

    component_data = component  # later versions of gz-sim use this name

    def create_component(self, entity: int, kind: components.ComponentProxy, *data: object) -> None:
        """Set a component of an entity, or replace its data."""
        components.write_component(self, entity, kind, *data)

    def set_component_data(
        self, entity: int, kind: components.ComponentProxy, data: object, compare: bool = True
    ) -> bool:
        """Set the data of a component; return false, with `compare`, if the component already has this data."""
        if compare and self.component(entity, kind) == data:
            return False
        self.create_component(entity, kind, data)
        return True

    def entity_has_component_type(self, entity: int, kind: components.ComponentProxy) -> bool:
        return self.component(entity, kind) is not None

    def remove_component(self, entity: int, kind: components.ComponentProxy) -> bool:
        """Remove a component that a system has set; return false if no system has set the component."""
        return components.remove_component(self, entity, kind)

    def set_changed(self, entity: int, kind: components.ComponentProxy, state: object = None) -> None:
        """Tell the manager that the data of a component was changed in place.

        Raises:
            NotImplementedError: the component is read-only, so a change in place has no effect.
        """
        components.mark_changed(self, entity, kind)

    def each(self, kinds: Iterable[components.ComponentProxy]) -> Iterator[components.ComponentCursor]:
        """Yield a cursor with `.entity` and `.components` for each entity that has all the components."""
        return components.each_entity(self, list(kinds))

    def each_data(self, *kinds: components.ComponentProxy) -> list[tuple[object, ...]]:
        """Return (entity, data, data, …) for each entity with all the components, as later versions of gz-sim do."""
        return [(item.entity, *item.components) for item in self.each(kinds)]

    def __getattr__(self, name: str) -> NoReturn:
        raise missing_name_error("EntityComponentManager", name, dir(type(self)))


_managers: weakref.WeakKeyDictionary[Simulation, EntityComponentManager] = weakref.WeakKeyDictionary()


def manager_of(sim: Simulation) -> EntityComponentManager:
    """Return the manager of a simulation; the first call creates it."""
    manager = _managers.get(sim)
    if manager is None:
        manager = _managers[sim] = EntityComponentManager(sim)
    return manager
