"""Worlds with a small rover of Gazebo Sim, and the comparison of a batch with single environments."""

from __future__ import annotations

from typing import Any

import numpy as np

import simkit.gym
from simkit import RunSpec

MUJOCO = ("physics.contact_law=mujoco",)


def wheel(name: str, x: float, y: float) -> str:
    """Return a wheel of a rover, with its joint."""
    return f"""<link name="{name}"><pose>{x} {y} 0 0 0 0</pose><inertial><mass>0.5</mass><inertia><ixx>0.002</ixx>
<iyy>0.0025</iyy><izz>0.002</izz></inertia></inertial>
<collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link>
<joint name="{name}_joint" type="revolute"><parent>base</parent><child>{name}</child>
<axis><xyz>0 1 0</xyz><limit><lower>-1e16</lower><upper>1e16</upper><velocity>9</velocity></limit></axis></joint>"""


def rover(name: str, y: float = 0.0, options: str = "", front: bool = False, sensors: str = "") -> str:
    """Return a model with a lidar, an IMU and a differential drive; with `front`, there are four wheels."""
    wheels = [wheel("left", -0.1, 0.2), wheel("right", -0.1, -0.2)]
    wheels += [wheel("front_left", 0.16, 0.2), wheel("front_right", 0.16, -0.2)] if front else []
    more = "<left_joint>front_left_joint</left_joint><right_joint>front_right_joint</right_joint>" if front else ""
    return f"""<model name="{name}"><pose>0 {y} 0.1 0 0 0.3</pose>
<link name="base"><inertial><pose>0.02 0 0 0 0 0</pose><mass>8</mass>
<inertia><ixx>0.1</ixx><iyy>0.15</iyy><izz>0.2</izz></inertia></inertial>
<collision name="body"><pose>0 0 0.06 0 0 0</pose><geometry><box><size>0.45 0.3 0.08</size></box></geometry></collision>
<collision name="caster"><pose>0.18 0 -0.06 0 0 0</pose><geometry><sphere><radius>0.04</radius></sphere></geometry>
<surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction></surface></collision>
<sensor name="imu" type="imu"><topic>{name}/imu</topic><update_rate>50</update_rate></sensor>
<sensor name="lidar" type="gpu_lidar"><pose>0 0 0.15 0 0 0</pose><topic>{name}/scan</topic><update_rate>10</update_rate>
<lidar><scan><horizontal><samples>24</samples><min_angle>-3</min_angle><max_angle>3</max_angle></horizontal></scan>
<range><min>0.1</min><max>6</max></range><noise><type>gaussian</type><stddev>0.01</stddev></noise></lidar></sensor>
{sensors}</link>{"".join(wheels)}
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
<left_joint>left_joint</left_joint><right_joint>right_joint</right_joint>{more}
<wheel_separation>0.4</wheel_separation><wheel_radius>0.1</wheel_radius>
<frame_id>odom</frame_id><child_frame_id>base</child_frame_id>{options}</plugin>
<plugin filename="gz-sim-joint-state-publisher-system" name="gz::sim::systems::JointStatePublisher"/></model>"""


def world(models: str, step: float = 0.002) -> str:
    """Return a world with the usual systems of Gazebo, a ground, a post and some models."""
    return f"""<sdf version="1.9"><world name="w">
<physics type="ignored"><max_step_size>{step}</max_step_size></physics>
<plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>
<plugin filename="gz-sim-user-commands-system" name="gz::sim::systems::UserCommands"/>
<plugin filename="gz-sim-scene-broadcaster-system" name="gz::sim::systems::SceneBroadcaster"/>
<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>
<plugin filename="gz-sim-imu-system" name="gz::sim::systems::Imu"/>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane><normal>0 0 1</normal>
<size>50 50</size></plane></geometry></collision></link></model>
<model name="post"><static>true</static><pose>1.5 0 0.5 0 0 0</pose><link name="l"><collision name="c"><geometry>
<cylinder><radius>0.2</radius><length>1</length></cylinder></geometry></collision></link></model>
{models}</world></sdf>"""


COMMAND_AND_ODOMETRY = "<topic>cmd_vel</topic><odom_topic>odom</odom_topic>"
ACCELERATION = "<max_acceleration>1.5</max_acceleration><min_acceleration>-2</min_acceleration>"
JERK = "<max_linear_jerk>4</max_linear_jerk><min_jerk>-6</min_jerk><max_linear_velocity>0.8</max_linear_velocity>"
RATE = "<odom_publish_frequency>{}</odom_publish_frequency>"
TWIST = {"/cmd_vel": {"linear.x": (-0.5, 1.0), "angular.z": (-2.0, 2.0)}}


def assert_same_bits(
    source: str | RunSpec, steps: int, count: int = 3, *, vector: Any = (("batch", True),), **options: Any
) -> int:
    """Compare all bits of a batch with single environments, and return the number of episodes that ended."""
    options = {"action": TWIST, "overrides": MUJOCO, "control_period": 0.1, **options}
    batch: Any = simkit.gym.make_vec(source, num_envs=count, **dict(vector), **options)
    single: Any = simkit.gym.make_vec(source, num_envs=count, processes=False, **options)
    random, ends = np.random.default_rng(3), 0
    low, high = batch.single_action_space.low, batch.single_action_space.high
    found, expected = batch.reset(seed=7), single.reset(seed=7)
    for step in range(steps):
        for name, values in expected[0].items():
            assert found[0][name].tobytes() == values.tobytes(), (step, name)
        actions = random.uniform(low, high, (count, len(low)))
        found, expected = batch.step(actions), single.step(actions)
        for mine, other in zip(found[1:4], expected[1:4], strict=True):
            assert np.array_equal(mine, other), step
        ends += int((expected[2] | expected[3]).sum())
    batch.close()
    single.close()
    return ends
