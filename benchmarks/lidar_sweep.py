"""Measure what a sweep costs: ratio of the time of a scan with a sweep to that of a scan at one instant.

    python benchmarks/lidar_sweep.py

The lidar is planar with 360 rays at 5 Hz, or has 16 layers of 1800 rays at 10 Hz. It moves and turns between static
shapes and a mesh, with or without ten moving bodies. Simulations with and without the sweep alternate in one process.
The table has medians of the CPU time for one scan. "scan" is the measurement with noise and message alone. "run" is a
whole run with a subscriber: also its steps, which a run with a sweep makes one by one, and the record of the poses.
"""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import simkit

PERIODS = 8
WALLS = ((5, 0, "0.2 10 3"), (-5, 0, "0.2 10 3"), (0, 5, "10 0.2 3"), (0, -5, "10 0.2 3"))
PILLAR = "<cylinder><radius>0.15</radius><length>2</length></cylinder>"
CONE = "<cone><radius>0.5</radius><length>2</length></cone>"
MOVERS = "<sphere><radius>0.25</radius></sphere>", "<box><size>0.4 0.4 0.4</size></box>"
INERTIA = (
    "<inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>"
    "<gravity>false</gravity>"
)


def shape(name: str, geometry: str, x: float, y: float, *, moves: bool = False) -> str:
    link = f'{INERTIA if moves else ""}<collision name="c"><geometry>{geometry}</geometry></collision>'
    head = f'<model name="{name}"><static>{str(not moves).lower()}</static><pose>{x} {y} 1 0 0 0</pose>'
    return f'{head}<link name="l">{link}</link></model>'


def ring(count: int, radius: float, shift: float) -> list[tuple[float, float]]:
    """Return points on a circle [m]."""
    angles = [2 * math.pi * (i + shift) / count for i in range(count)]
    return [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]


def world(columns: int, layers: int, rate: float, movers: int) -> str:
    """Return a room with pillars, a cone, and a lidar on a free body."""
    parts = [shape(f"wall{i}", f"<box><size>{size}</size></box>", x, y) for i, (x, y, size) in enumerate(WALLS)]
    parts += [shape(f"pillar{i}", PILLAR, x, y) for i, (x, y) in enumerate(ring(9, 3, 0))]
    parts.append(shape("cone", CONE, 2, 2))
    parts += [shape(f"mover{i}", MOVERS[i % 2], x, y, moves=True) for i, (x, y) in enumerate(ring(movers, 2, 0.5))]
    last = math.pi - 2 * math.pi / columns
    limits = "<min_angle>-0.26</min_angle><max_angle>0.26</max_angle>"
    vertical = f"<vertical><samples>{layers}</samples>{limits}</vertical>" if layers > 1 else ""
    lidar = (
        f'<sensor name="s" type="lidar"><topic>/scan</topic><update_rate>{rate}</update_rate><lidar><scan><horizontal>'
        f"<samples>{columns}</samples><min_angle>{-math.pi}</min_angle><max_angle>{last}</max_angle></horizontal>"
        f"{vertical}</scan><range><min>0.1</min><max>30</max></range>"
        '<noise type="gaussian"><mean>0</mean><stddev>0.01</stddev></noise></lidar></sensor>'
    )
    body = f'<model name="m"><pose>0 0 1 0 0 0</pose><link name="l">{INERTIA}{lidar}</link></model>'
    return f'<sdf version="1.9"><world name="w">{"".join(parts)}{body}</world></sdf>'


def load(text: str, movers: int, sweep: bool) -> Any:
    """Return a simulation whose free bodies move, with a subscriber."""
    sim = simkit.load(text, overrides=["m::l::s.sweep=true"] if sweep else [])
    for name in ["m", *(f"mover{i}" for i in range(movers))]:
        first = int(sim.mj_model.body_dofadr[sim.engine.names.link(f"{name}::l").body])
        sim.mj_data.qvel[first : first + 6] = (0.02, 0.01, 0, 0, 0, 0.3)
    sim.engine.physics.changed(3)
    sim.subscribe("/scan/points" if "<vertical>" in text else "/scan", callback=lambda message: None)
    sim.run(0.5)
    return sim


def measurement(sim: Any) -> Callable[[], None]:
    """Return a function that repeats one measurement, with noise and message, without the steps."""
    sensor, engine = sim.sensor("m::l::s"), sim.engine
    make = sensor.products()["scan" if sensor.options.vertical.samples == 1 else "points"].make
    if sensor.lasting is None:
        data = engine.physics.fresh()
        return lambda: make(sensor.perturb(sensor.measure(sim.mj_model, data), 5), 0)
    while not (sensor.lasting.samples and sensor.lasting.samples[0].end == engine.tick + 1):
        sim.step()
    begun = sensor.lasting.samples[0]
    engine.physics.advance(1)
    data, tick, sample = engine.physics.fresh(), engine.tick, begun.ended()

    def measure() -> None:
        sample.surroundings = sensor.end_measurement(begun, tick)
        make(sensor.perturb(sensor.capture_held(sim.mj_model, data, sample), 5), 0)

    return measure


def alternate(calls: Sequence[Callable[[], object]], rounds: int, repeats: int) -> list[float]:
    """Return the median CPU time of each call [ms]."""
    times: list[list[float]] = [[] for _ in calls]
    for _ in range(rounds):
        for call, found in zip(calls, times, strict=True):
            start = time.process_time()
            for _ in range(repeats):
                call()
            found.append(1e3 * (time.process_time() - start) / repeats)
    return [statistics.median(found) for found in times]


def main() -> None:
    print("     lidar moving |  scan: instant, sweep, ratio |   run: instant, sweep, ratio   [ms a scan]")
    for columns, layers, rate in ((360, 1, 5.0), (1800, 16, 10.0)):
        for movers in (0, 10):
            text = world(columns, layers, rate, movers)
            sims = [load(text, movers, sweep) for sweep in (False, True)]
            runs = alternate([partial(sim.run, PERIODS / rate) for sim in sims], 9, 1)
            scans = alternate([measurement(sim) for sim in sims], 15, 5)
            pairs = scans, [run / PERIODS for run in runs]
            row = " | ".join(f"{a:12.3f} {b:8.3f} {b / a:6.2f}" for a, b in pairs)
            print(f"{layers:>4}x{columns:<5} {movers:>6} | {row}")
            for sim in sims:
                sim.close()


if __name__ == "__main__":
    main()
