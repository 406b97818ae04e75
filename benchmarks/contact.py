"""Contact beside the analytic answer: simkit, plain MuJoCo with default options, and PyBullet where it is installed.

python benchmarks/contact.py [--cases GLOB] [--json FILE] [--plot FILE.svg] [--markdown] [--long] [--rounds N]

Bodies slide, roll, spin, skid, bounce, rest and bear loads; the same cases run in every engine. Plain MuJoCo has an
equivalent MJCF with its default options, but springs with the wanted damping where something bounces. Of each case:
errors against the analytic answer, and CPU time of a step, median of several rounds, the engines in turn. In simkit and
PyBullet that contains a call at every step where a body is pushed, and in simkit the DiffDrive plugin with its odometry
where a vehicle drives.
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import math
import platform
import statistics
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import measure  # noqa: F401  (finds simkit beside it)
import mujoco
from contact_cases import Case, all_cases
from contact_engines import DivergedError, Engine, UnsupportedCaseError, engines
from contact_measures import MEASURES, integrator_share, record
from contact_tables import markdown

import simkit

Results = dict[str, dict[str, float]]  # by engine and quantity
TIMED_STEPS = 200  # at most, of one round
PLAIN = "MuJoCo"


def run_case(case: Case, makers: Mapping[str, Callable[[Case, Path], Engine]], rounds: int) -> Results:
    """Run one case in every engine that has its shapes, then time them in turn."""
    made: dict[str, Engine] = {}
    results: Results = {}
    sound: dict[str, Engine] = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, make in makers.items():
            try:
                engine = make(case, Path(folder))
            except UnsupportedCaseError:
                continue
            made[name] = engine
            try:
                observed = record(engine, case)
            except (simkit.SimulationDiverged, DivergedError):
                results[name] = dict.fromkeys(case.asks, math.nan)
            else:
                results[name] = {quantity: MEASURES[quantity].find(observed) for quantity in case.asks}
                sound[name] = engine
        times = step_times(sound, case, rounds)
        for engine in made.values():
            engine.close()
    for name, taken in times.items():
        results[name]["step_us"] = 1e6 * taken
        results[name]["step_ratio"] = taken / times.get(PLAIN, math.nan)
    return results


def step_times(made: Mapping[str, Engine], case: Case, rounds: int) -> dict[str, float]:
    """Median CPU time of a step from the start of the motion on [s]; the engines alternate."""
    count = min(TIMED_STEPS, max(10, round(min(case.slips, case.duration) / case.timestep)))
    taken: dict[str, list[float]] = {name: [] for name in made}
    for turn in range(rounds + 1):
        for name, engine in made.items():
            engine.rewind()
            start = time.process_time()
            engine.advance(count)
            if turn:
                taken[name].append((time.process_time() - start) / count)
    return {name: statistics.median(times) for name, times in taken.items()}


def line(case: Case, name: str, found: Mapping[str, float]) -> str:
    """One engine's results of a case."""
    words = [f"{MEASURES[q].title} {found[q]:.4g} {MEASURES[q].unit}".rstrip() for q in case.asks]
    if not math.isnan(case.way):
        words.append(f"the integrator's own {integrator_share(case):.2f} %")
    taken, ratio = found.get("step_us", math.nan), found.get("step_ratio", math.nan)
    return f"{case.name:24s} {name:8s} {taken:6.1f} us ({ratio:5.2f})  " + ", ".join(words)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--cases", default="*", metavar="GLOB", help="names of the cases to run")
    parser.add_argument("--json", metavar="FILE", help="where to write every case's results")
    parser.add_argument("--plot", metavar="FILE", help="where to draw them (.svg or .png)")
    parser.add_argument("--markdown", action="store_true", help="print the tables instead of a line for each case")
    parser.add_argument("--long", action="store_true", help="watch the tower for 60 s instead of 10 s")
    parser.add_argument("--rounds", type=int, default=5, help="timings taken of each engine and case")
    return parser.parse_args()


def versions(names: list[str]) -> dict[str, str]:
    """Version of each engine that runs."""
    found = {"simkit": simkit.__version__, PLAIN: mujoco.__version__}
    if "PyBullet" in names:
        from importlib.metadata import version

        found["PyBullet"] = version("pybullet")
    return found


def main() -> None:
    args = arguments()
    longest = 60.0 if args.long else 10.0
    MEASURES["stands"] = replace(MEASURES["stands"], exact=longest, aim=longest)
    cases = [case for case in all_cases(longest) if fnmatch.fnmatch(case.name, args.cases)]
    if not cases:
        raise SystemExit(f"no case is named {args.cases}; there are {', '.join(c.name for c in all_cases())}")
    makers = engines()
    done: list[dict[str, Any]] = []
    for case in cases:
        results = run_case(case, makers, args.rounds)
        share = integrator_share(case)
        done.append({"name": case.name, "group": case.group, "integrator_share": share, "results": results})
        if not args.markdown:
            for name, found in results.items():
                print(line(case, name, found), flush=True)
    if args.markdown:
        print(markdown(done, list(makers)))
    if args.json:
        whole = {"versions": versions(list(makers)), "machine": platform.machine(), "cases": done}
        text = json.dumps(whole, indent=1, default=float)
        Path(args.json).write_text(text.replace("NaN", "null") + "\n", encoding="utf-8")
    if args.plot:
        from contact_plot import draw

        draw(done, list(makers), args.plot)


if __name__ == "__main__":
    main()
