"""Wheels that slip: what gz's and Classic's plugins share.

A wheel's contact yields to force: its surface passes the ground at a speed of c F, with c = s |ω| r / N of a compliance
s without a unit, the wheel's speed of turning ω and radius r, and a force N near the one that the wheel carries. So s
is the slip, the part of its rim speed that the wheel loses, where the force is N. At rest nothing slips.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.lookups import find_link
from simkit.runtime.directed_friction import SlippingWheel
from simkit.scene import Cylinder, SceneJoint, SceneLink, SceneModel, Sphere

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.runtime import Simulation

LATERAL, LONGITUDINAL = "slip_compliance_unitless_lateral", "slip_compliance_unitless_longitudinal"


@dataclass(frozen=True, slots=True)
class Wheel:
    """A `<wheel>` of the file.

    Attributes:
        name: plain name of the link.
        contact: its link and joint.
        radius: [m].
        force: that the compliances are told at [N].
        lateral, longitudinal: compliances along the axle and across it.
    """

    name: str
    contact: SlippingWheel
    radius: float
    force: float
    lateral: float
    longitudinal: float


class SlippingWheels(ModelPlugin):
    """Lets the contacts of wheels slip with the force on them; the compliances are live parameters.

    The compliances of a wheel are the parameters `slip_compliance_unitless_lateral/<link>` and
    `slip_compliance_unitless_longitudinal/<link>` of the plugin's node; `/world/<world>/wheel_slip` sets them too.
    """

    lets_sleep = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        blocks = params.all("wheel")
        if not blocks:
            params.text("wheel", required=True)
        self.wheels: list[Wheel] = []
        taken: set[str] = set()
        for block in blocks:
            wheel = _read_wheel(scene, block)
            if wheel is None:
                continue
            if wheel.contact.link in taken:
                block.error("SK-PLUGIN-092", f"link {wheel.name!r} has a <wheel> already; there is one for each")
                continue
            taken.add(wheel.contact.link)
            self.wheels.append(wheel)

    def load(self, parent: Any, params: Params) -> None:
        self.compliances = [
            (self._own(LATERAL, w, w.lateral), self._own(LONGITUDINAL, w, w.longitudinal)) for w in self.wheels
        ]
        self._scales = [wheel.radius / wheel.force for wheel in self.wheels]
        if self.wheels:
            self.sim.friction.add_wheels(self, [wheel.contact for wheel in self.wheels], self.slips)

    def _own(self, name: str, wheel: Wheel, value: float) -> Any:
        ahead = "along" if name == LATERAL else "across"
        text = f"slip of wheel {wheel.name}, {ahead} its axle, where the force is {wheel.force:g} N"
        return self.declare(f"{name}/{wheel.name}", value, minimum=0.0, maximum=_MOST, description=text)

    def slips(self) -> list[tuple[float, float]]:
        """Compliances of each wheel, per rate of turning [m/N]."""
        return [
            (scale * across.value, scale * ahead.value)
            for scale, (across, ahead) in zip(self._scales, self.compliances, strict=True)
        ]


_MOST = 1e6


def _read_wheel(scene: SceneModel, block: Params) -> Wheel | None:
    """One `<wheel>`; None after an error."""
    lateral = block.number("slip_compliance_lateral", 0.0, minimum=0, maximum=_MOST)
    longitudinal = block.number("slip_compliance_longitudinal", 0.0, minimum=0, maximum=_MOST)
    force = block.number("wheel_normal_force", required=True, minimum=1e-6)
    radius = block.number("wheel_radius", 1.0, minimum=1e-6) if block.has("wheel_radius") else 0.0
    name = block.attribute("link_name")
    if not name:
        block.error("SK-PARAM-001", "<wheel> has no link_name; it is the link of the wheel")
        return None
    link = find_link(scene, name, block)
    if link is None:
        return None
    joint = _joint_of(scene, link, block)
    if len(link.collisions) != 1:
        message = f"link {name!r} has {len(link.collisions) or 'no'} collisions; a wheel that slips has one"
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


def _joint_of(scene: SceneModel, link: SceneLink, block: Params) -> SceneJoint | None:
    """The one joint that a wheel turns on; None after an error."""
    joints = [joint for joint in scene.all_joints() if joint.child_link == link.scoped]
    if len(joints) != 1 or len(joints[0].axes) != 1:
        found = ", ".join(f"{joint.name!r} ({joint.type})" for joint in joints) or "none"
        message = f"link {link.name!r} is the child of {found}; a wheel that slips turns on one joint with one axis"
        block.error("SK-PLUGIN-091", message)
        return None
    return joints[0]


def set_compliances(sim: Simulation, links: set[str], lateral: float, longitudinal: float) -> list[str]:
    """Sets the compliances of wheels among links, as `/world/<world>/wheel_slip` does; which wheels were there."""
    found: list[str] = []
    for plugin in sim.friction.owners():
        if not isinstance(plugin, SlippingWheels):
            continue
        for wheel, pair in zip(plugin.wheels, plugin.compliances, strict=True):
            if wheel.contact.link in links:
                found.append(wheel.contact.link)
                for parameter, value in zip(pair, (lateral, longitudinal), strict=True):
                    sim.set_parameter(parameter.node, parameter.name, value)
    return found
