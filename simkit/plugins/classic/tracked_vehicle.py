"""Tracked vehicles of Gazebo Classic: `libSimpleTrackedVehiclePlugin.so`, `libWheelTrackedVehiclePlugin.so`."""

from __future__ import annotations

import abc
import math
from functools import partial
from typing import TYPE_CHECKING

from simkit import msgs
from simkit.compiler.contact_friction import MU_MOST, directional_friction, friction_priority
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.plugins.drives.odometry import COMMAND_TYPES, command_of
from simkit.plugins.drives.tracks import belt_of, needs_direction, report_missing_collisions
from simkit.plugins.drives.wheel_joints import find_wheels
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.find_entities import find_link
from simkit.plugins.options import Options, OptionsOf, integer, number, text, texts
from simkit.pose import IDENTITY
from simkit.runtime.contact.moving_surface import Belt, BeltMotion
from simkit.scene import Cylinder, SceneJoint, SceneLink, SceneModel

if TYPE_CHECKING:
    from simkit.compiler import ActuatorRef, SpecBuilder
    from simkit.msgs import Twist, TwistStamped
    from simkit.runtime import Model

_SIDES = ("left", "right")
_STRAIGHT, _STOPPED = 0.1, 0.1  # turn rate [rad/s] and speed [m/s] below which Gazebo treats them as zero
_SPEEDS = "geometry_msgs/msg/Vector3"


class TrackedVehicleOptions(Options):
    """Options of both kinds of tracked vehicles."""

    robot_namespace: str = text("{model}")
    steering_efficiency: float = number(0.5, minimum=1e-06)
    tracks_separation: float = number(0.4, "m", minimum=1e-06)
    max_linear_speed: float = number(1.0, minimum=1e-06)
    max_angular_speed: float = number(1.0, minimum=0.0)
    track_mu: float = number(minimum=0.0)
    track_mu2: float = number(minimum=0.0)


class _TrackedVehicle(ModelPlugin):
    """Base of tracked vehicles, which converts commands to speeds of the tracks.

    The command is a Twist. On `/<robot_namespace>/cmd_vel` a positive turning rate turns left, as usual in ROS. On
    `/<robot_namespace>/cmd_vel_twist` a positive turning rate turns right, as on Gazebo's own topic. Each command stays
    active until the next.
    """

    reads_at_load = ("surface",)  # the belt follows from the friction

    endpoints = (
        listens("/{model}/cmd_vel", *COMMAND_TYPES),
        listens("/{model}/cmd_vel_twist", *COMMAND_TYPES),
        publishes("/{model}/tracks_speed", _SPEEDS),
    )
    options = OptionsOf(TrackedVehicleOptions)
    drives = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._namespace = params.text("robot_namespace", scene.name).strip("/")
        options = self.options
        self._efficiency, self._separation = options.steering_efficiency, options.tracks_separation
        self._fastest, self._fastest_turn = options.max_linear_speed, options.max_angular_speed
        frictions = {"track_mu": options.track_mu, "track_mu2": options.track_mu2}
        self._friction_overrides = [min(MU_MOST, mu) if params.has(name) else None for name, mu in frictions.items()]

    def load(self, parent: Model, params: Params) -> None:
        namespace = valid_topic(f"/{self._namespace}") if self._namespace else ""
        self.listen(f"{namespace}/cmd_vel", COMMAND_TYPES, partial(self._on_command, 1.0))
        self.listen(f"{namespace}/cmd_vel_twist", COMMAND_TYPES, partial(self._on_command, -1.0))
        self._tracks_speed = self.advertise(f"{namespace}/tracks_speed", _SPEEDS)

    def _on_command(self, sense: float, message: Twist | TwistStamped) -> None:
        command = command_of(message)
        if command is None:
            self._once.not_finite()
            return
        ahead = _clamped(command[0], self._fastest)
        half = sense * _clamped(command[1], self._fastest_turn) * self._separation / 2 / self._efficiency
        left, right = _clamped(ahead - half, self._fastest), _clamped(ahead + half, self._fastest)
        self.drive(left, right)
        self._tracks_speed.publish(msgs.type_of(_SPEEDS)(left, right, 0.0))

    @abc.abstractmethod
    def drive(self, left: float, right: float) -> None:
        """Set the speeds of the tracks [m/s]."""

    def set_friction(self, link: SceneLink, mu: float) -> None:
        """Set the coefficient of friction of a link's collisions in the engine's model."""
        geoms = list(self.sim.engine.names.link(link.scoped).geoms)
        self.sim.engine.touch("geom_friction")[geoms, 0] = mu
        self.sim.engine.touch("geom_priority")[geoms] = friction_priority(mu)
        self.sim.engine.physics.changed_model()


class SimpleTrackedVehiclePluginOptions(TrackedVehicleOptions):
    """Options of `SimpleTrackedVehiclePlugin`."""

    collide_without_contact_bitmask: int = integer(1)
    body: str = text(required=True)
    left_track: str = text(required=True)
    left_flipper: tuple[str, ...] = texts()
    right_track: str = text(required=True)
    right_flipper: tuple[str, ...] = texts()


class SimpleTrackedVehiclePlugin(_TrackedVehicle):
    """Drives `<left_track>` and `<right_track>`, whose surfaces move, and any number of flippers on each side.

    In a turn the surface velocities follow circles about the vehicle's centre of rotation.
    """

    options = OptionsOf(SimpleTrackedVehiclePluginOptions)
    filenames = ("libSimpleTrackedVehiclePlugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        super().prepare(scene, params, builder)
        _ = self.options.collide_without_contact_bitmask  # only needed for ODE, which filters collisions by categories
        body = self._link("body", scene, params)
        self._body = "" if body is None else body.scoped
        self._tracks: list[tuple[SceneLink, int]] = []
        for index, side in enumerate(_SIDES):
            links = [self._link(f"{side}_track", scene, params)]
            links += [find_link(scene, flipper.value, flipper) for flipper in params.all(f"{side}_flipper")]
            self._tracks += [(link, index) for link in links if link is not None]
        for link, _ in self._tracks:
            report_missing_collisions(link, params)

    def _link(self, element: str, scene: SceneModel, params: Params) -> SceneLink | None:
        name, named = params.text(element, required=True), params.child(element)
        return None if named is None or not name else find_link(scene, name, named)

    def _friction(self, link: SceneLink) -> tuple[float, float] | None:
        """Return the friction along and across the belt; None if the plugin sets no friction.

        If the plugin sets only one of the two values, the collision's friction is the other value.
        """
        if self._friction_overrides == [None, None] or not link.collisions:
            return None
        of_file = directional_friction(link.collisions[0].surface)
        along, across = (
            old if new is None else new for new, old in zip(self._friction_overrides, of_file, strict=True)
        )
        return along, across

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        links = [link for link, _ in self._tracks]
        self._frictions = [self._friction(link) for link in links]
        for link, friction in zip(links, self._frictions, strict=True):
            if friction is not None:
                self.set_friction(link, max(friction))
        directed = [needs_direction(link) or friction for link, friction in zip(links, self._frictions, strict=True)]
        self._stopped_belts = [BeltMotion(0.0) if is_directed else None for is_directed in directed]
        self._belt_motions: list[BeltMotion | None] = list(self._stopped_belts)
        self._speeds = (0.0, 0.0)
        self.before_step_rate = NEVER
        self.sim.engine.friction.add_belts(self, self._belts)

    def _belts(self) -> list[Belt]:
        def now(index: int) -> BeltMotion | None:
            return self._belt_motions[index]

        return [
            belt_of(self.sim, link.scoped, IDENTITY, partial(now, i), friction)
            for i, ((link, _), friction) in enumerate(zip(self._tracks, self._frictions, strict=True))
        ]

    def drive(self, left: float, right: float) -> None:
        self._speeds = left, right
        self._run()
        # in a turn the centre of rotation moves with the vehicle, so every step updates the centre
        self._set_before_step_rate(NEVER if self._turn() is None else None)

    def _turn(self) -> float | None:
        """Return the position of the centre of rotation on the axis to the left [m]; None for straight motion."""
        left, right = self._speeds
        ahead, turning = (left + right) / 2, (right - left) * self._efficiency / self._separation
        if abs(turning) < _STRAIGHT:
            return None
        return 0.0 if abs(ahead) < _STOPPED else ahead / turning

    def before_step(self) -> None:
        """Update the centre of rotation in a turn."""
        self._run()

    def _run(self) -> None:
        turn, centre = self._turn(), None
        if turn is not None and self._body:
            pose = self.sim.link(self._body).pose
            x, y, z = (pose.position + pose.matrix[:, 1] * turn).tolist()
            centre = x, y, z
        runs = [
            BeltMotion(self._speeds[side], centre) if self._speeds[side] else stands
            for (_, side), stands in zip(self._tracks, self._stopped_belts, strict=True)
        ]
        if runs != self._belt_motions:
            self._belt_motions = runs
            self.sim.engine.physics.changed_surface()


class WheelTrackedVehiclePluginOptions(TrackedVehicleOptions):
    """Options of `WheelTrackedVehiclePlugin`."""

    max_torque: float = number(5.0, "N·m", minimum=0)
    left_joint: tuple[str, ...] = texts(required=True)
    right_joint: tuple[str, ...] = texts(required=True)


class WheelTrackedVehiclePlugin(_TrackedVehicle):
    """Drives tracks that are rows of wheels, `<left_joint>` and `<right_joint>`, at the rim speed of the track.

    The radius of a wheel is the radius of its cylinder, else of its sphere.
    """

    options = OptionsOf(WheelTrackedVehiclePluginOptions)
    filenames = ("libWheelTrackedVehiclePlugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        super().prepare(scene, params, builder)
        torque = self.options.max_torque
        named = {"left wheel": self.options.left_joint, "right wheel": self.options.right_joint}
        wheels = find_wheels(scene, named, params)
        links = {link.scoped: link for link in scene.all_links()}
        self._links: list[SceneLink] = []
        self._servos: list[tuple[ActuatorRef, int, float]] = []
        for index, joints in enumerate(wheels.values()):
            for joint in joints:
                link = links[joint.child_link]
                radius = self._radius(link, joint, params)
                servo = builder.add_velocity_servo(joint.scoped, max_effort=torque, owner=self.name)
                self._links.append(link)
                self._servos.append((servo, index, radius))
        frictions = [mu for mu in self._friction_overrides if mu is not None]
        self._mu = min(frictions) if frictions else None
        if len(set(frictions)) > 1:
            message = "<track_mu> and <track_mu2> of wheels differ; the smaller value is used in both directions"
            params.diagnostics.warning("SK-PLUGIN-103", message, params.where)

    def _radius(self, link: SceneLink, joint: SceneJoint, params: Params) -> float:
        sizes = [c.geometry.radius for c in link.collisions if isinstance(c.geometry, Cylinder)]
        sizes = sizes or [r for c in link.collisions if (r := float(getattr(c.geometry, "radius", 0.0) or 0.0)) > 0.0]
        if not sizes:
            message = f"link {link.name!r} of joint {joint.name!r} has no cylinder or sphere: its radius is unknown"
            params.error("SK-PLUGIN-102", message)
            return 1.0
        return max(sizes)

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        if self._mu is not None:
            for link in self._links:
                self.set_friction(link, self._mu)

    def drive(self, left: float, right: float) -> None:
        speeds = left, right
        for servo, side, radius in self._servos:
            self.sim.engine.set_control(servo, speeds[side] / radius)


def _clamped(value: float, most: float) -> float:
    return max(-most, min(most, value)) if math.isfinite(value) else 0.0
