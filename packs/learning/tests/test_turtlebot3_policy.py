"""The trained policy drives to its goals in a run, and its plugin observes what the environment observes."""

from __future__ import annotations

import importlib.util
import sys
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import simkit

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
FOLDER = EXAMPLES / "turtlebot3_policy"
FAST = ["physics.max_step_size=0.005", "physics.contact_law=mujoco"]


def module(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    found = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = found
    spec.loader.exec_module(found)
    return found


def test_the_policy_drives_to_three_goals() -> None:
    with simkit.load(FOLDER / "world.sdf", plugin_paths=[FOLDER], overrides=FAST, seed=1) as sim:
        driver = next(plugin for plugin in sim.plugins.values() if type(plugin).__name__ == "PolicyDriver")
        robot = sim.model("turtlebot3")
        for _ in range(300):
            sim.run(0.2)
            if driver.reached == 3:
                break
        assert driver.reached == 3
        assert np.linalg.norm(robot.pose.position[:2] - (1.7, 0.55)) < 0.3


def test_the_plugin_observes_what_the_environment_observes() -> None:
    gymnasium = pytest.importorskip("gymnasium", reason="pip install 'simkit-robotics[experiments]'")
    import simkit.gym

    driver = module(FOLDER / "policy_driver.py").PolicyDriver()
    training = module(EXAMPLES / "train_turtlebot3.py")
    single = simkit.gym.make(training.ENVIRONMENT, control_period=training.PERIOD, overrides=FAST)
    run = replace(single.spec_of_env.run, plugins=(("turtlebot3", driver),))
    env = simkit.gym.SimulationEnv(replace(single.spec_of_env, run=run))
    flat = gymnasium.wrappers.FlattenObservation(env)
    scaled = gymnasium.wrappers.RescaleObservation(flat, np.float32(-1.0), np.float32(1.0))
    scaled.reset(seed=3)
    driver = next(plugin for plugin in env.sim.plugins.values() if type(plugin).__name__ == "PolicyDriver")
    for _ in range(3):
        observation = scaled.step([0.5, 0.3])[0]
        assert driver.observe(tuple(env.memory["goal"])) == pytest.approx(observation, abs=1e-5)
        policy = {
            f"{kind}_{n}": layer[k]
            for n, layer in enumerate(driver.layers)
            for k, kind in enumerate(("weight", "bias"))
        }
        action = training.act(policy, observation)
        forward, turn = driver.act(observation)
        assert (forward, turn) == pytest.approx((0.13 * (action[0] + 1.0), 1.5 * action[1]), abs=1e-5)
