"""Handles of all entities in a simulation, by scoped name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from simkit.argument_checks import check_kind
from simkit.runtime.engine.velocity_limits import NO_LIMIT, LimitedDof
from simkit.runtime.handles.handle import look_up
from simkit.runtime.handles.joint import Joint
from simkit.runtime.handles.light import Light
from simkit.runtime.handles.link import Link
from simkit.runtime.handles.model import Model
from simkit.runtime.handles.visual import Labels, Temperatures, Visual
from simkit.scene import SceneLight, SceneLink, SceneModel

if TYPE_CHECKING:
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.engine.entity_structure import WorldStructure
    from simkit.runtime.engine.snapshot import Stateful

HandleTables = dict[str, dict[str, Any]]
"""Handles and sensors by kind and scoped name."""


class EntityHandles:
    """Handles that are made once per entity of the file and bound to each new structure.

    Args:
        engine: engine of the entities.
        make_movable: function that makes a static top-level model movable, by its name.

    Attributes:
        engine: engine of the entities.
        make_movable: function that makes a static top-level model movable, by its name.
        models: top-level models by name.
        tables: models, links, joints, lights and sensors, by kind and scoped name.
        labels: labels for segmentation and bounding box cameras, by scoped name of a model or a visual.
        temperatures: temperatures for thermal cameras, by scoped name of a model, a link or a visual.
        exact_limits: joints whose velocity limit is enforced at every step.
    """

    def __init__(self, engine: Engine, make_movable: Callable[[str], None]) -> None:
        self.engine, self.make_movable, self._world = engine, make_movable, engine.world
        self.labels, self.temperatures = Labels(self), Temperatures(self)
        self.exact_limits: list[Joint] = []
        self._by_scene: dict[int, tuple[SceneModel, Model, dict[str, Light]]] = {}
        self._world_lights: dict[str, Light] | None = None
        self._world_joints: dict[str, Joint] | None = None
        self.models: dict[str, Model] = {}
        self.tables: HandleTables = {}

    def bind(self, structure: WorldStructure) -> None:
        """Bind the handles of present entities; mark all others as removed."""
        if self._world_joints is None:
            self._world_joints = {j.name: Joint(self, j) for j in self._world.joints}
        for _, model, lights in self._by_scene.values():
            for handle in (*model.everything(), *lights.values()):
                handle.mark_present(False)
        self.models = {name: self._model_handles(scene)[0] for name, scene in structure.models.items()}
        tables: HandleTables = {k: {} for k in ("model", "link", "joint", "light", "sensor")}
        names = structure.compiled.names
        for model in self.models.values():
            for handle in model.everything():
                handle.mark_present()
                if isinstance(handle, (Link, Joint)):
                    handle.bind(names)
                tables[type(handle).__name__.lower()][handle.scoped] = handle
        for name, joint in self._world_joints.items():
            joint.mark_present(joint.scoped in names.joints)
            if joint.is_present:
                joint.bind(names)
                tables["joint"][name] = joint
        tables["sensor"] = {s.scoped: s for s in structure.all_sensors()}
        self.tables = tables
        if self._world_lights is None:
            self._world_lights = {li.name: Light(self, li) for li in self._world.lights}
        tables["light"].update(self._world_lights)
        for scene in structure.models.values():
            lights = self._lights(scene)
            for light in lights.values():
                light.mark_present()
            tables["light"].update(lights)

    def close(self) -> None:
        """End the presence of all handles, because the simulation is closed."""
        lights = [light for _, _, lights in self._by_scene.values() for light in lights.values()]
        handles = [handle for _, model, _ in self._by_scene.values() for handle in model.everything()]
        for handle in (*handles, *lights, *(self._world_lights or {}).values(), *(self._world_joints or {}).values()):
            handle.mark_present(False)

    @property
    def count(self) -> int:
        """Number of top-level models that have handles, including removed models that a restore may bring back."""
        return len(self._by_scene)

    def forget(self, living: Iterable[SceneModel]) -> None:
        """Drop the handles of models that nothing can bring back."""
        living_ids = {id(scene) for scene in living}
        self._by_scene = {key: handles for key, handles in self._by_scene.items() if key in living_ids}

    def _model_handles(self, scene: SceneModel) -> tuple[Model, dict[str, Light]]:
        if id(scene) not in self._by_scene:
            self._by_scene[id(scene)] = (scene, Model(self, scene), {})
        return self._by_scene[id(scene)][1:]

    def replace_scenes(self, old: Mapping[str, SceneModel], new: Mapping[str, SceneModel]) -> None:
        """Make the handles of top-level models refer to changed descriptions with the same entities."""
        for name, scene in new.items():
            _, model, lights = self._by_scene.pop(id(old[name]))
            self._by_scene[id(scene)] = (scene, model, lights)
            model.replace_scene(scene)

    def replace_lights(self, lights: Iterable[SceneLight]) -> None:
        """Make the handles of the world's lights refer to changed descriptions."""
        for scene in lights:
            light = (self._world_lights or {}).get(scene.name)
            if light is not None and light.scene is not scene:
                light.replace_scene(scene)

    def _lights(self, scene: SceneModel) -> dict[str, Light]:
        lights = self._model_handles(scene)[1]
        if not lights:
            lights.update({li.scoped: Light(self, li) for link in scene.all_links() for li in link.lights})
        return lights

    def set_values(self, values: Mapping[tuple[str, str, str], object]) -> None:
        """Set attributes of present handles by kind, scoped name and attribute; entities that are gone are left out."""
        for (kind, scoped, attribute), value in values.items():
            link = self.tables["link"].get(scoped.rpartition("::")[0]) if kind == "collision" else None
            handle = (
                self.tables.get(kind, {}).get(scoped) if link is None else link.collisions.get(scoped.split("::")[-1])
            )
            if handle is not None:
                setattr(handle, attribute, value)

    def find(self, kind: str, name: str) -> Any:
        """Return a handle by kind and scoped name; a KeyError suggests the closest name."""
        return look_up(self.tables[kind], name, kind)

    def find_visual(self, name: str) -> Visual:
        """Return a visual by scoped name; a KeyError suggests the closest name."""
        check_kind(name, str, "the name of a visual", "a text")
        link: Link | None = self.tables["link"].get(name.rpartition("::")[0])
        if link is not None:
            visual = next((v for v in link.visuals.values() if v.scoped == name), None)
            if visual is not None:
                return visual
        return look_up(self.visuals(), name, "visual")

    def visuals(self) -> dict[str, Visual]:
        """Return all visuals by scoped name."""
        return {v.scoped: v for link in self.tables["link"].values() for v in link.visuals.values()}

    def scene_link(self, scoped: str) -> SceneLink:
        """Return a link of the file by scoped name."""
        link: SceneLink = self.find("link", scoped).scene
        return link

    def link(self, name: str) -> Link:
        """Return a link by scoped name; a KeyError suggests the closest name."""
        link: Link = self.find("link", name)
        return link

    def model(self, name: str) -> Model:
        """Return a model by scoped name; a KeyError suggests the closest name."""
        model: Model = self.find("model", name)
        return model

    def joint(self, name: str) -> Joint:
        """Return a joint by scoped name; a KeyError suggests the closest name."""
        joint: Joint = self.find("joint", name)
        return joint

    def light(self, name: str) -> Light:
        """Return a light by scoped name; a KeyError suggests the closest name."""
        light: Light = self.find("light", name)
        return light

    def limit_velocity(self, joint: Joint) -> None:
        """Enforce a joint's velocity limit at every step from now on."""
        if joint not in self.exact_limits:
            self.exact_limits.append(joint)
        self.engine.reschedule()

    def limited_dofs(self) -> tuple[list[LimitedDof], list[LimitedDof]]:
        """Return the degrees of freedom whose velocity limit is enforced at every step, and the others with a limit."""
        moving = [joint for joint in self.tables["joint"].values() if joint.mj_dofs]
        exact = [joint for joint in moving if joint in self.exact_limits]
        others = [j for j in moving if j not in self.exact_limits and j.least_velocity_limit < NO_LIMIT]
        return [dof for joint in exact for dof in joint.limited_dofs()], [d for j in others for d in j.limited_dofs()]

    def velocity_limits(self) -> list[object]:
        """Return the array of each joint's velocity limits [rad/s or m/s], which a change replaces."""
        return [joint.get_state()[1] for joint in self.tables["joint"].values()]

    def velocity_limit(self, name: str, axis: int) -> float:
        """Return the velocity limit of a joint's axis [rad/s or m/s]."""
        return self.joint(name).axis_velocity_limit(axis)

    def stateful(self) -> list[Stateful]:
        """Return the handles with a state of their own, except models."""
        handles = [*self.tables["joint"].values(), *self.tables["light"].values()]
        return [*handles, self.labels, self.temperatures]
