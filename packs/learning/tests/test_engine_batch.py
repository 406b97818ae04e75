"""Environments that MuJoCo's batch steps in one call: the results of single environments, and what it refuses."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from sweep_worlds import CART, SLIDE

from simkit.errors import InputError

gymnasium = pytest.importorskip("gymnasium", reason="pip install 'simkit-robotics[experiments]'")

import simkit.gym  # noqa: E402
from simkit.gym import Batched, Observation  # noqa: E402
from simkit_learning.environments.array_bindings import world_obstacles  # noqa: E402

TWIST = {"/cmd_vel": {"linear.x": (0.0, 0.26), "angular.z": (-1.5, 1.5)}}
MUJOCO = ("physics.contact_law=mujoco",)
LOADS = tuple(
    f"turtlebot3::wheel_{side}_joint.axis.dynamics.{load}={value}"
    for side, load, value in (("left", "damping", 0.05), ("right", "friction", 0.02))
)
TOLERANCE = 1e-6
"""Largest difference to a single environment: one unit of the last digit of a 32-bit number near 10."""


def named(observation: Any) -> Mapping[str, Any]:
    return observation if isinstance(observation, Mapping) else {"": observation}


def assert_like_single(world: str, steps: int, count: int = 3, **options: Any) -> int:
    """Compare a batch with single environments, and return the number of episodes that ended."""
    batch = simkit.gym.make_vec(world, num_envs=count, batch=True, **options)
    single = simkit.gym.make_vec(world, num_envs=count, processes=False, **options)
    assert batch.not_batched == "" and batch.observation_space == single.observation_space
    ends, random = 0, np.random.default_rng(3)
    low, high = batch.single_action_space.low, batch.single_action_space.high
    found, expected = batch.reset(seed=7), single.reset(seed=7)
    for _ in range(steps):
        for name, values in named(expected[0]).items():
            assert np.abs(named(found[0])[name].astype(float) - values).max() <= TOLERANCE, name
        assert found[-1].keys() == expected[-1].keys()
        assert np.array_equal(found[-1]["time"], expected[-1]["time"])
        actions = random.uniform(low, high, (count, len(low)))
        found, expected = batch.step(actions), single.step(actions)
        assert np.abs(found[1] - expected[1]).max() <= TOLERANCE
        assert np.array_equal(found[2], expected[2]) and np.array_equal(found[3], expected[3])
        ends += int((expected[2] | expected[3]).sum())
    batch.close()
    single.close()
    return ends


def far(env: Any) -> bool:
    return bool(env.sim.joint(SLIDE).position > 0.1)


FAR = Batched(far, lambda view: view.joint_position(SLIDE) > 0.1)


@pytest.mark.parametrize("autoreset", ["next_step", "same_step"])
def test_a_batch_has_the_scans_joints_and_ends_of_single_environments(autoreset: str) -> None:
    observation = {
        "eye": "/eye",
        "near": Observation("/eye", sectors=2),
        "truth": Observation("/eye", truth=True),
        "slide": SLIDE,
    }
    options: dict[str, Any] = {"observation": observation, "action": SLIDE, "time_limit": 0.5}
    assert assert_like_single(CART, 14, terminated=FAR, success=FAR, autoreset=autoreset, **options) > 3


def test_a_batch_draws_masses_at_each_reset_like_single_environments() -> None:
    randomise = {"cart::car.inertial.mass": {"uniform": [0.5, 3.0]}}
    assert assert_like_single(CART, 9, observation=SLIDE, action=SLIDE, time_limit=0.3, randomise=randomise) == 6


def test_a_topic_whose_period_is_no_number_of_steps_is_like_that_of_single_environments() -> None:
    plugin = """<plugin name="states" filename="libgazebo_ros_joint_state_publisher.so"><update_rate>7</update_rate>
    <joint_name>slide</joint_name></plugin></model></world>"""
    options: dict[str, Any] = {"observation": {"joints": "/joint_states"}, "action": SLIDE, "time_limit": 0.7}
    assert assert_like_single(CART.replace("</model></world>", plugin), 18, terminated=FAR, **options) > 3


def heavier(env: Any) -> None:
    env.sim.link("cart::car").mass = env.np_random.uniform(1.0, 5.0)


WALL = CART[CART.index("<model") : CART.index("</model>") + len("</model>")]


def crowded(env: Any) -> None:
    if env.np_random.random() < 0.5:
        env.sim.spawn(f"<sdf version='1.9'>{WALL}</sdf>", name="other")


def test_on_reset_may_change_numbers_of_the_model_but_not_its_parts() -> None:
    options: dict[str, Any] = {"observation": SLIDE, "action": SLIDE, "time_limit": 0.3}
    assert assert_like_single(CART, 9, on_reset=heavier, **options) == 6
    envs = simkit.gym.make_vec(CART, num_envs=8, batch=True, on_reset=crowded, **options)
    with pytest.raises(InputError, match="SK-GYM-001 on_reset spawned"):
        envs.reset(seed=1)
    envs.close()


def test_a_batch_has_the_odometry_imu_and_joint_states_of_single_robots() -> None:
    observation = {"imu": "/imu", "odom": "/odom", "joints": "/joint_states", "pose": "turtlebot3", "scan": "/scan"}
    options: dict[str, Any] = {"observation": observation, "action": TWIST, "time_limit": 0.3}
    assert assert_like_single("turtlebot3_world", 5, 2, overrides=(*MUJOCO, *LOADS), **options) == 2


@pytest.mark.slow
def test_a_batch_has_the_rewards_and_collisions_of_the_registered_goal_task() -> None:
    assert assert_like_single("simkit/TurtleBot3Goal-v0", 8, 2, control_period=0.5, time_limit=3.5) >= 2


def test_a_batch_computes_expressions_like_single_environments() -> None:
    robot, goal = "'turtlebot3'", "(1.6, 0.5, 0)"
    observation = {
        "to_goal": f"{goal} - pose({robot}).position",
        "speed": f"norm(velocity({robot})) * 2",
        "turn": f"clamp(pose({robot}).yaw, -1, 1) + time",
        "wheel": "joint('turtlebot3::wheel_left_joint').velocity ** 2",
    }
    options: dict[str, Any] = {"observation": observation, "action": TWIST, "time_limit": 0.9, "overrides": MUJOCO}
    reward = f"-distance({robot}, {goal}) + max(pose({robot}).x, 0.1, -velocity({robot}).y)"
    ends = f"contact({robot}) or not (0 <= abs(pose({robot}).y) < 1) or pose({robot}).position.x > 5"
    assert assert_like_single("turtlebot3_world", 10, 2, reward=reward, terminated=ends, **options) == 2


@pytest.mark.slow
def test_a_batch_casts_on_the_walls_of_the_maze() -> None:
    assert_like_single("simkit/TurtleBot3Maze-v0", 60)


def test_an_environment_repeats_by_its_seed_whatever_the_others_do() -> None:
    def run(others: float, threads: int) -> list[Any]:
        envs = simkit.gym.make_vec(
            CART, num_envs=3, batch=True, threads=threads, observation={"eye": "/eye", "j": SLIDE}, action=SLIDE
        )
        found = [envs.reset(seed=[others, 5, None] if others else [1, 5, 2])[0]]  # type: ignore[list-item]
        found += [envs.step([[others], [2.0], [-others]])[0] for _ in range(3)]
        envs.close()
        return [{name: values[1].tobytes() for name, values in one.items()} for one in found]

    assert run(0, 1) == run(8, 2)


def test_a_diverged_environment_is_truncated_and_the_others_continue() -> None:
    envs = simkit.gym.make_vec(CART, num_envs=3, batch=True, observation=SLIDE, action=SLIDE)
    before = envs.reset(seed=1)[0]
    envs.view.qvel[1] = np.nan
    found, rewards, terminated, truncated, infos = envs.step(np.full((3, 1), 4.0))
    assert truncated.tolist() == [False, True, False] and not terminated.any() and rewards[1] == 0.0
    assert found[1].tolist() == before[1].tolist() and found[0, 0] > 0.0
    assert infos["_diverged"].tolist() == [False, True, False] and "slide" in infos["diverged"][1]
    found, _, _, truncated, _ = envs.step(np.zeros((3, 1)))
    assert np.isfinite(found).all() and not truncated.any()
    envs.close()


def test_the_mode_without_autoreset_resets_by_a_mask() -> None:
    options: dict[str, Any] = {"observation": SLIDE, "action": SLIDE, "terminated": FAR, "autoreset": "disabled"}
    envs = simkit.gym.make_vec(CART, num_envs=2, batch=True, **options)
    envs.reset(seed=1)
    forces = np.array([[8.0], [0.0]])
    while not (ended := envs.step(forces)[2]).any():
        pass
    assert ended.tolist() == [True, False]
    with pytest.raises(InputError, match=r"SK-GYM-005.*\[0\]"):
        envs.step(forces)
    found, _ = envs.reset(options={"reset_mask": ended})
    assert found[0, 0] == 0.0 and envs.view.time.tolist()[1] > 0.0
    assert not envs.step(forces)[2].any()
    envs.close()


@pytest.mark.parametrize(
    ("world", "options", "reason"),
    [
        ("turtlebot3_world", {}, "contact law"),
        (CART, {"reward": "count('/eye')"}, "reward: count\\('/eye'\\) in the expression"),
        (CART, {"reward": "{k} + 1", "randomise": {"k": {"choice": [1, 2]}}}, "variables"),
        (CART, {"reward": lambda env: 1.0}, "Batched"),
        (CART, {"sync": False}, "sync=False"),
        (CART, {"render_mode": "rgb_array"}, "render_mode"),
        (CART, {"observation": "/clock"}, "topic /clock"),
    ],
)
def test_what_a_batch_cannot_do_is_named(world: str, options: dict[str, Any], reason: str) -> None:
    rest = {"observation": "/scan", "action": TWIST} if world != CART else {"observation": SLIDE, "action": SLIDE}
    with pytest.raises(InputError, match=f"SK-GYM-001.*{reason}"):
        simkit.gym.make_vec(world, num_envs=2, batch=True, **{**rest, **options})


@pytest.mark.slow
def test_processes_start_anew_where_the_present_one_has_other_threads() -> None:
    """A copy of a process has the locks of its threads, but not the threads."""
    ended = threading.Event()
    thread = threading.Thread(target=ended.wait)
    thread.start()
    envs = simkit.gym.make_vec(CART, num_envs=1, processes=True, observation=SLIDE, action=SLIDE)
    ended.set()
    thread.join()
    assert envs.processes[0].__class__.__name__ in ("ForkServerProcess", "SpawnProcess")
    envs.reset()
    envs.close()


@pytest.mark.slow
def test_processes_take_over_and_say_why() -> None:
    envs = simkit.gym.make_vec(
        CART, num_envs=1, observation=SLIDE, action=SLIDE, reward="2 * 3", success="age('/eye') > 9"
    )
    assert isinstance(envs, gymnasium.vector.AsyncVectorEnv)
    assert "age('/eye') in the expression" in envs.not_batched
    envs.reset()
    assert envs.step(np.zeros((1, 1), np.float32))[1].tolist() == [6.0]
    envs.close()


def test_wrong_calls_of_a_batch_are_errors_with_codes() -> None:
    options: dict[str, Any] = {"observation": SLIDE, "action": SLIDE}
    for more in ({"threads": -1}, {"num_envs": 0}, {"batch": True, "processes": True}, {"autoreset": "never"}):
        with pytest.raises(InputError, match="SK-GYM-001"):
            simkit.gym.make_vec(CART, **{"num_envs": 2, **options, **more})
    envs = simkit.gym.make_vec(CART, num_envs=2, **options)
    with pytest.raises(InputError, match="SK-GYM-005"):
        envs.step(np.zeros((2, 1)))
    envs.reset()
    for actions in (np.zeros(2), np.zeros((3, 1)), [[0.0], [np.nan]], "fast"):
        with pytest.raises(InputError, match="SK-GYM-004.*cart::slide effort"):
            envs.step(actions)
    with pytest.raises(InputError, match="reset_mask"):
        envs.reset(options={"reset_mask": np.zeros(2, np.bool_)})
    with pytest.raises(InputError, match="found 3 seeds"):
        envs.reset(seed=[1, 2, 3])
    envs.close()
    envs.close()


class Speaker(simkit.WorldPlugin):
    only_publishes = True

    def load(self, sim: simkit.Simulation, params: Any) -> None:
        """Do nothing."""

    def after_step(self) -> None:
        """Publish."""


class Mover(Speaker):
    """May do more than its base class."""


def test_a_plugin_of_the_user_can_be_part_of_a_batch_if_it_only_publishes() -> None:
    for plugin, found in ((Speaker, []), (Mover, ["plugin Mover"])):
        with simkit.load(CART, plugins=[plugin()]) as sim:
            assert world_obstacles(sim) == found
