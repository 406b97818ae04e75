"""Speed of a run whose topics are read, beside the same run with nobody listening.

python benchmarks/listeners.py [--world NAME] [--rounds N] [--robots N]

Every way of listening has its own simulation in this process. Each simulates one second in turn, in parts of 0.05 s;
the times are the CPU time of the simulation's thread. Of each part, the lower eighth of the times is used, because most
parts are shorter than the time after which the system lets another program run: other programs hardly count.
`--robots` measures a fleet of TurtleBots with all topics instead of six topics of the world.
"""

from __future__ import annotations

import argparse
import contextlib
import multiprocessing
import tempfile
import time
from collections.abc import Callable
from multiprocessing.synchronize import Event
from pathlib import Path
from typing import Any

import fleet

import simkit
from simkit import msgs
from simkit.bridges.live.server import Server
from simkit.live import connect
from simkit.recording.bags.recorder import Recorder

TOPICS = ("/scan", "/odom", "/tf", "/joint_states", "/imu", "/clock")
PARTS = 20  # parts of a simulated second
Run = Callable[[int], None]  # simulates the part of a second with this number


def ignore(_: object) -> None:
    """Receives a message."""


def read_socket(name: str, topics: tuple[str, ...], is_open: Event) -> None:
    """The other process: subscribes and drops every message."""
    with contextlib.suppress(simkit.live.LiveError), connect(name, wait=60.0) as client:
        subscriptions = [client.subscribe(topic) for topic in topics]
        is_open.set()
        while True:
            client.receive(0.5)
            for subscription in subscriptions:
                subscription.waiting.clear()


class Ways:
    """One simulation for each way of listening."""

    def __init__(self, load: Callable[[], Any], topics: tuple[str, ...], folder: Path) -> None:
        self._load, self._topics, self._folder = load, topics, folder
        self._open: list[Any] = []

    def nobody(self) -> Run:
        sim = self._load()
        return lambda _: sim.run(1.0 / PARTS)

    def made(self) -> Run:
        sim = self._load()
        for topic in self._topics:
            sim.communication.bus.tap(topic, ignore)
        return lambda _: sim.run(1.0 / PARTS)

    def serialised(self) -> Run:
        sim = self._load()
        for topic in self._topics:
            sim.communication.bus.tap(topic, msgs.serialize)
        return lambda _: sim.run(1.0 / PARTS)

    def bag(self) -> Run:
        sim = self._load()
        self._open.append(Recorder(sim, self._folder / "bag.mcap", topics=self._topics))
        return lambda _: sim.run(1.0 / PARTS)

    def socket(self) -> Run:
        sim = self._load()
        server = Server(sim, "listeners")
        context = multiprocessing.get_context("spawn")
        is_open = context.Event()
        reader = context.Process(target=read_socket, args=(server.name, self._topics, is_open), daemon=True)
        reader.start()
        while not is_open.is_set():
            server.poll(0.05)

        def run(part: int) -> None:
            sim.run(1.0 / PARTS)
            if part % 5 == 4:  # at this speed, the slices of `simkit run` have 0.2 to 0.6 s
                server.poll()

        return run

    def close(self) -> None:
        """Ends the recordings."""
        for recorder in self._open:
            recorder.close()


def report(load: Callable[[], Any], topics: tuple[str, ...], rounds: int) -> None:
    """Times every way of listening, and prints them."""
    with tempfile.TemporaryDirectory() as folder:
        ways = Ways(load, topics, Path(folder))
        sides = {name: getattr(ways, name)() for name in ("nobody", "made", "serialised", "bag", "socket")}
        times: dict[str, list[list[float]]] = {name: [[] for _ in range(PARTS)] for name in sides}
        for _ in range(rounds + 1):
            for name, run in sides.items():
                for part in range(PARTS):
                    start = time.thread_time()
                    run(part)
                    times[name][part].append(time.thread_time() - start)
        ways.close()
    found = {name: sum(sorted(part[1:])[len(part) // 8] for part in each) for name, each in times.items()}
    for name, least in found.items():
        print(f"{name:12s} {1e3 * least:8.2f} ms a simulated second   speed {found['nobody'] / least:5.2f}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--world", default="turtlebot3_world")
    parser.add_argument("--rounds", type=int, default=40, help="simulated seconds of each side")
    parser.add_argument("--robots", type=int, default=0, help="a fleet of so many TurtleBots instead of the world")
    args = parser.parse_args()
    if args.robots:
        text = fleet.world(args.robots, "gz")
        sim = simkit.load(text)
        topics = tuple(topic for topic, kind in sim.topics().items() if kind in fleet.READ)
        report(lambda: simkit.load(text), topics, args.rounds)
    else:
        report(lambda: simkit.load(args.world), TOPICS, args.rounds)


if __name__ == "__main__":
    main()
