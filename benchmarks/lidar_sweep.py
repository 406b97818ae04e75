"""Measure what a sweep costs: ratio of the time of a run with a sweep to that of the same run without.

    python benchmarks/lidar_sweep.py

The lidar is planar with 360 rays at 5 Hz or has 16 layers of 1800 rays at 10 Hz. It moves and turns between static shapes and a
mesh, with or without ten moving bodies. Runs with and without the sweep alternate in one process; the table has medians of the
CPU time for one scan. "scan" is the measurement with noise and message alone, "poses" is the record of the poses at each step
and the steps one by one, which a run without any task at each step does not make otherwise.
"""

from __future__ import annotations

import math
import statistics
import time
from typing import Any

import numpy as np

import simkit

PERIODS = 8
INERTIA = (
    "<inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>"
    "<gravity>false</gravity>"
)


def shape(name: str, geometry: str, pose: str, *, moves: bool = False) -> str:
    link = f'{INERTIA if moves else ""}<collision name="c"><geometry>{geometry}</geometry></collision>'
    return f'<model name="{name}"><static>{str(not moves).lower()}</static><pose>{pose}</pose><link name="l">{link}</link></model>'


def world(columns: int, layers: int, rate: float, movers: int) -> str:
    """Return a room with pillars, a cone, and a lidar on a free body."""
    walls = [(5, 0, "0.2 10 3"), (-5, 0, "0.2 10 3"), (0, 5, "10 0.2 3"), (0, -5, "10 0.2 3")]
    parts = [
        shape(f"wall{i}", f"<box><size>{size}</size></box>", f"{x} {y} 1 0 0 0") for i, (x, y, size) in enumerate(walls)
    ]
    pillar, cone = (
        "<cylinder><radius>0.15</radius><length>2</length></cylinder>",
        "<cone><radius>0.5</radius><length>2</length></cone>",
    )
    for i in range(9):
        angle = 2 * math.pi * i / 9
        parts.append(shape(f"pillar{i}", pillar, f"{3 * math.cos(angle)} {3 * math.sin(angle)} 1 0 0 0"))
    parts.append(shape("cone", cone, "2 2 1 0 0 0"))
    parts.append(shape("ground", "<plane><normal>0 0 1</normal></plane>", "0 0 0 0 0 0"))
    for i in range(movers):
        angle = 2 * math.pi * (i + 0.5) / movers
        box = "<box><size>0.4 0.4 0.4</size></box>" if i % 2 else "<sphere><radius>0.25</radius></sphere>"
        parts.append(shape(f"mover{i}", box, f"{2 * math.cos(angle)} {2 * math.sin(angle)} 1 0 0 0", moves=True))
    last = math.pi - 2 * math.pi / columns
    vertical = (
        f"<vertical><samples>{layers}</samples><min_angle>-0.26</min_angle><max_angle>0.26</max_angle></vertical>"
    )
    lidar = (
        f'<sensor name="s" type="lidar"><topic>/scan</topic><update_rate>{rate}</update_rate><lidar><scan><horizontal>'
        f"<samples>{columns}</samples><min_angle>{-math.pi}</min_angle><max_angle>{last}</max_angle></horizontal>"
        f"{vertical if layers > 1 else ''}</scan><range><min>0.1</min><max>30</max></range>"
        '<noise type="gaussian"><mean>0</mean><stddev>0.01</stddev></noise></lidar></sensor>'
    )
    body = f'<model name="m"><pose>0 0 1 0 0 0</pose><link name="l">{INERTIA}{lidar}</link></model>'
    return f'<sdf version="1.9"><world name="w">{"".join(parts)}{body}</world></sdf>'


def load(text: str, movers: int, sweep: bool) -> Any:
    sim = simkit.load(text, overrides=["m::l::s.sweep=true"] if sweep else [])
    for name in ["m", *(f"mover{i}" for i in range(movers))]:
        first = int(sim.mj_model.body_dofadr[sim.engine.names.link(f"{name}::l").body])
        sim.mj_data.qvel[first : first + 6] = (0.02, 0.01, 0, 0, 0, 0.3)
    sim.engine.physics.changed(3)
    topic = "/scan" if "<vertical>" not in text else "/scan/points"
    sim.subscribe(topic, callback=lambda message: None)
    sim.run(0.5)
    return sim


def cpu(call: Any) -> float:
    start = time.process_time()
    call()
    return time.process_time() - start


def scan_times(sims: list[Any]) -> list[float]:
    """Return the time [s] of one measurement, with noise and message, without the steps."""
    times = []
    for sim in sims:
        sensor = sim.sensor("m::l::s")
        product = next(iter(sensor.topics)) if sensor.options.vertical.samples == 1 else "points"
        data = sim.engine.physics.fresh()
        sample, tick = None, sim.engine.tick
        if sensor.lasting is not None:
            while not (sensor.lasting.samples and sensor.lasting.samples[0].end == sim.engine.tick + 1):
                sim.step()
            begun = sensor.lasting.samples[0]
            sim.engine.physics.advance(1)
            data, tick = sim.engine.physics.fresh(), sim.engine.tick
            sample = begun.ended()

        def measure(
            sensor: Any = sensor, sample: Any = sample, sim: Any = sim, data: Any = data, tick: int = tick
        ) -> None:
            if sample is None:
                reading = sensor.measure(sim.mj_model, data)
            else:
                sample.surroundings = sensor.end_measurement(begun, tick)
                reading = sensor.capture_held(sim.mj_model, data, sample)
            sensor._products[product].make(sensor.perturb(reading, 5), 0)

        measure()
        times.append(measure)
    result = [[], []]
    for _ in range(15):
        for found, measure in zip(result, times, strict=True):
            found.append(cpu(lambda measure=measure: [measure() for _ in range(5)]) / 5)
    return [statistics.median(found) for found in result]


def main() -> None:
    print(
        f"{'lidar':>10} {'moving':>6} | {'scan':>8} {'swept':>8} {'ratio':>6} | {'run':>8} {'swept':>8} {'ratio':>6}   [ms a scan]"
    )
    for columns, layers, rate in ((360, 1, 5.0), (1800, 16, 10.0)):
        for movers in (0, 10):
            text = world(columns, layers, rate, movers)
            sims = [load(text, movers, sweep) for sweep in (False, True)]
            runs: list[list[float]] = [[], []]
            for _ in range(9):
                for sim, found in zip(sims, runs, strict=True):
                    found.append(cpu(lambda sim=sim: sim.run(PERIODS / rate)) / PERIODS)
            whole = [1e3 * statistics.median(found) for found in runs]
            scans = [1e3 * found for found in scan_times(sims)]
            row = f"{scans[0]:8.3f} {scans[1]:8.3f} {scans[1] / scans[0]:6.2f} | {whole[0]:8.3f} {whole[1]:8.3f} {whole[1] / whole[0]:6.2f}"
            print(f"{layers:>4}x{columns:<5} {movers:>6} | {row}")
            for sim in sims:
                sim.close()
    assert np.isfinite(whole).all()


if __name__ == "__main__":
    main()
