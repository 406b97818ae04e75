"""Environments by world or by registered id, one or several."""

from __future__ import annotations

import gc
import logging
import multiprocessing
import os
import threading
from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from functools import partial
from typing import Any, Final, Unpack

import gymnasium

from simkit import RunSpec
from simkit.diagnostics import shorten
from simkit.extend import did_you_mean
from simkit.run_spec import FilePath
from simkit.runtime.array_rules import CannotBatchError
from simkit.scene.overrides import override_texts
from simkit.sensors.cameras.rendering.render_thread import usable_cores
from simkit_learning.environments.batch_environment import BatchVectorEnv
from simkit_learning.environments.environment import IMAGE_SIZE, SimulationEnv
from simkit_learning.environments.shared_vector import SharedVectorEnv, turns_in_this_process
from simkit_learning.environments.specification import Autoreset, EnvironmentOptions, EnvironmentSpec, invalid
from simkit_learning.environments.tiago_tasks import pick_spec, reach_spec
from simkit_learning.environments.turtlebot3_tasks import goal_spec, maze_spec
from simkit_learning.sweeps.sweep_spec import spec_of_world

IDS: Final[Mapping[str, Callable[[], EnvironmentSpec]]] = {
    "simkit/TurtleBot3Goal-v0": goal_spec,
    "simkit/TurtleBot3Maze-v0": maze_spec,
    "simkit/TiagoReach-v0": reach_spec,
    "simkit/TiagoPick-v0": pick_spec,
}
"""Functions of the registered environments by id."""

_LOG: Final = logging.getLogger("simkit.gym")
_OF_RUN_AND_IMAGES: Final = ("overrides", "seed", "render_mode", "size")
_MOST_PROCESSES: Final = 4  # processes for each processor above which environments share them
_OPTIONS: Final = (*(field.name for field in fields(EnvironmentSpec) if field.name != "run"), *_OF_RUN_AND_IMAGES)


def environment_spec(world: FilePath | RunSpec, options: EnvironmentOptions) -> EnvironmentSpec:
    """Return the specification of a world or of a registered id, with changed fields.

    Raises:
        InputError: SK-GYM-001 an argument is unknown or missing, or no environment has this id.
    """
    overrides, seed = tuple(override_texts(options.get("overrides", ()))), options.get("seed")
    changes: dict[str, Any] = {name: value for name, value in options.items() if name not in _OF_RUN_AND_IMAGES}
    if seed is not None and (isinstance(seed, bool) or not isinstance(seed, int)):
        raise invalid(f"seed: found {seed!r}; expected a whole number")
    if not isinstance(world, (str, os.PathLike, RunSpec)):
        raise invalid(f"world: found {shorten(repr(world), 60)}; expected a world, a RunSpec or a registered id")
    for name in changes:
        if name not in _OPTIONS:
            hint = did_you_mean(name, _OPTIONS) or f"allowed: {', '.join(_OPTIONS)}"
            raise invalid(f"found the argument {name!r}; {hint}")
    if isinstance(world, str) and world.startswith("simkit/"):
        if world not in IDS:
            raise invalid(
                f"no environment has the id {world!r}", did_you_mean(world, IDS) or f"available: {', '.join(IDS)}"
            )
        spec = replace(IDS[world](), **changes)
    else:
        missing = [name for name in ("observation", "action") if name not in changes]
        if missing:
            raise invalid(f"{' and '.join(missing)} missing", "the page learning.md has an example")
        spec = EnvironmentSpec(spec_of_world(world, None, ""), **changes)
    run = replace(spec.run, overrides=(*spec.run.overrides, *overrides))
    return replace(spec, run=run if seed is None else replace(run, seed=seed))


def make_env(world: FilePath | RunSpec, **options: Unpack[EnvironmentOptions]) -> SimulationEnv:
    """Return one environment; see `simkit.gym.make`."""
    spec = environment_spec(world, options)
    return SimulationEnv(spec, options.get("render_mode"), options.get("size", IMAGE_SIZE))


def make_vector_env(
    world: FilePath | RunSpec,
    num_envs: int,
    *,
    batch: bool | None = None,
    processes: bool | int | None = None,
    autoreset: Autoreset = "next_step",
    threads: int = 0,
    **options: Unpack[EnvironmentOptions],
) -> BatchVectorEnv | Any:
    """Return several environments that step together; see `simkit.gym.make_vec`."""
    if isinstance(num_envs, bool) or not isinstance(num_envs, int) or num_envs < 1:
        raise invalid(f"num_envs: found {num_envs!r}; expected a whole number of at least 1")
    if isinstance(threads, bool) or not isinstance(threads, int) or threads < 0:
        raise invalid(f"threads: found {threads!r}; expected a whole number of at least 0")
    if batch not in (None, True, False):
        raise invalid(f"batch: found {batch!r}; expected True, False or None")
    if not (processes in (None, True, False) or (isinstance(processes, int) and processes >= 1)):
        raise invalid(f"processes: found {processes!r}; expected True, False, None or a whole number of at least 1")
    if batch and processes is not None:
        raise invalid("batch=True and processes exclude each other")
    modes = {mode.name.lower(): mode for mode in gymnasium.vector.AutoresetMode}
    if autoreset not in modes:
        raise invalid(f"autoreset: found {autoreset!r}; expected one of {', '.join(modes)}")
    spec, reason = environment_spec(world, options), ""
    render_mode, size = options.get("render_mode"), options.get("size", IMAGE_SIZE)
    if batch or (batch is None and processes is None):
        try:
            return BatchVectorEnv(spec, num_envs, modes[autoreset], render_mode, threads)
        except CannotBatchError as error:
            reason = str(error)
            if batch:
                raise invalid(f"the environments cannot step as a batch: {reason}", "leave out batch=True") from None
            _LOG.info("make_vec uses processes: %s", reason)
    shares, cores = 0, usable_cores()
    if not isinstance(processes, (bool, type(None))):
        shares = min(processes, num_envs)
    elif processes is None and num_envs > _MOST_PROCESSES * cores:
        shares = cores
    if shares:
        try:
            return _sharing(spec, num_envs, shares, modes[autoreset], render_mode, size, reason)
        except CannotBatchError as error:
            if processes is not None:
                raise invalid(f"the environments cannot take turns: {error}", "pass processes=True") from None
            reason = f"{reason}; the environments cannot take turns: {error}"
    makers = [
        partial(SimulationEnv, replace(spec, run=replace(spec.run, seed=spec.run.seed + number)), render_mode, size)
        for number in range(num_envs)
    ]
    vector: gymnasium.vector.VectorEnv[Any, Any, Any]
    if processes is None or processes:
        vector = gymnasium.vector.AsyncVectorEnv(
            makers, shared_memory=True, context=_start_method(), autoreset_mode=modes[autoreset]
        )
    else:
        vector = gymnasium.vector.SyncVectorEnv(makers, autoreset_mode=modes[autoreset])
    vars(vector)["not_batched"] = reason
    return vector


def _sharing(
    spec: EnvironmentSpec,
    count: int,
    processes: int,
    mode: gymnasium.vector.AutoresetMode,
    render_mode: str | None,
    size: tuple[int, int],
    reason: str,
) -> gymnasium.vector.VectorEnv[Any, Any, Any]:
    """Return environments that take turns in the simulations of some processes; one is the present process."""
    vector: gymnasium.vector.VectorEnv[Any, Any, Any]
    if processes == 1:
        vector = turns_in_this_process(spec, count, mode, render_mode, size)
    else:
        context = multiprocessing.get_context(_start_method())
        vector = SharedVectorEnv(spec, count, processes, mode, render_mode, size, context)
    vars(vector)["not_batched"] = reason
    return vector


def _start_method() -> str | None:
    """Return how processes start; None for Python's default.

    A process with other threads must not be copied: a lock that one of them holds would stay locked in the copy.
    """
    gc.collect()  # a copy that deleted an unused batch would wait for ever for the batch's threads
    if threading.active_count() == 1:
        return None
    return "forkserver" if "forkserver" in multiprocessing.get_all_start_methods() else "spawn"


def register_ids() -> None:
    """Register the environments, so that `gymnasium.make` finds them too."""
    for name in IDS:
        if name not in gymnasium.registry:
            gymnasium.register(
                name,
                entry_point=f"{__name__}:{make_env.__name__}",
                vector_entry_point=f"{__name__}:{make_vector_env.__name__}",
                kwargs={"world": name},
            )
