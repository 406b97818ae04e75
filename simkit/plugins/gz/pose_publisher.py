"""Poses of a model and its entities, published as Gazebo's `gz::sim::systems::PosePublisher` does."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.drives.entity_poses import (
    EntityPoses,
    PosedEntity,
    PoseSample,
    links_moved_by_joints,
    stamped_transform,
    transforms_message,
)
from simkit.plugins.drives.odometry_messages import TRANSFORMS
from simkit.plugins.endpoints import publishes
from simkit.plugins.options import Options, OptionsOf, boolean, choice, number, text

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model, Publisher
    from simkit.scene import SceneCollision, SceneLink, SceneModel, SceneSensor, SceneVisual

STAMPED: Final = "geometry_msgs/msg/TransformStamped"
_TYPES: Final = (
    STAMPED,
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/Transform",
    "geometry_msgs/msg/Pose",
)
"""Message types to which a bridge can convert one Gazebo pose."""


class PosePublisherOptions(Options):
    """Options of `PosePublisher`."""

    publish_nested_model_pose: bool = boolean()
    publish_model_pose: bool = boolean(instead="publish_nested_model_pose")
    publish_link_pose: bool = boolean(True)
    publish_visual_pose: bool = boolean()
    publish_collision_pose: bool = boolean()
    publish_sensor_pose: bool = boolean()
    use_pose_vector_msg: bool = boolean()
    pose_type: str = choice(_TYPES, STAMPED)
    static_publisher: bool = boolean()
    update_frequency: float = number(-1.0, "Hz")
    static_update_frequency: float = number(unit="Hz", instead="update_frequency")
    topic: str = text()


class PosePublisher(ModelPlugin):
    """Publishes on `/model/<model>/pose` the poses of the model's entities, each in the frame of its parent.

    Links are published by default. `<publish_visual_pose>`, `<publish_collision_pose>`, `<publish_sensor_pose>`,
    `<publish_nested_model_pose>` and `<publish_model_pose>` (default: the value of `<publish_nested_model_pose>`) add
    more entities. With `<use_pose_vector_msg>` one `tf2_msgs/msg/TFMessage` contains all poses. Otherwise each pose is
    a message, by default `geometry_msgs/msg/TransformStamped`; `<simkit:pose_type>` selects another type. Frame names
    are scoped names without the world's name. The parent frame of a top-level model has the world's name.

    With `<static_publisher>` this topic contains only the poses of links that a joint moves. All other poses are
    published on `<topic>_static`, including the model's own pose, as in Gazebo. An `<update_frequency>` or
    `<static_update_frequency>` [Hz] that is not positive means every step.
    """

    endpoints = (
        publishes("/model/{model}/pose", TRANSFORMS, STAMPED, named_by=("topic",)),
        publishes("/model/{model}/pose_static", TRANSFORMS, STAMPED, named_by=("topic",)),
    )
    options = OptionsOf(PosePublisherOptions)
    filenames = ("gz-sim-pose-publisher-system",)
    names = ("gz::sim::systems::PosePublisher",)
    only_publishes = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._published_kinds = {
            "nested": self.options.publish_nested_model_pose,
            "link": self.options.publish_link_pose,
            "visual": self.options.publish_visual_pose,
            "collision": self.options.publish_collision_pose,
            "sensor": self.options.publish_sensor_pose,
            "model": self.options.publish_model_pose,
        }
        is_vector, kind = self.options.use_pose_vector_msg, self.options.pose_type
        self._type = TRANSFORMS if is_vector else kind
        self._rate = max(0.0, self.options.update_frequency)
        self._static_rate = self._rate
        if self.options.static_publisher:
            self._static_rate = max(0.0, self.options.static_update_frequency)
        path = "".join(f"/model/{name}" for name in scene.scoped.split("::"))
        self._topic = valid_topic(self.options.topic or f"{path}/pose")
        self.after_step_rate = _common_rate(self._rate, self._static_rate)

    def load(self, parent: Model, params: Params) -> None:
        self._out = self.advertise(self._topic, self._type)
        self._static = self.advertise(f"{self._topic}_static", self._type) if self.options.static_publisher else None
        self._jointed = links_moved_by_joints(parent.scene.all_joints())
        entities = [*self._of_model(parent.scene)]
        self._resting = [entity for entity in entities if not entity.moves]
        self._moving = [entity for entity in entities if entity.moves]
        if self._static is None:
            self._moving = self._resting + self._moving

    def after_step(self) -> None:
        static = self._static
        if static is not None and static.wanted and self._is_due(self._static_rate):
            self._publish(static, "resting", self._resting)
        if self._out.wanted and (static is None or self._is_due(self._rate)):
            self._publish(self._out, "moving", self._moving)

    # ------------------------------------------------------------------ inside

    def _is_due(self, rate: float) -> bool:
        """Check whether this rate [Hz] has a tick now; `after_step` runs at the ticks of both rates."""
        grid, tick = self.sim.engine.clock.grid(rate), self.sim.tick
        return grid is None or grid.next(tick - 1) == tick

    def _publish(self, out: Publisher, group: str, entities: list[PosedEntity]) -> None:
        poses = self.sim.engine.names.shared(f"{group} poses {id(self)}", partial(EntityPoses, self.sim, entities))
        sample, time_ns = poses.take(), self.sim.time_ns
        if self._type == TRANSFORMS:
            out.publish_later(partial(transforms_message, time_ns, sample))
            return
        for index in range(len(entities)):
            out.publish_later(partial(_message, self._type, time_ns, sample, index))

    def _of_model(self, scene: SceneModel) -> Iterator[PosedEntity]:
        model = self.sim.model(scene.scoped)
        outer = scene.scoped.rpartition("::")[0]
        if outer and self._published_kinds["nested"]:
            yield PosedEntity(outer, scene.scoped, handle=model, within=self.sim.model(outer))
        elif not outer and self._published_kinds["model"]:
            yield PosedEntity(self.sim.world.name, scene.scoped, handle=model)
        for link in scene.links:
            if self._published_kinds["link"]:
                yield self._link(link, scene)
            yield from self._on_link(link)
        for joint in scene.joints:
            for sensor in joint.sensors if self._published_kinds["sensor"] else ():
                yield PosedEntity(joint.scoped, sensor.scoped, joint.pose_world.inverse() @ sensor.pose_world)
        for nested in scene.models:
            yield from self._of_model(nested)

    def _link(self, link: SceneLink, outer: SceneModel) -> PosedEntity:
        # the model's frame moves with its canonical link, so the pose of this link is constant
        if link.scoped == outer.canonical_link:
            return PosedEntity(outer.scoped, link.scoped, outer.pose_world.inverse() @ link.pose_world)
        model, handle = self.sim.model(outer.scoped), self.sim.link(link.scoped)
        return PosedEntity(outer.scoped, link.scoped, None, handle, model, link.scoped in self._jointed)

    def _on_link(self, link: SceneLink) -> Iterator[PosedEntity]:
        children: dict[str, tuple[SceneVisual | SceneCollision | SceneSensor, ...]]
        children = {"visual": link.visuals, "collision": link.collisions, "sensor": link.sensors}
        for kind, entities in children.items():
            for child in entities if self._published_kinds[kind] else ():
                yield PosedEntity(link.scoped, child.scoped, child.pose_link)


def _common_rate(rate: float, other: float) -> float:
    """Return the higher rate [Hz] if it is a multiple of the lower one, else 0, which means every step."""
    low, high = sorted((rate, other))
    return high if low > 0 and (high / low).is_integer() else 0.0


def _message(type_name: str, time_ns: int, sample: PoseSample, index: int) -> object:
    """Return the message with the pose of one entity."""
    frame, child, pose = sample.placed[index]
    if type_name == STAMPED:
        return stamped_transform(time_ns, frame, child, pose)
    x, y, z, w, i, j, k = pose
    place, turn = {"x": x, "y": y, "z": z}, {"x": i, "y": j, "z": k, "w": w}
    if type_name.endswith("/Transform"):
        return msgs.make(type_name, translation=place, rotation=turn)
    if type_name.endswith("/Pose"):
        return msgs.make(type_name, position=place, orientation=turn)
    return msgs.make(type_name, header=msgs.header(time_ns, frame), pose={"position": place, "orientation": turn})
