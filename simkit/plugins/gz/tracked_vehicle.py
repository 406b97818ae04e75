"""gz's tracked vehicle: `gz::sim::systems::TrackedVehicle`, which tells track controllers how fast to run."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from simkit import msgs
from simkit.params import Params
from simkit.plugins.base import NEVER
from simkit.plugins.drives.odometry import COMMAND_TYPES, ODOMETRY, TRANSFORMS, odometry_message, transforms
from simkit.plugins.drives.speed_limits import LimiterOptions, speed_limiter
from simkit.plugins.drives.tracks import TrackOdometry
from simkit.plugins.drives.twist_drive import Speeds, TwistDrive
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.find_entities import find_link, find_named_link, read_topic
from simkit.plugins.gz.track_controller import CENTRE, SPEED
from simkit.plugins.options import Options, OptionsOf, block, blocks, boolean, number, text
from simkit.plugins.publish_on_demand import publish_while_subscribed, set_after_step_rate

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel

_STRAIGHT = 1e-6  # rate of turning [rad/s] below which it drives straight, and speed [m/s] below which on the spot
_STILL = 1e-6  # change of a speed in a step below which the tracks are not told again
_SIDES = ("left", "right")


@dataclass(frozen=True, slots=True)
class _Track:
    """A track's link and the topics that its controller listens to."""

    link: str
    velocity_topic: str
    centre_topic: str


class TrackOptions(Options):
    """A `<left_track>` or `<right_track>` block."""

    link: str = text(required=True)
    velocity_topic: str = text()
    center_of_rotation_topic: str = text()


class TrackedVehicleOptions(Options):
    """Options of `TrackedVehicle`."""

    body_link: str = text(required=True)
    left_track: tuple[TrackOptions, ...] = blocks(TrackOptions)
    right_track: tuple[TrackOptions, ...] = blocks(TrackOptions)
    tracks_separation: float = number(1.0, "m", minimum=1e-6)
    steering_efficiency: float = number(0.5, minimum=1e-6)
    tracks_height: float = number(0.2, "m", minimum=1e-6)
    linear_velocity: LimiterOptions = block(LimiterOptions)
    angular_velocity: LimiterOptions = block(LimiterOptions)
    odom_publish_frequency: float = number(50.0, "Hz", minimum=0)
    debug: bool = boolean()
    topic: str = text()
    steering_efficiency_topic: str = text()
    odom_topic: str = text()
    tf_topic: str = text()


class TrackedVehicle(TwistDrive):
    """Drives tracks, each with a `TrackController` of its own, from `/model/<model>/cmd_vel`.

    A track turns the vehicle by skidding, so for a rate of turning it runs faster than a wheel would: by one over
    `<steering_efficiency>`, also told on `/model/<model>/steering_efficiency`. All tracks hear round which point the
    vehicle is to turn. Odometry on `/model/<model>/odometry` is what wheels at these speeds would say.
    """

    endpoints = (
        publishes(
            "/model/{model}/link/{link}/track_cmd_vel",
            SPEED,
            named_by=("left_track/velocity_topic", "right_track/velocity_topic"),
        ),
        publishes(
            "/model/{model}/link/{link}/track_cmd_center_of_rotation",
            "geometry_msgs/msg/Vector3",
            named_by=("left_track/center_of_rotation_topic", "right_track/center_of_rotation_topic"),
        ),
        listens("/model/{model}/cmd_vel", *COMMAND_TYPES, named_by=("topic",)),
        listens("/model/{model}/steering_efficiency", SPEED, named_by=("steering_efficiency_topic",)),
        publishes("/model/{model}/odometry", ODOMETRY, named_by=("odom_topic",)),
        publishes("/model/{model}/tf", TRANSFORMS, named_by=("tf_topic",)),
    )
    options = OptionsOf(TrackedVehicleOptions)
    filenames = ("gz-sim-tracked-vehicle-system",)
    names = ("gz::sim::systems::TrackedVehicle",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        own = params.has("body_link")
        self._canonical = find_named_link(scene, "body_link", params) if own else scene.canonical_link
        self._sides = [
            self._read_side("left_track", self.options.left_track, scene),
            self._read_side("right_track", self.options.right_track, scene),
        ]
        self._separation = self.options.tracks_separation
        self._efficiency = self.options.steering_efficiency
        _ = self.options.tracks_height  # gz's odometry divides by it and multiplies again
        self._limiters = [speed_limiter(self.options.linear_velocity), speed_limiter(self.options.angular_velocity)]
        self._odometry_rate = self.options.odom_publish_frequency
        if self.options.debug:
            params.diagnostics.note("SK-PLUGIN-100", "<debug> of a tracked vehicle draws nothing here", params.where)

    def _read_side(self, element: str, found: Sequence[TrackOptions], scene: SceneModel) -> list[_Track]:
        if not found:
            self.params.text(element, required=True)
        tracks = []
        for options in found:
            one, name = options.params, options.link
            named = one.child("link")
            if named is not None and name:
                find_link(scene, name, named)
            prefix = f"/model/{scene.name}/link/{name}"
            velocity = read_topic(one, "velocity_topic", f"{prefix}/track_cmd_vel")
            centre = read_topic(one, "center_of_rotation_topic", f"{prefix}/track_cmd_center_of_rotation")
            tracks.append(_Track(name, velocity, centre))
        return tracks

    def load(self, parent: Model, params: Params) -> None:
        self.start()
        self.after_step_rate = NEVER
        self._is_new = False
        self._odometry = TrackOdometry(self._separation, self.sim.time_ns)
        self._tracks = [
            [(self.advertise(t.velocity_topic, SPEED), self.advertise(t.centre_topic, CENTRE[0])) for t in side]
            for side in self._sides
        ]
        self.open_topics(parent, params)
        efficiency = read_topic(params, "steering_efficiency_topic", f"/model/{parent.name}/steering_efficiency")
        self.listen(efficiency, SPEED, self._on_efficiency)
        for publisher, method in ((self._odom, "publish_pose"), (self._tf, "publish_transform")):
            publish_while_subscribed(self, publisher, self._odometry_rate, method)

    # ------------------------------------------------------------------ commands

    def aim(self, speeds: Speeds) -> None:
        super().aim(speeds)
        self._begin()

    def _on_efficiency(self, message: msgs.Float64) -> None:
        efficiency = float(message.data)
        if math.isfinite(efficiency) and efficiency > 0.0:
            self._efficiency = efficiency
            self._begin()
        else:
            self.once.left_out("efficiency", "a steering efficiency that is not a positive number is left out")

    def _begin(self) -> None:
        self._is_new = True
        set_after_step_rate(self, None)

    def after_step(self) -> None:
        """Takes the limited speeds one step towards the command, and tells the tracks, for the next step."""
        ahead, turning = self.next_speeds()
        changes = any(abs(now - last) > _STILL for now, last in zip(self._last, self._before_last, strict=True))
        tells, self._is_new = self._is_new or changes, False
        if tells:
            self._tell(ahead, turning)
        elif self._settled:
            self.after_step_rate = NEVER
            self.sim.engine.reschedule()

    def _tell(self, ahead: float, turning: float) -> None:
        half = turning * self._separation / (2.0 * self._efficiency)
        left, right = ahead - half, ahead + half
        self._odometry.drive(left, right, self.sim.time_ns)
        x, y, z = self._centre(ahead, turning)
        number, vector = msgs.type_of(SPEED), msgs.type_of(CENTRE[0])
        for side, speed in zip(self._tracks, (left, right), strict=True):
            for velocity, centre in side:
                velocity.publish(number(speed))
                centre.publish(vector(x, y, z))

    def _centre(self, ahead: float, turning: float) -> tuple[float, float, float]:
        """The point of the world that it turns round [m]; infinitely far where it drives straight."""
        if abs(turning) < _STRAIGHT:
            return math.inf, math.inf, math.inf
        pose = self.sim.link(self._canonical).pose
        radius = 0.0 if abs(ahead) < _STRAIGHT else ahead / turning
        x, y, z = (pose.position + pose.matrix[:, 1] * radius).tolist()
        return x, y, z

    # ------------------------------------------------------------------ readings

    def publish_pose(self) -> None:
        """Odometry of the speeds that the tracks were told."""
        now = self.sim.time_ns
        pose, twist = self._odometry.at(now)
        self._odom.publish_later(partial(odometry_message, now, self._frame, self._child, pose, twist))

    def publish_transform(self) -> None:
        """The same as a transform."""
        now = self.sim.time_ns
        pose, _ = self._odometry.at(now)
        self._tf.publish_later(partial(transforms, now, (self._frame, self._child, pose)))
