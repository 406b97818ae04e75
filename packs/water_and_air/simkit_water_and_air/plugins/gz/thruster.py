"""Thruster of a boat or submarine: `gz::sim::systems::Thruster`.

A propeller of diameter D that turns at ω in a fluid of density ρ has the thrust T = k · ρ · D⁴ · ω · |ω|, with the
thrust coefficient k (T. I. Fossen, "Guidance and Control of Ocean Vehicles", 1994, page 246). Without the element
`<thrust_coefficient>`, k = alpha_1 + alpha_2 · (1 - wake_fraction) · V / (ω · D), for a propeller that moves at the
speed V.
"""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params, msgs
from simkit.extend import JointAxis, Options, OptionsOf, boolean, find_named_joint, listens, number, publishes, text
from simkit.linear_algebra import matmul, norm
from simkit.msgs import valid_topic
from simkit.plugins.battery import Battery, BatteryConsumer
from simkit.plugins.joints.joint_commands import DOUBLE
from simkit.plugins.joints.pid import Pid
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit_water_and_air.plugins.fluids.propeller_joint import PropellerJoint, propeller_inertia

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Bool, Float64

_BOOL: Final = "std_msgs/msg/Bool"
_MOST: Final = 1e12
_CLOSE: Final = 0.1  # error of the speed [rad/s] below which the PID does nothing


class ThrusterOptions(Options):
    """Options of `Thruster`."""

    namespace: str = text()
    joint_name: str = text(None, required=True)
    topic: str = text()
    thrust_coefficient: float = number(1.0, minimum=-_MOST, maximum=_MOST)
    alpha_1: float = number(1.0, minimum=-_MOST, maximum=_MOST)
    alpha_2: float = number(0.0, minimum=-_MOST, maximum=_MOST)
    wake_fraction: float = number(0.2, minimum=-_MOST, maximum=_MOST)
    propeller_diameter: float = number(0.02, "m", minimum=1e-6, maximum=1e4)
    fluid_density: float = number(1000.0, "kg/m³", minimum=1e-9, maximum=_MOST)
    use_angvel_cmd: bool = boolean()
    velocity_control: bool = boolean()
    p_gain: float = number(0.1, "N·m·s/rad")
    i_gain: float = number(0.0, "N·m/rad")
    d_gain: float = number(0.0, "N·m·s²/rad")
    max_thrust_cmd: float = number(1000.0, "N or rad/s")
    min_thrust_cmd: float = number(-1000.0, "N or rad/s")
    deadband: float = number(0.0, "N", minimum=0)
    power_load: float = number(0.0, "W", minimum=0)
    battery_name: str = text()


class Thruster(BatteryConsumer):
    """Pushes a link along the axis of its propeller with a commanded thrust, and turns the propeller accordingly.

    The command is a `Float64`: a thrust [N], or with `<use_angvel_cmd>` a speed of the propeller [rad/s]; it stays
    within `<min_thrust_cmd>` and `<max_thrust_cmd>`. Its topic is `/model/<namespace>/joint/<joint>/cmd_thrust` or
    `…/cmd_vel` (the namespace is the model's name by default), or `<namespace>/<topic>`. The speed is published on
    `…/ang_vel`, or the thrust on `…/force`. Thrusts below `<deadband>` are zero; `…/enable_deadband` switches this off
    and on. A thruster of a model with an empty battery stops.
    """

    endpoints = (
        listens("/model/{model}/joint/{joint_name}/cmd_thrust", DOUBLE, named_by=("topic",)),
        listens("/model/{model}/joint/{joint_name}/cmd_vel", DOUBLE, named_by=("topic",)),
        listens("/model/{model}/joint/{joint_name}/enable_deadband", _BOOL),
        publishes("/model/{model}/joint/{joint_name}/ang_vel", DOUBLE),
        publishes("/model/{model}/joint/{joint_name}/force", DOUBLE),
    )
    options = OptionsOf(ThrusterOptions)
    filenames = ("gz-sim-thruster-system",)
    names = ("gz::sim::systems::Thruster",)
    drives = True
    reads_at_load = ("inertial", "axes")  # the effort follows from the inertia of the propeller

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        joint = find_named_joint(scene, "joint_name", params)
        if options.max_thrust_cmd < options.min_thrust_cmd:
            text = f"<max_thrust_cmd>{options.max_thrust_cmd:g}</max_thrust_cmd> is below <min_thrust_cmd>"
            params.error("SK-PARAM-002", f"{text}; expected at least {options.min_thrust_cmd:g}")
        if options.power_load and not options.battery_name:
            params.error("SK-PARAM-001", "<power_load> needs the name of a battery", "add <battery_name>")
        if joint is not None:
            self._joint_name, self._link = joint.scoped, joint.child_link
            self._inertia = propeller_inertia(scene, joint)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self.battery = options.battery_name
        self._joint = PropellerJoint(JointAxis(self.sim.joint(self._joint_name)), self._inertia, self.period)
        self._links = PushedLinks(self.sim, (self._link,))
        self._thrust = self._speed = 0.0
        self._coefficient = options.thrust_coefficient if params.has("thrust_coefficient") else options.alpha_1
        self._has_deadband = params.has("deadband")
        high, low = self._speed_of(options.max_thrust_cmd), self._speed_of(options.min_thrust_cmd)
        self._pid = Pid(options.p_gain, options.i_gain, options.d_gain, 1.0, -1.0, high, low)
        self._open_topics(parent, options)

    def _open_topics(self, parent: Model, options: ThrusterOptions) -> None:
        base = f"/model/{options.namespace or parent.name}/joint/{options.joint_name}"
        command = f"{base}/cmd_vel" if options.use_angvel_cmd else f"{base}/cmd_thrust"
        if options.topic:
            base = command = f"/{options.namespace}/{options.topic}"
        self.listen(valid_topic(command), DOUBLE, self._on_command)
        self.listen(valid_topic(f"{base}/enable_deadband"), _BOOL, self._on_deadband)
        self._state = self.advertise(valid_topic(f"{base}/{'force' if options.use_angvel_cmd else 'ang_vel'}"), DOUBLE)

    @property
    def power(self) -> float:
        """Power drawn from the battery [W]."""
        return float(self.options.power_load)

    def _on_command(self, message: Float64) -> None:
        options, value = self.options, float(message.data)
        if math.isnan(value):
            self._once.not_finite()
            return
        value = max(options.min_thrust_cmd, min(options.max_thrust_cmd, value))
        if options.use_angvel_cmd:
            self._speed = value
            self._thrust = self._coefficient * self._factor * value * abs(value)
        else:
            self._thrust, self._speed = value, self._speed_of(value)

    def _on_deadband(self, message: Bool) -> None:
        self._has_deadband = bool(message.data)

    @property
    def _factor(self) -> float:
        """Thrust [N] at 1 rad/s with a thrust coefficient of 1."""
        return float(self.options.fluid_density * self.options.propeller_diameter**4)

    def _speed_of(self, thrust: float) -> float:
        """Return the speed of the propeller [rad/s] at a thrust [N]."""
        scale = self._factor * self._coefficient
        if scale == 0.0:
            return 0.0
        return math.copysign(math.sqrt(abs(thrust / scale)), thrust * self._coefficient)

    def before_step(self) -> None:
        """Apply the thrust, and turn the propeller."""
        if self._is_empty():
            return
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, (self._link,))
        data = moving_data(self.sim)
        self._update_coefficient()
        self._speed = self._speed_of(self._thrust)
        thrust, speed = self._thrust, self._speed
        if self._has_deadband and abs(thrust) < self.options.deadband:
            thrust = speed = 0.0
        axis = data.xaxis[self.sim.mj_model.dof_jntid[self._joint.axis.dof]]
        torque, shown = 0.0, speed
        if self.options.velocity_control:
            self._joint.turn(speed)
        elif len(self._links):
            shown = float(matmul(data.cvel[self._links.ids[0], :3], axis))
            if abs(shown - speed) > _CLOSE:
                torque = self._pid.update(shown - speed, self.period)
        if len(self._links) and (thrust or torque):
            body = self._links.ids[0]
            force = axis * thrust
            moment = axis * torque + np.cross(data.xpos[body] - data.xipos[body], force)
            self._links.push(data, force[None], moment[None])
        if self._state.wanted:
            self._state.publish(msgs.make(DOUBLE, data=thrust if self.options.use_angvel_cmd else shown))

    def _update_coefficient(self) -> None:
        """Compute the thrust coefficient for the present speed of the vehicle, unless the file gives it."""
        options = self.options
        if options.params.has("thrust_coefficient") or abs(self._speed) <= sys.float_info.epsilon:
            return
        speed = norm(self._links.velocities(moving_data(self.sim))[0]) if len(self._links) else 0.0
        advance = (1 - options.wake_fraction) * speed / (self._speed * options.propeller_diameter)
        self._coefficient = options.alpha_1 + options.alpha_2 * advance

    def _is_empty(self) -> bool:
        return any(b.cell.soc <= 0 for b in self.sim.engine.names.shared(f"cells {id(self)}", self._cells))

    def _cells(self) -> list[Battery]:
        plugins = self.sim.engine.structure.all_plugins()
        return [p for p in plugins if isinstance(p, Battery) and p.scoped == self.scoped]
