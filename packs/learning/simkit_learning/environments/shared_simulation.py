"""Environments that take turns in one simulation: each is a state of it, which is restored for its next step."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
import numpy.typing as npt

from simkit.runtime.array_rules import CannotBatchError
from simkit_learning.environments.environment import EpisodeState, SimulationEnv
from simkit_learning.environments.specification import EnvironmentSpec, Info, ResetOptions
from simkit_learning.sweeps.sweep_spec import split_values

if TYPE_CHECKING:
    from simkit_learning.environments.message_arrays import Array


class SharedSimulation:
    """Simulation in which several environments take turns.

    A turn takes as long as a step of a single environment and about 1 ms for the change of the state. An environment
    takes the memory of a state: 34 kB for a TurtleBot3.

    Args:
        spec: specification of the environments.
        render_mode, size: as for `SimulationEnv`.

    Raises:
        CannotBatchError: the environments cannot take turns.
    """

    def __init__(self, spec: EnvironmentSpec, render_mode: str | None, size: tuple[int, int]) -> None:
        self.env = SimulationEnv(spec, render_mode, size)
        self._present: TurnEnv | None = None
        reasons = obstacles_to_turns(self.env)
        if reasons:
            self.env.close()
            raise CannotBatchError("; ".join(reasons))

    def enter(self, turn: TurnEnv) -> SimulationEnv:
        """Bring the simulation into the state of an environment."""
        env, present = self.env, self._present
        if present is not turn:
            if present is not None:
                present.state = env.episode_state()
            if turn.state is not None:
                env.restore_episode(turn.state)
            self._present = turn
        return env


class TurnEnv(gymnasium.Env[Any, Any]):
    """One of several environments that take turns in one simulation; it behaves like a `SimulationEnv` of its own.

    Args:
        shared: simulation.
        seed: seed of the first episode without a seed in `reset`.

    Attributes:
        state: state after its last turn; None before the first reset.
    """

    def __init__(self, shared: SharedSimulation, seed: int) -> None:
        self._shared, self._seed = shared, seed
        env = shared.env
        self.observation_space, self.action_space = env.observation_space, env.action_space
        self.metadata, self.render_mode = env.metadata, env.render_mode
        self.state: EpisodeState | None = None
        self._is_seeded = False

    def reset(
        self, *, seed: int | None = None, options: ResetOptions | None = None
    ) -> tuple[Array | dict[str, Array], Info]:
        """Begin an episode, as `SimulationEnv.reset` does."""
        if seed is None and not self._is_seeded:
            seed = self._seed
        self._is_seeded = True
        return self._shared.enter(self).reset(seed=seed, options=options)

    def step(self, action: npt.ArrayLike) -> tuple[Array | dict[str, Array], float, bool, bool, Info]:
        """Make a step, as `SimulationEnv.step` does."""
        return self._shared.enter(self).step(action)

    def render(self) -> npt.NDArray[np.uint8] | None:
        """Return an image, as `SimulationEnv.render` does."""
        return self._shared.enter(self).render()

    def present(self) -> SimulationEnv:
        """Return the environment in the state of this one, until the turn of another one."""
        return self._shared.enter(self)

    def close(self) -> None:
        """Close the world of all environments; a second call has no effect."""
        self._shared.env.close()


def obstacles_to_turns(env: SimulationEnv) -> list[str]:
    """Return why copies of an environment cannot take turns in its simulation; empty if they can."""
    reasons = []
    if env.sim.nodes:
        reasons.append("nodes")
    if env.view.accumulates:
        reasons.append("expressions with counts or with values of the whole run")
    if split_values(env.values)[0]:
        reasons.append("randomise has values that change the world")
    return reasons
