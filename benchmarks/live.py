"""Clients of a running simulation: commands a second, answers, what it costs the run, and memory over an hour.

python benchmarks/live.py [--world NAME] [--seconds S] [--hour [SECONDS]] [--faults]

Commands are Twists on `/cmd_vel`, from one client in another process. A percentage is of the speed that the run has
while its client does nothing. `--hour` keeps eight clients at it for an hour of wall time and prints the memory of the
run every 10 s. `--faults` shows the real-time factor that `--rtf 1` keeps, the run's processor time, and the messages
on `/imu` that a client which behaves well gets and loses, while two others misbehave.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import multiprocessing
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from simkit import msgs
from simkit.live import Client, LiveError, connect

TWIST = "geometry_msgs/msg/Twist"


@contextmanager
def run(world: str, *options: str) -> Iterator[tuple[str, int]]:
    """A `simkit run` in another process: the name it can be connected by, and its process."""
    name = f"bench_{os.getpid()}"
    command = [sys.executable, "-m", "simkit", "run", world, "--quiet", "--name", name, *options]
    root = Path(__file__).resolve().parents[1]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=root)
    try:
        connect(name, wait=60.0).close()
        yield name, process.pid
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()


def speed(client: Client, seconds: float) -> float:
    """Simulated seconds a second, while this client does nothing."""
    before, began = client.state()["time_ns"], time.perf_counter()
    time.sleep(seconds)
    return float((client.state()["time_ns"] - before) / 1e9 / (time.perf_counter() - began))


def flood(client: Client, seconds: float) -> tuple[float, float]:
    """Commands that were taken a second, and simulated seconds a second."""
    publisher = client.advertise("/cmd_vel")
    still = msgs.serialize(msgs.make(publisher.type_name))
    before, began, count = client.state()["time_ns"], time.perf_counter(), 0
    while time.perf_counter() - began < seconds:
        for _ in range(100):
            publisher.publish(still)
        count += 100
    client.flush()
    taken = time.perf_counter() - began
    return count / taken, (client.state()["time_ns"] - before) / 1e9 / taken


def listen(client: Client, seconds: float) -> tuple[float, float, int]:
    """Messages of every topic without pictures a second, simulated seconds a second, and messages lost."""
    names = [
        t["name"] for t in client.topics() if not {"Image", "PointCloud2"} & {n.split("/")[-1] for n in t["types"]}
    ]
    subscriptions = [client.subscribe(name) for name in names]
    before, began, count = client.state()["time_ns"], time.perf_counter(), 0
    while time.perf_counter() - began < seconds:
        client.receive(0.1)
        for subscription in subscriptions:
            count += len(subscription.waiting)
            subscription.waiting.clear()
    taken = time.perf_counter() - began
    factor = (client.state()["time_ns"] - before) / 1e9 / taken
    lost = sum(subscription.lost for subscription in subscriptions)
    for subscription in subscriptions:
        subscription.close()
    return count / taken, factor, lost


def answers(client: Client, count: int = 300) -> float:
    """Seconds that a question and its answer take, the median."""
    found = []
    for _ in range(count):
        began = time.perf_counter()
        client.flush()
        found.append(time.perf_counter() - began)
    return sorted(found)[count // 2]


def figures(world: str, seconds: float) -> None:
    """What one client is told and what it costs, as fast as it goes, at real time and while the run is paused."""
    for title, options in (("as fast as it goes", ()), ("--rtf 1", ("--rtf", "1"))):
        with run(world, *options) as (name, _), connect(name) as client:
            client.control("pause")
            client.control("resume")
            idle = speed(client, seconds)
            rate, factor = flood(client, seconds)
            print(f"{title}: {rate:,.0f} commands/s while the run goes {factor:.2f} x real time ", end="")
            print(f"({100 * factor / idle:.1f} % of {idle:.2f} x)")
            rate, factor, lost = listen(client, seconds)
            print(f"{title}: {rate:,.0f} messages/s heard, {lost} lost, at {factor:.2f} x ", end="")
            print(f"({100 * factor / idle:.1f} %)")
            print(f"{title}: an answer takes {1e3 * answers(client):.2f} ms")
            client.control("pause")
            print(f"{title}, paused: {flood(client, seconds)[0]:,.0f} commands/s, ", end="")
            print(f"an answer takes {1e3 * answers(client):.2f} ms", flush=True)


# ---------------------------------------------------------------------- an hour


def memory(pid: int) -> float:
    """Resident memory of a process [MB]."""
    found = re.search(r"VmRSS:\s+(\d+) kB", Path(f"/proc/{pid}/status").read_text(encoding="utf-8"))
    return int(found[1]) / 1024 if found else 0.0


def work(kind: int, name: str) -> None:
    """What one of the eight clients does until it is ended."""
    while True:
        with contextlib.suppress(LiveError), connect(name, node=f"client_{kind}") as client:
            (_drive, _listen, _listen, _ignore, _ask, _come_and_go, _open_and_close, _break_off)[kind](client)


def _drive(client: Client) -> None:
    publisher = client.advertise("/cmd_vel")
    for n in itertools.count():
        publisher.publish({"linear": {"x": 0.1}, "angular": {"z": 0.5 if n // 500 % 2 else -0.5}})
        time.sleep(0.002)


def _listen(client: Client) -> None:
    subscriptions = [client.subscribe(topic) for topic in ("/scan", "/odom", "/imu", "/tf", "/joint_states")]
    while client.receive(None):
        for subscription in subscriptions:
            subscription.waiting.clear()


def _ignore(client: Client) -> None:
    client.subscribe("/scan")
    client.subscribe("/imu")
    time.sleep(60.0)


def _ask(client: Client) -> None:
    while True:
        for question in ("topics", "nodes", "services", "models", "state", "parameters"):
            client.ask(question)
        client.model("turtlebot3")
        time.sleep(0.2)


def _come_and_go(client: Client) -> None:
    client.subscribe("/scan").get(1.0)
    time.sleep(0.2)


def _open_and_close(client: Client) -> None:
    for n in itertools.count():
        subscription, publisher = client.subscribe(f"/a/{n}"), client.advertise(f"/b/{n % 900}", "std_msgs/msg/Int32")
        publisher.publish({"data": n})
        subscription.close()
        publisher.close()
        time.sleep(0.01)


def _break_off(client: Client) -> None:
    client.subscribe("/odom")
    client._socket.send(b"\xff\xff\x00\x00\x01 half a frame")
    time.sleep(0.2)


def hour(world: str, seconds: float) -> None:
    """Memory of a run with eight clients, every 10 s, and how it grew over the second half."""
    context = multiprocessing.get_context("spawn")
    with run(world, "--rtf", "1") as (name, pid):
        workers = [context.Process(target=work, args=(kind, name), daemon=True) for kind in range(8)]
        for worker in workers:
            worker.start()
        began, found = time.monotonic(), []
        try:
            while (now := time.monotonic() - began) < seconds:
                with connect(name, node="watch") as client:
                    state: dict[str, Any] = client.state()
                found.append((now, memory(pid)))
                print(f"{now:7.0f} s   t={state['time_ns'] / 1e9:9.2f} s   {found[-1][1]:8.2f} MB", flush=True)
                time.sleep(10.0)
        finally:
            for worker in workers:
                worker.terminate()
        half = found[len(found) // 2 :]
        print(f"{half[-1][1] - half[0][1]:+.2f} MB over the second half ({half[-1][0] - half[0][0]:.0f} s)")


# ---------------------------------------------------------------------- clients that misbehave


def misbehave(kind: str, name: str) -> None:
    """What a client does that kind of wrong until it is ended."""
    while True:
        with contextlib.suppress(LiveError, OSError):
            client = connect(name, node="fault")
            while True:
                FAULTS[kind](client)


def _never_read(client: Client) -> None:
    client.subscribe_all([topic["name"] for topic in client.topics()], depth=100_000)
    time.sleep(60.0)


def _subscribe_12000_times(client: Client) -> None:
    for number in range(12_000):
        client.send_request("subscribe", {"number": number, "topic": "/imu", "depth": 1000})
        if number % 500 == 0:
            client.flush()
    time.sleep(60.0)


def _subscribe_and_read(client: Client) -> None:
    client.subscribe_all(["/imu"] * 1000)
    while True:
        client.receive(None)


def _flood(client: Client) -> None:
    publisher = client.advertise("/cmd_vel")
    still = msgs.serialize(msgs.make(publisher.type_name))
    while True:
        publisher.publish(still)


def _flood_large(client: Client) -> None:
    publisher = client.advertise("/flood", "std_msgs/msg/UInt8MultiArray")
    large = msgs.serialize(msgs.make(publisher.type_name, data=bytes(10 << 20)))
    client.subscribe("/flood")
    while True:
        publisher.publish(large)


def _ask_only(client: Client) -> None:
    while True:
        client.send_request("topics", {})


def _garbage(client: Client) -> None:
    with connect(client.info["name"]) as other:
        other.send(b"\xff\xff\x00\x00\x09" + bytes(5000))
        other.flush()


FAULTS = {
    "nobody": lambda _: time.sleep(60.0),
    "never read": _never_read,
    "12,000 subscriptions": _subscribe_12000_times,
    "1000 subscriptions, read": _subscribe_and_read,
    "flood of commands": _flood,
    "flood of 10 MB": _flood_large,
    "questions, answers unread": _ask_only,
    "garbage": _garbage,
}


def processor_time(pid: int) -> float:
    """Processor time of a process so far [s], all threads."""
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def faults(world: str, seconds: float) -> None:
    """The real-time factor, and what a client that behaves well gets, beside two that do not."""
    context = multiprocessing.get_context("spawn")
    for kind in FAULTS:
        with run(world, "--rtf", "1") as (name, pid), connect(name, timeout=60.0) as client:
            workers = [context.Process(target=misbehave, args=(kind, name), daemon=True) for _ in range(2)]
            for worker in workers:
                worker.start()
            time.sleep(8.0)  # after 5 s, a client that reads nothing counts as stuck
            imu = client.subscribe("/imu")
            before, began, count = client.state()["time_ns"], time.perf_counter(), 0
            busy = processor_time(pid)
            while time.perf_counter() - began < seconds:
                client.receive(0.1)
                count += len(imu.waiting)
                imu.waiting.clear()
            simulated = (client.state()["time_ns"] - before) / 1e9
            factor = simulated / (time.perf_counter() - began)
            for worker in workers:
                worker.terminate()
            busy = (processor_time(pid) - busy) / simulated
            print(f"{kind:26} {factor:.3f} x, {busy:.2f} s of CPU per s, ", end="")
            print(f"{count / simulated:4.0f} /imu per s, {imu.lost} lost, {memory(pid):5.0f} MB", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--world", default="turtlebot3_world", help="file, or bare name of a world")
    parser.add_argument("--seconds", type=float, default=3.0, help="wall time of each figure")
    parser.add_argument("--hour", type=float, nargs="?", const=3600.0, help="seconds of wall time instead of an hour")
    parser.add_argument("--faults", action="store_true", help="clients that misbehave, at --rtf 1")
    args = parser.parse_args()
    if args.faults:
        faults(args.world, args.seconds)
    elif args.hour:
        hour(args.world, args.hour)
    else:
        figures(args.world, args.seconds)


if __name__ == "__main__":
    main()
