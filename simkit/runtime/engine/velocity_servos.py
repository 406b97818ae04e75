"""Integral action of velocity servos: a wheel keeps the commanded speed under a constant load.

MuJoCo's velocity servo is proportional, `effort = kv · (control − velocity)`, so that a load reduces the velocity by
load / kv. A larger kv does not help. MuJoCo solves contacts with the inertia of the wheel alone, and a wheel with a
much stiffer servo slips on the ground. Therefore the control is the command, plus the loads / kv that the file states,
plus a correction for all other loads. The stated loads are the damping of the joint at the commanded velocity, and its
friction. The correction is updated `RATE` times a second:

    correction += period / integral_time · (mean error − response_time · gain in velocity / period)

The mean error is that of the last period, command − travel / period. The second term is the error that the servo needed
to accelerate the robot. The rest is caused by a load: the load / kv that the correction does not yet compensate.

- The correction does not grow if the servo has its full effort in that direction at the start or end of the period
  (no windup).
- The recent change of the command is subtracted: a start without a load has no overshoot.
- A command of zero resets the correction. A robot that scrubs its wheels has other loads at rest, and wheels that push
  against each other would creep.
- The corrected effort is at most twice the weight of the robot at the rim of the wheel, because no tyre transmits more.
  The friction and the damping of the joint are added.

The period is a grid of simulated time, so that readers and the division of a run into steps make no difference.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.compiler.engine_options import SHORTEST_STEP
from simkit.compiler.servo_gains import ServoTraits, servo_traits
from simkit.runtime.engine.physics_step import CONTROL

if TYPE_CHECKING:
    import mujoco

    from simkit.compiler import ActuatorRef
    from simkit.runtime.engine.engine_state import EngineState
    from simkit.runtime.engine.number_changes import NumberChanges

RATE: Final = 50.0
"""Rate at which corrections are updated [Hz]."""

SHORTEST_INTEGRAL_TIME: Final = 0.04
"""Least integral time [s]."""

MIN_RESPONSE_TIMES: Final = 3.0
"""Least ratio of integral time to response time of a servo, so that a heavy robot does not oscillate."""

UNREST_DECAY: Final = 0.6
"""Fraction of a change of the command that still counts one period later."""

_MIN_ERROR: Final = 1e-6
"""Largest error that is not corrected [rad/s or m/s]."""

_SHARED_KEY: Final = "velocity servos"
_NEVER: Final = -(1 << 40)


@dataclass(slots=True)
class _ServoState:
    """State of one servo, in rad/s or m/s.

    Attributes:
        command: commanded velocity.
        correction: control minus command.
        position: position of the joint at the last update [rad or m].
        velocity: velocity of the joint at the last update.
        last_command: command at the last update.
        unrest: amount of recent changes of the command.
        tick: tick of the last update; far in the past before the first.
    """

    command: float = 0.0
    correction: float = 0.0
    position: float = 0.0
    velocity: float = 0.0
    last_command: float = 0.0
    unrest: float = 0.0
    tick: int = _NEVER

    def become(self, other: _ServoState) -> None:
        """Take over the state of another servo."""
        self.command, self.correction = other.command, other.correction
        self.position, self.velocity, self.last_command = other.position, other.velocity, other.last_command
        self.unrest, self.tick = other.unrest, other.tick


@dataclass(frozen=True, slots=True)
class _BoundServo:
    """Servo in the engine's model.

    Attributes:
        index: index of the actuator.
        widest: error at which the servo gives its full effort [rad/s or m/s].
        largest: largest correction [rad/s or m/s] at rest.
        damping: damping of the joint divided by kv, part of the control for each rad/s or m/s of the command.
        friction: friction of the joint divided by kv, part of the control of a joint that shall turn.
        share: factor of an uncompensated load that one update adds to the correction; above 1 only with damping.
        foresight: response time divided by the update period.
    """

    servo: _ServoState
    index: int
    widest: float
    largest: float
    damping: float
    friction: float
    share: float
    foresight: float

    def compensation(self) -> float:
        """Return the part of the control that compensates the loads of the joint."""
        servo = self.servo
        compensation = servo.correction + self.damping * servo.command
        return compensation + math.copysign(self.friction, servo.command) if servo.command else compensation

    def control(self) -> float:
        """Return the control: the command and the compensation of the loads."""
        return self.servo.command + self.compensation()


class VelocityServos:
    """Velocity servos that the plugins of a simulation requested; servos with a gain of their own stay proportional.

    Attributes:
        servos: states by name of the actuator.
        numbers: numbers of the model that a program changed.
    """

    def __init__(self, engine: EngineState) -> None:
        self._engine = engine
        self.numbers: NumberChanges | None = None
        self.servos: dict[str, _ServoState] = {}
        self._period = max(1.0 / RATE, engine.clock.timestep)
        # longest pause between two updates [ticks]; after a longer one the correction starts again
        self._longest = math.ceil(min(1.5 * self._period / max(engine.clock.timestep, SHORTEST_STEP), 1e15))
        self._model: mujoco.MjModel | None = None
        self._rows: dict[str, _BoundServo] = {}
        self._dofs = self._places = np.zeros(0, np.intp)

    def renew(self) -> None:
        """Derive the constants of the servos again, because numbers of the model have changed."""
        self._engine.names.forget_shared(_SHARED_KEY)
        self._model = None

    @property
    def are_there(self) -> bool:
        """True if the simulation has a servo to correct."""
        return bool(self._bound_servos())

    def command(self, ref: ActuatorRef, velocity: float) -> None:
        """Set the target velocity of a servo [rad/s or m/s]."""
        row = self._rows_by_name().get(ref.name)
        servo = row.servo if row is not None else self.servos.setdefault(ref.name, _ServoState())
        if velocity == 0.0 and servo.command != 0.0:
            servo.correction = 0.0
        servo.command = velocity
        control = row.control() if row is not None else velocity
        self._engine.mj_data.ctrl[self._engine.names.actuator(ref)] = control

    def is_commanded(self, actuators: Iterable[int]) -> bool:
        """Check whether one of these actuators of the engine has a nonzero command."""
        controls = self._engine.mj_data.ctrl
        commands = {row.index: row.servo.command for row in self._bound_servos()}
        return any(commands.get(int(i), controls[i]) != 0.0 for i in actuators)

    # ------------------------------------------------------------------ correction

    def correct(self, tick: int) -> None:
        """Update the corrections from the commands and velocities up to now."""
        rows, engine = self._bound_servos(), self._engine
        physics, is_changed = engine.physics, False
        data, timestep = physics.data, engine.clock.timestep
        if "actuator_gainprm" in engine.originals:
            self._release_slack(rows)
        positions, velocities = data.qpos.take(self._places).tolist(), data.qvel.take(self._dofs).tolist()
        for row, position, velocity in zip(rows, positions, velocities, strict=True):
            servo = row.servo
            load = 0.0
            ticks = tick - servo.tick
            if 0 < ticks <= self._longest:
                load = _uncompensated_load(row, (position - servo.position) / (ticks * timestep), velocity)
            servo.tick, servo.position, servo.velocity, servo.last_command = tick, position, velocity, servo.command
            if load:
                is_changed = True
                largest = row.largest + row.damping * abs(servo.command)
                servo.correction = max(-largest, min(largest, servo.correction + row.share * load))
                data.ctrl[row.index] = row.control()
        if is_changed:
            physics.changed(CONTROL)

    def _release_slack(self, rows: Iterable[_BoundServo]) -> None:
        """Clear the corrections of released servos, for example after an empty battery."""
        engine = self._engine
        gains = engine.mj_model.actuator_gainprm
        for row in rows:
            if row.servo.correction and gains[row.index, 0] == 0.0:
                row.servo.correction = 0.0
                engine.mj_data.ctrl[row.index] = row.control()

    def _bound_servos(self) -> Collection[_BoundServo]:
        """Return the servos with their indices in the engine's present model."""
        return self._rows_by_name().values()

    def _rows_by_name(self) -> dict[str, _BoundServo]:
        """Return the servos with their indices in the engine's present model, by the name of the actuator."""
        engine, model = self._engine, self._engine.physics.model
        if self._model is not model:
            self._model = model
            records = engine.structure.builder.records.values()
            refs = [r for record in records for r in record.actuators if r.kind == "velocity" and r.kv is None]
            self.servos = {ref.name: self.servos.get(ref.name) or _ServoState() for ref in refs}
            indices = [engine.names.actuator(ref) for ref in refs]
            # computed once from the compiled values, so that a restore gives the same traits
            given = self.numbers.compiled_values() if self.numbers is not None else engine.originals
            traits = engine.names.shared(_SHARED_KEY, lambda: servo_traits(model, refs, given))
            joints = model.actuator_trnid[indices, 0]
            self._dofs, self._places = (a[joints].astype(np.intp) for a in (model.jnt_dofadr, model.jnt_qposadr))
            rows = zip(refs, indices, traits, strict=True)
            self._rows = {
                ref.name: _bind_servo(self.servos[ref.name], index, trait, self._period) for ref, index, trait in rows
            }
        return self._rows

    # ------------------------------------------------------------------ state

    def get_state(self) -> dict[str, _ServoState]:
        """Return the state for a snapshot."""
        return {name: replace(servo) for name, servo in self.servos.items()}

    def set_state(self, state: Mapping[str, _ServoState]) -> None:
        """Restore a state from `get_state`; a servo that the state does not contain starts again."""
        if state.keys() == self.servos.keys():
            for name, servo in self.servos.items():
                servo.become(state[name])
        else:
            self.servos = {name: replace(servo) for name, servo in state.items()}
            self._model = None


def _uncompensated_load(row: _BoundServo, mean: float, velocity: float) -> float:
    """Return the load / kv that a servo did not compensate in the last period.

    Args:
        row: servo and its state at the last update.
        mean: mean velocity of the period [rad/s or m/s].
        velocity: present velocity [rad/s or m/s].
    """
    servo = row.servo
    command, before = servo.command, servo.velocity
    error = command - mean
    servo.unrest = abs(command - servo.last_command) + servo.unrest * UNREST_DECAY
    if abs(error) <= _MIN_ERROR or abs(mean) > abs(before) + abs(velocity) + abs(command):
        return 0.0
    load = error - (velocity - before) * row.foresight
    size = abs(load) - servo.unrest * max(1.0, row.foresight)
    if size <= 0.0:
        return 0.0
    sign = 1.0 if load > 0.0 else -1.0
    wider = max(sign * (command - velocity), sign * (servo.last_command - before)) + sign * row.compensation()
    return 0.0 if wider >= row.widest else sign * size


def _bind_servo(servo: _ServoState, index: int, traits: ServoTraits, period: float) -> _BoundServo:
    """Return the constants of a servo's correction, all in rad/s or m/s."""
    gain = max(traits.gain, 1e-300)
    share = min(1.0, period / max(SHORTEST_INTEGRAL_TIME, MIN_RESPONSE_TIMES * traits.response_time))
    share *= 1.0 + traits.damping / gain  # damping weakens the effect of the correction on the velocity
    foresight = traits.response_time / period
    loads = traits.max_effort, traits.largest_load, traits.damping, traits.friction
    widest, largest, damping, friction = (load / gain for load in loads)
    return _BoundServo(servo, index, widest, largest, damping, friction, share, foresight)
