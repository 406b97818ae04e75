"""Vector environment whose environments step together in one call of the engine."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final, cast

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space, create_empty_array

from simkit.diagnostics import shorten
from simkit.extend import counted
from simkit.runtime.array_rules import CannotBatchError
from simkit.sensors.cameras.rendering.render_thread import usable_cores
from simkit_learning.environments.array_bindings import (
    ActionArrays,
    ObservationArrays,
    Sources,
    array_value,
    plugin_rules,
    spec_obstacles,
    world_obstacles,
)
from simkit_learning.environments.batch_physics import BatchPhysics
from simkit_learning.environments.environment import SimulationEnv
from simkit_learning.environments.message_arrays import Array
from simkit_learning.environments.specification import (
    EnvironmentSpec,
    Info,
    Observation,
    ObservationSource,
    ResetOptions,
    invalid,
)
from simkit_learning.sweeps.sweep_spec import split_values

if TYPE_CHECKING:
    from simkit_learning.sweeps.parameter_space import Values

Bools = npt.NDArray[np.bool_]
Ids = npt.NDArray[np.intp]

_ENDED: Final = "SK-GYM-005"


def _by_name(observation: Array | dict[str, Array]) -> dict[str, Array]:
    """Return observations by name; a single one has the name `observation`."""
    return observation if isinstance(observation, dict) else {"observation": observation}


class BatchVectorEnv(gymnasium.vector.VectorEnv[Any, Any, Any]):
    """Environments of one world that MuJoCo's batch steps on several threads; `simkit.gym.make_vec` makes it.

    One ordinary environment resets each of them in turn, so that an episode begins with the bits of a single
    environment. Steps, rays, servos, drives, observations and rewards are computed as arrays.

    Args:
        spec: specification; environment k has its seed plus k.
        num_envs: number of environments.
        autoreset: start of the next episode.
        render_mode: must be None.
        threads: number of threads; 0 for all processors.

    Attributes:
        not_batched: empty text; other vector environments have the reason why they are no batch.
        view: state of all environments.
        values: values drawn at the last reset of each environment.

    Raises:
        CannotBatchError: a part of the environment needs Python for each environment; the message lists all parts.
    """

    not_batched = ""

    def __init__(
        self,
        spec: EnvironmentSpec,
        num_envs: int,
        autoreset: AutoresetMode,
        render_mode: str | None = None,
        threads: int = 0,
    ) -> None:
        self._env = SimulationEnv(spec)
        self.num_envs, self.render_mode, self._autoreset_mode = num_envs, render_mode, autoreset
        self.metadata = {**self._env.metadata, "autoreset_mode": autoreset}
        try:
            self._bind(min(threads or usable_cores(), num_envs))
        except BaseException:
            self._env.close()
            raise
        self.single_observation_space, self.single_action_space = self._env.observation_space, self._env.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._randoms: list[np.random.Generator | None] = [None] * num_envs
        self.values: list[Values] = [{} for _ in range(num_envs)]
        self._has_begun = np.zeros(num_envs, np.bool_)
        self._has_ended = np.zeros(num_envs, np.bool_)
        self._first_tick, self._last_tick = np.zeros(num_envs, np.int64), np.full(num_envs, np.inf)
        empty = create_empty_array(self.single_observation_space, num_envs)
        self._observation = cast(Array | dict[str, Array], empty)

    def _bind(self, threads: int) -> None:
        """Bind all parts of the environment to arrays, or raise an error that lists the parts that need Python."""
        env, spec = self._env, self._env.spec_of_env
        self._sim = sim = env.sim
        obstacles = [*spec_obstacles(spec, self.render_mode), *world_obstacles(sim), *self._variation_obstacles()]
        if obstacles:
            raise CannotBatchError("; ".join(obstacles))
        rules, _ = plugin_rules(sim)
        self._physics = physics = BatchPhysics(sim, self.num_envs, threads, rules)
        self.view = view = physics.view
        view.varies_model = bool(split_values(env.values)[0])
        self._sources = Sources(env, view, rules)
        self._bound: dict[str, ObservationArrays] = {}
        sources = spec.observation
        named: Mapping[str, ObservationSource] = sources if isinstance(sources, Mapping) else {"observation": sources}
        for name, source in named.items():
            observation = source if isinstance(source, Observation) else Observation(source)
            bound = env.observations.source_of(name)
            try:
                self._bound[name] = ObservationArrays(bound, self._sources.bind(observation, name))
            except CannotBatchError as error:
                obstacles.append(f"observation {name!r}: {error}")
        self._values: dict[str, Callable[[], npt.ArrayLike]] = {}
        for name in ("reward", "terminated", "success"):
            try:
                self._values[name] = array_value(getattr(spec, name), view, name, env)
            except CannotBatchError as error:
                obstacles.append(str(error))
        try:
            self._actions = ActionArrays(env, view, physics.applied, rules)
        except CannotBatchError as error:
            obstacles.append(str(error))
        if obstacles:
            raise CannotBatchError("; ".join(obstacles))

    def _variation_obstacles(self) -> list[str]:
        """Return why drawn values cannot change the models of a batch; empty if they can."""
        env, sim = self._env, self._env.sim
        if not split_values(env.values)[0]:
            return []
        env.reset(seed=env.spec_of_env.run.seed)
        env.reset()
        if env.sim is not sim:
            return ["randomise has values that load the world again"]
        return []

    # ------------------------------------------------------------------ episodes

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: ResetOptions | None = None
    ) -> tuple[Any, Info]:
        """Begin an episode in all environments, or in those of `options["reset_mask"]`.

        Args:
            seed: seed of the first environment, whose successors get the next ones; a list of seeds; or None.
            options: options of `SimulationEnv.reset`, and `{"reset_mask": mask}`.

        Returns:
            First observations and infos.
        """
        self._env.check_open()
        options = dict(options or {})
        mask = np.asarray(options.pop("reset_mask", np.ones(self.num_envs, np.bool_)))
        if mask.shape != (self.num_envs,) or mask.dtype != np.bool_ or not mask.any():
            raise invalid(f"reset_mask: expected {self.num_envs} truth values, one of them true; found {mask!r}")
        if seed is None or isinstance(seed, (int, np.integer)):
            seeds = [None if seed is None else int(seed) + row for row in range(self.num_envs)]
        elif len(seed) == self.num_envs:
            seeds = list(seed)
        else:
            raise invalid(
                f"seed: found {counted(len(seed), 'seed')}; expected one number, or {counted(self.num_envs, 'seed')}"
            )
        infos: Info = {}
        for row in np.flatnonzero(mask).tolist():
            infos = self._reset_row(row, infos, seeds[row], options)
        self._begin()
        return self._copied(), infos

    def _reset_row(self, row: int, infos: Info, seed: int | None = None, options: ResetOptions | None = None) -> Info:
        """Reset one environment with the help of the ordinary one, and add its info."""
        env, view, physics = self._env, self.view, self._physics
        random = self._randoms[row]
        if seed is None and random is None:
            seed = env.spec_of_env.run.seed + row
        elif seed is None and random is not None:
            env.np_random = random
        observation, info = env.reset(seed=seed, options=options or None)
        if env.sim is not self._sim:
            raise invalid("the drawn values changed the structure of the world", "pass batch=False to make_vec")
        self._randoms[row], self.values[row] = env.np_random, dict(env.values)
        sim = env.sim
        if sim.mj_model.names != physics.names or sim.contents.handles.exact_limits:
            raise invalid("on_reset spawned, removed or limited something", "pass batch=False to make_vec")
        view.varies_model |= bool(sim.engine.originals)  # on_reset may have written to the model
        sim.engine.loop.deliver_inputs()
        if sim.engine.physics.one_shot:
            raise invalid("on_reset applied a force for one step only", "pass batch=False to make_vec")
        physics.take(row)
        if view.varies_model:
            physics.take_model(row)
        try:
            for sensor in self._sources.sensors:
                sensor.take(row)
        except CannotBatchError as error:
            raise invalid(str(error), "pass batch=False to make_vec") from None
        for message in self._sources.sampled:
            message.take(row)
        for name, value in env.memory.items():
            if isinstance(value, (bool, int, float, np.ndarray, np.number, np.bool_)):
                array = np.asarray(value)
                rows = view.memory.get(name, np.zeros((self.num_envs, *array.shape), array.dtype))
                view.memory[name] = rows.astype(np.result_type(rows, array), copy=False)
                view.memory[name][row] = array
        self._first_tick[row], self._last_tick[row] = env.first_tick, env.last_tick or np.inf
        self._has_begun[row], self._has_ended[row] = True, False
        self._set_row(row, observation)
        return self._add_info(infos, info, row)

    def _set_row(self, row: int, observation: Array | dict[str, Array]) -> None:
        named = _by_name(observation)
        for name, values in _by_name(self._observation).items():
            values[row] = named[name]

    def _begin(self) -> None:
        if self.view.varies_model:
            self._physics.use_models()

    def _copied(self) -> Array | dict[str, Array]:
        observation = self._observation
        if isinstance(observation, dict):
            return {name: values.copy() for name, values in observation.items()}
        return observation.copy()

    # ------------------------------------------------------------------ steps

    def step(self, actions: npt.ArrayLike) -> tuple[Any, npt.NDArray[np.float64], Bools, Bools, Info]:
        """Send an action to each environment, advance by one control period, and return the results of all.

        Environments that have ended begin their next episode, as the autoreset mode says.
        """
        self._env.check_open()
        if not self._has_begun.all():
            raise invalid("step was called before reset", "call reset first", _ENDED)
        values = self._checked(actions)
        resets = np.flatnonzero(self._has_ended)
        if len(resets) and self._autoreset_mode == AutoresetMode.DISABLED:
            hint = "reset them with options={'reset_mask': terminated | truncated}"
            raise invalid(f"the episodes of the environments {resets[:9].tolist()} have ended", hint, _ENDED)
        ids = np.flatnonzero(~self._has_ended)
        with np.errstate(all="ignore"):  # a diverged environment has NaN
            rewards, terminated, truncated, infos = self._step(ids, values)
        if self._autoreset_mode == AutoresetMode.NEXT_STEP:
            for row in resets.tolist():
                infos = self._reset_row(row, infos)
        self._has_ended = terminated | truncated
        if self._autoreset_mode == AutoresetMode.SAME_STEP:
            resets = np.flatnonzero(self._has_ended)
            for row in resets.tolist():
                infos = self._end(row, infos)
            self._has_ended = np.zeros(self.num_envs, np.bool_)
        if len(resets):
            self._begin()
        return self._copied(), rewards, terminated, truncated, infos

    def _end(self, row: int, infos: Info) -> Info:
        """Store the last observation and info of an episode, and begin the next one."""
        last = {name: values[row].copy() for name, values in _by_name(self._observation).items()}
        info = {name: infos[name][row] for name in infos if not name.startswith("_") and infos[f"_{name}"][row]}
        final = last if isinstance(self._observation, dict) else last["observation"]
        final_info = {name: value for name, value in info.items() if name not in ("final_obs", "final_info")}
        infos = self._add_info(infos, {"final_obs": final, "final_info": final_info}, row)
        return self._reset_row(row, infos)

    def _checked(self, actions: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the actions within their bounds."""
        bound = self._env.actions
        shape = (self.num_envs, len(bound.names))
        try:
            values = np.asarray(actions, dtype=np.float64)
        except (TypeError, ValueError):
            values = np.zeros(0)
        if values.shape != shape or np.isnan(values).any():
            problem = "a NaN" if values.shape == shape else f"actions of the shape {np.shape(actions)}"
            names = shorten(", ".join(bound.names), 60)
            raise invalid(f"found {problem}; expected the shape {shape} with {names}", code="SK-GYM-004")
        return bound.limited(values)

    def _step(self, ids: Ids, values: npt.NDArray[np.float64]) -> tuple[npt.NDArray[np.float64], Bools, Bools, Info]:
        """Step some environments."""
        env, physics, view, count = self._env, self._physics, self.view, self.num_envs
        bound, steps = env.actions, env.steps
        is_active = np.zeros(count, np.bool_)
        is_active[ids] = True
        view.action = np.where(is_active[:, None], values, 0.0)
        numbers = bound.numbers_of(values[ids])
        before = physics.tick.copy()
        if len(ids):
            self._actions.send(ids, numbers)
            with_accelerations = self._sources.needs_acceleration
            physics.advance(ids, steps, self._sources.sampled, with_accelerations=with_accelerations)
        self._count_samples(ids, before, steps)
        diverged = physics.diverged & is_active
        good = is_active & ~diverged
        view.sim_time = np.multiply(physics.tick, self._sim.timestep, dtype=np.float64)
        view.time = np.multiply(physics.tick - self._first_tick, self._sim.timestep, dtype=np.float64)
        rows = np.flatnonzero(good)
        for name, bound_source in self._bound.items():
            target = _by_name(self._observation)[name]
            target[rows] = bound_source.values(rows)[rows]
        view.observation = self._observation
        rewards: npt.NDArray[np.float64] = np.where(good, np.asarray(self._values["reward"](), np.float64), 0.0)
        terminated = good & np.asarray(self._values["terminated"](), np.bool_)
        truncated = diverged | (good & (physics.tick >= self._last_tick) & ~terminated)
        return rewards, terminated, truncated, self._infos(good, diverged)

    def _count_samples(self, ids: Ids, before: npt.NDArray[np.int64], steps: int) -> None:
        for source in self._sources.sensors:
            for tick in np.unique(before[ids]).tolist():
                source.count(ids[before[ids] == tick], tick, tick + steps)

    def _infos(self, good: Bools, diverged: Bools) -> Info:
        infos: Info = {"time": np.where(good, self.view.time, 0.0), "_time": good.copy()}
        if self._env.spec_of_env.success is not None:
            success = np.asarray(self._values["success"](), np.bool_)
            infos |= {"is_success": success & good, "_is_success": good.copy()}
        for row in np.flatnonzero(diverged).tolist():
            time = self._sim.engine.clock.time(int(self._physics.tick[row]))
            infos = self._add_info(infos, {"time": time, "diverged": self._physics.divergence(row)}, row)
        return infos

    def close_extras(self, **kwargs: object) -> None:
        """Close the world."""
        self._env.close()
