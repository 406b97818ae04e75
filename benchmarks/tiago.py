"""TIAGo: its load and its steps beside bare MuJoCo, and how much faster than real time it is in the office.

python benchmarks/tiago.py [--rounds N] [--seconds S] [--profile] [--model NAME]

Loads are timed as in robot_loading.py. Steps with all controllers running (at rest; and with base, torso, head, arm
and gripper moving at once) stand beside `mj_step` on a copy of the same model and state. In the office all that the
robot's sensors, wheels and joints tell is read but pictures; the engine's part of the time is told beside it.
"""

from __future__ import annotations

import argparse
import cProfile
import os
import pstats
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable

import measure  # noqa: F401 - finds simkit in the checkout
from robot_loading import compare

import simkit
from simkit.cli.bench_bare_mujoco import BareEngine
from simkit.cli.bench_figures import time_interleaved

OFFICE = "simple_office_with_people"
CHUNK = 500  # steps of a round
OWN = ("/joint_states", "/mobile_base_controller/odom", "/tf", "/base_imu", "/ft_sensor_controller/wrench")
PICTURES = ("Image", "CameraInfo", "PointCloud2")
DRIVE = "/mobile_base_controller/cmd_vel_unstamped"
GOALS = {
    "arm": {f"arm_{i}_joint": p for i, p in enumerate((1.0, 0.3, -1.0, 1.2, -0.5, 0.3, 0.2), 1)},
    "torso": {"torso_lift_joint": 0.3},
    "head": {"head_1_joint": 0.4, "head_2_joint": -0.3},
    "gripper": {"gripper_left_finger_joint": 0.03, "gripper_right_finger_joint": 0.03},
}


def tiago_in(world: str, name: str, step: float = 0.0) -> simkit.Simulation:
    """A world with TIAGo in it; `step` [s] in place of the world's own."""
    sim = simkit.load(world, overrides=[f"physics.max_step_size={step}"] if step else [])
    sim.spawn(name, name="tiago")
    return sim


# ---------------------------------------------------------------------- load


def cold(name: str) -> float:
    """Wall time [s] of the first load there ever was: a new process, imports, nothing converted before."""
    program = (
        "import time; t = time.perf_counter(); import simkit; s = simkit.load({!r}); print(time.perf_counter() - t)"
    )
    with tempfile.TemporaryDirectory() as cache:
        environment = os.environ | {"SIMKIT_CACHE_DIR": cache}
        command = [sys.executable, "-c", program.format(name)]
        done = subprocess.run(command, check=True, capture_output=True, text=True, env=environment)
    return float(done.stdout.split()[-1])


def loads(name: str) -> list[str]:
    first = statistics.median(cold(name) for _ in range(3))
    return [f"load, first ever, imports counted: {first:.2f} s   aim <= 1", *compare([name])]


# ---------------------------------------------------------------------- steps


def start_moving(sim: simkit.Simulation, seconds: float) -> None:
    """Sends every joint somewhere, to be there after some seconds."""
    whole = {"sec": int(seconds), "nanosec": 0}
    for controller, wanted in GOALS.items():
        if not set(wanted) <= set(sim.model("tiago").joints):
            continue
        point = {"positions": list(wanted.values()), "time_from_start": whole}
        message = {"joint_names": list(wanted), "points": [point]}
        sim.publish(f"/{controller}_controller/joint_trajectory", message)


def drive(sim: simkit.Simulation) -> None:
    sim.publish(DRIVE, {"linear": {"x": 0.1}, "angular": {"z": 0.2}})


def steps(name: str, rounds: int) -> list[str]:
    lines = []
    for what in ("at rest", "all of it moving"):
        with tiago_in("empty", name) as sim:
            sim.step(1000)
            if what != "at rest":
                start_moving(sim, 30.0)

            def ours(sim: simkit.Simulation = sim, moves: bool = what != "at rest") -> None:
                for _ in range(5):  # a command every 100 steps
                    if moves:
                        drive(sim)
                    sim.step(CHUNK // 5)

            ours()
            bare = BareEngine(sim)
            mine, theirs = time_interleaved([ours, lambda bare=bare: bare.step(CHUNK)], rounds)  # type: ignore[misc]
            text = f"step, all controllers, {what}: {mine / CHUNK * 1e6:.1f} us, bare {theirs / CHUNK * 1e6:.1f} us"
            lines.append(f"{text}, ratio {mine / theirs:.2f}   aim <= 1.25")
    return lines


# ---------------------------------------------------------------------- real time


def read_all_but_pictures(sim: simkit.Simulation) -> int:
    """Has every message of the robot's sensors, its joints, its odometry and its frames made."""
    sensed = {topic for sensor in sim.contents.sensors.values() for topic in sensor._topics.values()}
    told = sim.topics()
    topics = [t for t in sorted({*sensed, *OWN}) if t in told and told[t].rpartition("/")[2] not in PICTURES]
    for topic in topics:
        sim.subscribe(topic, callback=lambda _message: None)
    return len(topics)


def office(name: str, seconds: float, step: float, profile: bool) -> list[str]:
    """Driving and moving in the office, everything but pictures read."""
    with tiago_in(OFFICE, name, step) as sim:
        count = read_all_but_pictures(sim)
        sim.run(1.0)

        def live(seconds: float) -> None:
            start_moving(sim, seconds)
            for _ in range(round(seconds * 10)):
                drive(sim)
                sim.run(0.1)

        taken = timed(lambda: live(seconds))
        at = f"at {sim.timestep * 1000:g} ms, {count} topics read"
        lines = [f"in the office, {at}: {seconds / taken:.1f} times real time   aim >= 10"]
        bare = BareEngine(sim)
        engine = timed(lambda: bare.step(round(seconds / sim.timestep)))
        lines.append(f"the engine alone there: {seconds / engine:.1f} times, {engine / taken:.0%} of it")
        if profile:
            profiler = cProfile.Profile()
            profiler.runcall(live, min(seconds, 5.0))
            pstats.Stats(profiler).sort_stats("tottime").print_stats(25)
    return lines


def timed(action: Callable[[], object]) -> float:
    start = time.process_time()
    action()
    return time.process_time() - start


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--rounds", type=int, default=15, help="timings taken of each side")
    parser.add_argument("--seconds", type=float, default=10.0, help="simulated, in the office")
    parser.add_argument("--model", default="tiago", help="tiago, tiago_no_arm or pmb2")
    parser.add_argument("--profile", action="store_true", help="what takes the time in the office")
    args = parser.parse_args()
    for part in (
        lambda: loads(args.model),
        lambda: steps(args.model, args.rounds),
        lambda: office(args.model, args.seconds, 0.0, args.profile),
        lambda: office(args.model, args.seconds, 0.002, profile=False),
    ):
        print("\n".join(part()), flush=True)


if __name__ == "__main__":
    main()
