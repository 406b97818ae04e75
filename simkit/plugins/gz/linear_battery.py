"""Battery of Gazebo: `gz::sim::systems::LinearBatteryPlugin`."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.battery import Battery, BatteryOptions, Cell
from simkit.plugins.endpoints import listens, offers, publishes
from simkit.plugins.find_entities import read_required_name
from simkit.plugins.gz.sensors import SensorsSystem
from simkit.plugins.options import OptionsOf, boolean, number, text, texts

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.pose import Vector
    from simkit.runtime import Joint, Model
    from simkit.scene import SceneModel

BOOL: Final = "std_msgs/msg/Bool"
SET_BOOL: Final = "std_srvs/srv/SetBool"
_RENDERED: Final = ("camera", "depth", "gpu_", "segmentation", "boundingbox", "thermal")
"""Substrings of the types of sensors that Gazebo's Sensors system renders; logical cameras are not rendered there."""
_LEAST_EFFORT: Final = 1e-9  # smallest effort that counts as a command [N·m or N]


class LinearBatteryOptions(BatteryOptions):
    """Options of `LinearBattery`."""

    voltage: float = number(minimum=0.0, required=True)
    initial_charge: float = number(instead="capacity")
    smooth_current_tau: float = number(1.0)
    start_draining: bool = boolean()
    enable_recharge: bool = boolean()
    invert_current_sign: bool = boolean()
    fix_issue_225: bool = boolean()
    recharge_by_topic: str = text()
    power_draining_topic: tuple[str, ...] = texts()
    stop_power_draining_topic: tuple[str, ...] = texts()


class LinearBattery(Battery):
    """Simulates a battery that a load drains and a charger fills; an empty battery disables the joints of its model.

    The battery starts to drain at the first of these events: the start of the simulation (with `<start_draining>`), a
    command to a joint of the model, or a message on a `<power_draining_topic>`. The battery's state is published on
    `/model/<model>/battery/<battery>/state` at 50 Hz.
    """

    endpoints = (
        publishes("/model/{model}/battery/{battery_name}/state", "sensor_msgs/msg/BatteryState"),
        listens("/model/{model}/battery/{battery_name}/recharge/start", BOOL),
        listens("/model/{model}/battery/{battery_name}/recharge/stop", BOOL),
        offers("/model/{model}/battery/{battery_name}/recharge/start", SET_BOOL),
        offers("/model/{model}/battery/{battery_name}/recharge/stop", SET_BOOL),
    )
    options = OptionsOf(LinearBatteryOptions)
    filenames = ("gz-sim-linearbatteryplugin-system", "gz-sim-linear-battery-plugin-system")
    names = ("gz::sim::systems::LinearBatteryPlugin",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.battery = read_required_name(params, "battery_name")
        self.cell = self._read_cell(params)
        self._joints = tuple(joint.scoped for joint in scene.all_joints() if joint.axes or joint.type == "ball")
        self.is_drained = self.options.start_draining
        recharges = self.options.enable_recharge
        hours = params.number("charging_time", 0.0, required=recharges, minimum=1e-9 if recharges else 0.0)
        self._charger = self.cell.capacity / hours if recharges and hours else None
        self.sign = -1.0 if self.options.invert_current_sign else 1.0
        self.percent = 100.0 if self.options.fix_issue_225 else 1.0
        if self.percent == 1.0 and builder.world.gazebo_quirks:
            self.cell.remember()

    def _read_cell(self, params: Params) -> Cell:
        options = self.options
        voltage, capacity, charge = options.voltage, options.capacity, options.initial_charge
        clamped = max(0.0, min(capacity, charge))
        if clamped != charge:
            fault = f"is not between 0 and {capacity:g}"
            self._warn(params, f"<initial_charge> {charge:g} {fault}; {clamped:g} is used", "initial_charge")
        tau = options.smooth_current_tau
        if tau <= 0.0:
            message = f"<smooth_current_tau> {tau:g} is not above 0; 1 is used, as in Gazebo"
            self._warn(params, message, "smooth_current_tau")
            tau = 1.0
        constant, linear = options.open_circuit_voltage_constant_coef, options.open_circuit_voltage_linear_coef
        if capacity and abs(constant + linear * (1.0 - clamped / capacity)) < 1e-3:
            hint = "set <open_circuit_voltage_constant_coef> to the voltage of the full battery"
            self._warn(params, "the open-circuit voltage is 0, so the battery supplies no power", hint=hint)
        return Cell(constant, linear, capacity or 1.0, options.resistance, tau, voltage, clamped)

    def _warn(self, params: Params, message: str, element: str = "", hint: str = "") -> None:
        where = params.block(element).where if element else self.where
        params.diagnostics.warning("SK-PLUGIN-123", f"plugin {self.name!r}: {message}", where, hint)

    def load(self, parent: Model, params: Params) -> None:
        if not params.has("power_load"):
            self._warn(params, "there is no <power_load> [W], so nothing drains the battery")
        self._power = self.declare("power_load", 0.0, description="power drawn while the battery drains [W]")
        self._is_dead = False
        self._held: dict[str, tuple[Vector, Vector, Vector]] = {}
        base = self.open_state(parent.name)
        if self._charger is not None and base:
            self._offer_recharge(base, by_topic=params.has("recharge_by_topic"))
        _ = self.options.recharge_by_topic
        self._supply(parent.scene)
        for topic in self.options.power_draining_topic:
            self.subscribe(valid_topic(topic), partial(self._set_drained, True), keep=1)
        for topic in self.options.stop_power_draining_topic:
            self.subscribe(valid_topic(topic), partial(self._set_drained, False), keep=1)

    def _supply(self, scene: SceneModel) -> None:
        """Stop the model's rendered sensors while the battery is empty, if the Sensors system enables this."""
        systems = (p for p in self.sim.engine.structure.all_plugins() if isinstance(p, SensorsSystem))
        if not any(system.stops_without_power for system in systems):
            return
        for sensor in scene.all_sensors():
            is_rendered = any(word in sensor.kind for word in _RENDERED) and "logical" not in sensor.kind
            if is_rendered and self.sim.contents.has_sensor(sensor.scoped):
                self.sim.sensor(sensor.scoped).sample_only_while(lambda: not self.is_empty)

    def _offer_recharge(self, base: str, *, by_topic: bool) -> None:
        # the name of the service decides; the data of the request is ignored, as in Gazebo
        for word, charger in (("start", self._charger), ("stop", None)):
            name, handler = valid_topic(f"{base}/recharge/{word}"), partial(self._set_charger, charger)
            self.offer(name, SET_BOOL, handler)
            if by_topic:
                self.listen(name, BOOL, handler)

    # ------------------------------------------------------------------ commands

    def _set_charger(self, charger: float | None, _: object) -> dict[str, object]:
        self.charger = charger
        return {"success": True}

    def _set_drained(self, is_drained: bool, _: object) -> None:
        self.is_drained = is_drained

    # ------------------------------------------------------------------ steps

    @property
    def is_empty(self) -> bool:
        """True if the battery has no charge left."""
        return self.cell.soc <= 0.0

    def demand(self) -> float:
        return float(self._power.value) + super().demand()

    def after_step(self) -> None:
        """Advance the battery by one step, and disable or enable the joints if the battery became empty or charged."""
        if not self.is_drained:
            self.is_drained = self._is_commanded()
        super().after_step()
        if self.is_empty != self._is_dead:
            self._is_dead = self.is_empty
            (self._disable_joints if self._is_dead else self._enable_joints)()

    def _is_commanded(self) -> bool:
        """Check whether a joint of the model received a control value or an effort other than zero in this step."""
        physics = self.sim.engine.physics
        if not (physics.data.ctrl.any() or physics.last_applied.any()):
            return False
        dofs, actuators = self.sim.engine.names.shared(f"battery {id(self)}", self._find_parts)
        pushed = np.abs(physics.last_applied[dofs]) > _LEAST_EFFORT
        return self.sim.engine.velocity_servos.is_commanded(actuators) or bool(pushed.any())

    def _find_parts(self) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """Return the degrees of freedom of the model's joints, and the actuators on them."""
        handles = [self.sim.joint(name) for name in self._joints]
        dofs = [dof for joint in handles for dof in joint.mj_dofs]
        actuators = [self._actuators_of(joint) for joint in handles]
        return np.array(dofs, dtype=int), np.concatenate([np.zeros(0, dtype=int), *actuators])

    def _actuators_of(self, joint: Joint) -> npt.NDArray[np.intp]:
        model = self.sim.mj_model
        ids = model.dof_jntid[list(joint.mj_dofs)]
        on_joint = model.actuator_trntype == mujoco.mjtTrn.mjTRN_JOINT
        return np.flatnonzero(on_joint & np.isin(model.actuator_trnid[:, 0], ids))

    def _disable_joints(self) -> None:
        """Remove all commands from the joints, as Gazebo's physics does for a model with an empty battery."""
        gains, biases = self.sim.engine.touch("actuator_gainprm"), self.sim.engine.touch("actuator_biasprm")
        for name in self._joints:
            joint = self.sim.joint(name)
            actuators = self._actuators_of(joint)
            efforts, velocities = joint.get_state()
            self._held[name] = (efforts, gains[actuators].copy(), biases[actuators].copy())
            joint.set_state((np.zeros_like(efforts), velocities))
            gains[actuators], biases[actuators] = 0.0, 0.0
        self.log.warning("%s: battery %r is empty", self.scoped, self.battery)

    def _enable_joints(self) -> None:
        """Restore the commands of the joints."""
        gains, biases = self.sim.engine.touch("actuator_gainprm"), self.sim.engine.touch("actuator_biasprm")
        for name, (efforts, gain, bias) in self._held.items():
            joint = self.sim.joint(name)
            actuators = self._actuators_of(joint)
            joint.set_state((efforts, joint.get_state()[1]))
            gains[actuators], biases[actuators] = gain, bias
        self._held = {}
