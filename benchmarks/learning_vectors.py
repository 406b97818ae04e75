"""Vector environments beside MuJoCo's batch, processes, and the environments of other projects.

python benchmarks/learning_vectors.py [--rounds N] [--environments N] [--processes N]

One step is 0.1 s of `simkit/TurtleBot3Goal-v0` with a fresh scan of 360 rays in each environment. MuJoCo's batch makes
the same steps from the same states with the same rays, on the same threads. Then the drives of Gazebo Sim and of Gazebo
Classic are compared in `turtlebot3_world`. The sides take turns; wall times, because both use all processors, but CPU
times for the peers. `--processes 0` leaves out the processes.
"""

from __future__ import annotations

import argparse
import re
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import fleet
import measure  # noqa: F401 - makes simkit importable
import mujoco
import numpy as np
from mujoco.batch import Batch

import simkit.gym
from simkit.install_command import install_command

ENVIRONMENT, SENSOR, PERIOD = "simkit/TurtleBot3Goal-v0", "turtlebot3::base_scan::lds", 0.1
_VELOCITIES = int(mujoco.mjtStage.mjSTAGE_VEL)


def bare_batch(envs: Any) -> Callable[[], object]:
    """The same steps and rays with MuJoCo's batch alone, from the present states of the environments."""
    physics, sim, count = envs._physics, envs._sim, envs.num_envs
    fan, threads = sim.sensor(SENSOR).fan, physics.batch.nthread
    steps = Batch(sim.mj_model, count, threads, persistent=True)
    rays = Batch(fan.targets.shapes_by_engine.model_for_rows(False), count, threads)
    positions, turns, controls = steps.bind("xpos"), steps.bind("xmat"), steps.bind("ctrl")
    number = round(PERIOD / sim.timestep)

    def step() -> object:
        steps.state[:] = physics.batch.state
        controls[:] = envs.view.ctrl
        steps.step(None, number, _VELOCITIES)
        turned = fan.directions @ turns[:, fan.body].reshape(-1, 3, 3).transpose(0, 2, 1)
        return rays.ray(np.broadcast_to(positions[:, fan.body][:, None], turned.shape), turned)

    return step


def medians(
    sides: Mapping[str, Callable[[], object]], rounds: int, clock: Callable[[], float] = time.perf_counter
) -> dict[str, float]:
    """Medians of the times [s] of all sides, which take turns."""
    times: dict[str, list[float]] = {name: [] for name in sides}
    for _ in range(rounds + 2):
        for name, side in sides.items():
            begun = clock()
            side()
            times[name].append(clock() - begun)
    return {name: float(np.median(found[2:])) for name, found in times.items()}


def vectors(count: int, processes: int, rounds: int) -> None:
    batch = simkit.gym.make_vec(ENVIRONMENT, num_envs=count)
    batch.reset(seed=0)
    random = np.random.default_rng(0)
    sides: dict[str, Callable[[], object]] = {
        "simkit's batch": lambda: batch.step(random.uniform(-1, 1, (count, 2))),
        "MuJoCo's batch": bare_batch(batch),
    }
    others: dict[str, Any] = {}
    for name, law in (("processes", "mujoco"), ("processes, simkit's contact law", "simkit")) if processes else ():
        options = {"processes": True, "overrides": (f"physics.contact_law={law}",)}
        others[name] = simkit.gym.make_vec(ENVIRONMENT, num_envs=processes, **options)
        others[name].reset(seed=0)
        sides[name] = lambda envs=others[name]: envs.step(random.uniform(-1, 1, (processes, 2)).astype(np.float32))
    found = medians(sides, rounds)
    ours = found["simkit's batch"] / count
    for name, seconds in found.items():
        each = seconds / (processes if name in others else count)
        print(f"{name:34s} {each * 1e6:8.0f} us for each environment   {name} / ours {each / ours:5.2f}")
    for envs in (batch, *others.values()):
        envs.close()


def drives(count: int, processes: int, rounds: int) -> None:
    """Burgers with Gazebo Sim's drive, with limited acceleration, in `turtlebot3_world`, and with Gazebo Classic's."""
    source = (Path(__file__).resolve().parents[1] / "worlds" / "turtlebot3_world.sdf").read_text(encoding="utf-8")
    robot = fleet.SYSTEMS + fleet.robot("turtlebot3", -2.0, -0.5, "gz")
    gazebo = re.sub(r"<include>.*?</include>", robot, source, flags=re.DOTALL)
    lidar = "/world/turtlebot3_world/model/turtlebot3/link/base_scan/sensor/lds/lidar"
    of_gazebo = gazebo, lidar, "/model/turtlebot3/odometry", "/model/turtlebot3/cmd_vel"
    of_classic = source.replace("//turtlebot3<", "//turtlebot3_burger<"), "/scan", "/odom", "/cmd_vel"

    def make(names: tuple[str, ...], number: int, **options: Any) -> Any:
        world, scan, odom, command = names
        twist = {command: {"linear.x": (0.0, 0.22), "angular.z": (-1.5, 1.5)}}
        given = {"observation": {"scan": scan, "odom": odom}, "action": twist, "samples_all": False, **options}
        return simkit.gym.make_vec(world, num_envs=number, overrides=("physics.contact_law=mujoco",), **given)

    made = {
        "batch, Gazebo Sim's drive": make(of_gazebo, count, batch=True),
        "batch, Gazebo Classic's drive": make(of_classic, count, batch=True),
        "one by one, Gazebo Sim's drive": make(of_gazebo, 4, processes=False),
    }
    if processes:
        made["processes, Gazebo Sim's drive"] = make(of_gazebo, processes, processes=True)
    random = np.random.default_rng(0)

    def side(envs: Any) -> Callable[[], object]:
        envs.reset(seed=0)
        return lambda: envs.step(random.uniform((0.0, -1.5), (0.22, 1.5), (envs.num_envs, 2)).astype(np.float32))

    found = medians({name: side(envs) for name, envs in made.items()}, rounds)
    each = {name: seconds / made[name].num_envs for name, seconds in found.items()}
    ours = each["batch, Gazebo Sim's drive"]
    for name, seconds in each.items():
        print(f"{name:34s} {seconds * 1e6:8.0f} us for each environment   {name} / ours {seconds / ours:5.2f}")
    for envs in made.values():
        envs.close()


# ---------------------------------------------------------------------- peers


def simkit_single(*overrides: str) -> Callable[[], object]:
    env = simkit.gym.make(ENVIRONMENT, overrides=overrides)
    env.reset(seed=0)

    def second() -> None:
        for _ in range(10):
            if any(env.step((0.2, 0.3))[2:4]):
                env.reset()

    return second


def ant() -> Callable[[], object]:
    """One simulated second of Gymnasium's Ant-v5, whose steps are 0.01 s."""
    import gymnasium

    env = gymnasium.make("Ant-v5")
    env.reset(seed=0)
    action, steps = 0.3 * np.ones(8), round(1.0 / env.unwrapped.dt)  # type: ignore[attr-defined]

    def second() -> None:
        for _ in range(steps):
            if any(env.step(action)[2:4]):
                env.reset()

    return second


ROBOT = """<robot name="turtlebot"><link name="base">
<inertial><mass value="1.4"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="-0.06 0 0.04"/><geometry><box size="0.27 0.27 0.09"/></geometry></collision>
<collision><origin xyz="-0.18 0 -0.023"/><geometry><sphere radius="0.01"/></geometry></collision></link>%s</robot>"""
WHEEL = """<link name="%s"><inertial><mass value="0.03"/><inertia ixx="2e-5" iyy="2e-5" izz="2e-5" ixy="0" ixz="0"
iyz="0"/></inertial><collision><geometry><cylinder radius="0.033" length="0.018"/></geometry></collision></link>
<joint name="j_%s" type="continuous"><parent link="base"/><child link="%s"/><origin xyz="0 %s 0" rpy="-1.5708 0 0"/>
<axis xyz="0 0 1"/></joint>"""


def pybullet_robot() -> Callable[[], object]:
    """One simulated second of a robot like the TurtleBot3 in PyBullet: steps of 1 ms, ten scans of 360 rays."""
    import pybullet

    client = pybullet.connect(pybullet.DIRECT)
    own = {"physicsClientId": client}
    pybullet.setGravity(0, 0, -9.81, **own)
    pybullet.setPhysicsEngineParameter(fixedTimeStep=0.001, **own)
    pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE, **own), **own)
    pillar = pybullet.createCollisionShape(pybullet.GEOM_CYLINDER, radius=0.15, height=0.5, **own)
    for x in (-1.1, 0.0, 1.1):
        for y in (-1.1, 0.0, 1.1):
            pybullet.createMultiBody(0, pillar, -1, (x, y, 0.25), **own)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "robot.urdf"
        path.write_text(ROBOT % "".join(WHEEL % (s, s, s, y) for s, y in (("left", 0.144), ("right", -0.144))))
        robot = pybullet.loadURDF(str(path), (-0.5, -0.5, 0.034), **own)
    angles = np.linspace(0.0, 2 * np.pi, 360)
    ends = 3.5 * np.column_stack((np.cos(angles), np.sin(angles), np.zeros(360)))

    def second() -> None:
        for _ in range(10):
            for joint, speed in ((0, 3.0), (1, 4.0)):
                pybullet.setJointMotorControl2(
                    robot, joint, pybullet.VELOCITY_CONTROL, targetVelocity=speed, force=5, **own
                )
            for _ in range(100):
                pybullet.stepSimulation(**own)
            place = np.add(pybullet.getBasePositionAndOrientation(robot, **own)[0], (0.0, 0.0, 0.15))
            pybullet.rayTestBatch([place.tolist()] * 360, (place + ends).tolist(), **own)

    return second


def peers(rounds: int) -> None:
    sides = {"simkit, steps of 1 ms": simkit_single()}
    sides["simkit, steps of 5 ms"] = simkit_single("physics.max_step_size=0.005")
    for name, make in (("PyBullet, steps of 1 ms", pybullet_robot), ("Gymnasium's Ant-v5, steps of 10 ms", ant)):
        try:
            sides[name] = make()
        except ImportError as error:
            print(f"{name:34s} left out: {error}; {install_command('compare')} 'gymnasium[mujoco]'")
    found = medians(sides, rounds, time.process_time)
    ours = found["simkit, steps of 1 ms"]
    for name, seconds in found.items():
        print(f"{name:34s} {seconds * 1e3:8.1f} ms for a simulated second   {name} / ours {seconds / ours:5.2f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--rounds", type=int, default=20)
    parser.add_argument("--environments", type=int, default=64)
    parser.add_argument("--processes", type=int, default=16)
    options = parser.parse_args()
    vectors(options.environments, options.processes, options.rounds)
    drives(options.environments, options.processes, options.rounds)
    peers(options.rounds)


if __name__ == "__main__":
    main()
