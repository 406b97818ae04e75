"""`--set PATH=VALUE`: one value of a loaded scene replaced by another, before anything is built from it.

PATH is `physics`, `world`, `scene`, or a scoped entity, then element names with dots:
`tb3::base_scan::lds.update_rate`, `tb3::base_scan::lds.ray.scan.horizontal.samples`, `physics.max_step_size`,
`scene.quality`, `tb3::drive_plugin.max_wheel_torque`.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import replace
from typing import Any

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
    SceneWorld,
)
from simkit.scene.world import CONTACT_LAWS, QUALITIES

_CODE = "SK-CLI-014"
_PLACE = "--set "

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
    """The scene with each `PATH=VALUE` put in, in their order.

    Raises:
        InputError: SK-CLI-014 no such entity or element (the closest is named), or a value that does not fit.
    """
    for text in overrides:
        path, equals, value = text.partition("=")
        if not equals or not path.strip():
            raise _override_error(text, "allowed is PATH=VALUE, such as physics.max_step_size=0.002")
        scene = _Override(text, value.strip()).apply(scene, path.strip())
    return scene


def check_used(diagnostics: Iterable[Diagnostic]) -> None:
    """Raises for an override that nothing read: its element's name is unknown to the sensor or plugin.

    Raises:
        InputError: SK-CLI-014 with the closest name.
    """
    for found in diagnostics:
        if found.code == "SK-PARAM-003" and (found.file or "").startswith(_PLACE):
            raise InputError(
                f"{_CODE} {found.file}: {found.message}" + (f"; {found.hint}" if found.hint else ""), _CODE
            )


def _override_error(text: str, reason: str) -> InputError:
    return InputError(f"{_CODE} {_PLACE}{text}: {reason}", _CODE)


class _Override:
    """One override on its way through a scene."""

    def __init__(self, text: str, value: str) -> None:
        self.text, self.value = text, value

    # ------------------------------------------------------------------ finding the entity

    def apply(self, scene: Scene, path: str) -> Scene:
        if path.startswith(("physics.", "world.", "scene.")):
            if scene.model is not None and path.startswith("scene."):
                return replace(scene, around=self._world(replace(scene.world, models=(), lights=()), path))
            if not scene.worlds:
                raise _override_error(self.text, "the file is a bare model; it has no world")
            return replace(scene, worlds=(self._world(scene.worlds[0], path), *scene.worlds[1:]))
        names = sorted(_entities(scene), key=len, reverse=True)
        entity = next((n for n in names if path.startswith(n + ".")), None)
        if entity is None:
            asked = (
                path.rpartition("::")[0] + "::" + path.rpartition("::")[2].split(".")[0]
                if "::" in path
                else path.split(".")[0]
            )
            if path in (*names, "physics", "world", "scene"):
                raise _override_error(self.text, f"{path!r} needs an element, as in {path}.element=value")
            hint = did_you_mean(asked, [*names, "physics", "world", "scene"])
            raise _override_error(self.text, f"no entity {asked!r}; {hint or 'simkit inspect lists them'}")
        element = path[len(entity) + 1 :]
        worlds = tuple(self._in_world(w, entity, element) for w in scene.worlds)
        model = None if scene.model is None else self._in_model(scene.model, entity, element)
        return replace(scene, worlds=worlds, model=model)

    def _in_world(self, world: SceneWorld, entity: str, element: str) -> SceneWorld:
        return replace(
            world,
            models=tuple(self._in_model(m, entity, element) for m in world.models),
            lights=tuple(self._light(li, element) if li.scoped == entity else li for li in world.lights),
            joints=tuple(self._joint(j, element) if j.scoped == entity else j for j in world.joints),
            plugins=self._plugins(world.plugins, "", entity, element),
        )

    def _in_model(self, model: SceneModel, entity: str, element: str) -> SceneModel:
        if entity != model.scoped and not entity.startswith(model.scoped + "::"):
            return model
        model = replace(
            model,
            links=tuple(self._in_link(link, entity, element) for link in model.links),
            joints=tuple(self._in_joint(j, entity, element) for j in model.joints),
            models=tuple(self._in_model(m, entity, element) for m in model.models),
            plugins=self._plugins(model.plugins, model.scoped, entity, element),
        )
        return self._model(model, element) if entity == model.scoped else model

    def _in_link(self, link: SceneLink, entity: str, element: str) -> SceneLink:
        if entity != link.scoped and not entity.startswith(link.scoped + "::"):
            return link
        link = replace(
            link,
            sensors=self._sensors(link.sensors, entity, element),
            lights=tuple(self._light(li, element) if li.scoped == entity else li for li in link.lights),
            plugins=self._plugins(link.plugins, link.scoped, entity, element),
            collisions=tuple(self._collision(c, element) if c.scoped == entity else c for c in link.collisions),
            visuals=tuple(
                replace(v, plugins=self._plugins(v.plugins, v.scoped, entity, element)) if v.plugins else v
                for v in link.visuals
            ),
        )
        return self._link(link, element) if entity == link.scoped else link

    def _in_joint(self, joint: SceneJoint, entity: str, element: str) -> SceneJoint:
        joint = replace(joint, sensors=self._sensors(joint.sensors, entity, element))
        return self._joint(joint, element) if joint.scoped == entity else joint

    def _sensors(self, sensors: tuple[SceneSensor, ...], entity: str, element: str) -> tuple[SceneSensor, ...]:
        changed = (replace(s, plugins=self._plugins(s.plugins, s.scoped, entity, element)) for s in sensors)
        return tuple(self._sensor(s, element) if s.scoped == entity else s for s in changed)

    def _plugins(
        self, plugins: tuple[ScenePlugin, ...], owner: str, entity: str, element: str
    ) -> tuple[ScenePlugin, ...]:
        return tuple(
            replace(p, params=self._params(p.params, element)) if _join_path(owner, p.name) == entity else p
            for p in plugins
        )

    # ------------------------------------------------------------------ changing it

    def _world(self, world: SceneWorld, path: str) -> SceneWorld:
        room, _, element = path.partition(".")
        if room == "physics":
            self._known(element, _PHYSICS)
            if element == "sleep":
                return replace(world, physics=replace(world.physics, sleep=self._boolean()))
            if element == "contact_law":
                return replace(world, physics=replace(world.physics, contact_law=self._one_of(CONTACT_LAWS)))
            positive = element == "max_step_size"
            number = self._number(lambda v: math.isfinite(v) and (v > 0 if positive else v >= 0), "a positive number")
            return replace(world, physics=replace(world.physics, **_change_value(element, number)))
        if room == "scene":
            return self._scene(world, element)
        self._known(element, _WORLD)
        return replace(world, **_change_value(element, self._vector(_WORLD[element])))

    def _scene(self, world: SceneWorld, element: str) -> SceneWorld:
        """How pictures are drawn."""
        self._known(element, _SCENE)
        if element == "quality":
            return replace(world, quality=self._one_of(QUALITIES))
        if element in ("shadows", "sky"):
            return replace(world, surroundings=replace(world.surroundings, **_change_value(element, self._boolean())))
        red, green, blue = self._vector(3)
        if not all(0.0 <= part <= 1.0 for part in (red, green, blue)):
            raise _override_error(self.text, f"found {self.value!r}, allowed are red, green and blue from 0 to 1")
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
            return replace(
                light, intensity=self._number(lambda v: math.isfinite(v) and v >= 0, "a number of at least 0")
            )
        if element == "direction":
            x, y, z = self._vector(3)
            length = math.hypot(x, y, z)
            if length == 0:
                raise _override_error(self.text, "a direction must not be zero")
            unit = (x / length, y / length, z / length)
            world = light.pose_world.rotate(unit)
            return replace(light, direction=unit, direction_world=(float(world[0]), float(world[1]), float(world[2])))
        return replace(light, **_change_value(element, self._boolean()))

    def _collision(self, collision: SceneCollision, element: str) -> SceneCollision:
        self._known(element, list(_SURFACE))
        value = self._number(lambda v: math.isfinite(v) and v >= 0, "a number of at least 0")
        return replace(collision, surface=replace(collision.surface, **_change_value(_SURFACE[element], value)))

    def _sensor(self, sensor: SceneSensor, element: str) -> SceneSensor:
        if element == "update_rate":
            rate = self._number(lambda v: math.isfinite(v) and v >= 0, "a number of at least 0")
            return replace(sensor, rate=rate, params=self._params(sensor.params, element))
        if element == "topic":
            return replace(sensor, topic=self.value, params=self._params(sensor.params, element))
        if element in ("name", "type", "pose"):
            raise _override_error(self.text, f"<{element}> cannot be set")
        return replace(sensor, params=self._params(sensor.params, element))

    def _params(self, params: Params, element: str) -> Params:
        """A copy of the block in which the element has the value; one that is not there is added."""
        head, _, rest = element.partition(".")
        block = copy.copy(params)
        block.children = list(params.children)
        at = next((i for i, c in enumerate(block.children) if c.name == head), None)
        if at is None:
            old = Params(head, where=Where(_PLACE + self.text), diagnostics=params.diagnostics)
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
        new.value, new.where = self.value, Where(_PLACE + self.text)
        block.children[at] = new
        return block

    # ------------------------------------------------------------------ values

    def _known(self, element: str, allowed: Collection[str]) -> None:
        if element not in allowed:
            hint = did_you_mean(element, allowed) or "allowed are " + ", ".join(allowed)
            raise _override_error(self.text, f"no element {element!r} to set here; {hint}")

    def _number(self, fits: Callable[[float], bool], allowed: str) -> float:
        try:
            value = float(self.value)
        except ValueError:
            value = math.nan
        if math.isnan(value) or not fits(value):
            raise _override_error(self.text, f"found {self.value!r}, allowed is {allowed}")
        return value

    def _one_of(self, allowed: Sequence[str]) -> str:
        if self.value not in allowed:
            raise _override_error(self.text, f"found {self.value!r}, allowed is one of {', '.join(allowed)}")
        return self.value

    def _boolean(self) -> bool:
        folded = self.value.lower()
        if folded not in ("true", "false", "1", "0"):
            raise _override_error(self.text, f"found {self.value!r}, allowed is true, false, 1 or 0")
        return folded in ("true", "1")

    def _vector(self, size: int) -> tuple[float, ...]:
        try:
            values = tuple(float(v) for v in self.value.replace(",", " ").split())
        except ValueError:
            values = ()
        if len(values) != size or not all(math.isfinite(v) for v in values):
            raise _override_error(self.text, f"found {self.value!r}, allowed are {size} numbers")
        return values


def _change_value(name: str, value: object) -> dict[str, Any]:
    return {name: value}


def _join_path(owner: str, name: str) -> str:
    return f"{owner}::{name}" if owner else name


def _entities(scene: Scene) -> set[str]:
    """Every name that `--set` can begin with."""
    found: set[str] = set()
    models = [m for w in scene.worlds for m in w.models] + ([scene.model] if scene.model else [])
    for world in scene.worlds:
        found |= {li.scoped for li in world.lights} | {j.scoped for j in world.joints} | {p.name for p in world.plugins}
    for model in (nested for m in models for nested in m.all_models()):
        found.add(model.scoped)
        found |= {_join_path(model.scoped, p.name) for p in model.plugins}
        for link in model.links:
            found |= {link.scoped, *(c.scoped for c in link.collisions), *(li.scoped for li in link.lights)}
            found |= {_join_path(link.scoped, p.name) for p in link.plugins}
            found |= {_join_path(visual.scoped, p.name) for visual in link.visuals for p in visual.plugins}
        found |= {j.scoped for j in model.joints}
        owned = [link.sensors for link in model.links] + [joint.sensors for joint in model.joints]
        for sensor in (s for sensors in owned for s in sensors):
            found |= {sensor.scoped, *(_join_path(sensor.scoped, p.name) for p in sensor.plugins)}
    return found
