"""Tracks of Gazebo: track controllers and tracked vehicles.

`gz::sim::systems::TrackController` moves a track or a conveyor belt. `gz::sim::systems::TrackedVehicle` sends speeds to
track controllers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

from simkit import msgs
from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.plugins.drives.odometry import COMMAND_TYPES
from simkit.plugins.drives.odometry_messages import ODOMETRY, TRANSFORMS, BodyTwist, odometry_message, transforms
from simkit.plugins.drives.speed_limits import LimiterOptions, speed_limiter
from simkit.plugins.drives.tracks import TrackOdometry, belt_of, needs_direction, report_missing_collisions
from simkit.plugins.drives.twist_drive import OdometryOptions, Speeds, TwistDrive
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.find_entities import find_link, find_named_link, read_topic
from simkit.plugins.one_time_warnings import are_usable
from simkit.plugins.options import Options, OptionsOf, block, blocks, boolean, number, text, vector3
from simkit.plugins.publish_on_demand import publish_while_subscribed
from simkit.pose import Pose
from simkit.runtime.contact.moving_surface import Belt, BeltMotion

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel

SPEED = "std_msgs/msg/Float64"
CENTRE = ("geometry_msgs/msg/Vector3", "geometry_msgs/msg/Point")
# turning rate [rad/s] below which the motion is straight; forward speed [m/s] below which the vehicle turns in place
_STRAIGHT = 1e-6
_STILL = 1e-6  # change of a speed per step below which no new speeds are sent to the tracks
_SIDES = ("left", "right")


class TrackOptions(Options):
    """Options of a `<left_track>` or `<right_track>` block."""

    link: str = text(required=True)
    velocity_topic: str = text()
    center_of_rotation_topic: str = text()


class TrackControllerOptions(LimiterOptions, TrackOptions):
    """Options of `TrackController`."""

    track_orientation: tuple[float, float, float] = vector3()
    max_command_age: float = number(math.inf, minimum=0, finite=False)
    odometry_publish_frequency: float = number(50.0, "Hz", minimum=0)
    debug: bool = boolean()
    odometry_topic: str = text()


class TrackController(ModelPlugin):
    """Moves the surface of a link: a conveyor belt, or a track of a vehicle.

    The belt runs along the x axis of the link (turned by `<track_orientation>`), around its y axis. The plugin reads
    the speed from `/model/<model>/link/<link>/track_cmd_vel`. At a positive speed, objects on top move along x and the
    ground below moves back, so that a vehicle drives along x. A point on `.../track_cmd_center_of_rotation` changes the
    motion to a circle around that point of the world; a point that is NaN or infinite makes the motion straight again.
    The travel and the speed of the belt are published on `/model/<model>/link/<link>/odometry`.
    """

    reads_at_load = ("surface",)  # the belt follows from the friction

    endpoints = (
        listens("/model/{model}/link/{link}/track_cmd_vel", SPEED, named_by=("velocity_topic",)),
        listens(
            "/model/{model}/link/{link}/track_cmd_center_of_rotation", *CENTRE, named_by=("center_of_rotation_topic",)
        ),
        publishes("/model/{model}/link/{link}/odometry", ODOMETRY, named_by=("odometry_topic",)),
    )
    options = OptionsOf(TrackControllerOptions)
    filenames = ("gz-sim-track-controller-system",)
    names = ("gz::sim::systems::TrackController",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        name = self.options.link
        named = params.child("link")
        link = None if named is None or not name else find_link(scene, name, named)
        self._link, self._name = ("", name) if link is None else (link.scoped, name)
        self._is_directed = link is not None and needs_direction(link)
        if link is not None and named is not None:
            report_missing_collisions(link, named)
        self._track = Pose.from_rpy(0.0, 0.0, 0.0, *self.options.track_orientation)
        self._limiter = speed_limiter(self.options)
        self._command_timeout = self.options.max_command_age
        self._odometry_rate = self.options.odometry_publish_frequency
        if self.options.debug:
            params.note("SK-PLUGIN-100", "<debug> of a track has no effect in simkit")

    def load(self, parent: Model, params: Params) -> None:
        self.before_step_rate = NEVER
        self._target_speed, self._command_tick = 0.0, -1
        self._speed, self._history = 0.0, (0.0, 0.0)  # current speed, and the speeds of the two steps before [m/s]
        self._centre: tuple[float, float, float] | None = None
        self._run: BeltMotion | None = BeltMotion(0.0) if self._is_directed else None
        self._tick, self._place = self.sim.tick, (self.sim.tick, 0.0)
        prefix = f"/model/{parent.name}/link/{self._name}"
        self.listen(read_topic(params, "velocity_topic", f"{prefix}/track_cmd_vel"), SPEED, self._on_speed)
        centre = read_topic(params, "center_of_rotation_topic", f"{prefix}/track_cmd_center_of_rotation")
        self.listen(centre, CENTRE, self._on_centre)
        odometry = read_topic(params, "odometry_topic", f"{prefix}/odometry")
        self._odometry = self.advertise(odometry, ODOMETRY)
        publish_while_subscribed(self, self._odometry, self._odometry_rate, "publish")
        if self._link:
            self.sim.engine.friction.add_belts(self, self._belts)

    def _belts(self) -> list[Belt]:
        return [belt_of(self.sim, self._link, self._track, lambda: self._run)]

    # ------------------------------------------------------------------ commands

    def _on_speed(self, message: msgs.Float64) -> None:
        speed = float(message.data)
        if not are_usable(speed):
            self._once.not_finite()
            return
        self._target_speed = speed
        self._begin()

    def _on_centre(self, message: msgs.Vector3 | msgs.Point) -> None:
        x, y, z = float(message.x), float(message.y), float(message.z)
        self._centre = (x, y, z) if all(map(math.isfinite, (x, y, z))) else None
        self._begin()

    def _begin(self) -> None:
        """Apply the last command from the next step on."""
        self._command_tick = self.sim.tick
        self.before_step()
        self._set_before_step_rate(None)

    def before_step(self) -> None:
        """Advance the limited speed by one step; when the speed reaches the command, the calls end."""
        tick = self.sim.tick
        if tick != self._tick:
            self._tick, self._history = tick, (self._speed, self._history[0])
        last, before = self._history
        waits = self._target_speed != 0.0 and math.isfinite(self._command_timeout)
        if waits and (tick - self._command_tick) * self.period > self._command_timeout + 1e-12:
            self._target_speed, waits = 0.0, False
        speed = self._limiter.limit(self._target_speed, last, before, self.period)
        if speed != self._speed:
            self._place = (tick, self._travel(tick))
            self._speed = speed
        self._apply()
        if not waits and speed == last == before and self.before_step_rate is None and tick != self._command_tick:
            self._set_before_step_rate(NEVER)

    def _apply(self) -> None:
        stands = self._speed == 0.0 and not self._is_directed
        run = None if stands else BeltMotion(self._speed, self._centre)
        if run != self._run:
            self._run = run
            self.sim.engine.physics.changed_surface()

    # ------------------------------------------------------------------ readings

    def _travel(self, tick: int) -> float:
        """Return the travel of the belt at a tick [m]."""
        since, travel = self._place
        return travel + self._speed * (tick - since) * self.period

    def publish(self) -> None:
        """Publish travel [m] and speed [m/s] of the belt."""
        pose, twist = Pose((self._travel(self.sim.tick), 0.0, 0.0)), BodyTwist((self._speed, 0.0, 0.0))
        self._odometry.publish_later(partial(odometry_message, self.sim.time_ns, "", "", pose, twist))


class TrackedVehicleOptions(OdometryOptions):
    """Options of `TrackedVehicle`."""

    body_link: str = text(required=True)
    left_track: tuple[TrackOptions, ...] = blocks(TrackOptions)
    right_track: tuple[TrackOptions, ...] = blocks(TrackOptions)
    tracks_separation: float = number(1.0, "m", minimum=1e-6)
    steering_efficiency: float = number(0.5, minimum=1e-6)
    tracks_height: float = number(0.2, "m", minimum=1e-6)
    linear_velocity: LimiterOptions = block(LimiterOptions)
    angular_velocity: LimiterOptions = block(LimiterOptions)
    debug: bool = boolean()
    steering_efficiency_topic: str = text()


class TrackedVehicle(TwistDrive):
    """Drives tracks, each with a `TrackController` of its own, from `/model/<model>/cmd_vel`.

    The tracks skid when the vehicle turns. For the same turning rate, the speed difference of the tracks is therefore
    larger than for wheels, by the factor 1 / `<steering_efficiency>`. A message on `/model/<model>/steering_efficiency`
    changes this value. All tracks receive the centre of rotation of the vehicle. The odometry on
    `/model/<model>/odometry` is computed as for wheels with the speeds of the tracks.
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
        is_named = params.has("body_link")
        self._canonical = find_named_link(scene, "body_link", params) if is_named else scene.canonical_link
        self._sides = [
            self._read_side("left_track", self.options.left_track, scene),
            self._read_side("right_track", self.options.right_track, scene),
        ]
        self._separation = self.options.tracks_separation
        self._efficiency = self.options.steering_efficiency
        _ = self.options.tracks_height  # the track height cancels out in Gazebo's odometry
        self._limiters = [speed_limiter(self.options.linear_velocity), speed_limiter(self.options.angular_velocity)]
        self._odometry_rate = self.options.odom_publish_frequency
        if self.options.debug:
            params.note("SK-PLUGIN-100", "<debug> of tracked vehicles has no effect in simkit")

    def _read_side(
        self, element: str, track_options: Sequence[TrackOptions], scene: SceneModel
    ) -> list[tuple[str, str]]:
        """Return the speed and centre topics of the track controllers on one side."""
        if not track_options:
            self.params.text(element, required=True)
        tracks = []
        for options in track_options:
            block, name = options.params, options.link
            named = block.child("link")
            if named is not None and name:
                find_link(scene, name, named)
            prefix = f"/model/{scene.name}/link/{name}"
            velocity = read_topic(block, "velocity_topic", f"{prefix}/track_cmd_vel")
            centre = read_topic(block, "center_of_rotation_topic", f"{prefix}/track_cmd_center_of_rotation")
            tracks.append((velocity, centre))
        return tracks

    def load(self, parent: Model, params: Params) -> None:
        self.start()
        self.after_step_rate = NEVER
        self._is_new = False
        self._odometry = TrackOdometry(self._separation, self.sim.time_ns)
        self._tracks = [
            [(self.advertise(speed, SPEED), self.advertise(centre, CENTRE[0])) for speed, centre in side]
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
            self._once.left_out("efficiency", "a steering efficiency is ignored; expected a positive number")

    def _begin(self) -> None:
        self._is_new = True
        self._set_after_step_rate(None)

    def after_step(self) -> None:
        """Advance the limited speeds by one step towards the command, and send them to the tracks for the next step."""
        ahead, turning = self.next_speeds()
        changes = any(abs(now - last) > _STILL for now, last in zip(self._last, self._before_last, strict=True))
        is_sent, self._is_new = self._is_new or changes, False
        if is_sent:
            self._command_tracks(ahead, turning)
        elif self._settled:
            self._set_after_step_rate(NEVER)

    def _command_tracks(self, ahead: float, turning: float) -> None:
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
        """Return the centre of rotation in the world [m]; infinite for straight motion."""
        if abs(turning) < _STRAIGHT:
            return math.inf, math.inf, math.inf
        pose = self.sim.link(self._canonical).pose
        radius = 0.0 if abs(ahead) < _STRAIGHT else ahead / turning
        x, y, z = (pose.position + pose.matrix[:, 1] * radius).tolist()
        return x, y, z

    # ------------------------------------------------------------------ readings

    def odometry_pose(self) -> Pose:
        return self._odometry.at(self.sim.time_ns)[0]

    def publish_pose(self) -> None:
        """Publish the odometry of the commanded track speeds."""
        now = self.sim.time_ns
        pose, twist = self._odometry.at(now)
        self._odom.publish_later(partial(odometry_message, now, self._frame, self._child, pose, twist))

    def publish_transform(self) -> None:
        """Publish the transform of the odometry."""
        now = self.sim.time_ns
        pose, _ = self._odometry.at(now)
        self._tf.publish_later(partial(transforms, now, (self._frame, self._child, pose)))
