"""Detachable joint of Gazebo: `gz::sim::systems::DetachableJoint`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.find_entities import find_named_link, read_required_name, read_topic
from simkit.plugins.joints.run_time_welds import close_weld, has_weld, open_weld
from simkit.plugins.options import Options, OptionsOf, boolean, text

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel

EMPTY: Final = "std_msgs/msg/Empty"
STRING: Final = "std_msgs/msg/String"


class DetachableJointOptions(Options):
    """Options of `DetachableJoint`."""

    parent_link: str = text(required=True)
    child_model: str = text(required=True)
    child_link: str = text(required=True)
    initial_attach: bool = boolean(True)
    suppress_child_warning: bool = boolean()
    topic: str = text()
    detach_topic: str = text()
    output_topic: str = text()
    attach_topic: str = text()


class DetachableJoint(ModelPlugin):
    """Attaches a link of another model to a link of this model; messages detach and attach the two links.

    Attached links keep the relative pose that they had at the moment of attachment. If the child model does not exist
    yet, its link is attached as soon as the model exists. Each change is published on the output topic, as "attached"
    or "detached".
    """

    endpoints = (
        listens("/model/{model}/detachable_joint/detach", EMPTY, named_by=("detach_topic", "topic")),
        listens("/model/{model}/detachable_joint/attach", EMPTY, named_by=("attach_topic",)),
        publishes("/model/{child_model}/detachable_joint/state", STRING, named_by=("output_topic",)),
    )
    options = OptionsOf(DetachableJointOptions)
    filenames = ("gz-sim-detachable-joint-system",)
    names = ("gz::sim::systems::DetachableJoint",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._own = scene.scoped
        self._parent = find_named_link(scene, "parent_link", params)
        self._child_model = read_required_name(params, "child_model")
        self._child_link = read_required_name(params, "child_link")
        self._shall_attach = self.options.initial_attach
        self._quiet = self.options.suppress_child_warning
        used_names = {name for record in builder.records.values() for name in record.equalities}
        base = f"{scene.scoped}#detachable"
        self._weld = next(name for k in range(len(used_names) + 1) if (name := f"{base}{k}") not in used_names)
        self._child = self._find((r.scene for r in builder.records.values()), params)
        if self._parent and self._child:
            builder.add_weld(self._weld, self._parent, self._child, active=self._shall_attach)

    def _find(self, models: Iterable[SceneModel], params: Params) -> str:
        """Return the scoped name of the child link, or warn and return an empty text."""
        models_by_name = {m.scoped: m for top in models for m in top.all_models()}
        name = self._own if self._child_model == "__model__" else self._child_model
        named = [m for scoped, m in models_by_name.items() if scoped == name or scoped.endswith("::" + name)]
        # if several models have that name, prefer a model inside this model
        inner = [m for m in named if m.scoped == name or m.scoped.startswith(self._own)] or named[:1]
        links = [link.scoped for m in inner for link in m.all_links() if link.scoped.endswith("::" + self._child_link)]
        if links:
            return links[0]
        if not self._quiet and not self._is_missing_reported:
            missing = f"link {self._child_link!r} of model {name!r}" if inner else f"model {name!r}"
            self._is_missing_reported = True
            hint = "if this is intended, add <suppress_child_warning>true</suppress_child_warning>"
            params.warning("SK-JOINT-013", f"plugin {self.name!r}: there is no {missing} to attach yet", hint)
        return ""

    _is_missing_reported = False

    def load(self, parent: Model, params: Params) -> None:
        topic_prefix = f"/model/{parent.name}/detachable_joint"
        old = self.options.topic
        detach = read_topic(params, "detach_topic" if params.has("detach_topic") else "topic", f"{topic_prefix}/detach")
        if old and valid_topic(old) != detach:
            message = f"<topic> is {old!r} and <detach_topic> is {detach!r}: <detach_topic> is used"
            params.diagnostics.warning("SK-PARAM-004", message, self.where)
        state = read_topic(params, "output_topic", f"/model/{self._child_model}/detachable_joint/state")
        self.listen(detach, EMPTY, self._on_detach)
        self.listen(read_topic(params, "attach_topic", f"{topic_prefix}/attach"), EMPTY, self._on_attach)
        self._state = self.advertise(state, STRING)
        # an initial attachment is published in the first step
        self._is_attached = False

    # ------------------------------------------------------------------ commands

    def _on_detach(self, _: object) -> None:
        if self._is_attached and open_weld(self.sim, self._weld):
            self._is_attached = False
            self._publish_state("detached")

    def _on_attach(self, _: object) -> None:
        if not (self._is_attached and self._is_there()):
            self._shall_attach, self._is_attached = True, False
            self._set_pace()

    def before_step(self) -> None:
        if self._is_attached and not self._is_there():
            self._is_attached = False
        if not self._shall_attach or self._is_attached or not self._parent:
            self._set_pace()
            return
        if not self._is_there():
            models = self.sim.engine.structure.models.values()
            self._child = self._find(models, self.params)
            if not self._child:
                return
        close_weld(self.sim, self._weld, self._parent, self._child)
        self._shall_attach, self._is_attached = False, True
        self._publish_state("attached")
        self._set_pace()

    # ------------------------------------------------------------------ inside

    def _is_there(self) -> bool:
        return has_weld(self.sim, self._weld)

    def _set_pace(self) -> None:
        """Call `before_step` at every step while a child link waits for its attachment, otherwise not at all."""
        self._set_before_step_rate(None if self._shall_attach and not self._is_attached else NEVER)

    def _publish_state(self, state: str) -> None:
        if self._state.wanted:
            self._state.publish(msgs.type_of(STRING)(state))
