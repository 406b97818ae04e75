"""Vector environments beside MuJoCo's batch, processes, and the environments of other projects.

python benchmarks/learning_vectors.py [--rounds N] [--environments N] [--processes N] [--many N,N,…]

One step is 0.1 s of `simkit/TurtleBot3Goal-v0` with a fresh scan of 360 rays in each environment. MuJoCo's batch makes
the same steps from the same states with the same controls and rays, on the same threads. Then the drives of Gazebo Sim
and of Gazebo Classic are compared in `turtlebot3_world`. The sides take turns; wall times, because both use all
processors, but CPU times for the peers. Pictures a second, and start and memory of many environments follow.
`--processes 0` leaves out the processes, `--many ""` the many environments.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
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


class BareBatch:
    """The last step of the environments with MuJoCo's batch alone: the same states, controls, steps and rays.

    The controls change at the ticks of the drive and of the servos; a program for MuJoCo's batch divides its steps
    there, too. Constant controls would need fewer iterations of MuJoCo's solver.
    """

    def __init__(self, envs: Any) -> None:
        self._physics, sim, count = envs._physics, envs._sim, envs.num_envs
        self._fan, threads = sim.sensor(SENSOR).fan, self._physics.batch.nthread
        model = self._physics._models[0]
        self._steps = Batch(model, count, threads)
        self._rays = Batch(self._fan.targets.shapes_by_engine.model_for_rows(False), count, threads)
        self._positions, self._turns = self._steps.bind("xpos"), self._steps.bind("xmat")
        self._controls = self._steps.bind("ctrl")
        self._parts: list[tuple[int, Any]] = []
        self._begin = self._physics.batch.state.copy()
        engine_step, view = self._physics.batch.step, envs.view

        def step(ids: Any, number: int, stage: int) -> None:
            if not self._parts:
                self._begin = self._physics.batch.state.copy()
            self._parts.append((number, view.ctrl.copy()))
            engine_step(ids, number, stage)

        self._physics.batch.step = step

    def forget(self) -> None:
        """Record the next step of the environments."""
        self._parts.clear()

    def step(self) -> object:
        """Repeat the recorded step."""
        self._steps.state[:] = self._begin
        for place, (number, controls) in enumerate(self._parts):
            self._controls[:] = controls
            self._steps.step(None, number, _VELOCITIES if place == len(self._parts) - 1 else 0)
        fan, turns = self._fan, self._turns
        turned = fan.directions @ turns[:, fan.body].reshape(-1, 3, 3).transpose(0, 2, 1)
        return self._rays.ray(np.broadcast_to(self._positions[:, fan.body][:, None], turned.shape), turned)


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
    random, bare = np.random.default_rng(0), BareBatch(batch)

    def step() -> None:
        bare.forget()
        batch.step(random.uniform(-1, 1, (count, 2)))

    sides: dict[str, Callable[[], object]] = {"simkit's batch": step, "MuJoCo's batch": bare.step}
    others: dict[str, Any] = {}
    kinds: list[tuple[str, str, Any]] = []
    if processes:
        kinds.append(("processes", "mujoco", True))
        kinds.append(("turns in two processes", "mujoco", 2))
        kinds.append(("processes, simkit's contact law", "simkit", True))
        kinds.append(("turns, simkit's contact law", "simkit", 2))
    for name, law, given in kinds:
        options = {"processes": given, "overrides": (f"physics.contact_law={law}",)}
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


def pictures(count: int, rounds: int, size: int = 64) -> None:
    """Pictures of a camera on each of so many burgers, drawn by the software renderer in one step of a batch."""
    text = fleet.robot("turtlebot3", -2.0, -0.5, "classic")
    text = text.replace("<ros><namespace>turtlebot3</namespace></ros>", "").replace(
        "<namespace>turtlebot3</namespace>", ""
    )
    place = text.index("</link>", text.index('name="base_scan"'))
    text = text[:place] + CAMERA.format(size=size) + text[place:]
    source = (Path(__file__).resolve().parents[1] / "worlds" / "turtlebot3_world.sdf").read_text(encoding="utf-8")
    world = re.sub(r"<include>.*?</include>", lambda _: text, source, count=1, flags=re.DOTALL)
    twist = {"/cmd_vel": {"linear.x": (0.0, 0.22), "angular.z": (-1.5, 1.5)}}
    options: dict[str, Any] = {"action": twist, "samples_all": False}
    options["overrides"] = ("physics.contact_law=mujoco", "scene.renderer=software")
    seeing = simkit.gym.make_vec(world, num_envs=count, batch=True, observation={"eye": "/eye"}, **options)
    blind = simkit.gym.make_vec(world, num_envs=count, batch=True, observation={"p": "turtlebot3"}, **options)
    random, sides = np.random.default_rng(0), {}
    for name, envs in (("with pictures", seeing), ("without", blind)):
        envs.reset(seed=0)
        sides[name] = lambda envs=envs: envs.step(random.uniform((0.0, -1.5), (0.22, 1.5), (count, 2)))
    for label, clock in (("of wall time", time.perf_counter), ("of CPU time", time.process_time)):
        found = medians(sides, rounds, clock)
        rate = count / (found["with pictures"] - found["without"])
        print(f"{count} pictures of {size} x {size} in a step: {rate:6.0f} pictures a second {label}")
    seeing.close()
    blind.close()


CAMERA = """<sensor name="eye" type="camera"><topic>eye</topic><update_rate>10</update_rate><camera>
<horizontal_fov>1.2</horizontal_fov><image><width>{size}</width><height>{size}</height></image>
<clip><near>0.05</near><far>20</far></clip></camera></sensor>"""

MANY = """
import sys, time
import numpy as np
import simkit.gym
def memory():
    with open("/proc/self/status") as lines:
        return next(int(line.split()[1]) / 1024 for line in lines if line.startswith("VmRSS"))
count, options = int(sys.argv[1]), eval(sys.argv[2])
one = simkit.gym.make_vec("simkit/TurtleBot3Goal-v0", num_envs=1, **options)
one.reset(seed=0)
one.step(np.zeros((1, 2)))
before, begun = memory(), time.process_time()
envs = simkit.gym.make_vec("simkit/TurtleBot3Goal-v0", num_envs=count, **options)
envs.reset(seed=0)
begun = time.process_time() - begun
envs.step(np.zeros((count, 2)))
print(f"{count:6d} environments   start {begun:6.2f} s   {(memory() - before) * 1024 / count:7.1f} kB for each")
"""


def many(counts: Sequence[int]) -> None:
    """Start and memory of many environments, each number in a process of its own (Linux)."""
    for name, options in (
        ("batch", {}),
        ("turns, simkit's contact law", {"processes": 1, "overrides": ("physics.contact_law=simkit",)}),
    ):
        for count in counts:
            print(f"{name:34s} ", end="", flush=True)
            subprocess.run([sys.executable, "-c", MANY, str(count), repr(options)], check=True)


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
    parser.add_argument("--many", default="64,1024,4096", help="numbers of environments whose memory is measured")
    options = parser.parse_args()
    vectors(options.environments, options.processes, options.rounds)
    drives(options.environments, options.processes, options.rounds)
    pictures(options.environments, options.rounds)
    many([int(number) for number in options.many.split(",") if number])
    peers(options.rounds)


if __name__ == "__main__":
    main()
