"""Free motions: the state at the beginning comes from the recording, and friction is found from many short parts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fit_worlds import record

import simkit
from simkit import InputError, Pose
from simkit_identification.fitting.motion import Motion

MU = "cube::cube::c.surface.friction.ode.mu"


def cube(mu: float) -> str:
    """Return a cube of 0.1 m above a plane, with its odometry."""
    friction = f"<surface><friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction></surface>"
    return f"""<sdf version="1.9"><world name="w"><physics type="ignored"><max_step_size>0.002</max_step_size></physics>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane><normal>0 0 1</normal>
</plane></geometry><surface><friction><ode><mu>1</mu><mu2>1</mu2></ode></friction></surface></collision></link></model>
<model name="cube"><pose>0 0 0.5 0 0 0</pose><link name="cube"><inertial><mass>0.4</mass>
<inertia><ixx>0.0006</ixx><iyy>0.0006</iyy><izz>0.0006</izz></inertia></inertial>
<collision name="c"><geometry><box><size>0.1 0.1 0.1</size></box></geometry>{friction}</collision></link>
<plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">
<dimensions>3</dimensions><odom_publish_frequency>100</odom_publish_frequency><odom_topic>/cube/odom</odom_topic>
<robot_base_frame>cube</robot_base_frame></plugin></model></world></sdf>"""


def toss(sim: simkit.Simulation, speed: float, noise: float, seed: int) -> Motion:
    """Let the cube slide and tumble; return its recorded motion with noise [m]."""
    random = np.random.default_rng(seed)
    model = sim.model("cube")
    model.set_pose(Pose.from_rpy(0, 0, 0.06, 0.1 * seed, 0.05, 0.3 * seed))
    model.set_velocity((speed, 0.3, 0.0), (1.0, 0.5 * seed, 0.0))
    rows: list[Any] = []
    for _ in range(30):
        link = sim.link("cube::cube")
        pose = model.pose
        rows.append((sim.time, *pose.position, *pose.quaternion, *link.linear_velocity, *link.angular_velocity))
        sim.step(5)
    data = np.array(rows)
    data[:, 1:4] += noise * random.standard_normal((len(data), 3))
    return Motion("cube", data[:, 0], data[:, 1:4], data[:, 4:8], data[:, 8:11], data[:, 11:14], f"toss {seed}")


@pytest.mark.slow
def test_friction_comes_back_from_short_parts_of_tosses() -> None:
    motions = []
    for number in range(2):
        with simkit.load(cube(0.18)) as sim:
            motions.append(toss(sim, 1.0 + 0.3 * number, 0.0005, number))
    result = simkit.fit(cube(0.5), motions, f"{MU}=0.02:1", window=0.1)
    low, high = result.intervals[MU]
    assert result.values[MU] == pytest.approx(0.18, abs=0.02)
    assert low < 0.18 < high and high - low < 0.1


@pytest.mark.slow
def test_a_bag_of_poses_is_a_free_motion(tmp_path: Path) -> None:
    def slide(sim: simkit.Simulation) -> None:
        sim.model("cube").set_pose(Pose.from_rpy(0, 0, 0.05, 0, 0, 0))
        sim.model("cube").set_velocity((1.0, 0.0, 0.0))
        sim.run(0.4)

    bag = record(cube(0.3), tmp_path / "slide.mcap", slide, topics=["/cube/odom"])
    result = simkit.fit(cube(0.6), bag, f"{MU}=0.05:1", motion="cube=/cube/odom")
    assert result.values[MU] == pytest.approx(0.3, abs=0.02)


def test_velocities_of_a_motion_come_from_its_poses() -> None:
    times = np.arange(11) * 0.01
    turn = 2.0 * times
    quaternions = np.stack((np.cos(turn / 2), 0 * turn, 0 * turn, np.sin(turn / 2)), axis=1)
    motion = Motion("cube", times, np.stack((3.0 * times, 0 * times, 0 * times), axis=1), quaternions)
    linear, angular = motion.velocities()
    assert linear == pytest.approx(np.tile([3.0, 0.0, 0.0], (11, 1)), abs=1e-9)
    assert angular == pytest.approx(np.tile([0.0, 0.0, 2.0], (11, 1)), abs=1e-9)
    assert motion.windows(0.05) == [(0, 5), (5, 10)] and motion.windows(None) == [(0, 10)]


@pytest.mark.parametrize(
    "model, times, text",
    [("ball", [0, 1, 2], "no model 'ball'"), ("cube", [0, 2, 1], "ascending"), ("ground", [0, 1, 2], "static")],
)
def test_a_mistake_in_a_motion_has_a_message(model: str, times: list[float], text: str) -> None:
    def run() -> None:
        motion = Motion(model, np.array(times, dtype=float), np.zeros((3, 3)), np.tile([1.0, 0, 0, 0], (3, 1)))
        simkit.fit(cube(0.5), motion, MU)

    with pytest.raises(InputError, match=text) as error:
        run()
    assert error.value.code == "SK-FIT-011"
