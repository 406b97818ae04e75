"""An hour of simulated time with listeners that come, go and do not read: memory and file handles stay the same."""

from __future__ import annotations

import json
import re
import signal
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest
from targets import WORLD_FILES, environment
from test_broken_files import SECONDS

pytestmark = [
    pytest.mark.fuzz,
    pytest.mark.needs_packs,
    pytest.mark.skipif(not Path("/proc/self/fd").is_dir(), reason="needs /proc"),
]
HOUR = 3600.0  # [s] of simulated time
LEAST, SHARE = 20.0, 4  # [s] of wall time at least; part of the time of all tests
PERIOD = 0.25  # [s] between two samples
GROWTH = 6.0  # [MiB] from the second third of the samples to the last one, beyond which memory is not flat
ODOMETRY, SCAN = ("/odom", "nav_msgs/msg/Odometry"), ("/scan", "sensor_msgs/msg/LaserScan")


class Watcher(threading.Thread):
    """Samples memory [MiB] and file handles of a process and its children."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self._number, self.is_over = number, threading.Event()
        self.samples: dict[str, list[tuple[float, int]]] = {}

    def run(self) -> None:
        while not self.is_over.wait(PERIOD):
            children = Path(f"/proc/{self._number}/task/{self._number}/children").read_text().split()
            for number in (str(self._number), *children):
                with suppress(OSError, IndexError):
                    name = Path(f"/proc/{number}/cmdline").read_bytes().split(b"\0")[-2].decode()[-40:]
                    memory = int(Path(f"/proc/{number}/status").read_text().partition("VmRSS:")[2].split()[0]) / 1024
                    handles = len(list(Path(f"/proc/{number}/fd").iterdir()))
                    self.samples.setdefault(f"{number} {name}", []).append((memory, handles))

    def growth(self) -> Iterator[tuple[str, float, float]]:
        """Yield name, growth of memory and growth of file handles, from the middle third to the last one."""
        for name, samples in self.samples.items():
            third = len(samples) // 3
            middle, last = samples[third : 2 * third], samples[2 * third :]
            if third > 5:
                memory, handles = (
                    [statistics.median(row[k] for row in part) for part in (middle, last)] for k in (0, 1)
                )
                yield name, memory[1] - memory[0], handles[1] - handles[0]


@contextmanager
def running(folder: Path) -> Iterator[tuple[subprocess.Popen[bytes], dict[str, str], dict[str, str]]]:
    """Yield a run that goes as fast as it can, the addresses of its servers, and the environment for its clients."""
    variables = {**environment(), "XDG_RUNTIME_DIR": str(folder / "r"), "PYTHONUNBUFFERED": "1"}
    (folder / "r").mkdir(mode=0o700)
    for name, content in WORLD_FILES.items():
        (folder / name).write_bytes(content)
    said = folder / "said.txt"
    with said.open("wb") as file:
        process = subprocess.Popen(
            [sys.executable, "-m", "simkit", "run", "w.sdf", "-q", "--name", "soak", "--duration", str(HOUR),
             "--rosbridge=0", "--foxglove=0"],
            cwd=folder, env=variables, stdout=file, stderr=file,
        )  # fmt: skip
    try:
        addresses: dict[str, str] = {}
        end = time.monotonic() + 60
        while len(addresses) < 2:
            assert process.poll() is None and time.monotonic() < end, said.read_text()
            addresses = dict(re.findall(r"(foxglove|rosbridge): (ws://\S+)", said.read_text()))
            time.sleep(0.05)
        yield process, addresses, variables
        assert "Traceback" not in said.read_text(), said.read_text()[-3000:]
        assert said.stat().st_size < 100_000, said.read_text()[:3000]
    finally:
        process.kill()
        process.wait()


def listen(address: str, is_over: threading.Event, counts: dict[str, int], kind: str) -> None:
    """Listen as a client that is `steady`, `passing` (connects again and again) or `silent` (never reads)."""
    from websockets.exceptions import ConnectionClosed
    from websockets.sync.client import connect

    while not is_over.is_set():
        with suppress(ConnectionClosed, OSError, TimeoutError), connect(address, max_size=None) as socket:
            for topic, type_name in (ODOMETRY, SCAN):
                socket.send(json.dumps({"op": "subscribe", "topic": topic, "type": type_name}))
            if kind == "passing":
                socket.send(json.dumps({"op": "advertise", "topic": "/cmd_vel", "type": "geometry_msgs/msg/Twist"}))
                socket.send(json.dumps({"op": "publish", "topic": "/cmd_vel", "msg": {"linear": {"x": 0.1}}}))
            end = time.monotonic() + (0.3 if kind == "passing" else 1e9)
            while kind == "silent" and not is_over.wait(0.2):
                pass
            while kind != "silent" and not is_over.is_set() and time.monotonic() < end:
                socket.recv(timeout=5.0)
                counts[kind] = counts.get(kind, 0) + 1
            counts[f"{kind} connections"] = counts.get(f"{kind} connections", 0) + 1


def echo(variables: dict[str, str], is_over: threading.Event, counts: dict[str, int]) -> None:
    """Start `topic echo` again and again; end it in different ways."""
    for number in range(10**6):
        if is_over.is_set():
            return
        process = subprocess.Popen(
            [sys.executable, "-m", "simkit", "topic", "echo", "/imu", "--sim", "soak"],
            env=variables, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        is_over.wait(2.0)
        process.send_signal((signal.SIGINT, signal.SIGTERM, signal.SIGKILL, signal.SIGSTOP)[number % 4])
        if number % 4 == 3:
            is_over.wait(1.0)
            process.kill()
        process.wait(60)
        counts["echo"] = counts.get("echo", 0) + 1


def simulated_time(variables: dict[str, str]) -> float:
    found = subprocess.run(
        [sys.executable, "-m", "simkit", "topic", "echo", "/clock", "--once", "--json", "--sim", "soak"],
        env=variables, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    seconds = re.search(r'"sec": ?(\d+)', found.stdout)
    return float(seconds[1]) if seconds else 0.0


def test_memory_and_file_handles_stay_the_same_in_an_hour_of_simulated_time(tmp_path: Path) -> None:
    pytest.importorskip("websockets", reason="needs the extra rosbridge")
    counts: dict[str, int] = {}
    is_over = threading.Event()
    with running(tmp_path) as (process, addresses, variables):
        watcher = Watcher(process.pid)
        kinds: list[Any] = ["steady", "passing", "passing", "silent"]
        threads = [
            threading.Thread(target=listen, args=(addresses["rosbridge"], is_over, counts, kind)) for kind in kinds
        ]
        threads += [threading.Thread(target=echo, args=(variables, is_over, counts)), watcher]
        for thread in threads:
            thread.start()
        end, reached = time.monotonic() + max(LEAST, SECONDS / SHARE), 0.0
        while time.monotonic() < end and process.poll() is None:
            time.sleep(1.0)
        if process.poll() is None:
            reached = simulated_time(variables)
        code = process.poll()
        is_over.set()
        watcher.is_over.set()
        for thread in threads:
            thread.join(30)
        if code is None:
            process.send_signal(signal.SIGINT)
            code = process.wait(60)
        assert code in (0, 130)
    grown = list(watcher.growth())
    print(f"\n{reached or HOUR:.0f} s of simulated time; {counts}")  # noqa: T201 -- read with -s
    for name, memory, handles in grown:
        print(f"{name}: {memory:+.1f} MiB, {handles:+.0f} file handles")  # noqa: T201 -- read with -s
    assert counts.get("steady", 0) > 10 and counts.get("passing connections", 0) > 3 and counts.get("echo", 0) > 1
    assert grown and all(memory < GROWTH and handles <= 4 for _, memory, handles in grown), grown
