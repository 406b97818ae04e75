"""Wheel slip of Gazebo and Gazebo Classic.

The module provides `gz::sim::systems::WheelSlip`, `libgazebo_ros_wheel_slip.so` and `libWheelSlipPlugin.so`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from simkit import msgs
from simkit.linear_algebra import matmul, norm
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.find_entities import find_link
from simkit.plugins.options import Options, OptionsOf, blocks, number, text
from simkit.plugins.publish_on_demand import publish_while_subscribed
from simkit.pose import quat_conjugate, quat_rotate
from simkit.runtime.contact.anisotropic_friction import SlippingWheel
from simkit.scene import Cylinder, SceneJoint, SceneLink, SceneModel, Sphere

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model, Simulation
    from simkit.runtime.communication.parameter import Parameter


LATERAL, LONGITUDINAL = "slip_compliance_unitless_lateral", "slip_compliance_unitless_longitudinal"


@dataclass(frozen=True, slots=True)
class Wheel:
    """Wheel of a `<wheel>` block.

    Attributes:
        name: Plain name of the link.
        contact: Link and joint of the wheel.
        radius: Radius [m].
        force: Normal force at which the wheel has these compliances [N].
        lateral, longitudinal: Slip compliances along the axle and across the axle, without unit.
    """

    name: str
    contact: SlippingWheel
    radius: float
    force: float
    lateral: float
    longitudinal: float


_MOST = 1e6


class WheelOptions(Options):
    """Options of a `<wheel>` block."""

    link_name: str = text(element="@link_name")
    slip_compliance_lateral: float = number(0.0, minimum=0, maximum=_MOST)
    slip_compliance_longitudinal: float = number(0.0, minimum=0, maximum=_MOST)
    wheel_normal_force: float = number(None, "N", required=True, minimum=1e-6)
    wheel_radius: float = number(1.0, "m", minimum=1e-6)


class WheelSlipOptions(Options):
    """Options shared by all wheel slip plugins."""

    wheels: tuple[WheelOptions, ...] = blocks(WheelOptions, element="wheel")


class RosWheelSlipOptions(WheelSlipOptions):
    """Options of `GazeboRosWheelSlip`."""

    wheel_spin_tolerance: float = number(1e-3, "m/s", minimum=0)
    publisher_update_rate: float = number(100.0, "Hz")
    slip_compliance_unitless_lateral: float = number(
        -1.0, is_live=True, description="lateral slip compliance of every wheel; negative values are ignored"
    )
    slip_compliance_unitless_longitudinal: float = number(
        -1.0, is_live=True, description="longitudinal slip compliance of every wheel; negative values are ignored"
    )


class WheelSlipBase(ModelPlugin):
    """Lets wheels slip in proportion to the force on their contacts; the compliances are live parameters.

    The compliances of a wheel are the parameters `slip_compliance_unitless_lateral/<link>` and
    `slip_compliance_unitless_longitudinal/<link>` of the plugin's node. The service `/world/<world>/wheel_slip` also
    sets these compliances.
    """

    options = OptionsOf(WheelSlipOptions)
    lets_sleep = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        if not self.options.wheels:
            params.text("wheel", required=True)
        self.wheels: list[Wheel] = []
        used_links: set[str] = set()
        for options in self.options.wheels:
            wheel = _read_wheel(scene, options)
            if wheel is None:
                continue
            if wheel.contact.link in used_links:
                message = f"link {wheel.name!r} already has a <wheel>; remove the second one"
                options.params.error("SK-PLUGIN-092", message)
                continue
            used_links.add(wheel.contact.link)
            self.wheels.append(wheel)
        self.options.read_all()

    def load(self, parent: Model, params: Params) -> None:
        self.compliances = [
            (self._declare_compliance(LATERAL, w, w.lateral), self._declare_compliance(LONGITUDINAL, w, w.longitudinal))
            for w in self.wheels
        ]
        self._scales = [wheel.radius / wheel.force for wheel in self.wheels]
        if self.wheels:
            self.sim.engine.friction.add_wheels(self, [wheel.contact for wheel in self.wheels], self.slips)

    def _declare_compliance(self, name: str, wheel: Wheel, value: float) -> Parameter[float]:
        direction = "along" if name == LATERAL else "across"
        text = f"slip compliance of wheel {wheel.name} {direction} its axle, at a normal force of {wheel.force:g} N"
        return self.declare(f"{name}/{wheel.name}", value, minimum=0.0, maximum=_MOST, description=text)

    def slips(self) -> list[tuple[float, float]]:
        """Return the compliances of each wheel per turning rate [m/N], lateral first."""
        return [
            (scale * across.value, scale * ahead.value)
            for scale, (across, ahead) in zip(self._scales, self.compliances, strict=True)
        ]


def _read_wheel(scene: SceneModel, options: WheelOptions) -> Wheel | None:
    """Read one `<wheel>` block; return None after an error."""
    block, lateral, longitudinal = options.params, options.slip_compliance_lateral, options.slip_compliance_longitudinal
    force = options.wheel_normal_force
    radius = options.wheel_radius if block.has("wheel_radius") else 0.0
    name = options.link_name
    if not name:
        block.error("SK-PARAM-001", '<wheel> has no link_name; write <wheel link_name="..."> with the wheel\'s link')
    link = find_link(scene, name, block) if name else None
    if link is None:
        return None
    joint = _wheel_joint(scene, link, block)
    if len(link.collisions) != 1:
        message = f"link {name!r} has {len(link.collisions) or 'no'} collisions; a wheel that slips needs exactly one"
        block.error("SK-PLUGIN-091", message)
    shape = link.collisions[0].geometry if link.collisions else None
    if not radius and isinstance(shape, (Cylinder, Sphere)):
        radius = shape.radius
    if not radius:
        block.number("wheel_radius", required=True)
    if joint is None or len(link.collisions) != 1 or not radius:
        return None
    contact = SlippingWheel(link.scoped, joint.scoped)
    return Wheel(link.name, contact, radius, force, lateral, longitudinal)


def _wheel_joint(scene: SceneModel, link: SceneLink, block: Params) -> SceneJoint | None:
    """Return the only joint that a wheel turns on, or None after an error."""
    joints = [joint for joint in scene.all_joints() if joint.child_link == link.scoped]
    if len(joints) != 1 or len(joints[0].axes) != 1:
        listed = ", ".join(f"{joint.name!r} ({joint.type})" for joint in joints) or "none"
        message = f"link {link.name!r} is the child of {listed}; a wheel that slips needs one joint with one axis"
        block.error("SK-PLUGIN-091", message)
        return None
    return joints[0]


def set_compliances(sim: Simulation, links: set[str], lateral: float, longitudinal: float) -> list[str]:
    """Set the slip compliances of the wheels among some links; used by `/world/<world>/wheel_slip`.

    Args:
        sim: Simulation of the wheels.
        links: Scoped names of links.
        lateral: Compliance along the axle.
        longitudinal: Compliance across the axle.

    Returns:
        The scoped names of the links that are wheels.
    """
    changed_links: list[str] = []
    for plugin in sim.engine.friction.owners():
        if not isinstance(plugin, WheelSlipBase):
            continue
        for wheel, pair in zip(plugin.wheels, plugin.compliances, strict=True):
            if wheel.contact.link in links:
                changed_links.append(wheel.contact.link)
                for parameter, value in zip(pair, (lateral, longitudinal), strict=True):
                    sim.set_parameter(parameter.node, parameter.name, value)
    return changed_links


class WheelSlip(WheelSlipBase):
    """Lets wheels slip along and across their axle; no `<fdir1>` is needed."""

    filenames = ("gz-sim-wheel-slip-system",)
    names = ("gz::sim::systems::WheelSlip",)


_SLIP = "gazebo_msgs/msg/WheelSlip"
_VECTOR = "geometry_msgs/msg/Vector3"
_NUMBERS = ("std_msgs/msg/Float64", "std_msgs/msg/Float32")
_UNSET = -1.0


class _ClassicWheelSlip(WheelSlipBase):
    """Base class of both Gazebo Classic variants, which publish the current slip of their wheels."""

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        self._model = parent
        down = self.sim.mj_model.opt.gravity
        size = norm(down)
        # in Classic the downward direction is constant in the model's frame, so this direction turns with the model
        world = down / size if size > 0 else np.array([0.0, 0.0, -1.0])
        self._down = quat_rotate(quat_conjugate(parent.scene.pose_world.quaternion), world).tolist()
        self._links = [self.sim.link(wheel.contact.link) for wheel in self.wheels]
        self._joints = [self.sim.joint(wheel.contact.joint) for wheel in self.wheels]

    def measured(self) -> list[tuple[Wheel, float, float, float]]:
        """Return each wheel with its forward speed, its speed along the axle and its rim speed [m/s]."""
        data = self.sim.engine.physics.fresh()
        down = quat_rotate(self._model.pose.quaternion, self._down)
        measurements = []
        for wheel, link, joint in zip(self.wheels, self._links, self._joints, strict=True):
            axle = data.xaxis[self.sim.engine.names.joint(wheel.contact.joint).joint_ids[0]]
            velocity, rim = link.linear_velocity, wheel.radius * float(joint.velocity)
            measurements.append(
                (wheel, float(matmul(np.cross(down, axle), velocity)), float(matmul(axle, velocity)), rim)
            )
        return measurements

    def set_all(self, side: int, value: float) -> None:
        """Set one compliance of every wheel.

        Args:
            side: 0 for the lateral compliance, 1 for the longitudinal one.
            value: New compliance.
        """
        for pair in self.compliances:
            self.sim.set_parameter(pair[side].node, pair[side].name, value)


class GazeboRosWheelSlip(_ClassicWheelSlip):
    """Lets wheels slip, and publishes the slip of each wheel on `wheel_slip`.

    The lateral slip is the angle between a wheel and its direction of motion [rad]. The longitudinal slip is the
    fraction of the rim speed that is lost. Both are 0 for a wheel whose rim speed is below `<wheel_spin_tolerance>`
    (0.001 m/s). The parameters `slip_compliance_unitless_lateral` and `slip_compliance_unitless_longitudinal` set all
    wheels.
    """

    options = OptionsOf(RosWheelSlipOptions)
    filenames = ("libgazebo_ros_wheel_slip.so",)

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        for side, name in enumerate((LATERAL, LONGITUDINAL)):
            kind = "lateral" if side == 0 else "longitudinal"
            text = f"{kind} slip compliance of every wheel; negative values are ignored"
            self.declare(name, _UNSET, description=text, on_change=partial(self._on_all, side))
        self._out = self.advertise("wheel_slip", _SLIP)
        publish_while_subscribed(self, self._out, max(0.0, self.options.publisher_update_rate), "tell")

    def _on_all(self, side: int, value: float) -> None:
        if value >= 0.0:
            self.set_all(side, value)

    def tell(self) -> None:
        """Publish the slip of all wheels."""
        names: list[str] = []
        slips: list[tuple[float, float]] = []
        for wheel, ahead, sideways, rim in self.measured():
            names.append(wheel.name)
            is_still = abs(rim) < self.options.wheel_spin_tolerance
            slips.append((0.0, 0.0) if is_still else (math.atan2(sideways, ahead), (rim - ahead) / rim))
        lateral, longitudinal = (np.array(column) for column in zip(*slips, strict=True))
        self._out.publish(msgs.type_of(_SLIP)(names, lateral, longitudinal))


class ClassicWheelSlip(_ClassicWheelSlip):
    """Lets wheels slip, and publishes the slip speed of each wheel on `/<model>/wheel_slip/<link>`.

    The message is a vector: forward speed minus rim speed, sideways speed, and rim speed [m/s].

    Numbers on `/<model>/wheel_slip/lateral_compliance` and `longitudinal_compliance` set all wheels (in Gazebo Classic
    they are text).
    """

    endpoints = (
        listens("/{model}/wheel_slip/lateral_compliance", *_NUMBERS),
        listens("/{model}/wheel_slip/longitudinal_compliance", *_NUMBERS),
        publishes("/{model}/wheel_slip/{link}", _VECTOR),
    )
    filenames = ("libWheelSlipPlugin.so",)

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        prefix = f"/{parent.name}/wheel_slip"
        for side, name in enumerate(("lateral", "longitudinal")):
            topic = valid_topic(f"{prefix}/{name}_compliance")
            self.listen(topic, _NUMBERS, partial(self._on_compliance, side))
        self._outs = [self.advertise(valid_topic(f"{prefix}/{wheel.name}"), _VECTOR) for wheel in self.wheels]
        for out in self._outs:
            publish_while_subscribed(self, out, 0.0, "tell")

    def _on_compliance(self, side: int, message: msgs.Float64) -> None:
        value = float(message.data)
        if math.isfinite(value) and value >= 0.0:
            self.set_all(side, value)
        else:
            self.log.warning("compliance %g is ignored: it must be finite and not negative", value)

    def tell(self) -> None:
        """Publish the slip of each wheel whose topic has a subscriber."""
        now = self.sim.time_ns
        if vars(self).get("_published_ns") == now:
            return
        self._published_ns = now
        for out, (_, ahead, sideways, rim) in zip(self._outs, self.measured(), strict=True):
            if out.wanted:
                out.publish(msgs.type_of(_VECTOR)(ahead - rim, sideways, rim))
