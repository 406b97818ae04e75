"""Thruster of an underwater vehicle in Gazebo Classic: `libuuv_thruster_ros_plugin.so` of uuv_simulator.

Parameters, defaults, topics and services are those of `ThrusterPlugin.cc` and `ThrusterROSPlugin.cc`.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Final

from simkit import ModelPlugin, Params, msgs
from simkit.extend import (
    JointAxis,
    Options,
    OptionsOf,
    find_named_link,
    integer,
    listens,
    number,
    offers,
    publishes,
    text,
)
from simkit.plugins.find_entities import find_axis_joint
from simkit.plugins.one_time_warnings import are_usable
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit_water_and_air.plugins.fluids.propeller_joint import PropellerJoint, propeller_inertia
from simkit_water_and_air.plugins.uuv.rotor_response import read_response, read_thrust_curve

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Message

STAMPED: Final = "uuv_gazebo_ros_plugins_msgs/msg/FloatStamped"
WRENCH: Final = "geometry_msgs/msg/WrenchStamped"
_SERVICES: Final = "uuv_gazebo_ros_plugins_msgs/srv"
_FLOAT, _BOOL = "std_msgs/msg/Float64", "std_msgs/msg/Bool"
_BASE: Final = "/{model}/thrusters/{thrusterID}"


class UuvThrusterOptions(Options):
    """Options of `UuvThruster`."""

    link: str = text(None, element="linkName", required=True)
    joint: str = text(element="jointName")
    id: int = integer(None, element="thrusterID", minimum=0, required=True)
    least_command: float = number(-math.inf, element="clampMin", finite=False)
    most_command: float = number(math.inf, element="clampMax", finite=False)
    least_thrust: float = number(-math.inf, "N", element="thrustMin", finite=False)
    most_thrust: float = number(math.inf, "N", element="thrustMax", finite=False)
    gain: float = number(1.0, minimum=-1e12, maximum=1e12)
    thrust_efficiency: float = number(1.0, minimum=0.0, maximum=1.0)
    propeller_efficiency: float = number(1.0, minimum=0.0, maximum=1.0)


class UuvThruster(ModelPlugin):
    """Pushes a link along the axis of its propeller, by the command's effect on the propeller's speed and thrust.

    A command is a `FloatStamped` on `/<model>/thrusters/<thrusterID>/input`. `<gain>` times the command goes through
    `<dynamics>` to the speed of the propeller, and through `<conversion>` to the thrust [N]. The thrust is published on
    `thrust` and `thrust_wrench` twenty times a second, with the state on `is_on` and both efficiencies. Services switch
    the thruster off and set efficiencies.
    """

    endpoints = (
        listens(f"{_BASE}/input", STAMPED, _FLOAT),
        publishes(f"{_BASE}/thrust", STAMPED),
        publishes(f"{_BASE}/thrust_wrench", WRENCH),
        publishes(f"{_BASE}/is_on", _BOOL),
        publishes(f"{_BASE}/thrust_efficiency", _FLOAT),
        publishes(f"{_BASE}/dynamic_state_efficiency", _FLOAT),
        offers(f"{_BASE}/set_thruster_state", f"{_SERVICES}/SetThrusterState"),
        offers(f"{_BASE}/get_thruster_state", f"{_SERVICES}/GetThrusterState"),
        offers(f"{_BASE}/set_thrust_force_efficiency", f"{_SERVICES}/SetThrusterEfficiency"),
        offers(f"{_BASE}/get_thrust_force_efficiency", f"{_SERVICES}/GetThrusterEfficiency"),
        offers(f"{_BASE}/set_dynamic_state_efficiency", f"{_SERVICES}/SetThrusterEfficiency"),
        offers(f"{_BASE}/get_dynamic_state_efficiency", f"{_SERVICES}/GetThrusterEfficiency"),
        offers(f"{_BASE}/get_thruster_conversion_fcn", f"{_SERVICES}/GetThrusterConversionFcn"),
    )
    options = OptionsOf(UuvThrusterOptions)
    filenames = ("libuuv_thruster_ros_plugin.so", "libuuv_thruster_plugin.so", "libthruster_ros_plugin.so")
    drives = True
    after_step_rate = 20.0
    reads_at_load = ("inertial", "axes")

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._link = find_named_link(scene, "linkName", params)
        self._response, self._curve = read_response(params), read_thrust_curve(params)
        self._joint_name, self._inertia = "", 0.0
        joint = find_axis_joint(scene, options.joint, params.block("jointName")) if options.joint else None
        if joint is not None:
            self._joint_name, self._inertia = joint.scoped, propeller_inertia(scene, joint)
        self._commands = _range(params, "clamp", options.least_command, options.most_command)
        self._thrusts = _range(params, "thrust", options.least_thrust, options.most_thrust)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self._joint = None
        if self._joint_name:
            self._joint = PropellerJoint(JointAxis(self.sim.joint(self._joint_name)), self._inertia, self.period)
        self._links = PushedLinks(self.sim, (self._link,))
        self._command = self._thrust = 0.0
        self._direction = (1.0, 0.0, 0.0)  # of the thrust, in the axes of the link
        self._is_on, self._has_begun = True, False
        self._efficiency = {"thrust": options.thrust_efficiency, "state": options.propeller_efficiency}
        base = f"/{parent.name}/thrusters/{options.id}"
        self.listen(f"{base}/input", (STAMPED, _FLOAT), self._on_command)
        self._outputs = {
            "thrust": self.advertise(f"{base}/thrust", STAMPED),
            "wrench": self.advertise(f"{base}/thrust_wrench", WRENCH),
            "is_on": self.advertise(f"{base}/is_on", _BOOL),
            "thrust_efficiency": self.advertise(f"{base}/thrust_efficiency", _FLOAT),
            "state_efficiency": self.advertise(f"{base}/dynamic_state_efficiency", _FLOAT),
        }
        self._offer_services(base)

    def _offer_services(self, base: str) -> None:
        self.offer(f"{base}/set_thruster_state", f"{_SERVICES}/SetThrusterState", self._switch)
        self.offer(f"{base}/get_thruster_state", f"{_SERVICES}/GetThrusterState", lambda _: {"is_on": self._is_on})
        for name, key in (("thrust_force", "thrust"), ("dynamic_state", "state")):
            get, put = partial(self._get_efficiency, key), partial(self._set_efficiency, key)
            self.offer(f"{base}/get_{name}_efficiency", f"{_SERVICES}/GetThrusterEfficiency", get)
            self.offer(f"{base}/set_{name}_efficiency", f"{_SERVICES}/SetThrusterEfficiency", put)
        curve = f"{_SERVICES}/GetThrusterConversionFcn"
        self.offer(f"{base}/get_thruster_conversion_fcn", curve, lambda _: {"fcn": self._curve_fields()})

    def _switch(self, request: Message) -> dict[str, object]:
        self._is_on = bool(request.on)
        return {"success": True}

    def _get_efficiency(self, key: str, _: Message) -> dict[str, object]:
        return {"efficiency": self._efficiency[key]}

    def _set_efficiency(self, key: str, request: Message) -> dict[str, object]:
        efficiency = float(request.efficiency)
        is_valid = 0.0 <= efficiency <= 1.0
        if is_valid:
            self._efficiency[key] = efficiency
        return {"success": is_valid}

    def _curve_fields(self) -> dict[str, object]:
        curve = self._curve
        return {
            "function_name": curve.kind,
            "tags": list(curve.values),
            "data": [*curve.values.values()],
            "lookup_table_input": [state for state, _ in curve.table],
            "lookup_table_output": [thrust for _, thrust in curve.table],
        }

    def _on_command(self, message: Message) -> None:
        value = float(message.data)
        if are_usable(value):
            self._command = value
        else:
            self._once.not_finite()

    def before_step(self) -> None:
        """Apply the thrust for the next step, and turn the propeller."""
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, (self._link,))
        low, high = self._commands
        target = self.options.gain * max(low, min(high, self._command)) if self._is_on else 0.0
        step = self.period if self._has_begun else 0.0  # in Gazebo, the first call only stores the time
        self._has_begun = True
        speed = self._efficiency["state"] * self._response.update(target, step)
        low, high = self._thrusts
        self._thrust = max(low, min(high, self._efficiency["thrust"] * self._curve.thrust(speed)))
        if self._joint is not None:
            self._joint.turn(speed)
        if len(self._links):
            self._push()

    def _push(self) -> None:
        data = moving_data(self.sim)
        body = self._links.ids[0]
        xx, xy, xz, yx, yy, yz, zx, zy, zz = data.xmat[body].tolist()
        axis = (xx, yx, zx)
        if self._joint is not None:
            axis = tuple(data.xaxis[self.sim.mj_model.dof_jntid[self._joint.axis.dof]].tolist())
        x, y, z = axis
        self._direction = (xx * x + yx * y + zx * z, xy * x + yy * y + zy * z, xz * x + yz * y + zz * z)
        thrust = self._thrust
        self._links.push_some(data, {0: (x * thrust, y * thrust, z * thrust, 0.0, 0.0, 0.0)})

    def after_step(self) -> None:
        """Publish the thrust and the state."""
        outputs, time_ns = self._outputs, self.sim.time_ns
        frame = self._link.rsplit("::", 1)[-1]
        if outputs["thrust"].wanted:
            outputs["thrust"].publish(msgs.make(STAMPED, header=msgs.header(time_ns, frame), data=self._thrust))
        if outputs["wrench"].wanted:
            force = dict(zip("xyz", (axis * self._thrust for axis in self._direction), strict=True))
            wrench = {"force": force}
            outputs["wrench"].publish(msgs.make(WRENCH, header=msgs.header(time_ns, frame), wrench=wrench))
        for name, value in (
            ("is_on", self._is_on),
            ("thrust_efficiency", self._efficiency["thrust"]),
            ("state_efficiency", self._efficiency["state"]),
        ):
            if outputs[name].wanted:
                outputs[name].publish(msgs.make(outputs[name].type_name, data=value))


def _range(params: Params, name: str, low: float, high: float) -> tuple[float, float]:
    """Return the limits `<nameMin>` and `<nameMax>`; no limits after a warning if they are reversed."""
    if low < high:
        return low, high
    message = f"found <{name}Min> {low:g} and <{name}Max> {high:g}; both are left out, as in Gazebo"
    params.warning("SK-PARAM-008", message, f"<{name}Min> is below <{name}Max>")
    return -math.inf, math.inf
