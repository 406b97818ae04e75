"""Golden runs: what capturing costs beside the plain run and beside one that is listened to, and how large they get.

python benchmarks/golden.py [--world NAME] [--rounds N]
"""

from __future__ import annotations

import os
import tempfile
import time
from pathlib import Path

from measure import arguments

from simkit.run_spec import RunSpec
from simkit.testing.golden.store import read_golden, write_golden
from simkit.testing.run_record.run_recorder import record_run
from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario

_DURATION = 30.0  # [s] simulated
_AIM = 200e3  # bytes, of half a minute of a TurtleBot3 with lidar and IMU


def main() -> None:
    args = arguments(__doc__, rounds=5)
    os.environ.setdefault("TURTLEBOT3_MODEL", "burger")
    drive = {"at": 0.0, "topic": "/cmd_vel", "message": {"linear": {"x": 0.1}, "angular": {"z": 0.2}}}
    scenario = RunSpec(args.world, _DURATION, commands=(drive,))
    _timed(scenario, "listened")
    plain, listened, captured = (
        min(_timed(scenario, what) for _ in range(args.rounds)) for what in ("plain", "listened", "captured")
    )
    print(f"{'plain run':30s} {plain:7.2f} s   {_DURATION / plain:6.1f} x real time")
    print(f"{'every topic listened to':30s} {listened:7.2f} s   ratio {listened / plain:5.2f}")
    print(
        f"{'captured':30s} {captured:7.2f} s   ratio {captured / plain:5.2f}, "
        f"to the listened {captured / listened:5.2f}"
    )
    record = record_run(scenario)
    with tempfile.TemporaryDirectory() as folder:
        writing = time.perf_counter()
        write_golden(folder, record)
        reading = time.perf_counter()
        read_golden(folder)
        end = time.perf_counter()
        size = sum(path.stat().st_size for path in Path(folder).iterdir())
    record.simulation.close()
    print(f"{'written in':30s} {reading - writing:7.2f} s, read in {end - reading:.3f} s")
    print(f"{'size':30s} {size / 1000:7.1f} kB   aim < {_AIM / 1000:.0f} kB for lidar and IMU")


def _timed(scenario: RunSpec, what: str) -> float:
    """Processor time of one run [s]."""
    with open_scenario(scenario) as sim:
        taps = [sim.communication.bus.tap(topic, _nothing) for topic in sim.topics()] if what == "listened" else []
        start = time.process_time()
        if what == "captured":
            record_run(scenario, sim=sim)
        else:
            run_scenario(scenario, sim)
        elapsed = time.process_time() - start
        for tap in taps:
            tap.close()
    return elapsed


def _nothing(_: object) -> None:
    """Takes a message."""


if __name__ == "__main__":
    main()
