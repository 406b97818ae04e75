"""External forces of Gazebo on links and joints.

The systems are `gz::sim::systems::ApplyLinkWrench` and `gz::sim::systems::ApplyJointForce`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeVar

import numpy as np

from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin, WorldPlugin
from simkit.plugins.endpoints import listens
from simkit.plugins.find_entities import read_required_name, read_topic
from simkit.plugins.joints.joint_axis import JointAxis, find_joints
from simkit.plugins.joints.joint_commands import DOUBLE
from simkit.plugins.one_time_warnings import are_usable
from simkit.plugins.options import Options, OptionsOf, blocks, boolean, choice, text, texts, vector3
from simkit.plugins.world.service_entities import RequestRefused, entity_of
from simkit.pose import Vector

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import Entity, EntityWrench, Float64, Vector3
    from simkit.runtime import Link, Model, Simulation
    from simkit.scene import SceneModel

ENTITY: Final = "ros_gz_interfaces/msg/Entity"
ENTITY_WRENCH: Final = "ros_gz_interfaces/msg/EntityWrench"
T = TypeVar("T")

_ANY, _MODEL, _LINK = 0, 2, 3
_TYPES: Final = {"model": _MODEL, "link": _LINK}


@dataclass(frozen=True)
class _Wrench:
    """Persistent wrench on an entity: force [N] and torque [N·m] in the world frame."""

    name: str
    type: int
    force: tuple[float, float, float]
    torque: tuple[float, float, float]


class PersistentWrenchOptions(Options):
    """Options of a `<persistent>` block."""

    entity_name: str = text(required=True)
    entity_type: str = choice(("model", "link"), "link")
    force: tuple[float, float, float] = vector3(unit="N")
    torque: tuple[float, float, float] = vector3(unit="N·m")


class ApplyLinkWrenchOptions(Options):
    """Options of `ApplyLinkWrench`."""

    verbose: bool = boolean(True)
    persistent: tuple[PersistentWrenchOptions, ...] = blocks(PersistentWrenchOptions)
    topic: str = text()
    topic_persistent: str = text()
    topic_clear: str = text()


class ApplyLinkWrench(WorldPlugin):
    """Applies wrenches in the world frame at the centre of mass of a link, or of a model's canonical link.

    A `<persistent>` element, or a message on `/world/<world>/wrench/persistent`, applies a wrench at every step. This
    wrench ends when a message on `/world/<world>/wrench/clear` names the entity. A message on `/world/<world>/wrench`
    applies a wrench in the next step only. If an entity does not exist yet, its persistent wrenches start as soon as
    the entity exists. Messages contain the name or the id of an entity.
    """

    options = OptionsOf(ApplyLinkWrenchOptions)
    filenames = ("gz-sim-apply-link-wrench-system",)
    names = ("gz::sim::systems::ApplyLinkWrench",)

    def load(self, parent: Simulation, params: Params) -> None:
        self._verbose = self.options.verbose
        self._persistent = [w for block in self.options.persistent if (w := self._read(block)) is not None]
        self._set_wrenches()
        base = f"/world/{parent.world.name}/wrench"
        self.listen(read_topic(params, "topic", base), ENTITY_WRENCH, self._on_wrench)
        self.listen(read_topic(params, "topic_persistent", f"{base}/persistent"), ENTITY_WRENCH, self._on_persistent)
        self.listen(read_topic(params, "topic_clear", f"{base}/clear"), ENTITY, self._on_clear)

    def _read(self, options: PersistentWrenchOptions) -> _Wrench | None:
        element = options.params
        name = read_required_name(element, "entity_name")
        force, torque = options.force, options.torque
        is_typed, kind = element.has("entity_type"), options.entity_type
        if not is_typed:
            element.error("SK-PARAM-001", "<persistent> needs <entity_type>: model or link")
        if not name or not is_typed:
            return None
        wrench = _Wrench(name, _TYPES[kind], force, torque)
        if self._target(name, wrench.type) is None:
            self.params.warning("SK-JOINT-013", f"plugin {self.name!r}: there is no {kind} {name!r} to push yet")
        return wrench

    def _target(self, name: str, kind: int) -> Link | None:
        """Return the link that a name refers to: an exact match, or the first scoped name that ends with `::<name>`."""
        tables = self.sim.contents.handles.tables
        if kind != _MODEL:
            link = _find_entity(tables["link"], name)
            if link is not None or kind == _LINK:
                return link
        model = _find_entity(tables["model"], name)
        if model is None or not model.scene.canonical_link:
            return None
        return self.sim.link(model.scene.canonical_link)

    def set_state(self, state: Mapping[str, object]) -> None:
        """Restore a state from `get_state`."""
        super().set_state(state)
        self._set_wrenches(are_applied=True)

    # ------------------------------------------------------------------ commands

    def _on_wrench(self, message: EntityWrench) -> None:
        wrench = self._read_wrench(message)
        if wrench is None:
            return
        link = self._target(wrench.name, wrench.type)
        if link is None:
            self.log.warning("%s: there is no entity %r to push", self.name, wrench.name)
            return
        link.apply_wrench(wrench.force, wrench.torque)
        self._log_if_verbose("pushes %s for one step", wrench.name)

    def _on_persistent(self, message: EntityWrench) -> None:
        wrench = self._read_wrench(message)
        if wrench is None:
            return
        self._persistent = [*self._persistent, wrench]
        self._log_if_verbose("pushes %s until it is cleared", wrench.name)
        self._set_wrenches()

    def _on_clear(self, message: Entity) -> None:
        name_and_kind = self._name_and_type(message)
        if name_and_kind is None:
            return
        name, kind = name_and_kind
        cleared = self._target(name, kind)
        remaining = []
        for wrench in self._persistent:
            target = self._target(wrench.name, wrench.type)
            is_same = target is cleared if cleared is not None else wrench.name == name
            if not is_same:
                remaining.append(wrench)
        self._log_if_verbose("no longer pushes %s", name)
        self._persistent = remaining
        self._set_wrenches()

    def before_step(self) -> None:
        self._set_wrenches()

    # ------------------------------------------------------------------ inside

    def _read_wrench(self, message: EntityWrench) -> _Wrench | None:
        name_and_kind = self._name_and_type(message.entity)
        force, torque = _xyz(message.wrench.force), _xyz(message.wrench.torque)
        if not are_usable(*force, *torque):
            self._once.not_finite("a wrench")
            return None
        return None if name_and_kind is None else _Wrench(*name_and_kind, force, torque)

    def _name_and_type(self, entity: Entity) -> tuple[str, int] | None:
        """Return the name and type of the entity in a message, or log a warning and return None."""
        if entity.type not in (_ANY, _MODEL, _LINK):
            self.log.warning("%s: only models and links can be pushed, found type %d", self.name, entity.type)
            return None
        if entity.name:
            return entity.name.removeprefix(f"{self.sim.world.name}::"), entity.type
        try:
            kind, name = entity_of(self.sim, entity, tuple(_TYPES))
        except RequestRefused as error:
            self.log.warning("%s: %s", self.name, error)
            return None
        return name, _TYPES[kind]

    def _set_wrenches(self, *, are_applied: bool = False) -> None:
        """Set the sum of all persistent wrenches.

        While an entity is missing, `before_step` calls this method at every step. Otherwise one call is enough, because
        the engine applies the wrenches until they change.
        """
        total: dict[str, Vector] = {}
        is_missing = False
        for wrench in self._persistent:
            link = self._target(wrench.name, wrench.type)
            if link is None:
                is_missing = True
            else:
                both = np.array((*wrench.force, *wrench.torque))
                total[link.scoped] = total.get(link.scoped, np.zeros(6)) + both
        self.sim.engine.wrenches.set(self, total, are_applied=are_applied)
        self._set_before_step_rate(None if is_missing else NEVER)

    def _log_if_verbose(self, text: str, name: str) -> None:
        if self._verbose:
            self.log.info("%s: " + text, self.name, name)


def _xyz(vector: Vector3) -> tuple[float, float, float]:
    return float(vector.x), float(vector.y), float(vector.z)


def _find_entity(table: Mapping[str, T], name: str) -> T | None:
    if name in table:
        return table[name]
    return next((handle for scoped, handle in table.items() if scoped.endswith("::" + name)), None)


class ApplyJointForceOptions(Options):
    """Options of `ApplyJointForce`."""

    joint_name: tuple[str, ...] = texts(required=True)


class ApplyJointForce(ModelPlugin):
    """Applies the effort [N·m or N] of the last message to the first axis of a joint, at every step.

    The topic of the commands is `/model/<model>/joint/<joint>/cmd_force`. The effort is added to the efforts of earlier
    plugins in the file. A later plugin that sets the joint's effort replaces this sum, as in Gazebo.
    """

    endpoints = (listens("/model/{model}/joint/{joint_name}/cmd_force", DOUBLE),)
    options = OptionsOf(ApplyJointForceOptions)
    filenames = ("gz-sim-apply-joint-force-system",)
    names = ("gz::sim::systems::ApplyJointForce",)
    drives = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        names = params.all("joint_name")
        for extra in names[1:]:
            message = f"plugin {self.name!r} uses one <joint_name>; {extra.value!r} is not used"
            params.diagnostics.warning("SK-PLUGIN-044", message, extra.where, "add one plugin for each joint")
        joints = find_joints(scene, params, most=1)
        self._scoped = joints[0].scoped if joints else ""
        self._joint_name = names[0].value if names else ""

    def load(self, parent: Model, params: Params) -> None:
        self._axis = JointAxis(self.sim.joint(self._scoped)) if self._scoped else None
        self._effort = 0.0
        self.listen(valid_topic(f"/model/{parent.name}/joint/{self._joint_name}/cmd_force"), DOUBLE, self._on_command)

    def _on_command(self, message: Float64) -> None:
        effort = float(message.data)
        if are_usable(effort):
            self._effort = effort
        else:
            self._once.left_out("finite", f"the command {effort} is ignored; expected a finite number up to 1e10")

    def explain_divergence(self, name: str) -> str:
        """Describe the effort of this plugin on a joint whose physics diverged, or return an empty text."""
        if not self._effort or self._axis is None or not self._axis.is_meant(name):
            return ""
        return f"plugin {self.name!r} ({self.where}) pushes joint {self._axis.joint.scoped!r} with {self._effort:g}"

    def before_step(self) -> None:
        if self._effort and self._axis is not None:
            self._axis.add(self._effort)
