"""The main job of simkit, a world with a script and a bag, beside bare MuJoCo with the recorded controls.

python benchmarks/main_job.py [--world NAME] [--script FILE] [--duration S] [--skip PATTERN] [--rounds N] [--json FILE]

The job is `simkit run turtlebot3_world --script worlds/turtlebot3_world_drive.yaml --duration 36 --record x.mcap
--skip '/camera/*'`, whose bag has nine topics. The sides are

- bare: `mj_step` on a copy of the compiled model, with the controls that simkit wrote at each step. Steps with equal
  controls are one call. It has the contact parameters of the compiled model and MuJoCo's own contact forces, but
  nothing of simkit: no contact law, no plugins, no sensors, no messages. Its wheels slip differently, so each part
  starts from simkit's state.
- nobody: simkit with the script, and nobody listening.
- counted: the same with the table of topics that `simkit run` prints.
- bag: the same with this table and all topics recorded, as the job does. Loading, and the start of the process, are
  not counted; the end of the bag is.

All sides simulate the same time in turn, in parts of half a second, in one process. Every round starts at time 0. Of
each part, the lower quartile of the rounds is used, so that other programs hardly count; the sums are divided by the
number of steps. "thread" is the CPU time of the simulation's thread, "process" that of all threads.
"""

from __future__ import annotations

import argparse
import copy
import gc
import json
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

import simkit
from simkit.recording.bags.recorder import Recorder
from simkit.recording.command_script import Commands, read_script
from simkit.recording.topic_counts import RENDERED, TopicCounter

GOALS = {"nobody": 1.2, "bag": 1.35}
STATE = int(mujoco.mjtState.mjSTATE_INTEGRATION)
PART = 0.5  # [s] of simulated time
SCRIPT = Path(__file__).resolve().parents[1] / "worlds" / "turtlebot3_world_drive.yaml"
Round = Iterator[None]  # simulates one part for each `next`


class Job:
    """World, script and length of the job.

    Args:
        args: arguments of the command line.
    """

    def __init__(self, args: argparse.Namespace) -> None:
        self.world, self.script, self.skip = args.world, Path(args.script), tuple(args.skip)
        with simkit.load(self.world) as sim:
            self.steps = round(args.duration / sim.timestep)
            size = round(PART / sim.timestep)
        self.stops = [*range(size, self.steps, size), self.steps]

    def load(self) -> Any:
        return simkit.load(self.world)

    def commands(self, sim: Any) -> Commands:
        return Commands(sim, read_script(self.script, sim.topics()))

    def parts(self, sim: Any) -> Round:
        """Run a simulation from time 0, with the script."""
        commands = self.commands(sim)
        for stop in self.stops:
            while sim.tick < stop:
                commands.send_due()
                due = commands.next_tick
                sim.step((stop if due is None else min(stop, due)) - sim.tick)
            yield


class BareJob:
    """The same steps by MuJoCo alone, from a run of the job in which the controls of each step are recorded.

    Of the tasks of the world, only those before a step may write controls.

    Attributes:
        parts: state at the start of each part, and numbers of steps with their controls, shape (nu,).
    """

    def __init__(self, job: Job) -> None:
        with job.load() as sim:
            self.model, self.data = copy.copy(sim.mj_model), copy.copy(sim.mj_data)
            commands = job.commands(sim)
            self.parts = [(self._state(sim.mj_data), self._calls(sim, commands, stop)) for stop in job.stops]

    def _state(self, data: Any) -> Any:
        values = np.empty(mujoco.mj_stateSize(self.model, STATE))
        mujoco.mj_getState(self.model, data, values, STATE)
        return values

    def _calls(self, sim: Any, commands: Commands, stop: int) -> list[tuple[int, Any]]:
        calls: list[tuple[int, Any]] = []
        while sim.tick < stop:
            commands.send_due()
            sim.step()
            controls = sim.mj_data.ctrl.copy()
            if calls and (calls[-1][1] == controls).all():
                calls[-1] = calls[-1][0] + 1, controls
            else:
                calls.append((1, controls))
        return calls

    def round(self) -> Round:
        model, data, step = self.model, self.data, mujoco.mj_step
        for state, calls in self.parts:
            mujoco.mj_setState(model, data, state, STATE)
            for count, controls in calls:
                data.ctrl[:] = controls
                step(model, data, count)
            yield


def bag_round(job: Job, sim: Any, path: Path) -> Round:
    with Recorder(sim, path, skip=job.skip, overwrite=True) as recorder:
        counter = TopicCounter(sim, RENDERED, recorder.records)
        for part in job.parts(sim):
            recorder.check()
            yield part
        counter.close()
    yield  # the end of the bag


def counted_round(job: Job, sim: Any) -> Round:
    counter = TopicCounter(sim, RENDERED)
    yield from job.parts(sim)
    counter.close()
    yield


def measure(job: Job, rounds: int) -> tuple[dict[str, tuple[float, float]], int]:
    """Time all sides.

    Returns:
        Thread and process CPU time of a step [s] by side, and the size of the bag [bytes].
    """
    bare = BareJob(job)
    sims = {name: job.load() for name in ("nobody", "counted", "bag")}
    times: dict[str, list[list[tuple[float, float]]]] = {}
    with tempfile.TemporaryDirectory() as folder:
        bag = Path(folder) / "x.mcap"
        for number in range(rounds + 1):  # the first round warms up
            for sim in sims.values():
                sim.reset()
            gc.collect()
            sides: dict[str, Round] = {
                "bare": bare.round(),
                "nobody": job.parts(sims["nobody"]),
                "counted": counted_round(job, sims["counted"]),
                "bag": bag_round(job, sims["bag"], bag),
            }
            row: dict[str, list[tuple[float, float]]] = {name: [] for name in sides}
            for _ in range(len(job.stops) + 1):
                for name, side in sides.items():
                    row[name].append(timed(lambda side=side: next(side, None)))
            if number:
                for name, each in row.items():
                    times.setdefault(name, []).append(each)
        size = bag.stat().st_size
    for sim in sims.values():
        sim.close()
    return {name: per_step(each, job.steps) for name, each in times.items()}, size


def timed(call: Callable[[], object]) -> tuple[float, float]:
    """Return the CPU time of this thread and of the process during a call [s]."""
    process, thread = time.process_time(), time.thread_time()
    call()
    return time.thread_time() - thread, time.process_time() - process


def per_step(rounds: list[list[tuple[float, float]]], steps: int) -> tuple[float, float]:
    """Return the sums of the lower quartiles of all parts, divided by the number of steps [s]."""
    sums = [0.0, 0.0]
    for part in zip(*rounds, strict=True):
        for clock in (0, 1):
            sums[clock] += sorted(each[clock] for each in part)[len(part) // 4]
    return sums[0] / steps, sums[1] / steps


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--world", default="turtlebot3_world")
    parser.add_argument("--script", default=str(SCRIPT), help="commands of the run")
    parser.add_argument("--duration", type=float, default=36.0, help="simulated time [s]")
    parser.add_argument("--skip", action="append", help="topics that are not recorded; default: /camera/*")
    parser.add_argument("--rounds", type=int, default=8, help="timings of each side")
    parser.add_argument("--json", help="file for the numbers")
    args = parser.parse_args()
    args.skip = args.skip or ["/camera/*"]
    job = Job(args)
    found, size = measure(job, args.rounds)
    bare = found["bare"]
    rows = {}
    for name, times in found.items():
        ratios = [ours / theirs for ours, theirs in zip(times, bare, strict=True)]
        rows[name] = {"thread": times[0], "process": times[1], "thread_ratio": ratios[0], "process_ratio": ratios[1]}
        goal = f"   goal <= {GOALS[name]:.2f}" if name in GOALS else ""
        print(
            f"{name:8s} thread {times[0] * 1e6:6.2f} us a step   ratio {ratios[0]:5.2f}"
            f"   process {times[1] * 1e6:6.2f} us   ratio {ratios[1]:5.2f}{goal}",
            flush=True,
        )
    print(f"bag of {size / 1e6:.2f} MB")
    if args.json:
        Path(args.json).write_text(json.dumps({"sides": rows, "bag_bytes": size}, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
