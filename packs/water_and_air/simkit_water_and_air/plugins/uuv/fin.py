"""Fin of an underwater vehicle in Gazebo Classic: `libuuv_fin_ros_plugin.so` of uuv_simulator.

Parameters, topics and forces are those of `FinPlugin.cc`, `FinROSPlugin.cc` and `LiftDragModel.cc`. The flow has the
angle α to the x axis of the fin, in the plane of its x and y axes.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params, msgs
from simkit.extend import (
    JointAxis,
    Options,
    OptionsOf,
    find_named_joint,
    find_named_link,
    integer,
    listens,
    offers,
    publishes,
    text,
)
from simkit.linear_algebra import matmul
from simkit.plugins.one_time_warnings import are_usable
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit_water_and_air.plugins.fluids.water_current import CURRENT_TYPES, absolute_topic, current_of
from simkit_water_and_air.plugins.uuv.rotor_response import read_response
from simkit_water_and_air.plugins.uuv.thruster import STAMPED, WRENCH

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Message

_PARAMS: Final = "uuv_gazebo_ros_plugins_msgs/srv/GetListParam"
_BASE: Final = "/{model}/fins/{fin_id}"
_LIFT_DRAG: Final[dict[str, tuple[str, ...]]] = {
    "Quadratic": ("lift_constant", "drag_constant"),
    "TwoLines": ("area", "fluid_density", "a0", "alpha_stall", "cla", "cla_stall", "cda", "cda_stall"),
}
_MOST: Final = 1e9


class UuvFinOptions(Options):
    """Options of `UuvFin`."""

    id: int = integer(None, element="fin_id", minimum=0, required=True)
    link: str = text(None, element="link_name", required=True)
    joint: str = text(None, element="joint_name", required=True)
    current_topic: str = text(element="current_velocity_topic")
    input_topic: str = text()
    output_topic: str = text()
    wrench_topic: str = text()


class UuvFin(ModelPlugin):
    """Turns a fin to a commanded angle, and applies the lift and drag of the water.

    A command is a `FloatStamped` [rad] on `/<model>/fins/<fin_id>/input`. The angle is published on `output` and the
    force on `wrench_topic`, twenty times a second.
    """

    endpoints = (
        listens(f"{_BASE}/input", STAMPED, named_by=("input_topic",)),
        listens("/{current_velocity_topic}", *CURRENT_TYPES, named_by=("current_velocity_topic",)),
        publishes(f"{_BASE}/output", STAMPED, named_by=("output_topic",)),
        publishes(f"{_BASE}/wrench_topic", WRENCH, named_by=("wrench_topic",)),
        offers(f"{_BASE}/get_lift_drag_params", _PARAMS),
    )
    options = OptionsOf(UuvFinOptions)
    filenames = ("libuuv_fin_ros_plugin.so", "libuuv_fin_plugin.so")
    drives = True
    after_step_rate = 20.0

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        self._link = find_named_link(scene, "link_name", params)
        joint = find_named_joint(scene, "joint_name", params)
        self._response = read_response(params)
        self._kind, self._coefficients = _read_lift_drag(params)
        self._joint_name = ""
        if joint is not None:
            self._joint_name = joint.scoped
            self._servo = builder.add_position_servo(joint.scoped, max_effort=math.inf, owner=self.name)
            limits = joint.axes[0]
            self._limits = float(limits.lower), float(limits.upper)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self._joint = JointAxis(self.sim.joint(self._joint_name))
        self._links = PushedLinks(self.sim, (self._link,))
        self._command, self._current, self._force = 0.0, (0.0, 0.0, 0.0), np.zeros(3)
        self._has_begun = False
        base = f"/{parent.name}/fins/{options.id}"
        self.listen(options.input_topic or f"{base}/input", STAMPED, self._on_command)
        if options.current_topic:
            self.listen(absolute_topic(options.current_topic), CURRENT_TYPES, self._on_current)
        self._angle_output = self.advertise(options.output_topic or f"{base}/output", STAMPED)
        self._wrench_output = self.advertise(options.wrench_topic or f"{base}/wrench_topic", WRENCH)
        self.offer(f"{base}/get_lift_drag_params", _PARAMS, self._lift_drag_params)

    def _lift_drag_params(self, _: Message) -> dict[str, object]:
        return {"description": self._kind, "tags": list(self._coefficients), "data": [*self._coefficients.values()]}

    def _on_command(self, message: Message) -> None:
        if are_usable(float(message.data)):
            self._command = float(message.data)
        else:
            self._once.not_finite()

    def _on_current(self, message: Message) -> None:
        current = current_of(message)
        if current is None:
            self._once.not_finite("a current")
        else:
            self._current = current

    def before_step(self) -> None:
        """Apply lift and drag for the next step, and turn the fin."""
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, (self._link,))
        low, high = self._limits
        self._command = max(low, min(high, self._command))
        angle = self._response.update(self._command, self.period if self._has_begun else 0.0)
        self._has_begun = True
        self.sim.mj_data.ctrl[self.sim.engine.names.actuator(self._servo)] = angle
        if not len(self._links):
            return
        data = moving_data(self.sim)
        axes = self._links.axes(data)[0]
        velocity = self._links.velocities(data)[0] - np.array(self._current)
        x, y, _ = matmul(velocity, axes).tolist()
        self._force = np.array((*self._lift_and_drag(x, y), 0.0))
        self._links.push(data, matmul(axes, self._force)[None])

    def _lift_and_drag(self, x: float, y: float) -> tuple[float, float]:
        """Return the force [N] in the fin's x and y for a velocity through the water [m/s]."""
        speed = math.hypot(x, y)
        if speed == 0.0:
            return 0.0, 0.0
        angle, values = math.atan2(y, x), self._coefficients
        if abs(angle) > math.pi / 2:
            angle -= math.copysign(math.pi, angle)
        if self._kind == "Quadratic":
            lift = angle * speed * speed * values["lift_constant"]
            drag = angle * angle * speed * speed * values["drag_constant"]
        else:
            alpha = angle + values["a0"]
            while abs(alpha) > math.pi / 2:
                alpha -= math.copysign(math.pi, alpha)
            stall = values["alpha_stall"]
            within = max(-stall, min(stall, alpha))
            pressure = 0.5 * values["fluid_density"] * speed * speed * values["area"]
            slope = values["cla_stall"] if alpha > 0 else values["cda_stall"]  # as in the source
            lift = (values["cla"] * within + slope * (alpha - within)) * pressure
            drag = (values["cda"] * within + values["cda_stall"] * (alpha - within)) * pressure
        along, across = x / speed, y / speed
        return lift * across - drag * along, -lift * along - drag * across

    def after_step(self) -> None:
        """Publish the angle and the force."""
        header = msgs.header(self.sim.time_ns, self._link.rsplit("::", 1)[-1])
        if self._angle_output.wanted:
            self._angle_output.publish(msgs.make(STAMPED, header=header, data=self._response.state))
        if self._wrench_output.wanted:
            force = dict(zip("xyz", self._force.tolist(), strict=True))
            self._wrench_output.publish(msgs.make(WRENCH, header=header, wrench={"force": force}))


def _read_lift_drag(params: Params) -> tuple[str, dict[str, float]]:
    """Read the `<liftdrag>` of a fin."""
    block = params.child("liftdrag")
    if block is None:
        params.error("SK-PARAM-001", "found no <liftdrag>; expected a block with a <type>")
        return "Quadratic", {"lift_constant": 0.0, "drag_constant": 0.0}
    kind = block.choice("type", tuple(_LIFT_DRAG), required=True)
    names = _LIFT_DRAG.get(kind, ())
    return kind, {name: block.number(name, 0.0, required=True, minimum=-_MOST, maximum=_MOST) for name in names}
