"""Runs of a sweep beside bare MuJoCo: what a run costs besides its steps.

python benchmarks/sweeps.py [--rounds N]

A run is 10 s of `turtlebot3_world` with another pillar, another radius and another friction, and with the scan and the
IMU read. CPU times of one process; the parts take turns, so that the load of the machine is the same for all.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from statistics import median

import mujoco
from measure import arguments

import simkit
from simkit.experiments.sweeps.design import Design
from simkit.experiments.sweeps.parameter_space import parameter_space
from simkit.experiments.sweeps.row_runner import RowRunner
from simkit.experiments.sweeps.sweep_spec import SweepSpec
from simkit.runtime.world_variation import apply_overrides

SPACES = {
    "arena::pillars::collision(pillar_5).pose.x": {"uniform": [-0.05, 0.05]},
    "arena::pillars::collision(pillar_2).geometry.cylinder.radius": {"uniform": [0.14, 0.16]},
    "**::wheel_*::*.surface.friction.ode.mu": {"uniform": [0.5, 1.0]},
}
DURATION = 10.0


def clearance(sim: simkit.Simulation) -> Generator[object]:
    scans, readings = sim.subscribe("/scan"), sim.subscribe("/imu")
    yield
    yield float(scans.latest.ranges.min()) + readings.latest.linear_acceleration.z


def cpu(function: Callable[[], object]) -> float:
    begun = time.process_time()
    function()
    return time.process_time() - begun


def main() -> None:
    rounds = arguments(__doc__, 5).rounds
    run = simkit.RunSpec("turtlebot3_world", duration=DURATION, velocity="0.2,0")
    spaces = tuple(parameter_space(name, space) for name, space in SPACES.items())
    spec = SweepSpec(run, Design(spaces, (0,), rounds + 1), {"clearance": clearance})
    runner = RowRunner(spec)
    runner.run(spec.design.row(rounds))  # loads the world
    found: dict[str, list[float]] = {"run of the sweep": [], "its change of the world": [], "bare MuJoCo": []}
    found["the same run in a loaded world"] = []
    with simkit.load("turtlebot3_world") as sim:
        sim.subscribe("/scan"), sim.subscribe("/imu")
        steps = round(DURATION / sim.timestep)
        for number in range(rounds):
            overrides = spec.row_spec(spec.design.row(number)).overrides
            found["run of the sweep"].append(cpu(lambda number=number: runner.run(spec.design.row(number))))
            found["its change of the world"].append(cpu(lambda texts=overrides: apply_overrides(sim, texts, 0)))
            sim.publish("/cmd_vel", {"linear": {"x": 0.2}})
            data = mujoco.MjData(sim.mj_model)
            found["bare MuJoCo"].append(cpu(lambda data=data: mujoco.mj_step(sim.mj_model, data, steps)))
            found["the same run in a loaded world"].append(cpu(lambda: sim.run(DURATION)))
    runner.close()
    bare = median(found["bare MuJoCo"])
    for name, times in found.items():
        print(f"{name:34s} {median(times):7.3f} s CPU   {median(times) / bare:6.2f} x bare MuJoCo")
    print(f"one core: {DURATION / median(found['run of the sweep']):.0f} x real time")


if __name__ == "__main__":
    main()
