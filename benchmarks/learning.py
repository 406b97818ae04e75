"""Environments for learning beside hand-written loops, and their resets.

python benchmarks/learning.py [--rounds N]

One step is 0.1 s of `turtlebot3_world` with a fresh scan of 360 rays with noise. The loops use the environment's
compiled model, begin each episode in its state, and get the controls of its wheels once for each step. One loop uses
bare MuJoCo; the other also follows simkit's contact law, by simkit's physics without tasks, plugins and messages. CPU
times; both sides take turns, so that the load of the machine is the same for both.
"""

from __future__ import annotations

import copy
import time
from collections.abc import Callable

import mujoco
import numpy as np
from measure import arguments

import simkit.gym
from simkit.runtime.engine.physics_state import CONTROL
from simkit.runtime.engine.physics_step import Physics

LAWS = {"MuJoCo's contacts": ("physics.contact_law=mujoco",), "simkit's contact law": ()}
SENSOR = "turtlebot3::base_scan::lds"
ACTION = (0.1, 0.4)
EPISODE = 3.0  # [s] the robot drives on a circle, free of pillars


def environment(overrides: tuple[str, ...]) -> simkit.gym.SimulationEnv:
    return simkit.gym.make(
        "turtlebot3_world",
        observation="/scan",
        action={"/cmd_vel": {"linear.x": (0.0, 0.26), "angular.z": (-1.5, 1.5)}},
        reward=lambda env: -float(np.hypot(*env.sim.model("turtlebot3").pose.position[:2])),
        samples_all=False,
        overrides=overrides,
    )


class Loop:
    """The same period by hand: steps, rays, noise, reward; with simkit's physics or with MuJoCo and NumPy alone."""

    def __init__(self, env: simkit.gym.SimulationEnv, has_law: bool) -> None:
        sim = self._sim = env.sim
        self._model, self._data = copy.copy(sim.mj_model), copy.copy(sim.mj_data)
        self._physics = Physics(self._model, self._data, sim.engine.clock) if has_law else None
        self._lidar, self._random = sim.sensor(SENSOR), np.random.default_rng(0)
        count = self._lidar.fan.count
        self._ids, self._distances, self._rays = np.zeros(count, np.int32), np.zeros(count), np.zeros((count, 3))
        self._base, self._own = sim.link("turtlebot3::base_footprint")._body, self._lidar.fan.body or -1
        self._steps = env.steps

    def reset(self) -> None:
        mujoco.mj_copyData(self._data, self._model, self._sim.mj_data)
        if self._physics is not None:
            self._physics.set_state(self._sim.engine.physics.get_state(), is_model_changed=False)

    def step(self) -> object:
        model, data, fan, options = self._model, self._data, self._lidar.fan, self._lidar.options
        data.ctrl[:] = self._sim.mj_data.ctrl
        if self._physics is None:
            mujoco.mj_step(model, data, self._steps)
            mujoco.mj_forward(model, data)
        else:
            self._physics.changed(CONTROL)
            self._physics.advance(self._steps)
            self._physics.fresh()
        origin, rotation = self._lidar.ray_frame(data)
        np.matmul(fan.directions, rotation.T, out=self._rays)
        distances, rays = self._distances, self._rays.reshape(-1)
        mujoco.mj_multiRay(
            model, data, origin, rays, fan.groups, 1, self._own, self._ids, distances, None, fan.count, fan.reach
        )
        low, high = options.range_min, options.range_max
        noisy = np.clip(distances + 0.01 * self._random.standard_normal(fan.count), low, high)
        scan = np.where((distances < 0) | (distances > high), high, noisy).astype(np.float32)
        return scan, -float(np.hypot(*data.xpos[self._base][:2])), False, False, {}


def interleaved(env: simkit.gym.SimulationEnv, loop: Loop, rounds: int) -> tuple[float, float]:
    """Medians of the CPU times [s] of a step of both sides."""
    sides: tuple[Callable[[], object], ...] = (lambda: env.step(ACTION), loop.step)
    times: tuple[list[float], list[float]] = ([], [])
    for _ in range(rounds):
        if env.time > EPISODE:
            env.reset()
            loop.reset()
        for side, function in zip(times, sides, strict=True):
            begun = time.process_time()
            function()
            side.append(time.process_time() - begun)
    return float(np.median(times[0])), float(np.median(times[1]))


def main() -> None:
    rounds = arguments(__doc__, 400).rounds
    for name, overrides in LAWS.items():
        env = environment(overrides)
        for has_law in (False, True) if not overrides else (False,):
            env.reset(seed=0)
            loop, kind = Loop(env, has_law), "with the same law" if has_law else "on bare MuJoCo"
            loop.reset()
            interleaved(env, loop, 20)
            ours, other = interleaved(env, loop, rounds)
            line = f"step, {name:20s} {ours * 1e6:7.0f} us   loop {kind:17s} {other * 1e6:7.0f} us"
            print(f"{line}   loop / ours {other / ours:.2f}", flush=True)
        resets = []
        for _ in range(300):
            begun = time.process_time()
            env.reset()
            resets.append(time.process_time() - begun)
        print(f"reset {np.median(resets) * 1e6:28.0f} us")


if __name__ == "__main__":
    main()
