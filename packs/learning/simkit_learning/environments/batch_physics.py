"""Engines of all environments of a batch, stepped in one call from tick to tick at which a part is due."""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt
from mujoco.batch import Batch, SimulationError

from simkit import Simulation
from simkit.runtime.array_rules import Grid, PluginRule, is_due, last_due, next_due
from simkit.runtime.engine.physics_state import BAD_ACCELERATION, BAD_POSITION, BAD_VELOCITY, divergence
from simkit.runtime.engine.step_tasks import LIMIT_RATE
from simkit.runtime.engine.velocity_limits import NO_LIMIT, limit_velocities
from simkit_learning.environments.array_view import ArrayView
from simkit_learning.environments.sampled_rows import SampledRows

Ids = npt.NDArray[np.intp]
_STATE: Final = int(mujoco.mjtState.mjSTATE_INTEGRATION)
_BAD: Final = [BAD_POSITION, BAD_VELOCITY, BAD_ACCELERATION]
_NONE: Final = int(mujoco.mjtStage.mjSTAGE_NONE)
_SLEEP: Final = int(mujoco.mjtEnableBit.mjENBL_SLEEP)
_VELOCITIES, _ACCELERATIONS = int(mujoco.mjtStage.mjSTAGE_VEL), int(mujoco.mjtStage.mjSTAGE_ACC)


class BatchPhysics:
    """Engines, servos and plugins of all environments.

    Args:
        sim: simulation of the environment that resets all others.
        count: number of environments.
        threads: number of threads; 0 for all processors.
        rules: array rules of the plugins.

    Attributes:
        batch: MuJoCo's batch.
        view: state of all environments.
        applied: forces on degrees of freedom, shape (count, nv).
        tick: present tick of each environment.
        names: names of all elements of MuJoCo's model, which all environments share.
    """

    def __init__(self, sim: Simulation, count: int, threads: int, rules: Sequence[PluginRule]) -> None:
        self._sim = sim
        self._models = [self._copied_model()] * count
        self.names: bytes = sim.mj_model.names
        self.batch = Batch(self._models[0], count, threads)
        self.view = ArrayView(sim, self.batch, self.state_of)
        self.applied = self.batch.bind("qfrc_applied")
        self.tick = np.zeros(count, np.int64)
        self.failed = np.zeros(count, np.bool_)
        self._scratch: mujoco.MjData | None = None
        self._servos, self._rules = self.view.servos, list(rules)
        for rule in self._rules:
            rule.bind(self.view)
        self._reads_poses = any(rule.reads_poses for rule in self._rules)
        self._compute_limits()

    def _compute_limits(self) -> None:
        joints = [joint for joint in self._sim.contents.handles.tables["joint"].values() if joint.mj_dofs]
        limited = [joint for joint in joints if joint.least_velocity_limit < NO_LIMIT]
        self._limited = np.array([dof for joint in limited for dof in joint.mj_dofs], dtype=np.intp)
        self._limits = np.array([joint.axis_velocity_limit(i) for joint in limited for i in range(len(joint.mj_dofs))])
        self._limit_grid = self._sim.engine.clock.grid(LIMIT_RATE, from_start=True)

    # ------------------------------------------------------------------ one environment

    def take(self, row: int) -> None:
        """Copy the state of the simulation to one environment."""
        physics, batch = self._sim.engine.physics, self.batch
        mujoco.mj_getState(physics.model, physics.data, batch.state[row], _STATE)
        batch.warning[row] = 0
        self.failed[row] = False
        self.tick[row] = physics.tick
        self._servos.take(row)
        for rule in self._rules:
            rule.take(row, physics.tick)

    def take_model(self, row: int) -> None:
        """Copy the numbers of the simulation's model to one environment."""
        self._models[row] = self._copied_model()

    def _copied_model(self) -> mujoco.MjModel:
        """Return a copy of the simulation's model without sleeping bodies.

        No body of a batch sleeps. With the flag, MuJoCo would need engine data of its own for each environment, which
        take 0.3 MB; without it, there are as many as threads.
        """
        model = copy.copy(self._sim.mj_model)
        model.opt.enableflags &= ~_SLEEP
        return model

    def use_models(self) -> None:
        """Use the copied models from now on."""
        self.batch.set_models(self._models)

    def state_of(self, row: int) -> tuple[mujoco.MjModel, mujoco.MjData]:
        """Return model and data of one environment; the data have its state, but no forward pass."""
        # the images of a model that does not vary are drawn with the meshes of the simulation
        model = self._models[row] if self.view.varies_model else self._sim.mj_model
        if self._scratch is None:
            self._scratch = mujoco.MjData(model)
        mujoco.mj_setState(model, self._scratch, np.ascontiguousarray(self.batch.state[row]), _STATE)
        return model, self._scratch

    def divergence(self, row: int) -> str:
        """Return the text of the error of a diverged environment."""
        message = self.batch.error(row)
        if message:
            return str(message)
        _, data = self.state_of(row)
        data.warning.lastinfo[:], data.warning.number[:] = self.batch.warning[row].T
        return str(divergence(self._models[row], data, self._sim.engine.clock, int(self.tick[row])))

    @property
    def diverged(self) -> npt.NDArray[np.bool_]:
        """True for each environment in which the engine met NaN or infinite numbers since its reset."""
        diverged: npt.NDArray[np.bool_] = (self.batch.warning[:, _BAD, 1] > 0).any(axis=1)
        unbound = ~(np.abs(self.view.qpos) < 1e10).all(axis=1) | ~(np.abs(self.view.qvel) < 1e10).all(axis=1)
        diverged |= unbound | self.failed
        return diverged

    # ------------------------------------------------------------------ steps

    def advance(self, ids: Ids, steps: int, sampled: list[SampledRows], *, with_accelerations: bool) -> None:
        """Make `steps` steps of some environments, with everything that is due on the way."""
        for group in self._groups(ids, sampled):
            first = int(self.tick[group[0]])
            tick, last = first, first + steps
            # only the last values of this call are observed
            samples = [(last_due(source.grid, last), source) for source in sampled]
            rows = None if len(group) == len(self.tick) else group
            while tick < last:
                self._before(group, self.tick[group] + (tick - first))
                stops = [
                    last,
                    *(due for due, _ in samples if due > tick),
                    *(source.next_stop(tick) for source in sampled),
                ]
                stop = self._next_stop(group, tick, stops)
                # other stops read joints only, whose values need no forward pass
                is_read = self._reads_poses or stop == last or stop in stops[1:]
                stage = _ACCELERATIONS if stop == last and with_accelerations else _VELOCITIES if is_read else _NONE
                try:
                    self.batch.step(rows, stop - tick, stage)
                except SimulationError as error:
                    self.failed[error.ids] = True
                self.view.has_moved = True
                tick = stop
                ticks = self.tick[group] + (tick - first)
                self._after(group, ticks)
                for due, source in samples:
                    if due == tick:
                        source.sample(group, ticks)
                    source.note(group, ticks)
            self.tick[group] += steps

    def _groups(self, ids: Ids, sampled: list[SampledRows]) -> list[Ids]:
        """Divide environments into groups at which the same parts are due at the same steps."""
        ticks = self.tick[ids]
        grids = [
            *self._grids(),
            *(grid for rule in self._rules for grid in rule.grids),
            *(source.grid for source in sampled),
        ]
        cycle = math.lcm(*(grid.cycle for grid in grids if grid is not None))
        phases = np.where(ticks > 0, ticks % cycle, -1)
        return [ids[phases == phase] for phase in np.unique(phases)]

    def _grids(self) -> list[Grid]:
        servos = [self._servos.grid] if self._servos.are_there else []
        return [*servos, self._limit_grid] if len(self._limited) else servos

    def _next_stop(self, ids: Ids, tick: int, stops: list[int]) -> int:
        """Return the first of some ticks and of those at which a part is due."""
        stops = [*stops, *(next_due(grid, tick) for grid in self._grids())]
        return min([*stops, *(rule.next_stop(ids, tick) for rule in self._rules)])

    def _before(self, ids: Ids, ticks: npt.NDArray[np.int64]) -> None:
        if self._servos.are_there and is_due(self._servos.grid, int(ticks[0])):
            self._servos.correct(ids, ticks)
        for rule in self._rules:
            rule.before_step(ids, ticks)

    def _after(self, ids: Ids, ticks: npt.NDArray[np.int64]) -> None:
        if len(self._limited) and is_due(self._limit_grid, int(ticks[0])):
            self._limit(ids)
        for rule in self._rules:
            rule.after_step(ids, ticks)

    def _limit(self, ids: Ids) -> None:
        """Enforce the velocity limits of joints, which few environments exceed."""
        velocities = self.view.qvel[ids[:, None], self._limited]
        for row in ids[(np.abs(velocities) > self._limits).any(axis=1) & np.isfinite(velocities).all(axis=1)].tolist():
            model, data = self.state_of(row)
            limit_velocities(_OneState(model, data), self._limited, self._limits)  # type: ignore[arg-type]
            self.view.qvel[row] = data.qvel


class _OneState:
    """State of one environment, for functions that correct velocities."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self.model, self.data = model, data

    def fresh_velocities(self) -> bool:
        """Compute the mass matrix and the velocities."""
        mujoco.mj_fwdPosition(self.model, self.data)
        mujoco.mj_fwdVelocity(self.model, self.data)
        return True

    def changed_body(self, _stage: int, _body: int) -> None:
        """Do nothing, because no result of this state is kept."""
