"""Vector environment of a few processes, in each of which environments take turns in one simulation."""

from __future__ import annotations

import contextlib
import gc
import itertools
import pickle
from collections.abc import Sequence
from functools import partial
from multiprocessing.connection import Connection
from multiprocessing.context import BaseContext
from typing import Any, Final, cast

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from gymnasium.vector.utils import CloudpickleWrapper, batch_space, concatenate, create_empty_array, iterate

from simkit.extend import counted
from simkit_learning.environments.message_arrays import Array
from simkit_learning.environments.shared_simulation import SharedSimulation, TurnEnv
from simkit_learning.environments.specification import EnvironmentSpec, Info, ResetOptions, invalid

_PATIENCE: Final = 10.0  # [s] wall time that a process gets to end

Size = tuple[int, int]
"""Width and height of the images of `render` [px]."""


def turns_in_this_process(
    spec: EnvironmentSpec, count: int, mode: AutoresetMode, render_mode: str | None, size: Size, first: int = 0
) -> SyncVectorEnv:
    """Return environments that take turns in one simulation of the present process.

    Args:
        spec: specification; environment k has its seed plus `first` plus k.
        count: number of environments.
        mode: start of the next episode.
        render_mode: as for `SimulationEnv`.
        size: as for `SimulationEnv`.
        first: number of the first environment.

    Raises:
        CannotBatchError: the environments cannot take turns.
    """
    shared = SharedSimulation(spec, render_mode, size)
    seeds = range(spec.run.seed + first, spec.run.seed + first + count)
    return SyncVectorEnv([partial(TurnEnv, shared, seed) for seed in seeds], autoreset_mode=mode)


class SharedVectorEnv(gymnasium.vector.VectorEnv[Any, Any, Any]):
    """Environments in a few processes, each of which steps its share in one simulation.

    An environment has the results of a single one, bit for bit, whatever the number of processes.

    Args:
        spec: specification; environment k has its seed plus k.
        num_envs: number of environments.
        processes: number of processes.
        autoreset: start of the next episode.
        render_mode, size: as for `SimulationEnv`.
        context: context that starts the processes.

    Raises:
        CannotBatchError: the environments cannot take turns.
    """

    def __init__(
        self,
        spec: EnvironmentSpec,
        num_envs: int,
        processes: int,
        autoreset: AutoresetMode,
        render_mode: str | None,
        size: Size,
        context: BaseContext,
    ) -> None:
        env = SharedSimulation(spec, render_mode, size).env
        env.close()
        self.num_envs, self.render_mode = num_envs, render_mode
        self.metadata = {**env.metadata, "autoreset_mode": autoreset}
        self.single_observation_space, self.single_action_space = env.observation_space, env.action_space
        self.observation_space = batch_space(env.observation_space, num_envs)
        self.action_space = batch_space(env.action_space, num_envs)
        self._observation: Any = create_empty_array(env.observation_space, num_envs)
        bounds = [num_envs * part // processes for part in range(processes + 1)]
        self._places = [slice(low, high) for low, high in itertools.pairwise(bounds)]
        self._calls = 0
        self._pipes: list[Connection] = []
        self._processes: list[Any] = []
        for place in self._places:
            mine, other = context.Pipe()
            count = place.stop - place.start
            make = partial(turns_in_this_process, spec, count, autoreset, render_mode, size, place.start)
            process = context.Process(  # type: ignore[attr-defined]
                target=_serve, args=(CloudpickleWrapper(cast(Any, make)), other, mine), daemon=True
            )
            process.start()
            other.close()
            self._pipes.append(mine)
            self._processes.append(process)

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: ResetOptions | None = None
    ) -> tuple[Array | dict[str, Array], Info]:
        """Begin an episode in all environments, or in those of `options["reset_mask"]`; see `BatchVectorEnv.reset`."""
        seeds: Sequence[int | None]
        if seed is None or isinstance(seed, (int, np.integer)):
            seeds = [None if seed is None else int(seed) + row for row in range(self.num_envs)]
        elif len(seed) == self.num_envs:
            seeds = seed
        else:
            raise invalid(
                f"seed: found {counted(len(seed), 'seed')}; expected one number, or {counted(self.num_envs, 'seed')}"
            )
        mask = None if options is None else options.get("reset_mask")
        calls: list[dict[str, Any] | None] = []
        for place in self._places:
            part = None if options is None else dict(options)
            if mask is not None and part is not None:
                part["reset_mask"] = np.asarray(mask)[place]
            resets = mask is None or bool(np.asarray(mask)[place].any())
            calls.append({"seed": list(seeds[place]), "options": part} if resets else None)
        results = self._call("reset", calls)
        self._store([None if result is None else result[0] for result in results])
        parts = zip(self._places, results, strict=True)
        infos = _merged([(place, result[1]) for place, result in parts if result is not None], self.num_envs)
        return self._copied(), infos

    def step(
        self, actions: npt.ArrayLike
    ) -> tuple[Array | dict[str, Array], npt.NDArray[np.float64], npt.NDArray[np.bool_], npt.NDArray[np.bool_], Info]:
        """Make a step of all environments."""
        values = np.asarray(actions)
        if values.shape[:1] != (self.num_envs,):
            raise invalid(
                f"found actions of the shape {values.shape}; expected {counted(self.num_envs, 'row')}",
                code="SK-GYM-004",
            )
        results = self._call("step", [{"actions": values[place]} for place in self._places])
        self._store([result[0] for result in results])
        rewards, terminated, truncated = (np.concatenate([r[item] for r in results]) for item in (1, 2, 3))
        parts = zip(self._places, results, strict=True)
        infos = _merged([(place, result[4]) for place, result in parts], self.num_envs)
        return self._copied(), rewards, terminated, truncated, infos

    def render(self) -> tuple[Any, ...]:
        """Return the images of all environments."""
        return tuple(image for images in self._call("render", [{} for _ in self._places]) for image in images)

    def close_extras(self, **kwargs: object) -> None:
        """End the processes."""
        for pipe in self._pipes:
            with contextlib.suppress(OSError):
                pipe.send((0, "close", {}))
            pipe.close()
        for process in reversed(self._processes):  # a fork also has the pipes of the processes before it
            process.join(_PATIENCE)
            if process.is_alive():
                process.terminate()
                process.join()

    def _call(self, name: str, calls: Sequence[dict[str, Any] | None]) -> list[Any]:
        """Call a method in the processes, and return their results; None for a process without a call."""
        if self.closed:
            raise invalid("the environment is closed", "make it again with simkit.gym.make_vec", "SK-GYM-005")
        self._calls += 1
        for pipe, arguments in zip(self._pipes, calls, strict=True):
            if arguments is not None:
                with contextlib.suppress(OSError):  # of a process that has ended, as `_received` reports
                    pipe.send((self._calls, name, arguments))
        results, failure = [], None
        for pipe, arguments in zip(self._pipes, calls, strict=True):
            error, result = (None, None) if arguments is None else _received(pipe, self._calls)
            failure = failure or error
            results.append(result)
        if failure is not None:
            raise failure
        return results

    def _store(self, parts: Sequence[Any]) -> None:
        """Store the observations of the processes; None keeps those of a process."""
        rows: list[Any] = list(iterate(self.observation_space, self._observation))
        for place, part in zip(self._places, parts, strict=True):
            if part is not None:
                space = batch_space(self.single_observation_space, place.stop - place.start)
                rows[place] = list(iterate(space, part))
        empty: Any = create_empty_array(self.single_observation_space, self.num_envs)
        self._observation = concatenate(self.single_observation_space, rows, empty)

    def _copied(self) -> Any:
        observation: Any = self._observation
        if isinstance(observation, dict):
            return {name: values.copy() for name, values in observation.items()}
        return observation.copy()


def _merged(parts: Sequence[tuple[slice, Info]], count: int) -> Info:
    """Return the infos of all environments from those of the processes."""
    merged: Info = {}
    for name in dict.fromkeys(name for _, infos in parts for name in infos):
        found = [(place, infos[name]) for place, infos in parts if name in infos]
        if isinstance(found[0][1], dict):
            merged[name] = _merged(found, count)
            continue
        first = np.asarray(found[0][1])
        shape = (count, *first.shape[1:])
        values = np.full(shape, None, object) if first.dtype == object else np.zeros(shape, first.dtype)
        for place, part in found:
            values[place] = part
        merged[name] = values
    return merged


# ---------------------------------------------------------------------- the processes


def _received(pipe: Connection, number: int) -> tuple[BaseException | None, Any]:
    """Return the error or the result of a call; answers to earlier calls, which Ctrl-C has interrupted, are dropped."""
    try:
        while True:
            answered, error, result = pipe.recv()
            if answered == number:
                return error, result
    except (EOFError, OSError):
        return invalid("a process of the environments has ended", "look at its last output"), None


def _serve(make: CloudpickleWrapper[Any], pipe: Connection, callers_end: Connection) -> None:
    """Serve calls of the methods of a vector environment, until it is closed or its process has ended."""
    gc.freeze()  # objects of the caller are not deleted here, because their threads are not in this process
    callers_end.close()  # else the pipe would stay open after the end of the caller
    envs: SyncVectorEnv | None = None
    try:
        while True:
            number, name, arguments = pipe.recv()
            if name == "close":
                return
            try:
                envs = make() if envs is None else envs
                answer: tuple[int, BaseException | None, Any] = number, None, getattr(envs, name)(**arguments)
                pipe.send(answer)
            except Exception as error:  # noqa: BLE001 - raised again by the caller
                pipe.send((number, _portable(error), None))
    except (EOFError, OSError, KeyboardInterrupt):
        return
    finally:
        if envs is not None:
            envs.close()


def _portable(error: Exception) -> Exception:
    """Return an error that can be sent to another process."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:  # noqa: BLE001 - any error of a class of the user
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error
