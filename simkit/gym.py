"""Environments for learning, with the interface of Gymnasium (the extra `experiments`).

import simkit.gym

env = simkit.gym.make("simkit/TurtleBot3Goal-v0")
observation, info = env.reset(seed=1)
observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

This name stands for the module of the pack for learning. After the import, `gymnasium.make` finds the ids, too.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from simkit.facade import pack_module

if TYPE_CHECKING:
    from simkit.facade import Batched, EnvironmentSpec, JointVelocities, Observation, SimulationEnv, make, make_vec

__all__ = ["Batched", "EnvironmentSpec", "JointVelocities", "Observation", "SimulationEnv", "make", "make_vec"]

sys.modules[__name__] = pack_module(__name__)  # both names are one module, with its state and its lazy attributes
