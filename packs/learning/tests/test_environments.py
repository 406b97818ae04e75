"""Environments for learning: spaces, determinism by seed, freshness of observations, actions, errors."""

from __future__ import annotations

import dataclasses
import logging
import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sweep_worlds import CART, SLIDE

import simkit
from simkit import ModelPlugin, RunSpec
from simkit.errors import InputError

gymnasium = pytest.importorskip("gymnasium", reason="pip install 'simkit-robotics[experiments]'")

import simkit.gym  # noqa: E402
from simkit.gym import JointVelocities, Observation  # noqa: E402
from simkit_learning.environments.specification import EnvironmentOptions  # noqa: E402
from simkit_learning.environments.turtlebot3_tasks import maze_world  # noqa: E402


def make(**options: Any) -> simkit.gym.SimulationEnv:
    given: dict[str, Any] = {
        "observation": {"eye": "/eye", "slide": SLIDE},
        "action": SLIDE,
        "reward": f"-abs(joint('{SLIDE}').position - 1)",
        "terminated": f"joint('{SLIDE}').position > 1.5",
        "time_limit": 1.0,
    }
    return simkit.gym.make(CART, **{**given, **options})


def results(env: simkit.gym.SimulationEnv, seed: int | None = 7, steps: int = 3) -> list[Any]:
    found = [env.reset(seed=seed)[0]]
    for number in range(steps):
        observation, reward, *_ = env.step([float(number)])
        found += [observation, reward]
    return found


def same(one: Any, other: Any) -> bool:
    """Compare observations, rewards and ends bit for bit."""
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(same(one[name], other[name]) for name in one)
    return np.asarray(one).tobytes() == np.asarray(other).tobytes()


def test_the_checker_of_gymnasium_accepts_an_environment() -> None:
    from gymnasium.utils.env_checker import check_env

    with pytest.warns(
        UserWarning, match="infinity|normalized"
    ):  # a velocity has no bounds, and an effort is not scaled
        check_env(make(), skip_render_check=True)


@pytest.mark.filterwarnings("error")
def test_the_checker_accepts_a_registered_environment_without_a_warning() -> None:
    from gymnasium.utils.env_checker import check_env

    check_env(gymnasium.make("simkit/TurtleBot3Goal-v0", disable_env_checker=True).unwrapped, skip_render_check=True)


def test_the_same_seed_gives_the_same_bits_and_another_seed_other_noise() -> None:
    env = make()
    first, again, other = results(env), results(env), results(env, seed=8)
    fresh = results(make())
    for a, b, c in zip(first, again, fresh, strict=True):
        assert same(a, b) and same(a, c)
    assert not np.array_equal(first[0]["eye"], other[0]["eye"])


def test_a_first_reset_without_a_seed_uses_the_seed_of_the_run() -> None:
    run = RunSpec(CART, seed=5)
    options = {"observation": "/eye", "action": SLIDE}
    one, other = simkit.gym.make(run, **options), simkit.gym.make(CART, seed=5, **options)
    assert np.array_equal(one.reset()[0], other.reset(seed=5)[0])


def test_the_bounds_of_a_scan_are_the_ranges_of_the_sensor() -> None:
    env = make(observation={"eye": "/eye", "near": Observation("/eye", sectors=2)})
    eye, near = env.observation_space["eye"], env.observation_space["near"]
    assert eye.shape == (6,) and np.all(eye.low == np.float32(0.1)) and np.all(eye.high == 5.0)
    assert near.shape == (2,)
    observation, _ = env.reset(seed=1)
    assert np.array_equal(observation["near"], observation["eye"].reshape(2, 3).min(axis=1))


def test_a_scan_is_as_new_as_the_step_with_sync_and_up_to_a_period_old_without() -> None:
    def ages(sync: bool) -> list[float]:
        env = make(observation=Observation("/eye"), sync=sync)
        env.reset(seed=1)
        found = []
        for _ in range(4):
            env.step([0.0])
            stamp = env.sim.sensor("cart::car::eye").latest.header.stamp
            found.append(round(env.sim.time - stamp.sec - stamp.nanosec * 1e-9, 9))
        return found

    assert ages(sync=True) == [0.0, 0.0, 0.0, 0.0]
    assert ages(sync=False) == [0.198, 0.05, 0.15, 0.0]  # samples at 0.002, 0.25 and 0.5 s


def test_sampling_only_observed_sensors_changes_no_observation() -> None:
    options: dict[str, Any] = {"observation": {"truth": Observation("/eye", truth=True), "slide": SLIDE}}
    every, observed = results(make(**options)), results(make(**options, samples_all=False))
    assert all(map(same, every, observed))


def test_an_effort_acts_during_the_whole_control_period() -> None:
    env = make()
    env.reset()
    env.step([4.0])
    assert env.sim.joint(SLIDE).velocity == pytest.approx(4.0 / 2.0 * 0.1, rel=1e-6)  # F/m·t
    assert env.action.tolist() == [4.0]
    env.step([100.0])
    assert env.action.tolist() == [8.0]  # the effort limit


def test_scaled_actions_stand_for_the_bounds() -> None:
    env = make(scaled_actions=True)
    assert env.action_space.low.tolist() == [-1.0] and env.action_space.high.tolist() == [1.0]
    env.reset()
    env.step([0.5])
    assert env.sim.joint(SLIDE).velocity == pytest.approx(4.0 / 2.0 * 0.1, rel=1e-6)


def test_an_episode_ends_by_its_task_or_by_its_time() -> None:
    env = make(success=f"joint('{SLIDE}').position > 1.5")
    env.reset()
    ends = [env.step([0.0])[2:4] for _ in range(10)]
    assert ends == [(False, False)] * 9 + [(False, True)]
    env.reset()
    env.sim.joint(SLIDE).set_position(1.6)
    _, _, terminated, truncated, info = env.step([0.0])
    assert terminated and not truncated and info["is_success"] is True


def test_a_clone_continues_with_the_same_bits() -> None:
    env = make(randomise={"cart::car.inertial.mass": {"uniform": [1.0, 3.0]}})
    results(env)
    other = env.clone()
    assert other.sim is not env.sim and other.values == env.values
    assert all(map(same, env.step([1.0])[:4], other.step([1.0])[:4]))
    assert env.reset()[0]["eye"].tolist() == other.reset()[0]["eye"].tolist()


class Push(ModelPlugin):
    """Pushes a joint with a force [N] that a callback may change."""

    def __init__(self, force: float) -> None:
        super().__init__()
        self.forces = [force]

    def load(self, model: Any, params: Any) -> None:
        self._joint = self.sim.joint(SLIDE)
        self.listen("/push", "std_msgs/msg/Float64", lambda message: self.forces.append(message.data))

    def before_step(self) -> None:
        self._joint.set_effort(self.forces[-1])


def test_each_environment_has_a_plugin_of_its_own() -> None:
    plugin = Push(2.0)
    spec = dataclasses.replace(
        make().spec_of_env, run=RunSpec(CART, plugins=(("cart", plugin),)), action={"/push": {"data": (-5.0, 5.0)}}
    )
    alone = simkit.gym.SimulationEnv(spec)
    expected = results(alone)
    alone.close()
    first, second = simkit.gym.SimulationEnv(spec), simkit.gym.SimulationEnv(spec)
    assert all(map(same, results(first), expected))
    assert all(map(same, results(second), expected))
    clone = first.clone()
    assert all(map(same, first.step([1.0])[:4], clone.step([1.0])[:4]))
    plugins = [plugin, *(env.sim.plugins["cart::Push"] for env in (first, second, clone))]
    assert len(set(map(id, plugins))) == 4
    assert [each.forces[-1] for each in plugins] == [2.0, 1.0, 2.0, 1.0]


def test_a_plugin_of_an_open_simulation_is_refused() -> None:
    plugin = Push(2.0)
    spec = dataclasses.replace(make().spec_of_env, run=RunSpec(CART, plugins=(("cart", plugin),)))
    refused = pytest.raises(InputError, match="SK-GYM-001 plugins: an open simulation has loaded this Push")
    with simkit.load(CART, plugins=[("cart", plugin)]), refused:
        simkit.gym.SimulationEnv(spec)
    simkit.gym.SimulationEnv(spec).close()


@pytest.mark.parametrize("observation", ["/eye", "path_length('cart::car') + 0 * {k}"])
def test_a_clone_of_a_long_episode_continues_with_the_same_noise_and_variables(observation: str) -> None:
    def reward(env: Any) -> float:
        env.memory["sum"] = env.memory.get("sum", 0.0) + float(env.action[0]) + env.values["k"]
        return float(env.memory["sum"])

    randomise = {"k": {"choice": [1.0, 2.0]}}
    env = make(observation=observation, reward=reward, terminated=False, randomise=randomise, time_limit=3.0)
    results(env, steps=12)
    other = env.clone()
    for action in ([2.0], [-3.0]):
        assert all(map(same, env.step(action)[:4], other.step(action)[:4]))
    assert env.time == other.time and env.memory == other.memory
    assert all(map(same, env.clone().step([1.0])[:4], other.clone().step([1.0])[:4]))
    assert same(env.reset()[0], other.reset()[0])


def test_a_clone_of_the_goal_task_restores_a_snapshot_and_drives_the_same_way() -> None:
    env = simkit.gym.make("simkit/TurtleBot3Goal-v0")
    env.reset(seed=2)
    for _ in range(5):
        env.step([0.5, 0.5])
    other = env.clone()
    try:
        pickle.dumps(env.sim.snapshot())
    except TypeError:
        assert not env._copy_state(other)  # the clone has repeated the episode
    else:
        assert env._copy_state(other)
    for _ in range(5):
        assert all(map(same, env.step([0.3, -0.5])[:4], other.step([0.3, -0.5])[:4]))
    assert np.array_equal(env.sim.mj_data.qpos, other.sim.mj_data.qpos)


def test_values_are_drawn_at_each_reset_and_can_be_given() -> None:
    mass = "cart::car.inertial.mass"
    env = make(
        randomise={mass: {"uniform": [1.0, 3.0]}, "goal": {"choice": [0.25, 0.75]}},
        reward=f"abs(joint('{SLIDE}').position - {{goal}})",
        observation=SLIDE,
    )
    env.reset(seed=1)
    first = dict(env.values)
    env.reset()
    assert env.values[mass] != first[mass] and 1.0 <= env.values[mass] <= 3.0
    assert env.sim.link("cart::car").mass == env.values[mass]
    env.reset(seed=1)
    assert env.values == first
    env.reset(options={"values": {"goal": 0.75, mass: 1.5}})
    assert env.sim.link("cart::car").mass == 1.5
    assert env.step([0.0])[1] == pytest.approx(0.75, abs=1e-3)


def test_an_episode_knows_no_message_and_no_history_of_the_last_one() -> None:
    car = "cart::car"
    env = make(observation={"eyes": "count('/eye')", "way": f"path_length('{car}')", "scan": "topic('/eye').ranges[0]"})
    begin = env.reset(seed=1)[0]
    for _ in range(5):
        later = env.step([8.0])[0]
    assert later["way"] > 0.1 and later["eyes"] > begin["eyes"]
    assert same(env.reset(seed=1)[0], begin)


def test_other_shapes_and_poses_load_the_world_again() -> None:
    env = make(
        randomise={"wall.pose": {"choice": ["2 0 0 0 0 0", "4 0 0 0 0 0"]}}, observation=Observation("/eye", truth=True)
    )
    for seed in range(4):
        eye = env.reset(seed=seed)[0]
        assert eye.min() == pytest.approx(float(env.values["wall.pose"].split()[0]) - 0.1, abs=0.01)


def test_functions_see_the_truth_and_their_memory_is_empty_after_a_reset() -> None:
    def reward(env: Any) -> float:
        env.memory["count"] = env.memory.get("count", 0) + 1
        return float(env.memory["count"])

    env = make(reward=reward, observation=lambda env: env.sim.joint(SLIDE).position)
    env.reset()
    assert [env.step([0.0])[1] for _ in range(2)] == [1.0, 2.0]
    env.reset()
    assert env.step([0.0])[1] == 1.0


def test_a_diverged_episode_is_truncated_and_the_next_one_works() -> None:
    env = make()
    env.reset(seed=1)
    env.sim.mj_data.qvel[:] = math.nan
    _, reward, terminated, truncated, info = env.step([0.0])
    assert (reward, terminated, truncated) == (0.0, False, True) and "diverged" in info
    assert np.isfinite(env.reset()[0]["slide"]).all()


def test_a_vector_steps_like_single_environments_with_the_next_seeds() -> None:
    options: dict[str, Any] = {"observation": "/eye", "action": SLIDE, "time_limit": 0.2}
    vector = simkit.gym.make_vec(CART, num_envs=2, processes=False, **options)
    single = [simkit.gym.make(CART, seed=number, **options) for number in range(2)]
    first, _ = vector.reset()
    assert np.array_equal(first, [env.reset()[0] for env in single])
    actions = np.array([[1.0], [-1.0]], np.float32)
    for _ in range(2):
        found, _, _, truncated, _ = vector.step(actions)
        assert np.array_equal(found, [env.step(action)[0] for env, action in zip(single, actions, strict=True)])
    assert truncated.all()
    begun = vector.step(actions)[0]  # the next episode, as Gymnasium's mode "next_step" says
    assert np.array_equal(begun, [env.reset()[0] for env in single])
    vector.close()


def test_all_problems_are_in_one_error() -> None:
    with pytest.raises(InputError) as caught:
        make(observation={"a": "/eyes", "b": "pose('carr')"}, action={"cart::slid": None}, reward="1 +")
    text = str(caught.value)
    assert "SK-COND-006" in text and "/eye" in text
    assert "SK-COND-005" in text and "SK-GYM-002 action 'cart::slid'" in text and "reward" in text


@pytest.mark.parametrize(
    ("options", "code", "expected"),
    [
        ({"observatoin": "/eye"}, "SK-GYM-001", "did you mean 'observation'"),
        ({"control_period": 0.001}, "SK-GYM-001", "a multiple of the step, 0.002 s"),
        ({"observation": "/rosout"}, "SK-GYM-003", "/rosout"),
        ({"observation": Observation(SLIDE, low=[0, 0, 0])}, "SK-GYM-001", "shape (2,)"),
        ({"randomise": {"goal": {"uniform": [1, 0]}}}, "SK-GYM-001", "lower bound"),
        ({"action": {SLIDE: (1.0, -1.0)}}, "SK-GYM-002", "the lower bound first"),
        ({"render_mode": "human"}, "SK-GYM-001", "rgb_array"),
        ({"action": None}, "SK-GYM-001", "targets with their bounds"),
        ({"control_period": math.nan, "time_limit": -1}, "SK-GYM-001", "time_limit: found -1"),
        ({"reward": [1.0]}, "SK-GYM-001", "a function of the environment"),
        ({"sync": "no", "on_reset": 1, "randomise": []}, "SK-GYM-001", "on_reset: found 1"),
        ({"seed": 1.5}, "SK-GYM-001", "a whole number"),
        ({"size": (0, 5)}, "SK-GYM-001", "width and height"),
    ],
)
def test_an_invalid_option_is_an_error_with_a_code(options: dict[str, Any], code: str, expected: str) -> None:
    with pytest.raises(InputError, match=code) as caught:
        make(**options)
    assert expected in str(caught.value)


def test_invalid_calls_are_errors_with_codes() -> None:
    env = make(time_limit=0.1)
    with pytest.raises(InputError, match="SK-GYM-005.*before reset"):
        env.step([0.0])
    env.reset()
    for action in ([0.0, 1.0], [math.nan], "left", None, 0.0):
        with pytest.raises(InputError, match=r"SK-GYM-004.*cart::slide effort"):
            env.step(action)
    for call in ({"options": {"values": {"mass": 1.0}}}, {"options": 3}, {"seed": -1}, {"seed": "a"}):
        with pytest.raises(InputError, match="SK-GYM-001 reset: found"):
            env.reset(**call)
    env.step([0.0])
    with pytest.raises(InputError, match="SK-GYM-005.*after the end"):
        env.step([0.0])
    env.close()
    env.close()
    for use in (env.reset, env.clone, lambda: env.step([0.0])):
        with pytest.raises(InputError, match="SK-GYM-005 the environment is closed"):
            use()
    with pytest.raises(InputError, match="TurtleBot3Goal"):
        simkit.gym.make("simkit/TurtleBot3Gaol-v0")
    with pytest.raises(InputError, match="SK-GYM-001 world: found 3"):
        simkit.gym.make(3)  # type: ignore[arg-type]


def test_a_field_that_a_message_does_not_have_is_an_error_with_the_closest_field() -> None:
    for field, closest in (("linear.w", "linear"), ("angular", "angular.x")):
        with pytest.raises(InputError, match=f"SK-GYM-002.*{field}") as caught:
            simkit.gym.make("turtlebot3_empty", observation="/scan", action={"/cmd_vel": {field: (0, 1)}})
        assert closest in str(caught.value)


def test_the_specifications_of_an_environment_can_be_pickled_and_written_as_json() -> None:
    env = gymnasium.make("simkit/TurtleBot3Goal-v0")
    again = gymnasium.make(gymnasium.envs.registration.EnvSpec.from_json(env.spec.to_json()))
    own = simkit.gym.SimulationEnv(pickle.loads(pickle.dumps(env.unwrapped.spec_of_env)))
    assert same(env.reset(seed=3)[0], own.reset(seed=3)[0]) and same(own.observation, again.reset(seed=3)[0])
    with pytest.raises(TypeError, match="pickle env.spec_of_env"):
        pickle.dumps(own)
    envs = gymnasium.make_vec("simkit/TurtleBot3Goal-v0", num_envs=1, vectorization_mode="vector_entry_point")
    assert same(envs.reset(seed=3)[0]["scan"][0], own.observation["scan"])


def test_the_maze_has_walls_between_some_cells() -> None:
    with simkit.load(maze_world()) as sim:
        scan = sim.sensor("turtlebot3::base_scan::lds")
        sim.run(0.3)
        assert sim.model("maze").static and np.isfinite(scan.truth.ranges).mean() > 0.9


@pytest.mark.slow
def test_processes_give_the_results_of_single_environments() -> None:
    vector = simkit.gym.make_vec("simkit/TurtleBot3Goal-v0", num_envs=2)
    single = [simkit.gym.make("simkit/TurtleBot3Goal-v0", seed=number) for number in range(2)]
    first, _ = vector.reset()
    alone = [env.reset()[0] for env in single]
    for _ in range(3):
        assert all(np.array_equal(first[name], [one[name] for one in alone]) for name in first)
        action = np.full((2, 2), 0.5, np.float32)
        first = vector.step(action)[0]
        alone = [env.step([0.5, 0.5])[0] for env in single]
    vector.close()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["TurtleBot3Maze", "TiagoReach", "TiagoPick"])
def test_registered_environments_pass_the_checker_and_repeat_by_seed(name: str) -> None:
    from gymnasium.utils.env_checker import check_env

    env = simkit.gym.make(f"simkit/{name}-v0")
    check_env(env, skip_render_check=True)
    action = env.action_space.sample()

    def run() -> list[Any]:
        env.reset(seed=3)
        return [part for _ in range(5) for part in env.step(action)[:4]]

    assert all(map(same, run(), run()))


@pytest.mark.slow
def test_joint_velocities_move_the_joints_of_a_controller() -> None:
    env = simkit.gym.make(
        "simkit/TiagoReach-v0",
        action={"/arm_controller/joint_trajectory": JointVelocities(("arm_1_joint",), 0.5)},
        scaled_actions=False,
    )
    env.reset(seed=1)
    start = env.sim.joint("tiago::arm_1_joint").position
    for _ in range(10):
        env.step([0.5])
    assert env.sim.joint("tiago::arm_1_joint").position - start == pytest.approx(0.5, abs=0.1)


def test_render_draws_the_world_from_outside() -> None:
    action = {"/cmd_vel": {"linear.x": (0.0, 0.2)}}
    options: dict[str, Any] = {"render_mode": "rgb_array", "size": (64, 48)}
    env = simkit.gym.make("turtlebot3_empty", observation="turtlebot3", action=action, **options)
    env.reset()
    try:
        image = env.render()
    except simkit.RenderError as error:
        pytest.skip(str(error))
    assert image.shape == (48, 64, 3) and image.dtype == np.uint8 and image.std() > 1.0


def test_on_reset_draws_the_same_numbers_before_the_first_reset() -> None:
    drawn: list[float] = []
    for _ in range(2):
        env = simkit.gym.make(
            CART, observation=SLIDE, action=SLIDE, on_reset=lambda e: drawn.append(e.np_random.random())
        )
        env.close()
    assert len(drawn) == 2 and drawn[0] == drawn[1]


def test_the_options_of_an_environment_have_one_list_of_names() -> None:
    names = [field.name for field in dataclasses.fields(simkit.gym.EnvironmentSpec) if field.name != "run"]
    assert list(EnvironmentOptions.__annotations__) == [*names, "overrides", "seed", "render_mode", "size"]


TYPO = "<plugin name='drive' filename='gz-sim-joint-controller-system'><joint_name>{}</joint_name></plugin>"


@pytest.mark.leaves_out
def test_an_environment_tells_what_its_world_runs_without(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    file = tmp_path / "cart.sdf"
    file.write_text(CART.replace("</model></world>", TYPO.format("silde") + "</model></world>"), encoding="utf-8")
    name = "plugin 'drive' (gz-sim-joint-controller-system) of 'cart'"
    with caplog.at_level(logging.WARNING, "simkit"):
        env = simkit.gym.make(file, observation="/eye", action=SLIDE)
    assert env.metadata["left_out"] == {name: 1} and f"the world runs without {name}" in caplog.text
    env.reset(seed=1)
    env.step([0.0])
    clone = env.clone()
    assert clone.metadata["left_out"] == {name: 1}
    clone.close()
    env.close()


@pytest.mark.leaves_out
def test_an_episode_whose_values_leave_out_a_plugin_is_an_error(tmp_path: Path) -> None:
    file = tmp_path / "cart.sdf.xacro"
    head = '<xacro:arg name="joint" default="slide"/>'
    text = CART.replace('<sdf version="1.9">', f'<sdf version="1.9" xmlns:xacro="http://ros.org/wiki/xacro">{head}')
    text = text.replace("</model></world>", TYPO.format("$(arg joint)") + "</model></world>")
    file.write_text(text, encoding="utf-8")
    env = simkit.gym.make(
        file, observation="/eye", action=SLIDE, randomise={"xacro.joint": ["slide"] * 20 + ["silde"]}, seed=1
    )
    assert env.metadata["left_out"] == {}
    env.reset(options={"values": {"xacro.joint": "slide"}})
    with pytest.raises(simkit.InputError, match=r"SK-GYM-006.*is without plugin 'drive'"):
        env.reset(options={"values": {"xacro.joint": "silde"}})
    env.close()
