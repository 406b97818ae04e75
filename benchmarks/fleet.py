"""Many TurtleBots in one world beside bare steps and bare rays of the same model, and what grows how.

python benchmarks/fleet.py [--robots 1 10 50 100] [--kind gz] [--rounds N] [--plot fleet.png]

Each robot has a differential drive, an IMU (200 Hz) and a planar lidar (5 Hz, 360 rays), and drives in a circle. Bare
is `mj_step` on a copy of the same model and state, with `mj_multiRay` of the same rays as often as there are scans;
both sides in turn, medians of CPU time.
"""

from __future__ import annotations

import argparse
import re
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import measure  # noqa: F401  (finds simkit beside it)

import simkit
from simkit import msgs
from simkit.cli.bench_bare_mujoco import BareEngine, cast_bare_scan
from simkit.cli.bench_figures import time_interleaved

BURGER = Path(__file__).resolve().parents[1] / "assets" / "turtlebot3" / "turtlebot3_burger" / "model.sdf"
SPACING = 2.0  # [m]
STRETCH = 200  # steps between two scans of a lidar of 5 Hz

DRIVE = """
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
  <left_joint>wheel_left_joint</left_joint><right_joint>wheel_right_joint</right_joint>
  <wheel_separation>0.16</wheel_separation><wheel_radius>0.033</wheel_radius>
  <max_linear_acceleration>1</max_linear_acceleration><min_linear_acceleration>-1</min_linear_acceleration>
</plugin>
"""
WORLD = """
<sdf version="1.9"><world name="fleet">
<physics type="ignored"><max_step_size>0.001</max_step_size></physics>
{plugins}
<include><uri>model://ground_plane</uri></include>
{robots}
</world></sdf>
"""
SYSTEMS = """
<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>
<plugin filename="gz-sim-imu-system" name="gz::sim::systems::Imu"/>
"""


READ = frozenset(
    {
        "sensor_msgs/msg/Imu",
        "sensor_msgs/msg/LaserScan",
        "nav_msgs/msg/Odometry",
        "tf2_msgs/msg/TFMessage",
        "sensor_msgs/msg/JointState",
    }
)


@dataclass(frozen=True)
class Row:
    """What was measured of so many robots; times in s, a step unless said otherwise.

    Attributes:
        load: of the whole world; `spawn` of one more robot.
        bare: of the engine's steps, `rays` of its rays.
        unread, later, called: ours where nobody reads, where the newest message of every topic is kept, and where
            somebody is called back with every message.
        messages: a second of simulated time.
    """

    robots: int
    load: float
    spawn: float
    bare: float
    rays: float
    unread: float
    later: float
    called: float
    messages: int

    @property
    def beside(self) -> float:
        return self.bare + self.rays


def robot(name: str, x: float, y: float, kind: str) -> str:
    """A burger of its own name, with gz's drive or with Gazebo Classic's plugins in a namespace."""
    text = BURGER.read_text(encoding="utf-8")
    text = text[text.index("<model") : text.rindex("</model>")]
    text = text.replace('name="turtlebot3_burger"', f'name="{name}"', 1)
    text = text.replace(">", f"><pose>{x} {y} 0 0 0 0</pose>", 1)
    if kind == "gz":
        text = re.sub(r"<plugin.*?</plugin>", "", text, flags=re.DOTALL) + DRIVE
    else:
        text = text.replace("<ros>", f"<ros><namespace>{name}</namespace>")
        alone = r'(<plugin name="(?:diff_drive|joint_states)"[^>]*>)'
        text = re.sub(alone, rf"\1<ros><namespace>{name}</namespace></ros>", text)
    return text + "</model>"


def place(number: int, robots: int) -> tuple[float, float]:
    """Where a robot stands on a square grid [m]."""
    side = round(robots**0.5 + 0.499)
    return SPACING * (number % side), SPACING * (number // side)


def world(robots: int, kind: str) -> str:
    """A plain with so many robots on a square grid."""
    there = "".join(robot(f"burger_{i}", *place(i, robots), kind) for i in range(robots))
    return WORLD.format(plugins=SYSTEMS if kind == "gz" else "", robots=there)


def drive(sim: Any) -> None:
    """Sends every robot round in a circle."""
    for topic in sim.topics():
        if topic.endswith("cmd_vel"):
            sim.publish(topic, {"linear": {"x": 0.1}, "angular": {"z": 0.3}})


def measured(robots: int, kind: str, rounds: int) -> Row:
    start = time.process_time()
    sim = simkit.load(world(robots, kind))
    load = time.process_time() - start
    drive(sim)
    sim.run(0.3)
    topics = [
        topic for topic, kind in sim.topics().items() if kind in READ and topic not in sim.communication.bus.aside
    ]
    bare = BareEngine(sim)
    scans = [cast_bare_scan(s, bare.model, bare.data) for s in sim.contents.sensors.values() if s.kind == "lidar"]
    received = 0

    def count(_: Any) -> None:
        nonlocal received
        received += 1

    def ours() -> None:
        sim.step(STRETCH)

    sides: list[Callable[[], object]] = [lambda: bare.step(STRETCH), lambda: [scan() for scan in scans], ours]
    unread = time_interleaved(sides, rounds)
    kept = [sim.subscribe(topic, keep=1) for topic in topics]
    later = time_interleaved(sides, rounds)
    for subscription in kept:
        subscription.close()
    for topic in topics:
        sim.subscribe(topic, count, keep=1)
    sim.step(STRETCH)
    received = 0
    called = time_interleaved(sides, rounds)
    per_second = round(received / (rounds + 1) / STRETCH / sim.timestep)
    step, rays = (statistics.median(side[i] for side in (unread, later, called)) / STRETCH for i in (0, 1))
    start = time.process_time()
    sim.spawn(f'<sdf version="1.9">{robot("one_more", -SPACING, 0.0, kind)}</sdf>')
    spawn = time.process_time() - start
    times = [side[2] / STRETCH for side in (unread, later, called)]
    return Row(robots, load, spawn, step, rays, times[0], times[1], times[2], per_second)


def publishing(rounds: int) -> float:
    """What one published message with one subscriber costs beyond building it [s]."""
    sim = simkit.load('<sdf version="1.9"><world name="w"/></sdf>')
    publisher = sim.communication.bus.advertise("/x", "std_msgs/msg/Float64")
    make, count = msgs.type_of("std_msgs/msg/Float64"), 20_000
    sim.subscribe("/x", lambda message: None, keep=1)

    def build() -> None:
        for i in range(count):
            make(float(i))

    def publish() -> None:
        for i in range(count):
            publisher.publish(make(float(i)))

    built, published = time_interleaved([build, publish], rounds)
    return (published - built) / count


def plot(rows: list[Row], path: str) -> None:
    """Time a step over robots, each beside its bare engine."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    robots = [row.robots for row in rows]
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.2), constrained_layout=True)
    lines = (("bare steps", "bare", "k:"), ("bare steps and rays", "beside", "k--"))
    ours = (("nobody reads", "unread", "C0o-"), ("newest kept", "later", "C1o-"), ("every message", "called", "C3o-"))
    for label, name, style in (*lines, *ours):
        left.plot(robots, [1e3 * getattr(row, name) for row in rows], style, label=label)
    left.set(xlabel="robots", ylabel="CPU time of a step of 1 ms [ms]", title="TurtleBots in one world")
    left.legend()
    right.plot(robots, [row.load for row in rows], "C0o-", label="load of the world")
    right.plot(robots, [row.spawn for row in rows], "C2o-", label="spawn of one more")
    right.set(xlabel="robots", ylabel="CPU time [s]", title="Loading")
    right.legend()
    figure.savefig(path, dpi=120)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--robots", type=int, nargs="+", default=[1, 10, 50, 100])
    parser.add_argument("--kind", choices=("gz", "classic"), default="gz")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--plot", metavar="PNG", help="where to draw it")
    args = parser.parse_args()
    print("robots   load  spawn | bare step   rays |  unread          newest kept     every message   messages/s")
    rows = []
    for robots in args.robots:
        row = measured(robots, args.kind, args.rounds)
        rows.append(row)
        ours = "  ".join(f"{t * 1e6:7.0f} ({t / row.beside:4.2f})" for t in (row.unread, row.later, row.called))
        times = f"{row.robots:6d} {row.load:5.2f} s {row.spawn:4.2f} s | {row.bare * 1e6:6.0f} us {row.rays * 1e6:6.0f}"
        print(f"{times} | {ours}   {row.messages:8d}", flush=True)
    print(f"one message to one subscriber, beyond building it: {publishing(args.rounds) * 1e6:.2f} us   aim <= 2")
    if args.plot:
        plot(rows, args.plot)


if __name__ == "__main__":
    main()
