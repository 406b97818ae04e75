"""Base class of gz-sim's handles: a handle stores the number of an entity and reads its data through a manager."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar, NoReturn, TypeVar

from simkit_gz_python.math.missing_names import missing_name_error
from simkit_gz_python.sim.entity_table import K_NULL_ENTITY, EntityRecord, Handle, SceneObject
from simkit_gz_python.sim.entity_view import EntityView

E = TypeVar("E", bound="EntityHandle")


class EntityHandle:
    """Number of an entity, with methods for its data.

    Attributes:
        KIND: required kind of the entity.
    """

    KIND: ClassVar[str]

    def __init__(self, entity: EntityHandle | int = K_NULL_ENTITY) -> None:
        self._entity: int = entity._entity if isinstance(entity, EntityHandle) else int(entity)

    def entity(self) -> int:
        return self._entity

    def reset_entity(self, new_entity: int) -> None:
        """Set the number of the entity to which the handle refers."""
        self._entity = int(new_entity)

    def valid(self, ecm: EntityView) -> bool:
        """Check whether the entity exists and is of the kind `KIND`."""
        return self._record(ecm) is not None

    def name(self, ecm: EntityView) -> str | None:
        """Return the plain name of the entity; None if the entity does not exist."""
        record = ecm.record(self._entity)
        return record.name if record is not None else None

    def _record(self, ecm: EntityView) -> EntityRecord | None:
        return ecm.record(self._entity, self.KIND)

    def _handle(self, ecm: EntityView) -> Handle:
        return ecm.handle(self._entity, self.KIND)

    def _scene(self, ecm: EntityView) -> SceneObject:
        """Return the scene object of the entity; None if the entity does not exist."""
        record = self._record(ecm)
        return record.scene if record is not None else None

    def _parent(self, ecm: EntityView) -> int | None:
        record = self._record(ecm)
        return record.parent if record is not None else None

    def _enable(self, ecm: EntityView, reading: str, enable: bool) -> None:
        """Enable or disable a reading such as "velocity", if the entity exists."""
        if self.valid(ecm):
            ecm.enable(self._entity, reading, enable)

    def _reading(self, ecm: EntityView, what: str) -> bool | None:
        return ecm.is_enabled(self._entity, what)

    def __getattr__(self, name: str) -> NoReturn:
        raise missing_name_error(type(self).__name__, name, dir(type(self)))

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and isinstance(other, EntityHandle) and self._entity == other._entity

    def __hash__(self) -> int:
        return hash((type(self).__name__, self._entity))

    def __copy__(self: E) -> E:
        return type(self)(self._entity)

    def __deepcopy__(self: E, memo: dict[int, object]) -> E:
        return type(self)(self._entity)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self._entity}>"


ListChildren = Callable[[EntityHandle, EntityView], list[int]]
FindChild = Callable[[EntityHandle, EntityView, str], int]
CountChildren = Callable[[EntityHandle, EntityView], int]


def child_methods(kind: str) -> tuple[ListChildren, FindChild, CountChildren]:
    """Create three methods for the children of a kind: list, child by name (0 if there is none), and number."""

    def children(self: EntityHandle, ecm: EntityView) -> list[int]:
        return ecm.sync().below(self._entity, kind)

    def child_by_name(self: EntityHandle, ecm: EntityView, name: str) -> int:
        return ecm.sync().named(self._entity, kind, name)

    def child_count(self: EntityHandle, ecm: EntityView) -> int:
        return len(children(self, ecm))

    return children, child_by_name, child_count
