"""gz's conveyor belts and tracks: `gz::sim::systems::TrackController`."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.plugins.drives.odometry import ODOMETRY, BodyTwist, odometry_message
from simkit.plugins.drives.speed_limits import LimiterOptions, speed_limiter
from simkit.plugins.drives.tracks import belt_of, needs_direction, report_missing_collisions
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.find_entities import find_link, read_topic
from simkit.plugins.one_time_warnings import OneTimeWarnings
from simkit.plugins.options import OptionsOf, boolean, number, text, vector3
from simkit.plugins.publish_on_demand import publish_while_subscribed, set_before_step_rate
from simkit.pose import Pose
from simkit.runtime.contact.belt import Belt, BeltMotion

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import Float64, Point, Vector3
    from simkit.runtime import Model
    from simkit.scene import SceneModel

SPEED = "std_msgs/msg/Float64"
CENTRE = ("geometry_msgs/msg/Vector3", "geometry_msgs/msg/Point")


class TrackControllerOptions(LimiterOptions):
    """Options of `TrackController`."""

    link: str = text(required=True)
    track_orientation: tuple[float, float, float] = vector3()
    max_command_age: float = number(math.inf, minimum=0, finite=False)
    odometry_publish_frequency: float = number(50.0, "Hz", minimum=0)
    debug: bool = boolean()
    velocity_topic: str = text()
    center_of_rotation_topic: str = text()
    odometry_topic: str = text()


class TrackController(ModelPlugin):
    """Has the surface of a link run: a conveyor belt, or a track of a vehicle.

    The belt runs along x of the link (turned by `<track_orientation>`), round its y: with a positive speed, told on
    `/model/<model>/link/<link>/track_cmd_vel`, what lies on top goes along x, and what is below goes back, so that a
    vehicle drives along x. A point on `.../track_cmd_center_of_rotation` bends its way to a circle round that point of
    the world; one that is not finite makes it straight again. How far and how fast the belt runs is on
    `/model/<model>/link/<link>/odometry`.
    """

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
        self._patience = self.options.max_command_age
        self._odometry_rate = self.options.odometry_publish_frequency
        if self.options.debug:
            params.diagnostics.note("SK-PLUGIN-100", "<debug> of a track draws nothing here", params.where)

    def load(self, parent: Model, params: Params) -> None:
        self.once = OneTimeWarnings(self)
        self.before_step_rate = NEVER
        self._wanted, self._told_tick = 0.0, -1
        self._speed, self._history = 0.0, (0.0, 0.0)  # now, and at the two steps before
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

    def _on_speed(self, message: Float64) -> None:
        speed = float(message.data)
        if not math.isfinite(speed):
            self.once.not_finite()
            return
        self._wanted = speed
        self._begin()

    def _on_centre(self, message: Vector3 | Point) -> None:
        x, y, z = float(message.x), float(message.y), float(message.z)
        self._centre = (x, y, z) if all(map(math.isfinite, (x, y, z))) else None
        self._begin()

    def _begin(self) -> None:
        """A command has come, between two steps: for the step to come already."""
        self._told_tick = self.sim.tick
        self.before_step()
        set_before_step_rate(self, None)

    def before_step(self) -> None:
        """Takes the limited speed one step towards the command; called no more once it is there."""
        tick = self.sim.tick
        if tick != self._tick:
            self._tick, self._history = tick, (self._speed, self._history[0])
        last, before = self._history
        waits = self._wanted != 0.0 and math.isfinite(self._patience)
        if waits and (tick - self._told_tick) * self.period > self._patience + 1e-12:
            self._wanted, waits = 0.0, False
        speed = self._limiter.limit(self._wanted, last, before, self.period)
        if speed != self._speed:
            self._place = (tick, self._way(tick))
            self._speed = speed
        self._apply()
        if not waits and speed == last == before and self.before_step_rate is None and tick != self._told_tick:
            self.before_step_rate = NEVER
            self.sim.engine.reschedule()

    def _apply(self) -> None:
        stands = self._speed == 0.0 and not self._is_directed
        run = None if stands else BeltMotion(self._speed, self._centre)
        if run != self._run:
            self._run = run
            self.sim.engine.physics.changed_surface()

    # ------------------------------------------------------------------ readings

    def _way(self, tick: int) -> float:
        """How far the belt has run [m]."""
        since, way = self._place
        return way + self._speed * (tick - since) * self.period

    def publish(self) -> None:
        """How far the belt has run [m], and how fast it does [m/s]."""
        pose, twist = Pose((self._way(self.sim.tick), 0.0, 0.0)), BodyTwist((self._speed, 0.0, 0.0))
        self._odometry.publish_later(partial(odometry_message, self.sim.time_ns, "", "", pose, twist))
