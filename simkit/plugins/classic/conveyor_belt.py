"""Conveyor belts of industrial worlds: `libros2_conveyorbelt_plugin.so` (IFRA), `libROSConveyorBeltPlugin.so` (ARIAC).

The sources move the link of the belt along its joint, and set it back at the end of the joint. In simkit the link stays
at its place, and its surface moves.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.drives.tracks import belt_of, report_missing_collisions
from simkit.plugins.endpoints import offers, publishes
from simkit.plugins.find_entities import find_axis_joint
from simkit.plugins.options import Options, OptionsOf, number, text, without_effect
from simkit.plugins.publish_on_demand import publish_while_subscribed
from simkit.pose import Pose
from simkit.runtime.contact.moving_surface import Belt, BeltMotion

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel

_MOST: Final = 100.0  # largest power [%]
_UPRIGHT: Final = 0.999  # largest |cosine| of the angle between a belt and the vertical


class ConveyorBelt(ModelPlugin):
    """Base class of conveyor belts with a service for their power."""

    reads_at_load = ("surface",)  # the belt follows from the friction
    _link = ""

    def hold_belt(self, scene: SceneModel, joint_name: str, params: Params, builder: SpecBuilder) -> None:
        """Find the link that a joint moves, and hold the joint.

        Args:
            scene: model of the joint.
            joint_name: name of the joint; its axis is the direction of the belt.
            params: element with the name.
            builder: builder of the servo.
        """
        joint = find_axis_joint(scene, joint_name, params)
        if joint is None:
            return
        link = next((link for link in scene.all_links() if link.scoped == joint.child_link), None)
        x, y, z = joint.axes[0].xyz_world
        if link is None or joint.type != "prismatic" or abs(z) > _UPRIGHT:
            message = f"joint {joint.name!r} is {joint.type}; a belt needs a prismatic joint that is not vertical"
            params.error("SK-PLUGIN-003", message)
            return
        report_missing_collisions(link, params)
        direction = Pose.from_rpy(0.0, 0.0, 0.0, 0.0, -math.asin(z), math.atan2(y, x))
        turned = link.pose_world.inverse() @ direction
        self._link, self._track = link.scoped, Pose((0.0, 0.0, 0.0), turned.quaternion)
        self._servo = builder.add_position_servo(joint.scoped, max_effort=float("inf"), owner=self.name)

    def start(self, package: str, topics: tuple[str, str], speed: float, power: float, rate: float) -> None:
        """Start the belt, offer its service, and open the topic of its state.

        Args:
            package: package of the message types.
            topics: names of the service and of the topic.
            speed: speed at 100 % [m/s].
            power: first power [%].
            rate: rate of the state [Hz]; 0 for every step.
        """
        self._speed, self._power = speed, power
        self._belt_motion = self._motion()
        control, state = topics
        self.offer(control, f"{package}/srv/ConveyorBeltControl", self._on_power)
        self._state = self.advertise(state, f"{package}/msg/ConveyorBeltState")
        publish_while_subscribed(self, self._state, rate, "publish_state")
        self.sim.engine.friction.add_belts(self, self._belts)

    def _belts(self) -> list[Belt]:
        return [belt_of(self.sim, self._link, self._track, lambda: self._belt_motion)]

    def _motion(self) -> BeltMotion | None:
        return BeltMotion(self._speed * self._power / _MOST) if self._power > 0 else None

    def _on_power(self, request: msgs.ConveyorBeltControl_Request) -> dict[str, object]:
        power = float(request.power)
        is_valid = 0.0 <= power <= _MOST
        if is_valid:
            self._power = power
            self._belt_motion = self._motion()
            self.sim.engine.physics.changed_surface()
        else:
            self._once.left_out("power", f"a power of {power:g} is ignored; expected 0 to 100")
        return {"success": is_valid}

    def publish_state(self) -> None:
        """Publish the power."""
        self._state.publish(msgs.make(self._state.type_name, power=self._power, enabled=self._power > 0))


class IfraConveyorBeltOptions(Options):
    """Options of `IfraConveyorBelt`."""

    max_velocity: float = number(1.0, "m/s", minimum=0)
    publish_rate: float = number(1000.0, "Hz", minimum=0)
    joint_name: str = text("belt_joint")
    lower_limit: bool = without_effect()
    upper_limit: bool = without_effect()


class IfraConveyorBelt(ConveyorBelt):
    """Moves the surface of the child link of `<joint_name>` along the joint, at a part of `<max_velocity>`.

    The service `CONVEYORPOWER` sets the power from 0 to 100 %. The power is published on `CONVEYORSTATE` at
    `<publish_rate>`.
    """

    endpoints = (
        offers("CONVEYORPOWER", "conveyorbelt_msgs/srv/ConveyorBeltControl"),
        publishes("CONVEYORSTATE", "conveyorbelt_msgs/msg/ConveyorBeltState"),
    )
    options = OptionsOf(IfraConveyorBeltOptions)
    filenames = ("libros2_conveyorbelt_plugin.so", "libros2_conveyorbelt_system.so")

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self.hold_belt(scene, options.joint_name, params.child_or_self("joint_name"), builder)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        topics = ("CONVEYORPOWER", "CONVEYORSTATE")
        self.start("conveyorbelt_msgs", topics, options.max_velocity, 0.0, options.publish_rate)


class AriacConveyorBeltOptions(Options):
    """Options of `AriacConveyorBelt`."""

    robot_namespace: str = text()
    joint: str = text("belt_joint")
    link: bool = without_effect()
    max_velocity: float = number(0.2, "m/s", minimum=0)
    power: float = number(0.0, "%", minimum=0, maximum=_MOST)
    update_rate: float = number(10.0, "Hz", minimum=0)
    control_topic: str = text("conveyor/control")
    state_topic: str = text("conveyor/state")
    population_rate_modifier_topic: bool = without_effect()
    enable_topic: bool = without_effect()


class AriacConveyorBelt(ConveyorBelt):
    """Moves the surface of the child link of `<joint>` (`belt_joint`) along the joint, at a part of `<max_velocity>`.

    The service `<control_topic>` (`conveyor/control`) sets the power from 0 to 100 %, at first `<power>`. The power is
    published on `<state_topic>` (`conveyor/state`) at `<update_rate>`. `<link>` has no effect: the belt is the child
    link of the joint.
    """

    endpoints = (
        offers("conveyor/control", "osrf_gear/srv/ConveyorBeltControl", named_by=("control_topic",)),
        publishes("conveyor/state", "osrf_gear/msg/ConveyorBeltState", named_by=("state_topic",)),
    )
    options = OptionsOf(AriacConveyorBeltOptions)
    filenames = ("libROSConveyorBeltPlugin.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self.hold_belt(scene, options.joint, params.child_or_self("joint"), builder)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        if options.robot_namespace:
            self.ros = self.ros.in_namespace(options.robot_namespace)
        topics = (options.control_topic, options.state_topic)
        self.start("osrf_gear", topics, options.max_velocity, options.power, options.update_rate)
