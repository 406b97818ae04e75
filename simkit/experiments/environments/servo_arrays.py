"""Velocity servos of all environments of a batch, as arrays.

Each row of an array belongs to one environment. The formulas and their order are those of
`runtime.engine.velocity_servos`, so that a batch has the bits of single environments.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.experiments.environments.array_view import ArrayView
from simkit.runtime import Simulation
from simkit.runtime.engine.velocity_servos import RATE, UNREST_DECAY

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
Ids = npt.NDArray[np.intp]

_MIN_ERROR: Final = 1e-6  # [rad/s or m/s] as in the servos
_STATES: Final = ("command", "correction", "position", "velocity", "last_command", "unrest", "tick")
_CONSTANTS: Final = ("widest", "largest", "damping", "friction", "share", "foresight")


class ServoArrays:
    """Velocity servos of all environments.

    Args:
        sim: simulation of the environment that resets all others.
        view: state of all environments.

    Attributes:
        grid: ticks at which the corrections are updated; None for every step.
    """

    def __init__(self, sim: Simulation, view: ArrayView) -> None:
        self._servos, self._view = sim.engine.velocity_servos, view
        rows = self._servos._bound_servos()
        self.grid = sim.engine.clock.grid(RATE)
        self._step, self._longest = sim.timestep, self._servos._longest
        self._indices = np.array([row.index for row in rows], dtype=np.intp)
        self._dofs, self._places = self._servos._dofs, self._servos._places
        self._values = {name: np.zeros((view.count, len(rows))) for name in (*_STATES, *_CONSTANTS)}

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

    def command(self, ids: Ids, columns: Ids, velocities: Floats, changed: Bools) -> None:
        """Set target velocities of some servos in some environments.

        Args:
            ids: environments.
            columns: columns of the servos.
            velocities: target velocities [rad/s or m/s], shape (len(ids), len(columns)).
            changed: elements of `velocities` to set.
        """
        places, controls = (ids[:, None], columns), (ids[:, None], self._indices[columns])
        v = {name: self._values[name][places] for name in ("command", "correction", "damping", "friction")}
        is_stop = changed & (velocities == 0.0) & (v["command"] != 0.0)
        v["correction"] = self._values["correction"][places] = np.where(is_stop, 0.0, v["correction"])
        v["command"] = self._values["command"][places] = np.where(changed, velocities, v["command"])
        present = self._view.ctrl[controls]
        self._view.ctrl[controls] = np.where(changed, v["command"] + _compensations(v), present)

    def correct(self, ids: Ids, ticks: npt.NDArray[np.int64]) -> None:
        """Update the corrections of some environments, at the present tick of each, from their commands and motions."""
        view = self._view
        v = {name: values[ids] for name, values in self._values.items()}
        position, velocity = view.qpos[ids[:, None], self._places], view.qvel[ids[:, None], self._dofs]
        passed = ticks[:, None] - v["tick"]
        is_known = (passed > 0) & (passed <= self._longest)
        mean = (position - v["position"]) / (np.where(is_known, passed, 1.0) * self._step)
        load, unrest = _uncompensated_loads(v, mean, velocity)
        load = np.where(is_known, load, 0.0)
        largest = v["largest"] + v["damping"] * np.abs(v["command"])
        correction = np.maximum(-largest, np.minimum(largest, v["correction"] + v["share"] * load))
        v["correction"] = correction = np.where(load != 0.0, correction, v["correction"])
        places = ids[:, None], self._indices
        view.ctrl[places] = np.where(load != 0.0, v["command"] + _compensations(v), view.ctrl[places])
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
