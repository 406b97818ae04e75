"""Batches of worlds with Gazebo Sim's differential drive: the bits of single environments, and what is refused."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simkit.errors import InputError

gymnasium = pytest.importorskip("gymnasium", reason="pip install 'simkit-robotics[experiments]'")

from rover_worlds import (  # noqa: E402
    ACCELERATION,
    COMMAND_AND_ODOMETRY,
    JERK,
    MUJOCO,
    RATE,
    TWIST,
    assert_same_bits,
    rover,
    world,
)

import simkit.gym  # noqa: E402
from simkit import RunSpec, msgs  # noqa: E402
from simkit.gym import Batched  # noqa: E402

AWAY = Batched(
    lambda env: bool(np.hypot(*env.sim.model("rover").pose.position[:2]) > 0.7),
    lambda view: np.hypot(*view.position("rover")[:, :2].T) > 0.7,
)
JOINTS = "/world/w/model/rover/joint_state"
OBSERVATION = {"scan": "/rover/scan", "odom": "/odom", "joints": JOINTS, "imu": "/rover/imu"}


@pytest.mark.parametrize("rate", [30, pytest.param(2, marks=pytest.mark.slow), pytest.param(0, marks=pytest.mark.slow)])
def test_scan_odometry_joint_states_and_imu_have_the_bits_of_single_robots(rate: float) -> None:
    plugin = COMMAND_AND_ODOMETRY + ACCELERATION + RATE.format(rate)
    source = world(rover("rover", 0, plugin))
    assert assert_same_bits(source, 60, terminated=AWAY, time_limit=2.5, observation=OBSERVATION) >= 6


@pytest.mark.slow
def test_limits_of_jerk_and_speed_four_wheels_and_truth_have_the_bits_of_single_robots() -> None:
    plugin = COMMAND_AND_ODOMETRY + JERK + "<simkit:publish_ground_truth>true</simkit:publish_ground_truth>"
    source = world(rover("rover", 0, plugin, front=True), 0.001)
    observation = {"odom": "/odom", "truth": "/model/rover/ground_truth/odom"}
    assert assert_same_bits(source, 40, 2, terminated=AWAY, time_limit=2.0, observation=observation) >= 2


@pytest.mark.slow
def test_four_robots_on_one_topic_of_commands_have_the_bits_of_single_worlds() -> None:
    robots = "".join(rover(f"r{k}", k, f"<topic>cmd_vel</topic>{RATE.format(20 + k)}{ACCELERATION}") for k in range(4))
    observation = {f"odom{k}": f"/model/r{k}/odometry" for k in range(4)}
    assert assert_same_bits(world(robots), 25, 2, time_limit=1.0, observation=observation) == 4


def moved(env: Any) -> None:
    """Drive for a random time before the episode, and disable some drives."""
    env.sim.publish("/cmd_vel", msgs.make("geometry_msgs/msg/Twist", linear={"x": 0.5}, angular={"z": 1.0}))
    env.sim.step(int(env.np_random.integers(1, 90)))
    env.sim.publish("/model/rover/enable", msgs.make("std_msgs/msg/Bool", data=bool(env.np_random.random() < 0.5)))
    env.sim.step(int(env.np_random.integers(1, 9)))


@pytest.mark.slow
def test_an_episode_begins_with_the_motion_and_the_enabled_state_that_on_reset_leaves() -> None:
    source = world(rover("rover", 0, COMMAND_AND_ODOMETRY + ACCELERATION + RATE.format(17)))
    options: dict[str, Any] = {"observation": {"odom": "/odom", "robot": "rover"}, "on_reset": moved}
    assert assert_same_bits(source, 60, time_limit=0.5, **options) > 20


def test_a_message_older_than_the_episode_is_observed_until_the_next_one() -> None:
    source = world(rover("rover", 0, COMMAND_AND_ODOMETRY + RATE.format(9)))  # one message for eleven control periods
    options: dict[str, Any] = {"observation": {"odom": "/odom"}, "on_reset": moved, "control_period": 0.01}
    assert assert_same_bits(source, 40, time_limit=0.1, **options) >= 9


PUBLISHER = """</plugin><plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">
<odom_topic>true_odom</odom_topic><odom_publish_frequency>{}</odom_publish_frequency>"""


@pytest.mark.parametrize("rate", [30, pytest.param(0, marks=pytest.mark.slow)])
def test_the_odometry_publisher_has_the_bits_of_single_robots(rate: float) -> None:
    source = world(rover("rover", 0, COMMAND_AND_ODOMETRY + ACCELERATION + PUBLISHER.format(rate)))
    options: dict[str, Any] = {"observation": {"true": "/true_odom", "odom": "/odom"}, "on_reset": moved}
    assert assert_same_bits(source, 24, time_limit=0.5, control_period=0.02, **options) == 0
    assert assert_same_bits(source, 20, time_limit=0.5, **options) >= 9


@pytest.mark.parametrize(
    ("plugin", "options", "reason"),
    [
        ("", {"observation": "/odom", "overrides": ()}, "contact law"),
        ("", {"observation": "/model/rover/tf"}, "topic /model/rover/tf"),
        (
            PUBLISHER.format(30) + "<gaussian_noise>0.1</gaussian_noise>",
            {"observation": "/true_odom"},
            "topic /true_odom with <gaussian_noise>",
        ),
        (
            """</plugin><plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl">""",
            {"observation": "/odom"},
            "plugin VelocityControl",
        ),
    ],
)
def test_what_a_batch_of_gazebos_drive_cannot_do_is_named(plugin: str, options: dict[str, Any], reason: str) -> None:
    source = world(rover("rover", 0, COMMAND_AND_ODOMETRY + plugin))
    with pytest.raises(InputError, match=f"SK-GYM-001.*{reason}"):
        simkit.gym.make_vec(source, num_envs=2, batch=True, **{"action": TWIST, "overrides": MUJOCO, **options})


NOISE = """<simkit:odometry_noise><wheel_variance>1e-4</wheel_variance><left_radius_error>0.02</left_radius_error>
<counts_per_revolution>360</counts_per_revolution></simkit:odometry_noise>"""


def test_odometry_with_noise_has_the_bits_of_single_robots() -> None:
    source = world(rover("rover", 0, COMMAND_AND_ODOMETRY + ACCELERATION + NOISE))
    options: dict[str, Any] = {"observation": {"odom": "/odom"}, "on_reset": moved}
    assert assert_same_bits(source, 25, time_limit=0.8, **options) >= 6


@pytest.mark.parametrize("source", [0, 1])
def test_noise_on_the_odometry_of_gazebo_classic_needs_encoders_in_a_batch(source: int) -> None:
    classic = f"""<plugin filename="libgazebo_ros_diff_drive.so" name="drive"><left_joint>left_joint</left_joint>
    <right_joint>right_joint</right_joint><wheel_separation>0.4</wheel_separation><wheel_diameter>0.2</wheel_diameter>
    <publish_odom>true</publish_odom><odometry_source>{source}</odometry_source>{NOISE}</plugin>"""
    robot = re.sub(r"<plugin filename=.gz-sim-diff.*?</plugin>", classic, rover("rover"), flags=re.DOTALL)
    if source == 0:
        assert assert_same_bits(world(robot), 25, 2, time_limit=0.8, observation={"odom": "/odom"}) >= 4
        return
    with pytest.raises(InputError, match="SK-GYM-001.*/odom: ground truth with <odometry_noise>"):
        simkit.gym.make_vec(world(robot), num_envs=2, batch=True, observation="/odom", action=TWIST, overrides=MUJOCO)


def test_a_drive_whose_commands_expire_is_no_drive_of_a_batch() -> None:
    kobuki = """<plugin filename="libgazebo_ros_kobuki.so" name="kobuki">
    <left_wheel_joint_name>left_joint</left_wheel_joint_name>
    <right_wheel_joint_name>right_joint</right_wheel_joint_name></plugin>"""
    robot = re.sub(r"<plugin filename=.gz-sim-diff.*?</plugin>", kobuki, rover("rover"), flags=re.DOTALL)
    action = {"/mobile_base/commands/velocity": TWIST["/cmd_vel"]}
    with pytest.raises(InputError, match="SK-GYM-001.*plugin GazeboRosKobuki"):
        simkit.gym.make_vec(world(robot), num_envs=2, batch=True, observation="rover", action=action, overrides=MUJOCO)


TURTLEBOT3 = Path(__file__).resolve().parents[4] / "shared" / "corpus" / "files" / "ROBOTIS-GIT+turtlebot3_simulations"
TURTLEBOT3_MODELS = TURTLEBOT3 / "turtlebot3_gazebo" / "models"


@pytest.mark.slow
@pytest.mark.skipif(not TURTLEBOT3_MODELS.is_dir(), reason="needs the corpus in ../shared")
def test_the_public_waffle_in_its_world_has_the_bits_of_single_robots() -> None:
    models = "".join(
        f"<include><uri>model://turtlebot3_{name}</uri><pose>{pose} 0 0 0</pose></include>"
        for name, pose in (("world", "0 0 0"), ("waffle", "-2 -0.5 0.01"))
    )
    source = world(models, 0.001).replace("1.5 0 0.5", "9 0 0.5")
    spec = RunSpec(source, name="w", options={"resource_paths": (TURTLEBOT3_MODELS,)})
    observation = {"scan": "/scan", "odom": "/odom", "joints": "/joint_states", "imu": "/imu"}
    assert assert_same_bits(spec, 25, 2, time_limit=1.0, observation=observation, samples_all=False) == 4
