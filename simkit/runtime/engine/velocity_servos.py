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

`VelocityServos` computes with the numbers of each servo, and `VelocityServoRows` with arrays of the servos of many
simulations, by the same functions.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from simkit.compiler.engine_options import SHORTEST_STEP
from simkit.compiler.servo_gains import ServoTraits, servo_traits
from simkit.elementary_functions import ARRAYS, FLOATS, Arithmetic
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

Number = Any
"""A float, or an array with a float for each of several servos."""

Floats = npt.NDArray[np.float64]
Ids = npt.NDArray[np.intp]


@dataclass(slots=True)
class _ServoState:
    """State of one servo, in rad/s or m/s; each number may be an array.

    Attributes:
        command: commanded velocity.
        correction: control minus command.
        position: position of the joint at the last update [rad or m].
        velocity: velocity of the joint at the last update.
        last_command: command at the last update.
        unrest: amount of recent changes of the command.
        tick: tick of the last update; far in the past before the first.
    """

    command: Number = 0.0
    correction: Number = 0.0
    position: Number = 0.0
    velocity: Number = 0.0
    last_command: Number = 0.0
    unrest: Number = 0.0
    tick: Number = _NEVER

    def follow(self, velocity: Number, of: Arithmetic[Number]) -> None:
        """Set the commanded velocity; a stop resets the correction."""
        is_stop = (velocity == 0.0) & (self.command != 0.0)
        self.correction = of.where(is_stop, 0.0, self.correction)
        self.command = velocity

    def become(self, other: _ServoState) -> None:
        """Take over the state of another servo."""
        self.command, self.correction = other.command, other.correction
        self.position, self.velocity, self.last_command = other.position, other.velocity, other.last_command
        self.unrest, self.tick = other.unrest, other.tick


@dataclass(frozen=True, slots=True)
class _BoundServo:
    """Servo in the engine's model; each number may be an array.

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
    widest: Number
    largest: Number
    damping: Number
    friction: Number
    share: Number
    foresight: Number

    def compensation(self, of: Arithmetic[Number]) -> Number:
        """Return the part of the control that compensates the loads of the joint."""
        command = self.servo.command
        friction = (command != 0.0) * of.copysign(self.friction, command)
        return self.servo.correction + self.damping * command + friction

    def control(self, of: Arithmetic[Number]) -> Number:
        """Return the control: the command and the compensation of the loads."""
        return self.servo.command + self.compensation(of)

    def correct(
        self, ticks: Number, timing: _Timing, position: Number, velocity: Number, of: Arithmetic[Number]
    ) -> Number:
        """Update the correction at the end of a period.

        Args:
            ticks: steps since the last update.
            timing: lengths of a step and of the longest period.
            position: present position of the joint [rad or m].
            velocity: present velocity [rad/s or m/s].
            of: functions for these numbers.

        Returns:
            True where the correction may have changed.
        """
        servo = self.servo
        command, before, last_command = servo.command, servo.velocity, servo.last_command
        is_known = (ticks > 0) & (ticks <= timing.longest)
        mean = (position - servo.position) / (of.maximum(ticks, 1) * timing.step)
        servo.position, servo.velocity, servo.last_command = position, velocity, command
        unrest = abs(command - last_command) + servo.unrest * UNREST_DECAY
        servo.unrest = of.where(is_known, unrest, servo.unrest)
        # the load / kv that the servo did not compensate in this period
        error = command - mean
        load = error - (velocity - before) * self.foresight
        size = abs(load) - unrest * of.maximum(1.0, self.foresight)
        sign = of.copysign(1.0, load)
        gap = of.maximum(sign * (command - velocity), sign * (last_command - before)) + sign * self.compensation(of)
        is_large = (abs(error) > _MIN_ERROR) & (abs(mean) <= abs(before) + abs(velocity) + abs(command))
        is_changed = is_known & is_large & (size > 0.0) & (gap < self.widest)
        largest = self.largest + self.damping * abs(command)
        correction = of.maximum(-largest, of.minimum(largest, servo.correction + self.share * (sign * size)))
        servo.correction = of.where(is_changed, correction, servo.correction)
        return is_changed


@dataclass(frozen=True, slots=True)
class _Timing:
    """Lengths of periods.

    Attributes:
        step: length of a step [s].
        longest: longest pause between two updates [ticks]; after a longer one the correction starts again.
    """

    step: float
    longest: int


class VelocityServos:
    """Velocity servos that the plugins of a simulation requested; servos with a gain of their own stay proportional.

    Args:
        engine: engine of the simulation.
        numbers: numbers of the model that a program changed.

    Attributes:
        servos: states by name of the actuator.
    """

    def __init__(self, engine: EngineState, numbers: NumberChanges) -> None:
        self._engine, self._numbers = engine, numbers
        self.servos: dict[str, _ServoState] = {}
        self._period = max(1.0 / RATE, engine.clock.timestep)
        longest = math.ceil(min(1.5 * self._period / max(engine.clock.timestep, SHORTEST_STEP), 1e15))
        self._timing = _Timing(engine.clock.timestep, longest)
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
        servo.follow(velocity, FLOATS)
        control = row.control(FLOATS) if row is not None else velocity
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
        data, timing = physics.data, self._timing
        if "actuator_gainprm" in engine.originals:
            self._release_slack(rows)
        positions, velocities = data.qpos.take(self._places).tolist(), data.qvel.take(self._dofs).tolist()
        for row, position, velocity in zip(rows, positions, velocities, strict=True):
            ticks, row.servo.tick = tick - row.servo.tick, tick
            if row.correct(ticks, timing, position, velocity, FLOATS):
                is_changed = True
                data.ctrl[row.index] = row.control(FLOATS)
        if is_changed:
            physics.changed(CONTROL)

    def _release_slack(self, rows: Iterable[_BoundServo]) -> None:
        """Clear the corrections of released servos, for example after an empty battery."""
        engine = self._engine
        gains = engine.mj_model.actuator_gainprm
        for row in rows:
            if row.servo.correction and gains[row.index, 0] == 0.0:
                row.servo.correction = 0.0
                engine.mj_data.ctrl[row.index] = row.control(FLOATS)

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
            numbers = self._numbers.compiled_values()
            traits = engine.names.shared(_SHARED_KEY, lambda: servo_traits(model, refs, numbers))
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


def _bind_servo(servo: _ServoState, index: int, traits: ServoTraits, period: float) -> _BoundServo:
    """Return the constants of a servo's correction, all in rad/s or m/s."""
    gain = max(traits.gain, 1e-300)
    share = min(1.0, period / max(SHORTEST_INTEGRAL_TIME, MIN_RESPONSE_TIMES * traits.response_time))
    share *= 1.0 + traits.damping / gain  # damping weakens the effect of the correction on the velocity
    foresight = traits.response_time / period
    loads = traits.max_effort, traits.largest_load, traits.damping, traits.friction
    widest, largest, damping, friction = (load / gain for load in loads)
    return _BoundServo(servo, index, widest, largest, damping, friction, share, foresight)


_STATE: Final = tuple(field.name for field in fields(_ServoState))
_CONSTANTS: Final = ("widest", "largest", "damping", "friction", "share", "foresight")


class VelocityServoRows:
    """Velocity servos of n simulations of one world.

    Args:
        servos: servos of the simulation that resets all others.
        count: number of simulations.
        qpos, qvel, ctrl: positions, velocities and controls of all simulations; the first axis is the simulation.

    Attributes:
        grid: ticks at which the corrections are updated; None for every step.
    """

    def __init__(self, servos: VelocityServos, count: int, qpos: Floats, qvel: Floats, ctrl: Floats) -> None:
        self._servos, self._qpos, self._qvel, self._ctrl = servos, qpos, qvel, ctrl
        bound = servos._bound_servos()
        self.grid = servos._engine.clock.grid(RATE)
        self._indices = np.array([row.index for row in bound], dtype=np.intp)
        self._places, self._dofs, self._timing = servos._places, servos._dofs, servos._timing
        self._numbers = {name: np.zeros((count, len(bound))) for name in (*_STATE, *_CONSTANTS)}

    @property
    def are_there(self) -> bool:
        """True if the simulations have a servo to correct."""
        return bool(len(self._indices))

    def column(self, actuator: int) -> int:
        """Return the column of the servo of an actuator."""
        return int(np.flatnonzero(self._indices == actuator)[0])

    def take(self, row: int) -> None:
        """Copy the servos of the simulation that resets all others to one row."""
        bound = self._servos._bound_servos()
        for name, numbers in self._numbers.items():
            numbers[row] = [getattr(item.servo if name in _STATE else item, name) for item in bound]

    def command(self, ids: Ids, columns: Ids, velocities: Floats, changed: npt.NDArray[np.bool_]) -> None:
        """Set target velocities of some servos in some simulations.

        Args:
            ids: simulations.
            columns: columns of the servos.
            velocities: target velocities [rad/s or m/s], shape (len(ids), len(columns)).
            changed: elements of `velocities` to set.
        """
        places, controls = (ids[:, None], columns), (ids[:, None], self._indices[columns])
        bound = self._bound(places)
        bound.servo.follow(velocities, ARRAYS)
        for name in ("command", "correction"):
            self._numbers[name][places] = np.where(changed, getattr(bound.servo, name), self._numbers[name][places])
        self._ctrl[controls] = np.where(changed, bound.control(ARRAYS), self._ctrl[controls])

    def correct(self, ids: Ids, ticks: npt.NDArray[np.int64]) -> None:
        """Update the corrections of some simulations, at the present tick of each, from their commands and motions."""
        bound, controls = self._bound(ids), (ids[:, None], self._indices)
        position, velocity = self._qpos[ids[:, None], self._places], self._qvel[ids[:, None], self._dofs]
        passed = ticks[:, None] - bound.servo.tick
        bound.servo.tick = np.broadcast_to(ticks[:, None], passed.shape)
        is_changed = bound.correct(passed, self._timing, position, velocity, ARRAYS)
        self._ctrl[controls] = np.where(is_changed, bound.control(ARRAYS), self._ctrl[controls])
        for name in _STATE:
            self._numbers[name][ids] = getattr(bound.servo, name)

    def _bound(self, places: Any) -> _BoundServo:
        """Return the state and the constants at some rows, or rows and columns, as arrays."""
        state = _ServoState(*(self._numbers[name][places] for name in _STATE))
        return _BoundServo(state, -1, *(self._numbers[name][places] for name in _CONSTANTS))
