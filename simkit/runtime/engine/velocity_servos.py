"""Integral action of velocity servos: a wheel keeps the commanded speed under a constant load.

The engine's velocity servo is proportional, `effort = kv · (control − velocity)`, so a load makes it give way by
load / kv. A larger kv is no remedy: the engine solves contacts with the inertia of the wheel alone, and a wheel whose
servo is much stiffer than that slips on the ground. So the control is the command plus a correction, which is brought
up to date `RATE` times a second:

    correction += period / integral_time · (mean error − response_time · gain in velocity / period)

The mean error is that of the last period, command − way / period. The second term is what the servo needed to
accelerate the robot. The rest belongs to a load: it is the load / kv that the correction does not meet yet.

- A servo that gave its whole effort in that direction at an end of the period is not corrected further (no windup).
- As much as the command has changed by of late is left out: a start without a load has no overshoot.
- A command of zero begins with no correction: the loads of a robot that scrubs its wheels are not those at rest, and
  wheels that push against each other would creep.
- The corrected effort is at most twice the weight of the robot at the rim of the wheel. No tyre transmits more.

The period is a grid of simulated time, so who reads, and how a run is divided into steps, make no difference.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
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

RATE: Final = 50.0
"""[Hz] at which corrections are brought up to date."""

SHORTEST_INTEGRAL_TIME: Final = 0.04
"""[s]"""

MIN_RESPONSE_TIMES: Final = 3.0
"""Integral time of a servo over its response time, at least, so that a heavy robot does not swing."""

UNREST_DECAY: Final = 0.6
"""Share of a change of command that still counts one period later."""

_MIN_ERROR: Final = 1e-6
"""[rad/s or m/s] An error that is not corrected."""

_NEVER: Final = -(1 << 40)


@dataclass(slots=True)
class _ServoState:
    """State of one servo, in rad/s or m/s.

    Attributes:
        command: velocity that was asked for.
        correction: what the control has beyond the command.
        position: of the joint at the last update [rad or m].
        velocity: of the joint at the last update.
        last_command: command at the last update.
        unrest: how much the command has changed of late.
        tick: of the last update; far in the past before the first.
    """

    command: float = 0.0
    correction: float = 0.0
    position: float = 0.0
    velocity: float = 0.0
    last_command: float = 0.0
    unrest: float = 0.0
    tick: int = _NEVER


@dataclass(frozen=True, slots=True)
class _BoundServo:
    """A servo in the engine's model.

    Attributes:
        index: of the actuator.
        widest: error at which the servo gives its whole effort [rad/s or m/s].
        largest: correction at most [rad/s or m/s].
        share: of an unmet load that is added to the correction at an update.
        foresight: response time over the period of updates.
    """

    servo: _ServoState
    index: int
    widest: float
    largest: float
    share: float
    foresight: float


class VelocityServos:
    """The velocity servos that plugins asked for, of one simulation; those with a gain of their own stay proportional.

    Attributes:
        servos: state by name of the actuator.
    """

    def __init__(self, engine: EngineState) -> None:
        self._engine = engine
        self.servos: dict[str, _ServoState] = {}
        self._period = max(1.0 / RATE, engine.clock.timestep)
        # in ticks; after more it begins anew
        self._longest = math.ceil(min(1.5 * self._period / max(engine.clock.timestep, SHORTEST_STEP), 1e15))
        self._model: mujoco.MjModel | None = None
        self._rows: list[_BoundServo] = []
        self._dofs = self._places = np.zeros(0, np.intp)

    @property
    def are_there(self) -> bool:
        """True where the simulation has a servo to correct."""
        return bool(self._bound())

    def command(self, ref: ActuatorRef, velocity: float) -> None:
        """Sets the velocity that a servo is to keep [rad/s or m/s]."""
        servo = self.servos.setdefault(ref.name, _ServoState())
        if velocity == 0.0 and servo.command != 0.0:
            servo.correction = 0.0
        servo.command = velocity
        self._engine.mj_data.ctrl[self._engine.names.actuator(ref)] = velocity + servo.correction

    def is_commanded(self, actuators: Iterable[int]) -> bool:
        """Check whether one of these actuators of the engine has a command other than zero."""
        controls = self._engine.mj_data.ctrl
        commands = {row.index: row.servo.command for row in self._bound()}
        return any(commands.get(int(i), controls[i]) != 0.0 for i in actuators)

    # ------------------------------------------------------------------ correction

    def correct(self, tick: int) -> None:
        """Brings the corrections up to date, from the commands and velocities up to now."""
        rows, engine = self._bound(), self._engine
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
                load = _unmet_load(row, (position - servo.position) / (ticks * timestep), velocity)
            servo.tick, servo.position, servo.velocity, servo.last_command = tick, position, velocity, servo.command
            if load:
                is_changed = True
                servo.correction = max(-row.largest, min(row.largest, servo.correction + row.share * load))
                data.ctrl[row.index] = servo.command + servo.correction
        if is_changed:
            physics.changed(CONTROL)

    def _release_slack(self, rows: Iterable[_BoundServo]) -> None:
        """Forgets the corrections of servos that were let go, as by an empty battery."""
        engine = self._engine
        gains = engine.mj_model.actuator_gainprm
        for row in rows:
            if row.servo.correction and gains[row.index, 0] == 0.0:
                row.servo.correction = 0.0
                engine.mj_data.ctrl[row.index] = row.servo.command

    def _bound(self) -> list[_BoundServo]:
        """The servos with their places in the engine's present model."""
        engine, model = self._engine, self._engine.physics.model
        if self._model is not model:
            self._model = model
            records = engine.structure.builder.records.values()
            refs = [r for record in records for r in record.actuators if r.kind == "velocity" and r.kv is None]
            self.servos = {ref.name: self.servos.get(ref.name) or _ServoState() for ref in refs}
            indices = [engine.names.actuator(ref) for ref in refs]
            # once, as compiled: after a restore they are the same, whatever was written to since
            traits = engine.names.shared("velocity servos", lambda: servo_traits(model, refs, engine.originals))
            joints = model.actuator_trnid[indices, 0]
            self._dofs, self._places = (a[joints].astype(np.intp) for a in (model.jnt_dofadr, model.jnt_qposadr))
            places = zip(refs, indices, traits, strict=True)
            self._rows = [_bind_servo(self.servos[ref.name], index, one, self._period) for ref, index, one in places]
        return self._rows

    # ------------------------------------------------------------------ state

    def get_state(self) -> dict[str, _ServoState]:
        """Return the state that a snapshot keeps."""
        return {name: replace(servo) for name, servo in self.servos.items()}

    def set_state(self, state: Mapping[str, _ServoState]) -> None:
        """Back to a state from `get_state`; a servo that it does not know begins anew."""
        self.servos = {name: replace(servo) for name, servo in state.items()}
        self._model = None


def _unmet_load(row: _BoundServo, mean: float, velocity: float) -> float:
    """Return the load / kv that a servo did not meet in the last period, from its mean and its present velocity."""
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
    wider = max(sign * (command - velocity), sign * (servo.last_command - before)) + sign * servo.correction
    return 0.0 if wider >= row.widest else sign * size


def _bind_servo(servo: _ServoState, index: int, traits: ServoTraits, period: float) -> _BoundServo:
    """Return what the correction of a servo is worked out with, all in rad/s or m/s."""
    gain = max(traits.gain, 1e-300)
    share = min(1.0, period / max(SHORTEST_INTEGRAL_TIME, MIN_RESPONSE_TIMES * traits.response_time))
    foresight = traits.response_time / period
    return _BoundServo(servo, index, traits.max_effort / gain, traits.largest_load / gain, share, foresight)
