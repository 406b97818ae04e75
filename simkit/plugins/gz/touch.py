"""Touch detector of Gazebo: `gz::sim::systems::TouchPlugin`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, ClassVar, Final, cast

from simkit import msgs
from simkit.diagnostics import did_you_mean
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.plugins.endpoints import listens, offers, publishes
from simkit.plugins.find_entities import read_required_name
from simkit.plugins.options import Options, OptionsOf, boolean, number, text, texts
from simkit.runtime.contact.collision_contacts import Bools, collision_table, find_contacts

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneCollision, SceneModel
    from simkit.sensors.devices.contact import Contact

BOOL: Final = "std_msgs/msg/Bool"
SET_BOOL: Final = "std_srvs/srv/SetBool"


class TouchOptions(Options):
    """Options shared by touch detectors."""

    target: str = text(required=True)
    time: float = number(None, "s", minimum=0.0, maximum=1e9, required=True)
    namespace: str = text(required=True)
    enabled: bool = boolean()


class TouchTimer(ModelPlugin):
    """Base class of the touch detectors of Gazebo and Gazebo Classic: measures the time of uninterrupted contact."""

    options = OptionsOf(TouchOptions)
    reads_contacts: ClassVar[bool] = True
    message_type: ClassVar[str] = BOOL
    is_exclusive: ClassVar[bool] = False  # True if contact with any other object interrupts the time

    def _read_common(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._target = read_required_name(params, "target")
        self._duration = round(self.options.time * 1e9)  # [ns]
        self._topic = valid_topic(self.options.namespace)
        if self._topic == "/" and params.has("namespace"):
            params.error("SK-PARAM-002", "found a <namespace> without a letter or digit; expected a topic's name")
        self._links = frozenset(link.scoped for link in scene.links)
        self._is_enabled = self.options.enabled
        self._world = builder.world.name

    def _watch(self, watched: Iterable[str], params: Params) -> None:
        """Open the topics, and start to watch the collisions with these scoped names."""
        self._touched = self.advertise(f"{self._topic}/touched", self.message_type)
        self.listen(f"{self._topic}/enable", self.message_type, self._on_enable)
        self._watched = frozenset(watched)
        self._since = -1  # start of the contact [ns]; -1 without contact
        self._set_pace()
        names = collision_table(self.sim.engine.compiled).names
        if not any(self._is_target(name) for name in names):
            message = f"plugin {self.name!r}: no collision has {self._target!r} in its name yet"
            models = sorted({part for name in names for part in name.split("::")})
            params.diagnostics.warning("SK-SENSOR-044", message, self.where, did_you_mean(self._target, models))

    def after_step(self) -> None:
        sim = self.sim
        watched, target, model = sim.engine.names.shared(f"touch {id(self)}", self._masks)
        contacts = find_contacts(sim.mj_model, sim.engine.physics.fresh(), watched)
        if contacts is None or not target[contacts.geoms].any():
            self._since = -1
            return
        if self.is_exclusive:
            first, second = contacts.geoms.T
            if not ((target[first] & model[second]) | (model[first] & target[second])).all():
                self._since = -1
                return
        now = sim.time_ns
        if self._since < 0:
            self._since = now
        if now - self._since > self._duration:
            self._touched.publish(msgs.make(self.message_type, data=True if self.message_type == BOOL else 1))
            self._enable(False)

    # ------------------------------------------------------------------ inside

    def _masks(self) -> tuple[Bools, Bools, Bools]:
        """Return the masks of watched geoms, target geoms and geoms of this model."""
        collisions = collision_table(self.sim.engine.compiled)
        targets = {name for name in collisions.names if self._is_target(name)}
        collisions_of_model = {name for name in collisions.names if name.startswith(f"{self.scoped}::")}
        return collisions.mask(self._watched), collisions.mask(targets), collisions.mask(collisions_of_model)

    def _is_target(self, scoped: str) -> bool:
        """Check whether a collision's name contains the target, in simkit's or in Gazebo's notation.

        Gazebo uses `world/w/model/m/link/l/collision/c`, and in its documentation `/m/l/c`.
        """
        *models, link, collision = scoped.split("::")
        kinds = "".join(f"/model/{m}" for m in models)
        long = f"world/{self._world}{kinds}/link/{link}/collision/{collision}"
        return any(self._target in name for name in (scoped, long, "/" + scoped.replace("::", "/")))

    def _on_enable(self, message: msgs.Bool) -> None:
        self._enable(bool(message.data))

    def _enable(self, enabled: bool) -> None:
        self._is_enabled, self._since = enabled, -1
        self._set_pace()

    def _set_pace(self) -> None:
        """Call `before_step` at every step while the detector is enabled, otherwise not at all."""
        self._set_after_step_rate(None if self._is_enabled else NEVER)


class TouchPluginOptions(TouchOptions):
    """Options of `TouchPlugin`."""

    collision: tuple[str, ...] = texts()
    create_contact_sensor_for_collision: bool = boolean()


class TouchPlugin(TouchTimer):
    """Publishes one message after its model has touched a target for a given time without interruption.

    The detector is then disabled until a message enables it again. It watches the collisions of contact sensors on the
    model's links, or those named in `<collision>`. With `<create_contact_sensor_for_collision>` a named collision needs
    no sensor. The target is every collision whose scoped name contains `<target>`. Contact with other objects does not
    interrupt the time, as in Gazebo.
    """

    endpoints = (
        publishes("{namespace}/touched", BOOL),
        listens("{namespace}/enable", BOOL),
        offers("{namespace}/enable", SET_BOOL),
    )
    options = OptionsOf(TouchPluginOptions)
    filenames = ("gz-sim-touchplugin-system",)
    names = ("gz::sim::systems::TouchPlugin",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._read_common(scene, params, builder)
        collisions = [c for link in scene.links for c in link.collisions]
        self._named = self._find(collisions, scene, params)
        self._may_create = self.options.create_contact_sensor_for_collision

    def _find(self, collisions: list[SceneCollision], scene: SceneModel, params: Params) -> tuple[str, ...]:
        """Return the scoped names of the collisions that `<collision>` names."""
        scoped_names: dict[str, None] = {}
        for element in params.all("collision"):
            same = [c.scoped for c in collisions if f"::{c.scoped}".endswith(f"::{element.value}")]
            scoped_names.update(dict.fromkeys(same))
            if not same:
                listed = [c.name for c in collisions]
                shown = ", ".join(map(repr, listed)) or "none"
                message = f"model {scene.scoped!r} has no collision {element.value!r}; it has: {shown}"
                element.error("SK-PLUGIN-003", message, did_you_mean(element.value, listed))
        return tuple(scoped_names)

    def load(self, parent: Model, params: Params) -> None:
        sensors = [
            s for s in self.sim.contents.sensors.values() if s.kind == "contact" and s.scene.parent in self._links
        ]
        watched = [name for sensor in cast("list[Contact]", sensors) for name in sensor.collisions]
        if self._named:
            watched = [name for name in self._named if self._may_create or name in watched]
        if not watched:
            message = f"plugin {self.name!r}: no contact sensor watches a collision of model {parent.name!r}"
            hint = "add a contact sensor to its link, or <collision> and <create_contact_sensor_for_collision>"
            params.diagnostics.warning("SK-SENSOR-043", f"{message}; no touch is detected", self.where, hint)
        self._watch(watched, params)
        # the first detector of a namespace offers the service for all detectors of that namespace
        if self._same_namespace()[0] is self:
            self.offer(f"{self._topic}/enable", SET_BOOL, self._on_call)

    def _same_namespace(self) -> list[TouchPlugin]:
        """Return the detectors with the same namespace, in the order of the file."""
        detectors = [p for p in self.sim.engine.structure.all_plugins() if isinstance(p, TouchPlugin)]
        return [p for p in detectors if p._topic == self._topic]

    def _on_call(self, request: msgs.SetBool_Request) -> dict[str, object]:
        for detector in self._same_namespace():
            detector._enable(bool(request.data))
        return {"success": True}
