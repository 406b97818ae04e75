"""`--set PATH=VALUE`: replacement of one value of a loaded scene, before anything is built from the scene.

PATH is `physics`, `world`, `scene`, or a scoped entity, then element names with dots:
`tb3::base_scan::lds.update_rate`, `tb3::base_scan::lds.ray.scan.horizontal.samples`, `physics.max_step_size`,
`scene.quality`, `tb3::drive_plugin.max_wheel_torque`.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

from simkit.diagnostics import Diagnostic, Where, did_you_mean
from simkit.errors import InputError
from simkit.params import Params
from simkit.scene import (
    Scene,
    SceneCollision,
    SceneJoint,
    SceneLight,
    SceneLink,
    SceneModel,
    ScenePlugin,
    SceneSensor,
    SceneVisual,
    SceneWorld,
)
from simkit.scene.geometry import vec3
from simkit.scene.world import CONTACT_LAWS, QUALITIES

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

T = TypeVar("T", bound="DataclassInstance")
_Entity = SceneModel | SceneLink | SceneJoint | SceneLight | SceneCollision | SceneSensor | SceneVisual | ScenePlugin
_Tree = dict[str, "_Tree"]  # name of a field with entities -> fields of these entities that hold entities too

_SENSOR_TREE: _Tree = {"plugins": {}}
_LINK_TREE: _Tree = {
    "sensors": _SENSOR_TREE, "lights": {}, "plugins": {}, "collisions": {}, "visuals": {"plugins": {}}
}  # fmt: skip
_MODEL_TREE: _Tree = {"links": _LINK_TREE, "joints": {"sensors": _SENSOR_TREE}, "models": {}, "plugins": {}}
_MODEL_TREE["models"] = _MODEL_TREE
_WORLD_TREE: _Tree = {"models": _MODEL_TREE, "lights": {}, "joints": {}, "plugins": {}}

_CODE = "SK-CLI-014"
_SOURCE_PREFIX = "--set "

_PHYSICS = ("max_step_size", "real_time_factor", "sleep", "contact_law")
_WORLD = {"gravity": 3, "magnetic_field": 3}
_SCENE = ("quality", "shadows", "sky", "ambient", "background")
_LINK = ("gravity", "self_collide", "kinematic", "inertial.mass")
_MODEL = ("static", "self_collide", "allow_auto_disable")
_LIGHT = ("intensity", "cast_shadows", "on", "direction")
_AXIS = {
    "limit.lower": "lower",
    "limit.upper": "upper",
    "limit.effort": "effort",
    "limit.velocity": "velocity",
    "dynamics.damping": "damping",
    "dynamics.friction": "friction",
    "dynamics.spring_stiffness": "stiffness",
    "dynamics.spring_reference": "spring_ref",
}
_SURFACE = {
    "surface.friction.ode.mu": "mu",
    "surface.friction.ode.mu2": "mu2",
    "surface.bounce.restitution_coefficient": "restitution",
    "surface.contact.ode.kp": "kp",
    "surface.contact.ode.kd": "kd",
}


def apply_overrides(scene: Scene, overrides: Sequence[str]) -> Scene:
    """Return the scene with every `PATH=VALUE` applied, in the given order.

    Raises:
        InputError: SK-CLI-014 no such entity or element (the closest is named), or an invalid value.
    """
    for text in overrides:
        path, equals, value = text.partition("=")
        if not equals or not path.strip():
            raise _override_error(text, "write PATH=VALUE, such as physics.max_step_size=0.002")
        scene = _Override(text, value.strip()).apply(scene, path.strip())
    return scene


def check_used(diagnostics: Iterable[Diagnostic]) -> None:
    """Raise an error if an override was not read, because the sensor or plugin has no element of that name.

    Raises:
        InputError: SK-CLI-014 with the closest name.
    """
    for found in diagnostics:
        if found.code == "SK-PARAM-003" and (found.file or "").startswith(_SOURCE_PREFIX):
            hint = f"; {found.hint}" if found.hint else ""
            raise InputError(f"{_CODE} {found.file}: {found.message}{hint}", _CODE)


def _override_error(text: str, reason: str) -> InputError:
    return InputError(f"{_CODE} {_SOURCE_PREFIX}{text}: {reason}", _CODE)


class _Override:
    """One override, which returns changed copies of the scene's elements."""

    def __init__(self, text: str, value: str) -> None:
        self.text, self.value = text, value

    # ------------------------------------------------------------------ finding the entity

    def apply(self, scene: Scene, path: str) -> Scene:
        if path.startswith(("physics.", "world.", "scene.")):
            if scene.model is not None and path.startswith("scene."):
                return replace(scene, around=self._world(replace(scene.world, models=(), lights=()), path))
            if not scene.worlds:
                raise _override_error(self.text, "the file is a bare model without a world")
            return replace(scene, worlds=(self._world(scene.worlds[0], path), *scene.worlds[1:]))
        names = sorted(_entities(scene), key=len, reverse=True)
        entity = next((n for n in names if path.startswith(n + ".")), None)
        if entity is None:
            outer, colons, last = path.rpartition("::")
            unknown = outer + colons + last.split(".")[0]
            if path in (*names, "physics", "world", "scene"):
                raise _override_error(self.text, f"{path!r} needs an element, as in {path}.element=value")
            hint = did_you_mean(unknown, [*names, "physics", "world", "scene"])
            raise _override_error(self.text, f"no entity {unknown!r}; {hint or 'simkit inspect lists all entities'}")
        element = path[len(entity) + 1 :]
        worlds = tuple(self._inside(world, _WORLD_TREE, "", entity, element) for world in scene.worlds)
        model = scene.model
        if model is not None:
            model = self._inside(model, _MODEL_TREE, model.scoped, entity, element)
            model = self._model(model, element) if model.scoped == entity else model
        return replace(scene, worlds=worlds, model=model)

    def _inside(self, holder: T, tree: _Tree, owner: str, entity: str, element: str) -> T:
        """Return a copy of a world, model or link in which the entity has the new value, at any depth.

        Args:
            holder: the world, model or link.
            tree: the fields of the holder that are searched.
            owner: scoped name of the holder; empty for a world.
            entity: scoped name of the entity to change.
            element: path of the element to set, with dots.
        """
        changes: dict[str, object] = {}
        for field, below in tree.items():
            items = []
            for item in getattr(holder, field):
                changed = self._inside(item, below, item.scoped, entity, element) if below else item
                items.append(self._change(changed, element) if _path_of(item, owner) == entity else changed)
            changes[field] = tuple(items)
        return replace(holder, **changes)

    def _change(self, item: object, element: str) -> object:
        match item:
            case SceneModel():
                return self._model(item, element)
            case SceneLink():
                return self._link(item, element)
            case SceneJoint():
                return self._joint(item, element)
            case SceneLight():
                return self._light(item, element)
            case SceneCollision():
                return self._collision(item, element)
            case SceneSensor():
                return self._sensor(item, element)
            case ScenePlugin():
                return replace(item, params=self._params(item.params, element))
        return item

    # ------------------------------------------------------------------ changing it

    def _world(self, world: SceneWorld, path: str) -> SceneWorld:
        area, _, element = path.partition(".")
        if area == "physics":
            self._known(element, _PHYSICS)
            if element == "sleep":
                return replace(world, physics=replace(world.physics, sleep=self._boolean()))
            if element == "contact_law":
                return replace(world, physics=replace(world.physics, contact_law=self._one_of(CONTACT_LAWS)))
            positive = element == "max_step_size"
            number = self._number(lambda v: math.isfinite(v) and (v > 0 if positive else v >= 0), "a positive number")
            return replace(world, physics=replace(world.physics, **_change_value(element, number)))
        if area == "scene":
            return self._scene(world, element)
        self._known(element, _WORLD)
        return replace(world, **_change_value(element, self._vector(_WORLD[element])))

    def _scene(self, world: SceneWorld, element: str) -> SceneWorld:
        """Return a copy of the world with a changed `<scene>` setting."""
        self._known(element, _SCENE)
        if element == "quality":
            return replace(world, quality=self._one_of(QUALITIES))
        if element in ("shadows", "sky"):
            return replace(world, surroundings=replace(world.surroundings, **_change_value(element, self._boolean())))
        red, green, blue = self._vector(3)
        if not all(0.0 <= part <= 1.0 for part in (red, green, blue)):
            raise _override_error(self.text, f"found {self.value!r}; expected red, green and blue from 0 to 1")
        colour = (red, green, blue, 1.0)
        return replace(world, surroundings=replace(world.surroundings, **_change_value(element, colour)))

    def _model(self, model: SceneModel, element: str) -> SceneModel:
        self._known(element, _MODEL)
        return replace(model, **_change_value(element, self._boolean()))

    def _link(self, link: SceneLink, element: str) -> SceneLink:
        self._known(element, _LINK)
        if element == "inertial.mass":
            mass = self._number(lambda v: math.isfinite(v) and v > 0, "a positive number")
            return replace(link, inertial=replace(link.inertial, mass=mass, given=True))
        return replace(link, **_change_value(element, self._boolean()))

    def _joint(self, joint: SceneJoint, element: str) -> SceneJoint:
        head, _, rest = element.partition(".")
        if head not in ("axis", "axis2") or rest not in _AXIS:
            self._known(element, [f"{a}.{k}" for a in ("axis", "axis2") for k in _AXIS])
        number = 1 if head == "axis2" else 0
        if number >= len(joint.axes):
            raise _override_error(self.text, f"joint {joint.scoped!r} has {len(joint.axes)} axes")
        value = self._number(lambda v: not math.isnan(v), "a number")
        axes = tuple(
            replace(a, **_change_value(_AXIS[rest], value)) if i == number else a for i, a in enumerate(joint.axes)
        )
        return replace(joint, axes=axes)

    def _light(self, light: SceneLight, element: str) -> SceneLight:
        self._known(element, _LIGHT)
        if element == "intensity":
            return replace(light, intensity=self._non_negative())
        if element == "direction":
            x, y, z = self._vector(3)
            length = math.hypot(x, y, z)
            if length == 0:
                raise _override_error(self.text, "a direction must not be zero")
            unit = (x / length, y / length, z / length)
            return replace(light, direction=unit, direction_world=vec3(light.pose_world.rotate(unit)))
        return replace(light, **_change_value(element, self._boolean()))

    def _collision(self, collision: SceneCollision, element: str) -> SceneCollision:
        self._known(element, list(_SURFACE))
        surface = replace(collision.surface, **_change_value(_SURFACE[element], self._non_negative()))
        return replace(collision, surface=surface)

    def _sensor(self, sensor: SceneSensor, element: str) -> SceneSensor:
        if element == "update_rate":
            sensor = replace(sensor, rate=self._non_negative())
        elif element == "topic":
            sensor = replace(sensor, topic=self.value)
        elif element in ("name", "type", "pose"):
            raise _override_error(self.text, f"<{element}> cannot be set")
        return replace(sensor, params=self._params(sensor.params, element))

    def _params(self, params: Params, element: str) -> Params:
        """Return a copy of the block in which the element has the new value; a missing element is added."""
        head, _, rest = element.partition(".")
        block = copy.copy(params)
        block.children = list(params.children)
        at = next((i for i, c in enumerate(block.children) if c.name == head), None)
        if at is None:
            old = Params(head, where=Where(_SOURCE_PREFIX + self.text), diagnostics=params.diagnostics)
            at = len(block.children)
            block.children.append(old)
        old = block.children[at]
        if rest:
            block.children[at] = self._params(old, rest)
            return block
        if old.children:
            inner = ", ".join(dict.fromkeys(c.name for c in old.children))
            raise _override_error(self.text, f"<{head}> holds elements; name one of them: {inner}")
        new = copy.copy(old)
        new.value, new.where = self.value, Where(_SOURCE_PREFIX + self.text)
        block.children[at] = new
        return block

    # ------------------------------------------------------------------ values

    def _known(self, element: str, allowed: Collection[str]) -> None:
        if element not in allowed:
            hint = did_you_mean(element, allowed) or "expected " + ", ".join(allowed)
            raise _override_error(self.text, f"the element {element!r} cannot be set here; {hint}")

    def _number(self, fits: Callable[[float], bool], allowed: str) -> float:
        try:
            value = float(self.value)
        except ValueError:
            value = math.nan
        if math.isnan(value) or not fits(value):
            raise _override_error(self.text, f"found {self.value!r}; expected {allowed}")
        return value

    def _non_negative(self) -> float:
        return self._number(lambda v: math.isfinite(v) and v >= 0, "a number of at least 0")

    def _one_of(self, allowed: Sequence[str]) -> str:
        if self.value not in allowed:
            raise _override_error(self.text, f"found {self.value!r}; expected one of {', '.join(allowed)}")
        return self.value

    def _boolean(self) -> bool:
        folded = self.value.lower()
        if folded not in ("true", "false", "1", "0"):
            raise _override_error(self.text, f"found {self.value!r}; expected true, false, 1 or 0")
        return folded in ("true", "1")

    def _vector(self, size: int) -> tuple[float, ...]:
        try:
            values = tuple(float(v) for v in self.value.replace(",", " ").split())
        except ValueError:
            values = ()
        if len(values) != size or not all(math.isfinite(v) for v in values):
            raise _override_error(self.text, f"found {self.value!r}; expected {size} numbers")
        return values


def _change_value(name: str, value: object) -> dict[str, Any]:
    return {name: value}


def _path_of(item: _Entity, owner: str) -> str:
    """Return the name of an entity in `--set`; empty for a visual, because only the plugins of a visual can be set."""
    if isinstance(item, ScenePlugin):
        return f"{owner}::{item.name}" if owner else item.name
    return "" if isinstance(item, SceneVisual) else item.scoped


def _entities(scene: Scene) -> set[str]:
    """Return every name that `--set` can begin with."""
    found = {path for world in scene.worlds for path in _paths(world, _WORLD_TREE, "")}
    if scene.model is not None:
        found |= {scene.model.scoped, *_paths(scene.model, _MODEL_TREE, scene.model.scoped)}
    return found - {""}


def _paths(holder: object, tree: _Tree, owner: str) -> Iterator[str]:
    for field, below in tree.items():
        for item in getattr(holder, field):
            yield _path_of(item, owner)
            yield from _paths(item, below, item.scoped)
