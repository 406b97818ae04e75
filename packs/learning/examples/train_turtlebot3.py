"""Train a TurtleBot3 to reach goals among pillars, test it on unseen seeds, and keep its policy as NumPy arrays.

pip install "simkit-robotics[experiments] @ git+https://github.com/simkit-robotics/simkit"
python packs/learning/examples/train_turtlebot3.py

The learning algorithm is PPO (Schulman et al. 2017) with two small networks, in NumPy alone. The robot learns in a
batch of environments with steps of 5 ms and MuJoCo's own contacts. The test also uses `turtlebot3_world` as it is, with
steps of 1 ms and simkit's contact law.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # these matrices are too small for threads

import argparse
import csv
import itertools
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
    sys.exit(f"the training needs Gymnasium: {install_command('experiments')}")

ENVIRONMENT = "simkit/TurtleBot3Goal-v0"
PERIOD = 0.2  # [s] between two actions
FAST = ("physics.max_step_size=0.005",)  # the environment has MuJoCo's contacts
FULL = ("physics.contact_law=simkit",)
POLICY = Path(__file__).parent / "turtlebot3_policy" / "policy.npz"
TEST_SEEDS = range(1_000_000, 1_000_100)  # training draws its episodes from the seeds 0, 1, …

ENVIRONMENTS, LENGTH = 64, 64  # environments, and steps of each between two updates
EPOCHS, BATCH = 8, 512  # passes over the samples of an update, and samples of a step of the optimiser
DISCOUNT, TRACE = 0.99, 0.95  # of rewards, and of the errors of the value (GAE's lambda)
CLIP, RATE, ENTROPY = 0.2, 5e-4, 0.001
LAYERS = 3

Weights = dict[str, np.ndarray]


def make(seed: int = 0, fast: bool = True) -> gymnasium.Env[Any, Any]:
    """Return the environment with one array of numbers from -1 to 1 as its observation."""
    env = simkit.gym.make(ENVIRONMENT, control_period=PERIOD, overrides=FAST if fast else FULL, seed=seed)
    flat = gymnasium.wrappers.FlattenObservation(env)
    return gymnasium.wrappers.RescaleObservation(flat, np.float32(-1.0), np.float32(1.0))


class Network:
    """Network of three layers with `tanh` between them, and Adam's averages of its gradients."""

    def __init__(self, random: np.random.Generator, sizes: tuple[int, ...], last: float) -> None:
        self.weights: Weights = {}
        for n, (inputs, outputs) in enumerate(itertools.pairwise(sizes)):
            matrix = np.linalg.qr(random.standard_normal((max(inputs, outputs), min(inputs, outputs))))[0]
            matrix = matrix if outputs >= inputs else matrix.T
            gain = last if n == LAYERS - 1 else np.sqrt(2.0)
            self.weights[f"weight_{n}"] = (gain * matrix).astype(np.float32)
            self.weights[f"bias_{n}"] = np.zeros(outputs, np.float32)
        self.inputs: list[np.ndarray] = []

    def forward(self, values: np.ndarray) -> np.ndarray:
        """Return the outputs for rows of inputs."""
        self.inputs = []
        for n in range(LAYERS):
            self.inputs.append(values)
            values = values @ self.weights[f"weight_{n}"].T + self.weights[f"bias_{n}"]
            values = np.tanh(values) if n < LAYERS - 1 else values
        return values

    def backward(self, slope: np.ndarray) -> Weights:
        """Return the gradients for the last inputs, from the gradient by the outputs."""
        gradients: Weights = {}
        for n in reversed(range(LAYERS)):
            gradients[f"weight_{n}"], gradients[f"bias_{n}"] = slope.T @ self.inputs[n], slope.sum(axis=0)
            slope = slope @ self.weights[f"weight_{n}"] * (1.0 - self.inputs[n] ** 2)
        return gradients


class Adam:
    """Steps along the averaged gradients of some arrays, which are changed in place."""

    def __init__(self, weights: Weights) -> None:
        self.weights, self.count = weights, 0
        self.means = {name: (np.zeros_like(values), np.zeros_like(values)) for name, values in weights.items()}

    def step(self, gradients: Weights, rate: float, most: float = 0.5) -> None:
        """Make a step, with gradients of the length `most` or less."""
        self.count += 1
        length = float(np.sqrt(sum(np.sum(values**2) for values in gradients.values())))
        for name, values in gradients.items():
            values = values * min(1.0, most / (length + 1e-8))
            mean, square = self.means[name]
            mean += 0.1 * (values - mean)
            square += 0.001 * (values**2 - square)
            by_count = np.sqrt(1.0 - 0.999**self.count) / (1.0 - 0.9**self.count)
            self.weights[name] -= rate * by_count * mean / (np.sqrt(square) + 1e-7)


class Learner:
    """Policy, value and their optimisers."""

    def __init__(self, seed: int, inputs: int, outputs: int) -> None:
        self.random = np.random.default_rng(seed)
        self.policy = Network(self.random, (inputs, 64, 64, outputs), 0.01)
        self.value = Network(self.random, (inputs, 64, 64, 1), 1.0)
        self.policy.weights["spread"] = np.zeros(outputs, np.float32)  # logarithm of the standard deviation
        self.steps = Adam(self.policy.weights), Adam(self.value.weights)

    def act(self, observations: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return random actions and the logarithms of their probabilities."""
        mean, spread = self.policy.forward(observations), self.policy.weights["spread"]
        noise = self.random.standard_normal(mean.shape, np.float32)
        return mean + np.exp(spread) * noise, -0.5 * (noise**2).sum(axis=1) - spread.sum()

    def update(self, samples: dict[str, np.ndarray], rate: float) -> None:
        """Improve policy and value by the samples of all environments."""
        count = len(samples["observation"])
        for _ in range(EPOCHS):
            order = self.random.permutation(count)
            for first in range(0, count, BATCH):
                rows = order[first : first + BATCH]
                self._step({name: values[rows] for name, values in samples.items()}, rate)

    def _step(self, samples: dict[str, np.ndarray], rate: float) -> None:
        count, advantage = len(samples["action"]), samples["advantage"]
        advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
        mean, spread = self.policy.forward(samples["observation"]), self.policy.weights["spread"]
        apart = (samples["action"] - mean) / np.exp(spread)
        ratio = np.exp(-0.5 * (apart**2).sum(axis=1) - spread.sum() - samples["logarithm"])
        is_clipped = np.where(advantage > 0.0, ratio > 1.0 + CLIP, ratio < 1.0 - CLIP)
        pull = np.where(is_clipped, 0.0, advantage * ratio)[:, None] / count
        gradients = self.policy.backward((-pull * apart / np.exp(spread)).astype(np.float32))
        gradients["spread"] = (-pull * (apart**2 - 1.0)).sum(axis=0) - ENTROPY
        self.steps[0].step(gradients, rate)
        error = self.value.forward(samples["observation"])[:, 0] - samples["return"]
        self.steps[1].step(self.value.backward((error / count).astype(np.float32)[:, None]), rate)


def flat(observation: dict[str, np.ndarray], space: gymnasium.spaces.Dict) -> np.ndarray:
    """Return the observations of all environments as rows of numbers from -1 to 1."""
    rows = [2.0 * (observation[name] - box.low) / (box.high - box.low) - 1.0 for name, box in space.items()]
    return np.concatenate(rows, axis=-1).astype(np.float32)


def train(steps: int, seed: int, curve: Path) -> Weights:
    """Train for a number of steps of all environments together, and return the weights of the policy."""
    envs = simkit.gym.make_vec(
        ENVIRONMENT, num_envs=ENVIRONMENTS, batch=True, autoreset="same_step",
        control_period=PERIOD, overrides=FAST, seed=seed,
    )  # fmt: skip
    space, begun, ended = envs.single_observation_space, time.process_time(), []
    now = flat(envs.reset()[0], space)
    learner = Learner(seed, now.shape[1], envs.single_action_space.shape[0])
    updates = steps // (ENVIRONMENTS * LENGTH)
    with curve.open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(("steps", "cpu_minutes", "success", "spread"))
        for update in range(updates):
            samples, now = collect(envs, learner, now, ended)
            learner.update(samples, RATE * max(0.05, 1.0 - update / updates))
            success = float(np.mean(ended[-500:])) if ended else 0.0
            minutes = (time.process_time() - begun) / 60.0
            spread = float(np.exp(learner.policy.weights["spread"]).mean())
            row = ((update + 1) * ENVIRONMENTS * LENGTH, round(minutes, 2), round(success, 3), round(spread, 3))
            table.writerow(row)
            file.flush()
            print("steps {} minutes {} success {} spread {}".format(*row), flush=True)
    envs.close()
    return {name: values for name, values in learner.policy.weights.items() if name != "spread"}


def collect(
    envs: gymnasium.vector.VectorEnv[Any, Any, Any], learner: Learner, now: np.ndarray, ended: list[bool]
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Make some steps, and return their samples and the present observations."""
    space, shape = envs.single_observation_space, (LENGTH, envs.num_envs)
    observation = np.empty((LENGTH, *now.shape), np.float32)
    action = np.empty((*shape, envs.single_action_space.shape[0]), np.float32)
    logarithm, reward, value, after = (np.zeros(shape, np.float32) for _ in range(4))
    goes_on = np.ones(shape, np.float32)
    for step in range(LENGTH):
        observation[step], value[step] = now, learner.value.forward(now)[:, 0]
        action[step], logarithm[step] = learner.act(now)
        seen, reward[step], terminated, truncated, infos = envs.step(np.clip(action[step], -1.0, 1.0))
        now = flat(seen, space)
        after[step] = learner.value.forward(now)[:, 0]
        for row in np.flatnonzero(terminated | truncated).tolist():
            ended.append(bool(infos["final_info"]["is_success"][row]))
            goes_on[step, row] = 0.0
            last = {name: infos["final_obs"][row][name] for name in space}
            after[step, row] = 0.0 if terminated[row] else learner.value.forward(flat(last, space)[None])[0, 0]
    advantage, trace = np.empty(shape, np.float32), np.zeros(envs.num_envs, np.float32)
    for step in reversed(range(LENGTH)):
        error = reward[step] + DISCOUNT * after[step] - value[step]
        trace = error + DISCOUNT * TRACE * goes_on[step] * trace
        advantage[step] = trace
    samples = {"observation": observation, "action": action, "logarithm": logarithm, "advantage": advantage}
    samples["return"] = advantage + value
    return {name: values.reshape(-1, *values.shape[2:]) for name, values in samples.items()}, now


def draw(curve: Path, picture: Path) -> None:
    """Draw the share of successful episodes over the processor time, as SVG."""
    with curve.open(newline="") as file:
        rows = [(float(row["cpu_minutes"]), float(row["success"])) for row in csv.DictReader(file)]
    last = max(minutes for minutes, _ in rows)
    line = " ".join(f"{50 + 370 * minutes / last:.1f},{180 - 160 * success:.1f}" for minutes, success in rows)
    levels = [(share, 180 - 1.6 * share) for share in range(0, 101, 25)]
    parts = [f'<path d="M50 {y}H420" stroke="#ddd"/><text x="44" y="{y + 4}">{share} %</text>' for share, y in levels]
    parts.append(f'<polyline points="{line}" fill="none" stroke="#1f77b4" stroke-width="2"/>')
    parts.append(f'<text x="50" y="196">0</text><text x="420" y="196">{last:.1f} min of processor time</text>')
    style = 'font-family="sans-serif" font-size="11" text-anchor="end"'
    size = 'width="440" height="205" viewBox="0 0 440 205"'
    start = f'<svg xmlns="http://www.w3.org/2000/svg" {size} {style}><rect width="440" height="205" fill="white"/>'
    picture.write_text("\n".join((start, *parts, "</svg>\n")), encoding="utf-8")


def act(policy: Weights, observation: np.ndarray) -> np.ndarray:
    """Return the action of the policy without exploration."""
    values = observation
    for number in range(LAYERS - 1):
        values = np.tanh(policy[f"weight_{number}"] @ values + policy[f"bias_{number}"])
    return np.clip(policy["weight_2"] @ values + policy["bias_2"], -1.0, 1.0)


def success_rate(policy: Weights, fast: bool, seeds: range) -> float:
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
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--curve", type=Path, default=Path("turtlebot3_curve.csv"))
    parser.add_argument("--picture", type=Path, default=Path("turtlebot3_curve.svg"), help="curve as SVG")
    parser.add_argument("--policy", type=Path, default=POLICY, help="file of the weights")
    parser.add_argument("--test-only", action="store_true", help="test the stored policy")
    options = parser.parse_args()
    if not options.test_only:
        begun = time.perf_counter(), time.process_time()
        policy = train(options.steps, options.seed, options.curve)
        np.savez(options.policy, **policy)
        draw(options.curve, options.picture)
        wall, spent = time.perf_counter() - begun[0], time.process_time() - begun[1]
        print(f"trained in {wall:.0f} s with {spent:.0f} s of processor time")
    policy = dict(np.load(options.policy))
    for fast in (True, False):
        name = "the world of the training" if fast else "turtlebot3_world as it is"
        print(f"success in {name}: {success_rate(policy, fast, TEST_SEEDS):.0%} of {len(TEST_SEEDS)} unseen seeds")


if __name__ == "__main__":
    main()
