"""Train a TurtleBot3 to reach goals among pillars, test it on unseen seeds, and keep its policy as NumPy arrays.

pip install 'simkit-robotics[rl]'
python examples/train_turtlebot3.py --steps 300000

The robot learns in a world with steps of 5 ms and MuJoCo's own contacts, which is three times as fast, and is tested in
`turtlebot3_world` as it is.
"""

from __future__ import annotations

import argparse
import csv
import time
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

import simkit.gym

ENVIRONMENT = "simkit/TurtleBot3Goal-v0"
PERIOD = 0.2  # [s] between two actions
FAST = ("physics.max_step_size=0.005", "physics.contact_law=mujoco")
POLICY = Path(__file__).parent / "turtlebot3_policy" / "policy.npz"
TEST_SEEDS = range(1_000_000, 1_000_100)  # training draws its episodes from the seeds 0, 1, …


def make(seed: int = 0, fast: bool = True) -> gymnasium.Env[Any, Any]:
    """Return the environment with one array of numbers from -1 to 1 as its observation."""
    env = simkit.gym.make(ENVIRONMENT, control_period=PERIOD, overrides=FAST if fast else (), seed=seed)
    flat = gymnasium.wrappers.FlattenObservation(env)
    return gymnasium.wrappers.RescaleObservation(flat, np.float32(-1.0), np.float32(1.0))


def train(steps: int, minutes: float, seed: int, curve: Path) -> dict[str, np.ndarray]:
    """Train with PPO until the steps or the minutes are used up, and return the weights of the policy."""
    from stable_baselines3 import PPO
    from stable_baselines3.common.callbacks import BaseCallback
    from stable_baselines3.common.monitor import Monitor
    from stable_baselines3.common.vec_env import DummyVecEnv

    class Curve(BaseCallback):
        """Writes the share of successful episodes, and stops at the time limit."""

        def _on_training_start(self) -> None:
            self._begun, self._ended = time.process_time(), []
            with curve.open("w", newline="") as file:
                csv.writer(file).writerow(("steps", "minutes", "success", "reward"))

        def _on_step(self) -> bool:
            self._ended += [info for info in self.locals["infos"] if "episode" in info]
            return time.process_time() - self._begun < 60.0 * minutes

        def _on_rollout_end(self) -> None:
            recent = self._ended[-200:]
            success = np.mean([info["is_success"] for info in recent]) if recent else 0.0
            reward = np.mean([info["episode"]["r"] for info in recent]) if recent else 0.0
            spent = (time.process_time() - self._begun) / 60.0
            row = (self.num_timesteps, round(spent, 2), round(float(success), 3), round(float(reward), 2))
            with curve.open("a", newline="") as file:
                csv.writer(file).writerow(row)
            print("steps {} minutes {} success {} reward {}".format(*row), flush=True)
            np.savez(POLICY, **weights_of(self.model))

    envs = DummyVecEnv([lambda number=number: Monitor(make(seed + number)) for number in range(8)])
    model = PPO(
        "MlpPolicy", envs, n_steps=256, batch_size=256, n_epochs=10, gamma=0.99, learning_rate=3e-4, ent_coef=0.002,
        policy_kwargs={"net_arch": [64, 64]}, seed=seed, device="cpu",
    )  # fmt: skip
    model.learn(steps, callback=Curve())
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
    parser.add_argument("--steps", type=int, default=300_000, help="steps of all environments together")
    parser.add_argument("--minutes", type=float, default=15.0, help="CPU time of the training")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--curve", type=Path, default=Path("turtlebot3_curve.csv"))
    parser.add_argument("--test-only", action="store_true", help="test the stored policy")
    options = parser.parse_args()
    if options.test_only:
        policy = dict(np.load(POLICY))
    else:
        policy = train(options.steps, options.minutes, options.seed, options.curve)
        np.savez(POLICY, **policy)
    for fast in (True, False):
        name = "the world of the training" if fast else "turtlebot3_world as it is"
        print(f"success in {name}: {success_rate(policy, fast, TEST_SEEDS):.0%} of {len(TEST_SEEDS)} unseen seeds")


if __name__ == "__main__":
    main()
