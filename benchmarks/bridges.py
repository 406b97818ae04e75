"""Speed of a run whose topics are read through a bridge, beside the same run with nobody listening.

python benchmarks/bridges.py [--ros-python PYTHON] [--ways WAY …] [--clients N] [--robots N] [--large] [--rounds N]

Ways are `socket` (a client without a bridge), `ros`, `foxglove`, and `rosbridge` with JSON, `cbor` or `cbor-raw`; each
with a client in a process of its own that counts the messages (bridge_reader.py). `deaf-` before a way adds a client
that has subscribed too and reads nothing. Every way has its own simulation in this process, which runs as in
`simkit run`, some simulated seconds in turn. Times are those of a simulated second: processor time of the
simulation's thread, of its process, of the bridge and of the clients, and wall time. With two cores, a run has
one for itself; bridge and clients share the other. `ros` needs `--ros-python` or a sourced ROS. Linux only.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import re
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import fleet

import simkit
from simkit import msgs
from simkit.bridges.bridge_process import BridgeProcess
from simkit.bridges.live.server import Server
from simkit.cli.run_loop import Interrupts, RunLoop
from simkit.recording.command_script import Commands
from simkit_ros.bridge_process import RosBridge, RosOptions
from simkit_view.web.web_process import WebBridge, WebOptions

TOPICS = ("/scan", "/odom", "/tf", "/joint_states", "/imu", "/clock")
WAYS = ("socket", "ros", "foxglove", "rosbridge", "cbor", "cbor-raw")
READER = Path(__file__).with_name("bridge_reader.py")
IMAGE, CLOUD = "sensor_msgs/msg/Image", "sensor_msgs/msg/PointCloud2"
QUIET = 0.05  # [s] of wall time without work of bridge and clients after which a round has ended


class Large(simkit.WorldPlugin):
    """Publishes images of 0.9 MB at 30 Hz, and clouds of 1 MB at 10 Hz."""

    after_step_rate = 30.0

    def load(self, parent: Any, params: Any) -> None:
        """Make the messages."""
        pixels, points = bytes(640 * 480 * 3), bytes(16 * 65536)
        image = {"height": 480, "width": 640, "encoding": "rgb8", "step": 1920, "data": pixels}
        cloud = {"height": 1, "width": 65536, "point_step": 16, "row_step": 16 * 65536, "data": points}
        self.count = 0
        self.image = self.advertise("/image", IMAGE), msgs.from_dict((IMAGE,), image)
        self.cloud = self.advertise("/points", CLOUD), msgs.from_dict((CLOUD,), cloud)

    def after_step(self) -> None:
        """Publish the messages."""
        self.count += 1
        for publisher, message in (self.image, self.cloud)[: 1 + (self.count % 3 == 0)]:
            publisher.publish(message)


@dataclass
class Times:
    """Times of a simulated second [s], and messages."""

    thread: float
    process: float
    wall: float
    bridge: float
    clients: float
    messages: float


def processor_time(pid: int) -> float:
    """Processor time of all threads of another process [s]."""
    total = 0
    for thread in Path(f"/proc/{pid}/task").iterdir():
        with contextlib.suppress(OSError):
            total += int((thread / "schedstat").read_text().split()[0])
    return total / 1e9


def children() -> set[int]:
    """Processes that this one has started."""
    tasks = Path("/proc/self/task").iterdir()
    return {int(pid) for task in tasks for pid in (task / "children").read_text().split()}


class Run:
    """Simulation with a bridge and its clients."""

    def __init__(self, sim: Any, way: str, topics: tuple[str, ...], clients: int, ros: RosOptions) -> None:
        self.sim, self.server = sim, Server(sim, f"bridges_{way}")
        self.loop = RunLoop(sim, Commands(sim, ()), Interrupts(), [])
        self.loop.server = self.server
        self.bridge: BridgeProcess | None = None
        self.bridge_pid, self.readers = 0, list[subprocess.Popen[str]]()
        self.times: list[Times] = []
        if way == "nobody":
            return
        kind, address = way.removeprefix("deaf-"), self.server.name
        self._address = address
        if kind != "socket":
            before = children()
            self._start_bridge(kind, ros)
            (self.bridge_pid,) = children() - before
        ways = [f"deaf-{kind}"] * way.startswith("deaf-") + [kind] * clients
        types = sim.topics()
        words = [f"{topic}={types[topic]}" for topic in topics]
        python = str(ros.python) if kind == "ros" and ros.python else sys.executable
        python = str(Path(python) / "bin" / "python") if Path(python).is_dir() else python
        environment = {**(ros.environment() if kind == "ros" else os.environ), "PYTHONPATH": ""}
        for word in ways:
            command = [python, str(READER), word, self._address, *words]
            pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
            self.readers.append(subprocess.Popen(command, env=environment, **pipes))
        for reader in self.readers:
            os.set_blocking(reader.stdout.fileno(), False)
            while not (line := reader.stdout.readline()):
                self.server.poll(0.02)
            assert line == "ready\n", line
        count = 1 if kind == "ros" else len(ways)
        while sum(len(p.subscriptions) for p in self.server.peers.values()) < count * len(topics):
            self.server.poll(0.02)

    def _start_bridge(self, kind: str, ros: RosOptions) -> None:
        lines: list[str] = []
        if kind == "ros":
            self.bridge, self._address = RosBridge(ros, lines.append), str(ros.domain)
        else:
            server = "foxglove" if kind == "foxglove" else "rosbridge"
            self.bridge = WebBridge(WebOptions(server, "127.0.0.1", 0, ""), lines.append)
        self.bridge.start(self.server.path, self.server.poll)
        found = re.search(r"ws://\S+", "\n".join(lines))
        self._address = found[0] if found else self._address

    def _outside(self) -> tuple[float, float]:
        """Processor times of the bridge and of the clients [s]."""
        bridge = processor_time(self.bridge_pid) if self.bridge_pid else 0.0
        return bridge, sum(processor_time(reader.pid) for reader in self.readers)

    def _count(self) -> int:
        total = 0
        for reader in self.readers:
            reader.stdin.write("?\n")
            reader.stdin.flush()
            while not (line := reader.stdout.readline()):
                self.server.poll(0.001)
            total += int(line)
        return total

    def round(self, seconds: float) -> None:
        """Simulate some seconds, then serve the clients until they have read everything."""
        count, outside = self._count(), self._outside()
        thread, process, wall = time.thread_time(), time.process_time(), time.perf_counter()
        self.loop.run(seconds)
        thread, process = time.thread_time() - thread, time.process_time() - process
        wall = time.perf_counter() - wall
        before = (-1.0, -1.0)
        while (now := self._outside()) != before and sum(now) - sum(before) > 0.1 * QUIET:
            before, end = now, time.perf_counter() + QUIET
            while time.perf_counter() < end:
                self.server.poll(QUIET / 5)
        bridge, clients = (after - start for after, start in zip(now, outside, strict=True))
        found = thread, process, wall, bridge, clients, self._count() - count
        self.times.append(Times(*(value / seconds for value in found)))

    def close(self) -> None:
        """End the clients, the bridge and the simulation."""
        for reader in self.readers:
            reader.kill()
            reader.wait()
        self.server.close()
        if self.bridge is not None:
            self.bridge.__exit__(None, None, None)
        self.sim.close()


def report(runs: dict[str, Run]) -> None:
    """Print the times of each way, and its speed beside that with nobody listening."""

    def low(run: Run, name: str) -> float:
        values = sorted(getattr(times, name) for times in run.times[1:])
        return float(values[len(values) // 4])

    alone = runs["nobody"]
    for way, run in runs.items():
        thread, process, wall = (low(run, name) for name in ("thread", "process", "wall"))
        speeds = [low(alone, name) / low(run, name) for name in ("thread", "process", "wall")]
        bridge, clients = (statistics.median(getattr(t, name) for t in run.times[1:]) for name in ("bridge", "clients"))
        count = statistics.median(times.messages for times in run.times[1:])
        print(
            f"{way:14s} thread {1e3 * thread:7.2f} ms  process {1e3 * process:7.2f}  wall {1e3 * wall:7.2f}   "
            f"speed {speeds[0]:4.2f} {speeds[1]:4.2f} {speeds[2]:4.2f}   "
            f"bridge {1e3 * bridge:7.2f}  clients {1e3 * clients:7.2f} ms  messages {count:7.0f}",
            flush=True,
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--world", default="turtlebot3_world")
    parser.add_argument("--ways", nargs="+", default=[way for way in WAYS if way != "ros"])
    parser.add_argument("--ros-python", type=Path)
    parser.add_argument("--ros-domain", type=int, default=87)
    parser.add_argument("--clients", type=int, default=1, help="clients of each bridge that read")
    parser.add_argument("--robots", type=int, default=0, help="a fleet of so many TurtleBots instead of the world")
    parser.add_argument("--large", action="store_true", help="images and clouds of 1 MB, 40 a second")
    parser.add_argument("--rounds", type=int, default=12)
    parser.add_argument("--seconds", type=float, default=4.0, help="simulated seconds of a round")
    args = parser.parse_args()
    load, topics = workload(args)
    runs: dict[str, Run] = {}
    ros = RosOptions(args.ros_python, args.ros_domain)
    try:
        for way in ("nobody", *args.ways):
            runs[way] = Run(load(), way, topics, args.clients, ros)
        for _ in range(args.rounds + 1):
            for run in runs.values():
                run.round(args.seconds)
        report(runs)
    finally:
        for run in runs.values():
            run.close()


def workload(args: argparse.Namespace) -> tuple[Callable[[], Any], tuple[str, ...]]:
    """Return a function that loads the world, and the topics to read."""
    if args.large:
        return lambda: simkit.load(args.world, plugins=[Large()]), ("/image", "/points")
    if args.robots:
        text = fleet.world(args.robots, "gz")
        found = simkit.load(text).topics()
        return lambda: simkit.load(text), tuple(topic for topic, kind in found.items() if kind in fleet.READ)
    return lambda: simkit.load(args.world), TOPICS


if __name__ == "__main__":
    main()
