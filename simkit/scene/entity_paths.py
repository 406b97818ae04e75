"""Paths of the entities of a world, by which overrides find them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Final, TypeVar

from simkit.scene.differences import HELD_ENTITIES as HOLDER_FIELDS
from simkit.scene.model import ScenePlugin
from simkit.scene.override_fields import PHYSICS, SCENE, WORLD, Field
from simkit.scene.world import SceneActor, SceneWorld

AREAS: Final[dict[str, tuple[Field, ...]]] = {"physics": PHYSICS, "world": WORLD, "scene": SCENE}
"""Values of the world itself, by the first name of their paths."""

H = TypeVar("H")
Location = tuple[tuple[str, int], ...]
"""Fields and indices that lead from the world to an entity."""


@dataclass(frozen=True, slots=True)
class Entity:
    """Entity of a world.

    Attributes:
        path: name by which overrides find the entity.
        kind: kind of the entity: model, link, joint, collision, visual, sensor, light, plugin or actor.
        location: place of the entity in the world.
        area: name of the area for values of the world itself, else empty.
    """

    path: str
    kind: str
    location: Location
    area: str = ""

    @property
    def qualified(self) -> str:
        """Path that contains the kind, for several entities with one name: `m::l::visual(tyre)`."""
        outer, colons, last = self.path.rpartition("::")
        return f"{outer}{colons}{self.kind}({last})"


class EntityPaths:
    """Entities of a world by path.

    Attributes:
        world: the world; it may be replaced by a changed world with the same entities.
    """

    def __init__(self, world: SceneWorld) -> None:
        self.world = world
        self._by_path: dict[str, list[Entity]] = {}
        for area in AREAS:
            self._by_path.setdefault(area, []).append(Entity(area, "world", (), area))
        for entity in _entities(world, (), ""):
            self._by_path.setdefault(entity.path, []).append(entity)
            self._by_path.setdefault(entity.qualified, []).append(entity)

    def names(self) -> list[str]:
        """Return all names of entities, without those that contain a kind."""
        return [path for path in self._by_path if not path.endswith(")")]

    def has(self, path: str) -> bool:
        """Check whether an entity has this path."""
        return path in self._by_path

    def all(self) -> Iterator[Entity]:
        """Yield every entity once."""
        for path, entities in self._by_path.items():
            yield from (entity for entity in entities if entity.path == path)

    def shared(self, entity: Entity) -> bool:
        """Check whether another entity has the same path."""
        return len(self._by_path[entity.path]) > 1

    def item(self, entity: Entity) -> Any:
        """Return an entity's description in the present world."""
        item: Any = self.world
        for field, index in entity.location:
            item = getattr(item, field)[index]
        return item

    def holders(self, entity: Entity) -> list[Any]:
        """Return the descriptions that hold an entity, from the world down."""
        holders: list[Any] = []
        item: Any = self.world
        for field, index in entity.location:
            holders.append(item)
            item = getattr(item, field)[index]
        return holders

    def find(self, path: str) -> list[tuple[Entity, str]]:
        """Return the entities that a path names, each with the element below it.

        In names, `*` stands for any text without `::`, and `**` for any text.
        """
        dots = [i for i, letter in enumerate(path) if letter == "."]
        for dot in reversed(dots):
            if path[:dot] in self._by_path:
                return [(entity, path[dot + 1 :]) for entity in self._by_path[path[:dot]]]
        if "*" not in path and "?" not in path:
            return []
        start = max(path.rfind("*"), path.rfind("?"), path.rfind("::"))
        for dot in (i for i in dots if i > start):
            pattern = _pattern(path[:dot])
            matching = [e for name, entities in self._by_path.items() if pattern.fullmatch(name) for e in entities]
            if matching:
                return [(entity, path[dot + 1 :]) for entity in dict.fromkeys(matching)]
        return []


def _pattern(text: str) -> re.Pattern[str]:
    parts = (re.escape(part) for part in text.split("**"))
    return re.compile(".*".join(part.replace(r"\*", "(?:(?!::).)*").replace(r"\?", "[^:]") for part in parts))


def _entities(holder: object, location: Location, owner: str) -> Iterator[Entity]:
    for field in HOLDER_FIELDS.get(type(holder), ()):
        for index, item in enumerate(getattr(holder, field)):
            place = (*location, (field, index))
            path = item.name if isinstance(item, SceneActor) else getattr(item, "scoped", "")
            if isinstance(item, ScenePlugin):
                path = f"{owner}::{item.name}" if owner else item.name
            yield Entity(path, field.removesuffix("s"), place)
            yield from _entities(item, place, path)


def replace_at(holder: H, location: Location, new: Any) -> H:
    """Return a world in which the entity at a location is replaced; all other entities stay the same objects."""
    same: Any = holder
    changed: H = new
    if location:
        (field, index), *rest = location
        items = getattr(holder, field)
        inner = replace_at(items[index], tuple(rest), new)
        changed = replace(same, **{field: (*items[:index], inner, *items[index + 1 :])})
    return changed
