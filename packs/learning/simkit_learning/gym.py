"""Environments for learning, with the interface of Gymnasium (the extra `experiments`).

import simkit.gym

env = simkit.gym.make("simkit/TurtleBot3Goal-v0")
observation, info = env.reset(seed=1)
observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
"""

from __future__ import annotations

import importlib.util
from typing import TYPE_CHECKING, Any, Unpack

from simkit import RunSpec
from simkit.errors import InputError
from simkit.install_command import install_command
from simkit.run_spec import FilePath
from simkit_learning.environments.specification import (
    Autoreset,
    Batched,
    EnvironmentOptions,
    EnvironmentSpec,
    JointVelocities,
    Observation,
)

if TYPE_CHECKING:
    from simkit_learning.environments.batch_environment import BatchVectorEnv
    from simkit_learning.environments.environment import SimulationEnv

__all__ = ["Batched", "EnvironmentSpec", "JointVelocities", "Observation", "SimulationEnv", "make", "make_vec"]


def make(world: FilePath | RunSpec, **options: Unpack[EnvironmentOptions]) -> SimulationEnv:
    """Return a world as an environment of Gymnasium.

    Args:
        world: world as for `simkit.load`, a run specification, or a registered id such as `simkit/TurtleBot3Goal-v0`.
        options: fields of `EnvironmentSpec` (observation, action, reward, terminated, …), which replace those of a
            registered id; further `overrides` (`PATH=VALUE`), `seed`, `render_mode` ("rgb_array") and `size` of the
            images (width, height) [px].

    Raises:
        InputError: SK-GYM-001 to SK-GYM-003 an option is invalid; SK-INPUT-004 Gymnasium is not installed.
        LoadError: the world has errors.
    """
    _check_gymnasium("simkit.gym.make")
    from simkit_learning.environments.make import make_env

    return make_env(world, **options)


def make_vec(
    world: FilePath | RunSpec,
    *,
    num_envs: int,
    batch: bool | None = None,
    processes: bool | int | None = None,
    autoreset: Autoreset = "next_step",
    threads: int = 0,
    **options: Unpack[EnvironmentOptions],
) -> BatchVectorEnv | Any:
    """Return several environments of a world that step together: a vector environment of Gymnasium.

    Environment k has the results of `make` with the seed of the specification plus k. The page learning.md lists the
    parts of worlds and specifications that MuJoCo's batch can step, all environments in one call. If another part
    occurs, each environment has a process, and the attribute `not_batched` says why.

    Args:
        world: world, run specification or registered id.
        num_envs: number of environments.
        batch: True for a batch or an error; False for no batch; None for a batch where the parts allow it.
        processes: True runs each environment in a process of its own, with shared memory for observations. False runs
            all of them in the present process, one after another, each in a simulation of its own. With a number, so
            many processes have one simulation each, in which their environments take turns; 1 is the present process.
            None for a batch, or else a process for each environment, or for more than four environments for each
            processor, a process for each processor.
        autoreset: start of the next episode: "next_step", "same_step" or "disabled", as Gymnasium defines these words.
        threads: number of threads of a batch; 0 for all processors.
        options: options of `make`.

    Raises:
        InputError: SK-GYM-001 to SK-GYM-003 an option is invalid; SK-INPUT-004 Gymnasium is not installed.
    """
    _check_gymnasium("simkit.gym.make_vec")
    from simkit_learning.environments.make import make_vector_env

    return make_vector_env(
        world, num_envs, batch=batch, processes=processes, autoreset=autoreset, threads=threads, **options
    )


def _check_gymnasium(user: str) -> None:
    if importlib.util.find_spec("gymnasium") is None:
        text = f"{user} needs Gymnasium, which is missing"
        raise InputError("SK-INPUT-004", text, help=install_command("experiments"))


def _register() -> None:
    """Register the ids, so that `gymnasium.make` finds them after `import simkit.gym`."""
    if importlib.util.find_spec("gymnasium") is not None:
        from simkit_learning.environments.make import register_ids

        register_ids()


def __getattr__(name: str) -> type[SimulationEnv]:
    if name == "SimulationEnv":  # imported lazily: it needs Gymnasium
        _check_gymnasium("simkit.gym.SimulationEnv")
        from simkit_learning.environments.environment import SimulationEnv

        return SimulationEnv
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


_register()
