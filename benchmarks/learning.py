"""Environments for learning beside a hand-written loop on bare MuJoCo, and their resets.

python benchmarks/learning.py [--rounds N]

One step is 0.1 s of `turtlebot3_world` with a fresh scan of 360 rays with noise. The loop uses the environment's
compiled model. CPU times; both sides take turns, so that the load of the machine is the same for both.
"""

from __future__ import annotations

import copy
import time
from collections.abc import Callable

import mujoco
import numpy as np
from measure import arguments

import simkit.gym

LAWS = {"MuJoCo's contacts": ("physics.contact_law=mujoco",), "simkit's contact law": ()}
SENSOR = "turtlebot3::base_scan::lds"
ACTION = (0.1, 0.4)


def environment(overrides: tuple[str, ...]) -> simkit.gym.SimulationEnv:
    return simkit.gym.make(
        "turtlebot3_world",
        observation="/scan",
        action={"/cmd_vel": {"linear.x": (0.0, 0.26), "angular.z": (-1.5, 1.5)}},
        reward=lambda env: -float(np.hypot(*env.sim.model("turtlebot3").pose.position[:2])),
        samples_all=False,
        overrides=overrides,
    )


def bare_loop(env: simkit.gym.SimulationEnv) -> Callable[[], object]:
    """The same period with MuJoCo and NumPy alone, driven by the environment's present wheel speeds."""
    sim = env.sim
    model, data, lidar = copy.copy(sim.mj_model), copy.copy(sim.mj_data), sim.sensor(SENSOR)
    random, fan = np.random.default_rng(0), lidar.fan
    count, low, high = fan.count, lidar.options.range_min, lidar.options.range_max
    ids, distances, rays = np.zeros(count, np.int32), np.zeros(count), np.zeros((count, 3))
    base, own = sim.link("turtlebot3::base_footprint")._body, fan.body or -1
    steps = round(0.1 / sim.timestep)

    def step() -> object:
        data.ctrl[:] = sim.mj_data.ctrl
        mujoco.mj_step(model, data, steps)
        mujoco.mj_forward(model, data)
        origin, rotation = lidar.ray_frame(data)
        np.matmul(fan.directions, rotation.T, out=rays)
        mujoco.mj_multiRay(
            model, data, origin, rays.reshape(-1), fan.groups, 1, own, ids, distances, None, count, fan.reach
        )
        scan = np.where((distances < 0) | (distances > high), high, distances)
        scan = np.clip(scan + 0.01 * random.standard_normal(count), low, high).astype(np.float32)
        return scan, -float(np.hypot(*data.xpos[base][:2])), False, False, {}

    return step


def interleaved(ours: Callable[[], object], bare: Callable[[], object], rounds: int) -> tuple[float, float]:
    """Medians of the CPU times [s] of both sides."""
    times: tuple[list[float], list[float]] = ([], [])
    for _ in range(rounds):
        for side, function in zip(times, (ours, bare), strict=True):
            begun = time.process_time()
            function()
            side.append(time.process_time() - begun)
    return float(np.median(times[0])), float(np.median(times[1]))


def main() -> None:
    rounds = arguments(__doc__, 400).rounds
    for name, overrides in LAWS.items():
        env = environment(overrides)
        env.reset(seed=0)
        bare = bare_loop(env)

        def step(env: simkit.gym.SimulationEnv = env) -> None:
            env.step(ACTION)
            if env.time > 3.0:  # drives on a circle, free of pillars
                env.reset()

        interleaved(step, bare, 20)
        ours, other = interleaved(step, bare, rounds)
        print(f"step, {name:22s} {ours * 1e6:7.0f} us   bare {other * 1e6:7.0f} us   bare / ours {other / ours:.2f}")
        resets = []
        for _ in range(100):
            begun = time.process_time()
            env.reset()
            resets.append(time.process_time() - begun)
        print(f"reset                        {np.median(resets) * 1e6:7.0f} us")


if __name__ == "__main__":
    main()
