"""Performers of Gazebo and their detector: `gz::sim::systems::PerformerDetector`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.diagnostics import did_you_mean
from simkit.params import Params
from simkit.plugins.base import ModelPlugin, WorldPlugin
from simkit.plugins.find_entities import read_required_name, read_topic
from simkit.plugins.options import Options, OptionsOf, block, blocks, pose, text, texts, vector3
from simkit.plugins.publish_on_demand import watch_while_subscribed
from simkit.plugins.world.service_entities import pose_fields
from simkit.pose import Pose, quat_rotate

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model, Simulation
    from simkit.scene import SceneModel, SceneWorld

POSE: Final = "geometry_msgs/msg/PoseStamped"
STATUS: Final = "simkit_msgs/msg/PerformerStatus"
DETAILS: Final = "/details"
"""Suffix of the topic on which a detector publishes its complete status."""


@dataclass(frozen=True)
class Performer:
    """Model that detectors look for, with half the size of its box around the model's origin [m]."""

    name: str
    model: str
    half: tuple[float, float, float]


class BoxOptions(Options):
    """Options of a `<box>` block."""

    size: tuple[float, float, float] = vector3(required=True)


class BoxGeometryOptions(Options):
    """Options of a `<geometry>` block with a box."""

    box: BoxOptions = block(BoxOptions)


class PerformerOptions(Options):
    """Options of a `<performer>` block."""

    name: str = text(element="@name")
    ref: str = text(required=True)
    geometry: BoxGeometryOptions = block(BoxGeometryOptions)


class PerformersOptions(Options):
    """Options of `Performers`."""

    performer: tuple[PerformerOptions, ...] = blocks(PerformerOptions)
    level: tuple[str, ...] = texts()


class Performers(WorldPlugin):
    """Reads the performers of a `<plugin name="gz::sim">`. Levels are not simulated: all models are always loaded."""

    options = OptionsOf(PerformersOptions)
    names = ("gz::sim", "ignition::gazebo")
    lets_sleep = True

    def prepare(self, scene: SceneWorld, params: Params, builder: SpecBuilder) -> None:
        self.performers: tuple[Performer, ...] = ()
        models = [model.name for model in scene.models]
        for options in self.options.performer:
            element, name = options.params, options.name
            model = read_required_name(element, "ref")
            size = options.geometry.box.size
            if min(size) <= 0.0:
                if options.geometry.box.params.has("size"):
                    element.error("SK-PARAM-002", f"found a <box> of {size}; expected lengths above 0")
                continue
            if model and model not in models:
                message = f"performer {name!r} is model {model!r}, which does not exist yet"
                params.diagnostics.warning("SK-PLUGIN-125", message, element.where, did_you_mean(model, models))
            self.performers += (Performer(name, model, (size[0] / 2, size[1] / 2, size[2] / 2)),)
        if params.has("level"):
            for level in params.all("level"):
                level.mark_all_read()
            params.block("level").note("SK-PLUGIN-126", "levels have no effect: every model is loaded from the start")

    def load(self, parent: Simulation, params: Params) -> None:
        """Do nothing."""


class HeaderDataOptions(Options):
    """Options of a `<header_data>` block."""

    key: str = text()
    value: str = text()


class PerformerDetectorOptions(Options):
    """Options of `PerformerDetector`."""

    geometry: BoxGeometryOptions = block(BoxGeometryOptions)
    pose: Pose = pose()
    header_data: tuple[HeaderDataOptions, ...] = blocks(HeaderDataOptions)
    topic: str = text()


class PerformerDetector(ModelPlugin):
    """Publishes a message when a performer's box enters or leaves the box of this model.

    As in Gazebo, both boxes are always aligned with the world's axes, even if their models are rotated.
    """

    options = OptionsOf(PerformerDetectorOptions)
    filenames = ("gz-sim-performer-detector-system",)
    names = ("gz::sim::systems::PerformerDetector",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        box, size = self.options.geometry.box.params, self.options.geometry.box.size
        if box.has("size") and min(size) <= 0.0:
            box.error("SK-PARAM-002", f"found a <box> of {size}; expected lengths above 0")
        self._half = size[0] / 2, size[1] / 2, size[2] / 2
        self._offset = self.options.pose.position
        self._is_centred = not self._offset.any()
        self._data = [pair for data in self.options.header_data if (pair := self._read_data(data)) is not None]

    def _read_data(self, data: HeaderDataOptions) -> tuple[str, str] | None:
        if data.key and data.value:
            return data.key, data.value
        message = f"plugin {self.name!r}: <header_data> without a <key> and a <value> is not used"
        data.params.diagnostics.warning("SK-PLUGIN-124", message, data.params.where)
        return None

    def load(self, parent: Model, params: Params) -> None:
        self._model, self._born = parent, self.sim.tick
        topic = read_topic(params, "topic", f"/model/{parent.name}/performer_detector/status")
        self._inside: tuple[str, ...] = ()
        self._was_heard = False
        self._poses, self._details = self.advertise(topic, POSE), self.advertise(topic + DETAILS, STATUS)
        self._known = self._performers()
        if not self._known:
            message = f"plugin {self.name!r}: the world has no performers, so the detector finds nothing"
            hint = 'add <plugin name="gz::sim" filename="dummy"> with a <performer> to the world'
            params.diagnostics.warning("SK-PLUGIN-125", message, self.where, hint)
        watch_while_subscribed(self, (self._poses, self._details), "look")

    def begin(self) -> None:
        """Store the performers that are inside when the first subscriber appears.

        The detector does not publish these performers, except at the very start of the simulation.
        """
        states = () if self.sim.tick == self._born else self._performer_states()
        self._inside = tuple(name for name, _, is_inside in states if is_inside)

    def look(self) -> None:
        """Publish the performers that entered or left this model's box since the last step."""
        states = self._performer_states()
        names = tuple(name for name, _, is_inside in states if is_inside)
        for name, place, is_inside in states:
            if is_inside != (name in self._inside):
                others = tuple(inside for inside in self._inside if inside != name)
                self._inside = (*others, name) if is_inside else others
                self._publish(name, place, is_inside)
        self._inside = tuple(name for name in self._inside if name in names)  # drop removed models

    def _performers(self) -> tuple[Performer, ...]:
        """Return the performers of the world's plugins, which do not change during a run."""
        plugins = self.sim.engine.structure.all_plugins()
        return tuple(
            performer for plugin in plugins if isinstance(plugin, Performers) for performer in plugin.performers
        )

    def _performer_states(self) -> list[tuple[str, Pose, bool]]:
        """Return each performer's model, its world pose, and whether its box overlaps this model's box."""
        models = self.sim.models
        present = [performer for performer in self._known if performer.model in models]
        if not present:
            return []
        frame = self._model.pose
        centre = frame.position if self._is_centred else frame.position + quat_rotate(frame.quaternion, self._offset)
        (x, y, z), (a, b, c), states = centre.tolist(), self._half, []
        for performer in present:
            pose = models[performer.model].pose
            (u, v, w), (p, q, r) = pose.position.tolist(), performer.half
            is_inside = abs(u - x) <= a + p and abs(v - y) <= b + q and abs(w - z) <= c + r
            states.append((performer.model, pose, is_inside))
        return states

    def _publish(self, name: str, pose: Pose, state: bool) -> None:
        frame = self._model.pose
        header = msgs.header(self.sim.time_ns, self._model.name)
        fields = pose_fields(frame.inverse() @ pose)
        if self._poses.wanted:
            self._poses.publish(msgs.make(POSE, header=header, pose=fields))
        if self._details.wanted:
            keys, values = [key for key, _ in self._data], [value for _, value in self._data]
            status = {"name": name, "pose": fields, "state": state, "count": len(self._inside)}
            self._details.publish(msgs.make(STATUS, header=header, **status, keys=keys, values=values))
