"""Environments that take turns in the simulations of a few processes: the bits of single environments."""

from __future__ import annotations

import os
import re
import select
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium", reason="pip install 'simkit-robotics[experiments]'")

import sweep_worlds  # noqa: E402
from rover_worlds import ACCELERATION, COMMAND_AND_ODOMETRY, RATE, assert_same_bits, rover, world  # noqa: E402
from sweep_worlds import CART, SLIDE  # noqa: E402

import simkit.gym  # noqa: E402
from simkit import Pose  # noqa: E402
from simkit.errors import InputError  # noqa: E402
from simkit_learning.environments import shared_vector  # noqa: E402

TURNS = (("processes", 1),)
OBSERVATION: dict[str, Any] = {"scan": "/rover/scan", "imu": "/rover/imu", "pose": "rover"}
DRIVE = re.compile(r"<plugin filename=.gz-sim-diff.*?</plugin>", re.DOTALL)


def with_drive(plugin: str, sensors: str = "") -> str:
    return DRIVE.sub(plugin, world(rover("rover", 0, front=True, sensors=sensors)))


def moved(env: Any) -> None:
    """Begin the episode at another place, and remember a number."""
    env.memory["x"] = float(env.np_random.uniform(-1.0, 0.2))
    env.sim.model("rover").set_pose(Pose((env.memory["x"], 0.0, 0.1)))


def far_from_start(env: Any) -> float:
    return float(env.sim.model("rover").pose.position[0]) - float(env.memory["x"])


def test_simkits_contact_law_odometry_and_memories_have_the_bits_of_single_robots() -> None:
    source = world(rover("rover", 0, COMMAND_AND_ODOMETRY + ACCELERATION + RATE.format(7)))
    options: dict[str, Any] = {"observation": {**OBSERVATION, "odom": "/odom"}, "overrides": ()}
    options |= {"on_reset": moved, "reward": far_from_start, "terminated": lambda env: far_from_start(env) > 0.02}
    assert assert_same_bits(source, 9, 3, vector=TURNS, time_limit=0.4, control_period=0.05, **options) >= 3


ACKERMANN = f"""<plugin filename="gz-sim-ackermann-steering-system" name="gz::sim::systems::AckermannSteering">
<left_joint>left_joint</left_joint><right_joint>right_joint</right_joint>
<left_steering_joint>front_left_joint</left_steering_joint><right_steering_joint>front_right_joint</right_steering_joint>
<wheel_radius>0.1</wheel_radius>{COMMAND_AND_ODOMETRY}</plugin>"""
MECANUM = f"""<plugin filename="gz-sim-mecanum-drive-system" name="gz::sim::systems::MecanumDrive">
<front_left_joint>front_left_joint</front_left_joint><front_right_joint>front_right_joint</front_right_joint>
<back_left_joint>left_joint</back_left_joint><back_right_joint>right_joint</back_right_joint>
<wheel_radius>0.1</wheel_radius>{COMMAND_AND_ODOMETRY}</plugin>"""
VELOCITY = """<plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl">
<topic>cmd_vel</topic></plugin><plugin filename="gz-sim-odometry-publisher-system"
name="gz::sim::systems::OdometryPublisher"><odom_topic>odom</odom_topic></plugin>"""
PLANAR = """<plugin filename="libgazebo_ros_planar_move.so" name="drive"><publish_rate>20</publish_rate></plugin>"""


@pytest.mark.slow
@pytest.mark.parametrize(
    "drive", [ACKERMANN, MECANUM, VELOCITY, PLANAR], ids=["ackermann", "mecanum", "velocity", "planar"]
)
def test_drives_without_array_rules_have_the_bits_of_single_robots(drive: str) -> None:
    options: dict[str, Any] = {"observation": {**OBSERVATION, "odom": "/odom"}, "overrides": ()}
    assert assert_same_bits(with_drive(drive), 5, 2, vector=TURNS, time_limit=0.2, **options) >= 2


@pytest.mark.slow
def test_two_processes_have_the_bits_of_one() -> None:
    source = world(rover("rover", 0, COMMAND_AND_ODOMETRY))
    options: dict[str, Any] = {
        "observation": {**OBSERVATION, "odom": "/odom"},
        "overrides": (),
        "success": "time > 0.1",
    }
    assert assert_same_bits(source, 5, 5, vector=(("processes", 2),), time_limit=0.2, **options) >= 5


def test_drawn_variables_of_expressions_belong_to_their_environments() -> None:
    options: dict[str, Any] = {"observation": SLIDE, "action": SLIDE, "reward": "{k} + joint('cart::slide').position"}
    options |= {"randomise": {"k": {"uniform": [1.0, 2.0]}}, "time_limit": 0.3}
    found = []
    for processes in (1, False):
        envs = simkit.gym.make_vec(CART, num_envs=3, processes=processes, **options)
        envs.reset(seed=2)
        found.append([envs.step(np.full((3, 1), 2.0))[1].tolist() for _ in range(6)])
        envs.close()
    assert found[0] == found[1] and len({round(value) for value in found[0][0]} | {*found[0][0]}) > 2


@pytest.mark.slow
@pytest.mark.parametrize("autoreset", ["same_step", "disabled"])
def test_the_modes_of_autoreset_and_infos_are_those_of_one_process(autoreset: str) -> None:
    options: dict[str, Any] = {"observation": SLIDE, "action": SLIDE, "time_limit": 0.2, "autoreset": autoreset}
    options["success"] = "joint('cart::slide').position > 0"
    found: list[Any] = []
    for processes in (2, False):
        envs = simkit.gym.make_vec(CART, num_envs=3, processes=processes, **options)
        envs.reset(seed=2)
        results: list[Any] = [envs.step(np.full((3, 1), 2.0)) for _ in range(2)]
        if autoreset == "disabled":
            mask = np.array([False, False, True])
            results.append(envs.reset(options={"reset_mask": mask}))
        found.append(results)
        envs.close()
    for mine, other in zip(*found, strict=True):
        assert np.array_equal(mine[0], other[0]) and mine[-1].keys() == other[-1].keys()
        assert np.array_equal(mine[-1]["time"], other[-1]["time"])


@pytest.mark.slow
def test_more_environments_than_processes_share_them_if_they_are_no_batch() -> None:
    envs: Any = simkit.gym.make_vec(CART, num_envs=50, observation=SLIDE, action=SLIDE, reward=lambda env: env.time)
    assert "Batched" in envs.not_batched
    envs.reset(seed=1)
    assert envs.step(np.zeros((50, 1)))[1].tolist() == [0.1] * 50
    envs.close()
    with pytest.raises(InputError, match="SK-GYM-005"):
        envs.step(np.zeros((50, 1)))


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ({"reward": "count('/eye')"}, "counts"),
        ({"randomise": {"cart::car.inertial.mass": {"uniform": [1.0, 2.0]}}}, "change the world"),
    ],
)
def test_what_cannot_take_turns_is_named(options: dict[str, Any], reason: str) -> None:
    with pytest.raises(InputError, match=f"SK-GYM-001.*cannot take turns.*{reason}"):
        simkit.gym.make_vec(CART, num_envs=2, processes=2, observation=SLIDE, action=SLIDE, **options)


@pytest.mark.slow
def test_an_error_in_a_process_is_raised_with_its_code() -> None:
    envs = simkit.gym.make_vec(CART, num_envs=2, processes=2, observation=SLIDE, action=SLIDE)
    with pytest.raises(InputError, match="SK-GYM-005"):
        envs.step(np.zeros((2, 1)))
    envs.close()


@pytest.mark.slow
def test_a_process_that_has_ended_is_named_in_each_call() -> None:
    envs: Any = simkit.gym.make_vec(CART, num_envs=2, processes=2, observation=SLIDE, action=SLIDE)
    envs.reset(seed=1)
    envs._processes[0].kill()
    envs._processes[0].join()
    for _ in range(2):
        with pytest.raises(InputError, match="a process of the environments has ended"):
            envs.step(np.zeros((2, 1)))
    envs.close()


@pytest.mark.slow
def test_a_call_after_an_interrupted_one_gets_its_own_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    envs = simkit.gym.make_vec(CART, num_envs=2, processes=2, observation=SLIDE, action=SLIDE)
    first, _ = envs.reset(seed=1)

    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(shared_vector, "_received", interrupted)
        with pytest.raises(KeyboardInterrupt):
            envs.step(np.ones((2, 1)))
    assert np.array_equal(envs.reset(seed=1)[0], first)
    envs.close()


CALLER = """
import sys
sys.path.insert(0, {folder!r})
import simkit.gym
from sweep_worlds import CART, SLIDE
if __name__ == "__main__":
    envs = simkit.gym.make_vec(CART, num_envs=3, processes=3, observation=SLIDE, action=SLIDE)
    envs.reset(seed=1)
    print("ready", flush=True)
    sys.stdin.read()
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the system has no fork")
def test_the_processes_end_with_a_caller_that_is_killed() -> None:
    program = CALLER.format(folder=str(Path(sweep_worlds.__file__).parent))
    read, write = os.pipe()  # closed when the last process that has its end has ended
    with subprocess.Popen(
        [sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, pass_fds=[write]
    ) as caller:
        os.close(write)
        assert caller.stdout is not None and caller.stdout.readline() == b"ready\n"
        caller.kill()
        assert select.select([read], [], [], 60)[0]
    os.close(read)
