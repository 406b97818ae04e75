"""Environments by world or by registered id, one or several."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from functools import partial
from typing import Any, Final, Literal

import gymnasium

from simkit.diagnostics import did_you_mean, shorten
from simkit.experiments.environments.batch_environment import BatchVectorEnv
from simkit.experiments.environments.cannot_batch import CannotBatchError
from simkit.experiments.environments.environment import SimulationEnv
from simkit.experiments.environments.specification import EnvironmentSpec, invalid
from simkit.experiments.environments.tiago_tasks import pick_spec, reach_spec
from simkit.experiments.environments.turtlebot3_tasks import goal_spec, maze_spec
from simkit.experiments.sweeps.sweep_spec import spec_of_world
from simkit.run_spec import FilePath, RunSpec
from simkit.scene.overrides import override_texts

IDS: Final[Mapping[str, Callable[[], EnvironmentSpec]]] = {
    "simkit/TurtleBot3Goal-v0": goal_spec,
    "simkit/TurtleBot3Maze-v0": maze_spec,
    "simkit/TiagoReach-v0": reach_spec,
    "simkit/TiagoPick-v0": pick_spec,
}
"""Functions of the registered environments by id."""

_LOG: Final = logging.getLogger("simkit.gym")

Autoreset = Literal["next_step", "same_step", "disabled"]
_FIELDS: Final = tuple(one.name for one in fields(EnvironmentSpec) if one.name != "run")


def environment_spec(world: FilePath | RunSpec, changes: Mapping[str, Any]) -> EnvironmentSpec:
    """Return the specification of a world or of a registered id, with changes.

    Raises:
        InputError: SK-GYM-001 an argument is unknown or missing, or no environment has this id.
    """
    changes = dict(changes)
    overrides, seed = tuple(override_texts(changes.pop("overrides", ()))), changes.pop("seed", None)
    if seed is not None and (isinstance(seed, bool) or not isinstance(seed, int)):
        raise invalid(f"seed: found {seed!r}; expected a whole number")
    if not isinstance(world, (str, os.PathLike, RunSpec)):
        raise invalid(f"world: found {shorten(repr(world), 60)}; expected a world, a RunSpec or a registered id")
    for name in changes:
        if name not in _FIELDS:
            allowed = [*_FIELDS, "overrides", "seed", "render_mode", "size"]
            hint = did_you_mean(name, allowed) or f"allowed: {', '.join(allowed)}"
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
            raise invalid(f"{' and '.join(missing)} missing", "docs/learning.md has an example")
        spec = EnvironmentSpec(spec_of_world(world, None, ""), **changes)
    run = replace(spec.run, overrides=(*spec.run.overrides, *overrides))
    return replace(spec, run=run if seed is None else replace(run, seed=seed))


def make_env(
    world: FilePath | RunSpec,
    *,
    render_mode: str | None = None,
    size: tuple[int, int] = (480, 360),
    **changes: Any,
) -> SimulationEnv:
    """Return one environment; see `simkit.gym.make`."""
    return SimulationEnv(environment_spec(world, changes), render_mode, size)


def make_vector_env(
    world: FilePath | RunSpec,
    num_envs: int,
    *,
    batch: bool | None = None,
    processes: bool | None = None,
    autoreset: Autoreset = "next_step",
    threads: int = 0,
    **changes: Any,
) -> gymnasium.vector.VectorEnv[Any, Any, Any]:
    """Return several environments that step together; see `simkit.gym.make_vec`."""
    if isinstance(num_envs, bool) or not isinstance(num_envs, int) or num_envs < 1:
        raise invalid(f"num_envs: found {num_envs!r}; expected a whole number of at least 1")
    if isinstance(threads, bool) or not isinstance(threads, int) or threads < 0:
        raise invalid(f"threads: found {threads!r}; expected a whole number of at least 0")
    for name, flag in (("batch", batch), ("processes", processes)):
        if flag not in (None, True, False):
            raise invalid(f"{name}: found {flag!r}; expected True, False or None")
    if batch and processes is not None:
        raise invalid("batch=True and processes exclude each other")
    modes = {mode.name.lower(): mode for mode in gymnasium.vector.AutoresetMode}
    if autoreset not in modes:
        raise invalid(f"autoreset: found {autoreset!r}; expected one of {', '.join(modes)}")
    options = {name: changes.pop(name) for name in ("render_mode", "size") if name in changes}
    spec, reason = environment_spec(world, changes), ""
    if batch or (batch is None and processes is None):
        try:
            return BatchVectorEnv(spec, num_envs, modes[autoreset], options.get("render_mode"), threads)
        except CannotBatchError as error:
            reason = str(error)
            if batch:
                raise invalid(f"the environments cannot step as a batch: {reason}", "leave out batch=True") from None
            _LOG.info("make_vec uses a process for each environment: %s", reason)
    makers = [
        partial(SimulationEnv, replace(spec, run=replace(spec.run, seed=spec.run.seed + number)), **options)
        for number in range(num_envs)
    ]
    vector: Any
    if processes is None or processes:
        vector = gymnasium.vector.AsyncVectorEnv(makers, shared_memory=True, autoreset_mode=modes[autoreset])
    else:
        vector = gymnasium.vector.SyncVectorEnv(makers, autoreset_mode=modes[autoreset])
    vector.not_batched = reason
    return vector  # type: ignore[no-any-return]


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
