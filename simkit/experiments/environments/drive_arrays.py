"""Velocity servos and differential drives of all environments of a batch, as arrays.

Each row of an array belongs to one environment. The formulas and their order are those of
`runtime.engine.velocity_servos` and `plugins.classic.diff_drive`, so that a batch has the bits of single environments.
"""

from __future__ import annotations

import math
from typing import Any, Final, Protocol

import numpy as np
import numpy.typing as npt

from simkit.plugins.classic.diff_drive import GazeboRosDiffDrive
from simkit.runtime import Simulation
from simkit.runtime.engine.velocity_servos import RATE, UNREST_DECAY

Floats = npt.NDArray[np.float64]
Ids = npt.NDArray[np.intp]

_LARGEST: Final = 9e9
_CLOSE: Final = 0.01  # [m/s] as in the plugin
_MIN_ERROR: Final = 1e-6  # [rad/s or m/s] as in the servos
_STATES: Final = ("command", "correction", "position", "velocity", "last_command", "unrest", "tick")
_CONSTANTS: Final = ("widest", "largest", "damping", "friction", "share", "foresight")


class BatchState(Protocol):
    """State of the engines of a batch, one row for each environment."""

    qpos: Floats
    qvel: Floats
    ctrl: Floats


class ServoArrays:
    """Velocity servos of all environments.

    Args:
        sim: simulation of the environment that resets all others.
        state: state of the engines.
        count: number of environments.

    Attributes:
        grid: ticks at which the corrections are updated; None for every step.
    """

    def __init__(self, sim: Simulation, state: BatchState, count: int) -> None:
        self._servos, self._state = sim.engine.velocity_servos, state
        rows = self._servos._bound_servos()
        self.grid = sim.engine.clock.grid(RATE)
        self._step, self._longest = sim.timestep, self._servos._longest
        self._indices = np.array([row.index for row in rows], dtype=np.intp)
        self._dofs, self._places = self._servos._dofs, self._servos._places
        self._values = {name: np.zeros((count, len(rows))) for name in (*_STATES, *_CONSTANTS)}

    def column(self, actuator: int) -> int:
        """Return the column of the servo of an actuator."""
        return int(np.flatnonzero(self._indices == actuator)[0])

    def take(self, row: int) -> None:
        """Copy the servos of the simulation to one environment."""
        bound = self._servos._bound_servos()
        for name in _STATES:
            self._values[name][row] = [getattr(one.servo, name) for one in bound]
        for name in _CONSTANTS:
            self._values[name][row] = [getattr(one, name) for one in bound]

    def command(self, ids: Ids, column: int, velocity: Floats) -> None:
        """Set the target velocity of one servo in some environments [rad/s or m/s]."""
        command, correction = self._values["command"], self._values["correction"]
        correction[ids, column] = np.where(
            (velocity == 0.0) & (command[ids, column] != 0.0), 0.0, correction[ids, column]
        )
        command[ids, column] = velocity
        v = {name: values[ids, column] for name, values in self._values.items()}
        self._state.ctrl[ids, self._indices[column]] = velocity + _compensations(v)

    def correct(self, ids: Ids, ticks: npt.NDArray[np.int64]) -> None:
        """Update the corrections of some environments, at the present tick of each, from their commands and motions."""
        state = self._state
        v = {name: values[ids] for name, values in self._values.items()}
        position, velocity = state.qpos[np.ix_(ids, self._places)], state.qvel[np.ix_(ids, self._dofs)]
        passed = ticks[:, None] - v["tick"]
        is_known = (passed > 0) & (passed <= self._longest)
        mean = (position - v["position"]) / (np.where(is_known, passed, 1.0) * self._step)
        load, unrest = _uncompensated_loads(v, mean, velocity)
        load = np.where(is_known, load, 0.0)
        largest = v["largest"] + v["damping"] * np.abs(v["command"])
        correction = np.maximum(-largest, np.minimum(largest, v["correction"] + v["share"] * load))
        v["correction"] = correction = np.where(load != 0.0, correction, v["correction"])
        places = np.ix_(ids, self._indices)
        state.ctrl[places] = np.where(load != 0.0, v["command"] + _compensations(v), state.ctrl[places])
        updated = {
            "tick": np.broadcast_to(ticks[:, None], v["tick"].shape),
            "position": position,
            "velocity": velocity,
            "last_command": v["command"],
            "correction": correction,
            "unrest": np.where(is_known, unrest, v["unrest"]),
        }
        for name, values in updated.items():
            self._values[name][ids] = values


def _compensations(v: dict[str, Floats]) -> Floats:
    """Return the parts of the controls that compensate the loads of the joints."""
    command = v["command"]
    known: Floats = v["correction"] + v["damping"] * command
    return known + np.where(command != 0.0, np.copysign(v["friction"], command), 0.0)


def _uncompensated_loads(v: dict[str, Floats], mean: Floats, velocity: Floats) -> tuple[Floats, Floats]:
    """Return the loads that the servos did not compensate in the last period, and the amounts of recent changes."""
    command, before, foresight = v["command"], v["velocity"], v["foresight"]
    error = command - mean
    unrest = np.abs(command - v["last_command"]) + v["unrest"] * UNREST_DECAY
    is_small = (np.abs(error) <= _MIN_ERROR) | (np.abs(mean) > np.abs(before) + np.abs(velocity) + np.abs(command))
    load = error - (velocity - before) * foresight
    size = np.abs(load) - unrest * np.maximum(1.0, foresight)
    sign = np.where(load > 0.0, 1.0, -1.0)
    wider = np.maximum(sign * (command - velocity), sign * (v["last_command"] - before)) + sign * _compensations(v)
    return np.where(is_small | (size <= 0.0) | (wider >= v["widest"]), 0.0, sign * size), unrest


class DiffDriveArrays:
    """One differential drive of Gazebo Classic in all environments.

    Args:
        plugin: drive of the environment that resets all others.
        servos: velocity servos of all environments.
        state: state of the engines.
        count: number of environments.

    Attributes:
        grid: ticks of both hooks of the plugin; None for every step.
        command: forward speed [m/s] and turning rate [rad/s] of the last command.
        odometry: x, y [m], yaw [rad], forward speed, speed to the left [m/s] and turning rate [rad/s] of the wheels, at
            the last tick of the plugin; only if the odometry comes from the encoders.
    """

    def __init__(self, plugin: GazeboRosDiffDrive, servos: ServoArrays, state: BatchState, count: int) -> None:
        sim, options = plugin.sim, plugin.options
        self.plugin, self._servos, self._state = plugin, servos, state
        self.grid = sim.engine.clock.grid(options.update_rate)
        self._clock = sim.engine.clock
        self._columns = [servos.column(sim.engine.names.actuator(servo)) for servo in plugin._servos]
        self._limits = [min(_LARGEST, sim.engine.velocity_limit(s.joint, s.axis)) for s in plugin._servos]
        self._places = np.array([wheel._first_qpos for wheel in plugin._wheels], dtype=np.intp)
        self._dofs = np.array([wheel._one_dof for wheel in plugin._wheels], dtype=np.intp)
        self.command, self._rims = np.zeros((count, 2)), np.zeros((count, len(plugin._wheels)))
        self._last_ns, self._angles = np.zeros(count), np.zeros((count, 2))
        self.odometry = np.zeros((count, 6))

    def take(self, row: int) -> None:
        """Copy the state of the plugin to one environment."""
        plugin = self.plugin
        self.command[row], self._rims[row], self._last_ns[row] = plugin._command, plugin._rims, plugin._last_ns
        self._angles[row] = plugin._angles
        reckoned = plugin._reckoning
        self.odometry[row, :3] = reckoned.x, reckoned.y, reckoned.yaw

    def before_step(self, ids: Ids, ticks: npt.NDArray[np.int64]) -> None:
        """Move each wheel's rim speed towards its target, by at most the acceleration limit."""
        now = np.array([self._clock.time_ns(tick) for tick in ticks.tolist()], float)
        elapsed = (now - self._last_ns[ids]) * 1e-9
        self._last_ns[ids] = now
        forward, turn = self.command[ids].T
        largest = self.plugin.options.max_wheel_acceleration
        for index, pair in enumerate(self.plugin.options.pairs):
            for side, sign in ((0, -1.0), (1, 1.0)):
                wheel = 2 * index + side
                target, before = forward + sign * turn * pair.separation / 2, self._rims[ids, wheel]
                speed = target
                if largest:
                    step = largest * elapsed
                    ramped = before + np.maximum(-step, np.minimum(step, target - before))
                    speed = np.where(np.abs(target - before) < _CLOSE, target, ramped)
                changed = speed != before
                self._rims[ids, wheel] = speed
                limit = self._limits[wheel]
                velocity = np.maximum(-limit, np.minimum(limit, speed[changed] / pair.radius))
                self._servos.command(ids[changed], self._columns[wheel], velocity)

    def after_step(self, ids: Ids) -> None:
        """Integrate the travel of the wheels, as the plugin does with odometry from encoders."""
        pair = self.plugin.options.pairs[0]
        angles = self._state.qpos[np.ix_(ids, self._places[:2])]
        left, right = ((angles - self._angles[ids]) * pair.radius).T
        self._angles[ids] = angles
        turn, half = (right - left) / pair.separation, (right - left) / pair.separation / 2
        x, y, yaw = self.odometry[ids, :3].T
        is_arc = np.abs(half) > 1e-4
        part = np.where(is_arc, np.sin(half) / np.where(is_arc, half, 1.0), 1 - half * half / 6)
        ahead = (left + right) / 2
        self.odometry[ids, 0] = x + ahead * (np.cos(yaw + half) * part)
        self.odometry[ids, 1] = y + ahead * (np.sin(yaw + half) * part)
        self.odometry[ids, 2] = yaw + turn
        rolled = self._state.qvel[np.ix_(ids, self._dofs[:2])] * pair.radius
        self.odometry[ids, 3] = rolled.sum(axis=1) / 2
        self.odometry[ids, 5] = (rolled[:, 1] - rolled[:, 0]) / pair.separation

    @staticmethod
    def obstacle(plugin: Any) -> str:
        """Return why a drive cannot be computed as arrays; empty if it can."""
        options = plugin.options
        if options.noise is not None:
            return "<odometry_noise>"
        if any(wheel.dof != 1 for wheel in plugin._wheels) or not all(
            math.isfinite(pair.radius) for pair in options.pairs
        ):
            return "its wheels"
        return ""
