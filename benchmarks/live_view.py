"""Processor time of a run at real time with pages of the live view, beside the same run without one.

The pages are WebSocket clients in another process, which show states, joints and the list of topics, and with
`--lidars` up to eight lidars, whose samples any subscriber would have to pay for. Runs without and with pages
alternate, and the median of the ratios of neighbours counts.

    python benchmarks/live_view.py [--seconds 4] [--rounds 5] [--lidars] [--browser]

`--browser` also measures the time to the first picture of the page, beside that of an empty WebGL canvas, in Chromium.
"""

from __future__ import annotations

import argparse
import json
import resource
import statistics
import subprocess
import sys
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import simkit
from simkit_view.view.live_view import LiveView

SLICE = 0.02  # [s] of wall time, as in a run with a limited real-time factor
CLIENT = """
import contextlib, json, sys, threading
from websockets.sync.client import connect
address, wants, count = sys.argv[1], sys.argv[2], int(sys.argv[3])
def show(socket):
    socket.send(json.dumps({"do": "want", "streams": json.loads(wants)}))
    for _ in socket:
        pass
threads, sockets = [], contextlib.ExitStack()
for _ in range(count):
    socket = sockets.enter_context(connect(address, max_size=None))
    threads.append(threading.Thread(target=show, args=(socket,), daemon=True))
    threads[-1].start()
print("ready", flush=True)
sys.stdin.read()
"""
SHOWN = {"lidars": False}
LIMITS = {1: 1.05, 8: 1.10}


def fleet(count: int) -> str:
    """A world with TurtleBots in rows."""
    models = "".join(
        f"<include><uri>model://turtlebot3_burger</uri><name>r{i}</name>"
        f"<pose>{i % 10} {i // 10} 0.01 0 0 0</pose></include>"
        for i in range(count)
    )
    ground = "<model name='g'><static>true</static><link name='l'><collision name='c'><geometry><plane/></geometry>"
    return f"<sdf version='1.9'><world name='fleet'>{ground}</collision></link></model>{models}</world></sdf>"


def cpu() -> float:
    """Processor time of this process so far [s]."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def run(sim: simkit.Simulation, view: LiveView, clients: int, seconds: float, pace: float) -> float:
    """Return the processor time of a run at `pace` times real time, with pages."""
    lidars = [name for name, sensor in sim.contents.sensors.items() if hasattr(sensor, "ray_ends")]
    wants: dict[str, Any] = {"joints": {}, "displays": {}, **({"lidar": lidars[:8]} if SHOWN["lidars"] else {})}
    with ExitStack() as stack:
        if clients:
            address = view.address.replace("http", "ws", 1).replace("/?", "/ws?")
            command = [sys.executable, "-c", CLIENT, address, json.dumps(wants), str(clients)]
            process = stack.enter_context(subprocess.Popen(command, stdin=-1, stdout=-1, text=True))
            assert process.stdin is not None and process.stdout is not None
            process.stdout.readline()
            stack.callback(process.stdin.close)
        for _ in range(20):  # the first packets
            view.update()
            time.sleep(0.01)
        sim.reset()
        begun, wall = cpu(), time.perf_counter()
        with sim.control.pausing.served():
            while sim.time < seconds * pace:
                target = round((time.perf_counter() - wall) * pace / sim.timestep)
                sim.control.pausing.advance(max(1, min(target - sim.tick, round(2 * SLICE * pace / sim.timestep))))
                view.update()
                time.sleep(max(0.0, SLICE - (time.perf_counter() - wall) % SLICE))
        found = cpu() - begun
    while view.server.client_count:
        time.sleep(0.01)
    return found


def measure(name: str, world: str, seconds: float, rounds: int, pace: float) -> bool:
    """Print the ratios of one world; return True if they are within the limits."""
    is_good = True
    with simkit.load(world) as sim, LiveView(sim) as view:
        run(sim, view, 1, 1.0, pace)  # warm
        for clients, limit in LIMITS.items():
            pairs = [[run(sim, view, n, seconds, pace) for n in (0, clients)] for _ in range(rounds)]
            ratio = statistics.median(more / less for less, more in pairs)
            cost = statistics.median(more - less for less, more in pairs) / seconds
            share = statistics.median(less for less, _ in pairs) / seconds
            most = 1.10 if name == "fleet" else limit
            is_good &= ratio <= most
            print(
                f"{name:12} {clients} pages: {ratio:.3f} of the processor time without (aim {most:.2f});"
                f" {100 * cost:.1f} % of a core more, {100 * share:.0f} % without"
            )
    return is_good


def first_picture() -> bool:
    """Print the time from opening the page to its first picture, beside an empty WebGL canvas."""
    from playwright.sync_api import sync_playwright

    options = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    times = []
    with simkit.load("tiago_table") as sim, LiveView(sim) as view, sync_playwright() as started:
        browser = started.chromium.launch(executable_path="/usr/bin/chromium", args=options)
        for _ in range(3):
            page = browser.new_context(bypass_csp=True).new_page()
            begun = time.perf_counter()
            page.goto(view.address, wait_until="commit")
            page.wait_for_function("window.simkitView?.stage?.draws > 0 && window.simkitView.scene", timeout=60_000)
            drawn = time.perf_counter() - begun
            blank = page.evaluate(BLANK)
            times.append((drawn, blank / 1000))
            page.close()
        browser.close()
    drawn, blank = (statistics.median(row) for row in zip(*times, strict=True))
    print(f"first picture of tiago_table: {drawn:.2f} s after the page is opened (aim 2 s)")
    print(f"an empty WebGL canvas: {blank:.2f} s")
    return drawn <= 2.0


BLANK = """(() => { const begun = performance.now(), gl = document.createElement('canvas').getContext('webgl2');
gl.clearColor(0, 0, 0, 1); gl.clear(gl.COLOR_BUFFER_BIT);
gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
return performance.now() - begun; })()"""


def main() -> int:
    """Measure; return 1 if an aim is missed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=4.0)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--lidars", action="store_true")
    parser.add_argument("--browser", action="store_true")
    given = parser.parse_args()
    SHOWN["lidars"] = given.lidars
    found = [measure("tiago_table", "tiago_table", given.seconds, given.rounds, 1.0)] if given.rounds else []
    found += [measure("fleet", fleet(100), given.seconds, given.rounds, 0.2)] if given.rounds else []
    if given.browser:
        found.append(first_picture())
    return 0 if all(found) else 1


if __name__ == "__main__":
    sys.exit(main())
