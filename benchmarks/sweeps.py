"""Runs of a sweep beside bare MuJoCo: what a run costs besides its steps.

python benchmarks/sweeps.py [--rounds N]

A run is 10 s of `turtlebot3_world` with another pillar, another radius and another friction, and with the scan and the
IMU read. A short run is ten steps of a box with another gravity, which shows the cost besides the steps. CPU times of
one process; the parts take turns, so that the load of the machine is the same for all.
"""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Generator
from statistics import median

import mujoco
from measure import arguments

import simkit
from simkit.runtime.world_variation import apply_overrides
from simkit_learning.sweeps.design import Design
from simkit_learning.sweeps.parameter_space import parameter_space
from simkit_learning.sweeps.row_runner import RowRunner
from simkit_learning.sweeps.sweep_spec import SweepSpec

SPACES = {
    "arena::pillars::collision(pillar_5).pose.x": {"uniform": [-0.05, 0.05]},
    "arena::pillars::collision(pillar_2).geometry.cylinder.radius": {"uniform": [0.14, 0.16]},
    "**::wheel_*::*.surface.friction.ode.mu": {"uniform": [0.5, 1.0]},
}
DURATION = 10.0
BOX = """<sdf version="1.9"><world name="w"><model name="box"><link name="l"><collision name="c"><geometry><box>
<size>.2 .2 .2</size></box></geometry></collision></link></model></world></sdf>"""
SHORT_RUNS = 200


def clearance(sim: simkit.Simulation) -> Generator[object]:
    scans, readings = sim.subscribe("/scan"), sim.subscribe("/imu")
    yield
    yield float(scans.latest.ranges.min()) + readings.latest.linear_acceleration.z


def cpu(function: Callable[[], object]) -> float:
    begun = time.process_time()
    function()
    return time.process_time() - begun


def short_runs() -> RowRunner:
    """Return a runner of short runs, whose world is loaded."""
    run = simkit.RunSpec(BOX, duration=0.01)
    spaces = (parameter_space("world.gravity", {"choice": [f"0 0 {-5 - k / 10}" for k in range(40)]}),)
    return RowRunner(SweepSpec(run, Design(spaces, (0,), SHORT_RUNS), {"z": "pose('box').z"}))


def run_all(runner: RowRunner) -> None:
    for number in range(SHORT_RUNS):
        result = runner.run(runner._spec.design.row(number))
        assert result.status == "ok", result.message


def main() -> None:
    rounds = arguments(__doc__, 5).rounds
    run = simkit.RunSpec("turtlebot3_world", duration=DURATION, velocity="0.2,0")
    spaces = tuple(parameter_space(name, space) for name, space in SPACES.items())
    spec = SweepSpec(run, Design(spaces, (0,), rounds + 1), {"clearance": clearance})
    runner, short = RowRunner(spec), short_runs()
    runner.run(spec.design.row(rounds))  # loads the world
    run_all(short)
    found: dict[str, list[float]] = {"run of the sweep": [], "its change of the world": [], "bare MuJoCo": []}
    found["the same run in a loaded world"], short_times = [], []
    with simkit.load("turtlebot3_world") as sim:
        gc.collect()
        gc.freeze()  # as in the workers of a sweep
        steps = round(DURATION / sim.timestep)
        for number in range(rounds):
            overrides = spec.row_spec(spec.design.row(number)).overrides
            found["run of the sweep"].append(cpu(lambda number=number: runner.run(spec.design.row(number))))
            found["its change of the world"].append(cpu(lambda texts=overrides: apply_overrides(sim, texts, 0)))
            readers = sim.subscribe("/scan"), sim.subscribe("/imu")
            sim.publish("/cmd_vel", {"linear": {"x": 0.2}})
            data = mujoco.MjData(sim.mj_model)
            found["bare MuJoCo"].append(cpu(lambda data=data: mujoco.mj_step(sim.mj_model, data, steps)))
            found["the same run in a loaded world"].append(cpu(lambda: sim.run(DURATION)))
            short_times.append(cpu(lambda: run_all(short)) / SHORT_RUNS)
            for reader in readers:
                reader.close()
    runner.close()
    short.close()
    bare = median(found["bare MuJoCo"])
    for name, times in found.items():
        print(f"{name:34s} {median(times):7.3f} s CPU   {median(times) / bare:6.2f} x bare MuJoCo")
    print(f"one core: {DURATION / median(found['run of the sweep']):.0f} x real time")
    print(f"a short run: {median(short_times) * 1e3:.2f} ms CPU")


if __name__ == "__main__":
    main()
