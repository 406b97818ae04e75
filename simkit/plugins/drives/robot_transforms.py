"""Publishers of a robot's transforms: fixed frames on `/tf_static`, moving links on `/tf`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.base import ModelPlugin, WorldPlugin
from simkit.plugins.drives.entity_poses import EntityPoses, PosedEntity, transforms_message
from simkit.plugins.drives.odometry_messages import TRANSFORMS, transforms
from simkit.plugins.options import Options, OptionsOf, number
from simkit.plugins.publish_on_demand import publish_while_subscribed
from simkit.pose import Pose

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import TFMessage
    from simkit.runtime import Model, Simulation
    from simkit.scene import SceneModel


def frame_names(sim: Simulation) -> dict[str, str]:
    """Return the frame name of every link by scoped link name; see `StaticTransforms` for the rule."""
    frames: dict[str, str] = {}
    used_names: set[str] = set()
    for scene in _moving_models_first(sim):
        links = {link.scoped: link.name for link in scene.all_links()}
        clash = any(name in used_names for name in links.values())
        own_names = {scoped: f"{scene.name}/{name}" if clash else name for scoped, name in links.items()}
        frames.update(own_names)
        used_names.update(own_names.values())
    return frames


def _moving_models_first(sim: Simulation) -> list[SceneModel]:
    """Return all models, static models last, so that a robot's frames keep their plain names."""
    return sorted((handle.scene for handle in sim.models.values()), key=lambda scene: scene.static)


class StaticTransforms(WorldPlugin):
    """Publishes latched transforms: the fixed joints of each moving model, and sensor frames relative to their links.

    Frames are plain link names as in ROS. If two models have a link of the same name, the frames of the later model are
    `<model>/<link>`. A sensor that has a frame of its own (`model::link::sensor`, as in Gazebo) gets a transform from
    its link, on static models too. A camera's `<optical_frame_id>` gets a transform from the sensor's frame, but not if
    a link has that name. Every world has this plugin. It looks for added and removed models once a second of simulated
    time.
    """

    after_step_rate = 1.0
    only_publishes = True

    def load(self, parent: Simulation, params: Params) -> None:
        self._static = self.advertise("/tf_static", TRANSFORMS, latched=True)
        self._known: tuple[object, ...] = ()
        self.after_step()

    def reset(self) -> None:
        self._known = self._names()
        # the compiled world keeps them, because resets come in thousands and each would compute the same transforms
        self._publish(self.sim.engine.names.shared("static transforms", lambda: list(self._all())))

    def after_step(self) -> None:
        """Publish all transforms again if the models have changed."""
        names = self._names()
        if names != self._known:
            self._known = names
            self._publish(list(self._all()))

    def _names(self) -> tuple[object, ...]:
        """Return the names on which the transforms depend: models, and frames of sensors."""
        return tuple(self.sim.models), tuple(sensor.frame_id for sensor in self.sim.contents.sensors.values())

    def _publish(self, links: Sequence[tuple[str, str, Pose]]) -> None:
        if links:
            self._static.publish_later(partial(transforms, 0, *links))

    def _all(self) -> Iterator[tuple[str, str, Pose]]:
        names = frame_names(self.sim)
        for scene in _moving_models_first(self.sim):
            frames = {link.scoped: names[link.scoped] for link in scene.all_links()}
            if not scene.static:
                yield from self._links(scene, frames)
            yield from self._sensors(scene, frames)

    def _links(self, scene: SceneModel, frames: dict[str, str]) -> Iterator[tuple[str, str, Pose]]:
        poses = {link.scoped: link.pose_world for link in scene.all_links()}
        for joint in scene.all_joints():
            if joint.type == "fixed" and joint.parent_link in poses and joint.child_link in poses:
                pose = poses[joint.parent_link].inverse() @ poses[joint.child_link]
                yield frames[joint.parent_link], frames[joint.child_link], pose

    def _sensors(self, scene: SceneModel, frames: dict[str, str]) -> Iterator[tuple[str, str, Pose]]:
        children = {joint.scoped: joint.child_link for joint in scene.all_joints()}
        links = {frames[link.scoped]: link.pose_world for link in scene.all_links()}
        for described in scene.all_sensors():
            link = children[described.parent] if described.on_joint else described.parent
            # a sensor with a Classic camera plugin uses a link's frame; a sensor of unsupported type is not simulated
            if described.plugins or link not in frames or not self.sim.contents.has_sensor(described.scoped):
                continue
            sensor = self.sim.sensor(described.scoped)
            frame, pose = sensor.frame_id, sensor.scene.pose_link
            if frame in {described.name, described.scoped} - set(links):
                yield frames[link], frame, pose
            for optical, turned in sensor.optical_frames().items():
                if optical in links or optical == frame:
                    continue
                if frame in links:  # the sensor's frame may be another link
                    turned = links[frame].inverse() @ links[frames[link]] @ pose @ turned
                yield frame, optical, turned


class RobotStatePublisherOptions(Options):
    """Options of `RobotStatePublisher`."""

    publish_frequency: float = number(20.0, "Hz", minimum=1e-3)


class RobotStatePublisher(ModelPlugin):
    """Publishes the pose of each link that a joint moves, in its parent link, on `/tf`.

    Transforms are published `<publish_frequency>` (20) times a second, with the frame names of `/tf_static`. The poses
    are ground truth, also for joints without an encoder. In ROS, the separate node `robot_state_publisher` computes
    these transforms from joint states.
    """

    options = OptionsOf(RobotStatePublisherOptions)
    filenames = ("libsimkit_robot_state_publisher.so",)
    names = ("simkit::RobotStatePublisher",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._rate = self.options.publish_frequency

    def load(self, parent: Model, params: Params) -> None:
        self._robot = parent
        self._out = self.advertise("/tf", TRANSFORMS)
        self._out.present = lambda: self._message()()
        publish_while_subscribed(self, self._out, self._rate, "tell")

    def tell(self) -> None:
        """Publish the transforms of all joints."""
        self._out.publish_later(self._message())

    def _message(self) -> Callable[[], TFMessage]:
        """Return a function that makes the message of the present transforms."""
        poses: EntityPoses = self.sim.engine.names.shared(f"joint frames {id(self)}", self._poses)
        return partial(transforms_message, self.sim.time_ns, poses.take())

    def _poses(self) -> EntityPoses:
        frames, joints = frame_names(self.sim), list(self._robot.scene.all_joints())
        published_links = {joint.child_link for joint in joints if joint.type == "fixed"}
        entities = []
        for joint in joints:
            parent, child = joint.parent_link, joint.child_link
            if child in published_links or parent not in frames or child not in frames:  # no frame has a second parent
                continue
            published_links.add(child)
            entities.append(
                PosedEntity(frames[parent], frames[child], handle=self.sim.link(child), within=self.sim.link(parent))
            )
        return EntityPoses(self.sim, entities)
