"""Differences between two worlds that have the same entities."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, Final

from simkit.scene.model import SceneJoint, SceneLink, SceneModel, SceneSensor, SceneVisual
from simkit.scene.world import SceneWorld

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


HELD_ENTITIES: Final[dict[type, tuple[str, ...]]] = {
    SceneWorld: ("models", "lights", "joints", "plugins", "actors"),
    SceneModel: ("links", "joints", "models", "plugins"),
    SceneLink: ("collisions", "visuals", "sensors", "lights", "plugins"),
    SceneJoint: ("sensors", "plugins"),
    SceneSensor: ("plugins",),
    SceneVisual: ("plugins",),
}
"""Fields that hold further entities, by class of their holder."""


@dataclass(frozen=True, slots=True)
class EntityChange:
    """Entity that differs between two worlds.

    Attributes:
        old, new: the entity in both worlds.
        fields: names of the fields that differ, without the entities that it holds.
        owner: top-level model of the entity in the new world; None for an entity of the world itself.
    """

    old: Any
    new: Any
    fields: frozenset[str]
    owner: SceneModel | None


def entity_changes(old: SceneWorld, new: SceneWorld) -> list[EntityChange] | None:
    """Return the entities that differ between two worlds; None if one world has an entity that the other lacks."""
    try:
        return list(_changes(old, new, None))
    except _DifferentEntities:
        return None


class _DifferentEntities(Exception):
    """Two worlds have different entities."""


def _changes(old: DataclassInstance, new: object, owner: SceneModel | None) -> Iterator[EntityChange]:
    if old is new:
        return
    if type(old) is not type(new) or getattr(old, "name", "") != getattr(new, "name", ""):
        raise _DifferentEntities
    entities = HELD_ENTITIES.get(type(old), ())
    different = frozenset(
        field.name
        for field in fields(old)
        if field.name not in entities
        and field.name != "where"
        and _differ(getattr(old, field.name), getattr(new, field.name))
    )
    if different:
        yield EntityChange(old, new, different, owner)
    for name in entities:
        before, after = getattr(old, name), getattr(new, name)
        if before is after:
            continue
        if len(before) != len(after):
            raise _DifferentEntities
        for first, second in zip(before, after, strict=True):
            is_top = owner is None and isinstance(second, SceneModel)
            yield from _changes(first, second, second if is_top else owner)


def _differ(value: object, other: object) -> bool:
    return value is not other and value != other
