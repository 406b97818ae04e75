"""Table of entities: each world, model, link, … has a number, which stays the same until the end of the run.

As in gz-sim, the world is 1, its wind 2 and its default level 3. The next numbers follow gz-sim's order of creation:
first the models, then the actors, then the lights of the world. Within a model the order is: the model, its links (each
with its visuals, collisions, lights and sensors), its nested models, its joints (each with its sensors).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Final

from simkit.extend import SceneLink, SceneModel, SceneWorld

K_NULL_ENTITY: Final = 0
"""Number that means "no entity"; the constant has gz-sim's name."""

WORLD_ENTITY: Final = 1
FIRST_ENTITY: Final = 4
"""Number of the first entity after world, wind and level."""


# simkit's handle for the kind of the entity: a Model, Link, Joint, Light, Sensor, ...
Handle = Any
# The scene's object for the kind of the entity: a SceneModel, SceneLink, SceneJoint, ...
SceneObject = Any


@dataclass(slots=True)
class EntityRecord:
    """Data of one entity.

    Attributes:
        entity: number of the entity.
        kind: world, model, link, joint, visual, collision, light, sensor or actor; empty for a custom entity.
        name: plain name.
        scene: scene object of the entity; None for a custom entity.
        parent: number of the parent entity; 0 for the world.
        children: numbers of the children, in the order of their creation.
        handle: simkit's handle of the entity; None before the first access.
    """

    entity: int
    kind: str
    name: str
    scene: SceneObject
    parent: int
    children: list[int] = field(default_factory=list)
    handle: Handle = None


Key = tuple[str, int]
"""Kind and `id()` of a scene object. `numbers` also stores the object, so that no other object gets the same `id()`."""


class EntityTable:
    """Table of a simulation's entities by number; an entity keeps its number as long as it exists."""

    def __init__(self) -> None:
        self.records: dict[int, EntityRecord] = {}
        self.numbers: dict[Key, tuple[int, object]] = {}
        self.next = FIRST_ENTITY

    def make(self, parent: int = 0) -> EntityRecord:
        """Create a custom entity."""
        record = EntityRecord(self.next, "", "", None, parent)
        self.records[record.entity] = record
        self.next += 1
        return record

    def rebuild(self, world: SceneWorld, models: list[SceneModel]) -> None:
        """Fill the table with the entities of the current world; custom entities stay."""
        custom = [record for record in self.records.values() if not record.kind]
        self.records = {WORLD_ENTITY: EntityRecord(WORLD_ENTITY, "world", world.name, world, 0)}
        for entity, kind in ((2, "wind"), (3, "level")):
            self.records[entity] = EntityRecord(entity, kind, kind, None, WORLD_ENTITY)
        for model in models:
            if model.moved_by is None:  # models of actors are added as actors below
                self._add_model(model, WORLD_ENTITY)
        for actor in world.actors:
            self._add("actor", actor, WORLD_ENTITY)
        for light in world.lights:
            self._add("light", light, WORLD_ENTITY)
        self.records.update((record.entity, record) for record in custom)

    def _add(self, kind: str, scene: SceneObject, parent: int) -> int:
        key = (kind, id(scene))
        if key not in self.numbers:
            self.numbers[key] = (self.next, scene)
            self.next += 1
        entity = self.numbers[key][0]
        self.records[entity] = EntityRecord(entity, kind, scene.name, scene, parent)
        self.records[parent].children.append(entity)
        return entity

    def _add_model(self, model: SceneModel, parent: int) -> None:
        entity = self._add("model", model, parent)
        for link in model.links:
            self._add_link(link, entity)
        for nested in model.models:
            self._add_model(nested, entity)
        for joint in model.joints:
            joint_entity = self._add("joint", joint, entity)
            for sensor in joint.sensors:
                self._add("sensor", sensor, joint_entity)

    def _add_link(self, link: SceneLink, parent: int) -> None:
        entity = self._add("link", link, parent)
        kinds = {"visual": link.visuals, "collision": link.collisions, "light": link.lights, "sensor": link.sensors}
        for kind, scenes in kinds.items():
            for scene in scenes:
                self._add(kind, scene, entity)

    def below(self, entity: int, kind: str) -> list[int]:
        """Return the children of a kind, in the order of their creation."""
        record = self.records.get(entity)
        if record is None:
            return []
        return [child for child in record.children if self.records[child].kind == kind]

    def named(self, entity: int, kind: str, name: str) -> int:
        """Return the child with this kind and plain name; 0 if there is none."""
        return next((child for child in self.below(entity, kind) if self.records[child].name == name), 0)

    def link(self, scoped: str) -> EntityRecord | None:
        """Return the record of the link with this scoped name; None if there is none."""
        return next((record for record in self if record.kind == "link" and record.scene.scoped == scoped), None)

    def __iter__(self) -> Iterator[EntityRecord]:
        return iter([self.records[entity] for entity in sorted(self.records)])
