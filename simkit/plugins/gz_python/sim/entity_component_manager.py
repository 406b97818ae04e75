"""The entity component manager: what systems of gz-sim see of a simulation."""

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
    """Entities by number and their components, as gz-sim's Python offers them.

    Of a simulation it is a view: components of gz-sim that simkit has a twin of are read from the simulation and
    commands among them go to it. Made by itself it holds only what is put into it.
    """

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

    def component(self, entity: int, kind: components.ComponentProxy) -> Any:
        """The data of a component; None where the entity has none."""
        return components.read_component(self, entity, kind)

    component_data = component  # its name in later versions

    def create_component(self, entity: int, kind: components.ComponentProxy, *data: object) -> None:
        """Gives an entity a component, or other data to the one it has."""
        components.write_component(self, entity, kind, *data)

    def set_component_data(
        self, entity: int, kind: components.ComponentProxy, data: object, compare: bool = True
    ) -> bool:
        """Other data for a component; False where it had the same and `compare`."""
        if compare and self.component(entity, kind) == data:
            return False
        self.create_component(entity, kind, data)
        return True

    def entity_has_component_type(self, entity: int, kind: components.ComponentProxy) -> bool:
        return self.component(entity, kind) is not None

    def remove_component(self, entity: int, kind: components.ComponentProxy) -> bool:
        """Takes a component away that was given from here; whether it was there."""
        return components.remove_component(self, entity, kind)

    def set_changed(self, entity: int, kind: components.ComponentProxy, state: object = None) -> None:
        """Says that the data of a component was changed in place.

        Raises:
            NotImplementedError: of something that the simulation says, which then stays as it is.
        """
        components.mark_changed(self, entity, kind)

    def each(self, kinds: Iterable[components.ComponentProxy]) -> Iterator[components.ComponentCursor]:
        """Entities that have every one of some components: `.entity`, `.components`; one object moves along."""
        return components.each_entity(self, list(kinds))

    def each_data(self, *kinds: components.ComponentProxy) -> list[tuple[object, ...]]:
        """The same as a list, as later versions have it: (entity, data, data, …)."""
        return [(item.entity, *item.components) for item in self.each(kinds)]

    def __getattr__(self, name: str) -> NoReturn:
        raise missing_name_error("EntityComponentManager", name, dir(type(self)))


_managers: weakref.WeakKeyDictionary[Simulation, EntityComponentManager] = weakref.WeakKeyDictionary()


def manager_of(sim: Simulation) -> EntityComponentManager:
    """Return the one manager of a simulation."""
    found = _managers.get(sim)
    if found is None:
        found = _managers[sim] = EntityComponentManager(sim)
    return found
