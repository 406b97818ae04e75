"""Train a TurtleBot3 to reach goals among pillars, test it on unseen seeds, and keep its policy as NumPy arrays.

pip install "simkit-robotics[rl] @ git+https://github.com/simkit-robotics/simkit"
python packs/learning/examples/train_turtlebot3.py --minutes 15

The robot learns first in a world with steps of 5 ms and MuJoCo's own contacts, which is three times as fast. It learns
the last part in `turtlebot3_world` as it is, so that the policy fits the contacts of that world too.
"""

from __future__ import annotations

import argparse
import csv
import importlib.util
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

import simkit.gym
from simkit.install_command import install_command

try:
    import gymnasium
except ModuleNotFoundError:
    sys.exit(f"the training needs Gymnasium: {install_command('rl')}")

ENVIRONMENT = "simkit/TurtleBot3Goal-v0"
PERIOD = 0.2  # [s] between two actions
FAST = ("physics.max_step_size=0.005",)  # the environment has MuJoCo's contacts
FULL = ("physics.contact_law=simkit",)
POLICY = Path(__file__).parent / "turtlebot3_policy" / "policy.npz"
FAST_SHARE = 0.5  # part of the CPU time in the fast world
TEST_SEEDS = range(1_000_000, 1_000_100)  # training draws its episodes from the seeds 0, 1, …


def make(seed: int = 0, fast: bool = True) -> gymnasium.Env[Any, Any]:
    """Return the environment with one array of numbers from -1 to 1 as its observation."""
    env = simkit.gym.make(ENVIRONMENT, control_period=PERIOD, overrides=FAST if fast else FULL, seed=seed)
    flat = gymnasium.wrappers.FlattenObservation(env)
    return gymnasium.wrappers.RescaleObservation(flat, np.float32(-1.0), np.float32(1.0))


def train(minutes: float, seed: int, curve: Path) -> dict[str, np.ndarray]:
    """Train with PPO for `minutes` of CPU time, and return the weights of the policy."""
    import torch
    from stable_baselines3 import PPO
    from stable_baselines3.common.callbacks import BaseCallback
    from stable_baselines3.common.monitor import Monitor
    from stable_baselines3.common.vec_env import DummyVecEnv

    begun = time.process_time()

    def spent() -> float:
        return (time.process_time() - begun) / 60.0

    class Curve(BaseCallback):
        """Writes the share of successful episodes, and stops at the time limit of its world."""

        def __init__(self, world: str, until: float) -> None:
            super().__init__()
            self._world, self._until, self._ended = world, until, []

        def _on_step(self) -> bool:
            self._ended += [info for info in self.locals["infos"] if "episode" in info]
            return spent() < self._until

        def _on_rollout_end(self) -> None:
            recent = self._ended[-200:]
            success = np.mean([info["is_success"] for info in recent]) if recent else 0.0
            reward = np.mean([info["episode"]["r"] for info in recent]) if recent else 0.0
            row = (
                self.num_timesteps,
                round(spent(), 2),
                round(float(success), 3),
                round(float(reward), 2),
                self._world,
            )
            with curve.open("a", newline="") as file:
                csv.writer(file).writerow(row)
            print("steps {} minutes {} success {} reward {} world {}".format(*row), flush=True)

    def envs(fast: bool) -> DummyVecEnv:
        return DummyVecEnv([lambda number=number: Monitor(make(seed + number, fast)) for number in range(8)])

    torch.set_num_threads(1)
    with curve.open("w", newline="") as file:
        csv.writer(file).writerow(("steps", "minutes", "success", "reward", "world"))
    rate = lambda _: 3e-4 * max(0.1, 1.0 - spent() / minutes)  # noqa: E731
    model = PPO(
        "MlpPolicy", envs(True), n_steps=256, batch_size=256, n_epochs=10, gamma=0.99, learning_rate=rate,
        ent_coef=0.001, policy_kwargs={"net_arch": [64, 64]}, seed=seed, device="cpu",
    )  # fmt: skip
    model.learn(10**9, callback=Curve("fast", FAST_SHARE * minutes))
    model.set_env(envs(False))
    model.learn(10**9, callback=Curve("full", minutes), reset_num_timesteps=False)
    return weights_of(model)


def weights_of(model: Any) -> dict[str, np.ndarray]:
    """Return the weights of the three layers as arrays."""
    net = model.policy
    layers = [net.mlp_extractor.policy_net[0], net.mlp_extractor.policy_net[2], net.action_net]
    return {
        name: getattr(layer, kind).detach().numpy().copy()
        for number, layer in enumerate(layers)
        for name, kind in ((f"weight_{number}", "weight"), (f"bias_{number}", "bias"))
    }


def act(policy: dict[str, np.ndarray], observation: np.ndarray) -> np.ndarray:
    """Return the action of the policy without exploration."""
    values = observation
    for number in range(2):
        values = np.tanh(policy[f"weight_{number}"] @ values + policy[f"bias_{number}"])
    return np.clip(policy["weight_2"] @ values + policy["bias_2"], -1.0, 1.0)


def success_rate(policy: dict[str, np.ndarray], fast: bool, seeds: range) -> float:
    """Return the share of unseen seeds with which the robot reaches its goal."""
    env = make(fast=fast)
    reached = 0
    for seed in seeds:
        observation, info = env.reset(seed=seed)
        is_over = False
        while not is_over:
            observation, _, terminated, truncated, info = env.step(act(policy, observation))
            is_over = terminated or truncated
        reached += info["is_success"]
    env.close()
    return reached / len(seeds)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--minutes", type=float, default=15.0, help="CPU time of the training")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--curve", type=Path, default=Path("turtlebot3_curve.csv"))
    parser.add_argument("--test-only", action="store_true", help="test the stored policy")
    options = parser.parse_args()
    if options.test_only:
        policy = dict(np.load(POLICY))
    elif importlib.util.find_spec("stable_baselines3") is None:
        sys.exit(f"the training needs Stable-Baselines3: {install_command('rl')}")
    else:
        policy = train(options.minutes, options.seed, options.curve)
        np.savez(POLICY, **policy)
    for fast in (True, False):
        name = "the world of the training" if fast else "turtlebot3_world as it is"
        print(f"success in {name}: {success_rate(policy, fast, TEST_SEEDS):.0%} of {len(TEST_SEEDS)} unseen seeds")


if __name__ == "__main__":
    main()
