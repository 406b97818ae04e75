"""Hardware that controllers command: joints with their interfaces, limits and servos."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit.compiler.couplings import Couplings
from simkit.extend import SharedByCopies, Vector
from simkit_control.plugins.ros2_control.actuator_modes import (
    EFFORT_MODE,
    FREE,
    POSITION_MODE,
    SPRING_MODE,
    VELOCITY_MODE,
)
from simkit_control.plugins.ros2_control.hardware_interfaces import (
    EFFORT,
    KD,
    KP,
    POSITION,
    VELOCITY,
    Indices,
    InterfaceTable,
    Reading,
)
from simkit_control.plugins.ros2_control.hardware_joint import HardwareJoint, PidGains
from simkit_control.plugins.ros2_control.hardware_sensors import HardwareSensor, find_sensor
from simkit_control.plugins.ros2_control.joint_actuators import JointActuators
from simkit_control.plugins.ros2_control.transmissions import TransmissionLaw, transmission_laws

if TYPE_CHECKING:
    import mujoco

    from simkit import Simulation
    from simkit.compiler import ActuatorRef
    from simkit.extend import Diagnostics, SceneJoint, SceneModel, SpecBuilder
    from simkit.scene.actuation import Transmission
    from simkit_control.plugins.ros2_control.hardware_description import ComponentDescription, JointDescription

_MODES = {POSITION: POSITION_MODE, VELOCITY: VELOCITY_MODE, EFFORT: EFFORT_MODE}
_COMMAND_MODES = {**_MODES, KP: SPRING_MODE, KD: SPRING_MODE}


@dataclass(slots=True)
class Hardware(SharedByCopies):
    """Joints and sensors of one robot.

    Attributes:
        joints: joints by plain name, in the order of the description.
        states: state interfaces, read from the simulation before the controllers are updated; interfaces that no active
            controller reads keep their values.
        commands: command interfaces, written to the simulation after the controllers were updated.
        components: description of the hardware.
        actuated: joints with command interfaces, and their actuators.
        sensors: sensors by name.
        actuators: transmission of each actuator, by the actuator's name; actuators have state interfaces too.
        owners: name of the claiming controller, by the name of the command interface.
        springs: kp and kd by joint, by the name of a controller that simulates springs at its joints.
        holds_position: true if an unclaimed joint holds its position, whatever interfaces it has.
        forgets_commands: true if released gains and their commands become 0; else they act until the next commands.
        is_limp: true if an unclaimed joint moves freely, whatever interfaces it has.
        rivals: actuators of other plugins that drive a joint too, by the joint's name, each with True if this hardware
            moves the joint and False if the other plugin moves it.
    """

    joints: dict[str, HardwareJoint] = field(default_factory=dict)
    states: InterfaceTable = field(default_factory=InterfaceTable)
    commands: InterfaceTable = field(default_factory=InterfaceTable)
    components: list[ComponentDescription] = field(default_factory=list)
    actuated: JointActuators = field(default_factory=JointActuators)
    sensors: dict[str, HardwareSensor] = field(default_factory=dict)
    actuators: dict[str, TransmissionLaw] = field(default_factory=dict)
    owners: dict[str, str] = field(default_factory=dict)
    springs: dict[str, dict[str, tuple[float, float]]] = field(default_factory=dict)
    holds_position: bool = True
    forgets_commands: bool = False
    is_limp: bool = False
    rivals: dict[str, list[tuple[ActuatorRef, bool]]] = field(default_factory=dict)
    _sim: Simulation = field(init=False, repr=False)
    _sources: Indices = field(default_factory=lambda: np.zeros(0, np.intp))
    # indices of joints without a claimed interface
    _unclaimed: Indices = field(default_factory=lambda: np.zeros(0, np.intp))
    # indices of joints whose gains are commands, and the indices of their five commands
    _sprung: Indices = field(default_factory=lambda: np.zeros(0, np.intp))
    _spring_rows: Indices = field(default_factory=lambda: np.zeros((0, 5), np.intp))
    _read_interfaces: frozenset[str] = frozenset()  # state interfaces of the active controllers
    _model: mujoco.MjModel | None = None
    _plan: list[Reading | tuple[int, Callable[[], float]]] = field(default_factory=list)  # read at every update
    _deferred: list[Reading] = field(default_factory=list)  # read at the first access after an update

    @classmethod
    def of(
        cls,
        components: list[ComponentDescription],
        scene: SceneModel,
        diagnostics: Diagnostics,
        transmissions: Iterable[Transmission] = (),
    ) -> Hardware:
        """Create the hardware from its description, before a simulation exists."""
        scenes = {scene_joint.name: scene_joint for scene_joint in scene.all_joints()}
        hardware = cls(components=components)
        states: list[str] = []
        commands: list[str] = []
        for joint in (joint for component in components for joint in component.joints):
            hardware.joints[joint.name] = _hardware_joint(joint, scenes[joint.name])
            states += [f"{joint.name}/{interface}" for interface in joint.states]
            commands += [f"{joint.name}/{interface}" for interface in joint.commands]
        for sensor in (sensor for component in components for sensor in component.sensors):
            states += [f"{sensor.name}/{name}" for name in sensor.interfaces]
            hardware_sensor = find_sensor(sensor, scene, diagnostics)
            if hardware_sensor is not None:
                hardware.sensors[sensor.name] = hardware_sensor
        for law in transmission_laws(transmissions, list(hardware.joints), diagnostics):
            hardware.actuators |= dict.fromkeys((a for a in law.actuators if a not in hardware.joints), law)
        states += [f"{actuator}/{interface}" for actuator in hardware.actuators for interface in _MODES]
        hardware.states, hardware.commands = InterfaceTable(states), InterfaceTable(commands)
        return hardware

    # ------------------------------------------------------------------ preparation

    def prepare(self, builder: SpecBuilder, owner: str, pids: Mapping[str, Mapping[str, PidGains]]) -> None:
        """Add an actuator to every joint that has a command interface.

        Args:
            builder: builder of the MuJoCo specification.
            owner: name of the plugin that owns the actuators.
            pids: PID gains that replace a servo, by joint and interface.
        """
        self._couple_mimics(builder)
        driven = [j for j in self.joints.values() if j.command_interfaces]
        self.actuated = JointActuators.prepare(builder, owner, driven, pids)
        self._sources = np.full(len(driven), -1, np.intp)

    def lift_zero_efforts(self, interfaces: frozenset[str], builder: SpecBuilder, owner: str) -> None:
        """Remove the effort limit 0 of joints whose position or velocity Gazebo sets without an effort.

        Args:
            interfaces: command interfaces that Gazebo applies without an effort.
            builder: builder of the MuJoCo specification; it receives a warning for each joint.
            owner: name of the plugin, for messages.
        """
        for name, joint in self.joints.items():
            if joint.max_effort == 0.0 and (direct := [i for i in joint.command_interfaces if i in interfaces]):
                message = (
                    f"{owner} drives joint {joint.scoped}, whose effort limit is 0: the effort is unlimited, "
                    f"because Gazebo Classic sets the {direct[0]} of the joint"
                )
                where = builder.names.joint(joint.scoped).scene.where
                builder.diagnostics.warning("SK-JOINT-011", message, where, "give <limit> a positive effort")
                self.joints[name] = replace(joint, max_effort=math.inf)

    def _couple_mimics(self, builder: SpecBuilder) -> None:
        """Couple mimic joints in the engine if their mimic relation is only in the hardware description."""
        for joint in self.joints.values():
            leader = self.joints.get(joint.leader)
            binding = builder.names.joint(joint.scoped)
            if leader is not None and binding.scene.axes[0].mimic is None:
                record, step = builder.records[binding.model], builder.world.physics.max_step_size
                coupling = Couplings(builder.spec, record, step, builder.diagnostics)
                coupling.tie(joint.scoped, leader.scoped, joint.multiplier, joint.offset)

    def load(self, sim: Simulation) -> None:
        """Bind the hardware to a simulation, and move joints to their initial positions."""
        self._sim = sim
        self.joints = {n: replace(j, joint=sim.joint(j.scoped)) for n, j in self.joints.items()}
        for joint in self.joints.values():
            if math.isfinite(joint.initial):
                joint.handle.set_position(joint.initial)
        self.actuated.load(sim)
        self._switch_modes()

    # ------------------------------------------------------------------ claims

    def claim(self, names: Sequence[str], owner: str) -> None:
        """Claim command interfaces for a controller; they drive the joints from now on."""
        for name in names:
            self.owners[name] = owner
            if not self.joints[name.rpartition("/")[0]].has_gain_commands:
                self.commands.values[self.commands.index(name)] = np.nan
        self._switch_modes()

    def release(self, owner: str) -> None:
        """Release the interfaces of a controller; its joints then hold their position or move freely."""
        released = [name for name, claimant in self.owners.items() if claimant == owner]
        self.owners = {name: claimant for name, claimant in self.owners.items() if claimant != owner}
        if self.forgets_commands:
            self.commands.values[[self.commands.index(name) for name in released]] = np.nan
        self._switch_modes()

    def _switch_modes(self) -> None:
        claimed: dict[str, str] = {}
        for owner, _, interface in (name.rpartition("/") for name in self.owners):
            if claimed.get(owner) != POSITION:  # a joint with both is driven by position
                claimed[owner] = interface
        modes = []
        springy = self._set_springs()
        for k, joint in enumerate(self.actuated.joints):
            chosen = claimed.get(joint.name, "")
            self._sources[k] = self.commands.index(f"{joint.name}/{chosen}") if chosen else -1
            mode = _COMMAND_MODES[chosen] if chosen else self._idle_mode(joint, claimed.get(joint.leader, ""))
            if joint.has_gain_commands or (mode == EFFORT_MODE and joint.name in springy):
                mode = SPRING_MODE
            modes.append(self._settle_rivals(joint, mode, is_claimed=bool(chosen)))
        self._unclaimed = np.flatnonzero(self._sources < 0)
        self._group_joints()
        self.actuated.switch(np.array(modes, np.intp))

    def _set_springs(self) -> dict[str, tuple[float, float]]:
        """Set and return the springs of the active controllers by joint; 0 if the controller computes the effort."""
        springy = {
            joint: self.springs[owner].get(joint, (0.0, 0.0))
            for joint, owner in ((name.rpartition("/")[0], owner) for name, owner in self.owners.items())
            if owner in self.springs
        }
        self.actuated.set_springs(springy)
        self._find_sprung_joints(springy)
        return springy

    def _find_sprung_joints(self, springy: Iterable[str]) -> None:
        """Store the joints whose gains are commands, without those to which a controller has given a spring."""
        joints = self.actuated.joints
        sprung = [k for k, joint in enumerate(joints) if joint.has_gain_commands and joint.name not in springy]
        rows = {name: row for row, name in enumerate(self.commands.names)}
        names = (POSITION, VELOCITY, EFFORT, KP, KD)
        self._sprung = np.array(sprung, np.intp)
        self._spring_rows = np.array(
            [[rows.get(f"{joints[k].name}/{name}", -1) for name in names] for k in sprung], np.intp
        ).reshape(-1, 5)

    def _group_joints(self) -> None:
        """Number the joints by their controller, because the wheels of one controller wait for one another."""
        by_joint = {name.rpartition("/")[0]: owner for name, owner in self.owners.items()}
        numbers = {owner: k for k, owner in enumerate(dict.fromkeys(by_joint.values()), 1)}
        claimed = [numbers.get(by_joint.get(joint.name, ""), 0) for joint in self.actuated.joints]
        self.actuated.groups = np.array(claimed, np.intp)

    def _settle_rivals(self, joint: HardwareJoint, mode: int, *, is_claimed: bool) -> int:
        """Return the mode of a joint beside the actuators of other plugins, and switch these actuators on or off.

        A servo of the plugin that has no effect in Gazebo is switched off: it would hold the joint against the other.
        """
        for ref, prevails in self.rivals.get(joint.name, ()):
            if not prevails and (mode == VELOCITY_MODE or (mode == POSITION_MODE and not is_claimed)):
                mode = FREE
            engine = self._sim.engine
            index = engine.names.actuator(ref)
            limited, ranges = engine.touch("actuator_forcelimited"), engine.touch("actuator_forcerange")
            is_off = prevails and mode != FREE
            limited[index] = True if is_off else engine.original("actuator_forcelimited")[index]
            ranges[index] = 0.0 if is_off else engine.original("actuator_forcerange")[index]
        return mode

    def _idle_mode(self, joint: HardwareJoint, leader_interface: str) -> int:
        """Return the mode of an unclaimed joint; a mimic joint has the mode of its leader's claimed interface."""
        if leader_interface:
            return _COMMAND_MODES[leader_interface] if leader_interface in joint.command_interfaces else FREE
        if self.is_limp:
            return FREE
        return POSITION_MODE if self.holds_position or POSITION in joint.command_interfaces else FREE

    # ------------------------------------------------------------------ run time

    def set_read_interfaces(self, names: Iterable[str]) -> None:
        """Set the state interfaces to update from now on; all other interfaces keep their values."""
        self._read_interfaces = frozenset(names)
        self._model = None

    def read(self) -> None:
        """Update the state interfaces from the simulation."""
        if self._model is not self._sim.engine.physics.model:
            self._bind()
        states = self.states
        values = states.values
        for rows, reading in self._plan:
            values[rows] = reading()
        if self._deferred or states.deferred:
            states.deferred = self._deferred.copy()

    def _bind(self) -> None:
        """Prepare the readings for the current engine model, because each model has different addresses."""
        self._model, self._plan, self._deferred = self._sim.mj_model, [], []
        by_kind: dict[str, list[tuple[int, str]]] = {}
        for name in (n for n in self.states.names if n in self._read_interfaces):
            owner, _, interface = name.rpartition("/")
            if owner in self.joints:
                by_kind.setdefault(interface, []).append((self.states.index(name), owner))
            elif owner in self.actuators:
                reading = _actuator_reading(self, owner, interface)
                self._plan.append((self.states.index(name), reading))
            elif owner in self.sensors:
                by_kind.setdefault(f"sensor {owner}", []).append((self.states.index(name), interface))
        for kind, rows_and_names in by_kind.items():
            rows, names = (
                np.array([row for row, _ in rows_and_names], np.intp),
                tuple(name for _, name in rows_and_names),
            )
            if kind.startswith("sensor "):
                sensor = self.sensors[kind.removeprefix("sensor ")]
                self._deferred.append((rows, partial(sensor.read, self._sim, names)))
            elif kind in _MODES:
                # computing efforts takes time, so they are computed only on access
                plan = self._deferred if kind == EFFORT else self._plan
                plan.append((rows, self.reading(kind, names)))
        self.states.deferred_indices = frozenset(row for rows, _ in self._deferred for row in rows.tolist())

    def reading(self, interface: str, joints: Sequence[str]) -> Callable[[], Vector]:
        """Return a function that reads positions, velocities or efforts of joints from the current engine model."""
        names, physics = self._sim.engine.names, self._sim.engine.physics
        bindings = [names.joint(self.joints[joint].scoped) for joint in joints]
        if interface == POSITION:
            qpos = np.array([binding.qpos[0] for binding in bindings], np.intp)
            return lambda: physics.data.qpos.take(qpos)
        if interface == VELOCITY:
            dofs = np.array([binding.dofs[0] for binding in bindings], np.intp)
            return lambda: physics.data.qvel.take(dofs)
        driven = {joint.name: k for k, joint in enumerate(self.actuated.joints)}
        indices = np.array([driven.get(joint, -1) for joint in joints], np.intp)
        if (indices >= 0).all():
            return lambda: self.actuated.efforts()[indices]
        # the index -1 of a joint without actuator selects the appended 0
        return lambda: np.append(self.actuated.efforts(), 0.0)[indices]

    def write(self, period: float) -> None:
        """Write the commands to the actuators.

        Args:
            period: time since the last call [s].
        """
        if len(self._sources):
            commands = self.commands.values.take(self._sources)
            if len(self._unclaimed):
                commands[self._unclaimed] = np.nan
            if len(self._sprung):
                commands[self._sprung] = self._spring_efforts()
            self.actuated.write(commands, period)

    def _spring_efforts(self) -> Vector:
        """Set the commanded gains, and return the efforts of their joints at position and velocity 0 [N·m or N].

        A position without a command is the initial position, and any other command is then 0.
        """
        rows = self._spring_rows
        given = np.where(rows < 0, np.nan, self.commands.values[rows])
        given = np.where(np.isfinite(given), given, 0.0)
        starts = [self.actuated.joints[k].initial for k in self._sprung.tolist()]
        has_none = ~np.isfinite(np.where(rows[:, 0] < 0, np.nan, self.commands.values[rows[:, 0]]))
        given[:, 0] = np.where(has_none & np.isfinite(starts), starts, given[:, 0])
        position, velocity, effort, kp, kd = given.T
        self.actuated.set_gains(self._sprung, kp, kd)
        kp, kd = self.actuated.spring_gains([self.actuated.joints[k].name for k in self._sprung.tolist()])
        efforts: Vector = effort + kp * position + kd * velocity
        return efforts

    # ------------------------------------------------------------------ state

    def get_state(self) -> object:
        """Return a copy of everything that changes at run time."""
        values = self.states.values.copy(), self.commands.values.copy()
        values_and_owners = (*values, dict(self.owners), self._sources.copy(), self._read_interfaces)
        actuated = self.actuated
        shares = None if actuated.gravity_shares is None else actuated.gravity_shares.copy()
        return values_and_owners, (actuated.modes.copy(), actuated.targets.copy(), actuated.integrals.copy()), shares

    def set_state(self, state: Any) -> None:
        """Restore a state from `get_state`."""
        (states, commands, owners, sources, self._read_interfaces), drives, shares = state
        self.states.values, self.commands.values = states.copy(), commands.copy()
        self.owners, self._sources = dict(owners), sources.copy()
        self._unclaimed = np.flatnonzero(sources < 0)
        self._model = None
        self.actuated.modes, self.actuated.targets, self.actuated.integrals = (values.copy() for values in drives)
        self.actuated.gravity_shares = None if shares is None else shares.copy()
        self._group_joints()
        self._set_springs()
        if len(self._sprung):
            self._spring_efforts()


def _hardware_joint(described: JointDescription, joint: SceneJoint) -> HardwareJoint:
    axis = joint.axes[0]
    is_unlimited = math.isinf(axis.lower) and math.isinf(axis.upper)
    return HardwareJoint(
        described.name,
        None,
        tuple(dict.fromkeys(described.commands)),
        lower=axis.lower,
        upper=axis.upper,
        max_velocity=axis.velocity,  # Gazebo ignores <param name="max"> of an interface
        max_effort=axis.effort,
        scoped=joint.scoped,
        is_continuous=joint.type in ("revolute", "continuous") and is_unlimited,
        initial=described.initial,
        leader=described.leader or (axis.mimic.joint.rpartition("::")[2] if axis.mimic else ""),
        multiplier=axis.mimic.multiplier if axis.mimic else described.multiplier,
        offset=axis.mimic.offset if axis.mimic else described.offset,
    )


def _actuator_reading(hardware: Hardware, actuator: str, interface: str) -> Callable[[], float]:
    law = hardware.actuators[actuator]
    joints, row = hardware.reading(interface, law.joints), law.actuators.index(actuator)
    return lambda: float(law.actuate(interface, joints())[row])
