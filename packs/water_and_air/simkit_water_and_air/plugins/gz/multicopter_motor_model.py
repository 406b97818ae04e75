"""Rotor of a multicopter: `gz::sim::systems::MulticopterMotorModel`.

A rotor that turns at ω [rad/s] and moves through the air at v, of which v⊥ is the part across its axis, causes:

    thrust along the z axis of its link      T = k · ω²  (against this axis for a rotor that turns backwards)
    drag of the air on the rotor             F = -|ω| · rotorDragCoefficient · v⊥
    torque on the link that carries it       -direction · momentConstant · T  about the rotor's z axis
    rolling moment on the same link          M = -|ω| · rollingMomentCoefficient · v⊥

These are the forces of RotorS (Furrer, Burri, Achtelik and Siegwart, "RotorS - A Modular Gazebo MAV Simulator
Framework", 2016). The joint turns more slowly than the rotor by the factor `rotorVelocitySlowdownSim`, so that a step
of the physics resolves its motion.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, ClassVar, Final

from simkit import ModelPlugin, Params
from simkit.extend import (
    JointAxis,
    Options,
    OptionsOf,
    choice,
    counted,
    find_named_joint,
    find_named_link,
    integer,
    listens,
    number,
    text,
    without_effect,
)
from simkit.msgs import valid_topic
from simkit.plugins.joints.joint_commands import ACTUATORS
from simkit.plugins.one_time_warnings import are_usable
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit_water_and_air.plugins.fluids.propeller_joint import PropellerJoint, propeller_inertia

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Actuators

_MOST: Final = 1e9
_DIRECTIONS: Final = {"ccw": 1, "cw": -1}


class MotorModelOptions(Options):
    """Options of `MulticopterMotorModel`."""

    namespace: str = text(element="robotNamespace")
    speed_topic: bool = without_effect(element="motorSpeedPubTopic")
    joint: str = text(None, element="jointName", required=True)
    link: str = text(None, element="linkName", required=True)
    motor_number: int = integer(0, element="motorNumber", minimum=0)
    actuator_number: int = integer(0, minimum=0)
    direction: str = choice(tuple(_DIRECTIONS), element="turningDirection", required=True)
    motor_type: str = choice(("velocity", "position", "force"), "velocity", element="motorType")
    topic: str = text("command/motor_speed", element="commandSubTopic")
    most_speed: float = number(838.0, "rad/s", element="maxRotVelocity", minimum=0, maximum=_MOST)
    thrust_factor: float = number(8.54858e-06, "N·s²/rad²", element="motorConstant", minimum=0, maximum=_MOST)
    torque_factor: float = number(0.016, "m", element="momentConstant", minimum=0, maximum=_MOST)
    drag_factor: float = number(1e-4, "N·s²/(rad·m)", element="rotorDragCoefficient", minimum=0, maximum=_MOST)
    rolling_factor: float = number(1e-6, "N·s²/rad", element="rollingMomentCoefficient", minimum=0, maximum=_MOST)
    time_up: float = number(1 / 80, "s", element="timeConstantUp", minimum=0)
    time_down: float = number(1 / 40, "s", element="timeConstantDown", minimum=0)
    slowdown: float = number(10.0, element="rotorVelocitySlowdownSim", minimum=1e-6, maximum=_MOST)


class MulticopterMotorModel(ModelPlugin):
    """Turns one rotor of a multicopter at a commanded speed and applies its thrust, drag and torques.

    The commanded speed [rad/s] is number `<motorNumber>` of an `Actuators` message on `<commandSubTopic>` below
    `<robotNamespace>` (default: the model's name), or comes from `MulticopterVelocityControl` in the same model, which
    has priority. The rotor follows it with the time constants `<timeConstantUp>` and `<timeConstantDown>`, up to
    `<maxRotVelocity>`.
    """

    endpoints: ClassVar[tuple[Any, ...]] = (
        listens("/{model}/command/motor_speed", ACTUATORS, named_by=("commandSubTopic",)),
    )
    options = OptionsOf(MotorModelOptions)
    filenames = ("gz-sim-multicopter-motor-model-system",)
    names: ClassVar[tuple[str, ...]] = ("gz::sim::systems::MulticopterMotorModel",)
    drives = True
    driven_types: ClassVar[tuple[str, ...]] = ("velocity",)
    reads_at_load = ("inertial", "axes")  # the effort follows from the inertia of the propeller

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._link = find_named_link(scene, "linkName", params)
        joint = find_named_joint(scene, "jointName", params)
        if params.has("actuator_number"):
            self._number = options.actuator_number
        else:
            self._number = params.integer("motorNumber", required=True, minimum=0)
        self._is_driven = options.motor_type in self.driven_types
        if not self._is_driven:
            kind = f"<motorType>{options.motor_type}</motorType> has no effect, as in Gazebo"
            params.warning("SK-PLUGIN-111", f"{kind}: the rotor stands still", "use `velocity`")
        if joint is None:
            return
        self._joint_name, self._parent = joint.scoped, joint.parent_link
        self._inertia = propeller_inertia(scene, joint)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self._joint = PropellerJoint(JointAxis(self.sim.joint(self._joint_name)), self._inertia, self.period)
        self._links = PushedLinks(self.sim, (self._link, self._parent))
        self._sign = _DIRECTIONS[options.direction]
        self._input = 0.0  # commanded speed of the rotor [rad/s]
        self._filtered = 0.0  # the same after the filter
        self._has_state = False
        self.share = 1.0  # of the speed that a damaged rotor reaches
        namespace = options.namespace or parent.name
        self.listen(valid_topic(f"/{namespace}/{options.topic}"), ACTUATORS, self._on_command)

    def _on_command(self, message: Actuators) -> None:
        speeds = message.velocity
        if self._number >= len(speeds):
            what = f"a message has {counted(len(speeds), 'velocity', 'velocities')} and none for motor {self._number}"
            self._once.left_out("short", f"{what}; the message is ignored")
        elif not are_usable(speeds[self._number]):
            self._once.left_out("finite", f"the command {speeds[self._number]} is ignored; expected a finite number")
        else:
            self.command(float(speeds[self._number]))

    @property
    def motor_number(self) -> int:
        """Index of the motor in a message."""
        return self._number

    @property
    def joint_name(self) -> str:
        """Scoped name of the joint of the rotor."""
        return self._joint_name

    def command(self, speed: float) -> None:
        """Set the speed of the rotor [rad/s] from the next step on; a negative speed turns it backwards."""
        self._input = min(speed, self.options.most_speed)

    def before_step(self) -> None:
        """Apply the forces of the rotor, and turn it towards the commanded speed."""
        if not self._has_state:  # in Gazebo, the joint has no velocity in the first step
            self._has_state = True
            return
        if not self._is_driven:
            return
        options = self.options
        turning = self._joint.axis.velocity
        if abs(turning) * self.period > math.pi:
            message = f"the joint turns more than half a turn in a step: {turning:.4g} rad/s"
            hint = "use a smaller <max_step_size> or a larger <rotorVelocitySlowdownSim>"
            self._once.warn("SK-PLUGIN-115", "aliasing", message, hint)
        self._apply_forces(turning * options.slowdown)
        slow = options.time_up if self._input > self._filtered else options.time_down
        left = math.exp(-self.period / slow) if slow > 0 else 0.0
        self._filtered = left * self._filtered + (1 - left) * self._input
        self._joint.turn(self._sign * self.share * self._filtered / options.slowdown)

    def inflow_factor(self, speed: float) -> float:
        """Return the share of the thrust that is left while the rotor moves along its axis [m/s]."""
        return 1.0

    def _apply_forces(self, speed: float) -> None:
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, (self._link, self._parent))
        links, options = self._links, self.options
        if speed == 0.0 or not links.names or links.names[0] != self._link:
            return
        data = moving_data(self.sim)
        body = links.ids[0]
        _, _, xz, _, _, yz, _, _, zz = data.xmat[body].tolist()
        (vx, vy, vz), *_ = links.velocities_few(data, data.xpos[links.bodies].tolist())
        ax, ay, az = self.sim.engine.wind.at(self.sim.tick)
        vx, vy, vz = vx - ax, vy - ay, vz - az
        jx, jy, jz = data.xaxis[self.sim.mj_model.dof_jntid[self._joint.axis.dof]].tolist()
        along = vx * jx + vy * jy + vz * jz
        vx, vy, vz = vx - along * jx, vy - along * jy, vz - along * jz
        force = self._sign * speed * abs(speed) * options.thrust_factor
        thrust = force * self.inflow_factor(along)
        drag = -abs(speed) * options.drag_factor
        wrenches = {0: (xz * thrust + drag * vx, yz * thrust + drag * vy, zz * thrust + drag * vz, 0.0, 0.0, 0.0)}
        if len(links.names) > 1:
            twist, roll = -self._sign * force * options.torque_factor, -abs(speed) * options.rolling_factor
            wrenches[1] = (0.0, 0.0, 0.0, xz * twist + roll * vx, yz * twist + roll * vy, zz * twist + roll * vz)
        links.push_some(data, wrenches)
