"""Wheel slip of Gazebo Classic: `libgazebo_ros_wheel_slip.so` and `libWheelSlipPlugin.so`."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit import msgs
from simkit.msgs.topics import valid_topic
from simkit.params import Params
from simkit.plugins.drives.slipping_wheels import LATERAL, LONGITUDINAL, SlippingWheels, Wheel
from simkit.plugins.heard import publish_while_heard
from simkit.pose import quat_conjugate, quat_rotate

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.scene import SceneModel

_SLIP = "gazebo_msgs/msg/WheelSlip"
_VECTOR = "geometry_msgs/msg/Vector3"
_NUMBERS = ("std_msgs/msg/Float64", "std_msgs/msg/Float32")
_UNSET = -1.0


class _ClassicWheelSlip(SlippingWheels):
    """What both know of their wheels: how they slip now."""

    def load(self, parent: Any, params: Params) -> None:
        super().load(parent, params)
        self._model = parent
        down = self.sim.mj_model.opt.gravity
        size = float(np.linalg.norm(down))
        # as Classic: downwards where the model started, turned with it
        world = down / size if size > 0 else np.array([0.0, 0.0, -1.0])
        self._down = quat_rotate(quat_conjugate(parent.scene.pose_world.quaternion), world).tolist()
        self._links = [self.sim.link(wheel.contact.link) for wheel in self.wheels]
        self._joints = [self.sim.joint(wheel.contact.joint) for wheel in self.wheels]

    def measured(self) -> list[tuple[Wheel, float, float, float]]:
        """Of each wheel its speeds ahead and along the axle, and that of its rim [m/s]."""
        data = self.sim.physics.fresh()
        down = quat_rotate(self._model.pose.quaternion, self._down)
        found = []
        for wheel, link, joint in zip(self.wheels, self._links, self._joints, strict=True):
            axle = data.xaxis[self.sim.names.joint(wheel.contact.joint).joint_ids[0]]
            velocity, rim = link.linear_velocity, wheel.radius * float(joint.velocity)
            found.append((wheel, float(np.cross(down, axle) @ velocity), float(axle @ velocity), rim))
        return found

    def set_all(self, side: int, value: float) -> None:
        """One compliance of every wheel: 0 is the lateral one, 1 the longitudinal."""
        for pair in self.compliances:
            self.sim.set_parameter(pair[side].node, pair[side].name, value)


class GazeboRosWheelSlip(_ClassicWheelSlip):
    """Lets wheels slip, and tells on `wheel_slip` by how much.

    The lateral slip is the angle between a wheel and the way it goes [rad], the longitudinal one the part of its rim
    speed that it loses; both are 0 of a wheel whose rim moves slower than `<wheel_spin_tolerance>` (0.001 m/s). With
    the parameters `slip_compliance_unitless_lateral` and `slip_compliance_unitless_longitudinal` all wheels are set.
    """

    filenames = ("libgazebo_ros_wheel_slip.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        super().prepare(scene, params, builder)
        self._tolerance = params.number("wheel_spin_tolerance", 1e-3, minimum=0)
        self._rate = params.number("publisher_update_rate", 100.0)

    def load(self, parent: Any, params: Params) -> None:
        super().load(parent, params)
        for side, name in enumerate((LATERAL, LONGITUDINAL)):
            what = f"{'lateral' if side == 0 else 'longitudinal'} slip compliance of every wheel; negative leaves them"
            self.declare(name, _UNSET, description=what, on_change=partial(self._on_all, side))
        self._out = self.advertise("wheel_slip", _SLIP)
        publish_while_heard(self, self._out, max(0.0, self._rate), "tell")

    def _on_all(self, side: int, value: float) -> None:
        if value >= 0.0:
            self.set_all(side, value)

    def tell(self) -> None:
        """Publishes."""
        names: list[str] = []
        slips: list[tuple[float, float]] = []
        for wheel, ahead, sideways, rim in self.measured():
            names.append(wheel.name)
            is_still = abs(rim) < self._tolerance
            slips.append((0.0, 0.0) if is_still else (math.atan2(sideways, ahead), (rim - ahead) / rim))
        lateral, longitudinal = (np.array(column) for column in zip(*slips, strict=True))
        self._out.publish(msgs.type_of(_SLIP)(names, lateral, longitudinal))


class ClassicWheelSlip(_ClassicWheelSlip):
    """Lets wheels slip, and tells of each on `/<model>/wheel_slip/<link>` how fast.

    It is a vector: the speed ahead less that of the rim, the speed sideways, and that of the rim [m/s].

    Numbers on `/<model>/wheel_slip/lateral_compliance` and `longitudinal_compliance` set all wheels (in Gazebo Classic
    they are text).
    """

    filenames = ("libWheelSlipPlugin.so",)

    def load(self, parent: Any, params: Params) -> None:
        super().load(parent, params)
        prefix = f"/{parent.name}/wheel_slip"
        for side, name in enumerate(("lateral", "longitudinal")):
            topic = valid_topic(f"{prefix}/{name}_compliance")
            self.listen(topic, _NUMBERS, partial(self._on_compliance, side))
        self._outs = [self.advertise(valid_topic(f"{prefix}/{wheel.name}"), _VECTOR) for wheel in self.wheels]
        for out in self._outs:
            publish_while_heard(self, out, 0.0, "tell")

    def _on_compliance(self, side: int, message: Any) -> None:
        value = float(message.data)
        if math.isfinite(value) and value >= 0.0:
            self.set_all(side, value)
        else:
            self.log.warning("a compliance of %g is left out, it cannot be negative", value)

    def tell(self) -> None:
        """Publishes what is heard."""
        now = self.sim.time_ns
        if vars(self).get("_told_ns") == now:
            return
        self._told_ns = now
        for out, (_, ahead, sideways, rim) in zip(self._outs, self.measured(), strict=True):
            if out.wanted:
                out.publish(msgs.type_of(_VECTOR)(ahead - rim, sideways, rim))
