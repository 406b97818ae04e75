"""The handles of everything in a simulation, by scoped name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import mujoco

from simkit.compiler.lights import drawn_position
from simkit.pose import Pose
from simkit.runtime.engine.world_structure import WorldStructure
from simkit.runtime.handles.handle import look_up
from simkit.runtime.handles.joint import Joint
from simkit.runtime.handles.light import Light
from simkit.runtime.handles.link import Link
from simkit.runtime.handles.model import Model
from simkit.runtime.handles.visual import Visual
from simkit.scene import SceneLink, SceneModel, SceneWorld

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation

_OBJECT_BY_PREFIX = {
    "geom": mujoco.mjtObj.mjOBJ_GEOM,
    "body": mujoco.mjtObj.mjOBJ_BODY,
    "jnt": mujoco.mjtObj.mjOBJ_JOINT,
    "light": mujoco.mjtObj.mjOBJ_LIGHT,
    "eq": mujoco.mjtObj.mjOBJ_EQUALITY,
    "actuator": mujoco.mjtObj.mjOBJ_ACTUATOR,
}


class EntityHandles:
    """Handles made once per entity of the file and bound anew to each structure."""

    def __init__(self, sim: Simulation, world: SceneWorld) -> None:
        self._sim, self._world = sim, world
        self._made: dict[int, tuple[Any, Model, dict[str, Light]]] = {}
        self._world_lights: dict[str, Light] | None = None
        self._world_joints: dict[str, Joint] | None = None
        self.models: dict[str, Model] = {}
        self.tables: dict[str, dict[str, Any]] = {}

    def bind(self, structure: WorldStructure) -> None:
        """Binds every handle of what is there now; the others say that they were removed."""
        if self._world_joints is None:
            self._world_joints = {j.name: Joint(self._sim, j) for j in self._world.joints}
        for _, model, lights in self._made.values():
            for handle in (*model.everything(), *lights.values()):
                handle._there = False
        self.models = {name: self._handles(scene)[0] for name, scene in structure.models.items()}
        tables: dict[str, dict[str, Any]] = {k: {} for k in ("model", "link", "joint", "light", "sensor")}
        names = structure.compiled.names
        for model in self.models.values():
            for handle in model.everything():
                handle._there = True
                if isinstance(handle, (Link, Joint)):
                    handle._bind(names)
                tables[type(handle).__name__.lower()][handle.scoped] = handle
        for name, joint in self._world_joints.items():
            joint._there = joint.scoped in names.joints
            if joint._there:
                joint._bind(names)
                tables["joint"][name] = joint
        tables["sensor"] = {s.scoped: s for s in structure.all_sensors()}
        self.tables = tables
        if self._world_lights is None:
            self._world_lights = {li.name: Light(self._sim, li) for li in self._world.lights}
        tables["light"].update(self._world_lights)
        for scene in structure.models.values():
            lights = self._lights(scene)
            for light in lights.values():
                light._there = True
            tables["light"].update(lights)

    def forget(self, living: Iterable[SceneModel]) -> None:
        """Lets go of the handles of models that nothing brings back any more."""
        there = {id(scene) for scene in living}
        self._made = {key: made for key, made in self._made.items() if key in there}

    def _handles(self, scene: SceneModel) -> tuple[Model, dict[str, Light]]:
        if id(scene) not in self._made:
            self._made[id(scene)] = (scene, Model(self._sim, scene), {})
        return self._made[id(scene)][1:]

    def _lights(self, scene: SceneModel) -> dict[str, Light]:
        lights = self._handles(scene)[1]
        if not lights:
            lights.update({li.scoped: Light(self._sim, li) for link in scene.all_links() for li in link.lights})
        return lights

    def find(self, what: str, name: str) -> Any:
        """A handle by scoped name; KeyError names the closest."""
        return look_up(self.tables[what], name, what)

    def find_visual(self, name: str) -> Visual:
        """A visual by scoped name; KeyError names the closest."""
        link: Link | None = self.tables["link"].get(name.rpartition("::")[0])
        if link is not None:
            found = next((v for v in link.visuals.values() if v.scoped == name), None)
            if found is not None:
                return found
        visual: Visual = look_up(self.visuals(), name, "visual")
        return visual

    def visuals(self) -> dict[str, Visual]:
        """All there are, by scoped name."""
        return {v.scoped: v for link in self.tables["link"].values() for v in link.visuals.values()}

    def scene_link(self, scoped: str) -> SceneLink:
        """A link of the file by scoped name."""
        link: SceneLink = self.find("link", scoped).scene
        return link

    def stateful(self) -> list[Any]:
        """Handles with a state of their own."""
        handles = [*self.tables["joint"].values(), *self.tables["light"].values()]
        return [*handles, self._sim.labels, self._sim.temperatures]


def draw_light(model: Any, light: Light, offset: Pose, touch: Any) -> None:
    """Puts the drawn light where the handle says, and lets it shine or not; one far away is drawn from nearer.

    Args:
        offset: of the link that carries it in the engine's body.
    """
    index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_LIGHT, light.scoped)
    if index < 0:
        return
    state = light.state
    pose = offset @ state.pose
    touch("light_pos")[index] = drawn_position(light.scene, pose.position)
    touch("light_dir")[index] = pose.rotate(light.scene.direction)
    if bool(model.light_active[index]) != state.on:
        touch("light_active")[index] = state.on


def copy_fields_by_name(old: Any, new: Any, fields: Mapping[str, Any]) -> list[str]:
    """Copies changed model fields to a recompiled model, element by element by name; returns their names."""
    for field in fields:
        source, target = getattr(old, field), getattr(new, field)
        if field.startswith("dof_"):  # without names of their own
            _copy_dof_field(old, new, source, target)
            continue
        kind = _OBJECT_BY_PREFIX[field.split("_")[0]]
        for i in range(len(source)):
            name = mujoco.mj_id2name(old, kind, i)
            j = mujoco.mj_name2id(new, kind, name) if name else -1
            if j >= 0:
                target[j] = source[i]
    return list(fields)


def restore_compiled_fields(model: Any, originals: Mapping[str, Any]) -> None:
    """Puts changed fields of a model that is left back: who returns to it brings along what was changed by then."""
    for field, original in originals.items():
        getattr(model, field)[:] = original


def _copy_dof_field(old: Any, new: Any, source: Any, target: Any) -> None:
    """The same of a field by degrees of freedom, which have the names of their joints."""
    widths = {int(mujoco.mjtJoint.mjJNT_FREE): 6, int(mujoco.mjtJoint.mjJNT_BALL): 3}
    for i in range(old.njnt):
        name = mujoco.mj_id2name(old, mujoco.mjtObj.mjOBJ_JOINT, i)
        j = mujoco.mj_name2id(new, mujoco.mjtObj.mjOBJ_JOINT, name) if name else -1
        if j >= 0:
            width = widths.get(int(old.jnt_type[i]), 1)
            a, b = int(old.jnt_dofadr[i]), int(new.jnt_dofadr[j])
            target[b : b + width] = source[a : a + width]
